//! Applications for users who do not write a program: [`play`](mod@play) shows a scene live in the web
//! browser; the command `pliant` (`command/`) is a separate crate, which uses the public API.

pub mod play;

//! Programs for those who do not write one: [`play`](mod@play) shows a scene live in the web browser; the command
//! `pliant` (`command/`) is a crate of its own, which uses what is public.

pub mod play;

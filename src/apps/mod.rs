//! Applications for users who do not write a program: `play` shows a scene live in the web browser; `command` is the command
//! `pliant`, which uses the public API alone, and which programs with devices of their own have by one line.

#[cfg(feature = "cli")]
pub mod command;
#[cfg(feature = "play")]
pub mod play;

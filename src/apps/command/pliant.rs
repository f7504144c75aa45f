//! The program `pliant`.

use std::process::ExitCode;

fn main() -> ExitCode {
    pliant::command::main_with(&[])
}

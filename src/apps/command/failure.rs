//! Failures of the command, with their exit codes, and printing to the standard output.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};

use pliant::{Error, InputError};

/// Why the command ends without success.
pub struct Failure {
    /// Exit code: [`FAILED`] or [`BAD_INPUT`].
    pub code: u8,
    /// The message.
    pub message: String,
}

/// A computation that failed or was interrupted, a result that cannot be written.
pub const FAILED: u8 = 1;
/// Bad input; nothing was computed.
pub const BAD_INPUT: u8 = 2;

impl Failure {
    /// A failure that is not the fault of the input.
    pub fn failed(message: impl Display) -> Self {
        Self { code: FAILED, message: message.to_string() }
    }

    /// An input that cannot be used.
    pub fn bad_input(message: impl Display) -> Self {
        Self { code: BAD_INPUT, message: message.to_string() }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Integration(_)
            | Error::Statics(_)
            | Error::Reference { .. }
            | Error::Output { .. } => Self::failed(error),
            _ => Self::bad_input(error),
        }
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::bad_input(error)
    }
}

/// Prints a text and a line end to the standard output.
pub fn print(text: impl Display) -> Result<(), Failure> {
    match writeln!(io::stdout().lock(), "{text}") {
        // a closed pipe is no error: its reader, such as `head`, has read enough
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::failed(format!("cannot write to the standard output: {error}")))
        }
        _ => Ok(()),
    }
}

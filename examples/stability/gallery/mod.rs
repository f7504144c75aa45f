//! Where methods and models fail: each failure as an experiment, and a section of the page that
//! reports it. The experiments are run by `tests/stability` as well, smaller.

pub mod alpha;
pub mod compression;
pub mod contact;
pub mod explicit;
pub mod forms;
pub mod heat;
pub mod index;
pub mod linear;
pub mod locking;
pub mod orders;
pub mod page;
pub mod pulses;
pub mod rotation;

/// Result of an experiment; an error ends the program with its message.
pub type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

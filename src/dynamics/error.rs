//! The one error type of the crate.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

use crate::base::input::{InputError, debug_in_words};
use crate::dynamics::equilibrium::NoEquilibrium;
use crate::dynamics::trajectory::IntegrationFailure;
use crate::integrators::common;

debug_in_words!(Error);

/// Failure of an operation: its cause, the input concerned, and the remedy. It is shown in words, also by [`Debug`](std::fmt::Debug).
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An input that cannot be used.
    #[error(transparent)]
    Input(#[from] InputError),

    /// The integrator failed; the results until then are kept inside.
    #[error(transparent)]
    Integration(#[from] Box<IntegrationFailure>),

    /// An integrator that was used on its own (`pliant::sundials`, `pliant::rk`) stopped.
    #[error(transparent)]
    Integrator(common::Error),

    /// No equilibrium was found; the last one found for part of the load is kept inside.
    #[error(transparent)]
    Statics(#[from] Box<NoEquilibrium>),

    /// A function that was given to a simulation has panicked.
    #[error(transparent)]
    Panicked(#[from] Panicked),

    /// A scene file holds something that cannot be used.
    #[error("{}:{line}: {key}{}{message}", path.display(), if key.is_empty() { "" } else { ": " })]
    SceneFile {
        /// The file.
        path: PathBuf,
        /// Number of the line, from 1.
        line: usize,
        /// The key, with those of the tables around it; empty for an error of no single key.
        key: String,
        /// Cause and remedy.
        message: String,
    },

    /// A study found no reference to compare with.
    #[error(
        "no two methods solve the scene at rtol {rtol:.0e}, so there is no reference: {help} ({failures})"
    )]
    Reference {
        /// Relative tolerance.
        rtol: f64,
        /// Reason for the failure of the methods.
        failures: String,
        /// Remedy.
        help: String,
    },

    /// A file could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
    },

    /// A file could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
    },
}

/// A function of the caller has panicked.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a function that was given to the simulation panicked: {message}")]
pub struct Panicked {
    /// The message of the panic.
    pub message: String,
}

/// Return value of a function of the caller, or an error if it panics.
pub(crate) fn guarded<T>(call: impl FnOnce() -> T) -> Result<T, Panicked> {
    catch_unwind(AssertUnwindSafe(call)).map_err(|payload| {
        let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
        Panicked { message: text.unwrap_or_else(|| "it said nothing".into()) }
    })
}

impl From<common::Error> for Error {
    fn from(error: common::Error) -> Self {
        match error {
            common::Error::Input(error) => error.into(),
            error => Self::Integrator(error),
        }
    }
}

//! Why a callback of a system failed.

use std::error::Error;

/// Why a callback of a system failed.
///
/// Any `std` error converts into [`Failure::Fatal`], so `?` works inside callbacks.
#[derive(Debug)]
pub enum Failure {
    /// This trial point is no good (outside the domain, say): retry with a smaller step.
    Recoverable(String),
    /// Stop the integration and hand the error to the caller.
    Fatal(Box<dyn Error + Send + Sync>),
}

impl Failure {
    /// The error by itself, where there is nothing left to retry.
    pub(crate) fn into_error(self) -> Box<dyn Error + Send + Sync> {
        match self {
            Self::Recoverable(message) => message.into(),
            Self::Fatal(error) => error,
        }
    }
}

impl<E: Error + Send + Sync + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Fatal(Box::new(error))
    }
}

/// The failure of a method that a system leaves out.
pub(super) fn missing(method: &'static str) -> Failure {
    Failure::Fatal(
        format!("the integrator was configured to call `{method}`, which this system lacks").into(),
    )
}

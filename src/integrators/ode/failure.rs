//! Failure of a callback of a system.

use std::error::Error;
use std::fmt;

/// Failure of a callback of a system.
///
/// Any `std` error converts into [`Failure::Fatal`], so `?` works inside callbacks. For that reason it is not
/// an [`Error`] itself: it would convert into itself in two ways. Outside of callbacks `?` converts it into
/// one, a `Box<dyn Error + Send + Sync>`.
///
/// ```
/// use pliant::ode::Ode;
///
/// fn slope(system: &mut impl Ode, t: f64, y: &[f64]) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
///     let mut ydot = vec![0.0; y.len()];
///     system.rhs(t, y, &mut ydot)?;
///     Ok(ydot)
/// }
/// let mut square_root = |_t: f64, y: &[f64], ydot: &mut [f64]| {
///     if y[0] < 0.0 {
///         return Err(pliant::ode::Failure::Recoverable("no root of a negative number".into()));
///     }
///     ydot[0] = y[0].sqrt();
///     Ok(())
/// };
/// let error = slope(&mut square_root, 0.0, &[-1.0]).unwrap_err();
/// assert_eq!(error.to_string(), "no root of a negative number");
/// ```
#[derive(Debug)]
pub enum Failure {
    /// This trial point cannot be used (it lies outside the domain, say): retry with a smaller step.
    Recoverable(String),
    /// Stop the integration and hand the error to the caller.
    Fatal(Box<dyn Error + Send + Sync>),
}

impl Failure {
    /// The error alone, if no retry is possible.
    pub(crate) fn into_error(self) -> Box<dyn Error + Send + Sync> {
        match self {
            Self::Recoverable(message) => message.into(),
            Self::Fatal(error) => error,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Recoverable(message) => f.write_str(message),
            Self::Fatal(error) => error.fmt(f),
        }
    }
}

impl From<Failure> for Box<dyn Error + Send + Sync> {
    fn from(failure: Failure) -> Self {
        failure.into_error()
    }
}

impl From<Failure> for Box<dyn Error> {
    fn from(failure: Failure) -> Self {
        failure.into_error()
    }
}

impl<E: Error + Send + Sync + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Fatal(Box::new(error))
    }
}

/// The failure of a call of a method that a system does not implement.
pub(super) fn missing(method: &'static str) -> Failure {
    Failure::Fatal(
        format!("the integrator was configured to call `{method}`, which this system lacks").into(),
    )
}

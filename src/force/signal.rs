//! Numbers and vectors that may change with time: actuation forces, pressures, loads.

use std::fmt;
use std::sync::Arc;

use crate::error::{Error, finite};
use crate::ode::Failure;

/// A number, constant or a function of time (s).
#[derive(Clone)]
pub(crate) enum Signal {
    Constant(f64),
    Function(Arc<dyn Fn(f64) -> f64 + Send + Sync>),
}

impl Signal {
    pub(crate) fn function(f: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self::Function(Arc::new(f))
    }

    pub(super) fn at(&self, t: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Function(function) => function(t),
        }
    }

    /// Checks what can be known beforehand.
    pub(crate) fn validate(&self, input: &str) -> Result<(), Error> {
        match self {
            Self::Constant(value) => finite(input, &[*value]),
            Self::Function(_) => Ok(()),
        }
    }
}

impl fmt::Debug for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => write!(f, "{value}"),
            Self::Function(_) => f.write_str("function of time"),
        }
    }
}

/// The sum of `signals` at time `t`.
pub(super) fn sum(signals: &[Signal], t: f64) -> f64 {
    signals.iter().map(|signal| signal.at(t)).sum()
}

/// Passes a `value` that a function of time gave, if it is finite.
pub(super) fn finite_at(t: f64, what: fmt::Arguments<'_>, value: f64) -> Result<f64, Failure> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(Failure::Fatal(
        format!("{what} is {value} at t = {t} s: it must be a finite number").into(),
    ))
}

/// Writes the vector at a time (s).
type Write = dyn Fn(f64, &mut [f64]) + Send + Sync;

/// A vector as a function of time (s), written to a slice with one component per dimension.
#[derive(Clone)]
pub(crate) struct VectorFunction {
    /// Components that it writes.
    pub(crate) dimension: usize,
    function: Arc<Write>,
}

impl VectorFunction {
    pub(crate) fn new<const D: usize>(f: impl Fn(f64) -> [f64; D] + Send + Sync + 'static) -> Self {
        let function = move |t: f64, vector: &mut [f64]| vector.copy_from_slice(&f(t));
        Self { dimension: D, function: Arc::new(function) }
    }

    pub(super) fn at(&self, t: f64, vector: &mut [f64]) {
        (self.function)(t, vector);
    }
}

impl fmt::Debug for VectorFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("function of time")
    }
}

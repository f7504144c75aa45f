//! Weights of the error norm that the user computes.

use std::{fmt, sync::Arc};

use crate::integrators::ode::Failure;

type Weigh = dyn Fn(&[f64], &mut [f64]) + Send + Sync;

/// A function that writes a weight for each unknown of a state.
#[derive(Clone)]
pub(super) struct ErrorWeights(Arc<Weigh>);

impl ErrorWeights {
    pub(super) fn new(weigh: impl Fn(&[f64], &mut [f64]) + Send + Sync + 'static) -> Self {
        Self(Arc::new(weigh))
    }

    /// Writes the weights of a state.
    ///
    /// # Errors
    /// Weights that are not positive.
    pub(super) fn write(&self, y: &[f64], weights: &mut [f64]) -> Result<(), Failure> {
        (self.0)(y, weights);
        match weights.iter().position(|weight| !(*weight > 0.0 && weight.is_finite())) {
            None => Ok(()),
            Some(i) => {
                let why = format!(
                    "the error weight of unknown {i} is {}: weights are positive",
                    weights[i]
                );
                Err(Failure::Fatal(why.into()))
            }
        }
    }
}

impl fmt::Debug for ErrorWeights {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("ErrorWeights")
    }
}

//! Weights of the error norm that the user computes.

use std::{fmt, sync::Arc};

use super::callbacks::callbacks;
use crate::integrators::{common::Callback, ode::Failure};

type Weigh = dyn Fn(&[f64], &mut [f64]) + Send + Sync;

/// A function that writes a weight for each unknown of a state.
#[derive(Clone)]
pub(super) struct ErrorWeights(Arc<Weigh>);

impl ErrorWeights {
    pub(super) fn new(weigh: impl Fn(&[f64], &mut [f64]) + Send + Sync + 'static) -> Self {
        Self(Arc::new(weigh))
    }

    fn write(&self, y: &[f64], weights: &mut [f64]) -> Result<(), Failure> {
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

callbacks! {
    /// `CVEwtFn`
    fn error_weights<S: Sized>(y: read, weights: write, host: (data S)) {
        let Some(own) = host.weights.clone() else { return 0 };
        let t = host.last_time();
        host.guard(Callback::ErrorWeights, t, |_| own.write(y, weights))
    }
}

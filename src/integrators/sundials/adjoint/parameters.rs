//! Derivatives with respect to parameters.

use crate::base::vector::size_or_one;
use crate::integrators::{ode::Failure, sundials::sensitivity::Access};

/// Central differences with respect to parameters.
pub(super) struct ParameterDifferences {
    p: Vec<f64>,
    trial: Vec<f64>,
    ahead: Vec<f64>,
    behind: Vec<f64>,
}

impl ParameterDifferences {
    /// Of `n` equations by `count` parameters.
    pub(super) fn new(count: usize, n: usize) -> Self {
        let zeros = |n: usize| vec![0.0; n];
        let (p, trial, ahead, behind) = (zeros(count), zeros(count), zeros(n), zeros(n));
        Self { p, trial, ahead, behind }
    }

    /// Writes the product of `lambda` with the derivatives of `evaluate`, by steps `relative` to the sizes of parameters,
    /// which are restored to the last bit, whatever happens.
    pub(super) fn write<S>(
        &mut self,
        system: &mut S,
        access: &Access<S>,
        relative: f64,
        lambda: &[f64],
        out: &mut [f64],
        mut evaluate: impl FnMut(&mut S, &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let Self { p, trial, ahead, behind } = self;
        p.copy_from_slice((access.get)(system));
        access.restoring(system, p, |system| {
            for (i, out) in out.iter_mut().enumerate() {
                let step = relative * size_or_one(p[i]);
                let ends = [p[i] + step, p[i] - step];
                for (end, result) in ends.into_iter().zip([&mut *ahead, &mut *behind]) {
                    trial.copy_from_slice(p);
                    trial[i] = end;
                    (access.set)(system, trial);
                    evaluate(system, result)?;
                }
                let differences = ahead.iter().zip(behind.iter()).map(|(a, b)| a - b);
                let sum: f64 = differences.zip(lambda).map(|(d, lambda)| d * lambda).sum();
                *out = sum / (ends[0] - ends[1]);
            }
            Ok(())
        })
    }
}

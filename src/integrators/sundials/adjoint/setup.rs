//! Adjoint gradients of any kind of equations.

use std::fmt;

use super::options::AdjointOptions;
use crate::integrators::common::Error;

/// A system, a functional of its solution, and the options `O` of the forward run: [`Adjoint`](super::Adjoint) for an
/// ODE, [`DaeAdjoint`](super::DaeAdjoint) for a DAE.
pub struct AdjointOf<O, S, F> {
    pub(super) system: S,
    pub(super) functional: F,
    pub(super) runs: Runs<O>,
}

/// Forward and backward runs of a system and its functional. These come as trait objects, so that the integration is
/// compiled once, and not for each type.
pub(super) struct Runs<O> {
    /// Time, state and its time derivative, which is empty for an ODE.
    pub(super) start: (f64, Vec<f64>, Vec<f64>),
    pub(super) forward: O,
    pub(super) options: AdjointOptions,
}

/// Times of the backward run at which its lambda is wanted, from the end to the start, and the function that gets it.
pub(super) struct Along<'a> {
    pub(super) times: &'a [f64],
    pub(super) visit: &'a mut dyn FnMut(f64, &[f64]),
}

impl Along<'_> {
    /// Checks the times of a run between `start` and `end`.
    pub(super) fn check(&self, start: f64, end: f64) -> Result<(), Error> {
        let mut last = end;
        for &t in self.times {
            if !((t - start) * (end - start) >= 0.0 && (last - t) * (end - start) >= 0.0) {
                let help = format!("times lead from the end, {end:?}, to the start, {start:?}");
                return Err(Error::input("time along the backward run", t, help));
            }
            last = t;
        }
        Ok(())
    }
}

impl<O: Clone> Runs<O> {
    /// Checks the options of the backward run for a system with so many parameters and root functions.
    pub(super) fn new(
        (t0, y0, yp0): (f64, &[f64], &[f64]),
        forward: &O,
        options: &AdjointOptions,
        (parameters, roots): (usize, usize),
    ) -> Result<Self, Error> {
        options.check(y0.len(), parameters)?;
        if roots > 0 {
            let help = "an adjoint gradient does not stop at events: leave them out";
            return Err(Error::input("root_count", roots, help));
        }
        let start = (t0, y0.to_vec(), yp0.to_vec());
        Ok(Self { start, forward: forward.clone(), options: options.clone() })
    }
}

impl<O, S, F> fmt::Debug for AdjointOf<O, S, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Adjoint").field("start", &self.runs.start).finish_non_exhaustive()
    }
}

impl<O, S, F> AdjointOf<O, S, F> {
    /// The system.
    #[must_use]
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The system, to change its parameters; the next `gradient` uses them.
    pub fn system_mut(&mut self) -> &mut S {
        &mut self.system
    }
}

//! Root functions are followed from step to step, on the dense output.

use std::mem::take;

use super::error::{Callback, Cause, Error};
use super::march::{March, StepMethod};
use super::one_step::OneStep;
use super::roots::time_tolerance;
use crate::integrators::ode::{Ode, call};

impl<S: Ode, M: StepMethod> OneStep<S, M> {
    /// Evaluates the root functions at the start; `step` is the size of the first step.
    ///
    /// A function that is 0 there is not reported as a root; it is followed from its value a tenth of a step
    /// later.
    pub(super) fn start_roots(&mut self, step: f64) -> Result<(), Error> {
        let March { t, y, argument, roots, .. } = &mut self.march;
        if roots.started || roots.found.is_empty() {
            return Ok(());
        }
        let (t, mut roots) = (*t, take(roots));
        (roots.started, roots.low) = (true, t);
        argument.copy_from_slice(y);
        let mut result = self.evaluate_roots(t, &mut roots.at_low);
        if result.is_ok() && roots.at_low.contains(&0.0) {
            let ahead = f64::max(0.1 * step, time_tolerance(t, step));
            let March { y, slope, argument, .. } = &mut self.march;
            for (argument, (y, slope)) in argument.iter_mut().zip(y.iter().zip(&*slope)) {
                *argument = y + ahead * slope;
            }
            result = self.evaluate_roots(t + ahead, &mut roots.trial);
            roots.leave_zeros();
        }
        self.march.roots = roots;
        result
    }

    /// Moves on from the root last found.
    pub(super) fn pass_root(&mut self) -> Result<(), Error> {
        let tolerance = self.time_tolerance();
        let mut roots = take(&mut self.march.roots);
        let mut result = Ok(());
        if take(&mut roots.rests) && roots.at_low.contains(&0.0) {
            let t = roots.low + tolerance;
            result = self.evaluate_roots_within_step(t, &mut roots.trial);
            roots.leave_zeros();
        }
        self.march.roots = roots;
        result
    }

    /// The time of the first root from where the search ended to `high`, within the last step.
    pub(super) fn find_root(&mut self, high: f64) -> Result<Option<f64>, Error> {
        if !self.march.roots.started || high <= self.march.roots.low {
            return Ok(None);
        }
        let tolerance = self.time_tolerance();
        let mut roots = take(&mut self.march.roots);
        let found = roots.search(high, tolerance, |t, g| self.evaluate_roots_within_step(t, g));
        self.march.roots = roots;
        found
    }

    fn evaluate_roots_within_step(&mut self, t: f64, g: &mut [f64]) -> Result<(), Error> {
        let mut argument = take(&mut self.march.argument);
        self.interpolate_state(t, &mut argument);
        self.march.argument = argument;
        self.evaluate_roots(t, g)
    }

    /// Writes g(t, y) for y = `argument`.
    fn evaluate_roots(&mut self, t: f64, g: &mut [f64]) -> Result<(), Error> {
        let march = &mut self.march;
        let (step, time) = (march.t - march.t_old, march.clock.time(t));
        march.statistics.root_evaluations += 1;
        if let Err(failure) = call::roots(&mut march.system, time, &march.argument, g) {
            let mut error = march.stopped(Cause::Fatal(Callback::Roots), step);
            error.source = Some(failure.into_error());
            return Err(error.into());
        }
        match g.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(component) => {
                let (callback, value) = (Callback::Roots, g[component]);
                let cause = Cause::NotFinite { callback, t: time, component, value };
                Err(march.stopped(cause, step).into())
            }
        }
    }

    /// Accuracy in time of a root within the last step.
    fn time_tolerance(&self) -> f64 {
        time_tolerance(self.march.t, self.march.t - self.march.t_old)
    }
}

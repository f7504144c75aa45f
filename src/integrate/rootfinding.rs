//! Root functions are followed from step to step, by integrators that have a dense output.

use std::mem::take;

use super::error::{Callback, Cause, Error, IntegrationError};
use super::roots::Roots;
use crate::ode::Ode;

/// An integrator whose root functions are followed on its dense output.
pub(crate) trait FollowsRoots {
    type System: Ode;

    fn roots_mut(&mut self) -> &mut Roots;

    /// Start and end of the last step.
    fn span(&self) -> [f64; 2];

    /// The system, the state at the end of the last step, f there, and room for another state.
    fn parts(&mut self) -> (&mut Self::System, [&[f64]; 2], &mut [f64]);

    /// Writes the state at a time within the last step into that room.
    fn interpolate_inside(&mut self, t: f64);

    /// Counts an evaluation of the root functions.
    fn count_root_evaluation(&mut self);

    /// An integration that stopped in a step of this size.
    fn halt(&self, cause: Cause, step: f64) -> IntegrationError;

    /// Evaluates the root functions at the start; `step` is the size of the first step.
    ///
    /// One that is 0 there is a root no longer, and followed from its value a tenth of a step later.
    fn start_roots(&mut self, step: f64) -> Result<(), Error> {
        if self.roots_mut().started || self.roots_mut().found.is_empty() {
            return Ok(());
        }
        let t = self.span()[1];
        let mut roots = take(self.roots_mut());
        (roots.started, roots.low) = (true, t);
        let (_, [y, _], argument) = self.parts();
        argument.copy_from_slice(y);
        let mut result = self.evaluate_roots(t, &mut roots.at_low);
        if result.is_ok() && roots.at_low.contains(&0.0) {
            let ahead = f64::max(0.1 * step, time_tolerance(t, step));
            let (_, [y, slope], argument) = self.parts();
            for (argument, (y, slope)) in argument.iter_mut().zip(y.iter().zip(slope)) {
                *argument = y + ahead * slope;
            }
            result = self.evaluate_roots(t + ahead, &mut roots.trial);
            roots.leave_zeros();
        }
        *self.roots_mut() = roots;
        result
    }

    /// Leaves the root last found behind.
    fn pass_root(&mut self) -> Result<(), Error> {
        let [start, end] = self.span();
        let mut roots = take(self.roots_mut());
        let mut result = Ok(());
        if take(&mut roots.rests) && roots.at_low.contains(&0.0) {
            let t = roots.low + time_tolerance(end, end - start);
            result = self.evaluate_roots_within_step(t, &mut roots.trial);
            roots.leave_zeros();
        }
        *self.roots_mut() = roots;
        result
    }

    /// The time of the first root from where the search ended to `high`, within the last step.
    fn find_root(&mut self, high: f64) -> Result<Option<f64>, Error> {
        if !self.roots_mut().started || high <= self.roots_mut().low {
            return Ok(None);
        }
        let [start, end] = self.span();
        let tolerance = time_tolerance(end, end - start);
        let mut roots = take(self.roots_mut());
        let found = roots.search(high, tolerance, |t, g| self.evaluate_roots_within_step(t, g));
        *self.roots_mut() = roots;
        found
    }

    fn evaluate_roots_within_step(&mut self, t: f64, g: &mut [f64]) -> Result<(), Error> {
        self.interpolate_inside(t);
        self.evaluate_roots(t, g)
    }

    /// Writes g(t, y) for the y in the room for another state.
    fn evaluate_roots(&mut self, t: f64, g: &mut [f64]) -> Result<(), Error> {
        self.count_root_evaluation();
        let [start, end] = self.span();
        let (system, _, argument) = self.parts();
        if let Err(failure) = system.roots(t, argument, g) {
            let mut error = self.halt(Cause::Fatal(Callback::Roots), end - start);
            error.source = Some(failure.into_error());
            return Err(error.into());
        }
        match g.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(component) => {
                let (callback, value) = (Callback::Roots, g[component]);
                let cause = Cause::NotFinite { callback, t, component, value };
                Err(self.halt(cause, end - start).into())
            }
        }
    }
}

/// To how much of the time a root is found.
fn time_tolerance(t: f64, step: f64) -> f64 {
    100.0 * f64::EPSILON * (t.abs() + step)
}

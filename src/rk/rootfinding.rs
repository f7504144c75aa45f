//! Root functions are followed from step to step.

use std::mem::take;

use super::dormand_prince::DormandPrince;
use super::stages::{fatal, stopped};
use super::tableau::advance;
use crate::integrate::{Callback, Cause, Error};
use crate::ode::Ode;

impl<S: Ode> DormandPrince<S> {
    /// Evaluates the root functions at the start; `step` is the size of the first step.
    ///
    /// One that is 0 there is a root no longer, and followed from its value a tenth of a step later.
    pub(super) fn start_roots(&mut self, step: f64) -> Result<(), Error> {
        if self.roots.started || self.roots.found.is_empty() {
            return Ok(());
        }
        let mut roots = take(&mut self.roots);
        (roots.started, roots.low) = (true, self.t);
        self.argument.copy_from_slice(&self.y);
        let mut result = self.evaluate_roots(self.t, &mut roots.at_low);
        if result.is_ok() && roots.at_low.contains(&0.0) {
            let ahead = f64::max(0.1 * step, self.time_tolerance(step));
            advance(&mut self.argument, &self.y, ahead, [1.0], [&self.k[0]]);
            result = self.evaluate_roots(self.t + ahead, &mut roots.trial);
            roots.leave_zeros();
        }
        self.roots = roots;
        result
    }

    /// Leaves the root last found behind.
    pub(super) fn pass_root(&mut self) -> Result<(), Error> {
        let mut roots = take(&mut self.roots);
        let mut result = Ok(());
        if take(&mut roots.rests) && roots.at_low.contains(&0.0) {
            let t = roots.low + self.time_tolerance(self.t - self.t_old);
            result = self.evaluate_roots_within_step(t, &mut roots.trial);
            roots.leave_zeros();
        }
        self.roots = roots;
        result
    }

    /// The time of the first root from where the search ended to `high`, within the last step.
    pub(super) fn find_root(&mut self, high: f64) -> Result<Option<f64>, Error> {
        if !self.roots.started || high <= self.roots.low {
            return Ok(None);
        }
        let tolerance = self.time_tolerance(self.t - self.t_old);
        let mut roots = take(&mut self.roots);
        let found = roots.search(high, tolerance, |t, g| self.evaluate_roots_within_step(t, g));
        self.roots = roots;
        found
    }

    /// To how much of the time a root is found.
    fn time_tolerance(&self, step: f64) -> f64 {
        100.0 * f64::EPSILON * (self.t.abs() + step)
    }

    fn evaluate_roots_within_step(&mut self, t: f64, g: &mut [f64]) -> Result<(), Error> {
        let mut y = take(&mut self.argument);
        self.interpolate_state(t, &mut y);
        self.argument = y;
        self.evaluate_roots(t, g)
    }

    /// Writes g(t, `argument`).
    fn evaluate_roots(&mut self, t: f64, g: &mut [f64]) -> Result<(), Error> {
        self.statistics.root_evaluations += 1;
        let place = [self.t, self.t - self.t_old];
        self.system
            .roots(t, &self.argument, g)
            .map_err(|failure| fatal(Callback::Roots, failure.into_error(), place))?;
        match g.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(component) => {
                let (callback, value) = (Callback::Roots, g[component]);
                Err(stopped(Cause::NotFinite { callback, t, component, value }, place))
            }
        }
    }
}

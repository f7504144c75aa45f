//! The inside of a step: slopes, matrix, stages, error, acceptance.

use std::mem::swap;

use super::options::Jacobian;
use super::solver::{Known, Rosenbrock, interpolate};
use super::tableau::Tableau;
use crate::integrate::{Callback, Cause, Error, IntegrationError};
use crate::ode::{Failure, Ode};

impl<S: Ode> Rosenbrock<S> {
    /// Evaluates f(t, y), where no smaller step can help.
    pub(super) fn evaluate_slope(&mut self) -> Result<(), Error> {
        let t = self.t;
        self.statistics.evaluations += 1;
        let outcome = self.system.rhs(t, &self.y, &mut self.slope);
        let setback = self.classify(outcome, Callback::Rhs, t)?;
        if let Some(cause) = setback.or_else(|| not_finite(t, &self.slope)) {
            return Err(self.stopped(cause, 0.0).into());
        }
        self.known.slope = true;
        Ok(())
    }

    /// Initial step size after HNW I, section II.4, "Starting step size".
    pub(super) fn estimate_initial_step(&mut self) -> Result<f64, Error> {
        let state_size = self.norm(&self.y);
        let slope_size = self.norm(&self.slope);
        let mut h = if state_size < 1e-5 || slope_size < 1e-5 {
            1e-6
        } else {
            0.01 * state_size / slope_size
        };
        h = h.min(self.max_step());
        if let Some(stop) = self.stop_time {
            h = h.min(stop - self.t);
        }
        for (argument, (y, slope)) in self.argument.iter_mut().zip(self.y.iter().zip(&self.slope)) {
            *argument = y + h * slope;
        }
        let t_trial = self.t + h;
        self.statistics.evaluations += 1;
        let outcome = self.system.rhs(t_trial, &self.argument, &mut self.slope_new);
        if self.classify(outcome, Callback::Rhs, t_trial)?.is_some() {
            return Ok(h);
        }
        for (trial, slope) in self.slope_new.iter_mut().zip(&self.slope) {
            *trial -= slope;
        }
        let curvature = self.norm(&self.slope_new) / h;
        // y' changes on the time scale T = |y'| / |y''|, so that the error of a step of order p is about
        // (h/T)^p |y'| T
        let time_scale = slope_size / curvature;
        let exponent = 1.0 / f64::from(self.tableau.order);
        let from_error = time_scale * (0.01 / (slope_size * time_scale)).powf(exponent);
        // Not a number or zero when the slopes vanish or are not finite: h will do.
        Ok(if from_error > 0.0 { from_error.min(100.0 * h) } else { h })
    }

    /// Tries a step to `t_new`; `y_old` then holds the new solution and `slope_new` its slope.
    ///
    /// The inner result is the norm of the error estimate, at most 1 when the step will do, or why
    /// there is none.
    pub(super) fn try_step(&mut self, t_new: f64, h: f64) -> Result<Result<f64, Cause>, Error> {
        if let Some(cause) = self.set_up(self.tableau.gamma * h)? {
            return Ok(Err(cause));
        }
        if !self.known.time_slope
            && let Some(cause) = self.differentiate_by_time(h)?
        {
            return Ok(Err(cause));
        }
        for i in 0..self.tableau.alpha.len() {
            if let Some(cause) = self.solve_stage(i, h)? {
                return Ok(Err(cause));
            }
        }
        let tableau = self.tableau;
        self.argument.fill(0.0);
        add(&mut self.argument, tableau.e, &self.stages);
        let error = self.norm(&self.argument);
        if !error.is_finite() {
            // Finite slopes whose solution overflows: the step is far too long.
            return Ok(Ok(f64::MAX));
        }
        if error <= 1.0
            && let Some(cause) = self.finish(t_new, h)?
        {
            return Ok(Err(cause));
        }
        Ok(Ok(error))
    }

    /// Factorizes I - gamma J.
    fn set_up(&mut self, gamma: f64) -> Result<Option<Cause>, Error> {
        let is_kept = self.options.linear && self.factored.is_some();
        if self.factored == Some(gamma) && (is_kept || self.known.jacobian) {
            return Ok(None);
        }
        let (t, reuse) = (self.t, is_kept || self.known.jacobian);
        let Self { system, dense, y, slope, statistics, .. } = self;
        statistics.linear_setups += 1;
        self.factored = None;
        let outcome = match dense {
            None => system.newton_setup(t, y, slope, gamma, reuse).map(|_| true),
            Some(dense) => {
                let at = [&y[..], &slope[..]];
                let evaluated = match self.options.jacobian {
                    _ if reuse => Ok(()),
                    Jacobian::Supplied => dense.ask(system, t, at),
                    _ => {
                        statistics.difference_quotient_evaluations += y.len() as u64;
                        dense.difference(system, t, at, &self.options.forward.tolerances)
                    }
                };
                evaluated.map(|()| dense.factorize(gamma))
            }
        };
        self.statistics.jacobian_evaluations += u64::from(!reuse);
        let callback =
            if self.dense.is_some() { Callback::Jacobian } else { Callback::NewtonSetup };
        let is_regular = match outcome {
            Ok(is_regular) => is_regular,
            Err(failure) => return self.classify(Err(failure), callback, t),
        };
        if let Some((component, value)) = self.dense.as_ref().and_then(|dense| dense.not_finite()) {
            let cause = Cause::NotFinite { callback, t, component, value };
            return Err(self.stopped(cause, 0.0).into());
        }
        self.known.jacobian = true;
        self.factored = is_regular.then_some(gamma);
        Ok((!is_regular).then_some(Cause::LinearSolver))
    }

    /// df/dt at (t, y), as a difference quotient within the step.
    fn differentiate_by_time(&mut self, h: f64) -> Result<Option<Cause>, Error> {
        let ahead = self.t + (f64::EPSILON.sqrt() * (self.t.abs() + h)).min(h);
        self.statistics.difference_quotient_evaluations += 1;
        let outcome = self.system.rhs(ahead, &self.y, &mut self.time_slope);
        let setback = self.classify(outcome, Callback::Rhs, ahead)?;
        if let Some(cause) = setback.or_else(|| not_finite(ahead, &self.time_slope)) {
            return Ok(Some(cause));
        }
        let rate = 1.0 / (ahead - self.t);
        for (ahead, slope) in self.time_slope.iter_mut().zip(&self.slope) {
            *ahead = rate * (*ahead - slope);
        }
        self.known.time_slope = true;
        Ok(None)
    }

    /// Solves for u_i.
    fn solve_stage(&mut self, i: usize, h: f64) -> Result<Option<Cause>, Error> {
        let (tableau, gamma) = (self.tableau, self.tableau.gamma * h);
        let t = self.t + tableau.alpha[i] * h;
        let (before, rest) = self.stages.split_at_mut(i);
        let u = &mut rest[0];
        // what the system leaves out of f, it adds in the solution
        let mut share = 0.0;
        if i == 0 {
            u.copy_from_slice(&self.slope);
        } else {
            self.argument.copy_from_slice(&self.y);
            add(&mut self.argument, tableau.a[i], before);
            self.statistics.evaluations += 1;
            let outcome = if self.dense.is_some() {
                self.system.rhs(t, &self.argument, u)
            } else {
                share = gamma;
                self.system.newton_rhs(t, &self.argument, u)
            };
            if let Err(failure) = outcome {
                return self.classify(Err(failure), Callback::Rhs, t);
            }
            if let Some(cause) = not_finite(t, u) {
                return Ok(Some(cause));
            }
        }
        let of_time = gamma * h * tableau.gamma_sums[i];
        for (u, by_time) in u.iter_mut().zip(&self.time_slope) {
            *u = gamma * *u + of_time * by_time;
        }
        for (c, earlier) in tableau.c[i].iter().zip(&*before) {
            let c = tableau.gamma * c;
            u.iter_mut().zip(earlier).for_each(|(u, earlier)| *u += c * earlier);
        }
        let outcome = match &mut self.dense {
            Some(dense) => {
                dense.solve(u);
                Ok(())
            }
            None => self.system.newton_solve(share, u),
        };
        u[self.coupled..].fill(0.0);
        self.classify(outcome, Callback::NewtonSolve, t)
    }

    /// Writes the new solution, its slope, the dense output and the integrals.
    fn finish(&mut self, t_new: f64, h: f64) -> Result<Option<Cause>, Error> {
        let (tableau, coupled) = (self.tableau, self.coupled);
        self.y_old.copy_from_slice(&self.y);
        add(&mut self.y_old, tableau.m, &self.stages);
        for (bend, weights) in self.bends.iter_mut().zip([tableau.p, tableau.q]) {
            bend.fill(0.0);
            add(bend, weights, &self.stages);
        }
        self.statistics.evaluations += 1;
        let outcome = self.system.rhs(t_new, &self.y_old, &mut self.slope_new);
        let setback = self.classify(outcome, Callback::Rhs, t_new)?;
        let setback = setback.or_else(|| not_finite(t_new, &self.slope_new));
        if setback.is_some() || coupled == self.y.len() {
            return Ok(setback);
        }
        // Simpson's rule, and the cubic through the slopes at both ends
        let middle = self.t + 0.5 * h;
        interpolate([&self.y, &self.y_old], &self.bends, 0.5, &mut self.argument);
        self.statistics.evaluations += 1;
        let outcome = self.system.rhs(middle, &self.argument, &mut self.output);
        for i in coupled..self.y.len() {
            let [first, last] = [h * self.slope[i], h * self.slope_new[i]];
            let change = (first + 4.0 * h * self.output[i] + last) / 6.0;
            self.y_old[i] = self.y[i] + change;
            self.bends[0][i] = first - change;
            self.bends[1][i] = 2.0 * change - first - last;
        }
        self.classify(outcome, Callback::Rhs, middle)
    }

    pub(super) fn accept(&mut self, t_new: f64, h: f64) {
        self.statistics.steps += 1;
        self.statistics.last_step = h;
        (self.t_old, self.t) = (self.t, t_new);
        swap(&mut self.y, &mut self.y_old);
        swap(&mut self.slope, &mut self.slope_new);
        self.known = Known { slope: true, ..Known::default() };
        self.update_weight();
    }

    /// Root mean square of a vector by the error weights, but for the integrals.
    fn norm(&self, x: &[f64]) -> f64 {
        let terms =
            x[..self.coupled].iter().zip(&self.weight).map(|(x, weight)| (x * weight).powi(2));
        (terms.sum::<f64>() / x.len() as f64).sqrt()
    }

    /// Separates what a smaller step may heal from what ends the integration.
    fn classify(
        &self,
        outcome: Result<(), Failure>,
        callback: Callback,
        t: f64,
    ) -> Result<Option<Cause>, Error> {
        match outcome {
            Ok(()) => Ok(None),
            Err(Failure::Recoverable(message)) => {
                Ok(Some(Cause::Rejected { callback, t, message }))
            }
            Err(Failure::Fatal(source)) => {
                let stopped = self.stopped(Cause::Fatal(callback), 0.0);
                Err(IntegrationError { source: Some(source), ..stopped }.into())
            }
        }
    }

    /// The integration stopped with a step.
    pub(super) fn stopped(&self, cause: Cause, step: f64) -> IntegrationError {
        let Tableau { name: integrator, order, .. } = *self.tableau;
        let message = String::new();
        IntegrationError { integrator, cause, t: self.t, step, order, message, source: None }
    }
}

/// Adds the sum of the vectors, weighted.
fn add(out: &mut [f64], weights: &[f64], vectors: &[Vec<f64>]) {
    for (weight, vector) in weights.iter().zip(vectors).filter(|(weight, _)| **weight != 0.0) {
        out.iter_mut().zip(vector).for_each(|(out, x)| *out += weight * x);
    }
}

fn not_finite(t: f64, slope: &[f64]) -> Option<Cause> {
    let component = slope.iter().position(|value| !value.is_finite())?;
    Some(Cause::NotFinite { callback: Callback::Rhs, t, component, value: slope[component] })
}

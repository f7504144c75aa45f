//! The integrator at work.

use std::mem::take;

use super::control::Controller;
use super::solver::{Known, Rosenbrock};
use crate::integrate::{
    Cause, Error, FollowsRoots, Integrator, Reached, Statistics, check_finite, check_length,
    check_start_time, check_stop_time, check_target,
};
use crate::ode::Ode;

impl<S: Ode> Rosenbrock<S> {
    /// How a call ended that came to rest without a root.
    fn reached(&mut self) -> Reached {
        let t = self.t();
        match self.stop_time.take_if(|stop| *stop == t) {
            Some(_) => Reached::StopTime,
            None => Reached::Time,
        }
    }

    /// Makes `t()` and `y()` the state at a time within the last step.
    fn rest_at(&mut self, t: f64) {
        self.rest = (t != self.t).then_some(t);
        if self.rest.is_some() {
            let mut output = take(&mut self.output);
            self.interpolate_state(t, &mut output);
            self.output = output;
        }
    }

    /// Takes one step.
    fn advance(&mut self) -> Result<(), Error> {
        self.rest = None;
        // Until this step succeeds there is nothing to interpolate in: its stages overwrite the
        // last one's.
        self.t_old = self.t;
        if !self.known.slope {
            self.evaluate_slope()?;
        }
        let planned = match self.next_step {
            Some(step) => step,
            None => self.estimate_initial_step()?,
        };
        let mut h = planned.min(self.max_step());
        self.start_roots(self.stop_time.map_or(h, |stop| h.min(stop - self.t)))?;
        loop {
            // A step may stretch by 1 % to hit the stop time rather than leave a sliver.
            let stop = self.stop_time.filter(|stop| self.t + 1.01 * h >= *stop);
            if stop.is_none() && self.t + 0.1 * h == self.t {
                self.next_step = None;
                let cause = self.setback.take().unwrap_or(Cause::ErrorTest);
                return Err(self.stopped(cause, h).into());
            }
            let t_new = stop.unwrap_or(self.t + h);
            let step = t_new - self.t;
            let error = match self.try_step(t_new, step)? {
                Ok(error) => error,
                Err(reason) => {
                    self.statistics.refused_steps += 1;
                    self.setback = Some(reason);
                    h = self.controller.refuse(step);
                    continue;
                }
            };
            if error > 1.0 {
                self.statistics.error_test_failures += 1;
                h = self.controller.reject(step, error);
                continue;
            }
            let proposed = self.controller.accept(step, error);
            if proposed > step {
                self.setback = None;
            }
            // A step cut short by the stop time says nothing against the one that was planned.
            self.next_step = Some(if stop.is_some() { proposed.max(h) } else { proposed });
            self.accept(t_new, step);
            return Ok(());
        }
    }
}

impl<S: Ode> Integrator for Rosenbrock<S> {
    type System = S;

    fn t(&self) -> f64 {
        self.rest.unwrap_or(self.t)
    }

    fn y(&self) -> &[f64] {
        if self.rest.is_some() { &self.output } else { &self.y }
    }

    fn solve_to(&mut self, t: f64) -> Result<Reached, Error> {
        check_target(t, "the last step began at", self.t_old)?;
        if t == self.t() {
            return Ok(Reached::Time);
        }
        self.pass_root()?;
        let first = self.statistics.steps;
        loop {
            if let Some(root) = self.find_root(t.min(self.t))? {
                self.rest_at(root);
                return Ok(Reached::Root);
            }
            if self.t >= t || self.stop_time == Some(self.t) {
                self.rest_at(t.min(self.t));
                return Ok(self.reached());
            }
            let steps = self.statistics.steps - first;
            if steps == u64::from(self.options.forward.steps.max_steps) {
                let cause = Cause::TooManySteps { steps, target: t, notice: self.notice() };
                return Err(self.stopped(cause, self.statistics.last_step).into());
            }
            self.advance()?;
        }
    }

    fn step(&mut self, towards: f64) -> Result<Reached, Error> {
        check_target(towards, "it lies behind", self.t())?;
        if towards == self.t() {
            return Ok(Reached::Time);
        }
        self.pass_root()?;
        if self.rest.is_none() {
            self.advance()?;
        }
        let root = self.find_root(self.t)?;
        self.rest_at(root.unwrap_or(self.t));
        Ok(if root.is_some() { Reached::Root } else { self.reached() })
    }

    fn last_step(&self) -> (f64, f64) {
        (self.t_old, self.t)
    }

    fn last_order(&self) -> u32 {
        self.tableau.order
    }

    fn interpolant_degree(&self) -> u32 {
        if self.tableau.order == 4 || self.coupled < self.y.len() { 3 } else { 2 }
    }

    /// The state, of an order one less than the method's, or, for `derivative` 1, the derivative of that.
    fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        check_length("length of out", out.len(), self.y.len())?;
        if !(self.t_old <= t && t <= self.t) {
            let mend = format!("it lies outside the last step, [{}, {}]", self.t_old, self.t);
            return Err(Error::input("t", t, mend));
        }
        match derivative {
            0 => self.interpolate_state(t, out),
            1 if self.t_old < self.t => self.interpolate_slope(t, out),
            1 => return Err(Error::input("derivative", 1, "take a step first")),
            _ => return Err(Error::input("derivative", derivative, "give 0 or 1")),
        }
        Ok(())
    }

    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), Error> {
        if let Some(stop) = t {
            check_stop_time(stop, self.t, self.t())?;
        }
        self.stop_time = t;
        Ok(())
    }

    fn reinit(&mut self, t: f64, y: &[f64]) -> Result<(), Error> {
        check_length("length of y", y.len(), self.y.len())?;
        check_start_time("t", t)?;
        check_finite("y", y)?;
        (self.t, self.t_old) = (t, t);
        self.y.copy_from_slice(y);
        self.rest = None;
        self.update_weight();
        self.roots.restart();
        self.stop_time = None;
        self.known = Known::default();
        self.factored = None;
        self.next_step = self.options.forward.steps.initial_step;
        self.controller = Controller::new(self.tableau.order, self.options.linear);
        self.setback = None;
        self.statistics = Statistics::default();
        Ok(())
    }

    fn resume(&mut self, t: f64, y: &[f64]) -> Result<bool, Error> {
        check_length("length of y", y.len(), self.y.len())?;
        check_start_time("t", t)?;
        check_finite("y", y)?;
        (self.t, self.t_old) = (t, t);
        self.y.copy_from_slice(y);
        (self.rest, self.stop_time, self.known, self.factored) =
            (None, None, Known::default(), None);
        self.update_weight();
        self.roots.restart();
        Ok(true)
    }

    fn roots_found(&self) -> &[i32] {
        &self.roots.found
    }

    fn statistics(&self) -> Statistics {
        Statistics {
            last_order: self.tableau.order,
            current_order: self.tableau.order,
            current_step: self.next_step.unwrap_or_default(),
            current_time: self.t,
            ..self.statistics.clone()
        }
    }

    fn system(&self) -> &S {
        &self.system
    }

    /// The next step evaluates it afresh.
    fn system_mut(&mut self) -> &mut S {
        (self.known, self.factored) = (Known::default(), None);
        &mut self.system
    }

    fn into_system(self) -> S {
        self.system
    }
}

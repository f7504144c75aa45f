//! Integration by one-step methods, whose steps share only the step size.
//!
//! `rk` and `rosenbrock` are one struct over a [`StepMethod`] (stages, error, size of the next step, dense
//! output), compiled for each method and system. Central differences, whose steps depend on each other,
//! implement the common trait by themselves.

use std::mem::{swap, take};

use super::clock::Clock;
use super::error::{Callback, Cause, Error};
use super::explicit_options::{ExplicitOptions, check_stop_time, check_target};
use super::integrator::{Integrator, Reached, number_before};
use super::march::{March, StepMethod, not_finite};
use super::options::{check_finite, check_form, check_length, check_start, check_start_time};
use super::roots::Roots;
use super::statistics::Statistics;
use crate::integrators::ode::{Ode, call};

/// Integrates y' = f(t, y) forward in time by the one-step method M.
///
/// Output times do not change the steps. Stepping allocates nothing.
#[derive(Debug)]
pub struct OneStep<S, M> {
    pub(crate) march: March<S>,
    pub(crate) method: M,
}

impl<S: Ode, M: StepMethod> OneStep<S, M> {
    /// Starts at y(t) = `y` by a method, with its name and order.
    pub(crate) fn start(
        system: S,
        t: f64,
        y: &[f64],
        options: &ExplicitOptions,
        (integrator, order, method): (&'static str, u32, M),
    ) -> Result<Self, Error> {
        check_start(t, y)?;
        check_form(&system)?;
        options.check(y)?;
        let zeros = || vec![0.0; y.len()];
        let clock = Clock::starting_at(t);
        let march = March {
            integrator,
            order,
            options: options.clone(),
            weight: zeros(),
            clock,
            now: t,
            stop_given: 0.0,
            stop_time: None,
            t: clock.start(),
            y: y.to_vec(),
            slope: zeros(),
            slope_known: false,
            t_old: clock.start(),
            y_old: zeros(),
            slope_old: zeros(),
            argument: zeros(),
            rest: None,
            output: zeros(),
            roots: Roots::new(system.root_count()),
            next_step: options.steps.initial_step,
            setback: None,
            statistics: Statistics::default(),
            system,
        };
        let mut solver = Self { march, method };
        solver.update_weight();
        Ok(solver)
    }

    /// Error weights at the start of the next step.
    fn update_weight(&mut self) {
        let March { options, y, weight, .. } = &mut self.march;
        options.tolerances.weigh(y, weight);
    }

    fn max_step(&self) -> f64 {
        self.march.options.steps.max_step.unwrap_or(f64::INFINITY)
    }

    /// Writes the state at a time within the last step.
    pub(super) fn interpolate_state(&self, t: f64, out: &mut [f64]) {
        if t == self.march.t {
            out.copy_from_slice(&self.march.y);
        } else {
            self.method.interpolate(&self.march, t, out);
        }
    }

    /// Makes `t()` and `y()` the state at a time within the last step.
    fn rest_at(&mut self, t: f64) {
        self.march.now = self.march.clock.time(t);
        self.march.rest = (t != self.march.t).then_some(t);
        if self.march.rest.is_some() {
            let mut output = take(&mut self.march.output);
            self.interpolate_state(t, &mut output);
            self.march.output = output;
        }
    }

    /// End of a call that did not stop at a root.
    fn reached(&mut self) -> Reached {
        let elapsed = self.march.rest.unwrap_or(self.march.t);
        match self.march.stop_time.take_if(|stop| *stop == elapsed) {
            Some(_) => {
                self.march.now = self.march.stop_given;
                self.march.clock.go_on();
                Reached::StopTime
            }
            None => Reached::Time,
        }
    }

    /// Evaluates f(t, y) at the start of a step, where no smaller step can remedy a failure.
    fn evaluate_slope(&mut self) -> Result<(), Error> {
        let march = &mut self.march;
        march.statistics.evaluations += 1;
        let t = march.clock.time(march.t);
        let outcome = call::rhs(&mut march.system, t, &march.y, &mut march.slope);
        let setback = march.classify(outcome, Callback::Rhs, march.t, 0.0)?;
        if let Some(cause) = setback.or_else(|| not_finite(t, &march.slope)) {
            return Err(march.stopped(cause, 0.0).into());
        }
        march.slope_known = true;
        Ok(())
    }

    /// Initial step size after E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations
    /// I", 2nd ed., section II.4, "Starting step size".
    fn estimate_initial_step(&mut self) -> Result<f64, Error> {
        let max_step = self.max_step();
        let Self { march, method } = self;
        let state_size = method.norm(&march.y, &march.weight);
        let slope_size = method.norm(&march.slope, &march.weight);
        let mut h = if state_size < 1e-5 || slope_size < 1e-5 {
            1e-6
        } else {
            0.01 * state_size / slope_size
        };
        h = h.min(max_step);
        let mut t_trial = march.t + h;
        if let Some(stop) = march.stop_time.filter(|stop| t_trial > *stop) {
            (t_trial, h) = (stop, stop - march.t);
        }
        for (argument, (y, slope)) in
            march.argument.iter_mut().zip(march.y.iter().zip(&march.slope))
        {
            *argument = y + h * slope;
        }
        march.statistics.evaluations += 1;
        let outcome = call::rhs(
            &mut march.system,
            march.clock.time(t_trial),
            &march.argument,
            &mut march.slope_old,
        );
        if march.classify(outcome, Callback::Rhs, t_trial, h)?.is_some() {
            return Ok(h);
        }
        for (trial, slope) in march.slope_old.iter_mut().zip(&march.slope) {
            *trial -= slope;
        }
        let curvature = method.norm(&march.slope_old, &march.weight) / h;
        // y' changes on the time scale T = |y'| / |y''|, so that the error of a step of order p is
        // about (h/T)^p |y'| T; the book has T = 1, which is only right for some unit of time.
        let time_scale = slope_size / curvature;
        let exponent = 1.0 / f64::from(march.order);
        let from_error = time_scale * (0.01 / (slope_size * time_scale)).powf(exponent);
        // NaN or zero if the slopes vanish or are not finite: then h is used.
        Ok(if from_error > 0.0 { from_error.min(100.0 * h) } else { h })
    }

    /// Takes one step, unless all that a call allows have been taken since the `first`.
    fn advance_towards(&mut self, target: f64, first: u64) -> Result<(), Error> {
        let steps = self.march.statistics.steps - first;
        if steps == u64::from(self.march.options.steps.max_steps) {
            let cause = Cause::TooManySteps { steps, target, notice: self.notice() };
            return Err(self.march.stopped(cause, self.march.statistics.last_step).into());
        }
        self.advance()
    }

    /// Takes one step.
    fn advance(&mut self) -> Result<(), Error> {
        self.march.rest = None;
        // Until this step succeeds there is nothing to interpolate in: its stages overwrite the
        // last one's.
        self.march.t_old = self.march.t;
        if !self.march.slope_known {
            self.evaluate_slope()?;
        }
        let prescribed = self.march.stop_time.filter(|_| self.march.options.prescribed);
        let planned = match (prescribed, self.march.next_step) {
            (Some(stop), _) => stop - self.march.t,
            (None, Some(step)) => step,
            (None, None) => self.estimate_initial_step()?,
        };
        let mut h = planned.min(self.max_step());
        self.start_roots(self.march.stop_time.map_or(h, |stop| h.min(stop - self.march.t)))?;
        let Self { march, method } = self;
        loop {
            // A step may stretch by 1 % to hit the stop time rather than leave a tiny one.
            let stop = march.stop_time.filter(|stop| march.t + 1.01 * h >= *stop);
            if stop.is_none() && march.t + 0.1 * h == march.t {
                march.next_step = None;
                let cause = march.setback.take().unwrap_or(Cause::ErrorTest);
                return Err(march.stopped(cause, h).into());
            }
            let t_new = stop.unwrap_or(march.t + h);
            let step = t_new - march.t;
            let error = match method.try_step(march, t_new, step)? {
                Ok(error) if prescribed.is_some() && error < f64::MAX => error.min(1.0),
                Ok(error) => error,
                Err(reason) => {
                    march.statistics.refused_steps += 1;
                    march.setback = Some(reason);
                    h = method.refuse(step);
                    continue;
                }
            };
            if error > 1.0 {
                march.statistics.error_test_failures += 1;
                h = method.reject(step, error);
                continue;
            }
            let proposed = method.accept(march, t_new, step, error);
            if proposed > step {
                march.setback = None;
            }
            // A step shortened by the stop time is no reason to give up the size that was planned.
            march.next_step = Some(if stop.is_some() { proposed.max(h) } else { proposed });
            march.statistics.steps += 1;
            march.statistics.last_step = step;
            (march.t_old, march.t) = (march.t, t_new);
            swap(&mut march.y, &mut march.y_old);
            swap(&mut march.slope, &mut march.slope_old);
            march.now = march.clock.time(t_new);
            self.update_weight();
            return Ok(());
        }
    }

    /// Sets the state `y` at time `t`, without a last step to interpolate in.
    fn set_state(&mut self, clock: Clock, t: f64, y: &[f64]) -> Result<(), Error> {
        let march = &mut self.march;
        check_length("length of y", y.len(), march.y.len())?;
        check_start_time("t", t)?;
        check_finite("y", y)?;
        let elapsed = clock.elapsed(t);
        (march.clock, march.now) = (clock, t);
        (march.t, march.t_old) = (elapsed, elapsed);
        march.y.copy_from_slice(y);
        (march.rest, march.stop_time, march.slope_known) = (None, None, false);
        march.roots.restart();
        self.method.forget();
        self.update_weight();
        Ok(())
    }
}

impl<S: Ode, M: StepMethod> Integrator for OneStep<S, M> {
    type System = S;

    #[allow(clippy::misnamed_getters, reason = "`t` of the march counts from its start")]
    fn t(&self) -> f64 {
        self.march.now
    }

    fn y(&self) -> &[f64] {
        if self.march.rest.is_some() { &self.march.output } else { &self.march.y }
    }

    fn solve_to(&mut self, t: f64) -> Result<Reached, Error> {
        let clock = self.march.clock;
        check_target(t, "the last step began at", clock.time(self.march.t_old))?;
        if t == self.t() {
            return Ok(Reached::Time);
        }
        let target = clock.elapsed(t);
        self.pass_root()?;
        let first = self.march.statistics.steps;
        loop {
            if let Some(root) = self.find_root(target.min(self.march.t))? {
                self.rest_at(root);
                return Ok(Reached::Root);
            }
            if self.march.t >= target || self.march.stop_time == Some(self.march.t) {
                self.rest_at(target.min(self.march.t));
                if self.march.t >= target {
                    self.march.now = t;
                }
                return Ok(self.reached());
            }
            self.advance_towards(t, first)?;
        }
    }

    fn step(&mut self, towards: f64) -> Result<Reached, Error> {
        check_target(towards, "it lies behind", self.t())?;
        if towards == self.t() {
            return Ok(Reached::Time);
        }
        self.pass_root()?;
        let (from, first) = (self.march.now, self.march.statistics.steps);
        if self.march.rest.is_none() {
            self.advance()?;
        }
        loop {
            let (clock, end, step) =
                (self.march.clock, self.march.t, self.march.t - self.march.t_old);
            if let Some(root) = self.find_root(end)? {
                self.rest_at(root);
                return Ok(Reached::Root);
            }
            let stops = self.march.stop_time == Some(end);
            // steps between the same two numbers are one step
            if stops || clock.passes(from, end, step) {
                let (_, last) = clock.last_within(end, step);
                self.rest_at(if stops { end } else { last });
                return Ok(self.reached());
            }
            self.advance_towards(towards, first)?;
        }
    }

    fn last_step(&self) -> (f64, f64) {
        let March { clock, t_old, t, .. } = self.march;
        (clock.time(t_old), clock.time(t))
    }

    fn last_order(&self) -> u32 {
        self.march.order
    }

    fn interpolant_degree(&self) -> u32 {
        self.method.interpolant_degree()
    }

    /// The state, or, for `derivative` 1, the derivative of the interpolant.
    fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        let March { clock, t: end, t_old: start, .. } = self.march;
        check_length("length of out", out.len(), self.march.y.len())?;
        let elapsed = match self.march.rest {
            Some(rest) if t == self.march.now => rest,
            _ => clock.within(t, (start, end)),
        };
        if !(start <= elapsed && elapsed <= end) {
            let [start, end] = [start, end].map(|at| clock.time(at));
            let help = format!("it lies outside the last step, [{start}, {end}]");
            return Err(Error::input("t", t, help));
        }
        match derivative {
            0 => self.interpolate_state(elapsed, out),
            1 if start < end => self.method.interpolate_slope(&self.march, elapsed, out),
            1 => return Err(Error::input("derivative", 1, "take a step first")),
            _ => return Err(Error::input("derivative", derivative, "give 0 or 1")),
        }
        Ok(())
    }

    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), Error> {
        if let Some(stop) = t {
            check_stop_time(stop, self.march.clock.time(self.march.t), self.t())?;
            self.march.stop_given = stop;
        }
        self.march.clock.go_on();
        self.march.stop_time = t.map(|stop| self.march.clock.elapsed(stop));
        Ok(())
    }

    fn set_stop_before(&mut self, t: f64) -> Result<(), Error> {
        let before = number_before(t, self.t());
        if before == self.t() {
            self.march.clock.go_on();
            self.march.stop_given = before;
        } else {
            self.set_stop_time(Some(before))?;
        }
        let March { clock, stop_time, t: now, .. } = &mut self.march;
        *stop_time = Some(clock.end_before(t, before, *now));
        Ok(())
    }

    fn reinit(&mut self, t: f64, y: &[f64]) -> Result<(), Error> {
        self.set_state(Clock::starting_at(t), t, y)?;
        self.march.next_step = self.march.options.steps.initial_step;
        self.march.setback = None;
        self.march.statistics = Statistics::default();
        self.method.restart();
        Ok(())
    }

    fn resume(&mut self, t: f64, y: &[f64]) -> Result<bool, Error> {
        self.set_state(self.march.clock, t, y)?;
        Ok(true)
    }

    fn roots_found(&self) -> &[i32] {
        &self.march.roots.found
    }

    fn statistics(&self) -> Statistics {
        Statistics {
            last_order: self.march.order,
            current_order: self.march.order,
            current_step: self.march.next_step.unwrap_or_default(),
            current_time: self.march.clock.time(self.march.t),
            ..self.march.statistics.clone()
        }
    }

    fn steps(&self) -> u64 {
        self.march.statistics.steps
    }

    fn notice(&self) -> Option<String> {
        self.method.notice()
    }

    fn bounding_rate(&self) -> Option<f64> {
        self.method.bounding_rate()
    }

    fn system(&self) -> &S {
        &self.march.system
    }

    /// Discards cached derivatives, so that the next step evaluates the system again.
    fn system_mut(&mut self) -> &mut S {
        self.march.slope_known = false;
        self.method.forget();
        &mut self.march.system
    }

    fn into_system(self) -> S {
        self.march.system
    }
}

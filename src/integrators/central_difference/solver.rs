//! The integrator: its state, its steps and its public methods.

use std::mem::{swap, take};

use super::control::Control;
use super::stability::Stability;
use crate::integrators::common::{
    Callback, Cause, Error, ExplicitOptions, IntegrationError, Integrator, Reached, Statistics,
    check_finite, check_length, check_start, check_start_time, check_stop_time, check_target,
};
use crate::integrators::ode::{Failure, SecondOrder, call};

/// Order of the method.
const ORDER: u32 = 2;

/// Number of steps for which the weights of the error norm are kept.
const KEPT: u64 = 16;

/// Integrates M u'' = f(t, u, u') forward in time by central differences.
///
/// Steps are as long as stability and the tolerances allow, and equal for as long as they can be; one
/// evaluation of the forces each. Stepping allocates nothing.
#[derive(Debug)]
pub struct CentralDifference<S> {
    pub(super) system: S,
    options: ExplicitOptions,
    /// Number of displacements.
    pub(super) n: usize,
    control: Control,
    stability: Stability,
    stop_time: Option<f64>,
    /// End and start of the last step; equal when there is nothing to interpolate in.
    pub(super) t: f64,
    t_before: f64,
    /// Time within the last step at which the last call stopped, unless at its end, and the state there.
    rest: Option<f64>,
    output: Vec<f64>,
    /// (u, v, integrals) at t, and at `t_before`; while a step is tried, the latter holds the trial state.
    pub(super) y: Vec<f64>,
    pub(super) y_before: Vec<f64>,
    /// Forces at t.
    pub(super) force: Vec<f64>,
    pub(super) trial_force: Vec<f64>,
    /// Time derivatives of the integrals at t, without those of constraints.
    pub(super) powers: Vec<f64>,
    pub(super) trial_powers: Vec<f64>,
    /// Work of the constraint forces in a step, for each integral.
    pub(super) work: Vec<f64>,
    /// Accelerations at the beginning of the step before the last, at the beginning of the last, and at its
    /// end.
    pub(super) earlier: Vec<f64>,
    pub(super) first: Vec<f64>,
    pub(super) second: Vec<f64>,
    /// Accelerations in the first half of a step, and whether they are kept: where constraints are not linear, these
    /// are others than those at the end of the step before.
    pub(super) departure: Vec<f64>,
    pub(super) is_curved: bool,
    /// Size of the step before the last.
    pub(super) step_before: Option<f64>,
    /// Velocities in the middle of a step, and extrapolated to its end.
    pub(super) middle: Vec<f64>,
    pub(super) extrapolated: Vec<f64>,
    /// 1/(rtol |y| + atol) for displacements and velocities.
    pub(super) weights: Vec<f64>,
    pub(super) statistics: Statistics,
}

impl<S: SecondOrder> CentralDifference<S> {
    /// Starts at time `t` from `y` = (u, v, integrals).
    ///
    /// Of the options, `initial_step` and `max_step` shorten steps that stability would allow; tolerances
    /// of the integrals are not used, for nothing depends on them.
    ///
    /// # Errors
    /// [`Error::Input`] names what cannot be used; [`Error::Integration`] if forces or constraints cannot be
    /// evaluated at the start.
    pub fn new(system: S, t: f64, y: &[f64], options: &ExplicitOptions) -> Result<Self, Error> {
        check_start(t, y)?;
        options.check(y)?;
        let integrals = system.integrals();
        let both = y.len().saturating_sub(integrals);
        if both == 0 || !both.is_multiple_of(2) {
            let help = format!("as many displacements as velocities, and {integrals} integrals");
            return Err(Error::input("length of y0", y.len(), help));
        }
        let n = both / 2;
        let (zeros, none) = (vec![0.0; n], vec![0.0; integrals]);
        let is_curved = system.is_curved();
        let mut solver = Self {
            system,
            n,
            options: options.clone(),
            control: Control::new(t, f64::INFINITY, f64::INFINITY),
            stability: Stability::new(),
            stop_time: None,
            t,
            t_before: t,
            y: y.to_vec(),
            y_before: y.to_vec(),
            rest: None,
            output: y.to_vec(),
            force: zeros.clone(),
            trial_force: zeros.clone(),
            powers: none.clone(),
            trial_powers: none.clone(),
            work: none,
            earlier: zeros.clone(),
            first: zeros.clone(),
            second: zeros.clone(),
            departure: vec![0.0; if is_curved { n } else { 0 }],
            is_curved,
            step_before: None,
            middle: zeros.clone(),
            extrapolated: zeros,
            weights: vec![0.0; 2 * n],
            statistics: Statistics::default(),
        };
        solver.reinit(t, y)?;
        Ok(solver)
    }

    fn advance(&mut self, towards: f64) -> Result<(), Error> {
        let longest = self.max_step();
        let Self { system, stability, t, y, force, second, .. } = self;
        let step = *t - self.t_before;
        if let Some(limit) = stability.update(system, *t, y, force, second, step) {
            self.control.set_limit(*t, limit.min(longest));
        }
        self.step_before = (step > 0.0).then_some(step);
        match self.is_curved {
            true => swap(&mut self.earlier, &mut self.departure),
            false => swap(&mut self.earlier, &mut self.first),
        }
        swap(&mut self.first, &mut self.second);
        // until this step succeeds there is nothing to interpolate in
        (self.t_before, self.rest) = (self.t, None);
        let mut setback = None;
        loop {
            let t = self.t;
            let next = self.control.next(t, towards);
            let h = next - t;
            if t + 0.1 * h == t {
                return Err(match setback {
                    Some(setback) => stopped(setback, t, h),
                    None => failure(Cause::ErrorTest, t, h).into(),
                });
            }
            match self.try_step(next, h) {
                Ok(error) if error <= 1.0 => {
                    self.accept(next, h, error);
                    return Ok(());
                }
                Ok(error) => {
                    self.statistics.error_test_failures += 1;
                    self.control.reject(t, error);
                    // a step that is too long to be stable shows by errors that grow from step to step
                    let limit = self.longest_step();
                    self.control.set_limit(t, limit);
                }
                Err(refusal @ Failure::Recoverable(_)) => {
                    self.statistics.refused_steps += 1;
                    self.control.refuse(t);
                    setback = Some(refusal);
                }
                Err(failure) => return Err(stopped(failure, t, h)),
            }
        }
    }

    /// The longest step that is stable at the present state, and allowed.
    fn longest_step(&mut self) -> f64 {
        self.stability.limit(&mut self.system, self.t, &self.y).min(self.max_step())
    }

    /// From now on takes steps of size `h`, whatever the stability.
    #[cfg(test)]
    pub(crate) fn fix_steps(&mut self, h: f64) {
        self.control.fix_steps(self.t, h);
        self.stability.freeze();
    }

    fn accept(&mut self, next: f64, h: f64, error: f64) {
        swap(&mut self.y, &mut self.y_before);
        swap(&mut self.force, &mut self.trial_force);
        swap(&mut self.powers, &mut self.trial_powers);
        self.t = next;
        self.control.accept(next, error);
        self.statistics.steps += 1;
        self.statistics.last_step = h;
        if self.statistics.steps.is_multiple_of(KEPT) {
            self.update_weights();
        }
    }

    fn update_weights(&mut self) {
        self.options.tolerances.weigh(&self.y, &mut self.weights);
    }

    fn max_step(&self) -> f64 {
        self.options.steps.max_step.unwrap_or(f64::INFINITY)
    }

    /// The state within the last step: cubic in u and in v, each with its own derivative at both ends, linear
    /// in the integrals. Known components have their prescribed values at that time.
    fn interpolate_state(&mut self, t: f64, y: &mut [f64]) -> Result<(), Error> {
        if t == self.t {
            y.copy_from_slice(&self.y);
            return Ok(());
        }
        let (n, h) = (self.n, self.t - self.t_before);
        let s = (t - self.t_before) / h;
        let hermite = Hermite::new(s, h);
        let (before, after) = (&self.y_before, &self.y);
        for i in 0..n {
            y[i] = hermite.at(before[i], before[n + i], after[i], after[n + i]);
            y[n + i] = hermite.at(before[n + i], self.first[i], after[n + i], self.second[i]);
        }
        for i in 2 * n..y.len() {
            y[i] = before[i] + s * (after[i] - before[i]);
        }
        let (u, v) = y[..2 * n].split_at_mut(n);
        self.system.prescribe(t, u, v).map_err(|failure| stopped(failure, t, h))
    }

    /// Result of a call.
    fn reached(&mut self) -> Reached {
        let t = self.t();
        match self.stop_time.take_if(|stop| *stop == t) {
            Some(_) => {
                self.control.set_end(self.t, f64::INFINITY);
                Reached::StopTime
            }
            None => Reached::Time,
        }
    }
}

impl<S: SecondOrder> Integrator for CentralDifference<S> {
    type System = S;

    fn t(&self) -> f64 {
        self.rest.unwrap_or(self.t)
    }

    fn y(&self) -> &[f64] {
        if self.rest.is_some() { &self.output } else { &self.y }
    }

    fn solve_to(&mut self, t: f64) -> Result<Reached, Error> {
        check_target(t, "the last step began at", self.t_before)?;
        let first = self.statistics.steps;
        while self.t < t && self.stop_time != Some(self.t) {
            let steps = self.statistics.steps - first;
            if steps == u64::from(self.options.steps.max_steps) {
                let cause = Cause::TooManySteps { steps, target: t, notice: self.notice() };
                return Err(failure(cause, self.t, self.statistics.last_step).into());
            }
            self.advance(t)?;
        }
        self.rest = None;
        if t < self.t {
            let mut output = take(&mut self.output);
            let interpolated = self.interpolate_state(t, &mut output);
            self.output = output;
            interpolated?;
            self.rest = Some(t);
        }
        Ok(self.reached())
    }

    fn step(&mut self, towards: f64) -> Result<Reached, Error> {
        check_target(towards, "it lies behind", self.t())?;
        if towards == self.t() {
            return Ok(Reached::Time);
        }
        if self.rest.take().is_none() {
            self.advance(towards)?;
        }
        Ok(self.reached())
    }

    fn last_step(&self) -> (f64, f64) {
        (self.t_before, self.t)
    }

    fn last_order(&self) -> u32 {
        ORDER
    }

    /// Hermite's cubic polynomials; prescribed components are evaluated at the time itself.
    fn interpolant_degree(&self) -> u32 {
        3
    }

    fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        check_length("length of out", out.len(), self.y.len())?;
        if derivative > 0 {
            return Err(Error::input("derivative", derivative, "only the state itself is known"));
        }
        if !(self.t_before <= t && t <= self.t) {
            let help = format!("it lies outside the last step, [{}, {}]", self.t_before, self.t);
            return Err(Error::input("t", t, help));
        }
        self.interpolate_state(t, out)
    }

    /// Steps up to the stop time are equal, unless accuracy or stability requires others.
    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), Error> {
        if let Some(stop) = t {
            check_stop_time(stop, self.t, self.t())?;
        }
        self.stop_time = t;
        self.control.set_end(self.t, t.unwrap_or(f64::INFINITY));
        Ok(())
    }

    fn reinit(&mut self, t: f64, y: &[f64]) -> Result<(), Error> {
        check_length("length of y", y.len(), self.y.len())?;
        check_start_time("t", t)?;
        check_finite("y", y)?;
        let (u, v) = (&y[..self.n], &y[self.n..2 * self.n]);
        let begun = self.system.start(t, u, v);
        begun
            .and_then(|()| call::forces(&mut self.system, t, u, v, &mut self.force))
            .map_err(|failure| stopped(failure, t, 0.0))?;
        call::powers(&mut self.system, v, &mut self.powers);
        (self.t, self.t_before, self.rest, self.step_before) = (t, t, None, None);
        self.y.copy_from_slice(y);
        self.update_weights();
        self.stability = Stability::new();
        let limit = self.longest_step();
        let first = self.options.steps.initial_step.unwrap_or(f64::INFINITY);
        self.control = Control::new(t, first, limit);
        self.stop_time = None;
        self.statistics = Statistics { evaluations: 1, ..Statistics::default() };
        Ok(())
    }

    /// There are none in a system of second order.
    fn roots_found(&self) -> &[i32] {
        &[]
    }

    fn statistics(&self) -> Statistics {
        Statistics {
            last_order: ORDER,
            current_order: ORDER,
            current_time: self.t,
            ..self.statistics.clone()
        }
    }

    fn notice(&self) -> Option<String> {
        self.stability.notice()
    }

    fn system(&self) -> &S {
        &self.system
    }

    fn system_mut(&mut self) -> &mut S {
        &mut self.system
    }

    fn into_system(self) -> S {
        self.system
    }
}

/// The error for a failure of the system on a step from time `t`.
fn stopped(refusal: Failure, t: f64, step: f64) -> Error {
    let callback = Callback::Forces;
    match refusal {
        Failure::Recoverable(message) => {
            failure(Cause::Rejected { callback, t: t + step, message }, t, step).into()
        }
        Failure::Fatal(source) => {
            IntegrationError { source: Some(source), ..failure(Cause::Fatal(callback), t, step) }
                .into()
        }
    }
}

fn failure(cause: Cause, t: f64, step: f64) -> IntegrationError {
    let integrator = "central differences";
    IntegrationError {
        integrator,
        cause,
        t,
        step,
        order: ORDER,
        message: String::new(),
        source: None,
    }
}

/// Weights of values and slopes at both ends of a step, for a cubic in between.
struct Hermite {
    values: [f64; 2],
    slopes: [f64; 2],
}

impl Hermite {
    /// At the fraction `s` of a step of size `h`.
    fn new(s: f64, h: f64) -> Self {
        let r = 1.0 - s;
        Self {
            values: [r * r * (1.0 + 2.0 * s), s * s * (1.0 + 2.0 * r)],
            slopes: [h * s * r * r, -h * r * s * s],
        }
    }

    fn at(&self, y0: f64, slope0: f64, y1: f64, slope1: f64) -> f64 {
        let ([v0, v1], [s0, s1]) = (self.values, self.slopes);
        v0 * y0 + v1 * y1 + s0 * slope0 + s1 * slope1
    }
}

//! The integrator: its state, its steps and what a user may ask of it.

use std::mem::{swap, take};

use super::control::Control;
use super::stability::Stability;
use crate::ode::{Failure, SecondOrder};
use crate::rk::{Error, Options, Statistics};
use crate::sundials::Reached;

/// Steps in which the weights of the error norm are kept.
const KEPT: usize = 16;

/// Integrates M u'' = f(t, u, u') forward in time by central differences.
///
/// Steps are as long as stability and the tolerances allow, and equal for as long as they can be; one
/// evaluation of the forces each. Stepping allocates nothing.
#[derive(Debug)]
pub struct CentralDifference<S> {
    pub(super) system: S,
    options: Options,
    /// Number of displacements.
    pub(super) n: usize,
    control: Control,
    stability: Stability,
    stop_time: Option<f64>,
    /// End and start of the last step; equal when there is nothing to interpolate in.
    pub(super) t: f64,
    t_before: f64,
    /// Time within the last step at which the last call came to rest, unless at its end, and the state
    /// there.
    rest: Option<f64>,
    output: Vec<f64>,
    /// (u, v, integrals) at t, and at `t_before`: room for a trial, in between.
    pub(super) y: Vec<f64>,
    pub(super) y_before: Vec<f64>,
    /// Forces at t.
    pub(super) force: Vec<f64>,
    pub(super) trial_force: Vec<f64>,
    /// Time derivatives of the integrals at t, constraints left out.
    pub(super) powers: Vec<f64>,
    pub(super) trial_powers: Vec<f64>,
    /// What the constraints add to the integrals in a step.
    pub(super) work: Vec<f64>,
    /// Accelerations at the beginning of the step before the last, at that of the last, and at its end.
    pub(super) earlier: Vec<f64>,
    pub(super) first: Vec<f64>,
    pub(super) second: Vec<f64>,
    /// Size of the step before the last.
    pub(super) step_before: Option<f64>,
    /// Velocities in the middle of a step, and extrapolated to its end.
    pub(super) middle: Vec<f64>,
    pub(super) extrapolated: Vec<f64>,
    atol: Vec<f64>,
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
    /// [`Error::BadInput`] names what cannot be worked with; forces or constraints that have no meaning at
    /// the start.
    pub fn new(system: S, t: f64, y: &[f64], options: &Options) -> Result<Self, Error> {
        let integrals = system.integrals();
        let both = y.len().saturating_sub(integrals);
        if both == 0 || !both.is_multiple_of(2) {
            let mend = format!("as many displacements as velocities, and {integrals} integrals");
            return Err(Error::bad_input("length of y", y.len(), mend));
        }
        let (n, atol) = (both / 2, options.check(y.len())?);
        let (zeros, none) = (vec![0.0; n], vec![0.0; integrals]);
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
            step_before: None,
            middle: zeros.clone(),
            extrapolated: zeros,
            atol,
            weights: vec![0.0; 2 * n],
            statistics: Statistics::default(),
        };
        solver.reinit(t, y)?;
        solver.set_stop_time(options.stop_time)?;
        Ok(solver)
    }

    /// Starts again at time `t` from `y`, with the same options and allocations, as after a jump of the
    /// state or of the system. Counters start at zero; a stop time is forgotten.
    ///
    /// # Errors
    /// [`Error::BadInput`] if `t` or `y` is not finite or `y` has the wrong length; forces or constraints that
    /// have no meaning there.
    pub fn reinit(&mut self, t: f64, y: &[f64]) -> Result<(), Error> {
        self.check_length("length of y", y)?;
        if !t.is_finite() {
            return Err(Error::bad_input("t", t, "give a finite time"));
        }
        if let Some(i) = y.iter().position(|y| !y.is_finite()) {
            return Err(Error::bad_input(format!("component {i} of y"), y[i], FINITE));
        }
        let (u, v) = (&y[..self.n], &y[self.n..2 * self.n]);
        let begun = self.system.start(t, u, v);
        begun
            .and_then(|()| self.system.forces(t, u, v, &mut self.force))
            .map_err(|failure| stopped(failure, t, 0.0))?;
        self.system.powers(v, &mut self.powers);
        (self.t, self.t_before, self.rest, self.step_before) = (t, t, None, None);
        self.y.copy_from_slice(y);
        self.update_weights();
        self.stability = Stability::new();
        let limit = self.longest_step();
        let first = self.options.initial_step.unwrap_or(f64::INFINITY);
        self.control = Control::new(t, first, limit);
        self.stop_time = None;
        self.statistics = Statistics { rhs_evaluations: 1, ..Statistics::default() };
        Ok(())
    }

    /// Sets, moves or (`None`) lifts the time that no step passes and that is hit exactly. Steps up to it
    /// are equal, unless the motion asks for others.
    ///
    /// # Errors
    /// [`Error::BadInput`] when it lies before the end of the last step.
    pub fn set_stop_time(&mut self, stop_time: Option<f64>) -> Result<(), Error> {
        if let Some(stop) = stop_time
            && !(stop >= self.t && stop.is_finite())
        {
            let mend = format!("the steps have reached {}: give a later time", self.t);
            return Err(Error::bad_input("stop_time", stop, mend));
        }
        self.stop_time = stop_time;
        self.control.set_end(self.t, stop_time.unwrap_or(f64::INFINITY));
        Ok(())
    }

    /// Integrates to time `t`, or to the stop time if it comes first.
    ///
    /// Steps go past `t`, but never past the stop time; so output times do not change the steps.
    ///
    /// # Errors
    /// Any [`Error`]; `BadInput` when `t` lies before the last step or beyond the stop time.
    pub fn solve_to(&mut self, t: f64) -> Result<Reached, Error> {
        if !(t >= self.t_before && t.is_finite()) {
            let mend =
                format!("the last step began at {}: integration goes forward", self.t_before);
            return Err(Error::bad_input("t", t, mend));
        }
        if let Some(stop) = self.stop_time.filter(|stop| t > *stop) {
            let mend = format!("it lies beyond the stop time {stop}: set a later one");
            return Err(Error::bad_input("t", t, mend));
        }
        let first = self.statistics.steps;
        while self.t < t {
            let steps = self.statistics.steps - first;
            if steps == self.options.max_steps {
                let step = self.statistics.last_step;
                let stability_limited = None;
                return Err(Error::TooManySteps {
                    t: self.t,
                    step,
                    target: t,
                    steps,
                    stability_limited,
                });
            }
            self.advance(t)?;
        }
        self.rest = None;
        if t < self.t {
            let mut output = take(&mut self.output);
            let interpolated = self.interpolate(t, &mut output);
            self.output = output;
            interpolated?;
            self.rest = Some(t);
        }
        Ok(self.reached())
    }

    /// Takes one step in the direction of time `towards`, which the step may pass. After a
    /// [`solve_to`](Self::solve_to) that came to rest within a step, goes on to the end of that step.
    ///
    /// # Errors
    /// Any [`Error`] but `TooManySteps`; `BadInput` when `towards` lies behind, or the stop time has been
    /// reached.
    pub fn step(&mut self, towards: f64) -> Result<Reached, Error> {
        if self.rest.take().is_none() {
            self.advance(towards)?;
        }
        Ok(self.reached())
    }

    fn reached(&self) -> Reached {
        match self.stop_time == Some(self.t()) {
            true => Reached::StopTime,
            false => Reached::Time,
        }
    }

    fn advance(&mut self, towards: f64) -> Result<(), Error> {
        if self.stop_time.is_some_and(|stop| self.t >= stop) {
            let mend = "it has been reached: set a later one to go on";
            return Err(Error::bad_input("stop_time", self.t, mend));
        }
        if !(towards > self.t && towards.is_finite()) {
            let mend = format!("the steps have reached {}: integration goes forward", self.t);
            return Err(Error::bad_input("towards", towards, mend));
        }
        let Self { system, stability, t, y, force, second, .. } = self;
        let step = *t - self.t_before;
        if let Some(limit) = stability.update(system, *t, y, force, second, step) {
            self.control.set_limit(*t, limit.min(self.options.max_step));
        }
        self.step_before = (step > 0.0).then_some(step);
        swap(&mut self.earlier, &mut self.first);
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
                    Some(message) => Error::Refused { t, step: h, message },
                    None => Error::StepUnderflow { t, step: h },
                });
            }
            match self.try_step(next, h) {
                Ok(error) if error <= 1.0 => {
                    self.accept(next, h, error);
                    return Ok(());
                }
                Ok(error) => {
                    self.statistics.rejected_steps += 1;
                    self.control.reject(t, error);
                    // errors that grow from step to step are how a step that is too long shows
                    let limit = self.longest_step();
                    self.control.set_limit(t, limit);
                }
                Err(Failure::Recoverable(reason)) => {
                    self.statistics.refused_steps += 1;
                    self.control.refuse(t);
                    setback = Some(reason);
                }
                Err(failure) => return Err(stopped(failure, t, h)),
            }
        }
    }

    /// The longest step that is stable at the present state, and allowed.
    fn longest_step(&mut self) -> f64 {
        self.stability.limit(&mut self.system, self.t, &self.y).min(self.options.max_step)
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
        for ((weight, y), atol) in self.weights.iter_mut().zip(&self.y).zip(&self.atol) {
            *weight = 1.0 / (self.options.rtol * y.abs() + atol);
        }
    }

    /// Writes the state at a time within the [last step](Self::last_step): cubic in u and in v, each with
    /// its own derivative at both ends, linear in the integrals. Known components are what they are at
    /// that time.
    ///
    /// # Errors
    /// [`Error::BadInput`] when `t` lies outside the last step or `y` has another length; constraints that
    /// have no meaning at `t`.
    pub fn interpolate(&mut self, t: f64, y: &mut [f64]) -> Result<(), Error> {
        self.check_length("length of y", y)?;
        if !(self.t_before <= t && t <= self.t) {
            let mend = format!("it lies outside the last step, [{}, {}]", self.t_before, self.t);
            return Err(Error::bad_input("t", t, mend));
        }
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

    /// Time of the state [`y`](Self::y).
    pub fn t(&self) -> f64 {
        self.rest.unwrap_or(self.t)
    }

    /// The state (u, v, integrals) at time [`t`](Self::t).
    pub fn y(&self) -> &[f64] {
        if self.rest.is_some() { &self.output } else { &self.y }
    }

    /// Start and end of the last step: the times between which [`interpolate`](Self::interpolate)
    /// works. Before the first step both are the start.
    pub fn last_step(&self) -> (f64, f64) {
        (self.t_before, self.t)
    }

    /// What has been done so far; evaluations are those of the forces.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// What there is to say about the steps: that energy grew by itself, or that decay rates, which
    /// implicit methods do not mind, bound them.
    pub fn notice(&self) -> Option<String> {
        self.stability.notice()
    }

    /// The system being integrated.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The system being integrated, to be changed. After a change that makes forces jump,
    /// [`reinit`](Self::reinit) is needed.
    pub fn system_mut(&mut self) -> &mut S {
        &mut self.system
    }

    /// Ends the integration and hands the system back.
    pub fn into_system(self) -> S {
        self.system
    }

    fn check_length(&self, input: &str, given: &[f64]) -> Result<(), Error> {
        let length = self.y.len();
        if given.len() == length {
            return Ok(());
        }
        Err(Error::bad_input(input, given.len(), format!("the state has {length} components")))
    }
}

const FINITE: &str = "give a finite state";

/// Why forces or constraints end the integration in a step of size `step` from `t`.
fn stopped(failure: Failure, t: f64, step: f64) -> Error {
    match failure {
        Failure::Recoverable(message) => Error::Refused { t, step, message },
        Failure::Fatal(source) => Error::Rhs { t, step, source },
    }
}

/// Weights of values and slopes at both ends of a step, for a cubic in between.
struct Hermite {
    values: [f64; 2],
    slopes: [f64; 2],
}

impl Hermite {
    /// At the part `s` of a step of size `h`.
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

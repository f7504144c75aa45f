//! The integrator: its state, its steps and what a user may ask of it.

use std::mem::take;

use super::control::{Controller, StabilityMonitor};
use super::roots::Roots;
use super::stages::Setback;
use super::tableau::{self, STAGES, advance};
use super::{Error, ORDER, Options, Statistics};
use crate::ode::Ode;
use crate::sundials::Reached;

/// Integrates y' = f(t, y) forward in time with the Dormand-Prince pair of order 5(4).
///
/// Steps of automatic size keep the local error within tolerance; six evaluations of the
/// right-hand side each. Solutions between the ends of a step come from a continuous extension of
/// order 4, so asking for output does not change the steps, and there root functions are followed,
/// as in CVODE. Stepping allocates nothing.
#[derive(Debug)]
pub struct DormandPrince<S: Ode> {
    pub(super) system: S,
    pub(super) options: Options,
    pub(super) atol: Vec<f64>,
    /// Weights of the error norm.
    pub(super) weight: Vec<f64>,
    pub(super) stop_time: Option<f64>,
    /// End of the last accepted step and the solution there.
    pub(super) t: f64,
    pub(super) y: Vec<f64>,
    /// Start of the last accepted step; equal to `t` when there is nothing to interpolate in.
    pub(super) t_old: f64,
    pub(super) y_old: Vec<f64>,
    /// Stage derivatives. Between steps the first and the last have changed places: `k[0]` is
    /// f(t, y), `k[6]` is f(t_old, y_old).
    pub(super) k: [Vec<f64>; STAGES],
    /// Whether `k[0]` is f(t, y).
    pub(super) slope_known: bool,
    /// Argument of a stage; stage 6 is the last to use it.
    pub(super) argument: Vec<f64>,
    /// Time within the last step at which the last call came to rest, unless at its end, and the
    /// solution there.
    rest: Option<f64>,
    output: Vec<f64>,
    pub(super) roots: Roots,
    /// Size of the next step, once known.
    pub(super) next_step: Option<f64>,
    pub(super) controller: Controller,
    pub(super) monitor: StabilityMonitor,
    pub(super) statistics: Statistics,
}

impl<S: Ode> DormandPrince<S> {
    /// Starts at y(t) = `y`; the length of `y` is the number n of equations.
    ///
    /// The right-hand side is first called by the first step.
    ///
    /// # Errors
    /// [`Error::BadInput`] names the option or component that cannot be worked with.
    pub fn new(system: S, t: f64, y: &[f64], options: &Options) -> Result<Self, Error> {
        let n = y.len();
        if n == 0 {
            return Err(Error::bad_input("length of y", 0, "give at least one component"));
        }
        check_state(t, y)?;
        let atol = options.check(n)?;
        let mut solver = Self {
            options: options.clone(),
            atol,
            weight: vec![0.0; n],
            stop_time: None,
            t,
            y: y.to_vec(),
            t_old: t,
            y_old: vec![0.0; n],
            k: std::array::from_fn(|_| vec![0.0; n]),
            slope_known: false,
            argument: vec![0.0; n],
            rest: None,
            output: vec![0.0; n],
            roots: Roots::new(system.root_count()),
            next_step: options.initial_step,
            controller: Controller::new(),
            monitor: StabilityMonitor::default(),
            statistics: Statistics::default(),
            system,
        };
        solver.update_weight();
        solver.set_stop_time(options.stop_time)?;
        Ok(solver)
    }

    /// Starts again at y(t) = `y` (same length as before), as after a jump in the system or state.
    ///
    /// Keeps tolerances, limits and allocations; clears the statistics and the stop time.
    ///
    /// # Errors
    /// [`Error::BadInput`] when `y` has another length, or `t` or a component is not finite.
    pub fn reinit(&mut self, t: f64, y: &[f64]) -> Result<(), Error> {
        self.check_length("length of y", y)?;
        check_state(t, y)?;
        (self.t, self.t_old) = (t, t);
        self.y.copy_from_slice(y);
        self.rest = None;
        self.update_weight();
        self.roots.restart();
        self.stop_time = None;
        self.slope_known = false;
        self.next_step = self.options.initial_step;
        self.controller = Controller::new();
        self.monitor = StabilityMonitor::default();
        self.statistics = Statistics::default();
        Ok(())
    }

    /// Sets, moves or (`None`) lifts the time that no step passes; see [`Options::stop_time`].
    ///
    /// # Errors
    /// [`Error::BadInput`] when it lies before `t()`: integration goes forward.
    pub fn set_stop_time(&mut self, stop_time: Option<f64>) -> Result<(), Error> {
        if let Some(stop) = stop_time
            && (stop.is_nan() || stop < self.t)
        {
            let mend = format!("it lies before t = {}: {FORWARD_ONLY}", self.t);
            return Err(Error::bad_input("stop_time", stop, mend));
        }
        self.stop_time = stop_time;
        Ok(())
    }

    /// Integrates to time `t`, or to a root or the stop time if one comes first.
    ///
    /// Steps go past `t`, but never past the stop time; so output times do not change the steps.
    ///
    /// # Errors
    /// Any [`Error`]; `BadInput` when `t` lies before the last step or beyond the stop time.
    pub fn solve_to(&mut self, t: f64) -> Result<Reached, Error> {
        if !(t >= self.t_old && t.is_finite()) {
            let mend = format!("the last step began at {}: {FORWARD_ONLY}", self.t_old);
            return Err(Error::bad_input("t", t, mend));
        }
        if let Some(stop) = self.stop_time.filter(|stop| t > *stop) {
            let mend = format!("it lies beyond the stop time {stop}: set a later one");
            return Err(Error::bad_input("t", t, mend));
        }
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
            if self.t >= t {
                self.rest_at(t);
                return Ok(self.reached());
            }
            let steps = self.statistics.steps - first;
            if steps == self.options.max_steps {
                return Err(Error::TooManySteps {
                    t: self.t,
                    step: self.statistics.last_step,
                    target: t,
                    steps,
                    stability_limited: self.monitor.limit(),
                });
            }
            self.advance()?;
        }
    }

    /// Takes one step of automatic size, shortened only to hit the stop time, or stops at a root within
    /// it. After a call that came to rest within a step, goes on to the end of that step first.
    ///
    /// # Errors
    /// Any [`Error`] but `TooManySteps`; `BadInput` when the stop time has been reached.
    pub fn step(&mut self) -> Result<Reached, Error> {
        self.pass_root()?;
        if self.rest.is_none() {
            self.advance()?;
        }
        let root = self.find_root(self.t)?;
        self.rest_at(root.unwrap_or(self.t));
        Ok(root.map_or(self.reached(), |_| Reached::Root))
    }

    fn reached(&self) -> Reached {
        match self.stop_time == Some(self.t()) {
            true => Reached::StopTime,
            false => Reached::Time,
        }
    }

    /// Has `t()` and `y()` tell the state at a time within the last step.
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
        if self.stop_time.is_some_and(|stop| self.t >= stop) {
            let mend = "it has been reached: set a later one to go on";
            return Err(Error::bad_input("stop_time", self.t, mend));
        }
        self.rest = None;
        // Until this step succeeds there is nothing to interpolate in: its stages overwrite the
        // last one's.
        self.t_old = self.t;
        if !self.slope_known {
            self.evaluate_slope()?;
        }
        let planned = match self.next_step {
            Some(step) => step,
            None => self.estimate_initial_step()?,
        };
        let mut setback = None;
        let mut h = planned.min(self.options.max_step);
        self.start_roots(self.stop_time.map_or(h, |stop| h.min(stop - self.t)))?;
        loop {
            // A step may stretch by 1 % to hit the stop time rather than leave a sliver.
            let stop = self.stop_time.filter(|stop| self.t + 1.01 * h >= *stop);
            if stop.is_none() && self.t + 0.1 * h == self.t {
                self.next_step = None;
                return Err(match setback {
                    Some(setback) => Setback::into_error(setback, self.t, h),
                    None => Error::StepUnderflow { t: self.t, step: h },
                });
            }
            let t_new = stop.unwrap_or(self.t + h);
            let step = t_new - self.t;
            let error = match self.try_step(t_new, step)? {
                Ok(error) => error,
                Err(reason) => {
                    self.statistics.refused_steps += 1;
                    setback = Some(reason);
                    h = self.controller.refuse(step);
                    continue;
                }
            };
            if error > 1.0 {
                self.statistics.rejected_steps += 1;
                setback = None;
                h = self.controller.reject(step, error);
                continue;
            }
            let proposed = self.controller.accept(step, error);
            // A step cut short by the stop time says nothing against the one that was planned.
            self.next_step = Some(if stop.is_some() { proposed.max(h) } else { proposed });
            self.accept(t_new, step);
            return Ok(());
        }
    }

    /// Writes the `derivative`-th time derivative of the solution at time `t`, within the
    /// [last step](Self::last_step), into `out`: 0 for the state itself, of order 4, or 1 for the
    /// derivative of that, of order 3, which is f(t, y) at both ends of the step.
    ///
    /// L. F. Shampine, Math. Comp. 46 (1986) 135-150; HNW I, section II.6.
    ///
    /// # Errors
    /// [`Error::BadInput`] when t lies outside the last step, when `derivative` is above 1, or 1 before
    /// the first step, or when `out` has another length.
    pub fn interpolate(&self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        self.check_length("length of out", out)?;
        if !(self.t_old <= t && t <= self.t) {
            let mend = format!("it lies outside the last step, [{}, {}]", self.t_old, self.t);
            return Err(Error::bad_input("t", t, mend));
        }
        match derivative {
            0 => self.interpolate_state(t, out),
            1 if self.t_old < self.t => self.interpolate_slope(t, out),
            1 => return Err(Error::bad_input("derivative", 1, "take a step first")),
            _ => return Err(Error::bad_input("derivative", derivative, "give 0 or 1")),
        }
        Ok(())
    }

    pub(super) fn interpolate_state(&self, t: f64, y: &mut [f64]) {
        if t == self.t {
            y.copy_from_slice(&self.y);
        } else {
            let h = self.t - self.t_old;
            let weights = tableau::dense_weights((t - self.t_old) / h);
            advance(y, &self.y_old, h, weights, self.last_stages());
        }
    }

    fn interpolate_slope(&self, t: f64, ydot: &mut [f64]) {
        let weights = tableau::dense_derivative_weights((t - self.t_old) / (self.t - self.t_old));
        let k = self.last_stages();
        for (i, slope) in ydot.iter_mut().enumerate() {
            *slope = weights.iter().zip(k).map(|(weight, k)| weight * k[i]).sum();
        }
    }

    /// Time of the state [`y`](Self::y).
    pub fn t(&self) -> f64 {
        self.rest.unwrap_or(self.t)
    }

    /// The state at time [`t`](Self::t).
    pub fn y(&self) -> &[f64] {
        if self.rest.is_some() { &self.output } else { &self.y }
    }

    /// Start and end of the last step: the times between which [`interpolate`](Self::interpolate)
    /// works. Before the first step both are the start.
    pub fn last_step(&self) -> (f64, f64) {
        (self.t_old, self.t)
    }

    /// Order of the steps.
    pub fn last_order(&self) -> u32 {
        ORDER
    }

    /// After [`Reached::Root`]: for each root function 0, or the sign of its change where it has a root
    /// at the present time: +1 rising, -1 falling.
    pub fn roots_found(&self) -> &[i32] {
        &self.roots.found
    }

    /// What has been done so far.
    pub fn statistics(&self) -> Statistics {
        Statistics {
            stability_limited_steps: self.monitor.limited_steps(),
            stability_limited: self.monitor.limit(),
            ..self.statistics
        }
    }

    /// The system being integrated.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The system being integrated, to be changed; the next step evaluates it afresh.
    ///
    /// After a change that makes the solution jump or kink, [`reinit`](Self::reinit) also chooses
    /// the step size afresh.
    pub fn system_mut(&mut self) -> &mut S {
        self.slope_known = false;
        &mut self.system
    }

    /// Ends the integration and hands the system back.
    pub fn into_system(self) -> S {
        self.system
    }

    /// Stages 1, 3, 4, 5, 6, 7 of the last accepted step.
    fn last_stages(&self) -> [&[f64]; 6] {
        let [last, _, k3, k4, k5, k6, first] = &self.k;
        [first, k3, k4, k5, k6, last]
    }

    fn check_length(&self, input: &str, given: &[f64]) -> Result<(), Error> {
        let n = self.y.len();
        if given.len() != n {
            let mend = format!("the state has {n} components");
            return Err(Error::bad_input(input, given.len(), mend));
        }
        Ok(())
    }
}

const FORWARD_ONLY: &str =
    "integration goes forward only; to go back, integrate dy/ds = -f(-s, y) with s = -t";

fn check_state(t: f64, y: &[f64]) -> Result<(), Error> {
    if !t.is_finite() {
        return Err(Error::bad_input("t", t, "give a finite time"));
    }
    if let Some(i) = y.iter().position(|value| !value.is_finite()) {
        return Err(Error::bad_input(format!("component {i} of y"), y[i], "give a finite state"));
    }
    Ok(())
}

//! The integrator: its state, its steps and what a user may ask of it.

use std::mem::swap;

use super::Statistics;
use super::control::Control;
use super::stability::Stability;
use crate::ode::{Failure, SecondOrder};

type Failed = Box<dyn std::error::Error + Send + Sync>;

/// Steps in which the weights of the error norm are kept.
const KEPT: usize = 16;

/// Integrates M u'' = f(t, u, u') forward in time by central differences.
pub(crate) struct CentralDifference<S> {
    pub(super) system: S,
    /// Number of displacements.
    pub(super) n: usize,
    control: Control,
    stability: Stability,
    pub(super) t: f64,
    t_before: f64,
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
    rtol: f64,
    atol: Vec<f64>,
    /// 1/(rtol |y| + atol) for displacements and velocities.
    pub(super) weights: Vec<f64>,
    pub(super) statistics: Statistics,
}

impl<S: SecondOrder> CentralDifference<S> {
    /// Starts at `t` with `y` = (u, v, integrals) and will stop at `end`; `atol` has a number for each
    /// unknown.
    ///
    /// # Errors
    /// Forces or constraints that have no meaning at the start.
    pub(crate) fn new(
        mut system: S,
        t: f64,
        end: f64,
        y: &[f64],
        rtol: f64,
        atol: Vec<f64>,
    ) -> Result<Self, Failed> {
        let integrals = system.integrals();
        let n = (y.len() - integrals) / 2;
        let (u, v) = (&y[..n], &y[n..2 * n]);
        let (mut force, mut powers) = (vec![0.0; n], vec![0.0; integrals]);
        system.start(t, u, v).map_err(Failure::into_error)?;
        system.forces(t, u, v, &mut force).map_err(Failure::into_error)?;
        system.powers(v, &mut powers);
        let mut stability = Stability::new();
        let limit = stability.limit(&mut system, t, y);
        let zeros = vec![0.0; n];
        let mut started = Self {
            n,
            control: Control::new(t, end, limit),
            stability,
            t,
            t_before: t,
            y: y.to_vec(),
            y_before: y.to_vec(),
            trial_force: force.clone(),
            force,
            trial_powers: powers.clone(),
            powers,
            work: vec![0.0; integrals],
            earlier: zeros.clone(),
            first: zeros.clone(),
            second: zeros.clone(),
            step_before: None,
            middle: zeros.clone(),
            extrapolated: zeros,
            rtol,
            weights: vec![0.0; 2 * n],
            atol,
            statistics: Statistics { evaluations: 1, ..Statistics::default() },
            system,
        };
        started.update_weights();
        Ok(started)
    }

    /// Takes no steps longer than `step` (s).
    pub(crate) fn max_step(mut self, step: f64) -> Self {
        self.control.set_longest(self.t, step);
        self
    }

    /// Takes one step and returns the time reached.
    ///
    /// # Errors
    /// What a force or constraint has to say that no smaller step helps against.
    pub(crate) fn step(&mut self) -> Result<f64, Failed> {
        let Self { system, stability, control, t, y, force, second, .. } = self;
        let step = *t - self.t_before;
        if let Some(limit) = stability.update(system, *t, y, force, second, step) {
            control.set_limit(*t, limit);
        }
        self.step_before = (step > 0.0).then_some(step);
        swap(&mut self.earlier, &mut self.first);
        swap(&mut self.first, &mut self.second);
        // until this step succeeds there is nothing to interpolate in
        self.t_before = self.t;
        let mut setback = None;
        loop {
            let (t, next) = (self.t, self.control.next());
            let h = next - t;
            if t + 0.1 * h == t {
                let reason = setback.unwrap_or_else(|| "the error does not get smaller".into());
                return Err(format!("the step has become too small, {h:e} s: {reason}").into());
            }
            match self.try_step(next, h) {
                Ok(error) if error <= 1.0 => {
                    self.accept(next, h, error);
                    return Ok(next);
                }
                Ok(error) => {
                    self.statistics.rejected_steps += 1;
                    self.control.reject(t, error);
                    // errors that grow from step to step are how a step that is too long shows
                    let limit = self.stability.limit(&mut self.system, t, &self.y);
                    self.control.set_limit(t, limit);
                }
                Err(Failure::Recoverable(reason)) => {
                    self.statistics.refused_steps += 1;
                    self.control.refuse(t);
                    setback = Some(reason);
                }
                Err(Failure::Fatal(error)) => return Err(error),
            }
        }
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
            *weight = 1.0 / (self.rtol * y.abs() + atol);
        }
    }

    /// The state at a time within the last step: cubic in u and in v, each with its own derivative at
    /// both ends, linear in the integrals.
    ///
    /// # Errors
    /// A time outside the last step, and constraints that have no meaning.
    pub(crate) fn interpolate(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failed> {
        if t == self.t {
            y.copy_from_slice(&self.y);
            return Ok(());
        }
        if !(self.t_before <= t && t <= self.t) {
            let last = format!("the last step, [{}, {}]", self.t_before, self.t);
            return Err(format!("t = {t} lies outside {last}").into());
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
        self.system.prescribe(t, u, v).map_err(Failure::into_error)
    }

    /// The time reached.
    #[cfg(test)]
    pub(crate) fn t(&self) -> f64 {
        self.t
    }

    /// The state at the time reached.
    pub(crate) fn y(&self) -> &[f64] {
        &self.y
    }

    pub(crate) fn system(&self) -> &S {
        &self.system
    }

    pub(crate) fn system_mut(&mut self) -> &mut S {
        &mut self.system
    }

    pub(crate) fn into_system(self) -> S {
        self.system
    }

    pub(crate) fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// What there is to say about the steps.
    pub(crate) fn notice(&self) -> Option<String> {
        self.stability.notice()
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

//! Explicit central differences, in the form of velocity Verlet, with displacements u, velocities v
//! and forces f:
//!
//! ```text
//! w       = v_n + (h/2) M^-1 f_n
//! u_(n+1) = u_n + h w
//! f_(n+1) = f(t_(n+1), u_(n+1), 2 w - v_n)
//! v_(n+1) = w + (h/2) M^-1 f_(n+1)
//! ```
//!
//! One evaluation of the forces per step, order 2. Without damping the method is symplectic: a
//! modified energy is conserved, and the energy proper does not drift (T. Belytschko et al.,
//! *Nonlinear Finite Elements for Continua and Structures*, chapter 6; E. Hairer, C. Lubich, G. Wanner,
//! Acta Numerica 12 (2003) 399-450). It pays with lumped inertia, where M^-1 is no work.
//!
//! **Damping.** Viscous forces see the velocity 2 w - v_n = v_n + h v_n', extrapolated to the end of
//! the step. Taking w instead, as is often done, allows twice the step where damping rules, but makes the
//! method first order.
//!
//! **Stability.** For a vibration of frequency omega and damping rate r (u'' + r u' + omega^2 u = 0) the
//! growth factors s solve
//!
//! ```text
//! s (s - 1)^2 + (h r/2) (3 s - 1) (s - 1) + (h omega)^2 s^2 = 0,
//! ```
//!
//! and none exceeds 1 in size as long as (h omega)^2 + 4 h r <= 4, so up to
//!
//! ```text
//! h = 2 / (r + sqrt(r^2 + omega^2)).
//! ```
//!
//! The largest omega and the largest r, each by itself, make that a bound for a whole body.
//!
//! **Energies.** The kinetic energy changes in one step by h w . (f_n + f_(n+1))/2, but for a bounded
//! remainder. So the trapezoidal rule for the powers of damping and applied forces is the work that
//! these forces do in the scheme. That of the constraint forces is what the kicks book.

mod control;
mod guide;
mod kick;
mod stability;
#[cfg(test)]
mod tests;

use std::mem::swap;

use control::Control;
use guide::Guide;
use kick::{Kick, Mobility};
use stability::Stability;

use crate::ode::Failure;
use crate::system::System;

type Failed = Box<dyn std::error::Error + Send + Sync>;

/// Order of the method.
pub(crate) const ORDER: u32 = 2;

/// Steps in which the weights of the error norm are kept.
const KEPT: usize = 16;

/// What has been done so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Statistics {
    pub(crate) steps: usize,
    pub(crate) evaluations: usize,
    pub(crate) rejected_steps: usize,
    pub(crate) refused_steps: usize,
    pub(crate) last_step: f64,
}

/// The method at work on the equations of one phase.
pub(crate) struct CentralDifference {
    system: System,
    guide: Guide,
    mobility: Mobility,
    control: Control,
    stability: Stability,
    t: f64,
    t_before: f64,
    /// (u, v, energy dissipated, energy supplied) at t, and at `t_before`: room for a trial, in
    /// between.
    y: Vec<f64>,
    y_before: Vec<f64>,
    /// Sum of all forces at t.
    force: Vec<f64>,
    trial_force: Vec<f64>,
    /// Power dissipated and power supplied at t, constraints left out (W).
    powers: (f64, f64),
    trial_powers: (f64, f64),
    /// Accelerations at the beginning of the step before the last, at that of the last, and at its end.
    earlier: Vec<f64>,
    first: Vec<f64>,
    second: Vec<f64>,
    /// Size of the step before the last.
    step_before: Option<f64>,
    /// Velocities in the middle of a step, and extrapolated to its end.
    middle: Vec<f64>,
    extrapolated: Vec<f64>,
    rtol: f64,
    atol: Vec<f64>,
    /// 1/(rtol |y| + atol) for displacements and velocities.
    weights: Vec<f64>,
    statistics: Statistics,
}

impl CentralDifference {
    /// Starts at `t` with `y` = (u, v, energies) and will stop at `end`; `atol` has a number for each
    /// unknown.
    ///
    /// # Errors
    /// Forces or paths that have no meaning at the start.
    pub(crate) fn new(
        mut system: System,
        t: f64,
        end: f64,
        y: &[f64],
        rtol: f64,
        atol: Vec<f64>,
    ) -> Result<Self, Failed> {
        let n = system.dofs();
        let (u, v) = (&y[..n], &y[n..2 * n]);
        let mut force = vec![0.0; n];
        system.forces(t, u, v, &mut force).map_err(Failure::into_error)?;
        let powers = system.force_powers(v);
        let guide = Guide::new(&system, t, u, v).map_err(Failure::into_error)?;
        let mut stability = Stability::new(&mut system);
        let limit = stability.limit(&mut system, t, y);
        let zeros = vec![0.0; n];
        let mut started = Self {
            guide,
            mobility: Mobility::new(&system),
            control: Control::new(t, end, limit),
            stability,
            t,
            t_before: t,
            y: y.to_vec(),
            y_before: y.to_vec(),
            trial_force: force.clone(),
            force,
            powers,
            trial_powers: powers,
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

    /// Takes one step and returns the time reached.
    ///
    /// # Errors
    /// What a force or path has to say that no smaller step helps against.
    pub(crate) fn step(&mut self) -> Result<f64, Failed> {
        let Self { system, stability, control, t, y, force, second, .. } = self;
        let step = *t - self.t_before;
        if let Some(limit) = stability.watch(system, *t, y, force, second, step) {
            control.set_limit(*t, limit);
        }
        self.step_before = (step > 0.0).then_some(step);
        swap(&mut self.earlier, &mut self.first);
        swap(&mut self.first, &mut self.second);
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

    /// Computes the state at `next`, `h` later, into `y_before`, and tells the error norm.
    fn try_step(&mut self, next: f64, h: f64) -> Result<f64, Failure> {
        let Self { system, guide, mobility, middle, extrapolated, .. } = self;
        let n = system.dofs();
        let (u, v) = (&self.y[..n], &self.y[n..2 * n]);
        let (u_next, rest) = self.y_before.split_at_mut(n);
        let (v_next, energies) = rest.split_at_mut(n);
        guide.aim(system, next)?;

        let half = 0.5 * h;
        let rates = guide.mean_rates(system, self.t, h)?;
        let kick = Kick { duration: half, force: &self.force, rates };
        // else those at the end of the step before
        if self.step_before.is_none() || !mobility.is_diagonal() {
            mobility.accelerations(system, &kick, v, &mut self.first);
        }
        let outputs = u_next.iter_mut().zip(&mut *middle).zip(&mut *extrapolated);
        for (((u_next, w), extrapolated), ((u, v), a)) in
            outputs.zip(u.iter().zip(v).zip(&self.first))
        {
            *w = v + half * a;
            *u_next = u + h * *w;
            *extrapolated = 2.0 * *w - v;
        }
        let mut supplied = mobility.lead(system, &kick, v, middle);
        guide.place(system, u_next, extrapolated);

        self.statistics.evaluations += 1;
        system.forces(next, u_next, extrapolated, &mut self.trial_force)?;
        let kick = Kick { duration: half, force: &self.trial_force, rates: &guide.rates };
        mobility.accelerations(system, &kick, middle, &mut self.second);
        let velocities = middle.iter().zip(&self.second);
        v_next.iter_mut().zip(velocities).for_each(|(v_next, (w, a))| *v_next = w + half * a);
        supplied += mobility.lead(system, &kick, middle, v_next);

        let powers = system.force_powers(v_next);
        energies[0] = self.y[2 * n] + 0.5 * h * (self.powers.0 + powers.0);
        energies[1] = self.y[2 * n + 1] + 0.5 * h * (self.powers.1 + powers.1) + supplied;
        self.trial_powers = powers;
        Ok(self.error_norm(h))
    }

    /// Root mean square, weighted by the tolerances, of the local errors
    ///
    /// ```text
    /// h^3 u'''/6 = h^2 (a_(n+1) - a_n)/6,    h^3 v'''/12 = h (a_(n+1) - 2 a_n + a_(n-1))/12
    /// ```
    fn error_norm(&self, h: f64) -> f64 {
        // differences of steps of different size; without a step before the first one will do
        let (ratio, scale) = match self.step_before {
            Some(before) => (h / before, 2.0 * h / (before + h)),
            None => (0.0, 1.0),
        };
        let [position, velocity] = self.squares(ratio);
        let (position, velocity) =
            (h * h / 6.0 * position.sqrt(), scale * h / 12.0 * velocity.sqrt());
        position.hypot(velocity) / (self.weights.len() as f64).sqrt()
    }

    /// Sums of the squares of the weighted differences in [`error_norm`](Self::error_norm).
    fn squares(&self, ratio: f64) -> [f64; 2] {
        let (position_weights, velocity_weights) = self.weights.split_at(self.first.len());
        let part = |first: f64, second: f64, earlier: f64, weights: [f64; 2]| {
            let ahead = second - first;
            let bend = ahead - ratio * (first - earlier);
            [(ahead * weights[0]).powi(2), (bend * weights[1]).powi(2)]
        };
        // in interleaved sums, for speed
        let (first, first_rest) = self.first.as_chunks::<4>();
        let (second, second_rest) = self.second.as_chunks::<4>();
        let (earlier, earlier_rest) = self.earlier.as_chunks::<4>();
        let (position, position_rest) = position_weights.as_chunks::<4>();
        let (velocity, velocity_rest) = velocity_weights.as_chunks::<4>();
        let mut sums = [[0.0; 4]; 2];
        for ((((f, s), e), p), v) in
            first.iter().zip(second).zip(earlier).zip(position).zip(velocity)
        {
            for k in 0..4 {
                let [position, velocity] = part(f[k], s[k], e[k], [p[k], v[k]]);
                sums[0][k] += position;
                sums[1][k] += velocity;
            }
        }
        let mut squares = sums.map(|sum| sum.iter().sum());
        let rest = first_rest.iter().zip(second_rest).zip(earlier_rest);
        for (((f, s), e), (p, v)) in rest.zip(position_rest.iter().zip(velocity_rest)) {
            let [position, velocity] = part(*f, *s, *e, [*p, *v]);
            squares[0] += position;
            squares[1] += velocity;
        }
        squares
    }

    fn accept(&mut self, next: f64, h: f64, error: f64) {
        swap(&mut self.y, &mut self.y_before);
        swap(&mut self.force, &mut self.trial_force);
        self.powers = self.trial_powers;
        (self.t_before, self.t) = (self.t, next);
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
    /// both ends, linear in the energies.
    pub(crate) fn interpolate(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failed> {
        let n = self.system.dofs();
        let (h, s) = (self.t - self.t_before, (t - self.t_before) / (self.t - self.t_before));
        let hermite = Hermite::new(s, h);
        let (before, after) = (&self.y_before, &self.y);
        for i in 0..n {
            y[i] = hermite.at(before[i], before[n + i], after[i], after[n + i]);
            y[n + i] = hermite.at(before[n + i], self.first[i], after[n + i], self.second[i]);
        }
        for i in 2 * n..y.len() {
            y[i] = before[i] + s * (after[i] - before[i]);
        }
        self.guide.aim(&self.system, t).map_err(Failure::into_error)?;
        let (u, v) = y.split_at_mut(n);
        self.guide.place(&self.system, u, v);
        Ok(())
    }

    /// The state at the time reached.
    pub(crate) fn y(&self) -> &[f64] {
        &self.y
    }

    pub(crate) fn system(&self) -> &System {
        &self.system
    }

    pub(crate) fn system_mut(&mut self) -> &mut System {
        &mut self.system
    }

    pub(crate) fn into_system(self) -> System {
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

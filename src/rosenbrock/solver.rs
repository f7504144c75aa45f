//! The integrator: its state, how it starts, and what is known within the last step.

use std::mem::take;

use super::control::Controller;
use super::matrix::Dense;
use super::options::{Jacobian, Options};
use super::tableau::{MOST_STAGES, Tableau};
use crate::integrate::{
    Cause, Error, FollowsRoots, IntegrationError, Roots, Statistics, check_form, check_start,
};
use crate::ode::Ode;

/// Integrates y' = f(t, y) forward in time by a Rosenbrock method.
///
/// Steps of automatic size keep the local error within tolerance. Solutions between the ends of a step come from
/// stages that are there anyway, so asking for output does not change the steps. df/dt is a difference quotient: one more
/// evaluation a step. Stepping allocates nothing.
#[derive(Debug)]
pub struct Rosenbrock<S: Ode> {
    pub(super) system: S,
    pub(super) options: Options,
    pub(super) tableau: &'static Tableau,
    /// The matrix, unless the system keeps it to itself.
    pub(super) dense: Option<Dense>,
    /// Unknowns but for the integrals at the end of the state.
    pub(super) coupled: usize,
    /// Weights of the error norm.
    pub(super) weight: Vec<f64>,
    pub(super) stop_time: Option<f64>,
    /// End of the last accepted step, the solution there and f.
    pub(super) t: f64,
    pub(super) y: Vec<f64>,
    pub(super) slope: Vec<f64>,
    /// Start of the last accepted step; equal to `t` when there is nothing to interpolate in.
    pub(super) t_old: f64,
    pub(super) y_old: Vec<f64>,
    pub(super) slope_new: Vec<f64>,
    /// df/dt.
    pub(super) time_slope: Vec<f64>,
    /// u_i.
    pub(super) stages: [Vec<f64>; MOST_STAGES],
    /// p and q of the dense output.
    pub(super) bends: [Vec<f64>; 2],
    /// What is known at (t, y).
    pub(super) known: Known,
    /// gamma h of the factors at hand.
    pub(super) factored: Option<f64>,
    /// Argument of a stage.
    pub(super) argument: Vec<f64>,
    /// Time within the last step at which the last call came to rest, unless at its end, and the
    /// solution there.
    pub(super) rest: Option<f64>,
    pub(super) output: Vec<f64>,
    pub(super) roots: Roots,
    /// Size of the next step, once known.
    pub(super) next_step: Option<f64>,
    /// Why a step was last refused, until steps grow again.
    pub(super) setback: Option<Cause>,
    pub(super) controller: Controller,
    pub(super) statistics: Statistics,
}

/// What has been evaluated at (t, y).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Known {
    pub(super) slope: bool,
    pub(super) time_slope: bool,
    pub(super) jacobian: bool,
}

impl<S: Ode> Rosenbrock<S> {
    /// Starts at y(t) = `y`; the length of `y` is the number n of equations.
    ///
    /// The system is first called by the first step.
    ///
    /// # Errors
    /// [`Error::Input`] names the option or component that cannot be used.
    pub fn new(system: S, t: f64, y: &[f64], options: &Options) -> Result<Self, Error> {
        check_start(t, y)?;
        check_form(&system)?;
        options.forward.check(y)?;
        let (n, tableau) = (y.len(), options.tableau()?);
        let zeros = || vec![0.0; n];
        let mut solver = Self {
            options: options.clone(),
            tableau,
            dense: (options.jacobian != Jacobian::Custom).then(|| Dense::new(n)),
            coupled: n - system.integrals(),
            weight: zeros(),
            stop_time: None,
            t,
            y: y.to_vec(),
            slope: zeros(),
            t_old: t,
            y_old: zeros(),
            slope_new: zeros(),
            time_slope: zeros(),
            stages: std::array::from_fn(|i| if i < tableau.alpha.len() { zeros() } else { vec![] }),
            bends: [zeros(), zeros()],
            known: Known::default(),
            factored: None,
            argument: zeros(),
            rest: None,
            output: zeros(),
            roots: Roots::new(system.root_count()),
            next_step: options.forward.steps.initial_step,
            setback: None,
            controller: Controller::new(tableau.order, options.linear),
            statistics: Statistics::default(),
            system,
        };
        solver.update_weight();
        Ok(solver)
    }

    /// Error weights at the start of the next step.
    pub(super) fn update_weight(&mut self) {
        self.options.forward.tolerances.weigh(&self.y, &mut self.weight);
    }

    pub(super) fn max_step(&self) -> f64 {
        self.options.forward.steps.max_step.unwrap_or(f64::INFINITY)
    }

    pub(super) fn interpolate_state(&self, t: f64, out: &mut [f64]) {
        if t == self.t {
            out.copy_from_slice(&self.y);
        } else {
            let theta = (t - self.t_old) / (self.t - self.t_old);
            interpolate([&self.y_old, &self.y], &self.bends, theta, out);
        }
    }

    pub(super) fn interpolate_slope(&self, t: f64, out: &mut [f64]) {
        let h = self.t - self.t_old;
        let theta = (t - self.t_old) / h;
        let [p, q] = &self.bends;
        for (i, slope) in out.iter_mut().enumerate() {
            let bend = (1.0 - 2.0 * theta) * (p[i] + theta * q[i]) + theta * (1.0 - theta) * q[i];
            *slope = (self.y[i] - self.y_old[i] + bend) / h;
        }
    }
}

/// The dense output at the part `theta` of a step.
pub(super) fn interpolate(ends: [&[f64]; 2], bends: &[Vec<f64>; 2], theta: f64, out: &mut [f64]) {
    let ([start, end], [p, q], rest) = (ends, bends, 1.0 - theta);
    for (i, out) in out.iter_mut().enumerate() {
        *out = rest * start[i] + theta * (end[i] + rest * (p[i] + theta * q[i]));
    }
}

impl<S: Ode> FollowsRoots for Rosenbrock<S> {
    type System = S;

    fn roots_mut(&mut self) -> &mut Roots {
        &mut self.roots
    }

    fn span(&self) -> [f64; 2] {
        [self.t_old, self.t]
    }

    fn parts(&mut self) -> (&mut S, [&[f64]; 2], &mut [f64]) {
        (&mut self.system, [&self.y, &self.slope], &mut self.argument)
    }

    fn interpolate_inside(&mut self, t: f64) {
        let mut y = take(&mut self.argument);
        self.interpolate_state(t, &mut y);
        self.argument = y;
    }

    fn count_root_evaluation(&mut self) {
        self.statistics.root_evaluations += 1;
    }

    fn halt(&self, cause: Cause, step: f64) -> IntegrationError {
        self.stopped(cause, step)
    }
}

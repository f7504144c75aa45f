//! The integrator: its state, how it starts, and what is known within the last step.

use super::control::{Controller, StabilityLimit, StabilityMonitor};
use super::tableau::{self, STAGES, advance};
use crate::integrate::{Error, ExplicitOptions, Roots, Statistics, check_form, check_start};
use crate::ode::Ode;

/// Order of the method.
pub(super) const ORDER: u32 = 5;

/// Integrates y' = f(t, y) forward in time with the Dormand-Prince pair of order 5(4).
///
/// Steps of automatic size keep the local error within tolerance; six evaluations of the
/// right-hand side each. Solutions between the ends of a step come from a continuous extension of
/// order 4, so asking for output does not change the steps, and there root functions are followed,
/// as in CVODE. Stepping allocates nothing.
#[derive(Debug)]
pub struct DormandPrince<S: Ode> {
    pub(super) system: S,
    pub(super) options: ExplicitOptions,
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
    pub(super) rest: Option<f64>,
    pub(super) output: Vec<f64>,
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
    /// [`Error::Input`] names the option or component that cannot be used.
    pub fn new(system: S, t: f64, y: &[f64], options: &ExplicitOptions) -> Result<Self, Error> {
        check_start(t, y)?;
        check_form(&system)?;
        options.check(y)?;
        let n = y.len();
        let mut solver = Self {
            options: options.clone(),
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
            next_step: options.steps.initial_step,
            controller: Controller::new(),
            monitor: StabilityMonitor::default(),
            statistics: Statistics::default(),
            system,
        };
        solver.update_weight();
        Ok(solver)
    }

    /// Whether stability, not accuracy, limits the steps: set once such steps are the rule.
    pub fn stability_limit(&self) -> Option<StabilityLimit> {
        self.monitor.limit()
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

    pub(super) fn interpolate_slope(&self, t: f64, ydot: &mut [f64]) {
        let weights = tableau::dense_derivative_weights((t - self.t_old) / (self.t - self.t_old));
        let k = self.last_stages();
        for (i, slope) in ydot.iter_mut().enumerate() {
            *slope = weights.iter().zip(k).map(|(weight, k)| weight * k[i]).sum();
        }
    }

    pub(super) fn max_step(&self) -> f64 {
        self.options.steps.max_step.unwrap_or(f64::INFINITY)
    }

    /// Stages 1, 3, 4, 5, 6, 7 of the last accepted step.
    fn last_stages(&self) -> [&[f64]; 6] {
        let [last, _, k3, k4, k5, k6, first] = &self.k;
        [first, k3, k4, k5, k6, last]
    }
}

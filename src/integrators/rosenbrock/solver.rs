//! The method: its data in addition to the state, and the solution within the last step.

use super::control::Controller;
use super::matrix::Matrix;
use super::options::Options;
use super::tableau::{MOST_STAGES, Tableau};
use crate::integrators::common::{Cause, Error, JacobianCheck, March, OneStep, StepMethod};
use crate::integrators::ode::Ode;

/// Integrates y' = f(t, y) forward in time by a Rosenbrock method.
///
/// Steps of automatic size keep the local error within tolerance. Solutions between the ends of a step come
/// from its stages, so output times do not change the steps; their order is one less than the method's. df/dt
/// is a difference quotient: one more evaluation per step. Stepping allocates nothing.
pub type Rosenbrock<S> = OneStep<S, LinearlyImplicit>;

/// A Rosenbrock method at work.
#[derive(Debug)]
pub struct LinearlyImplicit {
    pub(super) tableau: &'static Tableau,
    /// Checks the Jacobian that the system supplies by the method of this name, or difference quotients that may lack entries.
    pub(super) check: Option<(Option<&'static str>, JacobianCheck)>,
    /// Whether the system's own linear solver is checked for answers that are zero.
    pub(super) checks_answers: bool,
    /// Whether the Jacobian never changes.
    pub(super) is_linear: bool,
    /// The matrix, unless the system has its own linear solver.
    pub(super) matrix: Option<Matrix>,
    /// Number of unknowns without the integrals at the end of the state.
    pub(super) coupled: usize,
    /// df/dt.
    pub(super) time_slope: Vec<f64>,
    /// u_i.
    pub(super) stages: [Vec<f64>; MOST_STAGES],
    /// p and q of the dense output.
    pub(super) bends: [Vec<f64>; 2],
    /// Derivatives that are up to date at (t, y).
    pub(super) known: Known,
    /// gamma h of the present factorization.
    pub(super) factored: Option<f64>,
    /// Age of the factorization, and its limit.
    pub(super) service: Service,
    controller: Controller,
}

/// Part of the tolerance above which the error of a step asks for a new matrix.
const TOO_OLD: f64 = 0.2;

/// The steps of a factorization.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Service {
    /// Steps that it may serve.
    pub(super) most: u32,
    /// Steps that it has served.
    pub(super) steps: u32,
    /// Whether the integration was resumed, and the step size has stayed the same since.
    pub(super) is_resumed: bool,
}

/// Derivatives of f that have been evaluated at (t, y).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Known {
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
        let (n, tableau) = (y.len(), options.tableau()?);
        let zeros = || vec![0.0; n];
        options.forward.check(y)?;
        let matrix = match n {
            0 => None,
            n => Matrix::new(&options.solver, n, &options.forward.tolerances)?,
        };
        let method = LinearlyImplicit {
            tableau,
            check: (options.solver.is_checked() && !options.trusts_jacobian).then(|| {
                (options.solver.supplied(), JacobianCheck::new(n, &options.forward.tolerances))
            }),
            checks_answers: !options.trusts_jacobian,
            is_linear: options.linear,
            matrix,
            coupled: n.saturating_sub(system.integrals()),
            time_slope: zeros(),
            stages: std::array::from_fn(|i| if i < tableau.alpha.len() { zeros() } else { vec![] }),
            bends: [zeros(), zeros()],
            known: Known::default(),
            factored: None,
            service: Service { most: options.steps_between_jacobians, ..Service::default() },
            controller: Controller::new(tableau.order, options.linear),
        };
        Self::start(system, t, y, &options.forward, (tableau.name, tableau.order, method))
    }
}

impl LinearlyImplicit {
    /// Drops a matrix of another step, with which this one has failed; `false` if it is of this step.
    fn drops_old(&mut self) -> bool {
        let is_old = self.service.steps > 0 && self.factored.is_some() && !self.is_linear;
        if is_old {
            self.factored = None;
        }
        is_old
    }
}

impl StepMethod for LinearlyImplicit {
    fn restart(&mut self) {
        self.factored = None;
        self.controller = Controller::new(self.tableau.order, self.is_linear);
    }

    /// A matrix that may serve several steps may serve after a change of the state and of the forces, too.
    fn forget(&mut self) {
        self.known = Known::default();
        self.service.is_resumed = true;
        if self.service.most == 1 || self.is_linear {
            self.factored = None;
        }
    }

    /// Root mean square with the error weights, without the integrals.
    fn norm(&self, x: &[f64], weight: &[f64]) -> f64 {
        let terms = x[..self.coupled].iter().zip(weight).map(|(x, weight)| (x * weight).powi(2));
        (terms.sum::<f64>() / x.len() as f64).sqrt()
    }

    fn try_step<S: Ode>(
        &mut self,
        march: &mut March<S>,
        t_new: f64,
        h: f64,
    ) -> Result<Result<f64, Cause>, Error> {
        self.attempt(march, t_new, h)
    }

    fn accept<S: Ode>(&mut self, _: &March<S>, _: f64, h: f64, error: f64) -> f64 {
        self.known = Known::default();
        self.service.steps += 1;
        if error > TOO_OLD {
            self.service.steps = self.service.most;
        }
        self.controller.accept(h, error)
    }

    fn reject(&mut self, h: f64, error: f64) -> f64 {
        if self.drops_old() { h } else { self.controller.reject(h, error) }
    }

    fn refuse(&mut self, h: f64) -> f64 {
        if self.drops_old() { h } else { self.controller.refuse(h) }
    }

    fn interpolate<S: Ode>(&self, march: &March<S>, t: f64, y: &mut [f64]) {
        let theta = (t - march.t_old) / (march.t - march.t_old);
        interpolate([&march.y_old, &march.y], &self.bends, theta, y);
    }

    fn interpolate_slope<S: Ode>(&self, march: &March<S>, t: f64, ydot: &mut [f64]) {
        let h = march.t - march.t_old;
        let theta = (t - march.t_old) / h;
        let [p, q] = &self.bends;
        for (i, slope) in ydot.iter_mut().enumerate() {
            let bend = (1.0 - 2.0 * theta) * (p[i] + theta * q[i]) + theta * (1.0 - theta) * q[i];
            *slope = (march.y[i] - march.y_old[i] + bend) / h;
        }
    }

    fn interpolant_degree(&self) -> u32 {
        if self.tableau.order == 4 || self.coupled < self.time_slope.len() { 3 } else { 2 }
    }
}

/// The dense output at the fraction `theta` of a step.
pub(super) fn interpolate(ends: [&[f64]; 2], bends: &[Vec<f64>; 2], theta: f64, out: &mut [f64]) {
    let ([start, end], [p, q], rest) = (ends, bends, 1.0 - theta);
    for (i, out) in out.iter_mut().enumerate() {
        *out = rest * start[i] + theta * (end[i] + rest * (p[i] + theta * q[i]));
    }
}

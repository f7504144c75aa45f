//! Options that the integrators of SUNDIALS share.

use super::signs::{Sign, check_signs, check_state};
use crate::base::input::InputError;
use crate::integrators::common::{Tolerances, check_step};

/// Limits of the control of step size and order, of the nonlinear iteration, and of the unknowns.
#[derive(Clone, Debug, Default)]
pub(super) struct Limits {
    pub(super) min_step: Option<f64>,
    /// Of multistep methods.
    pub(super) max_order: Option<u32>,
    pub(super) convergence_coefficient: Option<f64>,
    /// One for each unknown, or none.
    pub(super) signs: Vec<Sign>,
    /// Whether a supplied Jacobian is not checked.
    pub(super) trusts_jacobian: bool,
}

/// Tolerances of integrals, if they are not those of the unknowns, and whether they take part in the error
/// control.
#[derive(Clone, Debug)]
pub(super) struct QuadratureOptions {
    pub(super) tolerances: Option<Tolerances>,
    pub(super) error_control: bool,
}

impl Default for QuadratureOptions {
    fn default() -> Self {
        Self { tolerances: None, error_control: true }
    }
}

impl Limits {
    pub(super) fn check(&self, max_step: Option<f64>, y0: &[f64]) -> Result<(), InputError> {
        if let Some(h) = self.min_step {
            check_step("min_step", h)?;
            if h < 0.0 {
                return Err(InputError::new("min_step", h, "it is positive: a size without sign"));
            }
        }
        if let (Some(min), Some(max)) = (self.min_step, max_step)
            && min > max
        {
            let help = format!("it is at most max_step, {max}");
            return Err(InputError::new("min_step", min, help));
        }
        if let Some(coefficient) = self.convergence_coefficient
            && !(coefficient > 0.0 && coefficient.is_finite())
        {
            return Err(InputError::new("convergence_coefficient", coefficient, "it is positive"));
        }
        check_signs(&self.signs, y0.len())?;
        check_state(&self.signs, "y0", y0)
    }

    /// Checks the order of a multistep method.
    pub(super) fn check_order(&self, highest: u32) -> Result<(), InputError> {
        match self.max_order {
            Some(order) if !(1..=highest).contains(&order) => {
                let help = format!("this method has orders 1 to {highest}");
                Err(InputError::new("max_order", order, help))
            }
            _ => Ok(()),
        }
    }
}

/// Builder methods that integrators share.
macro_rules! builder_methods {
    (limits) => {
        /// Lower bound of |step size|. Default: none.
        pub fn min_step(mut self, h: f64) -> Self {
            self.limits.min_step = Some(h);
            self
        }

        /// Factor of the convergence test: the error allowed to the nonlinear iteration, relative to the
        /// local error. Default: 0.1 in CVODE and ARKODE, 0.33 in IDA.
        pub fn convergence_coefficient(mut self, coefficient: f64) -> Self {
            self.limits.convergence_coefficient = Some(coefficient);
            self
        }

        /// Inequality constraints: for each unknown the sign that it keeps (`CVodeSetConstraints`,
        /// `ARKStepSetConstraints`, `IDASetConstraints`). Default: none.
        ///
        /// A step that takes an unknown beyond its bound is repeated with a smaller size; if it is beyond by
        /// less than the tolerances, CVODE and IDA set it to the bound, up to rounding. That holds at the
        /// ends of the steps: interpolated values may be beyond the bound by the error of the polynomials. No
        /// step size helps where the equations themselves lead across the bound.
        pub fn sign_constraints(
            mut self,
            signs: impl Into<Vec<$crate::integrators::sundials::Sign>>,
        ) -> Self {
            self.limits.signs = signs.into();
            self
        }

        /// Whether a Jacobian that the system supplies is checked against differences of the equations.
        /// Default: yes.
        ///
        /// The first Jacobian, the second, the fourth, the eighth and so on is checked, by its entries or its
        /// products, along two random directions. That costs three evaluations each time, which the
        /// statistics leave out. A run with a wrong Jacobian ends with
        /// [`Cause::WrongJacobian`](crate::integrators::common::Cause::WrongJacobian), because Newton's
        /// iteration may accept a wrong result as the solution. Switch the check off for a Jacobian that is
        /// meant to be an approximation.
        /// [`LinearSolver::Custom`](crate::integrators::sundials::LinearSolver::Custom) and preconditioners
        /// are not checked.
        pub fn check_jacobian(mut self, on: bool) -> Self {
            self.limits.trusts_jacobian = !on;
            self
        }
    };
    (order) => {
        /// Highest order that may be used. Default: 5 for BDF, 12 for Adams.
        pub fn max_order(mut self, order: u32) -> Self {
            self.limits.max_order = Some(order);
            self
        }
    };
    (quadratures) => {
        /// Tolerances of the integrals [`quadratures`](crate::integrators::ode::Ode::quadratures), whose
        /// errors also control the step size. Default: `rtol` of the unknowns, and their smallest `atol`.
        pub fn quadrature_tolerances(
            mut self,
            rtol: f64,
            atol: impl Into<AbsoluteTolerance>,
        ) -> Self {
            self.quadratures.tolerances = Some(Tolerances::new(rtol, atol));
            self
        }

        /// Whether errors of the integrals also control the step size (`CVodeSetQuadErrCon`). Default: yes.
        ///
        /// If not, the run is that of the unknowns alone, and the errors of the integrals depend on the
        /// length of its steps.
        pub fn quadrature_error_control(mut self, on: bool) -> Self {
            self.quadratures.error_control = on;
            self
        }
    };
    (sensitivities) => {
        /// Also computes derivatives of the solution with respect to parameters. Default: none.
        pub fn sensitivities(mut self, sensitivities: Sensitivities) -> Self {
            self.sensitivities = Some(sensitivities);
            self
        }
    };
    (nonlinear) => {
        /// Newton iteration with this linear solver (the default, dense with difference quotients).
        pub fn newton(mut self, solver: LinearSolver) -> Self {
            self.nonlinear.solver = NonlinearSolver::Newton(solver);
            self
        }

        /// Fixed-point iteration, accelerated by Anderson's method over the last `acceleration`
        /// iterates (0: plain): needs no Jacobian; for non-stiff systems.
        pub fn fixed_point(mut self, acceleration: u32) -> Self {
            self.nonlinear.solver = NonlinearSolver::FixedPoint { acceleration };
            self
        }

        /// Steps after which the Newton matrix is set up anew in any case
        /// (`CVodeSetLSetupFrequency`, `ARKStepSetLSetupFrequency`). Default: 20.
        pub fn max_steps_between_setups(mut self, steps: u32) -> Self {
            self.nonlinear.max_steps_between_setups = Some(steps);
            self
        }
    };
}
pub(super) use builder_methods;

//! Options of the integrators of SUNDIALS.

use super::{
    jacobian::Jacobian,
    linear_solver::LinearSolver,
    sensitivity::Sensitivities,
    signs::{Sign, check_signs, check_state},
    step_control::StepControl,
    weights::ErrorWeights,
};
use crate::base::input::InputError;
use crate::integrators::common::{
    AbsoluteTolerance, StepOptions, Tolerances, check_count, check_step, step_options,
};

/// Tolerances, method and limits of an integrator of SUNDIALS: [`CvodeOptions`](super::CvodeOptions),
/// [`ArkodeOptions`](super::ArkodeOptions) or [`IdaOptions`](super::IdaOptions), which add `own` options.
#[derive(Clone, Debug)]
#[must_use]
pub struct SolverOptions<O> {
    pub(super) tolerances: Tolerances,
    pub(crate) steps: StepOptions,
    pub(super) min_step: Option<f64>,
    pub(super) step_control: StepControl,
    /// Weights of the error norm, if they are not those of the tolerances.
    pub(super) weights: Option<ErrorWeights>,
    /// Of multistep methods.
    pub(super) max_order: Option<u32>,
    pub(super) convergence_coefficient: Option<f64>,
    /// One for each unknown, or none.
    pub(super) signs: Vec<Sign>,
    /// Whether a supplied Jacobian is not checked.
    pub(super) trusts_jacobian: bool,
    pub(super) linear_solver: LinearSolver,
    /// The acceleration of a fixed-point iteration in place of Newton's.
    pub(super) fixed_point: Option<u32>,
    pub(super) max_steps_between_setups: Option<u32>,
    /// Tolerances of integrals, if they are not those of the unknowns.
    pub(super) quadrature_tolerances: Option<Tolerances>,
    pub(super) quadrature_error_control: bool,
    pub(super) sensitivities: Option<Sensitivities>,
    pub(super) own: O,
}

/// Options of an integrator of ODEs: CVODE or ARKODE.
#[doc(hidden)]
pub trait OfOde {}

/// Options of a multistep method: CVODE or IDA.
#[doc(hidden)]
pub trait OfMultistep {}

impl<O> SolverOptions<O> {
    /// Defaults of all options but these.
    pub(super) fn with(rtol: f64, atol: impl Into<AbsoluteTolerance>, own: O) -> Self {
        Self {
            tolerances: Tolerances::new(rtol, atol),
            steps: StepOptions::default(),
            min_step: None,
            step_control: StepControl::new(),
            weights: None,
            max_order: None,
            convergence_coefficient: None,
            signs: Vec::new(),
            trusts_jacobian: false,
            linear_solver: LinearSolver::Dense(Jacobian::DifferenceQuotients),
            fixed_point: None,
            max_steps_between_setups: None,
            quadrature_tolerances: None,
            quadrature_error_control: true,
            sensitivities: None,
            own,
        }
    }

    step_options!(steps);

    /// Newton iteration with this linear solver (the default, dense with difference quotients).
    pub fn newton(mut self, solver: LinearSolver) -> Self {
        (self.linear_solver, self.fixed_point) = (solver, None);
        self
    }

    /// Lower bound of |step size|. Default: none.
    pub fn min_step(mut self, h: f64) -> Self {
        self.min_step = Some(h);
        self
    }

    /// Bounds for changes of the step size. Default: those of the integrator.
    pub fn step_control(mut self, control: StepControl) -> Self {
        self.step_control = control;
        self
    }

    /// Weights w_i of the error norm sqrt(sum_i (w_i e_i)^2 / n), in which local errors e are kept below 1
    /// (`CVodeWFtolerances`, `IDAWFtolerances`, `ARKStepWFtolerances`): `weights(y, w)` writes a positive one for each
    /// unknown of the state y. Default: 1/(rtol |y_i| + atol_i).
    ///
    /// The tolerances still tell the sizes of unknowns for difference quotients, and the errors allowed to integrals.
    pub fn error_weights(
        mut self,
        weights: impl Fn(&[f64], &mut [f64]) + Send + Sync + 'static,
    ) -> Self {
        self.weights = Some(ErrorWeights::new(weights));
        self
    }

    /// Factor of the convergence test: the error allowed to the nonlinear iteration, relative to the
    /// local error. Default: 0.1 in CVODE and ARKODE, 0.33 in IDA.
    pub fn convergence_coefficient(mut self, coefficient: f64) -> Self {
        self.convergence_coefficient = Some(coefficient);
        self
    }

    /// Inequality constraints: for each unknown the sign that it keeps (`CVodeSetConstraints`,
    /// `ARKStepSetConstraints`, `IDASetConstraints`). Default: none.
    ///
    /// A step that takes an unknown beyond its bound is repeated with a smaller size; if it is beyond by
    /// less than the tolerances, CVODE and IDA set it to the bound, up to rounding. That holds at the
    /// ends of the steps: interpolated values may be beyond the bound by the error of the polynomials. No
    /// step size helps where the equations themselves lead across the bound.
    pub fn sign_constraints(mut self, signs: impl Into<Vec<Sign>>) -> Self {
        self.signs = signs.into();
        self
    }

    /// Whether a Jacobian that the system supplies, or the band or pattern of its difference quotients, is checked against differences of
    /// the equations. Default: yes.
    ///
    /// The first Jacobian, the second, the fourth, the eighth and so on is checked, by its entries or its
    /// products, along two random directions. That costs three evaluations each time, which the
    /// statistics omit. A run with a wrong Jacobian ends with
    /// [`Cause::WrongJacobian`](crate::integrators::common::Cause::WrongJacobian), because Newton's
    /// iteration may accept a wrong result as the solution; one whose band or pattern lacks entries with
    /// [`Cause::MissingEntry`](crate::integrators::common::Cause::MissingEntry), as steps may become many times as many. Switch the check
    /// off for a Jacobian that is meant to be an approximation.
    ///
    /// A linear solver or preconditioner of the system's own is not checked, but for answers that are zero
    /// ([`Cause::WrongSolver`](crate::integrators::common::Cause::WrongSolver)); switch that off, too, for one that projects.
    pub fn check_jacobian(mut self, on: bool) -> Self {
        self.trusts_jacobian = !on;
        self
    }

    /// The linear solver of Newton's iteration, if there is one.
    pub(super) fn newton_solver(&self) -> Option<&LinearSolver> {
        Some(&self.linear_solver).filter(|_| self.fixed_point.is_none())
    }

    /// Checks the options that all integrators share, for orders up to `highest`.
    pub(super) fn check_shared(&self, y0: &[f64], highest: u32) -> Result<(), InputError> {
        self.tolerances.check(y0)?;
        self.steps.check()?;
        self.step_control.check()?;
        if let Some(h) = self.min_step {
            check_step("min_step", h)?;
            if h < 0.0 {
                return Err(InputError::new("min_step", h, "it is positive: a size without sign"));
            }
        }
        if let (Some(min), Some(max)) = (self.min_step, self.steps.max_step)
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
        check_state(&self.signs, "y0", y0)?;
        if let Some(order) = self.max_order.filter(|order| !(1..=highest).contains(order)) {
            let help = format!("this method has orders 1 to {highest}");
            return Err(InputError::new("max_order", order, help));
        }
        if let Some(steps) = self.max_steps_between_setups {
            check_count("max_steps_between_setups", steps)?;
        }
        match self.fixed_point {
            Some(acceleration) if acceleration > 100 => {
                let help = "a few iterates are enough, at most 100";
                Err(InputError::new("acceleration", acceleration, help))
            }
            Some(_) => Ok(()),
            None => self.linear_solver.check(y0.len()),
        }
    }

    /// Refuses sensitivities in the run forward of an adjoint gradient.
    pub(super) fn check_for_adjoint(&self) -> Result<(), InputError> {
        if self.sensitivities.is_some() {
            let help = "the run forward of an adjoint gradient needs none";
            return Err(InputError::new("sensitivities", "given", help));
        }
        Ok(())
    }
}

impl<O: OfOde> SolverOptions<O> {
    /// Fixed-point iteration, accelerated by Anderson's method over the last `acceleration`
    /// iterates (0: plain): needs no Jacobian; for non-stiff systems.
    pub fn fixed_point(mut self, acceleration: u32) -> Self {
        self.fixed_point = Some(acceleration);
        self
    }

    /// Steps after which the Newton matrix is recomputed in any case
    /// (`CVodeSetLSetupFrequency`, `ARKStepSetLSetupFrequency`). Default: 20.
    pub fn max_steps_between_setups(mut self, steps: u32) -> Self {
        self.max_steps_between_setups = Some(steps);
        self
    }
}

impl<O: OfMultistep> SolverOptions<O> {
    /// Highest order that may be used. Default: 5 for BDF, 12 for Adams.
    pub fn max_order(mut self, order: u32) -> Self {
        self.max_order = Some(order);
        self
    }

    /// Tolerances of the integrals [`quadratures`](crate::integrators::ode::Ode::quadratures), whose
    /// errors also control the step size. Default: `rtol` of the unknowns, and their smallest `atol`.
    pub fn quadrature_tolerances(mut self, rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        self.quadrature_tolerances = Some(Tolerances::new(rtol, atol));
        self
    }

    /// Whether errors of the integrals also control the step size (`CVodeSetQuadErrCon`). Default: yes.
    ///
    /// If not, the run is that of the unknowns alone, and the errors of the integrals depend on the
    /// length of its steps.
    pub fn quadrature_error_control(mut self, on: bool) -> Self {
        self.quadrature_error_control = on;
        self
    }

    /// Also computes derivatives of the solution with respect to parameters. Default: none.
    pub fn sensitivities(mut self, sensitivities: Sensitivities) -> Self {
        self.sensitivities = Some(sensitivities);
        self
    }
}

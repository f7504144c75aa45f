//! How CVODE is to integrate.

use crate::base::input::InputError;
use crate::integrators::{
    common::{AbsoluteTolerance, StepOptions, Tolerances, step_options},
    sundials::{
        linear_solver::LinearSolver,
        nonlinear::{NonlinearOptions, NonlinearSolver},
        options::{Limits, QuadratureOptions, builder_methods},
        sensitivity::Sensitivities,
    },
};

/// The two families of linear multistep methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Multistep {
    /// Backward differentiation formulas, orders 1 to 5: for stiff systems. Orders 3 to 5 are
    /// unstable for lightly damped oscillations; see [`CvodeOptions::max_order`].
    Bdf,
    /// Adams-Moulton formulas, orders 1 to 12: for non-stiff systems.
    Adams,
}

/// Tolerances, method and limits of a [`Cvode`](super::Cvode).
///
/// ```
/// use pliant::sundials::{CvodeOptions, Jacobian, LinearSolver};
///
/// let options = CvodeOptions::new(1e-6, [1e-10, 1e-14, 1e-8])
///     .newton(LinearSolver::Dense(Jacobian::Supplied))
///     .max_order(2);
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct CvodeOptions {
    pub(super) tolerances: Tolerances,
    pub(super) steps: StepOptions,
    pub(super) limits: Limits,
    pub(super) quadratures: QuadratureOptions,
    pub(super) sensitivities: Option<Sensitivities>,
    pub(super) method: Multistep,
    pub(super) nonlinear: NonlinearOptions,
    pub(super) stability_limit_detection: bool,
    pub(super) project: bool,
}

impl CvodeOptions {
    /// BDF with a Newton iteration on a dense matrix of difference quotients, and these
    /// tolerances: local errors are kept below `rtol |y_i| + atol_i`.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        Self {
            tolerances: Tolerances::new(rtol, atol),
            steps: StepOptions::default(),
            limits: Limits::default(),
            quadratures: QuadratureOptions::default(),
            sensitivities: None,
            method: Multistep::Bdf,
            nonlinear: NonlinearOptions::default(),
            stability_limit_detection: false,
            project: false,
        }
    }

    /// The family of methods. Default: BDF.
    pub fn method(mut self, method: Multistep) -> Self {
        self.method = method;
        self
    }

    /// Whether BDF may lower its order where it detects its stability limit
    /// (`CVodeSetStabLimDet`). Default: no.
    pub fn stability_limit_detection(mut self, on: bool) -> Self {
        self.stability_limit_detection = on;
        self
    }

    /// Makes BDF project the state onto the invariants of the equations after each step, by
    /// [`Ode::project`](crate::integrators::ode::Ode::project) (`CVodeSetProjFn`). Default: no.
    ///
    /// States between the ends of the steps satisfy the invariants within the tolerances only.
    pub fn project(mut self) -> Self {
        self.project = true;
        self
    }

    builder_methods!(order);
    builder_methods!(quadratures);
    builder_methods!(sensitivities);
    builder_methods!(nonlinear);
    step_options!();
    builder_methods!(limits);

    /// Options of an adjoint problem: the linear solver and the tolerances.
    pub(in crate::integrators::sundials) fn for_adjoint(
        &self,
        y0: &[f64],
    ) -> Result<(&LinearSolver, &Tolerances), InputError> {
        self.check(y0)?;
        if self.sensitivities.is_some() {
            let help = "the run forward of an adjoint gradient needs none";
            return Err(InputError::new("sensitivities", "given", help));
        }
        if self.project {
            let help = "an adjoint gradient knows nothing of projections: leave them out";
            return Err(InputError::new("project", true, help));
        }
        let Some(solver) = self.nonlinear.linear_solver() else {
            let help = "an adjoint gradient needs a Newton iteration";
            return Err(InputError::new("nonlinear solver", "fixed_point", help));
        };
        Ok((solver, &self.tolerances))
    }

    pub(super) fn check(&self, y0: &[f64]) -> Result<(), InputError> {
        self.tolerances.check(y0)?;
        self.steps.check()?;
        self.limits.check(self.steps.max_step, y0)?;
        self.limits.check_order(match self.method {
            Multistep::Bdf => 5,
            Multistep::Adams => 12,
        })?;
        if self.stability_limit_detection && self.method == Multistep::Adams {
            return Err(InputError::new("stability_limit_detection", true, "it belongs to BDF"));
        }
        if self.project && self.method == Multistep::Adams {
            return Err(InputError::new("project", true, "it belongs to BDF"));
        }
        if self.sensitivities.is_some() {
            match &self.nonlinear.solver {
                NonlinearSolver::Newton(LinearSolver::Custom) => {
                    let help = "with sensitivities another linear solver is needed: newton_solve may \
                                add what newton_rhs leaves out, which is not theirs";
                    return Err(InputError::new("linear solver", "Custom", help));
                }
                NonlinearSolver::FixedPoint { .. } => {
                    let help = "with sensitivities a Newton iteration is needed";
                    return Err(InputError::new("nonlinear solver", "fixed_point", help));
                }
                NonlinearSolver::Newton(_) => {}
            }
        }
        self.nonlinear.check(y0.len())
    }
}

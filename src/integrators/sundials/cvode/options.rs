//! Options of CVODE.

use crate::base::input::InputError;
use crate::integrators::{
    common::{AbsoluteTolerance, Tolerances},
    sundials::{
        linear_solver::LinearSolver,
        options::{OfMultistep, OfOde, SolverOptions},
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
pub type CvodeOptions = SolverOptions<OwnOptions>;

/// Options that CVODE alone has.
#[derive(Clone, Debug)]
pub struct OwnOptions {
    pub(super) method: Multistep,
    pub(super) stability_limit_detection: bool,
    pub(super) project: bool,
}

impl OfOde for OwnOptions {}
impl OfMultistep for OwnOptions {}

impl CvodeOptions {
    /// BDF with a Newton iteration on a dense matrix of difference quotients, and these
    /// tolerances: local errors are kept below `rtol |y_i| + atol_i`.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        let (method, stability_limit_detection, project) = (Multistep::Bdf, false, false);
        Self::with(rtol, atol, OwnOptions { method, stability_limit_detection, project })
    }

    /// The family of methods. Default: BDF.
    pub fn method(mut self, method: Multistep) -> Self {
        self.own.method = method;
        self
    }

    /// Whether BDF may lower its order where it detects its stability limit
    /// (`CVodeSetStabLimDet`). Default: no.
    pub fn stability_limit_detection(mut self, on: bool) -> Self {
        self.own.stability_limit_detection = on;
        self
    }

    /// Makes BDF project the state onto the invariants of the equations after each step, by
    /// [`Ode::project`](crate::integrators::ode::Ode::project) (`CVodeSetProjFn`). Default: no.
    ///
    /// States between the ends of the steps satisfy the invariants within the tolerances only.
    pub fn project(mut self) -> Self {
        self.own.project = true;
        self
    }

    /// Options of an adjoint problem: the linear solver and the tolerances.
    pub(in crate::integrators::sundials) fn for_adjoint(
        &self,
        y0: &[f64],
    ) -> Result<(&LinearSolver, &Tolerances), InputError> {
        self.check(y0)?;
        self.check_for_adjoint()?;
        if self.own.project {
            let help = "an adjoint gradient knows nothing of projections: leave them out";
            return Err(InputError::new("project", true, help));
        }
        let Some(solver) = self.newton_solver() else {
            let help = "an adjoint gradient needs a Newton iteration";
            return Err(InputError::new("nonlinear solver", "fixed_point", help));
        };
        Ok((solver, &self.tolerances))
    }

    pub(super) fn check(&self, y0: &[f64]) -> Result<(), InputError> {
        let is_adams = self.own.method == Multistep::Adams;
        self.check_shared(y0, if is_adams { 12 } else { 5 })?;
        if self.own.stability_limit_detection && is_adams {
            return Err(InputError::new("stability_limit_detection", true, "it belongs to BDF"));
        }
        if self.own.project && is_adams {
            return Err(InputError::new("project", true, "it belongs to BDF"));
        }
        match (&self.sensitivities, self.newton_solver()) {
            (Some(_), Some(LinearSolver::Custom)) => {
                let help = "with sensitivities another linear solver is needed: newton_solve may \
                            add what newton_rhs leaves out, which is not theirs";
                Err(InputError::new("linear solver", "Custom", help))
            }
            (Some(_), None) => {
                let help = "with sensitivities a Newton iteration is needed";
                Err(InputError::new("nonlinear solver", "fixed_point", help))
            }
            _ => Ok(()),
        }
    }
}

//! How IDA is to integrate.

use crate::base::input::InputError;
use crate::integrators::{
    common::{AbsoluteTolerance, StepOptions, Tolerances, check_length, step_options},
    sundials::{
        jacobian::Jacobian,
        linear_solver::LinearSolver,
        options::{Limits, QuadratureOptions, builder_methods},
        sensitivity::Sensitivities,
    },
};

/// Tolerances and limits of an [`Ida`](super::Ida).
#[derive(Clone, Debug)]
#[must_use]
pub struct IdaOptions {
    pub(super) tolerances: Tolerances,
    pub(super) steps: StepOptions,
    pub(super) limits: Limits,
    pub(super) quadratures: QuadratureOptions,
    pub(super) sensitivities: Option<Sensitivities>,
    pub(super) linear_solver: LinearSolver,
    pub(super) differential: Option<Vec<bool>>,
    pub(super) suppress_algebraic: bool,
}

impl IdaOptions {
    /// A Newton iteration on a dense matrix of difference quotients, and these tolerances: local
    /// errors are kept below `rtol |y_i| + atol_i`.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        Self {
            tolerances: Tolerances::new(rtol, atol),
            steps: StepOptions::default(),
            limits: Limits::default(),
            quadratures: QuadratureOptions::default(),
            sensitivities: None,
            linear_solver: LinearSolver::Dense(Jacobian::DifferenceQuotients),
            differential: None,
            suppress_algebraic: false,
        }
    }

    /// Newton iteration with this linear solver (the default, dense with difference quotients).
    pub fn newton(mut self, solver: LinearSolver) -> Self {
        self.linear_solver = solver;
        self
    }

    /// For each unknown, whether its derivative occurs in the equations (`true`) or it is
    /// algebraic (`false`). Needed by [`InitialCondition::Algebraic`], by
    /// [`suppress_algebraic`](Self::suppress_algebraic) and for adjoint gradients. (`IDASetId`)
    ///
    /// [`InitialCondition::Algebraic`]: super::InitialCondition::Algebraic
    pub fn differential(mut self, differential: impl Into<Vec<bool>>) -> Self {
        self.differential = Some(differential.into());
        self
    }

    /// Whether algebraic unknowns are left out of the local error test (`IDASetSuppressAlg`). Default: no.
    ///
    /// It is advisable for equations of index 2; the index is then not reported as the reason of failures.
    pub fn suppress_algebraic(mut self, on: bool) -> Self {
        self.suppress_algebraic = on;
        self
    }

    builder_methods!(order);
    builder_methods!(quadratures);
    builder_methods!(sensitivities);
    step_options!();
    builder_methods!(limits);

    /// Options of an adjoint problem: the linear solver, the tolerances, and which unknowns are differential.
    pub(in crate::integrators::sundials) fn for_adjoint(
        &self,
        y0: &[f64],
    ) -> Result<(&LinearSolver, &Tolerances, &[bool]), InputError> {
        self.check(y0)?;
        if self.sensitivities.is_some() {
            let help = "the run forward of an adjoint gradient needs none";
            return Err(InputError::new("sensitivities", "given", help));
        }
        let Some(differential) = &self.differential else {
            let help = "an adjoint gradient needs to know which unknowns are algebraic";
            return Err(InputError::new("differential", "not given", help));
        };
        Ok((&self.linear_solver, &self.tolerances, differential))
    }

    pub(super) fn check(&self, y0: &[f64]) -> Result<(), InputError> {
        self.tolerances.check(y0)?;
        self.steps.check()?;
        self.limits.check(self.steps.max_step, y0)?;
        self.limits.check_order(5)?;
        if let Some(differential) = &self.differential {
            check_length("length of differential", differential.len(), y0.len())?;
        } else if self.suppress_algebraic {
            let help = "it needs `differential` to say which unknowns are algebraic";
            return Err(InputError::new("suppress_algebraic", true, help));
        }
        if let Some(sensitivities) = &self.sensitivities {
            sensitivities.check_for_dae()?;
        }
        if let LinearSolver::Krylov(krylov) = &self.linear_solver {
            krylov.check_for_dae()?;
        }
        self.linear_solver.check(y0.len())
    }
}

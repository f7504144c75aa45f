//! Options of IDA.

use crate::base::input::InputError;
use crate::integrators::{
    common::{AbsoluteTolerance, Tolerances, check_length},
    sundials::{
        linear_solver::LinearSolver,
        options::{OfMultistep, SolverOptions},
    },
};

/// Tolerances and limits of an [`Ida`](super::Ida).
pub type IdaOptions = SolverOptions<OwnOptions>;

/// Options that IDA alone has.
#[derive(Clone, Debug)]
pub struct OwnOptions {
    pub(super) differential: Option<Vec<bool>>,
    pub(super) suppress_algebraic: bool,
}

impl OfMultistep for OwnOptions {}

impl IdaOptions {
    /// A Newton iteration on a dense matrix of difference quotients, and these tolerances: local
    /// errors are kept below `rtol |y_i| + atol_i`.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        let (differential, suppress_algebraic) = (None, false);
        Self::with(rtol, atol, OwnOptions { differential, suppress_algebraic })
    }

    /// For each unknown, whether its derivative occurs in the equations (`true`) or it is
    /// algebraic (`false`). Needed by [`InitialCondition::Algebraic`], by
    /// [`suppress_algebraic`](Self::suppress_algebraic) and for adjoint gradients. (`IDASetId`)
    ///
    /// [`InitialCondition::Algebraic`]: super::InitialCondition::Algebraic
    pub fn differential(mut self, differential: impl Into<Vec<bool>>) -> Self {
        self.own.differential = Some(differential.into());
        self
    }

    /// Whether algebraic unknowns are omitted from the local error test (`IDASetSuppressAlg`). Default: no.
    ///
    /// It is advisable for equations of index 2; the index is then not reported as the reason of failures.
    pub fn suppress_algebraic(mut self, on: bool) -> Self {
        self.own.suppress_algebraic = on;
        self
    }

    /// Says for twice the unknowns which are differential.
    pub(in crate::integrators::sundials) fn repeat_differential(&mut self) {
        if let Some(differential) = &mut self.own.differential {
            differential.extend_from_within(..);
        }
    }

    /// Options of an adjoint problem: the linear solver, the tolerances, and which unknowns are differential.
    pub(in crate::integrators::sundials) fn for_adjoint(
        &self,
        y0: &[f64],
    ) -> Result<(&LinearSolver, &Tolerances, &[bool]), InputError> {
        self.check(y0)?;
        self.check_for_adjoint()?;
        let Some(differential) = &self.own.differential else {
            let help = "an adjoint gradient needs to know which unknowns are algebraic";
            return Err(InputError::new("differential", "not given", help));
        };
        Ok((&self.linear_solver, &self.tolerances, differential))
    }

    pub(super) fn check(&self, y0: &[f64]) -> Result<(), InputError> {
        self.check_shared(y0, 5)?;
        if let Some(differential) = &self.own.differential {
            check_length("length of differential", differential.len(), y0.len())?;
        } else if self.own.suppress_algebraic {
            let help = "it needs `differential` to say which unknowns are algebraic";
            return Err(InputError::new("suppress_algebraic", true, help));
        }
        if let Some(sensitivities) = &self.sensitivities {
            sensitivities.check_for_dae()?;
        }
        if let LinearSolver::Krylov(krylov) = &self.linear_solver {
            krylov.check_for_dae()?;
        }
        Ok(())
    }
}

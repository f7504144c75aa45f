//! How the equations of an implicit step are solved.

use super::{
    context::Context, ffi, jacobian::Jacobian, linear_solver::LinearSolver, vector::Vector,
};
use crate::base::input::InputError;
use crate::integrators::common::{Error, check_count};

#[derive(Clone, Debug)]
pub(super) enum NonlinearSolver {
    Newton(LinearSolver),
    FixedPoint { acceleration: u32 },
}

/// Options of the integrators that can choose a nonlinear solver.
#[derive(Clone, Debug)]
pub(super) struct NonlinearOptions {
    pub(super) solver: NonlinearSolver,
    pub(super) max_steps_between_setups: Option<u32>,
}

impl Default for NonlinearOptions {
    fn default() -> Self {
        let solver = LinearSolver::Dense(Jacobian::DifferenceQuotients);
        Self { solver: NonlinearSolver::Newton(solver), max_steps_between_setups: None }
    }
}

impl NonlinearOptions {
    /// Checks that `n` equations can be solved so.
    pub(super) fn check(&self, n: usize) -> Result<(), InputError> {
        if let Some(steps) = self.max_steps_between_setups {
            check_count("max_steps_between_setups", steps)?;
        }
        match &self.solver {
            NonlinearSolver::FixedPoint { acceleration } if *acceleration > 100 => {
                let help = "a few iterates are enough, at most 100";
                Err(InputError::new("acceleration", acceleration, help))
            }
            NonlinearSolver::FixedPoint { .. } => Ok(()),
            NonlinearSolver::Newton(solver) => solver.check(n),
        }
    }

    pub(super) fn linear_solver(&self) -> Option<&LinearSolver> {
        match &self.solver {
            NonlinearSolver::Newton(solver) => Some(solver),
            NonlinearSolver::FixedPoint { .. } => None,
        }
    }
}

/// Owns a fixed-point nonlinear solver, which needs no Jacobian.
pub(super) struct FixedPoint(ffi::SUNNonlinearSolver);

impl FixedPoint {
    pub(super) fn new(
        template: &Vector,
        acceleration: u32,
        context: &Context,
    ) -> Result<Self, Error> {
        // SAFETY: vector and context are alive.
        let raw = unsafe {
            ffi::SUNNonlinSol_FixedPoint(template.raw(), acceleration as i32, context.raw())
        };
        if raw.is_null() {
            return Err(Error::out_of_memory("SUNNonlinSol_FixedPoint"));
        }
        Ok(Self(raw))
    }

    pub(super) fn raw(&self) -> ffi::SUNNonlinearSolver {
        self.0
    }
}

impl Drop for FixedPoint {
    fn drop(&mut self) {
        // SAFETY: made by SUNNonlinSol_FixedPoint and freed once, after the integrator.
        unsafe { ffi::SUNNonlinSolFree(self.0) };
    }
}

//! The fixed-point iteration, which solves the equations of an implicit step without a Jacobian.

use super::{context::Context, ffi, vector::Vector};
use crate::integrators::common::Error;

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

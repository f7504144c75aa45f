//! The backward problem of a DAE, by IDAS.

use super::{
    callbacks::{jacobian, quadratures, residual},
    end::start_of_backward_problem,
    system::AdjointDae,
};
use crate::integrators::{
    common::Error,
    ode::{Dae, Functional},
    sundials::{
        adjoint::{
            backward::{BackwardProblem, Point},
            equations::Equations,
            gradient::Gradient,
        },
        context::Context,
        ffi,
        functions::{BackwardFunctions, named},
        ida::{IdaKind, WITH_CHECKPOINTS},
        linear::Linear,
        vector::Vector,
    },
};

// SAFETY: the functions are those of IDA, and the callbacks are those for this system.
unsafe impl<S: Dae, F: Functional> BackwardProblem for AdjointDae<S, F> {
    type Kind = IdaKind;
    type System = S;
    type Functional = F;

    const FUNCTIONS: &'static BackwardFunctions = &BackwardFunctions {
        integrator: "IDA in the backward run",
        forward: &WITH_CHECKPOINTS,
        init_checkpoints: named!(IDAAdjInit),
        create: ("IDACreateB", |memory, which| {
            // SAFETY: whoever calls through the table vouches for the arguments.
            unsafe { ffi::IDACreateB(memory, which) }
        }),
        init: ("IDAInitB", |memory, which, t, lambda, slope| {
            // SAFETY: as above.
            unsafe { ffi::IDAInitB(memory, which, Some(residual::<S, F>), t, lambda, slope) }
        }),
        vector_tolerances: named!(IDASVtolerancesB),
        set_user_data: named!(IDASetUserDataB),
        set_max_steps: named!(IDASetMaxNumStepsB),
        set_linear_solver: named!(IDASetLinearSolverB),
        set_jacobian: ("IDASetJacFnB", |memory, which| {
            // SAFETY: as above.
            unsafe { ffi::IDASetJacFnB(memory, which, Some(jacobian::<S, F>)) }
        }),
        init_quadratures: ("IDAQuadInitB", |memory, which, integrals| {
            // SAFETY: as above.
            unsafe { ffi::IDAQuadInitB(memory, which, Some(quadratures::<S, F>), integrals) }
        }),
        set_quadrature_error_control: named!(IDASetQuadErrConB),
        quadrature_tolerances: named!(IDAQuadSVtolerancesB),
        solve: ffi::IDASolveB,
        get: ("IDAGetB", |memory, which, t, lambda, slope| {
            // SAFETY: as above.
            unsafe { ffi::IDAGetB(memory, which, t, lambda, slope) }
        }),
        get_quadratures: named!(IDAGetQuadB),
        get_memory: ffi::IDAGetAdjIDABmem,
        get_current_time: ffi::IDAGetCurrentTime,
        get_current_order: ffi::IDAGetCurrentOrder,
    };

    fn equations(&mut self) -> &mut Equations<S, F> {
        &mut self.equations
    }

    fn start_back(
        &mut self,
        at: Point<'_>,
        end: &mut Gradient,
        linear: &mut Linear,
        context: &Context,
    ) -> Result<(Vector, Option<Vector>), Error> {
        let (lambda, slope) = start_of_backward_problem(self, at, end, linear, context)?;
        Ok((lambda, Some(slope)))
    }

    fn by_initial_state(&self, lambda: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.mass.add_transposed_times(1.0, lambda, out);
    }
}

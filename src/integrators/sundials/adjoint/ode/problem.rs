//! The backward problem of an ODE, by CVODES.

use super::{
    callbacks::{jacobian, quadratures, rhs},
    system::AdjointSystem,
};
use crate::integrators::{
    common::Error,
    ode::{Functional, Ode},
    sundials::{
        adjoint::{
            backward::{BackwardProblem, Point},
            equations::Equations,
            gradient::Gradient,
        },
        context::Context,
        cvode::{CvodeKind, WITH_CHECKPOINTS},
        ffi,
        functions::{BackwardFunctions, named},
        linear::Linear,
        vector::Vector,
    },
};

// SAFETY: the functions are those of CVODE, and the callbacks are those for this system.
unsafe impl<S: Ode, F: Functional> BackwardProblem for AdjointSystem<S, F> {
    type Kind = CvodeKind;
    type System = S;
    type Functional = F;

    const FUNCTIONS: &'static BackwardFunctions = &BackwardFunctions {
        integrator: "CVODE in the backward run",
        forward: &WITH_CHECKPOINTS,
        init_checkpoints: named!(CVodeAdjInit),
        create: ("CVodeCreateB", |memory, which| {
            // SAFETY: whoever calls through the table vouches for the arguments.
            unsafe { ffi::CVodeCreateB(memory, ffi::CV_BDF, which) }
        }),
        init: ("CVodeInitB", |memory, which, t, lambda, _| {
            // SAFETY: as above.
            unsafe { ffi::CVodeInitB(memory, which, Some(rhs::<S, F>), t, lambda) }
        }),
        vector_tolerances: named!(CVodeSVtolerancesB),
        set_user_data: named!(CVodeSetUserDataB),
        set_max_steps: named!(CVodeSetMaxNumStepsB),
        set_linear_solver: named!(CVodeSetLinearSolverB),
        set_jacobian: ("CVodeSetJacFnB", |memory, which| {
            // SAFETY: as above.
            unsafe { ffi::CVodeSetJacFnB(memory, which, Some(jacobian::<S, F>)) }
        }),
        init_quadratures: ("CVodeQuadInitB", |memory, which, integrals| {
            // SAFETY: as above.
            unsafe { ffi::CVodeQuadInitB(memory, which, Some(quadratures::<S, F>), integrals) }
        }),
        set_quadrature_error_control: named!(CVodeSetQuadErrConB),
        quadrature_tolerances: named!(CVodeQuadSVtolerancesB),
        solve: ffi::CVodeB,
        get: ("CVodeGetB", |memory, which, t, lambda, _| {
            // SAFETY: as above.
            unsafe { ffi::CVodeGetB(memory, which, t, lambda) }
        }),
        get_quadratures: named!(CVodeGetQuadB),
        get_memory: ffi::CVodeGetAdjCVodeBmem,
        get_current_time: ffi::CVodeGetCurrentTime,
        get_current_order: ffi::CVodeGetCurrentOrder,
    };

    fn equations(&mut self) -> &mut Equations<S, F> {
        &mut self.equations
    }

    fn start_back(
        &mut self,
        _at: Point<'_>,
        end: &mut Gradient,
        _linear: &mut Linear,
        context: &Context,
    ) -> Result<(Vector, Option<Vector>), Error> {
        Ok((Vector::from_slice(&end.initial_state, context)?, None))
    }

    fn by_initial_state(&self, lambda: &[f64], out: &mut [f64]) {
        out.copy_from_slice(lambda);
    }
}

//! The backward problem of an ODE, by CVODES.

use super::system::AdjointSystem;
use crate::integrators::{
    common::{Callback, Error},
    ode::{Borrowed, Failure, Functional, Ode},
    sundials::{
        LinearSolver,
        adjoint::{
            backward::{BackwardProblem, Point},
            equations::Equations,
            gradient::Gradient,
        },
        callbacks::callbacks,
        context::Context,
        cvode::CvodeKind,
        ffi,
        functions::{BackwardFunctions, InitBackward, InitBackwardQuadratures, SetBackward},
        linear::Linear,
        matrix::stored,
        vector::Vector,
    },
};

callbacks! {
    /// `CVRhsFnB`
    fn rhs<S: Ode, F: Functional>(
        t: (time host), y: read, lambda: read, out: write, host: (data Borrowed<'_, AdjointSystem<S, F>>)
    ) {
        host.guard_output(Callback::Adjoint, t, out, |system, out| {
            system.0.backward_rhs(t, y, lambda, out)
        })
    }

    /// `CVQuadRhsFnB`
    fn quadratures<S: Ode, F: Functional>(
        t: (time host), y: read, lambda: read, out: write, host: (data Borrowed<'_, AdjointSystem<S, F>>)
    ) {
        host.guard_output(Callback::Adjoint, t, out, |system, out| {
            system.0.backward_quadratures(t, y, lambda, out)
        })
    }

    /// `CVLsJacFnB`
    fn jacobian<S: Ode, F: Functional>(
        t: (time host), y: read, _: vector, _: vector, jacobian: (ffi::SUNMatrix),
        host: (data Borrowed<'_, AdjointSystem<S, F>>), _: vector, _: vector, _: vector
    ) {
        // SAFETY: SUNDIALS passes the matrix that was made for this linear solver.
        let values = unsafe { stored(jacobian, &host.system.0.equations.backward, host.n) };
        host.guard_output(Callback::Adjoint, t, values, |system, values| {
            system.0.backward_jacobian(t, y, values)
        })
    }

    /// `CVLsJacTimesVecFnB`
    fn jacobian_times<S: Ode, F: Functional>(
        v: read, out: write, t: (time host), y: read, _: vector, _: vector,
        host: (data Borrowed<'_, AdjointSystem<S, F>>), _: vector
    ) {
        host.guard_output(Callback::Adjoint, t, out, |system, out| {
            system.0.backward_product(t, y, v, out)
        })
    }

    /// `CVLsPrecSetupFnB`
    fn precondition_setup<S: Ode, F: Functional>(
        t: (time host), y: read, _: vector, _: vector, reuse: i32, current: (result i32), gamma: f64,
        host: (data Borrowed<'_, AdjointSystem<S, F>>)
    ) {
        host.guard(Callback::Adjoint, t, |system| {
            *current = i32::from(system.0.backward_setup(t, y, gamma, reuse != 0)?);
            Ok(())
        })
    }

    /// `CVLsPrecSolveFnB`
    fn precondition_solve<S: Ode, F: Functional>(
        t: (time host), _: vector, _: vector, _: vector, r: read, z: write, _: f64, _: f64, _: i32,
        host: (data Borrowed<'_, AdjointSystem<S, F>>)
    ) {
        z.copy_from_slice(r);
        host.guard_output(Callback::Adjoint, t, z, |system, z| {
            system.0.backward_solve(z);
            Ok(())
        })
    }
}

// SAFETY: the functions are those of CVODE, and the callbacks are those for this system.
unsafe impl<S: Ode, F: Functional> BackwardProblem for AdjointSystem<S, F> {
    type Kind = CvodeKind;
    type System = S;
    type Functional = F;

    const FUNCTIONS: &'static BackwardFunctions = BackwardFunctions::CVODE;

    const INIT: InitBackward = ("CVodeInitB", |memory, which, t, lambda, _| {
        // SAFETY: whoever calls it vouches for the arguments.
        unsafe { ffi::CVodeInitB(memory, which, Some(rhs::<S, F>), t, lambda) }
    });

    const SET_JACOBIAN: SetBackward = ("CVodeSetJacFnB", |memory, which, solver| {
        let LinearSolver::Krylov(krylov) = solver else {
            // SAFETY: as above.
            return unsafe { ffi::CVodeSetJacFnB(memory, which, Some(jacobian::<S, F>)) };
        };
        // SAFETY: as above.
        unsafe {
            let times = Some(jacobian_times::<S, F> as _);
            let (set_up, solve) =
                (Some(precondition_setup::<S, F> as _), Some(precondition_solve::<S, F> as _));
            let mut codes = [ffi::CVodeSetJacTimesB(memory, which, None, times), 0, 0];
            if krylov.preconditioner.is_some() {
                codes[1] = ffi::CVodeSetPreconditionerB(memory, which, set_up, solve);
            }
            if let Some(factor) = krylov.tolerance_factor {
                codes[2] = ffi::CVodeSetEpsLinB(memory, which, factor);
            }
            codes.into_iter().min().unwrap_or(0)
        }
    });

    const INIT_QUADRATURES: InitBackwardQuadratures =
        ("CVodeQuadInitB", |memory, which, integrals| {
            // SAFETY: as above.
            unsafe { ffi::CVodeQuadInitB(memory, which, Some(quadratures::<S, F>), integrals) }
        });

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

    fn by_initial_state(&mut self, lambda: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        out.copy_from_slice(lambda);
        Ok(())
    }
}

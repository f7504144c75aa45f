//! The backward problem of a DAE, by IDAS.

use super::{end::start_of_backward_problem, system::AdjointDae};
use crate::integrators::{
    common::{Callback, Error},
    ode::{Borrowed, Dae, Failure, Functional},
    sundials::{
        LinearSolver,
        adjoint::{
            backward::{BackwardProblem, Point},
            equations::Equations,
            gradient::Gradient,
        },
        callbacks::callbacks,
        context::Context,
        ffi,
        functions::{BackwardFunctions, InitBackward, InitBackwardQuadratures, SetBackward},
        ida::IdaKind,
        linear::Linear,
        matrix::stored,
        vector::Vector,
    },
};

callbacks! {
    /// `IDAResFnB`
    fn residual<S: Dae, F: Functional>(
        t: (time host), y: read, yp: read, lambda: read, slope: read, out: write,
        host: (data Borrowed<'_, AdjointDae<S, F>>)
    ) {
        host.guard_output(Callback::Adjoint, t, out, |system, out| {
            system.0.backward_residual((t, y, yp), (lambda, slope), out)
        })
    }

    /// `IDAQuadRhsFnB`
    fn quadratures<S: Dae, F: Functional>(
        t: (time host), y: read, yp: read, lambda: read, _: vector, out: write,
        host: (data Borrowed<'_, AdjointDae<S, F>>)
    ) {
        host.guard_output(Callback::Adjoint, t, out, |system, out| {
            system.0.backward_quadratures((t, y, yp), lambda, out)
        })
    }

    /// `IDALsJacFnB`
    fn jacobian<S: Dae, F: Functional>(
        t: (time host), cj: f64, y: read, yp: read, _: vector, _: vector, _: vector, jacobian: (ffi::SUNMatrix),
        host: (data Borrowed<'_, AdjointDae<S, F>>), _: vector, _: vector, _: vector
    ) {
        // SAFETY: SUNDIALS passes the matrix that was made for this linear solver.
        let values = unsafe { stored(jacobian, &host.system.0.equations.backward, host.n) };
        host.guard_output(Callback::Adjoint, t, values, |system, values| {
            system.0.backward_jacobian((t, y, yp), cj, values)
        })
    }

    /// `IDALsJacTimesVecFnB`
    fn jacobian_times<S: Dae, F: Functional>(
        t: (time host), y: read, yp: read, _: vector, _: vector, _: vector, v: read, out: write, cj: f64,
        host: (data Borrowed<'_, AdjointDae<S, F>>), _: vector, _: vector
    ) {
        host.guard_output(Callback::Adjoint, t, out, |system, out| {
            system.0.transposed_times((t, y, yp), [-1.0, cj], v, out)
        })
    }

    /// `IDALsPrecSetupFnB`
    fn precondition_setup<S: Dae, F: Functional>(
        t: (time host), y: read, yp: read, _: vector, _: vector, _: vector, cj: f64,
        host: (data Borrowed<'_, AdjointDae<S, F>>)
    ) {
        host.guard(Callback::Adjoint, t, |system| system.0.backward_setup((t, y, yp), cj))
    }

    /// `IDALsPrecSolveFnB`
    fn precondition_solve<S: Dae, F: Functional>(
        t: (time host), _: vector, _: vector, _: vector, _: vector, _: vector, r: read, z: write, _: f64, _: f64,
        host: (data Borrowed<'_, AdjointDae<S, F>>)
    ) {
        z.copy_from_slice(r);
        host.guard_output(Callback::Adjoint, t, z, |system, z| {
            system.0.backward_solve(z);
            Ok(())
        })
    }
}

// SAFETY: the functions are those of IDA, and the callbacks are those for this system.
unsafe impl<S: Dae, F: Functional> BackwardProblem for AdjointDae<S, F> {
    type Kind = IdaKind;
    type System = S;
    type Functional = F;

    const FUNCTIONS: &'static BackwardFunctions = BackwardFunctions::IDA;

    const INIT: InitBackward = ("IDAInitB", |memory, which, t, lambda, slope| {
        // SAFETY: whoever calls it vouches for the arguments.
        unsafe { ffi::IDAInitB(memory, which, Some(residual::<S, F>), t, lambda, slope) }
    });

    const SET_JACOBIAN: SetBackward = ("IDASetJacFnB", |memory, which, solver| {
        let LinearSolver::Krylov(krylov) = solver else {
            // SAFETY: as above.
            return unsafe { ffi::IDASetJacFnB(memory, which, Some(jacobian::<S, F>)) };
        };
        // SAFETY: as above.
        unsafe {
            let times = Some(jacobian_times::<S, F> as _);
            let (set_up, solve) =
                (Some(precondition_setup::<S, F> as _), Some(precondition_solve::<S, F> as _));
            let mut codes = [ffi::IDASetJacTimesB(memory, which, None, times), 0, 0];
            if krylov.preconditioner.is_some() {
                codes[1] = ffi::IDASetPreconditionerB(memory, which, set_up, solve);
            }
            if let Some(factor) = krylov.tolerance_factor {
                codes[2] = ffi::IDASetEpsLinB(memory, which, factor);
            }
            codes.into_iter().min().unwrap_or(0)
        }
    });

    const INIT_QUADRATURES: InitBackwardQuadratures =
        ("IDAQuadInitB", |memory, which, integrals| {
            // SAFETY: as above.
            unsafe { ffi::IDAQuadInitB(memory, which, Some(quadratures::<S, F>), integrals) }
        });

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

    fn by_initial_state(&mut self, lambda: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.mass_times(lambda, out)
    }
}

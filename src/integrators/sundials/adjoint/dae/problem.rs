//! The backward problem of a DAE, by IDAS.

use super::{end::start_of_backward_problem, system::AdjointDae};
use crate::integrators::{
    common::{Callback, Error},
    ode::{Borrowed, Dae, Functional},
    sundials::{
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

    const SET_JACOBIAN: SetBackward = ("IDASetJacFnB", |memory, which, _| {
        // SAFETY: as above.
        unsafe { ffi::IDASetJacFnB(memory, which, Some(jacobian::<S, F>)) }
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

    fn by_initial_state(&self, lambda: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.mass.add_transposed_times(1.0, lambda, out);
    }
}

//! The backward problem of an ODE, by CVODES.

use super::system::AdjointSystem;
use crate::integrators::{
    common::{Callback, Error},
    ode::{Borrowed, Functional, Ode},
    sundials::{
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

    const SET_JACOBIAN: SetBackward = ("CVodeSetJacFnB", |memory, which| {
        // SAFETY: as above.
        unsafe { ffi::CVodeSetJacFnB(memory, which, Some(jacobian::<S, F>)) }
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

    fn by_initial_state(&self, lambda: &[f64], out: &mut [f64]) {
        out.copy_from_slice(lambda);
    }
}

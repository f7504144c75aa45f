//! The C functions through which IDAS evaluates the equations of the backward run.
//!
//! All of them get the [`Host`] of the solver as their data pointer and vectors of its length;
//! that is what their SAFETY comments refer to.

use std::ffi::c_void;

use super::system::AdjointDae;
use crate::integrators::{
    common::Callback,
    ode::{Borrowed, Dae, Functional},
    sundials::{
        ffi,
        host::Host,
        matrix,
        vector::{slice, slice_mut},
    },
};

/// `IDAResFnB`
pub(super) unsafe extern "C" fn residual<S: Dae, F: Functional>(
    t: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    lambda: ffi::N_Vector,
    slope: ffi::N_Vector,
    out: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module; `out` is a separate vector.
    let (host, y, yp, lambda, slope, out) = unsafe {
        let host = &mut *data.cast::<Host<Borrowed<'_, AdjointDae<S, F>>>>();
        let n = host.n;
        let (y, yp) = (slice(y, n), slice(yp, n));
        (host, y, yp, slice(lambda, n), slice(slope, n), slice_mut(out, n))
    };
    host.guard_output(Callback::Adjoint, t, out, |system, out| {
        system.0.backward_residual((t, y, yp), (lambda, slope), out)
    })
}

/// `IDAQuadRhsFnB`
pub(super) unsafe extern "C" fn quadratures<S: Dae, F: Functional>(
    t: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    lambda: ffi::N_Vector,
    _: ffi::N_Vector,
    out: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module; `out` has as many places as there are parameters.
    let (host, y, yp, lambda, out) = unsafe {
        let host = &mut *data.cast::<Host<Borrowed<'_, AdjointDae<S, F>>>>();
        let n = host.n;
        let count = (*(*out).content.cast::<ffi::_N_VectorContent_Serial>()).length as usize;
        (host, slice(y, n), slice(yp, n), slice(lambda, n), slice_mut(out, count))
    };
    host.guard_output(Callback::Adjoint, t, out, |system, out| {
        system.0.backward_quadratures((t, y, yp), lambda, out)
    })
}

/// `IDALsJacFnB`
#[allow(clippy::too_many_arguments)] // as C has it
pub(super) unsafe extern "C" fn jacobian<S: Dae, F: Functional>(
    t: f64,
    cj: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    jacobian: ffi::SUNMatrix,
    data: *mut c_void,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
) -> i32 {
    // SAFETY: see the module.
    let (host, y, yp) = unsafe {
        let host = &mut *data.cast::<Host<Borrowed<'_, AdjointDae<S, F>>>>();
        let n = host.n;
        (host, slice(y, n), slice(yp, n))
    };
    // SAFETY: SUNDIALS passes the matrix that was made for this linear solver.
    let entries = unsafe { matrix::entries(jacobian, &host.system.0.equations.backward, host.n) };
    let outcome = host
        .guard(Callback::Adjoint, t, |system| system.0.backward_jacobian((t, y, yp), cj, entries));
    if outcome != 0 {
        return outcome;
    }
    // SAFETY: as above; the access through `entries` has ended.
    let values = unsafe { matrix::stored(jacobian, &host.system.0.equations.backward, host.n) };
    host.check_finite(Callback::Adjoint, t, values)
}

//! The C functions through which IDAS evaluates the equations of the backward run.
//!
//! All of them get the [`Host`] of the solver as their data pointer, and live serial vectors; those that they
//! fill are different from the others. That is what their SAFETY comments refer to.

use std::ffi::c_void;

use super::system::AdjointDae;
use crate::integrators::{
    common::Callback,
    ode::{Borrowed, Dae, Functional},
    sundials::{
        ffi,
        host::Host,
        matrix::stored,
        serial::{slice, slice_mut},
    },
};

type HostOf<'a, S, F> = Host<Borrowed<'a, AdjointDae<S, F>>>;

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
    // SAFETY: see the module.
    let (host, y, yp, lambda, slope, out) = unsafe {
        let host = HostOf::<S, F>::of(data);
        (host, slice(y), slice(yp), slice(lambda), slice(slope), slice_mut(out))
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
    // SAFETY: see the module.
    let (host, y, yp, lambda, out) =
        unsafe { (HostOf::<S, F>::of(data), slice(y), slice(yp), slice(lambda), slice_mut(out)) };
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
    // SAFETY: see the module; SUNDIALS passes the matrix that was made for this linear solver.
    let (host, y, yp, values) = unsafe {
        let host = HostOf::<S, F>::of(data);
        let values = stored(jacobian, &host.system.0.equations.backward, host.n);
        (host, slice(y), slice(yp), values)
    };
    host.guard_output(Callback::Adjoint, t, values, |system, values| {
        system.0.backward_jacobian((t, y, yp), cj, values)
    })
}

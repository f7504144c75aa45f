//! The C functions through which IDA calls a [`Dae`].
//!
//! All of them get the [`Host`] of the solver as their data pointer and vectors of its length;
//! that is what their SAFETY comments refer to.

use std::ffi::c_void;

use super::{
    ffi,
    host::{Host, STOP},
    matrix::{self, Entries},
    vector::{slice, slice_mut},
};
use crate::{integrate::Callback, ode::Dae};

/// `IDAResFn`
pub(super) unsafe extern "C" fn residual<S: Dae>(
    t: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    residual: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module; the three vectors are different.
    let (host, y, yp, residual) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        (host, slice(y, n), slice(yp, n), slice_mut(residual, n))
    };
    host.guard_output(Callback::Residual, t, residual, |system, residual| {
        system.residual(t, y, yp, residual)
    })
}

/// `IDARootFn`
pub(super) unsafe extern "C" fn roots<S: Dae>(
    t: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    g: *mut f64,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module; `g` has as many places as root functions were declared.
    let (host, y, yp, g) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let (n, count) = (host.n, host.root_count);
        (host, slice(y, n), slice(yp, n), std::slice::from_raw_parts_mut(g, count))
    };
    host.guard_output(Callback::Roots, t, g, |system, g| system.roots(t, y, yp, g))
}

/// `IDALsJacFn`; for a user-supplied solver it sets up the matrix that the system keeps.
#[allow(clippy::too_many_arguments)] // as C has it
pub(super) unsafe extern "C" fn jacobian<S: Dae>(
    t: f64,
    cj: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    _: ffi::N_Vector,
    jacobian: ffi::SUNMatrix,
    data: *mut c_void,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
) -> i32 {
    // SAFETY: see the module.
    let (host, y, yp) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        (host, slice(y, n), slice(yp, n))
    };
    host.setup_time = t;
    let Some(solver) = &host.linear_solver else { return STOP };
    // SAFETY: SUNDIALS passes the matrix that was made for this linear solver.
    let entries = unsafe { matrix::entries(jacobian, solver, host.n) };
    let callback = match entries {
        Entries::Custom => Callback::NewtonSetup,
        _ => Callback::Jacobian,
    };
    let outcome = host.guard(callback, t, |system| match entries {
        Entries::Dense(matrix) => system.dense_jacobian(t, cj, y, yp, matrix),
        Entries::Band(matrix) => system.banded_jacobian(t, cj, y, yp, matrix),
        Entries::Sparse(values) => system.sparse_jacobian(t, cj, y, yp, values),
        Entries::Custom => system.newton_setup(t, cj, y, yp),
    });
    if outcome != 0 {
        return outcome;
    }
    let Some(solver) = &host.linear_solver else { return STOP };
    // SAFETY: as above; the user's access has ended.
    let values = unsafe { matrix::stored(jacobian, solver, host.n) };
    host.check_finite(callback, t, values)
}

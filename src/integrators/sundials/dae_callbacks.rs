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
use crate::integrators::{
    common::{Callback, Point},
    ode::{Dae, Failure, call},
};

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
        call::residual(system, t, y, yp, residual)
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
    host.guard_output(Callback::Roots, t, g, |system, g| call::dae_roots(system, t, y, yp, g))
}

/// `IDAQuadRhsFn`
pub(super) unsafe extern "C" fn quadratures<S: Dae>(
    t: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    qdot: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module; `qdot` has as many places as integrals were declared.
    let (host, y, yp, qdot) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let (n, count) = (host.n, host.quadrature_count);
        (host, slice(y, n), slice(yp, n), slice_mut(qdot, count))
    };
    host.guard_output(Callback::Quadratures, t, qdot, |system, qdot| {
        call::dae_quadratures(system, t, y, yp, qdot)
    })
}

/// `IDALsJacFn`; for a user-supplied solver it sets up the matrix that the system keeps.
#[allow(clippy::too_many_arguments)] // as C has it
pub(super) unsafe extern "C" fn jacobian<S: Dae>(
    t: f64,
    cj: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    residual: ffi::N_Vector,
    jacobian: ffi::SUNMatrix,
    data: *mut c_void,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
) -> i32 {
    // SAFETY: see the module.
    let (host, y, yp, residual) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        (host, slice(y, n), slice(yp, n), slice(residual, n))
    };
    host.setup_time = t;
    let Some(solver) = &host.linear_solver else { return STOP };
    // SAFETY: SUNDIALS passes the matrix that was made for this linear solver.
    let entries = unsafe { matrix::entries(jacobian, solver, host.n) };
    let callback = match entries {
        Entries::Custom => Callback::NewtonSetup,
        _ => Callback::Jacobian,
    };
    let outcome = match entries {
        Entries::Dense(matrix) => {
            host.guard(callback, t, |system| system.dense_jacobian(t, cj, y, yp, matrix))
        }
        Entries::Band(matrix) => {
            host.guard(callback, t, |system| system.banded_jacobian(t, cj, y, yp, matrix))
        }
        Entries::Sparse(values) => sparse_jacobian(host, t, (cj, y, yp), residual, values),
        Entries::Custom => host.guard(callback, t, |system| system.newton_setup(t, cj, y, yp)),
    };
    if outcome != 0 {
        return outcome;
    }
    let Some(solver) = &host.linear_solver else { return STOP };
    // SAFETY: as above; the user's access has ended.
    let values = unsafe { matrix::stored(jacobian, solver, host.n) };
    match host.check_finite(callback, t, values) {
        0 => check_jacobian(host, t, (cj, y, yp), values, |_, _, _| Ok(())),
        failed => failed,
    }
}

/// Checks the dF/dy + cj dF/dy' that the system has just supplied: its entries, or the products that `times`
/// writes.
pub(super) fn check_jacobian<S: Dae>(
    host: &mut Host<S>,
    t: f64,
    (cj, y, yp): (f64, &[f64], &[f64]),
    values: &[f64],
    times: impl FnMut(&mut S, &[f64], &mut [f64]) -> Result<(), Failure>,
) -> i32 {
    let evaluate = |system: &mut S, [y, yp]: [&[f64]; 2], out: &mut [f64]| {
        call::residual(system, t, y, yp, out)
    };
    host.check_jacobian(t, Point { y, yp, cj }, values, times, evaluate)
}

/// The values of dF/dy + cj dF/dy' on the pattern of the linear solver: the system's own, or difference
/// quotients.
pub(super) fn sparse_jacobian<S: Dae>(
    host: &mut Host<S>,
    t: f64,
    (cj, y, yp): (f64, &[f64], &[f64]),
    residual: &[f64],
    values: &mut [f64],
) -> i32 {
    // Taken out of the host, which calls the system meanwhile.
    let (Some(mut differences), Some(mut scales)) = (host.differences.take(), host.scales.take())
    else {
        let call = |system: &mut S| system.sparse_jacobian(t, cj, y, yp, values);
        return host.guard(Callback::Jacobian, t, call);
    };
    let (at, scale) = ((cj, y, yp), scales.read());
    let outcome = differences.of_residual(at, scale, residual, values, |y, yp, residual| {
        host.guard_output(Callback::Residual, t, residual, |system, r| {
            call::residual(system, t, y, yp, r)
        })
    });
    (host.differences, host.scales) = (Some(differences), Some(scales));
    outcome
}

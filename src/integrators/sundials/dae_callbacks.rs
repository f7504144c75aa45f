//! The C functions through which IDA calls a [`Dae`].
//!
//! All of them get the [`Host`] of the solver as their data pointer, and live serial vectors; those that they
//! fill are different from the others. That is what their SAFETY comments refer to.

use std::ffi::c_void;

use super::{
    ffi,
    host::Host,
    linear_solver::LinearSolver,
    serial::{slice, slice_mut},
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
    // SAFETY: see the module.
    let (host, y, yp, residual) =
        unsafe { (Host::<S>::of(data), slice(y), slice(yp), slice_mut(residual)) };
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
        let host = Host::<S>::of(data);
        let g = std::slice::from_raw_parts_mut(g, host.root_count);
        (host, slice(y), slice(yp), g)
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
    // SAFETY: see the module.
    let (host, y, yp, qdot) =
        unsafe { (Host::<S>::of(data), slice(y), slice(yp), slice_mut(qdot)) };
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
    // SAFETY: see the module; SUNDIALS passes the matrix that was made for the linear solver of the host.
    let (host, y, yp, residual, values) = unsafe {
        let host = Host::<S>::of(data);
        let values = host.stored(jacobian);
        (host, slice(y), slice(yp), slice(residual), values)
    };
    host.setup_time = t;
    if matches!(host.linear_solver, Some(LinearSolver::Custom)) {
        return host.guard(Callback::NewtonSetup, t, |system| system.newton_setup(t, cj, y, yp));
    }
    match evaluate_jacobian(host, t, (cj, y, yp), residual, values) {
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

/// The values of dF/dy + cj dF/dy' that the linear solver or its preconditioner stores: difference quotients,
/// or the system's own.
pub(super) fn evaluate_jacobian<S: Dae>(
    host: &mut Host<S>,
    t: f64,
    (cj, y, yp): (f64, &[f64], &[f64]),
    residual: &[f64],
    values: &mut [f64],
) -> i32 {
    // Taken out of the host, which calls the system meanwhile.
    let (Some(mut differences), Some(mut scales)) = (host.differences.take(), host.scales.take())
    else {
        return host.guard_entries(Callback::Jacobian, t, values, |system, entries| {
            entries.dae_jacobian(system, t, cj, y, yp)
        });
    };
    let (at, scale) = ((cj, y, yp), scales.read());
    let outcome = differences.of_residual(at, scale, residual, values, |y, yp, residual| {
        host.guard_output(Callback::Residual, t, residual, |system, r| {
            call::residual(system, t, y, yp, r)
        })
    });
    (host.differences, host.scales) = (Some(differences), Some(scales));
    match outcome {
        0 => host.check_finite(Callback::Jacobian, t, values),
        failed => failed,
    }
}

//! The C functions through which CVODE (and ARKODE) calls an [`Ode`].
//!
//! All of them get the [`Host`] of the solver as their data pointer, and live serial vectors; those that they
//! fill are different from the others. That is what their SAFETY comments refer to.

use std::ffi::c_void;

use super::{
    ffi,
    host::Host,
    serial::{slice, slice_mut},
};
use crate::integrators::{
    common::{Callback, Point},
    ode::{Failure, Ode, call},
};

/// `CVRhsFn`
pub(super) unsafe extern "C" fn rhs<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: both have the same contract.
    unsafe { evaluate(t, y, ydot, data, Callback::Rhs, call::rhs::<S>) }
}

/// `ARKRhsFn` of the explicit part.
pub(super) unsafe extern "C" fn explicit_rhs<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: both have the same contract.
    unsafe { evaluate(t, y, ydot, data, Callback::ExplicitRhs, call::explicit_rhs::<S>) }
}

/// `CVRhsFn`, within the Newton iteration of a user-supplied solver.
pub(super) unsafe extern "C" fn newton_rhs<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: both have the same contract.
    unsafe { evaluate(t, y, ydot, data, Callback::Rhs, call::newton_rhs::<S>) }
}

/// `CVQuadRhsFn`
pub(super) unsafe extern "C" fn quadratures<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    qdot: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: both have the same contract.
    unsafe { evaluate(t, y, qdot, data, Callback::Quadratures, call::quadratures::<S>) }
}

/// A method of [`Ode`] that writes a right-hand side.
type Rhs<S> = fn(&mut S, f64, &[f64], &mut [f64]) -> Result<(), Failure>;

/// The common part of the right-hand sides: `call` writes into `ydot`.
///
/// # Safety
/// That of `CVRhsFn`; see the module.
unsafe fn evaluate<S>(
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    data: *mut c_void,
    callback: Callback,
    call: Rhs<S>,
) -> i32 {
    // SAFETY: see the module.
    let (host, y, ydot) = unsafe { (Host::<S>::of(data), slice(y), slice_mut(ydot)) };
    host.guard_output(callback, t, ydot, |system, ydot| call(system, t, y, ydot))
}

/// `CVRootFn`
pub(super) unsafe extern "C" fn roots<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    g: *mut f64,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module; `g` has as many places as root functions were declared.
    let (host, y, g) = unsafe {
        let host = Host::<S>::of(data);
        let g = std::slice::from_raw_parts_mut(g, host.root_count);
        (host, slice(y), g)
    };
    host.guard_output(Callback::Roots, t, g, |system, g| call::roots(system, t, y, g))
}

/// `CVProjFn`
pub(super) unsafe extern "C" fn project<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    correction: ffi::N_Vector,
    _tolerance: f64,
    error: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module; the vector of the error estimate exists, as the estimate is never switched off.
    let (host, y, correction, error) =
        unsafe { (Host::<S>::of(data), slice(y), slice_mut(correction), slice_mut(error)) };
    correction.fill(0.0);
    let outcome = host.guard_output(Callback::Projection, t, correction, |system, correction| {
        system.project(t, y, correction, error)
    });
    if outcome == 0 { host.check_finite(Callback::Projection, t, error) } else { outcome }
}

/// `CVLsJacFn`
#[allow(clippy::too_many_arguments)] // as C has it
pub(super) unsafe extern "C" fn jacobian<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    jacobian: ffi::SUNMatrix,
    data: *mut c_void,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
) -> i32 {
    // SAFETY: see the module; SUNDIALS passes the matrix that was made for the linear solver of the host.
    let (host, y, ydot, values) = unsafe {
        let host = Host::<S>::of(data);
        let values = host.stored(jacobian);
        (host, slice(y), slice(ydot), values)
    };
    match evaluate_jacobian(host, t, y, ydot, values) {
        0 => check_jacobian(host, t, y, values, |_, _, _| Ok(())),
        failed => failed,
    }
}

/// Checks the df/dy that the system has just supplied: its entries, or the products that `times` writes.
pub(super) fn check_jacobian<S: Ode>(
    host: &mut Host<S>,
    t: f64,
    y: &[f64],
    values: &[f64],
    times: impl FnMut(&mut S, &[f64], &mut [f64]) -> Result<(), Failure>,
) -> i32 {
    let point = Point { y, yp: &[], cj: 0.0 };
    host.check_jacobian(t, point, values, times, |system, [y, _], ydot| {
        call::rhs(system, t, y, ydot)
    })
}

/// The values of df/dy that the linear solver or its preconditioner stores: difference quotients, or the
/// system's own.
pub(super) fn evaluate_jacobian<S: Ode>(
    host: &mut Host<S>,
    t: f64,
    y: &[f64],
    ydot: &[f64],
    values: &mut [f64],
) -> i32 {
    // Taken out of the host, which calls the system meanwhile.
    let Some(mut differences) = host.differences.take() else {
        return host.guard_entries(Callback::Jacobian, t, values, |system, entries| {
            entries.jacobian(system, t, y, ydot)
        });
    };
    let outcome = differences.of_rhs(y, ydot, values, &mut |y, ydot| {
        let evaluate = |system: &mut S, ydot: &mut [f64]| call::rhs(system, t, y, ydot);
        match host.guard_output(Callback::Rhs, t, ydot, evaluate) {
            0 => Ok(()),
            failed => Err(failed),
        }
    });
    host.differences = Some(differences);
    match outcome {
        Ok(()) => host.check_finite(Callback::Jacobian, t, values),
        Err(failed) => failed,
    }
}

/// `ARKExpStabFn`: notes the time that whole steps have reached, and sets no limit to the step size.
pub(super) unsafe extern "C" fn note_time<S>(
    _: ffi::N_Vector,
    t: f64,
    limit: *mut f64,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module; `limit` is a valid place for the result.
    unsafe {
        Host::<S>::of(data).step_end = Some(t);
        *limit = 0.0;
    }
    0
}

/// `ARKPostProcessFn`: the same for steps of a fixed size, which have no limit.
pub(super) unsafe extern "C" fn note_step_end<S>(
    t: f64,
    _: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module.
    unsafe { Host::<S>::of(data) }.step_end = Some(t);
    0
}

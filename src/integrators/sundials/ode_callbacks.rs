//! The C functions through which CVODE (and ARKODE) calls an [`Ode`].
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
    // SAFETY: see the module; `y` and `ydot` are different vectors.
    let (host, y, ydot) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        (host, slice(y, n), slice_mut(ydot, n))
    };
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
        let host = &mut *data.cast::<Host<S>>();
        let (n, count) = (host.n, host.root_count);
        (host, slice(y, n), std::slice::from_raw_parts_mut(g, count))
    };
    host.guard_output(Callback::Roots, t, g, |system, g| call::roots(system, t, y, g))
}

/// `CVQuadRhsFn`
pub(super) unsafe extern "C" fn quadratures<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    qdot: ffi::N_Vector,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module; `qdot` has as many places as integrals were declared.
    let (host, y, qdot) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let (n, count) = (host.n, host.quadrature_count);
        (host, slice(y, n), slice_mut(qdot, count))
    };
    host.guard_output(Callback::Quadratures, t, qdot, |system, qdot| {
        call::quadratures(system, t, y, qdot)
    })
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
    // SAFETY: see the module; the three vectors are different, and the vector of the error estimate exists,
    // as the estimate is never switched off.
    let (host, y, correction, error) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        (host, slice(y, n), slice_mut(correction, n), slice_mut(error, n))
    };
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
    // SAFETY: see the module.
    let (host, y, ydot) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        (host, slice(y, n), slice(ydot, n))
    };
    let Some(solver) = &host.linear_solver else { return STOP };
    // SAFETY: SUNDIALS passes the matrix that was made for this linear solver.
    let entries = unsafe { matrix::entries(jacobian, solver, host.n) };
    let callback = Callback::Jacobian;
    let outcome = match entries {
        _ if host.differences.is_some() => {
            // SAFETY: as above; the entries are not used.
            let values = unsafe { matrix::stored(jacobian, solver, host.n) };
            sparse_jacobian(host, t, y, ydot, values)
        }
        Entries::Dense(matrix) => {
            host.guard(callback, t, |system| system.dense_jacobian(t, y, ydot, matrix))
        }
        Entries::Band(matrix) => {
            host.guard(callback, t, |system| system.banded_jacobian(t, y, ydot, matrix))
        }
        Entries::Sparse(values) => sparse_jacobian(host, t, y, ydot, values),
        Entries::Custom => unreachable!("a custom solver sets up its own matrix"),
    };
    if outcome != 0 {
        return outcome;
    }
    let Some(solver) = &host.linear_solver else { return STOP };
    // SAFETY: as above; the user's access has ended.
    let values = unsafe { matrix::stored(jacobian, solver, host.n) };
    match host.check_finite(Callback::Jacobian, t, values) {
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

/// The values of df/dy: difference quotients, or the system's own on the pattern of the linear solver.
pub(super) fn sparse_jacobian<S: Ode>(
    host: &mut Host<S>,
    t: f64,
    y: &[f64],
    ydot: &[f64],
    values: &mut [f64],
) -> i32 {
    // Taken out of the host, which calls the system meanwhile.
    let Some(mut differences) = host.differences.take() else {
        let call = |system: &mut S| system.sparse_jacobian(t, y, ydot, values);
        return host.guard(Callback::Jacobian, t, call);
    };
    let outcome = differences.of_rhs(y, ydot, values, |y, ydot| {
        let evaluate = |system: &mut S, ydot: &mut [f64]| call::rhs(system, t, y, ydot);
        match host.guard_output(Callback::Rhs, t, ydot, evaluate) {
            0 => Ok(()),
            failed => Err(failed),
        }
    });
    host.differences = Some(differences);
    outcome.err().unwrap_or(0)
}

/// `ARKLsLinSysFn`: as [`newton_setup`], with an argument for the mass matrix; there is none here.
#[allow(clippy::too_many_arguments)] // as C has it
pub(super) unsafe extern "C" fn newton_setup_with_mass<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    matrix: ffi::SUNMatrix,
    _mass: ffi::SUNMatrix,
    reuse: i32,
    current: *mut i32,
    gamma: f64,
    data: *mut c_void,
    a: ffi::N_Vector,
    b: ffi::N_Vector,
    c: ffi::N_Vector,
) -> i32 {
    // SAFETY: both have the same contract.
    unsafe { newton_setup::<S>(t, y, ydot, matrix, reuse, current, gamma, data, a, b, c) }
}

/// `CVLsLinSysFn`: for a user-supplied solver, which stores I - gamma J itself.
#[allow(clippy::too_many_arguments)] // as C has it
pub(super) unsafe extern "C" fn newton_setup<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    _: ffi::SUNMatrix,
    reuse: i32,
    current: *mut i32,
    gamma: f64,
    data: *mut c_void,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
) -> i32 {
    // SAFETY: see the module.
    let (host, y, ydot) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        (host, slice(y, n), slice(ydot, n))
    };
    host.setup_time = t;
    let mut fresh = false;
    let outcome = host.guard(Callback::NewtonSetup, t, |system| {
        fresh = system.newton_setup(t, y, ydot, gamma, reuse != 0)?;
        Ok(())
    });
    // SAFETY: `current` is a valid place for the result.
    unsafe { *current = i32::from(fresh) };
    outcome
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
        (*data.cast::<Host<S>>()).step_end = Some(t);
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
    unsafe { (*data.cast::<Host<S>>()).step_end = Some(t) };
    0
}

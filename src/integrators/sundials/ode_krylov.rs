//! The C functions through which CVODE or ARKODE solves linear systems without a matrix of their own: by the
//! solver of an [`Ode`], or by a Krylov method.
//!
//! All of them get the [`Host`] of the solver as their data pointer, and live serial vectors; those that they
//! fill are different from the others. That is what their SAFETY comments refer to.

use std::ffi::c_void;

use super::{
    ffi,
    host::Host,
    ode_callbacks::{check_jacobian, evaluate_jacobian},
    serial::{slice, slice_mut},
};
use crate::integrators::{
    common::Callback,
    ode::{Ode, call},
};

/// `CVLsJacTimesVecFn`
pub(super) unsafe extern "C" fn jacobian_times<S: Ode>(
    v: ffi::N_Vector,
    jv: ffi::N_Vector,
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    data: *mut c_void,
    _: ffi::N_Vector,
) -> i32 {
    // SAFETY: see the module.
    let (host, v, jv, y, ydot) =
        unsafe { (Host::<S>::of(data), slice(v), slice_mut(jv), slice(y), slice(ydot)) };
    let outcome = host.guard_output(Callback::JacobianTimes, t, jv, |system, jv| {
        call::jacobian_times(system, t, y, ydot, v, jv)
    });
    if outcome != 0 {
        return outcome;
    }
    check_jacobian(host, t, y, &[], |system, v, jv| call::jacobian_times(system, t, y, ydot, v, jv))
}

/// `ARKLsLinSysFn`: as [`newton_setup`], with an argument for the mass matrix; there is none here.
#[allow(clippy::too_many_arguments)] // as C has it
pub(super) unsafe extern "C" fn newton_setup_with_mass<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    _: ffi::SUNMatrix,
    _mass: ffi::SUNMatrix,
    reuse: i32,
    current: *mut i32,
    gamma: f64,
    data: *mut c_void,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
) -> i32 {
    // SAFETY: both have the same contract.
    unsafe { precondition_setup::<S>(t, y, ydot, reuse, current, gamma, data) }
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
    // SAFETY: both have the same contract.
    unsafe { precondition_setup::<S>(t, y, ydot, reuse, current, gamma, data) }
}

/// `CVLsPrecSetupFn`: by the system, or by an incomplete factorization.
pub(super) unsafe extern "C" fn precondition_setup<S: Ode>(
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    reuse: i32,
    current: *mut i32,
    gamma: f64,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module.
    let (host, y, ydot) = unsafe { (Host::<S>::of(data), slice(y), slice(ydot)) };
    host.setup_time = t;
    let reuse = reuse != 0;
    let mut fresh = false;
    // Taken out of the host, which calls the system meanwhile.
    let outcome = match host.ilu.take() {
        None => host.guard(Callback::NewtonSetup, t, |system| {
            fresh = system.newton_setup(t, y, ydot, gamma, reuse)?;
            Ok(())
        }),
        Some(mut ilu) => {
            fresh = !(reuse && ilu.has_jacobian());
            let mut outcome = 0;
            if fresh {
                outcome = ilu.update_jacobian(|values| evaluate_jacobian(host, t, y, ydot, values));
            }
            if outcome == 0 {
                outcome = host.check_pivots(t, ilu.factorize_shifted(gamma));
            }
            host.ilu = Some(ilu);
            outcome
        }
    };
    // SAFETY: `current` is a valid place for the result.
    unsafe { *current = i32::from(fresh) };
    outcome
}

/// `CVLsPrecSolveFn`
#[allow(clippy::too_many_arguments)] // as C has it
pub(super) unsafe extern "C" fn precondition_solve<S: Ode>(
    t: f64,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    r: ffi::N_Vector,
    z: ffi::N_Vector,
    gamma: f64,
    _tolerance: f64,
    _side: i32,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module.
    let (host, r, z) = unsafe { (Host::<S>::of(data), slice(r), slice_mut(z)) };
    host.precondition(t, r, z, |system, z| system.newton_solve(gamma, z))
}

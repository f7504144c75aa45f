//! The C functions through which a Krylov method of CVODE or ARKODE calls an [`Ode`].
//!
//! All of them get the [`Host`] of the solver as their data pointer and vectors of its length; those that
//! they fill are different from the others. That is what their SAFETY comments refer to.

use std::ffi::c_void;

use super::{
    ffi,
    host::Host,
    ode_callbacks::{check_jacobian, sparse_jacobian},
    vector::{slice, slice_mut},
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
    let (host, v, jv, y, ydot) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        (host, slice(v, n), slice_mut(jv, n), slice(y, n), slice(ydot, n))
    };
    let outcome = host.guard_output(Callback::JacobianTimes, t, jv, |system, jv| {
        call::jacobian_times(system, t, y, ydot, v, jv)
    });
    if outcome != 0 {
        return outcome;
    }
    check_jacobian(host, t, y, &[], |system, v, jv| call::jacobian_times(system, t, y, ydot, v, jv))
}

/// `CVLsPrecSetupFn`
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
    let (host, y, ydot) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        (host, slice(y, n), slice(ydot, n))
    };
    let reuse = reuse != 0;
    let (outcome, fresh) = match host.ilu.take() {
        None => {
            let mut fresh = false;
            let outcome = host.guard(Callback::NewtonSetup, t, |system| {
                fresh = system.newton_setup(t, y, ydot, gamma, reuse)?;
                Ok(())
            });
            (outcome, fresh)
        }
        // Taken out of the host, which calls the system meanwhile.
        Some(mut ilu) => {
            let fresh = !(reuse && ilu.has_jacobian());
            let mut outcome = 0;
            if fresh {
                outcome =
                    ilu.update_jacobian(|values| match sparse_jacobian(host, t, y, ydot, values) {
                        0 => host.check_finite(Callback::Jacobian, t, values),
                        failed => failed,
                    });
            }
            if outcome == 0 {
                outcome = host.check_pivots(t, ilu.factorize_shifted(gamma));
            }
            host.ilu = Some(ilu);
            (outcome, fresh)
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
    let (host, z) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        let z = slice_mut(z, n);
        z.copy_from_slice(slice(r, n));
        (host, z)
    };
    host.precondition(t, z, |system, z| system.newton_solve(gamma, z))
}

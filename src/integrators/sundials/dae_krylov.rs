//! The C functions through which a Krylov method of IDA calls a [`Dae`].
//!
//! All of them get the [`Host`] of the solver as their data pointer, and live serial vectors; those that they
//! fill are different from the others. That is what their SAFETY comments refer to.

use std::ffi::c_void;

use super::{
    dae_callbacks::{check_jacobian, evaluate_jacobian},
    ffi,
    host::Host,
    serial::{slice, slice_mut},
};
use crate::integrators::{
    common::Callback,
    ode::{Dae, call},
};

/// `IDALsJacTimesVecFn`
#[allow(clippy::too_many_arguments)] // as C has it
pub(super) unsafe extern "C" fn jacobian_times<S: Dae>(
    t: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    _: ffi::N_Vector,
    v: ffi::N_Vector,
    jv: ffi::N_Vector,
    cj: f64,
    data: *mut c_void,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
) -> i32 {
    // SAFETY: see the module.
    let (host, v, jv, y, yp) =
        unsafe { (Host::<S>::of(data), slice(v), slice_mut(jv), slice(y), slice(yp)) };
    let outcome = host.guard_output(Callback::JacobianTimes, t, jv, |system, jv| {
        call::dae_jacobian_times(system, t, cj, y, yp, v, jv)
    });
    if outcome != 0 {
        return outcome;
    }
    check_jacobian(host, t, (cj, y, yp), &[], |system, v, jv| {
        call::dae_jacobian_times(system, t, cj, y, yp, v, jv)
    })
}

/// `IDALsPrecSetupFn`
pub(super) unsafe extern "C" fn precondition_setup<S: Dae>(
    t: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    residual: ffi::N_Vector,
    cj: f64,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module.
    let (host, y, yp, residual) =
        unsafe { (Host::<S>::of(data), slice(y), slice(yp), slice(residual)) };
    // Taken out of the host, which calls the system meanwhile.
    let Some(mut ilu) = host.ilu.take() else {
        let call = |system: &mut S| system.newton_setup(t, cj, y, yp);
        return host.guard(Callback::NewtonSetup, t, call);
    };
    let mut outcome =
        ilu.update_jacobian(|values| evaluate_jacobian(host, t, (cj, y, yp), residual, values));
    if outcome == 0 {
        outcome = host.check_pivots(t, ilu.factorize());
    }
    host.ilu = Some(ilu);
    outcome
}

/// `IDALsPrecSolveFn`
#[allow(clippy::too_many_arguments)] // as C has it
pub(super) unsafe extern "C" fn precondition_solve<S: Dae>(
    t: f64,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    r: ffi::N_Vector,
    z: ffi::N_Vector,
    _cj: f64,
    _tolerance: f64,
    data: *mut c_void,
) -> i32 {
    // SAFETY: see the module.
    let (host, r, z) = unsafe { (Host::<S>::of(data), slice(r), slice_mut(z)) };
    host.precondition(t, r, z, Dae::newton_solve)
}

//! The C functions through which CVODES and IDAS evaluate the equations of the sensitivities.
//!
//! All of them get the [`Host`] of the solver as their data pointer and vectors of its length;
//! that is what their SAFETY comments refer to.

use std::ffi::c_void;

use super::rhs::{Access, Line};
use crate::integrators::{
    common::Callback,
    ode::{Dae, Ode, call},
    sundials::{
        ffi,
        host::{Host, STOP},
        vector::{slice, slice_mut},
    },
};

/// `CVSensRhs1Fn`
#[allow(clippy::too_many_arguments)] // as C has it
pub(in crate::integrators::sundials) unsafe extern "C" fn one_rhs<S: Ode>(
    _: i32,
    t: f64,
    y: ffi::N_Vector,
    ydot: ffi::N_Vector,
    index: i32,
    s: ffi::N_Vector,
    sdot: ffi::N_Vector,
    data: *mut c_void,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
) -> i32 {
    // SAFETY: see the module; `sdot` is a separate vector.
    let (host, y, ydot, s, sdot) = unsafe {
        let host = &mut *data.cast::<Host<S>>();
        let n = host.n;
        (host, slice(y, n), slice(ydot, n), slice(s, n), slice_mut(sdot, n))
    };
    let Some(mut rhs) = host.sensitivity.take() else { return STOP };
    let index = index as usize;
    let outcome = host.guard_output(Callback::Sensitivities, t, sdot, |system, sdot| {
        if rhs.is_supplied() {
            return call::sensitivity_rhs(system, t, y, ydot, rhs.parameter(index), s, sdot);
        }
        let access = Access { get: S::parameters, set: S::set_parameters };
        let line = Line { y: (y, s), yp: (&[], &[]) };
        rhs.differences(system, &access, index, &line, ydot, sdot, |system, y, _, ydot| {
            call::rhs(system, t, y, ydot)
        })
    });
    host.sensitivity = Some(rhs);
    outcome
}

/// `IDASensResFn`
#[allow(clippy::too_many_arguments)] // as C has it
pub(in crate::integrators::sundials) unsafe extern "C" fn all_residuals<S: Dae>(
    count: i32,
    t: f64,
    y: ffi::N_Vector,
    yp: ffi::N_Vector,
    residual: ffi::N_Vector,
    s: *mut ffi::N_Vector,
    sp: *mut ffi::N_Vector,
    residuals: *mut ffi::N_Vector,
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
    let Some(mut rhs) = host.sensitivity.take() else { return STOP };
    let mut outcome = 0;
    for index in 0..count as usize {
        // SAFETY: the arrays have `count` vectors; those of the residuals are separate vectors.
        let (s, sp, out) = unsafe {
            let (s, sp, out) = (*s.add(index), *sp.add(index), *residuals.add(index));
            (slice(s, host.n), slice(sp, host.n), slice_mut(out, host.n))
        };
        outcome = host.guard_output(Callback::Sensitivities, t, out, |system, out| {
            if rhs.is_supplied() {
                return call::sensitivity_residual(
                    system,
                    t,
                    y,
                    yp,
                    rhs.parameter(index),
                    s,
                    sp,
                    out,
                );
            }
            let access = Access { get: S::parameters, set: S::set_parameters };
            let line = Line { y: (y, s), yp: (yp, sp) };
            rhs.differences(system, &access, index, &line, residual, out, |system, y, yp, out| {
                call::residual(system, t, y, yp, out)
            })
        });
        if outcome != 0 {
            break;
        }
    }
    host.sensitivity = Some(rhs);
    outcome
}

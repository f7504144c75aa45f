//! The C functions through which CVODES and IDAS evaluate the equations of the sensitivities.
//!
//! All of them get the [`Host`] of the solver as their data pointer, and live serial vectors; those that they
//! fill are different from the others. That is what their SAFETY comments refer to.

use std::ffi::c_void;

use super::rhs::{Access, Line};
use crate::integrators::{
    common::Callback,
    ode::{Dae, Ode, call},
    sundials::{
        ffi,
        host::{Host, STOP},
        serial::{slice, slice_mut},
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
    // SAFETY: see the module.
    let (host, y, ydot, s, sdot) =
        unsafe { (Host::<S>::of(data), slice(y), slice(ydot), slice(s), slice_mut(sdot)) };
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
    let (host, y, yp, residual) =
        unsafe { (Host::<S>::of(data), slice(y), slice(yp), slice(residual)) };
    let Some(mut rhs) = host.sensitivity.take() else { return STOP };
    let mut outcome = 0;
    for index in 0..count as usize {
        // SAFETY: as above; the arrays have `count` vectors.
        let (s, sp, out) = unsafe {
            (slice(*s.add(index)), slice(*sp.add(index)), slice_mut(*residuals.add(index)))
        };
        outcome = host.guard_output(Callback::Sensitivities, t, out, |system, out| {
            if rhs.is_supplied() {
                let parameter = rhs.parameter(index);
                return call::sensitivity_residual(system, t, y, yp, parameter, s, sp, out);
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

//! The C functions through which CVODES and IDAS evaluate the equations of the sensitivities.

use super::rhs::{Access, Line};
use crate::integrators::{
    common::Callback,
    ode::{Dae, Ode, call},
    sundials::{
        callbacks::callbacks,
        ffi,
        host::STOP,
        serial::{slice, slice_mut},
    },
};

callbacks! {
    /// `CVSensRhs1Fn`
    fn one_rhs<S: Ode>(
        _: i32, t: (time host), y: read, ydot: read, index: i32, s: read, sdot: write, host: (data S), _: vector, _: vector
    ) {
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
    fn all_residuals<S: Dae>(
        count: i32, t: (time host), y: read, yp: read, residual: read, s: (*mut ffi::N_Vector), sp: (*mut ffi::N_Vector),
        residuals: (*mut ffi::N_Vector), host: (data S), _: vector, _: vector, _: vector
    ) {
        let Some(mut rhs) = host.sensitivity.take() else { return STOP };
        let mut outcome = 0;
        for index in 0..count as usize {
            // SAFETY: the arrays have `count` live serial vectors; those to be filled are different from the others.
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
}

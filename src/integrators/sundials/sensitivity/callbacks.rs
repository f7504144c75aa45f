//! The C functions through which CVODES and IDAS evaluate the equations of the sensitivities.

use super::rhs::{Access, Line, SensitivityRhs};
use crate::integrators::{
    common::Callback,
    ode::{Dae, Ode, call},
    sundials::{
        callbacks::callbacks,
        ffi,
        host::{Host, STOP},
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

    /// `CVQuadSensRhsFn`
    fn integrands<S: Ode>(
        count: i32, t: (time host), y: read, s: (*mut ffi::N_Vector), qdot: read, out: (*mut ffi::N_Vector),
        host: (data S), _: vector, _: vector
    ) {
        for_each(host, count, |host, rhs, index| {
            // SAFETY: the arrays have `count` live serial vectors; those to be filled are different from the others.
            let (s, out) = unsafe { (slice(*s.add(index)), slice_mut(*out.add(index))) };
            host.guard_output(Callback::Quadratures, t, out, |system, out| {
                let access = Access { get: S::parameters, set: S::set_parameters };
                let line = Line { y: (y, s), yp: (&[], &[]) };
                rhs.differences(system, &access, index, &line, qdot, out, |system, y, _, out| {
                    call::quadratures(system, t, y, out)
                })
            })
        })
    }

    /// `IDAQuadSensRhsFn`
    fn dae_integrands<S: Dae>(
        count: i32, t: (time host), y: read, yp: read, s: (*mut ffi::N_Vector), sp: (*mut ffi::N_Vector), qdot: read,
        out: (*mut ffi::N_Vector), host: (data S), _: vector, _: vector, _: vector
    ) {
        for_each(host, count, |host, rhs, index| {
            // SAFETY: as above.
            let (s, sp, out) = unsafe {
                (slice(*s.add(index)), slice(*sp.add(index)), slice_mut(*out.add(index)))
            };
            host.guard_output(Callback::Quadratures, t, out, |system, out| {
                let access = Access { get: S::parameters, set: S::set_parameters };
                let line = Line { y: (y, s), yp: (yp, sp) };
                rhs.differences(system, &access, index, &line, qdot, out, |system, y, yp, out| {
                    call::dae_quadratures(system, t, y, yp, out)
                })
            })
        })
    }

    /// `IDASensResFn`
    fn all_residuals<S: Dae>(
        count: i32, t: (time host), y: read, yp: read, residual: read, s: (*mut ffi::N_Vector), sp: (*mut ffi::N_Vector),
        residuals: (*mut ffi::N_Vector), host: (data S), _: vector, _: vector, _: vector
    ) {
        for_each(host, count, |host, rhs, index| {
            // SAFETY: as above.
            let (s, sp, out) = unsafe {
                (slice(*s.add(index)), slice(*sp.add(index)), slice_mut(*residuals.add(index)))
            };
            host.guard_output(Callback::Sensitivities, t, out, |system, out| {
                if rhs.is_supplied() {
                    let parameter = rhs.parameter(index);
                    return call::sensitivity_residual(system, t, y, yp, parameter, s, sp, out);
                }
                let access = Access { get: S::parameters, set: S::set_parameters };
                let line = Line { y: (y, s), yp: (yp, sp) };
                rhs.differences(system, &access, index, &line, residual, out, |system, y, yp, out| {
                    call::residual(system, t, y, yp, out)
                })
            })
        })
    }
}

/// Calls `evaluate` for each of the `count` sensitivities, until one of them fails.
fn for_each<S>(
    host: &mut Host<S>,
    count: i32,
    mut evaluate: impl FnMut(&mut Host<S>, &mut SensitivityRhs, usize) -> i32,
) -> i32 {
    // Taken out of the host, which calls the system meanwhile.
    let Some(mut rhs) = host.sensitivity.take() else { return STOP };
    let outcomes = (0..count as usize).map(|index| evaluate(host, &mut rhs, index));
    let outcome = { outcomes }.find(|outcome| *outcome != 0).unwrap_or(0);
    host.sensitivity = Some(rhs);
    outcome
}

//! The C functions through which CVODE (and ARKODE) calls an [`Ode`].

use super::{callbacks::callbacks, host::Host};
use crate::integrators::{
    common::{Callback, Point},
    ode::{Failure, Ode, call},
};

callbacks! {
    /// `CVRhsFn`
    fn rhs<S: Ode>(t: (time host), y: read, ydot: write, host: (data S)) {
        host.guard_output(Callback::Rhs, t, ydot, |system, ydot| call::rhs(system, t, y, ydot))
    }

    /// `CVRhsFn` of the explicit part.
    fn explicit_rhs<S: Ode>(t: (time host), y: read, ydot: write, host: (data S)) {
        let call = |system: &mut S, ydot: &mut [f64]| call::explicit_rhs(system, t, y, ydot);
        host.guard_output(Callback::ExplicitRhs, t, ydot, call)
    }

    /// `CVRhsFn`, within the Newton iteration of a user-supplied solver.
    fn newton_rhs<S: Ode>(t: (time host), y: read, ydot: write, host: (data S)) {
        host.guard_output(Callback::Rhs, t, ydot, |system, ydot| call::newton_rhs(system, t, y, ydot))
    }

    /// `CVQuadRhsFn`
    fn quadratures<S: Ode>(t: (time host), y: read, qdot: write, host: (data S)) {
        let call = |system: &mut S, qdot: &mut [f64]| call::quadratures(system, t, y, qdot);
        host.guard_output(Callback::Quadratures, t, qdot, call)
    }

    /// `CVRootFn`
    fn roots<S: Ode>(t: (time host), y: read, g: (roots host), host: (data S)) {
        host.guard_output(Callback::Roots, t, g, |system, g| call::roots(system, t, y, g))
    }

    /// `CVProjFn`. The vector of the error estimate exists, as the estimate is never switched off.
    fn project<S: Ode>(
        t: (time host), y: read, correction: write, _: f64, error: write, host: (data S)
    ) {
        correction.fill(0.0);
        let call = |system: &mut S, correction: &mut [f64]| system.project(t, y, correction, error);
        match host.guard_output(Callback::Projection, t, correction, call) {
            0 => host.check_finite(Callback::Projection, t, error),
            failed => failed,
        }
    }

    /// `CVLsJacFn`
    fn jacobian<S: Ode>(
        t: (time host), y: read, ydot: read, values: (stored host), host: (data S), _: vector, _: vector, _: vector
    ) {
        match evaluate_jacobian(host, t, y, ydot, values) {
            0 => check_jacobian(host, t, y, values, |_, _, _| Ok(())),
            failed => failed,
        }
    }

    /// `ARKExpStabFn`: notes the time that whole steps have reached, and sets no limit to the step size.
    fn note_time<S: Sized>(_: vector, t: f64, limit: (result f64), host: (data S)) {
        (host.step_end, *limit) = (Some(t), 0.0);
        0
    }

    /// `ARKPostProcessFn`: the same for steps of a fixed size, which have no limit.
    fn note_step_end<S: Sized>(t: f64, _: vector, host: (data S)) {
        host.step_end = Some(t);
        0
    }

    /// `ARKLsMassFn`
    fn mass<S: Ode>(
        t: (time host), values: (stored host), host: (data S), _: vector, _: vector, _: vector
    ) {
        host.guard_entries(Callback::Mass, t, values, |system, entries| entries.mass(system, t))
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

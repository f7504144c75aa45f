//! The C functions through which IDA calls a [`Dae`].

use super::{callbacks::callbacks, host::Host, linear_solver::LinearSolver};
use crate::integrators::{
    common::{Callback, Point},
    ode::{Dae, Failure, call},
};

callbacks! {
    /// `IDAResFn`
    fn residual<S: Dae>(t: (time host), y: read, yp: read, residual: write, host: (data S)) {
        let call = |system: &mut S, residual: &mut [f64]| call::residual(system, t, y, yp, residual);
        host.guard_output(Callback::Residual, t, residual, call)
    }

    /// `IDARootFn`
    fn roots<S: Dae>(t: (time host), y: read, yp: read, g: (roots host), host: (data S)) {
        host.guard_output(Callback::Roots, t, g, |system, g| call::dae_roots(system, t, y, yp, g))
    }

    /// `IDAQuadRhsFn`
    fn quadratures<S: Dae>(t: (time host), y: read, yp: read, qdot: write, host: (data S)) {
        let call = |system: &mut S, qdot: &mut [f64]| call::dae_quadratures(system, t, y, yp, qdot);
        host.guard_output(Callback::Quadratures, t, qdot, call)
    }

    /// `IDALsJacFn`; for a user-supplied solver it sets up the matrix that the system keeps.
    fn jacobian<S: Dae>(
        t: (time host), cj: f64, y: read, yp: read, residual: read, values: (stored host), host: (data S), _: vector,
        _: vector, _: vector
    ) {
        host.setup_time = t;
        if matches!(host.linear_solver, Some(LinearSolver::Custom)) {
            return host.guard(Callback::NewtonSetup, t, |system| system.newton_setup(t, cj, y, yp));
        }
        match evaluate_jacobian(host, t, (cj, y, yp), residual, values) {
            0 => check_jacobian(host, t, (cj, y, yp), values, |_, _, _| Ok(())),
            failed => failed,
        }
    }

    /// `IDALsJacTimesVecFn`
    fn jacobian_times<S: Dae>(
        t: (time host), y: read, yp: read, _: vector, v: read, jv: write, cj: f64, host: (data S), _: vector, _: vector
    ) {
        let times = |system: &mut S, v: &[f64], jv: &mut [f64]| {
            call::dae_jacobian_times(system, t, cj, y, yp, v, jv)
        };
        match host.guard_output(Callback::JacobianTimes, t, jv, |system, jv| times(system, v, jv)) {
            0 => check_jacobian(host, t, (cj, y, yp), &[], times),
            failed => failed,
        }
    }

    /// `IDALsPrecSetupFn`
    fn precondition_setup<S: Dae>(
        t: (time host), y: read, yp: read, residual: read, cj: f64, host: (data S)
    ) {
        // Taken out of the host, which calls the system meanwhile.
        let Some(mut ilu) = host.ilu.take() else {
            return host.guard(Callback::NewtonSetup, t, |system| system.newton_setup(t, cj, y, yp));
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
    fn precondition_solve<S: Dae>(
        t: (time host), _: vector, _: vector, _: vector, r: read, z: write, _: f64, _: f64, host: (data S)
    ) {
        host.precondition(t, r, z, Dae::newton_solve)
    }
}

/// Checks the dF/dy + cj dF/dy' that the system has just supplied: its entries, or the products that `times`
/// writes.
fn check_jacobian<S: Dae>(
    host: &mut Host<S>,
    t: f64,
    (cj, y, yp): (f64, &[f64], &[f64]),
    values: &[f64],
    times: impl FnMut(&mut S, &[f64], &mut [f64]) -> Result<(), Failure>,
) -> i32 {
    let evaluate = |system: &mut S, [y, yp]: [&[f64]; 2], out: &mut [f64]| {
        call::residual(system, t, y, yp, out)
    };
    host.check_jacobian(t, Point { y, yp, cj }, values, times, evaluate)
}

/// The values of dF/dy + cj dF/dy' that the linear solver or its preconditioner stores: difference quotients,
/// or the system's own.
fn evaluate_jacobian<S: Dae>(
    host: &mut Host<S>,
    t: f64,
    (cj, y, yp): (f64, &[f64], &[f64]),
    residual: &[f64],
    values: &mut [f64],
) -> i32 {
    // Taken out of the host, which calls the system meanwhile.
    let (Some(mut differences), Some(mut scales)) = (host.differences.take(), host.scales.take())
    else {
        return host.guard_entries(Callback::Jacobian, t, values, |system, entries| {
            entries.dae_jacobian(system, t, cj, y, yp)
        });
    };
    let (at, scale) = ((cj, y, yp), scales.read());
    let outcome = differences.of_residual(at, scale, residual, values, |y, yp, residual| {
        host.guard_output(Callback::Residual, t, residual, |system, r| {
            call::residual(system, t, y, yp, r)
        })
    });
    (host.differences, host.scales) = (Some(differences), Some(scales));
    match outcome {
        0 => host.check_finite(Callback::Jacobian, t, values),
        failed => failed,
    }
}

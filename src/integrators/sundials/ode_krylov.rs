//! The C functions through which CVODE or ARKODE solves linear systems without a matrix of their own: by the
//! solver of an [`Ode`], or by a Krylov method.

use super::{
    callbacks::callbacks,
    ffi,
    host::Host,
    ode_callbacks::{check_jacobian, evaluate_jacobian},
};
use crate::integrators::{
    common::Callback,
    ode::{Ode, call},
};

callbacks! {
    /// `CVLsJacTimesVecFn`
    fn jacobian_times<S: Ode>(
        v: read, jv: write, t: (time host), y: read, ydot: read, host: (data S), _: vector
    ) {
        let times = |system: &mut S, v: &[f64], jv: &mut [f64]| {
            call::jacobian_times(system, t, y, ydot, v, jv)
        };
        match host.guard_output(Callback::JacobianTimes, t, jv, |system, jv| times(system, v, jv)) {
            0 => check_jacobian(host, t, y, &[], times),
            failed => failed,
        }
    }

    /// `CVLsLinSysFn`: as [`newton_setup`], with an argument for the mass matrix; there is none here.
    fn newton_setup_with_mass<S: Ode>(
        t: (time host), y: read, ydot: read, _: (ffi::SUNMatrix), _: (ffi::SUNMatrix), reuse: i32, current: (result i32),
        gamma: f64, host: (data S), _: vector, _: vector, _: vector
    ) {
        set_up(host, t, [y, ydot], (gamma, reuse), current)
    }

    /// `CVLsLinSysFn`: for a user-supplied solver, which stores I - gamma J itself.
    fn newton_setup<S: Ode>(
        t: (time host), y: read, ydot: read, _: (ffi::SUNMatrix), reuse: i32, current: (result i32), gamma: f64,
        host: (data S), _: vector, _: vector, _: vector
    ) {
        set_up(host, t, [y, ydot], (gamma, reuse), current)
    }

    /// `CVLsPrecSetupFn`: by the system, or by an incomplete factorization.
    fn precondition_setup<S: Ode>(
        t: (time host), y: read, ydot: read, reuse: i32, current: (result i32), gamma: f64, host: (data S)
    ) {
        set_up(host, t, [y, ydot], (gamma, reuse), current)
    }

    /// `CVLsPrecSolveFn`
    fn precondition_solve<S: Ode>(
        t: (time host), _: vector, _: vector, r: read, z: write, gamma: f64, _: f64, _: i32, host: (data S)
    ) {
        host.precondition(t, r, z, |system, z| system.newton_solve(gamma, z))
    }
}

/// Sets up I - gamma J, or a preconditioner for it: by the system, or by an incomplete factorization. `current` is
/// whether J is that of this point.
fn set_up<S: Ode>(
    host: &mut Host<S>,
    t: f64,
    [y, ydot]: [&[f64]; 2],
    (gamma, reuse): (f64, i32),
    current: &mut i32,
) -> i32 {
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
    *current = i32::from(fresh);
    outcome
}

//! `CVodeGetIntegratorStats` for the integrators that have no such function.

use std::{ffi::c_void, ptr};

use super::ffi;

/// Output of `CVodeGetIntegratorStats`.
struct Places {
    steps: *mut i64,
    evaluations: *mut i64,
    setups: *mut i64,
    error_test_failures: *mut i64,
    orders: [*mut i32; 2],
    initial_step: *mut f64,
    last_step: *mut f64,
    current_step: *mut f64,
    current_time: *mut f64,
}

/// Functions in place of `CVodeGetIntegratorStats`, of the memory and the places.
macro_rules! integrator_stats {
    ($($(#[$doc:meta])* fn $name:ident($memory:ident, $places:ident) $body:block)+) => {$(
        $(#[$doc])*
        pub(super) unsafe extern "C" fn $name(
            $memory: *mut c_void,
            steps: *mut i64,
            evaluations: *mut i64,
            setups: *mut i64,
            error_test_failures: *mut i64,
            last_order: *mut i32,
            current_order: *mut i32,
            initial_step: *mut f64,
            last_step: *mut f64,
            current_step: *mut f64,
            current_time: *mut f64,
        ) -> i32 {
            let orders = [last_order, current_order];
            let $places = Places {
                steps, evaluations, setups, error_test_failures, orders, initial_step, last_step, current_step, current_time,
            };
            $body
        }
    )+};
}

integrator_stats! {
    /// Those of ARKODE: evaluations are the sum of explicit and implicit ones, and both orders are that of the table.
    fn arkode_integrator_stats(memory, at) {
        let [mut explicit, mut implicit] = [0; 2];
        let (mut implicit_table, mut explicit_table) = (ptr::null_mut(), ptr::null_mut());
        // SAFETY: whoever calls through the table vouches for memory and places; a table that is there lives as long as the
        // memory.
        unsafe {
            let code = ffi::ARKStepGetStepStats(
                memory,
                at.steps,
                at.initial_step,
                at.last_step,
                at.current_step,
                at.current_time,
            );
            ffi::ARKStepGetNumRhsEvals(memory, &raw mut explicit, &raw mut implicit);
            ffi::ARKStepGetNumLinSolvSetups(memory, at.setups);
            ffi::ARKStepGetNumErrTestFails(memory, at.error_test_failures);
            ffi::ARKStepGetCurrentButcherTables(memory, &raw mut implicit_table, &raw mut explicit_table);
            *at.evaluations = explicit + implicit;
            let table = if implicit_table.is_null() { explicit_table } else { implicit_table };
            let order = table.as_ref().map_or(0, |table| table.q);
            at.orders.into_iter().for_each(|place| *place = order);
            code
        }
    }

    /// The same for multirate methods: those of the slow steps, which all have one size. The order is left as it is.
    fn multirate_integrator_stats(memory, at) {
        let [mut explicit, mut implicit] = [0; 2];
        // SAFETY: as above.
        unsafe {
            ffi::MRIStepGetNumSteps(memory, at.steps);
            ffi::MRIStepGetNumRhsEvals(memory, &raw mut explicit, &raw mut implicit);
            ffi::MRIStepGetNumLinSolvSetups(memory, at.setups);
            ffi::MRIStepGetLastStep(memory, at.last_step);
            (*at.evaluations, *at.error_test_failures) = (explicit + implicit, 0);
            (*at.current_step, *at.initial_step) = (*at.last_step, *at.last_step);
            ffi::MRIStepGetCurrentTime(memory, at.current_time)
        }
    }
}

//! The C functions that the integrators have in common, apart from their names.

use std::ffi::c_void;

use super::ffi;

/// A C function with its name, for errors.
pub(super) type Named<F> = (&'static str, F);

/// A C function with its name.
macro_rules! named {
    ($function:ident) => {
        (stringify!($function), $crate::integrators::sundials::ffi::$function)
    };
    ($function:ident as _) => {
        (stringify!($function), $crate::integrators::sundials::ffi::$function as _)
    };
}
pub(super) use named;

/// A function with one argument besides the memory block, mostly to set an option.
pub(super) type Set<T> = Named<unsafe extern "C" fn(*mut c_void, T) -> i32>;

/// A function with two arguments besides the memory block, mostly to set an option or callbacks.
pub(super) type SetTwo<A, B> = Named<unsafe extern "C" fn(*mut c_void, A, B) -> i32>;

/// A function that reads one value.
pub(super) type Get<T> = unsafe extern "C" fn(*mut c_void, *mut T) -> i32;

/// Reads the counters, orders, step sizes and time that every integrator keeps.
pub(super) type GetIntegratorStats = unsafe extern "C" fn(
    memory: *mut c_void,
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
) -> i32;

/// Integrates: (memory, target, time reached, y, y', task). An ODE has null for y'.
pub(super) type Solve =
    unsafe fn(*mut c_void, f64, *mut f64, ffi::N_Vector, ffi::N_Vector, i32) -> i32;

/// Starts again: (memory, time, y, y'). An ODE has null for y'.
pub(super) type Reinit = unsafe fn(*mut c_void, f64, ffi::N_Vector, ffi::N_Vector) -> i32;

/// One integrator of SUNDIALS. All functions take its memory block first; a table never mixes
/// functions of two integrators.
pub(super) struct Functions {
    /// The name of the integrator in errors.
    pub(super) integrator: &'static str,
    pub(super) free: unsafe extern "C" fn(*mut *mut c_void),
    pub(super) solve: Named<Solve>,
    pub(super) reinit: Named<Reinit>,
    /// Continues from a time and state after a change of the system, with the previous step size.
    pub(super) reset: Option<SetTwo<f64, ffi::N_Vector>>,
    /// ARKODE does, and would refuse another stop time if the direction of time has been reversed.
    pub(super) reinit_forgets_stop_time: bool,
    /// Codes of `solve` for a call that cannot be made.
    pub(super) refusals: &'static [i32],

    /// Codes of `solve` for a mass matrix that cannot be factorized.
    pub(super) mass_failures: &'static [i32],

    pub(super) set_error_handler: SetTwo<ffi::CVErrHandlerFn, *mut c_void>,
    pub(super) set_user_data: Set<*mut c_void>,
    pub(super) scalar_tolerances: SetTwo<f64, f64>,
    pub(super) vector_tolerances: SetTwo<f64, ffi::N_Vector>,
    pub(super) set_linear_solver: SetTwo<ffi::SUNLinearSolver, ffi::SUNMatrix>,
    pub(super) allow_inactive_roots: Named<unsafe extern "C" fn(*mut c_void) -> i32>,
    pub(super) set_max_steps: Set<i64>,
    pub(super) set_initial_step: Set<f64>,
    pub(super) set_max_step: Set<f64>,
    pub(super) set_min_step: Set<f64>,
    /// IDA has none.
    pub(super) set_max_error_test_failures: Option<Set<i32>>,
    /// The order of a Runge-Kutta method is that of its table.
    pub(super) set_max_order: Option<Set<i32>>,
    pub(super) set_convergence_coefficient: Set<f64>,
    /// For a Krylov method.
    pub(super) set_tolerance_factor: Set<f64>,
    pub(super) set_stop_time: Set<f64>,
    pub(super) set_constraints: Set<ffi::N_Vector>,

    pub(super) get_root_info: Set<*mut i32>,
    pub(super) get_dky: Named<unsafe extern "C" fn(*mut c_void, f64, i32, ffi::N_Vector) -> i32>,
    /// Codes of `get_dky` for a time outside the last step, and for too high a derivative.
    pub(super) bad_time: i32,
    pub(super) bad_derivative: i32,
    /// gamma of y - gamma f(t, y), or cj of IDA.
    pub(super) get_step_parameter: Get<f64>,
    /// In the first step of a multistep method CVODE reports 0.
    pub(super) get_current_step: Get<f64>,
    pub(super) get_error_weights: Set<ffi::N_Vector>,
    pub(super) get_linear_flag: Get<i64>,
    pub(super) get_integrator_stats: GetIntegratorStats,
    pub(super) get_nonlinear_stats: unsafe extern "C" fn(*mut c_void, *mut i64, *mut i64) -> i32,
    pub(super) get_step_failures: Get<i64>,
    pub(super) get_jacobian_evaluations: Get<i64>,
    pub(super) get_quotient_evaluations: Get<i64>,
    pub(super) get_linear_iterations: Get<i64>,
    pub(super) get_linear_failures: Get<i64>,
    pub(super) get_preconditioner_setups: Get<i64>,
    pub(super) get_preconditioner_solves: Get<i64>,
    pub(super) get_root_evaluations: Get<i64>,
    /// For right-hand sides that are split.
    pub(super) get_explicit_evaluations: Option<Get<i64>>,
    /// CVODE alone detects stability limits.
    pub(super) get_stability_reductions: Option<Get<i64>>,
    pub(super) get_tolerance_scale: Get<f64>,
    /// ARKODE has none.
    pub(super) quadratures: Option<&'static QuadratureFunctions>,
    /// ARKODE has none.
    pub(super) sensitivities: Option<&'static SensitivityFunctions>,
}

/// Starts sensitivities again: (memory, method, s, s'). An ODE has null for s'.
pub(super) type ReinitSensitivities =
    unsafe fn(*mut c_void, i32, *mut ffi::N_Vector, *mut ffi::N_Vector) -> i32;

/// The functions of CVODES and IDAS for sensitivities.
pub(super) struct SensitivityFunctions {
    pub(super) reinit: Named<ReinitSensitivities>,
    pub(super) set_parameters:
        Named<unsafe extern "C" fn(*mut c_void, *mut f64, *mut f64, *mut i32) -> i32>,
    pub(super) set_tolerances: Named<unsafe extern "C" fn(*mut c_void) -> i32>,
    pub(super) set_error_control: Set<i32>,
    pub(super) get: SetTwo<*mut f64, *mut ffi::N_Vector>,
    pub(super) get_dky:
        Named<unsafe extern "C" fn(*mut c_void, f64, i32, i32, ffi::N_Vector) -> i32>,
    pub(super) get_evaluations: Get<i64>,
}

/// The functions of CVODES and IDAS for quadratures.
pub(super) struct QuadratureFunctions {
    pub(super) reinit: Set<ffi::N_Vector>,
    pub(super) scalar_tolerances: SetTwo<f64, f64>,
    pub(super) vector_tolerances: SetTwo<f64, ffi::N_Vector>,
    pub(super) set_error_control: Set<i32>,
    pub(super) get: SetTwo<*mut f64, ffi::N_Vector>,
    pub(super) get_dky: Named<unsafe extern "C" fn(*mut c_void, f64, i32, ffi::N_Vector) -> i32>,
    pub(super) get_evaluations: Get<i64>,
}

/// Returns lambda and lambda': (memory, problem, time, lambda, lambda'). An ODE has null for lambda'.
pub(super) type GetBackward =
    unsafe fn(*mut c_void, i32, *mut f64, ffi::N_Vector, ffi::N_Vector) -> i32;

/// Starts a backward problem: (memory, problem, time, lambda, lambda'). An ODE has null for lambda'.
pub(super) type InitBackward =
    unsafe fn(*mut c_void, i32, f64, ffi::N_Vector, ffi::N_Vector) -> i32;

/// The functions of CVODES and IDAS for backward problems, which belong to the memory of the forward run and
/// are identified by a number.
pub(super) struct BackwardFunctions {
    /// The name of the integrator in errors.
    pub(super) integrator: &'static str,
    /// The integrator as it runs forward with checkpoints.
    pub(super) forward: &'static Functions,
    /// (memory, steps between checkpoints, interpolation)
    pub(super) init_checkpoints: SetTwo<i64, i32>,
    pub(super) create: Named<unsafe fn(*mut c_void, *mut i32) -> i32>,
    pub(super) init: Named<InitBackward>,
    pub(super) vector_tolerances:
        Named<unsafe extern "C" fn(*mut c_void, i32, f64, ffi::N_Vector) -> i32>,
    pub(super) set_user_data: SetTwo<i32, *mut c_void>,
    pub(super) set_max_steps: SetTwo<i32, i64>,
    pub(super) set_linear_solver:
        Named<unsafe extern "C" fn(*mut c_void, i32, ffi::SUNLinearSolver, ffi::SUNMatrix) -> i32>,
    pub(super) set_jacobian: Named<unsafe fn(*mut c_void, i32) -> i32>,
    /// Takes the initial values of the integrals, which are zero.
    pub(super) init_quadratures: Named<unsafe fn(*mut c_void, i32, ffi::N_Vector) -> i32>,
    pub(super) set_quadrature_error_control: SetTwo<i32, i32>,
    pub(super) quadrature_tolerances:
        Named<unsafe extern "C" fn(*mut c_void, i32, f64, ffi::N_Vector) -> i32>,
    /// (memory, target, task)
    pub(super) solve: unsafe extern "C" fn(*mut c_void, f64, i32) -> i32,
    pub(super) get: Named<GetBackward>,
    pub(super) get_quadratures:
        Named<unsafe extern "C" fn(*mut c_void, i32, *mut f64, ffi::N_Vector) -> i32>,
    /// The memory of the backward problem.
    pub(super) get_memory: unsafe extern "C" fn(*mut c_void, i32) -> *mut c_void,
    pub(super) get_current_time: Get<f64>,
    pub(super) get_current_order: Get<i32>,
}

// Tasks and codes that all integrators number alike: the shared code uses CVODE's names.
const _: () = {
    let alike = [
        [ffi::CV_NORMAL, ffi::IDA_NORMAL, ffi::ARK_NORMAL],
        [ffi::CV_ONE_STEP, ffi::IDA_ONE_STEP, ffi::ARK_ONE_STEP],
        [ffi::CV_ROOT_RETURN, ffi::IDA_ROOT_RETURN, ffi::ARK_ROOT_RETURN],
        [ffi::CV_TOO_MUCH_WORK, ffi::IDA_TOO_MUCH_WORK, ffi::ARK_TOO_MUCH_WORK],
        [ffi::CV_TOO_MUCH_ACC, ffi::IDA_TOO_MUCH_ACC, ffi::ARK_TOO_MUCH_ACC],
        [ffi::CV_ERR_FAILURE, ffi::IDA_ERR_FAIL, ffi::ARK_ERR_FAILURE],
        [ffi::CV_CONV_FAILURE, ffi::IDA_CONV_FAIL, ffi::ARK_CONV_FAILURE],
        [ffi::CV_LINIT_FAIL, ffi::IDA_LINIT_FAIL, ffi::ARK_LINIT_FAIL],
        [ffi::CV_LSETUP_FAIL, ffi::IDA_LSETUP_FAIL, ffi::ARK_LSETUP_FAIL],
        [ffi::CV_LSOLVE_FAIL, ffi::IDA_LSOLVE_FAIL, ffi::ARK_LSOLVE_FAIL],
        [ffi::CV_RHSFUNC_FAIL, ffi::IDA_RES_FAIL, ffi::ARK_RHSFUNC_FAIL],
    ];
    let mut i = 0;
    while i < alike.len() {
        let [cvode, ida, arkode] = alike[i];
        assert!(cvode == ida && cvode == arkode);
        i += 1;
    }
};

// The same holds for the interpolation between checkpoints.
const _: () = assert!(ffi::CV_HERMITE == ffi::IDA_HERMITE);

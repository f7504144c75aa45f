//! The C functions of the integrators, in tables with a column for each.

use std::ffi::c_void;

use super::{
    ffi,
    integrator_stats::{arkode_integrator_stats, multirate_integrator_stats},
    linear_solver::LinearSolver,
};

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

/// A function with three arguments besides the memory block.
pub(super) type SetThree<A, B, C> = Named<unsafe extern "C" fn(*mut c_void, A, B, C) -> i32>;

/// A function that reads one value.
pub(super) type Get<T> = Set<*mut T>;

/// Interpolates: (memory, time, derivative, result).
type GetDky = SetThree<f64, i32, ffi::N_Vector>;

/// Reads the counters, orders, step sizes and time that every integrator keeps.
type GetIntegratorStats = unsafe extern "C" fn(
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
    Named<unsafe fn(*mut c_void, f64, *mut f64, ffi::N_Vector, ffi::N_Vector, i32) -> i32>;

/// The right-hand sides of ARKODE, explicit and implicit; the other integrators keep theirs.
pub(super) type Stages = [ffi::CVRhsFn; 2];

/// Starts again: (memory, right-hand sides, time, y, y'). An ODE has null for y'.
type Reinit = Named<unsafe fn(*mut c_void, Stages, f64, ffi::N_Vector, ffi::N_Vector) -> i32>;

/// Starts sensitivities again: (memory, method, s, s'). An ODE has null for s'.
type ReinitSensitivities =
    Named<unsafe fn(*mut c_void, i32, *mut ffi::N_Vector, *mut ffi::N_Vector) -> i32>;

/// Returns lambda and lambda': (memory, problem, time, lambda, lambda'). An ODE has null for lambda'.
type GetBackward =
    Named<unsafe fn(*mut c_void, i32, *mut f64, ffi::N_Vector, ffi::N_Vector) -> i32>;

/// Starts a backward problem: (memory, problem, time, lambda, lambda'). An ODE has null for lambda'.
pub(super) type InitBackward =
    Named<unsafe fn(*mut c_void, i32, f64, ffi::N_Vector, ffi::N_Vector) -> i32>;

/// Gives a backward problem the callbacks of its linear solver: (memory, problem, linear solver).
pub(super) type SetBackward = Named<unsafe fn(*mut c_void, i32, &LinearSolver) -> i32>;

/// Gives a backward problem its integrals: (memory, problem, initial values, which are zero).
pub(super) type InitBackwardQuadratures = Named<unsafe fn(*mut c_void, i32, ffi::N_Vector) -> i32>;

/// Defines a table with a column for each integrator: first functions that all of them have, then those of SUNDIALS 6
/// alone, those that some have (`-`: no), and anything else.
macro_rules! table {
    ($(#[$doc:meta])* $table:ident: $first:ident, $second:ident;
     $($(#[$about:meta])* $field:ident: $type:ty = $a:ident, $b:ident;)+
     [others] $($(#[$about_value:meta])* $value:ident: $value_type:ty = $value_a:expr, $value_b:expr;)*) => {
        table!(@struct $table [$(#[$doc])*] $($(#[$about])* $field: $type,)+
               $($(#[$about_value])* $value: $value_type,)*);
        impl $table {
            table!(@column $first [$($field $a)+] [] [] [$($value $value_a)*]);
            table!(@column $second [$($field $b)+] [] [] [$($value $value_b)*]);
        }
    };
    ($(#[$doc:meta])* $table:ident: $first:ident, $second:ident, $third:ident;
     $($(#[$about:meta])* $field:ident: $type:ty = $a:ident, $b:ident, $c:ident;)+
    ) => {
        table!(@struct $table [$(#[$doc])*] $($(#[$about])* $field: $type,)+);
        impl $table {
            table!(@column $first [$($field $a)+] [] [] []);
            table!(@column $second [$($field $b)+] [] [] []);
            table!(@column $third [$($field $c)+] [] [] []);
        }
    };
    ($(#[$doc:meta])* $table:ident: $first:ident, $second:ident, $third:ident, $fourth:ident;
     $($(#[$about:meta])* $field:ident: $type:ty = $a:ident, $b:ident, $c:ident, $d:ident;)+
     [sundials 6] $($old:ident: $old_type:ty = $old_a:ident, $old_b:ident, $old_c:ident, $old_d:ident;)+
     [some] $($(#[$about_some:meta])* $some:ident: $some_type:ty = $some_a:tt, $some_b:tt, $some_c:tt, $some_d:tt;)+
     [others] $($(#[$about_value:meta])* $value:ident: $value_type:ty
         = $value_a:expr, $value_b:expr, $value_c:expr, $value_d:expr;)+
    ) => {
        table!(@struct $table [$(#[$doc])*] $($(#[$about])* $field: $type,)+
               $(#[cfg(sundials_major = "6")] $old: $old_type,)+
               $($(#[$about_some])* $some: Option<$some_type>,)+ $($(#[$about_value])* $value: $value_type,)+);
        impl $table {
            table!(@column $first [$($field $a)+] [$($old $old_a)+] [$($some $some_a)+] [$($value $value_a)+]);
            table!(@column $second [$($field $b)+] [$($old $old_b)+] [$($some $some_b)+] [$($value $value_b)+]);
            table!(@column $third [$($field $c)+] [$($old $old_c)+] [$($some $some_c)+] [$($value $value_c)+]);
            table!(@column $fourth [$($field $d)+] [$($old $old_d)+] [$($some $some_d)+] [$($value $value_d)+]);
        }
    };
    (@struct $table:ident [$($doc:tt)*] $($(#[$about:meta])* $field:ident: $type:ty,)+) => {
        $($doc)*
        pub(super) struct $table {
            $($(#[$about])* pub(super) $field: $type,)+
        }
    };
    (@column $column:ident [$($field:ident $function:ident)+] [$($old:ident $old_function:ident)*] [$($some:ident $cell:tt)*]
     [$($value:ident $other:expr)*]) => {
        pub(super) const $column: &'static Self = &Self {
            $($field: named!($function),)+
            $(#[cfg(sundials_major = "6")] $old: named!($old_function),)*
            $($some: table!(@cell $cell),)*
            $($value: $other,)*
        };
    };
    (@cell -) => { None };
    (@cell $function:ident) => { Some(named!($function)) };
}

table! {
    /// One integrator of SUNDIALS. All functions take its memory block first.
    Functions: CVODE, IDA, ARKODE, MULTIRATE;

    set_user_data: Set<*mut c_void> = CVodeSetUserData, IDASetUserData, ARKStepSetUserData, MRIStepSetUserData;
    scalar_tolerances: SetTwo<f64, f64> = CVodeSStolerances, IDASStolerances, ARKStepSStolerances, MRIStepSStolerances;
    vector_tolerances: SetTwo<f64, ffi::N_Vector> = CVodeSVtolerances, IDASVtolerances, ARKStepSVtolerances, MRIStepSVtolerances;
    weight_tolerances: Set<ffi::CVEwtFn> = CVodeWFtolerances, IDAWFtolerances, ARKStepWFtolerances, MRIStepWFtolerances;
    set_linear_solver: SetTwo<ffi::SUNLinearSolver, ffi::SUNMatrix>
        = CVodeSetLinearSolver, IDASetLinearSolver, ARKStepSetLinearSolver, MRIStepSetLinearSolver;
    set_nonlinear_solver: Set<ffi::SUNNonlinearSolver>
        = CVodeSetNonlinearSolver, IDASetNonlinearSolver, ARKStepSetNonlinearSolver, MRIStepSetNonlinearSolver;
    allow_inactive_roots: Named<unsafe extern "C" fn(*mut c_void) -> i32>
        = CVodeSetNoInactiveRootWarn, IDASetNoInactiveRootWarn, ARKStepSetNoInactiveRootWarn, MRIStepSetNoInactiveRootWarn;
    set_max_steps: Set<i64> = CVodeSetMaxNumSteps, IDASetMaxNumSteps, ARKStepSetMaxNumSteps, MRIStepSetMaxNumSteps;
    set_convergence_coefficient: Set<f64> = CVodeSetNonlinConvCoef, IDASetNonlinConvCoef, ARKStepSetNonlinConvCoef, MRIStepSetNonlinConvCoef;
    /// For a Krylov method.
    set_tolerance_factor: Set<f64> = CVodeSetEpsLin, IDASetEpsLin, ARKStepSetEpsLin, MRIStepSetEpsLin;
    set_stop_time: Set<f64> = CVodeSetStopTime, IDASetStopTime, ARKStepSetStopTime, MRIStepSetStopTime;
    get_root_info: Get<i32> = CVodeGetRootInfo, IDAGetRootInfo, ARKStepGetRootInfo, MRIStepGetRootInfo;
    get_dky: GetDky = CVodeGetDky, IDAGetDky, ARKStepGetDky, MRIStepGetDky;
    /// gamma of y - gamma f(t, y), or cj of IDA.
    get_step_parameter: Get<f64> = CVodeGetCurrentGamma, IDAGetCurrentCj, ARKStepGetCurrentGamma, MRIStepGetCurrentGamma;
    /// In the first step of a multistep method CVODE reports 0.
    get_current_step: Get<f64> = CVodeGetCurrentStep, IDAGetCurrentStep, ARKStepGetCurrentStep, MRIStepGetLastStep;
    get_error_weights: Set<ffi::N_Vector> = CVodeGetErrWeights, IDAGetErrWeights, ARKStepGetErrWeights, MRIStepGetErrWeights;
    get_linear_flag: Get<i64> = CVodeGetLastLinFlag, IDAGetLastLinFlag, ARKStepGetLastLinFlag, MRIStepGetLastLinFlag;
    get_nonlinear_stats: SetTwo<*mut i64, *mut i64>
        = CVodeGetNonlinSolvStats, IDAGetNonlinSolvStats, ARKStepGetNonlinSolvStats, MRIStepGetNonlinSolvStats;
    get_step_failures: Get<i64> = CVodeGetNumStepSolveFails, IDAGetNumStepSolveFails, ARKStepGetNumStepSolveFails, MRIStepGetNumStepSolveFails;
    get_jacobian_evaluations: Get<i64> = CVodeGetNumJacEvals, IDAGetNumJacEvals, ARKStepGetNumJacEvals, MRIStepGetNumJacEvals;
    get_quotient_evaluations: Get<i64> = CVodeGetNumLinRhsEvals, IDAGetNumLinResEvals, ARKStepGetNumLinRhsEvals, MRIStepGetNumLinRhsEvals;
    get_linear_iterations: Get<i64> = CVodeGetNumLinIters, IDAGetNumLinIters, ARKStepGetNumLinIters, MRIStepGetNumLinIters;
    get_linear_failures: Get<i64> = CVodeGetNumLinConvFails, IDAGetNumLinConvFails, ARKStepGetNumLinConvFails, MRIStepGetNumLinConvFails;
    get_preconditioner_setups: Get<i64> = CVodeGetNumPrecEvals, IDAGetNumPrecEvals, ARKStepGetNumPrecEvals, MRIStepGetNumPrecEvals;
    get_preconditioner_solves: Get<i64> = CVodeGetNumPrecSolves, IDAGetNumPrecSolves, ARKStepGetNumPrecSolves, MRIStepGetNumPrecSolves;
    get_root_evaluations: Get<i64> = CVodeGetNumGEvals, IDAGetNumGEvals, ARKStepGetNumGEvals, MRIStepGetNumGEvals;
    get_tolerance_scale: Get<f64> = CVodeGetTolScaleFactor, IDAGetTolScaleFactor, ARKStepGetTolScaleFactor, MRIStepGetTolScaleFactor;

    [sundials 6]
    set_error_handler: SetTwo<ffi::CVErrHandlerFn, *mut c_void>
        = CVodeSetErrHandlerFn, IDASetErrHandlerFn, ARKStepSetErrHandlerFn, MRIStepSetErrHandlerFn;

    [some]
    set_initial_step: Set<f64> = CVodeSetInitStep, IDASetInitStep, ARKStepSetInitStep, -;
    set_max_step: Set<f64> = CVodeSetMaxStep, IDASetMaxStep, ARKStepSetMaxStep, -;
    set_min_step: Set<f64> = CVodeSetMinStep, IDASetMinStep, ARKStepSetMinStep, -;
    set_max_growth: Set<f64> = CVodeSetEtaMax, IDASetEtaMax, ARKStepSetMaxGrowth, -;
    set_min_reduction: Set<f64> = CVodeSetEtaMin, IDASetEtaMin, ARKStepSetMinReduction, -;
    set_kept: SetTwo<f64, f64> = CVodeSetEtaFixedStepBounds, IDASetEtaFixedStepBounds, ARKStepSetFixedStepBounds, -;
    set_after_error_failure: Set<f64> = CVodeSetEtaMinErrFail, IDASetEtaMinErrFail, ARKStepSetMaxEFailGrowth, -;
    set_after_convergence_failure: Set<f64> = CVodeSetEtaConvFail, IDASetEtaConvFail, ARKStepSetMaxCFailGrowth, -;
    set_constraints: Set<ffi::N_Vector> = CVodeSetConstraints, IDASetConstraints, ARKStepSetConstraints, -;
    /// Continues from a time and state after a change of the system, with the previous step size.
    reset: SetTwo<f64, ffi::N_Vector> = -, -, ARKStepReset, MRIStepReset;
    /// Of the first ten steps, which CVODE treats apart.
    set_early_growth: Set<f64> = CVodeSetEtaMaxEarlyStep, -, -, -;
    set_first_growth: Set<f64> = CVodeSetEtaMaxFirstStep, -, ARKStepSetMaxFirstGrowth, -;
    set_max_error_test_failures: Set<i32> = CVodeSetMaxErrTestFails, -, ARKStepSetMaxErrTestFails, -;
    /// The order of a Runge-Kutta method is that of its table.
    set_max_order: Set<i32> = CVodeSetMaxOrd, IDASetMaxOrd, -, -;
    get_stability_reductions: Get<i64> = CVodeGetNumStabLimOrderReds, -, -, -;
    /// Evaluations of an explicit and of an implicit right-hand side.
    get_rhs_evaluations: SetTwo<*mut i64, *mut i64> = -, -, ARKStepGetNumRhsEvals, MRIStepGetNumRhsEvals;

    [others]
    /// The name of the integrator in errors.
    integrator: &'static str = "CVODE", "IDA", "ARKODE", "ARKODE's multirate method";
    free: unsafe extern "C" fn(*mut *mut c_void) = ffi::CVodeFree, ffi::IDAFree, ffi::ARKStepFree, ffi::MRIStepFree;
    // SAFETY: whoever calls through the table vouches for the arguments, here and in the other rows.
    solve: Solve = ("CVode", |memory, target, t, y, _, task| unsafe { ffi::CVode(memory, target, y, t, task) }),
        ("IDASolve", |memory, target, t, y, yp, task| unsafe { ffi::IDASolve(memory, target, t, y, yp, task) }),
        ("ARKStepEvolve", |memory, target, t, y, _, task| unsafe { ffi::ARKStepEvolve(memory, target, y, t, task) }),
        ("MRIStepEvolve", |memory, target, t, y, _, task| unsafe { ffi::MRIStepEvolve(memory, target, y, t, task) });
    // SAFETY: as above.
    reinit: Reinit = ("CVodeReInit", |memory, _, t, y, _| unsafe { ffi::CVodeReInit(memory, t, y) }),
        ("IDAReInit", |memory, _, t, y, yp| unsafe { ffi::IDAReInit(memory, t, y, yp) }),
        ("ARKStepReInit", |memory, [f, g], t, y, _| unsafe { ffi::ARKStepReInit(memory, f, g, t, y) }),
        ("MRIStepReInit", |memory, [f, g], t, y, _| unsafe { ffi::MRIStepReInit(memory, f, g, t, y) });
    /// ARKODE does, and would refuse another stop time if the direction of time has been reversed.
    reinit_forgets_stop_time: bool = false, false, true, true;
    get_integrator_stats: GetIntegratorStats
        = ffi::CVodeGetIntegratorStats, ffi::IDAGetIntegratorStats, arkode_integrator_stats, multirate_integrator_stats;
    /// Codes of `solve` for a call that cannot be made.
    refusals: &'static [i32] = &[ffi::CV_ILL_INPUT, ffi::CV_TOO_CLOSE, ffi::CV_BAD_T], &[ffi::IDA_ILL_INPUT],
        &[ffi::ARK_ILL_INPUT, ffi::ARK_TOO_CLOSE, ffi::ARK_BAD_T], &[ffi::ARK_ILL_INPUT, ffi::ARK_TOO_CLOSE, ffi::ARK_BAD_T];
    /// Codes of `solve` for a mass matrix that cannot be factorized.
    mass_failures: &'static [i32] = &[], &[], &[ffi::ARK_MASSSETUP_FAIL, ffi::ARK_MASSSOLVE_FAIL], &[];
    /// Codes of `get_dky` for a time outside the last step, and for too high a derivative.
    bad_time: i32 = ffi::CV_BAD_T, ffi::IDA_BAD_T, ffi::ARK_BAD_T, ffi::ARK_BAD_T;
    bad_derivative: i32 = ffi::CV_BAD_K, ffi::IDA_BAD_K, ffi::ARK_BAD_K, ffi::ARK_BAD_K;
    /// ARKODE has neither integrals nor sensitivities.
    quadratures: Option<&'static QuadratureFunctions>
        = Some(QuadratureFunctions::CVODE), Some(QuadratureFunctions::IDA), None, None;
    sensitivities: Option<&'static SensitivityFunctions>
        = Some(SensitivityFunctions::CVODE), Some(SensitivityFunctions::IDA), None, None;
}

table! {
    /// The functions for quadratures.
    QuadratureFunctions: CVODE, IDA;
    reinit: Set<ffi::N_Vector> = CVodeQuadReInit, IDAQuadReInit;
    scalar_tolerances: SetTwo<f64, f64> = CVodeQuadSStolerances, IDAQuadSStolerances;
    vector_tolerances: SetTwo<f64, ffi::N_Vector> = CVodeQuadSVtolerances, IDAQuadSVtolerances;
    set_error_control: Set<i32> = CVodeSetQuadErrCon, IDASetQuadErrCon;
    get: SetTwo<*mut f64, ffi::N_Vector> = CVodeGetQuad, IDAGetQuad;
    get_dky: GetDky = CVodeGetQuadDky, IDAGetQuadDky;
    get_evaluations: Get<i64> = CVodeGetQuadNumRhsEvals, IDAGetQuadNumRhsEvals;
    [others]
}

table! {
    /// The functions for sensitivities.
    SensitivityFunctions: CVODE, IDA;
    set_parameters: SetThree<*mut f64, *mut f64, *mut i32> = CVodeSetSensParams, IDASetSensParams;
    set_tolerances: Named<unsafe extern "C" fn(*mut c_void) -> i32> = CVodeSensEEtolerances, IDASensEEtolerances;
    set_error_control: Set<i32> = CVodeSetSensErrCon, IDASetSensErrCon;
    get: SetTwo<*mut f64, *mut ffi::N_Vector> = CVodeGetSens, IDAGetSens;
    get_dky: Named<unsafe extern "C" fn(*mut c_void, f64, i32, i32, ffi::N_Vector) -> i32>
        = CVodeGetSensDky1, IDAGetSensDky1;
    get_evaluations: Get<i64> = CVodeGetSensNumRhsEvals, IDAGetSensNumResEvals;
    [others]
    // SAFETY: as above.
    reinit: ReinitSensitivities
        = ("CVodeSensReInit", |memory, method, s, _| unsafe { ffi::CVodeSensReInit(memory, method, s) }),
        ("IDASensReInit", |memory, method, s, sp| unsafe { ffi::IDASensReInit(memory, method, s, sp) });
}

table! {
    /// The functions for sensitivities of integrals.
    QuadratureSensitivityFunctions: CVODE, IDA;
    reinit: Set<*mut ffi::N_Vector> = CVodeQuadSensReInit, IDAQuadSensReInit;
    set_tolerances: Named<unsafe extern "C" fn(*mut c_void) -> i32> = CVodeQuadSensEEtolerances, IDAQuadSensEEtolerances;
    set_error_control: Set<i32> = CVodeSetQuadSensErrCon, IDASetQuadSensErrCon;
    get: SetTwo<*mut f64, *mut ffi::N_Vector> = CVodeGetQuadSens, IDAGetQuadSens;
    get_dky: Named<unsafe extern "C" fn(*mut c_void, f64, i32, i32, ffi::N_Vector) -> i32>
        = CVodeGetQuadSensDky1, IDAGetQuadSensDky1;
    [others]
}

table! {
    /// The functions for backward problems, which belong to the memory of the forward run and are identified by a
    /// number, the first argument.
    BackwardFunctions: CVODE, IDA;
    /// (memory, steps between checkpoints, interpolation)
    init_checkpoints: SetTwo<i64, i32> = CVodeAdjInit, IDAAdjInit;
    vector_tolerances: SetThree<i32, f64, ffi::N_Vector> = CVodeSVtolerancesB, IDASVtolerancesB;
    set_user_data: SetTwo<i32, *mut c_void> = CVodeSetUserDataB, IDASetUserDataB;
    set_max_steps: SetTwo<i32, i64> = CVodeSetMaxNumStepsB, IDASetMaxNumStepsB;
    set_linear_solver: SetThree<i32, ffi::SUNLinearSolver, ffi::SUNMatrix>
        = CVodeSetLinearSolverB, IDASetLinearSolverB;
    set_quadrature_error_control: SetTwo<i32, i32> = CVodeSetQuadErrConB, IDASetQuadErrConB;
    quadrature_tolerances: SetThree<i32, f64, ffi::N_Vector> = CVodeQuadSVtolerancesB, IDAQuadSVtolerancesB;
    /// (memory, target, task)
    solve: SetTwo<f64, i32> = CVodeB, IDASolveB;
    get_quadratures: SetThree<i32, *mut f64, ffi::N_Vector> = CVodeGetQuadB, IDAGetQuadB;
    get_current_time: Get<f64> = CVodeGetCurrentTime, IDAGetCurrentTime;
    get_current_order: Get<i32> = CVodeGetCurrentOrder, IDAGetCurrentOrder;
    [others]
    integrator: &'static str = "CVODE in the backward run", "IDA in the backward run";
    /// The memory of the backward problem.
    get_memory: unsafe extern "C" fn(*mut c_void, i32) -> *mut c_void
        = ffi::CVodeGetAdjCVodeBmem, ffi::IDAGetAdjIDABmem;
    /// Integrates forward with checkpoints.
    // SAFETY: as above, here and in the other rows.
    solve_forward: Solve
        = ("CVodeF", |memory, target, t, y, _, task| unsafe { ffi::CVodeF(memory, target, y, t, task, &mut 0) }),
        ("IDASolveF", |memory, target, t, y, yp, task| unsafe {
            ffi::IDASolveF(memory, target, t, y, yp, task, &mut 0)
        });
    /// (memory, number of the problem)
    // SAFETY: as above.
    create: Named<unsafe fn(*mut c_void, *mut i32) -> i32>
        = ("CVodeCreateB", |memory, which| unsafe { ffi::CVodeCreateB(memory, ffi::CV_BDF, which) }),
        ("IDACreateB", |memory, which| unsafe { ffi::IDACreateB(memory, which) });
    // SAFETY: as above.
    get: GetBackward
        = ("CVodeGetB", |memory, which, t, lambda, _| unsafe { ffi::CVodeGetB(memory, which, t, lambda) }),
        ("IDAGetB", |memory, which, t, lambda, slope| unsafe { ffi::IDAGetB(memory, which, t, lambda, slope) });
}

table! {
    /// The functions of the integrators of ODEs that take callbacks.
    OdeFunctions: CVODE, ARKODE, MULTIRATE;
    set_roots: SetTwo<i32, ffi::CVRootFn> = CVodeRootInit, ARKStepRootInit, MRIStepRootInit;
    set_jacobian: Set<ffi::CVLsJacFn> = CVodeSetJacFn, ARKStepSetJacFn, MRIStepSetJacFn;
    set_jacobian_times: SetTwo<ffi::CVLsJacTimesSetupFn, ffi::CVLsJacTimesVecFn>
        = CVodeSetJacTimes, ARKStepSetJacTimes, MRIStepSetJacTimes;
    set_preconditioner: SetTwo<ffi::CVLsPrecSetupFn, ffi::CVLsPrecSolveFn>
        = CVodeSetPreconditioner, ARKStepSetPreconditioner, MRIStepSetPreconditioner;
    set_newton_rhs: Set<ffi::CVRhsFn> = CVodeSetNlsRhsFn, ARKStepSetNlsRhsFn, MRIStepSetNlsRhsFn;
}

table! {
    /// The functions for implicit stages of the methods of ARKODE.
    StageFunctions: ARKODE, MULTIRATE;
    set_predictor: Set<i32> = ARKStepSetPredictorMethod, MRIStepSetPredictorMethod;
    set_max_iterations: Set<i32> = ARKStepSetMaxNonlinIters, MRIStepSetMaxNonlinIters;
    deduce_slopes: Set<i32> = ARKStepSetDeduceImplicitRhs, MRIStepSetDeduceImplicitRhs;
    set_linear: Set<i32> = ARKStepSetLinear, MRIStepSetLinear;
    set_setup_frequency: Set<i32> = ARKStepSetLSetupFrequency, MRIStepSetLSetupFrequency;
    set_jacobian_frequency: Set<i64> = ARKStepSetJacEvalFrequency, MRIStepSetJacEvalFrequency;
    set_linear_system: Set<ffi::ARKLsLinSysFn> = ARKStepSetLinSysFn, MRIStepSetLinSysFn;
    [others]
    ode: &'static OdeFunctions = OdeFunctions::ARKODE, OdeFunctions::MULTIRATE;
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

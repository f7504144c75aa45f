//! Building an ARKODE solver.

use std::{ffi::c_void, ptr};

use super::{Arkode, options::ArkodeOptions};
use crate::{
    ode::Ode,
    sundials::{
        error::Error,
        ffi,
        functions::Functions,
        linear::LinearSolver,
        nonlinear::NonlinearSolver,
        ode_callbacks::{
            jacobian, newton_rhs, newton_setup_with_mass, note_step_end, note_time, rhs, roots,
        },
        options::check_start,
        session::{Session, Start},
    },
};

impl<S: Ode> Arkode<S> {
    /// The functions for implicit methods.
    const IMPLICIT: &'static Functions = &Functions {
        solver: "ARKODE",
        free: ffi::ARKStepFree,
        solve: ("ARKStepEvolve", |memory, target, t, y, _, task| {
            // SAFETY: whoever calls through the table vouches for the arguments.
            unsafe { ffi::ARKStepEvolve(memory, target, y, t, task) }
        }),
        reinit: ("ARKStepReInit", |memory, t, y, _| {
            // SAFETY: as above; the callback fits the host of the session.
            unsafe { ffi::ARKStepReInit(memory, None, Some(rhs::<S>), t, y) }
        }),
        reinit_forgets_stop_time: true,
        refusals: &[ffi::ARK_ILL_INPUT, ffi::ARK_TOO_CLOSE, ffi::ARK_BAD_T],
        set_error_handler: ("ARKStepSetErrHandlerFn", ffi::ARKStepSetErrHandlerFn),
        set_user_data: ("ARKStepSetUserData", ffi::ARKStepSetUserData),
        scalar_tolerances: ("ARKStepSStolerances", ffi::ARKStepSStolerances),
        vector_tolerances: ("ARKStepSVtolerances", ffi::ARKStepSVtolerances),
        set_linear_solver: ("ARKStepSetLinearSolver", ffi::ARKStepSetLinearSolver),
        allow_inactive_roots: ("ARKStepSetNoInactiveRootWarn", ffi::ARKStepSetNoInactiveRootWarn),
        set_max_steps: ("ARKStepSetMaxNumSteps", ffi::ARKStepSetMaxNumSteps),
        set_initial_step: ("ARKStepSetInitStep", ffi::ARKStepSetInitStep),
        set_max_step: ("ARKStepSetMaxStep", ffi::ARKStepSetMaxStep),
        set_min_step: ("ARKStepSetMinStep", ffi::ARKStepSetMinStep),
        set_max_order: None,
        set_convergence_coefficient: ("ARKStepSetNonlinConvCoef", ffi::ARKStepSetNonlinConvCoef),
        set_stop_time: ("ARKStepSetStopTime", ffi::ARKStepSetStopTime),
        get_root_info: ("ARKStepGetRootInfo", ffi::ARKStepGetRootInfo),
        get_dky: ("ARKStepGetDky", ffi::ARKStepGetDky),
        bad_time: ffi::ARK_BAD_T,
        bad_derivative: ffi::ARK_BAD_K,
        get_step_parameter: ffi::ARKStepGetCurrentGamma,
        get_linear_flag: ffi::ARKStepGetLastLinFlag,
        get_integrator_stats,
        get_nonlinear_stats: ffi::ARKStepGetNonlinSolvStats,
        get_step_failures: ffi::ARKStepGetNumStepSolveFails,
        get_jacobian_evaluations: ffi::ARKStepGetNumJacEvals,
        get_quotient_evaluations: ffi::ARKStepGetNumLinRhsEvals,
        get_root_evaluations: ffi::ARKStepGetNumGEvals,
        get_stability_reductions: None,
        get_tolerance_scale: ffi::ARKStepGetTolScaleFactor,
    };

    /// The functions for explicit methods.
    const EXPLICIT: &'static Functions = &Functions {
        reinit: ("ARKStepReInit", |memory, t, y, _| {
            // SAFETY: as above.
            unsafe { ffi::ARKStepReInit(memory, Some(rhs::<S>), None, t, y) }
        }),
        ..*Self::IMPLICIT
    };
}

/// `CVodeGetIntegratorStats` for ARKODE: evaluations are the explicit and the implicit ones, and
/// both orders that of the table.
unsafe extern "C" fn get_integrator_stats(
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
) -> i32 {
    let [mut explicit, mut implicit] = [0; 2];
    let (mut implicit_table, mut explicit_table) = (ptr::null_mut(), ptr::null_mut());
    // SAFETY: whoever calls through the table vouches for memory and places; a table that is
    // there lives as long as the memory.
    unsafe {
        let code = ffi::ARKStepGetStepStats(
            memory,
            steps,
            initial_step,
            last_step,
            current_step,
            current_time,
        );
        ffi::ARKStepGetNumRhsEvals(memory, &raw mut explicit, &raw mut implicit);
        ffi::ARKStepGetNumLinSolvSetups(memory, setups);
        ffi::ARKStepGetNumErrTestFails(memory, error_test_failures);
        ffi::ARKStepGetCurrentButcherTables(
            memory,
            &raw mut implicit_table,
            &raw mut explicit_table,
        );
        *evaluations = explicit + implicit;
        let table = if implicit_table.is_null() { explicit_table } else { implicit_table };
        let order = table.as_ref().map_or(0, |table| table.q);
        (*last_order, *current_order) = (order, order);
        code
    }
}

pub(super) fn new<S: Ode>(
    system: S,
    t0: f64,
    y0: &[f64],
    options: &ArkodeOptions,
) -> Result<Arkode<S>, Error> {
    check_start(t0, y0)?;
    options.check(y0)?;

    let start = Start { t: t0, y: y0, yp: None, root_count: system.root_count() };
    let is_implicit = options.table.is_implicit();
    let (functions, explicit, implicit) = match is_implicit {
        true => (Arkode::<S>::IMPLICIT, None, Some(rhs::<S> as _)),
        false => (Arkode::<S>::EXPLICIT, Some(rhs::<S> as _), None),
    };
    let solver = options.nonlinear.linear_solver().filter(|_| is_implicit).cloned();
    // SAFETY: the session passes a live context and a vector of its own, the table is that of
    // ARKODE, and the callbacks fit the host that is registered as their data.
    let mut session = unsafe {
        let create = |y, context| ffi::ARKStepCreate(explicit, implicit, t0, y, context);
        Session::new(functions, ("ARKStepCreate", create), system, &start, solver)?
    };
    session.host.get_mut().step_end = Some(t0);
    session.configure(&options.tolerances, &options.steps)?;
    let (implicit_id, explicit_id) = options.table.ids();
    let degree = options.interpolant_degree();
    // SAFETY: the callback fits the host; the memory is alive and reads the names, C strings, once;
    // the other values are plain numbers.
    unsafe {
        session.watch_roots(("ARKStepRootInit", ffi::ARKStepRootInit), Some(roots::<S>))?;
        let (implicit, explicit) = (implicit_id.as_ptr(), explicit_id.as_ptr());
        let code = ffi::ARKStepSetTableName(session.memory.raw, implicit, explicit);
        session.host.accept("ARKStepSetTableName", code)?;
        let set = ("ARKStepSetInterpolantDegree", ffi::ARKStepSetInterpolantDegree as _);
        session.set(set, degree as i32)?;
        // The post-processing of steps would make ARKODE evaluate the right-hand side at their ends.
        if let Some(h) = options.fixed_step {
            session.set(("ARKStepSetFixedStep", ffi::ARKStepSetFixedStep), h)?;
            let set = ("ARKStepSetPostprocessStepFn", ffi::ARKStepSetPostprocessStepFn as _);
            session.set(set, Some(note_step_end::<S> as _))?;
        } else {
            let (memory, data) = (session.memory.raw, session.host.as_ptr());
            let code = ffi::ARKStepSetStabilityFn(memory, Some(note_time::<S>), data);
            session.host.accept("ARKStepSetStabilityFn", code)?;
        }
    }
    if is_implicit {
        solve_stages(&mut session, options)?;
    }
    Ok(Arkode { session, degree })
}

/// Says how the equations of implicit stages are solved.
fn solve_stages<S: Ode>(session: &mut Session<S>, options: &ArkodeOptions) -> Result<(), Error> {
    // SAFETY: the values are plain numbers.
    unsafe {
        let set = ("ARKStepSetPredictorMethod", ffi::ARKStepSetPredictorMethod as _);
        session.set(set, options.predictor as i32)?;
        let set = ("ARKStepSetMaxNonlinIters", ffi::ARKStepSetMaxNonlinIters as _);
        session.set(set, options.max_iterations as i32)?;
        // The slope of a stage follows from its equation: this spares an evaluation, which would
        // also stop the integration if it failed, and magnify errors of stiff components.
        let set = ("ARKStepSetDeduceImplicitRhs", ffi::ARKStepSetDeduceImplicitRhs as _);
        session.set(set, 1)?;
        if options.linear {
            session.set(("ARKStepSetLinear", ffi::ARKStepSetLinear as _), 0)?;
        }
        if let Some(steps) = options.nonlinear.max_steps_between_setups {
            let set = ("ARKStepSetLSetupFrequency", ffi::ARKStepSetLSetupFrequency as _);
            session.set(set, steps as i32)?;
        }
    }
    // SAFETY: the callbacks fit the registered host, and the solvers live as long as the memory.
    unsafe {
        match &options.nonlinear.solver {
            NonlinearSolver::Newton(solver) => {
                session.use_newton(solver, S::newton_solve)?;
                if matches!(solver, LinearSolver::Custom) {
                    let callback = Some(newton_setup_with_mass::<S> as _);
                    session.set(("ARKStepSetLinSysFn", ffi::ARKStepSetLinSysFn), callback)?;
                    let callback = Some(newton_rhs::<S> as _);
                    session.set(("ARKStepSetNlsRhsFn", ffi::ARKStepSetNlsRhsFn), callback)?;
                } else if solver.has_jacobian_callback() {
                    let callback = Some(jacobian::<S> as _);
                    session.set(("ARKStepSetJacFn", ffi::ARKStepSetJacFn), callback)?;
                }
                if let Some(steps) = options.max_steps_between_jacobians {
                    let set = ("ARKStepSetJacEvalFrequency", ffi::ARKStepSetJacEvalFrequency as _);
                    session.set(set, i64::from(steps))?;
                }
            }
            NonlinearSolver::FixedPoint { acceleration } => {
                let set = ("ARKStepSetNonlinearSolver", ffi::ARKStepSetNonlinearSolver as _);
                session.use_fixed_point(set, *acceleration)?;
            }
        }
    }
    Ok(())
}

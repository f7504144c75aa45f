//! Building a CVODE solver.

use super::{
    Cvode,
    options::{CvodeOptions, Multistep},
};
use crate::{
    ode::Ode,
    sundials::{
        error::Error,
        ffi,
        functions::Functions,
        linear::LinearSolver,
        nonlinear::NonlinearSolver,
        ode_callbacks::{jacobian, newton_rhs, newton_setup, rhs, roots},
        options::check_start,
        session::{Session, Start},
    },
};

static FUNCTIONS: Functions = Functions {
    solver: "CVODE",
    free: ffi::CVodeFree,
    solve: ("CVode", |memory, target, t, y, _, task| {
        // SAFETY: whoever calls through the table vouches for the arguments.
        unsafe { ffi::CVode(memory, target, y, t, task) }
    }),
    reinit: ("CVodeReInit", |memory, t, y, _| {
        // SAFETY: as above.
        unsafe { ffi::CVodeReInit(memory, t, y) }
    }),
    reinit_forgets_stop_time: false,
    refusals: &[ffi::CV_ILL_INPUT, ffi::CV_TOO_CLOSE, ffi::CV_BAD_T],
    set_error_handler: ("CVodeSetErrHandlerFn", ffi::CVodeSetErrHandlerFn),
    set_user_data: ("CVodeSetUserData", ffi::CVodeSetUserData),
    scalar_tolerances: ("CVodeSetTolerances", ffi::CVodeSStolerances),
    vector_tolerances: ("CVodeSetTolerances", ffi::CVodeSVtolerances),
    set_linear_solver: ("CVodeSetLinearSolver", ffi::CVodeSetLinearSolver),
    allow_inactive_roots: ("CVodeSetNoInactiveRootWarn", ffi::CVodeSetNoInactiveRootWarn),
    set_max_steps: ("CVodeSetMaxNumSteps", ffi::CVodeSetMaxNumSteps),
    set_initial_step: ("CVodeSetInitStep", ffi::CVodeSetInitStep),
    set_max_step: ("CVodeSetMaxStep", ffi::CVodeSetMaxStep),
    set_min_step: ("CVodeSetMinStep", ffi::CVodeSetMinStep),
    set_max_order: Some(("CVodeSetMaxOrd", ffi::CVodeSetMaxOrd)),
    set_convergence_coefficient: ("CVodeSetNonlinConvCoef", ffi::CVodeSetNonlinConvCoef),
    set_stop_time: ("CVodeSetStopTime", ffi::CVodeSetStopTime),
    get_root_info: ("CVodeGetRootInfo", ffi::CVodeGetRootInfo),
    get_dky: ("CVodeGetDky", ffi::CVodeGetDky),
    bad_time: ffi::CV_BAD_T,
    bad_derivative: ffi::CV_BAD_K,
    get_step_parameter: ffi::CVodeGetCurrentGamma,
    get_linear_flag: ffi::CVodeGetLastLinFlag,
    get_integrator_stats: ffi::CVodeGetIntegratorStats,
    get_nonlinear_stats: ffi::CVodeGetNonlinSolvStats,
    get_step_failures: ffi::CVodeGetNumStepSolveFails,
    get_jacobian_evaluations: ffi::CVodeGetNumJacEvals,
    get_quotient_evaluations: ffi::CVodeGetNumLinRhsEvals,
    get_root_evaluations: ffi::CVodeGetNumGEvals,
    get_stability_reductions: Some(ffi::CVodeGetNumStabLimOrderReds),
    get_tolerance_scale: ffi::CVodeGetTolScaleFactor,
};

pub(super) fn new<S: Ode>(
    system: S,
    t0: f64,
    y0: &[f64],
    options: &CvodeOptions,
) -> Result<Cvode<S>, Error> {
    check_start(t0, y0)?;
    options.check(y0)?;

    let start = Start { t: t0, y: y0, yp: None, root_count: system.root_count() };
    let method = match options.method {
        Multistep::Bdf => ffi::CV_BDF,
        Multistep::Adams => ffi::CV_ADAMS,
    };
    // SAFETY: the session passes a live context, and the table is that of CVODE.
    let mut session = unsafe {
        let create = ("CVodeCreate", |_, context| ffi::CVodeCreate(method, context));
        let solver = options.nonlinear.linear_solver().cloned();
        Session::new(&FUNCTIONS, create, system, &start, solver)?
    };
    // SAFETY: the memory is alive, the vector has the right length, and the callbacks fit the
    // host that is registered as their data.
    unsafe {
        let code = ffi::CVodeInit(session.memory.raw, Some(rhs::<S>), t0, session.y.raw());
        session.host.accept("CVodeInit", code)?;
        session.configure(&options.tolerances, &options.steps)?;
        session.watch_roots(("CVodeRootInit", ffi::CVodeRootInit), Some(roots::<S>))?;
    }
    // SAFETY: the values are plain numbers.
    unsafe {
        if options.stability_limit_detection {
            session.set(("CVodeSetStabLimDet", ffi::CVodeSetStabLimDet), 1)?;
        }
        if let Some(steps) = options.nonlinear.max_steps_between_setups {
            let function = ("CVodeSetLSetupFrequency", ffi::CVodeSetLSetupFrequency as _);
            session.set(function, i64::from(steps))?;
        }
    }
    // SAFETY: the callbacks fit the registered host, and the solvers live as long as the memory.
    unsafe {
        match &options.nonlinear.solver {
            NonlinearSolver::Newton(solver) => {
                session.use_newton(solver, S::newton_solve)?;
                if matches!(solver, LinearSolver::Custom) {
                    let callback = Some(newton_setup::<S> as _);
                    session.set(("CVodeSetLinSysFn", ffi::CVodeSetLinSysFn), callback)?;
                    let callback = Some(newton_rhs::<S> as _);
                    session.set(("CVodeSetNlsRhsFn", ffi::CVodeSetNlsRhsFn), callback)?;
                } else if solver.has_jacobian_callback() {
                    let callback = Some(jacobian::<S> as _);
                    session.set(("CVodeSetJacFn", ffi::CVodeSetJacFn), callback)?;
                }
            }
            NonlinearSolver::FixedPoint { acceleration } => {
                let set = ("CVodeSetNonlinearSolver", ffi::CVodeSetNonlinearSolver as _);
                session.use_fixed_point(set, *acceleration)?;
            }
        }
    }
    Ok(Cvode(session))
}

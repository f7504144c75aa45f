//! Building a CVODE solver.

use super::options::{CvodeOptions, Multistep};
use crate::integrators::{
    common::{Error, check_form, check_start},
    ode::{Borrowed, Ode},
    sundials::{
        ffi,
        functions::{Functions, QuadratureFunctions, SensitivityFunctions, named},
        linear_solver::LinearSolver,
        nonlinear::NonlinearSolver,
        ode_callbacks::{jacobian, newton_rhs, project, quadratures, rhs, roots},
        ode_krylov::{jacobian_times, newton_setup, precondition_setup, precondition_solve},
        sensitivity::{Access, CarriesSensitivities, one_rhs},
        session::{InitialState, Session},
        solver::{Kind, Owner, Solver, WithSensitivities},
    },
};

/// Integrates y' = f(t, y) with variable step size and order.
///
/// Made by `Cvode::new`, used through the methods of [`Integrator`](crate::integrators::common::Integrator).
///
/// User guide: chapter "Using CVODE".
pub type Cvode<S> = Solver<CvodeKind, S>;

/// Marks a [`Solver`] as one of CVODE.
#[derive(Debug)]
pub struct CvodeKind;

impl Kind for CvodeKind {
    type System = dyn Ode;
    type Session = dyn CarriesSensitivities<System = Borrowed<'static, dyn Ode>>;

    const NAME: &'static str = "CVODE";
}

impl WithSensitivities for CvodeKind {}

static FUNCTIONS: Functions = TABLE;

/// CVODES as it runs forward with checkpoints.
pub(in crate::integrators::sundials) static WITH_CHECKPOINTS: Functions = Functions {
    solve: ("CVodeF", |memory, target, t, y, _, task| {
        let mut checkpoints = 0;
        // SAFETY: whoever calls through the table vouches for the arguments.
        unsafe { ffi::CVodeF(memory, target, y, t, task, &raw mut checkpoints) }
    }),
    ..TABLE
};

const TABLE: Functions = Functions {
    integrator: CvodeKind::NAME,
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
    reset: None,
    refusals: &[ffi::CV_ILL_INPUT, ffi::CV_TOO_CLOSE, ffi::CV_BAD_T],
    mass_failures: &[],
    set_error_handler: named!(CVodeSetErrHandlerFn),
    set_user_data: named!(CVodeSetUserData),
    scalar_tolerances: ("CVodeSetTolerances", ffi::CVodeSStolerances),
    vector_tolerances: ("CVodeSetTolerances", ffi::CVodeSVtolerances),
    set_linear_solver: named!(CVodeSetLinearSolver),
    allow_inactive_roots: named!(CVodeSetNoInactiveRootWarn),
    set_max_steps: named!(CVodeSetMaxNumSteps),
    set_initial_step: named!(CVodeSetInitStep),
    set_max_step: named!(CVodeSetMaxStep),
    set_min_step: named!(CVodeSetMinStep),
    set_max_error_test_failures: Some(named!(CVodeSetMaxErrTestFails)),
    set_max_order: Some(named!(CVodeSetMaxOrd)),
    set_convergence_coefficient: named!(CVodeSetNonlinConvCoef),
    set_tolerance_factor: named!(CVodeSetEpsLin),
    set_stop_time: named!(CVodeSetStopTime),
    set_constraints: named!(CVodeSetConstraints),
    get_root_info: named!(CVodeGetRootInfo),
    get_dky: named!(CVodeGetDky),
    bad_time: ffi::CV_BAD_T,
    bad_derivative: ffi::CV_BAD_K,
    get_step_parameter: ffi::CVodeGetCurrentGamma,
    get_current_step: ffi::CVodeGetCurrentStep,
    get_error_weights: named!(CVodeGetErrWeights),
    get_linear_flag: ffi::CVodeGetLastLinFlag,
    get_integrator_stats: ffi::CVodeGetIntegratorStats,
    get_nonlinear_stats: ffi::CVodeGetNonlinSolvStats,
    get_step_failures: ffi::CVodeGetNumStepSolveFails,
    get_jacobian_evaluations: ffi::CVodeGetNumJacEvals,
    get_quotient_evaluations: ffi::CVodeGetNumLinRhsEvals,
    get_linear_iterations: ffi::CVodeGetNumLinIters,
    get_linear_failures: ffi::CVodeGetNumLinConvFails,
    get_preconditioner_setups: ffi::CVodeGetNumPrecEvals,
    get_preconditioner_solves: ffi::CVodeGetNumPrecSolves,
    get_root_evaluations: ffi::CVodeGetNumGEvals,
    get_explicit_evaluations: None,
    get_stability_reductions: Some(ffi::CVodeGetNumStabLimOrderReds),
    get_tolerance_scale: ffi::CVodeGetTolScaleFactor,
    quadratures: Some(&QuadratureFunctions {
        reinit: named!(CVodeQuadReInit),
        scalar_tolerances: named!(CVodeQuadSStolerances),
        vector_tolerances: named!(CVodeQuadSVtolerances),
        set_error_control: named!(CVodeSetQuadErrCon),
        get: named!(CVodeGetQuad),
        get_dky: named!(CVodeGetQuadDky),
        get_evaluations: ffi::CVodeGetQuadNumRhsEvals,
    }),
    sensitivities: Some(&SensitivityFunctions {
        reinit: ("CVodeSensReInit", |memory, method, s, _| {
            // SAFETY: whoever calls through the table vouches for the arguments.
            unsafe { ffi::CVodeSensReInit(memory, method, s) }
        }),
        set_parameters: named!(CVodeSetSensParams),
        set_tolerances: named!(CVodeSensEEtolerances),
        set_error_control: named!(CVodeSetSensErrCon),
        get: named!(CVodeGetSens),
        get_dky: named!(CVodeGetSensDky1),
        get_evaluations: ffi::CVodeGetSensNumRhsEvals,
    }),
};

impl<S: Ode> Cvode<S> {
    /// A solver for `system`, starting at time `t0` from `y0`.
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that cannot be used.
    pub fn new(system: S, t0: f64, y0: &[f64], options: &CvodeOptions) -> Result<Self, Error> {
        let mut system = Owner::new(system);
        // SAFETY: the solver drops the session first, and accesses the system through it.
        unsafe {
            let session = start(system.lend_ode(), t0, y0, options)?;
            Ok(Self::new_within(session, system))
        }
    }
}

/// A session of [`Cvode`].
fn start(
    system: Borrowed<'static, dyn Ode>,
    t0: f64,
    y0: &[f64],
    options: &CvodeOptions,
) -> Result<Box<<CvodeKind as Kind>::Session>, Error> {
    Ok(Box::new(Session::of_cvode(system, t0, y0, options)?))
}

impl<S: Ode> Session<CvodeKind, S> {
    pub(in crate::integrators::sundials) fn of_cvode(
        system: S,
        t0: f64,
        y0: &[f64],
        options: &CvodeOptions,
    ) -> Result<Self, Error> {
        check_start(t0, y0)?;
        options.check(y0)?;
        check_form(&system)?;

        let count = system.quadrature_count();
        let start = InitialState { t: t0, y: y0, yp: None, root_count: system.root_count() };
        let method = match options.method {
            Multistep::Bdf => ffi::CV_BDF,
            Multistep::Adams => ffi::CV_ADAMS,
        };
        // SAFETY: `create` gets a live context, and the table is that of CVODE.
        let mut cvode = unsafe {
            let create = ("CVodeCreate", |_, context| ffi::CVodeCreate(method, context));
            let solver = options.nonlinear.linear_solver().cloned();
            Self::create(&FUNCTIONS, create, CvodeKind, system, &start, solver)?
        };
        // SAFETY: the memory is alive, the vector has the right length, and the callbacks fit the
        // host that is registered as their data.
        unsafe {
            let (memory, y) = (cvode.memory.raw, cvode.y.raw());
            cvode.host.call(named!(CVodeInit), |init| init(memory, Some(rhs::<S>), t0, y))?;
            cvode.configure(&options.tolerances, &options.steps, &options.limits)?;
            cvode.set_root_functions(named!(CVodeRootInit), Some(roots::<S>))?;
            let tolerances = (&options.quadratures, &options.tolerances);
            let integrands = Some(quadratures::<S> as _);
            cvode.set_quadratures(count, named!(CVodeQuadInit), integrands, tolerances)?;
        }
        // SAFETY: the callback fits the registered host; the other values are plain numbers.
        unsafe {
            if options.project {
                cvode.set(named!(CVodeSetProjFn), Some(project::<S> as _))?;
            }
            if options.stability_limit_detection {
                cvode.set(named!(CVodeSetStabLimDet), 1)?;
            }
            if let Some(steps) = options.nonlinear.max_steps_between_setups {
                cvode.set(named!(CVodeSetLSetupFrequency as _), i64::from(steps))?;
            }
        }
        if let Some(sensitivities) = &options.sensitivities {
            let memory = cvode.memory.raw;
            let access = Access { get: S::parameters, set: S::set_parameters };
            // SAFETY: the memory is alive, and the callback fits the host.
            unsafe {
                let init = ("CVodeSensInit1", |count, method, s, _| {
                    ffi::CVodeSensInit1(memory, count, method, Some(one_rhs::<S>), s)
                });
                cvode.set_up_sensitivities(sensitivities, &options.tolerances, &access, init)?;
            }
        }
        // SAFETY: the callbacks fit the registered host, and the solvers live as long as the memory.
        unsafe {
            match &options.nonlinear.solver {
                NonlinearSolver::Newton(solver) => {
                    let for_jacobian = (&options.tolerances, &options.limits);
                    cvode.set_newton(solver, S::newton_solve, for_jacobian)?;
                    if matches!(solver, LinearSolver::Custom) {
                        cvode.set(named!(CVodeSetLinSysFn), Some(newton_setup::<S> as _))?;
                        cvode.set(named!(CVodeSetNlsRhsFn), Some(newton_rhs::<S> as _))?;
                    } else if let LinearSolver::Krylov(krylov) = solver {
                        cvode.set_krylov(
                            krylov,
                            (named!(CVodeSetJacTimes), Some(jacobian_times::<S>)),
                            (
                                named!(CVodeSetPreconditioner),
                                Some(precondition_setup::<S>),
                                Some(precondition_solve::<S>),
                            ),
                        )?;
                    } else {
                        cvode.set(named!(CVodeSetJacFn), Some(jacobian::<S> as _))?;
                    }
                }
                NonlinearSolver::FixedPoint { acceleration } => {
                    cvode.set_fixed_point(named!(CVodeSetNonlinearSolver as _), *acceleration)?;
                }
            }
        }
        Ok(cvode)
    }
}

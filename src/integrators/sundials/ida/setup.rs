//! Building an IDA solver.

use super::options::IdaOptions;
use crate::integrators::{
    common::{Error, check_finite, check_length, check_start},
    ode::Dae,
    sundials::{
        dae_callbacks::{jacobian, quadratures, residual, roots},
        dae_krylov::{jacobian_times, precondition_setup, precondition_solve},
        ffi,
        functions::{Functions, QuadratureFunctions, SensitivityFunctions, named},
        index::index,
        linear_solver::LinearSolver,
        sensitivity::{Access, all_residuals},
        session::{InitialState, Session},
        vector::Vector,
    },
};

/// Marks a [`Solver`](crate::integrators::sundials::Solver) as one of IDA.
#[derive(Debug)]
pub struct IdaKind {
    pub(super) knows_algebraic: bool,
}

static FUNCTIONS: Functions = TABLE;

/// IDAS as it runs forward with checkpoints.
pub(in crate::integrators::sundials) static WITH_CHECKPOINTS: Functions = Functions {
    solve: ("IDASolveF", |memory, target, t, y, yp, task| {
        let mut checkpoints = 0;
        // SAFETY: whoever calls through the table vouches for the arguments.
        unsafe { ffi::IDASolveF(memory, target, t, y, yp, task, &raw mut checkpoints) }
    }),
    ..TABLE
};

const TABLE: Functions = Functions {
    integrator: "IDA",
    free: ffi::IDAFree,
    solve: ("IDASolve", |memory, target, t, y, yp, task| {
        // SAFETY: whoever calls through the table vouches for the arguments.
        unsafe { ffi::IDASolve(memory, target, t, y, yp, task) }
    }),
    reinit: ("IDAReInit", |memory, t, y, yp| {
        // SAFETY: as above.
        unsafe { ffi::IDAReInit(memory, t, y, yp) }
    }),
    reinit_forgets_stop_time: false,
    reset: None,
    refusals: &[ffi::IDA_ILL_INPUT],
    mass_failures: &[],
    set_error_handler: named!(IDASetErrHandlerFn),
    set_user_data: named!(IDASetUserData),
    scalar_tolerances: ("IDASetTolerances", ffi::IDASStolerances),
    vector_tolerances: ("IDASetTolerances", ffi::IDASVtolerances),
    set_linear_solver: named!(IDASetLinearSolver),
    allow_inactive_roots: named!(IDASetNoInactiveRootWarn),
    set_max_steps: named!(IDASetMaxNumSteps),
    set_initial_step: named!(IDASetInitStep),
    set_max_step: named!(IDASetMaxStep),
    set_min_step: named!(IDASetMinStep),
    set_max_error_test_failures: None,
    set_max_order: Some(named!(IDASetMaxOrd)),
    set_convergence_coefficient: named!(IDASetNonlinConvCoef),
    set_tolerance_factor: named!(IDASetEpsLin),
    set_stop_time: named!(IDASetStopTime),
    set_constraints: named!(IDASetConstraints),
    get_root_info: named!(IDAGetRootInfo),
    get_dky: named!(IDAGetDky),
    bad_time: ffi::IDA_BAD_T,
    bad_derivative: ffi::IDA_BAD_K,
    get_step_parameter: ffi::IDAGetCurrentCj,
    get_current_step: ffi::IDAGetCurrentStep,
    get_error_weights: named!(IDAGetErrWeights),
    get_linear_flag: ffi::IDAGetLastLinFlag,
    get_integrator_stats: ffi::IDAGetIntegratorStats,
    get_nonlinear_stats: ffi::IDAGetNonlinSolvStats,
    get_step_failures: ffi::IDAGetNumStepSolveFails,
    get_jacobian_evaluations: ffi::IDAGetNumJacEvals,
    get_quotient_evaluations: ffi::IDAGetNumLinResEvals,
    get_linear_iterations: ffi::IDAGetNumLinIters,
    get_linear_failures: ffi::IDAGetNumLinConvFails,
    get_preconditioner_setups: ffi::IDAGetNumPrecEvals,
    get_preconditioner_solves: ffi::IDAGetNumPrecSolves,
    get_root_evaluations: ffi::IDAGetNumGEvals,
    get_explicit_evaluations: None,
    get_stability_reductions: None,
    get_tolerance_scale: ffi::IDAGetTolScaleFactor,
    quadratures: Some(&QuadratureFunctions {
        reinit: named!(IDAQuadReInit),
        scalar_tolerances: named!(IDAQuadSStolerances),
        vector_tolerances: named!(IDAQuadSVtolerances),
        set_error_control: named!(IDASetQuadErrCon),
        get: named!(IDAGetQuad),
        get_dky: named!(IDAGetQuadDky),
        get_evaluations: ffi::IDAGetQuadNumRhsEvals,
    }),
    sensitivities: Some(&SensitivityFunctions {
        reinit: ("IDASensReInit", |memory, method, s, sp| {
            // SAFETY: whoever calls through the table vouches for the arguments.
            unsafe { ffi::IDASensReInit(memory, method, s, sp) }
        }),
        set_parameters: named!(IDASetSensParams),
        set_tolerances: named!(IDASensEEtolerances),
        set_error_control: named!(IDASetSensErrCon),
        get: named!(IDAGetSens),
        get_dky: named!(IDAGetSensDky1),
        get_evaluations: ffi::IDAGetSensNumResEvals,
    }),
};

impl<S: Dae> Session<IdaKind, S> {
    /// A session that starts as [`Ida::new`](super::Ida::new) says.
    pub(in crate::integrators::sundials) fn of_ida(
        system: S,
        t0: f64,
        (y0, yp0): (&[f64], &[f64]),
        options: &IdaOptions,
    ) -> Result<Self, Error> {
        check_start(t0, y0)?;
        check_length("length of yp0", yp0.len(), y0.len())?;
        check_finite("yp0", yp0)?;
        options.check(y0)?;

        let count = system.quadrature_count();
        let start = InitialState { t: t0, y: y0, yp: Some(yp0), root_count: system.root_count() };
        let solver = &options.linear_solver;
        let kind = IdaKind { knows_algebraic: options.differential.is_some() };
        // SAFETY: `create` gets a live context, and the table is that of IDA.
        let mut ida = unsafe {
            let create = ("IDACreate", |_, context| ffi::IDACreate(context));
            Self::create(&FUNCTIONS, create, kind, system, &start, Some(solver.clone()))?
        };
        let (memory, y, yp) = (ida.memory.raw, ida.y.raw(), ida.raw_yp());
        // SAFETY: the memory is alive, vectors have the right length, and the callbacks fit the host
        // that is registered as their data.
        unsafe {
            ida.host.call(named!(IDAInit), |init| init(memory, Some(residual::<S>), t0, y, yp))?;
            ida.configure(&options.tolerances, &options.steps, &options.limits)?;
            ida.set_root_functions(named!(IDARootInit), Some(roots::<S>))?;
            let tolerances = (&options.quadratures, &options.tolerances);
            let integrands = Some(quadratures::<S> as _);
            ida.set_quadratures(count, named!(IDAQuadInit), integrands, tolerances)?;
            let for_jacobian = (&options.tolerances, &options.limits);
            ida.set_newton(solver, |system, _, r| system.newton_solve(r), for_jacobian)?;
            if let LinearSolver::Krylov(krylov) = solver {
                ida.set_krylov(
                    krylov,
                    (named!(IDASetJacTimes), Some(jacobian_times::<S>)),
                    (
                        named!(IDASetPreconditioner),
                        Some(precondition_setup::<S>),
                        Some(precondition_solve::<S>),
                    ),
                )?;
            } else if solver.has_jacobian_callback() {
                ida.set(named!(IDASetJacFn), Some(jacobian::<S> as _))?;
            }
        }
        if !options.suppress_algebraic {
            ida.host.get_mut().find_index = Some(index);
        }
        if let Some(differential) = &options.differential {
            let id: Vec<f64> = differential.iter().map(|&d| f64::from(u8::from(d))).collect();
            let id = Vector::from_slice(&id, &ida.context)?;
            // SAFETY: IDA keeps a copy of the vector, whose length was checked.
            unsafe {
                ida.set(named!(IDASetId), id.raw())?;
                ida.set(named!(IDASetSuppressAlg), i32::from(options.suppress_algebraic))?;
            }
        }
        if let Some(sensitivities) = &options.sensitivities {
            let access = Access { get: S::parameters, set: S::set_parameters };
            // SAFETY: the memory is alive, and the callback fits the host.
            unsafe {
                let init = ("IDASensInit", |count, method, s, sp| {
                    ffi::IDASensInit(memory, count, method, Some(all_residuals::<S>), s, sp)
                });
                ida.set_up_sensitivities(sensitivities, &options.tolerances, &access, init)?;
            }
        }
        Ok(ida)
    }
}

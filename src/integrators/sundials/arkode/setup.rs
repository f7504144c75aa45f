//! Building an ARKODE solver.
//!
//! After a failure ARKODE returns the time of a stage with the state at the start of the step. The time that
//! belongs to that state is therefore recorded by the function of `ARKStepSetStabilityFn`, which is called
//! once a step. A function after each step (`ARKStepSetPostprocessStepFn`) would tell it, too, but makes
//! ARKODE evaluate the right-hand side at the ends of steps, which costs accuracy in stiff systems; it serves
//! fixed steps alone.

use std::{ffi::c_void, ptr};

use super::{mass, options::ArkodeOptions};
use crate::integrators::{
    common::{Error, Integrator, check_start, check_whole},
    ode::{Borrowed, MassKind, Ode},
    sundials::{
        ffi,
        functions::{Functions, named},
        linear_solver::LinearSolver,
        nonlinear::NonlinearSolver,
        ode_callbacks::{explicit_rhs, jacobian, newton_rhs, note_step_end, note_time, rhs, roots},
        ode_krylov::{
            jacobian_times, newton_setup_with_mass, precondition_setup, precondition_solve,
        },
        session::{InitialState, Session},
        solver::{Kind, Owner, Solver},
    },
};

/// Integrates y' = f(t, y), or M y' = f(t, y) with a regular [mass matrix](Ode::mass_kind), by a Runge-Kutta
/// method with variable step size.
///
/// Diagonally implicit methods are for stiff systems, among them lightly damped oscillations, which multistep
/// methods of high order cannot follow; explicit ones for systems that are not stiff. (`ARKStep`)
///
/// [`ButcherTable::imex`](super::ButcherTable::imex) makes it a pair of both, for a right-hand side that is
/// [split](Ode::is_split).
///
/// After a recoverable failure of the right-hand side it retries with a smaller step; with a fixed step, explicit methods and explicit
/// parts stop.
///
/// Interpolation between the steps is by Hermite polynomials, of a degree one less than the order of the
/// method, at most 3 for implicit and 5 for explicit methods. Degrees 4 and 5 evaluate the right-hand side.
///
/// Made by `Arkode::new`, used through the methods of [`Integrator`](crate::integrators::common::Integrator).
///
/// User guide: chapter "Using ARKODE", ARKStep.
pub type Arkode<S> = Solver<ArkodeKind, S>;

/// Marks a [`Solver`] as one of ARKODE.
#[derive(Debug)]
pub struct ArkodeKind;

impl Kind for ArkodeKind {
    type System = dyn Ode;
    type Session = dyn Integrator<System = Borrowed<'static, dyn Ode>>;

    const NAME: &'static str = "ARKODE";
}

impl<S: Ode> Session<ArkodeKind, S> {
    /// The functions for implicit methods.
    const IMPLICIT: &'static Functions = &Functions {
        integrator: ArkodeKind::NAME,
        free: ffi::ARKStepFree,
        solve: ("ARKStepEvolve", |memory, target, t, y, _, task| {
            // SAFETY: whoever calls through the table vouches for the arguments.
            unsafe { ffi::ARKStepEvolve(memory, target, y, t, task) }
        }),
        reinit: ("ARKStepReInit", |memory, t, y, _| {
            // SAFETY: as above; the callback fits the host of the session.
            unsafe { ffi::ARKStepReInit(memory, None, Some(rhs::<S>), t, y) }
        }),
        reset: Some(named!(ARKStepReset)),
        reinit_forgets_stop_time: true,
        refusals: &[ffi::ARK_ILL_INPUT, ffi::ARK_TOO_CLOSE, ffi::ARK_BAD_T],
        mass_failures: &[ffi::ARK_MASSSETUP_FAIL, ffi::ARK_MASSSOLVE_FAIL],
        set_error_handler: named!(ARKStepSetErrHandlerFn),
        set_user_data: named!(ARKStepSetUserData),
        scalar_tolerances: named!(ARKStepSStolerances),
        vector_tolerances: named!(ARKStepSVtolerances),
        set_linear_solver: named!(ARKStepSetLinearSolver),
        allow_inactive_roots: named!(ARKStepSetNoInactiveRootWarn),
        set_max_steps: named!(ARKStepSetMaxNumSteps),
        set_initial_step: named!(ARKStepSetInitStep),
        set_max_step: named!(ARKStepSetMaxStep),
        set_min_step: named!(ARKStepSetMinStep),
        set_max_error_test_failures: Some(named!(ARKStepSetMaxErrTestFails)),
        set_max_order: None,
        set_convergence_coefficient: named!(ARKStepSetNonlinConvCoef),
        set_tolerance_factor: named!(ARKStepSetEpsLin),
        set_stop_time: named!(ARKStepSetStopTime),
        set_constraints: named!(ARKStepSetConstraints),
        get_root_info: named!(ARKStepGetRootInfo),
        get_dky: named!(ARKStepGetDky),
        bad_time: ffi::ARK_BAD_T,
        bad_derivative: ffi::ARK_BAD_K,
        get_step_parameter: ffi::ARKStepGetCurrentGamma,
        get_current_step: ffi::ARKStepGetCurrentStep,
        get_error_weights: named!(ARKStepGetErrWeights),
        get_linear_flag: ffi::ARKStepGetLastLinFlag,
        get_integrator_stats,
        get_nonlinear_stats: ffi::ARKStepGetNonlinSolvStats,
        get_step_failures: ffi::ARKStepGetNumStepSolveFails,
        get_jacobian_evaluations: ffi::ARKStepGetNumJacEvals,
        get_quotient_evaluations: ffi::ARKStepGetNumLinRhsEvals,
        get_linear_iterations: ffi::ARKStepGetNumLinIters,
        get_linear_failures: ffi::ARKStepGetNumLinConvFails,
        get_preconditioner_setups: ffi::ARKStepGetNumPrecEvals,
        get_preconditioner_solves: ffi::ARKStepGetNumPrecSolves,
        get_root_evaluations: ffi::ARKStepGetNumGEvals,
        get_explicit_evaluations: None,
        get_stability_reductions: None,
        quadratures: None,
        sensitivities: None,
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

    /// The functions for ImEx pairs.
    const IMEX: &'static Functions = &Functions {
        reinit: ("ARKStepReInit", |memory, t, y, _| {
            // SAFETY: as above.
            unsafe { ffi::ARKStepReInit(memory, Some(explicit_rhs::<S>), Some(rhs::<S>), t, y) }
        }),
        get_explicit_evaluations: Some(get_explicit_evaluations),
        ..*Self::IMPLICIT
    };
}

/// Evaluations of the explicit part.
unsafe extern "C" fn get_explicit_evaluations(memory: *mut c_void, explicit: *mut i64) -> i32 {
    let mut implicit = 0;
    // SAFETY: whoever calls through the table vouches for memory and place.
    unsafe { ffi::ARKStepGetNumRhsEvals(memory, explicit, &raw mut implicit) }
}

/// `CVodeGetIntegratorStats` for ARKODE: evaluations are the sum of explicit and implicit ones, and both
/// orders are that of the table.
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

impl<S: Ode> Arkode<S> {
    /// A solver for `system`, starting at time `t0` from `y0`.
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that cannot be used.
    pub fn new(system: S, t0: f64, y0: &[f64], options: &ArkodeOptions) -> Result<Self, Error> {
        let mut system = Owner::new(system);
        // SAFETY: the solver drops the session first, and accesses the system through it.
        unsafe {
            let session = start(system.lend_ode(), t0, y0, options)?;
            Ok(Self::new_within(session, system))
        }
    }
}

/// A session of [`Arkode`].
fn start(
    system: Borrowed<'static, dyn Ode>,
    t0: f64,
    y0: &[f64],
    options: &ArkodeOptions,
) -> Result<Box<<ArkodeKind as Kind>::Session>, Error> {
    Ok(Box::new(Session::of_arkode(system, t0, y0, options)?))
}

impl<S: Ode> Session<ArkodeKind, S> {
    fn of_arkode(system: S, t0: f64, y0: &[f64], options: &ArkodeOptions) -> Result<Self, Error> {
        check_start(t0, y0)?;
        options.check(y0)?;
        if !options.table.is_imex() {
            check_whole(&system)?;
        } else if !system.is_split() {
            let help = "a pair of tables is for a right-hand side of two parts: see `is_split` and `split`";
            return Err(Error::input("table", options.table, help));
        }

        let start = InitialState { t: t0, y: y0, yp: None, root_count: system.root_count() };
        let (is_implicit, is_imex) = (options.table.is_implicit(), options.table.is_imex());
        let (functions, explicit, implicit) = match (is_imex, is_implicit) {
            (true, _) => (Self::IMEX, Some(explicit_rhs::<S> as _), Some(rhs::<S> as _)),
            (false, true) => (Self::IMPLICIT, None, Some(rhs::<S> as _)),
            (false, false) => (Self::EXPLICIT, Some(rhs::<S> as _), None),
        };
        let mass_kind = system.mass_kind();
        let solver = match mass_kind {
            MassKind::Identity => {
                options.nonlinear.linear_solver().filter(|_| is_implicit).cloned()
            }
            _ => Some(mass::check(options.nonlinear.linear_solver())?),
        };
        let mass_form = solver.clone().filter(|_| mass_kind != MassKind::Identity);
        // SAFETY: `create` gets a live context and a vector of its own, the table is that of
        // ARKODE, and the callbacks fit the host that is registered as their data.
        let mut arkode = unsafe {
            let create = |y, context| ffi::ARKStepCreate(explicit, implicit, t0, y, context);
            Self::create(functions, ("ARKStepCreate", create), ArkodeKind, system, &start, solver)?
        };
        arkode.host.get_mut().step_end = Some(t0);
        arkode.configure(&options.tolerances, &options.steps, &options.limits)?;
        let (implicit_id, explicit_id) = options.table.ids();
        let degree = options.interpolant_degree();
        arkode.interpolant_degree = Some(degree);
        // SAFETY: the callback fits the host; the memory is alive and reads the names, C strings, once;
        // the other values are plain numbers.
        unsafe {
            arkode.set_root_functions(named!(ARKStepRootInit), Some(roots::<S>))?;
            let (implicit, explicit) = (implicit_id.as_ptr(), explicit_id.as_ptr());
            let (memory, data) = (arkode.memory.raw, arkode.host.as_ptr());
            arkode.host.call(named!(ARKStepSetTableName), |set| set(memory, implicit, explicit))?;
            arkode.set(named!(ARKStepSetInterpolantDegree as _), degree as i32)?;
            // Post-processing of steps makes ARKODE evaluate the right-hand side at their ends; it is used
            // for fixed steps only.
            if let Some(h) = options.fixed_step {
                arkode.has_fixed_step = true;
                arkode.set(named!(ARKStepSetFixedStep), h)?;
                arkode
                    .set(named!(ARKStepSetPostprocessStepFn as _), Some(note_step_end::<S> as _))?;
            } else {
                let (set, note) = (named!(ARKStepSetStabilityFn), Some(note_time::<S> as _));
                arkode.host.call(set, |set| set(memory, note, data))?;
            }
        }
        if is_implicit {
            solve_stages(&mut arkode, options)?;
        }
        if let Some(form) = mass_form {
            mass::attach(&mut arkode, &form, mass_kind)?;
        }
        Ok(arkode)
    }
}

/// Sets how the equations of implicit stages are solved.
fn solve_stages<S: Ode>(
    arkode: &mut Session<ArkodeKind, S>,
    options: &ArkodeOptions,
) -> Result<(), Error> {
    // SAFETY: the values are plain numbers.
    unsafe {
        arkode.set(named!(ARKStepSetPredictorMethod as _), options.predictor as i32)?;
        arkode.set(named!(ARKStepSetMaxNonlinIters as _), options.max_iterations as i32)?;
        // The slope of a stage follows from its equation: this spares an evaluation, which would
        // also stop the integration if it failed, and magnify errors of stiff components.
        arkode.set(named!(ARKStepSetDeduceImplicitRhs as _), 1)?;
        if options.linear {
            arkode.set(named!(ARKStepSetLinear as _), 0)?;
        }
        if let Some(steps) = options.nonlinear.max_steps_between_setups {
            arkode.set(named!(ARKStepSetLSetupFrequency as _), steps as i32)?;
        }
    }
    // SAFETY: the callbacks fit the registered host, and the solvers live as long as the memory.
    unsafe {
        match &options.nonlinear.solver {
            NonlinearSolver::Newton(solver) => {
                let for_jacobian = (&options.tolerances, &options.limits);
                arkode.set_newton(solver, S::newton_solve, for_jacobian)?;
                if matches!(solver, LinearSolver::Custom) {
                    arkode
                        .set(named!(ARKStepSetLinSysFn), Some(newton_setup_with_mass::<S> as _))?;
                    arkode.set(named!(ARKStepSetNlsRhsFn), Some(newton_rhs::<S> as _))?;
                } else if let LinearSolver::Krylov(krylov) = solver {
                    arkode.set_krylov(
                        krylov,
                        (named!(ARKStepSetJacTimes), Some(jacobian_times::<S>)),
                        (
                            named!(ARKStepSetPreconditioner),
                            Some(precondition_setup::<S>),
                            Some(precondition_solve::<S>),
                        ),
                    )?;
                } else {
                    arkode.set(named!(ARKStepSetJacFn), Some(jacobian::<S> as _))?;
                }
                if let Some(steps) = options.max_steps_between_jacobians {
                    arkode.set(named!(ARKStepSetJacEvalFrequency as _), i64::from(steps))?;
                }
            }
            NonlinearSolver::FixedPoint { acceleration } => {
                arkode.set_fixed_point(named!(ARKStepSetNonlinearSolver as _), *acceleration)?;
            }
        }
    }
    Ok(())
}

//! Building a CVODE solver, and reading its counters.

use std::ffi::c_void;

use super::{
    Cvode, FixedPoint, Memory,
    options::{CvodeOptions, Multistep, NonlinearSolver},
};
use crate::{
    ode::Ode,
    sundials::{
        context::Context,
        error::Error,
        ffi,
        host::{Host, HostBox, keep_message},
        linear::{Linear, LinearSolver},
        ode_callbacks::{jacobian, newton_setup, newton_solve, rhs, roots},
        options::{AbsoluteTolerance, StopTime, check_start},
        statistics::Statistics,
        vector::Vector,
    },
};

pub(super) fn new<S: Ode>(
    system: S,
    t0: f64,
    y0: &[f64],
    options: &CvodeOptions,
) -> Result<Cvode<S>, Error> {
    check_start(t0, y0)?;
    options.check(y0)?;

    let context = Context::new()?;
    let y = Vector::from_slice(y0, &context)?;
    let scratch = Vector::from_slice(y0, &context)?;
    let root_count = system.root_count();
    let solver = options.linear_solver().cloned();
    let mut host = HostBox::new(Host::new(system, y0.len(), root_count, solver));
    let data = host.as_ptr();

    // Locals are dropped in reverse order, so on an error below the memory goes first.
    let (mut linear, mut fixed_point) = (None, None);
    match &options.nonlinear_solver {
        NonlinearSolver::Newton(solver) => {
            // SAFETY: the content of the solver is the host that `newton_solve` expects, and the
            // host outlives the solver.
            let made = unsafe { Linear::new(solver, &y, &context, newton_solve::<S>, data)? };
            linear = Some(made);
        }
        NonlinearSolver::FixedPoint { acceleration } => {
            fixed_point = Some(FixedPoint::new(&y, *acceleration, &context)?);
        }
    }
    // SAFETY: the context is alive.
    let memory = Memory(unsafe {
        ffi::CVodeCreate(
            match options.method {
                Multistep::Bdf => ffi::CV_BDF,
                Multistep::Adams => ffi::CV_ADAMS,
            },
            context.raw(),
        )
    });
    if memory.0.is_null() {
        return Err(Error::out_of_memory("CVodeCreate"));
    }
    let cv = memory.0;
    // SAFETY: the memory is alive, vectors have the right length, and the callbacks fit the host
    // that is registered as their data.
    unsafe {
        let code = ffi::CVodeSetErrHandlerFn(cv, Some(keep_message::<S>), data);
        host.accept("CVodeSetErrHandlerFn", code)?;
        let code = ffi::CVodeInit(cv, Some(rhs::<S>), t0, y.raw());
        host.accept("CVodeInit", code)?;
        let code = ffi::CVodeSetUserData(cv, data);
        host.accept("CVodeSetUserData", code)?;
        let rtol = options.tolerances.rtol;
        let code = match &options.tolerances.atol {
            AbsoluteTolerance::Scalar(atol) => ffi::CVodeSStolerances(cv, rtol, *atol),
            AbsoluteTolerance::Vector(atol) => {
                // CVODE keeps a copy.
                let atol = Vector::from_slice(atol, &context)?;
                ffi::CVodeSVtolerances(cv, rtol, atol.raw())
            }
        };
        host.accept("CVodeSetTolerances", code)?;
        if root_count > 0 {
            let code = ffi::CVodeRootInit(cv, root_count as i32, Some(roots::<S>));
            host.accept("CVodeRootInit", code)?;
            let code = ffi::CVodeSetNoInactiveRootWarn(cv);
            host.accept("CVodeSetNoInactiveRootWarn", code)?;
        }
    }
    set_step_options(&mut host, cv, options)?;

    if let (Some(linear), Some(solver)) = (&linear, options.linear_solver()) {
        attach(&mut host, cv, solver, linear)?;
    }
    if let Some(fixed_point) = &fixed_point {
        // SAFETY: memory and solver are alive, and the memory is dropped first.
        let code = unsafe { ffi::CVodeSetNonlinearSolver(cv, fixed_point.0) };
        host.accept("CVodeSetNonlinearSolver", code)?;
    }
    Ok(Cvode {
        memory,
        _fixed_point: fixed_point,
        _linear: linear,
        y,
        scratch,
        host,
        _context: context,
        t: t0,
        stop_time: StopTime::default(),
        roots_found: vec![0; root_count],
    })
}

fn set_step_options<S>(
    host: &mut HostBox<S>,
    cv: *mut c_void,
    options: &CvodeOptions,
) -> Result<(), Error> {
    let steps = &options.steps;
    // SAFETY: the memory is alive.
    unsafe {
        let code = ffi::CVodeSetMaxNumSteps(cv, i64::from(steps.max_steps));
        host.accept("CVodeSetMaxNumSteps", code)?;
        if let Some(h) = steps.initial_step {
            host.accept("CVodeSetInitStep", ffi::CVodeSetInitStep(cv, h))?;
        }
        if let Some(h) = steps.max_step {
            host.accept("CVodeSetMaxStep", ffi::CVodeSetMaxStep(cv, h))?;
        }
        if let Some(h) = steps.min_step {
            host.accept("CVodeSetMinStep", ffi::CVodeSetMinStep(cv, h))?;
        }
        if let Some(order) = steps.max_order {
            host.accept("CVodeSetMaxOrd", ffi::CVodeSetMaxOrd(cv, order as i32))?;
        }
        if let Some(coefficient) = steps.convergence_coefficient {
            let code = ffi::CVodeSetNonlinConvCoef(cv, coefficient);
            host.accept("CVodeSetNonlinConvCoef", code)?;
        }
        if options.stability_limit_detection {
            host.accept("CVodeSetStabLimDet", ffi::CVodeSetStabLimDet(cv, 1))?;
        }
        if let Some(steps) = options.max_steps_between_setups {
            let code = ffi::CVodeSetLSetupFrequency(cv, i64::from(steps));
            host.accept("CVodeSetLSetupFrequency", code)?;
        }
    }
    Ok(())
}

/// Registers the linear solver and the callback that fills its matrix.
fn attach<S: Ode>(
    host: &mut HostBox<S>,
    cv: *mut c_void,
    solver: &LinearSolver,
    linear: &Linear,
) -> Result<(), Error> {
    // SAFETY: memory, solver and matrix are alive, and the memory is dropped first.
    let code = unsafe { ffi::CVodeSetLinearSolver(cv, linear.solver(), linear.matrix()) };
    host.accept("CVodeSetLinearSolver", code)?;
    if matches!(solver, LinearSolver::Custom) {
        // SAFETY: the callback fits the registered host.
        let code = unsafe { ffi::CVodeSetLinSysFn(cv, Some(newton_setup::<S>)) };
        host.accept("CVodeSetLinSysFn", code)?;
    } else if solver.has_jacobian_callback() {
        // SAFETY: the callback fits the registered host.
        let code = unsafe { ffi::CVodeSetJacFn(cv, Some(jacobian::<S>)) };
        host.accept("CVodeSetJacFn", code)?;
    }
    Ok(())
}

/// Whether the last factorization found a singular matrix.
pub(super) fn is_singular(cv: *mut c_void) -> bool {
    let mut flag = 0;
    // SAFETY: the memory is alive, the result has a place.
    let code = unsafe { ffi::CVodeGetLastLinFlag(cv, &raw mut flag) };
    let singular = [ffi::SUNLS_LUFACT_FAIL, ffi::SUNLS_PACKAGE_FAIL_REC];
    code == 0 && singular.iter().any(|&code| i64::from(code) == flag)
}

pub(super) fn statistics(cv: *mut c_void, t: f64) -> Statistics {
    let mut s = Statistics::default();
    let [mut steps, mut evaluations, mut setups, mut error_fails] = [0; 4];
    let [mut iterations, mut nonlinear_fails, mut step_fails] = [0; 3];
    let [mut jacobians, mut quotients, mut roots, mut reductions] = [0; 4];
    let [mut last_order, mut current_order] = [0; 2];
    // SAFETY: the memory is alive, every result has a place. Functions which do not apply, say to
    // a solver without Jacobian, leave theirs untouched.
    unsafe {
        ffi::CVodeGetIntegratorStats(
            cv,
            &raw mut steps,
            &raw mut evaluations,
            &raw mut setups,
            &raw mut error_fails,
            &raw mut last_order,
            &raw mut current_order,
            &raw mut s.initial_step,
            &raw mut s.last_step,
            &raw mut s.current_step,
            &raw mut s.current_time,
        );
        ffi::CVodeGetNonlinSolvStats(cv, &raw mut iterations, &raw mut nonlinear_fails);
        ffi::CVodeGetNumStepSolveFails(cv, &raw mut step_fails);
        ffi::CVodeGetNumJacEvals(cv, &raw mut jacobians);
        ffi::CVodeGetNumLinRhsEvals(cv, &raw mut quotients);
        ffi::CVodeGetNumGEvals(cv, &raw mut roots);
        ffi::CVodeGetNumStabLimOrderReds(cv, &raw mut reductions);
        ffi::CVodeGetTolScaleFactor(cv, &raw mut s.tolerance_scale);
    }
    if steps == 0 {
        s.current_time = t;
    }
    s.steps = steps as u64;
    s.evaluations = evaluations as u64;
    s.difference_quotient_evaluations = quotients as u64;
    s.jacobian_evaluations = jacobians as u64;
    s.linear_setups = setups as u64;
    s.nonlinear_iterations = iterations as u64;
    s.nonlinear_failures = nonlinear_fails as u64;
    s.step_failures = step_fails as u64;
    s.error_test_failures = error_fails as u64;
    s.root_evaluations = roots as u64;
    s.stability_reductions = reductions as u64;
    s.last_order = last_order as u32;
    s.current_order = current_order as u32;
    s
}

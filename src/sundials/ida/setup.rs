//! Building an IDA solver, and reading its counters.

use std::ffi::c_void;

use super::{Ida, Memory, options::IdaOptions};
use crate::{
    ode::Dae,
    sundials::{
        context::Context,
        dae_callbacks::{jacobian, newton_solve, residual, roots},
        error::Error,
        ffi,
        host::{Host, HostBox, keep_message},
        linear::Linear,
        options::{AbsoluteTolerance, StopTime, check_finite, check_length, check_start},
        statistics::Statistics,
        vector::Vector,
    },
};

pub(super) fn new<S: Dae>(
    system: S,
    t0: f64,
    y0: &[f64],
    yp0: &[f64],
    options: &IdaOptions,
) -> Result<Ida<S>, Error> {
    check_start(t0, y0)?;
    check_length("length of yp0", yp0.len(), y0.len())?;
    check_finite("yp0", yp0)?;
    options.check(y0)?;

    let context = Context::new()?;
    let y = Vector::from_slice(y0, &context)?;
    let yp = Vector::from_slice(yp0, &context)?;
    let scratch = Vector::from_slice(y0, &context)?;
    let root_count = system.root_count();
    let solver = Some(options.linear_solver.clone());
    let mut host = HostBox::new(Host::new(system, y0.len(), root_count, solver));
    let data = host.as_ptr();

    // Locals are dropped in reverse order, so on an error below the memory goes first.
    // SAFETY: the content of a custom solver is the host that `newton_solve` expects, and the
    // host outlives the solver.
    let linear =
        unsafe { Linear::new(&options.linear_solver, &y, &context, newton_solve::<S>, data)? };
    // SAFETY: the context is alive.
    let memory = Memory(unsafe { ffi::IDACreate(context.raw()) });
    if memory.0.is_null() {
        return Err(Error::out_of_memory("IDACreate"));
    }
    let ida = memory.0;
    // SAFETY: the memory is alive, vectors have the right length, and the callbacks fit the host
    // that is registered as their data.
    unsafe {
        let code = ffi::IDASetErrHandlerFn(ida, Some(keep_message::<S>), data);
        host.accept("IDASetErrHandlerFn", code)?;
        let code = ffi::IDAInit(ida, Some(residual::<S>), t0, y.raw(), yp.raw());
        host.accept("IDAInit", code)?;
        let code = ffi::IDASetUserData(ida, data);
        host.accept("IDASetUserData", code)?;
        let rtol = options.tolerances.rtol;
        let code = match &options.tolerances.atol {
            AbsoluteTolerance::Scalar(atol) => ffi::IDASStolerances(ida, rtol, *atol),
            AbsoluteTolerance::Vector(atol) => {
                // IDA keeps a copy.
                let atol = Vector::from_slice(atol, &context)?;
                ffi::IDASVtolerances(ida, rtol, atol.raw())
            }
        };
        host.accept("IDASetTolerances", code)?;
        if root_count > 0 {
            let code = ffi::IDARootInit(ida, root_count as i32, Some(roots::<S>));
            host.accept("IDARootInit", code)?;
            let code = ffi::IDASetNoInactiveRootWarn(ida);
            host.accept("IDASetNoInactiveRootWarn", code)?;
        }
    }
    set_step_options(&mut host, ida, options)?;

    // SAFETY: memory, solver and matrix are alive, and the memory is dropped first; the callback
    // fits the registered host.
    unsafe {
        let code = ffi::IDASetLinearSolver(ida, linear.solver(), linear.matrix());
        host.accept("IDASetLinearSolver", code)?;
        if options.linear_solver.has_jacobian_callback() {
            let code = ffi::IDASetJacFn(ida, Some(jacobian::<S>));
            host.accept("IDASetJacFn", code)?;
        }
    }
    if let Some(differential) = &options.differential {
        let id: Vec<f64> = differential.iter().map(|&d| f64::from(u8::from(d))).collect();
        let id = Vector::from_slice(&id, &context)?;
        // SAFETY: the memory is alive, and IDA keeps a copy of the vector.
        unsafe {
            host.accept("IDASetId", ffi::IDASetId(ida, id.raw()))?;
            let suppress = i32::from(options.suppress_algebraic);
            host.accept("IDASetSuppressAlg", ffi::IDASetSuppressAlg(ida, suppress))?;
        }
    }
    Ok(Ida {
        memory,
        _linear: linear,
        y,
        yp,
        scratch,
        host,
        _context: context,
        t: t0,
        knows_algebraic: options.differential.is_some(),
        stop_time: StopTime::default(),
        roots_found: vec![0; root_count],
    })
}

fn set_step_options<S>(
    host: &mut HostBox<S>,
    ida: *mut c_void,
    options: &IdaOptions,
) -> Result<(), Error> {
    let steps = &options.steps;
    // SAFETY: the memory is alive.
    unsafe {
        let code = ffi::IDASetMaxNumSteps(ida, i64::from(steps.max_steps));
        host.accept("IDASetMaxNumSteps", code)?;
        if let Some(h) = steps.initial_step {
            host.accept("IDASetInitStep", ffi::IDASetInitStep(ida, h))?;
        }
        if let Some(h) = steps.max_step {
            host.accept("IDASetMaxStep", ffi::IDASetMaxStep(ida, h))?;
        }
        if let Some(h) = steps.min_step {
            host.accept("IDASetMinStep", ffi::IDASetMinStep(ida, h))?;
        }
        if let Some(order) = steps.max_order {
            host.accept("IDASetMaxOrd", ffi::IDASetMaxOrd(ida, order as i32))?;
        }
        if let Some(coefficient) = steps.convergence_coefficient {
            let code = ffi::IDASetNonlinConvCoef(ida, coefficient);
            host.accept("IDASetNonlinConvCoef", code)?;
        }
    }
    Ok(())
}

/// Whether the last factorization found a singular matrix.
pub(super) fn is_singular(ida: *mut c_void) -> bool {
    let mut flag = 0;
    // SAFETY: the memory is alive, the result has a place.
    let code = unsafe { ffi::IDAGetLastLinFlag(ida, &raw mut flag) };
    let singular = [ffi::SUNLS_LUFACT_FAIL, ffi::SUNLS_PACKAGE_FAIL_REC];
    code == 0 && singular.iter().any(|&code| i64::from(code) == flag)
}

pub(super) fn statistics(ida: *mut c_void, t: f64) -> Statistics {
    let mut s = Statistics::default();
    let [mut steps, mut evaluations, mut setups, mut error_fails] = [0; 4];
    let [mut iterations, mut nonlinear_fails, mut step_fails] = [0; 3];
    let [mut jacobians, mut quotients, mut roots] = [0; 3];
    let [mut last_order, mut current_order] = [0; 2];
    // SAFETY: the memory is alive, every result has a place. Functions which do not apply, say to
    // a solver without Jacobian, leave theirs untouched.
    unsafe {
        ffi::IDAGetIntegratorStats(
            ida,
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
        ffi::IDAGetNonlinSolvStats(ida, &raw mut iterations, &raw mut nonlinear_fails);
        ffi::IDAGetNumStepSolveFails(ida, &raw mut step_fails);
        ffi::IDAGetNumJacEvals(ida, &raw mut jacobians);
        ffi::IDAGetNumLinResEvals(ida, &raw mut quotients);
        ffi::IDAGetNumGEvals(ida, &raw mut roots);
        ffi::IDAGetTolScaleFactor(ida, &raw mut s.tolerance_scale);
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
    s.last_order = last_order as u32;
    s.current_order = current_order as u32;
    s
}

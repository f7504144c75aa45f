//! A running integrator: what CVODE, IDA and ARKODE have in common behind their public faces.

use std::{ffi::c_void, ptr};

use super::{
    context::Context,
    error::{Cause, Error, IntegrationError},
    ffi,
    functions::{Functions, Set},
    host::{Host, HostBox, Newton, NewtonSolve, keep_message},
    linear::{Linear, LinearSolver},
    nonlinear::FixedPoint,
    options::{
        AbsoluteTolerance, Reached, StepOptions, StopTime, Tolerances, check_finite, check_length,
        check_root_count, check_time,
    },
    statistics::Statistics,
    vector::Vector,
};

/// Owns an integrator and everything it uses.
pub(super) struct Session<S> {
    // Fields are dropped in this order: first what uses the others.
    pub(super) memory: Memory,
    fixed_point: Option<FixedPoint>,
    linear: Option<Linear>,
    pub(super) y: Vector,
    /// The time derivative of `y`, of a DAE only.
    pub(super) yp: Option<Vector>,
    scratch: Vector,
    pub(super) host: HostBox<S>,
    pub(super) context: Context,
    pub(super) t: f64,
    stop_time: StopTime,
    /// Whether there is a step to interpolate in. C does not ask, and gives NaN or what the run
    /// before has left.
    has_step: bool,
    /// Whether the last call failed in an integrator that gives the time of a stage then.
    failed_within: bool,
    pub(super) roots_found: Vec<i32>,
}

// SAFETY: the raw pointers lead to objects that this session alone owns, among them its
// SUNContext; SUNDIALS keeps no thread-local state. The system has to be `Send` itself. Troubles
// that wait in the host are `Send`.
unsafe impl<S: Send> Send for Session<S> {}

/// Owns the memory block of an integrator.
pub(super) struct Memory {
    pub(super) raw: *mut c_void,
    functions: &'static Functions,
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: made by the integrator of this table and freed once, before everything it
        // refers to.
        unsafe { (self.functions.free)(&raw mut self.raw) };
    }
}

/// Where a session starts.
pub(super) struct Start<'a> {
    pub(super) t: f64,
    pub(super) y: &'a [f64],
    /// Of a DAE only.
    pub(super) yp: Option<&'a [f64]>,
    pub(super) root_count: usize,
}

impl<S> Session<S> {
    /// Makes an integrator by the C function `create`, which gets a vector with the start; it is
    /// not yet initialised.
    ///
    /// # Safety
    /// `create` makes the memory block of the integrator that `functions` belong to, or null.
    pub(super) unsafe fn new(
        functions: &'static Functions,
        (function, create): (
            &'static str,
            impl FnOnce(ffi::N_Vector, ffi::SUNContext) -> *mut c_void,
        ),
        system: S,
        start: &Start<'_>,
        solver: Option<LinearSolver>,
    ) -> Result<Self, Error> {
        let context = Context::new()?;
        let y = Vector::from_slice(start.y, &context)?;
        let yp = start.yp.map(|yp| Vector::from_slice(yp, &context)).transpose()?;
        let scratch = Vector::from_slice(start.y, &context)?;
        check_root_count(start.root_count)?;
        let (n, root_count) = (start.y.len(), start.root_count);
        let mut host = HostBox::new(Host::new(system, n, root_count, solver));
        // Locals are dropped in reverse order, so on an error below the memory goes first.
        let memory = Memory { raw: create(y.raw(), context.raw()), functions };
        if memory.raw.is_null() {
            return Err(Error::out_of_memory(function));
        }
        let (function, set) = functions.set_error_handler;
        // SAFETY: the memory is alive, and the handler fits the host registered as its data.
        let code = unsafe { set(memory.raw, Some(keep_message::<S>), host.as_ptr()) };
        host.accept(function, code)?;
        Ok(Self {
            memory,
            fixed_point: None,
            linear: None,
            y,
            yp,
            scratch,
            host,
            context,
            t: start.t,
            stop_time: StopTime::default(),
            has_step: false,
            failed_within: false,
            roots_found: vec![0; root_count],
        })
    }

    /// The C vector of the time derivative; null for an ODE.
    pub(super) fn raw_yp(&self) -> ffi::N_Vector {
        self.yp.as_ref().map_or(ptr::null_mut(), Vector::raw)
    }

    /// Calls a function that sets one option.
    ///
    /// # Safety
    /// The function belongs to this integrator and may be called with this value.
    pub(super) unsafe fn set<T>(
        &mut self,
        (name, function): Set<T>,
        value: T,
    ) -> Result<(), Error> {
        // SAFETY: the memory is alive; the caller vouches for the value.
        let code = unsafe { function(self.memory.raw, value) };
        self.host.accept(name, code)
    }

    /// Registers the host, after the integrator was initialised with the callbacks for it, and
    /// sets tolerances and the options of the step size control.
    pub(super) fn configure(
        &mut self,
        tolerances: &Tolerances,
        steps: &StepOptions,
    ) -> Result<(), Error> {
        let functions = self.memory.functions;
        let (memory, rtol) = (self.memory.raw, tolerances.rtol);
        let (name, code) = match &tolerances.atol {
            AbsoluteTolerance::Scalar(atol) => {
                let (name, set) = functions.scalar_tolerances;
                // SAFETY: the memory is alive.
                (name, unsafe { set(memory, rtol, *atol) })
            }
            AbsoluteTolerance::Vector(atol) => {
                let atol = Vector::from_slice(atol, &self.context)?;
                let (name, set) = functions.vector_tolerances;
                // SAFETY: the memory is alive; it keeps a copy of the vector, whose length was
                // checked.
                (name, unsafe { set(memory, rtol, atol.raw()) })
            }
        };
        self.host.accept(name, code)?;
        // SAFETY: the host outlives the memory; the other values are plain numbers.
        unsafe {
            self.set(functions.set_user_data, self.host.as_ptr())?;
            self.set(functions.set_max_steps, i64::from(steps.max_steps))?;
            for (function, value) in [
                (functions.set_initial_step, steps.initial_step),
                (functions.set_max_step, steps.max_step),
                (functions.set_min_step, steps.min_step),
                (functions.set_convergence_coefficient, steps.convergence_coefficient),
            ] {
                if let Some(value) = value {
                    self.set(function, value)?;
                }
            }
            if let (Some(set), Some(order)) = (functions.set_max_order, steps.max_order) {
                self.set(set, order as i32)?;
            }
        }
        Ok(())
    }

    /// Registers the root functions by `init`, if there are any.
    ///
    /// # Safety
    /// `init` belongs to this integrator, and `callback` fits the host.
    pub(super) unsafe fn watch_roots<F>(
        &mut self,
        (name, init): (&'static str, unsafe extern "C" fn(*mut c_void, i32, F) -> i32),
        callback: F,
    ) -> Result<(), Error> {
        let count = self.roots_found.len() as i32;
        if count == 0 {
            return Ok(());
        }
        // SAFETY: the memory is alive; the caller vouches for the callback.
        let code = unsafe { init(self.memory.raw, count, callback) };
        self.host.accept(name, code)?;
        let (name, allow) = self.memory.functions.allow_inactive_roots;
        // SAFETY: the memory is alive.
        let code = unsafe { allow(self.memory.raw) };
        self.host.accept(name, code)
    }

    /// Gives the Newton iteration its linear solver.
    pub(super) fn use_newton(
        &mut self,
        solver: &LinearSolver,
        solve: NewtonSolve<S>,
    ) -> Result<(), Error> {
        let Memory { raw: memory, functions } = self.memory;
        let step_parameter = functions.get_step_parameter;
        self.host.get_mut().newton = Some(Newton { solve, step_parameter, memory });
        let data = self.host.as_ptr();
        // SAFETY: the data is the host, which outlives the solver.
        let linear = unsafe { Linear::new::<S>(solver, &self.y, &self.context, data)? };
        let linear = self.linear.insert(linear);
        let (name, set) = self.memory.functions.set_linear_solver;
        // SAFETY: memory, solver and matrix are alive, and the memory is dropped first.
        let code = unsafe { set(self.memory.raw, linear.solver(), linear.matrix()) };
        self.host.accept(name, code)
    }

    /// Replaces the Newton iteration by a fixed-point iteration, by the function `set`.
    ///
    /// # Safety
    /// The function belongs to this integrator and attaches a nonlinear solver.
    pub(super) unsafe fn use_fixed_point(
        &mut self,
        set: Set<ffi::SUNNonlinearSolver>,
        acceleration: u32,
    ) -> Result<(), Error> {
        let made = FixedPoint::new(&self.y, acceleration, &self.context)?;
        let solver = self.fixed_point.insert(made).raw();
        // SAFETY: the caller vouches for the function; the solver is dropped after the memory.
        unsafe { self.set(set, solver) }
    }

    /// Starts again; `yp` is of a DAE only.
    pub(super) fn reinit(&mut self, t: f64, y: &[f64], yp: Option<&[f64]>) -> Result<(), Error> {
        check_length("length of y", y.len(), self.y.as_slice().len())?;
        check_time("t", t)?;
        if let Some(yp) = yp {
            check_length("length of yp", yp.len(), y.len())?;
        }
        check_finite("y", y)?;
        check_finite("yp", yp.unwrap_or_default())?;
        self.y.as_mut_slice().copy_from_slice(y);
        if let (Some(vector), Some(yp)) = (&mut self.yp, yp) {
            vector.as_mut_slice().copy_from_slice(yp);
        }
        let (name, reinit) = self.memory.functions.reinit;
        // SAFETY: memory and vectors are alive; the integrator copies the vectors.
        let code = unsafe { reinit(self.memory.raw, t, self.y.raw(), self.raw_yp()) };
        self.host.accept(name, code)?;
        self.t = t;
        (self.has_step, self.failed_within) = (false, false);
        let step_end = &mut self.host.get_mut().step_end;
        *step_end = step_end.and(Some(t));
        match self.memory.functions.reinit_forgets_stop_time {
            true => self.stop_time.forget(),
            false => self.stop_time.set(None),
        }
        self.roots_found.fill(0);
        Ok(())
    }

    /// Integrates to `target` (`CV_NORMAL`) or by one step (`CV_ONE_STEP`).
    pub(super) fn integrate(&mut self, target: f64, task: i32) -> Result<Reached, Error> {
        check_time("target time", target)?;
        if target == self.t {
            return Ok(Reached::Time);
        }
        self.check_target(target, task)?;
        let functions = self.memory.functions;
        if let Some(time) = self.stop_time.news(self.t, target) {
            // SAFETY: the value is a plain number.
            unsafe { self.set(functions.set_stop_time, time)? };
        }
        let (name, solve) = functions.solve;
        let (memory, y, yp) = (self.memory.raw, self.y.raw(), self.raw_yp());
        self.host.get_mut().troubles.clear();
        // SAFETY: memory, vectors and everything registered with the memory are alive; `&mut self`
        // keeps others away while callbacks use the host.
        let code = unsafe { solve(memory, target, &raw mut self.t, y, yp, task) };
        self.failed_within = false;
        self.has_step = code >= 0 || self.step_statistics().steps > 0;
        if let Some(end) = self.host.get().step_end.filter(|_| code < 0) {
            // the time of `y`; C has that of a stage, and would interpolate as if the step ended there
            self.t = end;
            (self.has_step, self.failed_within) = (false, true);
        }
        self.host.get_mut().troubles.resume_panic();
        match code {
            ffi::CV_ROOT_RETURN => {
                let roots = self.roots_found.as_mut_ptr();
                // SAFETY: there are as many places as root functions.
                unsafe { self.set(functions.get_root_info, roots)? };
                Ok(Reached::Root)
            }
            code if code >= 0 => {
                let stopped = self.stop_time.time() == Some(self.t);
                if stopped {
                    self.stop_time.set(None);
                }
                Ok(if stopped { Reached::StopTime } else { Reached::Time })
            }
            code if functions.refusals.contains(&code) => {
                self.host.accept(name, code).map(|()| Reached::Time)
            }
            code => Err(self.stopped(code)),
        }
    }

    /// Refuses targets that C would refuse less clearly: `solve_to` can go back within the last
    /// step, `step` can not.
    fn check_target(&self, target: f64, task: i32) -> Result<(), Error> {
        let statistics = self.step_statistics();
        let earliest = match task {
            ffi::CV_ONE_STEP => self.t,
            _ => statistics.current_time - statistics.last_step,
        };
        if (target - earliest) * statistics.last_step < 0.0 {
            let mend = format!("it lies behind {earliest:?}; reinit turns the direction of time");
            return Err(Error::input("target time", target, mend));
        }
        Ok(())
    }

    pub(super) fn last_step(&self) -> (f64, f64) {
        let statistics = self.step_statistics();
        (statistics.current_time - statistics.last_step, statistics.current_time)
    }

    pub(super) fn last_order(&self) -> u32 {
        self.step_statistics().last_order
    }

    pub(super) fn interpolate(
        &mut self,
        t: f64,
        derivative: u32,
        out: &mut [f64],
    ) -> Result<(), Error> {
        check_length("length of out", out.len(), self.y.as_slice().len())?;
        check_time("t", t)?;
        if !self.has_step {
            return self.only_state(t, derivative, out);
        }
        let order = derivative.min(i32::MAX as u32) as i32;
        let functions = self.memory.functions;
        let (name, get_dky) = functions.get_dky;
        let (memory, scratch) = (self.memory.raw, self.scratch.raw());
        self.host.get_mut().troubles.clear();
        // SAFETY: memory and vector are alive; `&mut self` keeps others away while ARKODE evaluates
        // the right-hand side.
        let code = unsafe { get_dky(memory, t, order, scratch) };
        self.host.get_mut().troubles.resume_panic();
        if code == functions.bad_time {
            let (start, end) = self.last_step();
            return Err(Error::input("t", t, format!("the last step is [{start}, {end}]")));
        }
        if code == functions.bad_derivative {
            let order = self.step_statistics().last_order;
            let mend = format!("the last step was of order {order}");
            return Err(Error::input("derivative", derivative, mend));
        }
        if code == ffi::CV_RHSFUNC_FAIL {
            return Err(self.stopped(code));
        }
        self.host.accept(name, code)?;
        out.copy_from_slice(self.scratch.as_slice());
        Ok(())
    }

    /// Answers [`interpolate`](Self::interpolate) where there is no step to look into.
    fn only_state(&self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        if t != self.t {
            let mend =
                format!("without a step to look into only the state at {:?} is known", self.t);
            return Err(Error::input("t", t, mend));
        }
        if derivative > 0 {
            let mend = "it takes a step: without one only the state itself is known";
            return Err(Error::input("derivative", derivative, mend));
        }
        out.copy_from_slice(self.y.as_slice());
        Ok(())
    }

    pub(super) fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), Error> {
        if let Some(t) = t {
            check_time("stop time", t)?;
            let statistics = self.step_statistics();
            if (t - statistics.current_time) * statistics.last_step < 0.0 || t == self.t {
                let mend = format!("the steps have reached {} already", statistics.current_time);
                return Err(Error::input("stop time", t, mend));
            }
        }
        self.stop_time.set(t);
        Ok(())
    }

    pub(super) fn statistics(&self) -> Statistics {
        let Memory { raw: memory, functions } = self.memory;
        let mut s = self.step_statistics();
        let [mut iterations, mut nonlinear_fails] = [0; 2];
        let count = |get: unsafe extern "C" fn(*mut c_void, *mut i64) -> i32| {
            let mut count = 0;
            // SAFETY: the memory is alive, the result has a place. Functions which do not apply,
            // say to a solver without Jacobian, leave it untouched.
            unsafe { get(memory, &raw mut count) };
            count as u64
        };
        // SAFETY: the memory is alive, every result has a place.
        unsafe {
            (functions.get_nonlinear_stats)(memory, &raw mut iterations, &raw mut nonlinear_fails);
            (functions.get_tolerance_scale)(memory, &raw mut s.tolerance_scale);
        }
        s.nonlinear_iterations = iterations as u64;
        s.nonlinear_failures = nonlinear_fails as u64;
        s.step_failures = count(functions.get_step_failures);
        s.jacobian_evaluations = count(functions.get_jacobian_evaluations);
        s.difference_quotient_evaluations = count(functions.get_quotient_evaluations);
        s.root_evaluations = count(functions.get_root_evaluations);
        s.stability_reductions = functions.get_stability_reductions.map_or(0, count);
        s
    }

    /// The statistics that one call tells, among them those of the last step: cheap enough to be
    /// asked for at every step.
    fn step_statistics(&self) -> Statistics {
        let mut s = Statistics::default();
        let [mut steps, mut evaluations, mut setups, mut error_fails] = [0; 4];
        let [mut last_order, mut current_order] = [0; 2];
        // SAFETY: the memory is alive, every result has a place.
        unsafe {
            (self.memory.functions.get_integrator_stats)(
                self.memory.raw,
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
        }
        if steps == 0 {
            // what the last run has left behind
            (s.current_time, s.last_step) = (self.t, 0.0);
        } else if self.failed_within {
            s.current_time = self.t;
        }
        s.steps = steps as u64;
        s.evaluations = evaluations as u64;
        s.linear_setups = setups as u64;
        s.error_test_failures = error_fails as u64;
        s.last_order = last_order as u32;
        s.current_order = current_order as u32;
        s
    }

    /// Ends the integrator and gives the system back.
    pub(super) fn into_system(self) -> S {
        drop(self.memory);
        self.host.into_system()
    }

    /// Whether the last factorization found a singular matrix.
    fn is_singular(&self) -> bool {
        let mut flag = 0;
        // SAFETY: the memory is alive, the result has a place.
        let code =
            unsafe { (self.memory.functions.get_linear_flag)(self.memory.raw, &raw mut flag) };
        let singular = [ffi::SUNLS_LUFACT_FAIL, ffi::SUNLS_PACKAGE_FAIL_REC];
        code == 0 && singular.iter().any(|&code| i64::from(code) == flag)
    }

    /// The error for a return code of the integrator.
    pub(super) fn stopped(&mut self, code: i32) -> Error {
        // first of all: asking the linear solver for its flag may leave a message, too
        let message = self.host.get_mut().troubles.message().to_owned();
        let statistics = self.step_statistics();
        let is_dae = self.yp.is_some();
        let (otherwise, blame_retries) = match code {
            ffi::CV_TOO_MUCH_WORK => (Cause::TooManySteps, true),
            ffi::CV_TOO_MUCH_ACC => (Cause::TooMuchAccuracy, false),
            ffi::IDA_LINESEARCH_FAIL | ffi::IDA_NO_RECOVERY if is_dae => {
                (Cause::InconsistentStart, true)
            }
            ffi::CV_CONV_FAILURE if self.is_singular() => (Cause::LinearSolver, true),
            ffi::CV_ERR_FAILURE | ffi::CV_CONV_FAILURE if is_dae && statistics.steps == 0 => {
                (Cause::InconsistentStart, true)
            }
            ffi::CV_ERR_FAILURE => (Cause::ErrorTest, false),
            ffi::CV_CONV_FAILURE => (Cause::Convergence, true),
            ffi::CV_LINIT_FAIL | ffi::CV_LSETUP_FAIL | ffi::CV_LSOLVE_FAIL => {
                (Cause::LinearSolver, true)
            }
            _ => (Cause::Other, true),
        };
        let troubles = &mut self.host.get_mut().troubles;
        let place = (statistics.current_time, statistics.current_step);
        let (cause, source) = troubles.cause(place, blame_retries, otherwise);
        Error::Integration(Box::new(IntegrationError {
            solver: self.memory.functions.solver,
            cause,
            t: self.t,
            step: statistics.current_step,
            order: statistics.current_order,
            code,
            message,
            source,
        }))
    }
}

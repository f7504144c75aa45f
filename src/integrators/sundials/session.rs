//! A session of an integrator of SUNDIALS with all its parts: construction.
//!
//! CVODE, ARKODE and IDA are one struct over a table of C functions. A solver as users see it owns the system
//! and lends it to the session as `dyn Ode` or `dyn Dae`: all code that touches C is compiled once, in the
//! library, and not for each type of system in each program.

use std::{ffi::c_void, ptr};

use super::{
    auxiliary::{Backward, Quadratures, Sensitivity},
    callbacks::callbacks,
    context::Context,
    differences::{Differences, Scales},
    ffi,
    functions::{Functions, OdeFunctions, Set, SetTwo, Solve, Stages},
    host::{CustomSolve, Host, HostBox, NewtonSolve},
    ilu::IncompleteLu,
    jacobian::Jacobian,
    krylov::Krylov,
    linear::Linear,
    linear_solver::LinearSolver,
    messages,
    nonlinear::FixedPoint,
    ode_callbacks::{jacobian, newton_rhs},
    ode_krylov::{jacobian_times, precondition_setup, precondition_solve},
    options::SolverOptions,
    progress::Progress,
    shape::Shape,
    signs::{self, Sign},
    stop_time::StopTime,
    vector::Vector,
};
use crate::integrators::{
    common::{AbsoluteTolerance, Callback, Clock, Error, JacobianCheck, Tolerances},
    ode::Ode,
};

/// Largest number of repetitions of a step with a smaller size because its error is too large. The 7 of CVODE and
/// ARKODE end runs at jumps that follow a long smooth stretch (the Oregonator); 20 are enough to get from any
/// step to the smallest possible. IDA keeps its 10: it passes such jumps, and more would hide that equations
/// are of higher index.
const ERROR_TEST_FAILURES: i32 = 20;

/// The C side of an integrator, with the system that it calls. Users see it as a [`Solver`](super::Solver).
pub(super) struct Session<K, S> {
    // Fields are dropped in this order: first what uses the others.
    pub(super) memory: Memory,
    pub(super) kind: K,
    /// Integrates.
    pub(super) solve: Solve,
    /// The right-hand sides of ARKODE.
    pub(super) stages: Stages,
    fixed_point: Option<FixedPoint>,
    linear: Option<Linear>,
    /// Mass matrix and its linear solver, if there is one.
    pub(super) mass: Option<Linear>,
    pub(super) backward: Option<Backward>,
    pub(super) y: Vector,
    /// The time derivative of `y`, for a DAE only.
    pub(super) yp: Option<Vector>,
    pub(super) scratch: Vector,
    /// Scratch vector for `yp`, as `scratch` for `y`.
    pub(super) slope_scratch: Option<Vector>,
    pub(super) quadratures: Option<Quadratures>,
    pub(super) sensitivities: Option<Sensitivity>,
    pub(super) host: HostBox<S>,
    pub(super) context: Context,
    pub(super) t: f64,
    /// The same as C has it: from the start.
    pub(super) elapsed: f64,
    pub(super) max_steps: u32,
    pub(super) stop_time: StopTime,
    pub(super) progress: Progress,
    /// The order of a method that does not report it: the structure of C that has the order of a multirate one differs by versions.
    pub(super) known_order: Option<u32>,
    /// Size of the first step, if it is not estimated.
    pub(super) initial_step: Option<f64>,
    /// Whether all steps have the same size.
    pub(super) has_fixed_step: bool,
    /// Whether there is a step to interpolate in. C does not check, and returns NaN or what the previous run
    /// has left.
    pub(super) has_step: bool,
    /// Whether the last call failed in an integrator that then reports the time of a stage.
    pub(super) failed_within: bool,
    /// Whether C has to be given the present state before it continues: after a first step of IDA that
    /// failed, or where numbers overflowed.
    pub(super) history_lost: bool,
    /// Degree of the polynomials between the steps, if it is not the order of the last step.
    pub(super) interpolant_degree: Option<u32>,
    pub(super) roots_found: Vec<i32>,
    /// Which signs the unknowns keep, if any.
    pub(super) signs: Vec<Sign>,
}

/// Owns the memory block of an integrator.
pub(super) struct Memory {
    pub(super) raw: *mut c_void,
    pub(super) functions: &'static Functions,
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: made by the integrator of this table and freed once, before everything it
        // refers to.
        unsafe { (self.functions.free)(&raw mut self.raw) };
    }
}

/// Start of an integration.
pub(super) struct InitialState<'a> {
    pub(super) t: f64,
    pub(super) y: &'a [f64],
    /// For a DAE only.
    pub(super) yp: Option<&'a [f64]>,
    pub(super) root_count: usize,
}

impl<K, S> Session<K, S> {
    /// Makes an integrator by the C function `create`, which gets a vector with the start; it is
    /// not yet initialised.
    ///
    /// # Safety
    /// `create` makes the memory block of the integrator that `functions` belong to, or null.
    pub(super) unsafe fn create(
        functions: &'static Functions,
        (function, create): (
            &'static str,
            impl FnOnce(ffi::N_Vector, ffi::SUNContext) -> *mut c_void,
        ),
        kind: K,
        system: S,
        start: &InitialState<'_>,
        solver: Option<LinearSolver>,
    ) -> Result<Self, Error> {
        let root_count = start.root_count;
        if i32::try_from(root_count).is_err() {
            return Err(Error::input("root_count", root_count, "it is at most 2^31 - 1"));
        }
        let context = Context::new()?;
        let y = Vector::from_slice(start.y, &context)?;
        let yp = start.yp.map(|yp| Vector::from_slice(yp, &context)).transpose()?;
        let scratch = Vector::from_slice(start.y, &context)?;
        let slope_scratch = start.yp.map(|yp| Vector::from_slice(yp, &context)).transpose()?;
        let clock = Clock::starting_at(start.t);
        let mut host = HostBox::new(Host::new(system, start.y.len(), root_count, clock, solver));
        // Locals are dropped in reverse order, so on an error below the memory goes first.
        let memory = Memory { raw: create(y.raw(), context.raw()), functions };
        if memory.raw.is_null() {
            return Err(Error::out_of_memory(function));
        }
        // SAFETY: the memory is alive, and uses neither host nor context when these are dropped.
        let (name, code) =
            unsafe { messages::keep_in::<S>(host.as_ptr(), functions, memory.raw, &context) };
        host.accept(name, code)?;
        Ok(Self {
            memory,
            solve: functions.solve,
            stages: [None; 2],
            fixed_point: None,
            linear: None,
            mass: None,
            backward: None,
            y,
            yp,
            scratch,
            slope_scratch,
            quadratures: None,
            sensitivities: None,
            host,
            context,
            t: start.t,
            elapsed: clock.elapsed(start.t),
            max_steps: 0,
            stop_time: StopTime::default(),
            progress: Progress::default(),
            initial_step: None,
            known_order: None,
            has_fixed_step: false,
            has_step: false,
            failed_within: false,
            history_lost: false,
            interpolant_degree: None,
            roots_found: vec![0; root_count],
            signs: Vec::new(),
            kind,
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
    pub(super) unsafe fn set<T>(&mut self, function: Set<T>, value: T) -> Result<(), Error> {
        // SAFETY: the memory is alive; the caller vouches for the value.
        self.host.call(function, |set| unsafe { set(self.memory.raw, value) })
    }

    /// Sets tolerances by one of these functions, for a number or for a vector.
    ///
    /// # Safety
    /// The functions belong to this integrator, and a vector is as long as that of the values.
    pub(super) unsafe fn set_tolerances(
        &mut self,
        (scalar, vector): (SetTwo<f64, f64>, SetTwo<f64, ffi::N_Vector>),
        Tolerances { rtol, atol }: &Tolerances,
    ) -> Result<(), Error> {
        let memory = self.memory.raw;
        match atol {
            // SAFETY: the memory is alive; the caller vouches for the function.
            AbsoluteTolerance::Scalar(atol) => {
                self.host.call(scalar, |set| unsafe { set(memory, *rtol, *atol) })
            }
            AbsoluteTolerance::Vector(atol) => {
                let atol = Vector::from_slice(atol, &self.context)?;
                // SAFETY: as above; C keeps a copy of the vector.
                self.host.call(vector, |set| unsafe { set(memory, *rtol, atol.raw()) })
            }
        }
    }

    /// Registers the host, after the integrator was initialised with the callbacks for it, and
    /// sets tolerances and the options of the step size control.
    pub(super) fn configure<O>(&mut self, options: &SolverOptions<O>) -> Result<(), Error> {
        let (steps, control) = (&options.steps, &options.step_control);
        self.max_steps = steps.max_steps;
        self.initial_step = steps.initial_step;
        let functions = self.memory.functions;
        // SAFETY: the length of a vector was checked; the host outlives the memory; the other values are plain
        // numbers.
        unsafe {
            let set = (functions.scalar_tolerances, functions.vector_tolerances);
            self.set_tolerances(set, &options.tolerances)?;
            self.set(functions.set_user_data, self.host.as_ptr())?;
            if let Some(weights) = &options.weights {
                self.host.get_mut().weights = Some(weights.clone());
                self.set(functions.weight_tolerances, Some(error_weights::<S>))?;
            }
            self.set(functions.set_max_steps, i64::from(steps.max_steps))?;
            if let Some(set) = functions.set_max_error_test_failures {
                self.set(set, ERROR_TEST_FAILURES)?;
            }
            if let Some(coefficient) = options.convergence_coefficient {
                self.set(functions.set_convergence_coefficient, coefficient)?;
            }
            for (name, function, value) in [
                ("initial_step", functions.set_initial_step, steps.initial_step),
                ("max_step", functions.set_max_step, steps.max_step),
                ("min_step", functions.set_min_step, options.min_step),
                ("max_growth", functions.set_max_growth, control.max_growth),
                ("first_growth", functions.set_first_growth, control.first_growth),
                ("min_reduction", functions.set_min_reduction, control.min_reduction),
                (
                    "after_error_failure",
                    functions.set_after_error_failure,
                    control.after_error_failure,
                ),
                (
                    "after_convergence_failure",
                    functions.set_after_convergence_failure,
                    control.after_convergence_failure,
                ),
            ] {
                let Some(value) = value else { continue };
                let function = function.ok_or_else(|| self.lacks(name, value))?;
                self.set(function, value)?;
            }
            if let (Some(set), Some(ratio)) = (functions.set_early_growth, control.max_growth) {
                self.set(set, ratio)?;
            }
            if let Some((low, high)) = control.kept {
                let set = functions.set_kept.ok_or_else(|| self.lacks("keep_between", low))?;
                self.host.call(set, |set| set(self.memory.raw, low, high))?;
            }
            if let (Some(set), Some(order)) = (functions.set_max_order, options.max_order) {
                self.set(set, order as i32)?;
            }
        }
        self.set_signs(&options.signs)
    }

    /// The error of an option that the integrator does not have.
    fn lacks(&self, option: &str, value: f64) -> Error {
        Error::input(
            option,
            value,
            format!("{} has no such option", self.memory.functions.integrator),
        )
    }

    /// Forgets the factors after a failure: the matrix of Newton's iteration may be half written.
    pub(super) fn forget_factors(&mut self) {
        if let Some(linear) = &mut self.linear {
            linear.forget_factors();
        }
    }

    /// Makes the unknowns keep these signs.
    fn set_signs(&mut self, signs: &[Sign]) -> Result<(), Error> {
        // C takes a vector without any constraint for a mistake
        if signs.iter().all(|sign| *sign == Sign::Free) {
            return Ok(());
        }
        let values: Vec<f64> = signs.iter().map(|sign| f64::from(*sign as i8)).collect();
        let values = Vector::from_slice(&values, &self.context)?;
        let set = self.memory.functions.set_constraints;
        let set =
            set.ok_or_else(|| self.lacks("sign_constraints", f64::from(signs.len() as u32)))?;
        self.signs = signs.to_vec();
        // SAFETY: C keeps a clone of the vector, whose length was checked, and it notes what it finds in the
        // host, which outlives the memory.
        unsafe {
            signs::note_in(values.raw(), self.host.violation())?;
            self.set(set, values.raw())
        }
    }

    /// Registers the root functions by `init`, if there are any.
    ///
    /// # Safety
    /// `init` belongs to this integrator, and `callback` fits the host.
    pub(super) unsafe fn set_root_functions<F>(
        &mut self,
        init: SetTwo<i32, F>,
        callback: F,
    ) -> Result<(), Error> {
        let count = self.roots_found.len() as i32;
        if count == 0 {
            return Ok(());
        }
        let Memory { raw: memory, functions } = self.memory;
        // SAFETY: the memory is alive; the caller vouches for the callback.
        unsafe {
            self.host.call(init, |init| init(memory, count, callback))?;
            self.host.call(functions.allow_inactive_roots, |allow| allow(memory))
        }
    }

    /// Gives the Newton iteration its linear solver.
    pub(super) fn set_newton<O>(
        &mut self,
        options: &SolverOptions<O>,
        solve: NewtonSolve<S>,
    ) -> Result<(), Error> {
        let (solver, tolerances) = (&options.linear_solver, &options.tolerances);
        let Memory { raw: memory, functions } = self.memory;
        let step_parameter = functions.get_step_parameter;
        self.host.get_mut().custom_solve = Some(CustomSolve { solve, step_parameter, memory });
        let n = self.y.as_slice().len();
        let is_dae = self.yp.is_some();
        if let (true, Some(pattern)) = (is_dae, solver.pattern_of_differences()) {
            // SAFETY: the memory belongs to these functions; its callbacks alone read them.
            let scales = unsafe { Scales::new((memory, functions), n, &self.context)? };
            self.host.get_mut().scales = Some(scales);
            self.host.get_mut().differences = Some(Differences::of_dae(pattern, &self.signs));
        } else if !is_dae && solver.takes_quotients() {
            let differences = Differences::of_ode(solver, n, tolerances, &self.signs);
            self.host.get_mut().differences = differences;
        }
        self.host.get_mut().checks_answers = !options.trusts_jacobian;
        if !options.trusts_jacobian && solver.is_checked() {
            let check = JacobianCheck::new(n, tolerances);
            let is_matrix = !matches!(solver, LinearSolver::Krylov(_));
            let shape = Shape::of(solver).filter(|_| is_matrix);
            self.host.get_mut().check = Some((check, shape));
        }
        self.host.get_mut().ilu = solver.ilu().map(|(pattern, _)| IncompleteLu::new(pattern));
        let data = self.host.as_ptr();
        // SAFETY: the data is the host, which outlives the solver.
        let linear = unsafe { Linear::new::<S>(solver, &self.y, &self.context, data)? };
        let linear = self.linear.insert(linear);
        // SAFETY: memory, solver and matrix are alive, and the memory is dropped first.
        self.host.call(functions.set_linear_solver, |set| unsafe {
            set(memory, linear.solver(), linear.matrix())
        })?;
        if let LinearSolver::Krylov(Krylov { tolerance_factor: Some(factor), .. }) = solver {
            // SAFETY: the value is a plain number.
            unsafe { self.set(functions.set_tolerance_factor, *factor)? };
        }
        Ok(())
    }

    /// Gives a Krylov method its callbacks: `set_products` gets no setup function and `times`,
    /// `set_preconditioner` gets `setup` and `solve`.
    ///
    /// # Safety
    /// The functions belong to this integrator, and the callbacks fit the host.
    pub(super) unsafe fn set_krylov<A, B, P, Q>(
        &mut self,
        krylov: &Krylov,
        (set_products, times): (SetTwo<Option<A>, B>, B),
        (set_preconditioner, setup, solve): (SetTwo<P, Q>, P, Q),
    ) -> Result<(), Error> {
        let memory = self.memory.raw;
        // SAFETY: the memory is alive; the caller vouches for the callbacks.
        unsafe {
            if krylov.products == Jacobian::Supplied {
                self.host.call(set_products, |set| set(memory, None, times))?;
            }
            if krylov.preconditioner.is_some() {
                self.host.call(set_preconditioner, |set| set(memory, setup, solve))?;
            }
        }
        Ok(())
    }

    /// Sets how the equations of an implicit step of an ODE are solved; `set_up_custom` registers the set-up of a
    /// user-supplied linear solver.
    ///
    /// # Safety
    /// The functions belong to this integrator.
    pub(super) unsafe fn set_nonlinear<O>(
        &mut self,
        functions: &OdeFunctions,
        options: &SolverOptions<O>,
        set_up_custom: impl FnOnce(&mut Self) -> Result<(), Error>,
    ) -> Result<(), Error>
    where
        S: Ode,
    {
        if let Some(acceleration) = options.fixed_point {
            let made = FixedPoint::new(&self.y, acceleration, &self.context)?;
            let solver = self.fixed_point.insert(made).raw();
            // SAFETY: the solver is dropped after the memory.
            return unsafe { self.set(self.memory.functions.set_nonlinear_solver, solver) };
        }
        self.set_newton(options, S::newton_solve)?;
        // SAFETY: the callbacks fit the registered host; the caller vouches for the functions.
        unsafe {
            match &options.linear_solver {
                LinearSolver::Custom => {
                    set_up_custom(self)?;
                    self.set(functions.set_newton_rhs, Some(newton_rhs::<S>))
                }
                LinearSolver::Krylov(krylov) => {
                    let (set_up, solve) = (precondition_setup::<S>, precondition_solve::<S>);
                    let times = (functions.set_jacobian_times, Some(jacobian_times::<S> as _));
                    let set = functions.set_preconditioner;
                    self.set_krylov(krylov, times, (set, Some(set_up as _), Some(solve as _)))
                }
                _ => self.set(functions.set_jacobian, Some(jacobian::<S>)),
            }
        }
    }
}

callbacks! {
    /// `CVEwtFn`
    fn error_weights<S: Sized>(y: read, weights: write, host: (data S)) {
        let Some(own) = host.weights.clone() else { return 0 };
        let t = host.last_time();
        host.guard(Callback::ErrorWeights, t, |_| own.write(y, weights))
    }
}

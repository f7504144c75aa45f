//! User data of every C callback: the user's system, and a record of its failures.
//!
//! A callback must not unwind into C. [`Host::guard`] runs the user's code and stores whatever went wrong,
//! and its return value stops SUNDIALS; the integrator reports the error after C has returned.

use std::{
    any::Any,
    error,
    ffi::{CStr, c_void},
    panic::{AssertUnwindSafe, catch_unwind, resume_unwind},
    ptr::NonNull,
};

use super::{
    differences::{Differences, Scales},
    ffi,
    functions::{Get, Named},
    ilu::{IncompleteLu, no_pivot},
    index::Index,
    linear_solver::LinearSolver,
    matrix,
    sensitivity::SensitivityRhs,
    shape::Shape,
    signs::Violation,
    weights::ErrorWeights,
};
use crate::integrators::{
    common::{Callback, Cause, Clock, Error, JacobianCheck, Point, Wanted},
    ode::{Entries, Failure},
};

/// Return value of a callback that requests a smaller step.
pub(super) const RETRY: i32 = 1;
/// Return value of a callback that asks SUNDIALS to stop.
pub(super) const STOP: i32 = -1;

/// `newton_solve` of an `Ode` or a `Dae`: (system, step parameter, right-hand side and solution).
pub(super) type NewtonSolve<S> = fn(&mut S, f64, &mut [f64]) -> Result<(), Failure>;

/// Finds the index of a `Dae`: (system, t, y, y').
pub(super) type FindIndex<S> = fn(&mut S, f64, &[f64], &[f64]) -> Result<Index, Failure>;

/// Calls of a user-supplied linear solver.
pub(super) struct CustomSolve<S> {
    pub(super) solve: NewtonSolve<S>,
    /// Reads the step parameter of the integrator that `memory` belongs to.
    pub(super) step_parameter: Get<f64>,
    pub(super) memory: *mut c_void,
}

/// The user's system and the record of its callbacks.
pub(super) struct Host<S> {
    pub(super) system: S,
    /// Number of unknowns: the length of every vector.
    pub(super) n: usize,
    pub(super) root_count: usize,
    /// Counts the times of C, from the last start.
    pub(super) clock: Clock,
    /// The time of the present callback, as C has it.
    now: f64,
    pub(super) sensitivity: Option<Box<SensitivityRhs>>,
    /// Determines the form of the Jacobian; none for a fixed-point iteration.
    pub(super) linear_solver: Option<LinearSolver>,
    /// None for a fixed-point iteration.
    pub(super) custom_solve: Option<CustomSolve<S>>,
    /// For sparse Jacobians that the system does not supply.
    pub(super) differences: Option<Differences>,
    /// Step size and error weights for the difference quotients of a DAE.
    pub(super) scales: Option<Scales>,
    /// Whether the system's own linear solver or preconditioner is checked for answers that are zero.
    pub(super) checks_answers: bool,
    /// Checks the Jacobian that the system supplies, with its shape if it is a matrix.
    pub(super) check: Option<(JacobianCheck, Option<Shape>)>,
    /// Check whether a DAE failed because of its index; none if the user has declared the index.
    pub(super) find_index: Option<FindIndex<S>>,
    /// The preconditioner of a Krylov method, if it is not the system's own.
    pub(super) ilu: Option<IncompleteLu>,
    /// Time of the last `newton_setup`.
    pub(super) setup_time: f64,
    /// Time that whole steps have reached, noted for ARKODE, which reports the time of a stage after a
    /// failure.
    pub(super) step_end: Option<f64>,
    /// The weights of the error norm, if they are not those of the tolerances.
    pub(super) weights: Option<ErrorWeights>,
    pub(super) troubles: Troubles,
}

/// Reports of callbacks and the SUNDIALS error handler since the last call of the integrator, with times as C has them.
#[derive(Default)]
pub(super) struct Troubles {
    panic: Option<Box<dyn Any + Send>>,
    fatal: Option<(Callback, Box<dyn error::Error + Send + Sync>)>,
    /// Error in a supplied Jacobian.
    wrong: Option<Cause>,
    /// Time and reason of the last request for a smaller step.
    retry: Option<(f64, Cause)>,
    /// Number of consecutive such requests for the same time, within rounding.
    stuck: u32,
    /// The unknown that was last found beyond its bound.
    violation: Option<Violation>,
    message: String,
}

/// The error of the user's system, for the integrator's own error.
pub(super) type ErrorSource = Option<Box<dyn error::Error + Send + Sync>>;

/// Reserved length of messages of SUNDIALS, so that steps do not allocate: limits of steps are among them.
const MESSAGE: usize = 256;

/// Most requests for a smaller step at the same time.
const MOST_STUCK: u32 = 30;

impl Troubles {
    /// Notes a request for a smaller step, and stops where that no longer helps: near a time that cannot be
    /// passed, SUNDIALS would forever make steps that are lost in rounding.
    fn retry(&mut self, t: f64, cause: Cause) -> i32 {
        let same_time = |at: f64| (t - at).abs() <= 4.0 * f64::EPSILON * t.abs();
        let again = self.retry.as_ref().is_some_and(|(at, _)| same_time(*at));
        self.stuck = if again { self.stuck + 1 } else { 0 };
        self.retry = Some((t, cause));
        if self.stuck < MOST_STUCK { RETRY } else { STOP }
    }

    /// Whether all that went wrong is a request for a smaller step, at another time than `start`, from where the step goes.
    pub(super) fn requests_smaller_step(&self, start: f64) -> bool {
        let is_worse = self.panic.is_some() || self.fatal.is_some() || self.wrong.is_some();
        !is_worse
            && self.stuck < MOST_STUCK
            && self.retry.as_ref().is_some_and(|(t, _)| *t != start)
    }

    /// Forgets everything, keeping allocations.
    pub(super) fn clear(&mut self) {
        self.retry = None;
        self.stuck = 0;
        self.begin(0.0);
    }

    /// Clears the reports of earlier calls before one that continues from time `t`, except requests for a
    /// smaller step close to `t`, a time that they could not pass.
    pub(super) fn begin(&mut self, t: f64) {
        let near = |at: f64| (at - t).abs() <= 1e3 * f64::EPSILON * t.abs();
        if !self.retry.as_ref().is_some_and(|(at, _)| near(*at)) {
            self.retry = None;
            self.stuck = 0;
        }
        self.panic = None;
        self.fatal = None;
        self.wrong = None;
        self.violation = None;
        self.message.clear();
    }

    /// Resumes a panic of a callback, now that no C function is on the stack.
    pub(super) fn resume_panic(&mut self) {
        if let Some(panic) = self.panic.take() {
            resume_unwind(panic);
        }
    }

    /// Cause of the stop of the integrator at `t` with step `h`: the fatal error or the wrong Jacobian of the user's
    /// system; else, if `blame_retries`, its last request for a smaller step, at a point that was not passed
    /// since; else `otherwise`.
    pub(super) fn cause(
        &mut self,
        (t, h): (f64, f64),
        blame_retries: bool,
        otherwise: Cause,
    ) -> (Cause, ErrorSource) {
        if let Some((callback, source)) = self.fatal.take() {
            return (Cause::Fatal(callback), Some(source));
        }
        if let Some(wrong) = self.wrong.take() {
            return (wrong, None);
        }
        match self.retry.take() {
            Some((at, cause)) if blame_retries && (at - t) * h >= 0.0 => (cause, None),
            _ => (otherwise, None),
        }
    }

    /// Whether the user's code has requested a stop.
    pub(super) fn is_fatal(&self) -> bool {
        self.fatal.is_some()
    }

    pub(super) fn recent_violation(&self) -> Option<Violation> {
        self.violation.filter(Violation::is_recent)
    }

    /// Keeps the last message of SUNDIALS. Warnings have positive codes; they do not stop the integration.
    pub(super) fn keep_message(&mut self, code: i32, message: &CStr) {
        if code < 0 {
            self.message.clear();
            self.message.push_str(message.to_string_lossy().trim());
        }
    }

    pub(super) fn message(&self) -> &str {
        &self.message
    }
}

impl<S> Host<S> {
    pub(super) fn new(
        system: S,
        n: usize,
        root_count: usize,
        clock: Clock,
        linear_solver: Option<LinearSolver>,
    ) -> Self {
        let troubles = Troubles { message: String::with_capacity(MESSAGE), ..Troubles::default() };
        Self {
            system,
            n,
            root_count,
            clock,
            now: 0.0,
            sensitivity: None,
            linear_solver,
            custom_solve: None,
            differences: None,
            scales: None,
            check: None,
            find_index: None,
            ilu: None,
            checks_answers: false,
            setup_time: f64::NAN,
            step_end: None,
            weights: None,
            troubles,
        }
    }

    /// The host that a callback gets as its data.
    ///
    /// # Safety
    /// `data` points to a live host of this type, which nobody else uses during `'a`.
    pub(super) unsafe fn of<'a>(data: *mut c_void) -> &'a mut Self {
        // SAFETY: the caller vouches for the pointer.
        unsafe { &mut *data.cast() }
    }

    /// The time of a callback that C makes at `elapsed` after the start.
    pub(super) fn time_of_call(&mut self, elapsed: f64) -> f64 {
        self.now = elapsed;
        self.clock.time(elapsed)
    }

    /// The time of the last callback that had one.
    pub(super) fn last_time(&self) -> f64 {
        self.clock.time(self.now)
    }

    /// All numbers that a matrix of the linear solver stores; none if it stores none.
    ///
    /// # Safety
    /// `matrix` is live and was made for the linear solver and as many unknowns as this host has, and nobody
    /// else uses it during `'a`.
    pub(super) unsafe fn stored<'a>(&self, matrix: ffi::SUNMatrix) -> &'a mut [f64] {
        let Some(solver) = &self.linear_solver else { return &mut [] };
        // SAFETY: the caller vouches for the matrix.
        unsafe { matrix::stored(matrix, solver, self.n) }
    }

    /// Runs user code of a callback and translates its outcome for SUNDIALS.
    pub(super) fn guard(
        &mut self,
        callback: Callback,
        t: f64,
        call: impl FnOnce(&mut S) -> Result<(), Failure>,
    ) -> i32 {
        // After a panic the system is used again only if its owner, who gets the panic, does so.
        match catch_unwind(AssertUnwindSafe(|| call(&mut self.system))) {
            Ok(Ok(())) => 0,
            Ok(Err(Failure::Recoverable(message))) => {
                self.troubles.retry(self.now, Cause::Rejected { callback, t, message })
            }
            Ok(Err(Failure::Fatal(error))) => {
                self.troubles.fatal = Some((callback, error));
                STOP
            }
            Err(panic) => {
                self.troubles.panic = Some(panic);
                STOP
            }
        }
    }

    /// As [`guard`](Self::guard), for user code that fills `output`: NaN and infinity count as
    /// recoverable failures.
    pub(super) fn guard_output(
        &mut self,
        callback: Callback,
        t: f64,
        output: &mut [f64],
        call: impl FnOnce(&mut S, &mut [f64]) -> Result<(), Failure>,
    ) -> i32 {
        let outcome = self.guard(callback, t, |system| call(system, &mut *output));
        if outcome == 0 { self.check_finite(callback, t, output) } else { outcome }
    }

    /// As [`guard_output`](Self::guard_output), for entries of a matrix of the linear solver, or of its
    /// preconditioner, which are stored as `values`.
    pub(super) fn guard_entries(
        &mut self,
        callback: Callback,
        t: f64,
        values: &mut [f64],
        call: impl FnOnce(&mut S, Entries<'_>) -> Result<(), Failure>,
    ) -> i32 {
        let Some(solver) = &self.linear_solver else { return STOP };
        let entries = solver.entries(self.n, values);
        match self.guard(callback, t, |system| call(system, entries)) {
            0 => self.check_finite(callback, t, values),
            failed => failed,
        }
    }

    /// Checks the Jacobian that was just evaluated, if a check is due: its entries, or the products that `times` writes.
    pub(super) fn check_jacobian(
        &mut self,
        t: f64,
        point: Point<'_>,
        values: &[f64],
        mut times: impl FnMut(&mut S, &[f64], &mut [f64]) -> Result<(), Failure>,
        mut evaluate: impl FnMut(&mut S, [&[f64]; 2], &mut [f64]) -> Result<(), Failure>,
    ) -> i32 {
        let method = self.linear_solver.as_ref().and_then(LinearSolver::supplied);
        // Taken out of the host, which calls the system meanwhile.
        let Some((mut check, shape)) = self.check.take() else { return 0 };
        let mut wrong = None;
        let mut outcome = 0;
        if check.is_due() {
            outcome = self.guard(Callback::Jacobian, t, |system| {
                wrong = check.find(method, point, &mut |wanted, out| match (wanted, &shape) {
                    (Wanted::Product(v), Some(shape)) => {
                        shape.multiply(values, v, out);
                        true
                    }
                    (Wanted::Product(v), None) => times(system, v, out).is_ok(),
                    (Wanted::Equations(at), _) => evaluate(system, at, out).is_ok(),
                    (Wanted::Entry(row, column), shape) => {
                        shape.as_ref().is_none_or(|shape| shape.stores(row, column))
                    }
                });
                Ok(())
            });
        }
        self.check = Some((check, shape));
        if wrong.is_none() {
            return outcome;
        }
        self.troubles.wrong = wrong;
        STOP
    }

    /// Solves with the preconditioner of a Krylov method for `r`: by the incomplete factorization, or in place
    /// by `own` of the system.
    pub(super) fn precondition(
        &mut self,
        t: f64,
        r: &[f64],
        z: &mut [f64],
        own: impl FnOnce(&mut S, &mut [f64]) -> Result<(), Failure>,
    ) -> i32 {
        z.copy_from_slice(r);
        match &self.ilu {
            Some(ilu) => {
                ilu.solve(z);
                self.check_finite(Callback::Preconditioner, t, z)
            }
            None => match self.guard_output(Callback::NewtonSolve, t, z, own) {
                0 => self.check_answer(r, z),
                failed => failed,
            },
        }
    }

    /// Stops where the system's own solver answers zero to a right-hand side that is not.
    pub(super) fn check_answer(&mut self, r: &[f64], answer: &[f64]) -> i32 {
        let is_zero = |vector: &[f64]| vector.iter().all(|x| *x == 0.0);
        if !self.checks_answers || !is_zero(answer) || is_zero(r) {
            return 0;
        }
        self.troubles.wrong = Some(Cause::WrongSolver);
        STOP
    }

    /// Requests a smaller step where an incomplete factorization has no pivot.
    pub(super) fn check_pivots(&mut self, t: f64, factorized: Result<(), usize>) -> i32 {
        let Err(row) = factorized else { return 0 };
        let (callback, message) = (Callback::Preconditioner, no_pivot(row));
        self.troubles.retry(self.now, Cause::Rejected { callback, t, message })
    }

    /// Requests a smaller step if `output` has a NaN or infinity.
    pub(super) fn check_finite(&mut self, callback: Callback, t: f64, output: &[f64]) -> i32 {
        // A fold without early exit, which the compiler turns into vector instructions.
        if output.iter().fold(true, |finite, x| finite & x.is_finite()) {
            return 0;
        }
        let component = output.iter().position(|x| !x.is_finite()).unwrap_or_default();
        let value = output[component];
        self.troubles.retry(self.now, Cause::NotFinite { callback, t, component, value })
    }
}

/// Owns a [`Host`] at a fixed address which C may keep.
///
/// It is a raw pointer and not a `Box`, since moving a `Box` asserts that it is the only pointer, which would
/// invalidate C's copy.
pub(super) struct HostBox<S>(NonNull<Host<S>>);

impl<S> HostBox<S> {
    pub(super) fn new(host: Host<S>) -> Self {
        Self(NonNull::from(Box::leak(Box::new(host))))
    }

    pub(super) fn as_ptr(&self) -> *mut c_void {
        self.0.as_ptr().cast()
    }

    /// Record of an unknown beyond its bound by vectors of signs, during calls of C.
    pub(super) fn violation(&self) -> *mut Option<Violation> {
        // SAFETY: the host lives as long as `self`; no reference is made.
        unsafe { &raw mut (*self.0.as_ptr()).troubles.violation }
    }

    pub(super) fn get(&self) -> &Host<S> {
        // SAFETY: the host lives as long as `self`; callbacks, which make a `&mut Host`, only run
        // within calls that hold the integrator by `&mut`, when this reference is gone.
        unsafe { self.0.as_ref() }
    }

    pub(super) fn get_mut(&mut self) -> &mut Host<S> {
        // SAFETY: as in `get`, and `&mut self` makes the access unique.
        unsafe { self.0.as_mut() }
    }

    /// Turns the return code of a C function that does not integrate into a result.
    pub(super) fn accept(&mut self, function: &'static str, code: i32) -> Result<(), Error> {
        if code >= 0 {
            return Ok(());
        }
        let troubles = &mut self.get_mut().troubles;
        let message = std::mem::take(&mut troubles.message);
        Err(Error::Call { function, code, message })
    }

    /// Calls such a function by `call`.
    pub(super) fn call<F>(
        &mut self,
        (name, function): Named<F>,
        call: impl FnOnce(F) -> i32,
    ) -> Result<(), Error> {
        let code = call(function);
        self.accept(name, code)
    }

    /// Returns the user's system. All C objects that hold the pointer have to be freed before.
    pub(super) fn into_system(self) -> S {
        let pointer = self.0;
        std::mem::forget(self);
        // SAFETY: leaked from a Box in `new`; `self` is forgotten, so it is freed only here.
        unsafe { Box::from_raw(pointer.as_ptr()) }.system
    }
}

impl<S> Drop for HostBox<S> {
    fn drop(&mut self) {
        // SAFETY: leaked from a Box in `new` and freed once; owners drop the C objects first.
        drop(unsafe { Box::from_raw(self.0.as_ptr()) });
    }
}

//! CVODE: stiff and non-stiff systems of ordinary differential equations.

mod options;
mod setup;

pub use options::{CvodeOptions, Multistep};

use std::{ffi::c_void, fmt};

use super::{
    context::Context,
    error::{Cause, Error, IntegrationError},
    ffi,
    host::HostBox,
    linear::Linear,
    options::{Reached, StopTime, check_finite, check_length, check_time},
    statistics::Statistics,
    vector::Vector,
};
use crate::ode::Ode;

/// Integrates y' = f(t, y) with variable step size and order.
///
/// The solver owns the system `S`; [`Borrowed`](crate::ode::Borrowed) lends it one. It can be
/// sent to another thread if the system can.
///
/// User guide: chapter "Using CVODE".
pub struct Cvode<S> {
    // Fields are dropped in this order: first what uses the others.
    memory: Memory,
    _fixed_point: Option<FixedPoint>,
    _linear: Option<Linear>,
    y: Vector,
    scratch: Vector,
    host: HostBox<S>,
    _context: Context,
    t: f64,
    stop_time: StopTime,
    roots_found: Vec<i32>,
}

// SAFETY: the raw pointers lead to objects that this solver alone owns, among them its
// SUNContext; SUNDIALS keeps no thread-local state. The system has to be `Send` itself. Troubles
// that wait in the host are `Send`.
unsafe impl<S: Send> Send for Cvode<S> {}

impl<S> fmt::Debug for Cvode<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let y = self.y.as_slice();
        f.debug_struct("Cvode").field("t", &self.t).field("y", &y).finish_non_exhaustive()
    }
}

/// Owns the memory block of CVODE.
struct Memory(*mut c_void);

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: made by CVodeCreate and freed once, before everything it refers to.
        unsafe { ffi::CVodeFree(&raw mut self.0) };
    }
}

/// Owns a fixed-point nonlinear solver.
struct FixedPoint(ffi::SUNNonlinearSolver);

impl FixedPoint {
    fn new(template: &Vector, acceleration: u32, context: &Context) -> Result<Self, Error> {
        // SAFETY: vector and context are alive.
        let raw = unsafe {
            ffi::SUNNonlinSol_FixedPoint(template.raw(), acceleration as i32, context.raw())
        };
        if raw.is_null() {
            return Err(Error::out_of_memory("SUNNonlinSol_FixedPoint"));
        }
        Ok(Self(raw))
    }
}

impl Drop for FixedPoint {
    fn drop(&mut self) {
        // SAFETY: made by SUNNonlinSol_FixedPoint and freed once, after CVODE.
        unsafe { ffi::SUNNonlinSolFree(self.0) };
    }
}

impl<S: Ode> Cvode<S> {
    /// A solver for `system`, starting at time `t0` from `y0`.
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that can not be used.
    pub fn new(system: S, t0: f64, y0: &[f64], options: &CvodeOptions) -> Result<Self, Error> {
        setup::new(system, t0, y0, options)
    }

    /// Starts again at time `t` from `y`, with the same system and options, keeping all
    /// allocations. Counters start at zero; a stop time is forgotten. (`CVodeReInit`)
    ///
    /// # Errors
    /// [`Error::Input`] if `t` or `y` is not finite or `y` has the wrong length.
    pub fn reinit(&mut self, t: f64, y: &[f64]) -> Result<(), Error> {
        check_length("length of y", y.len(), self.y.as_slice().len())?;
        check_time("t", t)?;
        check_finite("y", y)?;
        self.y.as_mut_slice().copy_from_slice(y);
        // SAFETY: memory and vector are alive; CVODE copies the vector.
        let code = unsafe { ffi::CVodeReInit(self.memory.0, t, self.y.raw()) };
        self.host.accept("CVodeReInit", code)?;
        self.t = t;
        self.stop_time.set(None);
        self.roots_found.fill(0);
        Ok(())
    }

    /// Integrates to time `t`, or to a root or the stop time if one comes first.
    ///
    /// The steps are as long as the tolerances allow and usually pass `t`; the state at `t` is
    /// interpolated, so output times do not change the solution. Only the estimate of the first
    /// step depends on the first `t`; the option `initial_step` removes that too.
    /// (`CVode` with `CV_NORMAL`)
    ///
    /// # Errors
    /// [`Error::Integration`] if the integration stopped, with the reason; [`Error::Input`] if
    /// `t` is not finite or lies before the last step.
    ///
    /// # Panics
    /// A panic of the system passes through.
    pub fn solve_to(&mut self, t: f64) -> Result<Reached, Error> {
        self.integrate(t, ffi::CV_NORMAL)
    }

    /// Makes one step in the direction of time `towards`, which the step may pass.
    /// (`CVode` with `CV_ONE_STEP`)
    ///
    /// # Errors
    /// As for [`solve_to`](Self::solve_to).
    ///
    /// # Panics
    /// A panic of the system passes through.
    pub fn step(&mut self, towards: f64) -> Result<Reached, Error> {
        self.integrate(towards, ffi::CV_ONE_STEP)
    }

    fn integrate(&mut self, target: f64, task: i32) -> Result<Reached, Error> {
        check_time("target time", target)?;
        if target == self.t {
            return Ok(Reached::Time);
        }
        self.check_target(target, task)?;
        if let Some(time) = self.stop_time.news(self.t, target) {
            // SAFETY: the memory is alive.
            let code = unsafe { ffi::CVodeSetStopTime(self.memory.0, time) };
            self.host.accept("CVodeSetStopTime", code)?;
        }
        self.host.get_mut().troubles.clear();
        // SAFETY: memory, vector and everything registered with the memory are alive; `&mut self`
        // keeps others away while callbacks use the host.
        let code =
            unsafe { ffi::CVode(self.memory.0, target, self.y.raw(), &raw mut self.t, task) };
        self.host.get_mut().troubles.resume_panic();
        match code {
            ffi::CV_ROOT_RETURN => {
                // SAFETY: there are as many places as root functions.
                let code =
                    unsafe { ffi::CVodeGetRootInfo(self.memory.0, self.roots_found.as_mut_ptr()) };
                self.host.accept("CVodeGetRootInfo", code)?;
                Ok(Reached::Root)
            }
            code if code >= 0 => {
                let stopped = self.stop_time.time() == Some(self.t);
                if stopped {
                    self.stop_time.set(None);
                }
                Ok(if stopped { Reached::StopTime } else { Reached::Time })
            }
            ffi::CV_ILL_INPUT | ffi::CV_TOO_CLOSE | ffi::CV_BAD_T => {
                self.host.accept("CVode", code).map(|()| Reached::Time)
            }
            code => Err(self.stopped(code)),
        }
    }

    /// Refuses targets that C would refuse less clearly: `solve_to` can go back within the last
    /// step, `step` can not.
    fn check_target(&self, target: f64, task: i32) -> Result<(), Error> {
        let statistics = self.statistics();
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

    /// Time of the state [`y`](Self::y).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.t
    }

    /// The state at time [`t`](Self::t).
    #[must_use]
    pub fn y(&self) -> &[f64] {
        self.y.as_slice()
    }

    /// The times between which [`interpolate`](Self::interpolate) works: start and end of the
    /// last step.
    #[must_use]
    pub fn last_step(&self) -> (f64, f64) {
        let statistics = self.statistics();
        (statistics.current_time - statistics.last_step, statistics.current_time)
    }

    /// Writes the `derivative`-th time derivative of the solution at time `t`, within the
    /// [last step](Self::last_step), into `out`: 0 for the state itself. (`CVodeGetDky`)
    ///
    /// # Errors
    /// [`Error::Input`] if `t` lies outside the last step, `derivative` is larger than the order
    /// of the last step, or `out` has the wrong length.
    pub fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        check_length("length of out", out.len(), self.y.as_slice().len())?;
        check_time("t", t)?;
        let order = derivative.min(i32::MAX as u32) as i32;
        // SAFETY: memory and vector are alive.
        let code = unsafe { ffi::CVodeGetDky(self.memory.0, t, order, self.scratch.raw()) };
        match code {
            ffi::CV_BAD_T => {
                let (start, end) = self.last_step();
                return Err(Error::input("t", t, format!("the last step is [{start}, {end}]")));
            }
            ffi::CV_BAD_K => {
                let order = self.statistics().last_order;
                let mend = format!("the last step was of order {order}");
                return Err(Error::input("derivative", derivative, mend));
            }
            _ => self.host.accept("CVodeGetDky", code)?,
        }
        out.copy_from_slice(self.scratch.as_slice());
        Ok(())
    }

    /// Lets the integration stop exactly at time `t`, without evaluating the system beyond
    /// (`None`: no longer). For discontinuities at known times. (`CVodeSetStopTime`)
    ///
    /// # Errors
    /// [`Error::Input`] if `t` is not finite or lies behind the steps already taken.
    pub fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), Error> {
        if let Some(t) = t {
            check_time("stop time", t)?;
            let statistics = self.statistics();
            if (t - statistics.current_time) * statistics.last_step < 0.0 || t == self.t {
                let mend = format!("the steps have reached {} already", statistics.current_time);
                return Err(Error::input("stop time", t, mend));
            }
        }
        self.stop_time.set(t);
        Ok(())
    }

    /// After [`Reached::Root`]: for each root function 0, or the sign of its change where it has
    /// a root at the present time: +1 rising, -1 falling.
    #[must_use]
    pub fn roots_found(&self) -> &[i32] {
        &self.roots_found
    }

    /// What the integration has cost so far, and where it is.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        setup::statistics(self.memory.0, self.t)
    }

    /// The system.
    #[must_use]
    pub fn system(&self) -> &S {
        &self.host.get().system
    }

    /// The system, to be changed. After a change that makes the right-hand side jump,
    /// [`reinit`](Self::reinit) is needed.
    pub fn system_mut(&mut self) -> &mut S {
        &mut self.host.get_mut().system
    }

    /// Ends the solver and gives the system back.
    #[must_use]
    pub fn into_system(self) -> S {
        drop(self.memory);
        self.host.into_system()
    }

    /// The error for a return code of `CVode`.
    fn stopped(&mut self, code: i32) -> Error {
        let statistics = self.statistics();
        let (otherwise, blame_retries) = match code {
            ffi::CV_TOO_MUCH_WORK => (Cause::TooManySteps, true),
            ffi::CV_TOO_MUCH_ACC => (Cause::TooMuchAccuracy, false),
            ffi::CV_ERR_FAILURE => (Cause::ErrorTest, false),
            ffi::CV_CONV_FAILURE if setup::is_singular(self.memory.0) => {
                (Cause::LinearSolver, true)
            }
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
            solver: "CVODE",
            cause,
            t: self.t,
            step: statistics.current_step,
            order: statistics.current_order,
            code,
            message: troubles.message().to_owned(),
            source,
        }))
    }
}

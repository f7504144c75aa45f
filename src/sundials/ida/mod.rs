//! IDA: systems of differential-algebraic equations.

mod options;
mod setup;

pub use options::IdaOptions;

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
use crate::ode::Dae;

/// Integrates F(t, y, y') = 0 with variable step size and order.
///
/// The solver owns the system `S`; [`Borrowed`](crate::ode::Borrowed) lends it one. It can be
/// sent to another thread if the system can.
///
/// User guide: chapter "Using IDA".
pub struct Ida<S> {
    // Fields are dropped in this order: first what uses the others.
    memory: Memory,
    _linear: Linear,
    y: Vector,
    yp: Vector,
    scratch: Vector,
    host: HostBox<S>,
    _context: Context,
    t: f64,
    knows_algebraic: bool,
    stop_time: StopTime,
    roots_found: Vec<i32>,
}

// SAFETY: the raw pointers lead to objects that this solver alone owns, among them its
// SUNContext; SUNDIALS keeps no thread-local state. The system has to be `Send` itself. Troubles
// that wait in the host are `Send`.
unsafe impl<S: Send> Send for Ida<S> {}

/// Which initial values [`Ida::consistent_start`] may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitialCondition {
    /// The algebraic unknowns and the derivatives of the differential ones; differential unknowns
    /// stay (`IDA_YA_YDP_INIT`). Needs [`IdaOptions::differential`].
    Algebraic,
    /// All unknowns; their derivatives stay, such as zero for a state of rest (`IDA_Y_INIT`).
    State,
}

impl<S> fmt::Debug for Ida<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let y = self.y.as_slice();
        f.debug_struct("Ida").field("t", &self.t).field("y", &y).finish_non_exhaustive()
    }
}

/// Owns the memory block of IDA.
struct Memory(*mut c_void);

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: made by IDACreate and freed once, before everything it refers to.
        unsafe { ffi::IDAFree(&raw mut self.0) };
    }
}

impl<S: Dae> Ida<S> {
    /// A solver for `system`, starting at time `t0` from the state `y0` and its time derivative
    /// `yp0`, which have to satisfy the equations (see [`consistent_start`](Self::consistent_start)).
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that can not be used.
    pub fn new(
        system: S,
        t0: f64,
        y0: &[f64],
        yp0: &[f64],
        options: &IdaOptions,
    ) -> Result<Self, Error> {
        setup::new(system, t0, y0, yp0, options)
    }

    /// Corrects the initial values so that they satisfy the equations; call it before the first
    /// step. `first_output` is a time at which output will be wanted: it tells the direction and
    /// scale of time. [`y`](Self::y) and [`yp`](Self::yp) are the corrected values. (`IDACalcIC`)
    ///
    /// # Errors
    /// [`Error::Integration`] with [`Cause::InconsistentStart`] if no such values were found;
    /// [`Error::Input`] if steps were taken already, or it is not known which unknowns are
    /// algebraic.
    ///
    /// # Panics
    /// A panic of the system passes through.
    pub fn consistent_start(
        &mut self,
        unknown: InitialCondition,
        first_output: f64,
    ) -> Result<(), Error> {
        check_time("first_output", first_output)?;
        if first_output == self.t {
            let mend = "it is a later time than the start";
            return Err(Error::input("first_output", first_output, mend));
        }
        if unknown == InitialCondition::Algebraic && !self.knows_algebraic {
            let mend = "the option `differential` has to say which unknowns are algebraic";
            return Err(Error::input("unknown", "InitialCondition::Algebraic", mend));
        }
        if self.statistics().steps > 0 {
            let mend = "initial values can only be corrected before the first step";
            return Err(Error::input("steps taken", self.statistics().steps, mend));
        }
        let task = match unknown {
            InitialCondition::Algebraic => ffi::IDA_YA_YDP_INIT,
            InitialCondition::State => ffi::IDA_Y_INIT,
        };
        self.host.get_mut().troubles.clear();
        // SAFETY: the memory and everything registered with it are alive; `&mut self` keeps
        // others away while callbacks use the host.
        let code = unsafe { ffi::IDACalcIC(self.memory.0, task, first_output) };
        self.host.get_mut().troubles.resume_panic();
        if code < 0 {
            return Err(self.stopped(code));
        }
        // SAFETY: memory and vectors are alive.
        let code = unsafe { ffi::IDAGetConsistentIC(self.memory.0, self.y.raw(), self.yp.raw()) };
        self.host.accept("IDAGetConsistentIC", code)
    }

    /// Starts again at time `t` from `y` and its time derivative `yp`, with the same system and options, keeping all
    /// allocations. Counters start at zero; a stop time is forgotten. (`IDAReInit`)
    ///
    /// # Errors
    /// [`Error::Input`] if a number is not finite or a length is wrong.
    pub fn reinit(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Error> {
        check_length("length of y", y.len(), self.y.as_slice().len())?;
        check_time("t", t)?;
        check_length("length of yp", yp.len(), y.len())?;
        check_finite("y", y)?;
        check_finite("yp", yp)?;
        self.y.as_mut_slice().copy_from_slice(y);
        self.yp.as_mut_slice().copy_from_slice(yp);
        // SAFETY: memory and vectors are alive; IDA copies the vectors.
        let code = unsafe { ffi::IDAReInit(self.memory.0, t, self.y.raw(), self.yp.raw()) };
        self.host.accept("IDAReInit", code)?;
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
    /// (`IDASolve` with `IDA_NORMAL`)
    ///
    /// # Errors
    /// [`Error::Integration`] if the integration stopped, with the reason; [`Error::Input`] if
    /// `t` is not finite or lies before the last step.
    ///
    /// # Panics
    /// A panic of the system passes through.
    pub fn solve_to(&mut self, t: f64) -> Result<Reached, Error> {
        self.integrate(t, ffi::IDA_NORMAL)
    }

    /// Makes one step in the direction of time `towards`, which the step may pass.
    /// (`IDASolve` with `IDA_ONE_STEP`)
    ///
    /// # Errors
    /// As for [`solve_to`](Self::solve_to).
    ///
    /// # Panics
    /// A panic of the system passes through.
    pub fn step(&mut self, towards: f64) -> Result<Reached, Error> {
        self.integrate(towards, ffi::IDA_ONE_STEP)
    }

    fn integrate(&mut self, target: f64, task: i32) -> Result<Reached, Error> {
        check_time("target time", target)?;
        if target == self.t {
            return Ok(Reached::Time);
        }
        self.check_target(target, task)?;
        if let Some(time) = self.stop_time.news(self.t, target) {
            // SAFETY: the memory is alive.
            let code = unsafe { ffi::IDASetStopTime(self.memory.0, time) };
            self.host.accept("IDASetStopTime", code)?;
        }
        self.host.get_mut().troubles.clear();
        // SAFETY: memory, vector and everything registered with the memory are alive; `&mut self`
        // keeps others away while callbacks use the host.
        let code = unsafe {
            ffi::IDASolve(self.memory.0, target, &raw mut self.t, self.y.raw(), self.yp.raw(), task)
        };
        self.host.get_mut().troubles.resume_panic();
        match code {
            ffi::IDA_ROOT_RETURN => {
                // SAFETY: there are as many places as root functions.
                let code =
                    unsafe { ffi::IDAGetRootInfo(self.memory.0, self.roots_found.as_mut_ptr()) };
                self.host.accept("IDAGetRootInfo", code)?;
                Ok(Reached::Root)
            }
            code if code >= 0 => {
                let stopped = self.stop_time.time() == Some(self.t);
                if stopped {
                    self.stop_time.set(None);
                }
                Ok(if stopped { Reached::StopTime } else { Reached::Time })
            }
            ffi::IDA_ILL_INPUT => self.host.accept("IDASolve", code).map(|()| Reached::Time),
            code => Err(self.stopped(code)),
        }
    }

    /// Refuses targets that C would refuse less clearly: `solve_to` can go back within the last
    /// step, `step` can not.
    fn check_target(&self, target: f64, task: i32) -> Result<(), Error> {
        let statistics = self.statistics();
        let earliest = match task {
            ffi::IDA_ONE_STEP => self.t,
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

    /// The time derivative of the state at time [`t`](Self::t).
    #[must_use]
    pub fn yp(&self) -> &[f64] {
        self.yp.as_slice()
    }

    /// The times between which [`interpolate`](Self::interpolate) works: start and end of the
    /// last step.
    #[must_use]
    pub fn last_step(&self) -> (f64, f64) {
        let statistics = self.statistics();
        (statistics.current_time - statistics.last_step, statistics.current_time)
    }

    /// Writes the `derivative`-th time derivative of the solution at time `t`, within the
    /// [last step](Self::last_step), into `out`: 0 for the state itself. (`IDAGetDky`)
    ///
    /// # Errors
    /// [`Error::Input`] if `t` lies outside the last step, `derivative` is larger than the order
    /// of the last step, or `out` has the wrong length.
    pub fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        check_length("length of out", out.len(), self.y.as_slice().len())?;
        check_time("t", t)?;
        let order = derivative.min(i32::MAX as u32) as i32;
        // SAFETY: memory and vector are alive.
        let code = unsafe { ffi::IDAGetDky(self.memory.0, t, order, self.scratch.raw()) };
        match code {
            ffi::IDA_BAD_T => {
                let (start, end) = self.last_step();
                return Err(Error::input("t", t, format!("the last step is [{start}, {end}]")));
            }
            ffi::IDA_BAD_K => {
                let order = self.statistics().last_order;
                let mend = format!("the last step was of order {order}");
                return Err(Error::input("derivative", derivative, mend));
            }
            _ => self.host.accept("IDAGetDky", code)?,
        }
        out.copy_from_slice(self.scratch.as_slice());
        Ok(())
    }

    /// Lets the integration stop exactly at time `t`, without evaluating the system beyond
    /// (`None`: no longer). For discontinuities at known times. (`IDASetStopTime`)
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

    /// The error for a return code of `IDASolve`.
    fn stopped(&mut self, code: i32) -> Error {
        let statistics = self.statistics();
        let (otherwise, blame_retries) = match code {
            ffi::IDA_TOO_MUCH_WORK => (Cause::TooManySteps, true),
            ffi::IDA_TOO_MUCH_ACC => (Cause::TooMuchAccuracy, false),
            ffi::IDA_LINESEARCH_FAIL | ffi::IDA_NO_RECOVERY => (Cause::InconsistentStart, true),
            ffi::IDA_CONV_FAIL if setup::is_singular(self.memory.0) => (Cause::LinearSolver, true),
            ffi::IDA_ERR_FAIL | ffi::IDA_CONV_FAIL if statistics.steps == 0 => {
                (Cause::InconsistentStart, true)
            }
            ffi::IDA_ERR_FAIL => (Cause::ErrorTest, false),
            ffi::IDA_CONV_FAIL => (Cause::Convergence, true),
            ffi::IDA_LINIT_FAIL | ffi::IDA_LSETUP_FAIL | ffi::IDA_LSOLVE_FAIL => {
                (Cause::LinearSolver, true)
            }
            _ => (Cause::Other, true),
        };
        let troubles = &mut self.host.get_mut().troubles;
        let place = (statistics.current_time, statistics.current_step);
        let (cause, source) = troubles.cause(place, blame_retries, otherwise);
        Error::Integration(Box::new(IntegrationError {
            solver: "IDA",
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

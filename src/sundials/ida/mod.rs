//! IDA: systems of differential-algebraic equations.

mod options;
mod setup;

pub use options::IdaOptions;

use std::fmt;

use super::{
    error::Error,
    ffi,
    options::{Reached, check_time},
    session::Session,
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
    session: Session<S>,
    knows_algebraic: bool,
}

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
        let (t, y) = (self.session.t, self.session.y.as_slice());
        f.debug_struct("Ida").field("t", &t).field("y", &y).finish_non_exhaustive()
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
    /// [`Error::Integration`] with [`Cause::InconsistentStart`](super::Cause::InconsistentStart) if no such values were found;
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
        if first_output == self.session.t {
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
        let session = &mut self.session;
        session.host.get_mut().troubles.clear();
        // SAFETY: the memory and everything registered with it are alive; `&mut self` keeps
        // others away while callbacks use the host.
        let code = unsafe { ffi::IDACalcIC(session.memory.raw, task, first_output) };
        session.host.get_mut().troubles.resume_panic();
        if code < 0 {
            return Err(session.stopped(code));
        }
        // SAFETY: memory and vectors are alive.
        let code = unsafe {
            ffi::IDAGetConsistentIC(session.memory.raw, session.y.raw(), session.raw_yp())
        };
        session.host.accept("IDAGetConsistentIC", code)
    }

    /// Starts again at time `t` from `y` and its time derivative `yp`, with the same system and options, keeping all
    /// allocations. Counters start at zero; a stop time is forgotten. (`IDAReInit`)
    ///
    /// # Errors
    /// [`Error::Input`] if a number is not finite or a length is wrong.
    pub fn reinit(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Error> {
        self.session.reinit(t, y, Some(yp))
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
        self.session.integrate(t, ffi::IDA_NORMAL)
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
        self.session.integrate(towards, ffi::IDA_ONE_STEP)
    }

    /// Time of the state [`y`](Self::y).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.session.t
    }

    /// The state at time [`t`](Self::t).
    #[must_use]
    pub fn y(&self) -> &[f64] {
        self.session.y.as_slice()
    }

    /// The time derivative of the state at time [`t`](Self::t).
    #[must_use]
    pub fn yp(&self) -> &[f64] {
        self.session.yp.as_ref().map_or(&[], Vector::as_slice)
    }

    /// The times between which [`interpolate`](Self::interpolate) works: start and end of the
    /// last step.
    #[must_use]
    pub fn last_step(&self) -> (f64, f64) {
        self.session.last_step()
    }

    /// Order of the last step; 0 before the first.
    #[must_use]
    pub fn last_order(&self) -> u32 {
        self.session.last_order()
    }

    /// Writes the `derivative`-th time derivative of the solution at time `t`, within the
    /// [last step](Self::last_step), into `out`: 0 for the state itself. (`IDAGetDky`)
    ///
    /// # Errors
    /// [`Error::Input`] if `t` lies outside the last step, `derivative` is larger than the order
    /// of the last step, or `out` has the wrong length.
    pub fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        self.session.interpolate(t, derivative, out)
    }

    /// Lets the integration stop exactly at time `t`, without evaluating the system beyond
    /// (`None`: no longer). For discontinuities at known times. (`IDASetStopTime`)
    ///
    /// # Errors
    /// [`Error::Input`] if `t` is not finite or lies behind the steps already taken.
    pub fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), Error> {
        self.session.set_stop_time(t)
    }

    /// After [`Reached::Root`]: for each root function 0, or the sign of its change where it has
    /// a root at the present time: +1 rising, -1 falling.
    #[must_use]
    pub fn roots_found(&self) -> &[i32] {
        &self.session.roots_found
    }

    /// What the integration has cost so far, and where it is.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        self.session.statistics()
    }

    /// The system.
    #[must_use]
    pub fn system(&self) -> &S {
        &self.session.host.get().system
    }

    /// The system, to be changed. After a change that makes the right-hand side jump,
    /// [`reinit`](Self::reinit) is needed.
    pub fn system_mut(&mut self) -> &mut S {
        &mut self.session.host.get_mut().system
    }

    /// Ends the solver and gives the system back.
    #[must_use]
    pub fn into_system(self) -> S {
        self.session.into_system()
    }
}

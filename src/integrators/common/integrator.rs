//! Interface of all integrators.

use super::{error::Error, statistics::Statistics};

/// An integrator at work: it owns a system of equations and a state, and takes steps.
///
/// Steps are as long as the tolerances allow. The state between the ends of the last step is known,
/// too, by interpolation, so output times never change the steps.
pub trait Integrator {
    /// The system of equations.
    type System;

    /// Time of the state [`y`](Self::y).
    fn t(&self) -> f64;

    /// The state at time [`t`](Self::t). After a failure it is the last accepted one; where numbers overflow,
    /// that may be the one that the call began with.
    fn y(&self) -> &[f64];

    /// Integrates to time `t`, or to a root or the stop time if one comes first.
    ///
    /// Steps usually pass `t`; the state at `t` is interpolated, so output times do not change the
    /// solution. In SUNDIALS the estimate of the first step depends on the first `t`; the option
    /// `initial_step` removes that too.
    ///
    /// # Errors
    /// [`Error::Integration`] if the integration stopped, with the reason; [`Error::Input`] if
    /// `t` is not finite or lies before the last step.
    ///
    /// # Panics
    /// A panic of the system passes through.
    fn solve_to(&mut self, t: f64) -> Result<Reached, Error>;

    /// Makes one step in the direction of time `towards`, which the step may pass. After a
    /// [`solve_to`](Self::solve_to) that stopped within its last step, it first goes to the end of that step.
    ///
    /// # Errors
    /// As for [`solve_to`](Self::solve_to).
    ///
    /// # Panics
    /// A panic of the system passes through.
    fn step(&mut self, towards: f64) -> Result<Reached, Error>;

    /// The times between which [`interpolate`](Self::interpolate) works: start and end of the last step.
    /// Before the first one, both are the start.
    fn last_step(&self) -> (f64, f64);

    /// Order of the last step. Before the first it is 0 in methods of variable order.
    fn last_order(&self) -> u32;

    /// Degree in time of the polynomial that [`interpolate`](Self::interpolate) uses within the last step.
    fn interpolant_degree(&self) -> u32;

    /// Writes the `derivative`-th time derivative of the solution at time `t`, within the
    /// [last step](Self::last_step), into `out`: 0 for the state itself.
    ///
    /// Before the first step, and after a failure of ARKODE, there is no step to interpolate in: only the
    /// state itself is known.
    ///
    /// # Errors
    /// [`Error::Input`] if `t` lies outside the last step, `derivative` is larger than the method
    /// allows, or `out` has the wrong length; [`Error::Integration`] if the system had to be
    /// evaluated and failed.
    ///
    /// # Panics
    /// A panic of the system passes through.
    fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error>;

    /// Makes the integration stop exactly at time `t`, without evaluating the system beyond it.
    ///
    /// For discontinuities at known times. It applies once; `None` removes a stop time.
    ///
    /// # Errors
    /// [`Error::Input`] if `t` is not finite or lies before the current time of the integrator.
    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), Error>;

    /// Makes the integration stop where the equations change at time `t`, without evaluating them at `t` itself.
    ///
    /// [`t`](Self::t) is then the number before, and the state that just before the change.
    ///
    /// # Errors
    /// As for [`set_stop_time`](Self::set_stop_time).
    fn set_stop_before(&mut self, t: f64) -> Result<(), Error> {
        self.set_stop_time(Some(number_before(t, self.t())))
    }

    /// Starts again at time `t` from `y`, with the same options and allocations.
    ///
    /// For use after a jump of the state or of the system. Counters start at zero; a stop time is removed.
    ///
    /// A DAE keeps its present y', which has to fit `y`; [`Ida::reinit_with`] sets both.
    ///
    /// [`Ida::reinit_with`]: crate::integrators::sundials::Ida::reinit_with
    ///
    /// # Errors
    /// [`Error::Input`] if `t` or `y` is not finite or `y` has the wrong length.
    fn reinit(&mut self, t: f64, y: &[f64]) -> Result<(), Error>;

    /// Continues at time `t` from `y`, with the present step size, options and counters.
    ///
    /// For use after a change of the system that keeps the meaning of its unknowns. A stop time is removed.
    ///
    /// Returns `false`, and does nothing, where the method needs a new start by [`reinit`](Self::reinit):
    /// multistep methods depend on earlier steps, taken with the old system.
    ///
    /// # Errors
    /// [`Error::Input`] if `t` or `y` is not finite or `y` has the wrong length.
    fn resume(&mut self, t: f64, y: &[f64]) -> Result<bool, Error> {
        let _ = (t, y);
        Ok(false)
    }

    /// After [`Reached::Root`]: for each root function 0, or the sign of its change where it has
    /// a root at the present time: +1 rising, -1 falling.
    fn roots_found(&self) -> &[i32];

    /// Cost counters of the integration so far, and its present time, step size and order.
    fn statistics(&self) -> Statistics;

    /// Steps taken since the last start: cheap enough to be read at every step.
    fn steps(&self) -> u64 {
        self.statistics().steps
    }

    /// A warning about the steps: that stability, not accuracy, limits their size.
    fn notice(&self) -> Option<String> {
        None
    }

    /// The rate |lambda| (1/time) that bounds the steps of an explicit method, where stability does, not accuracy.
    fn bounding_rate(&self) -> Option<f64> {
        None
    }

    /// The system.
    fn system(&self) -> &Self::System;

    /// The system, to be changed. After a change that makes the right-hand side jump,
    /// [`reinit`](Self::reinit) is needed.
    fn system_mut(&mut self) -> &mut Self::System;

    /// Ends the integration and gives the system back.
    #[must_use]
    fn into_system(self) -> Self::System
    where
        Self: Sized;
}

/// The neighbouring number of time `t` towards `now`.
pub(crate) fn number_before(t: f64, now: f64) -> f64 {
    if t > now { t.next_down() } else { t.next_up() }
}

/// Reason for the end of an integration call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reached {
    /// At the requested time, or, for a single step, at the end of the step.
    Time,
    /// Sign change of a root function; [`Integrator::roots_found`] returns which one.
    Root,
    /// At the stop time, which is then no longer set.
    StopTime,
}

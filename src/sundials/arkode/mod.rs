//! ARKODE: Runge-Kutta methods, implicit and explicit.

mod options;
mod setup;
mod table;

pub use options::{ArkodeOptions, Predictor};
pub use table::Table;

use std::fmt;

use super::{error::Error, ffi, options::Reached, session::Session, statistics::Statistics};
use crate::ode::Ode;

/// Integrates y' = f(t, y) by a Runge-Kutta method with variable step size.
///
/// Diagonally implicit methods are for stiff systems, among them lightly damped oscillations,
/// which multistep methods of high order can not follow; explicit ones for systems that are not
/// stiff. (`ARKStep`)
///
/// After a recoverable failure of the right-hand side implicit methods retry with a smaller step,
/// explicit ones give up: SUNDIALS has no retry there.
///
/// The solver owns the system `S`; [`Borrowed`](crate::ode::Borrowed) lends it one. It can be
/// sent to another thread if the system can.
///
/// User guide: chapter "Using ARKODE", ARKStep.
pub struct Arkode<S> {
    session: Session<S>,
    /// Degree of the polynomials between the steps.
    degree: u32,
}

impl<S> fmt::Debug for Arkode<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (t, y) = (self.session.t, self.session.y.as_slice());
        f.debug_struct("Arkode").field("t", &t).field("y", &y).finish_non_exhaustive()
    }
}

impl<S: Ode> Arkode<S> {
    /// A solver for `system`, starting at time `t0` from `y0`.
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that can not be used.
    pub fn new(system: S, t0: f64, y0: &[f64], options: &ArkodeOptions) -> Result<Self, Error> {
        setup::new(system, t0, y0, options)
    }

    /// Starts again at time `t` from `y`, with the same system and options, keeping all
    /// allocations. Counters start at zero; a stop time is forgotten. (`ARKStepReInit`)
    ///
    /// # Errors
    /// [`Error::Input`] if `t` or `y` is not finite or `y` has the wrong length.
    pub fn reinit(&mut self, t: f64, y: &[f64]) -> Result<(), Error> {
        self.session.reinit(t, y, None)
    }

    /// Integrates to time `t`, or to a root or the stop time if one comes first.
    ///
    /// The steps are as long as the tolerances allow and usually pass `t`; the state at `t` is
    /// interpolated, so output times do not change the solution. Only the estimate of the first
    /// step depends on the first `t`; the option `initial_step` removes that too.
    /// (`ARKStepEvolve` with `ARK_NORMAL`)
    ///
    /// # Errors
    /// [`Error::Integration`] if the integration stopped, with the reason; [`Error::Input`] if
    /// `t` is not finite or lies before the last step.
    ///
    /// # Panics
    /// A panic of the system passes through.
    pub fn solve_to(&mut self, t: f64) -> Result<Reached, Error> {
        self.session.integrate(t, ffi::ARK_NORMAL)
    }

    /// Makes one step in the direction of time `towards`, which the step may pass.
    /// (`ARKStepEvolve` with `ARK_ONE_STEP`)
    ///
    /// # Errors
    /// As for [`solve_to`](Self::solve_to).
    ///
    /// # Panics
    /// A panic of the system passes through.
    pub fn step(&mut self, towards: f64) -> Result<Reached, Error> {
        self.session.integrate(towards, ffi::ARK_ONE_STEP)
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

    /// The times between which [`interpolate`](Self::interpolate) works: start and end of the
    /// last step.
    #[must_use]
    pub fn last_step(&self) -> (f64, f64) {
        self.session.last_step()
    }

    /// Writes the `derivative`-th time derivative of the solution at time `t`, within the
    /// [last step](Self::last_step), into `out`: 0 for the state itself. (`ARKStepGetDky`)
    ///
    /// The polynomial is Hermite's; its degree is one less than the order of the method, at most
    /// 3 for implicit and 5 for explicit methods. Degrees 4 and 5 evaluate the right-hand side.
    ///
    /// # Errors
    /// [`Error::Input`] if `t` lies outside the last step, `derivative` is larger than the degree,
    /// or `out` has the wrong length; [`Error::Integration`] if the right-hand side failed.
    ///
    /// # Panics
    /// A panic of the system passes through.
    pub fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        if derivative > self.degree {
            let mend = format!("the polynomials between the steps are of degree {}", self.degree);
            return Err(Error::input("derivative", derivative, mend));
        }
        self.session.interpolate(t, derivative, out)
    }

    /// Lets the integration stop exactly at time `t`, without evaluating the system beyond
    /// (`None`: no longer). For discontinuities at known times. (`ARKStepSetStopTime`)
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

    /// Order of the method.
    pub fn last_order(&self) -> u32 {
        self.session.last_order()
    }

    /// Ends the solver and gives the system back.
    #[must_use]
    pub fn into_system(self) -> S {
        self.session.into_system()
    }
}

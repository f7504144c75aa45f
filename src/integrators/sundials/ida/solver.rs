//! The public solver of IDA.

use faer::MatRef;

use super::{
    options::IdaOptions,
    setup::IdaKind,
    start::{InitialCondition, StartsDae},
};
use crate::integrators::{
    common::Error,
    ode::{Borrowed, Dae},
    sundials::{
        session::Session,
        solver::{Kind, Owner, Solver, WithSensitivities},
    },
};

/// Integrates F(t, y, y') = 0 with variable step size and order.
///
/// Made by `Ida::new`, used through the methods of [`Integrator`](crate::integrators::common::Integrator).
///
/// User guide: chapter "Using IDA".
pub type Ida<S> = Solver<IdaKind, S>;

impl Kind for IdaKind {
    type System = dyn Dae;
    type Session = dyn StartsDae<System = Borrowed<'static, dyn Dae>>;

    const NAME: &'static str = "IDA";
}

impl WithSensitivities for IdaKind {}

impl<S: Dae> Ida<S> {
    /// A solver for `system`, starting at time `t0` from the state `y0` and its time derivative
    /// `yp0`, which have to satisfy the equations (see [`consistent_start`](Self::consistent_start)).
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that cannot be used.
    pub fn new(
        system: S,
        t0: f64,
        y0: &[f64],
        yp0: &[f64],
        options: &IdaOptions,
    ) -> Result<Self, Error> {
        let mut system = Owner::new(system);
        // SAFETY: the solver drops the session first, and accesses the system through it.
        unsafe {
            let session = start(system.lend_dae(), t0, (y0, yp0), options)?;
            Ok(Self::new_within(session, system))
        }
    }

    /// Corrects the initial values so that they satisfy the equations (`IDACalcIC`).
    ///
    /// Call it before the first step. `first_output` is a time at which output will be wanted: it gives the
    /// direction and scale of time; if no start is found on that scale, shorter ones are tried. Sensitivities
    /// are corrected, too. [`y`](crate::integrators::common::Integrator::y) and [`yp`](Self::yp) are then the
    /// corrected values.
    ///
    /// The equations have to be of index 1: see [`check_index`](Self::check_index).
    ///
    /// # Errors
    /// [`Error::Integration`] with
    /// [`Cause::InconsistentStart`](crate::integrators::common::Cause::InconsistentStart) if no such values
    /// were found; [`Error::Input`] if steps were taken already, or it is not known which unknowns are
    /// algebraic.
    ///
    /// # Panics
    /// A panic of the system passes through.
    pub fn consistent_start(
        &mut self,
        unknown: InitialCondition,
        first_output: f64,
    ) -> Result<(), Error> {
        self.session.consistent_start(unknown, first_output)
    }

    /// Checks that the equations are of index 1 at most, at the present state.
    ///
    /// That is, the equations without derivatives determine the unknowns without derivatives, which IDA
    /// relies on.
    ///
    /// It takes four evaluations of the residual for each unknown, and elimination in dense matrices. If an
    /// integration with up to 300 unknowns fails, the check is made automatically.
    ///
    /// # Errors
    /// [`Error::Integration`] with [`Cause::HigherIndex`](crate::integrators::common::Cause::HigherIndex), or
    /// [`Cause::LinearSolver`](crate::integrators::common::Cause::LinearSolver) where the equations determine
    /// nothing at all, such as one equation twice, or what made the residual fail; [`Error::Input`] for more
    /// than 1000 unknowns.
    pub fn check_index(&mut self) -> Result<(), Error> {
        self.session.check_index()
    }

    /// As [`reinit`](crate::integrators::common::Integrator::reinit), from `y` and its time derivative `yp`.
    ///
    /// # Errors
    /// [`Error::Input`] if a number is not finite or a length is wrong.
    pub fn reinit_with(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Error> {
        self.session.reinit_with(t, y, yp)
    }

    /// As [`set_sensitivities`](Self::set_sensitivities), with the time derivatives `sp` of the
    /// sensitivities, which have to be consistent: (dF/dy) s + (dF/dy') s' + dF/dp = 0.
    /// [`consistent_start`](Self::consistent_start) finds the others.
    ///
    /// # Errors
    /// As for [`set_sensitivities`](Self::set_sensitivities).
    pub fn set_sensitivities_with(
        &mut self,
        s: MatRef<'_, f64>,
        sp: MatRef<'_, f64>,
    ) -> Result<(), Error> {
        self.session.set_sensitivities_with(s, sp)
    }

    /// Returns the error of a higher index, if the equations of a run without progress have one.
    pub(crate) fn diagnose_index(&mut self) -> Result<(), Error> {
        self.session.diagnose_index()
    }

    /// Whether the option [`differential`](super::IdaOptions::differential) was given, which
    /// [`InitialCondition::Algebraic`] needs.
    pub(crate) fn knows_algebraic(&self) -> bool {
        self.session.knows_algebraic()
    }

    /// The time derivative of the state at time [`t`](crate::integrators::common::Integrator::t).
    #[must_use]
    pub fn yp(&self) -> &[f64] {
        self.session.yp()
    }
}

/// A session of [`Ida`].
fn start(
    system: Borrowed<'static, dyn Dae>,
    t0: f64,
    (y0, yp0): (&[f64], &[f64]),
    options: &IdaOptions,
) -> Result<Box<<IdaKind as Kind>::Session>, Error> {
    Ok(Box::new(Session::of_ida(system, t0, (y0, yp0), options)?))
}

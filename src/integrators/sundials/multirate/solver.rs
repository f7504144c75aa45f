//! The public solver of multirate methods.

use std::{fmt, ptr};

use super::{
    options::MultirateOptions,
    setup::{FastStepper, MultirateKind},
};
use crate::integrators::{
    common::{Error, Integrator, Reached, Statistics},
    ode::{Borrowed, MassKind, Ode, delegate::delegate},
    sundials::{
        ArkodeOptions, arkode::ArkodeKind, functions::named, session::Session, solver::Owner,
    },
};

/// Integrates y' = slow(t, y) + fast(t, y) by slow steps of a fixed size, in each of which the fast part takes steps of
/// its own by a Runge-Kutta method. (`MRIStep` with `ARKStep`)
///
/// Both parts write slopes of all unknowns. It pays where the slow part costs more than the fast one, and is evaluated
/// a hundred times less. The slow part may be stiff, or [split](Ode::is_split) into a stiff part and one that is not, by
/// the [coupling](super::Coupling); the fast part may be either, by the table of its own options, and may have steps of
/// a fixed size or by its tolerances.
///
/// ```
/// use pliant::sundials::{ArkodeOptions, ButcherTable, Integrator, Multirate, MultirateOptions};
///
/// // a slow oscillation that drives a fast relaxation
/// let slow = |_t: f64, y: &[f64], ydot: &mut [f64]| {
///     (ydot[0], ydot[1]) = (-y[1], y[0]);
///     Ok(())
/// };
/// let fast = |_t: f64, y: &[f64], ydot: &mut [f64]| {
///     ydot[2] = -100.0 * (y[2] - y[0]);
///     Ok(())
/// };
/// let inner = ArkodeOptions::new(1e-8, 1e-10).table(ButcherTable::explicit(3)?);
/// let options = MultirateOptions::new(0.01, 1e-8, 1e-10);
/// let mut solver = Multirate::new(slow, fast, 0.0, &[1.0, 0.0, 1.0], &options, &inner)?;
/// solver.solve_to(2.0)?;
/// assert!((solver.y()[0] - 2f64.cos()).abs() < 1e-6);
/// assert!(solver.fast_statistics().steps > 3 * solver.statistics().steps);
/// # Ok::<(), pliant::sundials::Error>(())
/// ```
///
/// It is used through the methods of [`Integrator`], for which the slow part is the system: root functions are its own,
/// and statistics count the slow part. Steps are interpolated by polynomials of a degree one less than the order, at
/// most 3.
///
/// User guide: chapter "Using ARKODE", MRIStep.
pub struct Multirate<S, F> {
    // Fields are dropped in this order: sessions end before their systems, and the slow one, which calls the fast one,
    // first.
    slow: Box<Session<MultirateKind, Borrowed<'static, dyn Ode>>>,
    fast: Box<Session<ArkodeKind, Borrowed<'static, dyn Ode>>>,
    slow_system: Owner<S>,
    _fast_system: Owner<F>,
}

// SAFETY: as for `Solver`: the raw pointers in the sessions lead to objects that these alone own.
unsafe impl<S: Send, F: Send> Send for Multirate<S, F> {}

impl<S, F> fmt::Debug for Multirate<S, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (t, y) = (self.slow.t(), self.slow.y());
        f.debug_struct("Multirate").field("t", &t).field("y", &y).finish_non_exhaustive()
    }
}

impl<S: Ode, F: Ode> Multirate<S, F> {
    /// A solver for the sum of both parts, starting at time `t0` from `y0`, with options of the slow and of the fast
    /// part.
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that cannot be used, for parts with a mass matrix, and for root
    /// functions of the fast part.
    pub fn new(
        slow: S,
        fast: F,
        t0: f64,
        y0: &[f64],
        options: &MultirateOptions,
        fast_options: &ArkodeOptions,
    ) -> Result<Self, Error> {
        for kind in [slow.mass_kind(), fast.mass_kind()] {
            if kind != MassKind::Identity {
                let help = "multirate methods take none: multiply both parts by its inverse";
                return Err(Error::input("mass matrix", format!("{kind:?}"), help));
            }
        }
        if fast.root_count() > 0 {
            let help = "root functions belong to the slow part, which is given all unknowns, too";
            return Err(Error::input("root_count of the fast part", fast.root_count(), help));
        }
        let (mut slow_system, mut fast_system) = (Owner::new(slow), Owner::new(fast));
        // SAFETY: the sessions end before their systems, which are accessed through them alone, and the slow one ends
        // before the fast one.
        unsafe {
            let fast = Session::of_arkode(fast_system.lend_ode(), t0, y0, fast_options)?;
            let mut fast = Box::new(fast);
            // the ends of fast steps need not be known, and would cost evaluations
            fast.set(named!(ARKStepSetPostprocessStepFn as _), None)?;
            let stepper = FastStepper::new(fast.memory.raw)?;
            let slow = Session::of_multirate(slow_system.lend_ode(), stepper, t0, y0, options)?;
            Ok(Self { slow: Box::new(slow), fast, slow_system, _fast_system: fast_system })
        }
    }
}

impl<S, F> Multirate<S, F> {
    /// Cost counters of the fast part.
    #[must_use]
    pub fn fast_statistics(&self) -> Statistics {
        self.fast.statistics()
    }

    /// Calls the slow part, and adds to its errors what went wrong in the fast one.
    fn with_fast<T>(
        &mut self,
        call: impl FnOnce(&mut Session<MultirateKind, Borrowed<'static, dyn Ode>>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let fast = self.fast.host.get_mut();
        fast.clock = self.slow.clock();
        fast.troubles.begin(self.slow.elapsed);
        let outcome = call(&mut self.slow);
        let troubles = &mut self.fast.host.get_mut().troubles;
        troubles.resume_panic();
        match outcome {
            Err(Error::Integration(mut error)) => {
                let message = format!("; fast part: {}", troubles.message());
                let otherwise = error.cause.clone();
                let (cause, source) = troubles.cause((error.t, error.step), true, otherwise);
                if cause != error.cause {
                    (error.cause, error.source) = (cause, source);
                }
                if message != "; fast part: " {
                    error.message.push_str(&message);
                }
                Err(Error::Integration(error))
            }
            outcome => outcome,
        }
    }
}

impl<S, F> Integrator for Multirate<S, F> {
    type System = S;

    delegate! { @methods [slow]
        fn t() -> f64;
        fn y() -> &[f64];
        fn last_step() -> (f64, f64);
        fn last_order() -> u32;
        fn interpolant_degree() -> u32;
        fn set_stop_time(t: Option<f64>) -> Result<(), Error>;
        fn set_stop_before(t: f64) -> Result<(), Error>;
        fn roots_found() -> &[i32];
        fn statistics() -> Statistics;
        fn steps() -> u64;
    }

    fn solve_to(&mut self, t: f64) -> Result<Reached, Error> {
        self.with_fast(|slow| slow.solve_to(t))
    }

    fn step(&mut self, towards: f64) -> Result<Reached, Error> {
        self.with_fast(|slow| slow.step(towards))
    }

    fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        self.with_fast(|slow| slow.interpolate(t, derivative, out))
    }

    fn reinit(&mut self, t: f64, y: &[f64]) -> Result<(), Error> {
        self.fast.reinit(t, y)?;
        self.slow.reinit(t, y)
    }

    fn resume(&mut self, t: f64, y: &[f64]) -> Result<bool, Error> {
        self.with_fast(|slow| slow.resume(t, y))
    }

    fn system(&self) -> &S {
        let system = ptr::from_ref::<dyn Ode>(self.slow.system().0);
        // SAFETY: the session was lent this system, of type `S`, and gives it no longer than it is borrowed itself.
        unsafe { &*system.cast() }
    }

    fn system_mut(&mut self) -> &mut S {
        let system = ptr::from_mut::<dyn Ode>(self.slow.system_mut().0);
        // SAFETY: as above.
        unsafe { &mut *system.cast() }
    }

    fn into_system(self) -> S {
        drop(self.slow);
        self.slow_system.into_system()
    }
}

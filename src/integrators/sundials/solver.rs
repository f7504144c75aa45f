//! The public interface of an integrator of SUNDIALS: a session, and the system that is lent to it.

use std::{fmt, marker::PhantomData, mem, ptr, ptr::NonNull};

use faer::{MatMut, MatRef};

use super::{quadratures::CarriesIntegrals, sensitivity::CarriesSensitivities};
use crate::integrators::{
    common::{Error, Integrator, Reached, Statistics},
    ode::{Borrowed, Dae, Ode, delegate::delegate},
};

/// The kind of a [`Solver`]: CVODE, ARKODE or IDA.
pub trait Kind {
    /// The trait object of its systems, whatever their type.
    #[doc(hidden)]
    type System: ?Sized + 'static;

    /// Its session type. Sessions use systems through a pointer, so that they are compiled once and not for
    /// each type of system.
    #[doc(hidden)]
    type Session: Integrator<System = Borrowed<'static, Self::System>> + ?Sized;

    #[doc(hidden)]
    const NAME: &'static str;
}

/// The kinds that also compute integrals and sensitivities: CVODE and IDA.
pub trait WithSensitivities: Kind<Session: CarriesSensitivities> {}

/// An integrator of SUNDIALS: [`Cvode`](super::Cvode), [`Arkode`](super::Arkode) or [`Ida`](super::Ida), by
/// the parameter `K`. Their common interface is [`Integrator`]:
///
/// | method | C functions |
/// | --- | --- |
/// | `solve_to`, `step` | `CVode`, `ARKStepEvolve` or `IDASolve` with the task `CV_NORMAL` or `CV_ONE_STEP` |
/// | `interpolate` | `CVodeGetDky`, `ARKStepGetDky` or `IDAGetDky` |
/// | `set_stop_time` | `CVodeSetStopTime`, `ARKStepSetStopTime` or `IDASetStopTime`, called with the next step |
/// | `reinit` | `CVodeReInit`, `ARKStepReInit` or `IDAReInit` |
/// | `resume` | `ARKStepReset` for ARKODE; the others need a new start |
///
/// It owns the system `S`; [`Borrowed`] lends it one. It can be sent to another
/// thread if the system can.
pub struct Solver<K: Kind, S> {
    // Fields are dropped in this order: the session ends before its system.
    pub(super) session: Box<K::Session>,
    system: Owner<S>,
    kind: PhantomData<K>,
}

// SAFETY: the session is that of a system that is `Send`; the raw pointers in it lead to objects that it
// alone owns, among them its SUNContext; SUNDIALS keeps no thread-local state. Failures that are stored in
// its host are `Send`.
unsafe impl<K: Kind, S: Send> Send for Solver<K, S> {}

impl<K: Kind, S> fmt::Debug for Solver<K, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (t, y) = (self.t(), self.y());
        f.debug_struct(K::NAME).field("t", &t).field("y", &y).finish_non_exhaustive()
    }
}

/// Owns a system at a fixed address.
pub(super) struct Owner<S>(NonNull<S>);

impl<S> Owner<S> {
    pub(super) fn new(system: S) -> Self {
        Self(NonNull::from(Box::leak(Box::new(system))))
    }

    /// Lends the system to a session.
    ///
    /// # Safety
    /// The session ends before `self`, and until then the system is accessed only through the session.
    pub(super) unsafe fn lend_ode(&mut self) -> Borrowed<'static, dyn Ode>
    where
        S: Ode,
    {
        // SAFETY: the system lives as long as `self`; the caller vouches for the rest.
        let system: &mut dyn Ode = unsafe { self.0.as_mut() };
        // SAFETY: as above: it is used no longer than it lives.
        Borrowed(unsafe {
            mem::transmute::<&mut dyn Ode, &'static mut (dyn Ode + 'static)>(system)
        })
    }

    /// The same.
    ///
    /// # Safety
    /// As for [`lend_ode`](Self::lend_ode).
    pub(super) unsafe fn lend_dae(&mut self) -> Borrowed<'static, dyn Dae>
    where
        S: Dae,
    {
        // SAFETY: as in `lend_ode`.
        let system: &mut dyn Dae = unsafe { self.0.as_mut() };
        // SAFETY: as above.
        Borrowed(unsafe {
            mem::transmute::<&mut dyn Dae, &'static mut (dyn Dae + 'static)>(system)
        })
    }

    pub(super) fn into_system(self) -> S {
        let pointer = self.0;
        mem::forget(self);
        // SAFETY: leaked from a Box in `new`; `self` is forgotten, so it is freed only here.
        *unsafe { Box::from_raw(pointer.as_ptr()) }
    }
}

impl<S> Drop for Owner<S> {
    fn drop(&mut self) {
        // SAFETY: leaked from a Box in `new` and freed once.
        drop(unsafe { Box::from_raw(self.0.as_ptr()) });
    }
}

impl<K: Kind, S> Solver<K, S> {
    /// # Safety
    /// The session is one of `system`, which was lent to it.
    pub(super) unsafe fn new_within(session: Box<K::Session>, system: Owner<S>) -> Self {
        Self { session, system, kind: PhantomData }
    }
}

impl<K: Kind, S> Integrator for Solver<K, S> {
    type System = S;

    delegate! { @methods [session]
        fn t() -> f64;
        fn y() -> &[f64];
        fn solve_to(t: f64) -> Result<Reached, Error>;
        fn step(towards: f64) -> Result<Reached, Error>;
        fn last_step() -> (f64, f64);
        fn last_order() -> u32;
        fn interpolant_degree() -> u32;
        fn interpolate(t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error>;
        fn set_stop_time(t: Option<f64>) -> Result<(), Error>;
        fn set_stop_before(t: f64) -> Result<(), Error>;
        fn reinit(t: f64, y: &[f64]) -> Result<(), Error>;
        fn resume(t: f64, y: &[f64]) -> Result<bool, Error>;
        fn roots_found() -> &[i32];
        fn statistics() -> Statistics;
        fn steps() -> u64;
        fn notice() -> Option<String>;
    }

    fn system(&self) -> &S {
        let system = ptr::from_ref::<K::System>(self.session.system().0);
        // SAFETY: the session was lent this system, of type `S`, and gives it no longer than it is borrowed
        // itself.
        unsafe { &*system.cast() }
    }

    fn system_mut(&mut self) -> &mut S {
        let system = ptr::from_mut::<K::System>(self.session.system_mut().0);
        // SAFETY: as above.
        unsafe { &mut *system.cast() }
    }

    fn into_system(self) -> S {
        drop(self.session);
        self.system.into_system()
    }
}

impl<K: WithSensitivities, S> Solver<K, S> {
    /// The integrals of [`quadratures`](crate::integrators::ode::Ode::quadratures) from the start to time
    /// [`t`](Integrator::t). A new start sets them to zero. (`CVodeGetQuad`, `IDAGetQuad`)
    #[must_use]
    pub fn quadratures(&self) -> &[f64] {
        self.session.quadratures()
    }

    /// As [`interpolate`](Integrator::interpolate), for the integrals: their first derivative is the
    /// integrand. (`CVodeGetQuadDky`, `IDAGetQuadDky`)
    ///
    /// # Errors
    /// As for [`interpolate`](Integrator::interpolate).
    pub fn interpolate_quadratures(
        &mut self,
        t: f64,
        derivative: u32,
        out: &mut [f64],
    ) -> Result<(), Error> {
        self.session.interpolate_quadratures(t, derivative, out)
    }

    /// The sensitivities at time [`t`](Integrator::t): entry (i, j) is the derivative of unknown i with
    /// respect to the j-th parameter of [`Sensitivities::of`](super::Sensitivities::of). (`CVodeGetSens`,
    /// `IDAGetSens`)
    #[must_use]
    pub fn sensitivities(&self) -> MatRef<'_, f64> {
        self.session.sensitivities()
    }

    /// As [`interpolate`](Integrator::interpolate), for the sensitivities. (`CVodeGetSensDky1`,
    /// `IDAGetSensDky1`)
    ///
    /// # Errors
    /// As for [`interpolate`](Integrator::interpolate).
    pub fn interpolate_sensitivities(
        &mut self,
        t: f64,
        derivative: u32,
        out: MatMut<'_, f64>,
    ) -> Result<(), Error> {
        self.session.interpolate_sensitivities(t, derivative, out)
    }

    /// Lets the sensitivities start from `s` in place of zero (`CVodeSensReInit`, `IDASensReInit`).
    ///
    /// `s` has the form of [`sensitivities`](Self::sensitivities). Call it after the solver was made or
    /// started again, where initial values depend on parameters, or jump.
    ///
    /// # Errors
    /// [`Error::Input`] if steps were taken already, the shape is wrong or a number is not finite.
    pub fn set_sensitivities(&mut self, s: MatRef<'_, f64>) -> Result<(), Error> {
        self.session.set_sensitivities(s)
    }

    /// The sensitivities of the integrals at time [`t`](Integrator::t), if they are
    /// [wanted](super::Sensitivities::integrals): entry (i, j) is the derivative of integral i with respect to the j-th
    /// parameter of [`Sensitivities::of`](super::Sensitivities::of). A new start sets them to zero. (`CVodeGetQuadSens`,
    /// `IDAGetQuadSens`)
    #[must_use]
    pub fn quadrature_sensitivities(&self) -> MatRef<'_, f64> {
        self.session.quadrature_sensitivities()
    }

    /// As [`interpolate`](Integrator::interpolate), for the sensitivities of the integrals. (`CVodeGetQuadSensDky1`,
    /// `IDAGetQuadSensDky1`)
    ///
    /// # Errors
    /// As for [`interpolate`](Integrator::interpolate).
    pub fn interpolate_quadrature_sensitivities(
        &mut self,
        t: f64,
        derivative: u32,
        out: MatMut<'_, f64>,
    ) -> Result<(), Error> {
        self.session.interpolate_quadrature_sensitivities(t, derivative, out)
    }

    /// Sets how the parameters of the system change with each parameter of the sensitivities: columns, one
    /// after the other.
    pub(crate) fn set_parameter_directions(&mut self, directions: &[f64]) -> Result<(), Error> {
        self.session.set_parameter_directions(directions)
    }
}

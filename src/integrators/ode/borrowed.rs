//! Systems that are lent to an integrator, or behind a pointer.

use faer::MatMut;

use super::band::BandMut;
use super::dae::Dae;
use super::delegate::delegate;
use super::failure::Failure;
use super::first_order::Ode;
use super::functional::{Functional, Slopes};
use super::mass::MassKind;

/// A system lent to an integrator, or a functional, which otherwise owns it.
///
/// (`&mut` of a struct can not be a system by itself: closures already are, and to Rust `&mut closure` is a
/// closure, too.)
#[derive(Debug)]
pub struct Borrowed<'a, S: ?Sized>(pub &'a mut S);

/// A system behind a box, such as a `dyn Ode` of a type that is known only at run time.
///
/// (A `Box` can not be a system by itself, for the same reason.)
#[derive(Debug)]
pub struct Boxed<S: ?Sized>(pub Box<S>);

impl<S: Ode + ?Sized> Ode for Borrowed<'_, S> {
    delegate!(Ode in 0: equations, companions, explicit_part, mass, own_solvers, own_derivatives);
}

impl<S: Ode + ?Sized> Ode for Boxed<S> {
    delegate!(Ode in 0: equations, companions, explicit_part, mass, own_solvers, own_derivatives);
}

impl<S: Dae + ?Sized> Dae for Borrowed<'_, S> {
    delegate!(Dae in 0: equations, companions, own_solvers, own_derivatives);
}

impl<F: Functional + ?Sized> Functional for Borrowed<'_, F> {
    fn running(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        self.0.running(t, y, p, slopes)
    }

    fn terminal(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        self.0.terminal(t, y, p, slopes)
    }
}

impl<S: Dae + ?Sized> Dae for Boxed<S> {
    delegate!(Dae in 0: equations, companions, own_solvers, own_derivatives);
}

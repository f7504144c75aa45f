//! Right-hand sides made of a stiff and an explicit part.

use faer::MatMut;

use super::band::BandMut;
use super::delegate::delegate;
use super::failure::Failure;
use super::first_order::Ode;
use super::mass::MassKind;

/// An ODE whose right-hand side is split, made by [`split`].
#[derive(Clone, Debug)]
pub struct Split<S, E> {
    system: S,
    explicit: E,
}

/// The ODE y' = f(t, y) + g(t, y), where `stiff` gives f, with its Jacobian if it has one, and the closure
/// `explicit(t, y, ydot)` gives g, which is not stiff.
///
/// An ImEx method treats f implicitly and g explicitly: g enters no matrix and no iteration.
///
/// ```
/// use pliant::{
///     ode::split,
///     sundials::{Arkode, ArkodeOptions, ButcherTable, Integrator},
/// };
///
/// // y' = -1000 (y - 1) + cos t
/// let decay = |_t: f64, y: &[f64], f: &mut [f64]| {
///     f[0] = -1000.0 * (y[0] - 1.0);
///     Ok(())
/// };
/// let system = split(decay, |t, _y, g| {
///     g[0] = t.cos();
///     Ok(())
/// });
/// let options = ArkodeOptions::new(1e-6, 1e-9).table(ButcherTable::imex(4)?);
/// let mut solver = Arkode::new(system, 0.0, &[1.0], &options)?;
/// solver.solve_to(2.0)?;
/// assert!((solver.y()[0] - (1.0 + 1e-3 * (2f64.cos() + 1e-3 * 2f64.sin()))).abs() < 1e-5);
/// # Ok::<(), pliant::sundials::Error>(())
/// ```
pub fn split<S, E>(stiff: S, explicit: E) -> Split<S, E>
where
    S: Ode,
    E: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
{
    Split { system: stiff, explicit }
}

impl<S, E> Ode for Split<S, E>
where
    S: Ode,
    E: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
{
    delegate!(Ode in system: equations, companions, mass);

    fn is_split(&self) -> bool {
        true
    }

    fn explicit_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        if self.system.is_split() {
            return Err(Failure::Fatal("the stiff part of `split` is itself split".into()));
        }
        (self.explicit)(t, y, ydot)
    }
}

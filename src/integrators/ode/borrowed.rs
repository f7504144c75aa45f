//! Systems that are lent to an integrator, or behind a pointer.

use faer::MatMut;

use super::band::BandMut;
use super::dae::Dae;
use super::delegate::delegate_ode;
use super::failure::Failure;
use super::first_order::Ode;
use super::mass::MassKind;

/// A system lent to an integrator, which otherwise owns it.
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

/// Implements [`Ode`] by the system in field 0.
macro_rules! ode_within {
    () => {
        delegate_ode!(0);

        fn newton_setup(
            &mut self,
            t: f64,
            y: &[f64],
            ydot: &[f64],
            gamma: f64,
            reuse: bool,
        ) -> Result<bool, Failure> {
            self.0.newton_setup(t, y, ydot, gamma, reuse)
        }

        fn newton_solve(&mut self, gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
            self.0.newton_solve(gamma, r)
        }

        fn newton_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            self.0.newton_rhs(t, y, ydot)
        }

        fn integrals(&self) -> usize {
            self.0.integrals()
        }

        fn is_split(&self) -> bool {
            self.0.is_split()
        }

        fn explicit_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            self.0.explicit_rhs(t, y, ydot)
        }

        fn mass_kind(&self) -> MassKind {
            self.0.mass_kind()
        }

        fn dense_mass(&mut self, t: f64, mass: MatMut<'_, f64>) -> Result<(), Failure> {
            self.0.dense_mass(t, mass)
        }

        fn banded_mass(&mut self, t: f64, mass: BandMut<'_>) -> Result<(), Failure> {
            self.0.banded_mass(t, mass)
        }

        fn sparse_mass(&mut self, t: f64, values: &mut [f64]) -> Result<(), Failure> {
            self.0.sparse_mass(t, values)
        }

        fn sensitivity_rhs(
            &mut self,
            t: f64,
            y: &[f64],
            ydot: &[f64],
            parameter: usize,
            s: &[f64],
            sdot: &mut [f64],
        ) -> Result<(), Failure> {
            self.0.sensitivity_rhs(t, y, ydot, parameter, s, sdot)
        }

        fn adjoint_rhs(
            &mut self,
            t: f64,
            y: &[f64],
            lambda: &[f64],
            out: &mut [f64],
        ) -> Result<(), Failure> {
            self.0.adjoint_rhs(t, y, lambda, out)
        }

        fn adjoint_parameters(
            &mut self,
            t: f64,
            y: &[f64],
            lambda: &[f64],
            out: &mut [f64],
        ) -> Result<(), Failure> {
            self.0.adjoint_parameters(t, y, lambda, out)
        }
    };
}

/// Implements [`Dae`] by the system in field 0.
macro_rules! dae_within {
    () => {
        fn residual(
            &mut self,
            t: f64,
            y: &[f64],
            yp: &[f64],
            residual: &mut [f64],
        ) -> Result<(), Failure> {
            self.0.residual(t, y, yp, residual)
        }

        fn dense_jacobian(
            &mut self,
            t: f64,
            cj: f64,
            y: &[f64],
            yp: &[f64],
            jacobian: MatMut<'_, f64>,
        ) -> Result<(), Failure> {
            self.0.dense_jacobian(t, cj, y, yp, jacobian)
        }

        fn banded_jacobian(
            &mut self,
            t: f64,
            cj: f64,
            y: &[f64],
            yp: &[f64],
            jacobian: BandMut<'_>,
        ) -> Result<(), Failure> {
            self.0.banded_jacobian(t, cj, y, yp, jacobian)
        }

        fn sparse_jacobian(
            &mut self,
            t: f64,
            cj: f64,
            y: &[f64],
            yp: &[f64],
            values: &mut [f64],
        ) -> Result<(), Failure> {
            self.0.sparse_jacobian(t, cj, y, yp, values)
        }

        fn jacobian_times(
            &mut self,
            t: f64,
            cj: f64,
            y: &[f64],
            yp: &[f64],
            v: &[f64],
            jv: &mut [f64],
        ) -> Result<(), Failure> {
            self.0.jacobian_times(t, cj, y, yp, v, jv)
        }

        fn newton_setup(&mut self, t: f64, cj: f64, y: &[f64], yp: &[f64]) -> Result<(), Failure> {
            self.0.newton_setup(t, cj, y, yp)
        }

        fn newton_solve(&mut self, r: &mut [f64]) -> Result<(), Failure> {
            self.0.newton_solve(r)
        }

        fn root_count(&self) -> usize {
            self.0.root_count()
        }

        fn roots(&mut self, t: f64, y: &[f64], yp: &[f64], g: &mut [f64]) -> Result<(), Failure> {
            self.0.roots(t, y, yp, g)
        }

        fn quadrature_count(&self) -> usize {
            self.0.quadrature_count()
        }

        fn quadratures(
            &mut self,
            t: f64,
            y: &[f64],
            yp: &[f64],
            qdot: &mut [f64],
        ) -> Result<(), Failure> {
            self.0.quadratures(t, y, yp, qdot)
        }

        fn sensitivity_residual(
            &mut self,
            t: f64,
            y: &[f64],
            yp: &[f64],
            parameter: usize,
            s: &[f64],
            sp: &[f64],
            residual: &mut [f64],
        ) -> Result<(), Failure> {
            self.0.sensitivity_residual(t, y, yp, parameter, s, sp, residual)
        }

        fn parameters(&self) -> &[f64] {
            self.0.parameters()
        }

        fn set_parameters(&mut self, values: &[f64]) {
            self.0.set_parameters(values);
        }
    };
}

impl<S: Ode + ?Sized> Ode for Borrowed<'_, S> {
    ode_within!();
}

impl<S: Ode + ?Sized> Ode for Boxed<S> {
    ode_within!();
}

impl<S: Dae + ?Sized> Dae for Borrowed<'_, S> {
    dae_within!();
}

impl<S: Dae + ?Sized> Dae for Boxed<S> {
    dae_within!();
}

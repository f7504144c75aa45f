//! Right-hand sides as systems for integrators.

use faer::MatMut;

use super::{number::Number, system::Automatic, workspace::Workspace};
use crate::integrators::ode::{BandMut, Entries, Failure, Ode, Storage};

/// y' = f(t, y, p), written over a number type.
pub trait RightHandSide {
    /// Writes f(t, y, p) into `ydot` (same length as `y`, zero on entry).
    ///
    /// # Errors
    /// As [`Ode::rhs`].
    fn rhs<T: Number>(&mut self, t: f64, y: &[T], p: &[T], ydot: &mut [T]) -> Result<(), Failure>;
}

fn evaluate<E: RightHandSide, const N: usize>(
    equations: &mut E,
    t: f64,
    at: &mut Workspace<N>,
) -> Result<(), Failure> {
    equations.rhs(t, &at.y, &at.p, &mut at.f)
}

impl<E: RightHandSide> Ode for Automatic<E> {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.equations.rhs(t, y, &self.parameters, ydot)
    }

    fn supplied_jacobian(&self) -> Option<Storage<'_>> {
        Some(self.storage())
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.fill((t, y, &[]), 0.0, evaluate, Entries::Dense(jacobian))
    }

    fn banded_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        self.check_band(&jacobian)?;
        self.fill((t, y, &[]), 0.0, evaluate, Entries::Band(jacobian))
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.check_sparse(values)?;
        self.fill((t, y, &[]), 0.0, evaluate, Entries::Sparse(values))
    }

    fn jacobian_times(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        self.along((t, y, &[]), (v, 0.0, &[]), None, evaluate, jv)
    }

    fn sensitivity_rhs(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        parameter: usize,
        s: &[f64],
        sdot: &mut [f64],
    ) -> Result<(), Failure> {
        self.along((t, y, &[]), (s, 0.0, &[]), Some(parameter), evaluate, sdot)
    }

    fn adjoint_rhs(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.add_transposed((t, y, &[]), [1.0, 0.0], evaluate, lambda, out)
    }

    fn adjoint_parameters(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.by_parameters((t, y, &[]), evaluate, lambda, out)
    }

    fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.parameters.copy_from_slice(values);
    }
}

//! The entries of a matrix that a system writes, whatever its form.

use faer::MatMut;

use super::band::BandMut;
use super::dae::Dae;
use super::failure::Failure;
use super::first_order::Ode;

/// The entries of a matrix, zero and to be filled.
pub(crate) enum Entries<'a> {
    Dense(MatMut<'a, f64>),
    Band(BandMut<'a>),
    /// The values of a pattern, column by column.
    Sparse(&'a mut [f64]),
}

impl Entries<'_> {
    /// Sets entry (row, column), whose position among the values of a pattern is `position`.
    pub(crate) fn set(&mut self, entry: (usize, usize), position: usize, value: f64) {
        match self {
            Self::Dense(matrix) => matrix[entry] = value,
            Self::Band(band) => band[entry] = value,
            Self::Sparse(values) => values[position] = value,
        }
    }

    /// Lets the system write df/dy.
    pub(crate) fn jacobian(
        self,
        system: &mut (impl Ode + ?Sized),
        t: f64,
        y: &[f64],
        ydot: &[f64],
    ) -> Result<(), Failure> {
        match self {
            Self::Dense(matrix) => system.dense_jacobian(t, y, ydot, matrix),
            Self::Band(matrix) => system.banded_jacobian(t, y, ydot, matrix),
            Self::Sparse(values) => system.sparse_jacobian(t, y, ydot, values),
        }
    }

    /// Lets the system write dF/dy + cj dF/dy'.
    pub(crate) fn dae_jacobian(
        self,
        system: &mut (impl Dae + ?Sized),
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
    ) -> Result<(), Failure> {
        match self {
            Self::Dense(matrix) => system.dense_jacobian(t, cj, y, yp, matrix),
            Self::Band(matrix) => system.banded_jacobian(t, cj, y, yp, matrix),
            Self::Sparse(values) => system.sparse_jacobian(t, cj, y, yp, values),
        }
    }

    /// Lets the system write its mass matrix.
    pub(crate) fn mass(self, system: &mut (impl Ode + ?Sized), t: f64) -> Result<(), Failure> {
        match self {
            Self::Dense(matrix) => system.dense_mass(t, matrix),
            Self::Band(matrix) => system.banded_mass(t, matrix),
            Self::Sparse(values) => system.sparse_mass(t, values),
        }
    }
}

//! Equations with a constant mass matrix, M y' = f(t, y).

use faer::{Mat, MatMut};

use super::band::BandMut;
use super::delegate::delegate;
use super::failure::Failure;
use super::first_order::Ode;
use super::mass::MassKind;

/// The numbers of a constant mass matrix, for [`with_mass`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum MassMatrix {
    /// Its diagonal, for dense and band linear solvers.
    Diagonal(Vec<f64>),
    /// All of it, for dense linear solvers.
    Dense(Mat<f64>),
    /// Its values, column by column, on the sparsity pattern that the linear solver is given.
    Sparse(Vec<f64>),
}

impl From<Vec<f64>> for MassMatrix {
    /// A diagonal matrix.
    fn from(diagonal: Vec<f64>) -> Self {
        Self::Diagonal(diagonal)
    }
}

impl<const N: usize> From<[f64; N]> for MassMatrix {
    /// A diagonal matrix.
    fn from(diagonal: [f64; N]) -> Self {
        Self::Diagonal(diagonal.to_vec())
    }
}

impl From<Mat<f64>> for MassMatrix {
    fn from(matrix: Mat<f64>) -> Self {
        Self::Dense(matrix)
    }
}

impl MassMatrix {
    /// Checks that the `actual` number of entries is the `expected` one, for which the integrator has storage.
    fn check(&self, actual: usize, expected: usize) -> Result<(), Failure> {
        let what = match self {
            Self::Diagonal(_) => "numbers on its diagonal",
            Self::Dense(_) => "rows and columns",
            Self::Sparse(_) => "values",
        };
        if actual == expected {
            return Ok(());
        }
        let text = format!("the mass matrix has {actual} {what}, where {expected} are needed");
        Err(Failure::Fatal(text.into()))
    }

    fn unfit(&self, solver: &str) -> Failure {
        let has = match self {
            Self::Diagonal(_) => "a diagonal; dense and band linear solvers take it",
            Self::Dense(_) => "dense; a dense linear solver takes it",
            Self::Sparse(_) => "sparse; a sparse linear solver takes it",
        };
        Failure::Fatal(
            format!("the linear solver is {solver}, but the mass matrix is {has}").into(),
        )
    }
}

/// An ODE with a constant mass matrix, made by [`with_mass`].
#[derive(Clone, Debug)]
pub struct WithMass<S> {
    system: S,
    mass: MassMatrix,
}

/// The equations M y' = f(t, y), where `system` gives f and its Jacobian: a closure, say. (If it has a mass
/// matrix itself, that is not used.)
///
/// [`Arkode`](crate::integrators::sundials::Arkode) integrates them if M is regular,
/// [`Ida`](crate::integrators::sundials::Ida) by [`MassForm`](crate::integrators::sundials::MassForm) also if
/// it is singular.
///
/// ```
/// use pliant::{
///     ode::with_mass,
///     sundials::{Arkode, ArkodeOptions, Integrator},
/// };
///
/// // 2 y' = -y
/// let decay = |_t: f64, y: &[f64], f: &mut [f64]| {
///     f[0] = -y[0];
///     Ok(())
/// };
/// let options = ArkodeOptions::new(1e-8, 1e-10);
/// let mut solver = Arkode::new(with_mass(decay, [2.0]), 0.0, &[1.0], &options)?;
/// solver.solve_to(2.0)?;
/// assert!((solver.y()[0] - (-1f64).exp()).abs() < 1e-6);
/// # Ok::<(), pliant::sundials::Error>(())
/// ```
pub fn with_mass<S: Ode>(system: S, mass: impl Into<MassMatrix>) -> WithMass<S> {
    WithMass { system, mass: mass.into() }
}

impl<S: Ode> Ode for WithMass<S> {
    delegate!(Ode in system: equations, companions, explicit_part, own_derivatives);

    fn mass_kind(&self) -> MassKind {
        MassKind::Constant
    }

    fn dense_mass(&mut self, _t: f64, mut mass: MatMut<'_, f64>) -> Result<(), Failure> {
        match &self.mass {
            MassMatrix::Dense(matrix) => {
                self.mass.check(matrix.nrows(), mass.nrows())?;
                self.mass.check(matrix.ncols(), mass.ncols())?;
                mass.copy_from(matrix);
            }
            MassMatrix::Diagonal(diagonal) => {
                self.mass.check(diagonal.len(), mass.nrows())?;
                diagonal.iter().enumerate().for_each(|(i, value)| mass[(i, i)] = *value);
            }
            MassMatrix::Sparse(_) => return Err(self.mass.unfit("dense")),
        }
        Ok(())
    }

    fn banded_mass(&mut self, _t: f64, mut mass: BandMut<'_>) -> Result<(), Failure> {
        let MassMatrix::Diagonal(diagonal) = &self.mass else {
            return Err(self.mass.unfit("of band form"));
        };
        self.mass.check(diagonal.len(), mass.dimension())?;
        diagonal.iter().enumerate().for_each(|(i, value)| mass[(i, i)] = *value);
        Ok(())
    }

    fn sparse_mass(&mut self, _t: f64, values: &mut [f64]) -> Result<(), Failure> {
        let MassMatrix::Sparse(mass) = &self.mass else { return Err(self.mass.unfit("sparse")) };
        self.mass.check(mass.len(), values.len())?;
        values.copy_from_slice(mass);
        Ok(())
    }
}

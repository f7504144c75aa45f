//! Systems made of two closures: equations and Jacobian.

use faer::MatMut;

use super::failure::Failure;
use super::first_order::Ode;

/// A right-hand side with its dense Jacobian, made by [`with_jacobian`].
#[derive(Clone, Debug)]
pub struct WithJacobian<F, J> {
    rhs: F,
    jacobian: J,
}

/// The ODE y' = rhs(t, y) with the dense Jacobian `jacobian(t, y, ydot, matrix)`.
///
/// ```
/// use pliant::ode::with_jacobian;
///
/// let decay = with_jacobian(
///     |_t, y, ydot| {
///         ydot[0] = -50.0 * y[0];
///         Ok(())
///     },
///     |_t, _y, _ydot, mut jacobian| {
///         jacobian[(0, 0)] = -50.0;
///         Ok(())
///     },
/// );
/// # let _: &dyn pliant::ode::Ode = &decay;
/// ```
pub fn with_jacobian<F, J>(rhs: F, jacobian: J) -> WithJacobian<F, J>
where
    F: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    J: FnMut(f64, &[f64], &[f64], MatMut<'_, f64>) -> Result<(), Failure>,
{
    WithJacobian { rhs, jacobian }
}

impl<F, J> Ode for WithJacobian<F, J>
where
    F: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    J: FnMut(f64, &[f64], &[f64], MatMut<'_, f64>) -> Result<(), Failure>,
{
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        (self.rhs)(t, y, ydot)
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        (self.jacobian)(t, y, ydot, jacobian)
    }
}

/// A right-hand side with its sparse Jacobian, made by [`with_sparse_jacobian`].
#[derive(Clone, Debug)]
pub struct WithSparseJacobian<F, J> {
    rhs: F,
    jacobian: J,
}

/// The ODE y' = rhs(t, y) with a sparse Jacobian: `jacobian(t, y, ydot, values)` writes the values
/// in the order of the sparsity pattern that the linear solver was given.
pub fn with_sparse_jacobian<F, J>(rhs: F, jacobian: J) -> WithSparseJacobian<F, J>
where
    F: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    J: FnMut(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
{
    WithSparseJacobian { rhs, jacobian }
}

impl<F, J> Ode for WithSparseJacobian<F, J>
where
    F: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    J: FnMut(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
{
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        (self.rhs)(t, y, ydot)
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        (self.jacobian)(t, y, ydot, values)
    }
}

//! Systems made of closures: equations with their Jacobian, equations with parameters.

use faer::MatMut;

use super::dae::Dae;
use super::failure::Failure;
use super::first_order::Ode;
use super::storage::Storage;

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

    fn supplied_jacobian(&self) -> Option<Storage<'_>> {
        Some(Storage::Dense)
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

/// Equations with parameters, made by [`with_parameters`] or [`dae_with_parameters`].
#[derive(Clone, Debug)]
pub struct WithParameters<F> {
    equations: F,
    parameters: Vec<f64>,
}

/// The ODE y' = rhs(t, y, p) with the parameters p. The closure takes (t, y, p, ydot).
///
/// ```
/// use pliant::ode::with_parameters;
///
/// let decay = with_parameters(
///     |_t, y, p, ydot| {
///         ydot[0] = -p[0] * y[0];
///         Ok(())
///     },
///     [50.0],
/// );
/// # let _: &dyn pliant::ode::Ode = &decay;
/// ```
pub fn with_parameters<F>(rhs: F, parameters: impl Into<Vec<f64>>) -> WithParameters<F>
where
    F: FnMut(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
{
    WithParameters { equations: rhs, parameters: parameters.into() }
}

/// The DAE residual(t, y, y', p) = 0 with the parameters p. The closure takes (t, y, yp, p, residual).
pub fn dae_with_parameters<F>(residual: F, parameters: impl Into<Vec<f64>>) -> WithParameters<F>
where
    F: FnMut(f64, &[f64], &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
{
    WithParameters { equations: residual, parameters: parameters.into() }
}

impl<F> WithParameters<F> {
    fn replace(&mut self, values: &[f64]) {
        let (given, needed) = (values.len(), self.parameters.len());
        assert!(given == needed, "set_parameters: {given} values for {needed} parameters");
        self.parameters.copy_from_slice(values);
    }
}

impl<F> Ode for WithParameters<F>
where
    F: FnMut(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
{
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        (self.equations)(t, y, &self.parameters, ydot)
    }

    fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.replace(values);
    }
}

impl<F> Dae for WithParameters<F>
where
    F: FnMut(f64, &[f64], &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
{
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        (self.equations)(t, y, yp, &self.parameters, residual)
    }

    fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.replace(values);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(expected = "set_parameters: 1 values for 2 parameters")]
    fn an_ode_takes_as_many_parameters_as_it_has() {
        let mut line = with_parameters(
            |_t, _y, p, ydot| {
                ydot[0] = p[0] + p[1];
                Ok(())
            },
            [1.0, 2.0],
        );
        Ode::set_parameters(&mut line, &[3.0]);
    }

    #[test]
    #[should_panic(expected = "set_parameters: 3 values for 2 parameters")]
    fn a_dae_takes_as_many_parameters_as_it_has() {
        let residual = |_t: f64, _y: &[f64], yp: &[f64], p: &[f64], r: &mut [f64]| {
            r[0] = p[0] + p[1] - yp[0];
            Ok(())
        };
        let mut line = dae_with_parameters(residual, [1.0, 2.0]);
        Dae::set_parameters(&mut line, &[3.0, 4.0, 5.0]);
    }
}

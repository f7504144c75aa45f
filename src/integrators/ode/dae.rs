//! Differential-algebraic equations.

use faer::MatMut;

use super::band::BandMut;
use super::failure::{Failure, missing};
use super::storage::Storage;

/// F(t, y, y') = 0.
///
/// Only [`residual`](Self::residual) is required, as in [`Ode`](super::Ode). Output arguments of a
/// method are zero on entry, as there.
pub trait Dae {
    /// Writes F(t, y, y') into `residual` (same length as `y`, zero on entry).
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure>;

    /// The form of a Jacobian that the system supplies, for [`solve`](fn@crate::integrators::solve::solve), which uses it where no linear
    /// solver is given. Default: none is known.
    fn supplied_jacobian(&self) -> Option<Storage<'_>> {
        None
    }

    /// Writes dF/dy + cj dF/dy' into the dense matrix `jacobian` (zero on entry).
    fn dense_jacobian(
        &mut self,
        _t: f64,
        _cj: f64,
        _y: &[f64],
        _yp: &[f64],
        _jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        Err(missing("dense_jacobian"))
    }

    /// Writes dF/dy + cj dF/dy' into the band matrix `jacobian` (zero on entry).
    fn banded_jacobian(
        &mut self,
        _t: f64,
        _cj: f64,
        _y: &[f64],
        _yp: &[f64],
        _jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        Err(missing("banded_jacobian"))
    }

    /// Writes the values of dF/dy + cj dF/dy', column by column, for the sparsity pattern that
    /// the linear solver was given (`values` is zero on entry).
    fn sparse_jacobian(
        &mut self,
        _t: f64,
        _cj: f64,
        _y: &[f64],
        _yp: &[f64],
        _values: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("sparse_jacobian"))
    }

    /// Writes the product of dF/dy + cj dF/dy' with the vector `v` into `jv` (zero on entry).
    fn jacobian_times(
        &mut self,
        _t: f64,
        _cj: f64,
        _y: &[f64],
        _yp: &[f64],
        _v: &[f64],
        _jv: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("jacobian_times"))
    }

    /// Prepares to solve (dF/dy + cj dF/dy') x = r.
    ///
    /// As the preconditioner of a Krylov method, it may be solved approximately.
    fn newton_setup(&mut self, _t: f64, _cj: f64, _y: &[f64], _yp: &[f64]) -> Result<(), Failure> {
        Err(missing("newton_setup"))
    }

    /// Replaces the right-hand side `r` by the solution x of the system last set up.
    fn newton_solve(&mut self, _r: &mut [f64]) -> Result<(), Failure> {
        Err(missing("newton_solve"))
    }

    /// Number of root functions (events); 0 means none.
    fn root_count(&self) -> usize {
        0
    }

    /// Writes the root functions g(t, y, y') into `g` (zero on entry).
    fn roots(&mut self, _t: f64, _y: &[f64], _yp: &[f64], _g: &mut [f64]) -> Result<(), Failure> {
        Err(missing("roots"))
    }

    /// Number of integrals that are computed along with the solution; 0 means none.
    fn quadrature_count(&self) -> usize {
        0
    }

    /// Writes the integrands h(t, y, y') of the integrals q' = h into `qdot` (zero on entry), as in
    /// [`Ode`](super::Ode).
    fn quadratures(
        &mut self,
        _t: f64,
        _y: &[f64],
        _yp: &[f64],
        _qdot: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("quadratures"))
    }

    /// Writes the residual of the sensitivity s = dy/dp of a parameter p, given by its index among the
    /// [`parameters`](Self::parameters), into `residual` (zero on entry): (dF/dy) s + (dF/dy') s' + dF/dp.
    /// `sp` is s'.
    #[allow(clippy::too_many_arguments)] // two states, two sensitivities
    fn sensitivity_residual(
        &mut self,
        _t: f64,
        _y: &[f64],
        _yp: &[f64],
        _parameter: usize,
        _s: &[f64],
        _sp: &[f64],
        _residual: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("sensitivity_residual"))
    }

    /// Writes (dF/dy)^T lambda + (dF/dy')^T mu into `out` (zero on entry), for adjoint gradients.
    fn adjoint_residual(
        &mut self,
        _t: f64,
        _y: &[f64],
        _yp: &[f64],
        _lambda: &[f64],
        _mu: &[f64],
        _out: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("adjoint_residual"))
    }

    /// Writes (dF/dp)^T lambda into `out` (zero on entry), a number for each of the
    /// [`parameters`](Self::parameters).
    fn adjoint_parameters(
        &mut self,
        _t: f64,
        _y: &[f64],
        _yp: &[f64],
        _lambda: &[f64],
        _out: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("adjoint_parameters"))
    }

    /// The parameters that the equations depend on, for callers that change them or require derivatives with
    /// respect to them. Default: none.
    fn parameters(&self) -> &[f64] {
        &[]
    }

    /// Sets the [`parameters`](Self::parameters) to these values, of which there are as many.
    ///
    /// # Panics
    /// May panic if their number differs, as [`WithParameters`](super::WithParameters) does.
    fn set_parameters(&mut self, _values: &[f64]) {}
}

impl<F> Dae for F
where
    F: FnMut(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
{
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self(t, y, yp, residual)
    }
}

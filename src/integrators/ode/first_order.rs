//! Ordinary differential equations.

use faer::MatMut;

use super::band::BandMut;
use super::failure::{Failure, missing};
use super::mass::MassKind;
use super::storage::Storage;

/// y' = f(t, y), or M y' = f(t, y) with a [mass matrix](Self::mass_kind).
///
/// Only [`rhs`](Self::rhs) is required. The other methods are called when the integrator was
/// configured to use them; their defaults fail with [`Failure::Fatal`].
///
/// Output arguments of a method are zero on entry, whichever integrator calls it: a method may add to them, and
/// need not write zeros. (The arguments that [`newton_solve`](Self::newton_solve) and [`project`](Self::project)
/// change in place are not such outputs.)
pub trait Ode {
    /// Writes f(t, y) into `ydot` (same length as `y`, zero on entry).
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure>;

    /// The form of a Jacobian that the system supplies, for [`solve`](fn@crate::integrators::solve::solve), which uses it where no linear
    /// solver is given. Default: none is known.
    fn supplied_jacobian(&self) -> Option<Storage<'_>> {
        None
    }

    /// Writes df/dy into the dense matrix `jacobian` (zero on entry); `ydot` is f(t, y).
    fn dense_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        _jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        Err(missing("dense_jacobian"))
    }

    /// Writes df/dy into the band matrix `jacobian` (zero on entry); `ydot` is f(t, y).
    fn banded_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        _jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        Err(missing("banded_jacobian"))
    }

    /// Writes the values of df/dy, column by column, for the sparsity pattern that the linear
    /// solver was given (`values` is zero on entry); `ydot` is f(t, y).
    fn sparse_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        _values: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("sparse_jacobian"))
    }

    /// Writes the product of df/dy with the vector `v` into `jv` (zero on entry); `ydot` is f(t, y).
    fn jacobian_times(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        _v: &[f64],
        _jv: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("jacobian_times"))
    }

    /// Prepares to solve (I - gamma df/dy) x = r at (t, y).
    ///
    /// `reuse` allows an older df/dy to be kept (only gamma changed). Returns whether df/dy is
    /// current, that is, was evaluated at this (t, y).
    ///
    /// As the preconditioner of a Krylov method, it may be solved approximately.
    fn newton_setup(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        _gamma: f64,
        _reuse: bool,
    ) -> Result<bool, Failure> {
        Err(missing("newton_setup"))
    }

    /// Replaces the right-hand side `r` by the solution x of the system last set up.
    ///
    /// `gamma` is its present value, which may have changed a little since the setup. It matters to systems
    /// with their own [`newton_rhs`](Self::newton_rhs), and is 0 where `r` was computed with all of
    /// [`rhs`](Self::rhs).
    fn newton_solve(&mut self, _gamma: f64, _r: &mut [f64]) -> Result<(), Failure> {
        Err(missing("newton_solve"))
    }

    /// As [`rhs`](Self::rhs), for the residual y - y0 - gamma f(t, y) of an implicit step, if
    /// [`newton_solve`](Self::newton_solve) solves its linear systems.
    ///
    /// Terms that are omitted here have to be added by `newton_solve` to its right-hand side, times `gamma`.
    /// So M y' = f need not be solved for y' in each iteration: where M is a part of the matrix anyway, the
    /// right-hand side is M r + gamma f. Default: all of `rhs`.
    fn newton_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.rhs(t, y, ydot)
    }

    /// Number of integrals among the unknowns, the last ones: no right-hand side depends on them. Methods may then
    /// leave them out of their matrix and of the error test. Default: none.
    fn integrals(&self) -> usize {
        0
    }

    /// Writes into `correction` (zero on entry) the change from the state `y` to the nearest one that keeps
    /// the invariants of the equations, such as lengths or energy.
    ///
    /// `error` is an estimate of the error of `y`. The part of it that leads away from the invariants is
    /// removed from `y` by the correction; removing it from `error`, too, allows longer steps. It is also
    /// correct to leave `error` unchanged.
    fn project(
        &mut self,
        _t: f64,
        _y: &[f64],
        _correction: &mut [f64],
        _error: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("project"))
    }

    /// Whether f is split into a stiff part and one that is not stiff.
    ///
    /// It is then the sum of [`rhs`](Self::rhs), the stiff part, and [`explicit_rhs`](Self::explicit_rhs).
    /// For the ImEx methods of [`Arkode`](crate::integrators::sundials::Arkode); others refuse such a system.
    /// Default: it is not.
    fn is_split(&self) -> bool {
        false
    }

    /// Writes the part of f(t, y) that is not stiff into `ydot` (zero on entry), if f is
    /// [split](Self::is_split). Jacobians are those of the other part.
    fn explicit_rhs(&mut self, _t: f64, _y: &[f64], _ydot: &mut [f64]) -> Result<(), Failure> {
        Err(missing("explicit_rhs"))
    }

    /// Whether there is a mass matrix M, which makes the equations M y' = f(t, y). Default: there is none.
    ///
    /// [`rhs`](Self::rhs) and the Jacobians are those of f then, and one of the three methods below
    /// writes M, in the form of the matrix that the linear solver works on.
    fn mass_kind(&self) -> MassKind {
        MassKind::Identity
    }

    /// Writes the mass matrix M(t) into the dense matrix `mass` (zero on entry).
    fn dense_mass(&mut self, _t: f64, _mass: MatMut<'_, f64>) -> Result<(), Failure> {
        Err(missing("dense_mass"))
    }

    /// Writes the mass matrix M(t) into the band matrix `mass` (zero on entry), whose band is that of
    /// the linear solver.
    fn banded_mass(&mut self, _t: f64, _mass: BandMut<'_>) -> Result<(), Failure> {
        Err(missing("banded_mass"))
    }

    /// Writes the values of the mass matrix M(t), column by column, for the sparsity pattern that the
    /// linear solver was given (`values` is zero on entry): it has entries for M and df/dy.
    fn sparse_mass(&mut self, _t: f64, _values: &mut [f64]) -> Result<(), Failure> {
        Err(missing("sparse_mass"))
    }

    /// Number of root functions (events); 0 means none.
    fn root_count(&self) -> usize {
        0
    }

    /// Writes the root functions g(t, y) into `g` (zero on entry); the integrator stops where one of them
    /// changes sign.
    fn roots(&mut self, _t: f64, _y: &[f64], _g: &mut [f64]) -> Result<(), Failure> {
        Err(missing("roots"))
    }

    /// Number of integrals that are computed along with the solution; 0 means none.
    fn quadrature_count(&self) -> usize {
        0
    }

    /// Writes the integrands h(t, y) of the integrals q' = h, which are zero at the start, into `qdot` (zero
    /// on entry). No equation depends on them, so that they cost less than further unknowns.
    fn quadratures(&mut self, _t: f64, _y: &[f64], _qdot: &mut [f64]) -> Result<(), Failure> {
        Err(missing("quadratures"))
    }

    /// Writes the right-hand side of the sensitivity s = dy/dp of a parameter p, given by its index among the
    /// [`parameters`](Self::parameters), into `sdot` (zero on entry): (df/dy) s + df/dp. `ydot` is f(t, y).
    fn sensitivity_rhs(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        _parameter: usize,
        _s: &[f64],
        _sdot: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("sensitivity_rhs"))
    }

    /// Writes (df/dy)^T lambda into `out` (zero on entry), for adjoint gradients.
    fn adjoint_rhs(
        &mut self,
        _t: f64,
        _y: &[f64],
        _lambda: &[f64],
        _out: &mut [f64],
    ) -> Result<(), Failure> {
        Err(missing("adjoint_rhs"))
    }

    /// Writes (df/dp)^T lambda into `out` (zero on entry), a number for each of the
    /// [`parameters`](Self::parameters).
    fn adjoint_parameters(
        &mut self,
        _t: f64,
        _y: &[f64],
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

impl<F> Ode for F
where
    F: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
{
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self(t, y, ydot)
    }
}

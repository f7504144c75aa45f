//! What an integrator is given: systems of ordinary differential equations (ODE), of
//! differential-algebraic equations (DAE), and of [second order](SecondOrder).
//!
//! The same traits feed [`crate::sundials`] and the internal Runge-Kutta method `rk`.
//! Any closure `FnMut(t, y, ydot) -> Result<(), Failure>` is an [`Ode`]; [`with_jacobian`] and
//! [`with_sparse_jacobian`] bundle it with a second closure for the Jacobian; a struct implements
//! the trait when it wants to hand over root functions or a linear solver of its own. An
//! integrator owns its system; [`Borrowed`] lends it one instead.

mod second_order;

pub use second_order::{EnergyBalance, Kick, Rates, SecondOrder};

use std::{
    error::Error,
    ops::{Index, IndexMut},
};

use faer::MatMut;

/// Why a callback could not do what it was asked for.
///
/// Any `std` error converts into [`Failure::Fatal`], so `?` works inside callbacks.
#[derive(Debug)]
pub enum Failure {
    /// This trial point is no good (outside the domain, say): retry with a smaller step.
    Recoverable(String),
    /// Stop the integration and hand the error to the caller.
    Fatal(Box<dyn Error + Send + Sync>),
}

impl Failure {
    /// What it has to say, as an error, where there is nothing left to retry.
    pub(crate) fn into_error(self) -> Box<dyn Error + Send + Sync> {
        match self {
            Self::Recoverable(message) => message.into(),
            Self::Fatal(error) => error,
        }
    }
}

impl<E: Error + Send + Sync + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Fatal(Box::new(error))
    }
}

/// A band matrix to be filled: entry (i, j) exists where `j - upper <= i <= j + lower`.
///
/// Indexed like a full matrix, `band[(i, j)] = value`; panics outside the band.
#[derive(Debug)]
pub struct BandMut<'a> {
    data: &'a mut [f64],
    stride: usize,
    diagonal: usize,
    lower: usize,
    upper: usize,
}

impl<'a> BandMut<'a> {
    /// A view of `data`: columns of `stride` numbers each, the diagonal entry at place `diagonal`
    /// of its column.
    ///
    /// # Panics
    /// If a column has no room for the band.
    #[must_use]
    pub fn new(
        data: &'a mut [f64],
        stride: usize,
        diagonal: usize,
        lower: usize,
        upper: usize,
    ) -> Self {
        assert!(
            upper <= diagonal && diagonal + lower < stride && data.len().is_multiple_of(stride)
        );
        Self { data, stride, diagonal, lower, upper }
    }

    /// Diagonals below the main one.
    #[must_use]
    pub fn lower(&self) -> usize {
        self.lower
    }

    /// Diagonals above the main one.
    #[must_use]
    pub fn upper(&self) -> usize {
        self.upper
    }

    fn place(&self, (i, j): (usize, usize)) -> usize {
        assert!(
            i <= j + self.lower && j <= i + self.upper && i < self.data.len() / self.stride,
            "entry ({i}, {j}) lies outside the band of {} lower and {} upper diagonals",
            self.lower,
            self.upper
        );
        j * self.stride + self.diagonal + i - j
    }
}

impl Index<(usize, usize)> for BandMut<'_> {
    type Output = f64;

    fn index(&self, entry: (usize, usize)) -> &f64 {
        &self.data[self.place(entry)]
    }
}

impl IndexMut<(usize, usize)> for BandMut<'_> {
    fn index_mut(&mut self, entry: (usize, usize)) -> &mut f64 {
        let place = self.place(entry);
        &mut self.data[place]
    }
}

/// y' = f(t, y).
///
/// Only [`rhs`](Self::rhs) is required. The other methods are called when the integrator was
/// configured to use them; their defaults fail with [`Failure::Fatal`].
pub trait Ode {
    /// Writes f(t, y) into `ydot` (same length as `y`).
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure>;

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

    /// Prepares to solve (I - gamma df/dy) x = r at (t, y).
    ///
    /// `reuse` allows an older df/dy to be kept (only gamma changed). Returns whether df/dy is
    /// current, that is, was evaluated at this (t, y).
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
    /// `gamma` is the step parameter by now, which may have changed a little since then. It matters
    /// to systems with a [`newton_rhs`](Self::newton_rhs) of their own.
    fn newton_solve(&mut self, _gamma: f64, _r: &mut [f64]) -> Result<(), Failure> {
        Err(missing("newton_solve"))
    }

    /// As [`rhs`](Self::rhs), for the residual y - y0 - gamma f(t, y) of an implicit step, if
    /// [`newton_solve`](Self::newton_solve) solves its linear systems.
    ///
    /// What is left out here, `newton_solve` has to add to its right-hand side, times `gamma`. So M y' = f
    /// need not be solved for y' in each iteration, only for M x = M r + gamma f where M is a part
    /// of the matrix anyway. Default: all of `rhs`.
    fn newton_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.rhs(t, y, ydot)
    }

    /// Number of root functions (events); 0 means none.
    fn root_count(&self) -> usize {
        0
    }

    /// Writes the root functions g(t, y); the integrator stops where one of them changes sign.
    fn roots(&mut self, _t: f64, _y: &[f64], _g: &mut [f64]) -> Result<(), Failure> {
        Err(missing("roots"))
    }
}

impl<F> Ode for F
where
    F: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
{
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self(t, y, ydot)
    }
}

/// F(t, y, y') = 0.
///
/// Only [`residual`](Self::residual) is required, as in [`Ode`].
pub trait Dae {
    /// Writes F(t, y, y') into `residual`.
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure>;

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

    /// Prepares to solve (dF/dy + cj dF/dy') x = r.
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

    /// Writes the root functions g(t, y, y').
    fn roots(&mut self, _t: f64, _y: &[f64], _yp: &[f64], _g: &mut [f64]) -> Result<(), Failure> {
        Err(missing("roots"))
    }
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

/// A system lent to an integrator, which otherwise owns it.
///
/// (`&mut` of a struct can not be a system by itself: closures already are, and Rust takes
/// `&mut closure` for a closure.)
#[derive(Debug)]
pub struct Borrowed<'a, S: ?Sized>(pub &'a mut S);

impl<S: Ode + ?Sized> Ode for Borrowed<'_, S> {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.0.rhs(t, y, ydot)
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.0.dense_jacobian(t, y, ydot, jacobian)
    }

    fn banded_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        self.0.banded_jacobian(t, y, ydot, jacobian)
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.0.sparse_jacobian(t, y, ydot, values)
    }

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

    fn root_count(&self) -> usize {
        self.0.root_count()
    }

    fn roots(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        self.0.roots(t, y, g)
    }
}

impl<S: Dae + ?Sized> Dae for Borrowed<'_, S> {
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
}

fn missing(method: &'static str) -> Failure {
    Failure::Fatal(
        format!("the integrator was configured to call `{method}`, which this system lacks").into(),
    )
}

#[cfg(test)]
mod tests {
    use super::BandMut;

    #[test]
    fn a_band_stores_its_columns_one_after_another() {
        // Two lower diagonals, one upper, and one more row above them, as LU needs it.
        let mut data = [0.0; 5 * 4];
        let mut band = BandMut::new(&mut data, 5, 2, 2, 1);
        for (i, j) in [(0, 0), (2, 0), (0, 1), (3, 1), (2, 3)] {
            band[(i, j)] = (10 * i + j) as f64 + 0.5;
        }
        assert_eq!(band[(3, 1)], 31.5);
        let expected = [
            [0.0, 0.0, 0.5, 0.0, 20.5],
            [0.0, 1.5, 0.0, 0.0, 31.5],
            [0.0; 5],
            [0.0, 23.5, 0.0, 0.0, 0.0],
        ];
        assert_eq!(data, *expected.as_flattened());
    }

    #[test]
    #[should_panic(expected = "entry (0, 2) lies outside the band")]
    fn outside_the_band_there_is_nothing() {
        let mut data = [0.0; 20];
        BandMut::new(&mut data, 5, 2, 2, 1)[(0, 2)] = 1.0;
    }
}

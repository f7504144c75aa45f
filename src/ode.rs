//! What an integrator is given: systems of ordinary differential equations (ODE) and of
//! differential-algebraic equations (DAE).
//!
//! The same traits feed [`crate::sundials`] and the internal Runge-Kutta method [`crate::rk`].
//! Any closure `FnMut(t, y, ydot) -> Result<(), Failure>` is an [`Ode`]; a struct implements the
//! trait when it wants to hand over Jacobians, root functions or a linear solver of its own.

use std::error::Error;

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

impl<E: Error + Send + Sync + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Fatal(Box::new(error))
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
    fn newton_solve(&mut self, _r: &mut [f64]) -> Result<(), Failure> {
        Err(missing("newton_solve"))
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

fn missing(method: &'static str) -> Failure {
    Failure::Fatal(
        format!("the integrator was configured to call `{method}`, which this system lacks").into(),
    )
}

//! Residuals as systems for integrators.

use faer::MatMut;

use super::{number::Number, system::Automatic, workspace::Workspace};
use crate::integrators::ode::{BandMut, Dae, Entries, Failure, Storage};

/// F(t, y, y', p) = 0, written over a number type.
///
/// ```
/// use pliant::{
///     automatic::{Number, Residual, automatic},
///     ode::Failure,
///     solve::{Method, Options, Problem, solve},
/// };
///
/// /// Robertson's reactions with a conservation law in place of the third.
/// struct Robertson;
///
/// impl Residual for Robertson {
///     fn residual<T: Number>(
///         &mut self,
///         _t: f64,
///         y: &[T],
///         yp: &[T],
///         p: &[T],
///         residual: &mut [T],
///     ) -> Result<(), Failure> {
///         let exchange = p[0] * y[0] - p[1] * y[1] * y[2];
///         residual[0] = yp[0] + exchange;
///         residual[1] = yp[1] - exchange + p[2] * y[1] * y[1];
///         residual[2] = y[0] + y[1] + y[2] - 1.0;
///         Ok(())
///     }
/// }
///
/// let reactions = automatic(Robertson, [0.04, 1e4, 3e7]);
/// let problem = Problem::dae(reactions, [1.0, 0.0, 0.0], [-0.04, 0.04, 0.0]);
/// let solution = solve(problem, Method::Ida, (0.0, 40.0), &Options::new(1e-8, 1e-14))?;
/// // published: 0.7158270688
/// assert!((solution.last()[0] - 0.715_827_068_8).abs() < 1e-7);
/// assert_eq!(solution.statistics().difference_quotient_evaluations, 0);
/// # Ok::<(), pliant::solve::Error>(())
/// ```
pub trait Residual {
    /// Writes F(t, y, y', p) into `residual` (same length as `y`, zero on entry).
    ///
    /// # Errors
    /// As [`Dae::residual`].
    fn residual<T: Number>(
        &mut self,
        t: f64,
        y: &[T],
        yp: &[T],
        p: &[T],
        residual: &mut [T],
    ) -> Result<(), Failure>;
}

fn evaluate<E: Residual, const N: usize>(
    equations: &mut E,
    t: f64,
    at: &mut Workspace<N>,
) -> Result<(), Failure> {
    equations.residual(t, &at.y, &at.yp, &at.p, &mut at.f)
}

impl<E: Residual> Dae for Automatic<E> {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self.equations.residual(t, y, yp, &self.parameters, residual)
    }

    fn supplied_jacobian(&self) -> Option<Storage<'_>> {
        Some(self.storage())
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.fill((t, y, yp), cj, evaluate, Entries::Dense(jacobian))
    }

    fn banded_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        self.check_band(&jacobian)?;
        self.fill((t, y, yp), cj, evaluate, Entries::Band(jacobian))
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.check_sparse(values)?;
        self.fill((t, y, yp), cj, evaluate, Entries::Sparse(values))
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
        self.along((t, y, yp), (v, cj, v), None, evaluate, jv)
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
        self.along((t, y, yp), (s, 1.0, sp), Some(parameter), evaluate, residual)
    }

    fn adjoint_residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        lambda: &[f64],
        mu: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.add_transposed((t, y, yp), [1.0, 0.0], evaluate, lambda, out)?;
        self.add_transposed((t, y, yp), [0.0, 1.0], evaluate, mu, out)
    }

    fn adjoint_parameters(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.by_parameters((t, y, yp), evaluate, lambda, out)
    }

    fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.parameters.copy_from_slice(values);
    }
}

//! Bodies with linear forces as dense matrices, for what scenes do not offer: steps of a fixed size,
//! constraints without stabilization, other forms of the equations, other options of SUNDIALS.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, Side, c64};
use pliant::Body;
use pliant::ode::{Failure, Ode};

use super::Outcome;

/// M a + B v + K u = 0 at the degrees of freedom that are free.
pub struct Linear {
    /// Inertia (kg).
    pub inertia: Mat<f64>,
    /// Stiffness (N/m).
    pub stiffness: Mat<f64>,
    /// Damping (N s/m).
    pub damping: Mat<f64>,
}

impl Linear {
    /// The matrices of `body` at all degrees of freedom but those of the nodes `held` (from 0).
    pub fn new(body: &Body, held: &[usize]) -> Self {
        let d = body.dimension();
        let free: Vec<usize> = (0..body.dofs()).filter(|dof| !held.contains(&(dof / d))).collect();
        let matrix = |entry: &dyn Fn(usize, usize) -> f64| {
            Mat::from_fn(free.len(), free.len(), |i, j| entry(free[i], free[j]))
        };
        let inertia = |i: usize, j: usize| match i % d == j % d {
            true => body.inertia().get(i / d, j / d),
            false => 0.0,
        };
        Self {
            inertia: matrix(&inertia),
            stiffness: matrix(&|i, j| body.stiffness().get(i, j)),
            damping: matrix(&|i, j| body.damping().get(i, j)),
        }
    }

    /// Number of free degrees of freedom.
    pub fn size(&self) -> usize {
        self.inertia.nrows()
    }

    /// The matrix J of y' = J y, y = (u, v).
    pub fn jacobian(&self) -> Mat<f64> {
        let n = self.size();
        let inverse = PartialPivLu::new(self.inertia.as_ref());
        let (from_u, from_v) = (inverse.solve(&self.stiffness), inverse.solve(&self.damping));
        Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, _) => f64::from(j == n + i),
            (false, true) => -from_u[(i - n, j)],
            (false, false) => -from_v[(i - n, j - n)],
        })
    }

    /// The eigenvalues of J (1/s).
    pub fn eigenvalues(&self) -> Outcome<Vec<c64>> {
        Ok(self.jacobian().eigenvalues().map_err(|error| format!("{error:?}"))?)
    }

    /// Largest |eigenvalue| of J (1/s).
    pub fn spectral_radius(&self) -> Outcome<f64> {
        Ok(self.eigenvalues()?.iter().map(|value| value.norm()).fold(0.0, f64::max))
    }

    /// Lowest angular frequency (rad/s) without damping.
    pub fn lowest_frequency(&self) -> Outcome<f64> {
        let inverse = PartialPivLu::new(self.stiffness.as_ref());
        let values = inverse.solve(&self.inertia).eigenvalues();
        let values = values.map_err(|error| format!("{error:?}"))?;
        Ok(values.iter().map(|value| value.re).fold(0.0, f64::max).powf(-0.5))
    }

    /// Largest over least eigenvalue of K.
    pub fn condition(&self) -> Outcome<f64> {
        let values = self.stiffness.self_adjoint_eigenvalues(Side::Lower);
        let values = values.map_err(|error| format!("{error:?}"))?;
        Ok(values[values.len() - 1] / values[0])
    }
}

/// y' = J y.
#[derive(Clone)]
pub struct Dense(pub Mat<f64>);

impl Ode for Dense {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.fill(0.0);
        for (j, y) in y.iter().enumerate() {
            let column = self.0.col_as_slice(j);
            ydot.iter_mut().zip(column).for_each(|(ydot, entry)| *ydot += entry * y);
        }
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        mut jacobian: faer::MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        jacobian.copy_from(&self.0);
        Ok(())
    }
}

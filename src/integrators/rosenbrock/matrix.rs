//! The matrix I - gamma h J of a step.

use std::fmt;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Mat, MatMut, Par, Spec};

use crate::integrators::common::{Error, Tolerances};
use crate::integrators::ode::{Failure, Ode, call};
use crate::integrators::sundials::{self, Jacobian, LinearSolver, NewtonMatrix};

/// J and the factors of I - gamma h J.
#[derive(Debug)]
pub(super) enum Matrix {
    /// By faer, whose factorization of a large dense matrix is the faster one.
    Dense(Box<Dense>),
    /// Sparse, or of band form.
    Stored(Box<NewtonMatrix>),
}

impl Matrix {
    /// The matrix of `solver`, for `n` unknowns; `None` if the system has its own linear solver.
    pub(super) fn new(
        solver: &LinearSolver,
        n: usize,
        tolerances: &Tolerances,
    ) -> Result<Option<Self>, Error> {
        solver.check(n)?;
        Ok(match solver {
            LinearSolver::Custom => None,
            LinearSolver::Dense(_) => {
                Some(Self::Dense(Box::new(Dense::new(solver, n, tolerances))))
            }
            _ => Some(Self::Stored(Box::new(NewtonMatrix::new(solver, n, tolerances)?))),
        })
    }

    /// Evaluates J at (t, y), where `at` is y and f(t, y). Returns how often f was evaluated.
    pub(super) fn update<S: Ode>(
        &mut self,
        system: &mut S,
        t: f64,
        at: [&[f64]; 2],
    ) -> Result<u64, Failure> {
        match self {
            Self::Dense(dense) => dense.update(system, t, at),
            Self::Stored(stored) => stored.update(system, t, at),
        }
    }

    /// The first number of J that is not finite, column by column, with its place.
    pub(super) fn not_finite(&self) -> Option<(usize, f64)> {
        let values = match self {
            Self::Dense(dense) => &dense.jacobian,
            Self::Stored(stored) => stored.values(),
        };
        let place = values.iter().position(|value| !value.is_finite())?;
        Some((place, values[place]))
    }

    /// Writes the product of J with `v`.
    pub(super) fn multiply(&self, v: &[f64], out: &mut [f64]) {
        match self {
            Self::Dense(dense) => {
                out.fill(0.0);
                for (column, v) in dense.jacobian.chunks_exact(v.len()).zip(v) {
                    out.iter_mut().zip(column).for_each(|(out, entry)| *out += entry * v);
                }
            }
            Self::Stored(stored) => stored.multiply(v, out),
        }
    }

    /// Factorizes I - gamma J; `false` if it is singular.
    pub(super) fn factorize(&mut self, gamma: f64) -> bool {
        match self {
            Self::Dense(dense) => dense.factorize(gamma),
            Self::Stored(stored) => stored.factorize(gamma),
        }
    }

    /// Replaces `r` by the solution; returns whether there is one.
    pub(super) fn solve(&mut self, r: &mut [f64]) -> bool {
        match self {
            Self::Dense(dense) => {
                dense.solve(r);
                true
            }
            Self::Stored(stored) => stored.solve(r),
        }
    }
}

/// A dense matrix.
pub(super) struct Dense {
    /// Column by column.
    jacobian: Vec<f64>,
    /// None if the system supplies it.
    differences: Option<sundials::Differences>,
    factors: Mat<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    memory: MemBuffer,
}

impl fmt::Debug for Dense {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Dense").field("jacobian", &self.jacobian).finish_non_exhaustive()
    }
}

impl Dense {
    fn new(solver: &LinearSolver, n: usize, tolerances: &Tolerances) -> Self {
        let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Spec::default())
            .or(solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq));
        let differences = match solver {
            LinearSolver::Dense(Jacobian::DifferenceQuotients) => {
                sundials::Differences::of_ode(solver, n, tolerances, &[])
            }
            _ => None,
        };
        Self {
            jacobian: vec![0.0; n * n],
            differences,
            factors: Mat::zeros(n, n),
            forward: vec![0; n],
            inverse: vec![0; n],
            memory: MemBuffer::new(scratch),
        }
    }

    fn update<S: Ode>(
        &mut self,
        system: &mut S,
        t: f64,
        [y, slope]: [&[f64]; 2],
    ) -> Result<u64, Failure> {
        let (n, values) = (y.len(), &mut self.jacobian);
        let Some(differences) = &mut self.differences else {
            values.fill(0.0);
            let matrix = MatMut::from_column_major_slice_mut(values, n, n);
            return system.dense_jacobian(t, y, slope, matrix).map(|()| 0);
        };
        let before = differences.evaluations;
        differences.of_rhs(y, slope, values, &mut |y, ydot| call::rhs(system, t, y, ydot))?;
        Ok(differences.evaluations - before)
    }

    fn factorize(&mut self, gamma: f64) -> bool {
        let n = self.forward.len();
        for j in 0..n {
            let column = self.factors.col_as_slice_mut(j);
            for (entry, slope) in column.iter_mut().zip(&self.jacobian[j * n..][..n]) {
                *entry = -gamma * slope;
            }
            column[j] += 1.0;
        }
        factor::lu_in_place(
            self.factors.as_mut(),
            &mut self.forward,
            &mut self.inverse,
            Par::Seq,
            MemStack::new(&mut self.memory),
            Spec::default(),
        );
        (0..n).all(|i| self.factors[(i, i)] != 0.0)
    }

    fn solve(&mut self, r: &mut [f64]) {
        let n = r.len();
        solve::solve_in_place(
            self.factors.as_ref(),
            self.factors.as_ref(),
            PermRef::new_checked(&self.forward, &self.inverse, n),
            MatMut::from_column_major_slice_mut(r, n, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }
}

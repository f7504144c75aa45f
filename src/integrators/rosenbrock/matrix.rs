//! The matrix I - gamma h J of a step.

use std::fmt;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Mat, MatMut, Par, Spec};

use crate::integrators::common::{Error, Tolerances};
use crate::integrators::ode::{Failure, Ode, call};
use crate::integrators::sundials::{self, Differences, LinearSolver, StoredMatrix};

/// J and the factors of I - gamma h J.
pub(super) struct Matrix {
    jacobian: StoredMatrix,
    /// None if the system supplies J.
    differences: Option<Differences>,
    factors: Factors,
}

enum Factors {
    /// By faer, whose factorization of a large dense matrix is the faster one.
    Dense(Box<Dense>),
    /// Sparse, or of band form.
    Sundials(Box<sundials::Factors>),
}

impl fmt::Debug for Matrix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Matrix").field("jacobian", &self.jacobian).finish_non_exhaustive()
    }
}

impl Matrix {
    /// The matrix of `solver`, for `n` unknowns; `None` if the system has its own linear solver.
    pub(super) fn new(
        solver: &LinearSolver,
        n: usize,
        tolerances: &Tolerances,
    ) -> Result<Option<Self>, Error> {
        solver.check(n)?;
        let factors = match solver {
            LinearSolver::Custom => return Ok(None),
            LinearSolver::Dense(_) => Factors::Dense(Box::new(Dense::new(n))),
            _ => Factors::Sundials(Box::new(sundials::Factors::new(solver, n)?)),
        };
        let differences = match solver.takes_quotients() {
            true => Differences::of_ode(solver, n, tolerances, &[]),
            false => None,
        };
        Ok(Some(Self { jacobian: StoredMatrix::new(solver, n), differences, factors }))
    }

    /// Evaluates J at (t, y), where `at` is y and f(t, y). Returns how often f was evaluated.
    pub(super) fn update<S: Ode>(
        &mut self,
        system: &mut S,
        t: f64,
        [y, slope]: [&[f64]; 2],
    ) -> Result<u64, Failure> {
        let Some(differences) = &mut self.differences else {
            return self.jacobian.entries().jacobian(system, t, y, slope).map(|()| 0);
        };
        let before = differences.evaluations;
        let values = self.jacobian.values_mut();
        differences.of_rhs(y, slope, values, &mut |y, ydot| call::rhs(system, t, y, ydot))?;
        Ok(differences.evaluations - before)
    }

    /// The first number of J that is not finite, column by column, with its place.
    pub(super) fn not_finite(&self) -> Option<(usize, f64)> {
        let values = self.jacobian.values();
        let place = values.iter().position(|value| !value.is_finite())?;
        Some((place, values[place]))
    }

    /// Whether J has space for an entry.
    pub(super) fn stores(&self, row: usize, column: usize) -> bool {
        self.jacobian.stores(row, column)
    }

    /// Writes the product of J with `v`.
    pub(super) fn multiply(&self, v: &[f64], out: &mut [f64]) {
        self.jacobian.multiply(v, out);
    }

    /// Factorizes I - gamma J; `false` if it is singular.
    pub(super) fn factorize(&mut self, gamma: f64) -> bool {
        match &mut self.factors {
            Factors::Dense(dense) => dense.factorize(self.jacobian.values(), gamma),
            Factors::Sundials(factors) => factors.factorize(&self.jacobian, gamma),
        }
    }

    /// Replaces `r` by the solution; returns whether there is one.
    pub(super) fn solve(&mut self, r: &mut [f64]) -> bool {
        match &mut self.factors {
            Factors::Dense(dense) => {
                dense.solve(r);
                true
            }
            Factors::Sundials(factors) => factors.solve(r),
        }
    }
}

/// The factors of a dense matrix.
struct Dense {
    factors: Mat<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    memory: MemBuffer,
}

impl Dense {
    fn new(n: usize) -> Self {
        let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Spec::default())
            .or(solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq));
        Self {
            factors: Mat::zeros(n, n),
            forward: vec![0; n],
            inverse: vec![0; n],
            memory: MemBuffer::new(scratch),
        }
    }

    fn factorize(&mut self, jacobian: &[f64], gamma: f64) -> bool {
        let n = self.forward.len();
        for j in 0..n {
            let column = self.factors.col_as_slice_mut(j);
            for (entry, slope) in column.iter_mut().zip(&jacobian[j * n..][..n]) {
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

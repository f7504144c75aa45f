//! The matrix I - gamma h J of a step.

use std::fmt;

use crate::integrators::common::{Error, Tolerances};
use crate::integrators::ode::{Failure, Ode, call};
use crate::integrators::sundials::{Differences, Factors, LinearSolver, StoredMatrix};

/// J and the factors of I - gamma h J.
pub(super) struct Matrix {
    jacobian: StoredMatrix,
    /// None if the system supplies J.
    differences: Option<Differences>,
    factors: Factors,
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
        if matches!(solver, LinearSolver::Custom) {
            return Ok(None);
        }
        let factors = Factors::new(solver, n)?;
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
        self.factors.factorize(&self.jacobian, gamma)
    }

    /// Replaces `r` by the solution; returns whether there is one.
    pub(super) fn solve(&mut self, r: &mut [f64]) -> bool {
        self.factors.solve(r)
    }
}

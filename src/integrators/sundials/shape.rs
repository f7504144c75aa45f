//! Stored entries of a matrix, and their order.

use std::ops::Range;

use super::{colouring::Colouring, linear_solver::LinearSolver, pattern::Pattern};

/// The entries that a linear solver stores of a matrix, column by column.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Dense,
    Band { lower: usize, upper: usize },
    Sparse(Pattern),
}

impl Shape {
    /// The shape of the matrix, or of the preconditioner's matrix; none if there is neither.
    pub(crate) fn of(solver: &LinearSolver) -> Option<Self> {
        match (solver, solver.ilu()) {
            (LinearSolver::Dense(_), _) => Some(Self::Dense),
            (&LinearSolver::Band { lower, upper, .. }, _) => Some(Self::Band { lower, upper }),
            (LinearSolver::Klu { pattern, .. }, _) | (_, Some((pattern, _))) => {
                Some(Self::Sparse(pattern.clone()))
            }
            _ => None,
        }
    }

    /// Which of the `n` columns can share one evaluation of the function for their difference quotients.
    pub(crate) fn colouring(&self, n: usize) -> Colouring {
        match self {
            Self::Dense => Colouring::every(n, n),
            Self::Band { lower, upper } => Colouring::every(n, lower + upper + 1),
            Self::Sparse(pattern) => Colouring::new(pattern),
        }
    }

    /// Count of numbers that a matrix with `n` columns stores, without space for pivots.
    pub(crate) fn stored(&self, n: usize) -> usize {
        match self {
            Self::Dense => n * n,
            Self::Band { lower, upper } => n * (lower + upper + 1),
            Self::Sparse(pattern) => pattern.entry_count(),
        }
    }

    /// Positions of the entries of column `j` among the `stored` numbers of a matrix with `n` columns.
    pub(crate) fn positions(&self, j: usize, n: usize, stored: usize) -> Range<usize> {
        match self {
            Self::Dense => j * n..(j + 1) * n,
            Self::Band { lower, upper } => {
                let stride = stored / n;
                // space for pivots may lie above the band
                let diagonal = j * stride + stride - lower - 1;
                diagonal - upper.min(&j)..diagonal + (n - j).min(lower + 1)
            }
            Self::Sparse(pattern) => pattern.positions(j),
        }
    }

    /// Row of the `k`-th entry of column `j`.
    pub(crate) fn row(&self, j: usize, k: usize) -> usize {
        match self {
            Self::Dense => k,
            Self::Band { upper, .. } => j - upper.min(&j) + k,
            Self::Sparse(pattern) => pattern.column(j)[k] as usize,
        }
    }

    /// Whether entry (i, j) is stored.
    pub(super) fn stores(&self, i: usize, j: usize) -> bool {
        match self {
            Self::Dense => true,
            Self::Band { lower, upper } => i <= j + lower && j <= i + upper,
            Self::Sparse(pattern) => pattern.position(i, j).is_some(),
        }
    }

    /// Calls `visit` with the row, column and position of each entry.
    pub(super) fn each(&self, n: usize, stored: usize, mut visit: impl FnMut(usize, usize, usize)) {
        for j in 0..n {
            for (k, position) in self.positions(j, n, stored).enumerate() {
                visit(self.row(j, k), j, position);
            }
        }
    }

    /// Writes the product of the matrix with `v`.
    pub(super) fn multiply(&self, values: &[f64], v: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.each(v.len(), values.len(), |i, j, position| out[i] += values[position] * v[j]);
    }
}

#[cfg(test)]
mod tests {
    use super::{Pattern, Shape};

    /// A band with and without space for pivots, and the same as a sparse matrix.
    #[test]
    fn bands_are_sparse_matrices() {
        for (n, lower, upper) in [(6, 1, 2), (4, 3, 0), (5, 4, 4), (1, 0, 0)] {
            let pattern = Pattern::band(n, lower, upper).unwrap();
            let (band, sparse) = (Shape::Band { lower, upper }, Shape::Sparse(pattern.clone()));
            let entry = |i: usize, j: usize| (1 + i * n + j) as f64;
            let v: Vec<f64> = (0..n).map(|j| 1.0 + j as f64).collect();
            let product = |shape: &Shape, stored: usize| {
                let (mut values, mut out) = (vec![f64::NAN; stored], vec![0.0; n]);
                shape.each(n, stored, |i, j, position| values[position] = entry(i, j));
                shape.multiply(&values, &v, &mut out);
                out
            };
            let expected = product(&sparse, pattern.entry_count());
            for space in [0, lower.min(n - 1 - upper)] {
                assert_eq!(product(&band, n * (lower + upper + 1 + space)), expected);
            }
        }
    }
}

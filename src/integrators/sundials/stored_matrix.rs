//! Matrices that are stored in addition to the one that a linear solver factorizes.

use crate::base::input::InputError;
use crate::integrators::{
    ode::{Entries, Failure},
    sundials::{Jacobian, LinearSolver, colouring::Colouring, shape::Shape},
};

/// A matrix in the form of a linear solver.
#[derive(Clone, Debug)]
pub(crate) struct StoredMatrix {
    solver: LinearSolver,
    shape: Shape,
    n: usize,
    values: Vec<f64>,
}

impl StoredMatrix {
    /// An `n` x `n` matrix of zeros.
    pub(crate) fn new(solver: &LinearSolver, n: usize) -> Self {
        let count = match solver {
            LinearSolver::Dense(_) => n * n,
            LinearSolver::Band { lower, upper, .. } => n * (lower + upper + 1),
            LinearSolver::Klu { pattern, .. } => pattern.entry_count(),
            LinearSolver::Krylov(krylov) => krylov.ilu().map_or(0, |(ilu, _)| ilu.entry_count()),
            LinearSolver::Custom => 0,
        };
        let shape = Shape::of(solver).unwrap_or(Shape::Dense);
        Self { solver: solver.clone(), shape, n, values: vec![0.0; count] }
    }

    /// The linear solver for transposed matrices.
    pub(crate) fn backward_solver(&self) -> Result<LinearSolver, InputError> {
        match &self.solver {
            LinearSolver::Dense(_) => Ok(LinearSolver::Dense(Jacobian::Supplied)),
            LinearSolver::Band { lower, upper, .. } => Ok(LinearSolver::Band {
                lower: *upper,
                upper: *lower,
                jacobian: Jacobian::Supplied,
            }),
            LinearSolver::Klu { pattern, .. } => {
                let (pattern, jacobian) = (pattern.transposed(), Jacobian::Supplied);
                Ok(LinearSolver::Klu { pattern, jacobian })
            }
            LinearSolver::Krylov(krylov) => Ok(LinearSolver::Krylov(krylov.transposed()?)),
            LinearSolver::Custom => {
                let help = "an adjoint gradient needs entries of the Jacobian, or transposed products: choose a \
                            dense, a band or a sparse linear solver, or a Krylov method";
                Err(InputError::new("linear solver", "Custom", help))
            }
        }
    }

    /// Whether entry (i, j) is stored.
    pub(crate) fn stores(&self, i: usize, j: usize) -> bool {
        self.shape.stores(i, j)
    }

    /// Its entries, set to zero and to be filled.
    pub(crate) fn entries(&mut self) -> Entries<'_> {
        self.values.fill(0.0);
        self.solver.entries(self.n, &mut self.values)
    }

    /// The stored entries.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The same, to be written.
    pub(crate) fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Writes its product with `v`.
    pub(crate) fn multiply(&self, v: &[f64], out: &mut [f64]) {
        self.shape.multiply(&self.values, v, out);
    }

    /// Writes I - gamma J into the matrix of its own linear solver, which is zero before.
    pub(crate) fn write_shifted(&self, gamma: f64, mut entries: Entries<'_>) {
        self.each_position(|i, j, position| {
            let unit = if i == j { 1.0 } else { 0.0 };
            entries.set((i, j), position, unit - gamma * self.values[position]);
        });
    }

    /// Calls `visit` with row, column and value of each entry.
    pub(crate) fn each(&self, mut visit: impl FnMut(usize, usize, f64)) {
        self.each_position(|i, j, position| visit(i, j, self.values[position]));
    }

    /// Calls `visit` with row, column and position among the values of each entry.
    pub(crate) fn each_position(&self, visit: impl FnMut(usize, usize, usize)) {
        self.shape.each(self.n, self.values.len(), visit);
    }

    /// Adds `factor` J^T lambda.
    pub(crate) fn add_transposed_times(&self, factor: f64, lambda: &[f64], out: &mut [f64]) {
        self.each(|i, j, value| out[j] += factor * value * lambda[i]);
    }

    /// Writes the transpose of another matrix of this form, whose entries are `value(row, position)`, into the
    /// matrix of `backward`, the linear solver for transposed matrices.
    pub(crate) fn write_transposed(
        &self,
        backward: &LinearSolver,
        mut entries: Entries<'_>,
        value: impl Fn(usize, usize) -> f64,
    ) {
        self.each_position(|i, j, position| {
            let to = match (backward, backward.ilu()) {
                (LinearSolver::Klu { pattern, .. }, _) | (_, Some((pattern, _))) => {
                    pattern.position(j, i)
                }
                _ => Some(position),
            };
            if let Some(to) = to {
                entries.set((j, i), to, value(i, position));
            }
        });
    }
}

/// Difference quotients for matrices of one form.
pub(crate) struct Quotients {
    colouring: Colouring,
    /// Unknowns shifted, and two results.
    moved: Vec<f64>,
    ahead: Vec<f64>,
    behind: Vec<f64>,
}

impl Quotients {
    /// For matrices of the form of this one.
    pub(crate) fn new(matrix: &StoredMatrix) -> Self {
        let vector = || vec![0.0; matrix.n];
        let colouring = matrix.shape.colouring(matrix.n);
        Self { colouring, moved: vector(), ahead: vector(), behind: vector() }
    }

    /// Makes `matrix` the Jacobian of `evaluate` at `x`, by central differences with these steps, of as many
    /// columns at once as share no row.
    pub(crate) fn write(
        &mut self,
        matrix: &mut StoredMatrix,
        x: &[f64],
        step: impl Fn(usize) -> f64,
        mut evaluate: impl FnMut(&[f64], &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let StoredMatrix { shape, n, values, .. } = matrix;
        values.fill(0.0);
        for colour in 0..self.colouring.count() {
            let columns = self.colouring.columns(colour);
            for (sign, result) in [(1.0, &mut self.ahead), (-1.0, &mut self.behind)] {
                self.moved.copy_from_slice(x);
                columns.iter().for_each(|&j| self.moved[j] += sign * step(j));
                evaluate(&self.moved, result)?;
            }
            for &j in columns {
                let distance = (x[j] + step(j)) - (x[j] - step(j));
                for (k, position) in shape.positions(j, *n, values.len()).enumerate() {
                    let i = shape.row(j, k);
                    values[position] = (self.ahead[i] - self.behind[i]) / distance;
                }
            }
        }
        Ok(())
    }
}

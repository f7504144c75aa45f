//! The Jacobian df/dy, evaluated for products with its transpose.

use faer::MatMut;

use crate::{
    input::InputError,
    ode::{BandMut, Failure, Ode},
    sundials::{Jacobian, LinearSolver, Pattern, matrix::Entries},
};

/// The Jacobian at one point, stored as the linear solver of the run forward has it.
pub(super) struct StoredJacobian {
    forward: LinearSolver,
    n: usize,
    values: Vec<f64>,
    /// Unknowns moved for difference quotients, and two results.
    moved: Vec<f64>,
    ahead: Vec<f64>,
    behind: Vec<f64>,
}

impl StoredJacobian {
    pub(super) fn new(forward: &LinearSolver, n: usize) -> Self {
        let count = match forward {
            LinearSolver::Dense(_) => n * n,
            LinearSolver::Band { lower, upper, .. } => n * (lower + upper + 1),
            LinearSolver::Klu(pattern) => pattern.entry_count(),
            _ => 0,
        };
        let vector = || vec![0.0; n];
        let (moved, ahead, behind) = (vector(), vector(), vector());
        Self { forward: forward.clone(), n, values: vec![0.0; count], moved, ahead, behind }
    }

    /// The linear solver for -J^T.
    pub(super) fn backward_solver(&self) -> Result<LinearSolver, InputError> {
        match &self.forward {
            LinearSolver::Dense(_) => Ok(LinearSolver::Dense(Jacobian::Supplied)),
            LinearSolver::Band { lower, upper, .. } => Ok(LinearSolver::Band {
                lower: *upper,
                upper: *lower,
                jacobian: Jacobian::Supplied,
            }),
            LinearSolver::Klu(pattern) => {
                let mut entries = Vec::new();
                each_place(pattern, |i, j, _| entries.push((j, i)));
                Ok(LinearSolver::Klu(Pattern::from_entries(self.n, entries)?))
            }
            other => {
                let mend = "an adjoint gradient needs entries of the Jacobian: choose a dense, a band or a \
                            sparse linear solver";
                Err(InputError::new("linear solver", format!("{other:?}"), mend))
            }
        }
    }

    /// Evaluates it at (t, y). `size` is the size of an unknown, for difference quotients.
    pub(super) fn evaluate<S: Ode>(
        &mut self,
        system: &mut S,
        t: f64,
        y: &[f64],
        size: impl Fn(usize) -> f64,
    ) -> Result<(), Failure> {
        let n = self.n;
        self.values.fill(0.0);
        let quotients = match &self.forward {
            LinearSolver::Dense(jacobian) | LinearSolver::Band { jacobian, .. } => {
                *jacobian == Jacobian::DifferenceQuotients
            }
            _ => false,
        };
        if quotients {
            return self.quotients(system, t, y, size);
        }
        system.rhs(t, y, &mut self.ahead)?;
        match &self.forward {
            LinearSolver::Dense(_) => {
                let matrix = MatMut::from_column_major_slice_mut(&mut self.values, n, n);
                system.dense_jacobian(t, y, &self.ahead, matrix)
            }
            LinearSolver::Band { lower, upper, .. } => {
                let (stride, values) = (lower + upper + 1, &mut self.values);
                let band = BandMut::new(values, stride, *upper, *lower, *upper);
                system.banded_jacobian(t, y, &self.ahead, band)
            }
            _ => system.sparse_jacobian(t, y, &self.ahead, &mut self.values),
        }
    }

    /// Central differences, of as many columns at once as do not meet in any row.
    fn quotients<S: Ode>(
        &mut self,
        system: &mut S,
        t: f64,
        y: &[f64],
        size: impl Fn(usize) -> f64,
    ) -> Result<(), Failure> {
        let n = self.n;
        let (lower, upper) = match &self.forward {
            LinearSolver::Band { lower, upper, .. } => (*lower, *upper),
            _ => (n - 1, n - 1),
        };
        let dense = matches!(self.forward, LinearSolver::Dense(_));
        let width = (lower + upper + 1).min(n);
        let step = |j: usize| f64::EPSILON.cbrt() * size(j);
        for first in 0..width {
            for (sign, result) in [(1.0, &mut self.ahead), (-1.0, &mut self.behind)] {
                self.moved.copy_from_slice(y);
                for j in (first..n).step_by(width) {
                    self.moved[j] += sign * step(j);
                }
                system.rhs(t, &self.moved, result)?;
            }
            for j in (first..n).step_by(width) {
                let distance = (y[j] + step(j)) - (y[j] - step(j));
                for i in j.saturating_sub(upper)..=(j + lower).min(n - 1) {
                    let place = match dense {
                        true => j * n + i,
                        false => j * (lower + upper + 1) + upper + i - j,
                    };
                    self.values[place] = (self.ahead[i] - self.behind[i]) / distance;
                }
            }
        }
        Ok(())
    }

    /// Calls `visit` with row, column and value of each entry.
    fn each(&self, mut visit: impl FnMut(usize, usize, f64)) {
        let n = self.n;
        match &self.forward {
            LinearSolver::Klu(pattern) => {
                each_place(pattern, |i, j, place| visit(i, j, self.values[place]));
            }
            LinearSolver::Band { lower, upper, .. } => {
                for j in 0..n {
                    for i in j.saturating_sub(*upper)..=(j + lower).min(n - 1) {
                        visit(i, j, self.values[j * (lower + upper + 1) + upper + i - j]);
                    }
                }
            }
            _ => self.values.iter().enumerate().for_each(|(k, value)| visit(k % n, k / n, *value)),
        }
    }

    /// Writes J^T lambda.
    pub(super) fn transposed_times(&self, lambda: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.each(|i, j, value| out[j] += value * lambda[i]);
    }

    /// Writes -J^T into the matrix of `backward`, which is this solver's.
    pub(super) fn write_negative_transposed(&self, backward: &LinearSolver, entries: Entries<'_>) {
        match (entries, backward) {
            (Entries::Dense(mut matrix), _) => self.each(|i, j, value| matrix[(j, i)] = -value),
            (Entries::Band(mut band), _) => self.each(|i, j, value| band[(j, i)] = -value),
            (Entries::Sparse(values), LinearSolver::Klu(pattern)) => self.each(|i, j, value| {
                if let Some(place) = pattern.position(j, i) {
                    values[place] = -value;
                }
            }),
            _ => {}
        }
    }
}

/// Calls `visit` with row, column and place of each entry.
fn each_place(pattern: &Pattern, mut visit: impl FnMut(usize, usize, usize)) {
    for (j, ends) in pattern.column_pointers().windows(2).enumerate() {
        for place in ends[0] as usize..ends[1] as usize {
            visit(pattern.row_indices()[place] as usize, j, place);
        }
    }
}

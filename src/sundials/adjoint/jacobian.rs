//! The Jacobian df/dy, evaluated for products with its transpose.

use faer::MatMut;

use crate::{
    input::InputError,
    ode::{BandMut, Failure, Ode},
    sundials::{Jacobian, LinearSolver, Pattern, colouring::Colouring, matrix::Entries},
};

/// The Jacobian at one point, stored as the linear solver of the run forward has it.
pub(super) struct StoredJacobian {
    forward: LinearSolver,
    n: usize,
    values: Vec<f64>,
    /// Of a sparse matrix.
    colouring: Option<Colouring>,
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
            LinearSolver::Klu { pattern, .. } => pattern.entry_count(),
            _ => 0,
        };
        let vector = || vec![0.0; n];
        let (moved, ahead, behind) = (vector(), vector(), vector());
        let colouring = match forward {
            LinearSolver::Klu { pattern, .. } => Some(Colouring::new(pattern)),
            _ => None,
        };
        let (forward, values) = (forward.clone(), vec![0.0; count]);
        Self { forward, n, values, colouring, moved, ahead, behind }
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
            LinearSolver::Klu { .. } => {
                let mut entries = Vec::new();
                for j in 0..self.n {
                    places(&self.forward, self.n, j, |i, _| entries.push((j, i)));
                }
                let pattern = Pattern::from_entries(self.n, entries)?;
                Ok(LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied })
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
            LinearSolver::Dense(jacobian)
            | LinearSolver::Band { jacobian, .. }
            | LinearSolver::Klu { jacobian, .. } => *jacobian == Jacobian::DifferenceQuotients,
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
        let step = |j: usize| f64::EPSILON.cbrt() * size(j);
        for colour in 0..self.colours() {
            for (sign, result) in [(1.0, &mut self.ahead), (-1.0, &mut self.behind)] {
                self.moved.copy_from_slice(y);
                columns(&self.forward, self.colouring.as_ref(), self.n, colour, |j| {
                    self.moved[j] += sign * step(j);
                });
                system.rhs(t, &self.moved, result)?;
            }
            let (values, ahead, behind) = (&mut self.values, &self.ahead, &self.behind);
            columns(&self.forward, self.colouring.as_ref(), self.n, colour, |j| {
                let distance = (y[j] + step(j)) - (y[j] - step(j));
                places(&self.forward, self.n, j, |i, place| {
                    values[place] = (ahead[i] - behind[i]) / distance;
                });
            });
        }
        Ok(())
    }

    /// How many evaluations have all columns.
    fn colours(&self) -> usize {
        match (&self.forward, &self.colouring) {
            (_, Some(colouring)) => colouring.count(),
            (LinearSolver::Band { lower, upper, .. }, _) => (lower + upper + 1).min(self.n),
            _ => self.n,
        }
    }

    /// Calls `visit` with row, column and value of each entry.
    fn each(&self, mut visit: impl FnMut(usize, usize, f64)) {
        for j in 0..self.n {
            places(&self.forward, self.n, j, |i, place| visit(i, j, self.values[place]));
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
            (Entries::Sparse(values), LinearSolver::Klu { pattern, .. }) => {
                self.each(|i, j, value| {
                    if let Some(place) = pattern.position(j, i) {
                        values[place] = -value;
                    }
                })
            }
            _ => {}
        }
    }
}

/// Calls `visit` with the row and place of each entry of column `j`.
fn places(solver: &LinearSolver, n: usize, j: usize, mut visit: impl FnMut(usize, usize)) {
    match solver {
        LinearSolver::Klu { pattern, .. } => {
            let rows = pattern.column(j).iter().zip(pattern.places(j));
            rows.for_each(|(&i, place)| visit(i as usize, place));
        }
        LinearSolver::Band { lower, upper, .. } => {
            for i in j.saturating_sub(*upper)..=(j + lower).min(n - 1) {
                visit(i, j * (lower + upper + 1) + upper + i - j);
            }
        }
        _ => (0..n).for_each(|i| visit(i, j * n + i)),
    }
}

/// Calls `visit` with each column of a colour: columns that do not meet in any row.
fn columns(
    solver: &LinearSolver,
    colouring: Option<&Colouring>,
    n: usize,
    colour: usize,
    mut visit: impl FnMut(usize),
) {
    match (solver, colouring) {
        (_, Some(colouring)) => colouring.columns(colour).iter().for_each(|&j| visit(j)),
        (LinearSolver::Band { lower, upper, .. }, _) => {
            (colour..n).step_by((lower + upper + 1).min(n)).for_each(visit);
        }
        _ => visit(colour),
    }
}

//! Jacobians, evaluated for products with their transposes.

use faer::MatMut;

use crate::{
    input::InputError,
    ode::{BandMut, Failure},
    sundials::{Jacobian, LinearSolver, Pattern, colouring::Colouring, matrix::Entries},
};

/// A Jacobian at one point, stored as the linear solver of the run forward has it.
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

    /// The linear solver for transposed matrices.
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

    /// Whether the system supplies it.
    pub(super) fn is_supplied(&self) -> bool {
        match &self.forward {
            LinearSolver::Dense(jacobian)
            | LinearSolver::Band { jacobian, .. }
            | LinearSolver::Klu { jacobian, .. } => *jacobian == Jacobian::Supplied,
            _ => false,
        }
    }

    /// Its entries, to be filled; zeros.
    pub(super) fn entries(&mut self) -> Entries<'_> {
        self.values.fill(0.0);
        let values = &mut self.values;
        match &self.forward {
            LinearSolver::Dense(_) => {
                Entries::Dense(MatMut::from_column_major_slice_mut(values, self.n, self.n))
            }
            LinearSolver::Band { lower, upper, .. } => {
                let stride = lower + upper + 1;
                Entries::Band(BandMut::new(values, stride, *upper, *lower, *upper))
            }
            _ => Entries::Sparse(values),
        }
    }

    /// Makes it that of `evaluate` at `x` by central differences with these steps, of as many columns at once as do not
    /// meet in any row.
    pub(super) fn quotients(
        &mut self,
        x: &[f64],
        step: impl Fn(usize) -> f64,
        mut evaluate: impl FnMut(&[f64], &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.values.fill(0.0);
        for colour in 0..self.colours() {
            for (sign, result) in [(1.0, &mut self.ahead), (-1.0, &mut self.behind)] {
                self.moved.copy_from_slice(x);
                columns(&self.forward, self.colouring.as_ref(), self.n, colour, |j| {
                    self.moved[j] += sign * step(j);
                });
                evaluate(&self.moved, result)?;
            }
            let (values, ahead, behind) = (&mut self.values, &self.ahead, &self.behind);
            columns(&self.forward, self.colouring.as_ref(), self.n, colour, |j| {
                let distance = (x[j] + step(j)) - (x[j] - step(j));
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

    /// The numbers that are stored.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Calls `visit` with row, column and value of each entry.
    pub(super) fn each(&self, mut visit: impl FnMut(usize, usize, f64)) {
        self.each_place(|i, j, place| visit(i, j, self.values[place]));
    }

    /// Calls `visit` with row, column and place among the values of each entry.
    pub(super) fn each_place(&self, mut visit: impl FnMut(usize, usize, usize)) {
        for j in 0..self.n {
            places(&self.forward, self.n, j, |i, place| visit(i, j, place));
        }
    }

    /// Adds `factor` J^T lambda.
    pub(super) fn add_transposed_times(&self, factor: f64, lambda: &[f64], out: &mut [f64]) {
        self.each(|i, j, value| out[j] += factor * value * lambda[i]);
    }

    /// Writes the transpose of another matrix, which has `value` in a row and at a place of this one, into that of
    /// `backward`, which is this solver's.
    pub(super) fn write_transposed(
        &self,
        backward: &LinearSolver,
        entries: Entries<'_>,
        value: impl Fn(usize, usize) -> f64,
    ) {
        match (entries, backward) {
            (Entries::Dense(mut matrix), _) => {
                self.each_place(|i, j, place| matrix[(j, i)] = value(i, place));
            }
            (Entries::Band(mut band), _) => {
                self.each_place(|i, j, place| band[(j, i)] = value(i, place));
            }
            (Entries::Sparse(values), LinearSolver::Klu { pattern, .. }) => {
                self.each_place(|i, j, place| {
                    if let Some(to) = pattern.position(j, i) {
                        values[to] = value(i, place);
                    }
                });
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

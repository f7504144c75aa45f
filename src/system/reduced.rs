//! The linear systems of a phase, [X -A; -A^T 0] [x; mu] = [f; -d], with X the inertia matrix or
//! the Newton matrix.
//!
//! Nodal rows of A^T are eliminated: their components of x are known at once, and what remains is
//! a Cholesky solve with the free part of X. General rows, few of them, are met by a Schur
//! complement as large as their number.

#[cfg(test)]
mod tests;

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::{
    LltError, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::cholesky::llt::solve::{solve_in_place, solve_in_place_scratch};
use faer::sparse::SymbolicSparseColMat;
use faer::{Mat, MatMut, Par, Spec};

use super::cholesky::{Cholesky, Indefinite};
use crate::constraint::Row;
use crate::model::Model;

/// Which entry of the matrices of the body an entry of X comes from.
#[derive(Clone, Copy)]
pub(super) struct Source {
    /// Index of the pair of nodes in the [`NodePattern`].
    pub(super) entry: usize,
    /// Index of the same pair the other way round.
    pub(super) transposed: usize,
    /// Axis of the row and of the column, in the block of `entry`.
    pub(super) axes: [usize; 2],
}

/// Which entries X has.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Coupling {
    /// Nothing but itself, as lumped inertia.
    Diagonal,
    /// Equal axes only, as the inertia matrix.
    SameAxis,
    /// All axes of coupled nodes.
    AllAxes,
}

/// Solver for one X and one set of constraints.
pub(super) struct Reduced {
    /// Free degrees of freedom, ascending.
    free: Vec<usize>,
    /// Lower triangle of the free part of X.
    sources: Vec<Source>,
    values: Vec<f64>,
    cholesky: Cholesky,
    /// Entries of X between a free row (position in `free`) and a fixed column (dof).
    border: Vec<(usize, usize, Source)>,
    border_values: Vec<f64>,
    general: GeneralRows,
    /// Right-hand side and solution at the free degrees of freedom.
    work: Vec<f64>,
}

impl Reduced {
    pub(super) fn new(model: &Model, rows: &[Row], coupling: Coupling) -> Self {
        let (pattern, dimension) = (model.pattern(), model.dimension);
        let dofs = pattern.nodes() * dimension;
        let mut position: Vec<Option<usize>> = vec![Some(0); dofs];
        rows.iter().filter_map(Row::nodal).for_each(|(dof, _)| position[dof] = None);
        let free: Vec<usize> = (0..dofs).filter(|&dof| position[dof].is_some()).collect();
        free.iter().enumerate().for_each(|(at, &dof)| position[dof] = Some(at));

        let (mut offsets, mut row_indices) = (vec![0], Vec::new());
        let (mut sources, mut border) = (Vec::new(), Vec::new());
        for column in 0..dofs {
            for (entry, node) in pattern.row(column / dimension) {
                for axis in 0..dimension {
                    let axes = [column % dimension, axis];
                    let is_coupled = match coupling {
                        Coupling::Diagonal => node * dimension + axis == column,
                        Coupling::SameAxis => axes[0] == axes[1],
                        Coupling::AllAxes => true,
                    };
                    if !is_coupled {
                        continue;
                    }
                    // X is symmetric: entry (column, row) stands for (row, column).
                    let source = Source { entry, transposed: pattern.transposed(entry), axes };
                    match (position[node * dimension + axis], position[column]) {
                        (Some(row), Some(column)) if row >= column => {
                            row_indices.push(row);
                            sources.push(source);
                        }
                        (Some(row), None) => border.push((row, column, source)),
                        _ => {}
                    }
                }
            }
            if position[column].is_some() {
                offsets.push(row_indices.len());
            }
        }
        let lower =
            SymbolicSparseColMat::new_checked(free.len(), free.len(), offsets, None, row_indices);
        let of_nodes = |nodes: &Vec<usize>| -> Vec<usize> {
            let of = |(axis, &node): (usize, &usize)| position[node * dimension + axis];
            let axes = 0..dimension;
            match coupling {
                // axes that are not coupled are eliminated one after the other
                Coupling::Diagonal | Coupling::SameAxis => axes
                    .flat_map(|axis| nodes.iter().map(move |n| (axis, n)))
                    .filter_map(of)
                    .collect(),
                Coupling::AllAxes => {
                    let all = nodes.iter().flat_map(|n| axes.clone().map(move |axis| (axis, n)));
                    all.filter_map(of).collect()
                }
            }
        };
        // a diagonal fills in no order
        let dissection = model.dissection.as_ref().filter(|_| coupling != Coupling::Diagonal);
        let order = dissection.map(of_nodes);
        Self {
            values: vec![0.0; sources.len()],
            border_values: vec![0.0; border.len()],
            general: GeneralRows::new(rows, &position),
            work: vec![0.0; free.len()],
            cholesky: Cholesky::new(lower, order),
            free,
            sources,
            border,
        }
    }

    /// Factorizes X, positive definite, whose entries `value` gives.
    pub(super) fn factorize(&mut self, value: impl Fn(Source) -> f64) -> Result<(), Indefinite> {
        self.assemble(value);
        self.cholesky.factorize(&self.values)?;
        self.general.factorize(&mut self.cholesky)
    }

    /// Factorizes the X last given, which has turned out not to be positive definite.
    pub(super) fn factorize_indefinite(&mut self) -> Result<(), Indefinite> {
        self.cholesky.factorize_indefinite(&self.values)?;
        self.general.factorize(&mut self.cholesky)
    }

    fn assemble(&mut self, value: impl Fn(Source) -> f64) {
        self.values.iter_mut().zip(&self.sources).for_each(|(x, &source)| *x = value(source));
        self.border_values
            .iter_mut()
            .zip(&self.border)
            .for_each(|(x, &(_, _, source))| *x = value(source));
    }

    /// Solves X x - A mu = f, A^T x = d. `d` has one number per row of the constraints. `mu` gets
    /// the multipliers of the general rows; those of nodal rows are left to the caller, who knows
    /// X x - f at the fixed components.
    pub(super) fn solve(
        &mut self,
        rows: &[Row],
        f: &[f64],
        d: &[f64],
        x: &mut [f64],
        mu: &mut [f64],
    ) {
        for (row, d) in rows.iter().zip(d) {
            if let Some((dof, coefficient)) = row.nodal() {
                x[dof] = d / coefficient;
            }
        }
        self.work.iter_mut().zip(&self.free).for_each(|(work, &dof)| *work = f[dof]);
        for (&(row, column, _), value) in self.border.iter().zip(&self.border_values) {
            self.work[row] -= value * x[column];
        }
        self.cholesky.solve(&mut self.work);
        self.general.solve(rows, d, x, &mut self.work, mu);
        self.work.iter().zip(&self.free).for_each(|(work, &dof)| x[dof] = *work);
    }

    /// The general row found to follow from the others (its number in the list of all rows).
    pub(super) fn dependent_row(&self) -> Option<usize> {
        self.general.dependent
    }
}

/// The Schur complement S = G^T X^-1 G of the general rows, with G their free part.
struct GeneralRows {
    /// Number of each general row in the list of all rows, its free and its fixed terms.
    rows: Vec<GeneralRow>,
    /// X^-1 G, one column per row.
    inverse_g: Mat<f64>,
    schur: Mat<f64>,
    right: Vec<f64>,
    memory: MemBuffer,
    dependent: Option<usize>,
}

struct GeneralRow {
    number: usize,
    free: Vec<(usize, f64)>,
    fixed: Vec<(usize, f64)>,
}

impl GeneralRows {
    fn new(rows: &[Row], position: &[Option<usize>]) -> Self {
        let general = rows.iter().enumerate().filter(|(_, row)| row.nodal().is_none());
        let rows: Vec<GeneralRow> = general
            .map(|(number, row)| {
                let split = |&(dof, c): &(usize, f64)| position[dof].map(|at| (at, c));
                let is_fixed = |&&(dof, _): &&(usize, f64)| position[dof].is_none();
                GeneralRow {
                    number,
                    free: row.terms.iter().filter_map(split).collect(),
                    fixed: row.terms.iter().filter(is_fixed).copied().collect(),
                }
            })
            .collect();
        let (free, count) = (position.iter().flatten().count(), rows.len());
        let memory = MemBuffer::new(StackReq::any_of(&[
            cholesky_in_place_scratch::<f64>(count, Par::Seq, Spec::default()),
            solve_in_place_scratch::<f64>(count, 1, Par::Seq),
        ]));
        Self {
            rows,
            inverse_g: Mat::zeros(free, count),
            schur: Mat::zeros(count, count),
            right: vec![0.0; count],
            memory,
            dependent: None,
        }
    }

    fn factorize(&mut self, cholesky: &mut Cholesky) -> Result<(), Indefinite> {
        if self.rows.is_empty() {
            return Ok(());
        }
        for (k, row) in self.rows.iter().enumerate() {
            let column = self.inverse_g.col_as_slice_mut(k);
            column.fill(0.0);
            row.free.iter().for_each(|&(at, coefficient)| column[at] = coefficient);
            cholesky.solve(column);
        }
        for (i, row) in self.rows.iter().enumerate() {
            for j in 0..self.rows.len() {
                let column = self.inverse_g.col_as_slice(j);
                self.schur[(i, j)] = row.free.iter().map(|&(at, c)| c * column[at]).sum();
            }
        }
        let diagonal: Vec<f64> = (0..self.rows.len()).map(|i| self.schur[(i, i)]).collect();
        let factorized = cholesky_in_place(
            self.schur.as_mut(),
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut self.memory),
            Spec::default(),
        );
        // A row that follows from the rows before it leaves a pivot of the size of round-off.
        let pivot_is_lost = |&i: &usize| self.schur[(i, i)].powi(2) <= 1e-12 * diagonal[i];
        let lost = match factorized {
            Err(LltError::NonPositivePivot { index }) => Some(index),
            Ok(_) => (0..self.rows.len()).find(pivot_is_lost),
        };
        self.dependent = lost.map(|i| self.rows[i].number);
        if lost.is_some() { Err(Indefinite) } else { Ok(()) }
    }

    /// Corrects `free` = X^-1 f so that the rows hold.
    fn solve(&mut self, all: &[Row], d: &[f64], x: &[f64], free: &mut [f64], mu: &mut [f64]) {
        if self.rows.is_empty() {
            return;
        }
        debug_assert_eq!(all.len(), d.len());
        for (right, row) in self.right.iter_mut().zip(&self.rows) {
            let fixed: f64 = row.fixed.iter().map(|&(dof, c)| c * x[dof]).sum();
            let free: f64 = row.free.iter().map(|&(at, c)| c * free[at]).sum();
            *right = d[row.number] - fixed - free;
        }
        let count = self.rows.len();
        solve_in_place(
            self.schur.as_ref(),
            MatMut::from_column_major_slice_mut(&mut self.right, count, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
        for (k, (multiplier, row)) in self.right.iter().zip(&self.rows).enumerate() {
            mu[row.number] = *multiplier;
            let column = self.inverse_g.col_as_slice(k);
            free.iter_mut().zip(column).for_each(|(x, g)| *x += g * multiplier);
        }
    }
}

/// Completes the multipliers by those of nodal rows: `residual` is X x - f at a fixed component,
/// where X x - f = A mu.
pub(super) fn nodal_multipliers(
    rows: &[Row],
    multipliers: &mut [f64],
    residual: impl Fn(usize) -> f64,
) {
    for (row, multiplier) in rows.iter().zip(&mut *multipliers) {
        if let Some((dof, coefficient)) = row.nodal() {
            *multiplier = residual(dof) / coefficient;
        }
    }
    for general in (0..rows.len()).filter(|&k| rows[k].nodal().is_none()) {
        for &(dof, c) in &rows[general].terms {
            let fixed = |row: &Row| row.nodal().filter(|term| term.0 == dof);
            let found = rows.iter().enumerate().find_map(|(k, row)| Some((k, fixed(row)?.1)));
            if let Some((k, coefficient)) = found {
                multipliers[k] -= c * multipliers[general] / coefficient;
            }
        }
    }
}

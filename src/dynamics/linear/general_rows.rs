//! General rows of the constraints: those of several nodes, or along an oblique axis.

use faer::Mat;

use super::cholesky::Indefinite;
use super::schur::Schur;
use crate::elements::body::RigidPieces;
use crate::scene::constraint::{ConstraintRow, independent_terms};

/// The Schur complement S = G^T X^-1 G of the general rows, with G their free part.
pub(super) struct GeneralRows {
    /// Number of each general row in the list of all rows, its free and its fixed terms.
    pub(super) rows: Vec<GeneralRow>,
    /// X^-1 G, one column per row.
    inverse_g: Mat<f64>,
    schur: Schur,
    pub(super) right: Vec<f64>,
    pub(super) dependent: Option<usize>,
}

pub(super) struct GeneralRow {
    pub(super) number: usize,
    pub(super) free: Vec<(usize, f64)>,
    fixed: Vec<(usize, f64)>,
    /// Stiffness of the spring along it in the X in force.
    pub(super) spring: f64,
}

impl GeneralRow {
    /// The part of fixed components.
    fn of_fixed(&self, x: &[f64]) -> f64 {
        self.fixed.iter().map(|&(dof, c)| c * x[dof]).sum()
    }
}

impl GeneralRows {
    pub(super) fn new(
        rows: &[ConstraintRow],
        position: &[Option<usize>],
        rigid: Option<&RigidPieces>,
        dimension: usize,
    ) -> Self {
        let general = rows.iter().enumerate().filter(|(_, row)| row.nodal().is_none());
        let rows: Vec<GeneralRow> = general
            .map(|(number, row)| {
                let terms = independent_terms(&row.terms, rigid, dimension);
                let split = |&(dof, c): &(usize, f64)| position[dof].map(|at| (at, c));
                let is_fixed = |&&(dof, _): &&(usize, f64)| position[dof].is_none();
                GeneralRow {
                    number,
                    free: terms.iter().filter_map(split).collect(),
                    fixed: terms.iter().filter(is_fixed).copied().collect(),
                    spring: 0.0,
                }
            })
            .collect();
        let (free, count) = (position.iter().flatten().count(), rows.len());
        Self {
            rows,
            inverse_g: Mat::zeros(free, count),
            schur: Schur::new(count),
            right: vec![0.0; count],
            dependent: None,
        }
    }

    /// Free degrees of freedom of each row.
    pub(super) fn dofs(&self) -> Vec<Vec<usize>> {
        self.rows.iter().map(|row| row.free.iter().map(|term| term.0).collect()).collect()
    }

    /// Returns the free terms of each row. The rows are to be given terms for other unknowns, so many, before each factorization from now on.
    pub(super) fn take_terms(&mut self, unknowns: usize) -> Vec<Vec<(usize, f64)>> {
        self.inverse_g = Mat::zeros(unknowns, self.rows.len());
        self.rows.iter_mut().map(|row| std::mem::take(&mut row.free)).collect()
    }

    /// Prepares for the X in force, `definite` or not, whose systems `solve` solves.
    pub(super) fn factorize(
        &mut self,
        mut solve: impl FnMut(&mut [f64]),
        definite: bool,
    ) -> Result<(), Indefinite> {
        if self.rows.is_empty() {
            return Ok(());
        }
        for (k, row) in self.rows.iter().enumerate() {
            let column = self.inverse_g.col_as_slice_mut(k);
            column.fill(0.0);
            row.free.iter().for_each(|&(at, coefficient)| column[at] += coefficient);
            solve(column);
        }
        for (i, row) in self.rows.iter().enumerate() {
            for j in 0..self.rows.len() {
                let column = self.inverse_g.col_as_slice(j);
                self.schur.matrix[(i, j)] = row.free.iter().map(|&(at, c)| c * column[at]).sum();
            }
        }
        if !definite {
            self.schur.factorize_indefinite();
            return Ok(());
        }
        let lost = self.schur.factorize();
        self.dependent = lost.map(|i| self.rows[i].number);
        if lost.is_some() { Err(Indefinite) } else { Ok(()) }
    }

    /// Asks for the values `d`, one for each of all rows, where fixed components are those of `x`.
    pub(super) fn demand(&mut self, d: &[f64], x: &[f64]) {
        for (right, row) in self.right.iter_mut().zip(&self.rows) {
            *right = d[row.number] - row.of_fixed(x);
        }
    }

    /// Writes the multipliers, where `d` was demanded, among those of all rows.
    pub(super) fn write_multipliers(&self, d: &[f64], x: &[f64], mu: &mut [f64]) {
        for (multiplier, row) in self.right.iter().zip(&self.rows) {
            mu[row.number] = *multiplier - row.spring * (d[row.number] - row.of_fixed(x));
        }
    }

    /// Corrects `free` = X^-1 f so that the rows have the values `right`, which becomes their multipliers.
    pub(super) fn correct(&mut self, free: &mut [f64]) {
        if self.rows.is_empty() {
            return;
        }
        for (right, row) in self.right.iter_mut().zip(&self.rows) {
            *right -= row.free.iter().map(|&(at, c)| c * free[at]).sum::<f64>();
        }
        self.schur.solve(&mut self.right);
        for (k, multiplier) in self.right.iter().enumerate() {
            let column = self.inverse_g.col_as_slice(k);
            free.iter_mut().zip(column).for_each(|(x, g)| *x += g * multiplier);
        }
    }
}

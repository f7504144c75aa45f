//! The linear systems of a phase, [X -A; -A^T 0] [x; mu] = [f; -d], with X the inertia matrix or
//! the Newton matrix.
//!
//! Nodal rows of A^T are eliminated: their components of x are known at once, which leaves a Cholesky
//! solve with the free part of X. General rows, of which there are few, are satisfied by a Schur complement
//! of the size of their number. Nodes of rigid pieces (`elements/body/rigid.rs`) that move with others, x = W q, are
//! eliminated as well: the factorized matrix is W^T X W. Many pieces move by their
//! [rigid motions](super::rigid_motions).
//!
//! X may be singular without the general rows: a body may be held by oblique planes of symmetry only. So
//! where X itself is factorized, springs with the stiffness rho of its diagonal are added along the rows g of
//! single nodes, which fit into its pattern: X + rho g g^T has the same solution where g.x = d, with a
//! multiplier that is rho d larger.

#[cfg(test)]
mod pieces;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use faer::sparse::SymbolicSparseColMat;

use super::cholesky::Indefinite;
use super::edge_component::Coupled;
use super::edge_solver::EdgeSolver;
use super::edges::Edges;
use super::entry_source::{Coupling, EntrySource};
use super::free_matrix::FreeMatrix;
use super::general_rows::{GeneralRow, GeneralRows};
use super::gradients::Gradients;
use super::rigid_motions::{MANY, RigidMotions};
use super::symmetric::Symmetric;
use crate::base::sparse::NodePattern;
use crate::dynamics::matrices::Matrices;
use crate::elements::body::RigidPieces;
use crate::scene::constraint::ConstraintRow;

/// Residual, relative to the right-hand side, that is round-off.
pub(crate) const EXACT: f64 = 1e-13;

/// Solver for one X and one set of constraints.
pub(crate) struct ConstrainedSolver {
    kernel: Kernel,
    /// Entries of X between a free row (position in `free`) and a fixed column (dof), with their share.
    border: Vec<(usize, usize, EntrySource, f64)>,
    border_values: Vec<f64>,
    rigid: Option<Arc<RigidPieces>>,
    /// The edges of frames, where they are constraints.
    pub(crate) edges: Option<EdgeSolver>,
    general: GeneralRows,
    springs: Vec<Spring>,
    /// Entries of the free part, and contributions of the springs.
    stiffening: Vec<(usize, f64)>,
    /// Right-hand side and solution at the free degrees of freedom.
    work: Vec<f64>,
    /// The right-hand side, moved from nodes of rigid pieces to their frames.
    gathered: Vec<f64>,
}

/// The free part of X, with the solver of its systems.
enum Kernel {
    Symmetric(Box<Symmetric>),
    /// Together with edges and general rows.
    RigidMotions(Box<RigidMotions>),
}

impl Kernel {
    /// The free degrees of freedom, ascending.
    fn free(&self) -> &[usize] {
        match self {
            Self::Symmetric(symmetric) => symmetric.free(),
            Self::RigidMotions(motions) => motions.free(),
        }
    }
}

/// A spring along a general row of a single node.
struct Spring {
    /// Number of the row among the general ones.
    row: usize,
    /// Entries of the free part of X with the products of two coefficients of the row.
    entries: Vec<(usize, f64)>,
    /// The diagonal of X there.
    diagonal: Vec<EntrySource>,
}

impl ConstrainedSolver {
    pub(crate) fn new(
        matrices: &Matrices,
        rows: &[ConstraintRow],
        edges: &Edges,
        coupling: Coupling,
    ) -> Self {
        Self::with_motions(matrices, rows, edges, coupling, false)
    }

    /// For the Newton matrix of a phase, in which rigid pieces that touch are coupled: many of them are solved by their rigid motions.
    pub(crate) fn of_newton_matrix(
        matrices: &Matrices,
        rows: &[ConstraintRow],
        edges: &Edges,
    ) -> Self {
        let pieces = matrices.rigid.as_ref().map_or(0, |rigid| rigid.frames().len());
        let by_motions = pieces >= MANY && !edges.list.is_empty();
        Self::with_motions(matrices, rows, edges, Coupling::AllAxes, by_motions)
    }

    fn with_motions(
        matrices: &Matrices,
        rows: &[ConstraintRow],
        edges: &Edges,
        coupling: Coupling,
        by_motions: bool,
    ) -> Self {
        let (pattern, dimension) = (matrices.pattern(), matrices.dimension);
        let dofs = pattern.nodes() * dimension;
        let rigid = matrices.rigid.clone();
        let is_dependent =
            |node: usize| rigid.as_ref().is_some_and(|rigid| rigid.is_dependent(node));
        let mut position: Vec<Option<usize>> =
            (0..dofs).map(|dof| (!is_dependent(dof / dimension)).then_some(0)).collect();
        rows.iter().filter_map(ConstraintRow::nodal).for_each(|(dof, _)| position[dof] = None);
        let free: Vec<usize> = (0..dofs).filter(|&dof| position[dof].is_some()).collect();
        free.iter().enumerate().for_each(|(at, &dof)| position[dof] = Some(at));

        let (mut offsets, mut row_indices) = (vec![0; free.len() + 1], Vec::new());
        let (mut sources, mut border) = (Vec::new(), Vec::new());
        each_source(pattern, dimension, coupling, |source, [row, column]| {
            // contributions of dependent nodes follow below
            if is_dependent(row / dimension) || is_dependent(column / dimension) {
                return;
            }
            match (position[row], position[column]) {
                (Some(row), Some(column)) if row >= column => {
                    row_indices.push(row);
                    sources.push(source);
                    offsets[column + 1] = sources.len();
                }
                (Some(row), None) => border.push((row, column, source, 1.0)),
                _ => {}
            }
        });
        let mut general = GeneralRows::new(rows, &position, rigid.as_deref(), dimension);
        let entry = |row: usize, column: usize| {
            let [start, end] = [offsets[column], offsets[column + 1]];
            (start..end).find(|&at| row_indices[at] == row)
        };
        let mut carried = Vec::new();
        if let Some(rigid) = &rigid {
            let shares = |dof: usize| {
                let shares = rigid.shares(dof / dimension);
                shares.map(move |(node, w)| (node * dimension + dof % dimension, w))
            };
            each_source(pattern, dimension, coupling, |source, [row, column]| {
                if ![row, column].into_iter().any(|dof| is_dependent(dof / dimension)) {
                    return;
                }
                for (row, of_row) in shares(row) {
                    for (column, of_column) in shares(column) {
                        let share = of_row * of_column;
                        match (position[row], position[column]) {
                            (Some(row), Some(column)) if row >= column => {
                                carried.extend(entry(row, column).map(|at| (at, source, share)));
                            }
                            (Some(row), None) => border.push((row, column, source, share)),
                            _ => {}
                        }
                    }
                }
            });
        }
        let spring = |number: usize| {
            let general: &GeneralRow = &general.rows[number];
            rows[general.number].node(dimension)?;
            let mut spring = Spring { row: number, entries: Vec::new(), diagonal: Vec::new() };
            for &(row, c) in &general.free {
                for &(column, other) in general.free.iter().filter(|term| term.0 <= row) {
                    let at = entry(row, column)?;
                    spring.entries.push((at, c * other));
                    if row == column {
                        spring.diagonal.push(sources[at]);
                    }
                }
            }
            Some(spring)
        };
        let springs: Vec<Spring> = (0..general.rows.len()).filter_map(spring).collect();
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
        // a diagonal matrix has no fill in any order
        let dissection = matrices.dissection.as_ref().filter(|_| coupling != Coupling::Diagonal);
        let order = dissection.map(of_nodes);
        // they know nothing of nodes that move with others
        let gradients = rigid.is_none().then_some(|| Gradients::new(matrices, rows, coupling));
        let work = vec![0.0; free.len()];
        let matrix = FreeMatrix::new(free, sources, carried);
        let of_edges = (!edges.list.is_empty()).then(|| match by_motions {
            true => EdgeSolver::without_responses(edges),
            false => {
                let coupled = Coupled { pattern: &lower, general: &general.dofs() };
                EdgeSolver::new(edges, dimension, |dof| position[dof], coupled)
            }
        });
        let kernel = match &rigid {
            Some(rigid) if by_motions => {
                let frames = rigid.frames();
                let motions =
                    RigidMotions::new(matrix, lower, frames, edges, dimension, &mut general);
                Kernel::RigidMotions(Box::new(motions))
            }
            _ => Kernel::Symmetric(Symmetric::new(matrix, lower, order, gradients).into()),
        };
        Self {
            border_values: vec![0.0; border.len()],
            general,
            stiffening: Vec::with_capacity(springs.iter().map(|spring| spring.entries.len()).sum()),
            springs,
            work,
            gathered: vec![0.0; if rigid.is_some() { dofs } else { 0 }],
            kernel,
            border,
            rigid,
            edges: of_edges,
        }
    }

    /// Sets X, positive definite, whose entries `value` returns. That it is not positive definite may be
    /// found only later; on large solids systems are solved to an `accuracy` relative to their right-hand
    /// sides.
    pub(crate) fn begin(
        &mut self,
        accuracy: f64,
        value: impl Fn(EntrySource) -> f64,
    ) -> Result<(), Indefinite> {
        // prescribed components are only as accurate as the solutions of the systems
        let accuracy = if self.general.rows.is_empty() { accuracy } else { EXACT };
        Self::assemble_border(&self.border, &mut self.border_values, &value);
        self.general.rows.iter_mut().for_each(|row| row.spring = 0.0);
        match &mut self.kernel {
            Kernel::Symmetric(symmetric) => symmetric.begin(accuracy, value)?,
            Kernel::RigidMotions(motions) => motions.begin(accuracy, value),
        }
        self.eliminate(true)
    }

    /// Factorizes X, positive definite where the general rows of single nodes hold, whose entries `value`
    /// returns.
    pub(crate) fn factorize(
        &mut self,
        value: impl Fn(EntrySource) -> f64,
    ) -> Result<(), Indefinite> {
        let Kernel::Symmetric(symmetric) = &mut self.kernel else {
            return self.begin(EXACT, value);
        };
        Self::assemble_border(&self.border, &mut self.border_values, &value);
        self.stiffening.clear();
        for Spring { row, entries, diagonal } in &self.springs {
            let stiffness: f64 = diagonal.iter().map(|&source| value(source).abs()).sum();
            self.general.rows[*row].spring = stiffness;
            self.stiffening.extend(entries.iter().map(|&(at, product)| (at, stiffness * product)));
        }
        symmetric.factorize(value, &self.stiffening)?;
        self.eliminate(true)
    }

    /// Factorizes the X last given, which has turned out not to be positive definite.
    pub(crate) fn factorize_indefinite(&mut self) -> Result<(), Indefinite> {
        if let Kernel::Symmetric(symmetric) = &mut self.kernel {
            symmetric.factorize_indefinite()?;
        }
        self.eliminate(false)
    }

    /// Prepares the general rows and the edges for the current X, `definite` or not.
    fn eliminate(&mut self, definite: bool) -> Result<(), Indefinite> {
        // rigid motions are not known yet
        let Kernel::Symmetric(symmetric) = &mut self.kernel else { return Ok(()) };
        self.general.factorize(|x| symmetric.solve(x), definite)?;
        if let Some(edges) = &mut self.edges {
            edges.respond(&mut self.work, symmetric, &mut self.general);
        }
        Ok(())
    }

    fn assemble_border(
        border: &[(usize, usize, EntrySource, f64)],
        values: &mut [f64],
        value: impl Fn(EntrySource) -> f64,
    ) {
        values
            .iter_mut()
            .zip(border)
            .for_each(|(x, &(_, _, source, share))| *x = share * value(source));
    }

    /// Solves X x - A mu = f, A^T x = d. `d` has one number per row of the constraints. `mu` gets
    /// the multipliers of the general rows; those of nodal rows are left to the caller, who knows
    /// X x - f at the fixed components.
    pub(crate) fn solve(
        &mut self,
        rows: &[ConstraintRow],
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
        let f = match &self.rigid {
            None => f,
            Some(rigid) => {
                self.gathered.copy_from_slice(f);
                rigid.gather(&mut self.gathered);
                &self.gathered
            }
        };
        let Self { kernel, general, edges, work, .. } = self;
        work.iter_mut().zip(kernel.free()).for_each(|(work, &dof)| *work = f[dof]);
        for (&(row, column, ..), value) in self.border.iter().zip(&self.border_values) {
            work[row] -= value * x[column];
        }
        general.demand(d, x);
        match (kernel, edges) {
            (Kernel::RigidMotions(motions), Some(edges)) => {
                motions.solve(edges, general, work);
                general.write_multipliers(d, x, mu);
            }
            (Kernel::Symmetric(symmetric), edges) => {
                symmetric.solve(work);
                general.correct(work);
                general.write_multipliers(d, x, mu);
                if let Some(edges) = edges {
                    edges.correct(work, |row| general.rows[row].number, mu);
                }
            }
            // motions are those of edges
            (Kernel::RigidMotions(_), None) => {}
        }
        self.work.iter().zip(self.kernel.free()).for_each(|(work, &dof)| x[dof] = *work);
        if let Some(rigid) = &self.rigid {
            rigid.carry(x);
        }
    }

    /// As [`solve`](Self::solve), with the multipliers of nodal rows, for the X of which `row_product` is a row times x.
    pub(crate) fn solve_whole(
        &mut self,
        rows: &[ConstraintRow],
        f: &[f64],
        d: &[f64],
        x: &mut [f64],
        mu: &mut [f64],
        row_product: impl Fn(usize, &[f64]) -> f64,
    ) {
        self.solve(rows, f, d, x, mu);
        nodal_multipliers(rows, mu, |dof| row_product(dof, x) - f[dof]);
    }

    /// The x of X x - A mu = f, A^T x = 0.
    pub(crate) fn solve_free(&mut self, rows: &[ConstraintRow], f: &[f64]) -> Vec<f64> {
        let (mut x, mut mu) = (vec![0.0; f.len()], vec![0.0; rows.len()]);
        self.solve(rows, f, &mu.clone(), &mut x, &mut mu);
        x
    }

    /// Has iterations tried before a factor, up to so many more than solves with the factor would cost,
    /// however small the body is.
    #[cfg(test)]
    fn rent(
        mut self,
        matrices: &Matrices,
        rows: &[ConstraintRow],
        coupling: Coupling,
        iterations: f64,
    ) -> Self {
        if let Kernel::Symmetric(symmetric) = &mut self.kernel {
            symmetric.rent(Gradients::new(matrices, rows, coupling), iterations);
        }
        self
    }

    /// [What solving has cost](Symmetric::counts).
    pub(crate) fn counts(&self) -> [usize; 3] {
        match &self.kernel {
            Kernel::Symmetric(symmetric) => symmetric.counts(),
            Kernel::RigidMotions(motions) => [0, 0, motions.indefinite()],
        }
    }

    /// Has these counts from now on.
    pub(crate) fn set_counts(&mut self, counts: [usize; 3]) {
        match &mut self.kernel {
            Kernel::Symmetric(symmetric) => symmetric.set_counts(counts),
            Kernel::RigidMotions(motions) => motions.set_indefinite(counts[2]),
        }
    }

    /// The general row found to follow from the others (its number in the list of all rows).
    pub(crate) fn dependent_row(&self) -> Option<usize> {
        self.general.dependent
    }
}

/// Visits all entries of X, with their rows and columns.
fn each_source(
    pattern: &NodePattern,
    dimension: usize,
    coupling: Coupling,
    mut visit: impl FnMut(EntrySource, [usize; 2]),
) {
    for column in 0..pattern.nodes() * dimension {
        for (entry, node) in pattern.row(column / dimension) {
            for axis in 0..dimension {
                let axes = [column % dimension, axis];
                let is_coupled = match coupling {
                    Coupling::Diagonal => node == column / dimension && axes[0] == axes[1],
                    Coupling::SameAxis => axes[0] == axes[1],
                    Coupling::AllAxes => true,
                };
                if is_coupled {
                    // X is symmetric: entry (column, row) is that of (row, column).
                    let source = EntrySource::new(entry, pattern.transposed(entry), axes);
                    visit(source, [node * dimension + axis, column]);
                }
            }
        }
    }
}

/// Completes the multipliers by those of nodal rows: `residual` is X x - f at a fixed component,
/// where X x - f = A mu.
pub(crate) fn nodal_multipliers(
    rows: &[ConstraintRow],
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
            let fixed = |row: &ConstraintRow| row.nodal().filter(|term| term.0 == dof);
            let found = rows.iter().enumerate().find_map(|(k, row)| Some((k, fixed(row)?.1)));
            if let Some((k, coefficient)) = found {
                multipliers[k] -= c * multipliers[general] / coefficient;
            }
        }
    }
}

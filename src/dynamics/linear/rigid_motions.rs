//! Linear systems with X of many rigid pieces, in their rigid motions.
//!
//! With x the velocities of a frame, R x = demands leaves its rigid motions, x = T xi + p, where p is a strain ([`Simplex`]) and R T = 0; and
//! test motions T' with G T' = 0 eliminate the multipliers of the edges. Together, general rows with the multipliers mu among them,
//!
//! ```text
//! T'^T X T xi - T'^T A mu = T'^T (f - X p),   A^T T xi = d - A^T p
//! ```
//!
//! T and T' differ by the angle of a piece in a step. The factorized matrix is symmetric, B = T'^T X T' with 6 unknowns per piece, 3 in the plane, as sparse as
//! the contact graph, and solutions are refined iteratively until the equations above hold: each iteration is a product with X and a solve with B.
//! Motions are those along and about the edges of a piece, so that B is invariant under rotations of the pieces, and is kept for
//! as long as the refinement converges. A frame some of whose edges follow from general rows has the strains of these edges as unknowns, too.
//!
//! The multiplier of an edge is the work of X x - f - A mu in the strain of this edge.
//!
//! Few pieces are solved faster one by one ([`EdgeSolver`]), with a factor of X that is independent of their rotation.

use faer::sparse::SymbolicSparseColMat;

use super::cholesky::{Cholesky, Indefinite};
use super::edge_solver::EdgeSolver;
use super::edges::Edges;
use super::entry_source::EntrySource;
use super::free_matrix::FreeMatrix;
use super::general_rows::GeneralRows;
use super::motion_groups::{Block, Frame, Group, GroupMember, add_multiple, blocks, grouped};
use super::simplex::{ByEdge, Nodal, Simplex, edge_between};
use crate::base::vector::{dot, largest};

/// Pieces from which on this is less work than one by one.
pub(super) const MANY: usize = 8;

/// Rounds of refinement at most.
const MOST_ROUNDS: usize = 20;
/// Ratio of successive corrections above which refinement is slow: B is factorized again, or only round-off is left.
const SLOW: f64 = 0.3;
/// Changes below this, relative to the solution, may be round-off; and a solution that still changes by more than the second is none.
const SETTLED: [f64; 2] = [1e-9, 1e-3];

pub(super) struct RigidMotions {
    dimension: usize,
    matrix: FreeMatrix,
    /// The pattern of the lower triangle of X.
    pattern: SymbolicSparseColMat<usize>,
    groups: Vec<Group>,
    frames: Vec<Frame>,
    /// That of each free degree of freedom.
    places: Vec<GroupMember>,
    blocks: Vec<Block>,
    /// B: where the columns of its lower triangle begin, their entries, and its factor.
    offsets: Vec<usize>,
    values: Vec<f64>,
    cholesky: Cholesky,
    /// Terms of the general rows at the free degrees of freedom.
    terms: Vec<Vec<(usize, f64)>>,
    accuracy: f64,
    /// Whether B is that of X, and whether that at the motions in force.
    is_of_matrix: bool,
    is_here: bool,
    /// f, and f - X x + A mu.
    forces: Vec<f64>,
    residual: Vec<f64>,
    /// The values that the general rows are to have, and mu.
    wanted: Vec<f64>,
    multipliers: Vec<f64>,
    /// A change of xi.
    unknowns: Vec<f64>,
}

impl RigidMotions {
    /// For X with the lower triangle `pattern`, the nodes of each frame and their edges, and general rows, which are of the unknowns here from now on.
    pub(super) fn new(
        matrix: FreeMatrix,
        pattern: SymbolicSparseColMat<usize>,
        frames: &[Vec<usize>],
        edges: &Edges,
        dimension: usize,
        general: &mut GeneralRows,
    ) -> Self {
        let (groups, frames) = grouped(&matrix.free, frames, edges, dimension);
        let mut places = vec![GroupMember { group: 0, dof: 0 }; matrix.free.len()];
        for (number, group) in groups.iter().enumerate() {
            for (dof, &at) in group.dofs.iter().enumerate() {
                places[at] = GroupMember { group: number, dof };
            }
        }
        let (blocks, lower) = blocks(&groups, &places, &pattern);
        let terms = general.take_terms(lower.ncols());
        Self {
            dimension,
            offsets: lower.col_ptr().to_vec(),
            values: vec![0.0; lower.compute_nnz()],
            unknowns: vec![0.0; lower.ncols()],
            cholesky: Cholesky::new(lower, None),
            forces: vec![0.0; places.len()],
            residual: vec![0.0; places.len()],
            wanted: vec![0.0; terms.len()],
            multipliers: vec![0.0; terms.len()],
            matrix,
            pattern,
            groups,
            frames,
            places,
            blocks,
            terms,
            accuracy: f64::NAN,
            is_of_matrix: false,
            is_here: false,
        }
    }

    /// Sets X, whose systems are to be solved to an `accuracy` relative to the solution. It is factorized where that is needed.
    pub(super) fn begin(&mut self, accuracy: f64, value: impl Fn(EntrySource) -> f64) {
        self.matrix.assemble(value);
        (self.accuracy, self.is_of_matrix) = (accuracy, false);
    }

    /// The free degrees of freedom, ascending.
    pub(super) fn free(&self) -> &[usize] {
        &self.matrix.free
    }

    /// Number of matrices that were not positive definite.
    pub(super) fn indefinite(&self) -> usize {
        self.cholesky.indefinite
    }

    /// Has this number from now on.
    pub(super) fn set_indefinite(&mut self, count: usize) {
        self.cholesky.indefinite = count;
    }

    /// Takes the motions of pieces whose edges are G and R of the `edges`.
    fn turn(&mut self, edges: &EdgeSolver) {
        let d = self.dimension;
        for frame in &mut self.frames {
            let from_first = |of: &[[f64; 3]], factor: f64| {
                let edge = |k: usize| of[frame.edges[edge_between(k, 0)]].map(|x| x / factor);
                Simplex::new(d, std::array::from_fn(|k| if k < d { edge(k + 1) } else { [0.0; 3] }))
            };
            frame.test = from_first(&edges.columns, 1.0);
            frame.trial = from_first(&edges.rows, edges.factor);
            let Group { count, test, trial, .. } = &mut self.groups[frame.group];
            let kept = edges.demands.len();
            for (simplex, basis) in [(&frame.test, test), (&frame.trial, trial)] {
                let mut write = |unknown: usize, motion: Nodal| {
                    for (dof, row) in basis.chunks_exact_mut(*count).enumerate() {
                        row[unknown] = motion[dof / d][dof % d];
                    }
                };
                let rigid = Simplex::motions(d);
                (0..rigid).for_each(|number| write(number, simplex.motion(number)));
                let implied = (0..rigid).filter(|&edge| frame.edges[edge] >= kept);
                for (unknown, edge) in (rigid..).zip(implied) {
                    let mut rates = [0.0; 6];
                    rates[edge] = 1.0;
                    write(unknown, simplex.strain(&rates));
                }
            }
        }
        self.is_here = false;
    }

    /// Factorizes B at the current motions, with its products for general rows.
    fn factorize(&mut self, general: &mut GeneralRows) -> Result<(), Indefinite> {
        let Self { matrix, groups, blocks, offsets, values, .. } = self;
        blocks.iter().for_each(|block| block.assemble(&matrix.values, groups, offsets, values));
        for (terms, row) in self.terms.iter().zip(&mut general.rows) {
            row.free.clear();
            for &(at, c) in terms {
                let (group, motions) = self.places[at].of(&self.groups, |group| &group.test);
                row.free.extend((group.start..).zip(motions).map(|(unknown, x)| (unknown, c * x)));
            }
        }
        (self.is_of_matrix, self.is_here) = (false, true);
        let is_definite = self.cholesky.factorize(&self.values).is_ok();
        if !is_definite || general.factorize(|x| self.cholesky.solve(x), true).is_err() {
            self.cholesky.factorize_indefinite(&self.values)?;
            general.factorize(|x| self.cholesky.solve(x), false)?;
        }
        self.is_of_matrix = true;
        Ok(())
    }

    /// Replaces `x`, f, by the solution that the `edges` and the `general` rows demand, the latter with values less those of fixed
    /// components in `general.right`; leaves there, and in the edges, their multipliers. NaN where there is no solution.
    pub(super) fn solve(
        &mut self,
        edges: &mut EdgeSolver,
        general: &mut GeneralRows,
        x: &mut [f64],
    ) {
        if std::mem::take(&mut edges.has_turned) {
            self.turn(edges);
        }
        if !self.is_of_matrix && self.factorize(general).is_err() {
            return x.fill(f64::NAN);
        }
        self.forces.copy_from_slice(x);
        self.wanted.copy_from_slice(&general.right);
        self.multipliers.fill(0.0);
        self.strain(edges, x);
        if self.refine(general, x).is_err() {
            return x.fill(f64::NAN);
        }
        self.find_residual(x);
        for frame in &self.frames {
            let mut forces = [[0.0; 3]; 4];
            for (dof, &at) in self.groups[frame.group].dofs.iter().enumerate() {
                forces[dof / self.dimension][dof % self.dimension] = -self.residual[at];
            }
            for (&edge, force) in frame.edges.iter().zip(frame.test.along_edges(&forces)) {
                edges.multipliers.get_mut(edge).into_iter().for_each(|of_edge| *of_edge = force);
            }
        }
        general.right.copy_from_slice(&self.multipliers);
    }

    /// Sets `x` to the strain that the edges demand.
    fn strain(&self, EdgeSolver { demands, factor, .. }: &EdgeSolver, x: &mut [f64]) {
        x.fill(0.0);
        let d = self.dimension;
        for frame in &self.frames {
            let rates: ByEdge =
                frame.edges.map(|edge| demands.get(edge).map_or(0.0, |demand| demand / factor));
            let nodes = frame.trial.strain(&rates);
            for (dof, &at) in self.groups[frame.group].dofs.iter().enumerate() {
                x[at] = nodes[dof / d][dof % d];
            }
        }
    }

    /// Adds to `x` the motions that bring forces into balance.
    fn refine(&mut self, general: &mut GeneralRows, x: &mut [f64]) -> Result<(), Indefinite> {
        let mut before = f64::INFINITY;
        for round in 0..MOST_ROUNDS {
            self.find_residual(x);
            for group in &self.groups {
                let unknowns = &mut self.unknowns[group.start..][..group.count];
                unknowns.fill(0.0);
                for (motions, &at) in group.test.chunks_exact(group.count).zip(&group.dofs) {
                    add_multiple(self.residual[at], motions, unknowns);
                }
            }
            self.cholesky.solve(&mut self.unknowns);
            for ((right, wanted), terms) in
                general.right.iter_mut().zip(&self.wanted).zip(&self.terms)
            {
                *right = wanted - terms.iter().map(|&(at, c)| c * x[at]).sum::<f64>();
            }
            general.correct(&mut self.unknowns);
            add_multiple(1.0, &general.right, &mut self.multipliers);
            let (mut size, mut is_finite) = (0.0_f64, true);
            for group in &self.groups {
                let unknowns = &self.unknowns[group.start..][..group.count];
                for (motions, &at) in group.trial.chunks_exact(group.count).zip(&group.dofs) {
                    let change = dot(motions, unknowns);
                    size = size.max(change.abs());
                    is_finite &= change.is_finite();
                    x[at] += change;
                }
            }
            let whole = largest(x);
            if !is_finite {
                return Err(Indefinite);
            }
            let rate = if round == 0 { 1.0 } else { (size / before).min(1.0) };
            if rate * size <= self.accuracy * whole {
                return Ok(());
            }
            if round > 0 && rate > SLOW {
                if size <= SETTLED[0] * whole {
                    return Ok(());
                }
                if !self.is_here {
                    self.factorize(general)?;
                }
            }
            before = size;
        }
        if before <= SETTLED[1] * largest(x) { Ok(()) } else { Err(Indefinite) }
    }

    /// f - X x + A mu
    fn find_residual(&mut self, x: &[f64]) {
        let Self { matrix, pattern, forces, residual, multipliers, .. } = self;
        residual.copy_from_slice(forces);
        let (offsets, rows) = (pattern.col_ptr(), pattern.row_idx());
        for (column, ends) in offsets.windows(2).enumerate() {
            let mut sum = 0.0;
            for (&row, value) in rows[ends[0]..ends[1]].iter().zip(&matrix.values[ends[0]..]) {
                sum += value * x[row];
                if row != column {
                    residual[row] -= value * x[column];
                }
            }
            residual[column] -= sum;
        }
        for (terms, multiplier) in self.terms.iter().zip(multipliers) {
            terms.iter().for_each(|&(at, c)| residual[at] += c * *multiplier);
        }
    }
}

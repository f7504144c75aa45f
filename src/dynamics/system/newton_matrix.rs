//! The Newton matrix, factorized, and the tangents of the forces in it.

use std::sync::Arc;

use super::differences::Differences;
use crate::base::sparse::BlockMatrix;
use crate::dynamics::linear::{ConstrainedSolver, Edges, FlowMatrix, Skew};
use crate::dynamics::matrices::Matrices;
use crate::scene::constraint::ConstraintRow;

/// Residuals, relative to the right-hand side, to which systems may be solved where that saves work: the
/// first far below the residual of a Newton iteration, the second below the errors that affect any integrator that
/// solves each system once.
pub(super) const ITERATED: f64 = 1e-5;
pub(super) const SOLVED_ONCE: f64 = 1e-11;

/// Largest residual of the skew part, relative to the right-hand side: a Rosenbrock method of order 4 needs that part.
pub(super) const SKEW: f64 = 1e-9;

pub(super) struct NewtonMatrix {
    pub(super) solver: ConstrainedSolver,
    /// The part that the solver leaves out, as it is not symmetric.
    pub(super) skew: Skew,
    pub(super) stiffness: Tangent,
    pub(super) damping: Tangent,
    pub(super) differences: Differences,
    /// Whether the tangents depend on the state, and whether they have been evaluated.
    pub(super) follows: bool,
    pub(super) is_set: bool,
    /// Whether D is not all zeros.
    pub(super) is_damped: bool,
    pub(super) gamma: f64,
    /// Displacements (m) and internal strains at which Maxwell branches have been eliminated.
    pub(super) place: [Vec<f64>; 2],
    pub(super) accuracy: f64,
    pub(super) tangent_evaluations: usize,
    /// Patterns after the first.
    pub(super) patterns: usize,
    /// f of the linear system, and its solution xv.
    pub(super) right: Vec<f64>,
    pub(super) xv: Vec<f64>,
    /// d of the linear system, and its multipliers mu.
    pub(super) demands: Vec<f64>,
    pub(super) mu: Vec<f64>,
    /// Contribution of gas, liquids, lag states and pipe flows, if there are any.
    pub(super) flow: Option<FlowMatrix>,
    /// Deviation of velocities from those of rigid pieces; empty without any. No force acts on it.
    pub(super) stray: Vec<f64>,
}

/// Kt or D.
pub(super) enum Tangent {
    /// The constant matrix of the scene, in a phase without forces that change it.
    Constant(Arc<BlockMatrix>),
    /// A separate matrix.
    Own(BlockMatrix),
}

impl Tangent {
    fn new(matrices: &Matrices, constant: &Option<Arc<BlockMatrix>>, follows: bool) -> Self {
        match constant {
            Some(constant) if !follows => Self::Constant(constant.clone()),
            _ => Self::Own(BlockMatrix::zeros(matrices.pattern(), matrices.dimension)),
        }
    }

    pub(super) fn get(&self) -> &BlockMatrix {
        match self {
            Self::Constant(matrix) => matrix,
            Self::Own(matrix) => matrix,
        }
    }

    /// The separate matrix, as it is.
    pub(super) fn own(&mut self) -> Option<&mut BlockMatrix> {
        match self {
            Self::Own(matrix) => Some(matrix),
            Self::Constant(_) => None,
        }
    }

    /// The separate matrix, reset to the constant part.
    pub(super) fn begin(
        &mut self,
        constant: &Option<Arc<BlockMatrix>>,
    ) -> Option<&mut BlockMatrix> {
        let matrix = self.own()?;
        match constant {
            Some(constant) => matrix.values.copy_from_slice(&constant.values),
            None => matrix.values.fill(0.0),
        }
        Some(matrix)
    }
}

impl NewtonMatrix {
    pub(super) fn new(
        matrices: &Matrices,
        rows: &[ConstraintRow],
        edges: &Edges,
        follows: bool,
    ) -> Self {
        let dofs = matrices.dofs();
        Self {
            solver: ConstrainedSolver::of_newton_matrix(matrices, rows, edges),
            skew: Skew::default(),
            stiffness: Tangent::new(matrices, &matrices.stiffness, follows),
            damping: Tangent::new(matrices, &matrices.damping, follows),
            differences: Differences::new(matrices.scales),
            follows,
            is_set: false,
            is_damped: matrices.damping.is_some(),
            gamma: f64::NAN,
            place: match &matrices.branches {
                Some(branches) => [vec![0.0; dofs], vec![0.0; branches.unknowns()]],
                None => [Vec::new(), Vec::new()],
            },
            accuracy: SOLVED_ONCE,
            tangent_evaluations: 0,
            patterns: 0,
            right: vec![0.0; dofs],
            xv: vec![0.0; dofs],
            demands: vec![0.0; rows.len()],
            mu: vec![0.0; rows.len()],
            flow: None,
            stray: vec![0.0; if matrices.rigid.is_some() { dofs } else { 0 }],
        }
    }

    /// Continues with matrices on another pattern, without tangents yet.
    pub(super) fn move_to(&mut self, matrices: &Matrices, rows: &[ConstraintRow], edges: &Edges) {
        let mut solver = ConstrainedSolver::of_newton_matrix(matrices, rows, edges);
        solver.set_counts(self.solver.counts());
        self.solver = solver;
        self.stiffness = Tangent::new(matrices, &matrices.stiffness, self.follows);
        self.damping = Tangent::new(matrices, &matrices.damping, self.follows);
        self.differences.forget_patterns();
        self.is_set = false;
        self.patterns += 1;
    }

    /// Whether the residuals of its systems are evaluated again and solutions corrected.
    pub(super) fn iterates(&self) -> bool {
        self.accuracy == ITERATED
    }

    /// Keeps the right-hand side and the demands, of rows and of edges.
    pub(super) fn keep(&self, [right, demands, of_edges]: &mut [Vec<f64>; 3]) {
        right.clone_from(&self.right);
        demands.clone_from(&self.demands);
        if let Some(edges) = &self.solver.edges {
            of_edges.clone_from(&edges.demands);
        }
    }

    /// Has those again that were kept.
    pub(super) fn restore(&mut self, [right, demands, of_edges]: &[Vec<f64>; 3]) {
        self.right.copy_from_slice(right);
        self.demands.copy_from_slice(demands);
        if let Some(edges) = &mut self.solver.edges {
            edges.demands.copy_from_slice(of_edges);
        }
    }

    /// Demands 0 of all constraints.
    pub(super) fn demand_nothing(&mut self) {
        self.demands.fill(0.0);
        if let Some(edges) = &mut self.solver.edges {
            edges.demands.fill(0.0);
        }
    }

    /// Starts all counts from 0.
    pub(super) fn forget_counts(&mut self) {
        (self.tangent_evaluations, self.patterns) = (0, 0);
        self.solver.set_counts([0; 3]);
        self.differences.forget_counts();
    }
}

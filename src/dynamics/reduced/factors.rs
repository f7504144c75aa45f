//! The dense Newton matrix I + gamma D + gamma^2 K of a reduced model, and the tangents in it.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Mat, MatMut, Par, Spec};

use crate::base::sparse::BlockMatrix;
use crate::dynamics::system::Differences;

/// -df/du and -df/dv: at the nodes, and along Psi, row by row.
pub(super) struct Tangents {
    pub(super) nodal: [BlockMatrix; 2],
    pub(super) projected: [Vec<f64>; 2],
    pub(super) differences: Differences,
    pub(super) is_set: bool,
}

/// I + gamma D + gamma^2 K, factorized.
pub(super) struct Factors {
    pub(super) matrix: Mat<f64>,
    /// K, with the contribution of branches in such a step.
    pub(super) stiffness: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    memory: MemBuffer,
    pub(super) gamma: f64,
    pub(super) right: Vec<f64>,
    /// The right-hand side, and then the solution.
    pub(super) xv: Vec<f64>,
}

impl Factors {
    /// Of `n` unknowns, along so many shapes.
    pub(super) fn new(n: usize, shapes: usize) -> Self {
        let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Spec::default())
            .or(solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq));
        Self {
            matrix: Mat::zeros(n, n),
            stiffness: vec![0.0; shapes * shapes],
            forward: vec![0; n],
            inverse: vec![0; n],
            memory: MemBuffer::new(scratch),
            gamma: 0.0,
            right: vec![0.0; n],
            xv: vec![0.0; n],
        }
    }
    /// Factorizes the matrix, in place.
    pub(super) fn factorize(&mut self) {
        let Self { matrix, forward, inverse, memory, .. } = self;
        let memory = MemStack::new(memory);
        factor::lu_in_place(matrix.as_mut(), forward, inverse, Par::Seq, memory, Spec::default());
    }

    /// Turns the right-hand side into the solution.
    pub(super) fn solve(&mut self) {
        let Self { matrix, forward, inverse, memory, xv, .. } = self;
        let n = xv.len();
        solve::solve_in_place(
            matrix.as_ref(),
            matrix.as_ref(),
            PermRef::new_checked(forward, inverse, n),
            MatMut::from_column_major_slice_mut(xv, n, 1),
            Par::Seq,
            MemStack::new(memory),
        );
    }
}

//! The dense Schur complement S of the general rows of a linear system with the matrix X, and its factor.
//!
//! S is positive definite where X is. X need not be: a light body held by a tie only is rotated by the forces of that tie, and X without
//! the tie has no restoring stiffness.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::{lblt, llt};
use faer::perm::PermRef;
use faer::{Mat, MatMut, Par, Spec};

pub(super) struct Schur {
    /// S, or its factor.
    pub(super) matrix: Mat<f64>,
    diagonal: Vec<f64>,
    factor: Factor,
    pivots: Pivots,
    memory: MemBuffer,
}

/// The factorization that `matrix` holds.
enum Factor {
    /// L L^T
    Cholesky,
    /// P^T L B L^T P, with blocks B of one or two rows.
    BunchKaufman,
}

/// Beside the factor L of an indefinite S and the diagonal of B: the rest of B, and the permutation P with its inverse.
struct Pivots {
    beside: Diag<f64>,
    order: [Vec<usize>; 2],
}

impl Schur {
    pub(super) fn new(count: usize) -> Self {
        let memory = MemBuffer::new(StackReq::any_of(&[
            llt::factor::cholesky_in_place_scratch::<f64>(count, Par::Seq, Spec::default()),
            llt::solve::solve_in_place_scratch::<f64>(count, 1, Par::Seq),
            lblt::factor::cholesky_in_place_scratch::<usize, f64>(count, Par::Seq, Spec::default()),
            lblt::solve::solve_in_place_scratch::<usize, f64>(count, 1, Par::Seq),
        ]));
        let order = [(0..count).collect(), (0..count).collect()];
        Self {
            matrix: Mat::zeros(count, count),
            diagonal: vec![0.0; count],
            factor: Factor::Cholesky,
            pivots: Pivots { beside: Diag::zeros(count), order },
            memory,
        }
    }

    /// Factorizes S, positive definite. Returns a row that follows from those before it, if there is one, or where S is not positive definite.
    pub(super) fn factorize(&mut self) -> Option<usize> {
        self.factor = Factor::Cholesky;
        (0..self.diagonal.len()).for_each(|i| self.diagonal[i] = self.matrix[(i, i)]);
        let factorized = llt::factor::cholesky_in_place(
            self.matrix.as_mut(),
            llt::factor::LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut self.memory),
            Spec::default(),
        );
        // A row that follows from the rows before it leaves a pivot of the size of round-off.
        let pivot_is_lost = |&i: &usize| self.matrix[(i, i)].powi(2) <= 1e-12 * self.diagonal[i];
        match factorized {
            Err(llt::factor::LltError::NonPositivePivot { index }) => Some(index),
            Ok(_) => (0..self.diagonal.len()).find(pivot_is_lost),
        }
    }

    /// Factorizes S of any sign (J. R. Bunch and L. Kaufman, *Some stable methods for calculating inertia and solving symmetric linear systems*,
    /// Mathematics of Computation 31, 1977).
    pub(super) fn factorize_indefinite(&mut self) {
        self.factor = Factor::BunchKaufman;
        let Pivots { beside, order: [order, inverse] } = &mut self.pivots;
        lblt::factor::cholesky_in_place(
            self.matrix.as_mut(),
            beside.as_mut(),
            order,
            inverse,
            Par::Seq,
            MemStack::new(&mut self.memory),
            Spec::default(),
        );
    }

    /// Replaces `right` by the solution of S x = right; by NaN if S is singular.
    pub(super) fn solve(&mut self, right: &mut [f64]) {
        let (count, factor) = (right.len(), self.matrix.as_ref());
        let right = MatMut::from_column_major_slice_mut(right, count, 1);
        let stack = MemStack::new(&mut self.memory);
        match self.factor {
            Factor::Cholesky => llt::solve::solve_in_place(factor, right, Par::Seq, stack),
            Factor::BunchKaufman => {
                let Pivots { beside, order: [order, inverse] } = &self.pivots;
                let order = PermRef::new_checked(order, inverse, count);
                let (diagonal, beside) = (factor.diagonal(), beside.as_ref());
                lblt::solve::solve_in_place(
                    factor,
                    diagonal,
                    beside,
                    order,
                    right,
                    Par::Seq,
                    stack,
                );
            }
        }
    }
}

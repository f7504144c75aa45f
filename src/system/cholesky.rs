//! Sparse Cholesky factorization with everything allocated beforehand.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};

/// A symmetric positive definite matrix, given by its lower triangle, and its factor.
///
/// The fill-reducing order and the pattern of the factor are found once, in [`Cholesky::new`].
pub(super) struct Cholesky {
    pattern: SymbolicSparseColMat<usize>,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    memory: MemBuffer,
}

/// The matrix is not positive definite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Indefinite;

impl Cholesky {
    /// Analyses the pattern of a lower triangle (columns sorted, full diagonal).
    ///
    /// # Panics
    /// When the factor does not fit into memory: as any allocation does.
    pub(super) fn new(pattern: SymbolicSparseColMat<usize>) -> Self {
        let symbolic = factorize_symbolic_cholesky(
            pattern.as_ref(),
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams::default(),
        )
        .unwrap_or_else(|error| panic!("analysis of a sparse factorization: {error:?}"));
        let memory = MemBuffer::new(StackReq::any_of(&[
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ]));
        let factor = vec![0.0; symbolic.len_val()];
        Self { pattern, symbolic, factor, memory }
    }

    /// Factorizes the matrix whose lower triangle has these values.
    pub(super) fn factorize(&mut self, values: &[f64]) -> Result<(), Indefinite> {
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), values);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.memory),
                Spec::default(),
            )
            .map(|_| ())
            .map_err(|_| Indefinite)
    }

    /// Replaces `x` by the solution of A x' = x.
    pub(super) fn solve(&mut self, x: &mut [f64]) {
        let rows = x.len();
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, rows, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }
}

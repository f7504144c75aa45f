//! Matrices: the storage of the Newton matrix, and its numbers, which a Jacobian callback fills.

use std::{ptr, slice};

use super::{context::Context, ffi, linear_solver::LinearSolver};
use crate::integrators::common::Error;

/// Owns a `SUNMatrix`.
pub(super) struct Matrix(ffi::SUNMatrix);

impl Matrix {
    /// The `n` x `n` matrix that the linear solver works on, if it needs one.
    pub(super) fn new(
        solver: &LinearSolver,
        n: usize,
        context: &Context,
    ) -> Result<Option<Self>, Error> {
        let (size, context) = (n as i64, context.raw());
        let (function, raw) = match solver {
            // SAFETY: the context is alive.
            LinearSolver::Dense(_) => {
                ("SUNDenseMatrix", unsafe { ffi::SUNDenseMatrix(size, size, context) })
            }
            // SAFETY: the context is alive; the bandwidths were checked to be smaller than n.
            LinearSolver::Band { lower, upper, .. } => ("SUNBandMatrix", unsafe {
                ffi::SUNBandMatrix(size, *upper as i64, *lower as i64, context)
            }),
            // SAFETY: the context is alive; the type is CSC.
            LinearSolver::Klu { pattern, .. } => ("SUNSparseMatrix", unsafe {
                let entries = pattern.entry_count() as i64;
                ffi::SUNSparseMatrix(size, size, entries, ffi::CSC_MAT as i32, context)
            }),
            // SAFETY: the context is alive.
            LinearSolver::Custom => ("SUNMatNewEmpty", unsafe { empty(context) }),
            LinearSolver::Krylov(_) => return Ok(None),
        };
        if raw.is_null() {
            return Err(Error::out_of_memory(function));
        }
        Ok(Some(Self(raw)))
    }

    pub(super) fn raw(&self) -> ffi::SUNMatrix {
        self.0
    }
}

impl Drop for Matrix {
    fn drop(&mut self) {
        // SAFETY: made by a SUNMatrix constructor and freed once.
        unsafe { ffi::SUNMatDestroy(self.0) };
    }
}

/// A matrix without storage: SUNDIALS needs one wherever a Newton matrix is set up, and a
/// user-supplied solver keeps its own.
///
/// # Safety
/// `context` is alive.
unsafe fn empty(context: ffi::SUNContext) -> ffi::SUNMatrix {
    extern "C" fn id(_: ffi::SUNMatrix) -> ffi::SUNMatrix_ID {
        ffi::SUNMatrix_ID_SUNMATRIX_CUSTOM
    }
    extern "C" fn zero(_: ffi::SUNMatrix) -> i32 {
        0
    }
    // SAFETY: the operations table of a new matrix is writable; without a `destroy` operation
    // SUNMatDestroy frees the table and the matrix, and there is no content.
    unsafe {
        let matrix = ffi::SUNMatNewEmpty(context);
        if !matrix.is_null() {
            (*(*matrix).ops).getid = Some(id);
            (*(*matrix).ops).zero = Some(zero);
        }
        matrix
    }
}

/// All numbers that `matrix` stores, column after column, to be filled. A sparse matrix gets its pattern:
/// SUNDIALS clears it together with the values before each evaluation.
///
/// # Safety
/// `matrix` is a live `n` x `n` matrix made for `solver`, and nobody else uses it during `'a`.
pub(super) unsafe fn stored<'a>(
    matrix: ffi::SUNMatrix,
    solver: &LinearSolver,
    n: usize,
) -> &'a mut [f64] {
    // SAFETY: the caller vouches for the matrix; each kind has one contiguous array of the length given here,
    // and the index arrays of a sparse one have room for the pattern for which they were made.
    unsafe {
        let (data, len) = match solver {
            LinearSolver::Dense(_) => (ffi::SUNDenseMatrix_Data(matrix), n * n),
            LinearSolver::Band { .. } => {
                let stride = ffi::SUNBandMatrix_LDim(matrix) as usize;
                (ffi::SUNBandMatrix_Data(matrix), n * stride)
            }
            LinearSolver::Klu { pattern, .. } => {
                let (pointers, rows) = (pattern.column_pointers(), pattern.row_indices());
                let to = ffi::SUNSparseMatrix_IndexPointers(matrix);
                ptr::copy_nonoverlapping(pointers.as_ptr(), to, pointers.len());
                let to = ffi::SUNSparseMatrix_IndexValues(matrix);
                ptr::copy_nonoverlapping(rows.as_ptr(), to, rows.len());
                (ffi::SUNSparseMatrix_Data(matrix), pattern.entry_count())
            }
            LinearSolver::Krylov(_) | LinearSolver::Custom => return &mut [],
        };
        slice::from_raw_parts_mut(data, len)
    }
}

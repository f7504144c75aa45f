//! Matrices: the storage of the Newton matrix, and the view that a Jacobian callback fills.

use std::{ptr, slice};

use faer::MatMut;

use super::{context::Context, ffi, linear_solver::LinearSolver};
use crate::integrators::{
    common::Error,
    ode::{BandMut, Dae, Failure, Ode},
};

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

/// The entries of a matrix, to be filled.
pub(super) enum Entries<'a> {
    Dense(MatMut<'a, f64>),
    Band(BandMut<'a>),
    Sparse(&'a mut [f64]),
    /// Nothing: the system keeps its own matrix.
    Custom,
}

impl<'a> Entries<'a> {
    /// Those that `solver`, or its preconditioner, stores as `values` of a matrix with `n` columns.
    pub(super) fn of(solver: &LinearSolver, n: usize, values: &'a mut [f64]) -> Self {
        match *solver {
            LinearSolver::Dense(_) => {
                Self::Dense(MatMut::from_column_major_slice_mut(values, n, n))
            }
            LinearSolver::Band { lower, upper, .. } => {
                // room for pivots may lie above the band
                let stride = values.len() / n;
                Self::Band(BandMut::new(values, stride, stride - lower - 1, lower, upper))
            }
            LinearSolver::Klu { .. } | LinearSolver::Krylov(_) => Self::Sparse(values),
            LinearSolver::Custom => Self::Custom,
        }
    }

    /// Lets the system write df/dy.
    pub(super) fn jacobian<S: Ode>(
        self,
        system: &mut S,
        t: f64,
        y: &[f64],
        ydot: &[f64],
    ) -> Result<(), Failure> {
        match self {
            Self::Dense(matrix) => system.dense_jacobian(t, y, ydot, matrix),
            Self::Band(matrix) => system.banded_jacobian(t, y, ydot, matrix),
            Self::Sparse(values) => system.sparse_jacobian(t, y, ydot, values),
            Self::Custom => Ok(()),
        }
    }

    /// Lets the system write dF/dy + cj dF/dy'.
    pub(super) fn dae_jacobian<S: Dae>(
        self,
        system: &mut S,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
    ) -> Result<(), Failure> {
        match self {
            Self::Dense(matrix) => system.dense_jacobian(t, cj, y, yp, matrix),
            Self::Band(matrix) => system.banded_jacobian(t, cj, y, yp, matrix),
            Self::Sparse(values) => system.sparse_jacobian(t, cj, y, yp, values),
            Self::Custom => Ok(()),
        }
    }

    /// Lets the system write its mass matrix.
    pub(super) fn mass<S: Ode>(self, system: &mut S, t: f64) -> Result<(), Failure> {
        match self {
            Self::Dense(matrix) => system.dense_mass(t, matrix),
            Self::Band(matrix) => system.banded_mass(t, matrix),
            Self::Sparse(values) => system.sparse_mass(t, values),
            Self::Custom => Ok(()),
        }
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

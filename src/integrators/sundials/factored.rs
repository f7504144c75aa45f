//! Direct linear solvers that record whether they have factors.
//!
//! When a Jacobian cannot be evaluated, the matrix remains half written, and an integrator that is called
//! again continues with it as if it were factorized: with pivots of another matrix, or with pivots that were
//! never set, and these are indices into memory. So each solver that factorizes is one of this file, which
//! then requests a new set-up.

use std::{ptr, slice};

use super::{
    context::Context,
    dense::DenseFactors,
    ffi,
    serial::{slice, slice_mut},
};

struct Factored {
    solver: Direct,
    has_factors: bool,
}

/// Implementation of the factorization.
pub(super) enum Direct {
    /// This crate, a dense matrix.
    Dense(DenseFactors),
    /// A live direct solver of SUNDIALS, which belongs to this one.
    Sundials(ffi::SUNLinearSolver),
}

/// A linear solver that records whether there are factors; null if memory runs out.
///
/// # Safety
/// A solver of SUNDIALS is live and direct, and belongs to the result from now on. One of a dense matrix is used with `SUNDenseMatrix`es
/// and serial vectors of its size.
pub(super) unsafe fn factored(solver: Direct, context: &Context) -> ffi::SUNLinearSolver {
    // SAFETY: the context is alive; the operations table of a new solver is writable, and its content ours.
    unsafe {
        let outer = ffi::SUNLinSolNewEmpty(context.raw());
        if outer.is_null() {
            if let Direct::Sundials(solver) = solver {
                ffi::SUNLinSolFree(solver);
            }
            return outer;
        }
        let ops = &mut *(*outer).ops;
        ops.gettype = Some(kind);
        ops.getid = Some(id);
        ops.initialize = Some(initialize);
        ops.setup = Some(setup);
        ops.solve = Some(solve);
        ops.lastflag = Some(last_flag);
        ops.free = Some(free);
        (*outer).content = Box::into_raw(Box::new(Factored { solver, has_factors: false })).cast();
        outer
    }
}

/// Makes the next solve request a new set-up.
///
/// # Safety
/// `solver` is live and made by [`factored`], and no call of it is under way.
pub(super) unsafe fn forget_factors(solver: ffi::SUNLinearSolver) {
    // SAFETY: the caller vouches for the solver.
    unsafe { content(solver) }.has_factors = false;
}

/// # Safety
/// `solver` is live and made by [`factored`]; no other function of this file is using it.
unsafe fn content<'a>(solver: ffi::SUNLinearSolver) -> &'a mut Factored {
    // SAFETY: the content was made by `factored` and lives as long as the solver.
    unsafe { &mut *(*solver).content.cast() }
}

extern "C" fn kind(_: ffi::SUNLinearSolver) -> ffi::SUNLinearSolver_Type {
    ffi::SUNLinearSolver_Type_SUNLINEARSOLVER_DIRECT
}

unsafe extern "C" fn id(solver: ffi::SUNLinearSolver) -> ffi::SUNLinearSolver_ID {
    // SAFETY: SUNDIALS calls the operations of a live solver, one at a time; the same holds for the next four
    // functions.
    match unsafe { &content(solver).solver } {
        Direct::Dense(_) => ffi::SUNLinearSolver_ID_SUNLINEARSOLVER_DENSE,
        // SAFETY: as above.
        Direct::Sundials(solver) => unsafe { ffi::SUNLinSolGetID(*solver) },
    }
}

unsafe extern "C" fn initialize(solver: ffi::SUNLinearSolver) -> i32 {
    // SAFETY: as above.
    match unsafe { &content(solver).solver } {
        Direct::Dense(_) => 0,
        // SAFETY: as above.
        Direct::Sundials(solver) => unsafe { ffi::SUNLinSolInitialize(*solver) },
    }
}

unsafe extern "C" fn setup(solver: ffi::SUNLinearSolver, matrix: ffi::SUNMatrix) -> i32 {
    // SAFETY: as above, with the matrix that the solver was made for.
    unsafe {
        let content = content(solver);
        let code = match &mut content.solver {
            Direct::Dense(dense) => match dense.factorize(entries(matrix, dense.n())) {
                true => 0,
                false => ffi::SUNLS_LUFACT_FAIL as i32,
            },
            Direct::Sundials(solver) => ffi::SUNLinSolSetup(*solver, matrix),
        };
        content.has_factors = code == 0;
        code
    }
}

unsafe extern "C" fn solve(
    solver: ffi::SUNLinearSolver,
    matrix: ffi::SUNMatrix,
    x: ffi::N_Vector,
    b: ffi::N_Vector,
    tolerance: f64,
) -> i32 {
    // SAFETY: as above, with live vectors.
    unsafe {
        let content = content(solver);
        if !content.has_factors {
            return ffi::SUNLS_PACKAGE_FAIL_REC as i32;
        }
        match &content.solver {
            Direct::Dense(dense) => {
                if x != b {
                    slice_mut(x).copy_from_slice(slice(b));
                }
                dense.solve(entries(matrix, dense.n()), slice_mut(x));
                0
            }
            Direct::Sundials(solver) => ffi::SUNLinSolSolve(*solver, matrix, x, b, tolerance),
        }
    }
}

unsafe extern "C" fn last_flag(solver: ffi::SUNLinearSolver) -> i64 {
    // SAFETY: as above.
    match unsafe { &content(solver).solver } {
        // the integrator itself keeps the code of the last set-up
        Direct::Dense(_) => 0,
        // SAFETY: as above.
        Direct::Sundials(solver) => unsafe { ffi::SUNLinSolLastFlag(*solver) },
    }
}

/// The numbers of a dense matrix, column by column.
///
/// # Safety
/// `matrix` is a live `SUNDenseMatrix` of `n` columns and rows, and nobody else uses it during `'a`.
unsafe fn entries<'a>(matrix: ffi::SUNMatrix, n: usize) -> &'a mut [f64] {
    // SAFETY: the caller vouches for the matrix, whose numbers are contiguous.
    unsafe { slice::from_raw_parts_mut(ffi::SUNDenseMatrix_Data(matrix), n * n) }
}

unsafe extern "C" fn free(solver: ffi::SUNLinearSolver) -> i32 {
    // SAFETY: called once, by SUNLinSolFree; content and inner solver are freed once, with it.
    unsafe {
        let content = Box::from_raw((*solver).content.cast::<Factored>());
        if let Direct::Sundials(inner) = content.solver {
            ffi::SUNLinSolFree(inner);
        }
        (*solver).content = ptr::null_mut();
        ffi::SUNLinSolFreeEmpty(solver);
    }
    0
}

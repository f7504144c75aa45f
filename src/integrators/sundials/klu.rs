//! KLU as a linear solver of SUNDIALS, for a build without SUNDIALS' own interface to it: the same calls in the same order
//! (`sunlinsol_klu.c`), and so the same digits; but columns are ordered by AMD.

use std::ptr;

use klu_sys::{
    KluLCommon, KluLNumeric, KluLSymbolic, klu_l_analyze, klu_l_condest, klu_l_defaults,
    klu_l_factor, klu_l_free_numeric, klu_l_free_symbolic, klu_l_rcond, klu_l_refactor,
    klu_l_solve,
};

use super::{
    ffi,
    serial::{slice, slice_mut},
};

struct Klu {
    common: KluLCommon,
    symbolic: *mut KluLSymbolic,
    numeric: *mut KluLNumeric,
    /// Whether the next factorization begins with an analysis of the pattern.
    is_first: bool,
}

/// A linear solver for sparse matrices by columns; null if memory runs out.
///
/// # Safety
/// `context` is alive. The solver is used with `SUNSparseMatrix`es of one pattern, and with serial vectors of their size.
#[allow(non_snake_case)] // the name in C
pub(super) unsafe fn SUNLinSol_KLU(
    _: ffi::N_Vector,
    _: ffi::SUNMatrix,
    context: ffi::SUNContext,
) -> ffi::SUNLinearSolver {
    // SAFETY: the caller vouches for the context; the operations table of a new solver is writable, and its content ours;
    // `klu_l_defaults` writes all of a structure of numbers and pointers, for which zeros are values.
    unsafe {
        let solver = ffi::SUNLinSolNewEmpty(context);
        if solver.is_null() {
            return solver;
        }
        let ops = &mut *(*solver).ops;
        ops.gettype = Some(kind);
        ops.getid = Some(id);
        ops.initialize = Some(initialize);
        ops.setup = Some(setup);
        ops.solve = Some(solve);
        ops.lastflag = Some(last_flag);
        ops.free = Some(free);
        let mut common: KluLCommon = std::mem::zeroed();
        klu_l_defaults(&raw mut common);
        let klu =
            Klu { common, symbolic: ptr::null_mut(), numeric: ptr::null_mut(), is_first: true };
        (*solver).content = Box::into_raw(Box::new(klu)).cast();
        solver
    }
}

/// The arrays of a sparse matrix by columns: where columns begin, rows, values.
type Columns = (*mut i64, *mut i64, *mut f64);

impl Klu {
    /// Factorizes a matrix, and returns a code of SUNDIALS.
    ///
    /// # Safety
    /// `a` are the arrays of a matrix of `n` columns, of the same pattern each time.
    unsafe fn factorize(&mut self, n: i64, a: Columns) -> i32 {
        let retry = ffi::SUNLS_PACKAGE_FAIL_REC as i32;
        let (starts, rows, values) = a;
        // SAFETY: the caller vouches for the arrays; symbolic and numeric factors are of their pattern, as an analysis comes
        // first and `factorize_anew` replaces both.
        unsafe {
            if self.is_first {
                self.free_symbolic();
                self.symbolic = klu_l_analyze(n, starts, rows, &raw mut self.common);
                if self.symbolic.is_null() {
                    return ffi::SUNLS_PACKAGE_FAIL_UNREC;
                }
                let code = self.factorize_anew(a);
                self.is_first = code != 0;
                return code;
            }
            // with the pivots of before, unless these have become bad ones
            let (symbolic, numeric, common) = (self.symbolic, self.numeric, &raw mut self.common);
            if klu_l_refactor(starts, rows, values, symbolic, numeric, common) == 0
                || klu_l_rcond(symbolic, numeric, common) == 0
            {
                return retry;
            }
            let bad = (f64::EPSILON).powf(2.0 / 3.0);
            if self.common.rcond < bad {
                if klu_l_condest(starts, values, symbolic, numeric, common) == 0 {
                    return retry;
                }
                if self.common.condest > 1.0 / bad {
                    return self.factorize_anew(a);
                }
            }
        }
        0
    }

    /// Factorizes a matrix with new pivots.
    ///
    /// # Safety
    /// The pattern of `a` has been analysed.
    unsafe fn factorize_anew(&mut self, (starts, rows, values): Columns) -> i32 {
        self.free_numeric();
        // SAFETY: the caller vouches for the arrays and the analysis.
        self.numeric =
            unsafe { klu_l_factor(starts, rows, values, self.symbolic, &raw mut self.common) };
        if self.numeric.is_null() { ffi::SUNLS_PACKAGE_FAIL_UNREC } else { 0 }
    }

    fn free_symbolic(&mut self) {
        // SAFETY: null, or made by `klu_l_analyze` with these settings; KLU then writes null.
        unsafe { klu_l_free_symbolic(&raw mut self.symbolic, &raw mut self.common) };
    }

    fn free_numeric(&mut self) {
        // SAFETY: null, or made by `klu_l_factor` with these settings; KLU then writes null.
        unsafe { klu_l_free_numeric(&raw mut self.numeric, &raw mut self.common) };
    }
}

impl Drop for Klu {
    fn drop(&mut self) {
        self.free_numeric();
        self.free_symbolic();
    }
}

/// # Safety
/// `solver` is live and made by [`SUNLinSol_KLU`]; no other function of this file is using it.
unsafe fn content<'a>(solver: ffi::SUNLinearSolver) -> &'a mut Klu {
    // SAFETY: the content was made by `SUNLinSol_KLU` and lives as long as the solver.
    unsafe { &mut *(*solver).content.cast() }
}

extern "C" fn kind(_: ffi::SUNLinearSolver) -> ffi::SUNLinearSolver_Type {
    ffi::SUNLinearSolver_Type_SUNLINEARSOLVER_DIRECT
}

extern "C" fn id(_: ffi::SUNLinearSolver) -> ffi::SUNLinearSolver_ID {
    ffi::SUNLinearSolver_ID_SUNLINEARSOLVER_KLU
}

unsafe extern "C" fn initialize(solver: ffi::SUNLinearSolver) -> i32 {
    // SAFETY: SUNDIALS calls the operations of a live solver, one at a time; the same holds for the next functions.
    unsafe { content(solver) }.is_first = true;
    0
}

unsafe extern "C" fn setup(solver: ffi::SUNLinearSolver, matrix: ffi::SUNMatrix) -> i32 {
    // SAFETY: as above, with a matrix of the pattern that the solver was made for.
    unsafe {
        let columns = (
            ffi::SUNSparseMatrix_IndexPointers(matrix),
            ffi::SUNSparseMatrix_IndexValues(matrix),
            ffi::SUNSparseMatrix_Data(matrix),
        );
        content(solver).factorize(ffi::SUNSparseMatrix_NP(matrix), columns)
    }
}

unsafe extern "C" fn solve(
    solver: ffi::SUNLinearSolver,
    _: ffi::SUNMatrix,
    x: ffi::N_Vector,
    b: ffi::N_Vector,
    _: f64,
) -> i32 {
    // SAFETY: as above, with live vectors of the size of the matrix, whose factors there are.
    unsafe {
        if x != b {
            slice_mut(x).copy_from_slice(slice(b));
        }
        let x = slice_mut(x);
        let klu = content(solver);
        let n = x.len() as i64;
        match klu_l_solve(klu.symbolic, klu.numeric, n, 1, x.as_mut_ptr(), &raw mut klu.common) {
            0 => ffi::SUNLS_PACKAGE_FAIL_REC as i32,
            _ => 0,
        }
    }
}

/// The integrator itself keeps the code of the last set-up.
extern "C" fn last_flag(_: ffi::SUNLinearSolver) -> i64 {
    0
}

unsafe extern "C" fn free(solver: ffi::SUNLinearSolver) -> i32 {
    // SAFETY: called once, by SUNLinSolFree; the content is freed once, with it.
    unsafe {
        drop(Box::from_raw((*solver).content.cast::<Klu>()));
        (*solver).content = ptr::null_mut();
        ffi::SUNLinSolFreeEmpty(solver);
    }
    0
}

//! Direct linear solvers that know whether they have factors.
//!
//! When a Jacobian cannot be evaluated, the matrix is left half written, and an integrator that is called
//! again continues with it as if it were factorized: with pivots of another matrix, or with pivots that were
//! never set, and these are indices into memory. So each solver of SUNDIALS that factorizes is wrapped in
//! this one, which then requests a new set-up.

use std::ptr;

use super::{context::Context, ffi};

struct Factored {
    solver: ffi::SUNLinearSolver,
    has_factors: bool,
}

/// Wraps `solver` in one that knows whether there are factors; null if memory runs out.
///
/// # Safety
/// `solver` is a live direct solver or null, and belongs to the result from now on.
pub(super) unsafe fn factored(
    solver: ffi::SUNLinearSolver,
    context: &Context,
) -> ffi::SUNLinearSolver {
    if solver.is_null() {
        return solver;
    }
    // SAFETY: the context is alive; the operations table of a new solver is writable, and its content ours.
    unsafe {
        let outer = ffi::SUNLinSolNewEmpty(context.raw());
        if outer.is_null() {
            ffi::SUNLinSolFree(solver);
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
    unsafe { ffi::SUNLinSolGetID(content(solver).solver) }
}

unsafe extern "C" fn initialize(solver: ffi::SUNLinearSolver) -> i32 {
    // SAFETY: as above.
    unsafe { ffi::SUNLinSolInitialize(content(solver).solver) }
}

unsafe extern "C" fn setup(solver: ffi::SUNLinearSolver, matrix: ffi::SUNMatrix) -> i32 {
    // SAFETY: as above, with the matrix that the solver was made for.
    unsafe {
        let content = content(solver);
        let code = ffi::SUNLinSolSetup(content.solver, matrix);
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
        match content.has_factors {
            true => ffi::SUNLinSolSolve(content.solver, matrix, x, b, tolerance),
            false => ffi::SUNLS_PACKAGE_FAIL_REC as i32,
        }
    }
}

unsafe extern "C" fn last_flag(solver: ffi::SUNLinearSolver) -> i64 {
    // SAFETY: as above.
    unsafe { ffi::SUNLinSolLastFlag(content(solver).solver) }
}

unsafe extern "C" fn free(solver: ffi::SUNLinearSolver) -> i32 {
    // SAFETY: called once, by SUNLinSolFree; content and inner solver are freed once, with it.
    unsafe {
        let content = Box::from_raw((*solver).content.cast::<Factored>());
        ffi::SUNLinSolFree(content.solver);
        (*solver).content = ptr::null_mut();
        ffi::SUNLinSolFreeEmpty(solver);
    }
    0
}

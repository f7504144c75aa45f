//! Linear solvers of SUNDIALS for the Newton iteration.

use std::{ffi::c_void, ptr};

#[cfg(feature = "vendored")]
use super::klu::SUNLinSol_KLU;
use super::{
    context::Context,
    dense::DenseFactors,
    factored::{Direct, factored, forget_factors},
    ffi,
    host::{Host, RETRY, STOP},
    krylov::{Krylov, KrylovMethod, Side},
    linear_solver::LinearSolver,
    matrix::{Matrix, stored},
    serial::{slice, slice_mut},
    vector::Vector,
};
use crate::integrators::{
    common::{Callback, Error},
    ode::Entries,
};

/// Owns a `SUNLinearSolver` and the matrix it factorizes, if any, freed in this order.
pub(super) struct Linear {
    solver: RawSolver,
    matrix: Option<Matrix>,
    /// Whether the solver is ready for [`factorize`](Self::factorize); KLU has analysed its pattern then.
    is_ready: bool,
}

struct RawSolver(ffi::SUNLinearSolver);

/// KLU, with columns ordered by AMD on the pattern of A + A^T, KLU's own default. SUNDIALS' is COLAMD, which leaves twice the fill in matrices of
/// symmetric pattern.
///
/// # Safety
/// Vector, matrix and context are alive and fit together.
unsafe fn klu(y: ffi::N_Vector, m: ffi::SUNMatrix, c: ffi::SUNContext) -> ffi::SUNLinearSolver {
    #[cfg(feature = "vendored")]
    // SAFETY: the caller vouches for the arguments.
    return unsafe { SUNLinSol_KLU(y, m, c) };
    #[cfg(not(feature = "vendored"))]
    // SAFETY: as above; the new solver is one of KLU.
    unsafe {
        const AMD: i32 = 0;
        let solver = ffi::SUNLinSol_KLU(y, m, c);
        if !solver.is_null() {
            ffi::SUNLinSol_KLUSetOrdering(solver, AMD);
        }
        solver
    }
}

impl Linear {
    /// # Safety
    /// `data` is the [`Host<S>`] of the integrator, which outlives the result.
    pub(super) unsafe fn new<S>(
        kind: &LinearSolver,
        template: &Vector,
        context: &Context,
        data: *mut c_void,
    ) -> Result<Self, Error> {
        let n = template.as_slice().len();
        kind.check(n)?;
        let matrix = Matrix::new(kind, n, context)?;
        let m = matrix.as_ref().map_or(ptr::null_mut(), Matrix::raw);
        let (y, c) = (template.raw(), context.raw());
        let (function, raw) = match kind {
            // SAFETY: the matrix is made for this solver.
            LinearSolver::Dense(_) => ("SUNLinSolNewEmpty", unsafe {
                factored(Direct::Dense(DenseFactors::new(n)), context)
            }),
            // SAFETY: vector, matrix and context are alive and fit together.
            LinearSolver::Band { .. } => {
                ("SUNLinSol_Band", unsafe { ffi::SUNLinSol_Band(y, m, c) })
            }
            // SAFETY: as above.
            LinearSolver::Klu { .. } => ("SUNLinSol_KLU", unsafe { klu(y, m, c) }),
            // SAFETY: vector and context are alive; the numbers were checked.
            LinearSolver::Krylov(options) => unsafe { krylov(options, y, c) },
            // SAFETY: the context is alive; the caller vouches for `data`.
            LinearSolver::Custom => ("SUNLinSolNewEmpty", unsafe { custom::<S>(c, data) }),
        };
        if raw.is_null() {
            return Err(Error::out_of_memory(function));
        }
        let raw = match kind {
            // SAFETY: the solver is new, and a direct one.
            LinearSolver::Band { .. } | LinearSolver::Klu { .. } | LinearSolver::Custom => unsafe {
                factored(Direct::Sundials(raw), context)
            },
            LinearSolver::Dense(_) | LinearSolver::Krylov(_) => raw,
        };
        if raw.is_null() {
            return Err(Error::out_of_memory("SUNLinSolNewEmpty"));
        }
        Ok(Self { solver: RawSolver(raw), matrix, is_ready: false })
    }

    /// Makes the next solve begin with a set-up: the matrix may be half written.
    pub(super) fn forget_factors(&mut self) {
        if self.matrix.is_some() {
            // SAFETY: a solver with a matrix is made by `factored`; `&mut self` keeps others away.
            unsafe { forget_factors(self.solver.0) };
        }
    }

    /// Factorizes the matrix, after `fill` has written entries into it. Returns whether it succeeded.
    ///
    /// # Safety
    /// This was made for `kind` and for vectors of length `n`.
    pub(super) unsafe fn factorize(
        &mut self,
        kind: &LinearSolver,
        n: usize,
        fill: impl FnOnce(Entries<'_>),
    ) -> bool {
        let (solver, matrix) = (self.solver(), self.matrix());
        if matrix.is_null() {
            return false;
        }
        // SAFETY: solver and matrix are alive and fit together, and the caller vouches for the kind of
        // matrix; `&mut self` keeps others away, and the entries are gone when the solver works.
        unsafe {
            ffi::SUNMatZero(matrix);
            fill(kind.entries(n, stored(matrix, kind, n)));
            self.is_ready = self.is_ready || ffi::SUNLinSolInitialize(solver) == 0;
            self.is_ready && ffi::SUNLinSolSetup(solver, matrix) == 0
        }
    }

    /// Replaces the right-hand side `b` by the solution, after [`factorize`](Self::factorize). Returns
    /// whether there is one.
    pub(super) fn solve(&mut self, b: &mut Vector) -> bool {
        // SAFETY: solver, matrix and vector are alive and fit together; direct solvers take one vector for
        // both.
        unsafe { ffi::SUNLinSolSolve(self.solver(), self.matrix(), b.raw(), b.raw(), 0.0) == 0 }
    }

    pub(super) fn solver(&self) -> ffi::SUNLinearSolver {
        self.solver.0
    }

    /// Null for a solver without a matrix.
    pub(super) fn matrix(&self) -> ffi::SUNMatrix {
        self.matrix.as_ref().map_or(ptr::null_mut(), Matrix::raw)
    }
}

impl Drop for RawSolver {
    fn drop(&mut self) {
        // SAFETY: made by a SUNLinearSolver constructor and freed once.
        unsafe { ffi::SUNLinSolFree(self.0) };
    }
}

/// A Krylov method, or null, with the name of its constructor.
///
/// # Safety
/// `template` and `context` are alive, and the options were checked.
unsafe fn krylov(
    options: &Krylov,
    template: ffi::N_Vector,
    context: ffi::SUNContext,
) -> (&'static str, ffi::SUNLinearSolver) {
    let side = match options.preconditioner {
        None => ffi::SUN_PREC_NONE,
        Some((Side::Left, _)) => ffi::SUN_PREC_LEFT,
        Some((Side::Right, _)) => ffi::SUN_PREC_RIGHT,
    } as i32;
    let n = |number: u32| number as i32;
    // SAFETY: the caller vouches for the arguments.
    let (name, raw, solve): (_, _, KrylovSolve) = unsafe {
        match options.method {
            KrylovMethod::Gmres { dimension, restarts } => {
                let raw = ffi::SUNLinSol_SPGMR(template, side, n(dimension), context);
                if !raw.is_null() {
                    ffi::SUNLinSol_SPGMRSetMaxRestarts(raw, n(restarts));
                }
                ("SUNLinSol_SPGMR", raw, solve_by_gmres)
            }
            KrylovMethod::Fgmres { dimension, restarts } => {
                let raw = ffi::SUNLinSol_SPFGMR(template, side, n(dimension), context);
                if !raw.is_null() {
                    ffi::SUNLinSol_SPFGMRSetMaxRestarts(raw, n(restarts));
                }
                ("SUNLinSol_SPFGMR", raw, solve_by_fgmres)
            }
            KrylovMethod::BiCgStab { iterations } => {
                let raw = ffi::SUNLinSol_SPBCGS(template, side, n(iterations), context);
                ("SUNLinSol_SPBCGS", raw, solve_by_bicgstab)
            }
            KrylovMethod::Tfqmr { iterations } => {
                let raw = ffi::SUNLinSol_SPTFQMR(template, side, n(iterations), context);
                ("SUNLinSol_SPTFQMR", raw, solve_by_tfqmr)
            }
            KrylovMethod::ConjugateGradients { iterations } => {
                let raw = ffi::SUNLinSol_PCG(template, side, n(iterations), context);
                ("SUNLinSol_PCG", raw, solve_by_conjugate_gradients)
            }
        }
    };
    if !raw.is_null() {
        // SAFETY: the operations table of a new solver is writable.
        unsafe { (*(*raw).ops).solve = Some(solve) };
    }
    (name, raw)
}

/// The `solve` operation of a linear solver: (solver, matrix, x, b, tolerance).
type KrylovSolve = unsafe extern "C" fn(
    ffi::SUNLinearSolver,
    ffi::SUNMatrix,
    ffi::N_Vector,
    ffi::N_Vector,
    f64,
) -> i32;

/// The `solve` operations of Krylov methods, with codes that all integrators understand.
macro_rules! solve_operations {
    ($($name:ident: $solve:ident;)+) => {$(
        unsafe extern "C" fn $name(
            solver: ffi::SUNLinearSolver,
            matrix: ffi::SUNMatrix,
            x: ffi::N_Vector,
            b: ffi::N_Vector,
            tolerance: f64,
        ) -> i32 {
            // SAFETY: SUNDIALS calls the operation as it would this function.
            known(unsafe { ffi::$solve(solver, matrix, x, b, tolerance) })
        }
    )+};
}

solve_operations! {
    solve_by_gmres: SUNLinSolSolve_SPGMR;
    solve_by_fgmres: SUNLinSolSolve_SPFGMR;
    solve_by_bicgstab: SUNLinSolSolve_SPBCGS;
    solve_by_tfqmr: SUNLinSolSolve_SPTFQMR;
    solve_by_conjugate_gradients: SUNLinSolSolve_PCG;
}

/// Replaces the codes of a failed product, which IDA takes for success.
fn known(code: i32) -> i32 {
    const RETRY_PRODUCT: i32 = ffi::SUNLS_ATIMES_FAIL_REC as i32;
    match code {
        RETRY_PRODUCT => ffi::SUNLS_PSOLVE_FAIL_REC as i32,
        ffi::SUNLS_ATIMES_FAIL_UNREC => ffi::SUNLS_PSOLVE_FAIL_UNREC,
        code => code,
    }
}

/// A linear solver whose factorization happens in the integrator's matrix callback and whose
/// `solve` calls the user's system.
///
/// # Safety
/// `context` is alive, and `data` is a [`Host<S>`] that outlives the result.
unsafe fn custom<S>(context: ffi::SUNContext, data: *mut c_void) -> ffi::SUNLinearSolver {
    extern "C" fn kind(_: ffi::SUNLinearSolver) -> ffi::SUNLinearSolver_Type {
        ffi::SUNLinearSolver_Type_SUNLINEARSOLVER_DIRECT
    }
    extern "C" fn id(_: ffi::SUNLinearSolver) -> ffi::SUNLinearSolver_ID {
        ffi::SUNLinearSolver_ID_SUNLINEARSOLVER_CUSTOM
    }
    extern "C" fn nothing(_: ffi::SUNLinearSolver) -> i32 {
        0
    }
    extern "C" fn setup(_: ffi::SUNLinearSolver, _: ffi::SUNMatrix) -> i32 {
        0
    }
    unsafe extern "C" fn free(solver: ffi::SUNLinearSolver) -> i32 {
        // SAFETY: called once, by SUNLinSolFree; the content belongs to the integrator, so it
        // is only forgotten here.
        unsafe {
            (*solver).content = ptr::null_mut();
            ffi::SUNLinSolFreeEmpty(solver);
        }
        0
    }
    // SAFETY: the operations table of a new solver is writable.
    unsafe {
        let solver = ffi::SUNLinSolNewEmpty(context);
        if !solver.is_null() {
            let ops = &mut *(*solver).ops;
            ops.gettype = Some(kind);
            ops.getid = Some(id);
            ops.initialize = Some(nothing);
            ops.setup = Some(setup);
            ops.solve = Some(solve::<S>);
            ops.free = Some(free);
            (*solver).content = data;
        }
        solver
    }
}

/// The `solve` operation of a user-supplied linear solver, whose content is the [`Host`].
unsafe extern "C" fn solve<S>(
    solver: ffi::SUNLinearSolver,
    _: ffi::SUNMatrix,
    x: ffi::N_Vector,
    b: ffi::N_Vector,
    _: f64,
) -> i32 {
    // SAFETY: the content is the host of the integrator, which outlives the linear solver;
    // SUNDIALS passes two different vectors of its length.
    let (host, x, b) = unsafe { (Host::<S>::of((*solver).content), slice_mut(x), slice(b)) };
    x.copy_from_slice(b);
    let Some(custom) = &host.custom_solve else { return ffi::SUNLS_PACKAGE_FAIL_UNREC };
    let (newton_solve, mut parameter) = (custom.solve, f64::NAN);
    // SAFETY: the memory is that of the integrator which is calling; it only reads a number.
    unsafe { (custom.step_parameter.1)(custom.memory, &raw mut parameter) };
    let call = |system: &mut S, x: &mut [f64]| newton_solve(system, parameter, x);
    // SUNDIALS takes unknown codes of a linear solver for success.
    let outcome = match host.guard_output(Callback::NewtonSolve, host.setup_time, x, call) {
        0 => host.check_answer(b, x),
        failed => failed,
    };
    match outcome {
        RETRY => ffi::SUNLS_PACKAGE_FAIL_REC as i32,
        STOP => ffi::SUNLS_PACKAGE_FAIL_UNREC,
        _ => 0,
    }
}

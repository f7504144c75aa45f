//! Linear solvers for the Newton iteration.

use std::ffi::c_void;

use super::{
    context::Context,
    error::{Callback, Error},
    ffi,
    host::{Host, RETRY, STOP},
    matrix::Matrix,
    pattern::Pattern,
    vector::{Vector, slice, slice_mut},
};

/// Where the entries of a Jacobian come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jacobian {
    /// Difference quotients of the right-hand side or residual: n extra evaluations for a dense
    /// matrix, `lower + upper + 1` for a band.
    DifferenceQuotients,
    /// The system's own `dense_jacobian` or `banded_jacobian`.
    Supplied,
}

/// How the linear systems of the Newton iteration are solved.
///
/// User guide: chapter "Linear Algebraic Solvers", SUNLinearSolver.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum LinearSolver {
    /// LU factorization of a dense matrix: n^2 numbers, n^3 work. For small systems.
    Dense(Jacobian),
    /// LU factorization of a band matrix; entry (i, j) may be nonzero where
    /// `j - upper <= i <= j + lower`.
    Band {
        /// Diagonals below the main one.
        lower: usize,
        /// Diagonals above the main one.
        upper: usize,
        /// Where the entries come from.
        jacobian: Jacobian,
    },
    /// Sparse LU factorization by KLU with the system's own `sparse_jacobian`.
    Klu(Pattern),
    /// The system's own `newton_setup` and `newton_solve`: the way to exploit structure that
    /// a matrix of entries hides.
    Custom,
}

impl LinearSolver {
    /// Stops what C would crash on.
    pub(super) fn check(&self, n: usize) -> Result<(), Error> {
        match self {
            Self::Dense(_) if !is_addressable(n, n) => Err(Error::input(
                "number of unknowns",
                n,
                "a dense matrix of that size does not fit into any memory: choose a band, a sparse \
                 or a custom linear solver",
            )),
            Self::Band { lower, upper, .. } if *lower >= n || *upper >= n => Err(Error::input(
                "bandwidths (lower, upper)",
                format!("({lower}, {upper})"),
                format!("both have to be smaller than the number of unknowns, {n}"),
            )),
            Self::Band { lower, upper, .. } if !is_addressable(n, band_rows(*lower, *upper)) => {
                Err(Error::input(
                    "bandwidths (lower, upper)",
                    format!("({lower}, {upper})"),
                    format!("with {n} unknowns the band does not fit into any memory"),
                ))
            }
            Self::Klu(pattern) if pattern.dimension() != n => Err(Error::input(
                "dimension of the sparsity pattern",
                pattern.dimension(),
                format!("it has to be the number of unknowns, {n}"),
            )),
            _ => Ok(()),
        }
    }

    /// Whether the matrix is filled by a callback (and not by SUNDIALS' difference quotients).
    pub(super) fn has_jacobian_callback(&self) -> bool {
        match self {
            Self::Dense(jacobian) | Self::Band { jacobian, .. } => *jacobian == Jacobian::Supplied,
            Self::Klu(_) | Self::Custom => true,
        }
    }
}

/// Rows of the stored band: as many diagonals as LU factorization with pivoting needs.
fn band_rows(lower: usize, upper: usize) -> usize {
    lower.saturating_mul(2).saturating_add(upper).saturating_add(1)
}

/// Whether C can count the bytes of a matrix of `n` columns of `rows` numbers.
fn is_addressable(n: usize, rows: usize) -> bool {
    let bytes = n.checked_mul(rows).and_then(|count| count.checked_mul(size_of::<f64>()));
    bytes.is_some_and(|bytes| isize::try_from(bytes).is_ok())
}

/// Owns a `SUNLinearSolver` and the matrix it factorizes, freed in this order.
pub(super) struct Linear {
    solver: RawSolver,
    matrix: Matrix,
}

struct RawSolver(ffi::SUNLinearSolver);

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
        let (y, m, c) = (template.raw(), matrix.raw(), context.raw());
        let (function, raw) = match kind {
            // SAFETY: vector, matrix and context are alive and fit together.
            LinearSolver::Dense(_) => ("SUNLinSol_Dense", unsafe { ffi::SUNLinSol_Dense(y, m, c) }),
            // SAFETY: as above.
            LinearSolver::Band { .. } => {
                ("SUNLinSol_Band", unsafe { ffi::SUNLinSol_Band(y, m, c) })
            }
            // SAFETY: as above.
            LinearSolver::Klu(_) => ("SUNLinSol_KLU", unsafe { ffi::SUNLinSol_KLU(y, m, c) }),
            // SAFETY: the context is alive; the caller vouches for `data`.
            LinearSolver::Custom => ("SUNLinSolNewEmpty", unsafe { custom::<S>(c, data) }),
        };
        if raw.is_null() {
            return Err(Error::out_of_memory(function));
        }
        Ok(Self { solver: RawSolver(raw), matrix })
    }

    pub(super) fn solver(&self) -> ffi::SUNLinearSolver {
        self.solver.0
    }

    pub(super) fn matrix(&self) -> ffi::SUNMatrix {
        self.matrix.raw()
    }
}

impl Drop for RawSolver {
    fn drop(&mut self) {
        // SAFETY: made by a SUNLinearSolver constructor and freed once.
        unsafe { ffi::SUNLinSolFree(self.0) };
    }
}

/// A linear solver whose factorization happens in the integrator's matrix callback and whose
/// `solve` asks the user's system.
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
            (*solver).content = std::ptr::null_mut();
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
    let (host, x) = unsafe {
        let host = &mut *(*solver).content.cast::<Host<S>>();
        let n = host.n;
        let x = slice_mut(x, n);
        x.copy_from_slice(slice(b, n));
        (host, x)
    };
    let Some(newton) = &host.newton else { return ffi::SUNLS_PACKAGE_FAIL_UNREC };
    let (newton_solve, mut parameter) = (newton.solve, f64::NAN);
    // SAFETY: the memory is that of the integrator which is calling; it only reads a number.
    unsafe { (newton.step_parameter)(newton.memory, &raw mut parameter) };
    let call = |system: &mut S, x: &mut [f64]| newton_solve(system, parameter, x);
    // SUNDIALS takes codes that it does not know from a linear solver for success.
    match host.guard_output(Callback::NewtonSolve, host.setup_time, x, call) {
        RETRY => ffi::SUNLS_PACKAGE_FAIL_REC as i32,
        STOP => ffi::SUNLS_PACKAGE_FAIL_UNREC,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::{Jacobian, LinearSolver};

    /// n^2 numbers of 8 bytes are more than 2^63 from n = 2^30 on: products that C would not notice.
    #[test]
    fn matrices_whose_size_overflows_are_refused() {
        let dense = LinearSolver::Dense(Jacobian::Supplied);
        assert!(dense.check(1 << 29).is_ok());
        assert!(dense.check(1 << 30).is_err());
        let band =
            |half| LinearSolver::Band { lower: half, upper: half, jacobian: Jacobian::Supplied };
        assert!(band(1).check(1 << 40).is_ok());
        assert!(band((1 << 40) - 1).check(1 << 40).is_err());
        assert!(band(usize::MAX / 2).check(usize::MAX).is_err());
    }
}

//! The factors of I - gamma df/dy, dense, sparse or of band form, for methods that are not of SUNDIALS.

use std::ptr;

use super::{
    context::Context, linear::Linear, linear_solver::LinearSolver, stored_matrix::StoredMatrix,
    vector::Vector,
};
use crate::base::input::InputError;
use crate::integrators::common::Error;

/// The factors of I - gamma df/dy, by a linear solver of SUNDIALS. A sparse matrix is analysed once, for all
/// factorizations.
pub(crate) struct Factors {
    solver: LinearSolver,
    // what SUNDIALS owns, in the order in which it has to be freed
    linear: Linear,
    rhs: Vector,
    _context: Context,
}

// SAFETY: the raw pointers lead to objects that these factors alone own, among them their SUNContext; SUNDIALS
// keeps no thread-local state.
unsafe impl Send for Factors {}

impl Factors {
    /// For `n` unknowns.
    pub(crate) fn new(solver: &LinearSolver, n: usize) -> Result<Self, Error> {
        if matches!(solver, LinearSolver::Krylov(_) | LinearSolver::Custom) {
            let help =
                "this method factorizes its matrix: take a dense, a band or a sparse one (KLU)";
            return Err(InputError::new("linear solver", format!("{solver:?}"), help).into());
        }
        let context = Context::new()?;
        let rhs = Vector::from_slice(&vec![0.0; n], &context)?;
        // SAFETY: only a solver that calls the system needs its data.
        let linear = unsafe { Linear::new::<()>(solver, &rhs, &context, ptr::null_mut())? };
        Ok(Self { solver: solver.clone(), linear, rhs, _context: context })
    }

    /// Factorizes I - gamma J, where J has the form of the linear solver; `false` if it is singular.
    pub(crate) fn factorize(&mut self, jacobian: &StoredMatrix, gamma: f64) -> bool {
        let Self { solver, linear, rhs, .. } = self;
        let n = rhs.as_slice().len();
        // SAFETY: the linear solver was made for this kind of matrix and for vectors of this length.
        unsafe { linear.factorize(solver, n, |entries| jacobian.write_shifted(gamma, entries)) }
    }

    /// Replaces `r` by the solution, after [`factorize`](Self::factorize). Returns whether there is one.
    pub(crate) fn solve(&mut self, r: &mut [f64]) -> bool {
        self.rhs.as_mut_slice().copy_from_slice(r);
        let is_solved = self.linear.solve(&mut self.rhs);
        r.copy_from_slice(self.rhs.as_slice());
        is_solved
    }
}

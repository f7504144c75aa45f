//! The matrix I - gamma df/dy, sparse or of band form, for methods that are not of SUNDIALS.

use std::{fmt, ptr};

use super::{
    context::Context, differences::Differences, linear::Linear, linear_solver::LinearSolver,
    stored_matrix::StoredMatrix, vector::Vector,
};
use crate::base::input::InputError;
use crate::integrators::{
    common::{Error, Tolerances},
    ode::{Failure, Ode, call},
};

/// df/dy and the factors of I - gamma df/dy, by a linear solver of SUNDIALS. A sparse matrix is analysed
/// once, for all factorizations.
pub(crate) struct NewtonMatrix {
    solver: LinearSolver,
    jacobian: StoredMatrix,
    differences: Option<Differences>,
    // what SUNDIALS owns, in the order in which it has to be freed
    linear: Linear,
    rhs: Vector,
    _context: Context,
}

// SAFETY: the raw pointers lead to objects that this matrix alone owns, among them its SUNContext; SUNDIALS
// keeps no thread-local state.
unsafe impl Send for NewtonMatrix {}

impl fmt::Debug for NewtonMatrix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NewtonMatrix").field("solver", &self.solver).finish_non_exhaustive()
    }
}

impl NewtonMatrix {
    /// For `n` unknowns, whose sizes the tolerances give.
    pub(crate) fn new(
        solver: &LinearSolver,
        n: usize,
        tolerances: &Tolerances,
    ) -> Result<Self, Error> {
        if matches!(solver, LinearSolver::Krylov(_) | LinearSolver::Custom) {
            let help =
                "this method factorizes its matrix: take a dense, a band or a sparse one (KLU)";
            return Err(InputError::new("linear solver", format!("{solver:?}"), help).into());
        }
        let context = Context::new()?;
        let rhs = Vector::from_slice(&vec![0.0; n], &context)?;
        // SAFETY: only a solver that calls the system needs its data.
        let linear = unsafe { Linear::new::<()>(solver, &rhs, &context, ptr::null_mut())? };
        let differences = match solver.takes_quotients() {
            true => Differences::of_ode(solver, n, tolerances, &[]),
            false => None,
        };
        let jacobian = StoredMatrix::new(solver, n);
        Ok(Self { solver: solver.clone(), jacobian, differences, linear, rhs, _context: context })
    }

    /// Updates df/dy to (t, y), where f is `slope`. Returns how often f was evaluated.
    pub(crate) fn update<S: Ode>(
        &mut self,
        system: &mut S,
        t: f64,
        [y, slope]: [&[f64]; 2],
    ) -> Result<u64, Failure> {
        let Some(differences) = &mut self.differences else {
            return self.jacobian.entries().jacobian(system, t, y, slope).map(|()| 0);
        };
        let before = differences.evaluations;
        let values = self.jacobian.values_mut();
        differences.of_rhs(y, slope, values, &mut |y, ydot| call::rhs(system, t, y, ydot))?;
        Ok(differences.evaluations - before)
    }

    /// The stored entries of df/dy.
    pub(crate) fn values(&self) -> &[f64] {
        self.jacobian.values()
    }

    /// Writes the product of df/dy with `v`.
    pub(crate) fn multiply(&self, v: &[f64], out: &mut [f64]) {
        self.jacobian.multiply(v, out);
    }

    /// Factorizes I - gamma df/dy; `false` if it is singular.
    pub(crate) fn factorize(&mut self, gamma: f64) -> bool {
        let Self { solver, jacobian, linear, rhs, .. } = self;
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

//! Storage for products with transposed matrices in place of their entries, for Krylov methods.

use crate::integrators::sundials::{LinearSolver, ilu::IncompleteLu};

/// Storage for products.
pub(super) struct Products {
    /// The preconditioner of the backward run.
    pub(super) ilu: Option<IncompleteLu>,
    /// Time, state and its derivative at the start.
    pub(super) start: (f64, Vec<f64>, Vec<f64>),
    /// A direction of y', and the product of dF/dy' with it.
    pub(super) direction: Vec<f64>,
    pub(super) product: Vec<f64>,
    /// The time at which that was compared last.
    pub(super) checked: Option<f64>,
}

impl Products {
    /// For `n` unknowns and this linear solver of the backward run; none for one with a matrix.
    pub(super) fn new(backward: &LinearSolver, n: usize) -> Option<Self> {
        let LinearSolver::Krylov(_) = backward else { return None };
        let zeros = || vec![0.0; n];
        Some(Self {
            ilu: backward.ilu().map(|(pattern, _)| IncompleteLu::new(pattern)),
            start: (0.0, zeros(), zeros()),
            direction: zeros(),
            product: zeros(),
            checked: None,
        })
    }
}

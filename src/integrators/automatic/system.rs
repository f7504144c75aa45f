//! Equations with their parameters and the form of their Jacobian.

use std::fmt;

use super::workspace::{LANES, Workspace};
use crate::integrators::{
    ode::{BandMut, Failure, Storage},
    sundials::{Colouring, Jacobian, LinearSolver, Pattern, Shape},
};

/// Equations with exact derivatives, made by [`automatic`]: an [`Ode`](crate::integrators::ode::Ode) of a
/// [`RightHandSide`](super::RightHandSide), a [`Dae`](crate::integrators::ode::Dae) of a [`Residual`](super::Residual).
pub struct Automatic<E> {
    pub(super) equations: E,
    pub(super) parameters: Vec<f64>,
    solver: LinearSolver,
    pub(super) shape: Shape,
    /// Columns that are differentiated at once; none before the first Jacobian.
    pub(super) colouring: Option<Colouring>,
    pub(super) many: Workspace<LANES>,
    pub(super) one: Workspace<1>,
}

impl<E> fmt::Debug for Automatic<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Automatic")
            .field("parameters", &self.parameters)
            .field("solver", &self.solver)
            .finish_non_exhaustive()
    }
}

/// The ODE y' = f(t, y, p) or the DAE F(t, y, y', p) = 0 with the parameters `p` (none: `[]`) and a dense Jacobian:
/// [`banded`](Automatic::banded) and [`sparse`](Automatic::sparse) give it another form.
///
/// [`solve`](fn@crate::integrators::solve::solve) uses the Jacobian where no linear solver is given; the integrators below it take
/// [`linear_solver`](Automatic::linear_solver).
pub fn automatic<E>(equations: E, p: impl Into<Vec<f64>>) -> Automatic<E> {
    let solver = LinearSolver::Dense(Jacobian::Supplied);
    let (colouring, many, one) = (None, Workspace::default(), Workspace::default());
    Automatic { equations, parameters: p.into(), solver, shape: Shape::Dense, colouring, many, one }
}

impl<E> Automatic<E> {
    /// With a Jacobian of band form: entry (i, j) may be nonzero where `j - upper <= i <= j + lower`. It takes an evaluation for each
    /// four of its diagonals.
    #[must_use]
    pub fn banded(self, lower: usize, upper: usize) -> Self {
        self.of(LinearSolver::Band { lower, upper, jacobian: Jacobian::Supplied })
    }

    /// With a sparse Jacobian. It takes an evaluation for each four colours of its columns, of which those that share no row have the same.
    ///
    /// [`Pattern::ode_by_sampling`] and [`Pattern::ode_by_nan`], or those for DAEs, find the pattern, of these equations, too.
    #[must_use]
    pub fn sparse(self, pattern: Pattern) -> Self {
        self.of(LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied })
    }

    fn of(self, solver: LinearSolver) -> Self {
        let shape = Shape::of(&solver).unwrap_or(Shape::Dense);
        Self { solver, shape, colouring: None, ..self }
    }

    /// The linear solver that takes the Jacobian as it is.
    #[must_use]
    pub fn linear_solver(&self) -> LinearSolver {
        self.solver.clone()
    }

    /// The form of the Jacobian.
    pub(super) fn storage(&self) -> Storage<'_> {
        match &self.solver {
            &LinearSolver::Band { lower, upper, .. } => Storage::Band { lower, upper },
            LinearSolver::Klu { pattern, .. } => Storage::Sparse {
                column_pointers: pattern.column_pointers(),
                row_indices: pattern.row_indices(),
            },
            _ => Storage::Dense,
        }
    }

    /// Refuses a band of another form than that of the Jacobian.
    pub(super) fn check_band(&self, matrix: &BandMut<'_>) -> Result<(), Failure> {
        let widths = (matrix.lower(), matrix.upper());
        Self::check(matches!(self.shape, Shape::Band { lower, upper } if (lower, upper) == widths))
    }

    /// Refuses a sparse matrix of another form than that of the Jacobian.
    pub(super) fn check_sparse(&self, values: &[f64]) -> Result<(), Failure> {
        Self::check(
            matches!(&self.shape, Shape::Sparse(pattern) if pattern.entry_count() == values.len()),
        )
    }

    fn check(fits: bool) -> Result<(), Failure> {
        if fits {
            return Ok(());
        }
        let text = "the band or pattern of the linear solver is not that of the equations: Automatic::linear_solver gives the right one";
        Err(Failure::Fatal(text.into()))
    }
}

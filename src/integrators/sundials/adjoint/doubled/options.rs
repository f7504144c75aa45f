//! Options of the runs of y and s.

use super::line::Line;
use crate::base::input::InputError;
use crate::integrators::{
    common::{AbsoluteTolerance, Tolerances},
    sundials::{
        Jacobian, LinearSolver, Pattern, Sign,
        adjoint::{options::AdjointOptions, setup::Runs},
        options::SolverOptions,
    },
};

impl<O: Clone> Runs<SolverOptions<O>> {
    /// The options of the runs of y and s forward and back, for these parameters.
    pub(in crate::integrators::sundials::adjoint) fn doubled(
        &self,
        line: &Line,
        p: &[f64],
    ) -> Result<(SolverOptions<O>, AdjointOptions), InputError> {
        let (n, forward, back) = (self.start.1.len(), &self.forward, &self.options);
        if forward.weights.is_some() {
            let help = "the product of a Hessian has other unknowns, too: leave them out";
            return Err(InputError::new("error_weights", "given", help));
        }
        let mut both = forward.clone().check_jacobian(false);
        both.linear_solver = doubled_solver(&forward.linear_solver, n)?;
        both.tolerances = doubled_tolerances(&forward.tolerances, n, [1.0, line.scale]);
        if !both.signs.is_empty() {
            both.signs.resize(2 * n, Sign::Free);
        }
        let Tolerances { rtol, atol } = back.tolerances_for(p);
        let mut options = back.clone().supplied_parameters();
        options.supplied_rhs = false;
        // the multipliers of s are those of a gradient
        options.tolerances = doubled_tolerances(&back.tolerances, n, [line.scale, 1.0]);
        Ok((both, options.gradient_tolerances(rtol, scaled(&atol, p.len(), line.scale))))
    }
}

/// Tolerances of two vectors, whose sizes are those of the `n` unknowns that have `tolerances` times one of these scales.
fn doubled_tolerances(tolerances: &Tolerances, n: usize, scales: [f64; 2]) -> Tolerances {
    let both = scales.map(|scale| scaled(&tolerances.atol, n, scale));
    Tolerances::new(tolerances.rtol, both.concat())
}

fn scaled(atol: &AbsoluteTolerance, n: usize, scale: f64) -> Vec<f64> {
    match atol {
        AbsoluteTolerance::Scalar(atol) => vec![atol * scale; n],
        AbsoluteTolerance::Vector(atol) => atol.iter().map(|atol| atol * scale).collect(),
    }
}

/// The linear solver for y and s, whose matrix is supplied.
fn doubled_solver(solver: &LinearSolver, n: usize) -> Result<LinearSolver, InputError> {
    let jacobian = Jacobian::Supplied;
    let klu = |pattern: &Pattern| {
        let columns = (0..n).flat_map(|j| pattern.column(j).iter().map(move |&i| (i as usize, j)));
        let blocks = columns.flat_map(|(i, j)| [(i, j), (n + i, j), (n + i, n + j)]);
        Ok(LinearSolver::Klu { pattern: Pattern::from_entries(2 * n, blocks)?, jacobian })
    };
    match solver {
        LinearSolver::Dense(_) => Ok(LinearSolver::Dense(jacobian)),
        LinearSolver::Band { lower, upper, .. } => klu(&Pattern::band(n, *lower, *upper)?),
        LinearSolver::Klu { pattern, .. } => klu(pattern),
        other => {
            let help = "the product of a Hessian needs entries of the Jacobian: choose a dense, a band or a sparse one";
            Err(InputError::new("linear solver", format!("{other:?}"), help))
        }
    }
}

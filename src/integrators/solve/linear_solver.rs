//! The linear solver where none was given: that of the Jacobian that the equations supply; or, of many unknowns, a sparse one, on a pattern
//! that is found by changes of the unknowns.

use std::borrow::Cow;

use super::{method::Method, options::Options, problem::Equations};
use crate::base::input::InputError;
use crate::integrators::sundials::{Jacobian, LinearSolver, Pattern};

/// The largest number of unknowns whose matrix is dense in any case.
const FEW: usize = 500;
/// The largest part of the entries that a sparse matrix has: fuller ones are dense.
const SPARSE: f64 = 0.2;
/// Changes of the unknowns, relative to their sizes. The larger one shows entries that vanish at the start; where it leads out of the
/// domain of the equations, the smaller one has to do, which is one of difference quotients.
const SPREADS: [f64; 2] = [1e-2, 1e-7];

impl Options {
    /// These options, with a linear solver where none is given and the method solves linear systems: that of the Jacobian that the
    /// equations supply. Without one it is sparse if there are many unknowns, few of which occur in each equation. Entries that the pattern
    /// lacks, as the equations do not depend on them at the start, are found by the [check](Self::check_jacobian) of the Jacobians later on.
    pub(super) fn with_linear_solver(
        &self,
        method: Method,
        equations: &mut Equations<'_>,
        t: f64,
        y: &[f64],
    ) -> Result<Cow<'_, Self>, InputError> {
        if !method.information().is_implicit || self.linear_solver.is_some() || equations.has_mass()
        {
            return Ok(Cow::Borrowed(self));
        }
        let supplied = match &*equations {
            Equations::Ode(system) => system.supplied_jacobian(),
            Equations::Dae { system, .. } => system.supplied_jacobian(),
        };
        let solver = match supplied {
            Some(supplied) => Some(LinearSolver::of_supplied(supplied)?),
            None if y.len() > FEW => self.found(equations, t, y),
            None => None,
        };
        let with = |solver| Cow::Owned(self.clone().linear_solver(solver));
        Ok(solver.map_or(Cow::Borrowed(self), with))
    }

    /// A sparse linear solver, on the pattern of the equations at the start.
    fn found(&self, equations: &mut Equations<'_>, t: f64, y: &[f64]) -> Option<LinearSolver> {
        let found = SPREADS.iter().find_map(|part| self.pattern(equations, t, y, *part));
        let most = SPARSE * (y.len() as f64).powi(2);
        let pattern = found.filter(|pattern| (pattern.entry_count() as f64) < most)?;
        Some(LinearSolver::Klu { pattern, jacobian: Jacobian::DifferenceQuotients })
    }

    /// The pattern of the equations where all unknowns are farther from zero, by up to twice this part of their sizes; none where they have
    /// no values.
    fn pattern(
        &self,
        equations: &mut Equations<'_>,
        t: f64,
        y: &[f64],
        part: f64,
    ) -> Option<Pattern> {
        let spread = |i: usize| part * self.tolerances.size_of(i, y[i]);
        let spreads: Vec<f64> = (0..y.len()).map(spread).collect();
        let away: Vec<f64> = y.iter().zip(&spreads).map(|(y, s)| y + s.copysign(*y)).collect();
        let found = match equations {
            Equations::Ode(system) => {
                Pattern::ode_by_sampling(system.as_mut(), t, &away, &spreads, 1)
            }
            Equations::Dae { system, yp, .. } => {
                let slopes: Vec<f64> =
                    yp.iter().zip(&spreads).map(|(yp, s)| part * yp.abs() + s).collect();
                let (at, spreads) = ((&away[..], &yp[..]), (&spreads[..], &slopes[..]));
                Pattern::dae_by_sampling(system.as_mut(), t, at, spreads, 1)
            }
        };
        found.ok()
    }
}

//! The linear solver of many unknowns for which none was given: sparse, on a pattern that is found by changes of the unknowns.

use std::borrow::Cow;

use super::{method::Method, options::Options, problem::Equations};
use crate::integrators::sundials::{Jacobian, LinearSolver, Pattern};

/// The largest number of unknowns whose matrix is dense in any case.
const FEW: usize = 500;
/// The largest part of the entries that a sparse matrix has: fuller ones are dense.
const SPARSE: f64 = 0.2;
/// Changes of the unknowns, relative to their sizes. The larger one shows entries that vanish at the start; where it leads out of the
/// domain of the equations, the smaller one has to do, which is one of difference quotients.
const SPREADS: [f64; 2] = [1e-2, 1e-7];

impl Options {
    /// These options, with a sparse linear solver where none is given, the method solves linear systems, and there are many unknowns, few of
    /// which occur in each equation. Entries that the pattern lacks, as the equations do not depend on them at the start, are found by the
    /// [check](Self::check_jacobian) of the Jacobians later on.
    pub(super) fn with_pattern(
        &self,
        method: Method,
        equations: &mut Equations<'_>,
        t: f64,
        y: &[f64],
    ) -> Cow<'_, Self> {
        let n = y.len();
        if n <= FEW || method.is_explicit() || self.linear_solver.is_some() || equations.has_mass()
        {
            return Cow::Borrowed(self);
        }
        let found = SPREADS.iter().find_map(|part| self.pattern(equations, t, y, *part));
        let most = SPARSE * (n as f64).powi(2);
        match found.filter(|pattern| (pattern.entry_count() as f64) < most) {
            Some(pattern) => {
                let jacobian = Jacobian::DifferenceQuotients;
                Cow::Owned(self.clone().linear_solver(LinearSolver::Klu { pattern, jacobian }))
            }
            None => Cow::Borrowed(self),
        }
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

//! Root functions are followed on the dense output.

use std::mem::take;

use super::dormand_prince::DormandPrince;
use super::stages::stopped;
use crate::integrate::{Cause, FollowsRoots, IntegrationError, Roots};
use crate::ode::Ode;

impl<S: Ode> FollowsRoots for DormandPrince<S> {
    type System = S;

    fn roots_mut(&mut self) -> &mut Roots {
        &mut self.roots
    }

    fn span(&self) -> [f64; 2] {
        [self.t_old, self.t]
    }

    fn parts(&mut self) -> (&mut S, [&[f64]; 2], &mut [f64]) {
        (&mut self.system, [&self.y, &self.k[0]], &mut self.argument)
    }

    fn interpolate_inside(&mut self, t: f64) {
        let mut y = take(&mut self.argument);
        self.interpolate_state(t, &mut y);
        self.argument = y;
    }

    fn count_root_evaluation(&mut self) {
        self.statistics.root_evaluations += 1;
    }

    fn halt(&self, cause: Cause, step: f64) -> IntegrationError {
        stopped(cause, [self.t, step])
    }
}

//! The equations of the phases of a scene.

use std::sync::Arc;

use super::System;
use crate::base::input::InputError;
use crate::dynamics::matrices::Matrices;
use crate::elements::force::Forces;
use crate::scene::constraint::PhaseStart;
use crate::scene::timeline::{Phase, Scene};

impl Scene {
    /// The matrices of the scene under the forces of its phases.
    pub(crate) fn matrices(&self, forces: &[Forces]) -> Arc<Matrices> {
        let all = forces.iter().flatten().map(|force| &**force);
        let mut matrices = Matrices::new(self.body(), all);
        let of_first_phase = forces.first().into_iter().flatten();
        of_first_phase.for_each(|force| matrices.carry(force.capabilities().carried));
        Arc::new(matrices)
    }

    /// The equations of one phase under its forces, in all unknowns.
    pub(crate) fn system(
        &self,
        matrices: &Arc<Matrices>,
        phase: &Phase,
        forces: Forces,
        start: &PhaseStart,
        alpha: f64,
    ) -> Result<System, InputError> {
        let rows = self.rows(phase, start)?;
        let mut system = System::new(matrices.clone(), forces, rows, alpha, &phase.name)?;
        if system.tears_apart(start.time, start.u) {
            let input = format!("constraints of phase \"{}\"", phase.name);
            let help = "a rigid piece keeps its shape: move it as a whole, or fewer of its nodes";
            return Err(InputError::new(input, "moving nodes of a rigid piece apart", help));
        }
        Ok(system)
    }
}

//! The equations of a phase as the interface of a run, in any unknowns.

use super::{Energy, ResidualSnapshot, Spectrum, System};
use crate::elements::force::Forces;
use crate::integrators::ode::Failure;

/// The equations of a phase, in all unknowns or in those of a reduced model. Where nothing else is said they are those in all
/// unknowns.
pub(crate) trait PhaseSystem: Send {
    /// The equations in all unknowns.
    fn full(&self) -> &System;

    /// As [`full`](Self::full), to be changed.
    fn full_mut(&mut self) -> &mut System;

    /// Number of displacements among the unknowns.
    fn freedoms(&self) -> usize {
        self.full().dofs()
    }

    /// Replaces the forces, if the matrices have entries for them; all else is unchanged. Returns whether they have.
    fn change_forces(&mut self, forces: Forces) -> bool {
        self.full_mut().change_forces(forces)
    }

    /// Marks the tangents as out of date.
    fn forget_tangents(&mut self) {
        self.full_mut().forget_tangents();
    }

    /// Kinetic and potential energies of a state (u, v, internal unknowns); dissipated and supplied are left at 0.
    fn energy(&self, t: f64, [u, v, internal]: [&[f64]; 3]) -> Energy {
        self.full().energy(t, u, v, internal)
    }

    /// Evaluates accelerations (m/s^2) and constraint forces (N) in a state (u, v, internal unknowns): [`full`](Self::full) has them.
    fn evaluate(&mut self, t: f64, [u, v, internal]: [&[f64]; 3]) -> Result<(), Failure> {
        self.full_mut().evaluate(t, u, v, internal)
    }

    /// The spectrum at (t, u, v).
    fn spectrum(&mut self, t: f64, u: &[f64], v: &[f64]) -> Spectrum {
        self.full_mut().spectrum(t, u, v)
    }

    /// The residual of a reduced model in the `state` at time `t`, if a check is due in the phase from `start` to `end` (s).
    fn left_over(
        &mut self,
        _t: f64,
        _state: &[f64],
        _phase: [f64; 2],
    ) -> Result<Option<ResidualSnapshot>, Failure> {
        Ok(None)
    }

    /// Starts the counts below from 0.
    fn forget_counts(&mut self) {
        self.full_mut().forget_counts();
    }

    /// Number of evaluations of the tangents so far; 0 where they are constant.
    fn tangent_evaluations(&self) -> usize {
        self.full().tangent_evaluations()
    }

    /// Number of evaluations for the tangents of forces that do not compute them.
    fn difference_evaluations(&self) -> usize {
        self.full().difference_evaluations()
    }
}

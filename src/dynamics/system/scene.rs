//! The equations of the phases of a scene, and how fast a body can move by them.

use std::sync::Arc;

use super::{Spectrum, System};
use crate::base::input::InputError;
use crate::dynamics::matrices::Matrices;
use crate::elements::force::Forces;
use crate::scene::constraint::{ConstraintRow, PhaseStart};
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

    /// The equations of one phase under its forces.
    pub(crate) fn system(
        &self,
        matrices: &Arc<Matrices>,
        phase: &Phase,
        forces: Forces,
        start: &PhaseStart,
        alpha: f64,
    ) -> Result<System, InputError> {
        let rows = self.rows(phase, start)?;
        let mut system = self.system_by(matrices, forces, rows, alpha, &phase.name)?;
        if system.tears_apart(start.time, start.u) {
            let input = format!("constraints of phase \"{}\"", phase.name);
            let help = "a rigid piece keeps its shape: move it as a whole, or fewer of its nodes";
            return Err(InputError::new(input, "moving nodes of a rigid piece apart", help));
        }
        Ok(system)
    }

    /// The equations of the phase `name` under its forces and the `rows` of its constraints, by the reduced model of the
    /// scene if it has one.
    pub(crate) fn system_by(
        &self,
        matrices: &Arc<Matrices>,
        forces: Forces,
        rows: Vec<ConstraintRow>,
        alpha: f64,
        name: &str,
    ) -> Result<System, InputError> {
        let mut system = System::new(matrices.clone(), forces, rows, alpha, name)?;
        if let Some(model) = self.shared_reduced_model() {
            system.reduce(self.body(), model, name)?;
        }
        Ok(system)
    }

    /// # Errors
    /// Features of the scene that reduced models do not support; bad input.
    pub(crate) fn check_reducible(&self) -> Result<(), InputError> {
        let forces = self.forces()?;
        let (matrices, phase) = (self.matrices(&forces), self.first_phase()?);
        let start = PhaseStart { time: 0.0, u: self.initial_displacements() };
        let first = forces.into_iter().next().unwrap_or_default();
        let unreduced = self.clone().unreduced();
        unreduced.system(&matrices, phase, first, &start, 0.0)?.check_reducible()
    }

    /// How fast the body can move in each phase, in its undeformed shape and at rest.
    ///
    /// It shows what makes a scene stiff, and which method is suitable for it. Orifices count as shut.
    ///
    /// ```
    /// let scene = pliant::samples::square_jump(4)?;
    /// let free = scene.spectrum()?[2];
    /// assert!(free.highest_frequency > 4e3 && free.slowest_period().unwrap() > 0.01);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub fn spectrum(&self) -> Result<Vec<Spectrum>, InputError> {
        let shut = self.with_fixed_amounts();
        let forces = shut.forces()?;
        let matrices = self.matrices(&forces);
        let rest = vec![0.0; self.body().dofs()];
        let mut time = 0.0;
        let spectra = self.phases().iter().zip(forces).map(|(phase, forces)| {
            let start = PhaseStart { time, u: &rest };
            let mut system = self.system(&matrices, phase, forces, &start, 0.0)?;
            let spectrum = system.spectrum(time, &rest, &rest);
            time = phase.until;
            Ok(spectrum)
        });
        spectra.collect()
    }
}

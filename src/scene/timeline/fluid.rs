//! Fluids around the bodies of a scene.

use std::sync::Arc;

use super::{Phase, Scene, unique};
use crate::base::input::{InputError, find};
use crate::elements::force::Forces;
use crate::scene::forces::{Fluid, FluidForce};

impl Scene {
    /// Adds a fluid, which acts on bodies in all phases.
    pub fn fluid(mut self, fluid: Fluid) -> Self {
        let number = self.fluids.len() + 1;
        self.fluids.push(fluid.or_named(format!("fluid {number}")));
        self
    }

    /// The fluids.
    pub fn fluids(&self) -> &[Fluid] {
        &self.fluids
    }

    /// The force of the fluid with a name in `phase`; `input` is where the name was given.
    pub(crate) fn fluid_force(
        &self,
        name: &str,
        phase: &Phase,
        input: &str,
    ) -> Result<FluidForce, InputError> {
        let number = find(name, self.fluids.iter().map(Fluid::name), input, "fluids")?;
        self.fluids[number].force(&self.body, self.gravity_in(phase))
    }

    /// Adds the forces of all fluids.
    pub(super) fn add_fluids(&self, phase: &Phase, forces: &mut Forces) -> Result<(), InputError> {
        unique("fluid", self.fluids.iter().map(Fluid::name))?;
        for fluid in &self.fluids {
            forces.push(Arc::new(fluid.force(&self.body, self.gravity_in(phase))?));
        }
        Ok(())
    }
}

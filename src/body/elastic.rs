//! The elastic and viscous forces that depend on the shape of the body.

use std::sync::Arc;

use super::assembly::Elements;
use super::forces::Terms;
use super::regions::Regions;
use crate::force::{Force, NodalForces, Reservoir, Tangents};
use crate::ode::Failure;
use crate::sparse::BlockMatrix;

/// Elastic forces, forces of objective viscosity, or both.
pub(crate) struct Elastic {
    pub(super) elements: Arc<dyn Elements>,
    pub(super) regions: Arc<Regions>,
    pub(super) terms: Terms,
}

impl Force for Elastic {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.elements.add_forces(&self.regions, self.terms, u, v, forces)
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        self.elements.add_tangents(&self.regions, self.terms, u, v, stiffness, damping);
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        if self.terms.elastic { self.elements.energy(&self.regions, u) } else { 0.0 }
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Strain
    }
}

/// The forces -K u and -B v, element by element.
pub(crate) struct LinearByCells {
    pub(super) elements: Arc<dyn Elements>,
    pub(super) regions: Arc<Regions>,
    pub(super) terms: Terms,
}

impl LinearByCells {
    pub(crate) fn add_forces(
        &self,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.elements.add_linear_forces(&self.regions, self.terms, u, v, forces)
    }

    /// Strain energy (J).
    pub(crate) fn energy(&self, u: &[f64]) -> f64 {
        if self.terms.elastic { self.elements.energy(&self.regions, u) } else { 0.0 }
    }
}

//! The elastic and viscous forces that depend on the shape of the body.

use std::sync::Arc;

use super::cells::{Cells, Law};
use super::regions::Regions;
use crate::force::{Force, NodalForces, Reservoir};
use crate::ode::Failure;
use crate::sparse::BlockMatrix;

/// Forces of Green strain, of objective viscosity, or both.
pub(crate) struct Elastic {
    cells: Arc<dyn Cells>,
    regions: Arc<Regions>,
    law: Law,
}

impl Elastic {
    pub(super) fn new(cells: Arc<dyn Cells>, regions: Arc<Regions>, law: Law) -> Self {
        Self { cells, regions, law }
    }
}

impl Force for Elastic {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.cells.add_forces(&self.regions, self.law, u, v, forces)
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        self.cells.add_tangents(&self.regions, self.law, u, v, stiffness, damping);
    }

    fn is_nonlinear(&self) -> bool {
        true
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        if self.law.green { self.cells.green_energy(&self.regions, u) } else { 0.0 }
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Strain
    }
}

//! The elastic and viscous forces that depend on the shape of the body.

use std::sync::Arc;

use super::assembled::Body;
use super::assembly::Elements;
use super::forces::Terms;
use super::regions::Regions;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Force, NodalForces, Reservoir, Tangents};
use crate::elements::material::{Strain, Viscosity};
use crate::elements::mesh::CellKind;
use crate::integrators::ode::Failure;

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

impl Body {
    /// The elastic and viscous forces that have no constant matrix.
    pub(crate) fn elastic(&self) -> Option<Elastic> {
        let terms = Terms {
            elastic: self.strain != Strain::Cauchy,
            viscous: self.viscosity == Viscosity::Objective && self.regions.are_viscous(),
        };
        let (elements, regions) = (self.elements.clone(), self.regions.clone());
        (terms.elastic || terms.viscous).then_some(Elastic { elements, regions, terms })
    }

    /// The forces -K u and -B v element by element, where that is less work than with the matrices: a row of
    /// K has some 7 blocks in a mesh of triangles, and 15 in one of tetrahedra, which are added up one after
    /// the other.
    pub(crate) fn linear_by_cells(&self) -> Option<LinearByCells> {
        let terms = Terms {
            elastic: self.constant_stiffness().is_some(),
            viscous: self.has_natural_viscosity(),
        };
        let (elements, regions) = (self.elements.clone(), self.regions.clone());
        let is_linear = terms.elastic || terms.viscous;
        (self.is_linear_by_cells() && is_linear).then_some(LinearByCells {
            elements,
            regions,
            terms,
        })
    }

    /// Whether linear forces are less work cell by cell.
    pub(super) fn is_linear_by_cells(&self) -> bool {
        matches!(self.mesh.kind(), CellKind::Triangle | CellKind::Tetrahedron)
    }
}

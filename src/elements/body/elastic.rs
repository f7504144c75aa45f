//! The elastic and viscous forces that depend on the shape of the body.

use std::collections::BTreeMap;
use std::sync::Arc;

use faer::Mat;

use super::assembled::Body;
use super::continuum::Continuum;
use super::forces::Terms;
use super::strain_modes::{self, StrainModes};
use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::elements::force::{
    AlongShapes, ByCells, Capabilities, Force, GeneralizedForce, NodalForces, Reservoir, Tangents,
};
use crate::elements::mesh::CellKind;
use crate::integrators::ode::Failure;

/// Elastic forces, forces of objective viscosity, or both.
pub(crate) struct Elastic {
    pub(super) bodies: Vec<(Continuum, Terms)>,
    /// Whether they are those of the rigid pieces.
    pub(super) is_of_rigid: bool,
    /// The nodes of its cells, if these are a sample.
    pub(super) nodes: Option<Vec<usize>>,
}

impl Force for Elastic {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.bodies.iter().try_for_each(|(Continuum { elements, regions, .. }, terms)| {
            elements.add_forces(regions, *terms, u, v, forces)
        })
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        for (Continuum { elements, regions, .. }, terms) in &self.bodies {
            elements.add_tangents(regions, *terms, u, v, stiffness, damping);
        }
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        energy(&self.bodies, u)
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Strain
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        self.nodes.clone()
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            by_cells: Some(self),
            along_shapes: Some(self),
            keeps_rigid: self.is_of_rigid,
            ..Capabilities::default()
        }
    }
}

impl ByCells for Elastic {
    fn sample(&self, weights: &BTreeMap<usize, f64>, pattern: &NodePattern) -> Arc<dyn Force> {
        Arc::new(self.sampled(weights, pattern))
    }
}

impl AlongShapes for Elastic {
    fn is_exact_along(&self, shapes: usize) -> bool {
        self.has_strain_modes(shapes)
    }

    fn generalized(&self, origin: &[f64], shapes: &[&[f64]]) -> Option<Box<dyn GeneralizedForce>> {
        self.has_strain_modes(shapes.len())
            .then(|| Box::new(self.strain_modes(origin, shapes)) as Box<dyn GeneralizedForce>)
    }
}

impl Elastic {
    /// Whether the forces along so many shapes follow from the modes of the strains, in less time than from a sample of
    /// the cells.
    pub(crate) fn has_strain_modes(&self, shapes: usize) -> bool {
        let has_modes = |(Continuum { elements, regions, .. }, terms): &(Continuum, Terms)| {
            elements.has_strain_modes(regions, *terms)
        };
        let work: usize = self.bodies.iter().map(|(own, _)| own.elements.work()).sum();
        self.bodies.iter().all(has_modes) && strain_modes::pay(shapes, 1, work)
    }

    /// The forces along `shapes` from displacements `origin` (m), if [they have such modes](Self::has_strain_modes).
    pub(super) fn strain_modes(&self, origin: &[f64], shapes: &[&[f64]]) -> StrainModes {
        let zeros = || {
            let modes = strain_modes::modes(shapes.len());
            Mat::zeros(modes, modes)
        };
        let have =
            |is_term: fn(&Terms) -> bool| self.bodies.iter().any(|(_, terms)| is_term(terms));
        let mut products =
            [have(|terms| terms.elastic), have(|terms| terms.viscous)].map(|has| has.then(zeros));
        for (Continuum { elements, regions, .. }, terms) in &self.bodies {
            elements.add_products(regions, *terms, origin, shapes, &mut products);
        }
        StrainModes::new(shapes.len(), products)
    }
}

/// The forces -K u and -B v, element by element.
#[derive(Clone)]
pub(crate) struct LinearByCells {
    bodies: Vec<(Continuum, Terms)>,
}

impl LinearByCells {
    pub(crate) fn add_forces(
        &self,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.bodies.iter().try_for_each(|(Continuum { elements, regions, .. }, terms)| {
            elements.add_linear_forces(regions, *terms, u, v, forces)
        })
    }

    /// Strain energy (J).
    pub(crate) fn energy(&self, u: &[f64]) -> f64 {
        energy(&self.bodies, u)
    }
}

/// Strain energy (J) of the bodies whose elastic forces are among the terms.
fn energy(bodies: &[(Continuum, Terms)], u: &[f64]) -> f64 {
    let elastic = bodies.iter().filter(|(_, terms)| terms.elastic);
    elastic.map(|(Continuum { elements, regions, .. }, _)| elements.energy(regions, u)).sum()
}

impl Body {
    /// The elastic and viscous forces that have no constant matrix, without those of rigid pieces.
    pub(crate) fn elastic(&self) -> Option<Elastic> {
        self.elastic_of(false)
    }

    /// Those that keep rigid pieces in their shape.
    pub(crate) fn elastic_of_rigid(&self) -> Option<Elastic> {
        self.elastic_of(true)
    }

    fn elastic_of(&self, is_of_rigid: bool) -> Option<Elastic> {
        let part = if is_of_rigid { Continuum::rigid } else { Continuum::soft };
        let bodies = self.with_terms(Continuum::nonlinear_terms).into_iter();
        let bodies: Vec<_> = bodies.filter_map(|(own, terms)| Some((part(&own)?, terms))).collect();
        let elastic = Elastic { bodies, is_of_rigid, nodes: None };
        (!elastic.bodies.is_empty()).then_some(elastic)
    }

    /// The forces -K u and -B v element by element, where that is less work than with the matrices: a row of
    /// K has some 7 blocks in a mesh of triangles, and 15 in one of tetrahedra, which are added up one after
    /// the other.
    pub(crate) fn linear_by_cells(&self) -> Option<LinearByCells> {
        if !self.is_linear_by_cells() {
            return None;
        }
        let bodies = self.with_terms(Continuum::linear_terms);
        (!bodies.is_empty()).then_some(LinearByCells { bodies })
    }

    /// Whether linear forces are less work cell by cell: for all bodies, as matrices are those of all.
    pub(super) fn is_linear_by_cells(&self) -> bool {
        let is_simple = |continuum: &Continuum| {
            matches!(continuum.kind, CellKind::Triangle | CellKind::Tetrahedron)
        };
        self.continua.iter().all(|own| is_simple(own) || !own.linear_terms().are_any())
    }

    /// The bodies that have any of the terms.
    fn with_terms(&self, terms: fn(&Continuum) -> Terms) -> Vec<(Continuum, Terms)> {
        let all = self.continua.iter().map(|continuum| (continuum, terms(continuum)));
        let some = all.filter(|(_, terms)| terms.are_any());
        some.map(|(continuum, terms)| (continuum.clone(), terms)).collect()
    }
}

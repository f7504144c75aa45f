//! The cells of one body with their materials, on the nodes of all bodies that it is joined with.

use std::ops::Range;
use std::sync::Arc;

use super::assembly::Elements;
use super::forces::Terms;
use super::offset::Offset;
use super::recipe::Recipe;
use super::regions::Regions;
use super::reinforcement::{Families, among_others};
use crate::elements::material::{Material, Plane, Strain, Viscosity};
use crate::elements::mesh::CellKind;
use crate::elements::rod::RodElements;

/// The cells of one body.
#[derive(Clone)]
pub(super) struct Continuum {
    pub(super) kind: CellKind,
    /// Numbers of its nodes and cells among those of all bodies.
    pub(super) nodes: Range<usize>,
    pub(super) cells: Range<usize>,
    pub(super) material: Material,
    pub(super) strain: Strain,
    pub(super) plane: Plane,
    pub(super) viscosity: Viscosity,
    pub(super) section: f64,
    pub(super) elements: Arc<dyn Elements>,
    pub(super) regions: Arc<Regions>,
    pub(super) fibres: Arc<Families>,
    /// Those of a rod, whose cells have no forces of their own.
    pub(super) rod: Option<Arc<RodElements>>,
    /// The input that it was built from.
    pub(super) recipe: Arc<Recipe>,
}

impl Continuum {
    /// The same on the nodes of several bodies, where its cells begin with number `cell`.
    pub(super) fn among_others(&self, offset: Offset, cell: usize) -> Self {
        let moved = |own: &Range<usize>, first: usize| first + own.start..first + own.end;
        Self {
            nodes: moved(&self.nodes, offset.node),
            cells: moved(&self.cells, cell),
            elements: self.elements.among_others(offset),
            fibres: Arc::new(among_others(&self.fibres, offset)),
            rod: self.rod.as_ref().map(|rod| Arc::new(rod.among_others(offset.node))),
            ..self.clone()
        }
    }

    /// The same without its rigid pieces, if there is anything else.
    pub(super) fn soft(&self) -> Option<Self> {
        (self.rod.is_none() && self.regions.are_any(false)).then(|| self.clone())
    }

    /// The same with the stiffness of its rigid pieces alone, if it has any.
    pub(super) fn rigid(&self) -> Option<Self> {
        let of_rigid = || self.regions.of_rigid(self.kind.dimension(), self.plane);
        self.regions.are_any(true).then(|| Self { regions: Arc::new(of_rigid()), ..self.clone() })
    }

    /// Whether the elastic force is -K u.
    pub(super) fn is_linear(&self) -> bool {
        self.strain == Strain::Cauchy
    }

    /// Whether the viscous force is that of a constant matrix, and not 0.
    pub(super) fn has_natural_viscosity(&self) -> bool {
        self.viscosity == Viscosity::Natural && self.regions.are_viscous()
    }

    /// The forces that depend on its shape, and have no constant matrix.
    pub(super) fn nonlinear_terms(&self) -> Terms {
        Terms {
            elastic: !self.is_linear(),
            viscous: self.viscosity == Viscosity::Objective && self.regions.are_viscous(),
        }
    }

    /// The forces of constant matrices.
    pub(super) fn linear_terms(&self) -> Terms {
        Terms { elastic: self.is_linear(), viscous: self.has_natural_viscosity() }
    }
}

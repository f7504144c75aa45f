//! A body in the making: options, checks, assembly.

use std::sync::Arc;

use super::assembled::Body;
use super::assembly::elements;
use super::inertia::Inertia;
use super::regions::{CellSelection, Regions};
use crate::input::{InputError, positive};
use crate::material::{Material, Plane, Strain, Viscosity};
use crate::mesh::Mesh;
use crate::sparse::{BlockMatrix, NodeMatrix, NodePattern};

/// A body in the making: see [`Body::new`].
#[derive(Debug, Clone)]
pub struct BodyBuilder {
    mesh: Mesh,
    material: Material,
    regions: Vec<(CellSelection, Material)>,
    strain: Strain,
    viscosity: Option<Viscosity>,
    inertia: Inertia,
    plane: Plane,
    thickness: Option<f64>,
    area: Option<f64>,
    points: Vec<(String, Vec<f64>, f64)>,
}

impl BodyBuilder {
    /// Thickness h of a two-dimensional body (m).
    pub fn thickness(mut self, thickness: f64) -> Self {
        self.thickness = Some(thickness);
        self
    }

    /// Cross-sectional area A of a one-dimensional body (m^2).
    pub fn area(mut self, area: f64) -> Self {
        self.area = Some(area);
        self
    }

    /// How strain is measured (default: Green).
    pub fn strain(mut self, strain: Strain) -> Self {
        self.strain = strain;
        self
    }

    /// How viscosity acts. Default: natural with Cauchy strain, objective with Green strain.
    pub fn viscosity(mut self, viscosity: Viscosity) -> Self {
        self.viscosity = Some(viscosity);
        self
    }

    /// How inertia is shared out among the nodes (default: consistently).
    pub fn inertia(mut self, inertia: Inertia) -> Self {
        self.inertia = inertia;
        self
    }

    /// A region with a material of its own. Where regions overlap, the last one counts.
    pub fn region(mut self, cells: impl Into<CellSelection>, material: Material) -> Self {
        self.regions.push((cells.into(), material));
        self
    }

    /// A point mass (kg) at `position` (m): a node that belongs to no cell. It comes after the nodes
    /// of the mesh, and `name` is a node set with it alone.
    pub fn point_mass(
        mut self,
        name: impl Into<String>,
        position: impl Into<Vec<f64>>,
        mass: f64,
    ) -> Self {
        self.points.push((name.into(), position.into(), mass));
        self
    }

    /// Plane strain (default) or plane stress, for two-dimensional bodies.
    pub fn plane(mut self, plane: Plane) -> Self {
        self.plane = plane;
        self
    }

    /// Assembles the body.
    ///
    /// # Errors
    /// A material out of range, a missing or misplaced thickness or area, an inverted or flat cell,
    /// a node without a cell.
    pub fn build(self) -> Result<Body, InputError> {
        let section = self.section()?;
        let Self { mut mesh, material, strain, plane, .. } = self;
        let viscosity = self.viscosity.unwrap_or(match strain {
            Strain::Cauchy => Viscosity::Natural,
            _ => Viscosity::Objective,
        });
        let regions = Regions::new(&mesh, strain, plane, &material, &self.regions)?;
        let elements = elements(&mesh, section)?;
        for (name, position, mass) in &self.points {
            positive(&format!("mass of point \"{name}\""), *mass, "kg")?;
            mesh.push_node(name, position)?;
        }

        let pattern = Arc::new(NodePattern::new(mesh.node_count(), mesh.cells()));
        let mut inertia = NodeMatrix::zeros(&pattern);
        let mut stiffness = BlockMatrix::zeros(&pattern, mesh.dimension());
        let mut damping = stiffness.clone();
        elements.add_inertia(&regions, self.inertia, &mut inertia);
        elements.add_stiffness(&regions, &|substance| substance.hooke, &mut stiffness);
        elements.add_stiffness(&regions, &|substance| substance.viscous.0, &mut damping);
        let first_point = mesh.node_count() - self.points.len();
        for (node, (_, _, mass)) in (first_point..).zip(&self.points) {
            inertia.add(node, node, *mass);
        }
        let body = Body {
            mesh,
            material,
            strain,
            plane,
            viscosity,
            section,
            elements: elements.into(),
            regions: Arc::new(regions),
            inertia: Arc::new(inertia),
            stiffness: Arc::new(stiffness),
            damping: Arc::new(damping),
        };
        // not the nodal masses: those of quadratic cells are 0 and below at corners
        let mut nodes = 0..body.mesh.node_count();
        match nodes.find(|&node| body.inertia.get(node, node) == 0.0) {
            Some(node) => Err(InputError::new(
                "node",
                node + 1,
                "it belongs to no cell, so that nothing holds it: leave it out of the mesh",
            )),
            None => Ok(body),
        }
    }

    fn section(&self) -> Result<f64, InputError> {
        let kind = self.mesh.kind();
        let misplaced = |name: &str, value: f64| {
            Err(InputError::new(name, value, format!("a body of {kind:?} cells has no {name}")))
        };
        match (kind.dimension(), self.area, self.thickness) {
            (1, Some(area), None) => positive("area", area, "m^2"),
            (2, None, Some(thickness)) => positive("thickness", thickness, "m"),
            (3, None, None) => Ok(1.0),
            (1 | 3, _, Some(thickness)) => misplaced("thickness", thickness),
            (2 | 3, Some(area), _) => misplaced("area", area),
            (1, None, None) => Err(missing("area", "a one-dimensional body needs its area in m^2")),
            _ => Err(missing("thickness", "a two-dimensional body needs its thickness in m")),
        }
    }
}

fn missing(input: &str, mend: &str) -> InputError {
    InputError::new(input, "(missing)", mend)
}

impl Body {
    /// Starts a body of `mesh`, made of `material`; [`BodyBuilder::build`] assembles it.
    #[allow(clippy::new_ret_no_self)] // the one way to a body starts here
    pub fn new(mesh: Mesh, material: Material) -> BodyBuilder {
        BodyBuilder {
            mesh,
            material,
            regions: Vec::new(),
            strain: Strain::default(),
            viscosity: None,
            inertia: Inertia::default(),
            plane: Plane::default(),
            thickness: None,
            area: None,
            points: Vec::new(),
        }
    }
}

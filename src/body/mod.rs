//! A body: a mesh made of a material, and the constant matrices that follow from both.

mod assembly;

use std::sync::Arc;

use assembly::{Moduli, assemble};

use crate::error::{Error, positive};
use crate::material::{Lame, Material, Plane};
use crate::mesh::Mesh;
use crate::sparse::{BlockMatrix, NodeMatrix, NodePattern};

/// How the strain of a body follows from its displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Strain {
    /// Cauchy's small strain: force -K u, linear. Not invariant to rotation: a body that turns by
    /// theta swells as if strained by cos(theta) - 1.
    #[default]
    Cauchy,
}

/// An elastic body: mesh, material, and the matrices M, K and B.
///
/// ```
/// use pliant::{Body, Cells, Material, Mesh};
///
/// let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
/// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// let body = Body::new(mesh, rubber).thickness(0.01).build()?;
/// assert!((body.mass() - 0.9).abs() < 1e-12); // kg
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Body {
    mesh: Mesh,
    material: Material,
    strain: Strain,
    section: f64,
    inertia: NodeMatrix,
    stiffness: BlockMatrix,
    damping: BlockMatrix,
}

/// A body in the making: see [`Body::new`].
#[derive(Debug, Clone)]
pub struct BodyBuilder {
    mesh: Mesh,
    material: Material,
    strain: Strain,
    plane: Plane,
    thickness: Option<f64>,
    area: Option<f64>,
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

    /// How strain is measured (default: Cauchy).
    pub fn strain(mut self, strain: Strain) -> Self {
        self.strain = strain;
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
    pub fn build(self) -> Result<Body, Error> {
        self.material.validate()?;
        let section = self.section()?;
        let Self { mesh, material, strain, plane, .. } = self;
        let pattern = Arc::new(NodePattern::new(mesh.node_count(), mesh.cells()));
        let reduced = |lame: Lame| lame.reduced(mesh.kind().dimension(), plane);
        let moduli = Moduli {
            density: material.density,
            elastic: reduced(material.elastic()),
            viscous: reduced(material.viscous()),
        };
        let (inertia, [stiffness, damping]) = assemble(&mesh, section, moduli, &pattern)?;
        let body = Body { mesh, material, strain, section, inertia, stiffness, damping };
        match body.nodal_masses().iter().position(|&mass| mass == 0.0) {
            Some(node) => Err(Error::input(
                "node",
                node + 1,
                "it belongs to no cell, so that nothing holds it: leave it out of the mesh",
            )),
            None => Ok(body),
        }
    }

    fn section(&self) -> Result<f64, Error> {
        let kind = self.mesh.kind();
        let misplaced = |name: &str, value: f64| {
            Err(Error::input(name, value, format!("a body of {kind:?} cells has no {name}")))
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

fn missing(input: &str, mend: &str) -> Error {
    Error::input(input, "(missing)", mend)
}

impl Body {
    /// Starts a body of `mesh`, made of `material`; [`BodyBuilder::build`] assembles it.
    #[allow(clippy::new_ret_no_self)] // the one way to a body starts here
    pub fn new(mesh: Mesh, material: Material) -> BodyBuilder {
        BodyBuilder {
            mesh,
            material,
            strain: Strain::default(),
            plane: Plane::default(),
            thickness: None,
            area: None,
        }
    }

    /// The mesh in its natural shape.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// What it is made of.
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// How strain is measured.
    pub fn strain(&self) -> Strain {
        self.strain
    }

    /// Dimension of space.
    pub fn dimension(&self) -> usize {
        self.mesh.dimension()
    }

    /// Number of displacement components: nodes times dimension.
    pub fn dofs(&self) -> usize {
        self.mesh.node_count() * self.dimension()
    }

    /// Inertia matrix M = m (x) I; this is m (kg), consistent with the shape functions.
    pub fn inertia(&self) -> &NodeMatrix {
        &self.inertia
    }

    /// Stiffness matrix K = lambda J_lambda + mu J_mu (N/m).
    pub fn stiffness(&self) -> &BlockMatrix {
        &self.stiffness
    }

    /// Damping matrix B = lambda_vis J_lambda + mu_vis J_mu (N s/m).
    pub fn damping(&self) -> &BlockMatrix {
        &self.damping
    }

    /// The connection matrices J_lambda and J_mu: geometry only (slides, "stiffness matrix").
    ///
    /// # Panics
    /// Never: the cells were checked when the body was built.
    pub fn connection_matrices(&self) -> [BlockMatrix; 2] {
        let unit = |lambda: f64, mu: f64| Lame { lambda, mu };
        let moduli = Moduli { density: 0.0, elastic: unit(1.0, 0.0), viscous: unit(0.0, 1.0) };
        let (_, matrices) = assemble(&self.mesh, self.section, moduli, self.inertia.pattern())
            .expect("the cells were checked when the body was built");
        matrices
    }

    /// Total mass (kg).
    pub fn mass(&self) -> f64 {
        self.inertia.values.iter().sum()
    }

    /// Mass that moves with each node (kg): the row sums of m.
    pub fn nodal_masses(&self) -> Vec<f64> {
        let pattern = self.inertia.pattern();
        let row_sum = |row| pattern.row(row).map(|(entry, _)| self.inertia.values[entry]).sum();
        (0..pattern.nodes()).map(row_sum).collect()
    }
}

//! A body: a mesh made of a material, and the constant matrices that follow from both.

mod cells;
mod elastic;
mod fields;
mod forces;
mod polynomial;
mod regions;
mod shares;
mod strain;
#[cfg(test)]
mod tests;

use std::fmt;
use std::sync::Arc;

pub(crate) use cells::Cells;
use cells::{Law, cells};
pub(crate) use elastic::Elastic;
pub use fields::CellField;
use fields::Measure;
pub use polynomial::{Coefficients, GreenPolynomial};
pub use regions::CellSelection;
use regions::Regions;

use crate::force::NodalForces;
use crate::input::{InputError, positive};
use crate::material::{Lame, Material, Plane};
use crate::mesh::Mesh;
use crate::ode::Failure;
use crate::sparse::{BlockMatrix, NodeMatrix, NodePattern};

/// How the strain of a body follows from its displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Strain {
    /// Cauchy's small strain: force -K u, linear. Not invariant to rotation: a body that turns by
    /// theta swells as if strained by cos(theta) - 1.
    #[default]
    Cauchy,
    /// Green's strain E = (F^T F - I)/2, invariant to rotation: St. Venant-Kirchhoff material.
    Green,
}

/// How the viscous force of a body follows from its velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Viscosity {
    /// Force -B v with the constant B of the natural shape, as in Hirai. Not invariant to
    /// rotation: a body that spins as a whole is braked.
    Natural,
    /// Stress from the rate of Green's strain: a body that spins as a whole is not braked.
    Objective,
}

/// How the inertia of the cells is shared out among their nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Inertia {
    /// M as the shape functions have it: nodes of one cell share inertia.
    #[default]
    Consistent,
    /// All mass in the nodes, so that M is diagonal: what makes explicit methods cheap. Other
    /// equations than the consistent ones, with lower frequencies: both tend to the same motion
    /// when the mesh is refined.
    ///
    /// Nodes of linear cells get the integrals of their shape functions (row sums). At corners of
    /// quadratic cells those are 0 or below, so nodes of these get the diagonal of the consistent
    /// matrix, scaled to the mass of the cell (E. Hinton, T. Rock, O. C. Zienkiewicz, Earthquake
    /// Eng. Struct. Dyn. 4 (1976) 245-249).
    Lumped,
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
#[derive(Clone)]
pub struct Body {
    mesh: Mesh,
    material: Material,
    strain: Strain,
    viscosity: Viscosity,
    plane: Plane,
    section: f64,
    cells: Arc<dyn Cells>,
    regions: Arc<Regions>,
    inertia: Arc<NodeMatrix>,
    stiffness: Arc<BlockMatrix>,
    damping: Arc<BlockMatrix>,
}

impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Body")
            .field("nodes", &self.mesh.node_count())
            .field("cells", &self.mesh.cell_count())
            .field("kind", &self.mesh.kind())
            .field("material", &self.material)
            .field("strain", &self.strain)
            .field("viscosity", &self.viscosity)
            .finish_non_exhaustive()
    }
}

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

    /// How strain is measured (default: Cauchy).
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
            Strain::Green => Viscosity::Objective,
        });
        let regions = Regions::new(&mesh, plane, &material, &self.regions)?;
        let cells: Arc<dyn Cells> = cells(&mesh, section)?.into();
        for (name, position, mass) in &self.points {
            positive(&format!("mass of point \"{name}\""), *mass, "kg")?;
            mesh.push_node(name, position)?;
        }

        let pattern = Arc::new(NodePattern::new(mesh.node_count(), mesh.cells()));
        let mut inertia = NodeMatrix::zeros(&pattern);
        let mut stiffness = BlockMatrix::zeros(&pattern, mesh.dimension());
        let mut damping = stiffness.clone();
        cells.add_inertia(&regions, self.inertia, &mut inertia);
        cells.add_stiffness(&regions, &|moduli| moduli.elastic, &mut stiffness);
        cells.add_stiffness(&regions, &|moduli| moduli.viscous, &mut damping);
        let first_point = mesh.node_count() - self.points.len();
        for (node, (_, _, mass)) in (first_point..).zip(&self.points) {
            inertia.add(node, node, *mass);
        }
        let body = Body {
            mesh,
            material,
            strain,
            viscosity,
            plane,
            section,
            cells,
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

    /// How viscosity acts.
    pub fn viscosity(&self) -> Viscosity {
        self.viscosity
    }

    /// Thickness (m) of a body of two-dimensional cells, cross-sectional area (m^2) of one of
    /// segments, 1 otherwise.
    pub(crate) fn section(&self) -> f64 {
        self.section
    }

    /// Dimension of space.
    pub fn dimension(&self) -> usize {
        self.mesh.dimension()
    }

    /// Number of displacement components: nodes times dimension.
    pub fn dofs(&self) -> usize {
        self.mesh.node_count() * self.dimension()
    }

    /// Inertia matrix M = m (x) I; this is m (kg).
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
    pub fn connection_matrices(&self) -> [BlockMatrix; 2] {
        [Lame { lambda: 1.0, mu: 0.0 }, Lame { lambda: 0.0, mu: 1.0 }].map(|unit| {
            let mut matrix = BlockMatrix::zeros(self.stiffness.pattern(), self.dimension());
            self.cells.add_stiffness(&self.regions, &|_| unit, &mut matrix);
            matrix
        })
    }

    /// Present over natural volume (area, length) of each cell under the displacements `u` (m).
    pub fn volume_ratios(&self, u: &[f64]) -> Vec<f64> {
        self.cells.volume_ratios(u)
    }

    /// Strain, stress and strain energy density of each cell under the displacements `u` (m,
    /// dimension components per node).
    ///
    /// ```
    /// use pliant::{Body, Material, Mesh};
    ///
    /// let soft = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };
    /// let bar = Body::new(Mesh::bar(0.1, 2)?, soft).area(2e-4).build()?;
    /// let [field] = bar.cell_fields(&[0.0, 0.001])[..] else { panic!("one cell") };
    /// assert!((field.strain[0][0] - 0.01).abs() < 1e-12);
    /// assert!((field.stress[0][0] - 500.0).abs() < 1e-9 && (field.von_mises() - 500.0).abs() < 1e-9);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn cell_fields(&self, u: &[f64]) -> Vec<CellField> {
        let across = match self.mesh.kind().dimension() {
            1 => Plane::Stress,
            _ => self.plane,
        };
        self.cells.fields(&self.regions, Measure { strain: self.strain, across }, u)
    }

    /// Natural volume of each cell (m^3).
    pub fn cell_volumes(&self) -> Vec<f64> {
        self.cells.volumes()
    }

    /// Adds the nodal forces (N) of Green strain at the displacements `u` (m, dimension components
    /// per node) to the conservative ones of `forces`, cell by cell, whatever strain the body has.
    ///
    /// # Errors
    /// A cell that `u` turns inside out.
    pub fn add_green_forces(&self, u: &[f64], forces: &mut NodalForces) -> Result<(), Failure> {
        // without objective viscosity velocities count for nothing
        let law = Law { green: true, objective: false };
        self.cells.add_forces(&self.regions, law, u, u, forces)
    }

    /// Volume of the cells (m^3).
    pub fn volume(&self) -> f64 {
        self.cell_volumes().iter().sum()
    }

    pub(crate) fn shared_inertia(&self) -> Arc<NodeMatrix> {
        self.inertia.clone()
    }

    /// K, if the elastic force is -K u.
    pub(crate) fn constant_stiffness(&self) -> Option<Arc<BlockMatrix>> {
        (self.strain == Strain::Cauchy).then(|| self.stiffness.clone())
    }

    /// B, if the viscous force is -B v, and not 0.
    pub(crate) fn constant_damping(&self) -> Option<Arc<BlockMatrix>> {
        let natural = self.viscosity == Viscosity::Natural;
        (natural && self.regions.are_viscous()).then(|| self.damping.clone())
    }

    /// The elastic and viscous forces that have no constant matrix.
    pub(crate) fn elastic(&self) -> Option<Elastic> {
        let green = self.strain == Strain::Green;
        let objective = self.viscosity == Viscosity::Objective && self.regions.are_viscous();
        let (cells, regions) = (self.cells.clone(), self.regions.clone());
        (green || objective).then(|| Elastic::new(cells, regions, Law { green, objective }))
    }

    /// Total mass (kg).
    pub fn mass(&self) -> f64 {
        self.inertia.values.iter().sum()
    }

    /// Mass that moves with each node (kg): the row sums of m. Unless inertia is lumped, corners of
    /// quadratic cells may have none, or less than none.
    pub fn nodal_masses(&self) -> Vec<f64> {
        let pattern = self.inertia.pattern();
        let row_sum = |row| pattern.row(row).map(|(entry, _)| self.inertia.values[entry]).sum();
        (0..pattern.nodes()).map(row_sum).collect()
    }
}

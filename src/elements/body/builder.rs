//! The builder of a body: options, checks, assembly.

use std::sync::Arc;

use super::assembled::Body;
use super::assembly::elements;
use super::dilatation::Dilatation;
use super::inertia::Inertia;
use super::recipe::Recipe;
use super::regions::{CellSelection, Laws, Regions};
use super::reinforcement::{add_at_rest, families};
use crate::base::input::{InputError, positive};
use crate::base::sparse::{BlockMatrix, NodeMatrix, NodePattern};
use crate::elements::basis::Finer;
use crate::elements::material::{Plane, Strain, Substance, Viscosity};
use crate::elements::mesh::Mesh;

/// The builder of a body: see [`Body::new`].
#[derive(Debug, Clone)]
pub struct BodyBuilder {
    mesh: Mesh,
    recipe: Recipe,
}

impl BodyBuilder {
    /// Thickness h of a two-dimensional body (m).
    pub fn thickness(mut self, thickness: f64) -> Self {
        self.recipe.thickness = Some(thickness);
        self
    }

    /// Cross-sectional area A of a one-dimensional body (m^2).
    pub fn area(mut self, area: f64) -> Self {
        self.recipe.area = Some(area);
        self
    }

    /// How strain is measured (default: Green).
    pub fn strain(mut self, strain: Strain) -> Self {
        self.recipe.strain = strain;
        self
    }

    /// How viscosity acts. Default: natural with Cauchy strain, objective with Green strain.
    pub fn viscosity(mut self, viscosity: Viscosity) -> Self {
        self.recipe.viscosity = Some(viscosity);
        self
    }

    /// How inertia is shared out among the nodes (default: consistently).
    pub fn inertia(mut self, inertia: Inertia) -> Self {
        self.recipe.inertia = inertia;
        self
    }

    /// A region with a material of its own. Where regions overlap, the last one counts.
    pub fn region(
        mut self,
        cells: impl Into<CellSelection>,
        substance: impl Into<Substance>,
    ) -> Self {
        self.recipe.regions.push((cells.into(), substance.into()));
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
        self.recipe.points.push((name.into(), position.into(), mass));
        self
    }

    /// Plane strain (default) or plane stress, for two-dimensional bodies.
    pub fn plane(mut self, plane: Plane) -> Self {
        self.recipe.plane = plane;
        self
    }

    /// Where a change of volume is resisted: at each point (default), or projected onto few functions of each cell,
    /// which does not lock where the body is nearly incompressible.
    pub fn dilatation(mut self, dilatation: Dilatation) -> Self {
        self.recipe.dilatation = dilatation;
        self
    }

    /// The mesh, without point masses.
    pub(crate) fn own_mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The same on a finer mesh.
    ///
    /// # Errors
    /// Regions of cells that the mesh does not have.
    pub(crate) fn on(mut self, finer: &Finer) -> Result<Self, InputError> {
        for (cells, _) in &mut self.recipe.regions {
            if let CellSelection::Numbers(_) = cells {
                let children = finer.children_of(&cells.cells(&self.mesh)?);
                *cells = CellSelection::Numbers(children.iter().map(|cell| cell + 1).collect());
            }
        }
        Ok(Self { mesh: finer.mesh.clone(), ..self })
    }

    /// The same without viscosity, in its regions, too.
    pub(crate) fn without_viscosity(mut self) -> Self {
        self.recipe.material.material.viscosity = 0.0;
        self.recipe.regions.iter_mut().for_each(|(_, region)| region.material.viscosity = 0.0);
        self
    }

    /// Another material, everywhere outside regions.
    pub fn material(mut self, substance: impl Into<Substance>) -> Self {
        self.recipe.material = substance.into();
        self
    }

    /// Assembles the body.
    ///
    /// # Errors
    /// A material out of range, a missing or misplaced thickness or area, an inverted or flat cell,
    /// a node without a cell.
    pub fn build(self) -> Result<Body, InputError> {
        let Self { mut mesh, recipe } = self;
        let section = recipe.section(&mesh)?;
        let Recipe { ref material, strain, plane, .. } = recipe;
        let viscosity = recipe.viscosity.unwrap_or(match strain {
            Strain::Cauchy => Viscosity::Natural,
            _ => Viscosity::Objective,
        });
        let regions = Regions::new(&mesh, strain, plane, material, &recipe.regions)?;
        for (name, position, mass) in &recipe.points {
            positive(&format!("mass of point \"{name}\""), *mass, "kg")?;
            mesh.push_node(name, position)?;
        }

        let pattern = Arc::new(NodePattern::new(mesh.node_count(), mesh.cells()));
        recipe.dilatation.check(mesh.kind(), mesh.dimension(), plane)?;
        let elements = elements(&mesh, section, recipe.dilatation, &pattern)?;
        let mut inertia = NodeMatrix::zeros(&pattern);
        let mut stiffness = BlockMatrix::zeros(&pattern, mesh.dimension());
        let mut damping = stiffness.clone();
        elements.add_inertia(&regions, &|laws| laws.density, recipe.inertia, &mut inertia);
        elements.add_stiffness(&regions, &|laws| laws.elastic, &mut stiffness);
        elements.add_stiffness(&regions, &|laws| laws.natural_viscosity(), &mut damping);
        let mass_damping = regions.have_mass_damping().then(|| {
            let mut matrix = match recipe.inertia {
                Inertia::Consistent => NodeMatrix::zeros(&pattern),
                Inertia::Lumped => NodeMatrix::diagonal(mesh.node_count()),
            };
            let density = |laws: &Laws| laws.mass_damping * laws.density;
            elements.add_inertia(&regions, &density, recipe.inertia, &mut matrix);
            damping.add_on_all_axes(&matrix);
            Arc::new(matrix)
        });
        let cells = regions.by_substance(mesh.cell_count()).into_iter();
        let substances = std::iter::once(material).chain(recipe.regions.iter().map(|(_, s)| s));
        let substances = substances.map(|substance| &substance.fibres[..]).zip(cells);
        let fibres = families(&mesh, &*elements, substances)?;
        add_at_rest(&fibres, mesh.node_count() * mesh.dimension(), &mut stiffness, &mut damping);
        let first_point = mesh.node_count() - recipe.points.len();
        for (node, (_, _, mass)) in (first_point..).zip(&recipe.points) {
            inertia.add(node, node, *mass);
        }
        let body = Body {
            mesh,
            material: material.material,
            strain,
            plane,
            viscosity,
            section,
            elements: elements.into(),
            regions: Arc::new(regions),
            inertia: Arc::new(inertia),
            stiffness: Arc::new(stiffness),
            damping: Arc::new(damping),
            mass_damping,
            fibres: Arc::new(fibres),
            recipe: Arc::new(recipe),
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
}

impl Body {
    /// Starts a body of `mesh`, made of `substance`, a [`Material`](crate::Material) or one with a
    /// [`Law`](crate::Law); [`BodyBuilder::build`] assembles it.
    #[allow(clippy::new_ret_no_self)] // a body is made by its builder alone
    pub fn new(mesh: Mesh, substance: impl Into<Substance>) -> BodyBuilder {
        let recipe = Recipe {
            material: substance.into(),
            regions: Vec::new(),
            strain: Strain::default(),
            viscosity: None,
            inertia: Inertia::default(),
            plane: Plane::default(),
            dilatation: Dilatation::default(),
            thickness: None,
            area: None,
            points: Vec::new(),
        };
        BodyBuilder { mesh, recipe }
    }

    /// The builder that made it, for a body that differs in some options.
    ///
    /// ```
    /// use pliant::{Body, Cells, Inertia, Material, Mesh};
    ///
    /// let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    /// let body = Body::new(mesh, rubber).thickness(0.01).build()?;
    /// let lumped = body.to_builder().inertia(Inertia::Lumped).build()?;
    /// assert_eq!(lumped.mesh().node_count(), 16);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn to_builder(&self) -> BodyBuilder {
        let recipe = (*self.recipe).clone();
        let mesh = self.mesh.without_last(recipe.points.iter().map(|(name, ..)| &name[..]));
        BodyBuilder { mesh, recipe }
    }
}

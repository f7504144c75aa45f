//! The builder of a body: options, checks, assembly.

use std::ops::Range;
use std::sync::Arc;

use super::assembled::Body;
use super::assembly::elements;
use super::axis::mean_section;
use super::continuum::Continuum;
use super::dilatation::Dilatation;
use super::inertia::Inertia;
use super::joined::Part;
use super::nodal_masses::NodalMasses;
use super::recipe::Recipe;
use super::regions::{CellSelection, Laws, Regions};
use super::reinforcement::{add_at_rest, families};
use super::rigid::RigidPieces;
use super::section::Section;
use super::whole::{MassMoments, Whole};
use crate::base::input::{InputError, positive};
use crate::base::sparse::{BlockMatrix, NodeMatrix, NodePattern};
use crate::base::vector::distinct;
use crate::elements::basis::Finer;
use crate::elements::material::{Plane, Strain, Substance, Viscosity};
use crate::elements::mesh::{Mesh, NodeMap};
use crate::elements::rod::Rod;

/// The builder of a body: see [`Body::new`].
///
/// That of several bodies ([`Body::join`]) sets an option for each of them.
#[derive(Debug, Clone)]
pub struct BodyBuilder {
    bodies: Vec<(Mesh, Recipe)>,
}

impl BodyBuilder {
    fn each(mut self, set: impl Fn(&mut Recipe)) -> Self {
        self.bodies.iter_mut().for_each(|(_, recipe)| set(recipe));
        self
    }

    /// The name of the body among others (see [`Body::join`]).
    pub fn named(self, name: impl Into<String>) -> Self {
        let name = name.into();
        self.each(|recipe| recipe.name = Some(name.clone()))
    }

    /// Thickness h of a two-dimensional body (m).
    pub fn thickness(self, thickness: f64) -> Self {
        self.each(|recipe| recipe.thickness = Some(thickness))
    }

    /// Cross-sectional area A of a one-dimensional body (m^2).
    pub fn area(self, area: f64) -> Self {
        self.each(|recipe| recipe.area = Some(area))
    }

    /// Strain measure (default: Green).
    pub fn strain(self, strain: Strain) -> Self {
        self.each(|recipe| recipe.strain = strain)
    }

    /// Kind of viscosity. Default: natural with Cauchy strain, objective with Green strain.
    pub fn viscosity(self, viscosity: Viscosity) -> Self {
        self.each(|recipe| recipe.viscosity = Some(viscosity))
    }

    /// Distribution of inertia to the nodes (default: consistent).
    pub fn inertia(self, inertia: Inertia) -> Self {
        self.each(|recipe| recipe.inertia = inertia)
    }

    /// A region with a material of its own. Where regions overlap, the last one counts.
    pub fn region(self, cells: impl Into<CellSelection>, substance: impl Into<Substance>) -> Self {
        let region = (cells.into(), substance.into());
        self.each(|recipe| recipe.regions.push(region.clone()))
    }

    /// A point mass (kg) at `position` (m): a node that belongs to no cell. It comes after the nodes
    /// of the mesh, and `name` is a node set with it alone.
    pub fn point_mass(
        self,
        name: impl Into<String>,
        position: impl Into<Vec<f64>>,
        mass: f64,
    ) -> Self {
        let point = (name.into(), position.into(), mass);
        self.each(|recipe| recipe.points.push(point.clone()))
    }

    /// Plane strain, plane stress or a body of revolution, for cells of two dimensions. Default: plane strain in the plane, plane stress in
    /// space (membranes).
    pub fn plane(self, plane: Plane) -> Self {
        self.each(|recipe| recipe.plane = Some(plane))
    }

    /// Treatment of volumetric strain: at each point (default), or projected onto few functions of each cell,
    /// which does not lock where the body is nearly incompressible.
    pub fn dilatation(self, dilatation: Dilatation) -> Self {
        self.each(|recipe| recipe.dilatation = dilatation)
    }

    /// The mesh of a single body, without point masses.
    pub(crate) fn own_mesh(&self) -> &Mesh {
        &self.bodies[0].0
    }

    /// The same bodies on finer meshes; `make` refines each mesh, given the numbers of its cells among those of all. Also returns the
    /// joined coarse mesh, without point masses, and its refinement. Rigid bodies and rods among several keep their mesh.
    ///
    /// # Errors
    /// Regions of cells that the mesh does not have; several bodies with point masses; as `make`.
    pub(crate) fn finer(
        mut self,
        make: impl Fn(&Mesh, Range<usize>) -> Result<Finer, InputError>,
    ) -> Result<(Self, Mesh, Finer), InputError> {
        let (mut meshes, mut finer, mut first) = (Vec::new(), Vec::new(), 0);
        let is_single = self.bodies.len() == 1;
        for (mesh, recipe) in &mut self.bodies {
            let cells = first..first + mesh.cell_count();
            first = cells.end;
            if let (false, Some((name, ..))) = (is_single, recipe.points.first()) {
                let help =
                    "on finer meshes of several bodies it would have another number: leave it out";
                return Err(InputError::new("point mass", format!("\"{name}\""), help));
            }
            if is_single && recipe.rod.is_some() {
                let help = "a rod has no finer mesh: raise its number of elements";
                let name = recipe.name.as_deref().unwrap_or("rod");
                return Err(InputError::new("rod", format!("\"{name}\""), help));
            }
            let keeps_mesh = recipe.material.is_rigid || recipe.rod.is_some();
            let own = match keeps_mesh && !is_single {
                true => Finer::none(mesh),
                false => make(mesh, cells)?,
            };
            for (cells, _) in &mut recipe.regions {
                *cells = cells.on(mesh, &own)?;
            }
            meshes.push(std::mem::replace(mesh, own.mesh.clone()));
            finer.push(own);
        }
        if is_single {
            return Ok((self, meshes.remove(0), finer.remove(0)));
        }
        let names: Vec<&str> =
            self.bodies.iter().filter_map(|(_, recipe)| recipe.name.as_deref()).collect();
        let coarse = Mesh::join(names.iter().copied().zip(&meshes));
        let finer = Finer::join(names.iter().copied().zip(finer).collect());
        Ok((self, coarse, finer))
    }

    /// The same without viscosity, in its regions, too.
    pub(crate) fn without_viscosity(self) -> Self {
        self.each(|recipe| {
            recipe.material.material.viscosity = 0.0;
            recipe.regions.iter_mut().for_each(|(_, region)| region.material.viscosity = 0.0);
        })
    }

    /// The same with all of it rigid, its regions, too.
    pub(crate) fn all_rigid(self) -> Self {
        self.strain(Strain::Green).each(|recipe| {
            recipe.material.is_rigid = true;
            recipe.regions.iter_mut().for_each(|(_, region)| region.is_rigid = true);
        })
    }

    /// The smaller bodies that represent these: on one side of a plane of symmetry, with half of the point masses on it, or in a `plane`, as
    /// thick as the prism is long. One that is left of several keeps the names of its nodes among these.
    ///
    /// # Errors
    /// Point masses in a section, whose place in it is not known; rods; regions of cells that the mesh does not have.
    pub(crate) fn by_map(self, map: &NodeMap, plane: Option<Plane>) -> Result<Self, InputError> {
        let is_single = self.bodies.len() == 1;
        let (mut bodies, [mut node, mut cell, mut own_cell]) = (Vec::new(), [0; 3]);
        for ((mesh, mut recipe), own) in self.bodies.into_iter().zip(&map.meshes) {
            if recipe.rod.is_some() {
                let help = "rods are run whole: they have few unknowns";
                return Err(InputError::new("smaller model", "of a rod", help));
            }
            let (first_point, first_cell) = (node + mesh.node_count(), cell);
            (node, cell) = (first_point + recipe.points.len(), cell + mesh.cell_count());
            let Some(own) = own else { continue };
            let mut regions = Vec::new();
            for (selection, substance) in recipe.regions.drain(..) {
                let cells = selection.cells(&mesh)?.into_iter();
                let cells = cells.filter_map(|cell| map.cells[first_cell + cell]);
                let numbers = distinct(cells).into_iter().map(|cell| cell - own_cell + 1);
                let numbers: Vec<usize> = numbers.collect();
                if !numbers.is_empty() {
                    regions.push((CellSelection::Numbers(numbers), substance));
                }
            }
            own_cell += own.cell_count();
            recipe.regions = regions;
            let points = (first_point..).zip(recipe.points.drain(..));
            let points = points.filter(|(node, _)| map.numbers[*node].is_some());
            recipe.points = points
                .map(|(node, (name, position, mass))| (name, position, map.share(node) * mass))
                .collect();
            if let Some(plane) = plane {
                if let Some((name, ..)) = recipe.points.first() {
                    let help = "in a plane it would weigh on all of a line: leave it out";
                    return Err(InputError::new("point mass", format!("\"{name}\""), help));
                }
                (recipe.plane, recipe.thickness) = (Some(plane), Some(map.ends[1] - map.ends[0]));
                if plane == Plane::Stress {
                    recipe.dilatation = Dilatation::AtPoints;
                }
            }
            bodies.push((own.clone(), recipe));
        }
        if let ([(mesh, Recipe { name: Some(name), .. })], false) = (&mut bodies[..], is_single) {
            *mesh = mesh.clone().also_named(name);
        }
        Ok(Self { bodies })
    }

    /// Another material, everywhere outside regions.
    pub fn material(self, substance: impl Into<Substance>) -> Self {
        let substance = substance.into();
        self.each(|recipe| recipe.material = substance.clone())
    }

    /// Assembles the body.
    ///
    /// # Errors
    /// A material out of range, a missing or misplaced thickness or area, an inverted or flat cell,
    /// a node without a cell.
    pub fn build(self) -> Result<Body, InputError> {
        let bodies = self.bodies.into_iter().map(|(mesh, recipe)| Body::made(mesh, recipe));
        Body::join(bodies.collect::<Result<Vec<_>, _>>()?)
    }
}

impl Body {
    /// The single body of a recipe.
    fn made(mut mesh: Mesh, mut recipe: Recipe) -> Result<Self, InputError> {
        let section = recipe.section(&mesh)?;
        if section == Section::Turn {
            recipe.turn(&mut mesh)?;
        }
        let (strain, plane) = (recipe.strain, recipe.plane(&mesh));
        let viscosity = recipe.viscosity.unwrap_or(match strain {
            Strain::Cauchy => Viscosity::Natural,
            _ => Viscosity::Objective,
        });
        let mut regions = Regions::new(&mesh, strain, plane, &recipe.material, &recipe.regions)?;
        let whole = Whole::of(&mesh, &recipe)?;
        let rod = recipe.rod_elements()?;
        if let (Some(_), Some(name)) = (&rod, &recipe.name) {
            mesh = mesh.also_named(name);
        }
        for (name, position, mass) in &recipe.points {
            positive(&format!("mass of point \"{name}\""), *mass, "kg")?;
            mesh.push_node(name, position)?;
        }

        let frame = whole.iter().map(|whole| &whole.frame[..]);
        let sections = rod.as_ref().map_or_else(Vec::new, |rod| rod.groups());
        let groups = mesh.cells().chain(frame).chain(sections.iter().map(|nodes| &nodes[..]));
        let pattern = Arc::new(NodePattern::new(mesh.node_count(), groups));
        recipe.dilatation.check(mesh.kind(), mesh.dimension(), plane)?;
        let elements = elements(&mesh, section, recipe.dilatation, &pattern)?;
        mesh.check_sides()?;
        if let Some(given) = &recipe.material.mass {
            let density = given.mass / elements.volumes().iter().sum::<f64>();
            recipe.material.material.density = density;
            regions.set_density(density);
        }
        let material = &recipe.material;
        let mut inertia = NodeMatrix::zeros(&pattern);
        let mut stiffness = BlockMatrix::zeros(&pattern, mesh.dimension());
        let mut damping = stiffness.clone();
        let is_lumped = recipe.inertia == Inertia::Lumped;
        match &rod {
            Some(rod) => rod.add_inertia(1.0, is_lumped, &mut inertia),
            None => {
                elements.add_inertia(&regions, &|laws| laws.density, recipe.inertia, &mut inertia);
            }
        }
        let whole = whole.map(|whole| {
            let uniform = match mesh.is_surface() {
                true => MassMoments::of_surface(&mesh, material.material.density),
                false => MassMoments::of_matrix(&mesh, &inertia),
            };
            let moments = uniform.replaced_by(material.mass.as_ref())?;
            inertia = NodeMatrix::zeros(&pattern);
            whole.add_inertia(&moments, 1.0, &mut inertia);
            Ok((whole, moments))
        });
        let whole = whole.transpose()?;
        match &rod {
            Some(rod) => rod.add_tangents_at_rest(mesh.node_count(), &mut stiffness, &mut damping),
            None => {
                elements.add_stiffness(&regions, &|laws| laws.elastic, &mut stiffness);
                elements.add_stiffness(&regions, &|laws| laws.natural_viscosity(), &mut damping);
            }
        }
        let mass_damping = regions.have_mass_damping().then(|| {
            let mut matrix = match (recipe.inertia, &whole) {
                (Inertia::Lumped, None) if rod.is_none() => NodeMatrix::diagonal(mesh.node_count()),
                _ => NodeMatrix::zeros(&pattern),
            };
            let density = |laws: &Laws| laws.mass_damping * laws.density;
            match (&whole, &rod) {
                (Some((whole, moments)), _) => {
                    whole.add_inertia(moments, material.mass_damping, &mut matrix);
                }
                (None, Some(rod)) => {
                    rod.add_inertia(material.mass_damping, is_lumped, &mut matrix);
                }
                (None, None) => {
                    elements.add_inertia(&regions, &density, recipe.inertia, &mut matrix)
                }
            }
            damping.add_on_all_axes(&matrix);
            Arc::new(matrix)
        });
        let section = mean_section(section, &*elements);
        let cells = regions.by_substance(mesh.cell_count()).into_iter();
        let substances = std::iter::once(material).chain(recipe.regions.iter().map(|(_, s)| s));
        let substances = substances.map(|substance| &substance.fibres[..]).zip(cells);
        let fibres = families(&mesh, &*elements, substances)?;
        add_at_rest(&fibres, mesh.node_count() * mesh.dimension(), &mut stiffness, &mut damping);
        let first_point = mesh.node_count() - recipe.points.len();
        for (node, (_, _, mass)) in (first_point..).zip(&recipe.points) {
            inertia.add(node, node, *mass);
        }
        let continuum = Continuum {
            kind: mesh.kind(),
            nodes: 0..mesh.node_count(),
            cells: 0..mesh.cell_count(),
            material: material.material,
            strain,
            plane,
            viscosity,
            section,
            elements,
            regions: Arc::new(regions),
            fibres: Arc::new(fibres),
            rod: rod.map(Arc::new),
            recipe: Arc::new(recipe),
        };
        let body = Self {
            masses: Arc::new(NodalMasses::new(&inertia, &mesh)),
            mesh,
            continua: vec![continuum],
            joined: Arc::default(),
            inertia: Arc::new(inertia),
            stiffness: Arc::new(stiffness),
            damping: Arc::new(damping),
            mass_damping,
            rigid: None,
        };
        let body =
            Self { rigid: RigidPieces::of(&body.mesh, &body.rigid_cells()).map(Arc::new), ..body };
        // not the nodal masses: those of quadratic cells are 0 and below at corners
        let mut nodes = 0..body.mesh.node_count();
        let has_no_mass = |&node: &usize| {
            // nodes of rigid pieces may have it at others, with which they move
            body.inertia.get(node, node) == 0.0
                && body.rigid.as_ref().is_none_or(|rigid| !rigid.contains(node))
        };
        match nodes.find(has_no_mass) {
            Some(node) => Err(InputError::new(
                "node",
                node + 1,
                "it belongs to no cell, so that nothing holds it: leave it out of the mesh",
            )),
            None => Ok(body),
        }
    }

    /// Starts a body of `mesh`, made of `substance`, a [`Material`](crate::Material) or one with a
    /// [`Law`](crate::Law); [`BodyBuilder::build`] assembles it.
    #[allow(clippy::new_ret_no_self)] // a body is made by its builder alone
    pub fn new(mesh: Mesh, substance: impl Into<Substance>) -> BodyBuilder {
        BodyBuilder { bodies: vec![(mesh, Recipe::of(substance.into()))] }
    }
    /// Starts a body of a [rod](Rod) made of `substance`, whose law is linear; of the options of a body it has a name, inertia and point masses.
    ///
    /// # Errors
    /// A section of no size; fewer than two points, points that coincide; fewer elements than sides of the path; a kink that no section follows.
    pub fn rod(rod: Rod, substance: impl Into<Substance>) -> Result<BodyBuilder, InputError> {
        let mesh = rod.mesh()?;
        let recipe = Recipe { rod: Some(rod), ..Recipe::of(substance.into()) };
        Ok(BodyBuilder { bodies: vec![(mesh, recipe)] })
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
        let of_part = |part: Part| {
            let mut recipe = (*part.body.continua[0].recipe).clone();
            recipe.name = (!part.name.is_empty()).then(|| part.name.to_owned());
            let points = recipe.points.iter().map(|(name, ..)| &name[..]);
            (part.body.mesh.without_last(points), recipe)
        };
        BodyBuilder { bodies: self.parts().map(of_part).collect() }
    }

    /// Its name, if it has one: see [`join`](Self::join).
    pub fn name(&self) -> Option<&str> {
        self.continua[0].recipe.name.as_deref().filter(|_| self.is_single())
    }
}

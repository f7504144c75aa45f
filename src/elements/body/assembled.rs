//! An assembled body: its constant matrices, and results computed from displacements.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::continuum::Continuum;
use super::dilatation::Dilatation;
use super::fields::{CellField, NodalField, Probe, Tensors, nodal_fields};
use super::forces::Terms;
use super::inertia::Inertia;
use super::nodal_masses::NodalMasses;
use super::recipe::Recipe;
use super::reinforcement::Reinforcement;
use super::relaxing::Branches;
use super::rigid::RigidPieces;
use crate::base::input::{InputError, finite};
use crate::base::sparse::{BlockMatrix, NodeMatrix};
use crate::elements::basis::shares_at;
use crate::elements::force::NodalForces;
use crate::elements::material::{
    self, Hooke, Hookean, Lame, Material, Plane, Strain, Substance, Viscosity,
};
use crate::elements::mesh::Mesh;
use crate::integrators::ode::Failure;

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
///
/// Several bodies of one scene are [joined](Self::join) into one, whose nodes and cells are those of one body
/// after those of the other. Properties of a body such as its mass are then sums over all of them. Material, strain measure
/// and the like are read from each of its [`parts`](Self::parts): [`material`](Self::material), [`strain`](Self::strain),
/// [`viscosity`](Self::viscosity), [`dilatation`](Self::dilatation) and [`inertia_kind`](Self::inertia_kind) of several
/// bodies are those of the first.
#[derive(Clone)]
pub struct Body {
    pub(super) mesh: Mesh,
    /// The cells of each body.
    pub(super) continua: Vec<Continuum>,
    /// The bodies as they were before they were joined; none in a single one.
    pub(super) joined: Arc<[Joined]>,
    pub(super) inertia: Arc<NodeMatrix>,
    pub(super) masses: Arc<NodalMasses>,
    pub(super) stiffness: Arc<BlockMatrix>,
    pub(super) damping: Arc<BlockMatrix>,
    /// The part a M of the damping, if there is one.
    pub(super) mass_damping: Option<Arc<NodeMatrix>>,
    pub(super) rigid: Option<Arc<RigidPieces>>,
}

/// A body among those that it is joined with.
pub(super) struct Joined {
    pub(super) name: String,
    pub(super) body: Body,
    pub(super) nodes: Range<usize>,
    pub(super) cells: Range<usize>,
}

impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.is_single() {
            return f
                .debug_list()
                .entries(self.parts().map(|part| (part.name, part.body)))
                .finish();
        }
        let mut parts = f.debug_struct("Body");
        // as it was before there were bodies of revolution: checkpoints tell scenes apart by it
        if self.is_axisymmetric() {
            parts.field("plane", &Plane::Axisymmetric);
        }
        if let Some(rod) = &self.recipe().rod {
            parts.field("rod", rod);
        }
        parts
            .field("nodes", &self.mesh.node_count())
            .field("cells", &self.mesh.cell_count())
            .field("kind", &self.mesh.kind())
            .field("material", &self.recipe().material)
            .field("regions", &self.recipe().regions)
            .field("strain", &self.strain())
            .field("viscosity", &self.viscosity())
            .finish_non_exhaustive()
    }
}

impl Body {
    /// The mesh in its undeformed shape.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn recipe(&self) -> &Recipe {
        &self.continua[0].recipe
    }

    /// Its material; that of the first body, where several are joined.
    pub fn material(&self) -> &Material {
        &self.continua[0].material
    }

    /// Its material and those of its regions, body by body.
    pub(crate) fn materials(&self) -> impl Iterator<Item = &Material> {
        self.continua.iter().flat_map(|continuum| &continuum.regions.materials)
    }

    /// Assumption across its cells, if they have two dimensions; of several bodies that of the first.
    pub fn plane(&self) -> Option<Plane> {
        let continuum = &self.continua[0];
        (continuum.kind.dimension() == 2 && !self.mesh.is_surface()).then_some(continuum.plane)
    }

    /// The assumptions across cells of two dimensions of all bodies in words, as `plane strain`; `None` if there are no such cells.
    pub fn planes(&self) -> Option<String> {
        let with_names = |plane: Plane| {
            let parts = self.parts().filter(|part| part.body.plane() == Some(plane));
            (plane, parts.map(|part| part.name.to_owned()).collect::<Vec<_>>())
        };
        let mut all: Vec<_> =
            [Plane::Strain, Plane::Stress, Plane::Axisymmetric].map(with_names).into();
        all.retain(|(_, names)| !names.is_empty());
        match &all[..] {
            [] => None,
            [(Plane::Axisymmetric, _)] => Some("axisymmetric".into()),
            [(plane, _)] => Some(format!("plane {}", plane.name())),
            both => {
                let text = |(plane, names): &(Plane, Vec<String>)| {
                    format!("plane {} ({})", plane.name(), names.join(", "))
                };
                Some(both.iter().map(text).collect::<Vec<_>>().join(", "))
            }
        }
    }

    /// Its strain measure.
    pub fn strain(&self) -> Strain {
        self.continua[0].strain
    }

    /// Distribution of its inertia to the nodes.
    pub fn inertia_kind(&self) -> Inertia {
        self.recipe().inertia
    }

    /// Its treatment of volumetric strain.
    pub fn dilatation(&self) -> Dilatation {
        self.recipe().dilatation
    }

    /// Whether its cells are not free to change their volume by their thickness, so that they lock if the material is nearly
    /// incompressible.
    pub(crate) fn can_lock(&self) -> bool {
        !Dilatation::is_free(self.mesh.kind(), self.dimension(), self.continua[0].plane)
    }

    /// Its substance, then those of its regions; body by body.
    pub fn substances(&self) -> impl Iterator<Item = &Substance> {
        self.continua.iter().flat_map(|continuum| {
            let regions = continuum.recipe.regions.iter().map(|(_, substance)| substance);
            std::iter::once(&continuum.recipe.material).chain(regions)
        })
    }

    /// The substance of each cell.
    pub(crate) fn substances_of_cells(&self) -> Vec<&Substance> {
        let mut all = Vec::with_capacity(self.mesh.cell_count());
        for Continuum { recipe, regions, cells, .. } in &self.continua {
            let mut own = vec![&recipe.material; cells.len()];
            let of_regions = regions.by_substance(cells.len()).into_iter().skip(1);
            for (cells, (_, substance)) in of_regions.zip(&recipe.regions) {
                cells.into_iter().for_each(|cell| own[cell] = substance);
            }
            all.extend(own);
        }
        all
    }

    /// Its rigid pieces, if it has any.
    pub(crate) fn rigid_pieces(&self) -> Option<&Arc<RigidPieces>> {
        self.rigid.as_ref()
    }

    /// Number of displacement components that move by themselves: all but those of nodes of
    /// [rigid](crate::Material::rigid) pieces that move with others.
    pub fn independent_dofs(&self) -> usize {
        let dependent = self.rigid.as_ref().map_or(0, |rigid| rigid.dependent_nodes());
        self.dofs() - self.dimension() * dependent
    }

    /// Whether all of it is of rigid substances.
    pub(crate) fn is_rigid(&self) -> bool {
        self.substances().all(|substance| substance.is_rigid)
    }

    /// The numbers of its rigid cells (from 0).
    pub(super) fn rigid_cells(&self) -> Vec<usize> {
        let of_body = |Continuum { regions, cells, .. }: &Continuum| {
            let first = cells.start;
            let rigid = cells.clone().filter(|cell| regions.of(cell - first).of_rigid.is_some());
            rigid.collect::<Vec<_>>()
        };
        self.continua.iter().flat_map(of_body).collect()
    }

    /// Number of regions that were given.
    #[cfg(feature = "study")]
    pub(crate) fn region_count(&self) -> usize {
        self.recipe().regions.len()
    }

    /// Its kind of viscosity.
    pub fn viscosity(&self) -> Viscosity {
        self.continua[0].viscosity
    }

    /// Thickness (m) of a body of two-dimensional cells (of a body of revolution the length of its circles in the mean), cross-sectional
    /// area (m^2) of one of segments, 1 otherwise.
    pub(crate) fn section(&self) -> f64 {
        self.continua[0].section
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

    /// Damping matrix B = lambda_vis J_lambda + mu_vis J_mu + a M (N s/m), with the rate a of
    /// [mass damping](crate::Substance::mass_damping).
    pub fn damping(&self) -> &BlockMatrix {
        &self.damping
    }

    /// The connection matrices J_lambda and J_mu: geometry only (slides, "stiffness matrix").
    pub fn connection_matrices(&self) -> [BlockMatrix; 2] {
        [Lame { lambda: 1.0, mu: 0.0 }, Lame { lambda: 0.0, mu: 1.0 }].map(|unit| {
            let unit = material::Elastic::Linear(Hookean(Hooke::new(unit, 3, Plane::Strain)));
            let mut matrix = BlockMatrix::zeros(self.stiffness.pattern(), self.dimension());
            for Continuum { elements, regions, .. } in &self.continua {
                elements.add_stiffness(regions, &|_| unit, &mut matrix);
            }
            matrix
        })
    }

    /// Ratio of present to natural volume (area, length) of each cell under the displacements `u` (m).
    pub fn volume_ratios(&self, u: &[f64]) -> Vec<f64> {
        self.by_cell(|of| of.elements.volume_ratios(u))
    }

    /// Angle (rad, 0 to pi) by which each cell has turned under the displacements `u` (m): that of the
    /// rotation nearest to its mean deformation gradient.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh};
    ///
    /// let mesh = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Rectangles)?;
    /// let soft = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };
    /// let body = Body::new(mesh, soft).thickness(0.01).build()?;
    /// // sheared: the lower side stays, the upper one moves to the right by the height
    /// let turned = body.cell_rotations(&[0.0, 0.0, 0.0, 0.0, 0.1, 0.0, 0.1, 0.0]);
    /// assert!((turned[0].tan() - 0.5).abs() < 1e-12);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn cell_rotations(&self, u: &[f64]) -> Vec<f64> {
        self.by_cell(|of| of.elements.rotations(u))
    }

    /// Strain, stress and strain energy density of each cell under the displacements `u` (m,
    /// dimension components per node).
    ///
    /// ```
    /// use pliant::{Body, Material, Mesh, Strain};
    ///
    /// let soft = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };
    /// let bar = Body::new(Mesh::bar(0.1, 2)?, soft).area(2e-4).strain(Strain::Cauchy).build()?;
    /// let [field] = bar.cell_fields(&[0.0, 0.001])[..] else { panic!("one cell") };
    /// assert!((field.strain[0][0] - 0.01).abs() < 1e-12);
    /// assert!((field.stress[0][0] - 500.0).abs() < 1e-9 && (field.von_mises() - 500.0).abs() < 1e-9);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn cell_fields(&self, u: &[f64]) -> Vec<CellField> {
        self.by_cell(|of| of.elements.fields(&of.regions, u))
    }

    /// Part of the strain energy (0 to 1) under the displacements `u` (m) that is stored in the difference
    /// between the strain and a continuous one. `None` without strain.
    pub(crate) fn strain_jumps(&self, u: &[f64]) -> Option<f64> {
        let (mut energy, mut jumps) = (0.0, 0.0);
        for Continuum { elements, regions, strain, .. } in &self.continua {
            let (own, by_cell) = elements.jumps(regions, *strain, u);
            energy += own;
            jumps += by_cell.iter().sum::<f64>();
        }
        (energy > 0.0).then(|| jumps / energy)
    }

    /// The energy (J) of that difference in each cell.
    #[cfg(feature = "study")]
    pub(crate) fn strain_jumps_by_cell(&self, u: &[f64]) -> Vec<f64> {
        self.by_cell(|of| of.elements.jumps(&of.regions, of.strain, u).1)
    }

    /// Cells (counted from 0) that the displacements `u` (m) turn inside out.
    pub(crate) fn inverted_cells(&self, u: &[f64]) -> Vec<usize> {
        let of_body = |of: &Continuum| {
            let first = of.cells.start;
            of.elements.inverted(u).into_iter().map(move |cell| first + cell)
        };
        self.continua.iter().flat_map(of_body).collect()
    }

    /// Strain and stress at each node under the displacements `u` (m).
    ///
    /// They are those of the cells around it, extrapolated from where they are computed, in the mean weighted
    /// by the volumes of the cells. With quadratic cells fields that are linear in space come out exact.
    ///
    /// At the boundary of materials it is a mean over both: use [`cell_fields`](Self::cell_fields) there.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh, Strain};
    ///
    /// let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles6)?;
    /// let soft = Material { density: 1000.0, young: 5e4, poisson: 0.0, viscosity: 0.0 };
    /// let body = Body::new(mesh, soft).thickness(0.01).strain(Strain::Cauchy).build()?;
    /// // a strain of x / (1 m) along x
    /// let positions = body.mesh().positions().chunks(2);
    /// let u: Vec<f64> = positions.flat_map(|x| [x[0] * x[0] / 2.0, 0.0]).collect();
    /// for (field, x) in body.nodal_fields(&u).iter().zip(body.mesh().positions().chunks(2)) {
    ///     assert!((field.stress[0][0] - 5e4 * x[0]).abs() < 1e-9);
    /// }
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn nodal_fields(&self, u: &[f64]) -> Vec<NodalField> {
        let volumes = self.cell_volumes();
        nodal_fields(self.mesh.node_count(), &volumes, |cell, see| self.each_node(u, cell, see))
    }

    /// Calls `see` with the number of each node of a cell, its number among the nodes of the cell, and the
    /// tensors there.
    pub(super) fn each_node(
        &self,
        u: &[f64],
        cell: usize,
        see: &mut dyn FnMut(usize, usize, &Tensors),
    ) {
        let Continuum { elements, regions, cells, .. } = self.continuum_of(cell);
        elements.each_node(regions, u, cell - cells.start, see);
    }

    /// Values of all cells, body by body.
    pub(super) fn by_cell<T>(&self, of_body: impl Fn(&Continuum) -> Vec<T>) -> Vec<T> {
        match &self.continua[..] {
            [single] => of_body(single),
            several => several.iter().flat_map(of_body).collect(),
        }
    }

    /// The nodes of the cell in which the undeformed position `x` (m) lies, with their shape functions there.
    ///
    /// # Errors
    /// A point outside the body.
    pub(crate) fn shares_at(&self, x: &[f64]) -> Result<Vec<(usize, f64)>, InputError> {
        if x.len() != self.dimension() {
            let help = format!("it needs {} component(s) (m)", self.dimension());
            return Err(InputError::new("point", format!("{x:?}"), help));
        }
        finite("point", x)?;
        let of_rods = || self.shares_in_rods(x);
        shares_at(&self.mesh, x).or_else(of_rods).ok_or_else(|| {
            let help =
                "it lies outside the body: give the undeformed position of one of its points";
            InputError::new("point", format!("{x:?}"), help)
        })
    }

    /// A probe that reads the sum of the fields at nodes (counted from 0), each times its weight.
    pub(crate) fn probe(&self, weights: &[(usize, f64)]) -> Probe {
        Probe::new(&self.mesh, &self.cell_volumes(), weights)
    }

    /// Natural volume of each cell (m^3).
    pub fn cell_volumes(&self) -> Vec<f64> {
        self.by_cell(|of| of.elements.volumes())
    }

    /// Adds the elastic forces (N) at the displacements `u` (m, dimension components per node) to the
    /// conservative ones of `forces`, element by element. With Cauchy strain they are -K u.
    ///
    /// # Errors
    /// A cell for which the material's law has no meaning: one that `u` turns inside out, with Green
    /// strain.
    pub fn add_elastic_forces(&self, u: &[f64], forces: &mut NodalForces) -> Result<(), Failure> {
        // without objective viscosity velocities are not used
        let terms = Terms { elastic: true, viscous: false };
        self.continua.iter().try_for_each(|Continuum { elements, regions, .. }| {
            elements.add_forces(regions, terms, u, u, forces)
        })
    }

    /// Adds to `matrix` that of the Poisson equation of [steps that turn](super::turning).
    pub(crate) fn add_gradients(&self, matrix: &mut BlockMatrix) {
        self.continua.iter().for_each(|own| match &own.rod {
            Some(rod) => rod.add_gradients(matrix),
            None => own.elements.add_gradients(matrix),
        });
    }

    /// Adds its right-hand side for a `step` (m) from displacements `u` (m) to `right`. Returns the largest turn (rad) of a cell.
    pub(crate) fn add_turned(&self, u: &[f64], step: &[f64], right: &mut [f64]) -> f64 {
        let turns = self.continua.iter().map(|own| match &own.rod {
            Some(rod) => rod.add_turned(u, step, right),
            None => own.elements.add_turned(u, step, right),
        });
        turns.fold(0.0, f64::max)
    }

    /// Volume of the cells (m^3).
    pub fn volume(&self) -> f64 {
        self.cell_volumes().iter().sum()
    }

    pub(crate) fn shared_inertia(&self) -> Arc<NodeMatrix> {
        self.inertia.clone()
    }

    /// The forces of its fibres, if it has any.
    pub(crate) fn reinforcement(&self) -> Option<Reinforcement> {
        let fibres = self.continua.iter().map(|continuum| &continuum.fibres);
        let fibres: Vec<_> = fibres.filter(|families| !families.is_empty()).cloned().collect();
        (!fibres.is_empty()).then_some(Reinforcement(fibres))
    }

    /// The Maxwell branches, if there are any.
    pub(crate) fn branches(&self) -> Option<Branches> {
        Branches::of(self.continua.iter())
    }
}

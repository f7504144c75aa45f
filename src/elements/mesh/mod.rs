//! Meshes: nodes, cells, and named sets of nodes.
//!
//! Nodes and cells are counted from 0 inside the crate and in slices that it returns. In
//! selections and messages node numbers count from 1, as in the literature.

mod boundary;
mod cell;
mod cut;
mod generate;
#[cfg(feature = "gmsh")]
mod gmsh;
mod mirror;
mod node_map;
mod prism;
mod round;
mod select;
mod shape;
mod surface;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

pub use boundary::Face;
pub use cell::CellKind;
pub(crate) use cell::FaceKind;
pub(crate) use cut::Cut;
pub(crate) use generate::BYTES_PER_NODE;
pub use generate::{Cells, SolidCells};
pub(crate) use mirror::mirrored;
pub(crate) use node_map::NodeMap;
pub use select::Selection;
pub(crate) use surface::Enclosed;

use nalgebra::{Rotation3, Vector3};

use crate::base::input::{InputError, finite};

/// A finite element mesh in its undeformed shape: cells of one kind, in a space of their dimension or
/// of a higher one (a string in the plane or in space, a membrane in space, the [surface](Mesh::closed) of a rigid solid). That of several bodies
/// ([`Body::join`](crate::Body::join)) has those of one body after those of the other.
///
/// Axes are x, y, z in this order. Generators name the sides of a body by them: `left` and `right`
/// are its ends along x; `bottom` and `top` those along the last axis, y in 2D and z in 3D; `front`
/// and `back` those along y in 3D.
#[derive(Debug, Clone)]
pub struct Mesh {
    dimension: usize,
    positions: Vec<f64>,
    /// The cells of each body.
    blocks: Vec<Block>,
    sets: BTreeMap<String, Vec<usize>>,
    cell_groups: BTreeMap<String, Vec<usize>>,
    /// Nodes of a plane of symmetry at which it was cut.
    plane: Vec<usize>,
    /// The circles on which its nodes lie.
    round: Option<round::Round>,
    /// The file that it was read from, for messages.
    file: Option<Arc<Path>>,
    /// Changes that were made as it was read, in words.
    notes: Vec<String>,
}

/// Cells of one kind. Different blocks share no nodes.
#[derive(Debug, Clone)]
struct Block {
    kind: CellKind,
    connectivity: Vec<usize>,
    /// Whether they are the closed surface of a solid.
    is_surface: bool,
}

impl Block {
    fn cells(&self) -> impl ExactSizeIterator<Item = &[usize]> {
        self.connectivity.chunks_exact(self.kind.nodes())
    }
}

impl Mesh {
    /// A mesh from its parts.
    ///
    /// `positions` holds `dimension` coordinates (m) per node, one node after the other; `connectivity` the
    /// nodes of one cell after the other, counted from 0.
    ///
    /// # Errors
    /// Coordinates that are not finite, a dimension below that of the cells or above 3, a cell with a node
    /// that does not exist, two cells of the same nodes. (Inverted and flat cells are found when a body is
    /// made of it.)
    pub fn new(
        dimension: usize,
        positions: Vec<f64>,
        kind: CellKind,
        connectivity: Vec<usize>,
    ) -> Result<Self, InputError> {
        check_dimension(dimension, kind)?;
        if positions.is_empty() || !positions.len().is_multiple_of(dimension) {
            return Err(InputError::new(
                "number of mesh coordinates",
                positions.len(),
                format!("it must be {dimension} per node, for one node at least"),
            ));
        }
        finite("mesh.positions", &positions)?;
        if connectivity.is_empty() || !connectivity.len().is_multiple_of(kind.nodes()) {
            return Err(InputError::new(
                "length of mesh.connectivity",
                connectivity.len(),
                format!("it must be {} nodes per cell, for one cell at least", kind.nodes()),
            ));
        }
        let nodes = positions.len() / dimension;
        if let Some(at) = connectivity.iter().position(|&node| node >= nodes) {
            return Err(InputError::new(
                format!("node of cell {}", at / kind.nodes() + 1),
                connectivity[at] + 1,
                format!("the mesh has the nodes 1 to {nodes}"),
            ));
        }
        if let Some([first, second]) = twice(connectivity.chunks_exact(kind.nodes())) {
            let nodes = connectivity.chunks_exact(kind.nodes()).nth(second).unwrap_or_default();
            let nodes: Vec<usize> = nodes.iter().map(|node| node + 1).collect();
            return Err(InputError::new(
                format!("nodes of cell {}", second + 1),
                format!("{nodes:?}"),
                format!(
                    "they are those of cell {}, too: it would count twice, leave one of them out",
                    first + 1
                ),
            ));
        }
        Ok(Self::named(dimension, positions, kind, connectivity))
    }

    /// With the sets that every mesh has.
    fn named(
        dimension: usize,
        positions: Vec<f64>,
        kind: CellKind,
        connectivity: Vec<usize>,
    ) -> Self {
        let all = (0..positions.len() / dimension).collect();
        let (sets, cell_groups) = (BTreeMap::from([("all".into(), all)]), BTreeMap::new());
        let blocks = vec![Block { kind, connectivity, is_surface: false }];
        let plane = Vec::new();
        let mut mesh = Self {
            dimension,
            positions,
            blocks,
            sets,
            cell_groups,
            plane,
            round: None,
            file: None,
            notes: Vec::new(),
        };
        mesh.sets.insert("boundary".into(), mesh.find_boundary_nodes());
        mesh
    }

    /// Adds a node that belongs to no cell, alone in the node set `name`.
    pub(crate) fn push_node(&mut self, name: &str, position: &[f64]) -> Result<(), InputError> {
        if position.len() != self.dimension {
            let help = format!("it needs {} coordinates (m)", self.dimension);
            let input = format!("position of point \"{name}\"");
            return Err(InputError::new(input, format!("{position:?}"), help));
        }
        finite(&format!("the position of point \"{name}\""), position)?;
        if self.sets.contains_key(name) {
            let help = "a node set has that name already: choose another one";
            return Err(InputError::new("name of a point", format!("\"{name}\""), help));
        }
        let node = self.node_count();
        self.positions.extend_from_slice(position);
        self.sets.insert(name.into(), vec![node]);
        Ok(())
    }

    /// The same mesh without its last nodes, which belong to no cell and have these names.
    pub(crate) fn without_last<'a>(&self, names: impl ExactSizeIterator<Item = &'a str>) -> Self {
        let mut mesh = self.clone();
        mesh.positions.truncate(self.positions.len() - names.len() * self.dimension);
        for name in names {
            mesh.sets.remove(name);
        }
        mesh
    }

    /// A mesh of other cells and their nodes, with no sets but those that every mesh has.
    pub(crate) fn with_cells(
        &self,
        positions: Vec<f64>,
        kind: CellKind,
        connectivity: Vec<usize>,
    ) -> Self {
        let mut mesh = Self::named(self.dimension, positions, kind, connectivity);
        mesh.blocks[0].is_surface = self.blocks[0].is_surface;
        mesh.file.clone_from(&self.file);
        mesh.round.clone_from(&self.round);
        mesh
    }

    /// The mesh in words, with the file that it was read from.
    pub(crate) fn origin(&self) -> String {
        match &self.file {
            Some(file) => format!("mesh of file {}", file.display()),
            None => "mesh".into(),
        }
    }

    /// Whether it was read from a file, which has no shape but that of the cells.
    pub(crate) fn is_from_file(&self) -> bool {
        self.file.is_some()
    }

    /// Names nodes (from 0).
    pub(crate) fn set_nodes(&mut self, name: &str, nodes: Vec<usize>) {
        self.sets.insert(name.into(), nodes);
    }

    /// Names a group of cells (from 0, ascending).
    pub(crate) fn set_cells(&mut self, name: &str, cells: Vec<usize>) {
        self.cell_groups.insert(name.into(), cells);
    }

    /// The same mesh, moved by `offset` (m).
    ///
    /// # Errors
    /// An offset of the wrong length, or not finite.
    pub fn translated(mut self, offset: &[f64]) -> Result<Self, InputError> {
        if offset.len() != self.dimension {
            return Err(InputError::new(
                "length of the offset",
                offset.len(),
                format!("the mesh has dimension {}", self.dimension),
            ));
        }
        finite("offset", offset)?;
        for position in self.positions.chunks_exact_mut(self.dimension) {
            position.iter_mut().zip(offset).for_each(|(x, d)| *x += d);
        }
        self.move_circles(offset);
        Ok(self)
    }

    /// The same mesh, turned about the origin by the angle `turn` (rad): one number in the plane, counter-clockwise; in
    /// space three, the axis times the angle.
    ///
    /// ```
    /// # use pliant::{Mesh, SolidCells};
    /// # use std::f64::consts::PI;
    /// let lying = Mesh::cuboid([0.3, 0.2, 0.1], [2; 3], SolidCells::Hexahedra)?;
    /// let upright = lying.turned(&[0.0, -PI / 2.0, 0.0])?; // about y: x goes to z, z to -x
    /// let last = upright.position(7); // it was at (0.3, 0.2, 0.1)
    /// assert!((last[0] + 0.1).abs() + (last[1] - 0.2).abs() + (last[2] - 0.3).abs() < 1e-15);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// An angle of the wrong length, or not finite; a mesh on a line.
    pub fn turned(mut self, turn: &[f64]) -> Result<Self, InputError> {
        finite("turn", turn)?;
        let rotation = match (self.dimension, turn) {
            (2, &[angle]) => Rotation3::from_axis_angle(&Vector3::z_axis(), angle),
            (3, &[x, y, z]) => Rotation3::new(Vector3::new(x, y, z)),
            _ => {
                let help = "one angle (rad) in the plane; in space three numbers, the axis times the angle";
                return Err(InputError::new("turn", format!("{turn:?}"), help));
            }
        };
        for position in self.positions.chunks_exact_mut(self.dimension) {
            let mut place = Vector3::zeros();
            position.iter().zip(&mut place).for_each(|(x, place)| *place = *x);
            let turned = rotation * place;
            position.iter_mut().zip(&turned).for_each(|(x, turned)| *x = *turned);
        }
        self.turn_circles(&rotation);
        Ok(self)
    }

    /// The same mesh with the node at x (m) moved to `map(x)` (m).
    ///
    /// This bends a grid into another shape, or places it in a space of higher dimension. Cells and node sets
    /// stay; the set `boundary` is recomputed if the dimension changes.
    ///
    /// ```
    /// # use pliant::{Cells, Mesh};
    /// let square = Mesh::rectangle([1.0, 1.0], [3, 3], Cells::Triangles)?;
    /// let membrane = square.mapped(|x| [x[0], x[1], 0.1 * x[0] * x[1]])?;
    /// assert_eq!(membrane.dimension(), 3);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// A new position that is not finite, a dimension below that of the cells or above 3. (Cells
    /// that the map turns over are found when a body is made of the mesh.)
    pub fn mapped<const D: usize>(
        mut self,
        mut map: impl FnMut(&[f64]) -> [f64; D],
    ) -> Result<Self, InputError> {
        self.blocks.iter().try_for_each(|block| check_dimension(D, block.kind))?;
        let mut moved = Vec::with_capacity(D * self.node_count());
        for (node, from) in self.positions.chunks_exact(self.dimension).enumerate() {
            let to = map(from);
            if to.iter().any(|x| !x.is_finite()) {
                let help = format!("the map must give finite coordinates (m) for {from:?}");
                let input = format!("mapped position of node {}", node + 1);
                return Err(InputError::new(input, format!("{to:?}"), help));
            }
            moved.extend(to);
        }
        self.positions = moved;
        self.round = None;
        if D != self.dimension {
            self.dimension = D;
            self.sets.insert("boundary".into(), self.find_boundary_nodes());
        }
        Ok(self)
    }

    /// Dimension of space: coordinates per node.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.positions.len() / self.dimension
    }

    /// Natural coordinates (m), `dimension` per node.
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// Natural coordinates (m) of one node, counted from 0.
    pub fn position(&self, node: usize) -> &[f64] {
        &self.positions[node * self.dimension..][..self.dimension]
    }

    /// Type of the cells; of those of the first body, in a mesh of several.
    pub fn kind(&self) -> CellKind {
        self.blocks[0].kind
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.blocks.iter().map(|block| block.cells().len()).sum()
    }

    /// The cells: their nodes, counted from 0.
    pub fn cells(&self) -> impl Iterator<Item = &[usize]> {
        self.blocks.iter().flat_map(Block::cells)
    }

    /// The cells with their kinds.
    pub fn cells_with_kinds(&self) -> impl Iterator<Item = (CellKind, &[usize])> {
        self.blocks.iter().flat_map(|block| block.cells().map(|cell| (block.kind, cell)))
    }

    /// The meshes of several bodies as one, whose nodes and cells are those of one body after those of the
    /// other. Node sets and groups of cells have the name of their body before their own: `finger/tip`; those
    /// of all nodes and cells of a body have its name alone.
    pub(crate) fn join<'a>(bodies: impl Iterator<Item = (&'a str, &'a Self)>) -> Self {
        let mut joined = Self {
            dimension: 0,
            positions: Vec::new(),
            blocks: Vec::new(),
            sets: BTreeMap::new(),
            cell_groups: BTreeMap::new(),
            plane: Vec::new(),
            round: None,
            file: None,
            notes: Vec::new(),
        };
        let mut boundary = Vec::new();
        for (name, mesh) in bodies {
            joined.dimension = mesh.dimension;
            let (first_node, first_cell) = (joined.node_count(), joined.cell_count());
            let moved = |numbers: &[usize], first| numbers.iter().map(|k| first + k).collect();
            joined.positions.extend_from_slice(&mesh.positions);
            joined.blocks.extend(mesh.blocks.iter().map(|block| Block {
                kind: block.kind,
                connectivity: moved(&block.connectivity, first_node),
                is_surface: block.is_surface,
            }));
            boundary.extend(mesh.boundary_nodes().iter().map(|node| first_node + node));
            joined.plane.extend(mesh.plane.iter().map(|node| first_node + node));
            let is_own = |set: &str| set != "all" && !mesh.is_alias(set, name);
            for (own, nodes) in mesh.sets.iter().filter(|(own, _)| is_own(own)) {
                joined.sets.insert(format!("{name}/{own}"), moved(nodes, first_node));
            }
            joined.sets.insert(name.into(), (first_node..joined.node_count()).collect());
            for (own, cells) in &mesh.cell_groups {
                joined.cell_groups.insert(format!("{name}/{own}"), moved(cells, first_cell));
            }
            joined.cell_groups.insert(name.into(), (first_cell..joined.cell_count()).collect());
        }
        joined.sets.insert("all".into(), (0..joined.node_count()).collect());
        joined.sets.insert("boundary".into(), boundary);
        joined
    }

    /// The same; its sets are known by the `name` of its body, too, as among others.
    pub(crate) fn also_named(mut self, name: &str) -> Self {
        let own = self.sets.clone().into_iter();
        let own: Vec<_> = own.filter(|(set, _)| !self.is_alias(set, name)).collect();
        for (set, nodes) in own {
            let known = if set == "all" { name.to_owned() } else { format!("{name}/{set}") };
            self.sets.insert(known, nodes);
        }
        self
    }

    /// Whether a set is one that [`also_named`](Self::also_named) has added.
    fn is_alias(&self, set: &str, name: &str) -> bool {
        let own = match set.strip_prefix(name) {
            Some("") => "all",
            Some(rest) => rest.strip_prefix('/').unwrap_or(""),
            None => "",
        };
        self.sets.get(own).is_some_and(|nodes| *nodes == self.sets[set])
    }

    /// Notes in words on changes made while it was read from a file: omitted triangles without an area, for example.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The named node sets.
    ///
    /// Nodes are counted from 0 and in the order in which they were named; those of the generators run along
    /// their side, `all` and `boundary` ascend.
    pub fn sets(&self) -> &BTreeMap<String, Vec<usize>> {
        &self.sets
    }

    /// The named groups of cells (counted from 0, ascending) that the mesh was read with: see
    /// [`Mesh::read_gmsh`].
    pub fn cell_groups(&self) -> &BTreeMap<String, Vec<usize>> {
        &self.cell_groups
    }

    /// Nodes on the boundary, counted from 0, ascending. In a space of higher dimension than the
    /// cells these are all nodes of cells.
    pub fn boundary_nodes(&self) -> &[usize] {
        &self.sets["boundary"]
    }

    /// The values of a vector field at all nodes, one node after the other.
    pub(crate) fn field(&self, field: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
        self.positions.chunks_exact(self.dimension).flat_map(field).collect()
    }

    /// Length of the diagonal of the box around the mesh (m).
    pub fn size(&self) -> f64 {
        let extent = |axis: usize| {
            let along = self.positions.iter().skip(axis).step_by(self.dimension);
            let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| {
                (low.min(x), high.max(x))
            });
            high - low
        };
        (0..self.dimension).map(|axis| extent(axis).powi(2)).sum::<f64>().sqrt()
    }
}

/// The first two cells that have the same nodes, in any order.
fn twice<'a>(cells: impl Iterator<Item = &'a [usize]>) -> Option<[usize; 2]> {
    let sorted = cells.map(|cell| {
        let mut nodes = cell.to_vec();
        nodes.sort_unstable();
        nodes
    });
    let mut sorted: Vec<(Vec<usize>, usize)> = sorted.zip(0..).collect();
    sorted.sort_unstable();
    let same = sorted.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    same.map(|pair| [pair[0].1, pair[1].1]).min_by_key(|pair| pair[1])
}

fn check_dimension(dimension: usize, kind: CellKind) -> Result<(), InputError> {
    let least = kind.dimension();
    let most = if kind.fills_space() { least } else { 3 };
    if (least..=most).contains(&dimension) {
        return Ok(());
    }
    let help = match least {
        _ if least < most => format!("{kind:?} cells need a space of dimension {least} to 3"),
        2 if dimension == 3 => format!(
            "{kind:?} cells are for bodies that fill a plane, where they do not lock; a membrane in space does not lock: take \
             \"triangles6\""
        ),
        _ => format!("{kind:?} cells need a space of dimension {least}"),
    };
    Err(InputError::new("mesh.dimension", dimension, help))
}

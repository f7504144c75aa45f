//! Finer meshes: cells divided at the middles of their edges, or given mid nodes.
//!
//! A new node is identified by the corners around it and their weights in sixty-fourths, so that all cells
//! find the same one; position and initial state follow from the shape functions of the coarse cell. Old
//! nodes keep their numbers, so that node selections of a scene stay valid; forces on single nodes stay on
//! these nodes.

use std::collections::BTreeMap;
use std::ops::Range;

use super::ReferenceCell;
use super::with_element;
use crate::base::input::InputError;
use crate::elements::mesh::{CellKind, Mesh};

mod joined;

/// A mesh made finer: nodes keep their numbers, and new ones follow. Of several bodies both do in each.
pub(crate) struct Finer {
    pub(crate) mesh: Mesh,
    /// Index of the first part of each divided cell, and their number at the end.
    first_child: Vec<usize>,
    /// The numbers of the nodes of the first mesh, and the place of every node in it.
    olds: Vec<usize>,
    places: Vec<NodeOrigin>,
    /// Node numbers by their places.
    numbers: BTreeMap<Corners, usize>,
    is_boundary: Vec<bool>,
}

/// Position of a node in the first mesh.
struct NodeOrigin {
    corners: Corners,
    /// Nodes of the first mesh with the values of their shape functions.
    shares: Vec<(usize, f64)>,
}

/// A point, given by corners of a cell and their weights, ascending: the same from all cells around it.
type Corners = Vec<(usize, u32)>;

/// The weights of the corners add up to this, so that those of quarter points of edges and of the middles of faces and cells are
/// whole numbers, of their halves, too.
const WHOLE: f64 = 192.0;

/// A point of the reference cell; coordinates beyond its dimension are 0.
pub(super) type Point = [f64; 3];

impl Mesh {
    /// The same mesh with each cell divided into 2, 4 or 8 of its kind, at the middles of its edges.
    ///
    /// Nodes keep their numbers, and new ones follow: on the circles of [rings](Self::ring), and else at the middles as the cells have
    /// them. A new node belongs to the node sets that all corners
    /// around it belong to. Cell c (from 0), divided into n cells, becomes the cells n c to n c + n - 1.
    ///
    /// ```
    /// use pliant::{Cells, Mesh};
    ///
    /// let coarse = Mesh::rectangle([0.2, 0.1], [3, 2], Cells::Triangles)?;
    /// let fine = coarse.halved();
    /// assert_eq!((fine.cell_count(), fine.node_count()), (16, 15));
    /// assert_eq!(fine.sets()["bottom"].len(), 5);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    #[must_use]
    pub fn halved(&self) -> Self {
        self.divided().mesh
    }

    /// The same mesh with quadratic cells.
    ///
    /// Triangles, tetrahedra and hexahedra get a node in the middle of each edge; quadrilaterals are first
    /// divided into two triangles. Nodes keep their numbers, as in [`halved`](Self::halved).
    ///
    /// # Errors
    /// Cells that are quadratic already, or that have no quadratic kind (segments).
    pub fn quadratic(&self) -> Result<Self, InputError> {
        self.elevated().map(|finer| finer.mesh)
    }

    /// The same mesh with quadratic triangles and tetrahedra that have bubbles: nodes in the middle of each cell and, in space, of
    /// each of its faces, too.
    ///
    /// With [`Dilatation::Linear`](crate::Dilatation::Linear) they are the cells for nearly incompressible bodies of any shape.
    /// Quadrilaterals of four nodes are first divided into two triangles. Nodes keep their numbers, as in
    /// [`halved`](Self::halved).
    ///
    /// ```
    /// use pliant::{Cells, Mesh};
    ///
    /// let mesh = Mesh::rectangle([0.2, 0.1], [3, 2], Cells::Triangles6)?;
    /// let with_bubbles = mesh.with_bubbles()?;
    /// assert_eq!((mesh.node_count(), with_bubbles.node_count()), (15, 15 + 4));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// Cells of other shapes, or that have bubbles already.
    pub fn with_bubbles(&self) -> Result<Self, InputError> {
        self.bubbled().map(|finer| finer.mesh)
    }

    pub(crate) fn divided(&self) -> Finer {
        let kind = self.kind();
        let children = halves(linear(kind));
        Finer::new(self, kind, |_| children.clone())
    }

    /// See [`quadratic`](Self::quadratic).
    pub(crate) fn elevated(&self) -> Result<Finer, InputError> {
        let (kind, children): (_, &[&[usize]]) = match self.kind() {
            CellKind::Triangle => (CellKind::Triangle6, &[&[0, 1, 2]]),
            CellKind::Quadrilateral => (CellKind::Triangle6, HALVES_OF_QUADRILATERAL),
            CellKind::Tetrahedron => (CellKind::Tetrahedron10, &[&[0, 1, 2, 3]]),
            CellKind::Hexahedron => (CellKind::Hexahedron20, &[&[0, 1, 2, 3, 4, 5, 6, 7]]),
            kind => {
                let help = "triangles, quadrilaterals, tetrahedra and hexahedra of linear shape functions get mid nodes";
                return Err(InputError::new("cells", kind.name(), help));
            }
        };
        Ok(self.with_children(kind, children))
    }

    /// See [`with_bubbles`](Self::with_bubbles).
    pub(crate) fn bubbled(&self) -> Result<Finer, InputError> {
        let (kind, children): (_, &[&[usize]]) = match self.kind() {
            CellKind::Triangle | CellKind::Triangle6 => (CellKind::Triangle7, &[&[0, 1, 2]]),
            CellKind::Quadrilateral => (CellKind::Triangle7, HALVES_OF_QUADRILATERAL),
            CellKind::Tetrahedron | CellKind::Tetrahedron10 => {
                (CellKind::Tetrahedron15, &[&[0, 1, 2, 3]])
            }
            kind => {
                let help = "triangles and tetrahedra get bubbles; quadratic quadrilaterals and hexahedra need none: take \"rectangles9\" or \
                            \"hexahedra27\" (in Gmsh: Mesh.ElementOrder = 2)";
                return Err(InputError::new("cells", kind.name(), help));
            }
        };
        Ok(self.with_children(kind, children))
    }

    /// Cells of this `kind` between these corners of each cell.
    fn with_children(&self, kind: CellKind, children: &[&[usize]]) -> Finer {
        let corners = nodes(self.kind());
        let child = |child: &&[usize]| child.iter().map(|&node| corners[node]).collect();
        Finer::new(self, kind, |_| children.iter().map(child).collect())
    }
}

/// The triangles that a quadrilateral is divided into, by its corners.
const HALVES_OF_QUADRILATERAL: &[&[usize]] = &[&[0, 1, 2], &[0, 2, 3]];

impl Finer {
    /// `mesh` with cells of this `kind`: `children` gives the corners, in the reference cell, of those that
    /// a cell (from 0) is divided into.
    pub(super) fn new(
        mesh: &Mesh,
        kind: CellKind,
        children: impl Fn(usize) -> Vec<Vec<Point>>,
    ) -> Self {
        let old = mesh.node_count();
        let mut finer = Self {
            mesh: mesh.clone(),
            first_child: vec![0],
            olds: (0..old).collect(),
            places: Vec::new(),
            numbers: BTreeMap::new(),
            is_boundary: Vec::new(),
        };
        let mut places: Vec<Option<NodeOrigin>> = (0..old).map(|_| None).collect();
        let reference = nodes(mesh.kind());
        for cell in mesh.cells() {
            for (node, at) in cell.iter().zip(&reference) {
                let place = NodeOrigin::new(mesh.kind(), cell, at);
                finer.numbers.insert(place.corners.clone(), *node);
                places[*node] = Some(place);
            }
        }
        // nodes of no cell keep their places
        let placed = |(node, place): (_, Option<_>)| place.unwrap_or_else(|| NodeOrigin::at(node));
        finer.places = places.into_iter().enumerate().map(placed).collect();
        let mut connectivity = Vec::new();
        for (number, cell) in mesh.cells().enumerate() {
            let children = children(number);
            for point in children.iter().flat_map(|child| with_mid_nodes(kind, child)) {
                let place = NodeOrigin::new(mesh.kind(), cell, &point);
                let next = finer.places.len();
                let number = *finer.numbers.entry(place.corners.clone()).or_insert(next);
                if number == next {
                    finer.places.push(place);
                }
                connectivity.push(number);
            }
            finer.first_child.push(connectivity.len() / kind.nodes());
        }
        let mut positions = finer.interpolated(mesh.positions(), mesh.dimension());
        finer.onto_circles(mesh, &mut positions);
        finer.mesh = mesh.with_cells(positions, kind, connectivity);
        finer.is_boundary = vec![false; finer.places.len()];
        if !mesh.plane_of_symmetry().is_empty() {
            finer.mesh.cut_at(finer.extended(mesh.plane_of_symmetry()));
        }
        for &node in finer.mesh.boundary_nodes() {
            finer.is_boundary[node] = true;
        }
        for (name, nodes) in mesh.sets() {
            if !["all", "boundary"].contains(&&name[..]) {
                finer.mesh.set_nodes(name, finer.extended(nodes));
            }
        }
        for (name, cells) in mesh.cell_groups() {
            finer.mesh.set_cells(name, finer.children_of(cells));
        }
        finer
    }

    /// Brings new nodes of a ring onto its circles: halves of a polygon would be the same polygon.
    fn onto_circles(&self, mesh: &Mesh, positions: &mut [f64]) {
        if !mesh.is_round() {
            return;
        }
        let nodes = positions.chunks_exact_mut(mesh.dimension()).zip(&self.places);
        for (position, place) in nodes.skip(self.olds.len()) {
            let share = |(node, part): &(usize, u32)| (*node, f64::from(*part) / WHOLE);
            let shares: Vec<(usize, f64)> = place.corners.iter().map(share).collect();
            if let Some(on_circle) = mesh.between_on_circle(&shares) {
                position.copy_from_slice(&on_circle);
            }
        }
    }

    /// The cells (from 0) into which these `cells` of the first mesh are divided.
    pub(crate) fn children_of(&self, cells: &[usize]) -> Vec<usize> {
        cells.iter().flat_map(|&cell| self.children(cell)).collect()
    }

    /// The number of cells of the first mesh.
    #[cfg(feature = "study")]
    pub(crate) fn old_cell_count(&self) -> usize {
        self.first_child.len() - 1
    }

    /// The cells (from 0) into which a `cell` of the first mesh is divided.
    pub(crate) fn children(&self, cell: usize) -> Range<usize> {
        self.first_child[cell]..self.first_child[cell + 1]
    }

    /// Nodes (from 0) of the first mesh in the given order, with the new ones between them. If all given
    /// nodes are on the boundary, only new ones on the boundary are added.
    pub(crate) fn extended(&self, nodes: &[usize]) -> Vec<usize> {
        let mut is_given = vec![false; self.olds.len()];
        nodes.iter().for_each(|&node| is_given[node] = true);
        let all_outside = nodes.iter().all(|&node| self.is_boundary[self.olds[node]]);
        let between = |(place, &is_outside): (&NodeOrigin, &bool)| {
            let is_between = place.corners.iter().all(|(corner, _)| is_given[*corner]);
            is_between && (is_outside || !all_outside)
        };
        let mut is_new: Vec<bool> =
            self.places.iter().zip(&self.is_boundary).map(between).collect();
        self.olds.iter().for_each(|&node| is_new[node] = false);
        let mut run = Vec::with_capacity(2 * nodes.len());
        let next = nodes.iter().skip(1).chain(nodes.first());
        for (&node, &next) in nodes.iter().zip(next) {
            let [node, next] = [node, next].map(|node| self.olds[node]);
            run.push(node);
            let middle = middle(&self.places[node].corners, &self.places[next].corners);
            if let Some(&number) = self.numbers.get(&middle).filter(|number| is_new[**number]) {
                run.push(number);
                is_new[number] = false;
            }
        }
        run.extend((0..is_new.len()).filter(|&number| is_new[number]));
        run
    }

    /// The new number (from 0) of a node of the first mesh or of a point mass; point masses come last.
    pub(crate) fn number(&self, node: usize) -> usize {
        let point = || node + self.places.len() - self.olds.len();
        self.olds.get(node).copied().unwrap_or_else(point)
    }

    /// The nodes (from 0) that the first mesh, that of a single body, did not have.
    #[cfg(feature = "study")]
    pub(crate) fn new_nodes(&self) -> std::ops::Range<usize> {
        self.olds.len()..self.places.len()
    }

    /// Interpolates a vector field from the nodes of the first mesh to all nodes. The vectors of point masses
    /// stay last.
    pub(crate) fn interpolated(&self, field: &[f64], dimension: usize) -> Vec<f64> {
        let (field, points) = field.split_at((self.olds.len() * dimension).min(field.len()));
        let mut values = vec![0.0; self.places.len() * dimension];
        let mut is_old = vec![false; self.places.len()];
        for (&node, own) in self.olds.iter().zip(field.chunks_exact(dimension)) {
            values[node * dimension..][..dimension].copy_from_slice(own);
            is_old[node] = true;
        }
        let nodes = values.chunks_exact_mut(dimension).zip(&self.places).zip(&is_old);
        for ((values, place), _) in nodes.filter(|(_, is_old)| !**is_old) {
            for (axis, value) in values.iter_mut().enumerate() {
                let part = |(node, share): &(usize, f64)| share * field[node * dimension + axis];
                *value = place.shares.iter().map(part).sum();
            }
        }
        values.extend_from_slice(points);
        values
    }
}

impl NodeOrigin {
    /// That of a node of the first mesh.
    fn at(node: usize) -> Self {
        Self { corners: vec![(node, WHOLE as u32)], shares: vec![(node, 1.0)] }
    }

    /// The place of the point `at` of the reference cell, in a `cell` of this `kind`.
    fn new(kind: CellKind, cell: &[usize], at: &Point) -> Self {
        let parts = shape_functions(linear(kind), at);
        let parts =
            cell.iter().zip(parts).map(|(node, part)| (*node, (WHOLE * part).round() as u32));
        let mut corners: Corners = parts.filter(|(_, part)| *part > 0).collect();
        corners.sort_unstable();
        let shares = cell.iter().copied().zip(shape_functions(kind, at));
        Self { corners, shares: shares.filter(|(_, share)| *share != 0.0).collect() }
    }
}

/// The middle between two places, identified by its corners.
fn middle(one: &Corners, other: &Corners) -> Corners {
    let mut parts = BTreeMap::new();
    for (corner, part) in one.iter().chain(other) {
        *parts.entry(*corner).or_insert(0) += part;
    }
    parts.into_iter().map(|(corner, part)| (corner, part / 2)).collect()
}

/// The kind with the same corners, and no other nodes.
pub(super) fn linear(kind: CellKind) -> CellKind {
    match kind {
        CellKind::Triangle6 | CellKind::Triangle7 => CellKind::Triangle,
        CellKind::Tetrahedron10 | CellKind::Tetrahedron15 => CellKind::Tetrahedron,
        CellKind::Quadrilateral9 => CellKind::Quadrilateral,
        CellKind::Hexahedron20 | CellKind::Hexahedron27 => CellKind::Hexahedron,
        kind => kind,
    }
}

/// The corners of a cell of a `kind`, and the middles of its edges, faces and of itself that have nodes.
fn with_mid_nodes(kind: CellKind, corners: &[Point]) -> Vec<Point> {
    let mut points = corners.to_vec();
    for edge in kind.edges().iter().filter(|edge| edge.len() > 2) {
        points.push(between(&corners[edge[0]], &corners[edge[1]]));
    }
    points.extend(kind.middles().iter().map(|ends| mean(corners, ends)));
    points
}

fn between(a: &Point, b: &Point) -> Point {
    std::array::from_fn(|i| 0.5 * (a[i] + b[i]))
}

/// The mean of some corners.
pub(super) fn mean(corners: &[Point], ends: &[usize]) -> Point {
    let sum = |i: usize| ends.iter().map(|&end| corners[end][i]).sum::<f64>();
    std::array::from_fn(|i| sum(i) / ends.len() as f64)
}

/// Corners of the cells into which a linear cell is divided.
fn halves(kind: CellKind) -> Vec<Vec<Point>> {
    let corners = nodes(kind);
    let simplices: &[&[usize]] = match kind {
        CellKind::Triangle => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        // four at the corners; the octahedron that is left is divided along the line from 6 to 8 (Bey 1995)
        CellKind::Tetrahedron => &[
            &[0, 4, 6, 7],
            &[4, 1, 5, 8],
            &[6, 5, 2, 9],
            &[7, 8, 9, 3],
            &[4, 6, 7, 8],
            &[4, 5, 6, 8],
            &[6, 9, 7, 8],
            &[5, 9, 6, 8],
        ],
        // one at each corner: the cell, halved towards it
        _ => {
            let child = |corner: &Point| corners.iter().map(|node| between(node, corner)).collect();
            return corners.iter().map(child).collect();
        }
    };
    let quadratic = match kind {
        CellKind::Triangle => CellKind::Triangle6,
        _ => CellKind::Tetrahedron10,
    };
    let points = with_mid_nodes(quadratic, &corners);
    simplices.iter().map(|child| child.iter().map(|&point| points[point]).collect()).collect()
}

/// Positions of the nodes of the reference cell.
pub(super) fn nodes(kind: CellKind) -> Vec<Point> {
    fn nodes<
        C: ReferenceCell<N, M>,
        const N: usize,
        const M: usize,
        const D: usize,
        const P: usize,
    >() -> Vec<Point> {
        C::NODES.map(|x| std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0))).into()
    }
    with_element!(kind, 3, nodes())
}

/// The shape functions of a cell of a `kind` at a point.
fn shape_functions(kind: CellKind, at: &Point) -> Vec<f64> {
    fn values<
        C: ReferenceCell<N, M>,
        const N: usize,
        const M: usize,
        const D: usize,
        const P: usize,
    >(
        at: &Point,
    ) -> Vec<f64> {
        C::values(std::array::from_fn(|i| at[i])).into()
    }
    with_element!(kind, 3, values(at))
}

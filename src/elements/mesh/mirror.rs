//! Mirror images of nodes, and the halves of meshes on one side of a plane.
//!
//! Of several bodies each is its own mirror image or that of another one. Cells on both sides of the plane need not be images of each
//! other where all of a body are of one material; no cell lies across it.

use std::collections::BTreeMap;
use std::iter;

use super::node_map::within;
use super::{Mesh, NodeMap};
use crate::base::grid::Grid;
use crate::base::input::InputError;
use crate::base::vector::{distinct, padded};

/// Equal positions may differ by this fraction of the size of a mesh: round-off when it is made.
const SAME: f64 = 1e-9;

/// The middle of all `meshes` on an axis (m), and the mirror images of all nodes in the plane there, counted through all meshes:
/// those of each mesh in itself or in one other. `None` if not every node has one.
pub(crate) fn mirrored(meshes: &[&Mesh], axis: usize) -> Option<(f64, Vec<usize>)> {
    let along =
        || meshes.iter().flat_map(|mesh| mesh.positions.iter().skip(axis).step_by(mesh.dimension));
    let [least, most] = [
        along().copied().fold(f64::INFINITY, f64::min),
        along().copied().fold(f64::NEG_INFINITY, f64::max),
    ];
    let at = 0.5 * (least + most);
    let tolerance = SAME * meshes.iter().map(|mesh| mesh.size()).fold(0.0, f64::max);
    let points = |mesh: &&Mesh| -> Vec<[f64; 3]> {
        mesh.positions.chunks_exact(mesh.dimension).map(padded).collect()
    };
    let points: Vec<Vec<[f64; 3]>> = meshes.iter().map(points).collect();
    let (mut count, mut bodies) = (0, Vec::new());
    for points in &points {
        bodies.push((count, Grid::new(points), points));
        count += points.len();
    }
    let image = |x: &[f64; 3], grid: &Grid| -> Option<usize> {
        let mut to = *x;
        to[axis] = 2.0 * at - to[axis];
        let corners = [-tolerance, tolerance].map(|step| to.map(|x| x + step));
        let (mut found, mut count) = (None, 0);
        grid.each_within(&corners, |number| {
            found = Some(number);
            count += 1;
        });
        found.filter(|_| count == 1)
    };
    let mut images = Vec::with_capacity(count);
    for own in &bodies {
        let within = |(first, grid, points): &(usize, Grid, &Vec<[f64; 3]>)| {
            let all = own.2.iter().map(|x| Some(first + image(x, grid)?));
            all.collect::<Option<Vec<_>>>().filter(|_| points.len() == own.2.len())
        };
        images.extend(iter::once(own).chain(&bodies).find_map(within)?);
    }
    Some((at, images))
}

impl NodeMap {
    /// The map to the halves of the `meshes` of bodies on one side of their middle plane across an axis.
    ///
    /// # Errors
    /// An axis that the meshes do not have; a node without a mirror image.
    pub(crate) fn half(meshes: &[&Mesh], axis: usize, is_upper: bool) -> Result<Self, InputError> {
        let (name, dimension) = (["x", "y", "z"][axis], meshes[0].dimension);
        if axis >= dimension {
            let help = format!("the body has {dimension} dimension(s)");
            return Err(InputError::new("axis of symmetry", name, help));
        }
        let (at, images) = mirrored(meshes, axis).ok_or_else(|| {
            let help = "a node has no mirror image: make it so, or leave the scene whole";
            InputError::new(format!("mesh along {name}"), "not symmetric", help)
        })?;
        let mut map = Self {
            meshes: Vec::new(),
            axis,
            ends: [at; 2],
            is_upper,
            across: -1.0,
            images,
            cell_images: Vec::new(),
            numbers: Vec::new(),
            cells: Vec::new(),
            middles: Vec::new(),
        };
        let mut all = Vec::new();
        for mesh in meshes {
            let first = map.numbers.len();
            all.extend(mesh.cells().map(|cell| cell.iter().map(|node| first + node).collect()));
            map.add_half(mesh);
        }
        let known: BTreeMap<Vec<usize>, usize> =
            all.iter().map(|cell: &Vec<usize>| distinct(cell.iter().copied())).zip(0..).collect();
        let image = |cell: &Vec<usize>| distinct(cell.iter().map(|&node| map.images[node]));
        map.cell_images = all.iter().map(|cell| known.get(&image(cell)).copied()).collect();
        Ok(map)
    }

    /// Adds the half of the next mesh.
    fn add_half(&mut self, mesh: &Mesh) {
        let first = self.numbers.len();
        let [first_own, first_cell] =
            [&self.numbers, &self.cells].map(|all| all.iter().flatten().count());
        let is_on_plane = |node: usize| self.images[first + node] == first + node;
        let (mut numbers, mut kept) = (vec![None; mesh.node_count()], Vec::new());
        for (node, number) in numbers.iter_mut().enumerate() {
            if is_on_plane(node) || self.is_kept(mesh.position(node)[self.axis]) {
                *number = Some(kept.len());
                kept.push(node);
            }
        }
        let (mut count, mut connectivity) = (0, Vec::new());
        let mut number = |cell: &[usize]| {
            let own: Option<Vec<usize>> = cell.iter().map(|&node| numbers[node]).collect();
            connectivity.extend(own?);
            count += 1;
            Some(count - 1)
        };
        let cells: Vec<Option<usize>> = mesh.cells().map(&mut number).collect();
        // point masses, which have no cells, come after all others
        let last = mesh.cells().flatten().max().copied().unwrap_or_default();
        let positions = kept.iter().take_while(|&&node| node <= last);
        let positions = positions.flat_map(|&node| mesh.position(node)).copied().collect();
        self.meshes.push((count > 0).then(|| {
            let mut own = mesh.with_cells(positions, mesh.kind(), connectivity);
            let plane = (0..numbers.len()).filter(|&node| is_on_plane(node));
            own.take_names(mesh, plane.collect(), |nodes| within(&numbers, nodes), &cells);
            own
        }));
        let moved = |all: Vec<Option<usize>>, first: usize| {
            all.into_iter().map(move |number| number.map(|number| first + number))
        };
        self.numbers.extend(moved(numbers, first_own));
        self.cells.extend(moved(cells, first_cell));
    }
}

impl Mesh {
    /// Takes faces between these nodes of a plane of symmetry out of the boundary.
    pub(crate) fn cut_at(&mut self, plane: Vec<usize>) {
        self.plane = plane;
        self.sets.insert("boundary".into(), self.find_boundary_nodes());
    }

    /// The nodes (from 0) of a plane of symmetry at which it was cut.
    pub(crate) fn plane_of_symmetry(&self) -> &[usize] {
        &self.plane
    }
}

#[cfg(test)]
mod tests {
    use super::{InputError, mirrored};
    use crate::elements::mesh::{Cells, Mesh, NodeMap};

    fn lower(mesh: &Mesh, axis: usize) -> Result<NodeMap, InputError> {
        NodeMap::half(&[mesh], axis, false)
    }

    #[test]
    fn a_grid_is_its_own_image_and_loses_half() {
        let mesh = Mesh::rectangle([0.4, 0.1], [5, 2], Cells::Triangles).unwrap();
        let mesh = mesh.translated(&[1.0, 0.0]).unwrap();
        let (at, images) = mirrored(&[&mesh], 0).unwrap();
        assert!((at - 1.2).abs() < 1e-15);
        assert_eq!(images, [4, 3, 2, 1, 0, 9, 8, 7, 6, 5]);
        let half = lower(&mesh, 0).unwrap().meshes.remove(0).unwrap();
        assert_eq!((half.node_count(), half.cell_count()), (6, 4));
        // the cut is open: its edge is none of the boundary, and its ends are on others
        assert_eq!(half.boundary_faces().len(), 5);
        assert_eq!(half.plane_of_symmetry(), [2, 5]);
        assert_eq!(half.boundary_nodes().len(), 6);
        assert!(!half.sets().contains_key("right"));
        assert_eq!(half.sets()["bottom"], [0, 1, 2]);
        // one node off its place
        let bent = mesh.mapped(|x| [x[0] + if x[0] > 1.35 { 1e-6 } else { 0.0 }, x[1]]).unwrap();
        assert!(lower(&bent, 0).is_err() && lower(&bent, 1).is_ok());
    }

    /// Two meshes that are images of each other, and one between them with nodes in the places of theirs.
    #[test]
    fn of_several_meshes_each_has_an_image() {
        let block = |x: f64, width: f64, nodes: usize| {
            let mesh = Mesh::rectangle([width, 0.1], [nodes, 2], Cells::Rectangles).unwrap();
            mesh.translated(&[x, 0.0]).unwrap()
        };
        let [left, middle, right] = [block(0.0, 0.1, 2), block(0.1, 0.2, 3), block(0.3, 0.1, 2)];
        let (at, images) = mirrored(&[&left, &middle, &right], 0).unwrap();
        assert!((at - 0.2).abs() < 1e-15);
        assert_eq!(images, [11, 10, 13, 12, 6, 5, 4, 9, 8, 7, 1, 0, 3, 2]);
        let map = NodeMap::half(&[&left, &middle, &right], 0, true).unwrap();
        assert!(map.meshes[0].is_none());
        let counts = [1, 2].map(|k| map.meshes[k].as_ref().unwrap().node_count());
        assert_eq!(counts, [4, 4]);
        let numbers: Vec<i32> = map.numbers.iter().map(|x| x.map_or(-1, |x| x as i32)).collect();
        assert_eq!(numbers, [-1, -1, -1, -1, -1, 0, 1, -1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(map.cells, [None, None, Some(0), Some(1)]);
        assert_eq!(map.cell_images, [3, 2, 1, 0].map(Some));
        assert!(mirrored(&[&left, &middle], 0).is_none());
    }
}

//! Boundary extraction: the faces that belong to one cell only.

use super::{Block, FaceKind, Mesh};
use crate::base::input::{InputError, four_digits};

/// A face of a cell: a node in 1D, an edge in 2D, a face in 3D.
///
/// Its corners come first and run so that the body lies to the left (2D), counter-clockwise as seen from
/// outside (3D); the mid nodes of a quadratic cell follow, as in [`CellKind::faces`](super::CellKind::faces).
pub type Face = Vec<usize>;

impl Mesh {
    /// The faces that belong to one cell only, in the order of the cells.
    ///
    /// A body of lower dimension than space (string, membrane) is all boundary: its faces are its
    /// cells. Faces on a plane of symmetry at which it was cut
    /// ([`Scene::symmetric_half`](crate::Scene::symmetric_half)) are inside of it.
    pub fn boundary_faces(&self) -> Vec<Face> {
        self.boundary_faces_of_cells().into_iter().map(|(_, face)| face).collect()
    }

    /// The same faces, each with the cell that it belongs to.
    pub(crate) fn boundary_faces_of_cells(&self) -> Vec<(usize, Face)> {
        let (mut all, mut first) = (Vec::new(), 0);
        for block in &self.blocks {
            if self.dimension > block.kind.dimension() {
                all.extend((first..).zip(block.cells().map(<[usize]>::to_vec)));
            } else {
                let cell = |face| first + face / block.kind.faces().len();
                let once = self.faces_of_one_cell(block);
                all.extend(once.map(|face| (cell(face), block.face(face).collect())));
            }
            first += block.cells().len();
        }
        all
    }

    /// The faces of cells that belong to one cell only, in any dimension of space: those on the rim of
    /// a membrane, the ends of a string.
    pub(crate) fn outer_faces(&self) -> Vec<Face> {
        self.outer_faces_of_cells().into_iter().map(|(_, face)| face).collect()
    }

    /// The same faces, each with the cell that it belongs to.
    pub(crate) fn outer_faces_of_cells(&self) -> Vec<(usize, Face)> {
        let (mut all, mut first) = (Vec::new(), 0);
        for block in &self.blocks {
            let cell = |face| first + face / block.kind.faces().len();
            let once = self.faces_of_one_cell(block);
            all.extend(once.map(|face| (cell(face), block.face(face).collect())));
            first += block.cells().len();
        }
        all
    }

    /// Checks that cells that fill their space, and whose volumes are above 0, meet at their faces from opposite sides.
    ///
    /// # Errors
    /// Cells that lie on the same side of a face that they have in common, so that they overlap.
    pub(crate) fn check_sides(&self) -> Result<(), InputError> {
        let (mut count, mut first) = (0, None);
        for block in self.blocks.iter().filter(|block| block.kind.dimension() == self.dimension) {
            let per_cell = block.kind.faces().len();
            block.each_shared_face(self.node_count(), |faces| {
                let opposite = match *faces {
                    [a, b] => block.are_opposite(a, b),
                    _ => false,
                };
                if !opposite {
                    count += 1;
                    let cells = faces[..2].iter().map(|face| face / per_cell).collect::<Vec<_>>();
                    let place = (cells, block.face(faces[0]).collect::<Vec<_>>());
                    if first.as_ref().is_none_or(|first| place < *first) {
                        first = Some(place);
                    }
                }
            });
        }
        let Some((cells, face)) = first else { return Ok(()) };
        let nodes: Vec<usize> = face.iter().map(|node| node + 1).collect();
        let help = format!(
            "cells {} and {} are on the same side of the face that they have in common (nodes {nodes:?}, around {} m), so that they \
             overlap, with twice the mass and stiffness there: move the node that is on the wrong side of the face, or leave out the \
             cell that is too many",
            cells[0] + 1,
            cells[1] + 1,
            self.told_middle(&face)
        );
        let input = format!("folded mesh: faces with cells on one side in the {}", self.origin());
        Err(InputError::new(input, count, help))
    }

    /// The mean position of nodes, for messages.
    pub(crate) fn told_middle(&self, nodes: &[usize]) -> String {
        let mean = |axis: usize| {
            let sum: f64 = nodes.iter().map(|&node| self.position(node)[axis]).sum();
            four_digits(sum / nodes.len() as f64)
        };
        format!("({})", (0..self.dimension).map(mean).collect::<Vec<_>>().join(", "))
    }

    /// The shape of a face of the boundary.
    pub(crate) fn face_kind(&self, face: &[usize]) -> FaceKind {
        FaceKind::of(self.dimension, face.len())
    }

    /// Numbers of the faces of a block that belong to one cell only, and are not on a plane of symmetry.
    fn faces_of_one_cell(&self, block: &Block) -> impl Iterator<Item = usize> {
        let mut is_on_plane =
            vec![false; if self.plane.is_empty() { 0 } else { self.node_count() }];
        self.plane.iter().for_each(|&node| is_on_plane[node] = true);
        let mut once = block.faces_of_one_cell(self.node_count());
        if !self.plane.is_empty() {
            once.retain(|&face| !block.face(face).all(|node| is_on_plane[node]));
        }
        once.into_iter()
    }

    pub(super) fn find_boundary_nodes(&self) -> Vec<usize> {
        let mut nodes = self.boundary_faces().concat();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

impl Block {
    /// Numbers of the faces that belong to one cell only, ascending; the mesh has `nodes` nodes.
    fn faces_of_one_cell(&self, nodes: usize) -> Vec<usize> {
        let mut once: Vec<usize> = Vec::new();
        self.each_face(nodes, |faces| once.extend(faces.iter().filter(|_| faces.len() == 1)));
        once.sort_unstable();
        once
    }

    /// Calls `see` with the numbers, ascending, of the faces that have the same nodes, where several do.
    fn each_shared_face(&self, nodes: usize, mut see: impl FnMut(&[usize])) {
        self.each_face(nodes, |faces| {
            if faces.len() > 1 {
                see(faces);
            }
        });
    }

    /// Calls `see` with the numbers, ascending, of all faces that have the same nodes.
    fn each_face(&self, nodes: usize, mut see: impl FnMut(&[usize])) {
        let (offsets, faces) = self.faces_by_smallest_node(nodes);
        for range in offsets.windows(2) {
            each_match(&faces[range[0]..range[1]], |face| self.face(face), &mut see);
        }
    }

    /// Whether the cells of two faces with the same nodes lie on opposite sides: their corners run the other way round then.
    fn are_opposite(&self, a: usize, b: usize) -> bool {
        let count = self.kind.faces().len();
        let dimension = self.kind.dimension();
        if dimension == 1 {
            return a % count != b % count; // the left end of one and the right end of the other
        }
        let corners = FaceKind::of(dimension, self.kind.faces()[0].len()).corners();
        let [a, b] = [a, b].map(|face| self.face(face).take(corners).collect::<Vec<_>>());
        if corners == 2 {
            return a[0] != b[0];
        }
        let Some(start) = b.iter().position(|node| *node == a[0]) else { return false };
        (0..corners).all(|k| a[k] == b[(start + corners - k) % corners])
    }

    /// Nodes of face `face`; all faces of a cell are counted before those of the next.
    fn face(&self, face: usize) -> impl Iterator<Item = usize> {
        let faces = self.kind.faces();
        let cell = &self.connectivity[face / faces.len() * self.kind.nodes()..];
        faces[face % faces.len()].iter().map(|&local| cell[local])
    }

    /// All faces, sorted by their smallest node: those of node k are
    /// `faces[offsets[k]..offsets[k + 1]]`. Faces with the same nodes are neighbours then, and
    /// time and memory grow in proportion to the mesh.
    fn faces_by_smallest_node(&self, nodes: usize) -> (Vec<usize>, Vec<usize>) {
        let count = self.cells().len() * self.kind.faces().len();
        let smallest = |face| self.face(face).fold(usize::MAX, usize::min);
        let mut offsets = vec![0; nodes + 1];
        (0..count).for_each(|face| offsets[smallest(face) + 1] += 1);
        for node in 1..offsets.len() {
            offsets[node] += offsets[node - 1];
        }
        let mut next = offsets.clone();
        let mut faces = vec![0; count];
        for face in 0..count {
            let place = &mut next[smallest(face)];
            faces[*place] = face;
            *place += 1;
        }
        (offsets, faces)
    }
}

/// Calls `see` with each group of `faces` that have the same nodes.
fn each_match<I: Iterator<Item = usize>>(
    faces: &[usize],
    nodes: impl Fn(usize) -> I,
    mut see: impl FnMut(&[usize]),
) {
    // the nodes of each face, ascending: keys one after the other, of any length each
    let (mut all, mut keys) = (Vec::new(), Vec::with_capacity(faces.len()));
    for &face in faces {
        let start = all.len();
        all.extend(nodes(face));
        all[start..].sort_unstable();
        keys.push((start, face));
    }
    let key = |k: usize| &all[keys[k].0..keys.get(k + 1).map_or(all.len(), |next| next.0)];
    let mut order: Vec<usize> = (0..keys.len()).collect();
    order.sort_unstable_by(|&a, &b| key(a).cmp(key(b)).then(a.cmp(&b)));
    let mut same = Vec::new();
    for group in order.chunk_by(|&a, &b| key(a) == key(b)) {
        same.clear();
        same.extend(group.iter().map(|&k| keys[k].1));
        see(&same);
    }
}

#[cfg(test)]
mod tests {
    use crate::elements::mesh::{Cells, Mesh};

    #[test]
    fn a_grid_has_its_rim_as_boundary() {
        let mesh = Mesh::rectangle([1.0, 1.0], [4, 4], Cells::Triangles).unwrap();
        assert_eq!(mesh.boundary_nodes(), [0, 1, 2, 3, 4, 7, 8, 11, 12, 13, 14, 15]);
        // 12 edges, each once, which together go once around: the signed area is that of the square
        let faces = mesh.boundary_faces();
        assert_eq!(faces.len(), 12);
        let twice_area: f64 = faces
            .iter()
            .map(|face| {
                let (p, q) = (mesh.position(face[0]), mesh.position(face[1]));
                p[0] * q[1] - q[0] * p[1]
            })
            .sum();
        assert!((twice_area - 2.0).abs() < 1e-14);
    }

    #[test]
    fn a_bar_ends_at_its_ends() {
        let mesh = Mesh::bar(1.0, 5).unwrap();
        assert_eq!(mesh.boundary_nodes(), [0, 4]);
    }

    /// Faces of eight nodes, as hexahedra with mid nodes have them: two that share six nodes and differ in
    /// the others are two faces, and the same nodes in another order are one.
    #[test]
    fn faces_are_told_apart_by_all_their_nodes() {
        let faces = [
            [0, 1, 2, 3, 4, 5, 6, 7],
            [0, 1, 2, 3, 4, 5, 8, 9],
            [0, 10, 11, 12, 13, 14, 15, 16],
            [16, 15, 14, 13, 12, 11, 10, 0],
        ];
        let mut groups = Vec::new();
        super::each_match(
            &[0, 1, 2, 3],
            |face| faces[face].into_iter(),
            |same| groups.push(same.to_vec()),
        );
        assert_eq!(groups, [vec![0], vec![1], vec![2, 3]]);
    }
}

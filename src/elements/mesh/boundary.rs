//! Boundary extraction: the faces that belong to one cell only.

use std::ops::Range;

use super::{Block, FaceKind, Mesh};

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

    /// The faces of cells that belong to one cell only, whatever the dimension of space: those on the rim of
    /// a membrane, the ends of a string.
    pub(crate) fn outer_faces(&self) -> Vec<Face> {
        let of_block = |block: &Block| -> Vec<Face> {
            self.faces_of_one_cell(block).map(|face| block.face(face).collect()).collect()
        };
        self.blocks.iter().flat_map(of_block).collect()
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
        let (offsets, faces) = self.faces_by_smallest_node(nodes);
        for range in offsets.windows(2) {
            once.extend(without_match(&faces[range[0]..range[1]], |face| self.face(face)));
        }
        once.sort_unstable();
        once
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

/// Those of `faces` that have the same nodes as no other one of them.
fn without_match<I: Iterator<Item = usize>>(
    faces: &[usize],
    nodes: impl Fn(usize) -> I,
) -> Vec<usize> {
    // the nodes of each face, ascending: keys one after the other, of any length each
    let (mut all, mut keys) = (Vec::new(), Vec::with_capacity(faces.len()));
    for &face in faces {
        let start = all.len();
        all.extend(nodes(face));
        all[start..].sort_unstable();
        keys.push((start..all.len(), face));
    }
    let key = |range: &Range<usize>| &all[range.clone()];
    keys.sort_unstable_by(|(a, _), (b, _)| key(a).cmp(key(b)));
    let same = keys.chunk_by(|(a, _), (b, _)| key(a) == key(b));
    same.filter(|faces| faces.len() == 1).map(|faces| faces[0].1).collect()
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
        let alone = super::without_match(&[0, 1, 2, 3], |face| faces[face].into_iter());
        assert_eq!(alone, [0, 1]);
    }
}

//! Boundary extraction: the faces that belong to one cell only.

use super::Mesh;

/// A face of a cell: a node in 1D, an edge in 2D, a face in 3D. Its corners come first and run so
/// that the body lies to the left (2D), counter-clockwise as seen from outside (3D); the mid nodes
/// of a quadratic cell follow, as in [`CellKind::faces`](super::CellKind::faces).
pub type Face = Vec<usize>;

/// Nodes of a face of any kind of cell, ascending, filled up with `usize::MAX`.
type Key = [usize; 6];

impl Mesh {
    /// The faces that belong to one cell only, in the order of the cells.
    ///
    /// A body of lower dimension than space (string, membrane) is all boundary: its faces are its
    /// cells.
    pub fn boundary_faces(&self) -> Vec<Face> {
        self.boundary_faces_of_cells().into_iter().map(|(_, face)| face).collect()
    }

    /// The same faces, each with the cell that it belongs to.
    pub(crate) fn boundary_faces_of_cells(&self) -> Vec<(usize, Face)> {
        if self.dimension > self.kind.dimension() {
            return self.cells().map(<[usize]>::to_vec).enumerate().collect();
        }
        let mut once: Vec<usize> = Vec::new();
        let mut keys: Vec<(Key, usize)> = Vec::new();
        let (offsets, faces) = self.faces_by_smallest_node();
        for range in offsets.windows(2) {
            keys.clear();
            keys.extend(faces[range[0]..range[1]].iter().map(|&face| (self.key(face), face)));
            keys.sort_unstable();
            let same = keys.chunk_by(|(a, _), (b, _)| a == b);
            once.extend(same.filter(|faces| faces.len() == 1).map(|faces| faces[0].1));
        }
        once.sort_unstable();
        let cell = |face| face / self.kind.faces().len();
        once.into_iter().map(|face| (cell(face), self.face(face).collect())).collect()
    }

    pub(super) fn find_boundary_nodes(&self) -> Vec<usize> {
        let mut nodes = self.boundary_faces().concat();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
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
    fn faces_by_smallest_node(&self) -> (Vec<usize>, Vec<usize>) {
        let count = self.cell_count() * self.kind.faces().len();
        let smallest = |face| self.face(face).fold(usize::MAX, usize::min);
        let mut offsets = vec![0; self.node_count() + 1];
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

    fn key(&self, face: usize) -> Key {
        let mut key = [usize::MAX; 6];
        key.iter_mut().zip(self.face(face)).for_each(|(place, node)| *place = node);
        key.sort_unstable();
        key
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::{Cells, Mesh};

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
}

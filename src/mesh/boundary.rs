//! Boundary extraction: the faces that belong to one cell only.

use std::collections::BTreeMap;

use super::Mesh;

/// A face of a cell: a node in 1D, an edge in 2D. Its nodes run so that the body lies to the left.
pub type Face = Vec<usize>;

impl Mesh {
    /// The faces that belong to one cell only, in the order of the cells.
    pub fn boundary_faces(&self) -> Vec<Face> {
        let mut times_seen: BTreeMap<Face, usize> = BTreeMap::new();
        for face in self.faces() {
            *times_seen.entry(sorted(&face)).or_default() += 1;
        }
        self.faces().filter(|face| times_seen[&sorted(face)] == 1).collect()
    }

    pub(super) fn find_boundary_nodes(&self) -> Vec<usize> {
        let mut nodes = self.boundary_faces().concat();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    fn faces(&self) -> impl Iterator<Item = Face> {
        self.cells().flat_map(|cell| {
            self.kind
                .faces()
                .iter()
                .map(move |face| face.iter().map(|&local| cell[local]).collect::<Face>())
        })
    }
}

fn sorted(face: &[usize]) -> Face {
    let mut key = face.to_vec();
    key.sort_unstable();
    key
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

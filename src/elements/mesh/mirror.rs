//! Mirror images of nodes, and the half of a mesh on one side of a plane.
//!
//! Cells on both sides of the plane need not be images of each other where all are of one material; no cell
//! lies across it.

use std::collections::BTreeMap;

use super::{Mesh, NodeMap};
use crate::base::grid::Grid;
use crate::base::input::InputError;
use crate::base::vector::{distinct, padded};

/// Equal positions may differ by this fraction of the size of a mesh: round-off when it is made.
const SAME: f64 = 1e-9;

impl Mesh {
    /// Where the middle of the mesh is on an axis (m), and the mirror images of all nodes in the plane there; `None` if not every node
    /// has one.
    pub(crate) fn mirrored(&self, axis: usize) -> Option<(f64, Vec<usize>)> {
        let along = || self.positions.chunks_exact(self.dimension).map(|x| x[axis]);
        let [least, most] =
            [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)];
        let at = 0.5 * (least + most);
        let points: Vec<[f64; 3]> =
            self.positions.chunks_exact(self.dimension).map(padded).collect();
        let (grid, tolerance) = (Grid::new(&points), SAME * self.size());
        let image = |x: &[f64; 3]| -> Option<usize> {
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
        Some((at, points.iter().map(image).collect::<Option<_>>()?))
    }

    /// The map to the half of a symmetric mesh on one side of its middle plane across an axis.
    ///
    /// # Errors
    /// An axis that the mesh does not have; a node without a mirror image.
    pub(crate) fn half(&self, axis: usize, is_upper: bool) -> Result<NodeMap, InputError> {
        let name = ["x", "y", "z"][axis];
        if axis >= self.dimension {
            let help = format!("the body has {} dimension(s)", self.dimension);
            return Err(InputError::new("axis of symmetry", name, help));
        }
        let (at, images) = self.mirrored(axis).ok_or_else(|| {
            let help = "a node has no mirror image: make it so, or leave the scene whole";
            InputError::new(format!("mesh along {name}"), "not symmetric", help)
        })?;
        let (mut numbers, mut kept) = (vec![None; self.node_count()], Vec::new());
        for node in 0..numbers.len() {
            if images[node] == node || (self.position(node)[axis] > at) == is_upper {
                numbers[node] = Some(kept.len());
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
        let cells = self.cells().map(&mut number).collect();
        // point masses, which have no cells, come after all others
        let last = self.cells().flatten().max().copied().unwrap_or_default();
        let positions = kept.iter().take_while(|&&node| node <= last);
        let positions = positions.flat_map(|&node| self.position(node)).copied().collect();
        let mesh = self.with_cells(positions, self.kind(), connectivity);
        let known: BTreeMap<Vec<usize>, usize> =
            (self.cells().map(|cell| distinct(cell.iter().copied())).zip(0..)).collect();
        let image = |cell: &[usize]| known.get(&distinct(cell.iter().map(|&node| images[node])));
        let cell_images = self.cells().map(|cell| image(cell).copied()).collect();
        let (ends, middles) = ([at; 2], Vec::new());
        let map = NodeMap {
            mesh,
            axis,
            ends,
            across: -1.0,
            images,
            cell_images,
            numbers,
            cells,
            middles,
        };
        Ok(map.named(self))
    }

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
    use crate::elements::mesh::{Cells, Mesh};

    #[test]
    fn a_grid_is_its_own_image_and_loses_half() {
        let mesh = Mesh::rectangle([0.4, 0.1], [5, 2], Cells::Triangles).unwrap();
        let mesh = mesh.translated(&[1.0, 0.0]).unwrap();
        let (at, images) = mesh.mirrored(0).unwrap();
        assert!((at - 1.2).abs() < 1e-15);
        assert_eq!(images, [4, 3, 2, 1, 0, 9, 8, 7, 6, 5]);
        let half = mesh.half(0, false).unwrap().mesh;
        assert_eq!((half.node_count(), half.cell_count()), (6, 4));
        // the cut is open: its edge is none of the boundary, and its ends are on others
        assert_eq!(half.boundary_faces().len(), 5);
        assert_eq!(half.plane_of_symmetry(), [2, 5]);
        assert_eq!(half.boundary_nodes().len(), 6);
        assert!(!half.sets().contains_key("right"));
        assert_eq!(half.sets()["bottom"], [0, 1, 2]);
        // one node off its place
        let bent = mesh.mapped(|x| [x[0] + if x[0] > 1.35 { 1e-6 } else { 0.0 }, x[1]]).unwrap();
        assert!(bent.half(0, false).is_err() && bent.half(1, false).is_ok());
    }
}

//! Mirror images of nodes, and the part of a mesh on one side of a plane.
//!
//! Cells on both sides of the plane need not be images of each other where all are of one material; no cell
//! lies across it. Faces between nodes of the plane are no boundary of the half, so that nothing touches the
//! cut.

use super::Mesh;
use crate::base::grid::Grid;
use crate::base::vector::padded;

/// Equal positions may differ by this fraction of the size of a mesh: round-off when it is made.
const SAME: f64 = 1e-9;

/// The images of the nodes of a mesh in a plane normal to an axis.
#[derive(Debug, Clone)]
pub(crate) struct Mirror {
    /// The number of the axis.
    pub(crate) axis: usize,
    /// Where the plane is (m).
    pub(crate) at: f64,
    /// The image of each node; nodes of the plane are their own.
    pub(crate) images: Vec<usize>,
}

impl Mirror {
    /// Whether a node is on the plane.
    pub(crate) fn is_on_plane(&self, node: usize) -> bool {
        self.images[node] == node
    }
}

impl Mesh {
    /// The mirror images of all nodes in the plane normal to an axis through the middle of the mesh; `None` if not every node has
    /// one.
    pub(crate) fn mirror(&self, axis: usize) -> Option<Mirror> {
        let along = || self.positions.chunks_exact(self.dimension).map(|x| x[axis]);
        let [least, most] =
            [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)];
        let at = 0.5 * (least + most);
        let images = images(&self.positions, self.dimension, (axis, at), self.size())?;
        Some(Mirror { axis, at, images })
    }

    /// The image of each cell, by the means of its nodes; `None` if not every cell has one.
    pub(crate) fn mirrored_cells(&self, mirror: &Mirror) -> Option<Vec<usize>> {
        let mut centres = Vec::with_capacity(self.cell_count() * self.dimension);
        for cell in self.cells() {
            for i in 0..self.dimension {
                let sum: f64 = cell.iter().map(|&node| self.position(node)[i]).sum();
                centres.push(sum / cell.len() as f64);
            }
        }
        images(&centres, self.dimension, (mirror.axis, mirror.at), self.size())
    }

    /// Those of its `cells` (from 0), with the nodes that `keeps` has, in their order. Faces between nodes of a plane of symmetry,
    /// which `is_on_plane` has, are none of its boundary. Omitted nodes and cells are removed from sets and groups.
    pub(crate) fn part(
        &self,
        cells: &[usize],
        keeps: impl Fn(usize) -> bool,
        is_on_plane: impl Fn(usize) -> bool,
    ) -> Self {
        let mut numbers = vec![usize::MAX; self.node_count()];
        let kept: Vec<usize> = (0..self.node_count()).filter(|&node| keeps(node)).collect();
        kept.iter().enumerate().for_each(|(number, &node)| numbers[node] = number);
        let positions = kept.iter().flat_map(|&node| self.position(node)).copied().collect();
        let all: Vec<&[usize]> = self.cells().collect();
        let nodes = cells.iter().flat_map(|&cell| all[cell]).map(|&node| numbers[node]);
        let mut part = self.with_cells(positions, self.kind(), nodes.collect());
        let plane = kept.iter().filter(|&&node| is_on_plane(node));
        part.cut_at(plane.map(|&node| numbers[node]).collect());
        for (name, nodes) in &self.sets {
            let nodes: Vec<usize> = nodes
                .iter()
                .map(|&node| numbers[node])
                .filter(|&node| node != usize::MAX)
                .collect();
            if !nodes.is_empty() && !["all", "boundary"].contains(&&name[..]) {
                part.set_nodes(name, nodes);
            }
        }
        for (name, group) in &self.cell_groups {
            let own = cells.iter().enumerate().filter(|(_, cell)| group.contains(cell));
            let own: Vec<usize> = own.map(|(number, _)| number).collect();
            if !own.is_empty() {
                part.set_cells(name, own);
            }
        }
        part
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

/// For each of some `points`, `d` coordinates each, which of them is its image in the plane at a place on an axis. `None` if one has
/// no image, or more than one. `size` is that of all of them.
fn images(points: &[f64], d: usize, (axis, at): (usize, f64), size: f64) -> Option<Vec<usize>> {
    let points: Vec<[f64; 3]> = points.chunks_exact(d).map(padded).collect();
    let grid = Grid::new(&points);
    let image = |x: &[f64; 3]| -> Option<usize> {
        let mut to = *x;
        to[axis] = 2.0 * at - to[axis];
        let corners = [-SAME, SAME].map(|step| to.map(|x| x + step * size));
        let (mut found, mut count) = (None, 0);
        grid.each_within(&corners, |number| {
            found = Some(number);
            count += 1;
        });
        found.filter(|_| count == 1)
    };
    points.iter().map(image).collect()
}

#[cfg(test)]
mod tests {
    use crate::elements::mesh::{Cells, Mesh};

    #[test]
    fn a_grid_is_its_own_image_and_loses_half() {
        let mesh = Mesh::rectangle([0.4, 0.1], [5, 2], Cells::Triangles).unwrap();
        let mesh = mesh.translated(&[1.0, 0.0]).unwrap();
        let mirror = mesh.mirror(0).unwrap();
        assert!((mirror.at - 1.2).abs() < 1e-15);
        assert_eq!(mirror.images, [4, 3, 2, 1, 0, 9, 8, 7, 6, 5]);
        let keeps = |node: usize| mesh.position(node)[0] < 1.2 + 1e-9;
        let cells =
            mesh.cells().enumerate().filter(|(_, cell)| cell.iter().all(|&node| keeps(node)));
        let cells: Vec<usize> = cells.map(|(number, _)| number).collect();
        let half = mesh.part(&cells, keeps, |node| mirror.is_on_plane(node));
        assert_eq!((half.node_count(), half.cell_count()), (6, 4));
        // the cut is open: its edge is none of the boundary, and its ends are on others
        assert_eq!(half.boundary_faces().len(), 5);
        assert_eq!(half.plane_of_symmetry(), [2, 5]);
        assert_eq!(half.boundary_nodes().len(), 6);
        assert!(!half.sets().contains_key("right"));
        assert_eq!(half.sets()["bottom"], [0, 1, 2]);
        // one node off its place
        let bent = mesh.mapped(|x| [x[0] + if x[0] > 1.35 { 1e-6 } else { 0.0 }, x[1]]).unwrap();
        assert!(bent.mirror(0).is_none() && bent.mirror(1).is_some());
    }
}

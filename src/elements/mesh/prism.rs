//! Prisms: meshes that are the same all along an axis, and their sections.
//!
//! Nodes at one place of the plane, to round-off, are a column, and a column is a node of the section. A mesh
//! is a prism where every face of its boundary is at an end or covers two columns alone, and every cell
//! covers the columns of one of its own faces: layers need not be flat, and tetrahedra not layered alike. The
//! middle of a section's quadrilateral of 9 nodes has no column in hexahedra of 20: it starts where their
//! shape functions have it, and is held where all around it is.

use std::collections::BTreeMap;

use super::{CellKind, Mesh, NodeMap};
use crate::base::grid::Grid;
use crate::base::input::InputError;
use crate::base::vector::{axes_across, distinct};

/// Equal positions may differ by this fraction of the size of a mesh: round-off when it is made.
const SAME: f64 = 1e-9;

impl Mesh {
    /// The map to the section of a prism along an axis, whose axes are the other two in their order.
    ///
    /// # Errors
    /// A mesh that is no prism.
    pub(crate) fn section(&self, axis: usize) -> Result<NodeMap, InputError> {
        let refused = |value: String, help: &str| {
            let help = format!("{help}: take a prism, or leave the scene in space");
            Err(InputError::new(format!("mesh along {}", ["x", "y", "z"][axis]), value, help))
        };
        let kind = self.kind();
        let (of_section, corners) = match kind {
            _ if self.dimension != 3 => {
                return refused("no body in space".into(), "a section is of one that fills space");
            }
            CellKind::Hexahedron => (CellKind::Quadrilateral, 4),
            CellKind::Hexahedron20 | CellKind::Hexahedron27 => (CellKind::Quadrilateral9, 4),
            CellKind::Tetrahedron => (CellKind::Triangle, 3),
            CellKind::Tetrahedron10 => (CellKind::Triangle6, 3),
            _ => {
                let help = "sections are known of hexahedra and of tetrahedra without bubbles";
                return refused(format!("of {}", kind.name()), help);
            }
        };
        let (columns, firsts) = self.columns(axis);
        let axes = axes_across(axis);
        let mut positions: Vec<f64> =
            firsts.iter().flat_map(|&node| axes.map(|i| self.position(node)[i])).collect();
        let heights = || self.positions.chunks_exact(3).map(|x| x[axis]);
        let ends =
            [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
        for face in self.boundary_faces() {
            let is_at = |end: &f64| {
                let off = |&node: &usize| (self.position(node)[axis] - end).abs();
                face.iter().all(|node| off(node) <= SAME * self.size())
            };
            let corners = &face[..self.face_kind(&face).corners()];
            let covered = distinct(corners.iter().map(|&node| columns[node]));
            if covered.len() > 2 && !ends.iter().any(is_at) {
                let nodes: Vec<usize> = corners.iter().map(|node| node + 1).collect();
                let help = "this face of it is neither along the axis nor at one of its ends";
                return refused(format!("nodes {nodes:?}"), help);
            }
        }
        let (mut known, mut connectivity) = (BTreeMap::new(), Vec::new());
        let (mut cells, mut cell_images, mut middles) = (Vec::new(), Vec::new(), Vec::new());
        for (number, cell) in self.cells().enumerate() {
            let of_face = |face: &&[usize]| face.iter().map(|&k| columns[cell[k]]).collect();
            // the middle of a hexahedron of 20 nodes has none
            let is_under = |own: &Vec<usize>| {
                distinct(own[..corners].iter().copied()).len() == corners
                    && cell.iter().all(|&node| own.contains(&columns[node]))
            };
            let Some(mut own) = kind.faces().iter().map(of_face).find(is_under) else {
                let help = "it is no cell over one of a section";
                return refused(format!("cell {}", number + 1), help);
            };
            let key = distinct(own[..corners].iter().copied());
            let count = known.len();
            let (place, image) = *known.entry(key).or_insert((count, number));
            cells.push(Some(place));
            cell_images.push(Some(image));
            if place < count {
                continue;
            }
            if own.len() < of_section.nodes() {
                // the shape functions of 8 nodes there: -1/4 of corners and 1/2 of mid-side nodes
                let weight = |k: usize| if k < corners { -0.25 } else { 0.5 };
                let around: Vec<(usize, f64)> =
                    own.iter().enumerate().map(|(k, &node)| (node, weight(k))).collect();
                let middle = positions.len() / 2;
                for i in 0..2 {
                    let parts =
                        around.iter().map(|(node, weight)| weight * positions[2 * node + i]);
                    positions.push(parts.sum());
                }
                middles.push((middle, around));
                own.push(middle);
            }
            let x = |k: usize| &positions[2 * own[k % corners]..][..2];
            let twice = |k: usize| x(k)[0] * x(k + 1)[1] - x(k + 1)[0] * x(k)[1];
            if (0..corners).map(twice).sum::<f64>() < 0.0 {
                own = of_section.turned_over().iter().map(|&k| own[k]).collect();
            }
            connectivity.extend(own);
        }
        let mut mesh = Self::named(2, positions, of_section, connectivity);
        let images = columns.iter().map(|&column| firsts[column]).collect();
        let numbers = columns.into_iter().map(Some).collect();
        let mut map = NodeMap {
            meshes: Vec::new(),
            axis,
            ends,
            is_upper: false,
            across: 0.0,
            images,
            cell_images,
            numbers,
            cells,
            middles,
        };
        mesh.take_names(self, Vec::new(), |nodes| map.within(nodes), &map.cells);
        map.meshes.push(Some(mesh));
        Ok(map)
    }

    /// The column of each node along an axis, numbered as they are met, and the first node of each.
    fn columns(&self, axis: usize) -> (Vec<usize>, Vec<usize>) {
        let flat = |x: &[f64]| {
            let [i, j] = axes_across(axis);
            [x[i], x[j], 0.0]
        };
        let points: Vec<[f64; 3]> = self.positions.chunks_exact(3).map(flat).collect();
        let (grid, tolerance) = (Grid::new(&points), SAME * self.size());
        let (mut columns, mut firsts) = (vec![usize::MAX; points.len()], Vec::new());
        for (node, x) in points.iter().enumerate() {
            if columns[node] == usize::MAX {
                let corners = [-tolerance, tolerance].map(|step| x.map(|x| x + step));
                grid.each_within(&corners, |other| columns[other] = firsts.len());
                firsts.push(node);
            }
        }
        (columns, firsts)
    }
}

#[cfg(test)]
mod tests {
    use crate::elements::mesh::{CellKind, Mesh, SolidCells};

    /// The areas of all cells.
    fn area(mesh: &Mesh, corners: usize) -> f64 {
        let x = |node: usize| mesh.position(node);
        let twice = |cell: &[usize]| -> f64 {
            let next = |k: usize| cell[(k + 1) % corners];
            let cross = |k: usize| x(cell[k])[0] * x(next(k))[1] - x(next(k))[0] * x(cell[k])[1];
            (0..corners).map(cross).sum()
        };
        mesh.cells().map(|cell| 0.5 * twice(cell)).sum()
    }

    /// Sections along all axes, of all cells: positive cells that fill the rectangle, nodes in all places of the grid.
    #[test]
    fn sections_of_blocks_are_grids() {
        let (size, nodes) = ([0.4, 0.3, 0.2], [3, 4, 5]);
        for (cells, kind, corners) in [
            (SolidCells::Hexahedra, CellKind::Quadrilateral, 4),
            (SolidCells::Hexahedra20, CellKind::Quadrilateral9, 4),
            (SolidCells::Hexahedra27, CellKind::Quadrilateral9, 4),
            (SolidCells::Tetrahedra, CellKind::Triangle, 3),
            (SolidCells::Tetrahedra10, CellKind::Triangle6, 3),
        ] {
            let mesh = Mesh::cuboid(size, nodes, cells).unwrap();
            for axis in 0..3 {
                let map = mesh.section(axis).unwrap();
                let [i, j] = map.axes()[..] else { unreachable!() };
                let section = map.meshes[0].as_ref().unwrap();
                assert_eq!(section.kind(), kind);
                let grid =
                    [i, j].map(|i| if kind.is_quadratic() { 2 * nodes[i] - 1 } else { nodes[i] });
                assert_eq!(section.node_count(), grid[0] * grid[1], "{cells:?} {axis}");
                assert!(
                    (area(section, corners) - size[i] * size[j]).abs() < 1e-15,
                    "{cells:?} {axis}"
                );
                assert!((map.ends[1] - map.ends[0] - size[axis]).abs() < 1e-15);
                let per_cell = if corners == 3 { 2 } else { 1 };
                assert_eq!(section.cell_count(), per_cell * (nodes[i] - 1) * (nodes[j] - 1));
                // sides along the axis are sets of the section, those at its ends are none
                let sides = [["left", "right"], ["front", "back"], ["bottom", "top"]];
                for (other, names) in sides.iter().enumerate() {
                    let has = names.iter().all(|name| section.sets().contains_key(*name));
                    assert_eq!(has, other != axis, "{cells:?} {axis}");
                }
                // linear fields stay, at middles that no node in space has, too
                let field: Vec<f64> = mesh.positions().iter().map(|x| 2.0 * x).collect();
                for (own, x) in map.field(&field).iter().zip(section.positions()) {
                    assert!((own - 2.0 * x).abs() < 1e-15);
                }
            }
        }
    }

    #[test]
    fn what_is_no_prism_is_refused() {
        let told = |mesh: &Mesh, axis| mesh.section(axis).unwrap_err().to_string();
        let block = Mesh::cuboid([0.4, 0.3, 0.2], [3; 3], SolidCells::Hexahedra).unwrap();
        let tapered = block.clone().mapped(|x| [x[0], x[1] * (1.0 + x[0]), x[2]]).unwrap();
        assert!(tapered.section(2).is_ok());
        assert!(told(&tapered, 0).contains("mesh along x = "), "{}", told(&tapered, 0));
        let domed = block.mapped(|x| [x[0], x[1], x[2] * (1.0 + x[0])]).unwrap();
        assert!(told(&domed, 2).contains("neither along the axis"), "{}", told(&domed, 2));
        let bubbles = Mesh::cuboid([1.0; 3], [2; 3], SolidCells::Tetrahedra10).unwrap();
        assert!(told(&bubbles.with_bubbles().unwrap(), 2).contains("without bubbles"));
        // one cell of the second layer is missing
        let block = Mesh::cuboid([1.0; 3], [2, 2, 4], SolidCells::Hexahedra).unwrap();
        let kept: Vec<usize> = block
            .cells()
            .enumerate()
            .filter(|(k, _)| *k != 1)
            .flat_map(|(_, cell)| cell.to_vec())
            .collect();
        let holed = Mesh::new(3, block.positions().to_vec(), CellKind::Hexahedron, kept).unwrap();
        assert!(told(&holed, 2).contains("nodes [5, 6, 8, 7]"), "{}", told(&holed, 2));
    }
}

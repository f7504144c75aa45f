//! Prisms: meshes that are the same all along an axis, and their sections.
//!
//! Nodes at one place of the plane, to round-off, are a column, and a column is a node of the section. A mesh
//! is a prism where every face of its boundary is at an end or covers two columns alone, and every cell
//! covers the columns of one of its own faces: layers need not be flat, and tetrahedra not layered alike. The
//! middle of a section's quadrilateral of 9 nodes has no column in hexahedra of 20: it starts where their
//! shape functions have it, and is held where all around it is.

use std::collections::BTreeMap;

use super::{CellKind, Mesh};
use crate::base::grid::Grid;
use crate::base::input::InputError;
use crate::base::vector::axes_across;

/// Equal positions may differ by this fraction of the size of a mesh: round-off when it is made.
const SAME: f64 = 1e-9;

/// A mesh in space that fills the prism over a plane one, its section.
#[derive(Debug, Clone)]
pub(crate) struct Prism {
    /// The number of the axis along which it is the same.
    pub(crate) axis: usize,
    /// Where it begins and ends on it (m).
    pub(crate) ends: [f64; 2],
    /// The mesh of the section, whose axes are the other two in their order.
    pub(crate) section: Mesh,
    /// The node of the section (from 0) in whose place each node is.
    pub(crate) columns: Vec<usize>,
    /// The nodes in the place of each node of the section, ascending. Middles of quadrilaterals may have none: then their shape
    /// functions are more than those of the cells in space.
    pub(crate) nodes: Vec<Vec<usize>>,
    /// The cell of the section (from 0) over which each cell lies.
    pub(crate) cells: Vec<usize>,
    /// The middles of quadrilaterals without a node in space, each with the other nodes of its cell.
    middles: Vec<(usize, Vec<usize>)>,
}

/// The section of a mesh while it is found.
struct Section<'a> {
    mesh: &'a Mesh,
    axis: usize,
    columns: Vec<usize>,
    ends: [f64; 2],
}

impl Mesh {
    /// The mesh as a prism along an axis.
    ///
    /// # Errors
    /// Why it is none.
    pub(crate) fn prism(&self, axis: usize) -> Result<Prism, InputError> {
        let refused = |value: String, help: &str| {
            Err(InputError::new(along(axis), value, format!("{help}: {WHOLE}")))
        };
        let kind = self.kind();
        let (of_section, corners) = match kind {
            _ if self.dimension != 3 || axis > 2 => {
                return refused("no body in space".into(), "a section is of one that fills space");
            }
            CellKind::Hexahedron => (CellKind::Quadrilateral, 4),
            CellKind::Hexahedron20 | CellKind::Hexahedron27 => (CellKind::Quadrilateral9, 4),
            CellKind::Tetrahedron => (CellKind::Triangle, 3),
            CellKind::Tetrahedron10 => (CellKind::Triangle6, 3),
            _ => {
                return refused(
                    format!("of {}", kind.name()),
                    "sections are known of hexahedra and of tetrahedra without bubbles",
                );
            }
        };
        let (columns, mut positions) = columns(self, axis);
        let heights = || self.positions.chunks_exact(3).map(|x| x[axis]);
        let ends =
            [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
        let section = Section { mesh: self, axis, columns, ends };
        section.check_boundary()?;
        let (mut numbers, mut connectivity, mut cells) = (BTreeMap::new(), Vec::new(), Vec::new());
        let mut middles = Vec::new();
        let mut is_used = vec![false; positions.len() / 2];
        for (number, cell) in (1..).zip(self.cells()) {
            let Some(mut own) = section.cell(kind, cell, corners) else {
                return refused(format!("cell {number}"), "it is no cell over one of a section");
            };
            own.iter().for_each(|&column| is_used[column] = true);
            let mut key = own[..corners].to_vec();
            key.sort_unstable();
            let count = numbers.len();
            let place = *numbers.entry(key).or_insert(count);
            cells.push(place);
            if place < count {
                continue;
            }
            if own.len() < of_section.nodes() {
                let middle = positions.len() / 2;
                positions.extend(serendipity_middle(&own, &positions));
                middles.push((middle, own.clone()));
                own.push(middle);
            }
            if turns_right(&own[..corners], &positions) {
                own = of_section.turned_over().iter().map(|&k| own[k]).collect();
            }
            connectivity.extend(own);
        }
        if let Some(column) = is_used.iter().position(|used| !used) {
            let node =
                section.columns.iter().position(|other| *other == column).unwrap_or_default();
            return refused(
                format!("node {}", node + 1),
                "it is in the place of no node of a section",
            );
        }
        let mut nodes = vec![Vec::new(); positions.len() / 2];
        section.columns.iter().enumerate().for_each(|(node, &column)| nodes[column].push(node));
        let columns = section.columns;
        let section = Self::named(2, positions, of_section, connectivity);
        let mut prism = Prism { axis, ends, section, columns, nodes, cells, middles };
        prism.name_sets(self);
        Ok(prism)
    }
}

impl Prism {
    /// The extent along the axis (m).
    pub(crate) fn height(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }

    /// The numbers of the axes of the section among those of space.
    pub(crate) fn axes(&self) -> [usize; 2] {
        axes_across(self.axis)
    }

    /// The nodes of the section in whose places some nodes are, in that order, if they are all that are there: `None` if there are
    /// others.
    pub(crate) fn whole_columns(&self, nodes: &[usize]) -> Option<Vec<usize>> {
        let whole = self.columns_within(nodes);
        let count: usize = whole.iter().map(|&column| self.nodes[column].len()).sum();
        (count == nodes.len()).then_some(whole)
    }

    /// The nodes of the section that have all nodes in their places among these, in that order.
    fn columns_within(&self, nodes: &[usize]) -> Vec<usize> {
        let mut left: Vec<usize> = self.nodes.iter().map(Vec::len).collect();
        let mut columns = Vec::new();
        for &node in nodes {
            let column = self.columns[node];
            if left[column] == self.nodes[column].len() {
                columns.push(column);
            }
            left[column] -= 1;
        }
        columns.retain(|&column| left[column] == 0);
        let mut is_there = vec![false; self.nodes.len()];
        columns.iter().for_each(|&column| is_there[column] = true);
        let within = self.middles.iter().filter(|(_, around)| around.iter().all(|&k| is_there[k]));
        columns.extend(within.map(|(middle, _)| middle));
        columns
    }

    /// A vector field of the nodes in space at the nodes of the section, in its axes.
    pub(crate) fn field(&self, x: &[f64]) -> Vec<f64> {
        let mut own: Vec<f64> = Vec::with_capacity(2 * self.nodes.len());
        for nodes in &self.nodes {
            let first = nodes.first().map_or([0.0; 2], |node| self.axes().map(|i| x[3 * node + i]));
            own.extend(first);
        }
        for (middle, around) in &self.middles {
            let value = serendipity_middle(around, &own);
            own[2 * middle..][..2].copy_from_slice(&value);
        }
        own
    }

    /// Whether some nodes have all those of a face at one of the ends.
    pub(crate) fn has_end_face(&self, mesh: &Mesh, nodes: &[usize]) -> bool {
        let mut is_there = vec![false; mesh.node_count()];
        nodes.iter().for_each(|&node| is_there[node] = true);
        mesh.boundary_faces().iter().any(|face| {
            let corners = &face[..mesh.face_kind(face).corners()];
            face.iter().all(|&node| is_there[node]) && self.count(corners) > 2
        })
    }

    /// In how many places of the section some nodes are.
    fn count(&self, nodes: &[usize]) -> usize {
        count_columns(&self.columns, nodes)
    }

    /// Names sets and groups of the section by those of the `mesh` that are the same all along the axis, and cuts it where that is cut.
    fn name_sets(&mut self, mesh: &Mesh) {
        let plane = self.columns_within(&mesh.plane);
        if !plane.is_empty() {
            self.section.cut_at(plane);
        }
        for (name, nodes) in &mesh.sets {
            let own = self.columns_within(nodes);
            if !own.is_empty() && !["all", "boundary"].contains(&&name[..]) {
                self.section.set_nodes(name, own);
            }
        }
        for (name, group) in &mesh.cell_groups {
            let own = self.whole_cells(group).0;
            if !own.is_empty() {
                self.section.set_cells(name, own);
            }
        }
    }

    /// The cells of the section of which all cells over them are among these, ascending, and whether these are all.
    pub(crate) fn whole_cells(&self, cells: &[usize]) -> (Vec<usize>, bool) {
        let mut left = vec![0_usize; self.section.cell_count()];
        self.cells.iter().for_each(|&cell| left[cell] += 1);
        let mut is_touched = vec![false; left.len()];
        for &cell in cells {
            left[self.cells[cell]] -= 1;
            is_touched[self.cells[cell]] = true;
        }
        let touched: Vec<usize> = (0..left.len()).filter(|&cell| is_touched[cell]).collect();
        let whole: Vec<usize> = touched.iter().copied().filter(|&cell| left[cell] == 0).collect();
        let is_all = whole.len() == touched.len();
        (whole, is_all)
    }
}

impl Section<'_> {
    /// No face of the boundary is across the axis but those at the ends.
    fn check_boundary(&self) -> Result<(), InputError> {
        let mesh = self.mesh;
        let tolerance = SAME * mesh.size();
        for face in mesh.boundary_faces() {
            let corners = &face[..mesh.face_kind(&face).corners()];
            let is_at = |end: &f64| {
                face.iter().all(|&node| (mesh.position(node)[self.axis] - end).abs() <= tolerance)
            };
            if count_columns(&self.columns, corners) > 2 && !self.ends.iter().any(is_at) {
                let nodes: Vec<usize> = corners.iter().map(|node| node + 1).collect();
                let help = format!(
                    "this face of it is neither along the axis nor at one of its ends: {WHOLE}"
                );
                return Err(InputError::new(along(self.axis), format!("nodes {nodes:?}"), help));
            }
        }
        Ok(())
    }

    /// The nodes of the section's cell with so many corners under a cell: as one of its faces has them. `None` if it has nodes in other
    /// places.
    fn cell(&self, kind: CellKind, cell: &[usize], corners: usize) -> Option<Vec<usize>> {
        let is_over = |face: &&&[usize]| {
            let own: Vec<usize> = face[..corners].iter().map(|&k| cell[k]).collect();
            count_columns(&self.columns, &own) == corners
        };
        let face = kind.faces().iter().find(is_over)?;
        let own: Vec<usize> = face.iter().map(|&k| self.columns[cell[k]]).collect();
        // the middle of a hexahedron of 20 nodes has none
        cell.iter().all(|&node| own.contains(&self.columns[node])).then_some(own)
    }
}

/// The column of each node, numbered as they are met, and the position (m) of each in the section.
fn columns(mesh: &Mesh, axis: usize) -> (Vec<usize>, Vec<f64>) {
    let axes = axes_across(axis);
    let flat = |x: &[f64]| [x[axes[0]], x[axes[1]], 0.0];
    let points: Vec<[f64; 3]> = mesh.positions.chunks_exact(3).map(flat).collect();
    let (grid, tolerance) = (Grid::new(&points), SAME * mesh.size());
    let (mut columns, mut positions) = (vec![usize::MAX; points.len()], Vec::new());
    for (node, x) in points.iter().enumerate() {
        if columns[node] != usize::MAX {
            continue;
        }
        let column = positions.len() / 2;
        let corners = [-tolerance, tolerance].map(|step| x.map(|x| x + step));
        grid.each_within(&corners, |other| columns[other] = column);
        positions.extend(&x[..2]);
    }
    (columns, positions)
}

fn count_columns(columns: &[usize], nodes: &[usize]) -> usize {
    let mut own: Vec<usize> = nodes.iter().map(|&node| columns[node]).collect();
    own.sort_unstable();
    own.dedup();
    own.len()
}

/// Centre of an eight-node serendipity cell: shape functions there are -1/4 for corners and 1/2 for mid-side nodes.
fn serendipity_middle(around: &[usize], x: &[f64]) -> [f64; 2] {
    [0, 1].map(|i| {
        let part = |k: usize| if k < 4 { -0.25 } else { 0.5 };
        around.iter().enumerate().map(|(k, &node)| part(k) * x[2 * node + i]).sum()
    })
}

/// Whether a polygon has its inside on the right.
fn turns_right(corners: &[usize], positions: &[f64]) -> bool {
    let x = |k: usize| &positions[2 * corners[k % corners.len()]..][..2];
    let twice = |k: usize| x(k)[0] * x(k + 1)[1] - x(k + 1)[0] * x(k)[1];
    (0..corners.len()).map(twice).sum::<f64>() < 0.0
}

fn along(axis: usize) -> String {
    format!("mesh along {}", ["x", "y", "z"][axis.min(2)])
}

/// Remedy in error messages.
const WHOLE: &str = "take a prism, or leave the scene in space";

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
                let prism = mesh.prism(axis).unwrap();
                let [i, j] = prism.axes();
                let section = &prism.section;
                assert_eq!(section.kind(), kind);
                let grid =
                    [i, j].map(|i| if kind.is_quadratic() { 2 * nodes[i] - 1 } else { nodes[i] });
                assert_eq!(section.node_count(), grid[0] * grid[1], "{cells:?} {axis}");
                assert!(
                    (area(section, corners) - size[i] * size[j]).abs() < 1e-15,
                    "{cells:?} {axis}"
                );
                assert!((prism.height() - size[axis]).abs() < 1e-15);
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
                for (own, x) in prism.field(&field).iter().zip(section.positions()) {
                    assert!((own - 2.0 * x).abs() < 1e-15);
                }
                assert!(prism.has_end_face(&mesh, &mesh.sets()["all"]));
                assert!(!prism.has_end_face(&mesh, &mesh.sets()[sides[i][0]]));
            }
        }
    }

    #[test]
    fn what_is_no_prism_is_refused() {
        let told = |mesh: &Mesh, axis| mesh.prism(axis).unwrap_err().to_string();
        let block = Mesh::cuboid([0.4, 0.3, 0.2], [3; 3], SolidCells::Hexahedra).unwrap();
        let tapered = block.clone().mapped(|x| [x[0], x[1] * (1.0 + x[0]), x[2]]).unwrap();
        assert!(tapered.prism(2).is_ok());
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

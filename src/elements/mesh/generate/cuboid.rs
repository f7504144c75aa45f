//! Cuboids.

use super::grid::{Grid, MidNodes};
use super::{check_grading, check_nodes, grid_lines};
use crate::base::input::{InputError, positive};
use crate::elements::mesh::{CellKind, Mesh};

/// Division of a three-dimensional grid into cells, row by row along x.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SolidCells {
    /// One eight-node hexahedron per grid cell.
    Hexahedra,
    /// Six four-node tetrahedra per grid cell, all around its diagonal from the least to the
    /// greatest coordinates, so that neighbours fit. In each row first the first one of every grid
    /// cell, then the second ones, and so on.
    Tetrahedra,
    /// Ten-node tetrahedra, divided as [`SolidCells::Tetrahedra`]. Corner nodes are numbered as
    /// there; the nodes in the middle of edges come after all of them, in the order of the grid
    /// with half the spacing.
    Tetrahedra10,
    /// One twenty-node hexahedron per grid cell. Corner nodes are numbered as in [`SolidCells::Hexahedra`];
    /// the nodes in the middle of edges come after all of them, in the order of the grid with half the
    /// spacing.
    Hexahedra20,
    /// One twenty-seven-node hexahedron per grid cell. Corner nodes are numbered as in [`SolidCells::Hexahedra`]; the
    /// others come after all of them, in the order of the grid with half the spacing.
    Hexahedra27,
}

impl SolidCells {
    /// All ways to divide a grid.
    pub const ALL: [Self; 5] = [
        Self::Tetrahedra,
        Self::Hexahedra,
        Self::Tetrahedra10,
        Self::Hexahedra20,
        Self::Hexahedra27,
    ];

    /// Name: `tetrahedra`, `hexahedra`, `tetrahedra10`, `hexahedra20`, `hexahedra27`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tetrahedra => "tetrahedra",
            Self::Hexahedra => "hexahedra",
            Self::Tetrahedra10 => "tetrahedra10",
            Self::Hexahedra20 => "hexahedra20",
            Self::Hexahedra27 => "hexahedra27",
        }
    }
}

/// One tetrahedron per order of the axes: it steps from corner to corner along them.
const TETRAHEDRA: [[[usize; 3]; 4]; 6] = {
    let [o, x, y, z] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let [xy, xz, yz, xyz] = [[1, 1, 0], [1, 0, 1], [0, 1, 1], [1, 1, 1]];
    [
        [o, x, xy, xyz],
        [o, xz, x, xyz],
        [o, xy, y, xyz],
        [o, y, yz, xyz],
        [o, z, xz, xyz],
        [o, yz, z, xyz],
    ]
};

/// The corners of a grid cell in the order of [`CellKind::Hexahedron`].
const HEXAHEDRON: [[[usize; 3]; 8]; 1] =
    [[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]];

impl Mesh {
    /// A cuboid of `size` = [along x, along y, along z] (m) with its least corner at the origin.
    ///
    /// It has `nodes` corner nodes along the axes, numbered along x first, then y, then z, and the sets
    /// `left`, `right` (its ends along x), `front`, `back` (along y) and `bottom`, `top` (along z), with the
    /// mid nodes on them.
    ///
    /// # Errors
    /// A side that is not above 0, fewer than 2 nodes along a side.
    pub fn cuboid(
        size: [f64; 3],
        nodes: [usize; 3],
        cells: SolidCells,
    ) -> Result<Self, InputError> {
        Self::graded_cuboid(size, nodes, [1.0; 3], cells)
    }

    /// A [cuboid](Self::cuboid) with cells that get longer or shorter along its axes.
    ///
    /// Along each, the last one is `grading` times as long as the first, and each by the same factor as the
    /// one before it. Mid nodes are in the middles of edges.
    ///
    /// # Errors
    /// As [`cuboid`](Self::cuboid); a grading that is not within 1e-4 and 1e4, or is not 1 for one cell
    /// alone.
    pub fn graded_cuboid(
        size: [f64; 3],
        nodes: [usize; 3],
        grading: [f64; 3],
        cells: SolidCells,
    ) -> Result<Self, InputError> {
        for (axis, &length) in size.iter().enumerate() {
            positive(&format!("cuboid.size[{axis}]"), length, "m")?;
        }
        check_nodes("cuboid", nodes)?;
        check_grading("cuboid", nodes, grading)?;
        let mid_nodes = match cells {
            SolidCells::Hexahedra | SolidCells::Tetrahedra => MidNodes::None,
            SolidCells::Hexahedra20 => MidNodes::OnEdges,
            SolidCells::Tetrahedra10 | SolidCells::Hexahedra27 => MidNodes::Everywhere,
        };
        let grid = Grid::new(nodes.map(|count| count - 1), false, mid_nodes);
        let (kind, connectivity) = match cells {
            SolidCells::Hexahedra => {
                (CellKind::Hexahedron, grid.divide(CellKind::Hexahedron, |_| &HEXAHEDRON))
            }
            SolidCells::Hexahedra20 => {
                (CellKind::Hexahedron20, grid.divide(CellKind::Hexahedron20, |_| &HEXAHEDRON))
            }
            SolidCells::Hexahedra27 => {
                (CellKind::Hexahedron27, grid.divide(CellKind::Hexahedron27, |_| &HEXAHEDRON))
            }
            SolidCells::Tetrahedra => {
                (CellKind::Tetrahedron, grid.divide(CellKind::Tetrahedron, |_| &TETRAHEDRA))
            }
            SolidCells::Tetrahedra10 => {
                (CellKind::Tetrahedron10, grid.divide(CellKind::Tetrahedron10, |_| &TETRAHEDRA))
            }
        };
        let lines = [0, 1, 2].map(|i| grid_lines(nodes[i] - 1, grid.steps, size[i], grading[i]));
        let position = |place: &[usize; 3]| [0, 1, 2].map(|i| lines[i][place[i]]);
        let positions = grid.places.iter().flat_map(position).collect();
        let mut mesh = Mesh::new(3, positions, kind, connectivity)?;
        for (axis, [least, greatest]) in
            [["left", "right"], ["front", "back"], ["bottom", "top"]].into_iter().enumerate()
        {
            mesh = grid.name_side(mesh, least, axis, false)?;
            mesh = grid.name_side(mesh, greatest, axis, true)?;
        }
        Ok(mesh)
    }
}

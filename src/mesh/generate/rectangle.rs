//! Rectangles.

use super::grid::{Cells, Diagonal, Grid};
use super::{check_nodes, grid_line};
use crate::input::{InputError, positive};
use crate::mesh::Mesh;

impl Mesh {
    /// A rectangle of `size` = [width, height] (m) with its lower left corner at the origin and
    /// `nodes` = [along x, along y] corner nodes, numbered row by row from the lower left; sets
    /// `bottom`, `top` (from left to right), `left`, `right` (upward), with the mid nodes on them.
    ///
    /// # Errors
    /// A side that is not above 0, fewer than 2 nodes along a side.
    pub fn rectangle(size: [f64; 2], nodes: [usize; 2], cells: Cells) -> Result<Self, InputError> {
        positive("rectangle.size[0]", size[0], "m")?;
        positive("rectangle.size[1]", size[1], "m")?;
        check_nodes("rectangle", nodes)?;
        let grid = Grid::new(nodes.map(|count| count - 1), false, cells == Cells::Triangles6);
        let position = |place: [usize; 2]| {
            [0, 1].map(|i| grid_line(place[i], grid.steps * (nodes[i] - 1), size[i]))
        };
        let mut mesh = grid.mesh(cells, Diagonal::Falling, position)?;
        for (name, axis, greatest) in
            [("bottom", 1, false), ("top", 1, true), ("left", 0, false), ("right", 0, true)]
        {
            mesh = grid.name_side(mesh, name, axis, greatest)?;
        }
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slides_numbering() {
        let mesh = Mesh::rectangle([3.0, 3.0], [4, 4], Cells::Triangles).unwrap();
        let cells: Vec<&[usize]> = mesh.cells().collect();
        // slides, "Example (static simulation)": triangles 1 2 5; 2 3 6; 3 4 7; 6 5 2; ...; 16 15 12
        assert_eq!(cells[0], [0, 1, 4]);
        assert_eq!(cells[1], [1, 2, 5]);
        assert_eq!(cells[3], [5, 4, 1]);
        assert_eq!(cells[16], [14, 13, 10]);
        assert_eq!(cells[17], [15, 14, 11]);
        assert_eq!(mesh.position(6), [2.0, 1.0]);
        assert_eq!(mesh.sets()["top"], [12, 13, 14, 15]);
        assert_eq!(mesh.sets()["right"], [3, 7, 11, 15]);
    }
}

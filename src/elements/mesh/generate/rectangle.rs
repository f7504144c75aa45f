//! Rectangles.

use super::grid::{Cells, Diagonal, Grid};
use super::{check_grading, check_nodes, grid_lines};
use crate::base::input::{InputError, positive};
use crate::elements::mesh::Mesh;

impl Mesh {
    /// A rectangle of `size` = [width, height] (m) with its lower left corner at the origin.
    ///
    /// It has `nodes` = [along x, along y] corner nodes, numbered row by row from the lower left, and the
    /// sets `bottom`, `top` (from left to right), `left`, `right` (upward), with the mid nodes on them.
    ///
    /// # Errors
    /// A side that is not above 0, fewer than 2 nodes along a side.
    pub fn rectangle(size: [f64; 2], nodes: [usize; 2], cells: Cells) -> Result<Self, InputError> {
        Self::graded_rectangle(size, nodes, [1.0; 2], cells)
    }

    /// A [rectangle](Self::rectangle) with cells that get longer or shorter along its axes.
    ///
    /// Along each, the last one is `grading` times as long as the first, and each by the same factor as the
    /// one before it. Mid nodes are in the middles of edges.
    ///
    /// ```
    /// use pliant::{Cells, Mesh};
    ///
    /// // columns of 1 cm, 2 cm and 4 cm
    /// let mesh = Mesh::graded_rectangle([0.07, 0.02], [4, 2], [4.0, 1.0], Cells::Rectangles)?;
    /// assert!((mesh.position(1)[0] - 0.01).abs() < 1e-15);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`rectangle`](Self::rectangle); a grading that is not within 1e-4 and 1e4, or is not 1 for one cell
    /// alone.
    pub fn graded_rectangle(
        size: [f64; 2],
        nodes: [usize; 2],
        grading: [f64; 2],
        cells: Cells,
    ) -> Result<Self, InputError> {
        positive("rectangle.size[0]", size[0], "m")?;
        positive("rectangle.size[1]", size[1], "m")?;
        check_nodes("rectangle", nodes)?;
        check_grading("rectangle", nodes, grading)?;
        let grid = Grid::new(nodes.map(|count| count - 1), false, cells.mid_nodes());
        let lines = [0, 1].map(|i| grid_lines(nodes[i] - 1, grid.steps, size[i], grading[i]));
        let position = |place: [usize; 2]| [0, 1].map(|i| lines[i][place[i]]);
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

//! Mesh generators, with the numbering of the sources.

use super::{CellKind, Mesh, Selection};
use crate::error::{Error, positive};

/// How a rectangle grid is divided into cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Cells {
    /// Two triangles per grid cell, all diagonals from upper left to lower right: lower triangle
    /// (1, 2, 5) and upper triangle (6, 5, 2) in a grid of 4 x 4 nodes.
    Triangles,
}

impl Mesh {
    /// A bar of `length` (m) along x from 0 with `nodes` equidistant nodes; sets `left`, `right`.
    ///
    /// # Errors
    /// A length that is not above 0, fewer than 2 nodes.
    pub fn bar(length: f64, nodes: usize) -> Result<Self, Error> {
        positive("bar.length", length, "m")?;
        at_least_two("bar.nodes", nodes)?;
        let positions = (0..nodes).map(|i| grid_line(i, nodes, length)).collect();
        let connectivity = (0..nodes - 1).flat_map(|i| [i, i + 1]).collect();
        Mesh::new(1, positions, CellKind::Segment, connectivity)?
            .name_nodes("left", [1])?
            .name_nodes("right", [nodes])
    }

    /// A rectangle of `size` = [width, height] (m) with its lower left corner at the origin and
    /// `nodes` = [along x, along y], numbered row by row from the lower left; sets `bottom`,
    /// `top`, `left`, `right`.
    ///
    /// # Errors
    /// A side that is not above 0, fewer than 2 nodes along a side.
    pub fn rectangle(size: [f64; 2], nodes: [usize; 2], cells: Cells) -> Result<Self, Error> {
        let [width, height] = size;
        let [nx, ny] = nodes;
        positive("rectangle.size[0]", width, "m")?;
        positive("rectangle.size[1]", height, "m")?;
        at_least_two("rectangle.nodes[0]", nx)?;
        at_least_two("rectangle.nodes[1]", ny)?;

        let mut positions = Vec::with_capacity(2 * nx * ny);
        for j in 0..ny {
            for i in 0..nx {
                positions.extend([grid_line(i, nx, width), grid_line(j, ny, height)]);
            }
        }
        let Cells::Triangles = cells;
        let mut connectivity = Vec::with_capacity(6 * (nx - 1) * (ny - 1));
        for j in 0..ny - 1 {
            let row = |i: usize| j * nx + i;
            connectivity.extend((0..nx - 1).flat_map(|i| [row(i), row(i + 1), row(i) + nx]));
            connectivity
                .extend((0..nx - 1).flat_map(|i| [row(i + 1) + nx, row(i) + nx, row(i + 1)]));
        }
        let every = |first: usize, step: usize, count: usize| {
            Selection::Numbers((0..count).map(|k| 1 + first + k * step).collect())
        };
        Mesh::new(2, positions, CellKind::Triangle, connectivity)?
            .name_nodes("bottom", every(0, 1, nx))?
            .name_nodes("top", every((ny - 1) * nx, 1, nx))?
            .name_nodes("left", every(0, nx, ny))?
            .name_nodes("right", every(nx - 1, nx, ny))
    }
}

/// Coordinate of grid line `i` of `count` over `length`; exact at both ends.
fn grid_line(i: usize, count: usize, length: f64) -> f64 {
    length * (i as f64 / (count - 1) as f64)
}

fn at_least_two(input: &str, nodes: usize) -> Result<(), Error> {
    if nodes < 2 {
        return Err(Error::input(input, nodes, "at least 2 nodes are needed along each side"));
    }
    Ok(())
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

    #[test]
    fn zero_size_and_too_few_nodes_are_named() {
        let message = |mesh: Result<Mesh, Error>| mesh.unwrap_err().to_string();
        let flat = Mesh::rectangle([0.3, 0.0], [4, 4], Cells::Triangles);
        assert!(message(flat).starts_with("rectangle.size[1] = 0 "));
        let thin = Mesh::rectangle([0.3, 0.3], [4, 1], Cells::Triangles);
        assert!(message(thin).starts_with("rectangle.nodes[1] = 1 "));
        assert!(message(Mesh::bar(f64::NAN, 3)).starts_with("bar.length = NaN"));
    }
}

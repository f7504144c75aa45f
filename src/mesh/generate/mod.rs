//! Mesh generators, with the numbering of Hirai.

mod bar;
mod cuboid;
mod grid;
mod rectangle;
mod ring;

pub use cuboid::SolidCells;
pub use grid::Cells;

use crate::input::{InputError, check_memory};

/// Memory (bytes) that a body takes at least for each node, in the plane and with linear cells: its matrices alone.
pub(crate) const BYTES_PER_NODE: f64 = 4e3;

/// Checks the numbers of nodes along the axes of a grid.
fn check_nodes<const D: usize>(generator: &str, nodes: [usize; D]) -> Result<(), InputError> {
    for (axis, &count) in nodes.iter().enumerate() {
        if count < 2 {
            let input = match D {
                1 => format!("{generator}.nodes"),
                _ => format!("{generator}.nodes[{axis}]"),
            };
            let mend = "at least 2 nodes are needed along each side";
            return Err(InputError::new(input, count, mend));
        }
    }
    let total: f64 = nodes.iter().map(|&count| count as f64).product();
    let (input, bytes) = (format!("{generator}.nodes"), BYTES_PER_NODE * total);
    check_memory(&input, format!("{nodes:?}"), bytes, "choose fewer nodes")
}

/// Coordinate of line `i` of `count` equal steps over `length`; exact at both ends.
fn grid_line(i: usize, count: usize, length: f64) -> f64 {
    length * (i as f64 / count as f64)
}

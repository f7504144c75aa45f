//! Mesh generators, with the numbering of Hirai.

mod bar;
mod cuboid;
mod grid;
mod rectangle;
mod ring;

pub use cuboid::SolidCells;
pub use grid::Cells;

use crate::input::InputError;

/// Most nodes that a generator makes: beyond it, matrices fit no memory, and the input is a typing error.
const MOST_NODES: usize = 100_000_000;

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
    let total = nodes.iter().try_fold(1, |total: usize, &count| total.checked_mul(count));
    if total.is_none_or(|total| total > MOST_NODES) {
        let mend = format!("a mesh has at most {MOST_NODES} nodes: choose fewer");
        return Err(InputError::new(format!("{generator}.nodes"), format!("{nodes:?}"), mend));
    }
    Ok(())
}

/// Coordinate of line `i` of `count` equal steps over `length`; exact at both ends.
fn grid_line(i: usize, count: usize, length: f64) -> f64 {
    length * (i as f64 / count as f64)
}

//! Mesh generators, with the numbering of Hirai.

mod bar;
mod cuboid;
mod grid;
mod rectangle;
mod ring;

pub use cuboid::SolidCells;
pub use grid::Cells;

use crate::base::input::{InputError, check_memory, positive};

/// Memory (bytes) that a body takes at least for each node, in the plane and with linear cells: its matrices
/// alone.
pub(crate) const BYTES_PER_NODE: f64 = 4e3;

/// Checks the numbers of nodes along the axes of a grid.
fn check_nodes<const D: usize>(generator: &str, nodes: [usize; D]) -> Result<(), InputError> {
    for (axis, &count) in nodes.iter().enumerate() {
        if count < 2 {
            let input = match D {
                1 => format!("{generator}.nodes"),
                _ => format!("{generator}.nodes[{axis}]"),
            };
            let help = "at least 2 nodes are needed along each side";
            return Err(InputError::new(input, count, help));
        }
    }
    let total: f64 = nodes.iter().map(|&count| count as f64).product();
    let (input, bytes) = (format!("{generator}.nodes"), BYTES_PER_NODE * total);
    check_memory(&input, format!("{nodes:?}"), bytes, "choose fewer nodes")
}

/// The greatest ratio of the lengths of the last and the first cell of a side, or the other way round.
const STEEPEST: f64 = 1e4;

/// Checks how cells change in size along the axes of a grid: the ratios of the last cell to the first one.
fn check_grading<const D: usize>(
    generator: &str,
    nodes: [usize; D],
    grading: [f64; D],
) -> Result<(), InputError> {
    for (axis, (&ratio, count)) in grading.iter().zip(nodes).enumerate() {
        let input = format!("{generator}.grading[{axis}]");
        positive(&input, ratio, "")?;
        let help = match count {
            2 if ratio != 1.0 => {
                "one cell alone has no grading: give more nodes along this side, or 1".into()
            }
            _ if ratio.max(1.0 / ratio) > STEEPEST => {
                format!("the last cell by the first one must be within 1/{STEEPEST} and {STEEPEST}")
            }
            _ => continue,
        };
        return Err(InputError::new(input, ratio, help));
    }
    Ok(())
}

/// Coordinate of line `i` of `count` equal steps over `length`; exact at both ends.
fn grid_line(i: usize, count: usize, length: f64) -> f64 {
    length * (i as f64 / count as f64)
}

/// Coordinates of the lines across a side of `length` with `cells` cells in `steps` equal steps each, the
/// last cell `grading` times as long as the first: each by the same factor as the one before it.
fn grid_lines(cells: usize, steps: usize, length: f64, grading: f64) -> Vec<f64> {
    if grading == 1.0 {
        return (0..=steps * cells).map(|i| grid_line(i, steps * cells, length)).collect();
    }
    // the sum of the first k terms of the geometric series, as part of all of them
    let growth = grading.ln() / (cells - 1) as f64;
    let end = |k: usize| length * ((growth * k as f64).exp_m1() / (growth * cells as f64).exp_m1());
    let line = |i: usize| {
        let (cell, part) = (i / steps, (i % steps) as f64 / steps as f64);
        if part == 0.0 { end(cell) } else { (1.0 - part) * end(cell) + part * end(cell + 1) }
    };
    (0..=steps * cells).map(line).collect()
}

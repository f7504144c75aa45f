//! The sample of cells that represents all: non-negative weights, with which they do the work of all cells along the shapes
//! in the states of the training runs.
//!
//! The work of each cell along the shapes in 60 states gives the rows of non-negative least squares
//! (`base/nnls.rs`), scaled so that forces along a shape count as much as that shape moves. The work of
//! single cells is that of samples of cells that share no node. If the error does not fall with more shapes,
//! the worst run is repeated with the same shapes and all cells; if that halves the error, the cells are too
//! few, and the tolerance of the least squares falls by ten before shapes are added.

use std::collections::BTreeMap;

use faer::Mat;

use super::learn::{LearnedPhase, spread};
use crate::base::nnls::nonnegative;
use crate::base::vector::norm;
use crate::dynamics::error::Error;
use crate::elements::body::ByCell;

/// States in which the work is compared, of all phases.
const STATES: usize = 60;

/// Part of the largest amplitude of a shape that the forces along all others count with at least.
const LEAST: f64 = 0.01;

/// Cells with weights that do the work of all to `tolerance`, where each phase has so many of its shapes, and what is sampled in it is
/// given `by_cell`.
///
/// The forces along a shape are weighted by its motion, not by its stiffness.
pub(super) fn weights(
    by_cell: &[Option<&ByCell>],
    phases: &[LearnedPhase],
    counts: &[usize],
    tolerance: f64,
) -> Result<BTreeMap<usize, f64>, Error> {
    let mut blocks: Vec<Mat<f64>> = Vec::new();
    for ((phase, &count), by_cell) in phases.iter().zip(counts).zip(by_cell) {
        let Some(by_cell) = by_cell else { continue };
        let shapes = phase.all_shapes(count);
        let mut of_phase = Vec::new();
        for state in spread(&phase.states, STATES.div_ceil(phases.len())) {
            let u = phase.projected(state, count);
            let work = by_cell.work(&u, &state.v, &shapes);
            of_phase.push(work.map_err(super::undefined)?);
        }
        // the same scale for all states of a shape
        let most = phase.sizes[..count].iter().copied().fold(0.0, f64::max);
        for row in 0..shapes.len() {
            let sums = of_phase.iter().map(|work| work.row(row).iter().sum::<f64>());
            let force = norm(&sums.collect::<Vec<_>>());
            let amplitude = if row < count { phase.sizes[row] / most } else { 0.0 };
            let scale = if force > 0.0 { amplitude.max(LEAST) / force } else { 0.0 };
            for work in &mut of_phase {
                work.row_mut(row).iter_mut().for_each(|x| *x *= scale);
            }
        }
        blocks.extend(of_phase);
    }
    let rows: usize = blocks.iter().map(Mat::nrows).sum();
    let cells = blocks.first().map_or(0, Mat::ncols);
    let mut all = Mat::zeros(rows, cells);
    let mut first = 0;
    for block in &blocks {
        all.submatrix_mut(first, 0, block.nrows(), cells).copy_from(block);
        first += block.nrows();
    }
    let sums: Vec<f64> = (0..rows).map(|row| all.row(row).iter().sum()).collect();
    let weights = nonnegative(&all, &sums, tolerance);
    Ok(weights.into_iter().enumerate().filter(|(_, weight)| *weight > 0.0).collect())
}

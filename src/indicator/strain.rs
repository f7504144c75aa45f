//! Whether the strain of the body fits its motion.

use crate::body::Strain;
use crate::input::told;
use crate::trajectory::{Sample, Trajectory};

/// Degrees by which a cell may turn under Cauchy strain: they count as a strain of 1.5 %.
const MOST_TURN: f64 = 10.0;

/// Cells that turn further than Cauchy strain allows: it takes a rotation by theta for a compression by
/// 1 - cos theta.
pub(super) fn turning(trajectory: &Trajectory, samples: &[&Sample]) -> Option<String> {
    if trajectory.body().strain() != Strain::Cauchy {
        return None;
    }
    let turns = samples.iter().flat_map(|sample| trajectory.body().cell_rotations(&sample.u));
    let most = turns.fold(0.0, f64::max);
    let false_strain = |angle: f64| 100.0 * (1.0 - angle.cos());
    (most.to_degrees() > MOST_TURN).then(|| {
        format!(
            "cells turn by up to {:.1} degrees, which Cauchy strain takes for a strain of {:.1} % (limit: \
             {MOST_TURN} degrees, {:.1} %): use strain = \"green\"",
            most.to_degrees(),
            false_strain(most),
            false_strain(MOST_TURN.to_radians())
        )
    })
}

/// Cells that are turned inside out, which linear forces do not resist.
pub(super) fn inversion(trajectory: &Trajectory, samples: &[&Sample]) -> Option<String> {
    let body = trajectory.body();
    if body.strain() != Strain::Cauchy {
        return None;
    }
    let mut inverted = samples.iter().filter_map(|sample| {
        Some((body.inverted_cells(&sample.u), sample.time)).filter(|(cells, _)| !cells.is_empty())
    });
    let (cells, time) = inverted.next()?;
    let nodes = body.mesh().cells().nth(cells[0])?.iter().map(|node| node + 1);
    Some(format!(
        "{} cell(s) are turned inside out at t = {} s, the first of them cell {} (nodes {:?}) (limit: none): Cauchy \
         strain resists no such thing; use strain = \"green\", push less, or take finer cells there",
        cells.len(),
        told(time),
        cells[0] + 1,
        nodes.collect::<Vec<_>>()
    ))
}

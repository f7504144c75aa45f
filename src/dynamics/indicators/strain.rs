//! Suitability of the strain measure of the body for its motion.

use crate::base::input::four_digits;
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::Sample;
use crate::elements::body::{Body, Strain};

/// Degrees by which a cell may turn under Cauchy strain: they count as a strain of 1.5 %.
const MOST_TURN: f64 = 10.0;

/// Cells that turn further than Cauchy strain allows: it takes a rotation by theta for a compression by
/// 1 - cos theta.
pub(super) fn turning(body: &Body, samples: &[&Sample]) -> Option<Indicator> {
    if body.strain() != Strain::Cauchy {
        return None;
    }
    let most = largest_turn(body, samples.iter().map(|sample| &sample.u[..]));
    let false_strain = |angle: f64| 100.0 * (1.0 - angle.cos());
    let told = format!(
        "cells turn by up to {:.1} degrees, which Cauchy strain takes for a strain of {:.1} % (limit: \
         {MOST_TURN} degrees, {:.1} %)",
        most.to_degrees(),
        false_strain(most),
        false_strain(MOST_TURN.to_radians())
    );
    let beyond = || format!("{told}: use strain = \"green\"");
    let value = (most.to_degrees(), "degrees");
    Some(Indicator::trusted("turn", value, [0.0, MOST_TURN], || told.clone(), beyond))
}

/// The largest angle (rad) by which a cell turns under any of the `displacements` (m).
pub(super) fn largest_turn<'a>(body: &Body, displacements: impl Iterator<Item = &'a [f64]>) -> f64 {
    displacements.flat_map(|u| body.cell_rotations(u)).fold(0.0, f64::max)
}

/// Inverted cells, which linear forces do not resist.
pub(super) fn inversion(body: &Body, samples: &[&Sample]) -> Option<Indicator> {
    if body.strain() != Strain::Cauchy {
        return None;
    }
    let mut inverted = samples.iter().filter_map(|sample| {
        Some((body.inverted_cells(&sample.u), sample.time)).filter(|(cells, _)| !cells.is_empty())
    });
    let first = inverted.next();
    let count = first.as_ref().map_or(0, |(cells, _)| cells.len());
    let beyond = || {
        let (cells, time) = first.unwrap_or_default();
        let nodes = cells.first().and_then(|&cell| body.mesh().cells().nth(cell));
        let nodes: Vec<usize> = nodes.into_iter().flatten().map(|node| node + 1).collect();
        format!(
            "{} cell(s) are inverted at t = {} s, the first of them cell {} (nodes {nodes:?}) (limit: none): Cauchy \
             strain does not resist inversion; use strain = \"green\", smaller loads, or finer cells there",
            cells.len(),
            four_digits(time),
            cells.first().map_or(0, |cell| cell + 1),
        )
    };
    let within = || "no cell is inverted (limit: none)".to_owned();
    Some(Indicator::trusted("inverted-cells", (count as f64, ""), [0.0, 0.0], within, beyond))
}

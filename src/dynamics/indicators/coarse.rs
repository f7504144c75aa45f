//! Resolution of the strains by the cells.
//!
//! Zienkiewicz and Zhu's estimate compares strains with their means at the nodes; the fraction p of the
//! strain energy in the difference makes the body 1/(1 - p) times too stiff (0.8 to 1 of the true factor on
//! cantilevers, less where cells lock: `docs/notes/elements.md`).

use super::bending::stiffness;
use super::mesh::quadratic_cells;
use super::waves;
use crate::base::input::four_digits;
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::Sample;
use crate::elements::body::Body;
use crate::elements::mesh::CellKind;

/// Largest factors by which its cells may make a body too stiff: of triangles and tetrahedra, of which the estimate is a lower bound, and of
/// quadrilaterals and hexahedra, of which it is near to the truth.
const MOST_STIFF: [f64; 2] = [1.25, 1.1];
/// Samples count if they have at least this part of the largest strain energy of all samples, ...
const LARGE: f64 = 0.5;
/// ... and this part of the largest energy of any kind, and this mean strain: smaller strains may be
/// integration error and round-off.
const SEEN: f64 = 1e-3;
const LEAST_STRAIN: f64 = 1e-8;

/// Too few linear cells where the strain varies, as through the thickness of a beam in bending. The strain
/// energy of the jumps between cells is an effect of the mesh, which makes the body that much too stiff (or more, as jumps do not show
/// all of it: see [`stiffness`]).
/// `energy_scale` (J) is that of the motion.
pub(super) fn coarse(body: &Body, energy_scale: f64, samples: &[&Sample]) -> Option<Indicator> {
    let help = quadratic_cells(body.mesh().kind())?;
    let young = body.materials().map(|material| material.young).fold(0.0, f64::max);
    let round_off = 0.5 * young * body.volume() * LEAST_STRAIN.powi(2);
    let energy = |sample: &Sample| sample.energy.strain;
    let largest = samples.iter().map(|sample| energy(sample)).fold(0.0, f64::max);
    if largest <= round_off.max(SEEN * energy_scale) {
        return None;
    }
    let counts = samples.iter().filter(|sample| energy(sample) >= LARGE * largest);
    let jumps = counts.filter_map(|sample| Some((body.strain_jumps(&sample.u)?, sample)));
    let (jumps, sample) = jumps.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    let [of_simplices, of_bricks] = MOST_STIFF;
    let is_brick = matches!(body.mesh().kind(), CellKind::Quadrilateral | CellKind::Hexahedron);
    // bricks are the stiffer only where they bend
    let (stiff, most, place) = match waves::explain(body, sample, jumps) {
        true => (1.0 / (1.0 - jumps.min(0.99)), of_simplices, "along its waves"),
        false if is_brick => (stiffness(body, jumps), of_bricks, "where it bends"),
        false => (stiffness(body, jumps), of_simplices, "where it bends"),
    };
    let within = || {
        format!(
            "cells are fine enough for their strains: the body is some {stiff:.2} times too stiff (limit: {most} times)"
        )
    };
    let beyond = || {
        let finer = ((stiff - 1.0) / (most - 1.0)).sqrt();
        format!(
            "cells are too coarse for their strains: at t = {} s {:.0} % of the strain energy is in jumps between \
             cells, so the body is some {stiff:.2} times too stiff or more (limit: {most} times); take {help}, or a \
             mesh {:.1} times as fine {place}",
            four_digits(sample.time),
            100.0 * jumps,
            finer.max(1.1)
        )
    };
    let value = (stiff, "1");
    Some(Indicator::trusted("stiffness-of-cells", value, [1.0, most], within, beyond))
}

//! Resolution of the waves of a motion by the mesh.
//!
//! A wavelength is 2 pi times the root of the mean square of velocities over that of their changes along
//! edges of cells, and so in cells; a bar in one mode gets the wavelength of that mode.

use std::f64::consts::TAU;

use super::mesh::quadratic_cells;
use super::rigid::without_spin;
use crate::base::input::short;
use crate::base::vector::dot;
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::Sample;
use crate::elements::body::Body;

/// Fewest cells in a wavelength: linear cells are some 5 % too stiff or too slow there, quadratic ones 1 %.
const LINEAR: f64 = 6.0;
const QUADRATIC: f64 = 3.0;
/// Squares of velocities relative to a rigid motion that are below this part of the total are round-off and
/// integration error.
const SEEN: f64 = 1e-4;

/// Factor on the part of the energy that jumps between cells have in a plane wave, up to which jumps are those of waves: waves of
/// several directions, and of several lengths, have more.
const OF_WAVES: f64 = 2.0;
/// Least kinetic energy of a wave over its strain energy: both are the same in one that runs.
const RUNS: f64 = 0.25;

/// Whether waves explain that this part of the strain energy of a `sample` is in `jumps` between cells: (k h)^2/12 in a wave of
/// the wave number k along cells of the length h, and far more where a body bends in few layers.
pub(super) fn explain(body: &Body, sample: &Sample, jumps: f64) -> bool {
    let runs = sample.energy.kinetic > RUNS * sample.energy.strain;
    let cells = cells_in_a_wave(body, &[sample]).filter(|_| runs);
    cells.is_some_and(|cells| jumps < OF_WAVES * (TAU / cells).powi(2) / 12.0)
}

/// Cells in a wavelength of the motion: 2 pi times the root mean square of its velocity over that of the
/// change of velocity along the edges of a cell. For a single wave this is exact; for several it lies between
/// their numbers, nearer to those of the short ones. Where inertia hardly acts (`is_static`), the number is
/// for information only.
pub(super) fn resolution(body: &Body, samples: &[&Sample], is_static: bool) -> Option<Indicator> {
    let (kind, cells) = (body.mesh().kind(), cells_in_a_wave(body, samples)?);
    if is_static {
        let told = format!("a wavelength of the slow motion has some {} cells", short(cells));
        return Some(Indicator::told("cells-in-a-wave", cells, "", told));
    }
    let quadratic = kind.is_quadratic();
    let limit = if quadratic { QUADRATIC } else { LINEAR };
    let said =
        format!("a wavelength of the motion has some {} cells (limit: {limit})", short(cells));
    let beyond = || {
        let finer = short((limit / cells).max(1.1));
        let or = quadratic_cells(kind).map_or(String::new(), |cells| format!(", or {cells}"));
        format!(
            "{said}: they make its waves too fast or too slow; take a mesh {finer} times as fine{or}"
        )
    };
    let limits = [limit, f64::INFINITY];
    Some(Indicator::trusted("cells-in-a-wave", (cells, ""), limits, || said.clone(), beyond))
}

/// See [`resolution`].
fn cells_in_a_wave(body: &Body, samples: &[&Sample]) -> Option<f64> {
    let (mesh, d) = (body.mesh(), body.dimension());
    let (kind, volumes) = (mesh.kind(), body.cell_volumes());
    let [mut all, mut squares, mut changes] = [0.0; 3];
    for sample in samples {
        // a body that is held has no motion as a whole
        let own = match sample.multipliers.is_empty() {
            true => without_spin(body, &sample.u, &sample.v),
            false => sample.v.clone(),
        };
        for (cell, volume) in mesh.cells().zip(&volumes) {
            let square = |v: &[f64], node: usize| {
                let v = &v[node * d..][..d];
                dot(v, v)
            };
            let mean = |v: &[f64]| {
                cell.iter().map(|&node| square(v, node)).sum::<f64>() / cell.len() as f64
            };
            let change = kind.edges().iter().map(|edge| {
                let [a, b] = [cell[edge[0]], cell[edge[1]]].map(|node| &own[node * d..][..d]);
                a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
            });
            all += volume * mean(&sample.v);
            squares += volume * mean(&own);
            changes += volume * change.fold(0.0, f64::max);
        }
    }
    if changes == 0.0 || squares <= SEEN * all {
        return None;
    }
    Some(TAU * (squares / changes).sqrt())
}

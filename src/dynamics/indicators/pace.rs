//! Speed and size of a motion: whether statics suffice, the consequences of its vibrations for the choice of a
//! method, and whether tolerances are fine enough.

use super::rigid::travel;
use crate::base::input::{four_digits, percent, short};
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::{Leap, Sample, Trajectory};
use crate::scene::timeline::{Phase, Scene};

/// Kinetic over stored energy below which a motion is a sequence of equilibria.
const STATIC: f64 = 0.01;
/// Largest error of constraints relative to the distance that nodes travel.
const MOST_DRIFT: f64 = 1e-3;
/// Largest distance of the beginning of a path from its nodes, relative to the distance that nodes travel.
const MOST_LEAP: f64 = 0.01;
/// Times 1/alpha after which a jump w of a prescribed velocity, which leaves w t exp(-alpha t), is below 2e-3 of its largest
/// value.
const DECAY: f64 = 10.0;
/// Largest absolute tolerance of displacements relative to the distance that nodes travel, and the multiple
/// of `rtol` that it may be in any case.
const MOST_TOLERANCE: f64 = 0.01;
const TIMES_ASKED: f64 = 10.0;
/// A body that moves by less than this part of its size is at rest, apart from rounding.
const REST: f64 = 1e-9;
/// Damping ratios below which vibrations last for many periods, and from which on there are none.
const LASTING: f64 = 0.006;
const CREEPING: f64 = 1.0;

/// Whether equilibria suffice.
pub(super) fn inertia(samples: &[&Sample]) -> Option<Indicator> {
    let largest =
        |energy: fn(&Sample) -> f64| samples.iter().map(|s| energy(s)).fold(0.0, f64::max);
    let kinetic = largest(|sample| sample.energy.kinetic);
    let stored = largest(|s| s.energy.strain + s.energy.contact + s.energy.springs);
    if stored == 0.0 || kinetic == 0.0 {
        return None;
    }
    let part = kinetic / stored;
    let said = format!(
        "the largest kinetic energy is {} of the largest stored one (limit: {})",
        percent(part),
        percent(STATIC)
    );
    let enough = || {
        format!(
            "{said}: inertia is negligible; where friction and viscosity are negligible, too, equilibria (`pliant static`) \
             suffice"
        )
    };
    Some(Indicator::needed("kinetic-energy", (part, "1"), STATIC, || said.clone(), enough))
}

/// Frequencies and damping of the vibrations of the longest phase.
pub(super) fn vibrations(scene: &Scene) -> Vec<Indicator> {
    let Ok(spectra) = scene.spectrum() else { return Vec::new() };
    let starts = [0.0].into_iter().chain(scene.phases().iter().map(|phase| phase.end()));
    let phases = scene.phases().iter().zip(starts).zip(spectra);
    let longest = phases.max_by(|((a, from_a), _), ((b, from_b), _)| {
        (a.end() - from_a).total_cmp(&(b.end() - from_b))
    });
    let Some(((phase, _), spectrum)) = longest else { return Vec::new() };
    let Some(period) = spectrum.slowest_period() else { return Vec::new() };
    let (name, damping) = (phase.name(), spectrum.lowest_damping_ratio);
    let then = match damping {
        _ if damping < LASTING => {
            "it lasts for many periods, and needs a method without numerical damping (arkode, rk)"
        }
        _ if damping < CREEPING => {
            "it decays, and a method with slight numerical damping (bdf) suffices"
        }
        _ => "overdamped: no free vibrations, the body creeps",
    };
    let lowest = format!(
        "phase \"{name}\": the lowest vibration has a period of {} s and a damping ratio of {}: {then}",
        four_digits(period),
        short(damping)
    );
    let fastest = spectrum.stiffest_rate();
    let ratio = fastest * period / std::f64::consts::TAU;
    let stiff = format!(
        "phase \"{name}\": the fastest motion of the mesh is {} times as fast as that: explicit methods need steps below {} s",
        short(ratio),
        four_digits(2.0 / fastest)
    );
    vec![
        Indicator::told("damping", damping, "1", lowest),
        Indicator::told("stiffness", ratio, "1", stiff),
    ]
}

/// Drift of constraints: their largest violation, relative to the travel of nodes.
pub(super) fn drift(trajectory: &Trajectory, samples: &[&Sample]) -> Option<Indicator> {
    let (drift, way) = (trajectory.report().constraint_drift, travel(trajectory.body(), samples));
    if samples.iter().all(|sample| sample.multipliers.is_empty()) || way == 0.0 {
        return None;
    }
    let part = drift / way;
    let said = format!(
        "constraints are violated by up to {} m, {} of the travel of nodes (limit: {})",
        short(drift),
        percent(part),
        percent(MOST_DRIFT)
    );
    let beyond = || format!("{said}: raise alpha, or lower rtol");
    Some(Indicator::trusted("drift", (part, "1"), [0.0, MOST_DRIFT], || said.clone(), beyond))
}

/// Drift of constraints after the decay of jumps of prescribed velocities at the starts of phases; in most motions
/// [`drift`] shows these jumps alone.
pub(super) fn lasting_drift(trajectory: &Trajectory, samples: &[&Sample]) -> Option<Indicator> {
    let way = travel(trajectory.body(), samples);
    if samples.iter().all(|sample| sample.multipliers.is_empty()) || way == 0.0 {
        return None;
    }
    let (phases, alpha) = (trajectory.scene().phases(), trajectory.report().alpha);
    let has_settled = |sample: &&Sample| {
        let start = sample.phase.checked_sub(1).and_then(|before| phases.get(before));
        alpha == 0.0 || sample.time >= start.map_or(0.0, Phase::end) + DECAY / alpha
    };
    let settled = trajectory.samples().iter().filter(has_settled);
    let drift = settled.map(|sample| sample.constraint_drift).reduce(f64::max)?;
    // of a body at rest both are round-off
    let part = drift / way.max(REST * trajectory.body().size());
    let said = format!(
        "constraints are still violated by {} m after the starts of phases, {} of the travel of nodes (limit: {})",
        short(drift),
        percent(part),
        percent(MOST_DRIFT)
    );
    let beyond = || {
        let of_rigid = match trajectory.body().rigid_pieces() {
            Some(_) => {
                "; where a constraint on rigid bodies (held, joined or tied) follows from the others and the shape of the bodies, \
                 omit it"
            }
            None => "",
        };
        format!("{said}: raise alpha, or lower rtol{of_rigid}")
    };
    let limits = [0.0, MOST_DRIFT];
    Some(Indicator::trusted("lasting-drift", (part, "1"), limits, || said.clone(), beyond))
}

/// Paths that begin away from their nodes, which are drawn there within some 1/alpha.
pub(super) fn leaps(trajectory: &Trajectory, samples: &[&Sample]) -> Vec<Indicator> {
    let way = travel(trajectory.body(), samples).max(REST * trajectory.body().size());
    let indicator = |leap: &Leap| {
        let part = leap.by() / way;
        let Leap { phase, time, count, row, from, to } = leap;
        let others = match count - 1 {
            0 => String::new(),
            others => format!(" (and {others} more such rows)"),
        };
        let said = format!(
            "the path of {row} in phase \"{phase}\"{others} begins at {} m where the node is at {} m, at t = {} s: a jump of {} m, {} of \
             the travel of nodes (limit: {})",
            short(*to),
            short(*from),
            four_digits(*time),
            short(leap.by()),
            percent(part),
            percent(MOST_LEAP)
        );
        let beyond = || {
            format!(
                "{said}; the displacements of a path count from the undeformed position, not from that at the start of the phase: begin \
                 it with {} m, or use a velocity (`move`), which continues from there",
                short(*from)
            )
        };
        let limits = [0.0, MOST_LEAP];
        Indicator::trusted("path-leap", (part, "1"), limits, || said.clone(), beyond)
    };
    trajectory.leaps.iter().map(indicator).collect()
}

/// Whether the tolerance of displacements is small compared with them.
pub(super) fn tolerance(trajectory: &Trajectory, samples: &[&Sample]) -> Option<Indicator> {
    let (tolerance, body) = (trajectory.report().atol_position, trajectory.body());
    let way = travel(body, samples);
    if way <= REST * body.size() {
        return None;
    }
    let (part, most) =
        (tolerance / way, MOST_TOLERANCE.max(TIMES_ASKED * trajectory.report().rtol));
    let said = format!(
        "displacements have the absolute tolerance {} m, {} of the travel of nodes (limit: {})",
        short(tolerance),
        percent(part),
        percent(most)
    );
    let beyond = || {
        let enough = short(0.1 * most * way);
        format!(
            "{said}, and errors may be as large: set atol_position to {enough} m or below; or, if the body ought to move \
             further than {} of its size, look at the units of young and of what loads it",
            percent(way / body.size())
        )
    };
    let limits = [0.0, most];
    Some(Indicator::trusted("tolerance", (part, "1"), limits, || said.clone(), beyond))
}

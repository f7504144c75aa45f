//! How fast a motion is: whether statics would do, and what its vibrations say for a method.

use super::rigid::travel;
use crate::input::{percent, short, told};
use crate::report::Indicator;
use crate::scene::Scene;
use crate::trajectory::{Sample, Trajectory};

/// Kinetic over stored energy below which a motion is a sequence of equilibria.
const STATIC: f64 = 0.01;
/// Errors of constraints, over the way that nodes go.
const MOST_DRIFT: f64 = 1e-3;
/// Damping ratios below which vibrations go on and on, and from which on there are none.
const LASTING: f64 = 0.006;
const CREEPING: f64 = 1.0;

/// Whether equilibria would do.
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
    let enough = || format!("{said}: inertia hardly acts, equilibria (`pliant static`) would do");
    Some(Indicator::needed("kinetic-energy", (part, "1"), STATIC, || said.clone(), enough))
}

/// How fast and how damped the vibrations of the longest phase are.
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
            "it goes on for many periods, and wants a method that does not damp (arkode, rk)"
        }
        _ if damping < CREEPING => "it dies out, and a method that damps a little (bdf) does",
        _ => "nothing vibrates freely, the body creeps",
    };
    let lowest = format!(
        "phase \"{name}\": the lowest vibration has a period of {} s and a damping ratio of {}: {then}",
        told(period),
        short(damping)
    );
    let fastest = spectrum.stiffest_rate();
    let ratio = fastest * period / std::f64::consts::TAU;
    let stiff = format!(
        "phase \"{name}\": the fastest motion of the mesh is {} times as fast as that: explicit methods need steps below {} s",
        short(ratio),
        told(2.0 / fastest)
    );
    vec![
        Indicator::told("damping", damping, "1", lowest),
        Indicator::told("stiffness", ratio, "1", stiff),
    ]
}

/// How far constraints are from what they should be.
pub(super) fn drift(trajectory: &Trajectory, samples: &[&Sample]) -> Option<Indicator> {
    let (drift, way) = (trajectory.report().constraint_drift, travel(trajectory.body(), samples));
    if samples.iter().all(|sample| sample.multipliers.is_empty()) || way == 0.0 {
        return None;
    }
    let part = drift / way;
    let said = format!(
        "constraints are off by up to {} m, {} of the way that nodes go (limit: {})",
        short(drift),
        percent(part),
        percent(MOST_DRIFT)
    );
    let beyond = || format!("{said}: raise alpha, or lower rtol");
    Some(Indicator::trusted("drift", (part, "1"), [0.0, MOST_DRIFT], || said.clone(), beyond))
}

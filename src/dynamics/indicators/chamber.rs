//! Chambers whose walls have passed through each other.

use crate::base::input::four_digits;
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::Sample;
use crate::scene::forces::TURNED;
use crate::scene::timeline::Scene;

/// The least volume of each chamber that has one in the undeformed shape.
pub(super) fn volumes(scene: &Scene, samples: &[Sample]) -> Vec<Indicator> {
    let mut indicators = Vec::new();
    for chamber in scene.chambers() {
        // in a scene that was run, the walls of each chamber enclose a volume
        let Ok(force) = chamber.force(scene.body(), Vec::new()) else { continue };
        let volumes = samples.iter().map(|sample| (force.volume(&sample.u), sample.time));
        let least = volumes.reduce(|least, volume| if volume.0 < least.0 { volume } else { least });
        let Some((least, time)) = least.filter(|_| force.has_room()) else { continue };
        let found = format!(
            "chamber \"{}\" encloses {} m^3 at least, at t = {} s (limit: 0)",
            chamber.name(),
            four_digits(least),
            four_digits(time)
        );
        indicators.push(Indicator::trusted(
            "chamber-volume",
            (least, "m^3"),
            [0.0, f64::INFINITY],
            || found.clone(),
            || format!("{found}: {TURNED}"),
        ));
    }
    indicators
}

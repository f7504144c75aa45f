//! Gravity, the magnetic field and the remanence of magnets over time.

use serde_json::{Value, json};

use super::geometry::in_view;
use super::pack;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::mesh::Mesh;
use crate::io::output::acting::{self, EVERYWHERE, Remanence};
use crate::scene::timeline::{Phase, Scene};

/// Names of gravity and the magnetic field, as far as the run has them, and their vectors (m/s^2, T), sample by sample.
pub(super) fn everywhere(trajectory: &Trajectory, frames: &[&Sample]) -> Result<Value, Error> {
    let mut tracks = [Vec::new(), Vec::new()];
    for sample in frames {
        let all = at(trajectory.scene(), trajectory.phase_of(sample)?, sample.time);
        tracks.iter_mut().zip(all).for_each(|(track, vector)| track.extend(vector));
    }
    let named = EVERYWHERE.into_iter().zip(tracks);
    let present = named.filter(|(_, track)| track.iter().any(|x| *x != 0.0));
    Ok(present
        .map(|(name, track)| json!({ "name": name, "along": pack::singles(track) }))
        .collect())
}

/// Gravity (m/s^2) and the magnetic field (T), as the page draws them.
pub(super) fn at(scene: &Scene, phase: &Phase, t: f64) -> [Vec<f64>; 2] {
    acting::everywhere(scene, phase, t).map(|vector| in_view(&vector))
}

/// The names of gravity and the magnetic field, as far as phases of a scene have them.
#[cfg(feature = "play")]
pub(super) fn names(scene: &Scene) -> Vec<&'static str> {
    let phases = || scene.phases().iter();
    let has = [
        phases().any(|phase| scene.gravity_in(phase).is_some()),
        phases().any(|phase| phase.uniform_field().is_some()),
    ];
    EVERYWHERE.into_iter().zip(has).filter(|(_, has)| *has).map(|(name, _)| name).collect()
}

/// The arrows on magnets, sample by sample.
pub(super) fn arrows(trajectory: &Trajectory, frames: &[&Sample], remanence: &Remanence) -> Value {
    let mesh = trajectory.body().mesh();
    pack::singles(frames.iter().flat_map(|sample| arrows_at(remanence, mesh, &sample.u)))
}

/// The middle of each arrow on magnets, and the arrow (m), one after the other, as the page draws them, under the displacements `u` (m).
pub(super) fn arrows_at(remanence: &Remanence, mesh: &Mesh, u: &[f64]) -> Vec<f64> {
    remanence.at(mesh, u).iter().flatten().flat_map(|vector| in_view(vector)).collect()
}

//! Where dipoles are, and their moments.

use serde_json::{Value, json};

use super::geometry::in_view;
use super::pack;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::scene::timeline::{Phase, Scene};

/// Of each dipole its positions (m) and moments (A m^2), sample by sample.
pub(super) fn tracks(trajectory: &Trajectory, frames: &[&Sample]) -> Result<Value, Error> {
    let scene = trajectory.scene();
    let mut tracks = vec![[Vec::new(), Vec::new()]; scene.dipoles().len()];
    for sample in frames {
        let all = at(scene, trajectory.phase_of(sample)?, sample.time);
        for (track, vectors) in tracks.iter_mut().zip(all) {
            track.iter_mut().zip(vectors).for_each(|(track, vector)| track.extend(vector));
        }
    }
    let packed = tracks
        .into_iter()
        .map(|[at, along]| json!({ "at": pack::singles(at), "along": pack::singles(along) }));
    Ok(packed.collect())
}

/// The position and the moment of each dipole in `phase` at time `t` (s), as they are drawn.
pub(super) fn at(scene: &Scene, phase: &Phase, t: f64) -> Vec<[Vec<f64>; 2]> {
    drawn(scene.dipoles_at(phase, t))
}

/// Positions and moments as the page draws them.
pub(super) fn drawn(dipoles: Vec<[Vec<f64>; 2]>) -> Vec<[Vec<f64>; 2]> {
    let seen = |vectors: [Vec<f64>; 2]| vectors.map(|vector| in_view(&vector));
    dipoles.into_iter().map(seen).collect()
}

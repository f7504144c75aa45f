//! Where surfaces of liquids meet the walls.

use serde_json::{Value, json};

use super::geometry::in_view;
use super::pack;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::scene::timeline::{Phase, Scene};

/// The ends of all lines (m), one after the other, at each sample.
pub(super) fn tracks(trajectory: &Trajectory, frames: &[&Sample]) -> Result<Value, Error> {
    let scene = trajectory.scene();
    if !scene.liquids().iter().any(|liquid| liquid.has_surface()) {
        return Ok(json!([]));
    }
    let lines = frames.iter().map(|sample| {
        let phase = trajectory.phase_of(sample)?;
        Ok(at(scene, phase, &sample.u, &sample.amounts))
    });
    lines.collect()
}

/// The ends of all lines (m), one after the other, as they are drawn; `states` are the last unknowns of a state.
pub(super) fn at(scene: &Scene, phase: &Phase, u: &[f64], states: &[f64]) -> Value {
    let d = scene.body().dimension();
    let ends = scene.waterlines(phase, u, states).into_iter().flatten();
    pack::singles(ends.flat_map(|end| in_view(&end[..d])))
}

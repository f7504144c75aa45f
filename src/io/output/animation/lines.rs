//! Lines that are drawn beside the bodies: where surfaces of liquids meet the walls, and devices.

use serde_json::{Value, json};

use super::geometry::in_view;
use super::pack;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::scene::timeline::{Phase, Scene};

/// The ends of all lines (m), one after the other, at each sample.
pub(super) fn tracks(trajectory: &Trajectory, frames: &[&Sample]) -> Result<Value, Error> {
    let scene = trajectory.scene();
    let has_surfaces = scene.liquids().iter().any(|liquid| liquid.has_surface());
    if !has_surfaces && scene.devices().is_empty() {
        return Ok(json!([]));
    }
    let lines = frames.iter().map(|sample| {
        let Sample { time, u, v, amounts, .. } = sample;
        Ok(at(scene, trajectory.phase_of(sample)?, *time, [u, v], amounts))
    });
    lines.collect()
}

/// The ends of all lines (m), one after the other, as they are drawn at time `t` (s).
pub(super) fn at(
    scene: &Scene,
    phase: &Phase,
    t: f64,
    [u, v]: [&[f64]; 2],
    amounts: &[f64],
) -> Value {
    let d = scene.body().dimension();
    let lines = scene.waterlines(phase, u, amounts).into_iter();
    let ends = lines.chain(scene.device_lines(phase, t, [u, v])).flatten();
    pack::singles(ends.flat_map(|end| in_view(&end[..d])))
}

//! Drawings beside the bodies: lines where surfaces of liquids meet the walls, lines and needles of devices.

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

/// Places (m) and directions of all needles, one after the other, sample by sample.
pub(super) fn needles(trajectory: &Trajectory, frames: &[&Sample]) -> Result<Value, Error> {
    let mut all = Vec::new();
    for sample in frames {
        let (phase, motion) = (trajectory.phase_of(sample)?, [&sample.u[..], &sample.v]);
        all.extend(needles_at(trajectory.scene(), phase, sample.time, motion));
    }
    Ok(pack::singles(all))
}

/// Places (m) and directions of all needles, one after the other, as they are drawn at time `t` (s).
pub(super) fn needles_at(
    scene: &Scene,
    phase: &Phase,
    t: f64,
    motion: [&[f64]; 2],
) -> impl Iterator<Item = f64> {
    let (d, needles) = (scene.body().dimension(), scene.device_needles(phase, t, motion));
    needles.into_iter().flatten().flat_map(move |x| in_view(&x[..d]))
}

//! Simplified models: their display names, and features that none of them supports.

use std::fmt;

use super::{Phase, Scene};
use crate::base::input::{InputError, four_digits};
use crate::elements::material::Plane;
use crate::scene::constraint::Axis;

/// Differences below this part of the largest value are round-off.
pub(super) const SAME: f64 = 1e-9;
/// Number of times in each phase at which time-dependent quantities are compared.
const TIMES: u32 = 17;

/// How a model is smaller than the scene that it is of.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Smaller {
    /// All bodies are rigid.
    Rigid,
    /// One half of a symmetric scene: see [`Scene::symmetric_half`].
    Half {
        /// The axis that the plane of symmetry is normal to.
        axis: Axis,
        /// Where on that axis the plane is (m).
        at: f64,
    },
    /// The section of a scene that is the same all along an axis: see [`Scene::in_plane`].
    Plane {
        /// The axis.
        axis: Axis,
        /// Assumption along the axis: plane strain or plane stress.
        plane: Plane,
    },
}

impl fmt::Display for Smaller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rigid => f.write_str("all of it rigid"),
            Self::Half { axis, at } => {
                write!(f, "half of it, cut at {} = {} m", axis.word(), four_digits(*at))
            }
            Self::Plane { axis, plane } => {
                write!(f, "in a plane across {} (plane {})", axis.word(), plane.name())
            }
        }
    }
}

/// Times (s) of a phase that begins at `start` (s), at which things are compared.
pub(super) fn times_of(phase: &Phase, start: f64) -> Vec<f64> {
    let part = |k: u32| start + f64::from(k) / f64::from(TIMES - 1) * (phase.until - start);
    (0..TIMES).map(part).collect()
}

/// Refuses what `model`, as in "a half", of is not known; `instead` is what else can be done.
pub(super) fn check_known(scene: &Scene, model: &str, instead: &str) -> Result<(), InputError> {
    let body = &scene.body;
    body.single(model)?;
    let inputs = scene.phases.iter().flat_map(|phase| &phase.inputs);
    let unknown_inputs = inputs.map(|input| usize::from(!input.quantity.is_known_of_parts()));
    let unknown = [
        ("springs", scene.springs.len()),
        ("muscles", scene.muscles.len()),
        ("magnets", scene.magnets.len()),
        ("growths", scene.growths.len()),
        ("fluids", scene.fluids.len()),
        ("chambers", scene.chambers.len()),
        ("touches", scene.touches.len()),
        ("moments, followers and other inputs of phases", unknown_inputs.sum()),
        ("ties", scene.ties.len()),
        ("devices", scene.devices.len()),
        ("forces that are not of this crate", scene.forces.len()),
        ("rigid materials", body.substances().filter(|made_of| made_of.is_rigid).count()),
        ("families of fibres", body.substances().map(|made_of| made_of.fibres.len()).sum()),
    ];
    match unknown.iter().find(|(_, count)| *count > 0) {
        Some((name, count)) => {
            let help = format!("what {model} of them does is not known: {instead}");
            Err(InputError::new(*name, count, help))
        }
        None => Ok(()),
    }
}

//! Smaller models of an accurate motion.
//!
//! A rigid model is a candidate as any other, and the answer where it is accurate, as it has the fewest unknowns;
//! no run is spent on it where the distance of the whole motion from the nearest rigid one
//! (`studies/work_precision/rigid_motion.rs`, Kabsch's rotation of each piece at each time, which no rigid
//! motion can undercut) is above the accuracy. Half and section are compared with the whole by runs with
//! a negligible error of the integration (`smaller_run.rs`), so that the change is the asymmetry of the
//! motion; one that saves time within the accuracy is written with the answer (`Advice::set`). So is the rod in
//! place of a slender solid, whose change is its distance from the reference. The last stage
//! is a reduced model, learned within half of the accuracy. Half, section, rod and reduced model are no
//! candidates: their errors are of the model that was found, on its mesh.

use std::fmt;

use serde_json::{Value, json};

use crate::base::input::{percent, short};
use crate::scene::timeline::Smaller;
use crate::studies::work_precision::time_text;

/// A smaller model of a motion that is right, on the same mesh and with the same settings.
#[derive(Debug, Clone, PartialEq)]
pub struct SmallerModel {
    /// Kind of simplification.
    pub kind: Smaller,
    /// Change of the quantity by the model, relative to the same scale as the accuracy, from runs with small integration errors; of a rod
    /// the distance from the reference, with that of its faster run.
    pub change: f64,
    /// Time (s) of a run by it, and of one of the full model.
    pub seconds: f64,
    /// See `seconds`.
    pub full_seconds: f64,
    /// Unknowns of the integrator, and those of the full model; a rigid body counts with all its nodes, most of which move
    /// with others.
    pub unknowns: usize,
    /// See `unknowns`.
    pub full_unknowns: usize,
}

impl SmallerModel {
    /// A model by the times (s) and unknowns of two runs: one by it, and one of the full model.
    pub(super) fn new(kind: Smaller, change: f64, runs: [(f64, usize); 2]) -> Self {
        let [(seconds, unknowns), (full_seconds, full_unknowns)] = runs;
        Self { kind, change, seconds, full_seconds, unknowns, full_unknowns }
    }

    /// Override in the file of the scene, in addition to those of the full model; none for the rigid model, which
    /// is a candidate as any other.
    pub(super) fn set(&self) -> Option<String> {
        match self.kind {
            Smaller::Rigid => None,
            Smaller::Half { axis, .. } => Some(format!("solver.half={}", axis.word())),
            Smaller::Plane { axis, .. } => Some(format!("solver.plane={}", axis.word())),
            Smaller::Rod { elements } => Some(format!("solver.rod={elements}")),
        }
    }

    /// It as data.
    pub(super) fn to_json(&self) -> Value {
        let Self { change, seconds, full_seconds, unknowns, full_unknowns, .. } = self;
        json!({
            "model": self.kind.to_string(),
            "change": change,
            "seconds": seconds,
            "full_seconds": full_seconds,
            "unknowns": unknowns,
            "full_unknowns": full_unknowns,
        })
    }
}

impl fmt::Display for SmallerModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, change, seconds, full_seconds, unknowns, full_unknowns } = self;
        if change.is_nan() {
            return write!(f, "{kind} leaves nothing to compare");
        }
        write!(f, "{kind}")?;
        if unknowns < full_unknowns {
            write!(f, ", {unknowns} unknowns in place of {full_unknowns},")?;
        }
        f.write_str(" changes it by ")?;
        let (ratio, time) = (full_seconds / seconds, time_text(*seconds));
        match ratio > 1.0 {
            true => write!(f, "{} at {} times the speed ({time})", percent(*change), short(ratio)),
            false => write!(f, "{} and is no faster ({time})", percent(*change)),
        }?;
        match kind {
            Smaller::Rod { .. } => {
                f.write_str("; left out: cross sections that warp or change their shape")
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::constraint::Axis;

    #[test]
    fn smaller_models_are_told() {
        let half = SmallerModel {
            kind: Smaller::Half { axis: Axis::X, at: 0.05 },
            change: 3e-6,
            seconds: 0.5,
            full_seconds: 1.1,
            unknowns: 102,
            full_unknowns: 202,
        };
        let told = half.to_string();
        let parts = ["half of it, cut at x = 0.05 m, 102 unknowns in place of 202", "2.2 times"];
        assert!(parts.iter().all(|part| told.contains(part)), "{told}");
        let slow = SmallerModel { seconds: 2.0, kind: Smaller::Rigid, ..half };
        assert!(slow.to_string().contains("no faster"), "{slow}");
    }
}

//! Contributions to an error.
//!
//! The error of the scene as written and of the answer is split by runs between them and the reference: same
//! model and mesh without error in time; richest model on that mesh; reference, whose own error counts as one
//! of the mesh. Errors of different signs may cancel in one run but not in the next scene: the answer is
//! accepted by the sum of its parts, and that sum is reported.

use crate::base::input::percent;
use std::fmt;

/// Contributions to the error of a run (relative): the distances between runs that differ in one choice each.
/// The largest of them dominates: nothing is gained by making another one smaller. Their sum bounds the error, while the
/// parts themselves may cancel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parts {
    /// Of the model: measure of strain, inertia, alpha, omitted terms.
    pub model: f64,
    /// Of the mesh, with the possible error of the finest mesh. Without another mesh to compare with, the estimate by residuals, or NaN.
    pub mesh: f64,
    /// Of the integration over time.
    pub time: f64,
}

impl Parts {
    /// The sum of those that are known.
    pub fn sum(&self) -> f64 {
        self.model + self.time + if self.mesh.is_nan() { 0.0 } else { self.mesh }
    }
}

impl fmt::Display for Parts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { model, mesh, time } = *self;
        let [model, mesh, time] = [model, mesh, time].map(|part| match part.is_nan() {
            true => "not known".into(),
            false => percent(part),
        });
        write!(f, "model {model}, mesh {mesh}, time {time}")
    }
}

//! What an error is made of.

use crate::base::input::percent;
use std::fmt;

/// What the error of a run is made of (relative): the distances between runs that differ in one thing each.
/// The largest of them dominates: nothing is gained by making another one smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parts {
    /// Of the model: measure of strain, inertia, alpha, what is left out.
    pub model: f64,
    /// Of the mesh.
    pub mesh: f64,
    /// Of the integration over time.
    pub time: f64,
}

impl fmt::Display for Parts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { model, mesh, time } = *self;
        let [model, mesh, time] = [model, mesh, time].map(percent);
        write!(f, "model {model}, mesh {mesh}, time {time}")
    }
}

//! Rows of measurements of a scene: times, or equilibria.

use crate::dynamics::trajectory::Quantity;

/// Measurements: each sensor, with its readings row by row.
pub(super) type Columns = Vec<(Quantity, Vec<f64>)>;

/// The rows of measurements.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Rows {
    /// Times of a motion (s), ascending.
    Times(Vec<f64>),
    /// Equilibria: the values set for each of them, and the abscissa of their plots.
    Equilibria { set: Vec<Vec<String>>, label: String, along: Vec<f64> },
}

impl Rows {
    /// Their abscissa, and its name with its unit.
    pub(super) fn along(&self) -> (&[f64], &str) {
        match self {
            Self::Times(times) => (times, "time (s)"),
            Self::Equilibria { along, label, .. } => (along, label),
        }
    }
}

//! Factors from the lengths or areas of cells to their volumes.

use std::f64::consts::TAU;

/// The factor from the measure of a cell to its volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Section {
    /// The same everywhere: thickness (m), cross section (m^2), 1 of solids.
    Uniform(f64),
    /// A whole turn about the axis.
    Turn,
}

impl Section {
    /// The part that is the same everywhere.
    pub(super) fn uniform(self) -> f64 {
        match self {
            Self::Uniform(section) => section,
            Self::Turn => 1.0,
        }
    }

    /// The part that depends on the first coordinate `x` (m).
    pub(super) fn around(self, x: f64) -> f64 {
        match self {
            Self::Uniform(_) => 1.0,
            Self::Turn => TAU * x,
        }
    }
}

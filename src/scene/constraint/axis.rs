//! Axes of space.

/// An axis of space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub enum Axis {
    /// First coordinate.
    X,
    /// Second coordinate.
    Y,
    /// Third coordinate.
    Z,
}

impl Axis {
    /// Position of the axis among the components of a node: 0, 1 or 2.
    pub fn index(self) -> usize {
        self as usize
    }

    /// Its word: `x`, `y`, `z`.
    pub(crate) fn word(self) -> &'static str {
        ["x", "y", "z"][self.index()]
    }

    /// All axes of a space.
    pub(crate) fn all(dimension: usize) -> &'static [Axis] {
        &[Self::X, Self::Y, Self::Z][..dimension]
    }
}

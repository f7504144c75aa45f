//! Kinds of forces and moments on nodes together.

/// A kind of load on nodes together that depends on where they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub(crate) enum WrenchKind {
    /// A moment (N m) whose direction stays.
    Moment,
    /// A force (N) that turns with the nodes.
    FollowerForce,
    /// A moment (N m) that turns with the nodes.
    FollowerMoment,
}

impl WrenchKind {
    /// Number of components of its value in space of a `dimension`.
    pub(crate) fn rank(self, dimension: usize) -> usize {
        match (self, dimension) {
            (Self::FollowerForce, _) => dimension,
            (_, 2) => 1,
            _ => 3,
        }
    }
}

//! Kinds of joints.

/// Kind of a [`Joint`](crate::Joint).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum JointKind {
    /// Both sides have a point in common.
    Spherical,
    /// They have a point and an axis in common; in the plane a pin.
    Revolute,
    /// The second side moves along an axis of the first, without turning. One of them is the world.
    Prismatic,
    /// They do not move against each other.
    Fixed,
}

impl JointKind {
    /// Whether it has a coordinate, along which a motor may act.
    pub(super) fn moves(self) -> bool {
        matches!(self, Self::Revolute | Self::Prismatic)
    }
}

//! Kinds of joints.

/// Kind of a [`Joint`](crate::Joint).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum JointKind {
    /// Both sides have a point in common.
    Spherical,
    /// They have a point and an axis in common; in the plane a pin.
    Revolute,
    /// The second side moves along an axis of the first, without turning. Where neither is the world, the guide holds it by a
    /// [stiffness](crate::Joint::bearing).
    Prismatic,
    /// The second side moves along an axis fixed in the world and turns about it, a [lead](crate::Joint::lead) for each turn. The thread holds by a
    /// [stiffness](crate::Joint::bearing).
    Screw,
    /// They have a point in common, and an axis of the first stays at a right angle to a [second axis](crate::Joint::second_axis) of the second: a cross, which holds
    /// by a [stiffness](crate::Joint::bearing).
    Universal,
    /// They do not move against each other.
    Fixed,
}

impl JointKind {
    /// Whether it has a coordinate, along which a motor may act.
    pub(super) fn moves(self) -> bool {
        matches!(self, Self::Revolute | Self::Prismatic | Self::Screw)
    }

    /// Whether its coordinate is an angle.
    pub(super) fn turns(self) -> bool {
        matches!(self, Self::Revolute | Self::Screw)
    }
}

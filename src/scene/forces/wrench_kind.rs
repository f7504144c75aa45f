//! Kinds of forces and moments on nodes together, and their values.

use nalgebra::Vector3;

use super::signal::{VectorSignal, finite_at};
use crate::integrators::ode::Failure;

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

    /// Force (N) and moment (N m) that a `value` of it gives at time `t` (s) in space of a `dimension`, before anything turns; a moment in the
    /// plane is about the normal of that.
    ///
    /// # Errors
    /// A value that is not finite.
    pub(super) fn at(
        self,
        value: &VectorSignal,
        dimension: usize,
        t: f64,
    ) -> Result<[Vector3<f64>; 2], Failure> {
        let rank = self.rank(dimension);
        let mut components = [0.0; 3];
        value.at(t, &mut components[..rank]);
        let what = format_args!("a moment or a follower");
        components.iter().try_for_each(|x| finite_at(t, what, *x).map(|_| ()))?;
        let value = match rank {
            1 => Vector3::new(0.0, 0.0, components[0]),
            _ => Vector3::from(components),
        };
        Ok(match self {
            Self::FollowerForce => [value, Vector3::zeros()],
            Self::Moment | Self::FollowerMoment => [Vector3::zeros(), value],
        })
    }

    /// Whether it turns with the nodes.
    pub(super) fn follows(self) -> bool {
        self != Self::Moment
    }
}

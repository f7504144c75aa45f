//! Prescribed rotations: nodes that turn about a point of the plane, or about an axis in space.

use std::sync::Arc;

use super::prescribed::Prescribed;
use super::spline::Spline;
use super::start::PhaseStart;
use crate::base::input::{InputError, finite};
use crate::base::vector::{cross, dot, norm};
use crate::elements::mesh::Mesh;

/// The angular velocity (rad/s) or axis that was given for `input`: one component in the plane,
/// counter-clockwise, three in space.
///
/// # Errors
/// A wrong number of components, numbers that are not finite.
pub(crate) fn angular(
    input: &str,
    given: &[f64],
    dimension: usize,
) -> Result<[f64; 3], InputError> {
    finite(input, given)?;
    match (dimension, given) {
        (2, &[omega]) => Ok([0.0, 0.0, omega]),
        (3, &[x, y, z]) => Ok([x, y, z]),
        _ => {
            let help = match dimension {
                2 => "it needs 1 component, counter-clockwise",
                3 => "it needs 3 components",
                _ => "a body of 1 dimension cannot turn",
            };
            Err(InputError::new(input, format!("{given:?}"), help))
        }
    }
}

/// A rotation as the user of a phase gives it.
#[derive(Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Turn {
    /// A point of the axis (m).
    pub(crate) centre: Vec<f64>,
    /// As [`angular`] takes it: an angular velocity (rad/s) without `angles`, with them an axis of any
    /// length.
    pub(crate) axis: Vec<f64>,
    /// Angle (rad) over time.
    #[cfg_attr(
        feature = "checkpoint",
        serde(
            rename = "path",
            serialize_with = "super::spline::as_pair",
            deserialize_with = "serde::Deserialize::deserialize"
        )
    )]
    pub(crate) angles: Option<Spline>,
}

impl Turn {
    /// Times (s) at which the motion changes its law.
    pub(super) fn breaks(&self) -> &[f64] {
        self.angles.as_ref().map_or(&[], Spline::times)
    }

    /// # Errors
    /// A centre or axis with a wrong number of components for the body, an axis of length 0, numbers that are
    /// not finite, times of a path that do not ascend.
    pub(super) fn validate(&self, dimension: usize) -> Result<(), InputError> {
        if self.centre.len() != dimension {
            let help = format!("it needs {dimension} component(s) (m)");
            let input = "centre of turned nodes";
            return Err(InputError::new(input, format!("{:?}", self.centre), help));
        }
        finite("centre of turned nodes", &self.centre)?;
        let Some(angles) = &self.angles else {
            return angular("angular velocity of turned nodes", &self.axis, dimension).map(|_| ());
        };
        let axis = angular("axis of turned nodes", &self.axis, dimension)?;
        if norm(&axis) == 0.0 {
            let help = "it must have a direction";
            return Err(InputError::new("axis of turned nodes", format!("{:?}", self.axis), help));
        }
        angles.validate("angles of a rotation", "rad")
    }

    /// The angle (rad) since time `since`, with its derivatives, at time `t` (s).
    fn angle(&self, since: f64, t: f64) -> [f64; 3] {
        match &self.angles {
            None => [norm(&self.axis) * (t - since), norm(&self.axis), 0.0],
            Some(angles) => {
                let Prescribed { displacement, velocity, acceleration } = angles.at(t);
                [displacement - angles.at(since).displacement, velocity, acceleration]
            }
        }
    }
}

/// One component of a node that turns.
///
/// With the unit vector a of the axis and the arm r, perpendicular to it, from the axis to the node when the
/// phase begins, its displacement is b = u_0 + r (cos(angle) - 1) + (a x r) sin(angle) (Rodrigues).
#[derive(Clone)]
pub(super) struct Turning {
    pub(super) turn: Arc<Turn>,
    /// u_0 (m)
    start: f64,
    /// Time (s) of the start.
    since: f64,
    /// The components of r and of a x r (m).
    arm: [f64; 2],
}

impl Turning {
    /// The motion of the component `dof` from the state `start`; `turn` has to be valid.
    pub(super) fn new(turn: &Arc<Turn>, dof: usize, mesh: &Mesh, start: &PhaseStart) -> Self {
        let dimension = mesh.dimension();
        let (node, i) = (dof / dimension, dof % dimension);
        let mut axis = angular("axis", &turn.axis, dimension).unwrap_or_default();
        let length = norm(&axis);
        if length > 0.0 {
            axis.iter_mut().for_each(|a| *a /= length);
        }
        let (mut arm, u) = ([0.0; 3], &start.u[node * dimension..]);
        for (k, x) in mesh.position(node).iter().enumerate() {
            arm[k] = x + u[k] - turn.centre[k];
        }
        let along_axis = dot(&axis, &arm) * axis[i];
        let arm = [arm[i] - along_axis, cross(&axis, &arm)[i]];
        Self { turn: turn.clone(), start: u[i], since: start.time, arm }
    }

    pub(super) fn at(&self, t: f64) -> Prescribed {
        let ([angle, rate, change], [along, across]) = (self.turn.angle(self.since, t), self.arm);
        let (sine, cosine) = angle.sin_cos();
        let tangent = across * cosine - along * sine;
        Prescribed {
            displacement: self.start + along * (cosine - 1.0) + across * sine,
            velocity: rate * tangent,
            acceleration: change * tangent - rate * rate * (along * cosine + across * sine),
        }
    }

    pub(super) fn origin(&self) -> [f64; 4] {
        [self.start, self.since, self.arm[0], self.arm[1]]
    }

    pub(super) fn set_origin(&mut self, [start, since, along, across]: [f64; 4]) {
        (self.start, self.since, self.arm) = (start, since, [along, across]);
    }
}

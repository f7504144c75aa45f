//! Circles of which rings are made: where nodes lie that a finer mesh has between those of a ring.

use nalgebra::{Rotation3, Vector3};
use std::f64::consts::{PI, TAU};

use super::Mesh;

/// Circles around a centre, on which the nodes of a mesh lie.
#[derive(Debug, Clone)]
pub(super) struct Round {
    centre: Vector3<f64>,
    /// Unit vectors, normal to each other, of the plane of the circles.
    axes: [Vector3<f64>; 2],
}

impl Round {
    fn translated(&mut self, offset: &[f64]) {
        self.centre += vector(offset);
    }

    fn turned(&mut self, rotation: &Rotation3<f64>) {
        self.centre = rotation * self.centre;
        self.axes = self.axes.map(|axis| rotation * axis);
    }

    /// Radius (m) and angle (rad) of a place.
    fn polar(&self, place: &[f64]) -> [f64; 2] {
        let from_centre = vector(place) - self.centre;
        let [x, y] = self.axes.map(|axis| axis.dot(&from_centre));
        [x.hypot(y), y.atan2(x)]
    }
}

impl Mesh {
    /// The same mesh, whose nodes lie on circles around the origin.
    pub(super) fn around_origin(mut self) -> Self {
        let axes = [Vector3::x(), Vector3::y()];
        self.round = Some(Round { centre: Vector3::zeros(), axes });
        self
    }

    /// The same mesh of the plane in the plane z = 0 of space, as one [`mapped`](Self::mapped) there, but rings stay rings.
    ///
    /// # Errors
    /// Cells that fill the plane alone.
    #[cfg(feature = "scene-file")]
    pub(crate) fn in_space(self) -> Result<Self, crate::base::input::InputError> {
        let round = self.round.clone();
        let mapped = self.mapped(|x| [x[0], x[1], 0.0])?;
        Ok(Self { round, ..mapped })
    }

    /// Whether nodes of a finer mesh lie on the circles of a ring.
    pub(crate) fn is_round(&self) -> bool {
        self.round.is_some()
    }

    /// Carries the circles along as the mesh is moved by `offset` (m).
    pub(super) fn move_circles(&mut self, offset: &[f64]) {
        self.round.iter_mut().for_each(|round| round.translated(offset));
    }

    /// Carries the circles along as the mesh is turned about the origin.
    pub(super) fn turn_circles(&mut self, rotation: &Rotation3<f64>) {
        self.round.iter_mut().for_each(|round| round.turned(rotation));
    }

    /// The place (m) on a circle that lies between these nodes (from 0), each with its share: radius and angle are shared, not places.
    /// `None` of a mesh that is no ring.
    pub(crate) fn between_on_circle(&self, shares: &[(usize, f64)]) -> Option<Vec<f64>> {
        let round = self.round.as_ref()?;
        let mut parts =
            shares.iter().map(|(node, share)| (*share, round.polar(self.position(*node))));
        let (share, [radius, first]) = parts.next()?;
        let (mut mean, mut turn) = (share * radius, 0.0);
        for (share, [radius, angle]) in parts {
            mean += share * radius;
            turn += share * ((angle - first + PI).rem_euclid(TAU) - PI);
        }
        let (sin, cos) = (first + turn).sin_cos();
        let place = round.centre + mean * (cos * round.axes[0] + sin * round.axes[1]);
        Some(place.as_slice()[..self.dimension()].to_vec())
    }
}

/// Up to three coordinates.
fn vector(coordinates: &[f64]) -> Vector3<f64> {
    Vector3::from_fn(|i, _| coordinates.get(i).copied().unwrap_or(0.0))
}

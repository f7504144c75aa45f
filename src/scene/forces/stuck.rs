//! Points of surfaces that friction holds.

use crate::base::vector::dot;

use super::surface::weighted;

/// A point of a surface that is held by friction: it slides slower than the sticking speed on what it lies on.
///
/// The law is smooth in the sliding speed, so that what is held creeps.
pub(crate) struct Stuck {
    /// Nodes with the shares by which the point is given, ...
    pub(crate) point: Vec<(usize, f64)>,
    /// ... and those of the place on a body that it lies on, which is an obstacle if there are none.
    pub(crate) place: Vec<(usize, f64)>,
    /// Normal to what it lies on, of length 1.
    pub(crate) normal: [f64; 3],
    /// The normal force (N).
    pub(crate) pressing: f64,
    /// The sticking speed (m/s).
    pub(crate) sticking_speed: f64,
}

impl Stuck {
    /// Slip vector (m) of the point along its contact surface as the nodes move by `moved`, `dimension` components (m) each, and the
    /// obstacle that it may lie on by `carried`.
    pub(crate) fn slide(&self, moved: &[f64], carried: [f64; 3], dimension: usize) -> [f64; 3] {
        let of = |shares: &[(usize, f64)]| weighted(shares.iter().copied(), moved, dimension);
        let (point, place) = (of(&self.point), of(&self.place));
        let apart: [f64; 3] = std::array::from_fn(|i| point[i] - place[i] - carried[i]);
        let away = dot(&apart, &self.normal);
        std::array::from_fn(|i| apart[i] - away * self.normal[i])
    }
}

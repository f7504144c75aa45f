//! Boxes around curved faces, along their own directions: the distance from them is never more than that from the faces,
//! and is found much faster.

use crate::base::vector::{cross, difference, dot, norm};
use crate::elements::basis::control_points;
use crate::elements::mesh::FaceKind;

/// A box around a face.
pub(super) struct Hull {
    /// A point of it (m), and its directions, of length 1.
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
    /// Where it begins and ends along each direction, from the origin (m).
    ends: [[f64; 2]; 3],
}

impl Hull {
    /// Around a face of a kind with its nodes `at` these positions (m).
    pub(super) fn new(kind: FaceKind, at: &[[f64; 3]]) -> Self {
        let axes = axes(&at[..kind.corners()]);
        let mut hull = Self { origin: at[0], axes, ends: [[0.0; 2]; 3] };
        hull.include(kind, at);
        hull
    }

    /// Widens it so that it is around the face with its nodes `at` these positions, too.
    pub(super) fn include(&mut self, kind: FaceKind, at: &[[f64; 3]]) {
        let (points, count) = control_points(kind, at);
        for x in &points[..count] {
            let away = difference(x, &self.origin);
            for (axis, [low, high]) in self.axes.iter().zip(&mut self.ends) {
                let place = dot(axis, &away);
                (*low, *high) = (low.min(place), high.max(place));
            }
        }
    }

    /// The distance (m) of `x` from it, 0 inside.
    pub(super) fn distance(&self, x: &[f64; 3]) -> f64 {
        let away = difference(x, &self.origin);
        let beyond = self.axes.iter().zip(&self.ends).map(|(axis, [low, high])| {
            let place = dot(axis, &away);
            f64::max(low - place, place - high).max(0.0)
        });
        beyond.map(|x| x * x).sum::<f64>().sqrt()
    }
}

/// Directions of a face, the first along the side from its first corner to its second, and across it.
fn axes(corners: &[[f64; 3]]) -> [[f64; 3]; 3] {
    if corners.len() < 2 {
        return UNIT_AXES;
    }
    let side = difference(&corners[1], &corners[0]);
    let across = match *corners {
        [a, _, c] => cross(&side, &difference(&c, &a)),
        [a, b, c, d] => cross(&difference(&c, &a), &difference(&d, &b)),
        // an edge, most of all in the plane
        _ => cross(&side, &cross(&side, &UNIT_AXES[smallest(&side)])),
    };
    let normal = unit(&across);
    let along = dot(&side, &normal);
    let first = unit(&std::array::from_fn(|i| side[i] - along * normal[i]));
    let axes = [first, normal, cross(&first, &normal)];
    // a face without a length or an area has no directions of its own
    if axes.iter().all(|axis| (norm(axis) - 1.0).abs() < 1e-6) { axes } else { UNIT_AXES }
}

const UNIT_AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The axis along which `x` has its smallest component.
fn smallest(x: &[f64; 3]) -> usize {
    (0..3).rev().min_by(|&a, &b| x[a].abs().total_cmp(&x[b].abs())).unwrap_or(2)
}

fn unit(x: &[f64; 3]) -> [f64; 3] {
    let length = norm(x);
    x.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::vector::noise;
    use crate::elements::basis::{nearest, reference_node};

    /// Of bent faces of all kinds, turned in space: never farther than the nearest place, and in the mean nearly as far.
    #[test]
    fn no_face_is_nearer_than_its_hull() {
        for (kind, count) in [
            (FaceKind::Segment3, 3),
            (FaceKind::Triangle6, 6),
            (FaceKind::Triangle7, 7),
            (FaceKind::Quadrilateral, 4),
            (FaceKind::Quadrilateral8, 8),
            (FaceKind::Quadrilateral9, 9),
        ] {
            let (bent, mut short) = (noise(3 * count, 5), 0.0);
            let at: Vec<[f64; 3]> = (0..count)
                .map(|node| {
                    let [x, y] = reference_node(kind, node);
                    let flat = [0.8 * x, 0.6 * x + 0.6 * y, 0.8 * y];
                    std::array::from_fn(|i| flat[i] + 0.03 * bent[3 * node + i])
                })
                .collect();
            let hull = Hull::new(kind, &at);
            let places = noise(600, 3);
            for x in places.chunks_exact(3) {
                let x = [x[0], x[1], x[2]].map(|x| 0.5 + x);
                let apart = nearest(kind, &at, &x).distance(&at, &x);
                let bound = hull.distance(&x);
                assert!(bound <= apart + 1e-15, "{kind:?} {x:?}: {bound} {apart}");
                short += (apart - bound) / 200.0;
            }
            println!("{kind:?}: short by {short}");
            // half of a box around a triangle is beside it
            let bound = if kind.corners() == 3 { 0.2 } else { 0.15 };
            assert!(short < bound, "{kind:?}: {short}");
        }
        let point = Hull::new(FaceKind::Segment3, &[[1.0; 3]; 3]);
        assert!((point.distance(&[2.0, 1.0, 1.0]) - 1.0).abs() < 1e-15);
    }
}

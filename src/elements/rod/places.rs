//! Places within the cross sections of a rod.
//!
//! The point (t, a, b) of an element is (1 - t) (x_0 + a d_10 + b d_20) + t (x_1 + a d_11 + b d_21): as far from the axis along the directors of both
//! ends. So it is a sum of displacements of nodes with constant shares.

use nalgebra::{Matrix3, Vector3};

use super::elements::{RodElement, RodElements};
use crate::base::vector::padded;

/// Steps of Newton's method: elements are nearly straight.
const STEPS: usize = 20;
/// Parts of an element, and of the reach of its section, by which a place may be beyond these.
const ROUND_OFF: f64 = 1e-9;

/// Nodes with their shares, other than 0, in a point at the part `t` of the way between two cross sections. Each has its nodes and how far the point is along
/// its directors, in arms.
pub(super) fn shares_between(
    sections: [([usize; 3], [f64; 2]); 2],
    t: f64,
    dimension: usize,
) -> Vec<(usize, f64)> {
    let mut shares = Vec::with_capacity(2 * dimension);
    for ((nodes, arms), weight) in sections.into_iter().zip([1.0 - t, t]) {
        let directors = &arms[..dimension - 1];
        shares.push((nodes[0], weight * (1.0 - directors.iter().sum::<f64>())));
        let own = nodes[1..].iter().zip(directors);
        shares.extend(own.map(|(node, share)| (*node, weight * share)));
    }
    shares.retain(|(_, share)| *share != 0.0);
    shares
}

impl RodElements {
    /// Nodes with their shares in the point that is undeformed at `x` (m), if it is in a cross section.
    pub(crate) fn shares_at(&self, x: &[f64]) -> Option<Vec<(usize, f64)>> {
        let x = Vector3::from(padded(x));
        self.elements.iter().find_map(|element| {
            let [t, a, b] = self.coordinates(element, &x)?;
            let ends = element.ends.map(|end| (end.nodes, [a / end.arms[0], b / end.arms[1]]));
            Some(shares_between(ends, t, self.dimension))
        })
    }

    /// The coordinates t, a, b (m) of a position in an element, if it is in a cross section of that.
    fn coordinates(&self, element: &RodElement, x: &Vector3<f64>) -> Option<[f64; 3]> {
        let [first, last] = element.ends.map(|end| end.undeformed);
        let [first, last] =
            [first, last].map(|own| (Vector3::from(own.x), own.d.map(Vector3::from)));
        let mut at = Vector3::new(0.5, 0.0, 0.0);
        for _ in 0..STEPS {
            let [t, a, b] = at.into();
            let point = |(x, d): &(Vector3<f64>, [Vector3<f64>; 2])| x + d[0] * a + d[1] * b;
            let [begin, end] = [point(&first), point(&last)];
            let mixed = |k: usize| first.1[k] * (1.0 - t) + last.1[k] * t;
            let slopes = Matrix3::from_columns(&[end - begin, mixed(0), mixed(1)]);
            at += slopes.try_inverse()? * (x - begin - (end - begin) * t);
        }
        let [t, a, b] = at.into();
        let reach = [0, 1].map(|k| {
            let [first, last] = element.ends.map(|end| end.arms[k]);
            (1.0 - t) * first + t * last
        });
        let [a_part, b_part] = [a / reach[0], b / reach[1]];
        let beyond = match (self.dimension, self.has_corners()) {
            (2, _) => a_part.abs(),
            (_, true) => a_part.abs().max(b_part.abs()),
            _ => a_part.hypot(b_part),
        };
        let is_within = (t - 0.5).abs() <= 0.5 + ROUND_OFF && beyond <= 1.0 + ROUND_OFF;
        is_within.then_some([t, a, b])
    }

    /// Whether its section is a rectangle.
    fn has_corners(&self) -> bool {
        self.outline.iter().any(|[a, b]| a.abs() == 1.0 && b.abs() == 1.0)
    }
}

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

impl RodElements {
    /// Nodes with their shares in the point that is undeformed at `x` (m), if it is in a cross section.
    pub(crate) fn shares_at(&self, x: &[f64]) -> Option<Vec<(usize, f64)>> {
        let x = Vector3::from(padded(x));
        self.elements.iter().find_map(|element| {
            let [t, a, b] = self.coordinates(element, &x)?;
            let mut shares = Vec::with_capacity(2 * self.dimension);
            for (end, weight) in element.ends.iter().zip([1.0 - t, t]) {
                let arms = [a / end.arms[0], b / end.arms[1]];
                let directors = &arms[..self.dimension - 1];
                shares.push((end.nodes[0], weight * (1.0 - directors.iter().sum::<f64>())));
                let own = end.nodes[1..].iter().zip(directors);
                shares.extend(own.map(|(node, share)| (*node, weight * share)));
            }
            shares.retain(|(_, share)| *share != 0.0);
            Some(shares)
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

//! Distance from a face within which a node is tied to it.

use crate::base::vector::norm;

/// Largest distance of a node from the body that it is glued to, relative to the length of the edges there: the straight edges of
/// cells leave gaps along a curve.
pub(super) const MOST_APART: f64 = 0.2;

/// The longest edge between corners (m).
pub(super) fn longest(corners: &[[f64; 3]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let lengths = corners
        .iter()
        .zip(next)
        .map(|(a, b)| norm(&std::array::from_fn::<f64, 3, _>(|i| b[i] - a[i])));
    lengths.fold(0.0, f64::max)
}

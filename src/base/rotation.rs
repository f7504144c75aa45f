//! The rotation that is nearest to a matrix.

use nalgebra::{Matrix3, SVD};

/// The rotation that brings vectors x nearest to vectors y, in the mean square, with the correlation sum y x^T of both: that of its
/// polar decomposition, with a reflection taken out along the direction that matters least.
///
/// W. Kabsch, *A solution for the best rotation to relate two sets of vectors*, Acta Crystallographica A32 (1976).
pub(crate) fn nearest_rotation(correlation: Matrix3<f64>) -> Matrix3<f64> {
    match correlation.try_svd(true, true, f64::EPSILON, 100) {
        Some(SVD { u: Some(left), v_t: Some(right), .. }) => {
            let mut mirror = Matrix3::identity();
            mirror.m33 = (left * right).determinant().signum();
            left * mirror * right
        }
        _ => Matrix3::identity(),
    }
}

/// The angle (rad, counter-clockwise, between -pi and pi) of the rotation in the plane that brings vectors x nearest to vectors y, of pairs of
/// x times its weight, which add up to 0, and y.
pub(crate) fn plane_rotation(pairs: impl Iterator<Item = ([f64; 2], [f64; 2])>) -> f64 {
    let (mut along, mut across) = (0.0, 0.0);
    for ([a, b], [x, y]) in pairs {
        along += a * x + b * y;
        across += a * y - b * x;
    }
    across.atan2(along)
}

//! The flat face between the corners of a face of a mesh.

use nalgebra::Vector3;

use crate::elements::basis::reference_node;
use crate::elements::mesh::FaceKind;

/// The mean of the reference coordinates of some corners of a face.
pub(super) fn middle(kind: FaceKind, corners: impl ExactSizeIterator<Item = usize>) -> [f64; 2] {
    let share = 1.0 / corners.len() as f64;
    corners
        .map(|corner| reference_node(kind, corner))
        .fold([0.0; 2], |sum, xi| [sum[0] + share * xi[0], sum[1] + share * xi[1]])
}

/// The area (m^2) between corners (m) of a plane; the length (m) between two.
pub(super) fn area(corners: &[Vector3<f64>]) -> f64 {
    if let [a, b] = corners {
        return (b - a).norm();
    }
    let of_pair =
        |pair: &[Vector3<f64>]| 0.5 * (pair[0] - corners[0]).cross(&(pair[1] - corners[0]));
    corners.windows(2).skip(1).map(of_pair).sum::<Vector3<f64>>().norm()
}

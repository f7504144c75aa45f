//! Eight-node hexahedron on the unit cube, trilinear, nodes in the order of VTK.

use super::ReferenceCell;
use super::quadrilateral::GAUSS;

pub(crate) struct Hexahedron;

/// Gauss's rule along each axis: exact for stiffness and inertia of a cuboid.
const RULE: &[([f64; 3], f64)] = &[
    ([GAUSS[0], GAUSS[0], GAUSS[0]], 0.125),
    ([GAUSS[1], GAUSS[0], GAUSS[0]], 0.125),
    ([GAUSS[1], GAUSS[1], GAUSS[0]], 0.125),
    ([GAUSS[0], GAUSS[1], GAUSS[0]], 0.125),
    ([GAUSS[0], GAUSS[0], GAUSS[1]], 0.125),
    ([GAUSS[1], GAUSS[0], GAUSS[1]], 0.125),
    ([GAUSS[1], GAUSS[1], GAUSS[1]], 0.125),
    ([GAUSS[0], GAUSS[1], GAUSS[1]], 0.125),
];

/// The linear function that is 1 at `corner` and 0 at the other end of the axis, and its slope.
fn linear(corner: f64, x: f64) -> (f64, f64) {
    if corner == 1.0 { (x, 1.0) } else { (1.0 - x, -1.0) }
}

impl ReferenceCell<8, 3> for Hexahedron {
    const NODES: [[f64; 3]; 8] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ];
    const STIFFNESS_RULE: &'static [([f64; 3], f64)] = RULE;
    const MASS_RULE: &'static [([f64; 3], f64)] = RULE;

    fn values([x, y, z]: [f64; 3]) -> [f64; 8] {
        Self::NODES.map(|[i, j, k]| linear(i, x).0 * linear(j, y).0 * linear(k, z).0)
    }

    fn derivatives([x, y, z]: [f64; 3]) -> [[f64; 3]; 8] {
        Self::NODES.map(|[i, j, k]| {
            let ((p, dp), (q, dq), (r, dr)) = (linear(i, x), linear(j, y), linear(k, z));
            [dp * q * r, p * dq * r, p * q * dr]
        })
    }
}

//! Four-node tetrahedron (0,0,0), (1,0,0), (0,1,0), (0,0,1).

use super::ReferenceCell;

/// Barycentric coordinates (5 - sqrt(5))/20 and (5 + 3 sqrt(5))/20 of the four-point rule.
const A: f64 = 0.138_196_601_125_010_5;
const B: f64 = 0.585_410_196_624_968_5;

/// Four points, exact for quadratics.
pub(super) const FOUR_POINTS: &[([f64; 3], f64)] = &[
    ([A, A, A], 1.0 / 24.0),
    ([B, A, A], 1.0 / 24.0),
    ([A, B, A], 1.0 / 24.0),
    ([A, A, B], 1.0 / 24.0),
];

pub(crate) struct Tetrahedron;

impl ReferenceCell<4, 3> for Tetrahedron {
    const NODES: [[f64; 3]; 4] =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const STIFFNESS_RULE: &'static [([f64; 3], f64)] = &[([0.25, 0.25, 0.25], 1.0 / 6.0)];
    /// Exact for quadratics: M = (rho V/20) (2 on the diagonal, 1 elsewhere).
    const MASS_RULE: &'static [([f64; 3], f64)] = FOUR_POINTS;

    fn values([x, y, z]: [f64; 3]) -> [f64; 4] {
        [1.0 - x - y - z, x, y, z]
    }

    fn derivatives(_: [f64; 3]) -> [[f64; 3]; 4] {
        [[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    }
}

//! Four-node quadrilateral on [0, 1] x [0, 1], bilinear.

use super::ReferenceCell;

/// Abscissae (1 -+ 1/sqrt(3))/2 of Gauss's rule with two points on [0, 1], exact for cubics.
pub(super) const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

pub(crate) struct Quadrilateral;

/// Gauss's rule along each axis: exact for stiffness and inertia of a rectangle (and for the
/// inertia of any quadrilateral).
const RULE: &[([f64; 2], f64)] = &[
    ([GAUSS[0], GAUSS[0]], 0.25),
    ([GAUSS[1], GAUSS[0]], 0.25),
    ([GAUSS[1], GAUSS[1]], 0.25),
    ([GAUSS[0], GAUSS[1]], 0.25),
];

impl ReferenceCell<4, 2> for Quadrilateral {
    const NODES: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    const STIFFNESS_RULE: &'static [([f64; 2], f64)] = RULE;
    const MASS_RULE: &'static [([f64; 2], f64)] = RULE;

    fn values([x, y]: [f64; 2]) -> [f64; 4] {
        [(1.0 - x) * (1.0 - y), x * (1.0 - y), x * y, (1.0 - x) * y]
    }

    fn derivatives([x, y]: [f64; 2]) -> [[f64; 2]; 4] {
        [[y - 1.0, x - 1.0], [1.0 - y, -x], [y, x], [-y, 1.0 - x]]
    }
}

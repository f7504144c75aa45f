//! Two-node segment on [0, 1].

use super::ReferenceCell;

pub(crate) struct Segment;

impl ReferenceCell<2, 1> for Segment {
    const NODES: [[f64; 1]; 2] = [[0.0], [1.0]];
    const STIFFNESS_RULE: &'static [([f64; 1], f64)] = &[([0.5], 1.0)];
    /// Simpson's rule: exact for cubics, with rational numbers only.
    const MASS_RULE: &'static [([f64; 1], f64)] =
        &[([0.0], 1.0 / 6.0), ([0.5], 4.0 / 6.0), ([1.0], 1.0 / 6.0)];

    fn values([x]: [f64; 1]) -> [f64; 2] {
        [1.0 - x, x]
    }

    fn derivatives(_: [f64; 1]) -> [[f64; 1]; 2] {
        [[-1.0], [1.0]]
    }
}

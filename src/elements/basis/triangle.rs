//! Three-node triangle (0,0), (1,0), (0,1).

use super::ReferenceCell;

pub(crate) struct Triangle;

impl ReferenceCell<3, 2> for Triangle {
    const NODES: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    const STIFFNESS_RULE: &'static [([f64; 2], f64)] = &[([1.0 / 3.0, 1.0 / 3.0], 0.5)];
    /// Midpoints of the edges: exact for quadratics.
    const MASS_RULE: &'static [([f64; 2], f64)] =
        &[([0.5, 0.0], 1.0 / 6.0), ([0.5, 0.5], 1.0 / 6.0), ([0.0, 0.5], 1.0 / 6.0)];

    fn values([x, y]: [f64; 2]) -> [f64; 3] {
        [1.0 - x - y, x, y]
    }

    fn derivatives(_: [f64; 2]) -> [[f64; 2]; 3] {
        [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]
    }
}

//! Three-node segment on [0, 1]: its ends, then its middle. No body consists of them: they are the faces of
//! quadratic cells in the plane.

use super::ReferenceCell;
use super::quadrilateral::GAUSS;

/// sqrt(3/5)/2, the distance of the outer points of Gauss's rule with three points from the middle.
const OUTER: f64 = 0.387_298_334_620_741_7;

pub(crate) struct Segment3;

impl ReferenceCell<3, 1> for Segment3 {
    const NODES: [[f64; 1]; 3] = [[0.0], [1.0], [0.5]];
    /// Gauss's rule with two points: exact for cubics.
    const STIFFNESS_RULE: &'static [([f64; 1], f64)] = &[([GAUSS[0]], 0.5), ([GAUSS[1]], 0.5)];
    /// Gauss's rule with three points: exact for degree 5.
    const MASS_RULE: &'static [([f64; 1], f64)] =
        &[([0.5 - OUTER], 5.0 / 18.0), ([0.5], 8.0 / 18.0), ([0.5 + OUTER], 5.0 / 18.0)];

    fn values([x]: [f64; 1]) -> [f64; 3] {
        [(1.0 - x) * (1.0 - 2.0 * x), x * (2.0 * x - 1.0), 4.0 * x * (1.0 - x)]
    }

    fn derivatives([x]: [f64; 1]) -> [[f64; 1]; 3] {
        [[4.0 * x - 3.0], [4.0 * x - 1.0], [4.0 - 8.0 * x]]
    }
}

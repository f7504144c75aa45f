//! Six-node triangle: corners (0,0), (1,0), (0,1), then the middles of the edges 1-2, 2-3, 3-1.

use super::ReferenceCell;

/// Points and weights of the rule of degree 4 with six points (Dunavant 1985): two orbits of three
/// points each, with the barycentric coordinates (1 - 2a, a, a).
const A: f64 = 0.445_948_490_915_964_9;
const WEIGHT_A: f64 = 0.111_690_794_839_005_73;
const B: f64 = 0.091_576_213_509_770_74;
const WEIGHT_B: f64 = 0.054_975_871_827_660_93;

pub(super) const DEGREE_4: &[([f64; 2], f64)] = &[
    ([A, A], WEIGHT_A),
    ([1.0 - 2.0 * A, A], WEIGHT_A),
    ([A, 1.0 - 2.0 * A], WEIGHT_A),
    ([B, B], WEIGHT_B),
    ([1.0 - 2.0 * B, B], WEIGHT_B),
    ([B, 1.0 - 2.0 * B], WEIGHT_B),
];

pub(crate) struct Triangle6;

impl ReferenceCell<6, 2> for Triangle6 {
    const NODES: [[f64; 2]; 6] =
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
    /// Exact for quadratics, so for the stiffness of a triangle with straight sides and mid nodes
    /// in their middles.
    const STIFFNESS_RULE: &'static [([f64; 2], f64)] = &[
        ([1.0 / 6.0, 1.0 / 6.0], 1.0 / 6.0),
        ([2.0 / 3.0, 1.0 / 6.0], 1.0 / 6.0),
        ([1.0 / 6.0, 2.0 / 3.0], 1.0 / 6.0),
    ];
    /// Exact for degree 4, so for the inertia of a triangle with straight sides and mid nodes in
    /// their middles.
    const MASS_RULE: &'static [([f64; 2], f64)] = DEGREE_4;

    fn values([x, y]: [f64; 2]) -> [f64; 6] {
        let w = 1.0 - x - y;
        let corner = |l: f64| l * (2.0 * l - 1.0);
        [corner(w), corner(x), corner(y), 4.0 * w * x, 4.0 * x * y, 4.0 * y * w]
    }

    fn derivatives([x, y]: [f64; 2]) -> [[f64; 2]; 6] {
        let w = 1.0 - x - y;
        let first = 1.0 - 4.0 * w;
        [
            [first, first],
            [4.0 * x - 1.0, 0.0],
            [0.0, 4.0 * y - 1.0],
            [4.0 * (w - x), -4.0 * x],
            [4.0 * y, 4.0 * x],
            [-4.0 * y, 4.0 * (w - y)],
        ]
    }
}

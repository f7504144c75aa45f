//! Ten-node tetrahedron: corners (0,0,0), (1,0,0), (0,1,0), (0,0,1), then the middles of the edges
//! 1-2, 2-3, 3-1, 1-4, 2-4, 3-4 as in VTK.

use super::ReferenceCell;
use super::tetrahedron::FOUR_POINTS;

/// Points and weights of the rule of degree 5 with 14 points (Walkington 2000), all weights
/// positive: two orbits (1 - 3a, a, a, a) and one (1/2 - c, 1/2 - c, c, c) of barycentric
/// coordinates.
const A: f64 = 0.310_885_919_263_300_6;
const WEIGHT_A: f64 = 0.018_781_320_953_002_642;
const B: f64 = 0.092_735_250_310_891_23;
const WEIGHT_B: f64 = 0.012_248_840_519_393_659;
const C: f64 = 0.045_503_704_125_649_65;
const WEIGHT_C: f64 = 0.007_091_003_462_846_911;

pub(super) const DEGREE_5: &[([f64; 3], f64)] = &[
    ([A, A, A], WEIGHT_A),
    ([1.0 - 3.0 * A, A, A], WEIGHT_A),
    ([A, 1.0 - 3.0 * A, A], WEIGHT_A),
    ([A, A, 1.0 - 3.0 * A], WEIGHT_A),
    ([B, B, B], WEIGHT_B),
    ([1.0 - 3.0 * B, B, B], WEIGHT_B),
    ([B, 1.0 - 3.0 * B, B], WEIGHT_B),
    ([B, B, 1.0 - 3.0 * B], WEIGHT_B),
    ([C, C, 0.5 - C], WEIGHT_C),
    ([C, 0.5 - C, C], WEIGHT_C),
    ([0.5 - C, C, C], WEIGHT_C),
    ([C, 0.5 - C, 0.5 - C], WEIGHT_C),
    ([0.5 - C, C, 0.5 - C], WEIGHT_C),
    ([0.5 - C, 0.5 - C, C], WEIGHT_C),
];

pub(crate) struct Tetrahedron10;

impl ReferenceCell<10, 3> for Tetrahedron10 {
    const NODES: [[f64; 3]; 10] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.5, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.0, 0.5, 0.0],
        [0.0, 0.0, 0.5],
        [0.5, 0.0, 0.5],
        [0.0, 0.5, 0.5],
    ];
    /// Exact for quadratics, so for the stiffness of a tetrahedron with straight sides and mid
    /// nodes in their middles.
    const STIFFNESS_RULE: &'static [([f64; 3], f64)] = FOUR_POINTS;
    /// Exact for degree 5, so for the inertia of a tetrahedron with straight sides and mid nodes
    /// in their middles (degree 4).
    const MASS_RULE: &'static [([f64; 3], f64)] = DEGREE_5;

    fn values([x, y, z]: [f64; 3]) -> [f64; 10] {
        let w = 1.0 - x - y - z;
        let corner = |l: f64| l * (2.0 * l - 1.0);
        let middle = |l: f64, m: f64| 4.0 * l * m;
        [
            corner(w),
            corner(x),
            corner(y),
            corner(z),
            middle(w, x),
            middle(x, y),
            middle(y, w),
            middle(w, z),
            middle(x, z),
            middle(y, z),
        ]
    }

    fn derivatives([x, y, z]: [f64; 3]) -> [[f64; 3]; 10] {
        let w = 1.0 - x - y - z;
        let first = 1.0 - 4.0 * w;
        [
            [first, first, first],
            [4.0 * x - 1.0, 0.0, 0.0],
            [0.0, 4.0 * y - 1.0, 0.0],
            [0.0, 0.0, 4.0 * z - 1.0],
            [4.0 * (w - x), -4.0 * x, -4.0 * x],
            [4.0 * y, 4.0 * x, 0.0],
            [-4.0 * y, 4.0 * (w - y), -4.0 * y],
            [-4.0 * z, -4.0 * z, 4.0 * (w - z)],
            [4.0 * z, 0.0, 4.0 * x],
            [0.0, 4.0 * z, 4.0 * y],
        ]
    }
}

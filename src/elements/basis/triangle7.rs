//! Seven-node triangle: the nodes of the six-node one, then the middle, with the bubble 27 l1 l2 l3 of the barycentric
//! coordinates (Crouzeix and Raviart 1973).

use super::ReferenceCell;
use super::triangle6::{DEGREE_4, Triangle6};

/// Points and weights of the rule of degree 6 with twelve points (Dunavant 1985): two orbits of three points each, with
/// the barycentric coordinates (1 - 2a, a, a), and one of six, (1 - c - d, c, d).
const A: f64 = 0.249_286_745_170_910_43;
const WEIGHT_A: f64 = 0.058_393_137_863_189_684;
const B: f64 = 0.063_089_014_491_502_23;
const WEIGHT_B: f64 = 0.025_422_453_185_103_41;
const C: f64 = 0.053_145_049_844_816_945;
const D: f64 = 0.310_352_451_033_784_4;
const E: f64 = 1.0 - C - D;
const WEIGHT_C: f64 = 0.041_425_537_809_186_785;

const THIRD: f64 = 1.0 / 3.0;

pub(crate) struct Triangle7;

impl ReferenceCell<7, 2> for Triangle7 {
    const NODES: [[f64; 2]; 7] = {
        let mut nodes = [[THIRD; 2]; 7];
        let mut a = 0;
        while a < 6 {
            nodes[a] = Triangle6::NODES[a];
            a += 1;
        }
        nodes
    };
    /// Exact for degree 4, so for the stiffness of a triangle with straight sides and nodes in their middles.
    const STIFFNESS_RULE: &'static [([f64; 2], f64)] = DEGREE_4;
    /// Exact for degree 6, so for the inertia of such a triangle.
    const MASS_RULE: &'static [([f64; 2], f64)] = &[
        ([A, A], WEIGHT_A),
        ([1.0 - 2.0 * A, A], WEIGHT_A),
        ([A, 1.0 - 2.0 * A], WEIGHT_A),
        ([B, B], WEIGHT_B),
        ([1.0 - 2.0 * B, B], WEIGHT_B),
        ([B, 1.0 - 2.0 * B], WEIGHT_B),
        ([C, D], WEIGHT_C),
        ([D, C], WEIGHT_C),
        ([C, E], WEIGHT_C),
        ([E, C], WEIGHT_C),
        ([D, E], WEIGHT_C),
        ([E, D], WEIGHT_C),
    ];

    fn values([x, y]: [f64; 2]) -> [f64; 7] {
        let w = 1.0 - x - y;
        with_bubble(Triangle6::values([x, y]), w * x * y)
    }

    fn derivatives([x, y]: [f64; 2]) -> [[f64; 2]; 7] {
        let w = 1.0 - x - y;
        let bubble = [y * (w - x), x * (w - y)];
        let quadratic = Triangle6::derivatives([x, y]);
        let along = |axis: usize| with_bubble(quadratic.map(|d| d[axis]), bubble[axis]);
        let [by_x, by_y] = [along(0), along(1)];
        std::array::from_fn(|a| [by_x[a], by_y[a]])
    }
}

/// The quadratic functions without their values in the middle, where a corner has -1/9 and the middle of an edge 4/9, and
/// the bubble of that; `product` is l1 l2 l3.
fn with_bubble(quadratic: [f64; 6], product: f64) -> [f64; 7] {
    std::array::from_fn(|a| match a {
        0..3 => quadratic[a] + 3.0 * product,
        3..6 => quadratic[a] - 12.0 * product,
        _ => 27.0 * product,
    })
}

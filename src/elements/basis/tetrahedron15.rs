//! Fifteen-node tetrahedron: the nodes of the ten-node one, then the middles of its faces 1-2-3, 1-2-4, 2-3-4, 1-3-4 and of
//! the cell, with the bubbles of these: 27 l1 l2 l3 on a face, 256 l1 l2 l3 l4 in the cell (Crouzeix and Raviart 1973).

use super::ReferenceCell;
use super::tetrahedron10::{DEGREE_5, Tetrahedron10};
use crate::elements::mesh::CellKind;

/// Points and weights of the rule of degree 6 with 24 points, all weights positive (Keast 1986): three orbits (1 - 3a, a, a, a)
/// and one (d, d, e, 1 - 2d - e) of barycentric coordinates.
const A: f64 = 0.214_602_871_259_152_03;
const WEIGHT_A: f64 = 0.006_653_791_709_694_582;
const B: f64 = 0.040_673_958_534_611_35;
const WEIGHT_B: f64 = 0.001_679_535_175_886_774;
const C: f64 = 0.322_337_890_142_275_5;
const WEIGHT_C: f64 = 0.009_226_196_923_942_455;
const D: f64 = 0.063_661_001_875_017_53;
const E: f64 = 0.269_672_331_458_315_8;
const F: f64 = 1.0 - 2.0 * D - E;
const WEIGHT_D: f64 = 9.0 / 1120.0;

const THIRD: f64 = 1.0 / 3.0;

pub(crate) struct Tetrahedron15;

impl ReferenceCell<15, 3> for Tetrahedron15 {
    const NODES: [[f64; 3]; 15] = {
        let mut nodes = [[0.25; 3]; 15];
        let mut a = 0;
        while a < 10 {
            nodes[a] = Tetrahedron10::NODES[a];
            a += 1;
        }
        nodes[10] = [THIRD, THIRD, 0.0];
        nodes[11] = [THIRD, 0.0, THIRD];
        nodes[12] = [THIRD, THIRD, THIRD];
        nodes[13] = [0.0, THIRD, THIRD];
        nodes
    };
    /// Exact for degree 5: for all of the stiffness of a tetrahedron with straight sides but that between the bubble of the cell
    /// and itself.
    const STIFFNESS_RULE: &'static [([f64; 3], f64)] = DEGREE_5;
    /// Exact for degree 6, so for the inertia of all but the bubble of the cell; positive.
    const MASS_RULE: &'static [([f64; 3], f64)] = &[
        ([A, A, A], WEIGHT_A),
        ([1.0 - 3.0 * A, A, A], WEIGHT_A),
        ([A, 1.0 - 3.0 * A, A], WEIGHT_A),
        ([A, A, 1.0 - 3.0 * A], WEIGHT_A),
        ([B, B, B], WEIGHT_B),
        ([1.0 - 3.0 * B, B, B], WEIGHT_B),
        ([B, 1.0 - 3.0 * B, B], WEIGHT_B),
        ([B, B, 1.0 - 3.0 * B], WEIGHT_B),
        ([C, C, C], WEIGHT_C),
        ([1.0 - 3.0 * C, C, C], WEIGHT_C),
        ([C, 1.0 - 3.0 * C, C], WEIGHT_C),
        ([C, C, 1.0 - 3.0 * C], WEIGHT_C),
        ([D, D, E], WEIGHT_D),
        ([D, D, F], WEIGHT_D),
        ([D, E, D], WEIGHT_D),
        ([D, F, D], WEIGHT_D),
        ([E, D, D], WEIGHT_D),
        ([F, D, D], WEIGHT_D),
        ([D, E, F], WEIGHT_D),
        ([D, F, E], WEIGHT_D),
        ([E, D, F], WEIGHT_D),
        ([F, D, E], WEIGHT_D),
        ([E, F, D], WEIGHT_D),
        ([F, E, D], WEIGHT_D),
    ];

    fn values([x, y, z]: [f64; 3]) -> [f64; 15] {
        let l = [1.0 - x - y - z, x, y, z];
        let product = |corners: &[usize]| corners.iter().map(|&corner| l[corner]).product();
        with_bubbles(Tetrahedron10::values([x, y, z]), product)
    }

    fn derivatives([x, y, z]: [f64; 3]) -> [[f64; 3]; 15] {
        let l = [1.0 - x - y - z, x, y, z];
        let quadratic = Tetrahedron10::derivatives([x, y, z]);
        // of a product of barycentric coordinates: l1 falls along each axis as another one rises
        let slope = |corners: &[usize], axis: usize| {
            let others = |but: usize| -> f64 {
                let others = corners.iter().filter(|corner| **corner != but);
                others.map(|&corner| l[corner]).product()
            };
            let by = |corner: usize| if corners.contains(&corner) { others(corner) } else { 0.0 };
            by(axis + 1) - by(0)
        };
        let along = [0, 1, 2]
            .map(|axis| with_bubbles(quadratic.map(|d| d[axis]), |corners| slope(corners, axis)));
        std::array::from_fn(|a| along.map(|values| values[a]))
    }
}

/// The quadratic functions without their values in the middles, and the bubbles of these. `product` is that of the barycentric
/// coordinates of corners: of the three of a face, or all four. At the middle of a face a corner has -1/9 and the middle
/// of an edge 4/9, in that of the cell -1/8 and 1/4; a face has 27/64 there.
fn with_bubbles(quadratic: [f64; 10], product: impl Fn(&[usize]) -> f64) -> [f64; 15] {
    let (edges, middles) = (CellKind::Tetrahedron15.edges(), CellKind::Tetrahedron15.middles());
    let products: [f64; 5] = std::array::from_fn(|middle| product(middles[middle]));
    let (faces, cell) = (&products[..4], products[4]);
    let around = |corners: &[usize]| -> f64 {
        let faces = middles.iter().zip(faces);
        let around = faces.filter(|(face, _)| corners.iter().all(|corner| face.contains(corner)));
        around.map(|(_, product)| product).sum()
    };
    std::array::from_fn(|a| match a {
        0..4 => quadratic[a] + 3.0 * around(&[a]) - 4.0 * cell,
        4..10 => quadratic[a] - 12.0 * around(&edges[a - 4][..2]) + 32.0 * cell,
        10..14 => 27.0 * faces[a - 10] - 108.0 * cell,
        _ => 256.0 * cell,
    })
}

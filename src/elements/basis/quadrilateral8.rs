//! Eight-node serendipity quadrilateral on [0, 1] x [0, 1]: corners as in the four-node one, then the middles
//! of the edges 1-2, 2-3, 3-4, 4-1. No body consists of them: they are the faces of hexahedra of 20 nodes.

use super::ReferenceCell;
use super::quadrilateral::GAUSS;
use super::segment3::Segment3;

/// The shape functions of serendipity cells of degree 2 at `x`: at a corner the product of linear functions
/// f, g (, h) times 2 (f + g (+ h)) - (2 M - 1), at the middle of an edge the product of a parabola along it
/// and linear functions.
pub(super) fn serendipity<const N: usize, const M: usize>(
    nodes: [[f64; M]; N],
    x: [f64; M],
) -> [f64; N] {
    nodes.map(|node| {
        let product: f64 = (0..M).map(|axis| along(node[axis], x[axis]).0).product();
        product * if node.contains(&0.5) { 1.0 } else { corner_factor(node, x) }
    })
}

/// Their derivatives.
pub(super) fn serendipity_derivatives<const N: usize, const M: usize>(
    nodes: [[f64; M]; N],
    x: [f64; M],
) -> [[f64; M]; N] {
    nodes.map(|node| {
        let factors: [(f64, f64); M] = std::array::from_fn(|axis| along(node[axis], x[axis]));
        std::array::from_fn(|axis| {
            let others = (0..M).filter(|other| *other != axis);
            let rest: f64 = others.map(|other| factors[other].0).product();
            let (value, slope) = factors[axis];
            match node.contains(&0.5) {
                true => slope * rest,
                false => slope * rest * (corner_factor(node, x) + 2.0 * value),
            }
        })
    })
}

fn corner_factor<const M: usize>(node: [f64; M], x: [f64; M]) -> f64 {
    let sum: f64 = (0..M).map(|axis| along(node[axis], x[axis]).0).sum();
    2.0 * sum - (2.0 * M as f64 - 1.0)
}

/// The factor of a shape function along an axis, and its slope: a parabola for a `node` in the middle, else
/// linear; 1 at `node`, 0 at the other ends.
fn along(node: f64, x: f64) -> (f64, f64) {
    match node {
        0.5 => (4.0 * x * (1.0 - x), 4.0 - 8.0 * x),
        1.0 => (x, 1.0),
        _ => (1.0 - x, -1.0),
    }
}

pub(crate) struct Quadrilateral8;

/// Gauss's rule with three points along each axis.
pub(super) const RULE: [([f64; 2], f64); 9] = {
    let line = Segment3::MASS_RULE;
    let mut rule = [([0.0; 2], 0.0); 9];
    let mut k = 0;
    while k < 9 {
        let (([x], p), ([y], q)) = (line[k % 3], line[k / 3]);
        rule[k] = ([x, y], p * q);
        k += 1;
    }
    rule
};

impl ReferenceCell<8, 2> for Quadrilateral8 {
    const NODES: [[f64; 2]; 8] = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [0.5, 0.0],
        [1.0, 0.5],
        [0.5, 1.0],
        [0.0, 0.5],
    ];
    /// Exact for cubics along each axis.
    const STIFFNESS_RULE: &'static [([f64; 2], f64)] = &[
        ([GAUSS[0], GAUSS[0]], 0.25),
        ([GAUSS[1], GAUSS[0]], 0.25),
        ([GAUSS[1], GAUSS[1]], 0.25),
        ([GAUSS[0], GAUSS[1]], 0.25),
    ];
    /// Exact for degree 5 along each axis.
    const MASS_RULE: &'static [([f64; 2], f64)] = &RULE;

    fn values(x: [f64; 2]) -> [f64; 8] {
        serendipity(Self::NODES, x)
    }

    fn derivatives(x: [f64; 2]) -> [[f64; 2]; 8] {
        serendipity_derivatives(Self::NODES, x)
    }
}

//! Nine-node quadrilateral on [0, 1] x [0, 1], biquadratic: the corners and the middles of the edges as in the eight-node
//! one, then the middle of the cell.

use super::ReferenceCell;
use super::quadrilateral8::RULE;
use super::segment3::Segment3;

/// The shape functions of Lagrange's cells of degree 2 at `x`: products of parabolas along the axes.
pub(super) fn biquadratic<const N: usize, const M: usize>(
    nodes: [[f64; M]; N],
    x: [f64; M],
) -> [f64; N] {
    nodes.map(|node| (0..M).map(|axis| parabola(node[axis], x[axis]).0).product())
}

/// Their derivatives.
pub(super) fn biquadratic_derivatives<const N: usize, const M: usize>(
    nodes: [[f64; M]; N],
    x: [f64; M],
) -> [[f64; M]; N] {
    nodes.map(|node| {
        let factors: [(f64, f64); M] = std::array::from_fn(|axis| parabola(node[axis], x[axis]));
        std::array::from_fn(|axis| {
            let factor =
                |other: usize| if other == axis { factors[other].1 } else { factors[other].0 };
            (0..M).map(factor).product()
        })
    })
}

/// The parabola along an axis that is 1 at `node` and 0 at the other two of 0, 1/2 and 1, and its slope: a shape function of
/// the three-node segment.
fn parabola(node: f64, x: f64) -> (f64, f64) {
    let a = [0, 2, 1][(2.0 * node) as usize];
    (Segment3::values([x])[a], Segment3::derivatives([x])[a][0])
}

pub(crate) struct Quadrilateral9;

impl ReferenceCell<9, 2> for Quadrilateral9 {
    const NODES: [[f64; 2]; 9] = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [0.5, 0.0],
        [1.0, 0.5],
        [0.5, 1.0],
        [0.0, 0.5],
        [0.5, 0.5],
    ];
    /// Gauss's rule with three points along each axis: exact for the stiffness of a rectangle. With two there are motions
    /// without energy.
    const STIFFNESS_RULE: &'static [([f64; 2], f64)] = &RULE;
    const MASS_RULE: &'static [([f64; 2], f64)] = &RULE;

    fn values(x: [f64; 2]) -> [f64; 9] {
        biquadratic(Self::NODES, x)
    }

    fn derivatives(x: [f64; 2]) -> [[f64; 2]; 9] {
        biquadratic_derivatives(Self::NODES, x)
    }
}

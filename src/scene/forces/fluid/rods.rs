//! Drag of a fluid on rods, by their diameter.
//!
//! An element of the width b, whose length deforms, has at two points the force per length
//!
//! ```text
//! f = -(rho/2) (c b |w_n| w_n + C_t s |w_t| w_t)
//! ```
//!
//! of the velocity w relative to the fluid, divided into its parts along the axis and across it, with the perimeter s. c is the coefficient that faces around
//! the section have: 4/3 C_n of a cylinder, 2 C_n of the two sides of a rod in the plane.

use std::f64::consts::PI;

use nalgebra::SVector;
use num_dual::{DualNum, DualSVec64, DualVec};

use super::traction::Matrix;
use crate::base::vector::dot;
use crate::elements::rod::TubePiece;

/// Drag on an element of a rod.
pub(crate) struct RodDrag {
    /// The nodes of the axis at its ends.
    nodes: [usize; 2],
    /// Their undeformed difference (m).
    span: [f64; 3],
    /// rho c b/2 and rho C_t s/2 (kg/m^2).
    factors: [f64; 2],
}

/// A point of an element: the shares of both ends in it, the vector of the element (m), and its velocity relative to the fluid (m/s).
struct DragPoint {
    shares: [f64; 2],
    span: [f64; 3],
    velocity: [f64; 3],
}

/// Gauss points on an element from 0 to 1, each of which has half of it.
const POINTS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

impl RodDrag {
    /// The drag on a `piece` between these undeformed places (m), in a space of a `dimension`.
    pub(super) fn new(
        piece: &TubePiece,
        [from, to]: [[f64; 3]; 2],
        dimension: usize,
        density: f64,
        [normal, tangential]: [f64; 2],
    ) -> Self {
        let (shape, around) = if dimension == 2 { (2.0, 2.0) } else { (4.0 / 3.0, PI) };
        let per_area = 0.5 * density * piece.width;
        Self {
            nodes: piece.ends.map(|(node, _)| node),
            span: std::array::from_fn(|i| to[i] - from[i]),
            factors: [shape * normal, around * tangential].map(|c| per_area * c),
        }
    }

    fn points(
        &self,
        current: &[f64; 3],
        [u, v]: [&[f64]; 2],
        dimension: usize,
    ) -> [DragPoint; POINTS.len()] {
        let of = |field: &[f64], end: usize, i: usize| {
            if i < dimension { field[self.nodes[end] * dimension + i] } else { 0.0 }
        };
        let span = std::array::from_fn(|i| self.span[i] + of(u, 1, i) - of(u, 0, i));
        POINTS.map(|point| {
            let shares = [1.0 - point, point];
            let moving = |i: usize| shares[0] * of(v, 0, i) + shares[1] * of(v, 1, i);
            DragPoint { shares, span, velocity: std::array::from_fn(|i| moving(i) - current[i]) }
        })
    }

    /// The force (N) on a point with this vector of the element and this velocity.
    fn force<T: DualNum<Primitive = f64> + Copy>(&self, span: [T; 3], w: [T; 3]) -> [T; 3] {
        let dot = |a: [T; 3], b: [T; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let size = |a: [T; 3]| {
            let square = dot(a, a);
            // |w| w has the slope 0 there
            if square.re() == 0.0 { T::from(0.0) } else { square.sqrt() }
        };
        let length = size(span);
        let tangent = span.map(|x| x / length);
        let part = dot(w, tangent);
        let along = tangent.map(|t| t * part);
        let across: [T; 3] = std::array::from_fn(|i| w[i] - along[i]);
        let [a, b] = [size(across) * self.factors[0], size(along) * self.factors[1]];
        std::array::from_fn(|i| {
            -(across[i] * a + along[i] * b) * length * (1.0 / POINTS.len() as f64)
        })
    }

    /// Calls `see` with each node and the force (N) on it. Returns the power (W) by which a current carries the element along.
    pub(super) fn each(
        &self,
        current: &[f64; 3],
        state: [&[f64]; 2],
        dimension: usize,
        mut see: impl FnMut(usize, [f64; 3]),
    ) -> f64 {
        let mut power = 0.0;
        for DragPoint { shares, span, velocity } in self.points(current, state, dimension) {
            let force = self.force(span, velocity);
            for (&node, share) in self.nodes.iter().zip(shares) {
                see(node, force.map(|x| share * x));
            }
            power += dot(&force, current);
        }
        power
    }

    /// Calls `add` with each pair of nodes, and -df/du and -df/dv.
    pub(super) fn each_tangent(
        &self,
        current: &[f64; 3],
        state: [&[f64]; 2],
        dimension: usize,
        mut add: impl FnMut([usize; 2], [Matrix; 2]),
    ) {
        let dual = |value: f64, number: usize| -> DualSVec64<6> {
            let mut slopes = SVector::<f64, 6>::zeros();
            slopes[number] = 1.0;
            DualVec::new(value, num_dual::Derivative::some(slopes))
        };
        for DragPoint { shares, span, velocity } in self.points(current, state, dimension) {
            let force = self.force(
                std::array::from_fn(|i| dual(span[i], i)),
                std::array::from_fn(|i| dual(velocity[i], 3 + i)),
            );
            let slope = |i: usize, j: usize| force[i].eps.0.map_or(0.0, |slopes| slopes[j]);
            let matrix = |first: usize, factor: f64| -> Matrix {
                std::array::from_fn(|i| std::array::from_fn(|j| -factor * slope(i, first + j)))
            };
            for (&row, share) in self.nodes.iter().zip(shares) {
                let columns = self.nodes.iter().zip(shares).zip([-1.0, 1.0]);
                for ((&column, other), sign) in columns {
                    let by_both = [matrix(0, share * sign), matrix(3, share * other)];
                    add([row, column], by_both);
                }
            }
        }
    }
}

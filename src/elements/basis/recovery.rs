//! Extrapolation from strain points to nodes.
//!
//! The polynomial through the strain points is evaluated at the node; in cells of 14 points the value is that
//! of the nearest point.

use nalgebra::DMatrix;

use super::ReferenceCell;

/// The weights by which values at the `Q` strain points of a cell are extrapolated to its nodes: row a gives
/// the value at node a of the polynomial through them. It is constant for one point, else linear in a
/// simplex, and linear along each axis of a cube; with more points than coefficients it is the least-squares
/// fit.
pub(crate) fn extrapolation<
    C: ReferenceCell<N, M>,
    const N: usize,
    const M: usize,
    const Q: usize,
>() -> [[f64; Q]; N] {
    let is_simplex = M > 1 && !C::NODES.contains(&[1.0; M]);
    let term = |q: usize, xi: &[f64; M]| -> f64 {
        // axes of the factors of the term
        let factors = (0..M).filter(|axis| match is_simplex {
            true => q == axis + 1,
            false => (q >> axis) & 1 == 1,
        });
        factors.map(|axis| xi[axis]).product()
    };
    let terms = Q.min(if is_simplex { M + 1 } else { 1 << M });
    let at_points = DMatrix::from_fn(Q, terms, |p, q| term(q, &C::STIFFNESS_RULE[p].0));
    let inverse = match terms == Q {
        true => at_points.try_inverse(),
        false => at_points.tr_mul(&at_points).try_inverse().map(|x| x * at_points.transpose()),
    };
    let inverse = inverse.expect("the strain points of a cell lie apart");
    let factor = |node: &[f64; M], p| (0..terms).map(|q| term(q, node) * inverse[(q, p)]).sum();
    C::NODES.map(|node| std::array::from_fn(|p| factor(&node, p)))
}

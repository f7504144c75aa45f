//! From strain points to nodes.

use nalgebra::SMatrix;

use super::ReferenceCell;

/// What values at the `Q` strain points of a cell count for at each of its nodes: row a has their factors in the value
/// at node a of the polynomial through them, constant for one point, else linear in a simplex and along each axis of
/// a cube.
pub(crate) fn extrapolation<
    C: ReferenceCell<N, M>,
    const N: usize,
    const M: usize,
    const Q: usize,
>() -> [[f64; Q]; N] {
    let is_linear = Q == M + 1;
    let term = |q: usize, xi: &[f64; M]| -> f64 {
        // axes of the factors of the term
        let factors = (0..M).filter(|axis| match is_linear {
            true => q == axis + 1,
            false => (q >> axis) & 1 == 1,
        });
        factors.map(|axis| xi[axis]).product()
    };
    let at_points = SMatrix::<f64, Q, Q>::from_fn(|p, q| term(q, &C::STIFFNESS_RULE[p].0));
    let inverse = at_points.try_inverse().expect("the strain points of a cell lie apart");
    C::NODES
        .map(|node| std::array::from_fn(|p| (0..Q).map(|q| term(q, &node) * inverse[(q, p)]).sum()))
}

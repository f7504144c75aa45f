//! Reference cells: shape functions and quadrature in their own coordinates.

/// A reference cell of `N` nodes in dimension `M`.
pub(crate) trait ReferenceCell<const N: usize, const M: usize> {
    /// Positions of the nodes.
    const NODES: [[f64; M]; N];
    /// Points and weights that integrate the stiffness.
    const STIFFNESS_RULE: &'static [([f64; M], f64)];
    /// Points and weights that integrate products of two shape functions.
    const MASS_RULE: &'static [([f64; M], f64)];

    /// The shape functions N_a.
    fn values(xi: [f64; M]) -> [f64; N];

    /// Their derivatives by the reference coordinates.
    fn derivatives(xi: [f64; M]) -> [[f64; M]; N];
}

//! Elements: shape functions and quadrature, one small file per cell.
//!
//! A cell is known to the rest of the crate by its quadrature points only: the gradients g_a of
//! its shape functions and a weight each. The map from the reference cell to the natural shape is
//! isoparametric for all cells.

mod hexahedron;
mod quadrilateral;
mod segment;
#[cfg(test)]
mod tests;
mod tetrahedron;
mod tetrahedron10;
mod triangle;
mod triangle6;

use nalgebra::{SMatrix, SVector};

pub(crate) use hexahedron::Hexahedron;
pub(crate) use quadrilateral::Quadrilateral;
pub(crate) use segment::Segment;
pub(crate) use tetrahedron::Tetrahedron;
pub(crate) use tetrahedron10::Tetrahedron10;
pub(crate) use triangle::Triangle;
pub(crate) use triangle6::Triangle6;

/// A reference cell of `N` nodes in dimension `D`.
pub(crate) trait ReferenceCell<const N: usize, const D: usize> {
    /// Points and weights that integrate the stiffness.
    const STIFFNESS_RULE: &'static [([f64; D], f64)];
    /// Points and weights that integrate products of two shape functions.
    const MASS_RULE: &'static [([f64; D], f64)];

    /// The shape functions N_a.
    fn values(xi: [f64; D]) -> [f64; N];

    /// Their derivatives by the reference coordinates.
    fn derivatives(xi: [f64; D]) -> [[f64; D]; N];
}

/// A quadrature point for the stiffness: gradients of the shape functions (1/m) and volume.
pub(crate) struct StiffnessPoint<const N: usize, const D: usize> {
    pub gradients: [SVector<f64, D>; N],
    /// Length, area or volume that the point stands for (m, m^2, m^3).
    pub volume: f64,
}

/// A quadrature point for the inertia: values of the shape functions and volume.
pub(crate) struct MassPoint<const N: usize> {
    pub values: [f64; N],
    pub volume: f64,
}

/// The stiffness points of the cell with the natural nodal positions `nodes`; fails with the
/// volume of the worst point where the map is not invertible with positive volume.
pub(crate) fn stiffness_points<C: ReferenceCell<N, D>, const N: usize, const D: usize>(
    nodes: &[[f64; D]; N],
) -> Result<Vec<StiffnessPoint<N, D>>, f64> {
    let volume_scale = size(nodes).powi(D as i32);
    let point = |&(xi, weight): &([f64; D], f64)| {
        let derivatives = C::derivatives(xi).map(SVector::from);
        let jacobian = map_jacobian(nodes, &derivatives);
        let inverse = jacobian.try_inverse();
        let volume = weight * determinant(&jacobian);
        match inverse {
            Some(inverse) if volume > 1e-12 * volume_scale => Ok(StiffnessPoint {
                gradients: derivatives.map(|derivative| inverse.tr_mul(&derivative)),
                volume,
            }),
            _ => Err(volume),
        }
    };
    C::STIFFNESS_RULE.iter().map(point).collect()
}

/// The mass points of the cell with the natural nodal positions `nodes`.
pub(crate) fn mass_points<C: ReferenceCell<N, D>, const N: usize, const D: usize>(
    nodes: &[[f64; D]; N],
) -> impl Iterator<Item = MassPoint<N>> {
    C::MASS_RULE.iter().map(move |&(xi, weight)| {
        let jacobian = map_jacobian(nodes, &C::derivatives(xi).map(SVector::from));
        MassPoint { values: C::values(xi), volume: weight * determinant(&jacobian) }
    })
}

/// Derivative of the position by the reference coordinates: sum_a X_a (dN_a/dxi)^T.
fn map_jacobian<const N: usize, const D: usize>(
    nodes: &[[f64; D]; N],
    derivatives: &[SVector<f64, D>; N],
) -> SMatrix<f64, D, D> {
    let products = nodes.iter().zip(derivatives).map(|(x, d)| SVector::from(*x) * d.transpose());
    products.fold(SMatrix::zeros(), |sum, product| sum + product)
}

fn determinant<const D: usize>(matrix: &SMatrix<f64, D, D>) -> f64 {
    let m = |i: usize, j: usize| matrix[(i, j)];
    match D {
        1 => m(0, 0),
        2 => m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0),
        _ => {
            m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1))
                - m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0))
                + m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0))
        }
    }
}

/// Largest distance of a node from the first one.
fn size<const N: usize, const D: usize>(nodes: &[[f64; D]; N]) -> f64 {
    let first = SVector::from(nodes[0]);
    nodes.iter().map(|&node| (SVector::from(node) - first).norm()).fold(0.0, f64::max)
}

//! Elements: shape functions and quadrature, one small file per cell.
//!
//! The rest of the crate uses only the quadrature points of a cell: the gradients g_a of its shape functions
//! and a weight each. The map from the reference cell to the undeformed shape is isoparametric for all cells.
//!
//! A cell of dimension M may live in a space of higher dimension D (a string, a membrane). It is
//! then described in coordinates of its own, along an orthonormal frame in its tangent space.
//!
//! The kinds of cells differ by one table (`mesh/cell.rs`: nodes, faces, edges, names, type of Gmsh) and by
//! their file here, which `with_element` names. `elements/body` has no case for any kind.

mod bisection;
mod closest;
mod face;
mod finer;
mod hexahedron;
mod hexahedron20;
mod hexahedron27;
mod locate;
mod nearest;
mod quadrilateral;
mod quadrilateral8;
mod quadrilateral9;
mod recovery;
mod reference;
mod segment;
mod segment3;
#[cfg(test)]
mod tests;
mod tetrahedron;
mod tetrahedron10;
mod tetrahedron15;
mod triangle;
mod triangle6;
mod triangle7;

use nalgebra::{SMatrix, SVector};

#[cfg(feature = "study")]
pub(crate) use bisection::can_be_bisected;
pub(crate) use bisection::worst_cells;
pub(crate) use closest::closest;
pub(crate) use face::{
    FacePoint, MOST_NODES, control_points, face_points, is_affine, reach, reference_node,
};
pub(crate) use finer::Finer;
pub(crate) use hexahedron::Hexahedron;
pub(crate) use hexahedron20::Hexahedron20;
pub(crate) use hexahedron27::Hexahedron27;
pub(crate) use locate::{shares_at, shares_in};
pub(crate) use nearest::{NearestPoint, nearest};
pub(crate) use quadrilateral::Quadrilateral;
pub(crate) use quadrilateral8::Quadrilateral8;
pub(crate) use quadrilateral9::Quadrilateral9;
pub(crate) use recovery::extrapolation;
pub(crate) use reference::ReferenceCell;
pub(crate) use segment::Segment;
pub(crate) use segment3::Segment3;
pub(crate) use tetrahedron::Tetrahedron;
pub(crate) use tetrahedron10::Tetrahedron10;
pub(crate) use tetrahedron15::Tetrahedron15;
pub(crate) use triangle::Triangle;
pub(crate) use triangle6::Triangle6;
pub(crate) use triangle7::Triangle7;

use crate::base::tensor::{Matrix, determinant};

/// Calls a function that is generic over the reference cell, its number of nodes, its dimension, the
/// dimension of space and the number of strain points, with those of a kind of cell. Cells that must fill space occur in their
/// own dimension only.
macro_rules! with_element {
    ($kind:expr, $space:expr, $function:ident ( $($argument:expr),* )) => {{
        use $crate::elements::basis::*;
        use $crate::elements::mesh::CellKind as Kind;
        match ($kind, $space) {
            (Kind::Segment, 1) => $function::<Segment, 2, 1, 1, 1>($($argument),*),
            (Kind::Segment, 2) => $function::<Segment, 2, 1, 2, 1>($($argument),*),
            (Kind::Segment, _) => $function::<Segment, 2, 1, 3, 1>($($argument),*),
            (Kind::Triangle, 2) => $function::<Triangle, 3, 2, 2, 1>($($argument),*),
            (Kind::Triangle, _) => $function::<Triangle, 3, 2, 3, 1>($($argument),*),
            (Kind::Triangle6, 2) => $function::<Triangle6, 6, 2, 2, 3>($($argument),*),
            (Kind::Triangle6, _) => $function::<Triangle6, 6, 2, 3, 3>($($argument),*),
            (Kind::Triangle7, _) => $function::<Triangle7, 7, 2, 2, 6>($($argument),*),
            (Kind::Quadrilateral, 2) => $function::<Quadrilateral, 4, 2, 2, 4>($($argument),*),
            (Kind::Quadrilateral, _) => $function::<Quadrilateral, 4, 2, 3, 4>($($argument),*),
            (Kind::Quadrilateral9, _) => $function::<Quadrilateral9, 9, 2, 2, 9>($($argument),*),
            (Kind::Tetrahedron, _) => $function::<Tetrahedron, 4, 3, 3, 1>($($argument),*),
            (Kind::Tetrahedron10, _) => $function::<Tetrahedron10, 10, 3, 3, 4>($($argument),*),
            (Kind::Tetrahedron15, _) => $function::<Tetrahedron15, 15, 3, 3, 14>($($argument),*),
            (Kind::Hexahedron, _) => $function::<Hexahedron, 8, 3, 3, 8>($($argument),*),
            (Kind::Hexahedron20, _) => $function::<Hexahedron20, 20, 3, 3, 14>($($argument),*),
            (Kind::Hexahedron27, _) => $function::<Hexahedron27, 27, 3, 3, 27>($($argument),*),
        }
    }};
}
pub(crate) use with_element;

/// A quadrature point for strain, or such points of several cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StrainPoint<T, const N: usize, const M: usize, const D: usize> {
    /// Gradients g_a of the shape functions (1/m), in the coordinates of the cell.
    pub gradients: [[T; M]; N],
    /// Derivative F_0 of the undeformed position by the coordinates of the cell: the identity where the
    /// cell fills space, else its tangent frame.
    pub frame: Matrix<T, D, M>,
    /// Length, area or volume of the point (m, m^2, m^3).
    pub volume: T,
}

/// A quadrature point for inertia: values of the shape functions and volume.
pub(crate) struct MassPoint<const N: usize> {
    pub values: [f64; N],
    pub volume: f64,
}

/// The strain points of the cell with the natural nodal positions `nodes`; none if the map of one of them is not
/// invertible with positive volume.
pub(crate) fn strain_points<
    C: ReferenceCell<N, M>,
    const N: usize,
    const M: usize,
    const D: usize,
>(
    nodes: &[[f64; D]; N],
) -> Option<Vec<StrainPoint<f64, N, M, D>>> {
    let smallest = 1e-12 * size(nodes).powi(M as i32);
    let point = |&(xi, weight): &([f64; M], f64)| {
        let derivatives = C::derivatives(xi).map(SVector::from);
        let (frame, map) = split(&jacobian(nodes, &derivatives));
        let volume = weight * determinant(&map.into());
        match map.try_inverse() {
            Some(inverse) if volume > smallest => Some(StrainPoint {
                gradients: derivatives.map(|derivative| inverse.tr_mul(&derivative).into()),
                frame: frame.into(),
                volume,
            }),
            _ => None,
        }
    };
    C::STIFFNESS_RULE.iter().map(point).collect()
}

/// The mass points of the cell with the natural nodal positions `nodes`.
pub(crate) fn mass_points<
    C: ReferenceCell<N, M>,
    const N: usize,
    const M: usize,
    const D: usize,
>(
    nodes: &[[f64; D]; N],
) -> impl Iterator<Item = MassPoint<N>> {
    C::MASS_RULE.iter().map(move |&(xi, weight)| {
        let (_, map) = split(&jacobian(nodes, &C::derivatives(xi).map(SVector::from)));
        MassPoint { values: C::values(xi), volume: weight * determinant(&map.into()) }
    })
}

/// Derivative of the position by the reference coordinates: sum_a X_a (dN_a/dxi)^T.
fn jacobian<const N: usize, const M: usize, const D: usize>(
    nodes: &[[f64; D]; N],
    derivatives: &[SVector<f64, M>; N],
) -> SMatrix<f64, D, M> {
    let products = nodes.iter().zip(derivatives).map(|(x, d)| SVector::from(*x) * d.transpose());
    products.fold(SMatrix::zeros(), |sum, product| sum + product)
}

/// Splits a Jacobian into an orthonormal frame and the map from reference coordinates to those
/// along the frame. Where the cell fills space the frame is the identity.
fn split<const M: usize, const D: usize>(
    jacobian: &SMatrix<f64, D, M>,
) -> (SMatrix<f64, D, M>, SMatrix<f64, M, M>) {
    if M == D {
        return (SMatrix::identity(), SMatrix::from_fn(|i, j| jacobian[(i, j)]));
    }
    let (mut frame, mut map) = (*jacobian, SMatrix::zeros());
    for k in 0..M {
        for j in 0..k {
            let along = frame.column(j).dot(&frame.column(k));
            map[(j, k)] = along;
            let projection = frame.column(j) * along;
            frame.column_mut(k).zip_apply(&projection, |x, p| *x -= p);
        }
        let length = frame.column(k).norm();
        map[(k, k)] = length;
        if length > 0.0 {
            frame.column_mut(k).unscale_mut(length);
        }
    }
    (frame, map)
}

/// Largest distance of a node from the first one.
fn size<const N: usize, const D: usize>(nodes: &[[f64; D]; N]) -> f64 {
    let first = SVector::from(nodes[0]);
    nodes.iter().map(|&node| (SVector::from(node) - first).norm()).fold(0.0, f64::max)
}

//! Location of a point within a cell.

use nalgebra::{SMatrix, SVector};

use super::{ReferenceCell, jacobian, size, with_element};
use crate::elements::mesh::{CellKind, Mesh};

/// Points outside the reference cell by no more than this, by round-off or because someone rounded them,
/// count as on its boundary.
const TOLERANCE: f64 = 1e-6;
/// Most iterations of Newton's method: it takes one in cells with straight edges, a few in others.
const ROUNDS: usize = 20;

/// The nodes of the cell in which the undeformed position `x` (m) lies, with their shape functions there;
/// `None` outside the body.
pub(crate) fn shares_at(mesh: &Mesh, x: &[f64]) -> Option<Vec<(usize, f64)>> {
    let mut cells = mesh.cells_with_kinds();
    cells.find_map(|(kind, cell)| shares_in((kind, mesh.dimension()), mesh.positions(), cell, x))
}

/// The nodes of a cell of some kind, in a space of some dimension, with their shape functions at the point `x`
/// (m), if nodes are at `positions` (m); `None` outside the cell.
pub(crate) fn shares_in(
    (kind, dimension): (CellKind, usize),
    positions: &[f64],
    cell: &[usize],
    x: &[f64],
) -> Option<Vec<(usize, f64)>> {
    let values = with_element!(kind, dimension, values_at(positions, cell, x))?;
    Some(cell.iter().copied().zip(values).collect())
}

/// The shape functions of a cell with its nodes at `positions` at the point `x`; `None` outside it.
fn values_at<
    C: ReferenceCell<N, M>,
    const N: usize,
    const M: usize,
    const D: usize,
    const Q: usize,
>(
    positions: &[f64],
    cell: &[usize],
    x: &[f64],
) -> Option<Vec<f64>> {
    let positions = positions.as_chunks::<D>().0;
    let nodes: [[f64; D]; N] = std::array::from_fn(|a| positions[cell[a]]);
    let (x, size) = (SVector::<f64, D>::from_column_slice(x), size(&nodes));
    let away = |node: &[f64; D]| (x - SVector::from(*node)).norm();
    if nodes.iter().all(|node| away(node) > 2.0 * size) {
        return None;
    }
    let middle = C::NODES.iter().fold(SVector::zeros(), |sum, xi| sum + SVector::from(*xi));
    let mut xi: SVector<f64, M> = middle / N as f64;
    for _ in 0..ROUNDS {
        let values = C::values(xi.into());
        let there = nodes.iter().zip(values).map(|(node, value)| SVector::from(*node) * value);
        let missing = x - there.fold(SVector::zeros(), |sum, part| sum + part);
        let map = jacobian(&nodes, &C::derivatives(xi.into()).map(SVector::from));
        let square: SMatrix<f64, M, M> = map.tr_mul(&map);
        let step = square.try_inverse()? * map.tr_mul(&missing);
        xi += step;
        if step.norm() < 1e-12 {
            // off a cell of lower dimension than space a residual is left
            let is_on = missing.norm() <= TOLERANCE * size;
            return (is_on && is_within::<C, N, M>(&xi)).then(|| C::values(xi.into()).to_vec());
        }
    }
    None
}

fn is_within<C: ReferenceCell<N, M>, const N: usize, const M: usize>(xi: &SVector<f64, M>) -> bool {
    // only a cube has a corner whose coordinates add up to more than 1
    let reach = C::NODES.iter().map(|node| node.iter().sum::<f64>()).fold(0.0, f64::max);
    let is_cube = reach > 1.0;
    let below = if is_cube { xi.max() <= 1.0 + TOLERANCE } else { xi.sum() <= 1.0 + TOLERANCE };
    xi.min() >= -TOLERANCE && below
}

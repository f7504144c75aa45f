//! The inertia of elements, consistent or lumped.
//!
//! Lumped inertia is row sums, or Hinton's scaled diagonal for quadratic cells. It is another model and not
//! another solver: it lowers frequencies where the consistent one raises them. M acts alike on all axes and
//! is one number per coupled pair of nodes; its factor is that of the nodal matrix, once for each axis.

use super::elements::{ElementsOf, pairs};
use super::regions::{Laws, Regions};
use crate::base::sparse::NodeMatrix;

/// Distribution of the inertia of cells to their nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Inertia {
    /// M as it follows from the shape functions: inertia couples the nodes of a cell.
    #[default]
    Consistent,
    /// All mass in the nodes, so that M is diagonal, which makes explicit methods cheap. The equations are
    /// not the consistent ones, and have lower frequencies; both converge to the same motion when the mesh is
    /// refined.
    ///
    /// Nodes of linear cells get the integrals of their shape functions (row sums). At corners of
    /// quadratic cells those are 0 or below, so nodes of these get the diagonal of the consistent
    /// matrix, scaled to the mass of the cell (E. Hinton, T. Rock, O. C. Zienkiewicz, Earthquake
    /// Eng. Struct. Dyn. 4 (1976) 245-249).
    Lumped,
}

/// Elements as masses.
pub(super) trait Masses {
    /// Adds the inertia of all cells to `matrix`, shared out as `sharing` says, with the `density` (kg/m^3)
    /// of their laws.
    fn add_inertia(
        &self,
        regions: &Regions,
        density: &dyn Fn(&Laws) -> f64,
        sharing: Inertia,
        matrix: &mut NodeMatrix,
    );
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Masses
    for ElementsOf<N, M, D, Q>
{
    fn add_inertia(
        &self,
        regions: &Regions,
        density: &dyn Fn(&Laws) -> f64,
        sharing: Inertia,
        matrix: &mut NodeMatrix,
    ) {
        for (cell, (nodes, products)) in self.nodes.iter().zip(&*self.products).enumerate() {
            let density = density(regions.of(cell));
            let products = match sharing {
                Inertia::Consistent => *products,
                Inertia::Lumped => lumped(products, self.quadratic),
            };
            for (a, b) in pairs::<N>() {
                matrix.add(nodes[a], nodes[b], density * products[a][b]);
            }
        }
    }
}

/// `products` as a diagonal matrix with the same sum: its row sums or, for quadratic cells, whose row sums
/// are 0 or below at corners, its scaled diagonal.
fn lumped<const N: usize>(products: &[[f64; N]; N], quadratic: bool) -> [[f64; N]; N] {
    let row_sums = products.map(|row| row.iter().sum::<f64>());
    let trace: f64 = (0..N).map(|a| products[a][a]).sum();
    let scale = row_sums.iter().sum::<f64>() / trace;
    let mut lumped = [[0.0; N]; N];
    for (a, row) in lumped.iter_mut().enumerate() {
        row[a] = if quadratic { scale * products[a][a] } else { row_sums[a] };
    }
    lumped
}

//! The finite elements of a body: all cells of one kind with their quadrature points.
//!
//! With natural-shape gradients g_a, weights w and H = sum u_a g_a^T, every force of the elements is one
//! loop over these points: -sum w P g_a, with the first Piola stress P that the material's law gives for
//! H (and its rate, if the law is viscous). Tangents are loops over the derivatives of P, likewise.
//!
//! What elements are good for is in chapters: their inertia, forces, tangents and fields.

use super::shares::Shares;
use crate::element::{
    MassPoint, ReferenceCell, StrainPoint, extrapolation, mass_points, strain_points,
};
use crate::input::InputError;
use crate::mesh::Mesh;
use crate::tensor::Matrix;

/// Elements of `N` nodes, dimension `M` and `Q` strain points in a space of dimension `D`.
pub(super) struct ElementsOf<const N: usize, const M: usize, const D: usize, const Q: usize> {
    pub(super) nodes: Vec<[usize; N]>,
    /// Strain points, those of one cell after those of the other; volumes times section.
    points: Vec<StrainPoint<N, M, D>>,
    /// Shape functions at the strain points of a cell.
    pub(super) values: [[f64; N]; Q],
    /// What values at the strain points of a cell count for at each of its nodes.
    pub(super) extrapolation: [[f64; Q]; N],
    /// For each cell, sum w N_a N_b (m^3).
    pub(super) products: Vec<[[f64; N]; N]>,
    pub(super) quadratic: bool,
    pub(super) shares: Shares,
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// The elements on the cells of `mesh`; `section` is the area or thickness of the body.
    pub(super) fn new<C: ReferenceCell<N, M>>(
        mesh: &Mesh,
        section: f64,
    ) -> Result<Self, InputError> {
        const { assert!(C::STIFFNESS_RULE.len() == Q) };
        let positions = mesh.positions().as_chunks::<D>().0;
        let (mut nodes, mut points, mut products) = (Vec::new(), Vec::new(), Vec::new());
        for (number, cell) in mesh.cells().enumerate() {
            let natural: [[f64; D]; N] = std::array::from_fn(|a| positions[cell[a]]);
            let of_cell = strain_points::<C, N, M, D>(&natural)
                .map_err(|volume| bad_cell(number, cell, volume))?;
            points.extend(
                of_cell
                    .into_iter()
                    .map(|point| StrainPoint { volume: section * point.volume, ..point }),
            );
            let mut product = [[0.0; N]; N];
            for MassPoint { values, volume } in mass_points::<C, N, M, D>(&natural) {
                for (a, b) in pairs::<N>() {
                    product[a][b] += section * volume * values[a] * values[b];
                }
            }
            products.push(product);
            nodes.push(std::array::from_fn(|a| cell[a]));
        }
        let values = std::array::from_fn(|q| C::values(C::STIFFNESS_RULE[q].0));
        let quadratic = mesh.kind().is_quadratic();
        let shares = Shares::new(&nodes, mesh.node_count());
        let extrapolation = extrapolation::<C, N, M, Q>();
        Ok(Self { nodes, points, values, extrapolation, products, quadratic, shares })
    }

    /// The strain points of each cell.
    pub(super) fn points(&self) -> &[[StrainPoint<N, M, D>; Q]] {
        self.points.as_chunks::<Q>().0
    }
}

/// H = sum x_a g_a^T, with the vectors x of some nodes and the gradients g of their shape functions.
#[inline(always)]
pub(super) fn gradient<const M: usize, const D: usize>(
    x: &[[f64; D]],
    gradients: &[[f64; M]],
) -> Matrix<f64, D, M> {
    let mut h = [[-0.0; D]; M];
    for (j, column) in h.iter_mut().enumerate() {
        for (x, g) in x.iter().zip(gradients) {
            for i in 0..D {
                column[i] += x[i] * g[j];
            }
        }
    }
    h
}

/// All pairs of the nodes of a cell.
pub(super) fn pairs<const N: usize>() -> impl Iterator<Item = (usize, usize)> {
    (0..N).flat_map(|a| (0..N).map(move |b| (a, b)))
}

fn bad_cell(number: usize, cell: &[usize], volume: f64) -> InputError {
    let nodes: Vec<usize> = cell.iter().map(|node| node + 1).collect();
    let mend = if volume < 0.0 {
        "its nodes run the wrong way round (clockwise, in two dimensions): reverse them"
    } else {
        "it is flat: move its nodes apart or leave the cell out"
    };
    InputError::new(
        format!("signed volume of cell {} (nodes {nodes:?})", number + 1),
        format!("{volume:.3e}"),
        format!("{mend} (numbers count from 1)"),
    )
}

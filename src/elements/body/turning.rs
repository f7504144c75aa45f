//! Steps along which cells rotate.
//!
//! Displacements are straight, rotations are not: a cell that rotates by the angle theta along its velocities is stretched by about theta^2/2. In
//! a slender body, which resists bending far less than stretching, this energy dominates a long step of Newton's method.
//! So a step of displacement gradients dH at the gradient F is applied as one of rates, dH = L F: as a rotation by the skew part W of L
//! and a strain by its symmetric part D:
//!
//! ```text
//! F -> exp(W) (I + D) F
//! ```
//!
//! (the rotation-strain coordinates of J. Huang et al., *Interactive shape interpolation through controllable dynamic deformation*, IEEE
//! Transactions on Visualization and Computer Graphics 17, 2011). These gradients are in general not those of displacements; nearest to
//! them, in the mean square, are those of a Poisson equation. Where cells do not fill space, their normals turn as they do.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::elements::{ElementsOf, gradients};
use super::forces::relative;
use super::tangents::add_blocks;
use crate::base::sparse::BlockMatrix;
use crate::base::tensor::{Matrix, dot};
use crate::elements::material::{Block, Blocks, Deformation};

/// Elements that turn.
pub(super) trait Turning {
    /// Adds the matrix of the Poisson equation, sum w (g_a . g_b) I, to `matrix`.
    fn add_gradients(&self, matrix: &mut BlockMatrix);

    /// Adds its right-hand side, sum w dT g_a, to `right`: dT is by how much gradients that turn differ from those of the straight
    /// `step` (m) from displacements `u` (m). Returns the largest turn (rad).
    fn add_turned(&self, u: &[f64], step: &[f64], right: &mut [f64]) -> f64;
}

/// w (g_a . g_b) I
struct Products<'a, const N: usize, const M: usize> {
    gradients: &'a [[f64; M]; N],
    weight: f64,
}

impl<const N: usize, const M: usize, const D: usize> Blocks<f64, D> for Products<'_, N, M> {
    fn block(&self, a: usize, b: usize) -> Block<f64, D> {
        let product = self.weight * dot(&self.gradients[a], &self.gradients[b]);
        let mut block = [[0.0; D]; D];
        (0..D).for_each(|i| block[i][i] = product);
        block
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Turning
    for ElementsOf<N, M, D, Q>
{
    fn add_gradients(&self, matrix: &mut BlockMatrix) {
        let mut rows = matrix.rows_mut::<D>();
        for (cell, entries) in self.entries.iter().enumerate() {
            for point in self.points(cell) {
                let products = Products { gradients: &point.gradients, weight: point.volume };
                add_blocks(entries, &mut rows, &products);
            }
        }
    }

    fn add_turned(&self, u: &[f64], step: &[f64], right: &mut [f64]) -> f64 {
        let fields = [u, step].map(|field| field.as_chunks::<D>().0);
        let right = right.as_chunks_mut::<D>().0;
        let mut most: f64 = 0.0;
        for (cell, nodes) in self.nodes.iter().enumerate() {
            let x = fields.map(|field| relative(nodes, field));
            for point in self.points(cell) {
                let [h, change] = gradients(1, &x, &point.gradients);
                let at = Deformation::new(point.frame, h);
                let (excess, angle) = excess(padded(&at.gradient()), padded(&change), M);
                most = most.max(angle);
                for (node, gradient) in nodes.iter().zip(&point.gradients) {
                    for i in 0..D {
                        let pull: f64 = (0..M).map(|j| excess[(i, j)] * gradient[j]).sum();
                        right[*node][i] += point.volume * pull;
                    }
                }
            }
        }
        most
    }
}

fn padded<const M: usize, const D: usize>(matrix: &Matrix<f64, D, M>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| if i < D && j < M { matrix[j][i] } else { 0.0 })
}

/// Difference of the rotating gradient from F + dH in a cell of `dimension`, and the rotation angle (rad); zeros where the cell has no
/// extent.
fn excess(f: Matrix3<f64>, change: Matrix3<f64>, dimension: usize) -> (Matrix3<f64>, f64) {
    let mut square = f.tr_mul(&f);
    (dimension..3).for_each(|j| square[(j, j)] = 1.0);
    let Some(inverse) = square.try_inverse() else { return (Matrix3::zeros(), 0.0) };
    let inverse = inverse * f.transpose();
    let along = change * inverse;
    let rate = along - along.tr_mul(&(Matrix3::identity() - f * inverse));
    let skew = 0.5 * (rate - rate.transpose());
    let axis = Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)]);
    let turned = Rotation3::from_scaled_axis(axis).matrix() * (f + (rate - skew) * f);
    (turned - f - change, axis.norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rigid turns become rotations, and strains stay as straight steps have them: in cells that fill space, and in
    /// surfaces.
    #[test]
    fn turns_are_rotations() {
        let f = Matrix3::new(1.1, 0.2, -0.1, 0.3, 0.9, 0.2, 0.0, -0.2, 1.3);
        let axis = Vector3::new(0.7, -0.4, 0.9);
        let strain = Matrix3::new(0.2, 0.1, 0.0, 0.1, -0.1, 0.05, 0.0, 0.05, 0.3);
        for dimension in [2, 3] {
            let mut f = f;
            (dimension..3).for_each(|j| f.column_mut(j).fill(0.0));
            let change = axis.cross_matrix() * f;
            let (more, angle) = excess(f, change, dimension);
            let turned = Rotation3::from_scaled_axis(axis).matrix() * f;
            assert!((f + change + more - turned).norm() < 1e-14, "{dimension}: {more}");
            assert!((angle - axis.norm()).abs() < 1e-14, "{dimension}: {angle}");
        }
        let (more, angle) = excess(f, strain * f, 3);
        assert!(more.norm() < 1e-14 && angle < 1e-14, "{more}");
    }
}

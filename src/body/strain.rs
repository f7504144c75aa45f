//! Strain and stress at one point of a cell. All inlined: they are what the loop over cells is made of.

use nalgebra::SMatrix;

use crate::element::{StrainPoint, determinant};
use crate::material::Lame;

/// H = sum x_a g_a^T, with x the displacements or velocities of all nodes.
#[inline]
pub(super) fn gradient<const N: usize, const M: usize, const D: usize>(
    point: &StrainPoint<N, M, D>,
    nodes: &[usize; N],
    x: &[[f64; D]],
) -> SMatrix<f64, D, M> {
    let mut h = SMatrix::zeros();
    for (node, g) in nodes.iter().zip(&point.gradients) {
        for i in 0..D {
            for j in 0..M {
                h[(i, j)] += x[*node][i] * g[j];
            }
        }
    }
    h
}

/// E = sym(F_0^T H)
#[inline]
pub(super) fn cauchy_strain<const N: usize, const M: usize, const D: usize>(
    point: &StrainPoint<N, M, D>,
    h: &SMatrix<f64, D, M>,
) -> SMatrix<f64, M, M> {
    symmetric_part(&point.frame.tr_mul(h))
}

/// E = sym(F_0^T H) + H^T H / 2: as precise for small strains as for large ones.
#[inline]
pub(super) fn green_strain<const N: usize, const M: usize, const D: usize>(
    point: &StrainPoint<N, M, D>,
    h: &SMatrix<f64, D, M>,
) -> SMatrix<f64, M, M> {
    cauchy_strain(point, h) + h.tr_mul(h) * 0.5
}

/// (A + A^T) / 2
#[inline]
pub(super) fn symmetric_part<const M: usize>(matrix: &SMatrix<f64, M, M>) -> SMatrix<f64, M, M> {
    (matrix + matrix.transpose()) * 0.5
}

/// lambda tr(E) I + 2 mu E
#[inline]
pub(super) fn stress<const M: usize>(
    lame: Lame,
    strain: &SMatrix<f64, M, M>,
) -> SMatrix<f64, M, M> {
    SMatrix::identity() * (lame.lambda * strain.trace()) + strain * (2.0 * lame.mu)
}

/// lambda tr(E)^2 / 2 + mu E : E
#[inline]
pub(super) fn energy_density<const M: usize>(lame: Lame, strain: &SMatrix<f64, M, M>) -> f64 {
    let trace = strain.trace();
    0.5 * lame.lambda * trace * trace + lame.mu * strain.norm_squared()
}

/// Factor by which F stretches a volume: det F, or its size where the cell does not fill space.
#[inline]
pub(super) fn stretch_of<const M: usize, const D: usize>(f: &SMatrix<f64, D, M>) -> f64 {
    match M == D {
        true => determinant(&SMatrix::<f64, M, M>::from_fn(|i, j| f[(i, j)])),
        false => determinant(&f.tr_mul(f)).sqrt(),
    }
}

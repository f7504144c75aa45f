//! Stress and elasticity in the coordinates of a cell, and the tangent that follows from them for any law.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use super::law::{Block, Blocks};
use crate::base::tensor::{Matrix, Real, dot, product, times};

/// Largest number of components of a symmetric tensor of a cell: the diagonal and the upper triangle.
const PAIRS: usize = 6;

/// The axes of each component; cells of `M` dimensions have the first M (M + 1) / 2 of them.
pub(crate) const fn axes<const M: usize>(component: usize) -> (usize, usize) {
    const PLANE: [(usize, usize); 3] = [(0, 0), (1, 1), (0, 1)];
    const SPACE: [(usize, usize); PAIRS] = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)];
    match M {
        1 | 2 => PLANE[component],
        _ => SPACE[component],
    }
}

/// dS/dE: an entry for each pair of components of symmetric tensors.
pub(crate) type Elasticity<T> = [[T; PAIRS]; PAIRS];

/// Stress at a point of a cell of dimension `M`, and its derivative by the strain.
pub(crate) struct Response<T, const M: usize> {
    /// Second Piola stress S (Pa).
    pub(crate) stress: Matrix<T, M, M>,
    /// dS/dE (Pa), with minor and major symmetry.
    pub(crate) elasticity: Elasticity<T>,
}

/// sum B_a^T (dS/dE) B_b + (g_a . S g_b) I, with the change B_a of the strain by node a.
pub(crate) struct Tangent<'a, T, const N: usize, const M: usize, const D: usize> {
    gradients: &'a [[T; M]; N],
    /// B_a, by components of strain, those off the diagonal twice.
    strains: [[[T; D]; PAIRS]; N],
    /// (dS/dE) B_a
    stresses: [[[T; D]; PAIRS]; N],
    /// S g_a
    pulls: [[T; M]; N],
    weight: T,
}

impl<'a, T: Real, const N: usize, const M: usize, const D: usize> Tangent<'a, T, N, M, D> {
    /// That of a point with the deformation gradient `f` and the `gradients` of the shape functions, times
    /// `weight`.
    #[inline(always)]
    pub(crate) fn new(
        f: &Matrix<T, D, M>,
        response: &Response<T, M>,
        gradients: &'a [[T; M]; N],
        weight: T,
    ) -> Self {
        let zero = weight.constant(0.0);
        let mut strains = [[[zero; D]; PAIRS]; N];
        let mut stresses = strains;
        for a in 0..N {
            for v in 0..M * (M + 1) / 2 {
                let (j, l) = axes::<M>(v);
                for i in 0..D {
                    strains[a][v][i] = match j == l {
                        true => f[j][i] * gradients[a][j],
                        false => f[j][i] * gradients[a][l] + f[l][i] * gradients[a][j],
                    };
                }
            }
            for v in 0..M * (M + 1) / 2 {
                for i in 0..D {
                    let mut sum = response.elasticity[v][0] * strains[a][0][i];
                    for w in 1..M * (M + 1) / 2 {
                        sum += response.elasticity[v][w] * strains[a][w][i];
                    }
                    stresses[a][v][i] = sum;
                }
            }
        }
        Self { gradients, strains, stresses, pulls: product(&response.stress, gradients), weight }
    }
}

impl<T: Real, const N: usize, const M: usize, const D: usize> Blocks<T, D>
    for Tangent<'_, T, N, M, D>
{
    #[inline(always)]
    fn block(&self, a: usize, b: usize) -> Block<T, D> {
        let (strain, stress) = (&self.strains[a], &self.stresses[b]);
        let geometric = dot(&self.gradients[a], &self.pulls[b]);
        let mut block = [[geometric; D]; D];
        for i in 0..D {
            for k in 0..D {
                let mut sum = strain[0][i] * stress[0][k];
                for v in 1..M * (M + 1) / 2 {
                    sum += strain[v][i] * stress[v][k];
                }
                block[i][k] = match i == k {
                    true => sum + geometric,
                    false => sum,
                };
            }
        }
        times(block, self.weight)
    }
}

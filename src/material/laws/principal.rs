//! Principal stretches of a point and their directions, and how a law of the stretches resists a change of strain.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use nalgebra::{Const, DimDiff, DimSub, Matrix2, Matrix3, OMatrix, SymmetricEigen, U1};

use crate::material::response::{Elasticity, Response, axes};
use crate::tensor::{Matrix, Real, symmetric};

/// Principal stretches of a point of a cell of dimension `M`.
pub(crate) struct Principal<T, const M: usize> {
    /// Logarithms of the stretches: along the cell and across it.
    pub(super) logarithms: [T; 3],
    /// Unit vectors along the cell.
    directions: [[T; M]; M],
}

impl<T: Real, const M: usize> Principal<T, M> {
    /// From the logarithms and, one after the other, the components of the directions.
    #[inline(always)]
    pub(super) fn new(found: [T; 12]) -> Self {
        let [x, y, z, ..] = found;
        let mut directions = [[x; M]; M];
        for i in 0..M {
            for j in 0..M {
                directions[i][j] = found[3 + M * i + j];
            }
        }
        Self { logarithms: [x, y, z], directions }
    }

    /// What `of` makes of the logarithms and of `pull`, if there is one.
    #[inline(always)]
    pub(super) fn each_with<const O: usize>(
        &self,
        pull: Option<T>,
        of: impl Fn([f64; 3], Option<f64>) -> [f64; O],
    ) -> [T; O] {
        let [x, y, z] = self.logarithms;
        match pull {
            None => T::each([x, y, z], |x| of(x, None)),
            Some(pull) => T::each([x, y, z, pull], |[x, y, z, pull]| of([x, y, z], Some(pull))),
        }
    }

    /// The tensor along the cell that has these principal values.
    #[inline(always)]
    pub(super) fn tensor(&self, values: &[T; 3]) -> Matrix<T, M, M> {
        let n = &self.directions;
        symmetric!(values[0]; j, k => {
            let mut sum = values[0] * n[0][j] * n[0][k];
            for i in 1..M {
                sum += values[i] * n[i][j] * n[i][k];
            }
            sum
        })
    }

    /// The response that has these [numbers](Slopes::numbers) in its principal directions.
    #[inline(always)]
    pub(super) fn response(&self, numbers: [T; 15]) -> Response<T, M> {
        let zero = numbers[0].constant(0.0);
        let n = &self.directions;
        let mut elasticity: Elasticity<T> = [[zero; 6]; 6];
        for v in 0..M * (M + 1) / 2 {
            let (j, l) = axes::<M>(v);
            for w in 0..=v {
                let (p, q) = axes::<M>(w);
                let mut sum = zero;
                for a in 0..M {
                    for b in 0..M {
                        let square = n[a][j] * n[a][l] * n[b][p] * n[b][q];
                        sum += numbers[3 + 3 * a + b] * square;
                    }
                }
                // of the pair (a, b), by the direction that is left
                for a in 0..M {
                    for b in 0..a {
                        let left = n[a][j] * n[b][l] + n[a][l] * n[b][j];
                        let right = n[a][p] * n[b][q] + n[a][q] * n[b][p];
                        sum += numbers[12 + 3 - a - b] * 0.5 * left * right;
                    }
                }
                elasticity[v][w] = sum;
                elasticity[w][v] = sum;
            }
        }
        let [x, y, z, ..] = numbers;
        Response { stress: self.tensor(&[x, y, z]), elasticity }
    }
}

/// Second Piola stress S and its derivatives, in principal directions.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Slopes {
    /// S_i (Pa)
    pub(super) stress: [f64; 3],
    /// dS_i/dE_j (Pa)
    pub(super) normal: [[f64; 3]; 3],
    /// (S_j - S_k) / (E_j - E_k) of the two directions beside each (Pa)
    pub(super) shear: [f64; 3],
}

impl Slopes {
    /// Lets the section of a cell of dimension `M` follow, so that no stress comes up across it.
    pub(super) fn free_across<const M: usize>(&mut self) {
        let own: f64 = self.normal[2][M..].iter().sum();
        let by_along = self.normal[2];
        for i in 0..M {
            let across: f64 = self.normal[i][M..].iter().sum();
            for j in 0..M {
                self.normal[i][j] -= across * by_along[j] / own;
            }
        }
    }

    /// All of them, one after the other.
    pub(super) fn numbers(self) -> [f64; 15] {
        let mut numbers = [0.0; 15];
        numbers[..3].copy_from_slice(&self.stress);
        numbers[3..12].copy_from_slice(self.normal.as_flattened());
        numbers[12..].copy_from_slice(&self.shear);
        numbers
    }
}

/// Logarithms of the principal stretches along a cell of dimension `M` with these numbers of 2 E, column by column, and the unit
/// vectors of their directions; NaN where there are none.
#[inline(never)]
pub(super) fn directions_of<const M: usize>(twice: [f64; 9]) -> ([f64; 3], [f64; 9]) {
    let mut x = [0.0; 3];
    let mut directions = [0.0; 9];
    directions[0] = 1.0;
    match M {
        1 => x[0] = twice[0],
        2 => eigen(Matrix2::from_column_slice(&twice[..4]), &mut x, &mut directions),
        _ => eigen(Matrix3::from_column_slice(&twice), &mut x, &mut directions),
    }
    for x in &mut x[..M] {
        *x = 0.5 * x.ln_1p();
    }
    (x, directions)
}

fn eigen<const M: usize>(
    matrix: OMatrix<f64, Const<M>, Const<M>>,
    values: &mut [f64; 3],
    vectors: &mut [f64; 9],
) where
    Const<M>: DimSub<U1> + nalgebra::DimName,
    nalgebra::DefaultAllocator: nalgebra::allocator::Allocator<Const<M>, Const<M>>
        + nalgebra::allocator::Allocator<Const<M>>
        + nalgebra::allocator::Allocator<DimDiff<Const<M>, U1>>,
    OMatrix<f64, Const<M>, Const<M>>: Copy,
{
    /// QR steps: a few a direction are enough.
    const MOST: usize = 100;
    match SymmetricEigen::try_new(matrix, f64::EPSILON, MOST) {
        Some(found) => {
            values[..M].copy_from_slice(found.eigenvalues.as_slice());
            vectors[..M * M].copy_from_slice(found.eigenvectors.as_slice());
        }
        None => values[..M].fill(f64::NAN),
    }
}

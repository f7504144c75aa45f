//! Principal strains of a point and their directions, and the response of a law of the stretches to a change
//! of strain.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use crate::base::tensor::{Matrix, Real, symmetric};
use crate::elements::material::response::{Elasticity, Response, axes};

/// The strain of a point of a cell of dimension `M`, in principal directions.
pub(crate) struct Principal<T, const M: usize> {
    /// Principal values of 2E: along the cell and across it.
    pub(super) twice: [T; 3],
    /// Unit vectors along the cell.
    directions: [[T; M]; M],
}

impl<T: Real, const M: usize> Principal<T, M> {
    /// Those of a point with `twice` the strain along the cell; `across` gives 2E across it from that along
    /// it.
    #[inline(always)]
    pub(super) fn new(twice: Matrix<T, M, M>, across: impl Fn([f64; 3]) -> f64) -> Self {
        let (along, directions) = principal_of(twice);
        let zero = twice[0][0].constant(0.0);
        let mut values = [zero; 3];
        values[..M].copy_from_slice(&along);
        if M < 3 {
            let [of_all] = T::each(values, |values| [across(values)]);
            for i in M..3 {
                values[i] = of_all;
            }
        }
        Self { twice: values, directions }
    }

    /// The values of `of`, applied lane by lane to the principal values and to `pull`, if there is one.
    #[inline(always)]
    pub(super) fn each_with<const O: usize>(
        &self,
        pull: Option<T>,
        of: impl Fn([f64; 3], Option<f64>) -> [f64; O],
    ) -> [T; O] {
        let [x, y, z] = self.twice;
        match pull {
            None => T::each([x, y, z], |twice| of(twice, None)),
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
                // of the pair (a, b), stored under the third direction
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
    /// (S_j - S_k) / (E_j - E_k) of the two directions other than each (Pa)
    pub(super) shear: [f64; 3],
}

impl Slopes {
    /// Lets the section of a cell of dimension `M` change with the strain along it, so that there is no
    /// stress across it.
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

/// Sweeps of Jacobi's method, one rotation about each axis, after which a symmetric matrix is diagonal to the
/// last digit: each doubles the correct digits.
const ROUNDS: usize = 6;

/// Principal values and directions of a symmetric matrix, by Jacobi's method: the same work for all matrices,
/// so that several are computed at once.
#[inline(always)]
fn principal_of<T: Real, const M: usize>(mut a: Matrix<T, M, M>) -> ([T; M], Matrix<T, M, M>) {
    let zero = a[0][0].constant(0.0);
    let one = a[0][0].constant(1.0);
    let mut n = [[zero; M]; M];
    for i in 0..M {
        n[i][i] = one;
    }
    for _ in 0..ROUNDS {
        for p in 0..M {
            for q in p + 1..M {
                // the tangent t of the smaller angle that makes a_pq vanish; 0 if a_pq is 0
                let apart = a[q][q] - a[p][p];
                let twice = a[p][q] * 2.0;
                let sign = apart.sign();
                let whole = apart * sign + (apart * apart + twice * twice).sqrt();
                let t = twice * sign / (whole + f64::MIN_POSITIVE);
                let cos = one / (t * t + 1.0).sqrt();
                let sin = t * cos;
                a[p][p] = a[p][p] - t * a[p][q];
                a[q][q] += t * a[p][q];
                a[p][q] = zero;
                a[q][p] = zero;
                for r in 0..M {
                    if r != p && r != q {
                        let (left, right) = (a[p][r], a[q][r]);
                        a[p][r] = cos * left - sin * right;
                        a[q][r] = sin * left + cos * right;
                        a[r][p] = a[p][r];
                        a[r][q] = a[q][r];
                    }
                    let (left, right) = (n[p][r], n[q][r]);
                    n[p][r] = cos * left - sin * right;
                    n[q][r] = sin * left + cos * right;
                }
            }
        }
    }
    let mut values = [zero; M];
    for i in 0..M {
        values[i] = a[i][i];
    }
    (values, n)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, SymmetricEigen};

    use super::*;

    /// Against nalgebra's, with values far apart, alike, in pairs, and of any size: to the last digits of the
    /// largest one.
    #[test]
    fn principal_values_and_directions() {
        let turn = nalgebra::Rotation3::new(nalgebra::Vector3::new(0.7, -1.1, 0.9));
        let turn = turn.matrix();
        for values in [
            [1.0, 2.0, 3.0],
            [2.0, 2.0, 2.0],
            [1.0, 1.0, 5.0],
            [1.0, 1.0 + 1e-9, -0.5],
            [1e-8, -2e-8, 1e-9],
            [1e8, 1.0, 1e-8],
            [0.0; 3],
        ] {
            let matrix = turn * Matrix3::from_diagonal(&values.into()) * turn.transpose();
            let matrix = (matrix + matrix.transpose()) * 0.5;
            let size = matrix.norm();
            let (mut found, n) = principal_of(<[[f64; 3]; 3]>::from(matrix));
            for (value, n) in found.iter().zip(&n) {
                let n = nalgebra::Vector3::from(*n);
                assert!((n.norm() - 1.0).abs() < 1e-15 * 8.0, "{values:?}: {}", n.norm());
                assert!((matrix * n - n * *value).norm() <= 4e-16 * 8.0 * size, "{values:?}");
            }
            let mut expected = SymmetricEigen::new(matrix).eigenvalues;
            found.sort_by(f64::total_cmp);
            expected.as_mut_slice().sort_by(f64::total_cmp);
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() <= 4e-16 * 8.0 * size, "{values:?}");
            }
        }
    }
}

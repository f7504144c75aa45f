//! LU factors of a dense matrix, with the operations of SUNDIALS' dense linear solver in their order: the same digits. With 8 unknowns a
//! solution takes half its instructions.

/// The row exchanges of a factorization. The factors are in place of the matrix, column by column.
pub(super) struct DenseFactors {
    pivots: Vec<usize>,
}

impl DenseFactors {
    /// For `n` unknowns.
    pub(super) fn new(n: usize) -> Self {
        Self { pivots: vec![0; n] }
    }

    /// Number of unknowns.
    pub(super) fn n(&self) -> usize {
        self.pivots.len()
    }

    /// Replaces a matrix by its factors, with the largest entry of each column as pivot; `false` if one is zero.
    pub(super) fn factorize(&mut self, matrix: &mut [f64]) -> bool {
        let n = self.n();
        for k in 0..n {
            let column = &matrix[k * n..(k + 1) * n];
            let mut pivot = k;
            for i in k + 1..n {
                if column[i].abs() > column[pivot].abs() {
                    pivot = i;
                }
            }
            self.pivots[k] = pivot;
            if column[pivot] == 0.0 {
                return false;
            }
            if pivot != k {
                for j in 0..n {
                    matrix.swap(j * n + k, j * n + pivot);
                }
            }
            let (before, after) = matrix.split_at_mut((k + 1) * n);
            let below = &mut before[k * n..];
            let inverse = 1.0 / below[k];
            let below = &mut below[k + 1..];
            below.iter_mut().for_each(|entry| *entry *= inverse);
            for column in after.chunks_exact_mut(n) {
                let (above, rest) = column.split_at_mut(k + 1);
                let factor = above[k];
                if factor != 0.0 {
                    subtract(rest, factor, below);
                }
            }
        }
        true
    }

    /// Replaces `b` by the solution, by the factors of a matrix.
    pub(super) fn solve(&self, factors: &[f64], b: &mut [f64]) {
        let n = self.n();
        for (k, &pivot) in self.pivots.iter().enumerate() {
            b.swap(k, pivot);
        }
        for (k, column) in factors.chunks_exact(n).enumerate() {
            let (above, below) = b.split_at_mut(k + 1);
            subtract(below, above[k], &column[k + 1..]);
        }
        for (k, column) in factors.chunks_exact(n).enumerate().rev() {
            let (above, below) = b.split_at_mut(k);
            below[0] /= column[k];
            subtract(above, below[0], &column[..k]);
        }
    }
}

/// x - factor y
fn subtract(x: &mut [f64], factor: f64, y: &[f64]) {
    x.iter_mut().zip(y).for_each(|(x, y)| *x -= y * factor);
}

#[cfg(test)]
mod tests {
    use super::{
        super::{context::Context, ffi, vector::Vector},
        *,
    };
    use crate::base::vector::noise;

    /// Factors and solutions are those of `SUNLinSol_Dense` to the last bit, with row exchanges, zeros above the diagonal and without; a
    /// singular matrix is reported by both.
    #[test]
    fn digits_are_those_of_sundials() {
        let context = Context::new().unwrap();
        for n in [1, 2, 3, 8, 17, 40] {
            for zeros in [0, 2, 3] {
                let mut matrix = noise(n * n, 1 + zeros);
                let vanish = (0..n * n).filter(|k| zeros > 0 && k % (zeros + 1) == 1);
                vanish.for_each(|k| matrix[k] = 0.0);
                let b = Vector::from_slice(&noise(n, 7), &context).unwrap();
                let mut ours = b.as_slice().to_vec();
                // SAFETY: matrix, solver and vector are alive and fit together.
                let (code, factors) = unsafe {
                    let theirs = ffi::SUNDenseMatrix(n as i64, n as i64, context.raw());
                    let data = ffi::SUNDenseMatrix_Data(theirs);
                    let data = std::slice::from_raw_parts_mut(data, n * n);
                    data.copy_from_slice(&matrix);
                    let solver = ffi::SUNLinSol_Dense(b.raw(), theirs, context.raw());
                    let code = ffi::SUNLinSolSetup(solver, theirs);
                    if code == 0 {
                        ffi::SUNLinSolSolve(solver, theirs, b.raw(), b.raw(), 0.0);
                    }
                    let factors = data.to_vec();
                    ffi::SUNLinSolFree(solver);
                    ffi::SUNMatDestroy(theirs);
                    (code, factors)
                };
                let mut own = DenseFactors::new(n);
                assert_eq!(own.factorize(&mut matrix), code == 0, "{n} {zeros}");
                assert_eq!(matrix, factors, "{n} {zeros}");
                if code == 0 {
                    own.solve(&matrix, &mut ours);
                    assert_eq!(ours, b.as_slice(), "{n} {zeros}");
                }
            }
        }
        assert!(!DenseFactors::new(2).factorize(&mut [1.0, 2.0, 2.0, 4.0]));
    }
}

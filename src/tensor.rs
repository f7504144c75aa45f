//! Numbers and small dense matrices: what the formulas at one point of a cell are written in.
//!
//! Sums begin with -0, the zero that changes nothing it is added to, so that the compiler leaves out
//! their first addition. Loops, and not `map` or `from_fn` of arrays, which it does not always inline.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use std::ops::{Add, AddAssign, Mul, Sub};

/// A real number: `f64`, or a lane of several that are computed at once.
pub(crate) trait Real:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + AddAssign
{
    /// The square root.
    fn sqrt(self) -> Self;
}

impl Real for f64 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
}

/// A matrix of `R` rows and `C` columns, column by column.
pub(crate) type Matrix<T, const R: usize, const C: usize> = [[T; R]; C];

/// a . b
#[inline(always)]
pub(crate) fn dot<T: Real, const D: usize>(a: &[T; D], b: &[T; D]) -> T {
    (0..D).fold(T::from(-0.0), |sum, i| sum + a[i] * b[i])
}

/// A x
#[inline(always)]
pub(crate) fn apply<T: Real, const R: usize, const C: usize>(
    a: &Matrix<T, R, C>,
    x: &[T; C],
) -> [T; R] {
    let mut y = [T::from(-0.0); R];
    for k in 0..C {
        (0..R).for_each(|i| y[i] += a[k][i] * x[k]);
    }
    y
}

/// A B, or A x of several vectors x.
#[inline(always)]
pub(crate) fn product<T: Real, const R: usize, const K: usize, const C: usize>(
    a: &Matrix<T, R, K>,
    b: &[[T; K]; C],
) -> Matrix<T, R, C> {
    let mut product = [[T::from(-0.0); R]; C];
    (0..C).for_each(|j| product[j] = apply(a, &b[j]));
    product
}

/// A, every entry times `factor`
#[inline(always)]
pub(crate) fn times<T: Real, const R: usize, const C: usize>(
    mut a: Matrix<T, R, C>,
    factor: T,
) -> Matrix<T, R, C> {
    for column in &mut a {
        for entry in column {
            *entry = *entry * factor;
        }
    }
    a
}

/// A B^T
#[inline(always)]
pub(crate) fn product_transposed<T: Real, const R: usize, const K: usize, const C: usize>(
    a: &Matrix<T, R, K>,
    b: &Matrix<T, C, K>,
) -> Matrix<T, R, C> {
    let mut product = [[T::from(-0.0); R]; C];
    for j in 0..C {
        for k in 0..K {
            (0..R).for_each(|i| product[j][i] += a[k][i] * b[k][j]);
        }
    }
    product
}

/// The symmetric matrix with `entry` at each row and column not beyond it.
#[inline(always)]
pub(crate) fn symmetric<T: Real, const M: usize>(
    entry: impl Fn(usize, usize) -> T,
) -> Matrix<T, M, M> {
    let mut matrix = [[T::from(0.0); M]; M];
    for j in 0..M {
        for k in 0..=j {
            matrix[j][k] = entry(j, k);
            matrix[k][j] = matrix[j][k];
        }
    }
    matrix
}

/// Sum of the diagonal.
#[inline(always)]
pub(crate) fn trace<T: Real, const M: usize>(matrix: &Matrix<T, M, M>) -> T {
    (0..M).fold(T::from(-0.0), |sum, j| sum + matrix[j][j])
}

/// Determinant of a matrix of at most 3 rows.
#[inline(always)]
pub(crate) fn determinant<T: Real, const M: usize>(matrix: &Matrix<T, M, M>) -> T {
    let m = |i: usize, j: usize| matrix[j][i];
    match M {
        1 => m(0, 0),
        2 => m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0),
        _ => {
            m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1))
                - m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0))
                + m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0))
        }
    }
}

//! Numbers and small dense matrices, in which the formulas at one point of a cell are written.
//!
//! Loops and no closures: a function that is not inlined loses the SIMD instructions.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use std::ops::{Add, AddAssign, Div, Mul, Sub};

use pulp::NullaryFnOnce;

/// A real number: `f64`, or one for each of several cells, computed at once.
pub(crate) trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
{
    /// The square root.
    fn sqrt(self) -> Self;

    /// -1 where it is below 0, else 1.
    fn sign(self) -> Self;

    /// A constant, as a number of this kind.
    fn constant(self, number: f64) -> Self;

    /// The function `f` of some numbers, for each cell by itself.
    fn each<const I: usize, const O: usize>(
        numbers: [Self; I],
        f: impl Fn([f64; I]) -> [f64; O],
    ) -> [Self; O];

    /// The result of `formula`, in a function that is not inlined: compiled once, however many call it.
    fn apart<F: NullaryFnOnce>(self, formula: F) -> F::Output;
}

impl Real for f64 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn sign(self) -> Self {
        if self < 0.0 { -1.0 } else { 1.0 }
    }

    #[inline(always)]
    fn constant(self, number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn each<const I: usize, const O: usize>(
        numbers: [Self; I],
        f: impl Fn([f64; I]) -> [f64; O],
    ) -> [Self; O] {
        f(numbers)
    }

    #[inline(never)]
    fn apart<F: NullaryFnOnce>(self, formula: F) -> F::Output {
        formula.call()
    }
}

/// x^(-1/3) for x above 0, otherwise an arbitrary number.
#[inline(always)]
pub(crate) fn inverse_cube_root<T: Real>(x: T) -> T {
    // minus a third of the bits, and so of the exponent: 3.5 % off at most
    let [mut root] = T::each([x], |[x]| [f64::from_bits(0x553e_f000_0000_0000 - x.to_bits() / 3)]);
    // Newton's method doubles the digits
    for _ in 0..4 {
        root = root * (x * root * root * root * -1.0 + 4.0) * (1.0 / 3.0);
    }
    root
}

/// A matrix of `R` rows and `C` columns, column by column.
pub(crate) type Matrix<T, const R: usize, const C: usize> = [[T; R]; C];

/// a . b
#[inline(always)]
pub(crate) fn dot<T: Real, const D: usize>(a: &[T; D], b: &[T; D]) -> T {
    let mut sum = a[0] * b[0];
    for i in 1..D {
        sum += a[i] * b[i];
    }
    sum
}

/// A x
#[inline(always)]
pub(crate) fn apply<T: Real, const R: usize, const C: usize>(
    a: &Matrix<T, R, C>,
    x: &[T; C],
) -> [T; R] {
    // arbitrary numbers, which are all replaced
    let mut y = a[0];
    for i in 0..R {
        y[i] = a[0][i] * x[0];
        for k in 1..C {
            y[i] += a[k][i] * x[k];
        }
    }
    y
}

/// A B, or A x of several vectors x.
#[inline(always)]
pub(crate) fn product<T: Real, const R: usize, const K: usize, const C: usize>(
    a: &Matrix<T, R, K>,
    b: &[[T; K]; C],
) -> Matrix<T, R, C> {
    let mut product = [a[0]; C];
    for j in 0..C {
        product[j] = apply(a, &b[j]);
    }
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
    let mut product = [a[0]; C];
    for j in 0..C {
        for i in 0..R {
            product[j][i] = a[0][i] * b[0][j];
            for k in 1..K {
                product[j][i] += a[k][i] * b[k][j];
            }
        }
    }
    product
}

/// The symmetric matrix with `entry` at each pair k <= j, of the same kind of numbers as `like`. (A macro, as
/// a closure cannot be forced to be inlined.)
macro_rules! symmetric {
    ($like:expr; $j:ident, $k:ident => $entry:expr) => {{
        let mut matrix = [[$like; M]; M];
        for $j in 0..M {
            for $k in 0..=$j {
                matrix[$j][$k] = $entry;
                matrix[$k][$j] = matrix[$j][$k];
            }
        }
        matrix
    }};
}
pub(crate) use symmetric;

/// Sum of the diagonal.
#[inline(always)]
pub(crate) fn trace<T: Real, const M: usize>(matrix: &Matrix<T, M, M>) -> T {
    let mut sum = matrix[0][0];
    for j in 1..M {
        sum += matrix[j][j];
    }
    sum
}

/// Determinant of a matrix of at most 3 rows.
#[inline(always)]
pub(crate) fn determinant<T: Real, const M: usize>(matrix: &Matrix<T, M, M>) -> T {
    match M {
        1 => matrix[0][0],
        2 => matrix[0][0] * matrix[1][1] - matrix[1][0] * matrix[0][1],
        _ => {
            matrix[0][0] * (matrix[1][1] * matrix[2][2] - matrix[2][1] * matrix[1][2])
                - matrix[1][0] * (matrix[0][1] * matrix[2][2] - matrix[2][1] * matrix[0][2])
                + matrix[2][0] * (matrix[0][1] * matrix[1][2] - matrix[1][1] * matrix[0][2])
        }
    }
}

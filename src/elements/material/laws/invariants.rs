//! The strain of a point by its invariants: with the strain across the cell, and so that small strains keep
//! their digits.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use crate::base::tensor::{Matrix, Real, inverse_cube_root, symmetric, trace};

/// The strain of a point, with that across the cell.
pub(crate) struct Strained<T, const M: usize> {
    /// G along the cell.
    pub(super) along: Matrix<T, M, M>,
    /// G across it, in 3 - M directions; 0 of solids.
    pub(super) across: T,
    /// C^-1 along the cell and across it.
    pub(super) inverse: Matrix<T, M, M>,
    pub(super) inverse_across: T,
    /// Invariants of G: its trace, the sum of its principal minors, its determinant.
    pub(super) invariants: [T; 3],
    /// J^2 - 1
    pub(super) swelling: T,
    /// J^(-2/3)
    pub(super) shrink: T,
}

/// Directions across a cell of dimension `M`.
pub(super) const fn directions<const M: usize>() -> f64 {
    (3 - M) as f64
}

impl<T: Real, const M: usize> Strained<T, M> {
    #[inline(always)]
    pub(super) fn new(along: Matrix<T, M, M>, across: T) -> Self {
        let m = directions::<M>();
        let [trace, minors, determinant] = invariants_of(&along);
        let area = trace + minors + determinant;
        let mut invariants = [trace, minors, determinant];
        let mut swelling = area;
        if M < 3 {
            invariants[0] = trace + across * m;
            invariants[1] = minors + across * trace * m;
            invariants[2] = across * minors;
            swelling = area + across + area * across;
        }
        if M == 1 {
            invariants[1] += across * across;
            invariants[2] = across * across * trace;
            swelling = swelling + across + swelling * across;
        }
        let inverse = inverse_of(&along, area + 1.0);
        let one = across.constant(1.0);
        let inverse_across = one / (across + 1.0);
        let shrink = inverse_cube_root(swelling + 1.0);
        Self { along, across, inverse, inverse_across, invariants, swelling, shrink }
    }

    /// J
    #[inline(always)]
    pub(super) fn stretch(&self) -> T {
        (self.swelling + 1.0).sqrt()
    }

    /// [`above_rest`] of this point.
    #[inline(always)]
    pub(super) fn above_rest(&self) -> [T; 2] {
        above_rest(self.invariants, self.swelling, self.shrink)
    }

    /// C (whose trace is tr(G) + 3) times the derivative of I1 by C, over J^(-2/3), for the component
    /// g = `of` of G on the diagonal: g - tr(G) / 3.
    #[inline(always)]
    pub(super) fn first_slope(&self, of: T) -> T {
        of - self.invariants[0] * (1.0 / 3.0)
    }

    /// The same for I2 over J^(-4/3), with the square of that component of G.
    #[inline(always)]
    pub(super) fn second_slope(&self, of: T, square: T) -> T {
        let [trace, minors, _] = self.invariants;
        (trace + 1.0) * of - square - (trace + minors * 2.0) * (1.0 / 3.0)
    }
}

/// I1 - 3 and I2 - 3 of J^(-2/3) C, the deformation without its change of volume, by the `invariants` of C - I, J^2 - 1 and
/// J^(-2/3): as differences of terms of second order, so that they keep their digits.
#[inline(always)]
pub(super) fn above_rest<T: Real>(invariants: [T; 3], swelling: T, shrink: T) -> [T; 2] {
    let [g, minors, determinant] = invariants;
    let one = g.constant(1.0);
    // s = J^(2/3), and s - 1 = (s^3 - 1) / (1 + s + s^2)
    let s = shrink * shrink * (swelling + 1.0);
    let whole = s * s + s + 1.0;
    let more = swelling / whole;
    let first = g * more * (s + 2.0) - (minors + determinant) * 3.0;
    let second = g * more * (s * 2.0 + 1.0) + minors * (s * (s + -2.0) + -2.0)
        - determinant * (s + 1.0) * 3.0;
    let share = one / whole * shrink;
    [first * share, second * share * shrink]
}

/// Trace, sum of the principal minors and determinant of a symmetric matrix; those that a matrix is too small
/// for are 0.
#[inline(always)]
pub(super) fn invariants_of<T: Real, const M: usize>(g: &Matrix<T, M, M>) -> [T; 3] {
    let zero = g[0][0].constant(0.0);
    match M {
        1 => [g[0][0], zero, zero],
        2 => [trace(g), minor(g, 0, 1), zero],
        _ => {
            let minors = minor(g, 0, 1) + minor(g, 0, 2) + minor(g, 1, 2);
            [trace(g), minors, crate::base::tensor::determinant(g)]
        }
    }
}

#[inline(always)]
fn minor<T: Real, const M: usize>(g: &Matrix<T, M, M>, j: usize, k: usize) -> T {
    g[j][j] * g[k][k] - g[j][k] * g[j][k]
}

/// C^-1 of C = I + G, which has the determinant `area`.
#[inline(always)]
pub(super) fn inverse_of<T: Real, const M: usize>(g: &Matrix<T, M, M>, area: T) -> Matrix<T, M, M> {
    let one = area.constant(1.0);
    let share = one / area;
    let mut c = *g;
    for j in 0..M {
        c[j][j] = c[j][j] + 1.0;
    }
    symmetric!(one; j, k => match (M, j == k) {
        (1, _) => share,
        (2, true) => c[1 - j][1 - j] * share,
        (2, false) => c[j][k] * share * -1.0,
        _ => {
            let (j1, j2, k1, k2) = ((j + 1) % M, (j + 2) % M, (k + 1) % M, (k + 2) % M);
            (c[j1][k1] * c[j2][k2] - c[j1][k2] * c[j2][k1]) * share
        }
    })
}

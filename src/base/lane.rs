//! Numbers of several cells, or of several components of vectors, computed at once in one SIMD register.
//!
//! Arithmetic on a lane acts on each of its numbers, in the same order and without fused operations, so that
//! results are the same to the last bit as those of one cell after the other, on any machine.
//!
//! A number of a lane is a number of the register and not an array of eight: from arrays the compiler makes
//! loops over cells again, in the wrong direction.

use std::ops::{Add, AddAssign, Div, Mul, Sub};

use pulp::{NullaryFnOnce, Simd, WithSimd};

use crate::base::tensor::Real;

/// Cells that are kept side by side: as many as there are numbers in the widest register.
pub(crate) const SIDE_BY_SIDE: usize = 8;

/// One number for each of [`SIDE_BY_SIDE`] cells, in memory.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Packed(pub(crate) [f64; SIDE_BY_SIDE]);

/// One number for each of as many cells as a register of the machine holds.
#[derive(Clone, Copy)]
pub(crate) struct Lane<S: Simd> {
    simd: S,
    numbers: S::f64s,
}

impl<S: Simd> Lane<S> {
    /// Part `part` of the numbers, counted in registers.
    #[inline(always)]
    pub(crate) fn load(simd: S, numbers: &[f64], part: usize) -> Self {
        Self { simd, numbers: S::as_simd_f64s(numbers).0[part] }
    }

    /// The same number for all cells.
    #[inline(always)]
    pub(crate) fn splat(simd: S, number: f64) -> Self {
        Self { simd, numbers: simd.splat_f64s(number) }
    }

    /// Writes the numbers to part `part` of `out`, counted in registers.
    #[inline(always)]
    pub(crate) fn store(self, out: &mut [f64], part: usize) {
        S::as_mut_simd_f64s(out).0[part] = self.numbers;
    }

    /// Whether all of them are above 0, which NaN is not.
    #[inline(always)]
    pub(crate) fn are_positive(self) -> bool {
        let Self { simd, numbers } = self;
        let positive = simd.less_than_f64s(simd.splat_f64s(0.0), numbers);
        simd.first_true_m64s(simd.not_m64s(positive)) == S::F64_LANES
    }
}

macro_rules! by_number {
    ($operation:ident, $method:ident, $of_simd:ident) => {
        impl<S: Simd> $operation for Lane<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let numbers = self.simd.$of_simd(self.numbers, other.numbers);
                Self { simd: self.simd, numbers }
            }
        }

        impl<S: Simd> $operation<f64> for Lane<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.$method(Self::splat(self.simd, other))
            }
        }
    };
}

by_number!(Add, add, add_f64s);
by_number!(Sub, sub, sub_f64s);
by_number!(Mul, mul, mul_f64s);
by_number!(Div, div, div_f64s);

impl<S: Simd> AddAssign for Lane<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> Real for Lane<S> {
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { simd: self.simd, numbers: self.simd.sqrt_f64s(self.numbers) }
    }

    #[inline(always)]
    fn sign(self) -> Self {
        let Self { simd, numbers } = self;
        let is_below = simd.less_than_f64s(numbers, simd.splat_f64s(0.0));
        let numbers = simd.select_f64s(is_below, simd.splat_f64s(-1.0), simd.splat_f64s(1.0));
        Self { simd, numbers }
    }

    #[inline(always)]
    fn constant(self, number: f64) -> Self {
        Self::splat(self.simd, number)
    }

    #[inline(always)]
    fn each<const I: usize, const O: usize>(
        numbers: [Self; I],
        f: impl Fn([f64; I]) -> [f64; O],
    ) -> [Self; O] {
        let simd = numbers[0].simd;
        let mut given = [Packed([0.0; SIDE_BY_SIDE]); I];
        for i in 0..I {
            numbers[i].store(&mut given[i].0, 0);
        }
        let mut made = [Packed([0.0; SIDE_BY_SIDE]); O];
        for lane in 0..S::F64_LANES {
            let mut of_lane = [0.0; I];
            for i in 0..I {
                of_lane[i] = given[i].0[lane];
            }
            let of_lane = f(of_lane);
            for o in 0..O {
                made[o].0[lane] = of_lane[o];
            }
        }
        let mut results = [Self::splat(simd, 0.0); O];
        for o in 0..O {
            results[o] = Self::load(simd, &made[o].0, 0);
        }
        results
    }

    /// Called through `vectorize`: otherwise it would be compiled for the oldest supported processor.
    #[inline(never)]
    fn apart<F: NullaryFnOnce>(self, formula: F) -> F::Output {
        struct Vectorized<F>(F);
        impl<F: NullaryFnOnce> WithSimd for Vectorized<F> {
            type Output = F::Output;

            #[inline(always)]
            fn with_simd<S: Simd>(self, _: S) -> F::Output {
                self.0.call()
            }
        }
        self.simd.vectorize(Vectorized(formula))
    }
}

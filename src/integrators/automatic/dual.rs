//! Numbers with their derivatives along some directions (forward differentiation).
//!
//! A. Griewank, A. Walther, "Evaluating Derivatives" (SIAM 2008), section 3.2. The numbers of the crate `num-dual`, whose slopes may be absent, take five
//! times as long (`docs/notes/integrators.md`).

use std::{
    array,
    cmp::Ordering,
    ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign},
};

use super::number::Number;

/// A value, and its slopes along N directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dual<const N: usize> {
    pub(super) value: f64,
    pub(super) slopes: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// A function of this number and another one, from its value and its derivatives by both.
    #[inline(always)]
    fn with(self, other: Self, value: f64, [by_self, by_other]: [f64; 2]) -> Self {
        let slope = |k: usize| by_self * self.slopes[k] + by_other * other.slopes[k];
        Self { value, slopes: array::from_fn(slope) }
    }
}

impl<const N: usize> Number for Dual<N> {
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn function(self, value: f64, slope: f64) -> Self {
        Self { value, slopes: self.slopes.map(|own| slope * own) }
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { value, slopes: [0.0; N] }
    }
}

impl<const N: usize> PartialEq for Dual<N> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<const N: usize> PartialOrd for Dual<N> {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl<const N: usize> PartialEq<f64> for Dual<N> {
    fn eq(&self, other: &f64) -> bool {
        self.value == *other
    }
}

impl<const N: usize> PartialOrd<f64> for Dual<N> {
    #[inline(always)]
    fn partial_cmp(&self, other: &f64) -> Option<Ordering> {
        self.value.partial_cmp(other)
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.function(-self.value, -1.0)
    }
}

/// An operator of two numbers x and y, or of a number and a constant: its value and its derivatives by both.
macro_rules! operator {
    ($($operator:ident $method:ident, $assign:ident $by:ident:
       $x:ident $y:ident -> $value:expr, $by_x:expr, $by_y:expr;)*) => {
        $(
            impl<const N: usize> $operator for Dual<N> {
                type Output = Self;

                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    let ($x, $y) = (self.value, other.value);
                    self.with(other, $value, [$by_x, $by_y])
                }
            }

            impl<const N: usize> $operator<f64> for Dual<N> {
                type Output = Self;

                #[inline(always)]
                fn $method(self, $y: f64) -> Self {
                    let $x = self.value;
                    self.function($value, $by_x)
                }
            }

            impl<const N: usize> $assign for Dual<N> {
                #[inline(always)]
                fn $by(&mut self, other: Self) {
                    *self = $operator::$method(*self, other);
                }
            }

            impl<const N: usize> $assign<f64> for Dual<N> {
                #[inline(always)]
                fn $by(&mut self, other: f64) {
                    *self = $operator::$method(*self, other);
                }
            }
        )*
    };
}

operator! {
    Add add, AddAssign add_assign: x y -> x + y, 1.0, 1.0;
    Sub sub, SubAssign sub_assign: x y -> x - y, 1.0, -1.0;
    Mul mul, MulAssign mul_assign: x y -> x * y, y, x;
    Div div, DivAssign div_assign: x y -> x / y, 1.0 / y, -x / (y * y);
}

//! Numbers that equations may be written over.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number: `f64`, or one that carries derivatives along.
///
/// Constants stand on the right (`y[0] * 2.0`) or are made a number by `T::from(2.0)`. Numbers compare by their values; at a kink, as of
/// [`abs`](Self::abs), the derivative is that of one side.
pub trait Number:
    Copy
    + PartialOrd
    + PartialOrd<f64>
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + AddAssign<f64>
    + SubAssign<f64>
    + MulAssign<f64>
    + DivAssign<f64>
{
    /// Its value, without derivatives.
    fn value(self) -> f64;

    /// A function of this number, from its value and its derivative there: the chain rule, for functions that are not among those below.
    #[must_use]
    fn function(self, value: f64, slope: f64) -> Self;

    /// 1 / x
    #[must_use]
    fn recip(self) -> Self {
        let value = self.value().recip();
        self.function(value, -value * value)
    }

    /// The square root.
    #[must_use]
    fn sqrt(self) -> Self {
        let value = self.value().sqrt();
        self.function(value, 0.5 / value)
    }

    /// The cube root.
    #[must_use]
    fn cbrt(self) -> Self {
        let value = self.value().cbrt();
        self.function(value, 1.0 / (3.0 * value * value))
    }

    /// x to the power of a whole number.
    #[must_use]
    fn powi(self, n: i32) -> Self {
        let slope = if n == 0 { 0.0 } else { f64::from(n) * self.value().powi(n - 1) };
        self.function(self.value().powi(n), slope)
    }

    /// x to the power of a constant.
    #[must_use]
    fn powf(self, n: f64) -> Self {
        let slope = if n == 0.0 { 0.0 } else { n * self.value().powf(n - 1.0) };
        self.function(self.value().powf(n), slope)
    }

    /// e to the power of x.
    #[must_use]
    fn exp(self) -> Self {
        let value = self.value().exp();
        self.function(value, value)
    }

    /// e to the power of x, less 1: accurate near 0.
    #[must_use]
    fn exp_m1(self) -> Self {
        self.function(self.value().exp_m1(), self.value().exp())
    }

    /// The natural logarithm.
    #[must_use]
    fn ln(self) -> Self {
        self.function(self.value().ln(), self.value().recip())
    }

    /// The natural logarithm of 1 + x: accurate near 0.
    #[must_use]
    fn ln_1p(self) -> Self {
        self.function(self.value().ln_1p(), (1.0 + self.value()).recip())
    }

    /// The sine of an angle in radians.
    #[must_use]
    fn sin(self) -> Self {
        self.function(self.value().sin(), self.value().cos())
    }

    /// The cosine.
    #[must_use]
    fn cos(self) -> Self {
        self.function(self.value().cos(), -self.value().sin())
    }

    /// The tangent.
    #[must_use]
    fn tan(self) -> Self {
        let value = self.value().tan();
        self.function(value, 1.0 + value * value)
    }

    /// The angle in radians whose sine is x.
    #[must_use]
    fn asin(self) -> Self {
        let x = self.value();
        self.function(x.asin(), (1.0 - x * x).sqrt().recip())
    }

    /// The angle whose cosine is x.
    #[must_use]
    fn acos(self) -> Self {
        let x = self.value();
        self.function(x.acos(), -(1.0 - x * x).sqrt().recip())
    }

    /// The angle whose tangent is x.
    #[must_use]
    fn atan(self) -> Self {
        let x = self.value();
        self.function(x.atan(), (1.0 + x * x).recip())
    }

    /// The hyperbolic sine.
    #[must_use]
    fn sinh(self) -> Self {
        self.function(self.value().sinh(), self.value().cosh())
    }

    /// The hyperbolic cosine.
    #[must_use]
    fn cosh(self) -> Self {
        self.function(self.value().cosh(), self.value().sinh())
    }

    /// The hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self {
        let value = self.value().tanh();
        self.function(value, 1.0 - value * value)
    }

    /// The number whose hyperbolic sine is x.
    #[must_use]
    fn asinh(self) -> Self {
        let x = self.value();
        self.function(x.asinh(), 1.0_f64.hypot(x).recip())
    }

    /// The absolute value; at 0 with the derivative 1.
    #[must_use]
    fn abs(self) -> Self {
        if self.value().is_sign_negative() { -self } else { self }
    }

    /// The larger of two numbers; this one if they are equal.
    #[must_use]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    /// The smaller of two numbers; this one if they are equal.
    #[must_use]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    /// x to the power of another number, of a positive x.
    #[must_use]
    fn pow(self, exponent: Self) -> Self {
        (self.ln() * exponent).exp()
    }

    /// sqrt(x^2 + y^2), without overflow.
    #[must_use]
    fn hypot(self, other: Self) -> Self {
        let (x, y) = (self.value(), other.value());
        let length = x.hypot(y);
        self.function(length, x / length) + other.function(0.0, y / length)
    }

    /// The angle of the point (x, this number) from the x axis, in radians.
    #[must_use]
    fn atan2(self, x: Self) -> Self {
        let (y, squares) = (self.value(), self.value().powi(2) + x.value().powi(2));
        self.function(y.atan2(x.value()), x.value() / squares) + x.function(0.0, -y / squares)
    }
}

impl Number for f64 {
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }

    #[inline(always)]
    fn function(self, value: f64, _slope: f64) -> Self {
        value
    }
}

//! Bounds on a formula over a span of time, by interval arithmetic.
//!
//! Moore, Kearfott and Cloud, *Introduction to Interval Analysis*, chapters 2 and 5. Bounds hold for all times of the span,
//! however short what a formula does in it; they are wider than its range where a formula contains t several times,
//! by less and less on shorter spans.

use std::f64::consts::{PI, TAU};

use super::{DEEPEST, Formula, Operator, Step};

/// Lower and upper bound; not numbers where the formula is undefined on all of a span.
pub(crate) type Bounds = [f64; 2];

const ALL: Bounds = [f64::NEG_INFINITY, f64::INFINITY];
const UNDEFINED: Bounds = [f64::NAN; 2];

/// Round-off of one operation, in parts of its result: values of functions are correct to a few units in the last place.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

impl Formula {
    /// Bounds on its values at the times `span` (s, ascending).
    pub(crate) fn bounds(&self, span: [f64; 2]) -> Bounds {
        let mut stack = [[0.0; 2]; DEEPEST];
        let mut n = 0;
        for step in &self.steps {
            match step {
                Step::Number(x) => {
                    stack[n] = [*x; 2];
                    n += 1;
                }
                Step::Time => {
                    stack[n] = span;
                    n += 1;
                }
                Step::Negative => stack[n - 1] = negative(stack[n - 1]),
                Step::Operator(operator) => {
                    n -= 1;
                    stack[n - 1] = combined(stack[n - 1], *operator, stack[n]);
                }
                Step::Function(function) if matches!(function.name, "min" | "max") => {
                    n -= 1;
                    let choose = if function.name == "min" { f64::min } else { f64::max };
                    let (a, b) = (stack[n - 1], stack[n]);
                    let defined = !(a[0].is_nan() || b[0].is_nan());
                    stack[n - 1] =
                        if defined { [0, 1].map(|k| choose(a[k], b[k])) } else { UNDEFINED };
                }
                Step::Function(function) => stack[n - 1] = through(function.name, stack[n - 1]),
            }
        }
        stack[0]
    }
}

/// The same, wide enough for round-off.
fn rounded([low, high]: Bounds) -> Bounds {
    [low - ROUND_OFF * low.abs(), high + ROUND_OFF * high.abs()].map(|x| {
        // infinity less a part of it
        if x.is_nan() && !low.is_nan() && !high.is_nan() { f64::INFINITY } else { x }
    })
}

fn negative([low, high]: Bounds) -> Bounds {
    [-high, -low]
}

/// Bounds on numbers among which are the least and the largest of an operation.
fn hull(corners: impl IntoIterator<Item = f64>) -> Bounds {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    let all = corners.into_iter().fold(start, |[low, high], x| [low.min(x), high.max(x)]);
    if all[0] > all[1] { UNDEFINED } else { all }
}

fn combined(a: Bounds, operator: Operator, b: Bounds) -> Bounds {
    if a[0].is_nan() || b[0].is_nan() {
        return UNDEFINED;
    }
    let product = |x: f64, y: f64| if x == 0.0 || y == 0.0 { 0.0 } else { x * y };
    let times = |b: Bounds| {
        let corners = a.map(|x| b.map(|y| product(x, y)));
        hull(corners.into_iter().flatten())
    };
    rounded(match operator {
        Operator::Add => [a[0] + b[0], a[1] + b[1]],
        Operator::Subtract => [a[0] - b[1], a[1] - b[0]],
        Operator::Multiply => times(b),
        Operator::Divide if b[0] < 0.0 && b[1] > 0.0 => ALL,
        Operator::Divide => times(match b {
            [0.0, 0.0] => return UNDEFINED,
            [low, 0.0] => [f64::NEG_INFINITY, low.recip()],
            [0.0, high] => [high.recip(), f64::INFINITY],
            [low, high] => [high.recip(), low.recip()],
        }),
        Operator::Power => power(a, b),
    })
}

fn power(base: Bounds, exponent: Bounds) -> Bounds {
    let corners = |base: Bounds| hull(base.into_iter().flat_map(|x| exponent.map(|y| x.powf(y))));
    if base[0] >= 0.0 {
        return corners(base);
    }
    let n = exponent[0];
    let is_whole = exponent[1] == n && n.fract() == 0.0;
    match is_whole {
        true if base[1] > 0.0 && n < 0.0 => ALL,
        true if base[1] > 0.0 && n % 2.0 == 0.0 => {
            [if n == 0.0 { 1.0 } else { 0.0 }, corners(base)[1]]
        }
        true => corners(base),
        // powers of negative numbers are undefined
        false if exponent[1] == n && base[1] < 0.0 => UNDEFINED,
        false if exponent[1] == n => corners([0.0, base[1]]),
        false => ALL,
    }
}

/// Bounds on a function of one number; a function that is not known here has none.
fn through(name: &str, [low, high]: Bounds) -> Bounds {
    if low.is_nan() {
        return UNDEFINED;
    }
    let rising = |f: fn(f64) -> f64, [from, to]: Bounds| {
        let within = [low.max(from), high.min(to)];
        if within[0] > within[1] { UNDEFINED } else { within.map(f) }
    };
    let even = |f: fn(f64) -> f64| {
        let largest = f(low.abs().max(high.abs()));
        let least = if low <= 0.0 && high >= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
        [f(least), largest]
    };
    // not a number between infinities
    let is_longer = |period: f64| high - low >= period || (high - low).is_nan();
    // whether `at` or a time that lies periods after it is among the arguments
    let meets = |at: f64, period: f64| at + ((low - at) / period).ceil() * period <= high;
    let wave = |f: fn(f64) -> f64, top: f64| {
        if is_longer(TAU) {
            return [-1.0, 1.0];
        }
        let ends = hull([f(low), f(high)]);
        let least = if meets(top + PI, TAU) { -1.0 } else { ends[0] };
        [least, if meets(top, TAU) { 1.0 } else { ends[1] }]
    };
    let positive = [0.0, f64::INFINITY];
    rounded(match name {
        "sin" => wave(f64::sin, 0.5 * PI),
        "cos" => wave(f64::cos, 0.0),
        "tan" if is_longer(PI) || meets(0.5 * PI, PI) => ALL,
        "tan" => [low.tan(), high.tan()],
        "asin" => rising(f64::asin, [-1.0, 1.0]),
        "acos" => negative(rising(|x| -x.acos(), [-1.0, 1.0])),
        "atan" => rising(f64::atan, ALL),
        "sinh" => rising(f64::sinh, ALL),
        "cosh" => even(f64::cosh),
        "tanh" => rising(f64::tanh, ALL),
        "exp" => rising(f64::exp, ALL),
        "ln" => rising(f64::ln, positive),
        "log10" => rising(f64::log10, positive),
        "sqrt" => rising(f64::sqrt, positive),
        "abs" => even(f64::abs),
        "step" => rising(|x| f64::from(x >= 0.0), ALL),
        _ => ALL,
    })
}

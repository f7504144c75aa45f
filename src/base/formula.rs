//! Formulas of time, as a person writes them: `2000 * sin(2*pi*3*t)`.
//!
//! Numbers, `t` (s), `pi`, `e`, `+ - * / ^`, parentheses and the functions of [`FUNCTIONS`], with the
//! precedence of mathematics: `-t^2` is -(t^2), `2^3^2` is 2^9. Each evaluation gives the first and second
//! derivatives by t too, by the rules of differentiation applied to numbers (truncated Taylor series;
//! Griewank and Walther, *Evaluating Derivatives*, chapter 13), and allocates nothing.

mod enclosure;
mod kinks;
mod parse;
#[cfg(test)]
mod tests;

use std::fmt;

pub(crate) use enclosure::Bounds;

use crate::base::input::InputError;

/// A formula, ready to be evaluated.
#[derive(Clone)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(into = "String", try_from = "String"))]
pub(crate) struct Formula {
    text: String,
    /// In postfix order.
    steps: Vec<Step>,
}

#[derive(Clone, Copy)]
enum Step {
    Number(f64),
    Time,
    Negative,
    Operator(Operator),
    Function(&'static Function),
}

#[derive(Clone, Copy, PartialEq)]
enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

/// A value with its first and second derivatives by t.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Jet(pub(crate) [f64; 3]);

/// A function that a formula can call.
struct Function {
    name: &'static str,
    rule: Rule,
}

enum Rule {
    /// f, f' and f'' at a point; smooth where it is defined.
    Smooth(fn(f64) -> [f64; 3]),
    /// The same, with a kink.
    Kinked(fn(f64) -> [f64; 3]),
    /// Whether the first of two arguments is selected.
    Choice(fn(f64, f64) -> bool),
}

use Rule::{Choice, Kinked, Smooth};

static FUNCTIONS: [Function; 17] = [
    Function { name: "sin", rule: Smooth(|x| [x.sin(), x.cos(), -x.sin()]) },
    Function { name: "cos", rule: Smooth(|x| [x.cos(), -x.sin(), -x.cos()]) },
    Function {
        name: "tan",
        rule: Smooth(|x| {
            let (y, slope) = (x.tan(), x.cos().powi(-2));
            [y, slope, 2.0 * y * slope]
        }),
    },
    Function {
        name: "asin",
        rule: Smooth(|x| {
            let slope = (1.0 - x * x).sqrt().recip();
            [x.asin(), slope, x * slope.powi(3)]
        }),
    },
    Function {
        name: "acos",
        rule: Smooth(|x| {
            let slope = (1.0 - x * x).sqrt().recip();
            [x.acos(), -slope, -x * slope.powi(3)]
        }),
    },
    Function {
        name: "atan",
        rule: Smooth(|x| {
            let slope = (1.0 + x * x).recip();
            [x.atan(), slope, -2.0 * x * slope * slope]
        }),
    },
    Function { name: "sinh", rule: Smooth(|x| [x.sinh(), x.cosh(), x.sinh()]) },
    Function { name: "cosh", rule: Smooth(|x| [x.cosh(), x.sinh(), x.cosh()]) },
    Function {
        name: "tanh",
        rule: Smooth(|x| {
            let y = x.tanh();
            let slope = 1.0 - y * y;
            [y, slope, -2.0 * y * slope]
        }),
    },
    Function { name: "exp", rule: Smooth(|x| [x.exp(); 3]) },
    Function { name: "ln", rule: Smooth(|x| [x.ln(), x.recip(), -x.powi(-2)]) },
    Function {
        name: "log10",
        rule: Smooth(|x| {
            let scale = std::f64::consts::LOG10_E;
            [x.log10(), scale / x, -scale * x.powi(-2)]
        }),
    },
    Function {
        name: "sqrt",
        rule: Smooth(|x| {
            let y = x.sqrt();
            [y, 0.5 / y, -0.25 / (x * y)]
        }),
    },
    Function { name: "abs", rule: Kinked(|x| [x.abs(), x.signum(), 0.0]) },
    // 0 for arguments below 0, 1 from 0 on
    Function { name: "step", rule: Kinked(|x| [f64::from(x >= 0.0), 0.0, 0.0]) },
    Function { name: "min", rule: Choice(|a, b| a <= b || a.is_nan()) },
    Function { name: "max", rule: Choice(|a, b| a >= b || a.is_nan()) },
];

/// Largest number of operands that wait for an operator, and deepest nesting of parentheses.
const DEEPEST: usize = 32;

impl Formula {
    /// The formula as it was written.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// The first function in it that has a kink, if there is one.
    fn kink(&self) -> Option<&'static str> {
        self.steps.iter().find_map(|step| match step {
            Step::Function(Function { name, rule: Kinked(_) | Choice(_) }) => Some(*name),
            _ => None,
        })
    }

    /// Checks that it can describe a path: that its derivatives exist.
    pub(crate) fn check_smooth(&self) -> Result<(), InputError> {
        self.kink().map_or(Ok(()), |name| {
            let help = format!(
                "{name} has no velocity at its kink: give a smooth formula, or a path through points"
            );
            Err(InputError::new("path", self.text(), help))
        })
    }

    /// Its value at time `t` (s), with its derivatives.
    pub(crate) fn at(&self, t: f64) -> Jet {
        let mut stack = [Jet::constant(0.0); DEEPEST];
        // number of operands on the stack; parsing has made sure that there are enough, and not too many
        let mut n = 0;
        for step in &self.steps {
            match step {
                Step::Number(x) => {
                    stack[n] = Jet::constant(*x);
                    n += 1;
                }
                Step::Time => {
                    stack[n] = Jet([t, 1.0, 0.0]);
                    n += 1;
                }
                Step::Negative => stack[n - 1] = stack[n - 1].scaled(-1.0),
                Step::Operator(operator) => {
                    n -= 1;
                    stack[n - 1] = stack[n - 1].with(*operator, stack[n]);
                }
                Step::Function(function) => match function.rule {
                    Smooth(rule) | Kinked(rule) => {
                        stack[n - 1] = stack[n - 1].through(rule(stack[n - 1].0[0]));
                    }
                    Choice(first) => {
                        n -= 1;
                        if !first(stack[n - 1].0[0], stack[n].0[0]) {
                            stack[n - 1] = stack[n];
                        }
                    }
                },
            }
        }
        stack[0]
    }
}

#[cfg(feature = "checkpoint")]
impl From<Formula> for String {
    fn from(formula: Formula) -> Self {
        formula.text
    }
}

#[cfg(feature = "checkpoint")]
impl TryFrom<String> for Formula {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        Self::parse(&text)
    }
}

impl fmt::Debug for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "formula {:?}", self.text)
    }
}

impl Jet {
    fn constant(x: f64) -> Self {
        Self([x, 0.0, 0.0])
    }

    fn scaled(self, by: f64) -> Self {
        Self(self.0.map(|x| by * x))
    }

    fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }

    fn times(self, other: Self) -> Self {
        let (Self([a, a1, a2]), Self([b, b1, b2])) = (self, other);
        Self([a * b, a1 * b + a * b1, a2 * b + 2.0 * a1 * b1 + a * b2])
    }

    /// f of this number by the chain rule, given f, f' and f'' at its value.
    fn through(self, [f, slope, bend]: [f64; 3]) -> Self {
        let Self([_, first, second]) = self;
        // the derivatives of a constant are 0, even where those of f are infinite
        let times = |by: f64, x: f64| if x == 0.0 { 0.0 } else { by * x };
        Self([f, times(slope, first), times(bend, first * first) + times(slope, second)])
    }

    fn with(self, operator: Operator, other: Self) -> Self {
        match operator {
            Operator::Add => self.plus(other),
            Operator::Subtract => self.plus(other.scaled(-1.0)),
            Operator::Multiply => self.times(other),
            Operator::Divide => {
                let (Self([a, ..]), Self([b, ..])) = (self, other);
                let Self(mut quotient) =
                    self.times(other.through([b.recip(), -b.powi(-2), 2.0 * b.powi(-3)]));
                // correctly rounded
                quotient[0] = a / b;
                Self(quotient)
            }
            Operator::Power => self.power(other),
        }
    }

    fn power(self, exponent: Self) -> Self {
        let (Self([a, ..]), Self([b, first, second])) = (self, exponent);
        let value = a.powf(b);
        if first == 0.0 && second == 0.0 {
            let part = |factor: f64, b: f64| if factor == 0.0 { 0.0 } else { factor * a.powf(b) };
            return self.through([value, part(b, b - 1.0), part(b * (b - 1.0), b - 2.0)]);
        }
        let logarithm = exponent.times(self.through([a.ln(), a.recip(), -a.powi(-2)]));
        logarithm.through([value; 3])
    }
}

//! Formulas of time, as a person writes them: `2000 * sin(2*pi*3*t)`.
//!
//! Numbers, `t` (s), `pi`, `e`, `+ - * / ^`, parentheses and the functions of [`FUNCTIONS`], with the
//! precedence of mathematics: `-t^2` is -(t^2), `2^3^2` is 2^9. Each evaluation gives the first and second
//! derivatives by t too, by the rules of differentiation applied to numbers (truncated Taylor series;
//! Griewank and Walther, *Evaluating Derivatives*, chapter 13), and allocates nothing.

use std::fmt;

use crate::base::input::{InputError, unknown};

/// A formula, ready to be evaluated.
#[derive(Clone)]
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
    /// # Errors
    /// What is wrong with the text, and where.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut parser = Parser { text, at: 0, depth: 0, steps: Vec::new() };
        parser.sum()?;
        if parser.peek().is_some() {
            return Err(parser.problem("expected an operator (+ - * / ^) or the end"));
        }
        let formula = Self { text: text.to_owned(), steps: parser.steps };
        let mut waiting = 0_usize;
        for step in &formula.steps {
            match step {
                Step::Number(_) | Step::Time => waiting += 1,
                Step::Operator(_) => waiting -= 1,
                Step::Function(function) if matches!(function.rule, Choice(_)) => waiting -= 1,
                Step::Negative | Step::Function(_) => {}
            }
            if waiting > DEEPEST {
                return Err(format!("more than {DEEPEST} numbers wait for each other: divide it"));
            }
        }
        Ok(formula)
    }

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

/// Reads by recursive descent.
struct Parser<'a> {
    text: &'a str,
    /// Number of bytes read so far.
    at: usize,
    /// Number of open parentheses, and of signs and powers whose operand is not complete.
    depth: usize,
    steps: Vec<Step>,
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// The next character that is not a space.
    fn peek(&mut self) -> Option<char> {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
        self.rest().chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    fn problem(&mut self, help: &str) -> String {
        let column = self.text[..self.at].chars().count() + 1;
        match self.peek() {
            Some(found) => format!("{help}, found '{found}' at character {column}"),
            None => format!("{help}, found the end"),
        }
    }

    /// Goes one level down.
    fn nested(&mut self, read: impl FnOnce(&mut Self) -> Result<(), String>) -> Result<(), String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("it is nested more than {DEEPEST} deep: divide it"));
        }
        read(self)?;
        self.depth -= 1;
        Ok(())
    }

    /// term + term - ...
    fn sum(&mut self) -> Result<(), String> {
        self.row(&[('+', Operator::Add), ('-', Operator::Subtract)], Self::product)
    }

    /// factor * factor / ...
    fn product(&mut self) -> Result<(), String> {
        self.row(&[('*', Operator::Multiply), ('/', Operator::Divide)], Self::signed)
    }

    fn row(
        &mut self,
        operators: &[(char, Operator)],
        part: fn(&mut Self) -> Result<(), String>,
    ) -> Result<(), String> {
        part(self)?;
        while let Some((_, operator)) = operators.iter().find(|(sign, _)| self.take(*sign)) {
            part(self)?;
            self.steps.push(Step::Operator(*operator));
        }
        Ok(())
    }

    /// -power, +power or a power: a power binds tighter than a sign before it.
    fn signed(&mut self) -> Result<(), String> {
        if self.take('-') {
            self.nested(Self::signed)?;
            self.steps.push(Step::Negative);
            return Ok(());
        }
        if self.take('+') {
            return self.nested(Self::signed);
        }
        self.value()?;
        if self.take('^') {
            // right-associative
            self.nested(Self::signed)?;
            self.steps.push(Step::Operator(Operator::Power));
        }
        Ok(())
    }

    /// A number, a name, a function or an expression in parentheses.
    fn value(&mut self) -> Result<(), String> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                self.nested(Self::sum)?;
                self.close()
            }
            Some(digit) if digit.is_ascii_digit() || digit == '.' => self.number(),
            Some(letter) if letter.is_alphabetic() => self.word(),
            _ => Err(self.problem("expected a number, t, pi, e, a function or (")),
        }
    }

    fn close(&mut self) -> Result<(), String> {
        match self.take(')') {
            true => Ok(()),
            false => Err(self.problem("expected )")),
        }
    }

    fn number(&mut self) -> Result<(), String> {
        let bytes = self.rest().as_bytes();
        let digits =
            |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let mut end = digits(0);
        if bytes.get(end) == Some(&b'.') {
            end += 1 + digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let exponent = digits((end + 1 + sign).min(bytes.len()));
            if exponent > 0 {
                end += 1 + sign + exponent;
            }
        }
        let number = self.rest()[..end].parse::<f64>().ok().filter(|number| number.is_finite());
        let number = number.ok_or_else(|| self.problem("expected a finite number"))?;
        self.at += end;
        self.steps.push(Step::Number(number));
        Ok(())
    }

    fn word(&mut self) -> Result<(), String> {
        let rest = self.rest();
        let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let word = &rest[..length];
        let constant = match word {
            "t" => Some(Step::Time),
            "pi" => Some(Step::Number(std::f64::consts::PI)),
            "e" => Some(Step::Number(std::f64::consts::E)),
            _ => None,
        };
        if let Some(step) = constant {
            self.at += length;
            self.steps.push(step);
            return Ok(());
        }
        let Some(function) = FUNCTIONS.iter().find(|function| function.name == word) else {
            let known: Vec<&str> =
                ["t", "pi", "e"].into_iter().chain(FUNCTIONS.iter().map(|f| f.name)).collect();
            return Err(format!("unknown word \"{word}\"; {}", unknown(word, &known)));
        };
        self.at += length;
        if !self.take('(') {
            return Err(self.problem(&format!("expected ( after {word}")));
        }
        self.nested(|parser| {
            parser.sum()?;
            if matches!(function.rule, Choice(_)) {
                if !parser.take(',') {
                    return Err(
                        parser.problem(&format!("expected a comma: {word} takes two numbers"))
                    );
                }
                parser.sum()?;
            }
            Ok(())
        })?;
        self.close()?;
        self.steps.push(Step::Function(function));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str, t: f64) -> f64 {
        Formula::parse(text).unwrap_or_else(|error| panic!("{text}: {error}")).at(t).0[0]
    }

    /// The rules of mathematics, where programs are known to differ: signs and powers, powers of powers.
    #[test]
    fn they_mean_what_mathematics_does() {
        let t = 0.3_f64;
        for (text, expected) in [
            ("-t^2", -0.09),
            ("(-t)^2", 0.09),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("-2^-2", -0.25),
            ("8/4/2", 1.0),
            ("1-2-3", -4.0),
            ("1 - -2", 3.0),
            ("+3", 3.0),
            ("2*3+4*5", 26.0),
            ("1e-3*t", 3e-4),
            ("1.5E+2 + .5 + 2.", 152.5),
            ("2*e", 2.0 * std::f64::consts::E),
            ("2000*sin(2*pi*3*t)", 2000.0 * (std::f64::consts::TAU * 3.0 * t).sin()),
            ("min(t, 0.1) + max(t, 0.1)", 0.4),
            ("5*step(t-0.2) + 7*step(0.2-t)", 5.0),
            ("abs(-t) / sqrt(t^2)", 1.0),
            ("ln(exp(t)) + log10(10^t)", 0.6),
            ("atan(tan(t)) + asin(sin(t)) + acos(cos(t))", 0.9),
            ("cosh(t)^2 - sinh(t)^2 + tanh(0)", 1.0),
        ] {
            let found = value(text, t);
            assert!(
                (found - expected).abs() <= 1e-14 * expected.abs(),
                "{text}: {found} {expected}"
            );
        }
    }

    /// Derivatives, against central differences with h = 1e-5, whose error is h^2/6 times third and fourth
    /// derivatives, 4e5 at most here (of t^-1.5 at 0.2), and round-off over h.
    #[test]
    fn derivatives_are_those_of_the_values() {
        for text in [
            "sin(3*t)*cos(t) + tan(t/2)",
            "asin(t/2) - acos(t/3) + atan(2*t)",
            "sinh(t) + cosh(2*t) - tanh(t)",
            "exp(-t^2) + ln(1+t) + log10(2+t)",
            "sqrt(1+t)/(2-t) - t^3 + t^-1.5",
            "2^t + t^t + (1+t)^(2*t)",
            "0.01*(1 - cos(2*pi*t))/2",
            "-3*t + 4 - t*t*t/7",
            "min(t, 2*t) + max(t^2, -1) + abs(t)*step(t)",
        ] {
            let formula = Formula::parse(text).unwrap();
            let h = 1e-5;
            for t in [0.2, 0.7, 1.1] {
                let [behind, at, ahead] = [t - h, t, t + h].map(|t| formula.at(t).0);
                for k in 0..2 {
                    let slope = (ahead[k] - behind[k]) / (2.0 * h);
                    let apart = (at[k + 1] - slope).abs();
                    assert!(apart < 1e-5, "{text}: derivative {k} at {t} s off by {apart:e}");
                }
            }
        }
    }

    /// Where a number is 0 or constant, its derivatives do not become NaN by 0 times infinity.
    #[test]
    fn derivatives_at_the_start() {
        for (text, expected) in [
            ("t", [0.0, 1.0, 0.0]),
            ("t^2", [0.0, 0.0, 2.0]),
            ("t^3", [0.0; 3]),
            ("3*t^1", [0.0, 3.0, 0.0]),
            ("sqrt(0)", [0.0; 3]),
            ("0^2 + t", [0.0, 1.0, 0.0]),
        ] {
            assert_eq!(Formula::parse(text).unwrap().at(0.0).0, expected, "{text}");
        }
    }

    #[test]
    fn mistakes_are_told_with_their_place() {
        for (text, parts) in [
            ("", &["expected a number", "found the end"][..]),
            ("2*(3+t", &["expected )", "found the end"]),
            ("2*3)", &["expected an operator", "')' at character 4"]),
            ("2 t", &["expected an operator", "'t' at character 3"]),
            ("2*sinn(t)", &["unknown word \"sinn\"", "sin"]),
            ("sin t", &["expected ( after sin", "'t' at character 5"]),
            ("min(1)", &["expected a comma", "min takes two numbers"]),
            ("sin(1, 2)", &["expected )", "',' at character 6"]),
            ("3*/2", &["expected a number", "'/' at character 3"]),
            ("1e999", &["finite number"]),
            (".", &["finite number"]),
            ("t = 3", &["expected an operator", "'='"]),
            ("2*\u{3c0}", &["unknown word \"\u{3c0}\"", "pi"]),
            (&"(".repeat(100_000), &["nested more than 32 deep"]),
            (&"-".repeat(100_000), &["nested more than 32 deep"]),
            (&"2^".repeat(100_000), &["nested more than 32 deep"]),
        ] {
            let error = Formula::parse(text).unwrap_err();
            parts.iter().for_each(|part| assert!(error.contains(part), "{text:.20}: {error}"));
        }
        assert_eq!(Formula::parse("max(t, 0)").unwrap().kink(), Some("max"));
        assert_eq!(Formula::parse("sin(t)").unwrap().kink(), None);
    }
}

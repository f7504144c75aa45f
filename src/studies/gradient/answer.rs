//! A gradient: derivatives with their errors, in words and as JSON.

use std::fmt;
use std::path::Path;

use serde_json::{Map, Value, json};

use super::method::Method;
use crate::base::input::four_digits;
use crate::dynamics::error::Error;
use crate::io::file::write_file;

/// The value of an objective, and its derivatives by numbers of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Gradient {
    /// The objective.
    pub of: String,
    /// Its value, in `unit`.
    pub value: f64,
    /// Its unit; that of squares of residuals in several units is 1.
    pub unit: String,
    /// Whether it is of an equilibrium, and not of a motion.
    pub is_at_rest: bool,
    /// The method of the derivatives.
    pub method: Method,
    /// Reason for which a cheaper method was not used; none if it was not tried, or if the method was requested.
    pub reason: Option<String>,
    /// Relative tolerances of the runs: that of the value and the derivatives, and the one that they are compared with.
    pub rtols: [f64; 2],
    /// The derivatives, in the order of the keys.
    pub derivatives: Vec<Derivative>,
    /// Runs or searches for equilibria, without those of checks.
    pub runs: usize,
    /// Their steps, in multiples of those of the run of the value; adjoint steps count as about three, and two fifths for each scene with
    /// another number; linearized equilibria as an iteration, and one for each.
    pub cost: f64,
}

/// The derivative by one number.
#[derive(Debug, Clone, PartialEq)]
pub struct Derivative {
    /// The key of the number.
    pub key: String,
    /// The number, in `at_unit`.
    pub at: f64,
    /// Its unit; empty where that depends on other keys.
    pub at_unit: &'static str,
    /// The derivative, in the unit of the objective by that of the number.
    pub value: f64,
    /// Estimated error of it: the sum of the next two.
    pub error: f64,
    /// Error of the differences, from those of other steps.
    pub by_steps: f64,
    /// Difference from the result at the larger tolerance, which is about the error of that.
    pub by_tolerance: f64,
    /// Whether the objective does not depend on the number: all runs had the same value.
    pub is_constant: bool,
    /// Reason for which it is of little use for another value of the number, if there is one.
    pub doubt: Option<Doubt>,
    /// The same by whole runs, if requested.
    pub check: Option<Check>,
}

/// The reason why a derivative is not meaningful: its error is more than a tenth of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Doubt {
    /// Whether runs of different tolerances disagree; else differences of different steps.
    pub by_tolerance: bool,
    /// The time (s) since which they have disagreed, if the objective is a reading at the end.
    pub since: Option<f64>,
    /// The tolerances.
    pub rtols: [f64; 2],
}

/// A derivative by differences of whole runs, or of equilibria, by steps of their own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Check {
    /// The derivative.
    pub value: f64,
    /// Its estimated error.
    pub error: f64,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [fine, coarse] = self.rtols;
        match self.by_tolerance {
            true => write!(f, "runs at rtol {fine:e} and {coarse:e} disagree about it")?,
            false => f.write_str("differences by different steps disagree about it")?,
        }
        if let Some(time) = self.since {
            write!(f, " from {} s on", four_digits(time))?;
        }
        match self.by_tolerance {
            true => f.write_str(
                ": nearby motions part, as after bounces or in chaos; look at an earlier time, a mean, or a smaller solver.rtol",
            ),
            false => f.write_str(": the objective has kinks or jumps near this value"),
        }
    }
}

impl Gradient {
    /// Writes the [record](Self::to_json) to a file.
    ///
    /// # Errors
    /// [`Error::Output`] if it cannot be written.
    pub fn write_json(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let document = self.to_json();
        write_file(path.as_ref(), |file| writeln!(file, "{document:#}"))
    }

    /// JSON record: `of`, `value`, `unit`, `method`, `reason`, `rtol`, `runs`, `cost`, and `gradient`, which has for each key the derivative
    /// `value` with its `unit`, `error` and where that is from, whether it is `meaningful`, and the `check`.
    pub fn to_json(&self) -> Value {
        let gradient: Map<String, Value> = self
            .derivatives
            .iter()
            .map(|derivative| (derivative.key.clone(), derivative.to_json(&self.unit)))
            .collect();
        json!({
            "of": self.of,
            "value": self.value,
            "unit": self.unit,
            "equilibrium": self.is_at_rest,
            "gradient": gradient,
            "method": self.method.name(),
            "reason": self.reason,
            "rtol": self.rtols,
            "runs": self.runs,
            "cost": self.cost,
        })
    }
}

impl Derivative {
    /// That by a number, a value with its unit, on which nothing depends.
    pub(super) fn constant(key: String, (at, at_unit): (f64, &'static str)) -> Self {
        let [value, error, by_steps, by_tolerance] = [0.0; 4];
        let (is_constant, doubt, check) = (true, None, None);
        Self { key, at, at_unit, value, error, by_steps, by_tolerance, is_constant, doubt, check }
    }

    /// Its unit, of an objective of `unit`.
    pub(crate) fn unit(&self, unit: &str) -> String {
        match (unit, self.at_unit) {
            (unit, "" | "1") => unit.into(),
            (unit, own) if own.contains(['/', ' ', '*']) => format!("{unit}/({own})"),
            (unit, own) => format!("{unit}/{own}"),
        }
    }

    fn to_json(&self, unit: &str) -> Value {
        let check =
            self.check.map(|Check { value, error }| json!({ "value": value, "error": error }));
        json!({
            "value": self.value,
            "unit": self.unit(unit),
            "error": self.error,
            "error_of_differences": self.by_steps,
            "error_of_tolerance": self.by_tolerance,
            "at": self.at,
            "at_unit": self.at_unit,
            "depends": !self.is_constant,
            "meaningful": self.doubt.is_none(),
            "warning": self.doubt.map(|doubt| doubt.to_string()),
            "meaningful_until": self.doubt.and_then(|doubt| doubt.since),
            "check": check,
        })
    }
}

impl fmt::Display for Gradient {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            of, value, unit, method, reason, rtols: [fine, _], derivatives, runs, cost, ..
        } = self;
        let rest = if self.is_at_rest { " at rest" } else { "" };
        writeln!(f, "{of}{rest} = {value:.9e} {unit}")?;
        let width = derivatives.iter().map(|by| by.key.chars().count()).max().unwrap_or(0);
        for by in derivatives {
            let Derivative { key, value, error, .. } = by;
            write!(f, "by {key:width$}  {value:>17.9e} +- {error:.1e} {}", by.unit(unit))?;
            if let Some(Check { value, error }) = by.check {
                write!(f, "; whole runs {value:.9e} +- {error:.1e}")?;
            }
            if by.is_constant {
                f.write_str(": nothing depends on it here")?;
            }
            writeln!(f)?;
        }
        for by in derivatives {
            if let Some(doubt) = &by.doubt {
                writeln!(f, "warning: the derivative by {} means little: {doubt}", by.key)?;
            }
        }
        write!(f, "{method}, rtol {fine:e}: {runs} runs, the cost of {cost:.1}")?;
        match reason {
            Some(reason) => write!(f, " ({reason})"),
            None => Ok(()),
        }
    }
}

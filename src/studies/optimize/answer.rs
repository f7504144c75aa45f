//! The answer of a search, in words, as JSON and as a chart.

use std::fmt;
use std::path::Path;

use serde_json::{Map, Value, json};

use super::evaluation::{Aim, Evaluation, overrides};
use super::search::Ending;
use crate::base::input::four_digits;
use crate::dynamics::error::Error;
use crate::io::file::write_file;
use crate::io::output::Chart;
use crate::studies::fit::Unknown;
use crate::studies::gradient::{Derivative, Gradient};

/// Fraction of the largest derivative above which an error is reported.
const MEANINGFUL: f64 = 0.1;

/// The best numbers of a scene, and all that were tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimum {
    /// The aim of the search.
    pub aim: Aim,
    /// The numbers, with their ranges.
    pub numbers: Vec<Unknown>,
    /// All evaluations, in their order. The first is with the numbers of the file.
    pub evaluations: Vec<Evaluation>,
    /// The place of the best one among them.
    pub best: usize,
    /// Reason for the end.
    pub ending: Ending,
}

impl Optimum {
    /// The best evaluation.
    pub fn best(&self) -> &Evaluation {
        &self.evaluations[self.best]
    }

    /// The quantities before and after.
    fn quantities(&self) -> impl Iterator<Item = (&Gradient, &Gradient, Option<f64>)> {
        let [before, after] = [&self.evaluations[0], self.best()].map(Evaluation::quantities);
        let goal = |at: usize| match &self.aim {
            Aim::Goals(goals) => Some(goals[at]),
            _ => None,
        };
        let pairs = before.iter().zip(after).enumerate();
        pairs.map(move |(at, (before, after))| (before, after, goal(at)))
    }

    /// For each number its value before and after, and the end of its range that it is at: 0 the least, 1 the most.
    fn chosen(&self) -> impl Iterator<Item = (&Unknown, [f64; 2], Option<usize>)> {
        let values = self.evaluations[0].values.iter().zip(&self.best().values);
        self.numbers.iter().zip(values).map(|(number, (&before, &after))| {
            (number, [before, after], number.range.iter().position(|end| *end == after))
        })
    }

    /// Derivatives by some numbers whose errors, at the best evaluation, are above a tenth of the largest value that they had in any: keys, and why
    /// they mean little. (At an optimum itself a derivative is 0, and below its error.)
    pub fn warnings(&self) -> Vec<(&str, String)> {
        let mut warnings = Vec::new();
        for (of, gradient) in self.best().quantities().iter().enumerate() {
            for (by, Derivative { key, error, doubt, .. }) in
                gradient.derivatives.iter().enumerate()
            {
                let all = self.evaluations.iter().filter_map(|one| one.quantities().get(of));
                let values = all.map(|gradient| gradient.derivatives[by].value.abs());
                let largest = values.fold(0.0, f64::max);
                if let Some(doubt) = doubt.filter(|_| *error > MEANINGFUL * largest) {
                    warnings.push((&key[..], doubt.to_string()));
                }
            }
        }
        warnings
    }

    /// The runs of all evaluations that did not fail.
    pub fn runs(&self) -> usize {
        let gradients = self.evaluations.iter().flat_map(|one| one.gradients.iter().flatten());
        gradients.map(|gradient| gradient.runs).sum()
    }

    /// Number of failed evaluations, and the reason of the last one.
    pub fn failures(&self) -> (usize, Option<&str>) {
        let mut failures = self.evaluations.iter().filter_map(|one| one.gradients.as_ref().err());
        (failures.clone().count(), failures.next_back().map(String::as_str))
    }

    /// The values that were found, for keys of the scene file: see [`SceneFile::read_with`](crate::SceneFile::read_with).
    pub fn overrides(&self) -> Vec<String> {
        overrides(&self.numbers, &self.best().values)
    }

    /// JSON record: `aim`, `of` with the quantities `before` and `after`, `numbers` with the value, the range and the end `at` which it is for each
    /// key, `ending`, `is_optimum`, `evaluations`, `failed`, `failure`, `runs`, `warnings`, each a key
    /// and why its derivative means little, and `gradients`, those at the optimum.
    pub fn to_json(&self) -> Value {
        let of = self.quantities().map(|(before, after, goal)| {
            let Gradient { of, unit, value, .. } = before;
            json!({ "of": of, "unit": unit, "before": value, "after": after.value, "goal": goal })
        });
        let numbers = self.chosen().map(|(number, [before, value], end)| {
            let [least, most] = number.range;
            let at = end.map(|end| ["least", "most"][end]);
            let chosen = json!({
                "value": value, "before": before, "least": least, "most": most, "at": at,
            });
            (number.name.clone(), chosen)
        });
        let (failed, failure) = self.failures();
        let after = self.quantities().map(|(_, after, _)| after.to_json());
        json!({
            "aim": match self.aim {
                Aim::Least => "least",
                Aim::Largest => "largest",
                Aim::Goals(_) => "goals",
            },
            "of": of.collect::<Vec<_>>(),
            "numbers": numbers.collect::<Map<_, _>>(),
            "ending": self.ending.name(),
            "is_optimum": self.ending.is_optimum(),
            "evaluations": self.evaluations.len(),
            "failed": failed,
            "failure": failure,
            "runs": self.runs(),
            "warnings": self.warnings().into_iter().collect::<Vec<_>>(),
            "gradients": after.collect::<Vec<_>>(),
        })
    }

    /// Writes the [record](Self::to_json) to a file.
    ///
    /// # Errors
    /// [`Error::Output`] if it cannot be written.
    pub fn write_json(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let document = self.to_json();
        write_file(path.as_ref(), |file| writeln!(file, "{document:#}"))
    }

    /// Draws the quantities, and their goals, over the evaluations.
    ///
    /// # Errors
    /// As [`Chart::write`].
    pub fn write_chart(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let unit = self.quantities().next().map_or("", |(before, ..)| &before.unit);
        let mut chart = Chart::new("From evaluation to evaluation")
            .axes("evaluation", format!("value ({unit})"));
        for (at, (before, _, goal)) in self.quantities().enumerate() {
            let points = (1..).zip(&self.evaluations).filter_map(|(number, evaluation)| {
                let gradients = evaluation.gradients.as_ref().ok()?;
                Some((f64::from(number), gradients[at].value))
            });
            chart = chart.marked(&before.of, points);
            if let Some(goal) = goal {
                let ends = [1.0, self.evaluations.len() as f64];
                chart = chart.reference(format!("goal of {}", before.of), ends.map(|x| (x, goal)));
            }
        }
        chart.write(path)
    }
}

impl fmt::Display for Optimum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (before, after, goal) in self.quantities() {
            let Gradient { of, unit, value, .. } = before;
            write!(f, "{of}: {value:.6e} {unit} before, {:.6e} {unit} after", after.value)?;
            match goal {
                Some(goal) => writeln!(f, ", {:.1e} {unit} off {goal:?}", after.value - goal)?,
                None => writeln!(f)?,
            }
        }
        let width = self.numbers.iter().map(|number| number.name.chars().count()).max();
        let width = width.unwrap_or(0);
        for (number, [before, value], end) in self.chosen() {
            write!(f, "{:width$} = {value:.5e}, {} before", number.name, four_digits(before))?;
            if end.is_some() {
                let [least, most] = number.range;
                write!(f, ": at the end of its range, {least:?}..{most:?}")?;
            }
            writeln!(f)?;
        }
        for (_, after, _) in self.quantities() {
            let Gradient { of, unit, derivatives, .. } = after;
            for by in derivatives {
                let Derivative { key, value, error, .. } = by;
                writeln!(
                    f,
                    "{of} by {key:width$}  {value:>12.4e} +- {error:.1e} {}",
                    by.unit(unit)
                )?;
            }
        }
        for (key, doubt) in self.warnings() {
            writeln!(f, "warning: the derivative by {key} means little: {doubt}")?;
        }
        let (count, runs) = (self.evaluations.len(), self.runs());
        match self.failures() {
            (_, None) => writeln!(f, "{count} evaluations, {runs} runs; {}", self.ending)?,
            (failed, Some(last)) => writeln!(
                f,
                "{count} evaluations, {failed} of which failed ({last}), {runs} runs; {}",
                self.ending
            )?,
        }
        let set: Vec<String> = self.overrides().iter().map(|set| format!("--set {set}")).collect();
        write!(f, "{}", set.join(" "))
    }
}

//! Report of the models that were tried: words, numbers and a chart.

use std::fmt;
#[cfg(feature = "output")]
use std::path::Path;

use super::{Reduced, Tried, Verified};
use crate::base::input::{four_digits, percent, short};
#[cfg(feature = "output")]
use crate::dynamics::error::Error;
#[cfg(feature = "output")]
use crate::io::output::{Chart, write_file};

impl Reduced {
    /// The model that was chosen, among those that were tried.
    fn chosen(&self) -> Option<&Tried> {
        let [unknowns, cells] = [self.model.unknowns(), self.model.cells()];
        self.tried.iter().find(|tried| [tried.unknowns, tried.cells] == [unknowns, cells])
    }

    /// Number of the run from which on the training time is recovered; none if the model is not faster.
    pub fn pays_from(&self) -> Option<f64> {
        pays_from(self.training_seconds, self.full_seconds? - self.chosen()?.seconds)
    }

    /// All numbers, as JSON.
    #[cfg(feature = "output")]
    pub fn to_json(&self) -> serde_json::Value {
        let tried = self.tried.iter().map(|tried| {
            serde_json::json!({
                "unknowns": tried.unknowns,
                "cells": tried.cells,
                "error": tried.error,
                "told": tried.told,
                "seconds": tried.seconds,
            })
        });
        let [unknowns, cells] = self.full;
        serde_json::json!({
            "unknowns": self.model.unknowns(),
            "cells": self.model.cells(),
            "error": self.model.error(),
            "is_estimate": self.model.is_estimate(),
            "is_within": self.is_within,
            "learned_from": self.model.learned_from(),
            "training_seconds": self.training_seconds,
            "full": { "unknowns": unknowns, "cells": cells, "seconds": self.full_seconds },
            "tried": tried.collect::<Vec<_>>(),
        })
    }

    /// Writes all numbers to a file, as JSON.
    ///
    /// # Errors
    /// [`Error::Output`] if the file cannot be written.
    #[cfg(feature = "output")]
    pub fn write_json(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        write_file(path.as_ref(), |file| {
            serde_json::to_writer_pretty(&mut *file, &self.to_json())?;
            writeln!(file)
        })
    }

    /// Draws the errors of all models that were tried over the times of their runs, with the time of all unknowns and the
    /// error that was wanted, to an SVG or PNG file.
    ///
    /// # Errors
    /// As [`Chart::write`].
    #[cfg(feature = "output")]
    pub fn write_chart(
        &self,
        path: impl AsRef<Path>,
        title: &str,
        within: f64,
    ) -> Result<(), Error> {
        let points = self.tried.iter().map(|tried| (tried.seconds, tried.error));
        let points: Vec<(f64, f64)> = points
            .filter(|(time, error)| *time > 0.0 && *error > 0.0 && error.is_finite())
            .collect();
        let ends = |values: &[f64]| {
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            [least, values.iter().copied().fold(0.0, f64::max)]
        };
        let (mut times, mut errors): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        times.extend(self.full_seconds);
        errors.push(within);
        let ([first, last], [least, most]) = (ends(&times), ends(&errors));
        let error = match self.model.is_estimate() {
            true => "largest error of a displacement, as runs tell",
            false => "largest error of a displacement",
        };
        let mut chart = Chart::new(title)
            .axes("time of a run (s)", error)
            .logarithmic(true, true)
            .marked("reduced models", points.iter().copied());
        if let Some(full) = self.full_seconds {
            let name = format!("time with all unknowns: {} s", four_digits(full));
            chart = chart.reference(name, [(full, least), (full, most)]);
        }
        chart
            .reference(
                format!("error that is wanted: {}", percent(within)),
                [(first, within), (last, within)],
            )
            .write(path)
    }
}

/// From which run on the time `spent` (s) is won back, if each wins some time (s).
pub(crate) fn pays_from(spent: f64, won: f64) -> Option<f64> {
    (won > 0.0).then(|| (spent / won).ceil().max(1.0))
}

impl Reduced {
    /// As [`Display`](fmt::Display), where no run of all unknowns was made.
    fn fmt_by_modes(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [unknowns, cells] = self.full;
        writeln!(f, "unknowns     cells      error  estimated    time (s)")?;
        for Tried { unknowns, cells, error, told: said, seconds } in &self.tried {
            let cells = if *cells == 0 { "exact".into() } else { cells.to_string() };
            let error = if error.is_finite() { percent(*error) } else { String::new() };
            let (said, seconds) = (percent(*said), four_digits(*seconds));
            writeln!(f, "{unknowns:8} {cells:>9} {error:>10} {said:>10} {seconds:>11}")?;
        }
        writeln!(f, "{unknowns:8} {cells:>9}\n")?;
        write!(
            f,
            "{}; it took {} s, and no run of all unknowns: `pliant reduce --verify` makes one",
            self.model,
            four_digits(self.training_seconds)
        )
    }
}

impl fmt::Display for Reduced {
    /// A table of the tried models, and the choice.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [unknowns, cells] = self.full;
        let Some(full) = self.full_seconds else { return self.fmt_by_modes(f) };
        writeln!(f, "unknowns     cells      error  estimated    time (s)  speed-up")?;
        for Tried { unknowns, cells, error, told: said, seconds } in &self.tried {
            let cells = if *cells == 0 { "exact".into() } else { cells.to_string() };
            if error.is_infinite() {
                writeln!(f, "{unknowns:8} {cells:>9} {:>10}", "failed")?;
                continue;
            }
            let [error, said] = [*error, *said].map(percent);
            let (faster, seconds) = (short(full / seconds), four_digits(*seconds));
            writeln!(
                f,
                "{unknowns:8} {cells:>9} {error:>10} {said:>10} {seconds:>11} {faster:>9}"
            )?;
        }
        writeln!(
            f,
            "{unknowns:8} {cells:>9} {:>10} {:>10} {:>11} {:>9}\n",
            "",
            "",
            four_digits(full),
            1
        )?;
        let Some(chosen) = self.chosen() else { return write!(f, "{}", self.model) };
        let training = four_digits(self.training_seconds);
        write!(f, "{}, ", self.model)?;
        match self.pays_from() {
            Some(run) => write!(
                f,
                "at {} times the speed; learning it took {training} s and pays from run {run} on",
                short(full / chosen.seconds)
            ),
            None => write!(f, "and no faster than all unknowns: learning it took {training} s"),
        }
    }
}

impl fmt::Display for Verified {
    /// The measured error, and the one that the run estimated.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reduced: Tried { error, told: said, seconds, .. }, full_seconds } = *self;
        if error.is_infinite() {
            return write!(f, "the run by the model failed");
        }
        let faster = short(full_seconds / seconds);
        let [error, said] = [error, said].map(percent);
        let [full, seconds] = [full_seconds, seconds].map(four_digits);
        write!(
            f,
            "off by {error}, the run estimates {said}; {seconds} s in place of {full} s, {faster} times the speed"
        )
    }
}

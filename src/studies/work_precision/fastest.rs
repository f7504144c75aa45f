//! The fastest line for each accuracy.
//!
//! An accuracy counts from the last point of a line that misses it, and interpolates from there: a loose
//! tolerance that is accurate by luck, as happens with all methods now and then, does not count.

use std::fmt::{self, Write};
use std::path::Path;

use super::Findings;
use crate::dynamics::error::Error;
use crate::io::output::write_file;

impl Findings {
    /// Which line is the fastest, accuracy by accuracy.
    #[must_use]
    pub fn fastest(&self) -> Fastest {
        Fastest::of(self)
    }

    /// Writes which lines are the fastest, and the notes, to a Markdown file.
    ///
    /// # Errors
    /// [`Error::Output`] if it cannot be written.
    pub fn write_table(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        write_file(path.as_ref(), |file| {
            writeln!(file, "# {}\n\n{}", self.title(), self.fastest().markdown())?;
            self.notes().iter().try_for_each(|note| writeln!(file, "- {note}"))
        })
    }
}

/// For each decade of error from 1e-1 to 1e-7 the line that reaches it in the least time, and how much longer
/// the others take. Its `Display` is a plain table, [`markdown`](Self::markdown) one in Markdown.
#[derive(Debug, Clone, PartialEq)]
pub struct Fastest {
    /// From rough to fine.
    pub accuracies: Vec<Accuracy>,
}

/// The lines that reach an accuracy, and those that do not.
#[derive(Debug, Clone, PartialEq)]
pub struct Accuracy {
    /// Relative error.
    pub error: f64,
    /// Whether the reference is precise enough for this error; if not, no line counts as reaching it.
    pub is_resolved: bool,
    /// Names and times (s) of the lines that reach it, the fastest first.
    pub reached: Vec<(String, f64)>,
    /// Names of the others.
    pub missed: Vec<String>,
}

impl Fastest {
    fn of(findings: &Findings) -> Self {
        let accuracy = |digits: i32| {
            let error = 10_f64.powi(-digits);
            let is_resolved = error >= 10.0 * findings.resolution();
            let (mut reached, mut missed) = (Vec::new(), Vec::new());
            for line in findings.lines() {
                match line.time_to_reach(error).filter(|_| is_resolved) {
                    Some(time) => reached.push((line.name.clone(), time)),
                    None => missed.push(line.name.clone()),
                }
            }
            reached.sort_by(|a, b| a.1.total_cmp(&b.1));
            Accuracy { error, is_resolved, reached, missed }
        };
        Self { accuracies: (1..=7).map(accuracy).collect() }
    }

    /// The table in Markdown.
    #[must_use]
    pub fn markdown(&self) -> String {
        let mut table = "| error | fastest | time | the others, times as long |\n\
                         | --- | --- | --- | --- |\n"
            .to_owned();
        for accuracy in &self.accuracies {
            let [fastest, time, others] = accuracy.cells();
            let error = accuracy.error;
            writeln!(table, "| {error:.0e} | {fastest} | {time} | {others} |")
                .expect("writing to a string does not fail");
        }
        table
    }
}

impl fmt::Display for Fastest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cells: Vec<_> = self.accuracies.iter().map(Accuracy::cells).collect();
        let width = cells.iter().map(|cells| cells[0].chars().count()).max().unwrap_or(0).max(7);
        write!(f, "error  {:width$}  {:>8}  the others, times as long", "fastest", "time")?;
        for (accuracy, [fastest, time, others]) in self.accuracies.iter().zip(cells) {
            write!(f, "\n{:5.0e}  {fastest:width$}  {time:>8}  {others}", accuracy.error)?;
        }
        Ok(())
    }
}

impl Accuracy {
    /// The fastest, its time, the others.
    fn cells(&self) -> [String; 3] {
        let Some((fastest, least)) = self.reached.first() else {
            let why = if self.is_resolved { "none" } else { "beyond the reference" };
            return [why.into(), String::new(), String::new()];
        };
        let ratio = |(name, time): &(String, f64)| format!("{name} {:.1}", time / least);
        let mut others = self.reached[1..].iter().map(ratio).collect::<Vec<_>>().join(", ");
        if !self.missed.is_empty() {
            let separator = if others.is_empty() { "" } else { "; " };
            others = format!("{others}{separator}not reached: {}", self.missed.join(", "));
        }
        [fastest.clone(), time_text(*least), others]
    }
}

/// A time (s) with three digits, in a unit that suits it.
#[must_use]
pub fn time_text(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 0.9995e-3 => (1e6 * s, "\u{b5}s"),
        s if s < 0.9995 => (1e3 * s, "ms"),
        s => (s, "s"),
    };
    let decimals = if value < 9.995 { 2 } else { usize::from(value < 99.95) };
    format!("{value:.decimals$} {unit}")
}

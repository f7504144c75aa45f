//! Results of a study.

use std::path::Path;

use super::row::write_rows;
use super::{Line, Problem, Row};
use crate::dynamics::error::Error;

/// All rows of a study, line by line.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    title: String,
    is_processor_time: bool,
    lines: Vec<LineFindings>,
}

/// The rows of one line, from rough to fine.
#[derive(Debug, Clone, PartialEq)]
pub struct LineFindings {
    /// Name of the line.
    pub name: String,
    /// Its family.
    pub family: String,
    /// Its rows.
    pub rows: Vec<Row>,
}

impl Findings {
    pub(super) fn new(problem: &dyn Problem, rows: &[Row]) -> Self {
        let of = |line: &Line| LineFindings {
            name: line.name.clone(),
            family: line.family.clone(),
            rows: rows.iter().filter(|row| row.line == line.name).cloned().collect(),
        };
        Self {
            title: problem.title().into(),
            is_processor_time: false,
            lines: problem.lines().iter().map(of).collect(),
        }
    }

    /// The same findings with processor times in place of wall-clock times. On a quiet machine
    /// they hardly differ; on a busy one they are disturbed less.
    #[must_use]
    pub fn by_processor_time(mut self) -> Self {
        self.is_processor_time = true;
        for row in self.lines.iter_mut().flat_map(|line| &mut line.rows) {
            row.seconds = row.processor_seconds.unwrap_or(row.seconds);
        }
        self
    }

    /// Whether times are those of the processor.
    #[must_use]
    pub fn is_processor_time(&self) -> bool {
        self.is_processor_time
    }

    /// These findings and the lines of others, in one table and chart: for example of the same problem
    /// against a reference of its own.
    #[must_use]
    pub fn and(mut self, others: Self) -> Self {
        self.lines.extend(others.lines);
        self
    }

    /// Title of the problem.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The lines.
    #[must_use]
    pub fn lines(&self) -> &[LineFindings] {
        &self.lines
    }

    /// All rows, line by line.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        self.lines.iter().flat_map(|line| &line.rows)
    }

    /// Relative error that the reference may have itself.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        self.rows().map(|row| row.resolution).fold(0.0, f64::max)
    }

    /// Notes on how far the numbers can be trusted: how sure the reference is, which runs
    /// failed, whether the machine was busy.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let resolution = self.resolution();
        let mut notes =
            vec![format!("The reference is known to a relative error of {resolution:.1e}.")];
        let solved = self.rows().filter(|row| row.error.is_some());
        let (sure, unsure): (Vec<_>, Vec<_>) = solved.partition(|row| row.is_resolved());
        if !unsure.is_empty() {
            let count = unsure.len();
            notes.push(format!("{count} errors are below ten times that: they are not sure."));
        }
        let timed = sure.len() + unsure.len();
        let noisy: Vec<&Row> =
            sure.into_iter().chain(unsure).filter(|row| row.is_noisy()).collect();
        if !noisy.is_empty() {
            let most = |f: fn(&Row) -> f64| noisy.iter().map(|row| f(row)).fold(0.0, f64::max);
            let remedy = match self.is_processor_time {
                true => "processor times, given here, suffer less from that",
                false => "compare processor times",
            };
            notes.push(format!(
                "The machine was busy during {} of {timed} runs: repetitions differ by up to {:.0} %, \
                 and the yardstick took up to {:.1} times its least time; {remedy}.",
                noisy.len(),
                100.0 * most(|row| row.spread),
                most(|row| row.slowdown),
            ));
        }
        for row in self.rows() {
            if let Some(failure) = &row.failure {
                notes.push(format!("{} at {} failed: {failure}", row.line, row.point));
            }
        }
        notes
    }

    /// Writes all rows to a CSV file, one column for each field of [`Row`].
    ///
    /// # Errors
    /// [`Error::Output`] if it cannot be written.
    pub fn write_csv(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        write_rows(self.rows(), path.as_ref())
    }
}

impl LineFindings {
    /// Error and time (s) of each row, from rough to fine; none for rows that failed. Errors below
    /// the resolution of the reference count as large as that.
    pub(super) fn points(&self) -> impl Iterator<Item = Option<(f64, f64)>> {
        self.rows.iter().map(|row| Some((row.error?.max(row.resolution), row.seconds)))
    }

    /// The time (s) in which the line reaches a relative `error`, interpolated between its points
    /// on logarithmic scales. None if it does not, or if a finer point is worse again: that
    /// small error was chance.
    #[must_use]
    pub fn time_to_reach(&self, error: f64) -> Option<f64> {
        let points: Vec<_> = self.points().collect();
        let misses = |point: &Option<(f64, f64)>| point.is_some_and(|(found, _)| found > error);
        let first = points.iter().rposition(misses).map_or(0, |last| last + 1);
        let mut times: Vec<f64> = points[first..].iter().flatten().map(|point| point.1).collect();
        if first > 0
            && let (Some(Some(miss)), Some(Some(hit))) = (points.get(first - 1), points.get(first))
        {
            let part = (error / miss.0).ln() / (hit.0 / miss.0).ln();
            times.push(miss.1 * (hit.1 / miss.1).powf(part));
        }
        times.into_iter().min_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(in crate::studies::work_precision) fn line(
        name: &str,
        points: &[Option<(f64, f64)>],
    ) -> LineFindings {
        let row = |point: &Option<(f64, f64)>| Row {
            line: name.into(),
            error: point.map(|point| point.0),
            seconds: point.map_or(9.0, |point| point.1),
            resolution: 1e-9,
            ..Row::default()
        };
        LineFindings {
            name: name.into(),
            family: name.into(),
            rows: points.iter().map(row).collect(),
        }
    }

    #[test]
    fn times_are_interpolated_on_logarithmic_scales() {
        // time = error^(-1/2)
        let law = line("law", &[Some((1e-2, 10.0)), Some((1e-4, 100.0)), Some((1e-6, 1000.0))]);
        for (error, time) in
            [(1e-1, 10.0), (1e-2, 10.0), (1e-3, 1e3_f64.sqrt()), (1e-5, 1e5_f64.sqrt())]
        {
            let found = law.time_to_reach(error).unwrap();
            assert!((found / time - 1.0).abs() < 1e-12, "{error}: {found}");
        }
        assert_eq!(law.time_to_reach(1e-6), Some(1000.0));
        assert_eq!(law.time_to_reach(0.99e-6), None);
    }

    #[test]
    fn lucky_hits_and_failures_do_not_count() {
        let lucky = line("lucky", &[Some((1e-5, 1.0)), Some((1e-2, 2.0)), Some((1e-4, 8.0))]);
        assert_eq!(lucky.time_to_reach(1e-3), Some(4.0));
        assert_eq!(lucky.time_to_reach(1e-5), None);
        let broken = line("broken", &[Some((1e-2, 1.0)), None, Some((1e-4, 8.0)), None]);
        assert_eq!(broken.time_to_reach(1e-3), Some(8.0));
        assert_eq!(broken.time_to_reach(1e-1), Some(1.0));
        assert_eq!(line("none", &[None]).time_to_reach(1e-1), None);
        // a finer tolerance may be faster
        let odd = line("odd", &[Some((1e-2, 3.0)), Some((1e-4, 2.0))]);
        assert_eq!(odd.time_to_reach(1e-1), Some(2.0));
    }
}

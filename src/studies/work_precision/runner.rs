//! Runs a study, one run after the other.

use std::fmt;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::row::{Row, read_rows, write_rows};
use super::timing::{Repetitions, Time, Yardstick};
use super::{Failed, Findings, Measured, Problem};
use crate::base::input::{InputError, positive};
use crate::dynamics::error::Error;

/// Measures a problem line by line and point by point.
pub struct Study<'a> {
    problem: &'a mut dyn Problem,
    repetitions: usize,
    patience: f64,
    limit: f64,
    file: Option<PathBuf>,
}

/// No run is given up before this time (s): little is gained, and short times are noisy.
const LEAST_LIMIT: f64 = 1.0;
/// More would be beyond the range of durations.
const LONGEST_LIMIT: f64 = 1e9;
/// Relative error from which on a run counts as wrong: no other times are compared with its time.
const WRONG: f64 = 1.0;

/// Progress of a study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage<'a> {
    /// Runs done.
    pub done: usize,
    /// Runs in all.
    pub all: usize,
    /// Next action, for progress messages.
    pub what: &'a str,
}

impl fmt::Display for Stage<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{} {}", self.done, self.all, self.what)
    }
}

impl fmt::Debug for Study<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Study").field("problem", &self.problem.title()).finish_non_exhaustive()
    }
}

impl<'a> Study<'a> {
    /// A study of `problem`.
    pub fn new(problem: &'a mut dyn Problem) -> Self {
        Self { problem, repetitions: 3, patience: 20.0, limit: 120.0, file: None }
    }

    /// Number of repetitions of each run for timing. Default: 3.
    #[must_use]
    pub fn repetitions(mut self, count: usize) -> Self {
        self.repetitions = count;
        self
    }

    /// How many times longer than the fastest at the same point a run may take before it is given
    /// up; a second in any case. Default: 20.
    #[must_use]
    pub fn patience(mut self, factor: f64) -> Self {
        self.patience = factor;
        self
    }

    /// Processor time (s) that any run may take, those of the reference included. Default: 120.
    #[must_use]
    pub fn limit(mut self, seconds: f64) -> Self {
        self.limit = seconds;
        self
    }

    /// A CSV file that keeps all rows. Runs that it holds are not repeated, so that a study that was
    /// stopped can be resumed; rows of other problems stay in it. Rows of scenes that another version of this
    /// library has run are not used; after changes of the code within a version, or on another machine, begin
    /// a new file.
    #[must_use]
    pub fn keep(mut self, file: impl Into<PathBuf>) -> Self {
        self.file = Some(file.into());
        self
    }

    /// Runs all points without a stored row. Calls `observer` before each run.
    ///
    /// # Errors
    /// Bad input; [`Error::Reference`] if there is nothing to compare with; [`Error::Read`] and
    /// [`Error::Output`] if the file cannot be read or written. Runs that fail are rows, not errors.
    pub fn run(self, observer: &mut dyn FnMut(Stage<'_>)) -> Result<Findings, Error> {
        self.validate()?;
        let Self { problem, repetitions, patience, limit, file } = self;
        let mut kept = file.as_deref().map_or(Ok(Vec::new()), read_rows)?;
        let mut rows = Vec::<Row>::new();
        let mut ready = None;
        let runs = all_runs(problem);
        let all = runs.len();
        for (done, PlannedRun { line, point, mut row }) in runs.into_iter().enumerate() {
            if let Some(known) = kept.iter().find(|known| known.is_same_run(&row)) {
                rows.push(known.clone());
                continue;
            }
            let (resolution, yardstick) = match &mut ready {
                Some(ready) => ready,
                None => {
                    let tell = &mut |what: &str| observer(Stage { done, all, what });
                    let resolution = problem.prepare(Duration::from_secs_f64(limit), tell)?;
                    ready.insert((resolution, Yardstick::new()))
                }
            };
            observer(Stage { done, all, what: &format!("{} at {}", row.line, row.point) });
            row.resolution = *resolution;
            let limit = limit.min((patience * fastest_at(&row.point, &rows)).max(LEAST_LIMIT));
            let before = yardstick.slowdown();
            fill(&mut row, problem, [line, point], repetitions, Duration::from_secs_f64(limit));
            row.slowdown = before.max(yardstick.slowdown());
            rows.push(row.clone());
            kept.push(row);
            if let Some(file) = &file {
                write_rows(&kept, file)?;
            }
        }
        Ok(Findings::new(problem, &rows))
    }

    fn validate(&self) -> Result<(), Error> {
        if self.repetitions == 0 {
            return Err(InputError::new("repetitions", 0, "each run is timed once at least").into());
        }
        positive("patience", self.patience, "")?;
        positive("limit", self.limit, "s")?;
        if self.limit > LONGEST_LIMIT {
            let help = format!("it is at most {LONGEST_LIMIT:e} s");
            return Err(InputError::new("limit", self.limit, help).into());
        }
        Ok(())
    }
}

struct PlannedRun {
    line: usize,
    point: usize,
    row: Row,
}

/// All runs, the rough points of all lines first, with their rows if known.
fn all_runs(problem: &dyn Problem) -> Vec<PlannedRun> {
    let lines = problem.lines();
    let longest = lines.iter().map(|line| line.points.len()).max().unwrap_or(0);
    let mut runs = Vec::new();
    for number in 0..longest {
        for (k, line) in lines.iter().enumerate() {
            let Some(point) = line.points.get(number) else { continue };
            let row = Row {
                problem: problem.title().into(),
                line: line.name.clone(),
                family: line.family.clone(),
                point: point.name.clone(),
                rtol: point.rtol,
                fingerprint: format!("{:016x}", problem.fingerprint(k, number)),
                ..Row::default()
            };
            runs.push(PlannedRun { line: k, point: number, row });
        }
    }
    runs
}

/// The least time (s) at `point` among the runs that were right.
fn fastest_at(point: &str, rows: &[Row]) -> f64 {
    rows.iter()
        .filter(|row| row.point == point && row.error.is_some_and(|error| error < WRONG))
        .map(|row| row.seconds)
        .fold(f64::INFINITY, f64::min)
}

/// Measures and times the run of `row`.
fn fill(
    row: &mut Row,
    problem: &mut dyn Problem,
    [line, point]: [usize; 2],
    repetitions: usize,
    limit: Duration,
) {
    let clock = Instant::now();
    let solve = |problem: &mut dyn Problem| -> Result<_, Failed> {
        let measure = || problem.measure(line, point, limit);
        let (measured, first) = Time::of(measure, |measured| measured.seconds)?;
        if !measured.error.is_finite() {
            return Err("the solution is not finite".into());
        }
        let again = || Ok(Time::of(|| problem.time(line, point), |seconds| *seconds)?.1);
        Ok((measured, Repetitions::of(first, repetitions, again)?))
    };
    match solve(problem) {
        Ok((measured, times)) => {
            let Measured { states, steps, evaluations, factorizations, .. } = measured;
            let Time { wall, processor } = times.median();
            row.error = Some(measured.error);
            row.largest_error = Some(measured.largest_error);
            row.energy_error = measured.energy_error;
            row.seconds = wall;
            row.processor_seconds = Some(processor);
            row.spread = times.spread();
            row.repetitions = times.count();
            row.states = Some(states);
            row.steps = Some(steps);
            row.evaluations = Some(evaluations);
            row.factorizations = Some(factorizations);
        }
        Err(failure) => {
            row.seconds = clock.elapsed().as_secs_f64();
            row.failure = Some(failure.to_string());
        }
    }
}

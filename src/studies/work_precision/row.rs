//! One run of a study, and the file of these rows.
//!
//! A row is the same run if the scene is the same: a hash of its `Debug` text and of its accelerations at a
//! few times of each phase, as functions of time have no text.

use std::fs::File;
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::dynamics::error::Error;
use crate::io::output::write_file;

/// One run: problem, method, result and cost. Also one row of the CSV file,
/// whose columns have the names of the fields.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Title of the problem.
    pub problem: String,
    /// Name of the line.
    pub line: String,
    /// Family of the line.
    pub family: String,
    /// Name of the point.
    pub point: String,
    /// Relative tolerance.
    pub rtol: f64,
    /// Relative error, root mean square. None for a run that failed, as for the fields that depend on it.
    pub error: Option<f64>,
    /// Relative error, largest.
    pub largest_error: Option<f64>,
    /// Relative error that the reference may have itself.
    pub resolution: f64,
    /// Time of the solution (s), median; for a run that failed, the time until it failed.
    pub seconds: f64,
    /// Processor time of the solution (s), median.
    pub processor_seconds: Option<f64>,
    /// Slowest less fastest repetition, relative to the median.
    pub spread: f64,
    /// Number of repetitions.
    pub repetitions: usize,
    /// Slow-down of the machine, relative to its best.
    pub slowdown: f64,
    /// Unknowns.
    pub states: Option<usize>,
    /// Steps.
    pub steps: Option<usize>,
    /// Evaluations of the right-hand side or residual.
    pub evaluations: Option<usize>,
    /// Factorizations of the Newton matrix.
    pub factorizations: Option<usize>,
    /// Largest change of the energy balance, relative to the largest sum of the energies.
    pub energy_error: Option<f64>,
    /// Reason for the failure of the run.
    pub failure: Option<String>,
    /// Identifies the run; [`Problem::fingerprint`](super::Problem::fingerprint).
    pub fingerprint: String,
}

/// A timing is noisy when repetitions differ by more than this, or the machine was slower than at
/// its best by more than this.
const NOISE: f64 = 0.2;

/// Errors count as sure from this multiple of the reference's resolution on.
const RESOLVED: f64 = 10.0;

impl Row {
    /// Whether the machine had other things to do while the run was timed.
    #[must_use]
    pub fn is_noisy(&self) -> bool {
        self.spread > NOISE || self.slowdown > 1.0 + NOISE
    }

    /// Whether the error is well above the error that the reference may have itself.
    #[must_use]
    pub fn is_resolved(&self) -> bool {
        self.error.is_some_and(|error| error >= RESOLVED * self.resolution)
    }

    pub(super) fn is_same_run(&self, other: &Self) -> bool {
        (&self.fingerprint, &self.line, &self.point)
            == (&other.fingerprint, &other.line, &other.point)
    }
}

/// Reads the rows of a CSV file; none if there is no file.
///
/// # Errors
/// [`Error::Read`] if the file cannot be read or is not such a table.
pub(super) fn read_rows(path: &Path) -> Result<Vec<Row>, Error> {
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(Error::Read { path: path.into(), source: error }),
    };
    let rows: Result<_, csv::Error> = csv::Reader::from_reader(file).into_deserialize().collect();
    rows.map_err(|source| Error::Read { path: path.into(), source: source.into() })
}

/// Writes rows to a CSV file.
///
/// # Errors
/// [`Error::Output`] if it cannot be written.
pub(super) fn write_rows<'a>(
    rows: impl IntoIterator<Item = &'a Row>,
    path: &Path,
) -> Result<(), Error> {
    write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        for row in rows {
            table.serialize(row)?;
        }
        table.flush()
    })
}

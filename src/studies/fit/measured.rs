//! What was measured: a table over time.

use std::io;
use std::path::Path;

use crate::dynamics::error::Error;

/// Numbers measured over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Times (s), as they stand in the table.
    pub times: Vec<f64>,
    /// The name of each column, and its number at each time.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Measured {
    /// Reads a table (CSV) whose first column is `t` or `time` (s); the heads of the others are the names of
    /// sensors, as in `trajectory.csv`: `tip.y`.
    ///
    /// # Errors
    /// [`Error::Read`] for a file that cannot be read, and one that is no such table, with the line.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let failed = |source: io::Error| Error::Read { path: path.into(), source };
        let bad = |message: String| failed(io::Error::other(message));
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_path(path)
            .map_err(|error| failed(error.into()))?;
        let head = reader.headers().map_err(|error| failed(error.into()))?.clone();
        if !head.get(0).is_some_and(|first| ["t", "time"].contains(&first)) {
            let first = head.get(0).unwrap_or_default();
            return Err(bad(format!(
                "its first column is \"{first}\": it must be t or time, in seconds"
            )));
        }
        let mut measured = Self {
            times: Vec::new(),
            columns: head.iter().skip(1).map(|name| (name.into(), Vec::new())).collect(),
        };
        for (number, record) in reader.records().enumerate() {
            let record = record.map_err(|error| failed(error.into()))?;
            for (place, text) in record.iter().enumerate() {
                let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
                let value = value.ok_or_else(|| {
                    let (line, name) = (number + 2, &head[place]);
                    bad(format!("line {line}, column {name}: \"{text}\" is no finite number"))
                })?;
                match place {
                    0 => measured.times.push(value),
                    _ => measured.columns[place - 1].1.push(value),
                }
            }
        }
        Ok(measured)
    }
}

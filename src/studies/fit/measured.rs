//! Measurements: a table over time, or of equilibria.

use std::io;
use std::path::Path;

use csv::StringRecord;

use crate::dynamics::error::Error;
use crate::io::scene_file::SetValue;

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
        let bad = |message: String| unreadable(path, io::Error::other(message));
        let (head, records) = table(path)?;
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
        for (number, record) in records.iter().enumerate() {
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

/// Numbers measured in equilibria, each at other values of keys of the scene: a load curve, or shapes under several loads.
///
/// ```
/// use pliant::fit::MeasuredAtRest;
/// use pliant::scene_file::SetValue;
///
/// let column = |name: &str, values: [f64; 3]| {
///     (name.to_owned(), values.map(|value| SetValue::from_number(value, false)).to_vec())
/// };
/// let pressed = MeasuredAtRest {
///     columns: vec![
///         column("phase.blow.pressure.value", [1e3, 2e3, 3e3]), // a key (Pa)
///         column("tip.y", [-0.011, -0.024, -0.040]), // a sensor (m)
///     ],
/// };
/// # assert_eq!(pressed.columns[1].1[2].number(), Some(-0.040));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredAtRest {
    /// The columns, with a value for each equilibrium. Those with the names of sensors, as in `trajectory.csv`, hold what was
    /// measured, in their units; the others are keys of the scene, with the values that they have there.
    pub columns: Vec<(String, Vec<SetValue>)>,
}

impl MeasuredAtRest {
    /// Reads a table (CSV) each row of which is an equilibrium: its heads are keys of the scene, as `phase.blow.pressure.value`,
    /// and names of sensors, as `tip.y`.
    ///
    /// # Errors
    /// [`Error::Read`] for a file that cannot be read, and one that is no table.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let (head, records) = table(path.as_ref())?;
        let column = |(at, name): (usize, &str)| {
            let cells = records.iter().map(|record| SetValue::read(&record[at]));
            (name.to_owned(), cells.collect())
        };
        Ok(Self { columns: head.iter().enumerate().map(column).collect() })
    }
}

/// The heads and the rows of a table; all rows are as long as the heads.
fn table(path: &Path) -> Result<(StringRecord, Vec<StringRecord>), Error> {
    let failed = |error: csv::Error| unreadable(path, error.into());
    let mut builder = csv::ReaderBuilder::new();
    let mut reader = builder.trim(csv::Trim::All).from_path(path).map_err(failed)?;
    let head = reader.headers().map_err(failed)?.clone();
    Ok((head, reader.records().collect::<Result<_, _>>().map_err(failed)?))
}

fn unreadable(path: &Path, source: io::Error) -> Error {
    Error::Read { path: path.into(), source }
}

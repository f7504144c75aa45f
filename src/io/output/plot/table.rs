//! Columns of numbers over time, or over the load factor, as `trajectory.csv` has them.

use std::fs;
use std::io;
use std::path::Path;

use serde_json::Value;

use crate::base::input::{InputError, unknown_among};
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{DEGREES, LOAD_FACTOR, Quantity, Trajectory};
use crate::elements::mesh::Selection;
use crate::io::output::columns::{
    Columns, DIFFERENCE, EXCHANGED, OF_SENSOR, STORED, standard_unit,
};

/// A motion in numbers: the contents of `trajectory.csv`.
#[derive(Debug, Clone)]
pub struct Table {
    /// Times (s).
    pub(super) times: Vec<f64>,
    pub(super) columns: Vec<Column>,
    /// Phases that were begun: their names, and when they ended (s).
    pub(super) phases: Vec<(String, f64)>,
    /// Title of the scene; empty if it is not known.
    pub(super) title: String,
}

/// A quantity over time.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub(super) quantity: Quantity,
    pub(super) values: Vec<f64>,
}

impl Table {
    /// The columns of [`write_csv`](crate::io::output::write_csv).
    ///
    /// # Errors
    /// A node or set in `track` that does not exist.
    pub fn of(trajectory: &Trajectory, track: Option<&Selection>) -> Result<Self, InputError> {
        let columns = Columns::new(trajectory, track)?;
        let phases = trajectory.report().phases.iter();
        let mut table = Self::empty(columns.quantities(trajectory).into_iter().skip(1));
        table.title.clone_from(&trajectory.report().title);
        table.phases = phases.map(|phase| (phase.name.clone(), phase.end)).collect();
        for sample in trajectory.samples() {
            table.push(&columns.row(trajectory, sample));
        }
        Ok(table)
    }

    /// Output of a run in a directory: `trajectory.csv`, with the units of sensors and the ends of phases
    /// from `report.json`, if that is there. A row that was not written to its end is left out.
    ///
    /// # Errors
    /// [`Error::Read`] if there is no table, or one that no run has written.
    pub fn read(directory: impl AsRef<Path>) -> Result<Self, Error> {
        let path = directory.as_ref().join("trajectory.csv");
        let failed = |source: io::Error| Error::Read { path: path.clone(), source };
        let mut reader = csv::ReaderBuilder::new()
            .flexible(true)
            .from_path(&path)
            .map_err(|error| failed(error.into()))?;
        let report = fs::read(directory.as_ref().join("report.json")).unwrap_or_default();
        let report: Value = serde_json::from_slice(&report).unwrap_or_default();
        let header = reader.headers().map_err(|error| failed(error.into()))?.clone();
        let names: Vec<(&str, bool)> = header.iter().map(Quantity::of_heading).collect();
        if names.first().is_none_or(|(name, _)| *name != "t") {
            return Err(failed(io::Error::other("its first column must be t")));
        }
        let sensors = list(&report, "sensors");
        let unit = |name: &str, in_degrees: bool| {
            if in_degrees {
                return DEGREES.to_owned();
            }
            let sensor = sensors.iter().find(|sensor| sensor["name"] == name);
            let unit = sensor.and_then(|sensor| sensor["unit"].as_str());
            unit.or_else(|| standard_unit(name)).unwrap_or_default().to_owned()
        };
        let named = |&(name, in_degrees): &(&str, bool)| Quantity {
            name: name.into(),
            unit: unit(name, in_degrees),
        };
        let count = names.len();
        let mut table = Self::empty(names.iter().skip(1).map(named));
        let phases = list(&report, "phases").iter();
        let phase = |phase: &Value| Some((phase["name"].as_str()?.into(), phase["end"].as_f64()?));
        table.phases = phases.filter_map(phase).collect();
        table.title = report["title"].as_str().unwrap_or_default().into();
        // the last row may have been cut off
        let mut bad = None;
        for (number, record) in reader.records().enumerate() {
            if let Some(line) = bad {
                return Err(failed(io::Error::other(format!("line {line} is no row of numbers"))));
            }
            let record = record.map_err(|error| failed(error.into()))?;
            let row: Option<Vec<f64>> = record.iter().map(|text| text.parse().ok()).collect();
            match row.filter(|row| row.len() == count) {
                Some(row) => table.push(&row),
                None => bad = Some(number + 2),
            }
        }
        Ok(table)
    }

    fn empty(quantities: impl Iterator<Item = Quantity>) -> Self {
        let column = |quantity| Column { quantity, values: Vec::new() };
        let (times, phases, title) = (Vec::new(), Vec::new(), String::new());
        Self { times, columns: quantities.map(column).collect(), phases, title }
    }

    fn push(&mut self, row: &[f64]) {
        let Some((time, values)) = row.split_first() else { return };
        self.times.push(*time);
        self.columns.iter_mut().zip(values).for_each(|(column, value)| column.values.push(*value));
    }

    /// The values along the horizontal axis, with their name and unit: load factors of a load curve, else times.
    pub(super) fn across(&self) -> (&[f64], &'static str, &'static str) {
        match self.columns.iter().find(|column| column.quantity.name == LOAD_FACTOR) {
            Some(column) => (&column.values, LOAD_FACTOR, "1"),
            None => (&self.times, "time", "s"),
        }
    }

    /// The columns with these names; without names the sensors and the energies that there are.
    ///
    /// # Errors
    /// A name that no column has.
    pub(super) fn chosen(&self, names: Option<&[String]>) -> Result<Vec<&Column>, InputError> {
        let Some(names) = names else {
            let is_sensor = |column: &&Column| {
                let name = &column.quantity.name;
                let is_difference = name == DIFFERENCE || name.ends_with(OF_SENSOR);
                standard_unit(name).is_none() && !is_difference && name != LOAD_FACTOR
            };
            let sensors = self.columns.iter().filter(is_sensor);
            return Ok(sensors.chain(self.energies()).collect());
        };
        let find = |name: &String| {
            let found = self.columns.iter().find(|column| column.quantity.name == *name);
            found.ok_or_else(|| {
                let known: Vec<&str> =
                    self.columns.iter().map(|column| &column.quantity.name[..]).collect();
                let help = unknown_among(name, &known, "table", "columns");
                InputError::new("column", format!("\"{name}\""), help)
            })
        };
        names.iter().map(find).collect()
    }

    /// The difference of a column from the run before, if it is known.
    pub(super) fn difference(&self, column: &Column) -> Option<&Column> {
        let name = Some(&column.quantity.name[..]);
        self.columns.iter().find(|other| other.quantity.name.strip_suffix(OF_SENSOR) == name)
    }

    /// The energies, except those that are 0 throughout.
    fn energies(&self) -> impl Iterator<Item = &Column> {
        let names = STORED.into_iter().chain(EXCHANGED);
        let energies = names
            .filter_map(|name| self.columns.iter().find(|column| column.quantity.name == name));
        energies.filter(|column| column.values.iter().any(|value| *value != 0.0))
    }
}

fn list<'a>(report: &'a Value, key: &str) -> &'a [Value] {
    report[key].as_array().map_or(&[], Vec::as_slice)
}

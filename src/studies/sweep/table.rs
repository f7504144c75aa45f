//! The rows of a study as one table.

use std::path::Path;

use super::row::Row;
use super::run::Sweep;
use super::store::Store;
use crate::dynamics::error::Error;
use crate::io::file::write_file;
use crate::io::scene_file::SetValue;

/// The rows of a study that are there, in the order of its points.
#[derive(Debug, Clone)]
pub struct Results {
    /// The rows.
    pub rows: Vec<Row>,
    /// Number of points without one.
    pub missing: usize,
}

impl Results {
    /// Reads the rows.
    pub fn gather(sweep: &Sweep, store: &Store) -> Self {
        let rows: Vec<Row> =
            sweep.plan().points().filter_map(|point| store.row(&point.id)).collect();
        Self { missing: sweep.plan().len() - rows.len(), rows }
    }

    /// Writes `table.csv`, and of rows that are there `plot.svg` and `sweep.html`, into the directory of the rows. Quantities
    /// have these `units`.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn write(&self, sweep: &Sweep, store: &Store, units: &[&str]) -> Result<(), Error> {
        let path = |name: &str| store.path().join(name);
        self.write_csv(sweep, path("table.csv"))?;
        if !self.rows.is_empty() {
            self.write_plot(sweep, units, path("plot.svg"))?;
            self.write_page(sweep, store, units, path("sweep.html"))?;
        }
        Ok(())
    }

    /// Writes them as CSV: `id`, the keys, the quantities, `verdict`, `warnings`, `failure`, `difference`, `reached`,
    /// `steps`, and at the end the times, which alone differ when a study is run again.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn write_csv(&self, sweep: &Sweep, path: impl AsRef<Path>) -> Result<(), Error> {
        let (keys, quantities) = (sweep.plan().keys(), sweep.quantities());
        let quantities: Vec<&str> = quantities.collect();
        write_file(path.as_ref(), |file| {
            let mut table = csv::Writer::from_writer(file);
            let keys_and_quantities =
                keys.iter().map(String::as_str).chain(quantities.iter().copied());
            table.write_record(["id"].into_iter().chain(keys_and_quantities).chain(LAST))?;
            for row in &self.rows {
                let mut cells = vec![row.id.clone()];
                let value =
                    |key: &String| row.keys.get(key).map(|text| SetValue::read(text).cell());
                cells.extend(keys.iter().map(|key| value(key).unwrap_or_default()));
                let number = |name: &&str| row.quantities.get(*name).copied().flatten();
                cells.extend(quantities.iter().map(|name| cell(number(name))));
                cells.extend([
                    row.verdict.to_string(),
                    row.warnings.join(" "),
                    row.failure.clone().unwrap_or_default(),
                    cell(row.difference),
                    cell(row.reached),
                    row.steps.to_string(),
                    format!("{:.4}", row.cost.wall_seconds),
                    format!("{:.4}", row.cost.processor_seconds),
                ]);
                table.write_record(cells)?;
            }
            table.flush()
        })
    }
}

const LAST: [&str; 8] = [
    "verdict",
    "warnings",
    "failure",
    "difference",
    "reached",
    "steps",
    "wall_seconds",
    "processor_seconds",
];

fn cell(number: Option<f64>) -> String {
    number.map_or_else(String::new, |number| format!("{number:?}"))
}

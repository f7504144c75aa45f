//! A table of all evaluations, which grows with them.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use super::evaluation::Evaluation;
use crate::dynamics::error::Error;
use crate::studies::fit::Unknown;

/// A table (CSV) with a row for each evaluation, on the disk as soon as it is there: its number, the numbers by their keys, the quantities, their
/// derivatives, whether it was the best one so far, and why it failed.
#[derive(Debug)]
pub struct EvaluationTable {
    path: PathBuf,
    keys: Vec<String>,
    quantities: usize,
    rows: usize,
    table: Option<csv::Writer<File>>,
}

impl EvaluationTable {
    /// A table at `path`, for values of these `numbers`. There is no file before the first row.
    pub fn new(path: impl AsRef<Path>, numbers: &[Unknown]) -> Self {
        let keys = numbers.iter().map(|number| number.name.clone()).collect();
        Self { path: path.as_ref().into(), keys, quantities: 0, rows: 0, table: None }
    }

    /// Adds a row. The first one has quantities.
    ///
    /// # Errors
    /// [`Error::Output`] if it cannot be written.
    pub fn add(&mut self, evaluation: &Evaluation) -> Result<(), Error> {
        self.written(evaluation).map_err(|source| Error::Output { path: self.path.clone(), source })
    }

    fn written(&mut self, evaluation: &Evaluation) -> io::Result<()> {
        let Evaluation { values, gradients, is_best } = evaluation;
        let table = match &mut self.table {
            Some(table) => table,
            empty => {
                if let Some(directory) = self.path.parent() {
                    fs::create_dir_all(directory)?;
                }
                let table = empty.insert(csv::Writer::from_path(&self.path)?);
                let of = evaluation.quantities().iter().map(|gradient| &gradient.of[..]);
                self.quantities = of.clone().count();
                let head = ["evaluation"].into_iter().chain(self.keys.iter().map(String::as_str));
                table.write_record(
                    head.map(String::from)
                        .chain(of.clone().map(String::from))
                        .chain(of.flat_map(|of| {
                            self.keys.iter().map(move |key| format!("{of} by {key}"))
                        }))
                        .chain(["best", "failure"].map(String::from)),
                )?;
                table
            }
        };
        let number = |value: &f64| format!("{value:?}");
        let numbers: Vec<String> = match gradients {
            Ok(gradients) => {
                let slopes = gradients.iter().flat_map(|gradient| &gradient.derivatives);
                let own = gradients.iter().map(|gradient| number(&gradient.value));
                own.chain(slopes.map(|by| number(&by.value))).collect()
            }
            Err(_) => vec![String::new(); self.quantities * (1 + self.keys.len())],
        };
        self.rows += 1;
        let failure = gradients.as_ref().err().cloned().unwrap_or_default();
        let row = [self.rows.to_string()].into_iter().chain(values.iter().map(number));
        table.write_record(row.chain(numbers).chain([is_best.to_string(), failure]))?;
        table.flush()
    }
}

//! Equilibria that were measured: what is set for each of them, and what sensors have read there.
//!
//! The equilibria of one set of unknowns are found on all cores, each by itself. The scene tells which column
//! of a table is a sensor and which a key, so that a table is what was measured and nothing else.

use std::path::Path;

use super::measured::MeasuredAtRest;
use super::rows::{Columns, Rows};
use crate::base::input::{InputError, unknown_among};
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::Quantity;
use crate::io::scene_file::{SceneFile, SceneReader, SetValue, problem};

/// The equilibria of a table, whose columns with names of sensors, `known`, were measured; the others are keys of the scene.
///
/// # Errors
/// A column that is neither, or stands twice; no column of a sensor; columns of different lengths; a reading that is no number; a value
/// that the scene does not take.
pub(super) fn equilibria(
    reader: &SceneReader,
    (text, path): (&str, &Path),
    overrides: &[String],
    (measured, known): (&MeasuredAtRest, &[Quantity]),
) -> Result<(Rows, Columns), Error> {
    let count = measured.columns.first().map_or(0, |(_, values)| values.len());
    let (mut keys, mut columns) = (Vec::new(), Vec::new());
    for (at, (name, values)) in measured.columns.iter().enumerate() {
        let bad = |help: &str| InputError::new("column of the data", format!("\"{name}\""), help);
        if measured.columns[..at].iter().any(|(other, _)| other == name) {
            return Err(bad("it stands twice: leave one of them out").into());
        }
        if values.len() != count {
            let help = format!("it has {} values, and the first column {count}", values.len());
            return Err(bad(&help).into());
        }
        if ["t", "time"].contains(&&name[..]) {
            return Err(bad("an equilibrium has no time: leave it out, or fit a motion").into());
        }
        match known.iter().find(|quantity| quantity.heading() == *name) {
            Some(quantity) => columns.push((quantity.clone(), numbers(name, values)?)),
            None => keys.push((&name[..], &values[..])),
        }
    }
    let one = |row: usize| -> Vec<String> {
        keys.iter().map(|(key, values)| format!("{key}={}", values[row])).collect()
    };
    let read = |set: &[String]| reader.parse_with(text, path, &[overrides, set].concat());
    let set: Vec<Vec<String>> = (0..count).map(one).collect();
    for (row, set) in set.iter().enumerate() {
        let Err(error) = read(set) else { continue };
        // the first value that the scene does not take
        let at = (0..keys.len()).find(|&at| read(&set[..=at]).is_err()).unwrap_or_default();
        let Some((name, values)) = keys.get(at) else { return Err(error) };
        let told = problem(read(&set[..=at]).err().unwrap_or(error));
        let input = format!("column \"{name}\" of the data, row {}", row + 1);
        let help = match row {
            0 => format!("{told}; nor is it a sensor: {}", sensors(name, known)),
            _ => told,
        };
        return Err(InputError::new(input, &values[row], help).into());
    }
    if columns.is_empty() {
        let names: Vec<&str> = keys.iter().map(|(name, _)| *name).collect();
        let help = format!("none of them is measured: {}", sensors("", known));
        return Err(InputError::new("columns of the data", names.join(", "), help).into());
    }
    let (label, along) = along(text, path, &keys, count)?;
    Ok((Rows::Equilibria { set, label, along }, columns))
}

/// The sensors that there are, and the one that `name` may mean.
fn sensors(name: &str, known: &[Quantity]) -> String {
    let known: Vec<String> = known.iter().map(Quantity::heading).collect();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    unknown_among(name, &known, "scene", "sensors")
}

fn numbers(name: &str, values: &[SetValue]) -> Result<Vec<f64>, InputError> {
    let number = |(row, value): (usize, &SetValue)| {
        value.number().filter(|number| number.is_finite()).ok_or_else(|| {
            let input = format!("column \"{name}\" of the data, row {}", row + 1);
            InputError::new(input, value, "a measured value is a finite number")
        })
    };
    values.iter().enumerate().map(number).collect()
}

/// The abscissa of equilibria: the first key that is a number, with its unit, or else their own numbers.
fn along(
    text: &str,
    path: &Path,
    keys: &[(&str, &[SetValue])],
    count: usize,
) -> Result<(String, Vec<f64>), Error> {
    let of_key = |(key, values): &(&str, &[SetValue])| {
        let numbers = values.iter().map(SetValue::number).collect::<Option<Vec<f64>>>();
        numbers.map(|numbers| ((*key).to_owned(), numbers))
    };
    let Some((key, numbers)) = keys.iter().find_map(of_key) else {
        return Ok(("equilibrium".into(), (1..=count).map(|row| row as f64).collect()));
    };
    match SceneFile::units(text, path, &[&key])?[..] {
        [unit] if !unit.is_empty() => Ok((format!("{key} ({unit})"), numbers)),
        _ => Ok((key, numbers)),
    }
}

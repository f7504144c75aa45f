//! The points of a study: the values of the keys in each run.
//!
//! A plan is a product of factors from which any point is computed by its number: a million points take no
//! memory. An id is a hash of sorted keys and values in one form, independent of the order of keys, of how
//! numbers are written, and of the rest of the study; numbers of ranges and samples have twelve digits, so
//! that a list of the same numbers has the same ids.

use std::collections::HashMap;
use std::hash::Hasher;
use std::sync::Arc;

use siphasher::sip::SipHasher13;

use super::factor::{Factor, MANY, TOO_MANY, factors, table_path};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::io::scene_file::{SceneFile, SetValue, StudyFile, text_of};

/// The points of a study, in the order of its table: the values of the last key change fastest.
#[derive(Debug, Clone)]
pub struct Plan {
    keys: Arc<[String]>,
    factors: Vec<Factor>,
    count: usize,
}

/// One point: the values of all keys that are varied.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// A hash of the keys and their values, independent of their order and notation, in 16 digits.
    pub id: String,
    /// The keys.
    pub keys: Arc<[String]>,
    /// Their values.
    pub values: Vec<SetValue>,
}

impl Plan {
    /// The points of a study; more than [`MANY`](super::MANY) only if that `is_meant`.
    ///
    /// # Errors
    /// With the line: an empty range, a key that stands twice, a value that stands twice, ranges that nothing fills, a
    /// table that cannot be read, too many points.
    pub fn new(file: &StudyFile, is_meant: bool) -> Result<Self, Error> {
        check_keys(file)?;
        let factors = factors(file, is_meant)?;
        let keys: Vec<String> = factors.iter().flat_map(Factor::keys).map(String::from).collect();
        if keys.is_empty() {
            let help = "name what is to be varied, in [[key]] or in a table";
            return Err(file.error(1, "key", format!("none is varied: {help}")));
        }
        let count =
            factors.iter().try_fold(1_usize, |count, factor| count.checked_mul(factor.len()));
        match count {
            Some(count) if count <= MANY || is_meant => {
                let plan = Self { keys: keys.into(), factors, count };
                plan.check_ids(file)?;
                Ok(plan)
            }
            count => {
                let told =
                    count.map_or("more than can be counted".into(), |count| count.to_string());
                Err(InputError::new("number of runs", told, TOO_MANY).into())
            }
        }
    }

    /// Number of points.
    #[allow(clippy::len_without_is_empty, reason = "no plan is empty")]
    pub fn len(&self) -> usize {
        self.count
    }

    /// The keys that are varied.
    pub fn keys(&self) -> &[String] {
        &self.keys
    }

    /// A point, by its number from 0; numbers beyond the last wrap around.
    pub fn point(&self, number: usize) -> Point {
        let mut rest = number;
        let mut parts: Vec<Vec<SetValue>> = Vec::with_capacity(self.factors.len());
        for factor in self.factors.iter().rev() {
            parts.push(factor.values(rest % factor.len()));
            rest /= factor.len();
        }
        let values: Vec<SetValue> = parts.into_iter().rev().flatten().collect();
        Point { id: id(&self.keys, &values), keys: self.keys.clone(), values }
    }

    /// All points.
    pub fn points(&self) -> impl Iterator<Item = Point> {
        (0..self.count).map(|number| self.point(number))
    }

    pub(super) fn factors(&self) -> &[Factor] {
        &self.factors
    }

    /// # Errors
    /// Two rows of a table that are the same point.
    fn check_ids(&self, file: &StudyFile) -> Result<(), Error> {
        let Some(Factor::Table { keys, rows, lines }) = self.factors.first() else { return Ok(()) };
        let mut seen = HashMap::new();
        for (row, line) in rows.iter().zip(lines) {
            if let Some(first) = seen.insert(id(keys, row), line) {
                let message =
                    format!("this row has the values of line {first}: leave one of them out");
                let (path, line, key) = (table_path(file), *line, String::new());
                return Err(Error::SceneFile { path, line, key, message });
            }
        }
        Ok(())
    }
}

impl Point {
    /// Overrides in the scene file, each as `body.material.young=2e5`.
    pub fn set(&self) -> Vec<String> {
        let pairs = self.keys.iter().zip(&self.values);
        pairs.map(|(key, value)| format!("{key}={value}")).collect()
    }
}

/// A hash of the values, independent of their order and notation.
fn id(keys: &[String], values: &[SetValue]) -> String {
    let pairs = keys.iter().zip(values);
    let mut lines: Vec<String> =
        pairs.map(|(key, value)| format!("{key}={}\n", value.canonical())).collect();
    lines.sort_unstable();
    let mut hasher = SipHasher13::new();
    lines.iter().for_each(|line| hasher.write(line.as_bytes()));
    format!("{:016x}", hasher.finish())
}

/// # Errors
/// A key that stands twice, under any of its names, or within another one.
fn check_keys(file: &StudyFile) -> Result<(), Error> {
    let names: Vec<&str> = file.keys.iter().map(|key| &key.name.text[..]).collect();
    let places = SceneFile::places(&text_of(&file.scene)?, &file.scene, &names)?;
    for (at, (place, key)) in places.iter().zip(&file.keys).enumerate() {
        for (other, before) in places.iter().zip(&file.keys).take(at) {
            let (name, first) = (&key.name.text, &before.name.text);
            let problem = match () {
                _ if place == other && name == first => "it has values already".to_owned(),
                _ if place == other => {
                    format!("it is the same as {first}, which has values already")
                }
                _ if place.starts_with(other) => {
                    format!("it is a part of {first}, which has values already")
                }
                _ if other.starts_with(place) => {
                    format!("{first} is a part of it, and has values already")
                }
                _ => continue,
            };
            let told = format!("{problem} (line {}): leave one of them out", before.name.line);
            return Err(file.error(key.name.line, name, told));
        }
    }
    Ok(())
}

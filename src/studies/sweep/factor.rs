//! Factors of the product that gives the points of a study: lists, ranges, samples of several ranges, rows of a table.

use std::collections::HashSet;
use std::iter;
use std::path::PathBuf;

use super::points::{MOST_AXES, latin_hypercube, sobol};
use crate::base::input::{InputError, check_memory};
use crate::dynamics::error::Error;
use crate::io::scene_file::{
    SampleMethod, SampleRequest, SetValue, Spacing, StudyFile, Varied, VariedKey,
};

/// A study of more runs has to be confirmed.
pub const MANY: usize = 1_000_000;

/// One of the things that are combined with each other.
#[derive(Debug, Clone)]
pub(super) enum Factor {
    /// A key with a list of values.
    List { key: String, values: Vec<SetValue> },
    /// A key with evenly spaced values.
    Range { key: String, range: Range, count: usize, is_whole: bool },
    /// Keys with points that fill their ranges together.
    Sample { keys: Vec<String>, ranges: Vec<Range>, places: Places, count: usize },
    /// Keys with values that belong together, and the lines of the table where they stand.
    Table { keys: Vec<String>, rows: Vec<Vec<SetValue>>, lines: Vec<usize> },
}

/// Distribution of the points of a sample.
#[derive(Debug, Clone)]
pub(super) enum Places {
    /// Key by key.
    Hypercube(Vec<Vec<f64>>),
    /// The axis of each key, and how many points are left out.
    Sobol(Vec<usize>, u64),
}

/// A range of numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    ends: [f64; 2],
    is_logarithmic: bool,
}

impl Range {
    /// The number at a part of it, from 0 to 1; within the range with twelve digits, as those who list values write them.
    fn at(&self, part: f64) -> f64 {
        let [from, to] = self.ends;
        let value = match (part, self.is_logarithmic) {
            (0.0, _) => return from,
            (1.0, _) => return to,
            (_, false) => from + part * (to - from),
            (_, true) => from * (to / from).powf(part),
        };
        short(value)
    }
}

/// A number with twelve digits.
fn short(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

impl Factor {
    pub(super) fn keys(&self) -> impl Iterator<Item = &str> {
        let (one, several) = match self {
            Self::List { key, .. } | Self::Range { key, .. } => (Some(key), None),
            Self::Sample { keys, .. } | Self::Table { keys, .. } => (None, Some(keys)),
        };
        one.into_iter().chain(several.into_iter().flatten()).map(String::as_str)
    }

    /// Number of its points.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::List { values, .. } => values.len(),
            Self::Range { count, .. } | Self::Sample { count, .. } => *count,
            Self::Table { rows, .. } => rows.len(),
        }
    }

    /// The values of its keys at one of its points.
    pub(super) fn values(&self, number: usize) -> Vec<SetValue> {
        match self {
            Self::List { values, .. } => vec![values[number].clone()],
            Self::Range { range, count, is_whole, .. } => {
                let value = range.at(number as f64 / (count - 1).max(1) as f64);
                vec![SetValue::from_number(value, *is_whole)]
            }
            Self::Sample { ranges, places, .. } => {
                let place = |at: usize| match places {
                    Places::Hypercube(places) => places[at][number],
                    Places::Sobol(axes, skip) => sobol(skip + number as u64, axes[at]),
                };
                let value = |(at, range): (usize, &Range)| range.at(place(at));
                let values = ranges.iter().enumerate().map(value);
                values.map(|value| SetValue::from_number(value, false)).collect()
            }
            Self::Table { rows, .. } => rows[number].clone(),
        }
    }
}

/// Factors of a study: its table, its sample, its keys.
pub(super) fn factors(file: &StudyFile, is_meant: bool) -> Result<Vec<Factor>, Error> {
    let mut factors = Vec::new();
    factors.extend(file.table.is_some().then(|| table(file)).transpose()?);
    let is_sampled =
        |key: &&VariedKey| matches!(key.values, Varied::Range { spacing: Spacing::Sampled, .. });
    let sampled: Vec<&VariedKey> = file.keys.iter().filter(is_sampled).collect();
    factors.extend(sample(file, &sampled, is_meant)?);
    for key in file.keys.iter().filter(|key| !is_sampled(key)) {
        factors.push(one(file, key)?);
    }
    Ok(factors)
}

fn one(file: &StudyFile, varied: &VariedKey) -> Result<Factor, Error> {
    let VariedKey { name, values } = varied;
    let bad = |line, problem: String| Err(file.error(line, &name.text, problem));
    match values {
        Varied::Values(values) => {
            if values.is_empty() {
                return bad(name.line, "values = [] is empty: give one value at least".into());
            }
            let mut seen = HashSet::new();
            if let Some((value, line)) = values.iter().find(|one| !seen.insert(one.0.canonical())) {
                return bad(*line, format!("{value} stands twice among its values: leave one out"));
            }
            let values = values.iter().map(|(value, _)| value.clone()).collect();
            Ok(Factor::List { key: name.text.clone(), values })
        }
        Varied::Range { spacing, is_whole, .. } => {
            let range = range(file, varied)?;
            let [from, to] = range.ends;
            let (count, range, is_whole) = match *spacing {
                Spacing::Count(count) if count < 2 => {
                    let help = "a range has two at least; a single value is values = [...]";
                    return bad(name.line, format!("count = {count} is too few: {help}"));
                }
                Spacing::Count(count) => {
                    // whole numbers stay whole if all of them are
                    let step = (to - from) / (count - 1) as f64;
                    (count, range, *is_whole && step.fract() == 0.0)
                }
                Spacing::Step(step) if step <= 0.0 || step.is_nan() => {
                    return bad(name.line, format!("step = {step} must be above 0"));
                }
                Spacing::Step(_) if range.is_logarithmic => {
                    let help = "steps of a logarithmic range are ratios: give its count";
                    return bad(name.line, help.into());
                }
                Spacing::Step(step) => {
                    let steps = ((to - from) / step * (1.0 + 1e-12) + 1e-9).floor();
                    let ends = [from, short(from + steps * step)];
                    (steps as usize + 1, Range { ends, ..range }, *is_whole)
                }
                Spacing::Sampled => (1, range, false),
            };
            Ok(Factor::Range { key: name.text.clone(), range, count, is_whole })
        }
    }
}

/// # Errors
/// An empty range, and one that cannot be logarithmic.
fn range(file: &StudyFile, key: &VariedKey) -> Result<Range, Error> {
    let VariedKey { name, values } = key;
    let Varied::Range { ends, is_logarithmic, .. } = *values else {
        return Err(file.error(name.line, &name.text, "it is no range"));
    };
    let [from, to] = ends;
    let bad = |problem: String| Err(file.error(name.line, &name.text, problem));
    if from >= to || (to - from) < 1e-9 * from.abs().max(to.abs()) {
        return bad(format!(
            "the range from {from:?} to {to:?} is empty: it goes from the least value to the largest"
        ));
    }
    if is_logarithmic && from <= 0.0 {
        return bad(format!("from = {from:?} must be above 0 on a logarithmic scale"));
    }
    Ok(Range { ends, is_logarithmic })
}

/// The ranges that have neither count nor step.
fn sample(
    file: &StudyFile,
    sampled: &[&VariedKey],
    is_meant: bool,
) -> Result<Option<Factor>, Error> {
    let request = match (file.sample, sampled) {
        (None, []) => return Ok(None),
        (None, [key, ..]) => {
            let help =
                "the range has neither count nor step: give it one, or fill it by a table [sample]";
            return Err(file.error(key.name.line, &key.name.text, help));
        }
        (Some(request), []) => {
            let help =
                "no range is left to be sampled: leave count and step out of one, or [sample]";
            return Err(file.error(request.line, "sample", help));
        }
        (Some(request), _) => request,
    };
    let SampleRequest { method, count, seed, line } = request;
    if count == 0 {
        return Err(file.error(line, "sample", "count = 0: there has to be one point at least"));
    }
    if count > MANY && !is_meant {
        return Err(InputError::new("number of runs", count, TOO_MANY).into());
    }
    let keys: Vec<String> = sampled.iter().map(|key| key.name.text.clone()).collect();
    let ranges = sampled.iter().map(|key| range(file, key)).collect::<Result<_, _>>()?;
    let places = match method {
        SampleMethod::LatinHypercube => {
            let bytes = 32.0 * count as f64 * keys.len() as f64;
            check_memory("number of points", count.to_string(), bytes, "take fewer of them")?;
            Places::Hypercube(keys.iter().map(|key| latin_hypercube(count, seed, key)).collect())
        }
        SampleMethod::Sobol if keys.len() > MOST_AXES => {
            let told = format!(
                "{} keys are too many for Sobol's sequence, which has {MOST_AXES} axes here: take a latin-hypercube",
                keys.len()
            );
            return Err(file.error(line, "sample", told));
        }
        SampleMethod::Sobol => {
            // the order of the keys does not count
            let axis = |key: &String| keys.iter().filter(|other| *other < key).count();
            Places::Sobol(keys.iter().map(axis).collect(), seed)
        }
    };
    Ok(Some(Factor::Sample { keys, ranges, places, count }))
}

/// Path of the table of a study.
pub(super) fn table_path(file: &StudyFile) -> PathBuf {
    let name = file.table.as_ref().map_or("", |table| &table.text[..]);
    file.path.parent().map_or_else(|| name.into(), |parent| parent.join(name))
}

pub(super) const TOO_MANY: &str = "that is more than a million: take fewer values, or sample the ranges, or say --yes if it is meant";

/// The rows of the table.
fn table(file: &StudyFile) -> Result<Factor, Error> {
    let path = table_path(file);
    let failed = |source: csv::Error| Error::Read { path: path.clone(), source: source.into() };
    let bad = |line: u64, message: String| {
        let (path, line, key) = (path.clone(), line as usize, String::new());
        Err(Error::SceneFile { path, line, key, message })
    };
    let mut builder = csv::ReaderBuilder::new();
    let mut reader =
        builder.trim(csv::Trim::All).comment(Some(b'#')).from_path(&path).map_err(failed)?;
    let keys: Vec<String> = reader.headers().map_err(failed)?.iter().map(String::from).collect();
    let others = || file.keys.iter().map(|key| &key.name.text);
    let mut seen: HashSet<&str> = HashSet::new();
    for key in &keys {
        let problem = match () {
            _ if key.is_empty() => "a column has no head: it is a key of the scene".into(),
            _ if !seen.insert(key) => format!("two columns have the head {key}: leave one out"),
            _ if others().any(|other| other == key) => {
                format!("{key} has values in the study file, too: leave one of them out")
            }
            _ => continue,
        };
        return bad(1, problem);
    }
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let record = record.map_err(failed)?;
        let line = record.position().map_or(0, csv::Position::line);
        if let Some(at) = record.iter().position(str::is_empty) {
            return bad(line, format!("{}: a value is missing", keys[at]));
        }
        rows.push(record.iter().map(SetValue::read).collect());
        lines.push(line as usize);
    }
    if rows.is_empty() {
        return bad(1, "the table has no rows: each row is a point".into());
    }
    Ok(Factor::Table { keys, rows, lines })
}

/// The values of a key that are worth a look before anything runs, each with its number among those of its factor: all
/// of a list, the ends of a range, all rows of a table.
pub(super) fn looked_at(factor: &Factor) -> Box<dyn Iterator<Item = usize> + '_> {
    match factor {
        Factor::List { .. } | Factor::Table { .. } => Box::new(0..factor.len().min(MOST_LOOKS)),
        Factor::Range { count, .. } => Box::new([0, count - 1].into_iter()),
        Factor::Sample { .. } => Box::new(iter::once(0)),
    }
}

/// More values than these are not looked at beforehand: runs that cannot start are rows, too.
const MOST_LOOKS: usize = 1000;

//! Keys of a scene file, fitted to what sensors of the scene have measured.

use std::fmt;
use std::path::{Path, PathBuf};

use super::least_squares::{Determined, Fitted, least_squares};
use super::measured::Measured;
use super::unknown::Unknown;
use crate::base::input::{InputError, unknown_among};
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Sampling;
use crate::dynamics::trajectory::{Quantity, Trajectory};
use crate::io::output::Chart;
use crate::io::scene_file::{SceneFile, text_of};

/// A scene file, and what was measured of the scene.
///
/// Runs have the tolerance of the file, `solver.rtol`. Measurements outside the time of the scene do not
/// count. If sensors have several units, residuals are divided by the root mean square variation of what was
/// measured in their unit.
#[derive(Debug, Clone)]
pub struct SceneFit {
    text: String,
    path: PathBuf,
    overrides: Vec<String>,
    /// Times of the scene at which something was measured, ascending.
    times: Vec<f64>,
    /// Each sensor that was measured, with its readings at these times.
    columns: Vec<(Quantity, Vec<f64>)>,
    /// What the residuals of each column are divided by.
    scales: Vec<f64>,
    precision: f64,
}

/// A scene whose unknowns were fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFitted {
    /// The unknowns. The root mean squares are over all columns, each weighted.
    pub fitted: Fitted,
    /// Sensors, one by one.
    pub columns: Vec<FittedColumn>,
    times: Vec<f64>,
}

/// The residuals of a sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedColumn {
    /// The sensor.
    pub quantity: Quantity,
    /// Root mean square of the residuals, in its unit: in the middle of the ranges, and at the values that
    /// were found.
    pub rms: [f64; 2],
    /// The model less what was measured, in its unit, over time.
    pub residuals: Vec<f64>,
}

impl SceneFit {
    /// A fit of the scene file at `path`, with other values as [`SceneFile::read_with`] takes them.
    ///
    /// # Errors
    /// As [`SceneFile::read_with`]; a column that no sensor has; no measurement within the time of the scene.
    pub fn new(
        path: impl Into<PathBuf>,
        overrides: &[String],
        measured: &Measured,
    ) -> Result<Self, Error> {
        let path = path.into();
        Self::of_text(text_of(&path)?, path, overrides, measured)
    }

    /// As [`new`](Self::new), of the `text` of a file at `path`.
    ///
    /// # Errors
    /// As there.
    pub fn of_text(
        text: impl Into<String>,
        path: impl Into<PathBuf>,
        overrides: &[String],
        measured: &Measured,
    ) -> Result<Self, Error> {
        let (text, path) = (text.into(), path.into());
        let file = SceneFile::parse_with(&text, &path, overrides)?;
        let end = file.scene.end();
        let mut rows: Vec<usize> = (0..measured.times.len())
            .filter(|&row| (0.0..=end).contains(&measured.times[row]))
            .collect();
        rows.sort_by(|&a, &b| measured.times[a].total_cmp(&measured.times[b]));
        if rows.is_empty() {
            let told = match measured.times[..] {
                [] => "none".into(),
                [first, .., last] => format!("{first} s to {last} s"),
                [only] => format!("{only} s"),
            };
            let help = format!(
                "the scene lasts from 0 to {end} s: move them, or let a phase go on until then"
            );
            return Err(InputError::new("times of the data", told, help).into());
        }
        let times: Vec<f64> = rows.iter().map(|&row| measured.times[row]).collect();
        let known = sensors(&file)?;
        let columns = measured.columns.iter().map(|(name, values)| {
            let quantity = known.iter().find(|quantity| quantity.heading() == *name);
            let quantity = quantity.ok_or_else(|| {
                let known: Vec<String> = known.iter().map(Quantity::heading).collect();
                let known: Vec<&str> = known.iter().map(String::as_str).collect();
                let help = unknown_among(name, &known, "scene", "sensors");
                Error::from(InputError::new("column of the data", format!("\"{name}\""), help))
            })?;
            Ok((quantity.clone(), rows.iter().map(|&row| values[row]).collect()))
        });
        let columns = columns.collect::<Result<Vec<(Quantity, Vec<f64>)>, Error>>()?;
        let scales = columns.iter().map(|(quantity, _)| scale(&columns, &quantity.unit)).collect();
        let precision = file.settings.rtol;
        Ok(Self { text, path, overrides: overrides.into(), times, columns, scales, precision })
    }

    /// Fits keys of the file, as `body.material.young`. `tell` is as in [`least_squares`].
    ///
    /// # Errors
    /// As [`least_squares`]; keys that scene files do not have.
    pub fn fit(
        &self,
        unknowns: &[Unknown],
        tell: &mut dyn FnMut(usize, f64),
    ) -> Result<SceneFitted, Error> {
        let at = |values: &[f64]| {
            let residuals = self.residuals(unknowns, values)?;
            let columns = residuals.iter().zip(&self.scales);
            let weighed = columns
                .map(|(column, scale)| column.iter().map(|residual| residual / scale).collect());
            Ok(weighed.collect())
        };
        let fitted = least_squares(unknowns, self.precision, &at, tell)?;
        let middle: Vec<f64> = unknowns.iter().map(|unknown| unknown.at(0.5)).collect();
        let found: Vec<f64> = fitted.unknowns.iter().map(|found| found.value).collect();
        let [before, after] =
            [self.residuals(unknowns, &middle)?, self.residuals(unknowns, &found)?];
        let columns = self.columns.iter().zip(before.iter().zip(after)).map(
            |((quantity, _), (before, residuals))| FittedColumn {
                quantity: quantity.clone(),
                rms: [super::least_squares::rms(before), super::least_squares::rms(&residuals)],
                residuals,
            },
        );
        Ok(SceneFitted { fitted, columns: columns.collect(), times: self.times.clone() })
    }

    /// The model less what was measured, column by column.
    fn residuals(&self, unknowns: &[Unknown], values: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        let set = unknowns.iter().zip(values).map(|(unknown, value)| set(&unknown.name, *value));
        let overrides: Vec<String> = self.overrides.iter().cloned().chain(set).collect();
        let file = SceneFile::parse_with(&self.text, &self.path, &overrides)?;
        let last = self.times.last().copied().unwrap_or_default();
        let scene = match last > 0.0 {
            true => file.scene.clone().ended_at(last),
            false => file.scene.clone(),
        };
        let sampling = Sampling::at(&*self.times);
        let sampling = file
            .output
            .sensors
            .iter()
            .fold(sampling, |sampling, (name, reading)| sampling.read(name, reading.clone()));
        let motion = scene.simulate(&file.settings, &sampling)?;
        self.columns
            .iter()
            .map(|(quantity, measured)| {
                let sensors = motion.sensors().iter();
                let place = sensors.clone().position(|sensor| sensor.name == quantity.name);
                let place = place.ok_or_else(|| {
                    let known: Vec<&str> = sensors.map(|sensor| &sensor.name[..]).collect();
                    let help = unknown_among(&quantity.name, &known, "scene", "sensors");
                    InputError::new("column of the data", format!("\"{}\"", quantity.name), help)
                })?;
                let pairs = self.times.iter().zip(measured);
                Ok(pairs.map(|(time, measured)| read(&motion, *time, place) - measured).collect())
            })
            .collect()
    }
}

/// What a sensor reads at the sample nearest to `time` (s).
fn read(motion: &Trajectory, time: f64, sensor: usize) -> f64 {
    let samples = motion.samples();
    let after = samples.partition_point(|sample| sample.time < time).min(samples.len() - 1);
    let before = after.saturating_sub(1);
    let off = |at: usize| (samples[at].time - time).abs();
    let nearest = if off(before) < off(after) { before } else { after };
    samples[nearest].sensors[sensor]
}

/// All that the sensors of a file read.
fn sensors(file: &SceneFile) -> Result<Vec<Quantity>, Error> {
    let none = Sampling::phase_ends();
    let sampling = file
        .output
        .sensors
        .iter()
        .fold(none, |sampling, (name, reading)| sampling.read(name, reading.clone()));
    Ok(sampling.columns(&file.scene)?)
}

/// Root mean square variation of all columns of a unit; 1 if all columns have this unit, or these do not
/// vary.
fn scale(columns: &[(Quantity, Vec<f64>)], unit: &str) -> f64 {
    if columns.iter().all(|(quantity, _)| quantity.unit == unit) {
        return 1.0;
    }
    let own =
        || columns.iter().filter(|(quantity, _)| quantity.unit == unit).map(|(_, values)| values);
    let count: usize = own().map(Vec::len).sum();
    let squares = own().flat_map(|values| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(move |value| (value - mean).powi(2))
    });
    match (squares.sum::<f64>() / count as f64).sqrt() {
        0.0 => 1.0,
        scale => scale,
    }
}

/// A value for a key of a scene file.
fn set(key: &str, value: f64) -> String {
    format!("{key}={value:?}")
}

impl SceneFitted {
    /// The values that were found, for keys of the scene file: see [`SceneFile::read_with`].
    pub fn overrides(&self) -> Vec<String> {
        self.fitted.unknowns.iter().map(|found| set(&found.unknown.name, found.value)).collect()
    }

    /// Draws the residuals of each sensor over time.
    ///
    /// # Errors
    /// [`Error::Output`] if the file cannot be written.
    pub fn write_chart(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let chart = Chart::new("What the fit leaves over");
        let chart = chart.axes("time (s)", "model - measured, in the sensor's unit");
        let chart = self.columns.iter().fold(chart, |chart, column| {
            let FittedColumn { quantity: Quantity { name, unit }, residuals, .. } = column;
            let points = self.times.iter().copied().zip(residuals.iter().copied());
            chart.series(format!("{name} ({unit})"), points)
        });
        chart.write(path)
    }
}

impl fmt::Display for SceneFitted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fitted { unknowns, residuals, independent, runs, failed, is_converged, .. } =
            &self.fitted;
        let width =
            unknowns.iter().map(|found| found.unknown.name.chars().count()).max().unwrap_or(0);
        for found in unknowns {
            let Determined { unknown, value, confidence } = found;
            let [least, most] = unknown.range;
            write!(f, "{:width$} = {value:.5e} +- {confidence:.1e} (95 %)", unknown.name)?;
            if found.is_at_end() {
                write!(
                    f,
                    ": at the end of its range, {least:?}..{most:?}; a wider one may fit better"
                )?;
            } else if *confidence > 0.5 * (most - least) {
                write!(f, ": the data hardly tell it within {least:?}..{most:?}")?;
            }
            writeln!(f)?;
        }
        for FittedColumn { quantity: Quantity { name, unit }, rms: [before, after], residuals } in
            &self.columns
        {
            let count = residuals.len();
            writeln!(
                f,
                "{name}: off by {before:.3e} {unit} before, {after:.3e} {unit} after (root mean square of {count})"
            )?;
        }
        if *independent < *residuals as f64 {
            writeln!(
                f,
                "what is left over is alike from one time to the next: {residuals} residuals count as {independent:.0} independent ones"
            )?;
        }
        let end = if *is_converged { "" } else { "; the search has not come to its end" };
        match failed {
            0 => writeln!(f, "{runs} runs{end}")?,
            failed => writeln!(f, "{runs} runs, {failed} of which failed{end}")?,
        }
        let set: Vec<String> = self.overrides().iter().map(|set| format!("--set {set}")).collect();
        write!(f, "{}", set.join(" "))
    }
}

//! Keys of a scene file, fitted to measurements of its sensors, in motion or at rest.

use std::fmt;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::at_rest::equilibria;
use super::least_squares::{Determined, Fitted, least_squares};
use super::measured::{Measured, MeasuredAtRest};
use super::rows::{Columns, Rows};
use super::unknown::Unknown;
use crate::base::input::{InputError, unknown_among};
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Sampling;
use crate::dynamics::trajectory::{Quantity, Trajectory};
use crate::io::output::Chart;
use crate::io::scene_file::{SceneFile, SceneReader, text_of};
use crate::scene::timeline::Scene;

/// The run of a scene, with the settings of its file.
type Run<'a> = &'a mut dyn FnMut(&SceneFile, &Scene, &Sampling) -> Result<Trajectory, Error>;

/// A scene file, and the measurements of the scene.
///
/// Runs have the tolerance of the file, `solver.rtol`, and equilibria `statics.rtol`. Measurements outside the time of the scene do not
/// count. If sensors have several units, residuals are divided by the root mean square variation of what was
/// measured in their unit.
#[derive(Debug, Clone)]
pub struct SceneFit {
    reader: SceneReader,
    text: String,
    path: PathBuf,
    overrides: Vec<String>,
    /// The times or equilibria of the measurements.
    rows: Rows,
    /// The measurements there.
    columns: Columns,
    /// The scale of the residuals of each column.
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
    rows: Rows,
}

/// The residuals of a sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedColumn {
    /// The sensor.
    pub quantity: Quantity,
    /// Root mean square of the residuals, in its unit: in the middle of the ranges, and at the values that
    /// were found.
    pub rms: [f64; 2],
    /// The model less the measurements, in their unit, over time, or equilibrium by equilibrium.
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
        Self::of_text(&SceneReader::default(), text_of(&path)?, path, overrides, measured)
    }

    /// As [`new`](Self::new), of the `text` of a file at `path`, which `reader` reads.
    ///
    /// # Errors
    /// As there.
    pub fn of_text(
        reader: &SceneReader,
        text: impl Into<String>,
        path: impl Into<PathBuf>,
        overrides: &[String],
        measured: &Measured,
    ) -> Result<Self, Error> {
        let (text, path) = (text.into(), path.into());
        let file = reader.parse_with(&text, &path, overrides)?;
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
        let columns = columns.collect::<Result<Columns, Error>>()?;
        let (overrides, rows, precision) =
            (overrides.into(), Rows::Times(times), file.settings.rtol);
        let scales = scales(&columns);
        let reader = reader.clone();
        Ok(Self { reader, text, path, overrides, rows, columns, scales, precision })
    }

    /// A fit of the scene file at `path` to equilibria, each at other values of its keys, as
    /// [`SceneFile::equilibrium`] finds them; with other values for all of them as [`SceneFile::read_with`] takes them.
    ///
    /// ```
    /// use pliant::fit::{MeasuredAtRest, SceneFit, Unknown};
    ///
    /// # let place = tempfile::tempdir().unwrap();
    /// # let [scene, curve] = ["bar.toml", "curve.csv"].map(|name| place.path().join(name));
    /// # std::fs::write(&scene, r#"
    /// #     body = { mesh = { kind = "bar", length = 0.1, nodes = 2 }, area = 1e-4, strain = "cauchy", material = { density = 1e3, young = 1e5, poisson = 0.0, viscosity = 0.0 } }
    /// #     phase = { name = "pull", until = 1.0, hold = { nodes = "left" }, load = { nodes = "right", force = [0.1] } }
    /// #     sensor = { name = "tip", kind = "displacement", nodes = "right" }
    /// # "#).unwrap();
    /// // stretched by F L / (E A) with E = 2e5 Pa
    /// std::fs::write(&curve, "phase.pull.load.force, tip.x\n[0.1], 5e-4\n[0.2], 1e-3\n[0.4], 2e-3\n").unwrap();
    /// let measured = MeasuredAtRest::read(&curve)?;
    /// let young = Unknown::new("body.material.young", 5e4, 1e6);
    /// let fitted = SceneFit::at_rest(&scene, &[], &measured)?.fit(&[young], &mut |_, _| {})?;
    /// assert!((fitted.fitted.unknowns[0].value / 2e5 - 1.0).abs() < 1e-6);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`SceneFile::read_with`]; a column that is neither a sensor nor a key of the scene, or stands twice; no column of a sensor; a
    /// reading that is no number, and a value that the scene does not take, with its row.
    pub fn at_rest(
        path: impl Into<PathBuf>,
        overrides: &[String],
        measured: &MeasuredAtRest,
    ) -> Result<Self, Error> {
        let path = path.into();
        Self::at_rest_of_text(&SceneReader::default(), text_of(&path)?, path, overrides, measured)
    }

    /// As [`at_rest`](Self::at_rest), of the `text` of a file at `path`, which `reader` reads.
    ///
    /// # Errors
    /// As there.
    pub fn at_rest_of_text(
        reader: &SceneReader,
        text: impl Into<String>,
        path: impl Into<PathBuf>,
        overrides: &[String],
        measured: &MeasuredAtRest,
    ) -> Result<Self, Error> {
        let (text, path) = (text.into(), path.into());
        let file = reader.parse_with(&text, &path, overrides)?;
        let known = sensors(&file)?;
        let (rows, columns) = equilibria(reader, (&text, &path), overrides, (measured, &known))?;
        let (overrides, precision) = (overrides.into(), file.statics.options.rtol);
        let scales = scales(&columns);
        let reader = reader.clone();
        Ok(Self { reader, text, path, overrides, rows, columns, scales, precision })
    }

    /// The sum of the squares of all residuals, with other values for some keys, of the motion that `run` gives, or of
    /// equilibria.
    ///
    /// # Errors
    /// As [`SceneFile::read_with`]; those of runs and equilibria.
    #[cfg(feature = "gradient")]
    pub(crate) fn sum_of_squares(&self, set: &[String], run: Run) -> Result<f64, Error> {
        let overrides = [&self.overrides[..], set].concat();
        let weighed = self.columns.iter().zip(&self.scales);
        let residuals = self.residuals_with(&overrides, run)?;
        let terms = residuals.iter().zip(weighed).flat_map(|(column, (_, scale))| {
            column.iter().map(move |residual| (residual / scale).powi(2))
        });
        Ok(terms.sum())
    }

    /// The unit of the residuals, if it is one.
    #[cfg(feature = "gradient")]
    pub(crate) fn unit(&self) -> Option<&str> {
        let first = self.columns.first().map(|(quantity, _)| &quantity.unit[..]);
        first.filter(|unit| self.columns.iter().all(|(quantity, _)| quantity.unit == **unit))
    }

    /// Whether it is of equilibria.
    #[cfg(feature = "gradient")]
    pub(crate) fn is_at_rest(&self) -> bool {
        matches!(self.rows, Rows::Equilibria { .. })
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
        Ok(SceneFitted { fitted, columns: columns.collect(), rows: self.rows.clone() })
    }

    /// The model less the measurements, column by column.
    fn residuals(&self, unknowns: &[Unknown], values: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        let set = unknowns.iter().zip(values).map(|(unknown, value)| set(&unknown.name, *value));
        let overrides: Vec<String> = self.overrides.iter().cloned().chain(set).collect();
        self.residuals_with(&overrides, &mut |file, scene, sampling| {
            scene.simulate(&file.settings, sampling)
        })
    }

    /// The same with these values for keys, of the motion that `run` gives.
    fn residuals_with(&self, overrides: &[String], run: Run) -> Result<Vec<Vec<f64>>, Error> {
        let read = match &self.rows {
            Rows::Times(times) => self.in_motion(overrides, times, run)?,
            Rows::Equilibria { set, .. } => {
                let rows =
                    set.par_iter().map(|set| self.in_equilibrium(&[overrides, set].concat()));
                // of several errors the first one, whichever was found first
                let rows: Vec<_> = rows.collect();
                rows.into_iter().collect::<Result<Vec<Vec<f64>>, Error>>()?
            }
        };
        let columns = self.columns.iter().enumerate().map(|(at, (_, measured))| {
            read.iter().zip(measured).map(|(row, measured)| row[at] - measured).collect()
        });
        Ok(columns.collect())
    }

    /// Readings of the sensors in a motion at some times (s).
    fn in_motion(
        &self,
        overrides: &[String],
        times: &[f64],
        run: Run,
    ) -> Result<Vec<Vec<f64>>, Error> {
        let file = self.reader.parse_with(&self.text, &self.path, overrides)?;
        let last = times.last().copied().unwrap_or_default();
        let scene = match last > 0.0 {
            true => file.scene.clone().ended_at(last),
            false => file.scene.clone(),
        };
        let sampling = Sampling::at(times);
        let sampling = file
            .output
            .sensors
            .iter()
            .fold(sampling, |sampling, (name, reading)| sampling.read(name, reading.clone()));
        let motion = run(&file, &scene, &sampling)?;
        let places = self.places(&motion)?;
        let row = |time: &f64| places.iter().map(|place| read(&motion, *time, *place)).collect();
        Ok(times.iter().map(row).collect())
    }

    /// Readings of the sensors in an equilibrium.
    fn in_equilibrium(&self, overrides: &[String]) -> Result<Vec<f64>, Error> {
        let found = self.reader.parse_with(&self.text, &self.path, overrides)?.equilibrium()?;
        let places = self.places(found.trajectory())?;
        Ok(places.into_iter().map(|place| found.sample().sensors[place]).collect())
    }

    /// Indices of the sensors of the columns among those that were read.
    fn places(&self, motion: &Trajectory) -> Result<Vec<usize>, InputError> {
        let sensors = motion.sensors().iter();
        let place = |(quantity, _): &(Quantity, Vec<f64>)| {
            sensors.clone().position(|sensor| sensor.name == quantity.name).ok_or_else(|| {
                let known: Vec<&str> = sensors.clone().map(|sensor| &sensor.name[..]).collect();
                let help = unknown_among(&quantity.name, &known, "scene", "sensors");
                InputError::new("column of the data", format!("\"{}\"", quantity.name), help)
            })
        };
        self.columns.iter().map(place).collect()
    }
}

/// Reading of a sensor at the sample nearest to `time` (s).
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

/// Scales of the residuals, one for each column.
fn scales(columns: &Columns) -> Vec<f64> {
    columns.iter().map(|(quantity, _)| scale(columns, &quantity.unit)).collect()
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

    /// Draws the residuals of each sensor over time; those of equilibria over the first key that is a number.
    ///
    /// # Errors
    /// [`Error::Output`] if the file cannot be written.
    pub fn write_chart(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let chart = Chart::new("What the fit leaves over");
        let (along, label) = self.rows.along();
        let chart = chart.axes(label, "model - measured, in the sensor's unit");
        let chart = self.columns.iter().fold(chart, |chart, column| {
            let FittedColumn { quantity: Quantity { name, unit }, residuals, .. } = column;
            let points = along.iter().copied().zip(residuals.iter().copied());
            let name = format!("{name} ({unit})");
            match &self.rows {
                Rows::Times(_) => chart.series(name, points),
                Rows::Equilibria { .. } => chart.marked(name, points),
            }
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
                "residuals of successive rows are correlated: {residuals} residuals count as {independent:.0} independent ones"
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

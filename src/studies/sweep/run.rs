//! A study, and the run of one of its points.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use super::factor::{Factor, looked_at, table_path};
use super::plan::{Plan, Point};
use super::row::{Cost, Row, RowVerdict};
use crate::base::input::InputError;
use crate::dynamics::error::{Error, guarded};
use crate::dynamics::simulate::{Sampling, Simulation};
use crate::dynamics::trajectory::{IntegrationFailure, Trajectory};
use crate::io::scene_file::{SceneFile, StudyFile};
use crate::studies::work_precision::Verification;
use crate::studies::work_precision::quantity::Quantity;
use crate::studies::work_precision::timing::Budget;

/// A scene that is run for many values of its keys.
///
/// ```
/// use std::ops::ControlFlow;
/// use pliant::scene_file::StudyFile;
/// use pliant::sweep::Sweep;
///
/// # let directory = tempfile::tempdir().unwrap();
/// # std::fs::copy("scenes/report-8.toml", directory.path().join("scene.toml")).unwrap();
/// let study = r#"
///     scene = "scene.toml"
///     quantities = ["com.y:min"]
///     set = ["phase.1.until=0.05"]
///     [[key]]
///     name = "body.material.young"
///     values = [1e5, 2e5]
/// "#;
/// let study = StudyFile::parse(study, &directory.path().join("study.toml"))?;
/// let sweep = Sweep::new(study, false)?;
/// let point = sweep.plan().point(1);
/// let run = sweep.run(&point, &mut |_| ControlFlow::Continue(())).expect("nothing stops it");
/// assert_eq!(run.row.keys["body.material.young"], "2e5");
/// println!("{:?}", run.row.quantities["com.y:min"]);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Sweep {
    file: StudyFile,
    plan: Plan,
}

/// A run of a point.
#[derive(Debug)]
pub struct PointRun {
    /// Its row.
    pub row: Row,
    /// The scene, and what it asks for; none if it cannot be read.
    pub file: Option<SceneFile>,
    /// The motion, as `pliant run` has it; none if the run did not begin.
    pub motion: Option<Result<Trajectory, Box<IntegrationFailure>>>,
}

/// Names of sensors that read quantities begin so.
const SENSOR: &str = "\u{1}sweep";
/// Times at which swings are looked at.
const LOOKS: usize = 2000;

impl Sweep {
    /// The study of a file; one of more than [`MANY`](super::MANY) runs only if that `is_meant`.
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub fn new(file: StudyFile, is_meant: bool) -> Result<Self, Error> {
        if file.quantities.is_empty() {
            let help = "name one at least, as \"com.y:max\"";
            return Err(file.error(1, "quantities", format!("none is kept: {help}")));
        }
        let plan = Plan::new(&file, is_meant)?;
        Ok(Self { file, plan })
    }

    /// What the file says.
    pub fn file(&self) -> &StudyFile {
        &self.file
    }

    /// The points.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The quantities, as they are named.
    pub fn quantities(&self) -> impl Iterator<Item = &str> {
        self.file.quantities.iter().map(|written| &written.text[..])
    }

    /// The scene of a point.
    ///
    /// # Errors
    /// As [`SceneFile::read_with`].
    pub fn scene(&self, point: &Point) -> Result<SceneFile, Error> {
        let set = self.file.set.iter().map(|written| written.text.clone());
        SceneFile::read_with(&self.file.scene, &set.chain(point.set()).collect::<Vec<_>>())
    }

    /// Checks that the scene of the first point can be run, with its keys and quantities. Returns the units of these.
    ///
    /// # Errors
    /// With the line of the study.
    pub fn check_first(&self) -> Result<Vec<&'static str>, Error> {
        let first = self.plan.point(0);
        self.check_keys(&first)?;
        let scene = self.scene(&first)?;
        let units = self.check_quantities(&scene)?;
        scene.scene.start(&scene.settings)?;
        Ok(units)
    }

    /// As [`check_first`](Self::check_first), and that the scene takes the values of each key: all of a list and of a
    /// table (the first thousand), the ends of a range.
    ///
    /// # Errors
    /// With the line of the study or the table.
    pub fn check(&self) -> Result<Vec<&'static str>, Error> {
        let units = self.check_first()?;
        let mut stride = 1;
        for factor in self.plan.factors().iter().rev() {
            for number in looked_at(factor) {
                let point = self.plan.point(number * stride);
                self.scene(&point).map_err(|error| self.blame(factor, number, error))?;
            }
            stride *= factor.len();
        }
        Ok(units)
    }

    /// # Errors
    /// What is set, or a key of the first point, that the scene does not take.
    fn check_keys(&self, first: &Point) -> Result<(), Error> {
        let mut set = Vec::new();
        SceneFile::read_with(&self.file.scene, &set)?;
        for written in &self.file.set {
            set.push(written.text.clone());
            let read = SceneFile::read_with(&self.file.scene, &set);
            read.map_err(|error| self.at(written.line, "set", error))?;
        }
        for (key, one) in first.keys.iter().zip(first.set()) {
            set.push(one);
            let read = SceneFile::read_with(&self.file.scene, &set);
            read.map_err(|error| self.at(self.line(key), key, error))?;
        }
        Ok(())
    }

    fn check_quantities(&self, scene: &SceneFile) -> Result<Vec<&'static str>, Error> {
        let written = self.file.quantities.iter().enumerate();
        let units = written.map(|(at, written)| {
            let bad = |error: InputError| self.file.error(written.line, "quantities", error);
            let text = &written.text;
            let quantity = Quantity::named(text, &scene.scene, &scene.output.sensors).map_err(bad)?;
            let refuse = |help: String| Err(bad(InputError::new("quantity", format!("\"{text}\""), help)));
            if self.quantities().take(at).any(|other| other == text) {
                return refuse("it stands twice: leave one out".into());
            }
            if quantity.is_over_time() {
                return refuse(format!(
                    "a row has one number of it: add which one, as {text}:end, :max, :min, :frequency or :damping"
                ));
            }
            Ok(quantity.unit())
        });
        units.collect()
    }

    /// The line of a key.
    fn line(&self, key: &str) -> usize {
        let varied = self.file.keys.iter().find(|varied| varied.name.text == key);
        let table = || self.file.table.as_ref().map_or(0, |table| table.line);
        varied.map_or_else(table, |varied| varied.name.line)
    }

    /// Gives an error about a value of a factor its line.
    fn blame(&self, factor: &Factor, number: usize, error: Error) -> Error {
        use crate::io::scene_file::Varied::Values;
        match factor {
            Factor::Table { lines, .. } => Error::SceneFile {
                path: table_path(&self.file),
                line: lines[number],
                key: String::new(),
                message: message(error),
            },
            _ => {
                let key = factor.keys().next().unwrap_or_default();
                let varied = self.file.keys.iter().find(|varied| varied.name.text == key);
                let line = match varied.map(|varied| &varied.values) {
                    Some(Values(values)) => values[number].1,
                    _ => self.line(key),
                };
                self.at(line, key, error)
            }
        }
    }

    /// An error of the scene, at a line of the study.
    fn at(&self, line: usize, key: &str, error: Error) -> Error {
        let message = message(error);
        match message.strip_prefix(key).and_then(|rest| rest.strip_prefix(": ")) {
            Some(problem) => self.file.error(line, key, problem),
            None => self.file.error(line, key, &message),
        }
    }

    /// Runs a point. `observer` is called after each step, and stops the run by [`ControlFlow::Break`]: then there is
    /// no result. A run that fails, or cannot begin, is a row.
    pub fn run(
        &self,
        point: &Point,
        observer: &mut dyn FnMut(&Simulation) -> ControlFlow<()>,
    ) -> Option<PointRun> {
        let (clock, budget) = (Instant::now(), Budget::new(Duration::MAX));
        let found = guarded(|| self.compute(point, observer));
        let found = found.unwrap_or_else(|panic| Err(panic.into()));
        let cost =
            Cost { wall_seconds: clock.elapsed().as_secs_f64(), processor_seconds: budget.spent() };
        let keys = point.keys.iter().cloned();
        let none = self.quantities().map(|name| (name.to_owned(), None));
        let mut row = Row {
            id: point.id.clone(),
            keys: keys.zip(point.values.iter().map(|value| value.text().to_owned())).collect(),
            quantities: none.collect(),
            verdict: RowVerdict::Failed,
            warnings: Vec::new(),
            failure: None,
            difference: None,
            reached: None,
            steps: 0,
            cost,
        };
        let (numbers, file, motion) = match found {
            Ok(found) => found,
            Err(error) => {
                row.failure = Some(error.to_string());
                return Some(PointRun { row, file: None, motion: None });
            }
        };
        let trajectory = match &motion {
            Ok(trajectory) => trajectory,
            Err(failure) if failure.is_interruption() => return None,
            Err(failure) => {
                row.failure = Some(failure.to_string());
                &failure.trajectory
            }
        };
        let report = trajectory.report();
        row.warnings = report.named_warnings().into_iter().map(|(name, _)| name.into()).collect();
        row.warnings.dedup();
        row.difference = report.achieved.as_ref().map(|achieved| achieved.difference);
        row.reached = Some(trajectory.last().time);
        row.steps = report.steps();
        if row.failure.is_none() {
            row.quantities = numbers.into_iter().collect();
            let is_fine = row.warnings.is_empty();
            row.verdict = if is_fine { RowVerdict::Fine } else { RowVerdict::Doubtful };
        }
        Some(PointRun { row, file: Some(file), motion: Some(motion) })
    }

    #[allow(clippy::type_complexity, reason = "taken apart at once")]
    fn compute(
        &self,
        point: &Point,
        observer: &mut dyn FnMut(&Simulation) -> ControlFlow<()>,
    ) -> Result<
        (Vec<(String, Option<f64>)>, SceneFile, Result<Trajectory, Box<IntegrationFailure>>),
        Error,
    > {
        let mut file = self.scene(point)?;
        let within = self.file.accuracy.or(file.accuracy.within);
        if file.accuracy.quantity.is_none() {
            file.accuracy.quantity = self.quantities().next().map(String::from);
        }
        let named = |text: &str| Quantity::named(text, &file.scene, &file.output.sensors);
        let quantities = self.quantities().map(named).collect::<Result<Vec<_>, _>>()?;
        let sampling = sampling(&file, &quantities, within.is_some());
        let result = match within {
            None => {
                let mut simulation = file.scene.start(&file.settings)?;
                simulation.record(&sampling)?;
                simulation.finish(observer)
            }
            Some(within) => {
                Verification::of_file(&file, within)?.sampling(sampling.clone()).finish(observer)
            }
        };
        let mut motion = match result {
            Ok(trajectory) => Ok(trajectory),
            Err(Error::Integration(failure)) => Err(failure),
            Err(error) => return Err(error),
        };
        let trajectory = match &mut motion {
            Ok(trajectory) => trajectory,
            Err(failure) => &mut failure.trajectory,
        };
        let numbers = self.quantities().zip(&quantities).enumerate();
        let numbers =
            numbers.map(|(at, (name, quantity))| (name.into(), read(trajectory, quantity, at)));
        let numbers = numbers.collect();
        trajectory.drop_sensors(|name| name.starts_with(SENSOR));
        let ends: Vec<f64> =
            file.scene.phases().iter().map(crate::scene::timeline::Phase::end).collect();
        trajectory
            .keep_samples(|sample| !sampling.is_extra(sample.time) || ends.contains(&sample.time));
        file.explain(trajectory);
        Ok((numbers, file, motion))
    }
}

/// What is sampled: what the scene asks for, and the quantities.
fn sampling(file: &SceneFile, quantities: &[Quantity], is_verified: bool) -> Sampling {
    let end = file.scene.end();
    let mut sampling = match is_verified {
        false => file.output.sampling(),
        true => file.output.verified_sampling(end),
    };
    if quantities.iter().any(Quantity::is_of_swings) {
        let times: Vec<f64> = (1..LOOKS).map(|k| end * (k as f64 / LOOKS as f64)).collect();
        sampling = match is_verified {
            false => sampling.also_at(times),
            // verified runs have extra times of their own
            true => {
                let sensors = file.output.sensors.iter().cloned();
                sensors.fold(Sampling::at(times), |all, (name, reading)| all.read(name, reading))
            }
        };
    }
    for (at, quantity) in quantities.iter().enumerate() {
        if let Some(reading) = quantity.read_for_it() {
            sampling = sampling.read(format!("{SENSOR}{at}"), reading.clone());
        }
    }
    match quantities.iter().any(Quantity::is_peak) {
        true => sampling.finding_peaks(),
        false => sampling,
    }
}

/// The number of the quantity that sensor `at` reads.
fn read(motion: &Trajectory, quantity: &Quantity, at: usize) -> Option<f64> {
    let name = format!("{SENSOR}{at}");
    // a vector on a line has one component, which the name of its column has, too
    let is_own = |column: &str| {
        column.strip_prefix(&name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    let column = motion.sensors().iter().position(|sensor| is_own(&sensor.name))?;
    let samples = motion.samples().iter();
    let (times, series): (Vec<f64>, Vec<f64>) =
        samples.map(|sample| (sample.time, sample.sensors[column])).unzip();
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let read = motion.peaks.get(column).copied().unwrap_or(none);
    quantity.number(&times, &series, read).filter(|number| number.is_finite())
}

/// An error without the place where it was found.
fn message(error: Error) -> String {
    match error {
        Error::SceneFile { path, key, message, .. } if path == Path::new("--set") => match &key[..]
        {
            "" => message,
            key => format!("{key}: {message}"),
        },
        Error::Input(InputError { input, value, help }) if input == "--set" => {
            format!("{value}: {help}")
        }
        error => error.to_string(),
    }
}

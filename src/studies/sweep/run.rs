//! A study, and the run of one of its points.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use super::factor::{Factor, looked_at, table_path};
use super::outcome::{self, Computed, Outcome};
use super::plan::{Plan, Point};
use super::row::{Cost, Row, RowVerdict};
use crate::base::input::InputError;
use crate::dynamics::error::{Error, guarded};
use crate::dynamics::simulate::Simulation;
use crate::io::scene_file::{SceneFile, SceneReader, StudyFile, problem};
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
    reader: SceneReader,
}

/// A run of a point.
#[derive(Debug)]
pub struct PointRun {
    /// Its row.
    pub row: Row,
    /// The scene, and its requests; none if it cannot be read.
    pub file: Option<SceneFile>,
    /// Its outcome; none if the run did not begin.
    pub outcome: Option<Outcome>,
}

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
        if let (true, Some(accuracy)) = (file.is_static, file.accuracy) {
            let help =
                "equilibria are found to `rtol` of [statics] of the scene: leave accuracy out";
            return Err(InputError::new("accuracy of equilibria", accuracy.0, help).into());
        }
        let plan = Plan::new(&file, is_meant)?;
        Ok(Self { file, plan, reader: SceneReader::default() })
    }

    /// With scenes that `reader` reads, as those with devices of a program.
    #[must_use]
    pub fn read_by(self, reader: SceneReader) -> Self {
        Self { reader, ..self }
    }

    /// Contents of the study file.
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
        self.read(&set.chain(point.set()).collect::<Vec<_>>())
    }

    /// The scene with these values.
    pub(super) fn read(&self, set: &[String]) -> Result<SceneFile, Error> {
        self.reader.read_with(&self.file.scene, set)
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
        match self.file.is_static {
            true => scene.check_equilibrium()?,
            false => _ = scene.scene.start(&scene.settings)?,
        }
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
    /// An override, or a key of the first point, that the scene does not take.
    fn check_keys(&self, first: &Point) -> Result<(), Error> {
        let mut set = Vec::new();
        self.read(&set)?;
        for written in &self.file.set {
            set.push(written.text.clone());
            let read = self.read(&set);
            read.map_err(|error| self.at(written.line, "set", error))?;
        }
        for (key, one) in first.keys.iter().zip(first.set()) {
            set.push(one);
            let read = self.read(&set);
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
            if self.file.is_static {
                quantity.at_rest(&scene.scene).map_err(bad)?;
            } else if quantity.is_over_time() {
                return refuse(format!(
                    "a row has one number of it: add which one, as {text}:end, :max, :min, :mean, :frequency or :damping"
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
                message: problem(error),
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
        let message = problem(error);
        match message.strip_prefix(key).and_then(|rest| rest.strip_prefix(": ")) {
            Some(problem) => self.file.error(line, key, problem),
            None => self.file.error(line, key, &message),
        }
    }

    /// Runs a point, or finds its equilibrium if that is the kind of study. `observer` is called after each step of a run, and stops it by
    /// [`ControlFlow::Break`]: then there is no result. A failed run, or one that cannot begin, is a row, too.
    pub fn run(
        &self,
        point: &Point,
        observer: &mut dyn FnMut(&Simulation) -> ControlFlow<()>,
    ) -> Option<PointRun> {
        let (clock, budget) = (Instant::now(), Budget::new(Duration::MAX));
        let compute = || {
            let scene = self.scene(point)?;
            match self.file.is_static {
                true => outcome::equilibrium(scene, &self.file),
                false => outcome::motion(scene, &self.file, observer),
            }
        };
        let found = guarded(compute).unwrap_or_else(|panic| Err(panic.into()));
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
        let Computed { file, numbers, outcome } = match found {
            Ok(found) => found,
            Err(error) => {
                row.failure = Some(error.to_string());
                return Some(PointRun { row, file: None, outcome: None });
            }
        };
        if outcome.is_interruption() {
            return None;
        }
        let trajectory = outcome.trajectory();
        row.failure = outcome.failure();
        row.warnings = outcome.warnings();
        row.difference = trajectory.report().achieved.as_ref().map(|achieved| achieved.difference);
        row.reached = Some(outcome.reached());
        row.steps = outcome.steps();
        if row.failure.is_none() {
            row.quantities = self.quantities().map(String::from).zip(numbers).collect();
            let is_fine = row.warnings.is_empty();
            row.verdict = if is_fine { RowVerdict::Fine } else { RowVerdict::Doubtful };
        }
        Some(PointRun { row, file: Some(file), outcome: Some(outcome) })
    }
}

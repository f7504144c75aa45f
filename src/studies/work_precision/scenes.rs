//! A scene and its variants as a problem.

use std::time::Duration;

use super::quantity::Quantity;
use super::truth::{Probe, Truth, reason, shared_nodes};
use super::{Failed, Line, Measured, Point, Problem, fingerprint};
use crate::base::input::{InputError, positive};
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Sampling;
use crate::scene::settings::{Method, Settings};
use crate::scene::timeline::Scene;

/// A scene that is solved in several ways: by several methods at several tolerances, with another
/// strain model or other cells, on finer and finer meshes.
///
/// All ways are compared with the exact motion of the scene given to [`new`](Self::new). Where a line
/// solves another scene, its error thus includes the difference of the scenes.
#[derive(Debug)]
pub struct Scenes {
    title: String,
    quantity: Quantity,
    alpha: f64,
    finest: f64,
    tolerances: Vec<f64>,
    lines: Vec<Line>,
    /// As `lines`, point by point.
    runs: Vec<Vec<SceneRun>>,
    /// The scene of the reference first.
    scenes: Vec<Scene>,
    fingerprints: Vec<u64>,
    /// Position of the scene that checks the reference.
    check: Option<usize>,
    reference: Option<Reference>,
}

/// Scene and settings of a run.
#[derive(Debug)]
struct SceneRun {
    /// Position among the scenes.
    scene: usize,
    settings: Settings,
}

#[derive(Debug)]
struct Reference {
    truth: Truth,
    /// As the scenes.
    probes: Vec<Probe>,
}

impl Scenes {
    /// A scene whose exact motion is the reference, and no lines yet.
    pub fn new(title: impl Into<String>, scene: Scene) -> Self {
        Self {
            title: title.into(),
            quantity: Quantity::motion(),
            alpha: Settings::default().alpha,
            finest: 1e-7,
            tolerances: (2..=8).map(|digits| 10_f64.powi(-digits)).collect(),
            lines: Vec::new(),
            runs: Vec::new(),
            fingerprints: vec![fingerprint::of_scene(&scene)],
            scenes: vec![scene],
            check: None,
            reference: None,
        }
    }

    /// Quantity in which errors are measured. Default: the whole motion.
    #[must_use]
    pub fn quantity(mut self, quantity: Quantity) -> Self {
        self.quantity = quantity;
        self
    }

    /// Rate of the constraint stabilization (1/s) in the reference, and in the lines that
    /// [`all_methods`](Self::all_methods) adds from now on. It is a part of the model: lines with another
    /// alpha move differently. Default: 1e3.
    #[must_use]
    pub fn alpha(mut self, alpha: f64) -> Self {
        self.alpha = alpha;
        self
    }

    /// The least error that is to be measured: the reference is made thirty times better, if that
    /// is possible. Default: 1e-7.
    #[must_use]
    pub fn finest(mut self, error: f64) -> Self {
        self.finest = error;
        self
    }

    /// Relative tolerances of the lines added from now on, from rough to fine. Default: 1e-2, 1e-3,
    /// ..., 1e-8.
    #[must_use]
    pub fn tolerances(mut self, tolerances: impl Into<Vec<f64>>) -> Self {
        self.tolerances = tolerances.into();
        self
    }

    /// Adds a line: the scene by `settings`, tolerance by tolerance. Its method is its family.
    #[must_use]
    pub fn line(self, name: impl Into<String>, settings: Settings) -> Self {
        self.by_tolerance(name.into(), settings.method.family().name(), 0, settings)
    }

    /// Adds a line for each of [`all_methods`].
    #[must_use]
    pub fn all_methods(self) -> Self {
        let alpha = self.alpha;
        all_methods().into_iter().fold(self, |scenes, (name, settings)| {
            scenes.line(name, Settings { alpha, ..settings })
        })
    }

    /// Adds a line: another scene by `settings`, tolerance by tolerance. The name is its family.
    #[must_use]
    pub fn variant(mut self, name: impl Into<String>, scene: Scene, settings: Settings) -> Self {
        let name = name.into();
        let scene = self.add(scene);
        self.by_tolerance(name.clone(), &name, scene, settings)
    }

    /// Adds a line: the scene on finer and finer meshes, each with the name of the mesh, by
    /// `settings`. Its name is its family.
    #[must_use]
    pub fn meshes<N: Into<String>>(
        mut self,
        name: impl Into<String>,
        meshes: impl IntoIterator<Item = (N, Scene)>,
        settings: &Settings,
    ) -> Self {
        let name = name.into();
        let (mut points, mut runs) = (Vec::new(), Vec::new());
        for (mesh, scene) in meshes {
            points.push(Point { name: mesh.into(), rtol: settings.rtol });
            runs.push(SceneRun { scene: self.add(scene), settings: settings.clone() });
        }
        self.lines.push(Line { family: name.clone(), name, points });
        self.runs.push(runs);
        self
    }

    /// Checks the reference by another scene that should move alike, for example the same on a mesh half as
    /// fine: its distance from the reference counts as resolution.
    #[must_use]
    pub fn checked_by(mut self, scene: Scene) -> Self {
        self.check = Some(self.add(scene));
        self
    }

    fn add(&mut self, scene: Scene) -> usize {
        self.fingerprints.push(fingerprint::of_scene(&scene));
        self.scenes.push(scene);
        self.scenes.len() - 1
    }

    fn by_tolerance(
        mut self,
        name: String,
        family: &str,
        scene: usize,
        settings: Settings,
    ) -> Self {
        let point = |&rtol: &f64| Point { name: format!("{rtol:e}"), rtol };
        let points = self.tolerances.iter().map(point).collect();
        let run = |&rtol: &f64| SceneRun { scene, settings: Settings { rtol, ..settings.clone() } };
        self.runs.push(self.tolerances.iter().map(run).collect());
        self.lines.push(Line { name, family: family.into(), points });
        self
    }

    fn validate(&self) -> Result<(), InputError> {
        if !(self.finest > 0.0 && self.finest < 1.0) {
            let help = "a relative error lies above 0 and below 1 (1e-7 is usual)";
            return Err(InputError::new("finest", self.finest, help));
        }
        positive("alpha", self.alpha, "1/s")?;
        let end = self.scenes[0].end();
        for scene in &self.scenes {
            scene.validate()?;
            self.quantity.check(scene)?;
            if scene.end() != end {
                let help = format!("all scenes that are compared end together, at {end} s here");
                return Err(InputError::new("end of a scene", format!("{} s", scene.end()), help));
            }
        }
        for (number, line) in self.lines.iter().enumerate() {
            if self.lines[..number].iter().any(|other| other.name == line.name) {
                let help = "another line has it: name it otherwise";
                return Err(InputError::new("name of a line", format!("\"{}\"", line.name), help));
            }
        }
        self.runs.iter().flatten().try_for_each(|run| run.settings.validate())
    }

    fn find_reference(
        &self,
        limit: Duration,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Reference, Error> {
        self.validate()?;
        let scenes: Vec<&Scene> = self.scenes.iter().collect();
        let probes: Vec<Probe> = shared_nodes(&scenes)?
            .into_iter()
            .map(|nodes| Probe::new(&self.scenes[0], self.quantity.clone(), nodes))
            .collect();
        let check = self.check.map(|k| (&self.scenes[k], &probes[k]));
        let target = self.finest / 30.0;
        let truth =
            Truth::find(&self.scenes[0], &probes[0], check, self.alpha, target, limit, tell)?;
        Ok(Reference { truth, probes })
    }
}

/// Name and settings of all methods: each of [`Method::ALL`], of some with further orders, and CVODE's BDF also with detection
/// of the stability limits of its higher orders.
#[must_use]
pub fn all_methods() -> Vec<(String, Settings)> {
    let mut lines = Vec::new();
    for method in Method::ALL {
        let settings = Settings { method, ..Settings::default() };
        lines.push((method.name().to_owned(), settings.clone()));
        for order in method.information().charted_orders {
            let settings = Settings { max_order: Some(*order), ..settings.clone() };
            lines.push((format!("{method}, order {order}"), settings));
        }
        if method == Method::CvodeBdf {
            let settings = Settings { stability_limit_detection: true, ..settings };
            lines.push((format!("{method}, stability limit"), settings));
        }
    }
    lines
}

impl Problem for Scenes {
    fn title(&self) -> &str {
        &self.title
    }

    fn lines(&self) -> &[Line] {
        &self.lines
    }

    fn fingerprint(&self, line: usize, point: usize) -> u64 {
        let SceneRun { scene, settings } = &self.runs[line][point];
        let scenes = [*scene, 0].into_iter().chain(self.check);
        let fingerprints: Vec<u64> = scenes.map(|scene| self.fingerprints[scene]).collect();
        fingerprint::of_text(
            format_args!("{settings:?} {} {} {:?}", self.alpha, self.finest, self.quantity),
            &fingerprints,
        )
    }

    fn prepare(&mut self, limit: Duration, tell: &mut dyn FnMut(&str)) -> Result<f64, Error> {
        let reference = self.find_reference(limit, tell)?;
        Ok(self.reference.insert(reference).truth.resolution)
    }

    fn measure(&mut self, line: usize, point: usize, limit: Duration) -> Result<Measured, Failed> {
        let SceneRun { scene, settings } = &self.runs[line][point];
        let Reference { truth, probes } =
            self.reference.as_ref().ok_or("the study was not prepared")?;
        let (seen, trajectory) =
            probes[*scene].run(&self.scenes[*scene], settings, limit).map_err(reason)?;
        let distance = truth.error(&seen);
        let report = trajectory.report();
        Ok(Measured {
            error: distance.mean,
            largest_error: distance.largest,
            seconds: report.wall_seconds,
            states: report.states,
            steps: report.steps(),
            evaluations: report.evaluations(),
            factorizations: report.factorizations(),
            energy_error: Some(report.energy_error / report.energy_scale.max(f64::MIN_POSITIVE)),
        })
    }

    fn time(&mut self, line: usize, point: usize) -> Result<f64, Failed> {
        let SceneRun { scene, settings } = &self.runs[line][point];
        let trajectory =
            self.scenes[*scene].simulate(settings, &Sampling::phase_ends()).map_err(reason)?;
        Ok(trajectory.report().wall_seconds)
    }
}

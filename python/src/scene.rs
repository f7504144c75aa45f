//! Scenes, as the reader of scene files makes them.

use std::path::PathBuf;

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pliant::fit::{Measured, MeasuredAtRest, SceneFit, Unknown};
use pliant::gradient::{Objective, SceneGradient};
use pliant::optimize::{Aim, SceneOptimizer};
use pliant::scene_file::{SetValue, override_of, toml_of as toml_of_scene};
use pliant::study::{Adviser, Quantity, Scenes, Study, Verification, all_methods};
use pliant::{Error, Mesh, Part, ReducedModel, SceneFile, SceneReader, Settings, Trajectory};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::vectors;
use crate::errors::{made, raised};
use crate::motion::Motion;
use crate::reduced::Reduced;
use crate::simulation::Simulation;
use crate::watch::Watch;

/// A scene with how it is run: the text of a scene file, with other values for some of its keys.
#[pyclass(frozen, module = "pliant._pliant")]
pub struct Scene {
    text: String,
    path: PathBuf,
    overrides: Vec<String>,
    file: SceneFile,
    /// A reduced model that is in no file.
    model: Option<ReducedModel>,
}

impl Scene {
    fn read(
        text: String,
        path: PathBuf,
        overrides: Vec<String>,
        model: Option<ReducedModel>,
    ) -> Result<Self, Error> {
        let mut file = SceneFile::parse_with(&text, &path, &overrides)?;
        if let Some(model) = &model {
            file.scene = file.scene.reduced(model.clone())?;
        }
        Ok(Self { text, path, overrides, file, model })
    }

    /// # Errors
    /// A reduced model that is in no file, so that no text names it.
    fn check_file(&self) -> PyResult<()> {
        match self.model {
            Some(_) => Err(PyValueError::new_err(
                "its reduced model is in no file: write it, and take scene.reduced(path)",
            )),
            None => Ok(()),
        }
    }

    fn motion(&self, mut trajectory: Trajectory, failure: Option<String>) -> Motion {
        self.file.explain(&mut trajectory);
        Motion::new(trajectory, self.file.title.clone(), failure)
    }

    /// Runs the scene as `file` says, to its accuracy if it has one.
    fn moved(&self, file: &SceneFile, watch: &mut Watch) -> Result<Motion, Error> {
        let moved = match file.accuracy.within {
            Some(within) => Verification::of_file(file, within)?
                .finish(|simulation| watch.see(simulation.time())),
            None => {
                let seen = |progress: &pliant::simulate::Progress| watch.see(progress.time);
                file.scene.simulate_with(&file.settings, &file.output.sampling(), seen)
            }
        };
        match moved {
            Ok(trajectory) => Ok(self.motion(trajectory, None)),
            // what was computed before it was stopped from outside
            Err(Error::Integration(failure)) if failure.is_interruption() => {
                let text = failure.to_string();
                Ok(self.motion(failure.trajectory, Some(text)))
            }
            Err(error) => Err(error),
        }
    }
}

#[pymethods]
impl Scene {
    /// The scene of a text that is or could be in the file `path`; `values` are pairs of a key, as in
    /// `phase.free.until`, and a value as JSON.
    #[new]
    fn new(text: String, path: PathBuf, values: Vec<(String, String)>) -> PyResult<Self> {
        let overrides = values.iter().map(|(key, value)| overriding(key, value));
        Self::read(text, path, overrides.collect::<PyResult<_>>()?, None).map_err(raised)
    }

    /// The scene with other values for some keys, in addition to those that it has.
    fn with_values(&self, values: Vec<(String, String)>) -> PyResult<Self> {
        let mut overrides = self.overrides.clone();
        for (key, value) in &values {
            overrides.push(overriding(key, value)?);
        }
        let (text, path) = (self.text.clone(), self.path.clone());
        Self::read(text, path, overrides, self.model.clone()).map_err(raised)
    }

    /// Learns a reduced model over ranges of keys: each its least, its most, and how many values are learned.
    fn reduce(
        &self,
        py: Python<'_>,
        within: f64,
        vary: Vec<(String, f64, f64, Option<usize>)>,
        hold_out: usize,
        most: usize,
        modes: bool,
    ) -> PyResult<Reduced> {
        let Self { text, path, overrides, .. } = self;
        let read = |set: &[String]| SceneFile::parse_with(text, path, &[overrides, set].concat());
        let mut watch = Watch::new(None);
        let observer = &mut |_: &str| watch.see(0.0);
        let sizes = [hold_out, most];
        let learned = py.detach(|| Reduced::learn(&read, within, vary, sizes, modes, observer));
        watch.check(py)?;
        learned.map_err(raised)
    }

    /// The scene by a reduced model of it, or with all its unknowns.
    fn reduced(&self, reduced: Option<&Reduced>) -> PyResult<Self> {
        let mut overrides = self.overrides.clone();
        overrides.push(overriding("solver.reduced", "\"\"")?);
        let model = reduced.map(|reduced| reduced.learned.model.clone());
        Self::read(self.text.clone(), self.path.clone(), overrides, model).map_err(raised)
    }

    /// The text, with other values written into it.
    fn to_toml(&self) -> PyResult<String> {
        SceneFile::written_with(&self.text, &self.overrides).map_err(raised)
    }

    /// The same with the whole paths of files that it names, so that it may stand anywhere.
    fn to_toml_anywhere(&self) -> PyResult<String> {
        self.check_file()?;
        SceneFile::moved_with(&self.text, &self.path, &self.overrides).map_err(raised)
    }

    #[getter]
    fn title(&self) -> &str {
        &self.file.title
    }

    #[getter]
    fn end(&self) -> f64 {
        self.file.scene.end()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.file.notes.clone()
    }

    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mesh = self.file.scene.body().mesh();
        vectors(py, mesh.positions().to_vec(), mesh.dimension())
    }

    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        cells(py, self.file.scene.body().mesh())
    }

    /// The word for the cells.
    #[getter]
    fn cell_kind(&self) -> &'static str {
        self.file.scene.body().mesh().kind().word()
    }

    /// The bodies: their names, nodes, cells, words for the cells, and node sets.
    #[allow(clippy::type_complexity)]
    fn bodies<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<
        Vec<(
            String,
            Bound<'py, PyArray2<f64>>,
            Bound<'py, PyArray2<i64>>,
            &'static str,
            Bound<'py, PyDict>,
        )>,
    > {
        let of_part = |Part { name, body, .. }: Part| {
            let mesh = body.mesh();
            let nodes = vectors(py, mesh.positions().to_vec(), mesh.dimension())?;
            Ok((name.into(), nodes, cells(py, mesh)?, mesh.kind().word(), sets(py, mesh)?))
        };
        self.file.scene.body().parts().map(of_part).collect()
    }

    /// Node sets: names and nodes, from 0.
    fn sets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        sets(py, self.file.scene.body().mesh())
    }

    /// Runs the scene; `step` or `times` (s) replace those of `[output]`.
    #[pyo3(signature = (progress = None, step = None, times = None))]
    fn run(
        &self,
        py: Python<'_>,
        progress: Option<Py<PyAny>>,
        step: Option<f64>,
        times: Option<Vec<f64>>,
    ) -> PyResult<Motion> {
        let mut watch = Watch::new(progress);
        let mut file = self.file.clone();
        if step.is_some() || times.is_some() {
            (file.output.step, file.output.times) = (step, times);
        }
        let motion = py.detach(|| self.moved(&file, &mut watch));
        watch.check(py)?;
        motion.map_err(raised)
    }

    /// The equilibrium of the phase that `[statics]` names.
    fn equilibrium(&self, py: Python<'_>) -> PyResult<(Motion, String)> {
        let found = py.detach(|| self.file.equilibrium()).map_err(raised)?;
        let report = pliant::output::static_report(Ok(&found)).to_string();
        Ok((self.motion(found.trajectory().clone(), None), report))
    }

    /// Recommended settings for the scene: the advice as text and as JSON.
    #[pyo3(signature = (within, quantity = None, budget = None, progress = None))]
    fn advise(
        &self,
        py: Python<'_>,
        within: f64,
        quantity: Option<String>,
        budget: Option<f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(String, String)> {
        let SceneFile { scene, settings, output, .. } = &self.file;
        let quantity =
            Quantity::named(quantity.as_deref().unwrap_or("motion"), scene, &output.sensors);
        let quantity = quantity.map_err(raised)?;
        let mut watch = Watch::new(progress);
        let advice = py.detach(|| {
            let mut adviser =
                Adviser::new(scene, within).settings(settings.clone()).quantity(quantity);
            if let Some(seconds) = budget {
                adviser = adviser.budget(seconds);
            }
            adviser.run(&mut |_| watch.see(0.0))
        });
        watch.check(py)?;
        advice.map(|advice| (advice.to_string(), advice.to_json().to_string())).map_err(raised)
    }

    /// Fits keys, each with the least and the most that it may be, to what was measured: times (s) and readings by the
    /// names of sensors.
    fn fit(
        &self,
        py: Python<'_>,
        times: Vec<f64>,
        columns: Vec<(String, Vec<f64>)>,
        unknowns: Vec<(String, f64, f64)>,
    ) -> PyResult<FoundByFit> {
        let measured = Measured { times, columns };
        let fit = || {
            SceneFit::of_text(
                &SceneReader::default(),
                &*self.text,
                &self.path,
                &self.overrides,
                &measured,
            )
        };
        fitted(py, fit, unknowns)
    }

    /// As `fit`, to equilibria: values of keys and readings, as JSON.
    fn fit_at_rest(
        &self,
        py: Python<'_>,
        columns: Vec<(String, Vec<String>)>,
        unknowns: Vec<(String, f64, f64)>,
    ) -> PyResult<FoundByFit> {
        let of_column = |(name, values): (String, Vec<String>)| {
            (name, values.iter().map(|value| SetValue::read(value)).collect())
        };
        let measured = MeasuredAtRest { columns: columns.into_iter().map(of_column).collect() };
        let fit = || {
            SceneFit::at_rest_of_text(
                &SceneReader::default(),
                &*self.text,
                &self.path,
                &self.overrides,
                &measured,
            )
        };
        fitted(py, fit, unknowns)
    }

    /// Derivatives by the numbers of the keys `by`, of a quantity or of squares of what is left over of measurements. The answer in words
    /// and as JSON.
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn gradient(
        &self,
        py: Python<'_>,
        of: Option<String>,
        times: Vec<f64>,
        columns: Vec<(String, Vec<f64>)>,
        is_at_rest: bool,
        by: Vec<String>,
        method: Option<String>,
        check: bool,
    ) -> PyResult<(String, String)> {
        self.check_file()?;
        let objective = match (of, is_at_rest) {
            (Some(of), false) => Objective::Quantity(of),
            (Some(of), true) => Objective::QuantityAtRest(of),
            (None, _) => Objective::LeastSquares(Measured { times, columns }),
        };
        let found = py.detach(|| {
            let (reader, text, path) = (SceneReader::default(), &*self.text, &self.path);
            let mut gradient =
                SceneGradient::of_text(&reader, text, path, &self.overrides, objective, &by)?;
            if let Some(method) = method {
                gradient = gradient.by_method(method.parse()?)?;
            }
            if check {
                gradient = gradient.checked();
            }
            gradient.value_and_gradient(&mut |_| {})
        });
        found.map(|found| (found.to_string(), found.to_json().to_string())).map_err(raised)
    }

    /// The best numbers, each with the least and the most that it may be, of a quantity or of several with goals. The answer in words and as JSON.
    fn optimize(
        &self,
        py: Python<'_>,
        of: Vec<String>,
        by: Vec<(String, f64, f64)>,
        maximize: bool,
        goals: Option<Vec<f64>>,
        is_at_rest: bool,
    ) -> PyResult<(String, String)> {
        self.check_file()?;
        let objective = match is_at_rest {
            true => Objective::QuantityAtRest,
            false => Objective::Quantity,
        };
        let objectives: Vec<Objective> = of.into_iter().map(objective).collect();
        let aim = match (goals, maximize) {
            (Some(goals), _) => Aim::Goals(goals),
            (None, true) => Aim::Largest,
            (None, false) => Aim::Least,
        };
        let found = py.detach(|| {
            let (reader, text, path) = (SceneReader::default(), &*self.text, &self.path);
            let set = &self.overrides;
            SceneOptimizer::of_text(&reader, text, path, set, objectives, aim, &ranges(by))?
                .optimize(&mut |_| Ok(()))
        });
        found.map(|found| (found.to_string(), found.to_json().to_string())).map_err(raised)
    }

    /// Charts speed against accuracy of methods at tolerances, into a directory. Returns the table of the fastest.
    #[pyo3(signature = (directory, methods, tolerances, repetitions))]
    fn chart(
        &self,
        py: Python<'_>,
        directory: PathBuf,
        methods: Option<Vec<String>>,
        tolerances: Vec<f64>,
        repetitions: usize,
    ) -> PyResult<String> {
        let SceneFile { title, scene, settings, .. } = &self.file;
        let table = py.detach(|| {
            let lines: Vec<(String, Settings)> = match methods {
                None => all_methods(),
                Some(methods) => methods
                    .into_iter()
                    .map(|name| {
                        let method = name.parse()?;
                        Ok((name, Settings { method, ..Settings::default() }))
                    })
                    .collect::<Result<_, pliant::InputError>>()?,
            };
            let scenes = Scenes::new(&**title, scene.clone()).alpha(settings.alpha);
            let mut scenes = lines
                .into_iter()
                .fold(scenes.tolerances(tolerances), |scenes, (name, settings)| {
                    scenes.line(name, settings)
                });
            let findings = Study::new(&mut scenes)
                .repetitions(repetitions)
                .keep(directory.join("chart.csv"))
                .run(&mut |_| {})?;
            findings.write_table(directory.join("chart.md"))?;
            if findings.rows().any(|row| row.failure.is_none()) {
                findings.write_chart(directory.join("chart.svg"))?;
                findings.write_chart(directory.join("chart.png"))?;
            }
            Ok::<_, Error>(findings.fastest().to_string())
        });
        table.map_err(raised)
    }

    /// Starts the scene, to be driven.
    fn start(&self, py: Python<'_>) -> PyResult<Simulation> {
        let SceneFile { scene, settings, output, .. } = &self.file;
        let started = py.detach(|| {
            let mut simulation = scene.start(settings)?;
            simulation.record(&output.sampling())?;
            Ok::<_, Error>(simulation)
        });
        Ok(Simulation::new(started.map_err(raised)?, self.file.title.clone()))
    }
}

/// Keys with the least and the most that each may be.
fn ranges(keys: Vec<(String, f64, f64)>) -> Vec<Unknown> {
    keys.into_iter().map(|(key, least, most)| Unknown::new(key, least, most)).collect()
}

/// The answer of a fit in words; the keys with their values and the half widths of their intervals of confidence; root mean
/// squares of the residuals before and after, by sensors.
type FoundByFit = (String, Vec<(String, f64, f64)>, Vec<(String, [f64; 2])>);

fn fitted(
    py: Python<'_>,
    fit: impl FnOnce() -> Result<SceneFit, Error> + Send,
    unknowns: Vec<(String, f64, f64)>,
) -> PyResult<FoundByFit> {
    let fitted = py.detach(|| fit()?.fit(&ranges(unknowns), &mut |_, _| {}));
    let fitted = fitted.map_err(raised)?;
    let found = fitted
        .fitted
        .unknowns
        .iter()
        .map(|found| (found.unknown.name.clone(), found.value, found.confidence));
    let columns = fitted.columns.iter().map(|column| (column.quantity.name.clone(), column.rms));
    Ok((fitted.to_string(), found.collect(), columns.collect()))
}

fn overriding(key: &str, value: &str) -> PyResult<String> {
    override_of(key, &of_json(value)?).map_err(raised)
}

fn of_json(text: &str) -> PyResult<serde_json::Value> {
    serde_json::from_str(text).map_err(|error| {
        let help = format!("it cannot be written into a scene file: {error}");
        Python::attach(|py| {
            made(py, "InputError", (help.clone(), "scene", text, help))
                .unwrap_or_else(|broken| broken)
        })
    })
}

/// The text of a scene file with the values of `json`.
#[pyfunction]
pub fn toml_of(json: &str) -> PyResult<String> {
    toml_of_scene(&of_json(json)?).map_err(raised)
}

/// The JSON Schema of scene files.
#[pyfunction]
pub fn schema() -> String {
    SceneReader::default().schema().to_string()
}

/// Nodes, cells, the word for these, node sets, groups of cells and notes of a file of Gmsh.
#[pyfunction]
#[allow(clippy::type_complexity)]
#[pyo3(signature = (path, dimension = None))]
pub fn read_gmsh(
    py: Python<'_>,
    path: PathBuf,
    dimension: Option<usize>,
) -> PyResult<(
    Bound<'_, PyArray2<f64>>,
    Bound<'_, PyArray2<i64>>,
    &'static str,
    Bound<'_, PyDict>,
    Bound<'_, PyDict>,
    Vec<String>,
)> {
    let mesh = match dimension {
        Some(dimension) => Mesh::read_gmsh_in(path, dimension),
        None => Mesh::read_gmsh(path),
    };
    let mesh = mesh.map_err(raised)?;
    let nodes = vectors(py, mesh.positions().to_vec(), mesh.dimension())?;
    let groups = PyDict::new(py);
    for (name, cells) in mesh.cell_groups() {
        groups.set_item(name, PyArray1::from_iter(py, cells.iter().map(|cell| *cell as i64)))?;
    }
    let word = mesh.kind().word();
    let notes = mesh.notes().to_vec();
    Ok((nodes, cells(py, &mesh)?, word, sets(py, &mesh)?, groups, notes))
}

/// Nodes of the cells, from 0: [cell, node].
///
/// # Errors
/// Cells of several kinds.
pub fn cells<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Bound<'py, PyArray2<i64>>> {
    if mesh.cells_with_kinds().any(|(kind, _)| kind != mesh.kind()) {
        let help =
            "the bodies have cells of different kinds: take the mesh of each, scene.bodies[name]";
        return Err(PyValueError::new_err(help));
    }
    let nodes: Vec<i64> = mesh.cells().flatten().map(|node| *node as i64).collect();
    PyArray1::from_vec(py, nodes).reshape([mesh.cell_count(), mesh.kind().nodes()])
}

fn sets<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Bound<'py, PyDict>> {
    let sets = PyDict::new(py);
    for (name, nodes) in mesh.sets() {
        sets.set_item(name, PyArray1::from_iter(py, nodes.iter().map(|node| *node as i64)))?;
    }
    Ok(sets)
}

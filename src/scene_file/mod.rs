//! Scene files: a scene, how it is integrated and what is written, in TOML.
//!
//! The words are those of the API, units are SI.

mod body;
mod mesh;
mod nearest;
mod phase;
mod selection;
mod settings;
mod source;
mod surroundings;
mod table;
mod value;

use std::path::Path;

use toml::de::DeTable;

use self::source::Source;
use self::table::Table;
use self::value::Value;
use crate::error::Error;
use crate::mesh::Selection;
use crate::scene::Scene;
use crate::simulate::{Sampling, Solver};

/// What a scene file says.
#[derive(Debug, Clone)]
pub struct SceneFile {
    /// Title of the scene; empty without one.
    pub title: String,
    /// The scene.
    pub scene: Scene,
    /// How it is integrated.
    pub solver: Solver,
    /// What is to be written.
    pub output: OutputRequest,
}

/// What a run is to write.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputRequest {
    /// Time between samples (s). Without it, phases are sampled at their ends only.
    pub step: Option<f64>,
    /// Nodes whose displacements the table lists.
    pub track: Option<Selection>,
    /// Kinds of files. Default: CSV.
    pub formats: Vec<Format>,
}

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// A table of the motion.
    Csv,
    /// Files for ParaView.
    Vtk,
    /// Snapshots.
    Svg,
    /// An animation.
    Html,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 4] = [Self::Csv, Self::Vtk, Self::Svg, Self::Html];

    /// Name: `csv`, `vtk`, `svg`, `html`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Vtk => "vtk",
            Self::Svg => "svg",
            Self::Html => "html",
        }
    }
}

impl Default for OutputRequest {
    fn default() -> Self {
        Self { step: None, track: None, formats: vec![Format::Csv] }
    }
}

impl OutputRequest {
    /// When the motion is sampled.
    pub fn sampling(&self) -> Sampling {
        self.step.map_or_else(Sampling::phase_ends, Sampling::every)
    }
}

const TOP: &[&str] = &[
    "title",
    "dimension",
    "gravity",
    "body",
    "point",
    "spring",
    "chamber",
    "obstacle",
    "phase",
    "solver",
    "output",
];

impl SceneFile {
    /// Reads a scene file. Files that it names are sought relative to it.
    ///
    /// # Errors
    /// A file that cannot be read; [`Error::SceneFile`] with the line for anything that is wrong
    /// inside.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path)
            .map_err(|source| Error::Read { path: path.into(), source })?;
        Self::parse(&text, path)
    }

    /// As [`read`](Self::read), from the `text` of a file at `path`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, Error> {
        let source = Source { path, text };
        let document = DeTable::parse(text).map_err(|error| {
            let at = error.span().unwrap_or(0..0);
            source.error(&at, "", error.message())
        })?;
        let (at, entries) = (document.span(), document.get_ref());
        let top = Table::new(&source, String::new(), at, entries, TOP)?;
        convert(&top)
    }
}

fn convert(top: &Table) -> Result<SceneFile, Error> {
    let title = top.optional("title", "the title", Value::string)?.unwrap_or_default();
    let dimension = top.get("dimension", "the dimension of space");
    let points = top.get("point", "point masses, [[point]]");
    let body = top.required("body", "the table [body]", |value| {
        body::body(value, dimension.as_ref(), points.as_ref())
    })?;
    let mut scene = Scene::new(body);
    if let Some(gravity) = top.get("gravity", "the acceleration of gravity (m/s^2)") {
        let gravity = gravity.vector(scene.body().dimension())?;
        scene = scene.gravity(gravity);
    }
    let parts: [(&str, &str, fn(Scene, &Value) -> Result<Scene, Error>); 4] = [
        ("spring", "springs, [[spring]]", surroundings::add_spring),
        ("chamber", "chambers, [[chamber]]", surroundings::add_chamber),
        ("obstacle", "obstacles, [[obstacle]]", surroundings::add_obstacle),
        ("phase", "phases, [[phase]]", phase::add_phase),
    ];
    for (key, meaning, add) in parts {
        if let Some(values) = top.get(key, meaning) {
            scene = values.one_or_more()?.iter().try_fold(scene, add)?;
        }
    }
    if scene.phases().is_empty() {
        return Err(top.missing("phase", "a scene needs one phase at least, [[phase]]"));
    }
    let solver = top.optional("solver", "the table [solver]", settings::solver)?;
    let output = top.optional("output", "the table [output]", |value| {
        settings::output(value, scene.body().mesh())
    })?;
    let (solver, output) = (solver.unwrap_or_default(), output.unwrap_or_default());
    Ok(SceneFile { title: title.into(), scene, solver, output })
}

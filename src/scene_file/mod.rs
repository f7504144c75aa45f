//! Scene files: a scene, how it is integrated and what is written, in TOML. SI units; the words are
//! those of the API.
//!
//! ```
//! use std::path::Path;
//! use pliant::SceneFile;
//!
//! let text = r#"
//!     title = "A rubber square falls on the floor"
//!     dimension = 2
//!     gravity = [0.0, -9.8]
//!
//!     [body]
//!     mesh = { kind = "rectangle", size = [0.1, 0.1], nodes = [4, 4], cells = "crossed", origin = [0.0, 0.02] }
//!     thickness = 0.01
//!     strain = "green"
//!     material = { density = 1000.0, young = 1.0e5, poisson = 0.48, viscosity = 40.0 }
//!
//!     [[obstacle]]
//!     name = "floor"
//!     kind = "half-plane"
//!     point = [0.0, 0.0]
//!     normal = [0.0, 1.0]
//!     stiffness_density = 1.0e7
//!
//!     [[phase]]
//!     until = 0.2
//! "#;
//! let file = SceneFile::parse(text, Path::new("fall.toml"))?;
//! let trajectory = file.scene.simulate(&file.settings, &file.output.sampling())?;
//! assert_eq!(trajectory.last().time, 0.2);
//! # Ok::<(), pliant::Error>(())
//! ```
//!
//! | table | keys |
//! | --- | --- |
//! | top | `title`; `dimension`: 1, 2 or 3 (default: that of the mesh; in a higher one, bars are strings and surfaces membranes); `gravity` (m/s^2) |
//! | `[body]` | `mesh`; `thickness` (m) in 2D, `area` (m^2) in 1D; `strain`: `"cauchy"` (default), `"green"` or `"auto"`; `viscous`: `"natural"` or `"objective"` (defaults: with Cauchy, with Green strain); `inertia`: `"consistent"` (default) or `"lumped"` ([`Inertia`](crate::Inertia)); `plane`: `"strain"` (default) or `"stress"`; `material` = { `density` (kg/m^3), `young` (Pa), `poisson`, `viscosity` (Pa s) } |
//! | `mesh` | `kind`, and for `"bar"` `length`, `nodes`; for `"rectangle"` and `"cuboid"` `size`, `nodes`, `cells`; for `"ring"` and `"half-ring"` `inner`, `outer`, `nodes` = [around, radial], `cells`; for `"gmsh"` `file`, relative to the scene file ([`Mesh::read_gmsh`](crate::Mesh::read_gmsh)). For all: `origin` (m), the lower corner, or the centre of a ring |
//! | `cells` | `"triangles"`, `"crossed"`, `"rectangles"`, `"triangles6"` ([`Cells`](crate::Cells)); `"tetrahedra"`, `"hexahedra"`, `"tetrahedra10"` ([`SolidCells`](crate::SolidCells)) |
//! | `[[body.region]]` | `name`; `box` (cells whose centroid lies in it) or `group` (a physical group of Gmsh); `material`: the keys that differ |
//! | `[[point]]` | `name`, `position` (m), `mass` (kg): a point mass, whose name is a node set |
//! | `[[spring]]` | `name`; `ends`: two selections of one node each; `stiffness` (N/m), `length` (m), `damping` (N s/m) |
//! | `[[chamber]]` | `name`; `nodes` of its walls: a set, or a closed polygon of numbers ([`Chamber::within`](crate::Chamber::within)); `thickness` (m; default: that of the body) |
//! | `[[obstacle]]` | `name`; `kind`: `"half-plane"` with `point`, `normal`, `"disc"` with `centre`, `radius`, `cavity`, `"box"` with `min`, `max`, or `"capsule"` with `from`, `to`, `radius`; `stiffness` (N/m per node) or `stiffness_density` (N/m^3); `damping`, `tangential_damping`; `friction_coefficient`: a number or { `static`, `kinetic` }, `sticking_speed` (m/s; [Friction](crate::Obstacle#friction)); `adhesion` (default true); `velocity` (m/s) |
//! | `[[phase]]` | `name`; `until` (s); `contact`: `true` (default), `false` or names of obstacles; `project_velocity` (default false); and the lists below |
//! | `hold` | { `nodes`, `axes` } |
//! | `move` | { `nodes`, `axes`, `velocity` (m/s) } |
//! | `path` | { `nodes`, `axes`, `times` (s), `displacements` (m) }: [`Phase::path`](crate::Phase::path) |
//! | `load` | { `nodes`, `force` (N on each) }, { `nodes`, `total` (N on all together) } or { `nodes`, `times` (s), `forces` (N on each) } |
//! | `pressure` | { `chamber`, `value` (Pa) } or { `chamber`, `times` (s), `values` (Pa) } |
//! | `actuate` | { `springs`, `force` (N) } or { `springs`, `times` (s), `forces` (N) } |
//! | `[solver]` | as [`Settings`]; `contact_events`: `"auto"`, `"step-over"` or `"locate"`; `stability_limit_detection`: `true` or `false` |
//! | `[output]` | as [`OutputRequest`] |
//!
//! - **Nodes** are the name of a set, a number (from 1) or a list of them, or { `box` = [min, max] }.
//! - **Axes** are `"x"`, `"y"`, `"z"` or a list of them; without them all are meant. Numbers along axes
//!   (`velocity`, each of `displacements`) are one per named axis, for one axis a number alone; or one
//!   per dimension, 0 along the axes that are not named.
//! - **Paths** run smoothly through their points and begin and end at rest; tables of loads, pressures
//!   and forces run along straight lines. Before and after, all of them are constant.
//! - **`strain = "auto"`** is Green strain: small strain takes rotation for swelling, and Green strain,
//!   which does not, costs little more.
//! - Where a list of tables is expected, a table alone will do.

mod body;
mod mesh;
mod phase;
#[cfg(feature = "play")]
mod rewrite;
mod selection;
mod settings;
mod source;
mod surroundings;
mod table;
mod value;

use std::io;
use std::path::Path;

use toml::de::DeTable;

#[cfg(feature = "play")]
pub(crate) use self::rewrite::{Rewritten, rewritten};
use self::source::Source;
use self::table::Table;
use self::value::Value;
use crate::error::Error;
use crate::input::read_at_most;
use crate::mesh::Selection;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::simulate::Sampling;

/// The contents of a scene file.
#[derive(Debug, Clone)]
pub struct SceneFile {
    /// Title of the scene; empty without one.
    pub title: String,
    /// The scene.
    pub scene: Scene,
    /// How it is integrated.
    pub settings: Settings,
    /// What is to be written.
    pub output: OutputRequest,
    /// What `pliant check` says about the text: keys that have another name now.
    pub notes: Vec<String>,
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

/// Bytes that a scene file may have.
const MOST_BYTES: u64 = 16 << 20;

impl SceneFile {
    /// Reads a scene file. Files that it names are sought relative to it.
    ///
    /// # Errors
    /// A file that cannot be read; [`Error::SceneFile`] with the line for anything that is wrong
    /// inside.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let text = read_at_most(path, MOST_BYTES).and_then(|bytes| {
            String::from_utf8(bytes)
                .map_err(|error| io::Error::other(format!("it is no UTF-8 text: {error}")))
        });
        Self::parse(&text.map_err(|source| Error::Read { path: path.into(), source })?, path)
    }

    /// As [`read`](Self::read), from the `text` of a file at `path`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, Error> {
        let source = Source { path, text };
        let document = DeTable::parse(text).map_err(|error| {
            let at = error.span().unwrap_or(0..0);
            let line = source.line(at.start);
            let written = text.lines().nth(line - 1).unwrap_or_default().trim();
            source.error(&at, "", format!("this is not TOML ({}): {written}", error.message()))
        })?;
        let (at, entries) = (document.span(), document.get_ref());
        let top = Table::new(&source, String::new(), at, entries, TOP)?;
        convert(&top)
    }
}

/// Adds a table to a scene.
type Add = fn(Scene, &Value) -> Result<Scene, Error>;

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
    let parts: [(&str, &str, Add); 4] = [
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
        return Err(top.missing("phase", "a scene needs one phase at least: [[phase]]"));
    }
    let settings = top.optional("solver", "the table [solver]", settings::solver)?;
    let output = top.optional("output", "the table [output]", |value| {
        settings::output(value, scene.body().mesh())
    })?;
    let (settings, output) = (settings.unwrap_or_default(), output.unwrap_or_default());
    let obstacles = top.get("obstacle", "obstacles, [[obstacle]]");
    let notes = obstacles.map_or(Ok(Vec::new()), |value| surroundings::notes(&value))?;
    Ok(SceneFile { title: title.into(), scene, settings, output, notes })
}

//! Scene files: a scene, its settings and its output, in TOML. SI units; the words are
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
//! All tables and keys, and all other files of `pliant`:
//!
#![doc = include_str!("../../../docs/reference.md")]

mod absent;
mod auto;
mod body;
mod cells;
mod contents;
mod course;
mod device;
mod fluid;
mod friction;
mod gas;
mod generators;
mod growth;
mod initial;
mod joint;
mod keys;
mod lag;
mod leaves;
mod liquid;
mod listed;
mod magnet;
mod material;
mod mesh;
mod muscle;
mod obstacle;
mod overrides;
mod phase;
mod phase_keys;
mod reference;
#[cfg(feature = "play")]
mod rewrite;
mod rod;
mod schema;
mod selection;
mod sensor;
mod set_value;
mod settings;
mod smaller;
mod source;
#[cfg(feature = "sweep")]
mod study;
mod surroundings;
mod table;
mod tie;
mod top;
mod touch;
mod value;
#[cfg(any(feature = "play", feature = "study"))]
mod written;

use std::cell::RefCell;
use std::path::Path;

use toml::de::DeTable;

pub use self::contents::{
    AccuracyRequest, AutoRequest, Format, OutputRequest, SceneFile, StaticsRequest,
};
use self::device::take_devices;
pub use self::device::{DeviceKey, DeviceTable};
#[cfg(any(feature = "fit", feature = "sweep"))]
pub(crate) use self::overrides::problem;
use self::overrides::{as_toml, merge};
pub use self::overrides::{override_of, toml_of};
pub use self::reference::laws;
#[cfg(feature = "sweep")]
pub use self::reference::study_reference;
#[cfg(feature = "play")]
pub(crate) use self::rewrite::{Rewritten, rewritten};
pub use self::set_value::SetValue;
pub(crate) use self::source::text_of;
use self::source::{SourceText, no_toml};
#[cfg(feature = "sweep")]
pub use self::study::{
    SampleMethod, SampleRequest, Spacing, StudyFile, Varied, VariedKey, Written,
};
use self::table::Table;
use self::top::TOP;
#[cfg(any(feature = "play", feature = "study"))]
use self::written::{whole_paths, written};
use crate::dynamics::error::Error;

impl SceneFile {
    /// Reads a scene file. Files that it names are sought relative to it.
    ///
    /// # Errors
    /// A file that cannot be read; [`Error::SceneFile`] with the line for anything that is wrong
    /// inside.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::read_with(path, &[])
    }

    /// As [`read`](Self::read), with other values: each of `overrides` is as `body.material.young=2e5` or
    /// `phase.free.until=1.5`, where a list of tables is followed by the name or the number (from 1) of one
    /// of them. Of an only one the number may be left out, and a single table may have one, 1.
    ///
    /// # Errors
    /// As [`read`](Self::read); [`Error::Input`] for an override that is no key and value.
    pub fn read_with(path: impl AsRef<Path>, overrides: &[String]) -> Result<Self, Error> {
        SceneReader::default().read_with(path, overrides)
    }

    /// The text of a scene file, with the values of `overrides`, as those of [`read_with`](Self::read_with),
    /// written into it: all else stays as it was.
    ///
    /// # Errors
    /// A file that cannot be read; [`Error::Input`] for an override that is no key and value, or for which
    /// the text has no place.
    #[cfg(any(feature = "play", feature = "study"))]
    pub fn text_with(path: impl AsRef<Path>, overrides: &[String]) -> Result<String, Error> {
        Self::written_with(&text_of(path.as_ref())?, overrides)
    }

    /// As [`text_with`](Self::text_with), from the text itself.
    ///
    /// # Errors
    /// As there.
    #[cfg(any(feature = "play", feature = "study"))]
    pub fn written_with(text: &str, overrides: &[String]) -> Result<String, Error> {
        overrides.iter().try_fold(text.to_owned(), |text, over| written(&text, over))
    }

    /// As [`written_with`](Self::written_with), of the text of a file at `path`, with the whole paths of the files that it names, so
    /// that it may stand anywhere.
    ///
    /// # Errors
    /// As there.
    #[cfg(any(feature = "play", feature = "study"))]
    pub fn moved_with(text: &str, path: &Path, overrides: &[String]) -> Result<String, Error> {
        let text = Self::written_with(text, overrides)?;
        let files = whole_paths(&text, path)?;
        Self::written_with(&text, &files)
    }

    /// The places that keys, as those of [`read_with`](Self::read_with), have in the `text` of a scene file: the same for the
    /// name and the number of an element of a list.
    ///
    /// # Errors
    /// A text that is not TOML.
    #[cfg(any(feature = "fit", feature = "sweep"))]
    pub(crate) fn places(
        text: &str,
        path: &Path,
        keys: &[&str],
    ) -> Result<Vec<Vec<String>>, Error> {
        let source = SourceText { path, text, own: text.len(), notes: RefCell::default() };
        let document = DeTable::parse(text).map_err(|error| no_toml(&source, &error))?;
        Ok(keys.iter().map(|key| overrides::place(document.get_ref(), key)).collect())
    }

    /// The units of keys, as those of [`read_with`](Self::read_with): empty for words, and where they depend on other keys.
    ///
    /// # Errors
    /// As of [`places`](Self::places).
    #[cfg(any(feature = "fit", feature = "sweep"))]
    pub(crate) fn units(
        text: &str,
        path: &Path,
        keys: &[&str],
    ) -> Result<Vec<&'static str>, Error> {
        Ok(Self::places(text, path, keys)?.iter().map(|place| TOP.unit(place)).collect())
    }

    /// The value of a key, as one of [`read_with`](Self::read_with), in the `text` of a scene file with other values for some keys;
    /// none if it is not stated there.
    ///
    /// # Errors
    /// A text that is not TOML; as of [`read_with`](Self::read_with) for overrides.
    #[cfg(feature = "gradient")]
    pub(crate) fn value_of(
        text: &str,
        path: &Path,
        overrides: &[String],
        key: &str,
    ) -> Result<Option<SetValue>, Error> {
        let source = SourceText { path, text, own: text.len(), notes: RefCell::default() };
        overrides::value_of(text, overrides, key, |error| no_toml(&source, &error))
    }

    /// As [`read`](Self::read), from the `text` of a file at `path`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, Error> {
        Self::parse_with(text, path, &[])
    }

    /// As [`read_with`](Self::read_with), from the `text` of a file at `path`.
    ///
    /// # Errors
    /// As there.
    pub fn parse_with(text: &str, path: &Path, overrides: &[String]) -> Result<Self, Error> {
        SceneReader::default().parse_with(text, path, overrides)
    }
}

/// A reader of scene files that may have tables of [devices](crate::Device) which other crates define.
///
/// ```
/// use pliant::SceneReader;
///
/// let file = SceneReader::new(&[]).read_with("scenes/beam-bend-green.toml", &[])?;
/// assert_eq!(file.scene.end(), 6.0);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct SceneReader {
    devices: Vec<DeviceTable>,
}

impl SceneReader {
    /// A reader of files that may have these tables, too.
    pub fn new(devices: &[DeviceTable]) -> Self {
        Self { devices: devices.into() }
    }

    /// As [`SceneFile::read_with`].
    ///
    /// # Errors
    /// As there.
    pub fn read_with(
        &self,
        path: impl AsRef<Path>,
        overrides: &[String],
    ) -> Result<SceneFile, Error> {
        let path = path.as_ref();
        parse(text_of(path)?, path, overrides, &self.devices)
    }

    /// As [`SceneFile::parse_with`].
    ///
    /// # Errors
    /// As there.
    pub fn parse_with(
        &self,
        text: &str,
        path: &Path,
        overrides: &[String],
    ) -> Result<SceneFile, Error> {
        parse(text.into(), path, overrides, &self.devices)
    }

    /// All tables and keys of its scene files in Markdown, with types, units, defaults and examples.
    pub fn reference(&self) -> String {
        reference::reference(&self.devices)
    }

    /// The JSON Schema (draft 7) of its scene files, for editors that check TOML by it.
    pub fn schema(&self) -> serde_json::Value {
        schema::schema(&self.devices)
    }
}

fn parse(
    mut text: String,
    path: &Path,
    overrides: &[String],
    devices: &[DeviceTable],
) -> Result<SceneFile, Error> {
    let own = text.len();
    // overrides follow the text, so that errors have a place to point to
    let mut padded = Vec::with_capacity(overrides.len());
    for over in overrides {
        let toml = as_toml(over)?;
        text.push('\n');
        padded.push(" ".repeat(text.len()) + &toml);
        text.push_str(&toml);
    }
    let source = SourceText { path, text: &text, own, notes: RefCell::default() };
    let no_toml = |error: toml::de::Error| no_toml(&source, &error);
    let document = DeTable::parse(&text[..own]).map_err(no_toml)?;
    let (at, mut entries) = (document.span(), document.into_inner());
    for over in &padded {
        merge(&mut entries, DeTable::parse(over).map_err(no_toml)?.into_inner(), &text)?;
    }
    let leaves = leaves::leaves(&entries);
    let devices = take_devices(&source, &mut entries, devices)?;
    let top = Table::new(&source, String::new(), at, &entries, &TOP)?;
    let file = top::scene_file(&top, devices)?;
    let scene = file.scene.written_with(leaves);
    Ok(SceneFile { scene, notes: source.notes.take(), ..file })
}

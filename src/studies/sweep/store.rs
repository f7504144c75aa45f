//! The directory of a study: one file per row, so that any number of processes may compute it side by side.
//!
//! The table needs no lock and no process in charge, as it is gathered from the files. A process that
//! computes a row locks a file with its id; locks end with their process, so that a kill leaves nothing to be
//! cleared. On file systems without locks a row may be computed twice, and is stored once. The identity of a
//! study is the scene as it is read, not its text, so that comments may change, and the names of the keys,
//! not their values, so that values can be added.

use std::fs::{self, File, TryLockError};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::plan::{Plan, Point};
use super::row::Row;
use super::run::Sweep;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::io::file::write_file;
use crate::studies::work_precision::fingerprint::{of_scene, of_text};

/// A directory that holds the rows of one study.
///
/// | in it | what that is |
/// | --- | --- |
/// | `study.json` | which study it is |
/// | `rows/<id>.json` | one row each, complete or not there at all |
/// | `claims/<id>` | locked while a process computes that row; gone afterwards |
/// | `runs/<id>/` | the whole output of a run, if it was kept |
#[derive(Debug, Clone)]
pub struct Store {
    path: PathBuf,
    identity: Identity,
}

/// The right to compute a row: no other process has it.
#[derive(Debug)]
pub struct Claim {
    path: PathBuf,
    /// Locked until it is closed, also if the process is killed.
    _lock: Option<File>,
}

/// Identity of a study. Values of the keys can be added later, so they do not count.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Identity {
    version: String,
    /// The scene with the values set in it, and its solver or the options of its equilibrium, as a hash.
    scene: String,
    set: Vec<String>,
    keys: Vec<String>,
    quantities: Vec<String>,
    accuracy: Option<f64>,
    #[serde(rename = "static", default, skip_serializing_if = "std::ops::Not::not")]
    is_static: bool,
}

const STUDY: &str = "study.json";
/// No row takes so long to be written.
const LONG: Duration = Duration::from_secs(3600);

impl Store {
    /// The directory at `path` for the rows of a study; nothing is written yet.
    ///
    /// # Errors
    /// A directory that holds another study, with the differences; a scene that cannot be read.
    pub fn new(path: impl Into<PathBuf>, sweep: &Sweep) -> Result<Self, Error> {
        let store = Self { path: path.into(), identity: Identity::of(sweep)? };
        let study = store.path.join(STUDY);
        let text = match fs::read_to_string(&study) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(store),
            Err(source) => return Err(Error::Read { path: study, source }),
        };
        let differs = match serde_json::from_str::<Identity>(&text) {
            Ok(there) => there.differs_from(&store.identity),
            Err(_) => Some("its study.json is of another kind".into()),
        };
        match differs {
            None => Ok(store),
            Some(why) => {
                let help =
                    format!("it holds another study: {why}; name another directory by --out");
                Err(InputError::new("directory", store.path.display(), help).into())
            }
        }
    }

    /// Writes which study it is, unless that stands there.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn create(&self) -> Result<(), Error> {
        let study = self.path.join(STUDY);
        for name in ["rows", "claims"] {
            let path = self.path.join(name);
            fs::create_dir_all(&path).map_err(|source| Error::Output { path, source })?;
        }
        if study.exists() {
            return Ok(());
        }
        let document = serde_json::json!(self.identity);
        write_file(&study, |file| writeln!(file, "{document:#}"))
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The directory of the whole output of a run.
    pub fn run_directory(&self, id: &str) -> PathBuf {
        self.path.join("runs").join(id)
    }

    /// Whether the whole output of a run is there.
    pub fn is_kept(&self, id: &str) -> bool {
        self.run_directory(id).join("animation.html").exists()
    }

    /// A row, if its file is there and valid.
    pub fn row(&self, id: &str) -> Option<Row> {
        let text = fs::read_to_string(self.row_path(id)).ok()?;
        serde_json::from_str(&text).ok().filter(|row: &Row| row.id == id)
    }

    /// Whether the row of a point is to be computed: it is not there, or `again` is true for it.
    pub fn is_open(&self, point: &Point, again: impl Fn(&Row) -> bool) -> bool {
        self.row(&point.id).is_none_or(|row| again(&row))
    }

    /// Numbers of the points whose rows are to be computed, as [`is_open`](Self::is_open). Any first part of them is
    /// spread over the study.
    pub fn open(&self, plan: &Plan, again: impl Fn(&Row) -> bool) -> Vec<usize> {
        let is_open = |number: &usize| self.is_open(&plan.point(*number), &again);
        let mut numbers: Vec<usize> = (0..plan.len()).filter(is_open).collect();
        numbers.sort_by_key(|number| number.reverse_bits());
        numbers
    }

    /// Writes a row.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn write(&self, row: &Row) -> Result<(), Error> {
        let document = serde_json::json!(row);
        write_file(&self.row_path(&row.id), |file| writeln!(file, "{document:#}"))
    }

    /// The right to compute a row, if no other process has it now.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn claim(&self, id: &str) -> Result<Option<Claim>, Error> {
        let path = self.path.join("claims").join(id);
        let file = File::options().create(true).append(true).open(&path);
        let file = file.map_err(|source| Error::Output { path: path.clone(), source })?;
        match file.try_lock() {
            // not if whoever had it before took it away after it was opened here
            Ok(()) if !is_at(&file, &path) => Ok(None),
            Ok(()) => Ok(Some(Claim { path, _lock: Some(file) })),
            Err(TryLockError::WouldBlock) => Ok(None),
            // file systems without locks are accepted: a row may be computed twice there, and is there once
            Err(TryLockError::Error(_)) => Ok(Some(Claim { path, _lock: None })),
        }
    }

    /// Removes files left by killed processes: claims without an owner, and partial rows from an hour ago or earlier.
    /// Failures to remove them are harmless.
    pub fn tidy(&self) {
        let files = |name: &str| fs::read_dir(self.path.join(name)).into_iter().flatten().flatten();
        for claim in files("claims") {
            if let Some(id) = claim.file_name().to_str() {
                drop(self.claim(id));
            }
        }
        let is_old = |file: &fs::DirEntry| {
            let modified = file.metadata().and_then(|data| data.modified()).ok();
            let age = modified.and_then(|time| time.elapsed().ok());
            age.is_some_and(|age| age > LONG)
        };
        let is_half = |file: &fs::DirEntry| file.file_name().to_string_lossy().starts_with(".tmp");
        files("rows")
            .filter(is_half)
            .filter(is_old)
            .for_each(|file| _ = fs::remove_file(file.path()));
    }

    fn row_path(&self, id: &str) -> PathBuf {
        self.path.join("rows").join(format!("{id}.json"))
    }
}

/// Whether this file is the one at `path`.
fn is_at(file: &File, path: &Path) -> bool {
    match (file.metadata(), fs::metadata(path)) {
        (Ok(own), Ok(there)) => (own.dev(), own.ino()) == (there.dev(), there.ino()),
        _ => false,
    }
}

impl Drop for Claim {
    /// Whoever opened the file before it goes, and locks it afterwards, finds the row.
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

impl Identity {
    fn of(sweep: &Sweep) -> Result<Self, Error> {
        let file = sweep.file();
        let set: Vec<String> = file.set.iter().map(|written| written.text.clone()).collect();
        let scene = sweep.read(&set)?;
        let solver = match file.is_static {
            true => format!("{:?}", scene.statics),
            false => format!("{:?} {:?}", scene.settings, scene.accuracy),
        };
        let mut keys = sweep.plan().keys().to_vec();
        keys.sort_unstable();
        Ok(Self {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: format!("{:016x}", of_text(format_args!("{solver}"), &[of_scene(&scene.scene)])),
            set,
            keys,
            quantities: sweep.quantities().map(String::from).collect(),
            accuracy: file.accuracy.map(|accuracy| accuracy.0),
            is_static: file.is_static,
        })
    }

    /// The first thing in which this study, which is there, differs from another one.
    fn differs_from(&self, new: &Self) -> Option<String> {
        let list = |words: &[String]| format!("[{}]", words.join(", "));
        let lists = [
            ("keys", &self.keys, &new.keys),
            ("quantities", &self.quantities, &new.quantities),
            ("set", &self.set, &new.set),
        ];
        let list =
            lists.iter().find(|(_, there, here)| there != here).map(|(what, there, here)| {
                format!("{what} = {} there, {} here", list(there), list(here))
            });
        let other = |what: &str, there: String, here: String| {
            (there != here).then(|| format!("{what} = {there} there, {here} here"))
        };
        let accuracy = |of: &Self| of.accuracy.map_or("none".into(), |part| part.to_string());
        other("version of pliant", self.version.clone(), new.version.clone())
            .or(list)
            .or_else(|| other("accuracy", accuracy(self), accuracy(new)))
            .or_else(|| other("static", self.is_static.to_string(), new.is_static.to_string()))
            .or_else(|| {
                (self != new).then(|| "its scene differs from the one that there is now".into())
            })
    }
}

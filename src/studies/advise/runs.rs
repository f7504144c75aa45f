//! Runs that are kept in a file, so that a search can continue where another one ended.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::choice::Choice;
use crate::dynamics::error::Error;
use crate::scene::timeline::Scene;
use crate::studies::work_precision::fingerprint;
use crate::studies::work_precision::quantity::{Quantity, Seen};

/// The result of a run: a line of the file.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Outcome {
    /// Which run it is: a hash of the scene, the quantity, the choice and the version of this library.
    pub(super) run: String,
    /// Observation; `None` without a motion.
    pub(super) seen: Option<Seen>,
    pub(super) seconds: f64,
    pub(super) unknowns: usize,
    /// Reason for a missing motion.
    pub(super) failure: Option<String>,
    /// Warnings of the run.
    pub(super) warnings: Vec<String>,
    /// Cells with most jumps of strain, to be divided next. None where cells cannot be divided locally.
    pub(super) worst: Vec<usize>,
}

impl Outcome {
    /// One that has no name yet.
    pub(super) fn new(seen: Option<Seen>, seconds: f64, unknowns: usize) -> Self {
        let (run, warnings, worst) = (String::new(), Vec::new(), Vec::new());
        Self { run, seen, seconds, unknowns, failure: None, warnings, worst }
    }

    pub(super) fn failed(failure: String) -> Self {
        Self { failure: Some(failure), ..Self::new(None, 0.0, 0) }
    }
}

/// The runs of a file.
#[derive(Debug, Default)]
pub(super) struct Runs {
    known: HashMap<String, Outcome>,
    file: Option<(File, PathBuf)>,
}

impl Runs {
    /// Those of the file at `path`, which is made if it is not there.
    pub(super) fn open(path: Option<&Path>) -> Result<Self, Error> {
        let Some(path) = path else { return Ok(Self::default()) };
        let failed = |source: io::Error| Error::Output { path: path.into(), source };
        let text = match fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(failed(error)),
        };
        // the last line may have been cut short by a kill
        let lines = text.lines().filter_map(|line| serde_json::from_str::<Outcome>(line).ok());
        let known = lines.map(|outcome| (outcome.run.clone(), outcome)).collect();
        if let Some(directory) = path.parent() {
            fs::create_dir_all(directory).map_err(failed)?;
        }
        let mut file = OpenOptions::new().create(true).append(true).open(path).map_err(failed)?;
        if !text.is_empty() && !text.ends_with('\n') {
            writeln!(file).map_err(failed)?;
        }
        Ok(Self { known, file: Some((file, path.into())) })
    }

    /// Identity of a run.
    pub(super) fn name(&self, scene: &Scene, quantity: &Quantity, choice: &Choice) -> String {
        match &self.file {
            Some(_) => {
                let scene = fingerprint::of_scene(scene);
                format!(
                    "{:016x}",
                    fingerprint::of_text(format_args!("{quantity:?} {choice:?}"), &[scene])
                )
            }
            None => String::new(),
        }
    }

    /// The result of a run, if it was made.
    pub(super) fn get(&self, name: &str) -> Option<&Outcome> {
        self.known.get(name)
    }

    /// Keeps the result of a run.
    pub(super) fn keep(&mut self, outcome: &Outcome) -> Result<(), Error> {
        let Some((file, path)) = &mut self.file else { return Ok(()) };
        let line = serde_json::to_string(outcome).map_err(io::Error::from);
        let written = line.and_then(|line| writeln!(file, "{line}"));
        written.map_err(|source| Error::Output { path: path.clone(), source })
    }
}

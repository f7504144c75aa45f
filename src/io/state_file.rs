//! Files with a state that a scene can start from, as JSON.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::base::input::finite;
use crate::dynamics::error::Error;
use crate::io::file::{Kind, write_file};
use crate::scene::timeline::BodyState;

/// The name of the file among the results of a run.
const NAME: &str = "state.json";

const KIND: Kind = Kind {
    what: "pliant state",
    format: 1,
    input: "file of a state",
    help: "the results of a run, or their state.json",
    // fifty million numbers
    most_bytes: 1 << 30,
};

/// A file, in SI units.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Record {
    what: String,
    format: u32,
    positions: Vec<f64>,
    displacements: Vec<f64>,
    velocities: Vec<f64>,
}

impl BodyState {
    /// Writes the state to a file, as JSON.
    ///
    /// # Errors
    /// Numbers that are not finite; [`Error::Output`] if the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let Self { positions, displacements, velocities } = self.clone();
        finite("displacements of the state", &displacements)?;
        finite("velocities of the state", &velocities)?;
        let Kind { what, format, .. } = KIND;
        let record = Record { what: what.into(), format, positions, displacements, velocities };
        write_file(path.as_ref(), |file| {
            serde_json::to_writer(&mut *file, &record)?;
            writeln!(file)
        })
    }

    /// Reads the state that a run has left: its file, or the directory that has it as `state.json`.
    ///
    /// # Errors
    /// [`Error::Read`] if there is no file that can be read; a file that holds no state, or is damaged.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let path = if path.is_dir() { path.join(NAME) } else { path.into() };
        let Record { positions, displacements, velocities, .. } = KIND.read(&path)?;
        Ok(Self { positions, displacements, velocities })
    }
}

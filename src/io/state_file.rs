//! Files with a state that a scene can start from, as JSON.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::base::input::finite;
use crate::dynamics::error::Error;
use crate::io::file::{Kind, write_file};
use crate::scene::timeline::{BodyState, SceneState};

/// The name of the file among the results of a run.
const NAME: &str = "state.json";

/// Format 1 has displacements and velocities of all bodies in a row, and nothing else.
const KIND: Kind = Kind {
    what: "pliant state",
    format: 2,
    oldest: 1,
    input: "file of a state",
    help: "the results of a run, or their state.json",
    // fifty million numbers
    most_bytes: 1 << 30,
};

type ByName<T> = BTreeMap<String, T>;

/// A file, in SI units.
#[derive(Serialize, Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
struct Record {
    what: String,
    format: u32,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    bodies: Vec<BodyState>,
    #[serde(skip_serializing_if = "ByName::is_empty")]
    gases: ByName<f64>,
    #[serde(skip_serializing_if = "ByName::is_empty")]
    liquids: ByName<f64>,
    #[serde(skip_serializing_if = "ByName::is_empty")]
    lags: ByName<f64>,
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pipes: ByName<f64>,
    #[serde(skip_serializing_if = "ByName::is_empty")]
    obstacles: ByName<Vec<f64>>,
    #[serde(skip_serializing_if = "ByName::is_empty")]
    angles: ByName<f64>,
    /// Those of format 1.
    #[serde(skip_serializing)]
    positions: Vec<f64>,
    #[serde(skip_serializing)]
    displacements: Vec<f64>,
    #[serde(skip_serializing)]
    velocities: Vec<f64>,
}

impl SceneState {
    /// Writes the state to a file, as JSON.
    ///
    /// # Errors
    /// Numbers that are not finite; [`Error::Output`] if the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let Self { bodies, gases, liquids, lags, pipes, obstacles, angles } = self.clone();
        for BodyState { displacements, velocities, branches, .. } in &bodies {
            finite("displacements of the state", displacements)?;
            finite("velocities of the state", velocities)?;
            if let Some(branches) = branches {
                finite("branches of the state", &branches.components)?;
            }
        }
        for (what, numbers) in [
            ("gases", &gases),
            ("liquids", &liquids),
            ("lags", &lags),
            ("pipes", &pipes),
            ("angles", &angles),
        ] {
            let numbers: Vec<f64> = numbers.values().copied().collect();
            finite(&format!("{what} of the state"), &numbers)?;
        }
        finite(
            "obstacles of the state",
            &obstacles.values().flatten().copied().collect::<Vec<_>>(),
        )?;
        let Kind { what, format, .. } = KIND;
        let what = what.to_owned();
        let record = Record {
            what,
            format,
            bodies,
            gases,
            liquids,
            lags,
            pipes,
            obstacles,
            angles,
            ..Record::default()
        };
        write_file(path.as_ref(), |file| {
            serde_json::to_writer(&mut *file, &record)?;
            writeln!(file)
        })
    }

    /// Reads the state that a run has left: its file, or the directory that has it as `state.json`.
    ///
    /// Files of versions up to 0.1.0 have displacements and velocities alone.
    ///
    /// # Errors
    /// [`Error::Read`] if there is no file that can be read; a file that holds no state, or is damaged.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let path = if path.is_dir() { path.join(NAME) } else { path.into() };
        let record: Record = KIND.read(&path)?;
        let Record { format, gases, liquids, lags, pipes, obstacles, angles, .. } = record;
        let Record { mut bodies, positions, displacements, velocities, .. } = record;
        let is_first = format == 1;
        if is_first == positions.is_empty() || is_first != bodies.is_empty() {
            return Err(KIND.refuse(&path, "it has no bodies: recreate it"));
        }
        if is_first {
            let (name, branches) = (String::new(), None);
            bodies.push(BodyState { name, positions, displacements, velocities, branches });
        }
        Ok(Self { bodies, gases, liquids, lags, pipes, obstacles, angles })
    }
}

//! Files with a state that a scene can start from, as JSON.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::base::input::{InputError, finite, read_if_at_most};
use crate::dynamics::error::Error;
use crate::io::file::write_file;
use crate::scene::timeline::BodyState;

/// The name of the file among the results of a run.
const NAME: &str = "state.json";

/// What a file says it is, and the format that this version writes and reads.
const WHAT: &str = "pliant state";
const FORMAT: u32 = 1;

/// The most bytes that a file may have: fifty million numbers.
const MOST_BYTES: u64 = 1 << 30;

/// What a file begins with, whatever its format.
#[derive(Deserialize)]
struct Head {
    what: String,
    format: u32,
}

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
        let record =
            Record { what: WHAT.into(), format: FORMAT, positions, displacements, velocities };
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
        let refuse = |help: String| InputError::new("file of a state", path.display(), help).into();
        let unread = |source| Error::Read { path: path.clone(), source };
        // opening a pipe may block for ever
        if !fs::metadata(&path).map_err(unread)?.is_file() {
            return Err(refuse("it is no regular file: name one".into()));
        }
        let Some(text) = read_if_at_most(&path, MOST_BYTES).map_err(unread)? else {
            return Err(refuse(format!("it has more than {MOST_BYTES} bytes")));
        };
        parse(&text).map_err(refuse)
    }
}

fn parse(text: &[u8]) -> Result<BodyState, String> {
    let none = format!("it does not say \"{WHAT}\": name the results of a run, or their {NAME}");
    let damaged = |error| format!("it is damaged or cut off ({error}): make it anew");
    let head: Head = serde_json::from_slice(text).map_err(|error| match error.is_data() {
        true => none.clone(),
        false => damaged(error),
    })?;
    if head.what != WHAT {
        return Err(none);
    }
    if head.format != FORMAT {
        return Err(format!("it has format {}, this version reads format {FORMAT}", head.format));
    }
    let Record { positions, displacements, velocities, .. } =
        serde_json::from_slice(text).map_err(damaged)?;
    Ok(BodyState { positions, displacements, velocities })
}

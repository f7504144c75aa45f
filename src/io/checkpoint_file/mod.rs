//! Checkpoints in files: written by one process, read by another, for a simulation of the same scene.
//!
//! A file identifies the scene without containing it: numbers of nodes and cells, and a hash
//! (SipHash, the same with every version of Rust) of each part, so that an error names the part. Of the
//! current phase it has all numbers and names; functions of time, which no file can hold, are stored as
//! their index in the scene's own phase. Constraints store position and time of their start, so that held nodes
//! continue at the same position to the last bit.

mod commands;
mod identity;
mod record;

use std::fs;
use std::path::Path;

use self::record::{Head, Record, WHAT};
use crate::base::input::{InputError, read_if_at_most};
use crate::dynamics::error::Error;
use crate::dynamics::simulate::{Checkpoint, Simulation};
use crate::io::file::write_file;

impl Checkpoint {
    /// Writes the checkpoint to a file, as JSON, from which a simulation of the same scene can
    /// [read](Simulation::read_checkpoint) it, in another process, too.
    ///
    /// The file replaces an earlier one only when it is complete: after a crash there is the old one or the
    /// new one. It holds the state, the commands in force, and how the integration continues. Of the scene it
    /// holds only what identifies it; functions of time in the phases are taken from the scene that reads it.
    ///
    /// # Errors
    /// [`Error::Output`] if the file cannot be written; a command in force that is a function of time
    /// ([`Signal::function`](crate::Signal::function), [`Simulation::load_with`]), which no file can hold:
    /// command a constant or a table before.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let text = serde_json::to_vec_pretty(&Record::new(self)?).map_err(|error| {
            InputError::new("checkpoint", format!("at {} s", self.time()), error.to_string())
        })?;
        let most = most_bytes(self.scene().body().dofs());
        if text.len() as u64 > most {
            let help = format!("files of checkpoints may have {most}: command smaller tables");
            let input = format!("checkpoint at {} s", self.time());
            return Err(InputError::new(input, format!("{} bytes", text.len()), help).into());
        }
        write_file(path.as_ref(), |file| {
            file.write_all(&text)?;
            writeln!(file)
        })
    }
}

impl Simulation {
    /// Reads a checkpoint that a simulation of the same scene has [written](Checkpoint::write), to be
    /// [restored](Self::restore) here: the motion continues bit by bit as from the checkpoint in memory.
    ///
    /// Settings are those of this simulation. With [`Method::Auto`](crate::Method::Auto) it continues with
    /// the method that was chosen there, if one was. Earlier samples of the motion stay with the simulation
    /// that took them.
    ///
    /// ```
    /// use pliant::{Settings, samples};
    ///
    /// # let directory = tempfile::tempdir().unwrap();
    /// # let path = directory.path().join("square.json");
    /// let scene = samples::square_jump(4)?;
    /// let mut square = scene.start(&Settings::default())?;
    /// square.advance_to(0.3)?;
    /// square.checkpoint().write(&path)?;
    ///
    /// // later, in another process
    /// let mut square = scene.start(&Settings::default())?;
    /// let checkpoint = square.read_checkpoint(&path)?;
    /// square.restore(&checkpoint)?;
    /// assert_eq!(square.time(), 0.3);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Read`] if there is no file that can be read; a file that is no checkpoint, of a format that
    /// this version cannot read, damaged, or of another scene: the message names the difference.
    pub fn read_checkpoint(&self, path: impl AsRef<Path>) -> Result<Checkpoint, Error> {
        let path = path.as_ref();
        let refuse = |help| InputError::new("checkpoint file", path.display(), help).into();
        let file = open(path, most_bytes(self.scene().body().dofs()))
            .map_err(|source| Error::Read { path: path.into(), source })?;
        file.and_then(|text| parse(&text, self)).map_err(refuse)
    }
}

/// The largest size (bytes) of a file of a body with `dofs` displacement components: ten times what the
/// state takes, and some more for commands.
fn most_bytes(dofs: usize) -> u64 {
    (1 << 24) + 512 * dofs as u64
}

/// The contents of a file of `most` bytes at most, or its defect.
fn open(path: &Path, most: u64) -> std::io::Result<Result<Vec<u8>, String>> {
    // opening a pipe may block for ever
    if !fs::metadata(path)?.is_file() {
        return Ok(Err("it is no regular file: name one".into()));
    }
    let help = "it is no checkpoint of this scene, or was damaged: recreate it";
    let too_long = || format!("it has more than {most} bytes: {help}");
    Ok(read_if_at_most(path, most)?.ok_or_else(too_long))
}

fn parse(text: &[u8], simulation: &Simulation) -> Result<Checkpoint, String> {
    let damaged = |error| format!("it is damaged or cut off ({error}): recreate it");
    let head: Head = serde_json::from_slice(text).map_err(|error| match error.is_data() {
        true => format!("it does not say \"{WHAT}\": name a file of `Checkpoint::write`"),
        false => damaged(error),
    })?;
    head.check()?;
    let record: Record = serde_json::from_slice(text).map_err(damaged)?;
    let (kept, choice) = record.read(simulation.scene())?;
    simulation.adopt(kept, choice).map_err(|error| error.to_string())
}

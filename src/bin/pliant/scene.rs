//! The scene file that a command is about.

use std::path::PathBuf;

use clap::Args;
use pliant::{Error, SceneFile};

/// The scene file, and values that take the place of its own.
#[derive(Args)]
pub struct SceneArguments {
    /// Scene file
    #[arg(value_name = "FILE")]
    pub path: PathBuf,
    /// Another value for a key of the scene file, as body.material.young=2e5 or phase.2.until=1.5 (a list of tables is
    /// followed by the name or number of one); may be given several times
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

impl SceneArguments {
    /// Reads the file.
    pub fn read(&self) -> Result<SceneFile, Error> {
        SceneFile::read_with(&self.path, &self.set)
    }
}

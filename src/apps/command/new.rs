//! `pliant new`

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::failure::{Failure, print};

/// Write a scene file to start from, with comments
#[derive(Args)]
pub struct Arguments {
    /// Which scene
    kind: Kind,
    /// Where to [default: its name with .toml]
    #[arg(value_name = "FILE")]
    path: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Kind {
    /// A square is pressed and jumps off the floor
    Square,
    /// A ring falls and bounces
    Ring,
    /// A finger is bent by a tendon
    Finger,
    /// A clamped beam loses its weight and swings
    Cantilever,
    /// The smallest scene
    Blank,
}

impl Kind {
    fn text(self) -> &'static str {
        match self {
            Self::Square => include_str!("templates/square.toml"),
            Self::Ring => include_str!("templates/ring.toml"),
            Self::Finger => include_str!("templates/finger.toml"),
            Self::Cantilever => include_str!("templates/cantilever.toml"),
            Self::Blank => include_str!("templates/blank.toml"),
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { kind, path } = arguments;
    let name = kind.to_possible_value().map(|value| format!("{}.toml", value.get_name()));
    let path = path.clone().unwrap_or_else(|| name.unwrap_or_default().into());
    let place = path.display();
    let file = OpenOptions::new().write(true).create_new(true).open(&path);
    let written = file.and_then(|mut file| file.write_all(kind.text().as_bytes()));
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            Failure::bad_input(format!("{place} is there already: name another file"))
        }
        _ => Failure::failed(format!("cannot write {place}: {error}")),
    })?;
    print(format_args!("written to {place}; next: pliant check {place}, pliant run {place}"))
}

//! `pliant schema`

use clap::Args;
use pliant::scene_file;

use crate::failure::{Failure, print};

/// Print the JSON Schema of scene files, by which editors complete and check them
///
/// `pliant schema > scene.schema.json`, and the line `#:schema scene.schema.json` at the head of a scene file, are
/// what editors with Even Better TOML or taplo need.
#[derive(Args)]
pub struct Arguments {}

pub fn run(_: &Arguments) -> Result<(), Failure> {
    print(format_args!("{:#}", scene_file::schema()))
}

//! `pliant schema`

use clap::Args;
use pliant::SceneReader;

use super::failure::{Failure, print};

/// Print the JSON Schema of scene files, by which editors complete and check them
///
/// `pliant schema > scene.schema.json`, and the line `#:schema scene.schema.json` at the head of a scene file, are
/// what editors with Even Better TOML or taplo need.
#[derive(Args)]
pub struct Arguments {}

pub fn run(_: &Arguments, reader: &SceneReader) -> Result<(), Failure> {
    print(format_args!("{:#}", reader.schema()))
}

//! A beam of silicone that was measured: fits the model to its motion under its own weight, judges it by that under a load,
//! and writes the chapter of it in `docs/validation.md`.
//!
//! `cargo run --release --example measured_beam`
//!
//! What to look for: distances from the markers below a millimetre where the model was fitted, and two or three where it predicts.

mod beam;
mod capture;
#[path = "../common/chapter.rs"]
mod chapter;
mod judge;
mod page;

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Parser;

/// Result of a part of the work.
pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// Fits and judges the measured beam.
#[derive(Parser)]
struct Arguments {
    /// Directory of the measurements
    #[arg(long, default_value = "examples/data/silicone-beam")]
    data: PathBuf,
    /// Directory of the page; its pictures go to `validation/` in it
    #[arg(long, default_value = "docs")]
    out: PathBuf,
}

fn main() {
    let Arguments { data, out } = Arguments::parse();
    if let Err(error) = run(&data, &out) {
        eprintln!("{error}");
        std::process::exit(1);
    }
}

fn run(data: &Path, out: &Path) -> Outcome<()> {
    let trial = |name: &str| capture::Trial::read(&data.join(name));
    let own = [trial("gravity-a.csv")?, trial("gravity-b.csv")?];
    let loaded = [trial("load52-a.csv")?, trial("load52-b.csv")?];
    page::write(&page::Trials { own, loaded }, out)
}

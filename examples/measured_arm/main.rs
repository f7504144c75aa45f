//! A soft arm that was measured, one of whose four chambers is inflated: fits the rubber and the walls between its chambers to two low
//! pressures, predicts two higher ones and the ringing, and writes the chapter of it in `docs/validation.md`.
//!
//! `cargo run --release --example measured_arm`
//!
//! What to look for: how far predictions are off at 300 and 400 mbar, beside those of a power law, a modulus and a frequency near those of
//! the beam and the arm, and which guess of what the data do not tell (shape, reinforcement) matters how much.

mod arm;
mod capture;
#[path = "../common/chapter.rs"]
mod chapter;
mod judge;
mod page;
mod section;

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Parser;

/// Result of a part of the work.
pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// Fits and judges the measured arm.
#[derive(Parser)]
struct Arguments {
    /// Directory of the measurements
    #[arg(long, default_value = "examples/data/soft-arm")]
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
    page::write(&capture::read_all(data)?, out)
}

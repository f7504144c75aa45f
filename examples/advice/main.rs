//! The adviser on trial: what it promises for each scene of `scenes/` and some more, against a run that it knows nothing of.
//!
//! `cargo run --release --example advice` writes `docs/advice.md`, in some 10 minutes.
//!
//! What to look for: the column "true". It should be below the accuracy that was asked for, and is compared with a mesh finer
//! than any that the adviser has seen, by another method at a tighter tolerance.

mod page;
mod scenes;
mod trial;

use std::path::PathBuf;

use clap::Parser;
use trial::Trial;

/// Asks the adviser about many scenes, and compares what it promises with the truth.
#[derive(Parser)]
struct Arguments {
    /// The page that is written
    #[arg(long, default_value = "docs/advice.md")]
    out: PathBuf,
    /// How right the whole motion has to be (relative)
    #[arg(long, default_value_t = 0.02)]
    within: f64,
    /// Time for each advice (s)
    #[arg(long, default_value_t = 30.0)]
    budget: f64,
    /// Time for each of the runs that it is compared with (s)
    #[arg(long, default_value_t = 90.0)]
    limit: f64,
    /// Only scenes whose names have this in them
    #[arg(long, default_value = "")]
    only: String,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Arguments { out, within, budget, limit, only } = Arguments::parse();
    let mut trials = Vec::new();
    for (name, scene, settings) in scenes::all()? {
        if name.contains(&only) {
            let trial = Trial::run(name, &scene, &settings, [within, budget, limit])?;
            println!("{}", trial.row());
            trials.push(trial);
        }
    }
    std::fs::write(&out, page::page(&trials, within, budget))?;
    println!("{}", out.display());
    Ok(())
}

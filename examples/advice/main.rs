//! Tests of the adviser: its promises for each scene of `scenes/` and some more, against independent runs.
//!
//! `cargo run --release --example advice` writes `docs/advice.md`, in some 40 minutes.
//!
//! What to look for: the column "true". It should be below the accuracy that was asked for, and is compared with a mesh finer
//! than any that the adviser has seen, by another method at a tighter tolerance.

mod page;
mod scenes;
mod soft;
mod trial;

use std::path::PathBuf;

use clap::Parser;
use pliant::Settings;
use trial::Trial;

/// Soft bodies of silicone: accuracies, time for each advice (s), and for each of the runs that it is compared with (s).
const ACCURACIES: [f64; 3] = [0.01, 0.02, 0.05];
const SOFT_BUDGET: f64 = 8.0;
const SOFT_LIMIT: f64 = 30.0;

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
            let goal = [within, budget, limit];
            let trial = Trial::run(name, &scene, &settings, goal, &mut Vec::new())?;
            println!("{}", trial.row());
            trials.push(trial);
        }
    }
    // what was found survives a kill
    std::fs::write(&out, page::page(&trials, within, budget))?;
    let mut soft = Vec::new();
    for (name, scene) in soft::all()? {
        if name.contains(&only) {
            let mut references = Vec::new();
            let mut of_scene = Vec::new();
            for accuracy in ACCURACIES {
                let goal = [accuracy, SOFT_BUDGET, SOFT_LIMIT];
                let settings = Settings::default();
                let trial = Trial::run(name.clone(), &scene, &settings, goal, &mut references)?;
                println!("{accuracy}: {}", trial.row());
                of_scene.push(trial);
            }
            soft.push(of_scene);
            let text = page::page(&trials, within, budget) + &page::soft(&soft, SOFT_BUDGET);
            std::fs::write(&out, text)?;
        }
    }
    println!("{}", out.display());
    Ok(())
}

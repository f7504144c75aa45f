//! Common code of the examples: arguments, and how they end.
#![allow(dead_code)] // each example uses its part

use std::path::PathBuf;

use clap::Args;
use pliant::{Error, Method, Settings, Trajectory};

/// Arguments of every example.
#[derive(Args)]
pub struct Common {
    /// Integration method (`pliant methods` lists them)
    #[arg(long, default_value_t = Method::CvodeBdf)]
    pub method: Method,
    /// Relative tolerance
    #[arg(long, default_value_t = 1e-6)]
    pub rtol: f64,
    /// Rate of the constraint stabilization (1/s)
    #[arg(long, default_value_t = 1e3)]
    pub alpha: f64,
    /// Directory for the pictures
    #[arg(long, default_value = "out")]
    pub out: PathBuf,
}

impl Common {
    /// The settings they ask for.
    pub fn settings(&self) -> Settings {
        let &Self { method, rtol, alpha, .. } = self;
        Settings { method, rtol, alpha, ..Settings::default() }
    }
}

/// Ends the program: with the message and code 1 after an error.
pub fn finish(result: Result<(), Error>) {
    if let Err(error) = result {
        eprintln!("{error}");
        std::process::exit(1);
    }
}

/// The number of patterns that the Newton matrix had after the first, and whether bodies overlap.
pub fn patterns_and_overlaps(motion: &Trajectory) -> (usize, &'static str) {
    let phases = motion.report().phases.iter();
    let overlaps = motion.indicators().iter().any(|of| of.name == "overlap" && of.value > 0.0);
    (phases.map(|phase| phase.counts.pattern_changes).sum(), if overlaps { "yes" } else { "none" })
}

//! Stability where methods fail: runs every experiment of `docs/stability.md` and writes that page
//! with its numbers and pictures.
//!
//! `cargo run --release --example stability`
//!
//! What to look for: `git diff docs`. Counts of steps may change by a few with versions of SUNDIALS
//! and of compilers; what the page concludes from them is held by `tests/stability`.

mod gallery;

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use clap::Parser;
use gallery::page::Page;
use gallery::{
    Outcome, alpha, compression, contact, explicit, index, locking, orders, pulses, rotation,
};

/// Writes the page on stability: every number and picture of it is computed.
#[derive(Parser)]
struct Arguments {
    /// Directory of the page; its pictures go to `stability/` in it
    #[arg(long, default_value = "docs")]
    out: PathBuf,
    /// Sections to write, by their letters
    #[arg(long, default_value = "abcdefghi")]
    only: String,
}

const INTRODUCTION: &str = "\
# Stability: where methods and models fail

Every section shows a failure with its numbers, says why, and what works instead. Many take scenes of
chapter 4 of S. Hirai, *Computing Dynamic Deformation*. All numbers and
pictures are results of `cargo run --release --example stability`, which writes this page in a few
minutes; the tests in `tests/stability/` hold its conclusions. Those of the last section, on reduced models, are
results of `pliant reduce`.

| | fails | works |
| --- | --- | --- |
| a | explicit Runge-Kutta on viscous bodies | implicit methods |
| b | alpha = 0; starts with R' not 0; large alpha with Runge-Kutta | other methods, projected velocities |
| c | BDF of order 3 to 5 with next to no damping | a cap of 2, `arkode`, `auto` |
| d | Cauchy strain and natural viscosity in rotation | Green strain with objective viscosity |
| e | hard penalty floors | moderate stiffness, tight tolerances, the energy balance as a check |
| f | constraints in index 3 | index 1, stabilized; stabilized index 2 |
| g | St. Venant-Kirchhoff material under strong compression | nothing beyond its limit; it is named |
| h | linear triangles and rectangles as nu goes to 1/2 | quadratic triangles, alternating diagonals |
| i | short pulses in functions of programs | tables, phases, stop times |
| [r](#reduced-models) | reduced models of travelling contact, of what was not learned | all unknowns, wider ranges, more shapes |";

/// Section on motions that reduced models do not represent: measured by the command.
const REDUCED: &str = include_str!("reduced.md");

type Section = fn(&mut Page) -> Outcome<()>;

const SECTIONS: [(char, Section); 9] = [
    ('a', explicit::section),
    ('b', alpha::section),
    ('c', orders::section),
    ('d', rotation::section),
    ('e', contact::section),
    ('f', index::section),
    ('g', compression::section),
    ('h', locking::section),
    ('i', pulses::section),
];

fn main() {
    if let Err(error) = run(&Arguments::parse()) {
        eprintln!("{error}");
        std::process::exit(1);
    }
}

fn run(arguments: &Arguments) -> Outcome<()> {
    let Arguments { out, only } = arguments;
    let mut page = Page::new(out.join("stability"));
    page.say(INTRODUCTION);
    for (letter, section) in SECTIONS {
        if only.contains(letter) {
            let clock = Instant::now();
            section(&mut page)?;
            eprintln!("section {letter}: {:.1} s", clock.elapsed().as_secs_f64());
        }
    }
    page.say(REDUCED.trim_end());
    fs::write(out.join("stability.md"), page.text().trim_end().to_string() + "\n")?;
    Ok(())
}

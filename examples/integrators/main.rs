//! Which integrator when: speed against accuracy of all methods, and of all solvers of linear systems, on standard
//! stiff problems.
//!
//! `cargo run --release --example integrators -- hires` runs one problem, and without a name all of them. What to look
//! for: a chart of each, and a page that says which method is the fastest for which accuracy.
//!
//! Runs are kept and not run again. After changes of the code begin with an empty directory.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/page.rs"]
mod page;

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use common::finish;
use page::{Making, page};
use pliant::Error;
use pliant::study::General;

const READINGS: &str = include_str!("readings.md");

/// Charts of speed against accuracy on systems of equations, and a page about them.
#[derive(Parser)]
struct Arguments {
    /// The problems [default: all]
    #[arg(value_enum)]
    problems: Vec<System>,
    /// Relative tolerances, from rough to fine
    #[arg(long, value_delimiter = ',', default_value = "1e-2,1e-3,1e-4,1e-5,1e-6,1e-7,1e-8,1e-9")]
    rtol: Vec<f64>,
    /// Times that each run is repeated
    #[arg(long, default_value_t = 5)]
    repetitions: usize,
    /// Processor time that any run may take (s)
    #[arg(long, default_value_t = 20.0)]
    limit: f64,
    /// Directory for the rows that are kept
    #[arg(long, default_value = "out/integrators")]
    keep: PathBuf,
    /// Directory for the page, and for the charts in a directory within
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

/// The problems, in the order of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum System {
    Hires,
    Robertson,
    VanDerPol,
    Oregonator,
    Pollution,
    TransistorAmplifier,
    Brusselator,
    HeatedSquare,
}

impl System {
    /// As in arguments and names of files.
    fn name(self) -> String {
        self.to_possible_value().expect("none is skipped").get_name().to_owned()
    }

    fn title(self) -> &'static str {
        match self {
            Self::Hires => "HIRES",
            Self::Robertson => "Robertson",
            Self::VanDerPol => "Van der Pol",
            Self::Oregonator => "Oregonator",
            Self::Pollution => "Pollution",
            Self::TransistorAmplifier => "Transistor amplifier",
            Self::Brusselator => "Brusselator, 1000 unknowns",
            Self::HeatedSquare => "Heated square, 10 000 unknowns",
        }
    }

    fn problem(self) -> General {
        match self {
            Self::Hires => General::hires(),
            Self::Robertson => General::robertson(),
            Self::VanDerPol => General::van_der_pol(),
            Self::Oregonator => General::oregonator(),
            Self::Pollution => General::pollution(),
            Self::TransistorAmplifier => General::transistor_amplifier(),
            Self::Brusselator => General::brusselator(),
            Self::HeatedSquare => General::heated_square(),
        }
    }
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let Arguments { problems, rtol, repetitions, limit, keep, out } = arguments;
    let problems = if problems.is_empty() { System::value_variants() } else { problems };
    let charts = out.join("integrators");
    let making = Making { repetitions: *repetitions, limit: *limit, keep, charts: &charts };
    let section = |system: &System| {
        let mut problem = system.problem().tolerances(rtol.as_slice());
        making.section(system.name(), system.title(), true, &mut problem)
    };
    let sections = problems.iter().map(section).collect::<Result<Vec<_>, _>>()?;
    page::write(&out.join("integrators.md"), &page(READINGS, "integrators/", &sections))?;
    println!("written to {}: integrators.md, integrators/*.svg", out.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;
    use page::Section;
    use pliant::study::Study;

    #[test]
    fn every_problem_can_be_read_about() {
        for &system in System::value_variants() {
            // without tolerances nothing is run but references, and numbers are none
            if system == System::Brusselator {
                continue;
            }
            let mut problem = system.problem().tolerances([]);
            let findings = Study::new(&mut problem).run(&mut |_| ()).unwrap();
            let section = Section {
                name: system.name(),
                title: system.title(),
                compares_methods: true,
                findings,
            };
            let page = page(READINGS, "", &[section]);
            assert!(page.contains(system.title()));
        }
    }

    #[test]
    fn the_command_makes_a_page() {
        let directory = tempfile::tempdir().unwrap();
        let out = directory.path().display().to_string();
        let keep = directory.path().join("rows").display().to_string();
        let options = ["--rtol", "1e-2,1e-3", "--repetitions", "1", "--keep", &keep, "--out", &out];
        let names = ["hires", "transistor-amplifier"];
        run(&Arguments::parse_from(["integrators"].iter().chain(&names).chain(&options))).unwrap();
        let page = fs::read_to_string(directory.path().join("integrators.md")).unwrap();
        assert!(page.contains("![HIRES: error over time](integrators/hires.svg)"), "{page}");
        assert!(page.contains("| Transistor amplifier |"), "{page}");
        assert!(directory.path().join("integrators/transistor-amplifier.svg").is_file());
    }

    #[test]
    fn the_page_of_the_documents_is_complete() {
        let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
        let page = fs::read_to_string(directory.join("integrators.md")).unwrap();
        for system in System::value_variants() {
            let chart = format!("integrators/{}.svg", system.name());
            assert!(page.contains(&format!("\n### {}\n", system.title())), "{system:?}");
            assert!(page.contains(&format!("({chart})")), "{system:?}");
            assert!(directory.join(&chart).is_file(), "{chart} is missing");
        }
        assert!(!page.contains(['{', '}']) && !page.contains("(none)"), "a number is missing");
    }
}

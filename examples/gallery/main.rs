//! The gallery: speed against accuracy of every method on Hirai's scenes and a clamped
//! beam, tolerance by tolerance; and of every kind of cell, mesh by mesh.
//!
//! `cargo run --release --example gallery -- square-jump` runs one problem, and without a name
//! all of them. What to look for: a chart of each, and a page that says which method is the
//! fastest for which accuracy. No method is the fastest everywhere.
//!
//! It is a list of problems, a page that puts findings into tables, and prose in `readings.md`, whose numbers are
//! filled in from the run: a number without a run is a failure of the test.
//!
//! Runs are kept and not run again. After changes of the code begin with an empty directory.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/page.rs"]
mod page;
mod problems;

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use common::finish;
use page::{Making, page};
use pliant::Error;
use problems::Sample;
use rayon::ThreadPoolBuilder;

const READINGS: &str = include_str!("readings.md");

/// Charts of speed against accuracy, and a page about them.
#[derive(Parser)]
struct Arguments {
    /// The problems [default: all]
    #[arg(value_enum)]
    problems: Vec<Sample>,
    /// Relative tolerances, from rough to fine
    #[arg(long, value_delimiter = ',', default_value = "1e-2,1e-3,1e-4,1e-5,1e-6,1e-7,1e-8")]
    rtol: Vec<f64>,
    /// Times that each run is repeated
    #[arg(long, default_value_t = 3)]
    repetitions: usize,
    /// Processor time that any run may take (s)
    #[arg(long, default_value_t = 10.0)]
    limit: f64,
    /// Directory for the rows that are kept
    #[arg(long, default_value = "out/charts")]
    keep: PathBuf,
    /// Directory for page and charts
    #[arg(long, default_value = "out/charts")]
    out: PathBuf,
}

fn main() {
    let arguments = Arguments::parse();
    // What is compared is work, and processor times are those of one thread.
    let one = ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
    finish(one.install(|| run(&arguments)));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let Arguments { problems, rtol, repetitions, limit, keep, out } = arguments;
    let problems = if problems.is_empty() { Sample::value_variants() } else { problems };
    let making = Making { repetitions: *repetitions, limit: *limit, keep, charts: out };
    let section = |&sample: &Sample| {
        let (mut problem, ranked) = (sample.problem(rtol)?, sample.compares_methods());
        making.section(sample.name(), sample.title(), ranked, &mut *problem)
    };
    let sections = problems.iter().map(section).collect::<Result<Vec<_>, _>>()?;
    page::write(&out.join("README.md"), &page(READINGS, "", &sections))?;
    println!("written to {}: README.md, .svg of each problem", out.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;
    use page::Section;
    use pliant::study::Study;

    fn made(problems: &[&str], directory: &Path) -> String {
        let [keep, out] = ["rows", "page"].map(|name| directory.join(name).display().to_string());
        let options =
            ["--rtol", "1e-2,1e-3,1e-4", "--repetitions", "1", "--keep", &keep, "--out", &out];
        let arguments = ["gallery"].iter().chain(problems).chain(&options);
        run(&Arguments::parse_from(arguments)).unwrap();
        fs::read_to_string(directory.join("page/README.md")).unwrap()
    }

    #[test]
    fn the_command_makes_charts_and_a_page_and_runs_nothing_twice() {
        let directory = tempfile::tempdir().unwrap();
        let page = made(&["beam-jump", "ring-roll"], directory.path());
        for part in [
            "\n| Jumping beam | ",
            "\nOf 2 ratios ",
            "\n### Jumping beam\n\n![Jumping beam: error over time](beam-jump.svg)\n",
            "\n### Rolling ring\n",
            "\n| 1e-2 | ",
            "\n- The reference is known to ",
        ] {
            assert!(page.contains(part), "{part} is missing in {page}");
        }
        assert!(!page.contains(['{', '}']), "{page}");
        for name in ["beam-jump", "ring-roll"] {
            let chart =
                fs::read_to_string(directory.path().join(format!("page/{name}.svg"))).unwrap();
            assert!(
                chart.contains("class=\"series\"") && chart.len() < 60_000,
                "{} bytes",
                chart.len()
            );
        }
        // times are never the same twice: these are those that were kept
        assert_eq!(made(&["beam-jump", "ring-roll"], directory.path()), page);
    }

    #[test]
    fn every_problem_can_be_read_about() {
        for &sample in Sample::value_variants().iter().filter(|sample| sample.compares_methods()) {
            // without tolerances nothing is run, and numbers are none
            let mut problem = sample.problem(&[]).unwrap();
            let findings = Study::new(&mut *problem).run(&mut |_| ()).unwrap();
            let section = Section {
                name: sample.name(),
                title: sample.title(),
                compares_methods: true,
                findings,
            };
            let page = page(READINGS, "", &[section]);
            assert!(page.contains(sample.title()));
        }
    }

    #[test]
    fn the_page_of_the_documents_is_complete() {
        let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/charts");
        let page = fs::read_to_string(directory.join("README.md")).unwrap();
        for sample in Sample::value_variants() {
            let chart = format!("{}.svg", sample.name());
            assert!(page.contains(&format!("\n### {}\n", sample.title())), "{sample:?}");
            assert!(page.contains(&format!("({chart})")), "{sample:?}");
            assert!(directory.join(&chart).is_file(), "{chart} is missing");
        }
        assert!(!page.contains(['{', '}']) && !page.contains("(none)"), "a number is missing");
    }
}

//! Runs pliant and its peers on the same equations: charts, tables, `peers/README.md`'s numbers.
//!
//! `peers [--quick] [--out FOLDER] [CASE...]` for scenes, `peers equations [--quick] [--out FOLDER] [SYSTEM...]` for systems
//! of equations, `peers silicone [--quick] [--out FOLDER] [CASE...]` for cells of all kinds at rest, `peers space [--quick] [--out FOLDER] [CASE...]` for blocks in space; programs are expected where `peers/run` puts them.

mod comparison;
mod diffsol_peer;
mod equations;
mod external;
mod implicit;
mod report;
mod silicone;
mod space;

use std::path::{Path, PathBuf};

use comparison::{Comparison, Way};
use external::Program;
use pliant::study::{Failed, Findings, Study};
use pliant::{Inertia, Method, Settings};
use pliant_peers::scenes::{CASES, Case};

/// Processor time (s) that a run may take, in full and quickly.
const LIMITS: [f64; 2] = [6.0, 2.0];

struct Arguments {
    quick: bool,
    out: PathBuf,
    cases: Vec<&'static Case>,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.split_first() {
        Some((first, rest)) if first == "diffsol" => diffsol_peer::main(rest),
        Some((first, rest)) if first == "equations" => equations::run(rest),
        Some((first, rest)) if first == "space" => space::run(rest),
        Some((first, rest)) if first == "silicone" => silicone::run(rest),
        _ => run(&arguments),
    };
    if let Err(error) = done {
        eprintln!("peers: {error}");
        std::process::exit(1);
    }
}

fn parse(words: &[String]) -> Result<Arguments, Failed> {
    let mut parsed = Arguments { quick: false, out: "out".into(), cases: Vec::new() };
    let mut words = words.iter();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--quick" => parsed.quick = true,
            "--out" => parsed.out = words.next().ok_or("--out needs a folder")?.into(),
            name => {
                let known = CASES.map(|case| case.name).join(", ");
                let case = Case::find(name).ok_or(format!("no case {name}: there are {known}"))?;
                parsed.cases.push(case);
            }
        }
    }
    if parsed.cases.is_empty() {
        let few = |case: &&Case| !parsed.quick || ["beam-35x2", "square-jump"].contains(&case.name);
        parsed.cases = CASES.iter().filter(few).collect();
    }
    Ok(parsed)
}

fn run(words: &[String]) -> Result<(), Failed> {
    let Arguments { quick, out, cases } = parse(words)?;
    let limit = LIMITS[usize::from(quick)];
    for case in cases {
        let mut findings: Option<Findings> = None;
        let mut tips = Vec::new();
        for inertia in [Inertia::Consistent, Inertia::Lumped] {
            let folder = out.join(format!("{}-{inertia:?}", case.name).to_lowercase());
            let mut comparison = Comparison::new(case, inertia, references(case), folder)?;
            add_lines(&mut comparison, case, inertia, quick);
            // patience: a slow peer is told by its limit alone
            let study = Study::new(&mut comparison).repetitions(1).limit(limit).patience(1e6);
            let found = study.run(&mut |stage| eprintln!("{}: {stage}", case.name))?;
            tips.extend(comparison.tips().clone());
            findings = Some(match findings {
                None => found,
                Some(findings) => findings.and(found),
            });
        }
        let Some(findings) = findings else { continue };
        report::write(&out, case, &findings, &tips.into_iter().collect())?;
    }
    Ok(())
}

/// Two methods of pliant that do not know of each other, at tolerances near what they can do.
fn references(case: &Case) -> [Settings; 2] {
    let solver =
        |method, max_order, rtol| Settings { method, max_order, rtol, ..Settings::default() };
    match case.name {
        "beam-70x4-damped" => {
            [solver(Method::CvodeBdf, None, 1e-11), solver(Method::Arkode, Some(5), 1e-9)]
        }
        "square-jump" => [solver(Method::CvodeAdams, None, 1e-11), solver(Method::Rk, None, 1e-11)],
        _ => [solver(Method::Rk, None, 1e-9), solver(Method::Arkode, Some(5), 1e-8)],
    }
}

/// Tolerances 10^-2, 10^-3, ... of so many digits.
pub fn digits(quick: bool, from: i32, to: i32) -> Vec<f64> {
    let step = if quick { 2 } else { 1 };
    (from..=to).step_by(step).map(|digits| format!("1e-{digits}").parse().unwrap_or(1.0)).collect()
}

fn add_lines(comparison: &mut Comparison, case: &Case, inertia: Inertia, quick: bool) {
    let tolerances = digits(quick, 2, 7);
    let mut line = |name: &str, family: &str, way: Way, settings: &[f64]| {
        comparison.line(name, family, way, settings);
    };
    let pliant = Way::Pliant;
    let pliant_family = if inertia == Inertia::Lumped { "pliant, lumped" } else { "pliant" };
    line("pliant auto", pliant_family, pliant(Method::Auto, None), &tolerances);
    if inertia == Inertia::Lumped {
        line(
            "pliant central-difference",
            pliant_family,
            pliant(Method::CentralDifference, None),
            &tolerances,
        );
        let central = program("central", &[], "leapfrog");
        let fractions = [0.9, 0.45, 0.225, 0.1125, 0.05625];
        line("C central differences", "C", central, &fractions[..if quick { 3 } else { 5 }]);
        return;
    }
    line("pliant arkode", pliant_family, pliant(Method::Arkode, None), &tolerances);
    line("pliant arkode, order 3", pliant_family, pliant(Method::Arkode, Some(3)), &tolerances);
    match case.name {
        "beam-35x2" | "beam-70x4" => {
            line("pliant rk", pliant_family, pliant(Method::Rk, None), &tolerances)
        }
        _ => line("pliant cvode-bdf", pliant_family, pliant(Method::CvodeBdf, None), &tolerances),
    }
    let own = std::env::current_exe().unwrap_or_default();
    let diffsol = |method| program(&own.display().to_string(), &["diffsol"], method);
    line("diffsol tr_bdf2", "diffsol", diffsol("tr_bdf2"), &digits(quick, 2, 6));
    line("diffsol esdirk34", "diffsol", diffsol("esdirk34"), &tolerances);
    line("diffsol bdf", "diffsol", diffsol("bdf"), &tolerances);
    let steps: Vec<f64> = (0..if quick { 4 } else { 7 }).map(|k| 200.0 * 2_f64.powi(k)).collect();
    line("implicit midpoint", "implicit", Way::Implicit(1.0), &steps);
    line("generalized-alpha 0.9", "implicit", Way::Implicit(0.9), &steps);
    let python = here(&[".venv/bin/python", "scipy/solve.py"]);
    let python: Vec<&str> = python.iter().map(String::as_str).collect();
    let library = own.with_file_name(libname()).display().to_string();
    let scipy = |method| program(python[0], &[python[1], &library], method);
    line("SciPy BDF", "SciPy", scipy("BDF"), &digits(quick, 2, 6));
    line("SciPy Radau", "SciPy", scipy("Radau"), &digits(quick, 2, 6));
    line("SciPy DOP853", "SciPy", scipy("DOP853"), &digits(quick, 3, 7));
    let script = here(&["octave/solve.m"]);
    let octave = |method| {
        let options = ["--no-gui", "--no-history", "-q", "--no-init-file", &script[0]];
        match program("octave-cli", &options, method) {
            // the kind of scene of Hirai's scripts is worth waiting for
            Way::Program(program) if case.has_floor() && !quick && method == "ode45" => {
                Way::Program(Program { patience: 20.0, ..program })
            }
            way => way,
        }
    };
    line("Octave ode15s", "Octave", octave("ode15s"), &[1e-3]);
    line("Octave ode45", "Octave", octave("ode45"), &[1e-3]);
}

pub fn libname() -> &'static str {
    if cfg!(target_os = "macos") { "libpliant_peers.dylib" } else { "libpliant_peers.so" }
}

pub fn here(paths: &[&str]) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    paths.iter().map(|path| root.join(path).display().to_string()).collect()
}

fn program(name: &str, arguments: &[&str], method: &'static str) -> Way {
    let name = if name == "central" { here(&["out/central"]).remove(0) } else { name.into() };
    let command = [name].into_iter().chain(arguments.iter().map(|&word| word.into())).collect();
    Way::Program(Program { command, method, patience: 1.0 })
}

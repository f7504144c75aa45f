//! Standard systems of equations by pliant, diffsol and SciPy: charts and tables of time against error.

mod diffsol;

use std::cell::Cell;
use std::ffi::OsStr;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Instant;

use pliant::ode::{MassKind, Ode};
use pliant::rk::DormandPrince;
use pliant::samples::TransistorAmplifier;
use pliant::study::{EndState, Failed, Findings, General, Goal, Study, time_text};
use pliant::sundials::{Arkode, Cvode, Ida, Jacobian, LinearSolver, MassForm};
use pliant_peers::motion::{Clock, ENOUGH, REPETITIONS};
use pliant_peers::systems::{NAMES, System};

use crate::comparison::TOO_SLOW;
use crate::external::Program;
use crate::{digits, here, libname, report};
use diffsol::Kind;

/// Processor time (s) that a run may take, in full and quickly.
const LIMITS: [f64; 2] = [10.0, 3.0];
/// Errors at which lines are compared.
const ACCURACIES: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// # Errors
/// Arguments that are wrong, files that cannot be written.
pub fn run(words: &[String]) -> Result<(), Failed> {
    let (mut quick, mut out, mut names) = (false, PathBuf::from("out"), Vec::new());
    let mut words = words.iter().map(String::as_str);
    while let Some(word) = words.next() {
        match word {
            "--quick" => quick = true,
            "--out" => out = words.next().ok_or("--out needs a folder")?.into(),
            name if NAMES.contains(&name) => names.push(name),
            name => {
                return Err(format!("no system {name}: there are {}", NAMES.join(", ")).into());
            }
        }
    }
    if names.is_empty() {
        names = if quick { vec!["hires", "pollution"] } else { NAMES.to_vec() };
    }
    fs::create_dir_all(&out)?;
    for name in names {
        let limit = LIMITS[usize::from(quick)];
        let mut problem = problem(name, &out)?.tolerances(digits(quick, 2, 9));
        // patience: a slow peer is told by its limit alone; lines repeat themselves
        let study = Study::new(&mut problem).repetitions(1).limit(limit).patience(1e6);
        let findings = study.run(&mut |stage| eprintln!("{name}: {stage}"))?;
        write(&out, name, &findings)?;
    }
    Ok(())
}

/// How a system is solved.
enum Way {
    Bdf,
    Arkode,
    Ida,
    Rk,
    Diffsol(Kind),
    /// Python, the name of the system, and a folder for what it reads and writes.
    Scipy(Program, String, PathBuf),
}

/// A system with all lines.
fn problem(name: &str, folder: &Path) -> Result<General, Failed> {
    let system = Rc::new(System::find(name).ok_or(format!("no system {name}"))?);
    let problem = match system.truth.clone() {
        Some((y, resolution)) => General::new(system.title, system.t, y, resolution),
        None => {
            let scale = vec![1.0; system.y0.len()];
            General::agreed(system.title, system.t, scale, ["pliant arkode", "pliant rk"])
        }
    };
    let ways = if system.ode().mass_kind() == MassKind::Identity {
        let mut ways = vec![
            ("pliant cvode-bdf", "cvode-bdf", Way::Bdf),
            ("pliant arkode", "arkode", Way::Arkode),
            ("pliant rk", "rk", Way::Rk),
        ];
        for (name_of_line, method) in
            [("SciPy BDF", "BDF"), ("SciPy Radau", "Radau"), ("SciPy LSODA", "LSODA")]
        {
            let [python, script] =
                [".venv/bin/python", "scipy/equations.py"].map(|path| here(&[path]).remove(0));
            let library = std::env::current_exe()?.with_file_name(libname()).display().to_string();
            let program = Program { command: vec![python, script, library], method, patience: 1.0 };
            ways.push((name_of_line, "SciPy", Way::Scipy(program, name.into(), folder.into())));
        }
        ways
    } else {
        vec![("pliant ida", "ida", Way::Ida)]
    };
    let diffsol = [
        ("diffsol bdf", Kind::Bdf),
        ("diffsol tr_bdf2", Kind::TrBdf2),
        ("diffsol esdirk34", Kind::Esdirk34),
    ];
    let diffsol = diffsol.map(|(name, kind)| (name, "diffsol", Way::Diffsol(kind)));
    Ok(ways.into_iter().chain(diffsol).fold(problem, |problem, (name, family, way)| {
        let system = Rc::clone(&system);
        let slow = Cell::new(false);
        problem.line(name, family, move |goal| {
            if slow.get() {
                return Err(TOO_SLOW.into());
            }
            let start = Instant::now();
            way.repeated(&system, goal).inspect_err(|_| {
                // what is finer takes no less
                slow.set(start.elapsed() > goal.limit);
            })
        })
    }))
}

impl Way {
    /// The least processor time of some runs. A program repeats itself.
    fn repeated(&self, system: &System, goal: &Goal) -> Result<EndState, Failed> {
        if let Self::Scipy(program, name, folder) = self {
            return scipy(program, name, folder, system, goal);
        }
        let (mut least, mut all, mut count) = (f64::INFINITY, 0.0, 0);
        loop {
            let clock = Clock::new(f64::INFINITY);
            let reached = self.reach(system, goal)?;
            let seconds = clock.seconds();
            (least, all, count) = (least.min(seconds), all + seconds, count + 1);
            if count == REPETITIONS || all > ENOUGH {
                return Ok(EndState { seconds: Some(least), ..reached });
            }
        }
    }

    fn reach(&self, system: &System, goal: &Goal) -> Result<EndState, Failed> {
        let (y0, newton, jacobian) = (&system.y0, || newton(system), Jacobian::Supplied);
        match self {
            Self::Bdf => {
                let options = goal.cvode().newton(newton());
                goal.reach(Cvode::new(system.ode(), 0.0, y0, &options)?)
            }
            Self::Arkode => {
                let options = goal.arkode().newton(newton());
                goal.reach(Arkode::new(system.ode(), 0.0, y0, &options)?)
            }
            Self::Rk => goal.reach(DormandPrince::new(system.ode(), 0.0, y0, &goal.rk())?),
            Self::Ida => {
                let newton = LinearSolver::Dense(jacobian);
                let form = MassForm::new(system.ode(), y0.len(), &newton)?;
                let options = goal.ida().newton(newton);
                let slope = TransistorAmplifier::YP0;
                goal.reach(Ida::new(form, 0.0, y0, &slope, &options)?)
            }
            Self::Diffsol(kind) => diffsol::integrate(system, *kind, goal),
            Self::Scipy(..) => Err("a program".into()),
        }
    }
}

fn newton(system: &System) -> LinearSolver {
    let jacobian = Jacobian::Supplied;
    match &system.pattern {
        Some(pattern) => LinearSolver::Klu { pattern: pattern.clone(), jacobian },
        None => LinearSolver::Dense(jacobian),
    }
}

fn scipy(
    program: &Program,
    name: &str,
    folder: &Path,
    system: &System,
    goal: &Goal,
) -> Result<EndState, Failed> {
    let [atol, out] = ["atol", "end"].map(|file| folder.join(format!("{name}.{file}")));
    fs::write(&atol, goal.atol.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>())?;
    let rtol = goal.rtol.to_string();
    let arguments =
        [OsStr::new(name), OsStr::new(program.method), OsStr::new(&rtol), atol.as_os_str()];
    let limit = goal.limit.as_secs_f64();
    let solved = program.call(arguments.into_iter(), &out, system.y0.len(), limit)?;
    Ok(EndState {
        y: solved.u,
        seconds: Some(solved.seconds),
        steps: solved.steps,
        evaluations: solved.evaluations,
        factorizations: solved.factorizations,
    })
}

/// Chart, and a table of the times (s) of each line for each accuracy, with how many times as long as the fastest of
/// pliant that is.
fn write(out: &Path, name: &str, findings: &Findings) -> Result<(), Failed> {
    for ending in ["svg", "png"] {
        findings.write_chart(out.join(format!("{name}.{ending}")))?;
    }
    let mut page = format!("## {}\n\n![chart]({name}.png)\n\n", findings.title());
    let lines: Vec<_> = findings.lines().iter().collect();
    let label = |error| format!("{error:.0e}");
    page += &report::ranking(&lines, &ACCURACIES, label, time_text, |line, error| {
        line.time_to_reach(error)
    })?;
    page += "\n";
    for note in findings.notes().iter().filter(|note| !note.ends_with(TOO_SLOW)) {
        writeln!(page, "- {note}")?;
    }
    fs::write(out.join(format!("{name}.md")), &page)?;
    println!("{page}");
    Ok(())
}

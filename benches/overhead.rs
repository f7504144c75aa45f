//! Cost of CVODE and IDA through pliant, against the same runs in C (`benches/c/overhead.c`).
//!
//! `cargo bench --bench overhead`; it needs a C compiler (`CC`, or else `cc`), and valgrind for the instructions. Both
//! sides are programs of their own and take turns. Times are the least of all runs, from the first object made to
//! the last one freed; instructions are counted by callgrind in some runs and in twice as many, and their difference is
//! divided by that of the runs. The counters of both sides have to be the same.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use pliant::{
    ode::Ode,
    samples::{Brusselator, Hires, Pollution, Robertson, TransistorAmplifier, VanDerPol},
    sundials::{
        Cvode, CvodeOptions, Ida, IdaOptions, Integrator, Jacobian, LinearSolver, MassForm,
        Statistics,
    },
};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Problem and linear solver.
const CASES: [[&str; 2]; 8] = [
    ["hires", "dense"],
    ["hires", "klu"],
    ["robertson", "dense"],
    ["vanderpol", "dense"],
    ["pollution", "dense"],
    ["brusselator", "band"],
    ["brusselator", "klu"],
    ["amplifier", "dense"],
];
/// Points of the Brusselator.
const POINTS: usize = 20;
/// How often the sides take turns, and the runs of a turn.
const TURNS: usize = 40;
const RUNS: usize = 40;
/// Runs whose instructions are counted.
const COUNTED: usize = 10;
const COUNTERS: [&str; 7] = [
    "steps",
    "evaluations",
    "Jacobians",
    "setups",
    "error test failures",
    "nonlinear iterations",
    "nonlinear failures",
];
const LIBRARIES: [&str; 11] = [
    "sundials_cvodes",
    "sundials_idas",
    "sundials_nvecserial",
    "sundials_sunmatrixband",
    "sundials_sunmatrixdense",
    "sundials_sunmatrixsparse",
    "sundials_sunlinsolband",
    "sundials_sunlinsoldense",
    "sundials_sunlinsolklu",
    "klu",
    "m",
];

/// One run by pliant.
fn run(problem: &str, solver: &str) -> Outcome<Statistics> {
    let jacobian = Jacobian::Supplied;
    let newton = match (problem, solver) {
        ("hires", "klu") => LinearSolver::Klu { pattern: Hires::new().pattern().clone(), jacobian },
        ("brusselator", "klu") => {
            LinearSolver::Klu { pattern: Brusselator::new(POINTS).pattern().clone(), jacobian }
        }
        (_, "band") => {
            let bandwidth = Brusselator::BANDWIDTH;
            LinearSolver::Band { lower: bandwidth, upper: bandwidth, jacobian }
        }
        _ => LinearSolver::Dense(jacobian),
    };
    if problem == "amplifier" {
        return amplifier(newton);
    }
    let options = |atol: &[f64]| CvodeOptions::new(1e-8, atol.to_vec()).newton(newton);
    match problem {
        "hires" => solve(Hires::new(), &Hires::Y0, Hires::REFERENCE.t, &options(&[1e-12; 8])),
        "robertson" => {
            let options = options(&[1e-14, 1e-19, 1e-10]);
            solve(Robertson::new(), &Robertson::Y0, Robertson::REFERENCE.t, &options)
        }
        "pollution" => {
            let options = options(&[1e-12; 20]);
            solve(Pollution::new(), &Pollution::Y0, Pollution::REFERENCE.t, &options)
        }
        "brusselator" => {
            let system = Brusselator::new(POINTS);
            let y0 = system.y0();
            solve(system, &y0, Brusselator::REFERENCE_20.t, &options(&[1e-12; 2 * POINTS]))
        }
        _ => {
            let options = options(&[1e-12; 2]);
            solve(VanDerPol::new(), &VanDerPol::Y0, VanDerPol::REFERENCE.t, &options)
        }
    }
}

fn solve(system: impl Ode, y0: &[f64], end: f64, options: &CvodeOptions) -> Outcome<Statistics> {
    let mut solver = Cvode::new(system, 0.0, y0, options)?;
    solver.solve_to(end)?;
    Ok(solver.statistics())
}

fn amplifier(newton: LinearSolver) -> Outcome<Statistics> {
    let system = MassForm::new(TransistorAmplifier, 8, &newton)?;
    let (y0, slope) = (TransistorAmplifier::Y0, TransistorAmplifier::YP0);
    let options = IdaOptions::new(1e-5, 1e-5).newton(newton).max_order(3);
    let mut solver = Ida::new(system, 0.0, &y0, &slope, &options)?;
    solver.solve_to(TransistorAmplifier::REFERENCE.t)?;
    Ok(solver.statistics())
}

/// Some runs by pliant: prints what the program in C does.
fn turn(problem: &str, solver: &str, runs: usize) -> Outcome<()> {
    let (mut least, mut statistics) = (f64::INFINITY, Statistics::default());
    for _ in 0..runs {
        let clock = Instant::now();
        statistics = run(problem, solver)?;
        least = least.min(clock.elapsed().as_secs_f64());
    }
    let counters = [
        statistics.steps,
        statistics.evaluations,
        statistics.jacobian_evaluations,
        statistics.linear_setups,
        statistics.error_test_failures,
        statistics.nonlinear_iterations,
        statistics.nonlinear_failures,
    ];
    println!("{least:.9} {}", counters.map(|count| count.to_string()).join(" "));
    Ok(())
}

/// Builds the program in C.
fn build() -> Outcome<PathBuf> {
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("overhead-c");
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/c/overhead.c");
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
    let mut command = Command::new(&compiler);
    command.args(["-O3", "-o"]).arg(&program).arg(source);
    for name in ["SUNDIALS_INCLUDE_DIR", "SUITESPARSE_INCLUDE_DIR"] {
        command.args(std::env::var(name).map(|directory| format!("-I{directory}")));
    }
    command.arg("-I/usr/include/suitesparse");
    command.args(std::env::var("SUNDIALS_LIBRARY_DIR").map(|directory| format!("-L{directory}")));
    command.args(LIBRARIES.map(|library| format!("-l{library}")));
    let status = command.status().map_err(|error| format!("{compiler}: {error}"))?;
    if status.success() { Ok(program) } else { Err(format!("{compiler}: {status}").into()) }
}

/// Output of a program, all numbers.
fn output(command: &mut Command) -> Outcome<Vec<f64>> {
    let output = command.output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let text = String::from_utf8(output.stdout)?;
    Ok(text.split_whitespace().map(str::parse).collect::<Result<_, _>>()?)
}

/// Instructions of so many runs.
fn instructions(program: &Path, case: [&str; 2], runs: usize) -> Outcome<f64> {
    let profile = Path::new(env!("CARGO_TARGET_TMPDIR")).join("overhead-callgrind");
    let mut command = Command::new("valgrind");
    command.args(["-q", "--tool=callgrind"]);
    command.arg(format!("--callgrind-out-file={}", profile.display()));
    output(command.arg(program).args(case).arg(runs.to_string()))?;
    let profile = std::fs::read_to_string(&profile)?;
    let count = profile.lines().find_map(|line| line.strip_prefix("summary: "));
    Ok(count.ok_or("callgrind counts nothing")?.trim().parse()?)
}

fn main() -> Outcome<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [problem, solver, runs] = &arguments[..] {
        return turn(problem, solver, runs.parse()?);
    }
    let sides = [build()?, std::env::current_exe()?];
    let has_valgrind = Command::new("valgrind").arg("--version").output().is_ok();
    println!(
        "{:16} {:>6} {:>10} {:>11} {:>6} {:>16} {:>16} {:>6}",
        "", "steps", "C (us)", "pliant (us)", "ratio", "C (instructions)", "pliant", "ratio"
    );
    for case in CASES {
        let mut counters = [const { Vec::new() }; 2];
        let mut least = [f64::INFINITY; 2];
        for _ in 0..TURNS {
            for side in 0..2 {
                let printed = output(Command::new(&sides[side]).args(case).arg(RUNS.to_string()))?;
                least[side] = least[side].min(1e6 * printed[0]);
                counters[side] = printed[1..].to_vec();
            }
        }
        for (name, (c, pliant)) in COUNTERS.iter().zip(counters[0].iter().zip(&counters[1])) {
            if c != pliant {
                return Err(format!("{case:?}: {name}: {c} in C, {pliant} by pliant").into());
            }
        }
        let (steps, [c, pliant]) = (counters[0][0], least);
        print!("{:16} {steps:6} {c:10.1} {pliant:11.1} {:6.3}", case.join(", "), pliant / c);
        if has_valgrind {
            let mut counts = [0.0; 2];
            for (side, count) in sides.iter().zip(&mut counts) {
                let twice = instructions(side, case, 2 * COUNTED)?;
                *count = (twice - instructions(side, case, COUNTED)?) / COUNTED as f64;
            }
            let [c, pliant] = counts;
            print!(" {c:16.0} {pliant:16.0} {:6.3}", pliant / c);
        }
        println!();
    }
    Ok(())
}

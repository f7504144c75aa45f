//! Slowdowns, found by numbers of instructions, which are free of timing noise.
//!
//! `cargo bench --bench counts` counts the instructions of small cases by callgrind and compares them with those that
//! `baseline.txt` keeps: it fails where one grew by more than [`GROWTH`], and where one fell by more than [`FALL`], so that what
//! was won is kept, too. `cargo bench --bench counts -- --store` makes a new baseline (`make baseline`).
//!
//! Counts depend on the compiler, on the libraries and on the processor (callgrind shows programs one with AVX2 at
//! most, and only where the machine has it). The baseline names its own; where they are others, or valgrind is missing,
//! nothing is compared, and nothing fails.

mod cases;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

use cases::Outcome;

const BASELINE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/baseline.txt");
/// Growth that fails, and fall that asks for a new baseline, as parts of the baseline.
const GROWTH: f64 = 0.04;
const FALL: f64 = 0.15;

/// Instructions of one case.
#[derive(Debug, Clone, PartialEq)]
struct Counted {
    name: String,
    /// Unit of the count, such as a cell.
    unit: String,
    instructions: f64,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let is_asked = |flag: &str| arguments.iter().any(|argument| argument == flag);
    let done = match () {
        () if is_asked("--run") => run_cases(),
        () if is_asked("--store") => store(),
        () => compare(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Does all cases, under callgrind, and tells their names, in order.
fn run_cases() -> Outcome {
    cases::run(&mut |name, unit, number, work| {
        work()?; // what is allocated, linked or decided once
        let done = counted_by_callgrind(work);
        println!("{name}\t{unit}\t{number}");
        done
    })
}

/// Callgrind writes down what it has counted where it leaves this function.
#[inline(never)]
fn counted_by_callgrind(work: &mut dyn FnMut() -> Outcome) -> Outcome {
    counted_from_here();
    let done = work();
    // so that the call above is no jump, and this function is left here
    std::hint::black_box(&done);
    done
}

/// Callgrind begins to count where it enters this function.
#[inline(never)]
fn counted_from_here() {
    std::hint::black_box(());
}

fn store() -> Outcome {
    let here = surroundings()?;
    let mut text = format!(
        "# Instructions, counted by callgrind; `make baseline` writes this file, `make test` compares.\n# {here}\n"
    );
    for Counted { name, unit, instructions } in count()? {
        writeln!(text, "{instructions:12.1} per {unit:9} {name}")?;
    }
    fs::write(BASELINE, &text)?;
    println!("{text}");
    Ok(())
}

fn compare() -> Outcome {
    let text = fs::read_to_string(BASELINE)?;
    let theirs = text.lines().nth(1).unwrap_or("").trim_start_matches("# ");
    let skipped = |reason: &str| {
        println!("counts: not compared: {reason}; `make baseline` stores others");
        Ok(())
    };
    match surroundings() {
        Err(error) => return skipped(&error.to_string()),
        Ok(here) if here != theirs => {
            return skipped(&format!("the baseline is of {theirs}; this is {here}"));
        }
        Ok(_) => {}
    }
    let (now, mut before) = (count()?, parse(&text)?);
    let mut troubles = String::new();
    println!("{:42} {:>12} {:>12} {:>8}", "instructions", "baseline", "now", "change");
    for Counted { name, unit, instructions } in now {
        let label = format!("{name}, per {unit}");
        match before.remove(&(name, unit)) {
            None => writeln!(troubles, "  {label}: not in the baseline")?,
            Some(old) => {
                let change = instructions / old - 1.0;
                let percent = 100.0 * change;
                println!("{label:42} {old:12.1} {instructions:12.1} {percent:+7.1}%");
                if !(-FALL..=GROWTH).contains(&change) {
                    let verb = if change > 0.0 { "grew" } else { "fell" };
                    writeln!(
                        troubles,
                        "  {label}: {verb} from {old:.1} to {instructions:.1} ({percent:+.1}%)"
                    )?;
                }
            }
        }
    }
    for (name, unit) in before.keys() {
        writeln!(troubles, "  {name}, per {unit}: in the baseline, but no longer counted")?;
    }
    match troubles.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "counts: instructions are no longer those of the baseline (at most {:+.0} %, at least {:+.0} %):\n{troubles}\
             Make what grew cheaper again; where it is worth its price, or has fallen, store a new baseline by\n    \
             make baseline\nand say in the commit why.",
            100.0 * GROWTH,
            -100.0 * FALL,
        )
        .into()),
    }
}

/// Instructions by name and unit, as [`store`] writes them.
fn parse(text: &str) -> Outcome<BTreeMap<(String, String), f64>> {
    let line = |line: &str| {
        let mut words = line.split_whitespace();
        let (number, _, unit) = (words.next()?, words.next()?, words.next()?);
        let name = words.collect::<Vec<_>>().join(" ");
        Some(((name, unit.to_owned()), number.parse().ok()?))
    };
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|text| line(text).ok_or_else(|| format!("{BASELINE}: {text}").into())).collect()
}

/// Counts all cases.
fn count() -> Outcome<Vec<Counted>> {
    let folder = tempfile::tempdir()?;
    let profile = folder.path().join("profile");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--zero-before=*counted_from_here*"])
        .args(["--dump-after=*counted_by_callgrind*"])
        .arg(format!("--callgrind-out-file={}", profile.display()))
        .arg(std::env::current_exe()?)
        .arg("--run")
        .env("RAYON_NUM_THREADS", "1")
        .stderr(Stdio::piped())
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let listed = String::from_utf8(output.stdout)?;
    let case = |(number, line): (usize, &str)| {
        let words: Vec<&str> = line.split('\t').collect();
        let [name, unit, parts] = words[..] else { return Err(line.to_owned().into()) };
        let total = total(&folder.path().join(format!("profile.{}", number + 1)))?;
        let instructions = total / parts.parse::<f64>()?;
        Ok(Counted { name: name.into(), unit: unit.into(), instructions })
    };
    listed.lines().enumerate().map(case).collect()
}

/// Instructions that a profile tells in all.
fn total(profile: &Path) -> Outcome<f64> {
    let text = fs::read_to_string(profile)?;
    let total = text.lines().find_map(|line| line.strip_prefix("totals: "));
    Ok(total.ok_or("a profile of callgrind without totals")?.parse()?)
}

/// Environment that counts depend on besides the code.
fn surroundings() -> Outcome<String> {
    let answer = |program: &str, argument: &str| -> Outcome<String> {
        let output = Command::new(program).arg(argument).output();
        let output = output.map_err(|error| format!("{program}: {error}"))?;
        Ok(String::from_utf8(output.stdout)?.trim().to_owned())
    };
    Ok([
        answer("rustc", "--version")?,
        answer("valgrind", "--version")?,
        answer("getconf", "GNU_LIBC_VERSION")?,
        format!("SUNDIALS {}", pliant::sundials::version()),
        format!("SuiteSparse {}", pliant::sundials::suitesparse_version()),
        processor(),
    ]
    .join(", "))
}

/// The processor, as far as valgrind knows more of it than the least, and what the build is for.
fn processor() -> String {
    #[cfg(target_arch = "x86_64")]
    let has_avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    let has_avx2 = false;
    let more = [(has_avx2, " with AVX2"), (cfg!(target_feature = "avx"), ", built for AVX")];
    let more = more.iter().filter(|(holds, _)| *holds).map(|(_, words)| *words);
    std::iter::once(std::env::consts::ARCH).chain(more).collect()
}

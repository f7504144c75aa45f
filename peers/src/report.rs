//! What was found: chart, table of all runs, and who is the fastest for each accuracy.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use pliant::study::{Failed, Findings, LineFindings};

use crate::comparison::{LUMPED, TOO_SLOW};
use pliant_peers::scenes::Case;

/// Errors of the tip (mm) for which times are compared.
const ACCURACIES: [f64; 5] = [1.0, 0.1, 0.01, 0.001, 0.0001];

/// Writes chart, CSV and a page in Markdown of one case into `out`.
pub fn write(
    out: &Path,
    case: &Case,
    findings: &Findings,
    tips: &BTreeMap<(String, String), f64>,
) -> Result<(), Failed> {
    fs::create_dir_all(out)?;
    let file = |extension: &str| out.join(format!("{}.{extension}", case.name));
    findings.write_csv(file("csv"))?;
    for extension in ["svg", "png"] {
        findings.write_chart(file(extension))?;
    }
    let mut page = format!("## {}\n\n![chart]({}.png)\n\n", case.title, case.name);
    page += "Processor time (s) to reach an error of the tip, and times as long as the fastest of pliant with the same \
             inertia (lumped inertia is another model, compared with a reference of its own):\n";
    for is_lumped in [false, true] {
        let lines = findings.lines().iter().filter(|line| line.name.ends_with(LUMPED) == is_lumped);
        page += "\n";
        page += &tip_table(&lines.collect::<Vec<_>>(), tips)?;
    }
    page +=
        "\nAll runs: error of node positions (relative), of the tip (mm), processor time (s).\n\n";
    page += &all_runs(findings, tips)?;
    page += "\n";
    for note in findings.notes().iter().filter(|note| !note.ends_with(TOO_SLOW)) {
        writeln!(page, "- {note}")?;
    }
    fs::write(file("md"), &page)?;
    println!("{page}");
    Ok(())
}

/// Time (s) that a line takes to reach an error of the tip (m).
fn time_to_reach(
    line: &LineFindings,
    tips: &BTreeMap<(String, String), f64>,
    error: f64,
) -> Option<f64> {
    let mut by_tip = line.clone();
    for row in &mut by_tip.rows {
        row.error = row.error.and(tips.get(&(row.line.clone(), row.point.clone())).copied());
    }
    by_tip.time_to_reach(error)
}

fn tip_table(
    lines: &[&LineFindings],
    tips: &BTreeMap<(String, String), f64>,
) -> Result<String, Failed> {
    let (label, text) = (|error| format!("{error} mm"), |time| format!("{time:.3}"));
    ranking(lines, &ACCURACIES, label, text, |line, error| time_to_reach(line, tips, 1e-3 * error))
}

/// A table of the times that `lines` take to reach some errors, and how many times as long as the fastest of
/// pliant among them that is. Both are bold where that one is slower.
pub fn ranking(
    lines: &[&LineFindings],
    errors: &[f64],
    label: impl Fn(f64) -> String,
    text: impl Fn(f64) -> String,
    time: impl Fn(&LineFindings, f64) -> Option<f64>,
) -> Result<String, Failed> {
    let mut table = "| line |".to_owned();
    for &error in errors {
        write!(table, " {} |", label(error))?;
    }
    table += "\n| --- |";
    table += &" --- |".repeat(errors.len());
    let own = lines.iter().filter(|line| line.name.starts_with("pliant"));
    let best =
        |&error: &f64| own.clone().filter_map(|line| time(line, error)).min_by(f64::total_cmp);
    let best: Vec<Option<f64>> = errors.iter().map(best).collect();
    for line in lines {
        write!(table, "\n| {} |", line.name)?;
        for (&error, &best) in errors.iter().zip(&best) {
            let Some(time) = time(line, error) else {
                table += " |";
                continue;
            };
            let words = text(time);
            match best {
                Some(best) if time < best => write!(table, " **{words} ({:.2})** |", time / best)?,
                Some(best) => write!(table, " {words} ({:.1}) |", time / best)?,
                None => write!(table, " **{words}** |")?,
            }
        }
    }
    Ok(table + "\n")
}

fn all_runs(findings: &Findings, tips: &BTreeMap<(String, String), f64>) -> Result<String, Failed> {
    let mut table =
        "| line | setting | error | tip, mm | time, s | steps | forces | factorizations |\n\
                     | --- | --- | --- | --- | --- | --- | --- | --- |\n"
            .to_owned();
    for row in findings.rows() {
        let Some(error) = row.error else { continue };
        let tip = tips.get(&(row.line.clone(), row.point.clone())).copied().unwrap_or(f64::NAN);
        let count = |count: Option<usize>| match count {
            None | Some(0) => String::new(),
            Some(count) => count.to_string(),
        };
        writeln!(
            table,
            "| {} | {} | {error:.1e} | {:.2e} | {:.4} | {} | {} | {} |",
            row.line,
            row.point,
            1e3 * tip,
            row.seconds,
            count(row.steps),
            count(row.evaluations),
            count(row.factorizations),
        )?;
    }
    Ok(table)
}

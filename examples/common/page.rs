//! A page of charts: tables over all problems, then chart, reading and table of each.
//!
//! A file of readings holds the prose: what stands before the first problem, then a section for each,
//! headed by its name. Numbers in it come from the findings, by what stands in braces:
//!
//! - `{time of LINE at ERROR}`: how long a line takes to reach a relative error;
//! - `{LINE / LINE at ERROR}`: how many times longer the first one takes;
//! - `{error of LINE at POINT}`, `{energy of LINE at POINT}`, `{steps of LINE at POINT}`,
//!   `{seconds of LINE at POINT}`: of a run;
//! - `{fastest}`, `{auto}`, `{asked}`: the tables over all problems.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use pliant::Error;
use pliant::study::{Findings, LineFindings, Problem, Row, Study, time_text};

/// Relative tolerances at which the automatic choice is judged, as points are named.
const JUDGED: [&str; 3] = ["1e-3", "1e-5", "1e-7"];

/// Times as long as the fastest method that the automatic choice should take at most, and may.
const TARGETS: [f64; 2] = [1.5, 3.0];

/// Relative tolerances at which the error of the automatic choice is compared with what was asked for, and the least and the
/// most that it should be of it.
const ASKED: [&str; 6] = ["1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-7"];
const CALIBRATED: [f64; 2] = [0.1, 3.0];

/// A problem and what was found.
pub struct Section {
    /// As in the names of files.
    pub name: String,
    /// Over chart and section.
    pub title: &'static str,
    /// Whether its lines are methods, which are ranked over all problems.
    pub compares_methods: bool,
    pub findings: Findings,
}

/// How a page of charts is made.
pub struct Making<'a> {
    pub repetitions: usize,
    /// Processor time that any run may take (s).
    pub limit: f64,
    /// Directory for the rows that are kept.
    pub keep: &'a Path,
    /// Directory for the charts.
    pub charts: &'a Path,
}

impl Making<'_> {
    /// Runs a problem, draws its chart, and tells who is the fastest.
    pub fn section(
        &self,
        name: String,
        title: &'static str,
        compares_methods: bool,
        problem: &mut dyn Problem,
    ) -> Result<Section, Error> {
        let findings = Study::new(problem)
            .repetitions(self.repetitions)
            .limit(self.limit)
            .keep(self.keep.join(format!("{name}.csv")))
            .run(&mut |stage| eprintln!("{name}: {stage}"))?
            .by_processor_time();
        findings.write_chart(self.charts.join(format!("{name}.svg")))?;
        println!("{title}\n\n{}\n", findings.fastest());
        Ok(Section { name, title, compares_methods, findings })
    }
}

/// Writes a page.
pub fn write(path: &Path, page: &str) -> Result<(), Error> {
    fs::write(path, page).map_err(|source| Error::Output { path: path.into(), source })
}

/// The page in Markdown, with charts at `charts`.
pub fn page(readings: &str, charts: &str, sections: &[Section]) -> String {
    let before = readings.split("\n### ").next().unwrap_or_default();
    let tables = before.replace("{fastest}", &fastest(sections)).replace("{auto}", &auto(sections));
    let mut page = tables.replace("{asked}", &asked(sections));
    sections.iter().for_each(|section| page += &section.text(readings, charts));
    page
}

impl Section {
    fn text(&self, readings: &str, charts: &str) -> String {
        let Self { title, name, findings, .. } = self;
        let reading = filled(reading(readings, name), findings);
        let table = findings.fastest().markdown();
        let notes: String = findings.notes().iter().map(|note| format!("- {note}\n")).collect();
        format!(
            "\n### {title}\n\n![{title}: error over time]({charts}{name}.svg)\n\n{reading}\n\n{table}\n\
             <details><summary>Notes</summary>\n\n{notes}\n</details>\n"
        )
    }
}

/// Text on a problem, from the section of this name in `readings`.
fn reading<'a>(readings: &'a str, name: &str) -> &'a str {
    readings
        .split("\n### ")
        .skip(1)
        .filter_map(|section| section.split_once('\n'))
        .find_map(|(heading, text)| (heading == name).then_some(text.trim()))
        .unwrap_or_else(|| panic!("there is no reading of {name}"))
}

/// `text` with numbers for what stands in braces.
fn filled(text: &str, findings: &Findings) -> String {
    let mut pieces = text.split(['{', '}']);
    let mut filled = pieces.next().unwrap_or_default().to_owned();
    while let (Some(asked), Some(rest)) = (pieces.next(), pieces.next()) {
        filled += &number(asked, findings).unwrap_or("(none)".into());
        filled += rest;
    }
    filled
}

/// Number that is `asked` for; none if no run has it.
fn number(asked: &str, findings: &Findings) -> Option<String> {
    let known = |name: &str| findings.lines().iter().find(|line| line.name == name);
    let line = |name: &str| known(name).unwrap_or_else(|| panic!("{{{asked}}}: no line {name}"));
    let parts = |text: &str| panic!("{{{asked}}}: it lacks \"{text}\"");
    let (what, at) = asked.rsplit_once(" at ").unwrap_or_else(|| parts("at"));
    let time = |name: &str| line(name).time_to_reach(at.parse().expect("an error"));
    if let Some((long, short)) = what.split_once(" / ") {
        return Some(ratio_text(time(long)? / time(short)?));
    }
    let (what, name) = what.split_once(" of ").unwrap_or_else(|| parts("of"));
    let row = || row(line(name), at);
    match what {
        "time" => time(name).map(time_text),
        "error" => row()?.error.map(part_text),
        "energy" => row()?.energy_error.map(part_text),
        "steps" => row()?.steps.map(|steps| steps.to_string()),
        "seconds" => row().map(|row| time_text(row.seconds)),
        _ => panic!("{{{asked}}}: there is no {what}"),
    }
}

fn row<'a>(line: &'a LineFindings, point: &str) -> Option<&'a Row> {
    line.rows.iter().find(|row| row.point == point)
}

/// A part of a whole.
fn part_text(part: f64) -> String {
    match part {
        small if small < 1e-3 => format!("{small:.0e}"),
        small if small < 0.0995 => format!("{:.1} %", 100.0 * small),
        large => format!("{:.0} %", 100.0 * large),
    }
}

fn ratio_text(ratio: f64) -> String {
    format!("{ratio:.*}", usize::from(ratio < 9.95))
}

/// The fastest method for each accuracy, problem by problem, the automatic choice left aside.
fn fastest(sections: &[Section]) -> String {
    let accuracies: [String; 6] = std::array::from_fn(|k| format!("1e-{}", k + 1));
    let mut table = head(&accuracies);
    for Section { title, findings, .. } in methods(sections) {
        write!(table, "\n| {title} |").unwrap();
        for accuracy in &findings.fastest().accuracies[..accuracies.len()] {
            let cell = match accuracy.reached.iter().find(|(name, _)| name != "auto") {
                Some((name, time)) => format!("{name}: {}", time_text(*time)),
                None if accuracy.is_resolved => "none".into(),
                None => "–".into(),
            };
            write!(table, " {cell} |").unwrap();
        }
    }
    table
}

/// The head of a table over all problems.
fn head(columns: &[String]) -> String {
    let rule = " --- |".repeat(columns.len());
    format!("| problem | {} |\n| --- |{rule}", columns.join(" | "))
}

fn methods(sections: &[Section]) -> impl Iterator<Item = &Section> {
    sections.iter().filter(|section| section.compares_methods)
}

/// How much longer than the fastest other method the automatic choice takes for the error that
/// it has.
fn auto(sections: &[Section]) -> String {
    let mut table = head(&JUDGED.map(String::from));
    let mut ratios = Vec::new();
    for Section { title, findings, .. } in methods(sections) {
        let Some(auto) = findings.lines().iter().find(|line| line.name == "auto") else { continue };
        write!(table, "\n| {title} |").unwrap();
        for point in JUDGED {
            let cell = match compared(auto, point, findings) {
                Some((ratio, _)) if ratio <= TARGETS[0] => format!("{ratio:.2}"),
                Some((ratio, best)) => format!("**{ratio:.2}**, {best}"),
                None => "–".into(),
            };
            write!(table, " {cell} |").unwrap();
            ratios.extend(compared(auto, point, findings).map(|(ratio, _)| ratio));
        }
    }
    let above = |target: f64| ratios.iter().filter(|ratio| **ratio > target).count();
    let [missed, far] = TARGETS.map(above);
    let all = ratios.len();
    write!(
        table,
        "\n\nOf {all} ratios {missed} are above {}, {far} above {}.",
        TARGETS[0], TARGETS[1]
    )
    .unwrap();
    table
}

/// The error of the automatic choice over its tolerance.
fn asked(sections: &[Section]) -> String {
    let mut table = head(&ASKED.map(String::from));
    let mut ratios = Vec::new();
    for Section { title, findings, .. } in methods(sections) {
        let Some(auto) = findings.lines().iter().find(|line| line.name == "auto") else { continue };
        write!(table, "\n| {title} |").unwrap();
        for point in ASKED {
            let row = row(auto, point).filter(|row| row.is_resolved());
            let ratio = row.and_then(|row| Some(row.error? / row.rtol));
            let cell = match ratio {
                Some(ratio) if (CALIBRATED[0]..=CALIBRATED[1]).contains(&ratio) => {
                    format!("{ratio:.2}")
                }
                Some(ratio) => format!("**{ratio:.2}**"),
                None => "–".into(),
            };
            write!(table, " {cell} |").unwrap();
            ratios.extend(ratio);
        }
    }
    let [least, most] = CALIBRATED;
    let below = ratios.iter().filter(|ratio| **ratio < least).count();
    let above = ratios.iter().filter(|ratio| **ratio > most).count();
    let all = ratios.len();
    write!(table, "\n\nOf {all} ratios {below} are below {least}, {above} above {most}.").unwrap();
    table
}

/// The time of `auto` at `point`, relative to the least that any other line needs for the same
/// error, and the name of that line. None if the error is too near to that of the reference.
fn compared<'a>(
    auto: &LineFindings,
    point: &str,
    findings: &'a Findings,
) -> Option<(f64, &'a str)> {
    let row = row(auto, point).filter(|row| row.is_resolved())?;
    findings
        .lines()
        .iter()
        .filter(|line| line.name != auto.name)
        .filter_map(|line| {
            Some((row.seconds / line.time_to_reach(row.error?)?, line.name.as_str()))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))
}

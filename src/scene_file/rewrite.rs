//! The text of a scene file with other pressures and forces of actuators; all else stays as it was written.

use std::ops::Range;

use serde_json::Value;
use toml::de::{DeTable, DeValue};

use crate::external::Signal;
use crate::scene::Phase;

/// A phase whose signals are others than in the file.
pub(crate) struct Rewritten {
    /// Its number, from 0.
    pub(crate) number: usize,
    /// What it is now.
    pub(crate) phase: Phase,
    /// Whether the pressures are others, and the forces of actuators.
    pub(crate) changed: [bool; 2],
}

/// The keys of the pressures and of the forces of actuators.
const KEYS: [&str; 2] = ["pressure", "actuate"];

/// Tables as `[[phase.pressure]]` have no place of their own.
const ELSEWHERE: &str = "write the lists of each phase as pressure = [...], actuate = [...]";

/// The `text` of a scene file with other signals in the phases `changes`.
///
/// # Errors
/// A text in which there is no place for them.
pub(crate) fn rewritten(text: &str, changes: &[Rewritten]) -> Result<String, String> {
    let document = DeTable::parse(text).map_err(|error| error.message().to_owned())?;
    let phases = document.get_ref().get("phase").ok_or("the file has no phases")?;
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    for Rewritten { number, phase, changed } in changes {
        let table = match phases.get_ref() {
            DeValue::Array(tables) => {
                tables.get(*number).and_then(|table| table.get_ref().as_table())
            }
            DeValue::Table(table) if *number == 0 => Some(table),
            _ => None,
        };
        let missing = || format!("the file has no phase {}", number + 1);
        let table = table.ok_or_else(missing)?;
        for ((key, list), _) in KEYS
            .into_iter()
            .zip([pressures(phase), actuations(phase)])
            .zip(changed)
            .filter(|x| *x.1)
        {
            let edit = match table.get(key) {
                Some(value) if text.get(value.span()).is_some_and(is_list) => (value.span(), list),
                Some(_) => return Err(ELSEWHERE.into()),
                None => {
                    let until = table.get("until").ok_or_else(missing)?.span();
                    insertion(text, until.end, &format!("{key} = {list}"))
                }
            };
            edits.push(edit);
        }
    }
    edits.sort_by_key(|(place, _)| place.start);
    let mut result = String::new();
    let mut at = 0;
    for (place, new) in edits {
        let kept = text.get(at..place.start).ok_or(ELSEWHERE)?;
        result.push_str(kept);
        result.push_str(&new);
        at = place.end;
    }
    Ok(result + text.get(at..).unwrap_or_default())
}

/// Whether this is a list of tables, or one table, as it stands behind a key.
fn is_list(text: &str) -> bool {
    let begins = |inner: &str| inner.trim_start().starts_with(['{', ']', '#']);
    let begins = text.starts_with('{') || text.strip_prefix('[').is_some_and(begins);
    begins && text.ends_with([']', '}'])
}

/// Puts `entry` after the value that ends at `at`: on a line of its own, or, within braces, beside it.
fn insertion(text: &str, at: usize, entry: &str) -> (Range<usize>, String) {
    let rest = text.get(at..).unwrap_or_default();
    let line = rest.lines().next().unwrap_or_default();
    match line.trim_start().starts_with([',', '}']) {
        true => (at..at, format!(", {entry}")),
        false => {
            let end = at + line.len();
            (end..end, format!("\n{entry}"))
        }
    }
}

fn pressures(phase: &Phase) -> String {
    let entry = |(chamber, pressure): &(String, Signal)| {
        let chamber = quoted(chamber);
        format!("{{ chamber = {chamber}, {} }}", course(pressure, ["value", "values"]))
    };
    list(phase.pressures.iter().map(entry))
}

fn actuations(phase: &Phase) -> String {
    let entry = |(springs, force): &(Vec<String>, Signal)| {
        let springs: Vec<String> = springs.iter().map(|spring| quoted(spring)).collect();
        let springs = springs.join(", ");
        format!("{{ springs = [{springs}], {} }}", course(force, ["force", "forces"]))
    };
    list(phase.actuations.iter().map(entry))
}

fn list(entries: impl Iterator<Item = String>) -> String {
    let lines: String = entries.map(|entry| format!("    {entry},\n")).collect();
    format!("[\n{lines}]")
}

fn course(signal: &Signal, [one, many]: [&str; 2]) -> String {
    let times = signal.breaks();
    if times.is_empty() {
        return format!("{one} = {:?}", signal.at(0.0));
    }
    let values: Vec<f64> = times.iter().map(|t| signal.at(*t)).collect();
    format!("times = {times:?}, {many} = {values:?}")
}

/// A name in quotes; JSON escapes as TOML does.
fn quoted(name: &str) -> String {
    Value::from(name).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_else_changes() {
        let text = "title = \"a\"\n[[phase]] # one\nuntil = 1.0 # s\nhold = []\n\n[[phase]]\nuntil = 2.0\n\
                    pressure = { chamber = \"air\", value = 1 } # Pa\n";
        let change = |number, phase| Rewritten { number, phase, changed: [true, false] };
        let changes = [
            change(1, Phase::until(2.0).pressure_table("a\"b", [0.5, 1.5], [0.0, 2.0])),
            change(0, Phase::until(1.0).pressure("air", 3.0)),
        ];
        let expected = "title = \"a\"\n[[phase]] # one\nuntil = 1.0 # s\n\
                        pressure = [\n    { chamber = \"air\", value = 3.0 },\n]\n\
                        hold = []\n\n[[phase]]\nuntil = 2.0\npressure = [\n    \
                        { chamber = \"a\\\"b\", times = [0.5, 1.5], values = [0.0, 2.0] },\n] # Pa\n";
        assert_eq!(rewritten(text, &changes).unwrap(), expected);
        let inline = "phase = [{ until = 1.0, contact = false }]";
        let expected = "phase = [{ until = 1.0, pressure = [\n    { chamber = \"air\", value = 3.0 },\n], \
                        contact = false }]";
        assert_eq!(rewritten(inline, &changes[1..]).unwrap(), expected);
        for nested in [
            "[[phase]]\nuntil = 1.0\n[[phase.pressure]]\nchamber = \"air\"\nvalue = 1.0\n",
            "[[phase]]\nuntil = 1.0\n[phase.pressure]\nchamber = \"air\"\nvalue = 1.0\n",
            "[[phase]]\nuntil = 1.0\npressure.chamber = \"air\"\npressure.value = 1.0\n",
        ] {
            let error = rewritten(nested, &changes[1..]).unwrap_err();
            assert!(error.contains("pressure = [...]"), "{error}");
        }
    }
}

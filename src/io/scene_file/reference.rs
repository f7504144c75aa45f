//! The reference page of scene files.

use std::fmt::Write;

use super::device::{DeviceKey, DeviceTable};
use super::keys::{Default, Key, TableKeys, ValueType};
use super::material::LAW;
use super::top::TOP;

/// All tables and keys of scene files in Markdown, with types, units, defaults and examples, those of `devices` at the end.
pub(super) fn reference(devices: &[DeviceTable]) -> String {
    let mut page = sections(VALUES, &tables());
    for DeviceTable { word, about, keys, .. } in devices {
        page += &format!("\n### `[[{word}]]`\n\n{about}\n");
        if !keys.is_empty() {
            page += "\n| key | unit | meaning |\n| --- | --- | --- |\n";
        }
        for DeviceKey { name, unit, meaning } in *keys {
            page += &format!("| `{name}` | {unit} | {meaning} |\n");
        }
    }
    page
}

/// The same of study files.
#[cfg(feature = "sweep")]
pub fn study_reference() -> String {
    sections("", &tables_from(&super::study::STUDY))
}

fn sections(head: &str, tables: &[&'static TableKeys]) -> String {
    let mut page = String::from(head);
    for table in tables {
        // writing to a text cannot fail
        let _ = section(&mut page, table);
    }
    page
}

/// The laws of materials: the word of each, its purpose, and its constants with their units.
pub fn laws() -> impl Iterator<Item = (&'static str, &'static str, Vec<String>)> {
    LAW.kinds.iter().map(|kind| {
        let constant =
            |key: &Key| format!("{}: {} ({})", key.name, key.meaning.text, key.meaning.unit);
        (kind.word, kind.about, kind.keys.iter().map(constant).collect())
    })
}

const VALUES: &str = "\
A scene file is [TOML](https://toml.io), in SI units. Numbers need no decimal point. Where a list of tables is expected, a table
alone will do. Types below:

| type | what is written |
| --- | --- |
| number | `0.3`, `1e6`, `2` |
| whole number | 0 or above: `14` |
| vector | one number per dimension of space: `[0.0, -9.8]` |
| numbers along axes | one number per named axis (for one axis a number alone), or one per dimension, 0 along axes that are not named |
| formula | a function of time `t` (s) as a text: `\"2000 * sin(2*pi*3*t)\"`. It consists of numbers, `t`, `pi`, `e`, `+ - * / ^`, parentheses, \
`sin`, `cos`, `tan`, `asin`, `acos`, `atan`, `sinh`, `cosh`, `tanh`, `exp`, `ln`, `log10`, `sqrt`, `abs`, `min(a, b)`, `max(a, b)` and `step` (0 below 0, else 1); \
`-t^2` is -(t^2). Steps do not end at its kinks and jumps, as they do at the times of a table |
| vector or formulas | a vector any component of which may be a formula: `[0.0, \"-2*t\"]` |
| nodes | the name of a node set `\"left\"`, a number (from 1) `14`, a list of numbers `[14, 15]`, or `{ box = [[0.0, 0.0], [0.1, 0.02]] }` |
| corners | the lower and the upper corner of a box: `[[0.0, 0.0], [0.1, 0.02]]` |
| axes | `\"x\"`, or a list `[\"x\", \"y\"]` |
";

/// All tables, each once, the file itself first.
pub(super) fn tables() -> Vec<&'static TableKeys> {
    tables_from(&TOP)
}

fn tables_from(first: &'static TableKeys) -> Vec<&'static TableKeys> {
    let mut tables = vec![first];
    let mut at = 0;
    while let Some(table) = tables.get(at) {
        let inner: Vec<_> = table.all().flat_map(|key| inside(&key.holds)).collect();
        let known = |inner: &&TableKeys| tables.iter().any(|table| table.name == inner.name);
        let mut fresh: Vec<&TableKeys> = Vec::new();
        for inner in inner {
            if !known(&inner) && fresh.iter().all(|table| table.name != inner.name) {
                fresh.push(inner);
            }
        }
        at += 1;
        tables.splice(at..at, fresh);
    }
    tables
}

/// The tables in a value.
fn inside(holds: &'static ValueType) -> Vec<&'static TableKeys> {
    match holds {
        ValueType::Table(keys) | ValueType::Tables(keys) => vec![*keys],
        ValueType::Array(inner, _) | ValueType::List(inner) | ValueType::OneOrMore(inner) => {
            inside(inner)
        }
        ValueType::Either(several) => several.iter().flat_map(inside).collect(),
        _ => Vec::new(),
    }
}

fn section(page: &mut String, table: &TableKeys) -> std::fmt::Result {
    writeln!(page, "\n### {}\n\n{}\n", heading(table), table.about)?;
    if !table.one_of.is_empty() {
        let groups: Vec<String> = table.one_of.iter().map(|group| quoted(group, " and ")).collect();
        writeln!(page, "Exactly one of {} stands there.\n", groups.join(", or "))?;
    }
    writeln!(page, "```toml\n{}\n```\n", table.example)?;
    writeln!(page, "| key | type | unit | default | meaning |\n| --- | --- | --- | --- | --- |")?;
    if !table.kinds.is_empty() {
        let words: Vec<&str> = table.kinds.iter().map(|kind| kind.word).collect();
        writeln!(page, "| `kind` | {} | | required | the kind |", words_of(&words))?;
    }
    for key in table.keys {
        row(page, key)?;
    }
    for kind in table.kinds {
        writeln!(page, "| | **kind = \"{}\"** | | | {} |", kind.word, kind.about)?;
        for key in kind.keys {
            row(page, key)?;
        }
    }
    Ok(())
}

/// The heading of a table.
fn heading(table: &TableKeys) -> String {
    match table.name.contains(' ') {
        true => table.name.into(),
        false => format!("`{}`", table.name),
    }
}

fn row(page: &mut String, key: &Key) -> std::fmt::Result {
    let Key { name, holds, meaning, note, default, renamed_to } = key;
    let default = match default {
        Default::Required => "required",
        Default::Words(words) => words,
    };
    let (kind, unit) = (kind_of(holds), meaning.unit);
    let meaning = match (renamed_to, *note) {
        (Some(name), _) => format!("old name of `{name}`"),
        (None, "") => meaning.text.into(),
        (None, note) => format!("{}. {note}", meaning.text),
    };
    writeln!(page, "| `{name}` | {kind} | {unit} | {default} | {meaning} |")
}

/// Type of a value, in words.
fn kind_of(holds: &ValueType) -> String {
    match holds {
        ValueType::Number => "number".into(),
        ValueType::Count => "whole number".into(),
        ValueType::Flag => "`true` or `false`".into(),
        ValueType::Text => "text".into(),
        ValueType::Word(words) => words_of(&words()),
        ValueType::Array(inner, count) => format!("list of {count}: {}", kind_of(inner)),
        ValueType::List(inner) => format!("list: {}", kind_of(inner)),
        ValueType::OneOrMore(inner) => format!("{}, or a list", kind_of(inner)),
        ValueType::Either(several) => several.iter().map(kind_of).collect::<Vec<_>>().join("; or "),
        ValueType::Vector => "vector".into(),
        ValueType::Along => "numbers along axes".into(),
        ValueType::Changing => "number or formula".into(),
        ValueType::ChangingVector => "vector or formulas".into(),
        ValueType::Nodes => "nodes".into(),
        ValueType::Corners => "corners".into(),
        ValueType::Axes => "axes".into(),
        ValueType::Table(keys) => {
            format!("table [{}](#{})", keys.name.trim_matches(['[', ']']), anchor(keys))
        }
        ValueType::Tables(keys) => {
            format!("tables [{}](#{})", keys.name.trim_matches(['[', ']']), anchor(keys))
        }
    }
}

/// The anchor of a heading, as GitHub makes it.
fn anchor(table: &TableKeys) -> String {
    let kept = |c: &char| c.is_alphanumeric() || *c == '_' || *c == '-';
    table.name.to_lowercase().chars().filter(kept).collect()
}

fn words_of(words: &[&str]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("`\"{word}\"`")).collect();
    words.join(", ")
}

fn quoted(keys: &[&str], between: &str) -> String {
    keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(between)
}

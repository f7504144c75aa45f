//! `[solver]` and `[output]`.

use super::contents::{Format, OutputRequest};
use super::keys::{Holds, Key, TableKeys};
use super::selection::selection;
use super::value::Value;
use crate::error::Error;
use crate::input::positive;
use crate::mesh::Mesh;
use crate::settings::{Settings, SettingsOption, SettingsValue as Kind};

pub(super) const SOLVER: TableKeys = TableKeys::new(
    "[solver]",
    "How the equations of motion are integrated.",
    &OPTIONS,
    "[solver]\nmethod = \"cvode-bdf\"\nrtol = 1e-6\nalpha = 1e4",
);

const OPTIONS: [Key; SettingsOption::ALL.len()] = {
    let mut keys = [Key::number("", "", ""); SettingsOption::ALL.len()];
    let mut number = 0;
    while number < keys.len() {
        keys[number] = key(&SettingsOption::ALL[number]);
        number += 1;
    }
    keys
};

const fn key(option: &SettingsOption) -> Key {
    let holds = match option.value {
        Kind::Number(_) => Holds::Number,
        Kind::Count(_) => Holds::Count,
        Kind::Flag(_) => Holds::Flag,
        Kind::Word(words, _) => Holds::Word(words),
    };
    Key::new(option.key, holds, option.meaning).in_unit(option.unit).default(option.default)
}

pub(super) const OUTPUT: TableKeys = TableKeys::new(
    "[output]",
    "What `pliant run` writes.",
    &[
        Key::number("step", "the time between samples", "s").default("the ends of the phases only"),
        Key::new("track", Holds::Nodes, "nodes whose displacements the table lists"),
        Key::new(
            "formats",
            Holds::OneOrMore(&Holds::Word(|| Format::ALL.map(Format::name).into())),
            "what is written: a table, files for ParaView, snapshots, an animation",
        )
        .default("csv, which is always written"),
    ],
    "[output]\nstep = 0.01\ntrack = \"right\"\nformats = [\"csv\", \"svg\", \"html\"]",
);

pub(super) fn solver(value: &Value) -> Result<Settings, Error> {
    let table = value.table(&SOLVER)?;
    let mut settings = Settings::default();
    for option in SettingsOption::ALL {
        let Some(value) = table.get(option.key) else { continue };
        match option.value {
            Kind::Number(set) => set(&mut settings, value.number()?),
            Kind::Count(set) => set(&mut settings, value.count()?),
            Kind::Flag(set) => set(&mut settings, value.flag()?),
            Kind::Word(words, set) => {
                let words: Vec<_> = words().into_iter().map(|word| (word, word)).collect();
                set(&mut settings, value.word(&words)?).map_err(|error| table.blame(error))?;
            }
        }
    }
    settings.validate().map_err(|error| table.blame(error))?;
    Ok(settings)
}

pub(super) fn output(value: &Value, mesh: &Mesh) -> Result<OutputRequest, Error> {
    let table = value.table(&OUTPUT)?;
    let step = table.optional("step", Value::number)?;
    if let Some(step) = step {
        positive("step", step, "s").map_err(|error| table.blame(error))?;
    }
    let track = table.optional("track", |value| selection(value, mesh))?;
    let formats = table.optional("formats", |value| {
        let known = Format::ALL.map(|format| (format.name(), format));
        value.one_or_more()?.iter().map(|format| format.word(&known)).collect()
    })?;
    Ok(OutputRequest { step, track, formats: formats.unwrap_or_else(|| vec![Format::Csv]) })
}

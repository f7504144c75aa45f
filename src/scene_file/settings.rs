//! `[solver]` and `[output]`.

use super::selection::selection;
use super::value::Value;
use super::{Format, OutputRequest};
use crate::error::Error;
use crate::input::positive;
use crate::mesh::Mesh;
use crate::settings::{Settings, SettingsOption, SettingsValue as Kind};

pub(super) fn solver(value: &Value) -> Result<Settings, Error> {
    let options = SettingsOption::ALL.map(|option| (option.key(), option));
    let table = value.table(&options.each_ref().map(|(key, _)| key.as_str()))?;
    let mut settings = Settings::default();
    for (key, option) in &options {
        let Some(value) = table.get(key, option.meaning) else { continue };
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
    let table = value.table(&["step", "track", "formats"])?;
    let step = table.optional("step", "the time between samples (s)", Value::number)?;
    if let Some(step) = step {
        positive("step", step, "s").map_err(|error| table.blame(error))?;
    }
    let meaning = "nodes whose motion is written";
    let track = table.optional("track", meaning, |value| selection(value, mesh))?;
    let formats = table.optional("formats", "what is written", |value| {
        let known = Format::ALL.map(|format| (format.name(), format));
        value.one_or_more()?.iter().map(|format| format.word(&known)).collect()
    })?;
    Ok(OutputRequest { step, track, formats: formats.unwrap_or_else(|| vec![Format::Csv]) })
}

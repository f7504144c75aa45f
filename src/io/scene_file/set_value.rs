//! Values of keys, as `--set` takes them.

use std::fmt;

use toml::de::{DeTable, DeValue};

/// A value of a key of a scene file, as it is written after `KEY=`, and in a form in which equal values are equal texts.
///
/// ```
/// use pliant::scene_file::SetValue;
///
/// assert_eq!(SetValue::read("1e5").canonical(), SetValue::read("100000").canonical());
/// assert_eq!(SetValue::read("rk").canonical(), SetValue::read("\"rk\"").canonical());
/// assert_eq!(SetValue::read("[1, 2]").number(), None);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SetValue {
    text: String,
    canonical: String,
    number: Option<f64>,
}

impl SetValue {
    /// The value that a text stands for: a value of TOML, or else the text itself.
    pub fn read(text: &str) -> Self {
        let (key, text) = ("x", text.trim());
        let line = format!("{key} = {text}");
        let table = DeTable::parse(&line).ok();
        let value = table.as_ref().filter(|table| table.get_ref().len() == 1);
        match value.and_then(|table| table.get_ref().get(key)) {
            Some(value) => Self::of(value.get_ref(), text),
            None => Self { text: text.into(), canonical: quoted(text), number: None },
        }
    }

    /// A number; `is_whole` ones are written without a decimal point.
    pub fn from_number(number: f64, is_whole: bool) -> Self {
        let text = match is_whole && number.fract() == 0.0 && number.abs() < 1e15 {
            true => format!("{number:.0}"),
            false => format!("{number:?}"),
        };
        Self { text, canonical: of_number(number), number: Some(number) }
    }

    /// A value of TOML that is written as `text`.
    pub(super) fn of(value: &DeValue, text: &str) -> Self {
        // overrides are one line each
        let text = text.replace(['\n', '\r'], " ");
        let number = number(value);
        Self { text, canonical: canonical(value), number }
    }

    /// As it is written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The same for all ways to write this value.
    pub fn canonical(&self) -> &str {
        &self.canonical
    }

    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        self.number
    }

    /// The text of a table's cell: without quotes.
    pub fn cell(&self) -> String {
        match self.number {
            Some(number) => of_number(number),
            None => {
                serde_json::from_str(&self.canonical).unwrap_or_else(|_| self.canonical.clone())
            }
        }
    }
}

impl fmt::Display for SetValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// The number that a value of TOML is, whole or not.
pub(super) fn number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) => {
            i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|i| i as f64)
        }
        _ => None,
    }
}

pub(super) fn canonical(value: &DeValue) -> String {
    if let Some(number) = number(value) {
        return of_number(number);
    }
    match value {
        DeValue::String(text) => quoted(text),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Array(list) => {
            let items: Vec<String> = list.iter().map(|item| canonical(item.get_ref())).collect();
            format!("[{}]", items.join(","))
        }
        DeValue::Table(table) => {
            let mut items: Vec<String> = table
                .iter()
                .map(|(key, value)| format!("{}={}", key.get_ref(), canonical(value.get_ref())))
                .collect();
            items.sort();
            format!("{{{}}}", items.join(","))
        }
        other => format!("{other:?}"),
    }
}

/// As Rust writes it, so that it is read as the same number; no zero has a sign.
fn of_number(number: f64) -> String {
    format!("{:?}", number + 0.0)
}

/// A text in quotes; JSON escapes as TOML does.
pub(super) fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

//! Keys and quantities as axes.

use std::collections::BTreeSet;

use super::super::row::Row;
use super::super::run::Sweep;
use crate::io::output::{Axis, power_text};
use crate::io::scene_file::{SceneFile, SetValue, Varied, text_of};

/// A key or a quantity, with its values in the rows that are drawn.
pub(super) struct Variable {
    pub(super) name: String,
    unit: String,
    /// Row by row; NaN where there is none. Words are numbered from 0 in alphabetical order.
    pub(super) values: Vec<f64>,
    /// The words, if these are its values.
    pub(super) words: Vec<String>,
    is_logarithmic: bool,
}

/// Positive values whose largest is this many times the least, and that are spaced by ratios, have a logarithmic axis.
const DECADES: f64 = 30.0;
/// Lines across a field, about.
const LINES: usize = 6;

impl Variable {
    /// A key, if it has several values.
    pub(super) fn key(sweep: &Sweep, key: &str, rows: &[(usize, &Row)]) -> Option<Self> {
        let text = |row: &Row| row.keys.get(key).map(|text| SetValue::read(text));
        let values: Vec<Option<SetValue>> = rows.iter().map(|(_, row)| text(row)).collect();
        let distinct: BTreeSet<&str> = values.iter().flatten().map(SetValue::canonical).collect();
        if distinct.len() < 2 {
            return None;
        }
        let name = key.to_owned();
        let numbers: Option<Vec<f64>> =
            values.iter().map(|value| value.as_ref().and_then(SetValue::number)).collect();
        let Some(numbers) = numbers else {
            let words: Vec<String> = distinct.into_iter().map(String::from).collect();
            let place = |value: &Option<SetValue>| {
                let word = value.as_ref()?.canonical();
                words.iter().position(|known| known == word)
            };
            let values = values.iter().map(|value| place(value).map_or(f64::NAN, |at| at as f64));
            let values = values.collect();
            return Some(Self { name, unit: String::new(), values, words, is_logarithmic: false });
        };
        let varied = sweep.file().keys.iter().find(|varied| varied.name.text == key);
        let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = numbers.iter().copied().fold(0.0, f64::max);
        let is_logarithmic = match varied.map(|varied| &varied.values) {
            Some(Varied::Range { is_logarithmic, .. }) => *is_logarithmic,
            _ => least > 0.0 && largest > DECADES * least,
        };
        // a scene that cannot be read any more has rows all the same
        let scene = &sweep.file().scene;
        let units = text_of(scene).and_then(|text| SceneFile::units(&text, scene, &[key]));
        let units = units.unwrap_or_default();
        let unit = units.first().filter(|unit| **unit != "1").copied().unwrap_or_default().into();
        Some(Self { name, unit, values: numbers, words: Vec::new(), is_logarithmic })
    }

    pub(super) fn quantity(name: &str, unit: &str, rows: &[(usize, &Row)]) -> Self {
        let value = |row: &Row| row.quantities.get(name).copied().flatten().unwrap_or(f64::NAN);
        let values = rows.iter().map(|(_, row)| value(row)).collect();
        let unit = if unit == "1" { "" } else { unit };
        Self {
            name: name.into(),
            unit: unit.into(),
            values,
            words: Vec::new(),
            is_logarithmic: false,
        }
    }

    /// Its axis, with margins at both ends as fractions of the range.
    pub(super) fn axis(&self, room: f64) -> Axis {
        let values = self.values.iter().copied();
        let mut axis = match self.is_logarithmic {
            true => Axis::logarithmic(values.filter(|value| *value > 0.0), 2 * LINES, power_text),
            false => Axis::linear(values, room, LINES, &self.unit),
        };
        if self.is_logarithmic {
            axis.unit.clone_from(&self.unit);
        }
        if !self.words.is_empty() {
            let words = self.words.iter().map(|word| word.trim_matches('"').into());
            axis.ticks = (0..).map(f64::from).zip(words).collect();
        }
        axis
    }

    /// Its distinct values, ascending.
    pub(super) fn distinct(&self) -> Vec<f64> {
        let mut values: Vec<f64> = self.values.iter().copied().filter(|x| x.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    }
}

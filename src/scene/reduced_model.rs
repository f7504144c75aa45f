//! Reduced models: a body that moves in a few shapes, and the cells that stand for all.
//!
//! Displacements are u = u_0 + E (b - b_0) + Phi q: the start of the phase, what its constraints move, and shapes Phi
//! times their amplitudes q, the unknowns. The columns of Phi are orthonormal with the inertia M, and A^T Phi = 0. Of
//! the forces that follow the shape of the body only those of some cells are computed, each times a weight that is not
//! negative, such that they do the work of all cells along Phi (energy-conserving sampling and weighting, C. Farhat,
//! P. Avery, T. Chapman, J. Cortial, Int. J. Numer. Meth. Engng 98 (2014) 625-662).

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use crate::base::input::percent;

/// A scene in fewer unknowns, learned from its own motion: what [`reduce`](crate::reduce::reduce) returns, and
/// [`Scene::reduced`](crate::Scene::reduced) takes.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(deny_unknown_fields))]
pub struct ReducedModel {
    /// Number of displacement components of the scene, and of its cells.
    pub(crate) dofs: usize,
    pub(crate) cell_count: usize,
    pub(crate) phases: Vec<ReducedPhase>,
    /// The cells that stand for all (from 0), with their weights; none where these forces are exact along the shapes.
    pub(crate) cells: BTreeMap<usize, f64>,
    /// Largest displacement (m) from the start in the runs that it was checked with.
    pub(crate) travel: f64,
    /// Largest error of a displacement in these runs, relative to that displacement.
    pub(crate) error: f64,
    /// The error that was wanted.
    pub(crate) within: f64,
    /// That error for an [imbalance](crate::Report) of 1 that a run tells.
    pub(crate) error_per_imbalance: f64,
    /// Whether that is not the error of a run with all unknowns, but what its own runs told.
    #[cfg_attr(feature = "checkpoint", serde(default))]
    pub(crate) is_estimate: bool,
    /// Number of runs that it was learned from; 0 if that is not known.
    #[cfg_attr(feature = "checkpoint", serde(default))]
    pub(crate) runs: usize,
    /// Description of its training data, in words.
    pub(crate) learned_from: String,
    /// Values of the keys of scene files over its training and check scenes; empty for scenes without files.
    #[cfg_attr(feature = "checkpoint", serde(default, skip_serializing_if = "BTreeMap::is_empty"))]
    pub(crate) learned_keys: BTreeMap<String, LearnedKey>,
}

/// The values of a key of scene files that a reduced model was learned from.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(untagged))]
pub(crate) enum LearnedKey {
    /// Numbers: the least and the largest.
    Range([f64; 2]),
    /// Texts, each once; an empty one where a scene does not have the key.
    Texts(Vec<String>),
}

/// Part of its range by which a number may be outside: points inside of ranges of many keys do not reach their ends.
const NEAR: f64 = 0.05;

impl LearnedKey {
    /// The values of all keys in these scenes.
    pub(crate) fn of(scenes: &[&BTreeMap<String, String>]) -> BTreeMap<String, Self> {
        let keys = scenes.iter().flat_map(|scene| scene.keys());
        let learned = |key: &String| {
            let values = scenes.iter().map(|scene| scene.get(key).map_or("", String::as_str));
            let numbers: Option<Vec<f64>> = values.clone().map(finite).collect();
            match numbers {
                Some(numbers) => {
                    let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
                    let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                    Self::Range([least, most])
                }
                None => {
                    let mut texts: Vec<String> = values.map(str::to_owned).collect();
                    texts.sort();
                    texts.dedup();
                    Self::Texts(texts)
                }
            }
        };
        keys.map(|key| (key.clone(), learned(key))).collect()
    }

    fn has(&self, value: &str) -> bool {
        match self {
            Self::Range([least, most]) => finite(value).is_some_and(|number| {
                let near = NEAR * (most - least);
                (least - near..=most + near).contains(&number)
            }),
            Self::Texts(texts) => texts.iter().any(|text| text == value),
        }
    }
}

impl fmt::Display for LearnedKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range([least, most]) if least == most => write!(f, "{least}"),
            Self::Range([least, most]) => write!(f, "{least} to {most}"),
            Self::Texts(texts) => {
                let texts: Vec<&str> = texts.iter().map(|text| said(text)).collect();
                f.write_str(&texts.join(" or "))
            }
        }
    }
}

fn finite(value: &str) -> Option<f64> {
    value.parse().ok().filter(|number: &f64| number.is_finite())
}

fn said(value: &str) -> &str {
    if value.is_empty() { "not given" } else { value }
}

/// The shapes of one phase.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(deny_unknown_fields))]
pub(crate) struct ReducedPhase {
    pub(crate) name: String,
    /// Number of rows of its constraints.
    pub(crate) rows: usize,
    /// The columns of Phi (kg^-1/2).
    pub(crate) shapes: Vec<Vec<f64>>,
    /// The columns of E, one for each row that moves.
    pub(crate) lifts: Vec<Vec<f64>>,
    /// Least and largest Phi^T M u of each (kg^1/2 m) in the runs that it was learned from.
    pub(crate) range: Vec<[f64; 2]>,
}

impl ReducedModel {
    /// Number of shapes of the phase that has most.
    pub fn unknowns(&self) -> usize {
        self.phases.iter().map(|phase| phase.shapes.len()).max().unwrap_or(0)
    }

    /// Number of cells whose forces are computed; 0 where these are exact along the shapes.
    pub fn cells(&self) -> usize {
        self.cells.len()
    }

    /// Largest error of a displacement in the runs that it was checked with, relative to their largest displacement.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Whether its [error](Self::error) is what its own runs told, as it was checked with none of all unknowns: see
    /// [`reduce_by_modes`](crate::reduce::reduce_by_modes).
    pub fn is_estimate(&self) -> bool {
        self.is_estimate
    }

    /// Description of its training data, in words.
    pub fn learned_from(&self) -> &str {
        &self.learned_from
    }

    /// The keys of a scene file, with their values, that the model has not learned: `phase.push.gravity.2 = -9.8 (learned: -5 to 0)`.
    /// Nothing where it was learned from no file.
    pub(crate) fn unlearned(&self, keys: &BTreeMap<String, String>) -> Vec<String> {
        if self.learned_keys.is_empty() || keys.is_empty() {
            return Vec::new();
        }
        let none = LearnedKey::Texts(vec![String::new()]);
        let all = self.learned_keys.keys().chain(keys.keys()).collect::<BTreeSet<_>>();
        let pairs = all.into_iter().map(|key| {
            let value = keys.get(key).map_or("", String::as_str);
            (key, value, self.learned_keys.get(key).unwrap_or(&none))
        });
        let strange = pairs.filter(|(_, value, learned)| !learned.has(value));
        strange
            .map(|(key, value, learned)| format!("{key} = {} (learned: {learned})", said(value)))
            .collect()
    }

    /// Adds what the scenes that it was learned from differ in, in words.
    pub fn learned_over(mut self, words: &str) -> Self {
        self.learned_from = format!("{}: {words}", self.learned_from);
        self
    }
}

impl fmt::Display for ReducedModel {
    /// 24 unknowns and 61 of 900 cells, off by 1.3 %
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} unknowns", self.unknowns())?;
        if self.cells() > 0 {
            write!(f, " and {} of {} cells", self.cells(), self.cell_count)?;
        }
        write!(f, ", off by {}", percent(self.error))?;
        if self.is_estimate { write!(f, " as its own runs tell") } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers may be a little outside of their range, and within it in between; words have to be known, and so have keys.
    #[test]
    fn keys_have_values_that_were_learned() {
        let keys = |of: &[(&str, &str)]| -> BTreeMap<String, String> {
            of.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
        };
        let scenes = [("0.0", "\"sin(t)\""), ("2.0", "\"sin(t)\""), ("1.0", "\"cos(t)\"")];
        let scenes = scenes.map(|(x, y)| keys(&[("load.1", x), ("load.2", y), ("until", "0.5")]));
        let learned = LearnedKey::of(&scenes.each_ref());
        let value_of = |x: &str| learned["load.1"].has(x);
        assert!(value_of("1.3") && value_of("2.09") && !value_of("2.11") && !value_of("-0.2"));
        assert!(!value_of("") && !value_of("inf") && !value_of("\"t\""));
        assert!(learned["load.2"].has("\"cos(t)\"") && !learned["load.2"].has("\"tan(t)\""));
        assert!(learned["until"].has("0.5") && !learned["until"].has("0.50001"));
        assert_eq!(learned["load.1"].to_string(), "0 to 2");
        assert_eq!(learned["until"].to_string(), "0.5");
        assert_eq!(learned["load.2"].to_string(), "\"cos(t)\" or \"sin(t)\"");
    }
}

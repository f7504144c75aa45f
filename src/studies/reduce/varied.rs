//! Ranges of keys of a scene file, and the scenes that a reduced model of them is learned from and checked with.

use std::collections::HashSet;

use super::Training;
use super::alike::differing_part;
use crate::base::input::{InputError, finite};
use crate::dynamics::error::Error;
use crate::io::scene_file::{SceneFile, SetValue};
use crate::studies::sweep::{MOST_AXES, sobol};

/// A key of a scene file, and the range of its values that a reduced model is for.
#[derive(Debug, Clone, PartialEq)]
pub struct VariedKey {
    key: String,
    ends: [f64; 2],
    count: Option<usize>,
}

/// More keys than these are learned without the corners of their ranges, of which there are too many.
const MOST_WITH_CORNERS: usize = 3;
/// Points inside the ranges that are learned beside the corners.
const INSIDE: usize = 3;
/// Points inside the ranges for each key, without corners.
const INSIDE_PER_KEY: usize = 4;
/// Tables of settings and readings, which do not change the motion.
const NOT_OF_SCENES: [&str; 4] = ["solver", "statics", "output", "sensor"];
/// Override for scenes with all unknowns: no reduced model.
const UNREDUCED: &str = "solver.reduced=\"\"";

impl VariedKey {
    /// A key, as `phase.push.gravity`, and the ends of its range.
    pub fn new(key: impl Into<String>, least: f64, most: f64) -> Self {
        Self { key: key.into(), ends: [least, most], count: None }
    }

    /// The number of its values, evenly spaced, that are learned with all those of the other keys. Default: 2, the ends.
    pub fn count(mut self, count: usize) -> Self {
        self.count = Some(count);
        self
    }

    /// `phase.push.gravity` from 0 to 9.8
    fn words(&self) -> String {
        let [least, most] = self.ends;
        format!("{} from {least} to {most}", self.key)
    }

    fn check(&self) -> Result<(), InputError> {
        let [least, most] = self.ends;
        finite(&format!("range of {}", self.key), &self.ends)?;
        let refuse = |value: String, help: &str| {
            Err(InputError::new(format!("range of {}", self.key), value, help))
        };
        if least >= most {
            let help = "it goes from the least value to the largest";
            return refuse(format!("{least}..{most}"), help);
        }
        if self.count.is_some_and(|count| count < 2) {
            let help = "a range has two values at least, its ends";
            return refuse(format!("{least}..{most}:{}", self.count.unwrap_or(0)), help);
        }
        let table = self.key.split('.').next().unwrap_or_default();
        if NOT_OF_SCENES.contains(&table) {
            let help =
                format!("[{table}] does not change the motion: vary loads, pressures, signals");
            return Err(InputError::new("key that is varied", &self.key, help));
        }
        Ok(())
    }

    /// Override `key=value` for the value at a fraction of the range, from 0 to 1.
    fn set(&self, part: f64) -> String {
        let [least, most] = self.ends;
        let value = format!("{:.11e}", least + part * (most - least)).parse().unwrap_or(least);
        format!("{}={}", self.key, SetValue::from_number(value, true))
    }
}

impl Training {
    /// Training data of a scene file over ranges of its keys: all combinations of the values of up to three keys, which
    /// are the ends of their ranges unless they have a [count](VariedKey::count), and three points inside; of more keys four
    /// points inside for each. `held_out` further points are those that models are checked with. Points inside are those of
    /// Sobol's sequence. Without keys it is the scene as it stands, and checked with itself.
    ///
    /// `read` reads the scene with values that are set, as [`SceneFile::read_with`].
    ///
    /// ```
    /// use pliant::SceneFile;
    /// use pliant::reduce::{Training, VariedKey};
    ///
    /// let read = |set: &[String]| SceneFile::read_with("scenes/bending-actuator.toml", set);
    /// let pressure = VariedKey::new("phase.1.pressure.1.value", 2000.0, 5000.0);
    /// let training = Training { within: 0.01, ..Training::varied(&read, &[pressure], 2)? };
    /// assert_eq!((training.scenes.len(), training.held_out.len()), (5, 2));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// Values that the scene does not take; empty ranges; a key that stands twice, or that changes the body or what is held
    /// and moved, for which a model would have to be another one.
    pub fn varied(
        read: &dyn Fn(&[String]) -> Result<SceneFile, Error>,
        keys: &[VariedKey],
        held_out: usize,
    ) -> Result<Self, Error> {
        let read = |mut set: Vec<String>| {
            set.push(UNREDUCED.into());
            read(&set)
        };
        check(keys)?;
        for key in keys {
            let [least, most] = [0.0, 1.0].map(|part| read(vec![key.set(part)]));
            if let Some(part) = differing_part(&least?.scene, &most?.scene)? {
                let help = format!(
                    "it changes the {part}, and a reduced model is of one body with the same nodes held: vary what acts on it, \
                     as loads, pressures, gravity and signals"
                );
                return Err(InputError::new("key that is varied", &key.key, help).into());
            }
        }
        let file = read(Vec::new())?;
        let [learned, checked] = points(keys, held_out);
        let scenes = |points: Vec<Vec<f64>>| {
            let set = |point: Vec<f64>| keys.iter().zip(point).map(|(key, part)| key.set(part));
            let scenes = points.into_iter().map(|point| Ok(read(set(point).collect())?.scene));
            scenes.collect::<Result<Vec<_>, Error>>()
        };
        Ok(Self {
            scenes: scenes(learned)?,
            held_out: scenes(checked)?,
            settings: file.settings,
            within: 0.02,
            most_unknowns: 64,
        })
    }
}

/// The ranges in words; empty without any.
pub fn words(keys: &[VariedKey]) -> String {
    keys.iter().map(VariedKey::words).collect::<Vec<_>>().join(", ")
}

fn check(keys: &[VariedKey]) -> Result<(), InputError> {
    let mut seen = HashSet::new();
    for key in keys {
        key.check()?;
        if !seen.insert(&key.key) {
            let help = "it has a range already: leave one of them out";
            return Err(InputError::new("key that is varied", &key.key, help));
        }
        if keys.len() > MOST_WITH_CORNERS && key.count.is_some() {
            let help = format!(
                "so many values of each key are for {MOST_WITH_CORNERS} keys at most: leave :{} out",
                key.count.unwrap_or(0)
            );
            return Err(InputError::new("key that is varied", &key.key, help));
        }
    }
    if keys.len() > MOST_AXES {
        let help = format!("there may be {MOST_AXES}: vary those that matter most");
        return Err(InputError::new("number of keys that are varied", keys.len(), help));
    }
    Ok(())
}

/// The points to learn from and to check with, each with the parts of the ranges, from 0 to 1.
fn points(keys: &[VariedKey], held_out: usize) -> [Vec<Vec<f64>>; 2] {
    if keys.is_empty() {
        return [vec![Vec::new()], Vec::new()];
    }
    let (grid, inside) = match keys.len() {
        0..=MOST_WITH_CORNERS => (grid(keys), INSIDE),
        many => (Vec::new(), INSIDE_PER_KEY * many),
    };
    // the first point of the sequence is a corner
    let all = (1..).map(|number| (0..keys.len()).map(|axis| sobol(number, axis)).collect());
    let mut new = all.filter(|point| !grid.contains(point));
    let inside: Vec<_> = new.by_ref().take(inside).collect();
    let held_out = new.take(held_out).collect();
    [[grid, inside].concat(), held_out]
}

/// All combinations of the values of the keys.
fn grid(keys: &[VariedKey]) -> Vec<Vec<f64>> {
    keys.iter().fold(vec![Vec::new()], |points: Vec<Vec<f64>>, key| {
        let count = key.count.unwrap_or(2);
        let parts = (0..count).map(|k| k as f64 / (count - 1) as f64);
        let with = |part: f64| points.iter().map(move |point| [&point[..], &[part]].concat());
        parts.flat_map(with).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(count: usize) -> Vec<VariedKey> {
        (0..count).map(|k| VariedKey::new(format!("key.{k}"), 0.0, 1.0)).collect()
    }

    /// Corners and points inside are learned, and no point is used twice.
    #[test]
    fn points_that_are_checked_are_not_learned() {
        for (count, learned) in [(0, 1), (1, 5), (2, 7), (3, 11), (4, 16), (21, 84)] {
            let [to_learn, to_check] = points(&keys(count), 5);
            assert_eq!((to_learn.len(), to_check.len()), (learned, 5 * usize::from(count > 0)));
            let all = [&to_learn[..], &to_check].concat();
            for (number, point) in all.iter().enumerate() {
                assert!(point.iter().all(|part| (0.0..=1.0).contains(part)), "{point:?}");
                assert!(!all[..number].contains(point), "{point:?}");
            }
            let corners =
                to_learn.iter().filter(|point| point.iter().all(|x| [0.0, 1.0].contains(x)));
            let expected = [1, 2, 4, 8].get(count).copied().unwrap_or(0);
            assert_eq!(corners.count(), expected);
        }
        let five = [keys(1)[0].clone().count(5)];
        let [to_learn, _] = points(&five, 0);
        assert_eq!(to_learn.concat(), [0.0, 0.25, 0.5, 0.75, 1.0, 0.375, 0.875, 0.625]);
    }
}

//! Numbers of a scene file by which derivatives are taken.

use std::path::Path;

use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::io::scene_file::{SceneFile, SceneReader, problem};

/// A number of a scene: its key, its value there, and its unit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Number {
    pub(super) key: String,
    pub(super) value: f64,
    pub(super) unit: &'static str,
    /// Sides on which the scene takes values next to it, and how far, as a part of its scale.
    sides: Sides,
    reach: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sides {
    Both,
    /// One side: 1 above, -1 below.
    One(i8),
}

/// Part of a number, or of 1 in its unit where it is 0, within which a scene has to take other values on one side at least.
const NEXT_TO: f64 = 1e-3;
/// The same of the longest steps.
const FAR: f64 = 0.02;

impl Number {
    /// The number that `key` has in the scene of a `text` with other values for some keys.
    ///
    /// # Errors
    /// A key that the scene does not have or does not state; a value that is not a number, or beside which there is no other.
    pub(super) fn of(
        key: &str,
        reader: &SceneReader,
        (text, path): (&str, &Path),
        overrides: &[String],
    ) -> Result<Self, Error> {
        let bad = |value: String, help: String| Error::from(InputError::new(key, value, help));
        let with = |value: f64| {
            let set = [overrides, &[set(key, value)]].concat();
            reader.parse_with(text, path, &set)
        };
        let stated = SceneFile::value_of(text, path, overrides, key)?;
        let Some(stated) = stated else {
            // an unknown key is an error of the reader
            with(1.0).map_err(|error| bad("a number".into(), problem(error)))?;
            let help = format!(
                "the scene file does not say it: write it there, or give it a value by --set {key}=VALUE"
            );
            return Err(bad("its default".into(), help));
        };
        let value = stated.number().ok_or_else(|| {
            let help =
                "a derivative is by a number: name one, in a list by its place, as gravity.2";
            bad(stated.to_string(), help.into())
        })?;
        let unit = SceneFile::units(text, path, &[key])?.first().copied().unwrap_or_default();
        let beside = |part: f64| [1.0, -1.0].map(|side| with(value + side * part * scale(value)));
        let far = beside(FAR).map(|scene| scene.is_ok());
        let (sides, reach) = match far {
            [true, true] => (Sides::Both, FAR),
            far => match beside(NEXT_TO) {
                [Ok(_), Ok(_)] => (Sides::Both, NEXT_TO),
                [Ok(_), Err(_)] => (Sides::One(1), if far[0] { FAR } else { NEXT_TO }),
                [Err(_), Ok(_)] => (Sides::One(-1), if far[1] { FAR } else { NEXT_TO }),
                [Err(error), Err(_)] => {
                    let help = format!("it takes no value next to this one: {}", problem(error));
                    return Err(bad(stated.to_string(), help));
                }
            },
        };
        Ok(Self { key: key.into(), value, unit, sides, reach })
    }

    /// The longest step of differences that begin with a `part` of it.
    pub(super) fn first_step(&self, part: f64) -> f64 {
        part.min(self.reach) * self.scale()
    }

    /// Its size, of which steps are parts.
    pub(super) fn scale(&self) -> f64 {
        scale(self.value)
    }

    /// The two values whose difference quotient has the `step`, the larger one first.
    pub(super) fn ends(&self, step: f64) -> [f64; 2] {
        match self.sides {
            Sides::Both => [self.value + step, self.value - step],
            Sides::One(1) => [self.value + step, self.value],
            Sides::One(_) => [self.value, self.value - step],
        }
    }

    /// The power of the step in the error of difference quotients.
    pub(super) fn order(&self) -> i32 {
        if self.sides == Sides::Both { 2 } else { 1 }
    }
}

/// The numbers of the keys `by`.
///
/// # Errors
/// No key, a key that stands twice; as [`Number::of`].
pub(super) fn numbers(
    by: &[impl AsRef<str>],
    reader: &SceneReader,
    (text, path): (&str, &Path),
    overrides: &[String],
) -> Result<Vec<Number>, Error> {
    if by.is_empty() {
        let help = "name a number at least, as body.material.young";
        return Err(InputError::new("numbers of the gradient", "none", help).into());
    }
    let mut numbers: Vec<Number> = Vec::new();
    for key in by.iter().map(AsRef::as_ref) {
        if numbers.iter().any(|number| number.key == key) {
            return Err(InputError::new(key, "twice", "name each number once").into());
        }
        numbers.push(Number::of(key, reader, (text, path), overrides)?);
    }
    Ok(numbers)
}

fn scale(value: f64) -> f64 {
    if value == 0.0 { 1.0 } else { value.abs() }
}

/// The override that gives a key this value.
pub(crate) fn set(key: &str, value: f64) -> String {
    format!("{key}={value:?}")
}

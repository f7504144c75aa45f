//! The error of an input that cannot be used, and the checks that raise it.

mod nearest;

use std::fmt::Display;

pub(crate) use nearest::unknown_among;
#[cfg(feature = "scene-file")]
pub(crate) use nearest::{list, unknown};

/// An input that cannot be used: which one, its value, and how to mend it.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{input} = {value} cannot be used: {mend}")]
pub struct InputError {
    /// Name of the input, in the words of the API.
    pub input: String,
    /// Its value, as given.
    pub value: String,
    /// What is allowed, and why.
    pub mend: String,
}

impl InputError {
    /// `input` = `value` cannot be used: `mend`.
    pub(crate) fn new(
        input: impl Into<String>,
        value: impl Display,
        mend: impl Into<String>,
    ) -> Self {
        Self { input: input.into(), value: value.to_string(), mend: mend.into() }
    }
}

/// Position of `name` among the names of all `what` (springs, chambers) that the scene has; `input` is where it was
/// given.
pub(crate) fn find<'a>(
    name: &str,
    known: impl Iterator<Item = &'a str> + Clone,
    input: &str,
    what: &str,
) -> Result<usize, InputError> {
    known.clone().position(|other| other == name).ok_or_else(|| {
        let known: Vec<&str> = known.collect();
        InputError::new(input, format!("\"{name}\""), unknown_among(name, &known, "scene", what))
    })
}

/// Passes `value` if it is finite and above zero.
pub(crate) fn positive(input: &str, value: f64, unit: &str) -> Result<f64, InputError> {
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(InputError::new(
        input,
        value,
        format!("it must be a finite number above 0{}", suffix(unit)),
    ))
}

/// Passes `value` if it is finite and not below zero.
pub(crate) fn not_negative(input: &str, value: f64, unit: &str) -> Result<f64, InputError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(value);
    }
    Err(InputError::new(
        input,
        value,
        format!("it must be a finite number, 0 or above{}", suffix(unit)),
    ))
}

/// Passes `values` if all of them are finite.
pub(crate) fn finite(input: &str, values: &[f64]) -> Result<(), InputError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => Err(InputError::new(
            format!("component {} of {input}", at + 1),
            values[at],
            "it must be a finite number",
        )),
    }
}

fn suffix(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" ({unit})") }
}

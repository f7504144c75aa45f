//! The error of an input that cannot be used, and the checks that raise it.

#[cfg(feature = "bodies")]
mod file;
mod fraction;
mod memory;
mod nearest;
mod words;

use std::fmt::Display;

#[cfg(feature = "bodies")]
pub(crate) use file::read_at_most;
#[cfg(feature = "checkpoint")]
pub(crate) use file::read_if_at_most;
pub use fraction::Fraction;
pub(crate) use memory::check_memory;
#[cfg(feature = "sweep")]
pub(crate) use memory::free_memory;
#[cfg(feature = "scene-file")]
pub(crate) use nearest::list;
pub(crate) use nearest::{unknown, unknown_among};
pub(crate) use words::{digits, four_digits, percent, short};

/// Lets errors have the same words wherever they are shown: a `main` that returns one prints its [`Debug`](std::fmt::Debug) form.
macro_rules! debug_in_words {
    ($($error:ty),+) => {$(
        impl std::fmt::Debug for $error {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                std::fmt::Display::fmt(self, f)
            }
        }
    )+};
}
pub(crate) use debug_in_words;

debug_in_words!(InputError);

/// An invalid input: its name, its value, and the allowed values. It is shown in words, also by [`Debug`](std::fmt::Debug).
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("{input} = {value} cannot be used: {help}")]
pub struct InputError {
    /// Name of the input, in the words of the API.
    pub input: String,
    /// Its value, as given.
    pub value: String,
    /// Allowed values, and the reason.
    pub help: String,
}

impl InputError {
    /// `input` = `value` cannot be used: `help`.
    pub fn new(input: impl Into<String>, value: impl Display, help: impl Into<String>) -> Self {
        Self { input: input.into(), value: value.to_string(), help: help.into() }
    }
}

/// Position of `name` among the names of all `what` (springs, chambers) that the scene has; `input` is where
/// it was given.
pub(crate) fn find<'a>(
    name: &str,
    known: impl Iterator<Item = &'a str> + Clone,
    input: &str,
    what: &str,
) -> Result<usize, InputError> {
    find_in("scene", name, known, input, what)
}

/// The same among those that the `owner`, another thing than the scene, has.
pub(crate) fn find_in<'a>(
    owner: &str,
    name: &str,
    known: impl Iterator<Item = &'a str> + Clone,
    input: &str,
    what: &str,
) -> Result<usize, InputError> {
    known.clone().position(|other| other == name).ok_or_else(|| {
        let known: Vec<&str> = known.collect();
        InputError::new(input, format!("\"{name}\""), unknown_among(name, &known, owner, what))
    })
}

/// Largest number that is accepted: no quantity is larger, and results computed from larger numbers may
/// exceed the range of double precision.
const MOST: f64 = 1e30;

/// The message about a number above that.
fn too_large(value: f64) -> Option<&'static str> {
    (value.is_finite() && value.abs() > MOST)
        .then_some("nothing is as large as that: it may be 1e30 at most")
}

/// Passes `value` if it is finite and above zero.
pub(crate) fn positive(input: &str, value: f64, unit: &str) -> Result<f64, InputError> {
    if value > 0.0 && value <= MOST {
        return Ok(value);
    }
    let range = format!("it must be a finite number above 0{}", suffix(unit));
    Err(InputError::new(input, shown(value), too_large(value).map_or(range, String::from)))
}

/// Passes `value` if it is finite and not below zero.
pub(crate) fn not_negative(input: &str, value: f64, unit: &str) -> Result<f64, InputError> {
    if (0.0..=MOST).contains(&value) {
        return Ok(value);
    }
    let range = format!("it must be a finite number, 0 or above{}", suffix(unit));
    Err(InputError::new(input, shown(value), too_large(value).map_or(range, String::from)))
}

/// Passes `values` if all of them are finite.
pub(crate) fn finite(input: &str, values: &[f64]) -> Result<(), InputError> {
    match values.iter().position(|value| !value.is_finite() || value.abs() > MOST) {
        None => Ok(()),
        Some(at) => {
            let name = match values.len() {
                1 => input.to_owned(),
                _ => format!("component {} of {input}", at + 1),
            };
            let help = too_large(values[at]).unwrap_or("it must be a finite number");
            Err(InputError::new(name, shown(values[at]), help))
        }
    }
}

/// A number as one would write it: 1e200 without two hundred zeros.
fn shown(value: f64) -> String {
    if too_large(value).is_some() { format!("{value:e}") } else { value.to_string() }
}

fn suffix(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" ({unit})") }
}

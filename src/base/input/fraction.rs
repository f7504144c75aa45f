//! Parts of a whole.

use std::fmt;
use std::str::FromStr;

use super::{InputError, percent};

/// A part of a whole, above 0 and below 1, such as an accuracy: `0.01`, or `1%`.
///
/// ```
/// assert_eq!("1%".parse::<pliant::Fraction>()?.0, 0.01);
/// assert_eq!("1e-4".parse::<pliant::Fraction>()?.0, 1e-4);
/// assert!("150%".parse::<pliant::Fraction>().is_err());
/// # Ok::<(), pliant::InputError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fraction(pub f64);

impl Fraction {
    /// # Errors
    /// If the number is NaN, or not above 0 and below 1; `input` names where it was given.
    pub(crate) fn check(input: &str, part: f64) -> Result<f64, InputError> {
        if part > 0.0 && part < 1.0 {
            return Ok(part);
        }
        let help = "it is a part of the whole, above 0 and below 1: 0.01 or 1%";
        Err(InputError::new(input, part, help))
    }
}

impl FromStr for Fraction {
    type Err = InputError;

    fn from_str(text: &str) -> Result<Self, InputError> {
        let number = match text.trim().strip_suffix('%') {
            Some(percent) => percent.trim_end().parse().map(|percent: f64| percent / 100.0),
            None => text.trim().parse(),
        };
        Self::check("part", number.unwrap_or(f64::NAN))
            .map(Self)
            .map_err(|error| InputError { value: format!("\"{text}\""), ..error })
    }
}

impl fmt::Display for Fraction {
    /// In percent, with two significant digits.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&percent(self.0))
    }
}

//! Unknown parameters of a fit, and their ranges.

use crate::base::input::{InputError, finite};

/// A number that is sought: its name, and the range in which it lies.
///
/// In a range above 0 steps are ratios, so that a range over several decades works as well as a narrow one.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Its name; of scene files a key, as `body.material.young`.
    pub name: String,
    /// The least and the most that it may be.
    pub range: [f64; 2],
}

impl Unknown {
    /// An unknown between two ends.
    pub fn new(name: impl Into<String>, least: f64, most: f64) -> Self {
        Self { name: name.into(), range: [least, most] }
    }

    /// # Errors
    /// A range that is not valid.
    pub(crate) fn validate(&self) -> Result<(), InputError> {
        let Self { name, range } = self;
        let input = || format!("range of {name}");
        finite(&input(), range)?;
        if range[0] < range[1] {
            return Ok(());
        }
        let help = "its first end must be below its second: leave what is known out";
        Err(InputError::new(input(), format!("{:?}..{:?}", range[0], range[1]), help))
    }

    /// The value at a `part` of the range: 0 its least, 1 its most.
    pub(crate) fn at(&self, part: f64) -> f64 {
        let [least, most] = self.range;
        match least > 0.0 {
            _ if part >= 1.0 => most,
            true => (least * (most / least).powf(part)).clamp(least, most),
            false => least + part * (most - least),
        }
    }

    /// The part of the range at which it has a value.
    #[cfg(feature = "gradient")]
    pub(crate) fn part(&self, value: f64) -> f64 {
        let [least, most] = self.range;
        match least > 0.0 {
            true => (value / least).ln() / (most / least).ln(),
            false => (value - least) / (most - least),
        }
    }

    /// The derivative of the value with respect to the part.
    pub(crate) fn slope(&self, part: f64) -> f64 {
        let [least, most] = self.range;
        match least > 0.0 {
            true => self.at(part) * (most / least).ln(),
            false => most - least,
        }
    }
}

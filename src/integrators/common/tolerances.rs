//! Tolerances of the local error.

use crate::base::{input::InputError, vector::size_or_one};

/// Absolute tolerance: one number for all unknowns, or one for each.
///
/// Made from an `f64`, an array, a slice or a `Vec`.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum AbsoluteTolerance {
    /// The same for all unknowns.
    Scalar(f64),
    /// One per unknown, each in the unknown's own unit.
    Vector(Vec<f64>),
}

impl From<f64> for AbsoluteTolerance {
    fn from(atol: f64) -> Self {
        Self::Scalar(atol)
    }
}

impl From<Vec<f64>> for AbsoluteTolerance {
    fn from(atol: Vec<f64>) -> Self {
        Self::Vector(atol)
    }
}

impl From<&[f64]> for AbsoluteTolerance {
    fn from(atol: &[f64]) -> Self {
        Self::Vector(atol.to_vec())
    }
}

impl<const N: usize> From<[f64; N]> for AbsoluteTolerance {
    fn from(atol: [f64; N]) -> Self {
        Self::Vector(atol.to_vec())
    }
}

/// Smallest rtol that determines sizes of noise: below it, increments of difference quotients, 1.5e-8 of a size at least,
/// would be more than 150 atol. The usual one is assumed.
const LEAST_RTOL: f64 = 1e-10;
const USUAL_RTOL: f64 = 1e-6;

/// Local errors are kept below `rtol |y_i| + atol_i` in the root mean square over the unknowns.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tolerances {
    /// Relative tolerance, below 1; 0 where absolute tolerances alone count.
    pub rtol: f64,
    /// Absolute tolerance: the size below which a value is noise.
    pub atol: AbsoluteTolerance,
}

impl Tolerances {
    /// Made of both tolerances.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        Self { rtol, atol: atol.into() }
    }

    /// Checks that they can be used for an integration that starts from `y0`.
    pub(crate) fn check(&self, y0: &[f64]) -> Result<(), InputError> {
        if !(0.0..1.0).contains(&self.rtol) {
            let help = "it is at least 0 and below 1, such as 1e-6";
            return Err(InputError::new("rtol", self.rtol, help));
        }
        if let AbsoluteTolerance::Vector(atol) = &self.atol
            && atol.len() != y0.len()
        {
            return Err(InputError::new(
                "length of atol",
                atol.len(),
                format!("give one number, or one for each of the {} unknowns", y0.len()),
            ));
        }
        for (i, y) in y0.iter().enumerate() {
            let atol = self.atol_of(i);
            if !(atol >= 0.0 && atol.is_finite()) {
                return Err(InputError::new("atol", atol, "it is not negative, such as 1e-9"));
            }
            if atol == 0.0 && self.rtol == 0.0 {
                let help = format!("unknown {i} has no rtol either: one of the two is positive");
                return Err(InputError::new("atol", atol, help));
            }
            if atol == 0.0 && *y == 0.0 {
                return Err(InputError::new(
                    "atol",
                    atol,
                    format!("unknown {i} starts at zero, so its atol has to be positive"),
                ));
            }
        }
        Ok(())
    }

    /// The absolute tolerance of one unknown.
    pub(crate) fn atol_of(&self, unknown: usize) -> f64 {
        match &self.atol {
            AbsoluteTolerance::Scalar(atol) => *atol,
            AbsoluteTolerance::Vector(atol) => atol[unknown],
        }
    }

    /// The size of an unknown with the value `y`: |y| plus that below which it is noise; 1 if both are 0.
    pub(crate) fn size_of(&self, unknown: usize, y: f64) -> f64 {
        size_or_one(y.abs() + self.noise_of(unknown))
    }

    /// The size below which an unknown is noise.
    pub(crate) fn noise_of(&self, unknown: usize) -> f64 {
        let rtol = if self.rtol < LEAST_RTOL { USUAL_RTOL } else { self.rtol };
        self.atol_of(unknown) / rtol
    }

    /// The distance from the state `y` along `direction` at which the first unknown has changed by its tolerance, but at most
    /// `longest`.
    pub(crate) fn error_reach(&self, y: &[f64], direction: &[f64], longest: f64) -> f64 {
        let allowed = |i: usize| match self.rtol * f64::abs(y[i]) + self.atol_of(i) {
            0.0 => self.rtol,
            allowed => allowed,
        };
        direction.iter().enumerate().map(|(i, d)| allowed(i) / d.abs()).fold(longest, f64::min)
    }

    /// The distance from the state `y` along `direction` at which the first unknown has changed by its size,
    /// but at most `longest`: the scale of differences along it.
    pub(crate) fn reach(&self, y: &[f64], direction: &[f64], longest: f64) -> f64 {
        let distances = direction.iter().enumerate().map(|(i, d)| self.size_of(i, y[i]) / d.abs());
        distances.fold(longest, f64::min)
    }

    /// The smallest absolute tolerance that is not zero, or `rtol` if all are: for numbers other than the
    /// unknowns.
    pub(crate) fn least_atol(&self) -> f64 {
        let least = match &self.atol {
            AbsoluteTolerance::Scalar(atol) => *atol,
            AbsoluteTolerance::Vector(atol) => {
                let given = atol.iter().copied().filter(|atol| *atol > 0.0);
                given.reduce(f64::min).unwrap_or(0.0)
            }
        };
        if least > 0.0 { least } else { self.rtol }
    }

    /// Writes the weights 1/(rtol |y_i| + atol_i) of the error norm.
    pub(crate) fn weigh(&self, y: &[f64], weights: &mut [f64]) {
        let weight = |y: f64, atol: f64| 1.0 / (self.rtol * y.abs() + atol);
        let pairs = weights.iter_mut().zip(y);
        match &self.atol {
            AbsoluteTolerance::Scalar(atol) => pairs.for_each(|(w, y)| *w = weight(*y, *atol)),
            AbsoluteTolerance::Vector(atol) => {
                pairs.zip(atol).for_each(|((w, y), atol)| *w = weight(*y, *atol));
            }
        }
    }
}

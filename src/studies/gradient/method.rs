//! Ways to find derivatives.

use std::fmt;
use std::str::FromStr;

use crate::base::input::InputError;

/// Method of derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// The discrete adjoint of the steps of a run, or the dual of the equations of an equilibrium: for any number of numbers at once.
    Adjoint,
    /// Differences of runs that take the same steps.
    SameSteps,
    /// Differences of whole runs, or of equilibria, at a tight tolerance.
    Differences,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 3] = [Self::Adjoint, Self::SameSteps, Self::Differences];

    /// Its word: `adjoint`, `same-steps`, `differences`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Adjoint => "adjoint",
            Self::SameSteps => "same-steps",
            Self::Differences => "differences",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Method {
    type Err = InputError;

    fn from_str(name: &str) -> Result<Self, InputError> {
        Self::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| {
            let help = format!("it is one of {}", Self::ALL.map(Self::name).join(", "));
            InputError::new("method of the gradient", format!("\"{name}\""), help)
        })
    }
}

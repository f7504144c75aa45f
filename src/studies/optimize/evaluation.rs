//! The aim of a search, and the quantities that it meets on its way.

use crate::studies::fit::Unknown;
use crate::studies::gradient::{Gradient, set};

/// The aim of a search: values that quantities ought to have.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Aim {
    /// The least value of one quantity.
    Least,
    /// The largest value of one quantity.
    Largest,
    /// These values, one for each quantity: the sum of the squares of the differences is to be least.
    Goals(Vec<f64>),
}

/// Quantities of the scene with some numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// The numbers, in the order of their keys.
    pub values: Vec<f64>,
    /// The quantities with their derivatives, or why there are none.
    pub gradients: Result<Vec<Gradient>, String>,
    /// Whether it is the best one so far.
    pub is_best: bool,
}

impl Evaluation {
    /// The quantities with their derivatives; none if it failed.
    pub fn quantities(&self) -> &[Gradient] {
        self.gradients.as_deref().unwrap_or_default()
    }
}

/// Values for numbers, as [`SceneFile::read_with`](crate::SceneFile::read_with) takes them.
pub(super) fn overrides(numbers: &[Unknown], values: &[f64]) -> Vec<String> {
    let pairs = numbers.iter().zip(values);
    pairs.map(|(number, value)| set(&number.name, *value)).collect()
}

//! The least value of a function of numbers between 0 and 1, by its slopes and their errors.
//!
//! A trust region in the box: a quadratic [model](Model) is minimized within the box and a distance from the best point so far, and its prediction is compared
//! with the value there (A. R. Conn, N. I. M. Gould and Ph. L. Toint, "Trust-Region Methods" (2000), chapter 12). A point without a value
//! shortens the next step. Numbers are named by a user and therefore few, so that B is dense; the pure port of L-BFGS-B among the
//! crates (`lbfgsb-rs-pure`) has no means for a point without a value, and steps until slopes are far below their errors.

use std::fmt;

use nalgebra::DVector;

use super::model::Model;
use crate::dynamics::error::Error;

/// A function at a point, in parts of the ranges.
#[derive(Debug, Clone)]
pub(super) struct Seen {
    /// Its value, and an error of that.
    pub(super) value: f64,
    pub(super) noise: f64,
    /// Its slopes, and their errors.
    pub(super) slopes: DVector<f64>,
    pub(super) errors: DVector<f64>,
    /// A model by other means than changes of the slopes.
    pub(super) model: Option<Model>,
}

/// The function at a point, none where it has no value there.
pub(super) type Function<'a> = &'a mut dyn FnMut(&[f64]) -> Result<Option<Seen>, Error>;

/// Reason for the end of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Ending {
    /// All derivatives by numbers that may change are below their own errors.
    WithinError,
    /// The next step would be below 1e-5 of each range, or gain less than 1e-9 of the gain so far.
    Settled,
    /// Steps of 1e-5 of the ranges lead to nothing better: the quantity has kinks or jumps there, or its derivatives mean little.
    NothingBetter,
    /// After 100 evaluations.
    ManyEvaluations,
}

impl Ending {
    /// Its word: `within-error`, `settled`, `nothing-better`, `many-evaluations`.
    pub fn name(self) -> &'static str {
        match self {
            Self::WithinError => "within-error",
            Self::Settled => "settled",
            Self::NothingBetter => "nothing-better",
            Self::ManyEvaluations => "many-evaluations",
        }
    }

    /// Whether there is an optimum.
    pub fn is_optimum(self) -> bool {
        matches!(self, Self::WithinError | Self::Settled)
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::WithinError => "an optimum: derivatives are below their own errors",
            Self::Settled => {
                "an optimum: the next step would be below 1e-5 of the ranges, or gain next to nothing"
            }
            Self::NothingBetter => {
                "no optimum: nothing better is near, though derivatives say so; there is a kink or a jump, or they mean little"
            }
            Self::ManyEvaluations => {
                "no optimum yet: the most evaluations were made; go on from these values"
            }
        })
    }
}

/// Largest change of a number in the first step, as a part of its range.
const FIRST: f64 = 0.2;
/// Steps below this part of the ranges count as none.
const NO_STEP: f64 = 1e-5;
/// Steps with a predicted gain of less than this fraction of the gain so far are not made, unless the objective is a sum of squares: where a quantity is curved, it
/// is the gain of the last 3e-5 of a way.
const NO_GAIN: f64 = 1e-9;
/// Most evaluations.
const MOST_EVALUATIONS: usize = 100;
/// Parts of the promise of the model: below the first a step is rejected, below the second the next is shorter, above the third it
/// may be longer.
const REJECTED: f64 = 1e-4;
const POOR: f64 = 0.25;
const GOOD: f64 = 0.75;

/// Finds the least value of a `function` from a `start` on. Returns the number of its evaluation, from 0, and why it was the last.
///
/// # Errors
/// Those of the function.
pub(super) fn least(start: Vec<f64>, function: Function) -> Result<(usize, Ending), Error> {
    let mut at = start;
    let Some(mut here) = function(&at)? else { return Ok((0, Ending::NothingBetter)) };
    let (mut best, mut radius, mut is_first) = (0, FIRST, true);
    let first = here.value;
    let initial = || Model::at_distance(&here.slopes, FIRST);
    let mut model = here.model.clone().unwrap_or_else(initial);
    for evaluation in 1..MOST_EVALUATIONS {
        if is_flat(&at, &here) {
            return Ok((best, Ending::WithinError));
        }
        let ends: Vec<[f64; 2]> =
            at.iter().map(|x| [(-radius).max(-x), radius.min(1.0 - x)]).collect();
        let (step, promise) = model.least(&here.slopes, &ends);
        if step.amax() < NO_STEP {
            let is_held = radius <= NO_STEP;
            return Ok((best, if is_held { Ending::NothingBetter } else { Ending::Settled }));
        }
        let is_free = step.amax() < radius;
        if is_free && here.model.is_none() && promise < NO_GAIN * (first - here.value) {
            return Ok((best, Ending::Settled));
        }
        let there = at.iter().zip(&step).map(|(x, d)| snapped(x + d)).collect::<Vec<_>>();
        let Some(found) = function(&there)? else {
            radius = POOR * step.amax();
            continue;
        };
        let gain = match promise > 10.0 * here.noise.max(found.noise) {
            true => here.value - found.value,
            // by the slopes, where values differ by less than their errors
            false => -0.5 * (&here.slopes + &found.slopes).dot(&step),
        };
        let kept = gain / promise;
        if found.model.is_none() {
            let change = &found.slopes - &here.slopes;
            if is_first {
                model.scaled(&step, &change);
            }
            model.update(&step, &change);
            is_first = false;
        }
        if kept.is_nan() || kept < POOR {
            radius = POOR * step.amax();
        } else if kept > GOOD && step.amax() > 0.99 * radius {
            radius = (2.0 * radius).min(1.0);
        }
        if kept > REJECTED {
            model = found.model.clone().unwrap_or(model);
            (at, here, best) = (there, found, evaluation);
        }
    }
    Ok((best, Ending::ManyEvaluations))
}

/// Whether no number can change so that its derivative, beyond the error, says that this is better.
fn is_flat(at: &[f64], seen: &Seen) -> bool {
    at.iter().zip(seen.slopes.iter().zip(&seen.errors)).all(|(x, (slope, error))| {
        let is_held = (*x <= 0.0 && *slope >= 0.0) || (*x >= 1.0 && *slope <= 0.0);
        is_held || slope.abs() <= *error
    })
}

/// A part of a range, an end of it if it is next to that.
fn snapped(part: f64) -> f64 {
    const NEXT_TO: f64 = 1e-9;
    match part {
        ..NEXT_TO => 0.0,
        _ if part > 1.0 - NEXT_TO => 1.0,
        _ => part,
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::{Ending, Seen, least};

    fn seen(value: f64, slopes: [f64; 2], error: f64) -> Option<Seen> {
        let [slopes, errors] = [slopes, [error; 2]].map(|two| DVector::from_row_slice(&two));
        Some(Seen { value, noise: 1e-12, slopes, errors, model: None })
    }

    /// The narrow valley (1 - x)^2 + 100 (y - x^2)^2, of which the least value is at (1, 1), in [-2, 2]^2: values and slopes by parts of the ranges.
    fn valley([a, b]: [f64; 2]) -> (f64, [f64; 2]) {
        let [x, y] = [a, b].map(|part| 4.0 * part - 2.0);
        let slopes = [-2.0 * (1.0 - x) - 400.0 * x * (y - x * x), 200.0 * (y - x * x)];
        ((1.0 - x).powi(2) + 100.0 * (y - x * x).powi(2), slopes.map(|slope| 4.0 * slope))
    }

    fn found(error: f64, fails: impl Fn(f64) -> bool) -> ([f64; 2], Ending, usize) {
        let mut all = Vec::new();
        let ended = least(vec![0.2, 0.7], &mut |at| {
            let at = [at[0], at[1]];
            all.push(at);
            let (value, slopes) = valley(at);
            Ok(if fails(at[0]) { None } else { seen(value, slopes, error) })
        });
        let (best, ending) = ended.unwrap();
        (all[best].map(|part| 4.0 * part - 2.0), ending, all.len())
    }

    /// The bottom of a narrow curved valley is found, and not gone on from where slopes are below their errors.
    #[test]
    fn the_bottom_of_a_valley() {
        let ([x, y], ending, count) = found(1e-7, |_| false);
        // steps that gain less than 1e-9 of the first value, 45, are not made
        let (value, _) = valley([x, y].map(|x| (x + 2.0) / 4.0));
        assert!(value < 5e-8 && (x - 1.0).abs() < 2e-4 && (y - 1.0).abs() < 4e-4, "{x} {y}");
        assert!(ending.is_optimum() && count < 60, "{ending:?} {count}");
        let (at, ending, rough) = found(1.0, |_| false);
        assert_eq!(ending, Ending::WithinError);
        let (value, slopes) = valley(at.map(|x| (x + 2.0) / 4.0));
        assert!(value < 0.1 && slopes.iter().all(|slope| slope.abs() <= 1.0) && rough < count);
    }

    /// Where there is no value beyond x = 0.5, the search comes as near as steps count, and says that this is no optimum.
    #[test]
    fn points_without_a_value_are_gone_around() {
        let ([x, y], ending, count) = found(1e-7, |part| part > 0.625);
        assert!(x <= 0.5 && x > 0.49 && (y - x * x).abs() < 1e-2, "{x} {y}");
        assert!(ending == Ending::NothingBetter && count < 100, "{ending:?} {count}");
    }

    /// A plane is least in a corner: at the ends themselves.
    #[test]
    fn corners_are_reached() {
        let mut all = Vec::new();
        let (best, ending) = least(vec![0.3, 0.4], &mut |at| {
            all.push(at.to_vec());
            Ok(seen(3.0 * at[0] - at[1], [3.0, -1.0], 1e-9))
        })
        .unwrap();
        assert_eq!((&all[best][..], ending), (&[0.0, 1.0][..], Ending::WithinError));
        assert!(all.len() < 8, "{all:?}");
    }
}

//! Location of sign changes of root functions within a step.
//!
//! They are followed as by SUNDIALS (K. L. Hiebert, L. F. Shampine, "Implicitly defined output points for
//! solutions of ODEs", Sandia report SAND80-0180, 1980; CVODE user guide, "Rootfinding").
//!
//! Two differences from SUNDIALS: a function that reaches zero and stays there is ignored instead of being an
//! error, and the search turns to bisection where it is far behind one (`base/root.rs`), so that roots of
//! high order and jumps are found in a third of the evaluations.

use std::mem::swap;

use super::error::Error;
use crate::base::root::{Illinois, Point, crosses};

/// The root functions g of a system, as far as they have been followed.
#[derive(Debug, Default)]
pub(crate) struct Roots {
    /// Whether g was evaluated at the start.
    pub(crate) started: bool,
    /// Whether there is a root at `low`.
    pub(crate) rests: bool,
    /// Time up to which sign changes were searched, and g there.
    pub(crate) low: f64,
    pub(crate) at_low: Vec<f64>,
    /// g at the end of the interval that holds a sign change.
    at_high: Vec<f64>,
    pub(crate) trial: Vec<f64>,
    /// Whether a function is followed: one that stays at 0 is omitted until it leaves 0.
    active: Vec<bool>,
    /// For each function 0, or the sign of its change at the root last found.
    pub(crate) found: Vec<i32>,
}

/// Event of the root functions between two times.
enum Change {
    None,
    /// One or more become 0 at the later time.
    Zero,
    /// The sign of this one changes, the earliest of all according to their secants.
    Sign(usize),
}

impl Roots {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            at_low: vec![0.0; count],
            at_high: vec![0.0; count],
            trial: vec![0.0; count],
            active: vec![true; count],
            found: vec![0; count],
            ..Self::default()
        }
    }

    /// Restarts the search.
    pub(crate) fn restart(&mut self) {
        (self.started, self.rests) = (false, false);
        self.active.fill(true);
        self.found.fill(0);
    }

    /// Replaces the value of a function that is 0 at `low` by that a little later, in `trial`.
    pub(crate) fn leave_zeros(&mut self) {
        for (i, at_low) in self.at_low.iter_mut().enumerate().filter(|(_, value)| **value == 0.0) {
            *at_low = self.trial[i];
            self.active[i] = self.trial[i] != 0.0;
        }
    }

    /// Finds the first sign change between `low` and `high`, to within `tolerance`, or else moves `low` to
    /// `high`.
    pub(crate) fn search(
        &mut self,
        mut high: f64,
        tolerance: f64,
        mut evaluate: impl FnMut(f64, &mut [f64]) -> Result<(), Error>,
    ) -> Result<Option<f64>, Error> {
        evaluate(high, &mut self.at_high)?;
        let mut change = self.change(&self.at_high);
        let mut search = Illinois::new(tolerance);
        while let Change::Sign(i) = change {
            let low = Point { t: self.low, g: self.at_low[i] };
            let end = Point { t: high, g: self.at_high[i] };
            let Some(middle) = search.next(low, end) else { break };
            evaluate(middle, &mut self.trial)?;
            match self.change(&self.trial) {
                Change::None => {
                    self.low = middle;
                    swap(&mut self.at_low, &mut self.trial);
                }
                nearer => {
                    (high, change) = (middle, nearer);
                    swap(&mut self.at_high, &mut self.trial);
                }
            }
        }
        for i in 0..self.found.len() {
            let (before, after) = (self.at_low[i], self.at_high[i]);
            let is_root = self.active[i] && crosses(before, after);
            self.found[i] = if is_root { -before.signum() as i32 } else { 0 };
            self.active[i] |= after != 0.0;
        }
        self.low = high;
        swap(&mut self.at_low, &mut self.at_high);
        self.rests = !matches!(change, Change::None);
        Ok(self.rests.then_some(high))
    }

    /// The event between `low` and the time at which the functions are `values`.
    fn change(&self, values: &[f64]) -> Change {
        let (mut change, mut largest) = (Change::None, 0.0);
        for (i, (&before, &after)) in self.at_low.iter().zip(values).enumerate() {
            if !self.active[i] || !crosses(before, after) {
                continue;
            }
            let part = after / (after - before);
            if part > largest {
                (change, largest) = (Change::Sign(i), part);
            } else if largest == 0.0 {
                change = Change::Zero;
            }
        }
        change
    }
}

/// Accuracy in time of a root within a step of this size that ends at time `t`: that of SUNDIALS.
pub(crate) fn time_tolerance(t: f64, step: f64) -> f64 {
    100.0 * f64::EPSILON * (t.abs() + step.abs())
}

//! Where root functions change sign within a step.
//!
//! The search is that of SUNDIALS: the Illinois algorithm, a secant method that keeps the root between
//! its two points (K. L. Hiebert, L. F. Shampine, "Implicitly defined output points for solutions of
//! ODEs", Sandia report SAND80-0180, 1980; CVODE user guide, "Rootfinding").

use std::mem::swap;

use super::error::Error;

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
    /// Whether a function is followed: those that are 0 and stay so are left out until they leave 0.
    active: Vec<bool>,
    /// For each function 0, or the sign of its change at the root last found.
    pub(crate) found: Vec<i32>,
}

/// What happens to the functions from one time to a later one.
enum Change {
    None,
    /// One or more become 0 at the later time.
    Zero,
    /// The sign of this one changes, the earliest of all according to their secants.
    Sign(usize),
}

/// The end of an interval.
#[derive(Clone, Copy, PartialEq)]
enum End {
    Low,
    High,
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

    /// Begins anew.
    pub(crate) fn restart(&mut self) {
        (self.started, self.rests) = (false, false);
        self.active.fill(true);
        self.found.fill(0);
    }

    /// Where a function is 0 at `low`, replaces its value by that a little later, in `trial`.
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
        // weight of the lower end in the secant, halved or doubled when the same end moves again
        let (mut weight, mut moved, mut moved_before) = (1.0, None, None);
        while let Change::Sign(i) = change
            && high - self.low > tolerance
        {
            weight = match moved {
                Some(End::Low) if moved == moved_before => 2.0 * weight,
                Some(End::High) if moved == moved_before => 0.5 * weight,
                _ => 1.0,
            };
            moved_before = moved;
            let width = high - self.low;
            let part = self.at_high[i] / (self.at_high[i] - weight * self.at_low[i]);
            // a point too near to an end would tell nothing new
            let edge = 0.5 * tolerance / width;
            let inward = if width > 5.0 * tolerance { 0.1 } else { edge };
            let part = match part {
                part if part < edge => inward,
                part if part > 1.0 - edge => 1.0 - inward,
                part => part,
            };
            let middle = high - part * width;
            evaluate(middle, &mut self.trial)?;
            match self.change(&self.trial) {
                Change::None => {
                    (self.low, moved) = (middle, Some(End::Low));
                    swap(&mut self.at_low, &mut self.trial);
                }
                nearer => {
                    (high, moved, change) = (middle, Some(End::High), nearer);
                    swap(&mut self.at_high, &mut self.trial);
                }
            }
        }
        for i in 0..self.found.len() {
            let (before, after) = (self.at_low[i], self.at_high[i]);
            let is_root = self.active[i] && (after == 0.0 || differ(before, after));
            self.found[i] = if is_root { -before.signum() as i32 } else { 0 };
            self.active[i] |= after != 0.0;
        }
        self.low = high;
        swap(&mut self.at_low, &mut self.at_high);
        self.rests = !matches!(change, Change::None);
        Ok(self.rests.then_some(high))
    }

    /// What happens between `low` and the time at which the functions are `values`.
    fn change(&self, values: &[f64]) -> Change {
        let (mut change, mut largest) = (Change::None, 0.0);
        for (i, (&before, &after)) in self.at_low.iter().zip(values).enumerate() {
            if !self.active[i] {
                continue;
            }
            if after == 0.0 {
                if largest == 0.0 {
                    change = Change::Zero;
                }
            } else if differ(before, after) {
                let part = after / (after - before);
                if part > largest {
                    (change, largest) = (Change::Sign(i), part);
                }
            }
        }
        change
    }
}

/// Whether the signs of two numbers differ, neither of which is 0.
fn differ(a: f64, b: f64) -> bool {
    (a < 0.0) != (b < 0.0)
}

//! Contact events: where a node touches an obstacle or leaves it.

use super::stepper::{Failed, Stepper};
use crate::system::System;

/// The switches of the forces (see [`crate::force::Force::switches`]) in a phase, as they are held
/// from one event to the next.
///
/// Held, the force is smooth within a step: a node that leaves an obstacle is still pulled by it, as
/// if glued, until the event is found and the step cut off there.
#[derive(Default)]
pub(super) struct Events {
    on: Vec<bool>,
    values: Vec<f64>,
    /// Events found, and those in a row that did not move time ahead.
    pub(super) count: usize,
    standing: usize,
}

/// Events in a row at one time, after which the switches are left to themselves.
const STANDING: usize = 20;

/// Part of a step to which an event is located.
const PRECISION: f64 = 1e-12;

impl Events {
    /// From now on holds the switches of `system`, as they are at `t` and `u`, if they are `located`.
    pub(super) fn begin(&mut self, system: &System, t: f64, u: &[f64], located: bool) {
        let count = if located { system.switches() } else { 0 };
        (self.on, self.values) = (vec![false; count], vec![0.0; count]);
        system.hold_switches(None);
        self.set(system, t, u);
    }

    /// The time of the first event in the last step, from `start` (s) to `end` (s). `work` has room
    /// for a state.
    pub(super) fn first(
        &mut self,
        stepper: &mut Stepper,
        start: f64,
        end: f64,
        work: &mut [f64],
    ) -> Result<Option<f64>, Failed> {
        let n = stepper.system().dofs();
        if !self.change(stepper.system(), end, &stepper.state()[..n]) {
            return Ok(None);
        }
        // bisection: no switch has changed at `before`, one at least has at `after`
        let (mut before, mut after) = (start, end);
        while after - before > PRECISION * (end - start) {
            let middle = 0.5 * (before + after);
            if middle <= before || middle >= after {
                break;
            }
            stepper.interpolate(middle, work)?;
            match self.change(stepper.system(), middle, &work[..n]) {
                true => after = middle,
                false => before = middle,
            }
        }
        Ok(Some(after))
    }

    /// Goes on after an event at (t, u), a `step` (s) after the one before.
    pub(super) fn pass(&mut self, system: &System, t: f64, u: &[f64], step: f64) {
        self.count += 1;
        self.standing = if step > 0.0 { 0 } else { self.standing + 1 };
        self.set(system, t, u);
        if self.standing == STANDING {
            // a node that trembles at the edge
            system.hold_switches(None);
            self.on.clear();
            self.values.clear();
        }
    }

    /// Whether a switch should change at (t, u).
    fn change(&mut self, system: &System, t: f64, u: &[f64]) -> bool {
        if self.on.is_empty() {
            return false;
        }
        system.switch_values(t, u, &mut self.values);
        self.on.iter().zip(&self.values).any(|(&on, &value)| on != (value <= 0.0))
    }

    /// Sets the switches by their values at (t, u).
    pub(super) fn set(&mut self, system: &System, t: f64, u: &[f64]) {
        if self.on.is_empty() {
            return;
        }
        system.switch_values(t, u, &mut self.values);
        self.on.iter_mut().zip(&self.values).for_each(|(on, &value)| *on = value <= 0.0);
        system.hold_switches(Some(&self.on));
    }
}

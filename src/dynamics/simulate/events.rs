//! Contact events: where a node touches an obstacle or leaves it, slips or sticks.
//!
//! The switches of a contact are the distances of its points and, without adhesion, the normal forces K_p d +
//! B_p d' of those that touch, where the damper is cut off. After a step the first change of sign is found on
//! dense output by the search of root functions, with the forces of which a switch has changed alone.
//! Switches that were not held would make steps over the kink fail before an event could be found. They are
//! atomics in the contact, as forces are shared; each phase has forces of its own.
//!
//! Under friction the third kind of switch is the sliding speed less v0 of points that press. The law is
//! smooth there, so nothing is held; the benefit is the new start. As a spring draws a block that sticks,
//! mu(w) rises to its maximum at v0 and falls beyond, and speeds grow e-fold within 4 v0 m/(3 (mu_s - mu_k)
//! N): a longer step does not see it, and implicit methods even stay on the unstable branch. An absolute
//! tolerance of velocities of v0/400, the upper limit of its default, does as much for implicit methods, and
//! not for `rk` (`docs/notes/contact.md`). A step that begins and ends in sliding in opposite directions
//! shows no event although the point has stuck in between; that is not searched for, as the reversal of
//! friction makes such a step fail the error test unless friction is too weak to matter. The report lists
//! when all points that press have come to slide and to stick; changes of some of them count as events.

use std::ops::Range;

use crate::base::root::{Point, bracket};
use crate::dynamics::phase::{Failed, Stepper};
use crate::dynamics::report::SlipEvent;
use crate::dynamics::state::State;
use crate::dynamics::system::System;
use crate::elements::force::Step;

/// Result of the check of a step for events.
pub(super) enum Met {
    Nothing,
    /// The first contact event, at this time (s).
    Event(f64),
    /// An obstacle or a surface that the step has passed through without a force, at this time (s).
    Passage(f64),
}

/// The switches of the forces (see [`crate::elements::force::Switches::switches`]) in a phase, as they are held
/// from one event to the next, if events are located.
///
/// While they are held, the force is smooth within a step: a node that leaves an obstacle is still pulled by
/// it, as if glued, until the event is found and the step is cut off there.
#[derive(Default)]
pub(super) struct Events {
    on: Vec<bool>,
    values: Vec<f64>,
    /// The values where a switch was last found to change.
    changed: Vec<f64>,
    /// Of each switch that changes in a step, |value| at its start; 0 of the others.
    scales: Vec<f64>,
    /// Bound of the motion of the body before a switch can change (see
    /// [`crate::elements::force::ContactForce::passage`]).
    clearances: Vec<f64>,
    /// Events found, and those in a row that did not advance time.
    pub(super) count: usize,
    standing: usize,
    /// For each force whether the body slides, as it was last known.
    slides: Vec<Option<bool>>,
    /// When that changed.
    pub(super) slips: Vec<SlipEvent>,
}

/// Events in a row at one time, after which the switches are no longer held.
const STANDING: usize = 20;

/// Precision to which an event is located, relative to the step.
const PRECISION: f64 = 1e-12;

impl Events {
    /// From now on holds the switches of `system` as they are at `t` and `state`, if events are
    /// `located`.
    pub(super) fn begin(&mut self, system: &System, t: f64, state: &[f64], located: bool) {
        refill(&mut self.clearances, system.switches(), 0.0);
        let count = if located { self.clearances.len() } else { 0 };
        refill(&mut self.on, count, false);
        for values in [&mut self.values, &mut self.changed, &mut self.scales] {
            refill(values, count, 0.0);
        }
        system.hold_switches(None);
        self.set(system, t, state);
        self.slips.retain(|slip| slip.time <= t);
        let Self { slides, slips, .. } = self;
        let known = |(obstacle, slides): (&str, Option<bool>)| {
            let last = || slips.iter().rfind(|slip| slip.obstacle == obstacle);
            slides.unwrap_or_else(|| last().is_some_and(|slip| slip.slides))
        };
        slides.clear();
        slides.extend(system.slides().map(|now| now.map(known)));
    }

    /// Event or passage in the last step, from the state `before` at time `start` (s) to time `end` (s). Depths within
    /// obstacles below `tolerance` (m) are ignored. `work` is a buffer for a state.
    pub(super) fn met(
        &mut self,
        stepper: &mut dyn Stepper,
        before: &[f64],
        [start, end]: [f64; 2],
        tolerance: f64,
        work: &mut [f64],
    ) -> Result<Met, Failed> {
        if !stepper.system().full().can_be_passed() {
            return Ok(Met::Nothing);
        }
        let (system, after) = (stepper.system().full(), stepper.state());
        let ends = [before, after].map(|state| system.layout().of(state));
        let step = Step { times: [start, end], u: ends.map(|at| at.u), v: ends.map(|at| at.v) };
        let passage = system.passage(&step, tolerance, &mut self.clearances);
        let mut event = self.change(system, end, after).then_some(end);
        if let Some(t) = passage.filter(|&t| t > start && t < end) {
            // the step will not be taken as it is
            self.clearances.fill(0.0);
            stepper.interpolate(t, work)?;
            match (self.change(stepper.system().full(), t, work), event) {
                (true, _) => event = Some(t),
                (false, None) => return Ok(Met::Passage(t)),
                (false, Some(_)) => {}
            }
        }
        match event {
            Some(event) => Ok(Met::Event(self.locate(stepper, before, [start, event], work)?)),
            None => Ok(Met::Nothing),
        }
    }

    /// The first event between `start` (s) with the state `before`, where no switch has changed, and `end` (s), where at
    /// least one has. Forces of which no switch changes are left out of the search.
    fn locate(
        &mut self,
        stepper: &mut dyn Stepper,
        before: &[f64],
        [start, end]: [f64; 2],
        work: &mut [f64],
    ) -> Result<f64, Failed> {
        self.evaluate(stepper.system().full(), start, before, |_| true);
        for (k, scale) in self.scales.iter_mut().enumerate() {
            let changes = self.on[k] != is_on(self.changed[k]);
            *scale = if changes { self.values[k].abs().max(f64::MIN_POSITIVE) } else { 0.0 };
        }
        let scales = std::mem::take(&mut self.scales);
        let near = Point { t: start, g: 1.0 };
        let far = Point { t: end, g: self.advance(&scales, &self.changed) };
        let met = bracket(near, far, PRECISION * (end - start), &mut |t| {
            stepper.interpolate(t, work)?;
            let changes = |own: Range<usize>| scales[own].iter().any(|&scale| scale > 0.0);
            self.evaluate(stepper.system().full(), t, work, changes);
            Ok::<_, Failed>(self.advance(&scales, &self.values))
        });
        self.scales = scales;
        Ok(met?.1.t)
    }

    /// Distance of the first changing switch from its change: 1 at the start of the step, below 0 behind the
    /// change.
    fn advance(&self, scales: &[f64], values: &[f64]) -> f64 {
        let mut first = f64::INFINITY;
        for ((&on, &value), &scale) in self.on.iter().zip(values).zip(scales) {
            if scale > 0.0 {
                // a value of 0 has a side, too
                let size = (value.abs() / scale).max(f64::MIN_POSITIVE);
                first = first.min(if on == is_on(value) { size } else { -size });
            }
        }
        first
    }

    /// Continues after an event at time `t` in `state`, at the end of a step of size `step` (s).
    pub(super) fn pass(&mut self, system: &System, t: f64, state: &[f64], step: f64) {
        self.count += 1;
        self.standing = if step > 0.0 { 0 } else { self.standing + 1 };
        self.clearances.fill(0.0);
        self.set(system, t, state);
        self.note_slips(system, t);
        if self.standing == STANDING {
            // a node that chatters at the surface
            system.hold_switches(None);
            self.on.clear();
            self.values.clear();
            self.changed.clear();
            self.scales.clear();
        }
    }

    /// Records where all of the body has begun to slide, or to stick. A body that lifts off does neither, and
    /// a change that is reversed at once does not count.
    fn note_slips(&mut self, system: &System, time: f64) {
        let Self { slides, slips, .. } = self;
        for (known, now) in slides.iter_mut().zip(system.slides()) {
            let Some((obstacle, Some(slides))) = now else { continue };
            if known.replace(slides).is_none_or(|known| known == slides) {
                continue;
            }
            let last = slips.iter().rposition(|slip| slip.obstacle == obstacle);
            match last.filter(|&last| time - slips[last].time <= PRECISION * time) {
                Some(last) => drop(slips.remove(last)),
                None => slips.push(SlipEvent { time, obstacle: obstacle.to_owned(), slides }),
            }
        }
    }

    /// Whether a switch should change at time `t` in `state`.
    fn change(&mut self, system: &System, t: f64, state: &[f64]) -> bool {
        if self.on.is_empty() {
            return false;
        }
        self.evaluate(system, t, state, |_| true);
        let changes = self.on.iter().zip(&self.values).any(|(&on, &value)| on != is_on(value));
        if changes {
            self.changed.copy_from_slice(&self.values);
        }
        changes
    }

    /// Sets the switches by their values at time `t` in `state`.
    pub(super) fn set(&mut self, system: &System, t: f64, state: &[f64]) {
        if self.on.is_empty() {
            return;
        }
        system.hold_switches(None);
        self.evaluate(system, t, state, |_| true);
        self.on.iter_mut().zip(&self.values).for_each(|(on, &value)| *on = is_on(value));
        system.hold_switches(Some(&self.on));
    }

    /// Evaluates the switches of all forces of which `is_wanted` says so by their numbers.
    fn evaluate(
        &mut self,
        system: &System,
        t: f64,
        state: &[f64],
        is_wanted: impl Fn(Range<usize>) -> bool,
    ) {
        let State { u, v, .. } = system.layout().of(state);
        system.switch_values(t, u, v, &mut self.values, is_wanted);
    }
}

fn is_on(value: f64) -> bool {
    value <= 0.0
}

fn refill<T: Clone>(list: &mut Vec<T>, length: usize, value: T) {
    list.clear();
    list.resize(length, value);
}

//! Contact events: where a node touches an obstacle or leaves it, slips or sticks.

use super::stepper::{Failed, Stepper};
use crate::base::root::{Point, bracket};
use crate::dynamics::report::SlipEvent;
use crate::dynamics::state::State;
use crate::dynamics::system::System;
use crate::elements::force::Step;

/// What happened in a step.
pub(super) enum Met {
    Nothing,
    /// The first contact event, at this time (s).
    Event(f64),
    /// An obstacle or a surface that the step has passed through without a force, at this time (s).
    Passage(f64),
}

/// The switches of the forces (see [`crate::elements::force::Force::switches`]) in a phase, as they are held
/// from one event to the next, if events are located.
///
/// While they are held, the force is smooth within a step: a node that leaves an obstacle is still pulled by
/// it, as if glued, until the event is found and the step is cut off there.
#[derive(Default)]
pub(super) struct Events {
    on: Vec<bool>,
    values: Vec<f64>,
    /// How far the body can move before a switch can change (see
    /// [`crate::elements::force::Force::passage`]).
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
    /// From now on holds the switches of `system` as they are at `t` and `state` = (u, v, ...), if events are
    /// `located`.
    pub(super) fn begin(&mut self, system: &System, t: f64, state: &[f64], located: bool) {
        refill(&mut self.clearances, system.switches(), 0.0);
        let count = if located { self.clearances.len() } else { 0 };
        refill(&mut self.on, count, false);
        refill(&mut self.values, count, 0.0);
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

    /// What happened in the last step, from the state `before` at time `start` (s) to time `end` (s). Depths
    /// within obstacles below `tolerance` (m) do not matter. `work` has room for a state.
    pub(super) fn met(
        &mut self,
        stepper: &mut dyn Stepper,
        before: &[f64],
        [start, end]: [f64; 2],
        tolerance: f64,
        work: &mut [f64],
    ) -> Result<Met, Failed> {
        if !stepper.system().can_be_passed() {
            return Ok(Met::Nothing);
        }
        let (system, after) = (stepper.system(), stepper.state());
        let ends = [before, after].map(|state| State::of(state, system.dofs()));
        let step = Step { times: [start, end], u: ends.map(|at| at.u), v: ends.map(|at| at.v) };
        let passage = system.passage(&step, tolerance, &mut self.clearances);
        let mut event = self.change(system, end, after).then_some(end);
        if let Some(t) = passage.filter(|&t| t > start && t < end) {
            // the step will not be taken as it is
            self.clearances.fill(0.0);
            stepper.interpolate(t, work)?;
            match (self.change(stepper.system(), t, work), event) {
                (true, _) => event = Some(t),
                (false, None) => return Ok(Met::Passage(t)),
                (false, Some(_)) => {}
            }
        }
        match event {
            Some(event) => Ok(Met::Event(self.locate(stepper, start, event, work)?)),
            None => Ok(Met::Nothing),
        }
    }

    /// The first event between `start` (s), where no switch has changed, and `end` (s), where at least one
    /// has, by bisection: values are of several units, and may jump.
    fn locate(
        &mut self,
        stepper: &mut dyn Stepper,
        start: f64,
        end: f64,
        work: &mut [f64],
    ) -> Result<f64, Failed> {
        let sign = |changed: bool| if changed { f64::NEG_INFINITY } else { f64::INFINITY };
        let [before, after] =
            [(start, false), (end, true)].map(|(t, changed)| Point { t, g: sign(changed) });
        let (_, after) = bracket(before, after, PRECISION * (end - start), &mut |t| {
            stepper.interpolate(t, work)?;
            Ok::<_, Failed>(sign(self.change(stepper.system(), t, work)))
        })?;
        Ok(after.t)
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
        self.evaluate(system, t, state);
        self.on.iter().zip(&self.values).any(|(&on, &value)| on != (value <= 0.0))
    }

    /// Sets the switches by their values at time `t` in `state`.
    pub(super) fn set(&mut self, system: &System, t: f64, state: &[f64]) {
        if self.on.is_empty() {
            return;
        }
        system.hold_switches(None);
        self.evaluate(system, t, state);
        self.on.iter_mut().zip(&self.values).for_each(|(on, &value)| *on = value <= 0.0);
        system.hold_switches(Some(&self.on));
    }

    fn evaluate(&mut self, system: &System, t: f64, state: &[f64]) {
        let State { u, v, .. } = State::of(state, system.dofs());
        system.switch_values(t, u, v, &mut self.values);
    }
}

fn refill<T: Clone>(list: &mut Vec<T>, length: usize, value: T) {
    list.clear();
    list.resize(length, value);
}

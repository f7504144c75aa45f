//! Events at given times, ticks of clocks, and breaks; which events are armed.

use std::mem;

use super::{
    error::Reason,
    event::{Jump, Schedule},
    problem::Break,
    run::Run,
    snapshot::Act,
    solution::{End, Occurrence},
};
use crate::base::{input::InputError, vector::noise};

/// Directions in which the change of an event function within the tolerances of the state is sought, and a factor for
/// what they miss.
const DIRECTIONS: usize = 4;
const MISSED: f64 = 4.0;

impl Run<'_> {
    /// Follows the events from the present time, which is the start of the span, or where a run `resumes`.
    pub(super) fn follow_events(&mut self, resumes: bool) {
        for i in 0..self.events.len() {
            let may_start = self.events[i].schedule.is_some_and(Schedule::may_start);
            self.plan_tick(i, may_start && !resumes);
            if resumes && self.watches[i].value() == 0.0 {
                let band = self.band(i);
                self.watches[i].hold(band, 0.0);
            }
        }
    }

    /// Plans the next tick of event `i`; one at the present time counts if that `is_start`.
    pub(super) fn plan_tick(&mut self, i: usize, is_start: bool) {
        let Some(schedule) = self.events[i].schedule else { return };
        let next = schedule.next(self.t, self.sign, is_start);
        self.ticks[i] = next.filter(|t| (self.span.1 - t) * self.sign >= 0.0);
        if let Some(t) = self.ticks[i]
            && self.events[i].acts()
        {
            let later = self.breaks.partition_point(|at| (at.t - t) * self.sign > 0.0);
            self.breaks.insert(later, Break { t, number: 0, tick: Some(i), action: None });
        }
    }

    /// Records the ticks up to time `t` of clocks that do nothing else; the state is known there.
    pub(super) fn record_ticks(&mut self, t: f64) -> Result<(), Reason> {
        let before = self.occurred.len();
        for i in 0..self.events.len() {
            while let Some(tick) = self.ticks[i].filter(|tick| (t - tick) * self.sign >= 0.0)
                && !self.events[i].acts()
            {
                if self.armed[i] {
                    let (reached, mut y) = (self.engine.t(), vec![0.0; self.y.len()]);
                    let at = if (tick - reached) * self.sign > 0.0 { reached } else { tick };
                    self.engine.interpolate(at, 0, &mut y)?;
                    self.count(i);
                    self.occurred.push(Occurrence { event: i, t: tick, sign: 1, y });
                }
                let schedule = self.events[i].schedule;
                let next = schedule.and_then(|schedule| schedule.next(tick, self.sign, false));
                self.ticks[i] = next.filter(|t| (self.span.1 - t) * self.sign >= 0.0);
            }
        }
        if self.occurred.len() > before {
            let sign = self.sign;
            self.occurred.sort_by(|a, b| ((a.t - b.t) * sign).total_cmp(&0.0));
        }
        Ok(())
    }

    /// Counts an occurrence of event `i`.
    pub(super) fn count(&mut self, i: usize) {
        self.counts[i] += 1;
        self.armed[i] &= !self.events[i].once;
    }

    /// Arms and disarms events, as an action asks for.
    pub(super) fn arm(&mut self, armed: Vec<(usize, bool)>) -> Result<(), InputError> {
        let count = self.armed.len();
        for (i, on) in armed {
            let Some(armed) = self.armed.get_mut(i) else {
                let help = format!("the problem has {count}, counted from 0");
                return Err(InputError::new("event that an action arms or disarms", i, help));
            };
            *armed = on;
        }
        Ok(())
    }

    /// Values of the function of event `i` that errors of the state within its tolerances make of zero.
    pub(super) fn band(&self, i: usize) -> f64 {
        let Self { t, y, parameters, tolerances, .. } = self;
        let value = |part: f64, direction: &[f64]| {
            let sizes = (0..y.len()).map(|k| tolerances.rtol * tolerances.size_of(k, y[k]));
            let moves = sizes.zip(direction).map(|(size, d)| part * size * d);
            let y: Vec<f64> = y.iter().zip(moves).map(|(y, d)| y + d).collect();
            self.events[i].function.at(*t, &y, parameters)
        };
        let changes = (0..DIRECTIONS).map(|seed| {
            let direction = noise(y.len(), seed);
            0.5 * (value(1.0, &direction) - value(-1.0, &direction)).abs()
        });
        MISSED * changes.fold(0.0, f64::max)
    }

    /// Performs the actions of the breaks and ticks at the next break.
    pub(super) fn jump_at_break(&mut self) -> Result<(), Reason> {
        let Some(Break { t, .. }) = self.breaks.last() else { return Ok(()) };
        let t = *t;
        self.check_break(t)?;
        self.t = t;
        self.stale = true;
        let before = self.snapshot();
        let mut met = Vec::new();
        while let Some(mut next) = self.breaks.pop_if(|next| next.t == t) {
            if let Some(i) = next.tick {
                self.plan_tick(i, false);
                if !self.armed[i] {
                    continue;
                }
                self.count(i);
                let y = before.y.clone();
                self.occurred.push(Occurrence { event: i, t, sign: 1, y });
            }
            self.note(next.tick.map_or(Act::Break(next.number), Act::Tick));
            let Self { events, y, yp, parameters, .. } = self;
            let action = match next.tick {
                Some(i) => &mut events[i].action,
                None => &mut next.action,
            };
            let mut jump = Jump::new(t, y, yp, parameters);
            action.iter_mut().for_each(|action| action(&mut jump));
            let Jump { ends, armed, .. } = jump;
            let is_last = |i: usize| self.events[i].last == Some(self.counts[i]);
            if (ends || next.tick.is_some_and(is_last)) && self.end.is_none() {
                self.end = Some(next.tick.map_or(End::Break, End::Event));
            }
            self.arm(armed)?;
            met.push(next);
        }
        // algebraic unknowns jump with the equations
        let follows = !self.yp.is_empty() && self.engine.can_be_consistent();
        let acts = |at: &Break<'_>| {
            at.tick.map_or(at.action.is_some(), |i| self.events[i].action.is_some())
        };
        let acts = met.iter().any(acts);
        if !acts && !follows {
            self.passed.append(&mut met);
            return Ok(());
        }
        self.land(&before, &[])?;
        let mut events = mem::take(&mut self.events);
        // its time depends on no parameter
        let outcome = self.carry(&before, |carried, at| {
            if !acts {
                carried.note_before();
                return Ok(());
            }
            let taus = vec![0.0; at.p.len()];
            carried.cross(at, &taus, |jump| {
                for at in &mut met {
                    let action = match at.tick {
                        Some(i) => &mut events[i].action,
                        None => &mut at.action,
                    };
                    action.iter_mut().for_each(|action| action(jump));
                }
            })
        });
        self.events = events;
        met.retain(|at| at.tick.is_none());
        self.passed.append(&mut met);
        outcome
    }
}

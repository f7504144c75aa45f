//! A simulation that watches for events while time advances.

use std::mem::take;
use std::ops::ControlFlow;

use super::simulation::Simulation;
use super::view::View;
use super::watch::{Arrival, Turns, WatchedEvent};
use crate::base::input::InputError;
use crate::base::root::{Direction, crosses};
use crate::base::vector::largest;
use crate::dynamics::error::{Error, guarded};

/// An event that may be met while time advances.
struct Pending<'a> {
    /// Its number among those that are watched; none for that of `advance_until`.
    number: Option<usize>,
    event: &'a mut dyn FnMut(&View) -> f64,
    direction: Direction,
    /// Its value at the last check (0 if it had just been met), and that at the next one.
    value: f64,
    after: f64,
    is_met: bool,
    /// How it begins to change after commands given when it had just been met: only the sign counts. 0 if
    /// that is not known.
    tendency: f64,
    turns: Turns,
}

/// How often events are checked in each step: an implicit method takes the whole flight between two impacts
/// in one.
const LOOKS: u32 = 8;

/// How often the time to the next check is halved to see whether an action has turned an event back.
const HALVES: u32 = 20;

/// Part of the time between two checks within which events count as simultaneous.
const AT_ONE_TIME: f64 = 1e-10;

/// Displacement of nodes, relative to the size of the body, in the difference that gives the direction of an event.
const AHEAD: f64 = 1e-6;

impl Simulation {
    /// Watches an `event`: whenever its sign changes in the given direction, `action` is called.
    ///
    /// It is called at exactly that time, to round-off within the step. It may read the
    /// motion, give commands and change the state; [`ControlFlow::Break`] stops the advance there.
    ///
    /// Signs are compared eight times in each step, as by [`advance_until`](Self::advance_until). If several
    /// events are met at one time, to round-off, all their actions are called, in the order in which they
    /// were given, before the advance stops. While an action runs nothing is watched, and a
    /// [`fork`](Self::fork) watches nothing.
    ///
    /// An advance ends with an error where the function of an event returns NaN, and where an event
    /// accumulates: its action turns the motion back each time, as an impact that restores a part of the
    /// speed, and the events still to come would all lie within a millionth of the time since the first, or
    /// the motion goes back by less than the tolerances can resolve. Time cannot advance beyond them.
    /// Therefore the action itself has to bring such a motion to rest: below some speed it
    /// [holds](Self::hold) the nodes that have landed, lets an obstacle [act](Self::contact), or stops the advance.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    ///
    /// use pliant::simulate::Direction;
    /// use pliant::{Body, Cells, Material, Mesh, Phase, Scene, Settings};
    ///
    /// // a square falls on a plate that gives it back nine tenths of its velocity
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    /// let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles)?;
    /// let body = Body::new(mesh, rubber).thickness(0.01).build()?;
    /// let scene = Scene::new(body).gravity([0.0, -9.8]).phase(Phase::until(2.0));
    /// let mut square = scene.start(&Settings::default())?;
    /// square.when(
    ///     |view| view.centre_of_mass()[1] + 1.0,
    ///     Direction::Falling,
    ///     |square| {
    ///         square.change_state(|_, v| v.iter_mut().for_each(|v| *v *= -0.9))?;
    ///         Ok(ControlFlow::Continue(()))
    ///     },
    /// );
    /// square.advance_to(1.6)?;
    /// // after two bounces, on the way up
    /// assert!(square.view().mean_velocity()[1] > 0.0);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn when(
        &mut self,
        event: impl FnMut(&View) -> f64 + Send + 'static,
        direction: Direction,
        action: impl FnMut(&mut Self) -> Result<ControlFlow<()>, Error> + Send + 'static,
    ) {
        let (event, action) = (Box::new(event), Box::new(action));
        self.watches.push(WatchedEvent {
            event,
            direction,
            action,
            met: f64::NAN,
            turns: Turns::default(),
        });
    }

    /// Advances time to `t` (s), but at most until `until` changes its sign. `commanded` is whether commands
    /// were given before.
    pub(super) fn advance_watched(
        &mut self,
        t: f64,
        mut until: Option<&mut dyn FnMut(&View) -> f64>,
        commanded: bool,
    ) -> Result<Arrival, Error> {
        let mut watches = take(&mut self.watches);
        let arrival = self.watch(t, &mut watches, &mut until, commanded);
        watches.append(&mut self.watches);
        self.watches = watches;
        arrival
    }

    fn watch(
        &mut self,
        t: f64,
        watches: &mut [WatchedEvent<Self>],
        until: &mut Option<&mut dyn FnMut(&View) -> f64>,
        mut commanded: bool,
    ) -> Result<Arrival, Error> {
        loop {
            let mut pending = Vec::with_capacity(watches.len() + 1);
            for (number, watch) in watches.iter_mut().enumerate() {
                let WatchedEvent { event, direction, met, turns, .. } = watch;
                let number = Some(number);
                let is_met = *met == self.time;
                let value = if is_met { 0.0 } else { self.value(number, event)? };
                let asks = is_met && commanded;
                let tendency = if asks { self.tendency(number, event)? } else { 0.0 };
                let new = Pending::new(number, event, *direction, value);
                pending.push(Pending { tendency, turns: *turns, ..new });
            }
            if let Some(event) = until.as_deref_mut() {
                let value = self.value(None, event)?;
                pending.push(Pending::new(None, event, Direction::Either, value));
            }
            if !self.meet(t, &mut pending, commanded)? {
                return Ok(Arrival::Time);
            }
            let time = self.time;
            let is_met: Vec<bool> = pending.iter().map(|event| event.is_met).collect();
            drop(pending);
            let is_until_met = is_met.get(watches.len()).is_some_and(|is_met| *is_met);
            let met = watches.iter_mut().enumerate().zip(is_met).filter(|(_, is_met)| *is_met);
            let mut met: Vec<_> = met.map(|(watch, _)| watch).collect();
            met.iter_mut().for_each(|(_, watch)| watch.met = time);
            let mut is_stopped = false;
            commanded = false;
            for (number, watch) in met {
                // if an action went back in time, the remaining events are still to come
                if self.time >= time {
                    self.commanded = false;
                    let flow = guarded(|| (watch.action)(self));
                    // an event of nodes that are now held in place does not turn back
                    let turns =
                        self.commanded && self.tendency(Some(number), &mut watch.event)? != 0.0;
                    watch.turns.add(time, turns);
                    commanded |= self.commanded;
                    self.commanded = commanded;
                    is_stopped |= flow??.is_break();
                    if watch.turns.accumulate() {
                        return Err(watch.turns.error(number).into());
                    }
                }
            }
            if is_until_met && self.time >= time {
                return Ok(Arrival::Event);
            }
            if is_stopped {
                return Ok(Arrival::Stopped);
            }
        }
    }

    /// Advances time to `t` (s), but at most to the first of the events, and marks those that are met there;
    /// returns whether there are any.
    fn meet(&mut self, t: f64, events: &mut [Pending], commanded: bool) -> Result<bool, Error> {
        while self.time < t {
            if self.run.time <= self.time && !self.advance()? {
                break;
            }
            let [start, end] = [self.time, self.run.time.min(t)];
            for part in 1..=LOOKS {
                let from = self.time;
                let share = f64::from(part) / f64::from(LOOKS);
                let to = if part == LOOKS { end } else { start + share * (end - start) };
                if to > from && self.first(events, [from, to], commanded)? {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Makes `to` (s) the present, or the time of the first event since `from`, and marks the events that are
    /// met there; returns whether there are any. Commands may have turned back an event that is 0 because it
    /// was just met.
    fn first(
        &mut self,
        events: &mut [Pending],
        [from, to]: [f64; 2],
        commanded: bool,
    ) -> Result<bool, Error> {
        self.look(to)?;
        for event in &mut *events {
            let mut start = from;
            event.after = self.value(event.number, event.event)?;
            let has_left = event.value == 0.0 && event.after != 0.0;
            if commanded && has_left && event.direction.counts(event.after) {
                match (self.turn(event, from)?, event.number) {
                    (Some(t), _) => start = t,
                    (None, Some(number)) if event.tendency * event.after < 0.0 => {
                        self.look(from)?;
                        return Err(event.turns.error(number).into());
                    }
                    (None, _) => {}
                }
            }
            if event.counts() {
                self.bisect([start, self.time], event)?;
            }
        }
        if self.time == to && !events.iter().any(Pending::counts) {
            events.iter_mut().for_each(|event| event.value = event.after);
            return Ok(false);
        }
        let first = self.time;
        let count = self.mark(events)?;
        if events.len() > 1 {
            let apart = AT_ONE_TIME * (to - from) + 4.0 * f64::EPSILON * first.abs();
            self.look((first + apart).min(to))?;
            if self.mark(events)? <= count {
                self.look(first)?;
                self.mark(events)?;
            }
        }
        Ok(true)
    }

    /// Marks the events that are met at the present time, and counts them.
    fn mark(&self, events: &mut [Pending]) -> Result<usize, Error> {
        let mut count = 0;
        for event in events {
            event.after = self.value(event.number, event.event)?;
            event.is_met = event.counts();
            count += usize::from(event.is_met);
        }
        Ok(count)
    }

    /// Looks for a time between `from` and the present at which an event, 0 at `from`, had the opposite sign
    /// of its present value, and makes its value there that of the last check.
    fn turn(&mut self, event: &mut Pending, from: f64) -> Result<Option<f64>, Error> {
        let present = self.time;
        let mut found = None;
        for halves in 1..=HALVES {
            let t = from + (present - from) * 0.5_f64.powi(halves as i32);
            self.look(t)?;
            let value = self.value(event.number, event.event)?;
            if value * event.after < 0.0 {
                (event.value, found) = (value, Some(t));
                break;
            }
        }
        self.look(present)?;
        Ok(found)
    }

    /// Moves the present to the time at which `event`, which has the sign of its last value at the start,
    /// loses that sign.
    fn bisect(&mut self, [mut start, mut end]: [f64; 2], event: &mut Pending) -> Result<(), Error> {
        loop {
            let middle = 0.5 * (start + end);
            if middle <= start || middle >= end {
                return self.look(end);
            }
            self.look(middle)?;
            match event.value * self.value(event.number, event.event)? > 0.0 {
                true => start = middle,
                false => end = middle,
            }
        }
    }

    /// How an event changes as all nodes move on with their velocities; only the sign counts.
    fn tendency(
        &self,
        number: Option<usize>,
        event: &mut dyn FnMut(&View) -> f64,
    ) -> Result<f64, Error> {
        let view = self.view();
        let fastest = largest(view.v);
        if fastest == 0.0 {
            return Ok(0.0);
        }
        let ahead = AHEAD * view.body().size() / fastest;
        let u: Vec<f64> = view.u.iter().zip(view.v).map(|(u, v)| u + ahead * v).collect();
        let near = View { u: &u, ..view };
        Ok(self.value_in(&near, number, event)? - self.value(number, event)?)
    }

    /// The value of an event at the present time.
    fn value(
        &self,
        number: Option<usize>,
        event: &mut dyn FnMut(&View) -> f64,
    ) -> Result<f64, Error> {
        self.value_in(&self.view(), number, event)
    }

    fn value_in(
        &self,
        view: &View,
        number: Option<usize>,
        event: &mut dyn FnMut(&View) -> f64,
    ) -> Result<f64, Error> {
        let value = guarded(|| event(view))?;
        if !value.is_nan() {
            return Ok(value);
        }
        let input = match number {
            Some(number) => format!("value of event {} of `when`", number + 1),
            None => "value of the event of `advance_until`".into(),
        };
        let help = "its function has to give a number at all times: look for a root or logarithm of a negative number, or a \
                    division of 0 by 0";
        Err(InputError::new(input, format!("NaN at t = {} s", self.time), help).into())
    }
}

impl<'a> Pending<'a> {
    fn new(
        number: Option<usize>,
        event: &'a mut dyn FnMut(&View) -> f64,
        direction: Direction,
        value: f64,
    ) -> Self {
        let turns = Turns::default();
        Self { number, event, direction, value, after: value, is_met: false, tendency: 0.0, turns }
    }

    /// Whether it is met between its last two values.
    fn counts(&self) -> bool {
        crosses(self.value, self.after) && self.direction.counts(-self.value)
    }
}

//! A simulation that watches for events on its way.

use std::mem::take;
use std::ops::ControlFlow;

use super::simulation::Simulation;
use super::view::View;
use super::watch::{Arrival, Direction, Watch};
use crate::error::{Error, guarded};

/// An event on the way to some time.
struct Pending<'a> {
    event: &'a mut dyn FnMut(&View) -> f64,
    direction: Direction,
    /// Its value at the present time; 0 if it has just been met.
    value: f64,
}

/// Times that events are looked at in each step: an implicit method takes the flight between two impacts in one.
const LOOKS: u32 = 8;

impl Simulation {
    /// Watches an `event`: whenever its sign changes in the given direction while time goes on, `action` is
    /// called at that very time, to the round-off of the step that it lies in. It looks, gives commands, changes
    /// the state; [`ControlFlow::Break`] stops the advance there.
    ///
    /// Signs are compared eight times in each step, as by [`advance_until`](Self::advance_until). While an action is
    /// at work nothing is watched, and a [`fork`](Self::fork) watches nothing.
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
        self.watches.push(Watch { event, direction, action, met: f64::NAN });
    }

    /// Lets time go on to `t` (s), but at most until `until` changes its sign.
    pub(super) fn advance_watched(
        &mut self,
        t: f64,
        mut until: Option<&mut dyn FnMut(&View) -> f64>,
    ) -> Result<Arrival, Error> {
        let mut watches = take(&mut self.watches);
        let arrival = self.watch(t, &mut watches, &mut until);
        watches.append(&mut self.watches);
        self.watches = watches;
        arrival
    }

    fn watch(
        &mut self,
        t: f64,
        watches: &mut [Watch<Self>],
        until: &mut Option<&mut dyn FnMut(&View) -> f64>,
    ) -> Result<Arrival, Error> {
        loop {
            let mut pending = Vec::with_capacity(watches.len() + 1);
            for Watch { event, direction, met, .. } in &mut *watches {
                let value = if *met == self.time { 0.0 } else { self.value(event)? };
                pending.push(Pending { event, direction: *direction, value });
            }
            if let Some(event) = until.as_deref_mut() {
                let value = self.value(event)?;
                pending.push(Pending { event, direction: Direction::Either, value });
            }
            let Some(number) = self.meet(t, &mut pending)? else { return Ok(Arrival::Time) };
            drop(pending);
            let Some(watch) = watches.get_mut(number) else { return Ok(Arrival::Event) };
            watch.met = self.time;
            if guarded(|| (watch.action)(self))??.is_break() {
                return Ok(Arrival::Stopped);
            }
        }
    }

    /// Lets time go on to `t` (s), but at most to the first event, and gives its number.
    fn meet(&mut self, t: f64, events: &mut [Pending]) -> Result<Option<usize>, Error> {
        while self.time < t {
            if self.run.time <= self.time && !self.advance()? {
                break;
            }
            let [start, end] = [self.time, self.run.time.min(t)];
            for part in 1..=LOOKS {
                let from = self.time;
                let share = f64::from(part) / f64::from(LOOKS);
                let to = if part == LOOKS { end } else { start + share * (end - start) };
                let met = if to > from { self.first(events, from, to)? } else { None };
                if met.is_some() {
                    return Ok(met);
                }
            }
        }
        Ok(None)
    }

    /// Looks at time `to` (s), or at the first event since time `from`, whose number it gives.
    fn first(
        &mut self,
        events: &mut [Pending],
        from: f64,
        to: f64,
    ) -> Result<Option<usize>, Error> {
        self.look(to)?;
        let mut first = None;
        for (number, Pending { event, direction, value }) in events.iter_mut().enumerate() {
            let after = self.value(event)?;
            if direction.counts(*value, after) {
                self.bisect([from, self.time], *value, event)?;
                first = Some(number);
            } else if first.is_none() {
                *value = after;
            }
        }
        Ok(first)
    }

    /// Moves the present to where `event`, which has the sign of `before` at the start, has lost it.
    fn bisect(
        &mut self,
        [mut start, mut end]: [f64; 2],
        before: f64,
        event: &mut dyn FnMut(&View) -> f64,
    ) -> Result<(), Error> {
        loop {
            let middle = 0.5 * (start + end);
            if middle <= start || middle >= end {
                return self.look(end);
            }
            self.look(middle)?;
            match before * self.value(event)? > 0.0 {
                true => start = middle,
                false => end = middle,
            }
        }
    }

    /// The value of an event at the present time.
    fn value(&self, event: &mut dyn FnMut(&View) -> f64) -> Result<f64, Error> {
        Ok(guarded(|| event(&self.view()))?)
    }
}

//! Events: functions of the motion whose changes of sign are located exactly.

use std::ops::ControlFlow;

use super::view::View;
use crate::base::input::InputError;
use crate::base::root::Direction;
use crate::dynamics::error::Error;

type Event = dyn FnMut(&View) -> f64 + Send;
type Action<S> = dyn FnMut(&mut S) -> Result<ControlFlow<()>, Error> + Send;

/// An event that is watched, and what is done when it is met in a simulation `S`.
pub(super) struct WatchedEvent<S> {
    pub(super) event: Box<Event>,
    pub(super) direction: Direction,
    pub(super) action: Box<Action<S>>,
    /// When it was met last (s).
    pub(super) met: f64,
    pub(super) turns: Turns,
}

/// Events in a row that gave commands, with shorter and shorter pauses between them: an impact law that
/// restores a part of the speed has infinitely many of them in a finite time.
#[derive(Clone, Copy, Default)]
pub(super) struct Turns {
    count: usize,
    /// Times of the first and the last one (s).
    first: f64,
    last: f64,
    /// Time between the last two, and between the two before (s).
    pauses: [f64; 2],
}

/// Least number of turns of which it is known whether they accumulate: the pauses between them have shrunk
/// twice.
const ENOUGH: usize = 4;

/// Turns accumulate if all those to come would lie within this part of the time since the first one. A bounce
/// is then a millionth as long as the first one and 1e-12 as high, which is still above round-off.
const LEFT: f64 = 1e-6;

impl Turns {
    /// Adds an event at time `t` (s); `turns` is whether its commands have turned the motion back.
    pub(super) fn add(&mut self, t: f64, turns: bool) {
        let pause = t - self.last;
        let Self { count, first, last, pauses: [before, _] } = *self;
        *self = match count {
            _ if !turns => Self::default(),
            count if count == 0 || pause <= 0.0 => {
                Self { count: 1, first: t, last: t, pauses: [f64::INFINITY; 2] }
            }
            _ if pause < before => {
                Self { count: count + 1, first, last: t, pauses: [pause, before] }
            }
            _ => Self { count: 2, first: last, last: t, pauses: [pause, f64::INFINITY] },
        };
    }

    /// Whether all turns to come, with pauses that shrink by the ratio of the last two, take next to no time.
    pub(super) fn accumulate(&self) -> bool {
        let [pause, before] = self.pauses;
        let left = pause * pause / (before - pause);
        self.count >= ENOUGH && left < LEFT * (self.last - self.first)
    }

    /// The error of event `number`, beyond which time cannot advance.
    pub(super) fn error(&self, number: usize) -> InputError {
        let Self { count, last, .. } = self;
        let input = format!("number of times that event {} of `when` was met", number + 1);
        let value = format!("{count} up to t = {last} s");
        let help = "its action turns the motion back ever sooner, or by less than the tolerances tell from nothing, and no time leads \
                    past all the events that are still to come: below some speed let it bring the motion to rest and `hold` \
                    what has landed, let an obstacle act (`contact`), or stop the advance by ControlFlow::Break";
        InputError::new(input, value, help)
    }
}

/// End of an advance.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Arrival {
    /// At the requested time.
    Time,
    /// At the requested event.
    Event,
    /// By an action that stopped it.
    Stopped,
}

//! Events: functions of the motion whose changes of sign are met exactly.

use std::ops::ControlFlow;

use super::view::View;
use crate::error::Error;

/// Which changes of the sign of an event count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Direction {
    /// All.
    #[default]
    Either,
    /// From below 0 upwards.
    Rising,
    /// From above 0 downwards.
    Falling,
}

impl Direction {
    /// Whether a change from one value to another counts.
    pub(super) fn counts(self, before: f64, after: f64) -> bool {
        let (rises, falls) = (before < 0.0 && after >= 0.0, before > 0.0 && after <= 0.0);
        match self {
            Self::Either => rises || falls,
            Self::Rising => rises,
            Self::Falling => falls,
        }
    }
}

type Event = dyn FnMut(&View) -> f64 + Send;
type Action<S> = dyn FnMut(&mut S) -> Result<ControlFlow<()>, Error> + Send;

/// An event that is watched, and what is done when it is met in a simulation `S`.
pub(super) struct Watch<S> {
    pub(super) event: Box<Event>,
    pub(super) direction: Direction,
    pub(super) action: Box<Action<S>>,
    /// When it was met last (s).
    pub(super) met: f64,
}

/// What an advance ended with.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Arrival {
    /// The time that it was to go on to.
    Time,
    /// The event that it was to go on to.
    Event,
    /// An action that stopped it.
    Stopped,
}

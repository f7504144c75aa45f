//! The time at which an integration is to stop.

use std::mem;

use crate::integrators::common::Clock;

/// The stop time, as C has it, and whether it still has to be passed to C.
///
/// SUNDIALS 6.4.1 cannot forget a stop time; one at the largest finite time has the same effect, if it lies
/// in the direction of time, which a new start may reverse.
#[derive(Debug, Default)]
pub(super) struct StopTime {
    time: Option<f64>,
    /// The number that it was given as.
    given: f64,
    stale: bool,
    /// Whether C was ever given one.
    in_c: bool,
}

impl StopTime {
    /// Sets it to a time of a `clock`.
    pub(super) fn set(&mut self, time: Option<f64>, clock: Clock) {
        self.given = time.unwrap_or_default();
        self.keep(time.map(|t| clock.elapsed(t)));
    }

    /// Lets C have it again, or none.
    pub(super) fn keep(&mut self, time: Option<f64>) {
        self.stale = time.is_some() || self.in_c;
        self.time = time;
    }

    /// Notes that C has forgotten it.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    pub(super) fn time(&self) -> Option<f64> {
        self.time
    }

    pub(super) fn given(&self) -> f64 {
        self.given
    }

    /// The stop time to pass to C before it integrates from `t` towards `target`, if it has changed.
    pub(super) fn take_update(&mut self, t: f64, target: f64) -> Option<f64> {
        self.in_c |= self.stale;
        mem::take(&mut self.stale).then(|| self.time.unwrap_or(f64::MAX.copysign(target - t)))
    }
}

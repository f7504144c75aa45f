//! The time at which an integration is to stop.

use std::mem;

/// The stop time, and whether it still has to be passed to C.
///
/// SUNDIALS 6.4.1 cannot forget a stop time; one at the largest finite time has the same effect, if it lies
/// in the direction of time, which a new start may reverse.
#[derive(Debug, Default)]
pub(super) struct StopTime {
    time: Option<f64>,
    stale: bool,
    /// Whether C was ever given one.
    in_c: bool,
}

impl StopTime {
    pub(super) fn set(&mut self, time: Option<f64>) {
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

    /// The stop time to pass to C before it integrates from `t` towards `target`, if it has changed.
    pub(super) fn take_update(&mut self, t: f64, target: f64) -> Option<f64> {
        self.in_c |= self.stale;
        mem::take(&mut self.stale).then(|| self.time.unwrap_or(f64::MAX.copysign(target - t)))
    }
}

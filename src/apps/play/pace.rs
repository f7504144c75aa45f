//! Pace of simulated time: as requested, or as fast as the computer can.
//!
//! Time advances in portions, as long as requested but of no more than some 20 ms of computing, judged by the
//! last ones, with answers in between. A delay of simulated time is not caught up; the page
//! shows the real-time factor. Portions and reading do not influence steps.

use std::time::{Duration, Instant};

/// Approximate computing time between two checks for messages (s).
const BUDGET: f64 = 0.02;
/// The longest pause that is made up for (s).
const LONGEST: f64 = 0.1;
/// Time between two portions (s).
const TICK: Duration = Duration::from_millis(4);
/// Computing time over which the real-time factor is a mean (s).
const MEMORY: f64 = 0.5;

/// The pace of a simulation.
pub(super) struct Pace {
    /// Requested simulated seconds per second.
    pub(super) speed: f64,
    /// When the last portion began.
    last: Instant,
    /// The largest portion (s) that is computed within the budget.
    most: f64,
    /// Recent simulated and computing time (s).
    moved: f64,
    busy: f64,
}

impl Pace {
    pub(super) fn new() -> Self {
        Self { speed: 1.0, last: Instant::now(), most: f64::INFINITY, moved: 0.0, busy: 0.0 }
    }

    /// Starts the clock.
    pub(super) fn start(&mut self) {
        self.last = Instant::now();
    }

    /// The time (s) by which the simulation should advance now.
    pub(super) fn portion(&mut self) -> f64 {
        let now = Instant::now();
        let passed = (now - self.last).as_secs_f64().min(LONGEST);
        self.last = now;
        (self.speed * passed).min(self.most)
    }

    /// Whether the last portion has used up its computing time.
    pub(super) fn is_spent(&self) -> bool {
        self.last.elapsed().as_secs_f64() > BUDGET
    }

    /// Notes that the last portion advanced the simulation by `moved` (s).
    pub(super) fn note(&mut self, moved: f64) {
        let cost = self.last.elapsed().as_secs_f64();
        if cost > BUDGET && moved > 0.0 {
            self.most = moved * BUDGET / cost;
        } else {
            self.most *= 2.0;
        }
        self.moved += moved;
        self.busy += cost;
        if self.busy > MEMORY {
            (self.moved, self.busy) = (0.5 * self.moved, 0.5 * self.busy);
        }
    }

    /// Time until the next portion.
    pub(super) fn wait(&self) -> Duration {
        TICK.saturating_sub(self.last.elapsed())
    }

    /// Simulated seconds per second of computing, once it is known.
    pub(super) fn factor(&self) -> Option<f64> {
        (self.busy > 0.0 && self.moved > 0.0).then(|| self.moved / self.busy)
    }
}

//! Detection of steps without progress in time.

/// After how many steps this is checked.
pub(super) const STRETCH: u64 = 100;

/// Time of a run some steps ago.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Progress {
    steps: u64,
    t: f64,
    /// Whether the last stretch made no progress.
    pub(super) stands: bool,
}

impl Progress {
    /// Notes that `steps` steps have led to time `t`, from the start.
    ///
    /// There is no progress if the steps of a stretch were, on average, no longer than a few times the round-off
    /// error of the time.
    pub(super) fn note(&mut self, steps: u64, t: f64) {
        self.stands = false;
        if steps >= self.steps + STRETCH {
            let least = 4.0 * f64::EPSILON * t.abs() * (steps - self.steps) as f64;
            self.stands = (t - self.t).abs() <= least;
            (self.steps, self.t) = (steps, t);
        }
    }
}

//! Step sizes: constant for as long as possible, for a change of step costs central differences what
//! they are best at, an energy that does not drift.

/// Part of the largest error that new steps aim at.
const TARGET: f64 = 0.5;
/// Steps after which a longer step is thought of, and how much longer it must be, at least, and may
/// be, at most.
const PATIENCE: usize = 50;
const WORTHWHILE: f64 = 1.25;
const LARGEST_FACTOR: f64 = 4.0;
/// Bounds on the shortening of a step whose error was too large.
const SMALLEST_FACTOR: f64 = 0.1;
const REJECTED_FACTOR: f64 = 0.8;
/// Shortening after forces that could not be evaluated.
const REFUSED_FACTOR: f64 = 0.25;

/// Equal steps from one time to the end of the phase, until a reason turns up to change them.
#[derive(Debug, Clone)]
pub(super) struct Control {
    from: f64,
    end: f64,
    count: f64,
    taken: f64,
    /// Longest step that is stable (s), and longest step that may be taken.
    limit: f64,
    longest: f64,
    /// Largest error since the last change or thought of one, and steps since then.
    worst: f64,
    watched: usize,
}

impl Control {
    /// Steps from `t` to `end` as long as `limit` allows.
    pub(super) fn new(t: f64, end: f64, limit: f64) -> Self {
        let (count, longest) = (1.0, f64::INFINITY);
        let mut control =
            Self { from: t, end, count, taken: 0.0, limit, longest, worst: 0.0, watched: 0 };
        control.divide(t, limit);
        control
    }

    /// Divides what lies ahead of `t` into equal steps no longer than `step`.
    fn divide(&mut self, t: f64, step: f64) {
        self.from = t;
        // round-off must not add a step
        self.count = ((self.end - t) / step * (1.0 - 1e-12)).ceil().max(1.0);
        (self.taken, self.worst, self.watched) = (0.0, 0.0, 0);
    }

    #[cfg(test)]
    pub(super) fn fix_steps(&mut self, t: f64, h: f64) {
        *self = Self::new(t, self.end, h);
    }

    /// Size of the present steps (s).
    pub(super) fn step(&self) -> f64 {
        (self.end - self.from) / self.count
    }

    /// Where the next step ends.
    pub(super) fn next(&self) -> f64 {
        match self.taken + 1.0 >= self.count {
            true => self.end,
            false => self.from + (self.taken + 1.0) * self.step(),
        }
    }

    /// A step to `t` was good, with an error norm of at most 1.
    pub(super) fn accept(&mut self, t: f64, error: f64) {
        self.taken += 1.0;
        self.worst = self.worst.max(error);
        self.watched += 1;
        if self.watched == PATIENCE {
            let step = self.step();
            let factor = (TARGET / self.worst).cbrt().min(LARGEST_FACTOR);
            let longer = f64::min(factor * step, self.limit);
            (self.worst, self.watched) = (0.0, 0);
            if longer > WORTHWHILE * step {
                self.divide(t, longer);
            }
        }
    }

    /// The step from `t` had an error norm above 1.
    pub(super) fn reject(&mut self, t: f64, error: f64) {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        let factor = (TARGET / error).cbrt().clamp(SMALLEST_FACTOR, REJECTED_FACTOR);
        self.divide(t, factor * self.step());
    }

    /// The step from `t` met forces that have no meaning.
    pub(super) fn refuse(&mut self, t: f64) {
        self.divide(t, REFUSED_FACTOR * self.step());
    }

    /// Sets the longest step that may be taken, at time `t`.
    pub(super) fn set_longest(&mut self, t: f64, longest: f64) {
        self.longest = longest;
        self.set_limit(t, self.limit);
    }

    /// Sets the longest stable step, at time `t`.
    pub(super) fn set_limit(&mut self, t: f64, limit: f64) {
        self.limit = limit.min(self.longest);
        if self.step() > self.limit {
            self.divide(t, self.limit);
        }
    }
}

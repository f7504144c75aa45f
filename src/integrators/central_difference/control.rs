//! Step sizes: constant for as long as possible, because each change of the step spoils the main strength of
//! central differences, an energy that does not drift.

/// Error norm that new steps aim at; 1 is the largest that is accepted.
const TARGET: f64 = 0.5;
/// Number of steps after which a longer step is considered, and the smallest and the largest factor by which
/// it may be longer.
const PATIENCE: usize = 50;
const WORTHWHILE: f64 = 1.25;
const LARGEST_FACTOR: f64 = 4.0;
/// Bounds on the shortening of a step whose error was too large.
const SMALLEST_FACTOR: f64 = 0.1;
const REJECTED_FACTOR: f64 = 0.8;
/// Shortening after forces that could not be evaluated.
const REFUSED_FACTOR: f64 = 0.25;

/// Equal steps from one time to the stop time, until there is a reason to change them.
#[derive(Debug, Clone)]
pub(super) struct Control {
    from: f64,
    /// The stop time; infinite if there is none.
    end: f64,
    /// Step size wanted (s), and number and size of the equal steps.
    planned: f64,
    count: f64,
    step: f64,
    taken: f64,
    /// Longest step that is stable and allowed (s).
    limit: f64,
    /// Largest error since a change of the step was last made or considered, and steps since then.
    worst: f64,
    watched: usize,
}

impl Control {
    /// Steps of size `first` from `t` on, to be no longer than `limit`.
    pub(super) fn new(t: f64, first: f64, limit: f64) -> Self {
        let mut control = Self {
            from: t,
            end: f64::INFINITY,
            planned: 0.0,
            count: 0.0,
            step: 0.0,
            taken: 0.0,
            limit,
            worst: 0.0,
            watched: 0,
        };
        control.divide(t, first.min(limit));
        control
    }

    /// Ends the steps at `end`.
    pub(super) fn set_end(&mut self, t: f64, end: f64) {
        self.end = end;
        self.divide(t, self.planned);
    }

    /// Divides the time from `t` to the end into equal steps no longer than `step`.
    fn divide(&mut self, t: f64, step: f64) {
        (self.from, self.planned) = (t, step);
        // round-off must not add a step
        self.count = ((self.end - t) / step * (1.0 - 1e-12)).ceil().max(1.0);
        self.step = if self.end.is_finite() { (self.end - t) / self.count } else { step };
        (self.taken, self.worst, self.watched) = (0.0, 0.0, 0);
    }

    #[cfg(test)]
    pub(super) fn fix_steps(&mut self, t: f64, h: f64) {
        (self.limit, self.planned) = (h, h);
        self.divide(t, h);
    }

    /// End of the next step from `t`: `towards` if nothing bounds it.
    pub(super) fn next(&mut self, t: f64, towards: f64) -> f64 {
        if self.step == f64::INFINITY {
            self.divide(t, towards - t);
        }
        match self.taken + 1.0 >= self.count {
            true => self.end,
            false => self.from + (self.taken + 1.0) * self.step,
        }
    }

    /// A step to `t` was accepted, with an error norm of at most 1.
    pub(super) fn accept(&mut self, t: f64, error: f64) {
        self.taken += 1.0;
        self.worst = self.worst.max(error);
        self.watched += 1;
        if self.watched == PATIENCE {
            let step = self.step;
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
        self.divide(t, factor * self.step);
    }

    /// In the step from `t` the forces could not be evaluated.
    pub(super) fn refuse(&mut self, t: f64) {
        self.divide(t, REFUSED_FACTOR * self.step);
    }

    /// Sets the longest stable step, at time `t`.
    pub(super) fn set_limit(&mut self, t: f64, limit: f64) {
        self.limit = limit;
        if self.step > limit {
            self.divide(t, limit);
        }
    }
}

//! Times as integrators count them: from the last start.
//!
//! At clock times, such as the seconds since 1970, neighbouring numbers are 2e-7 s apart, and SUNDIALS treats times as equal that differ
//! by less than a hundred of these. Counted from the start, times resolve the steps.

/// The origin of the times of an integrator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    origin: f64,
    start: f64,
    /// The last time that is shown to the equations; NaN if there is none.
    last: f64,
}

/// Times (s) up to here need no origin: SUNDIALS distinguishes those that are 2e-12 s apart.
const FINE: f64 = 100.0;

/// Whether times around `t` need no origin.
pub(crate) fn is_fine(t: f64) -> bool {
    t.abs() <= FINE
}

/// Fraction of a step by which the time of its end may be rounded.
const ROUNDED: f64 = 1e-9;

impl Clock {
    /// A clock that begins at time `t`; it counts from zero where times need no origin.
    pub(crate) fn starting_at(t: f64) -> Self {
        let origin = if is_fine(t) { 0.0 } else { t };
        Self { origin, start: t - origin, last: f64::NAN }
    }

    /// The distance from the origin to the start.
    pub(crate) fn start(self) -> f64 {
        self.start
    }

    /// The time `elapsed` after the origin, rounded.
    pub(crate) fn time(self, elapsed: f64) -> f64 {
        let t = self.origin + elapsed;
        if (t - self.last) * elapsed.signum() > 0.0 { self.last } else { t }
    }

    /// The distance from the origin to time `t`, rounded so that no distance up to it is that of a later time.
    pub(crate) fn elapsed(self, t: f64) -> f64 {
        let elapsed = t - self.origin;
        let beyond = (self.origin + elapsed - t) * elapsed.signum();
        if beyond > 0.0 { towards_zero(elapsed) } else { elapsed }
    }

    /// From `now` on shows the equations no time from `t` on. Returns the distance to `t` if that to the number before it is too far off,
    /// and else to that number, which is `before`.
    pub(crate) fn end_before(&mut self, t: f64, before: f64, now: f64) -> f64 {
        let [exact, short] = [t, before].map(|t| self.elapsed(t));
        if (exact - short).abs() <= ROUNDED * (exact - now).abs() {
            return short;
        }
        self.last = before;
        exact
    }

    /// Shows the equations all times again.
    pub(crate) fn go_on(&mut self) {
        self.last = f64::NAN;
    }

    /// The last time that is a number, on the way from the origin to `elapsed` after it.
    fn before(self, elapsed: f64) -> f64 {
        let t = self.origin + elapsed;
        // the exact error of the sum (D. E. Knuth, The Art of Computer Programming 2, section 4.2.2)
        let added = t - self.origin;
        let error = (self.origin - (t - added)) + (elapsed - added);
        match error * elapsed.signum() {
            short if short >= 0.0 => t,
            _ if elapsed > 0.0 => t.next_down(),
            _ => t.next_up(),
        }
    }

    /// The distance to time `t` within a step from `start` to `end` after the origin: one of its ends where these differ from numbers.
    pub(crate) fn within(self, t: f64, (start, end): (f64, f64)) -> f64 {
        let (elapsed, sign) = (self.elapsed(t), (end - start).signum());
        if (elapsed - end) * sign > 0.0 && t == self.time(end) {
            end
        } else if (elapsed - start) * sign < 0.0 && t == self.before(start) {
            start
        } else {
            elapsed
        }
    }

    /// Whether a step of this size that ends `elapsed` after the origin has passed a time that is a number, after `t`.
    pub(crate) fn passes(self, t: f64, elapsed: f64, step: f64) -> bool {
        self.before(elapsed) != t && self.last_within(elapsed, step).0 != t
    }

    /// The time at which a step of this size ends `elapsed` after the origin, and its distance from there: the end, unless rounding of its
    /// time would count; then the last time before it that is a number. The last one that is shown to the equations represents the stop
    /// behind it, where another step ends.
    pub(crate) fn last_within(self, elapsed: f64, step: f64) -> (f64, f64) {
        let t = match self.before(elapsed) {
            t if t != self.last => t,
            t if elapsed > 0.0 => t.next_down(),
            t => t.next_up(),
        };
        let exact = self.elapsed(t);
        match (elapsed - exact).abs() <= ROUNDED * step.abs() {
            true => (self.origin + elapsed, elapsed),
            false => (t, exact),
        }
    }
}

/// The neighbour of a number that is closer to zero.
fn towards_zero(x: f64) -> f64 {
    if x > 0.0 { x.next_down() } else { x.next_up() }
}

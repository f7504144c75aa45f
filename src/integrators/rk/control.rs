//! Step size control and the detection of steps that stability limits.

use std::fmt;

/// Safety factor on the step that would just pass the error test.
const SAFETY: f64 = 0.9;
/// Weight of the previous error: the integral part of the controller.
const BETA: f64 = 0.04;
/// Exponent of the present error, order 5.
const ALPHA: f64 = 0.2 - 0.75 * BETA;
const SMALLEST_FACTOR: f64 = 0.2;
const LARGEST_FACTOR: f64 = 10.0;
/// Factor on the step after a right-hand side that could not be evaluated.
const REFUSED_FACTOR: f64 = 0.25;

/// Proportional-integral step size control: K. Gustafsson, ACM TOMS 17 (1991) 533-554; E.
/// Hairer, G. Wanner, "Solving Ordinary Differential Equations II" (HNW II), section IV.2, with
/// the constants recommended in HNW I, section II.4 and appendix.
#[derive(Clone, Copy, Debug)]
pub(super) struct Controller {
    previous_error: f64,
    after_rejection: bool,
}

impl Controller {
    pub fn new() -> Self {
        Self { previous_error: 1e-4, after_rejection: false }
    }

    /// Step after an accepted one of size `h` with error norm at most 1.
    pub fn accept(&mut self, h: f64, error: f64) -> f64 {
        let factor = SAFETY * self.previous_error.powf(BETA) / error.powf(ALPHA);
        let largest = if self.after_rejection { 1.0 } else { LARGEST_FACTOR };
        self.previous_error = error.max(1e-4);
        self.after_rejection = false;
        h * factor.clamp(SMALLEST_FACTOR, largest)
    }

    /// Step to retry with after an error norm above 1.
    pub fn reject(&mut self, h: f64, error: f64) -> f64 {
        self.after_rejection = true;
        h * (SAFETY / error.powf(ALPHA)).max(SMALLEST_FACTOR)
    }

    /// Step to retry with when the right-hand side could not be evaluated.
    pub fn refuse(&mut self, h: f64) -> f64 {
        self.after_rejection = true;
        h * REFUSED_FACTOR
    }
}

/// Stability, not accuracy, limits the step: an implicit method would be faster.
///
/// An explicit method has to keep h |lambda| within its stability region for every eigenvalue
/// lambda of df/dy, even for motions that have long died away. For the Dormand-Prince pair the
/// region reaches to 3.3 along the negative real axis.
///
/// The notice is about damped motions, the stabilization of constraints among them. For oscillations without
/// damping stability holds h |lambda| at about 1 to 2. That is also about the step that resolves them, so
/// those steps are not counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityLimit {
    /// Time at which the limit was established.
    pub time: f64,
    /// Step size there.
    pub step: f64,
    /// Estimated largest |lambda| of df/dy there, in 1/time.
    pub rate: f64,
    /// Steps found to be limited by stability, up to now.
    pub steps: usize,
}

impl fmt::Display for StabilityLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "stability, not accuracy, limits the step: |lambda| ~ {:.3e}, step ~ 3.3/|lambda| = \
             {:.3e} ({} steps, first noticed at t = {}); use an implicit method",
            self.rate, self.step, self.steps, self.time
        )
    }
}

/// Stability limits of the method on the real and on the imaginary axis: step times rate.
pub(crate) const REACH: f64 = 3.3;
pub(crate) const REACH_UNDAMPED: f64 = 1.0;

/// Beyond this h |lambda| a step is at the border of the stability region (at 3.307).
const LIMITED: f64 = 3.25;
/// Number of limited steps, not interrupted by `CLEAR_AFTER` others, after which the notice is given.
const ESTABLISH_AFTER: usize = 15;
const CLEAR_AFTER: usize = 6;

/// Watches h |lambda| of the accepted steps (HNW II, section IV.2, "Automatic stiffness detection").
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StabilityMonitor {
    run: usize,
    free: usize,
    limit: Option<StabilityLimit>,
    limited_steps: usize,
}

impl StabilityMonitor {
    pub fn accepted(&mut self, t: f64, h: f64, rate: f64) {
        if h * rate > LIMITED {
            self.limited_steps += 1;
            self.free = 0;
            self.run += 1;
            if self.run == ESTABLISH_AFTER && self.limit.is_none() {
                self.limit = Some(StabilityLimit { time: t, step: h, rate, steps: 0 });
            }
        } else {
            self.free += 1;
            if self.free == CLEAR_AFTER {
                self.run = 0;
            }
        }
    }

    pub fn limit(&self) -> Option<StabilityLimit> {
        self.limit.map(|limit| StabilityLimit { steps: self.limited_steps, ..limit })
    }
}

//! Options of explicit methods.

use super::options::{StepOptions, check_time, step_options};
use super::tolerances::{AbsoluteTolerance, Tolerances};
use crate::base::input::InputError;

/// Error message of explicit methods for a time before the present one.
const FORWARD_ONLY: &str =
    "integration goes forward only; to go back, integrate dy/ds = -f(-s, y) with s = -t";

/// Checks that a target time `t` is finite and not before `earliest`, which `limit` names.
pub(crate) fn check_target(t: f64, limit: &str, earliest: f64) -> Result<(), InputError> {
    const INPUT: &str = "target time";
    check_time(INPUT, t)?;
    if t < earliest {
        let help = format!("{limit} {earliest}: {FORWARD_ONLY}");
        return Err(InputError::new(INPUT, t, help));
    }
    Ok(())
}

/// Checks that a stop time is finite and ahead, where the steps have reached the time `reached` and the
/// present state is that of the time `t`.
pub(crate) fn check_stop_time(stop: f64, reached: f64, t: f64) -> Result<(), InputError> {
    const INPUT: &str = "stop time";
    check_time(INPUT, stop)?;
    if stop < reached || stop == t {
        let help = format!("the steps have reached {reached}: {FORWARD_ONLY}");
        return Err(InputError::new(INPUT, stop, help));
    }
    Ok(())
}

/// Tolerances and limits of an explicit method: [`DormandPrince`](crate::integrators::rk::DormandPrince) or
/// [`CentralDifference`](crate::integrators::central_difference::CentralDifference), which export it as
/// `Options`.
///
/// ```
/// use pliant::rk::Options;
///
/// let options = Options::new(1e-8, 1e-10).max_step(0.1);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct ExplicitOptions {
    pub(crate) tolerances: Tolerances,
    pub(crate) steps: StepOptions,
    /// Whether steps end at stop times alone.
    pub(crate) prescribed: bool,
}

impl Default for ExplicitOptions {
    /// Tolerances rtol 1e-6 and atol 1e-9.
    fn default() -> Self {
        Self::new(1e-6, 1e-9)
    }
}

impl ExplicitOptions {
    /// These tolerances: local errors are kept below `rtol |y_i| + atol_i` in the root mean square, the
    /// norm of CVODE.
    ///
    /// `rtol` is at least 1e-14, below which the error estimate is round-off, or 0, where only `atol` counts. `atol` is positive: the
    /// size below which a value is noise.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        Self {
            tolerances: Tolerances::new(rtol, atol),
            steps: StepOptions::default(),
            prescribed: false,
        }
    }

    step_options!(steps);

    /// Prescribed steps: as long as a stop time is set the step ends there, whatever its error estimate says. With the steps of an
    /// earlier integration the result is a smooth function of initial values and parameters. A step whose equations cannot be
    /// evaluated or solved is still divided.
    #[cfg(feature = "bodies")]
    pub(crate) fn prescribed(mut self) -> Self {
        self.prescribed = true;
        self
    }

    pub(crate) fn check(&self, y0: &[f64]) -> Result<(), InputError> {
        self.tolerances.check(y0)?;
        if self.tolerances.rtol != 0.0 && self.tolerances.rtol < 1e-14 {
            let help =
                "rounding errors allow 1e-14 or more, such as 1e-6; or 0, where atol alone counts";
            return Err(InputError::new("rtol", self.tolerances.rtol, help));
        }
        if (0..y0.len()).any(|i| self.tolerances.atol_of(i) == 0.0) {
            let help = "it is positive: rtol alone is not enough where a value passes through zero";
            return Err(InputError::new("atol", 0, help));
        }
        self.steps.check()?;
        match self.steps.initial_step {
            Some(h) if h < 0.0 => Err(InputError::new("initial_step", h, FORWARD_ONLY)),
            _ => Ok(()),
        }
    }
}

//! Options that all integrators share, and the checks of their input.

use crate::base::input::InputError;
use crate::integrators::ode::{MassKind, Ode};

/// Options of the step sizes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StepOptions {
    pub(crate) initial_step: Option<f64>,
    pub(crate) max_step: Option<f64>,
    pub(crate) max_steps: u32,
}

impl Default for StepOptions {
    fn default() -> Self {
        Self { initial_step: None, max_step: None, max_steps: 100_000 }
    }
}

impl StepOptions {
    pub(crate) fn check(&self) -> Result<(), InputError> {
        if let Some(h) = self.max_step
            && !(SHORTEST..=LONGEST).contains(&h)
        {
            let help = format!("it lies between {SHORTEST:e} and {LONGEST:e}");
            return Err(InputError::new("max_step", h, help));
        }
        self.initial_step.map_or(Ok(()), |h| check_step("initial_step", h))?;
        check_count("max_steps", self.max_steps)
    }
}

/// Builder methods for a field that is a [`StepOptions`].
macro_rules! step_options {
    ($($field:ident).+) => {
        /// Size of the first step; negative when integrating backwards. Default: estimated.
        pub fn initial_step(mut self, h: f64) -> Self {
            self.$($field).+.initial_step = Some(h);
            self
        }

        /// Upper bound of |step size|, for systems with short pulses that a long step would miss.
        /// Default: none, which is infinity.
        pub fn max_step(mut self, h: f64) -> Self {
            self.$($field).+.max_step = (h != f64::INFINITY).then_some(h);
            self
        }

        /// Steps allowed in one call of `solve_to`. Default: 100,000.
        pub fn max_steps(mut self, steps: u32) -> Self {
            self.$($field).+.max_steps = steps;
            self
        }
    };
}
pub(crate) use step_options;

/// Checks the start of an integration.
pub(crate) fn check_start(t0: f64, y0: &[f64]) -> Result<(), InputError> {
    check_start_time("t0", t0)?;
    if y0.is_empty() {
        return Err(InputError::new("length of y0", 0, "there is at least one unknown"));
    }
    check_finite("y0", y0)
}

/// Upper bound of step sizes and start times: integrators compute powers of them, which would overflow.
const LONGEST: f64 = 1e100;
/// Lower bound of step sizes, for the same reason.
pub(crate) const SHORTEST: f64 = 1e-100;

/// Checks a time to start from. (Times that only give a direction may have any finite value.)
pub(crate) fn check_start_time(input: &str, t: f64) -> Result<(), InputError> {
    if t.abs() <= LONGEST {
        return Ok(());
    }
    Err(InputError::new(input, t, format!("starts lie between -{LONGEST:e} and {LONGEST:e}")))
}

/// Checks that a time is finite.
pub(crate) fn check_time(input: &str, t: f64) -> Result<(), InputError> {
    if t.is_finite() { Ok(()) } else { Err(InputError::new(input, t, "times are finite")) }
}

/// Checks a step size with its sign.
pub(crate) fn check_step(input: &str, h: f64) -> Result<(), InputError> {
    if (SHORTEST..=LONGEST).contains(&h.abs()) {
        return Ok(());
    }
    let help = format!(
        "its size lies between {SHORTEST:e} and {LONGEST:e}; negative when integrating backwards"
    );
    Err(InputError::new(input, h, help))
}

/// Checks that a system is of the form y' = rhs(t, y) and no other.
pub(crate) fn check_form(system: &impl Ode) -> Result<(), InputError> {
    if system.mass_kind() != MassKind::Identity {
        let help = "this integrator takes none: take Arkode, or Ida with MassForm";
        return Err(InputError::new("mass matrix", format!("{:?}", system.mass_kind()), help));
    }
    check_whole(system)
}

/// Checks that the right-hand side of a system is not split.
pub(crate) fn check_whole(system: &impl Ode) -> Result<(), InputError> {
    if system.is_split() {
        let help = "it is for Arkode with ButcherTable::imex; others need it as a whole";
        return Err(InputError::new("right-hand side", "split", help));
    }
    Ok(())
}

/// Checks that every number of an input is finite.
pub(crate) fn check_finite(input: &str, values: &[f64]) -> Result<(), InputError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(i) => {
            let value = format!("{} in component {i}", values[i]);
            Err(InputError::new(input, value, "all components are finite"))
        }
    }
}

/// Checks the length of an input.
pub(crate) fn check_length(input: &str, len: usize, n: usize) -> Result<(), InputError> {
    if len == n {
        return Ok(());
    }
    Err(InputError::new(input, len, format!("there are {n} unknowns")))
}

/// Checks a count that C takes as an `int`.
pub(crate) fn check_count(input: &str, count: u32) -> Result<(), InputError> {
    if (1..=i32::MAX as u32).contains(&count) {
        return Ok(());
    }
    Err(InputError::new(input, count, "it lies between 1 and 2^31 - 1"))
}

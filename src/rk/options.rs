//! What may be chosen before the integration starts.

use super::Error;

/// Tolerances and limits of [`DormandPrince`](super::DormandPrince).
///
/// ```
/// use pliant::rk::Options;
///
/// let options = Options::default().rtol(1e-8).atol(1e-10).max_step(0.1);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    pub(crate) rtol: f64,
    pub(crate) atol: Tolerance,
    pub(crate) initial_step: Option<f64>,
    pub(crate) max_step: f64,
    pub(crate) max_steps: usize,
    pub(crate) stop_time: Option<f64>,
}

impl Default for Options {
    /// rtol 1e-6, atol 1e-9, automatic initial step, no largest step, 100,000 steps, no stop time.
    fn default() -> Self {
        Self {
            rtol: 1e-6,
            atol: Tolerance::Scalar(1e-9),
            initial_step: None,
            max_step: f64::INFINITY,
            max_steps: 100_000,
            stop_time: None,
        }
    }
}

impl Options {
    /// Relative tolerance, from 1e-14 (below it rounding errors drown the error estimate) up.
    ///
    /// The local error of a step is kept below rtol |y_i| + atol_i in the root-mean-square sense,
    /// the same norm as CVODE's. Default 1e-6.
    pub fn rtol(mut self, rtol: f64) -> Self {
        self.rtol = rtol;
        self
    }

    /// Absolute tolerance: one positive number for all components, or one for each (length n),
    /// in the units of the component. Give the size below which a value is noise.
    ///
    /// Default 1e-9.
    pub fn atol(mut self, atol: impl Into<Tolerance>) -> Self {
        self.atol = atol.into();
        self
    }

    /// Size of the first step, also after [`reinit`](super::DormandPrince::reinit).
    ///
    /// Default: chosen from the size of f and its first variation (HNW I, section II.4), for one
    /// more evaluation of the right-hand side.
    pub fn initial_step(mut self, step: f64) -> Self {
        self.initial_step = Some(step);
        self
    }

    /// Largest step allowed (by up to 1 % longer to hit the stop time); default: none. Useful when the right-hand side has short pulses
    /// that a long step would not see.
    pub fn max_step(mut self, step: f64) -> Self {
        self.max_step = step;
        self
    }

    /// Most steps that one call of [`solve_to`](super::DormandPrince::solve_to) may take.
    ///
    /// Default 100,000: a guard against waiting for ever on a stiff problem.
    pub fn max_steps(mut self, steps: usize) -> Self {
        self.max_steps = steps;
        self
    }

    /// Time that no step passes and that the last step hits exactly; the right-hand side is never
    /// evaluated beyond it. Default: none.
    pub fn stop_time(mut self, t: f64) -> Self {
        self.stop_time = Some(t);
        self
    }

    /// Checks everything that does not depend on the state; returns atol for each component.
    pub(crate) fn check(&self, n: usize) -> Result<Vec<f64>, Error> {
        if !(self.rtol >= 1e-14 && self.rtol.is_finite()) {
            return Err(Error::bad_input("rtol", self.rtol, "give 1e-14 or more, 1e-6 say"));
        }
        for (input, step) in
            [("initial_step", self.initial_step.unwrap_or(1.0)), ("max_step", self.max_step)]
        {
            if step.is_nan() || step <= 0.0 {
                return Err(Error::bad_input(input, step, "give a positive time"));
            }
        }
        if self.max_steps == 0 {
            return Err(Error::bad_input("max_steps", 0, "allow at least one step"));
        }
        let atol = match &self.atol {
            Tolerance::Scalar(atol) => vec![*atol; n],
            Tolerance::Vector(atol) => atol.clone(),
        };
        if atol.len() != n {
            let mend = format!("the state has {n} components: give one number, or {n}");
            return Err(Error::bad_input("length of atol", atol.len(), mend));
        }
        if let Some(i) = atol.iter().position(|a| !(*a > 0.0 && a.is_finite())) {
            let mend = "give the positive size below which the component is noise; rtol alone is \
                        not enough where it passes through zero";
            return Err(Error::bad_input(format!("atol of component {i}"), atol[i], mend));
        }
        Ok(atol)
    }
}

/// Absolute tolerance: the same for all components, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum Tolerance {
    /// The same for all components.
    Scalar(f64),
    /// One for each component (length n).
    Vector(Vec<f64>),
}

impl From<f64> for Tolerance {
    fn from(atol: f64) -> Self {
        Self::Scalar(atol)
    }
}

impl From<Vec<f64>> for Tolerance {
    fn from(atol: Vec<f64>) -> Self {
        Self::Vector(atol)
    }
}

impl From<&[f64]> for Tolerance {
    fn from(atol: &[f64]) -> Self {
        Self::Vector(atol.to_vec())
    }
}

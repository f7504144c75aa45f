//! Tolerances and step options, shared by the integrators.

use super::error::Error;

/// Absolute tolerance: one number for all unknowns, or one for each.
///
/// Made from an `f64`, an array, a slice or a `Vec`.
#[derive(Clone, Debug, PartialEq)]
pub enum AbsoluteTolerance {
    /// The same for all unknowns.
    Scalar(f64),
    /// One per unknown, each in the unknown's own unit.
    Vector(Vec<f64>),
}

impl From<f64> for AbsoluteTolerance {
    fn from(atol: f64) -> Self {
        Self::Scalar(atol)
    }
}

impl From<Vec<f64>> for AbsoluteTolerance {
    fn from(atol: Vec<f64>) -> Self {
        Self::Vector(atol)
    }
}

impl From<&[f64]> for AbsoluteTolerance {
    fn from(atol: &[f64]) -> Self {
        Self::Vector(atol.to_vec())
    }
}

impl<const N: usize> From<[f64; N]> for AbsoluteTolerance {
    fn from(atol: [f64; N]) -> Self {
        Self::Vector(atol.to_vec())
    }
}

/// Local errors are kept below `rtol |y_i| + atol_i` in the root mean square over the unknowns.
#[derive(Clone, Debug)]
pub(super) struct Tolerances {
    pub(super) rtol: f64,
    pub(super) atol: AbsoluteTolerance,
}

impl Tolerances {
    pub(super) fn check(&self, y0: &[f64]) -> Result<(), Error> {
        if !(self.rtol > 0.0 && self.rtol < 1.0) {
            return Err(Error::input("rtol", self.rtol, "it lies between 0 and 1, such as 1e-6"));
        }
        if let AbsoluteTolerance::Vector(atol) = &self.atol
            && atol.len() != y0.len()
        {
            return Err(Error::input(
                "length of atol",
                atol.len(),
                format!("give one number, or one for each of the {} unknowns", y0.len()),
            ));
        }
        for (i, y) in y0.iter().enumerate() {
            let atol = match &self.atol {
                AbsoluteTolerance::Scalar(atol) => *atol,
                AbsoluteTolerance::Vector(atol) => atol[i],
            };
            if !(atol >= 0.0 && atol.is_finite()) {
                return Err(Error::input("atol", atol, "it is not negative, such as 1e-9"));
            }
            if atol == 0.0 && *y == 0.0 {
                return Err(Error::input(
                    "atol",
                    atol,
                    format!("unknown {i} starts at zero, so its atol has to be positive"),
                ));
            }
        }
        Ok(())
    }
}

/// Options of the step size and order control.
#[derive(Clone, Debug)]
pub(super) struct StepOptions {
    pub(super) initial_step: Option<f64>,
    pub(super) min_step: Option<f64>,
    pub(super) max_step: Option<f64>,
    /// Of multistep methods.
    pub(super) max_order: Option<u32>,
    pub(super) max_steps: u32,
    pub(super) convergence_coefficient: Option<f64>,
}

impl Default for StepOptions {
    fn default() -> Self {
        Self {
            initial_step: None,
            min_step: None,
            max_step: None,
            max_order: None,
            max_steps: 100_000,
            convergence_coefficient: None,
        }
    }
}

impl StepOptions {
    pub(super) fn check(&self) -> Result<(), Error> {
        for (input, value) in [("min_step", self.min_step), ("max_step", self.max_step)] {
            if let Some(h) = value
                && !(h > 0.0 && h.is_finite())
            {
                return Err(Error::input(input, h, "it is positive and finite"));
            }
        }
        if let Some(h) = self.initial_step
            && !(h.is_finite() && h != 0.0)
        {
            return Err(Error::input(
                "initial_step",
                h,
                "it is finite, and negative when integrating backwards",
            ));
        }
        if let (Some(min), Some(max)) = (self.min_step, self.max_step)
            && min > max
        {
            return Err(Error::input("min_step", min, format!("it is at most max_step, {max}")));
        }
        if self.max_steps == 0 || self.max_steps > i32::MAX as u32 {
            return Err(Error::input(
                "max_steps",
                self.max_steps,
                "it lies between 1 and 2^31 - 1",
            ));
        }
        if let Some(coefficient) = self.convergence_coefficient
            && !(coefficient > 0.0 && coefficient.is_finite())
        {
            return Err(Error::input("convergence_coefficient", coefficient, "it is positive"));
        }
        Ok(())
    }

    /// Checks the order of a multistep method.
    pub(super) fn check_order(&self, highest: u32) -> Result<(), Error> {
        match self.max_order {
            Some(order) if !(1..=highest).contains(&order) => {
                let mend = format!("this method has orders 1 to {highest}");
                Err(Error::input("max_order", order, mend))
            }
            _ => Ok(()),
        }
    }
}

/// Builder methods that integrators share.
macro_rules! builder_methods {
    (steps) => {
        /// Size of the first step; negative when integrating backwards. Default: estimated.
        pub fn initial_step(mut self, h: f64) -> Self {
            self.steps.initial_step = Some(h);
            self
        }

        /// Lower bound of |step size|. Default: none.
        pub fn min_step(mut self, h: f64) -> Self {
            self.steps.min_step = Some(h);
            self
        }

        /// Upper bound of |step size|. Default: none.
        pub fn max_step(mut self, h: f64) -> Self {
            self.steps.max_step = Some(h);
            self
        }

        /// Steps allowed in one call of `solve_to`. Default: 100,000.
        pub fn max_steps(mut self, steps: u32) -> Self {
            self.steps.max_steps = steps;
            self
        }

        /// How much smaller than the local error the error of the nonlinear iteration has to be.
        /// Default: 0.1 in CVODE and ARKODE, 0.33 in IDA.
        pub fn convergence_coefficient(mut self, coefficient: f64) -> Self {
            self.steps.convergence_coefficient = Some(coefficient);
            self
        }
    };
    (order) => {
        /// Highest order that may be used. Default: 5 for BDF, 12 for Adams.
        pub fn max_order(mut self, order: u32) -> Self {
            self.steps.max_order = Some(order);
            self
        }
    };
    (nonlinear) => {
        /// Newton iteration with this linear solver (the default, dense with difference quotients).
        pub fn newton(mut self, solver: LinearSolver) -> Self {
            self.nonlinear.solver = NonlinearSolver::Newton(solver);
            self
        }

        /// Fixed-point iteration, accelerated by Anderson's method over the last `acceleration`
        /// iterates (0: plain): needs no Jacobian; for non-stiff systems.
        pub fn fixed_point(mut self, acceleration: u32) -> Self {
            self.nonlinear.solver = NonlinearSolver::FixedPoint { acceleration };
            self
        }

        /// Steps after which the Newton matrix is set up anew in any case
        /// (`CVodeSetLSetupFrequency`, `ARKStepSetLSetupFrequency`). Default: 20.
        pub fn max_steps_between_setups(mut self, steps: u32) -> Self {
            self.nonlinear.max_steps_between_setups = Some(steps);
            self
        }
    };
}
pub(super) use builder_methods;

/// Where an integration call came to an end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reached {
    /// At the requested time, or, for a single step, at the end of the step.
    Time,
    /// Where a root function changes sign; `roots_found` tells which.
    Root,
    /// At the stop time, which is then no longer set.
    StopTime,
}

/// The stop time, and whether C has to be told.
///
/// SUNDIALS 6.4.1 can not forget a stop time; one at the end of all time does the same, if it lies
/// in the direction of time, which a new start may turn.
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

    /// C has forgotten it.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    pub(super) fn time(&self) -> Option<f64> {
        self.time
    }

    /// What to hand to C before it integrates from `t` towards `target`, if anything.
    pub(super) fn news(&mut self, t: f64, target: f64) -> Option<f64> {
        self.in_c |= self.stale;
        std::mem::take(&mut self.stale).then(|| self.time.unwrap_or(f64::MAX.copysign(target - t)))
    }
}

/// Checks the number of root functions, before there is room made for them.
pub(super) fn check_root_count(count: usize) -> Result<(), Error> {
    if i32::try_from(count).is_ok() {
        return Ok(());
    }
    Err(Error::input("root_count", count, "it is at most 2^31 - 1"))
}

/// Checks the start of an integration.
pub(super) fn check_start(t0: f64, y0: &[f64]) -> Result<(), Error> {
    check_time("t0", t0)?;
    if y0.is_empty() {
        return Err(Error::input("length of y0", 0, "there is at least one unknown"));
    }
    check_finite("y0", y0)
}

/// Checks that a time is finite.
pub(super) fn check_time(input: &'static str, t: f64) -> Result<(), Error> {
    if t.is_finite() { Ok(()) } else { Err(Error::input(input, t, "times are finite")) }
}

/// Checks that every number of an input is finite.
pub(super) fn check_finite(input: &'static str, values: &[f64]) -> Result<(), Error> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(i) => Err(Error::input(
            input,
            format!("{} in component {i}", values[i]),
            "all components are finite",
        )),
    }
}

/// Checks the length of an input.
pub(super) fn check_length(input: &'static str, len: usize, n: usize) -> Result<(), Error> {
    if len == n {
        return Ok(());
    }
    Err(Error::input(input, len, format!("there are {n} unknowns")))
}

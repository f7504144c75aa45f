//! How CVODE is to integrate.

use crate::sundials::{
    error::Error,
    linear::{Jacobian, LinearSolver},
    options::{AbsoluteTolerance, StepOptions, Tolerances, shared_builder_methods},
};

/// The two families of linear multistep methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Multistep {
    /// Backward differentiation formulas, orders 1 to 5: for stiff systems. Orders 3 to 5 are
    /// unstable for lightly damped oscillations; see [`CvodeOptions::max_order`].
    Bdf,
    /// Adams-Moulton formulas, orders 1 to 12: for non-stiff systems.
    Adams,
}

#[derive(Clone, Debug)]
pub(super) enum NonlinearSolver {
    Newton(LinearSolver),
    FixedPoint { acceleration: u32 },
}

/// Tolerances, method and limits of a [`Cvode`](super::Cvode).
///
/// ```
/// use pliant::sundials::{CvodeOptions, Jacobian, LinearSolver};
///
/// let options = CvodeOptions::new(1e-6, [1e-10, 1e-14, 1e-8])
///     .newton(LinearSolver::Dense(Jacobian::Supplied))
///     .max_order(2);
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct CvodeOptions {
    pub(super) tolerances: Tolerances,
    pub(super) steps: StepOptions,
    pub(super) method: Multistep,
    pub(super) nonlinear_solver: NonlinearSolver,
    pub(super) stability_limit_detection: bool,
    pub(super) max_steps_between_setups: Option<u32>,
}

impl CvodeOptions {
    /// BDF with a Newton iteration on a dense matrix of difference quotients, and these
    /// tolerances: local errors are kept below `rtol |y_i| + atol_i`.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        Self {
            tolerances: Tolerances { rtol, atol: atol.into() },
            steps: StepOptions::default(),
            method: Multistep::Bdf,
            nonlinear_solver: NonlinearSolver::Newton(LinearSolver::Dense(
                Jacobian::DifferenceQuotients,
            )),
            stability_limit_detection: false,
            max_steps_between_setups: None,
        }
    }

    /// The family of methods. Default: BDF.
    pub fn method(mut self, method: Multistep) -> Self {
        self.method = method;
        self
    }

    /// Newton iteration with this linear solver (the default, dense with difference quotients).
    pub fn newton(mut self, solver: LinearSolver) -> Self {
        self.nonlinear_solver = NonlinearSolver::Newton(solver);
        self
    }

    /// Fixed-point iteration, accelerated by Anderson's method over the last `acceleration`
    /// iterates (0: plain): needs no Jacobian; for non-stiff systems.
    pub fn fixed_point(mut self, acceleration: u32) -> Self {
        self.nonlinear_solver = NonlinearSolver::FixedPoint { acceleration };
        self
    }

    /// Whether BDF may lower its order where it detects its stability limit
    /// (`CVodeSetStabLimDet`). Default: no.
    pub fn stability_limit_detection(mut self, on: bool) -> Self {
        self.stability_limit_detection = on;
        self
    }

    /// Steps after which the Newton matrix is set up anew in any case
    /// (`CVodeSetLSetupFrequency`). Default: 20.
    pub fn max_steps_between_setups(mut self, steps: u32) -> Self {
        self.max_steps_between_setups = Some(steps);
        self
    }

    shared_builder_methods!();

    pub(super) fn check(&self, y0: &[f64]) -> Result<(), Error> {
        self.tolerances.check(y0)?;
        self.steps.check(match self.method {
            Multistep::Bdf => 5,
            Multistep::Adams => 12,
        })?;
        if self.stability_limit_detection && self.method == Multistep::Adams {
            return Err(Error::input("stability_limit_detection", true, "it belongs to BDF"));
        }
        if self.max_steps_between_setups == Some(0) {
            return Err(Error::input("max_steps_between_setups", 0, "it is at least 1"));
        }
        match &self.nonlinear_solver {
            NonlinearSolver::FixedPoint { acceleration } if *acceleration > 100 => {
                Err(Error::input(
                    "acceleration",
                    acceleration,
                    "a few iterates are enough, at most 100",
                ))
            }
            NonlinearSolver::FixedPoint { .. } => Ok(()),
            NonlinearSolver::Newton(solver) => solver.check(y0.len()),
        }
    }

    pub(super) fn linear_solver(&self) -> Option<&LinearSolver> {
        match &self.nonlinear_solver {
            NonlinearSolver::Newton(solver) => Some(solver),
            NonlinearSolver::FixedPoint { .. } => None,
        }
    }
}

//! How ARKODE is to integrate.

use super::table::Table;
use crate::sundials::{
    error::Error,
    linear::LinearSolver,
    nonlinear::{NonlinearOptions, NonlinearSolver},
    options::{AbsoluteTolerance, StepOptions, Tolerances, builder_methods},
};

/// Where the iteration for an implicit stage starts (`ARKStepSetPredictorMethod`).
///
/// Interpolants are those of the step before, continued.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Predictor {
    /// At the state at the start of the step.
    Trivial = 0,
    /// On the interpolant of highest degree.
    MaximumOrder = 1,
    /// On the interpolant of a degree that falls from 3 to 1 with the distance of the stage.
    VariableOrder = 2,
    /// On the interpolant of highest degree up to half a step, on the linear one beyond.
    CutoffOrder = 3,
    /// Where the stages before lead without this one.
    MinimumCorrection = 5,
}

/// Tolerances, method and limits of an [`Arkode`](super::Arkode).
///
/// ```
/// use pliant::sundials::{ArkodeOptions, Jacobian, LinearSolver, Table};
///
/// let options = ArkodeOptions::new(1e-6, [1e-10, 1e-14, 1e-8])
///     .table(Table::implicit(5)?)
///     .newton(LinearSolver::Dense(Jacobian::Supplied));
/// # Ok::<(), pliant::sundials::Error>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct ArkodeOptions {
    pub(super) tolerances: Tolerances,
    pub(super) steps: StepOptions,
    pub(super) fixed_step: Option<f64>,
    pub(super) table: Table,
    pub(super) nonlinear: NonlinearOptions,
    pub(super) max_steps_between_jacobians: Option<u32>,
    pub(super) max_iterations: u32,
    pub(super) linear: bool,
    pub(super) predictor: Predictor,
}

impl ArkodeOptions {
    /// The implicit method of order 4 with a Newton iteration on a dense matrix of difference
    /// quotients, and these tolerances: local errors are kept below `rtol |y_i| + atol_i`.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        Self {
            tolerances: Tolerances { rtol, atol: atol.into() },
            steps: StepOptions::default(),
            fixed_step: None,
            table: Table::default(),
            nonlinear: NonlinearOptions::default(),
            max_steps_between_jacobians: None,
            max_iterations: 6,
            linear: false,
            predictor: Predictor::VariableOrder,
        }
    }

    /// The method. Default: [`Table::default`]. What follows about Newton's iteration is for
    /// implicit methods; explicit ones have none.
    pub fn table(mut self, table: Table) -> Self {
        self.table = table;
        self
    }

    /// Steps of this size without regard to their errors, but for the last before a stop time
    /// (`ARKStepSetFixedStep`). Default: steps as the tolerances ask for.
    pub fn fixed_step(mut self, h: f64) -> Self {
        self.fixed_step = Some(h);
        self
    }

    builder_methods!(nonlinear);

    /// Steps after which a new Newton matrix has a new Jacobian in any case
    /// (`ARKStepSetJacEvalFrequency`). Default: 51.
    pub fn max_steps_between_jacobians(mut self, steps: u32) -> Self {
        self.max_steps_between_jacobians = Some(steps);
        self
    }

    /// Iterations allowed for each stage (`ARKStepSetMaxNonlinIters`). Default: 6.
    pub fn max_iterations(mut self, iterations: u32) -> Self {
        self.max_iterations = iterations;
        self
    }

    /// Says that the right-hand side is linear in y, with a constant Jacobian: one iteration
    /// solves a stage then, with a matrix that fits exactly (`ARKStepSetLinear`). Default: it is
    /// not.
    pub fn linear(mut self) -> Self {
        self.linear = true;
        self
    }

    /// Where iterations start. Default: variable order.
    pub fn predictor(mut self, predictor: Predictor) -> Self {
        self.predictor = predictor;
        self
    }

    builder_methods!(steps);

    /// Degree of the polynomials between the steps. Those of degree 4 and 5 cost evaluations of
    /// the right-hand side at each use, in stiff systems also accuracy.
    pub(super) fn interpolant_degree(&self) -> u32 {
        let highest = if self.table.is_implicit() { 3 } else { 5 };
        (self.table.order() - 1).min(highest)
    }

    pub(super) fn check(&self, y0: &[f64]) -> Result<(), Error> {
        self.tolerances.check(y0)?;
        self.steps.check()?;
        if let Some(h) = self.fixed_step
            && !(h.is_finite() && h != 0.0)
        {
            let mend = "it is finite, and negative when integrating backwards";
            return Err(Error::input("fixed_step", h, mend));
        }
        for (input, value) in [
            ("max_steps_between_jacobians", self.max_steps_between_jacobians),
            ("max_iterations", Some(self.max_iterations)),
        ] {
            if let Some(value) = value
                && !(1..=i32::MAX as u32).contains(&value)
            {
                return Err(Error::input(input, value, "it lies between 1 and 2^31 - 1"));
            }
        }
        self.nonlinear.check(y0.len())
    }
}

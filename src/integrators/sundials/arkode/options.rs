//! How ARKODE is to integrate.

use super::butcher_table::ButcherTable;
use crate::base::input::InputError;
use crate::integrators::{
    common::{AbsoluteTolerance, StepOptions, Tolerances, check_count, check_step, step_options},
    sundials::{
        linear_solver::LinearSolver,
        nonlinear::{NonlinearOptions, NonlinearSolver},
        options::{Limits, builder_methods},
        signs::Sign,
    },
};

/// Where the iteration for an implicit stage starts (`ARKStepSetPredictorMethod`).
///
/// Interpolants are those of the step before, extrapolated.
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
    /// At the state that the previous stages of the step give without this one.
    MinimumCorrection = 5,
}

/// Tolerances, method and limits of an [`Arkode`](super::Arkode).
///
/// ```
/// use pliant::sundials::{ArkodeOptions, Jacobian, LinearSolver, ButcherTable};
///
/// let options = ArkodeOptions::new(1e-6, [1e-10, 1e-14, 1e-8])
///     .table(ButcherTable::implicit(5)?)
///     .newton(LinearSolver::Dense(Jacobian::Supplied));
/// # Ok::<(), pliant::InputError>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct ArkodeOptions {
    pub(super) tolerances: Tolerances,
    pub(super) steps: StepOptions,
    pub(super) limits: Limits,
    pub(super) fixed_step: Option<f64>,
    pub(super) table: ButcherTable,
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
            tolerances: Tolerances::new(rtol, atol),
            steps: StepOptions::default(),
            limits: Limits::default(),
            fixed_step: None,
            table: ButcherTable::default(),
            nonlinear: NonlinearOptions::default(),
            max_steps_between_jacobians: None,
            max_iterations: 6,
            linear: false,
            predictor: Predictor::VariableOrder,
        }
    }

    /// The method. Default: [`ButcherTable::default`].
    ///
    /// The options of Newton's iteration are for implicit methods; explicit ones have none. (But the linear
    /// solver also gives a mass matrix its form.)
    pub fn table(mut self, table: ButcherTable) -> Self {
        self.table = table;
        self
    }

    /// Steps of this fixed size, without error control; the last one before a stop time may differ
    /// (`ARKStepSetFixedStep`). Default: the tolerances control the steps.
    pub fn fixed_step(mut self, h: f64) -> Self {
        self.fixed_step = Some(h);
        self
    }

    builder_methods!(nonlinear);

    /// Steps after which a new Newton matrix gets a new Jacobian in any case (`ARKStepSetJacEvalFrequency`).
    /// Default: 51.
    pub fn max_steps_between_jacobians(mut self, steps: u32) -> Self {
        self.max_steps_between_jacobians = Some(steps);
        self
    }

    /// Iterations allowed for each stage (`ARKStepSetMaxNonlinIters`). Default: 6.
    pub fn max_iterations(mut self, iterations: u32) -> Self {
        self.max_iterations = iterations;
        self
    }

    /// Declares that the right-hand side is linear in y, with a constant Jacobian (`ARKStepSetLinear`).
    /// Default: it is not.
    ///
    /// One iteration then solves a stage, with an exact Newton matrix.
    pub fn linear(mut self) -> Self {
        self.linear = true;
        self
    }

    /// Where iterations start. Default: variable order.
    pub fn predictor(mut self, predictor: Predictor) -> Self {
        self.predictor = predictor;
        self
    }

    step_options!();
    builder_methods!(limits);

    /// Degree of the polynomials between the steps. Those of degree 4 and 5 need evaluations of the
    /// right-hand side at each use, and are less accurate in stiff systems.
    pub(super) fn interpolant_degree(&self) -> u32 {
        let highest = if self.table.is_implicit() { 3 } else { 5 };
        (self.table.order() - 1).min(highest)
    }

    pub(super) fn check(&self, y0: &[f64]) -> Result<(), InputError> {
        self.tolerances.check(y0)?;
        self.steps.check()?;
        self.limits.check(self.steps.max_step, y0)?;
        self.fixed_step.map_or(Ok(()), |h| check_step("fixed_step", h))?;
        if self.fixed_step.is_some() && self.limits.signs.iter().any(|sign| *sign != Sign::Free) {
            let help = "signs are kept by smaller steps: let the tolerances choose the steps";
            return Err(InputError::new("sign_constraints", "given with fixed_step", help));
        }
        for (input, value) in [
            ("max_steps_between_jacobians", self.max_steps_between_jacobians),
            ("max_iterations", Some(self.max_iterations)),
        ] {
            value.map_or(Ok(()), |count| check_count(input, count))?;
        }
        self.nonlinear.check(y0.len())
    }
}

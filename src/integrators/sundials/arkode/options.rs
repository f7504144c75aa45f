//! Options of ARKODE.

use super::{
    butcher_table::ButcherTable,
    controller::Controller,
    stages::{OfStages, StageOptions},
    tableau::{Scheme, Tableau},
};
use crate::base::input::InputError;
use crate::integrators::{
    common::{AbsoluteTolerance, check_step},
    sundials::{
        options::{OfOde, SolverOptions},
        signs::Sign,
    },
};

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
pub type ArkodeOptions = SolverOptions<OwnOptions>;

/// Options that ARKODE alone has.
#[derive(Clone, Debug)]
pub struct OwnOptions {
    pub(super) fixed_step: Option<f64>,
    pub(super) scheme: Scheme,
    pub(super) stages: StageOptions,
    pub(super) controller: Controller,
    pub(super) safety_factor: Option<f64>,
    pub(super) error_bias: Option<f64>,
}

impl OfOde for OwnOptions {}

impl OfStages for OwnOptions {
    fn stages_mut(&mut self) -> &mut StageOptions {
        &mut self.stages
    }
}

impl ArkodeOptions {
    /// The implicit method of order 4 with a Newton iteration on a dense matrix of difference
    /// quotients, and these tolerances: local errors are kept below `rtol |y_i| + atol_i`.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        let own = OwnOptions {
            fixed_step: None,
            scheme: Scheme::Known(ButcherTable::default()),
            stages: StageOptions::default(),
            controller: Controller::Pid,
            safety_factor: None,
            error_bias: None,
        };
        Self::with(rtol, atol, own)
    }

    /// The method. Default: [`ButcherTable::default`].
    ///
    /// The options of Newton's iteration are for implicit methods; explicit ones have none. (But the linear
    /// solver also gives a mass matrix its form.)
    pub fn table(mut self, table: ButcherTable) -> Self {
        self.own.scheme = Scheme::Known(table);
        self
    }

    /// The method, by coefficients of one's own: explicit or diagonally implicit (`ARKStepSetTables`).
    pub fn tableau(mut self, tableau: Tableau) -> Self {
        self.own.scheme = Scheme::Own(tableau);
        self
    }

    /// The method, by a pair of tableaux of one's own with the same stages, for a right-hand side that is
    /// [split](crate::integrators::ode::Ode::is_split) (`ARKStepSetTables`).
    pub fn imex_tableaux(mut self, implicit: Tableau, explicit: Tableau) -> Self {
        self.own.scheme = Scheme::OwnPair(implicit, explicit);
        self
    }

    /// Steps of this fixed size, without error control; the last one before a stop time may differ
    /// (`ARKStepSetFixedStep`). Default: the tolerances control the steps.
    pub fn fixed_step(mut self, h: f64) -> Self {
        self.own.fixed_step = Some(h);
        self
    }

    /// Controller of the step size. Default: [`Controller::Pid`].
    pub fn controller(mut self, controller: Controller) -> Self {
        self.own.controller = controller;
        self
    }

    /// Factor of the step size that the controller proposes (`ARKStepSetSafetyFactor`). Default: 0.96.
    pub fn safety_factor(mut self, factor: f64) -> Self {
        self.own.safety_factor = Some(factor);
        self
    }

    /// Factor of the error estimates that the controller gets (`ARKStepSetErrorBias`). Default: 1.5.
    pub fn error_bias(mut self, factor: f64) -> Self {
        self.own.error_bias = Some(factor);
        self
    }

    /// Degree of the polynomials between the steps. Those of degree 4 and 5 need evaluations of the
    /// right-hand side at each use, and are less accurate in stiff systems.
    pub(super) fn interpolant_degree(&self) -> u32 {
        let highest = if self.own.scheme.is_implicit() { 3 } else { 5 };
        (self.own.scheme.order() - 1).clamp(1, highest)
    }

    pub(super) fn check(&self, y0: &[f64]) -> Result<(), InputError> {
        self.check_shared(y0, u32::MAX)?;
        self.own.fixed_step.map_or(Ok(()), |h| check_step("fixed_step", h))?;
        self.own.scheme.check(self.own.fixed_step.is_none())?;
        if self.own.fixed_step.is_some() && self.signs.iter().any(|sign| *sign != Sign::Free) {
            let help = "signs are kept by smaller steps: let the tolerances choose the steps";
            return Err(InputError::new("sign_constraints", "given with fixed_step", help));
        }
        if let Some(factor) =
            self.own.safety_factor.filter(|factor| !(*factor > 0.0 && *factor < 1.0))
        {
            return Err(InputError::new(
                "safety_factor",
                factor,
                "it lies between 0 and 1, such as 0.96",
            ));
        }
        if let Some(factor) =
            self.own.error_bias.filter(|factor| !(*factor >= 1.0 && factor.is_finite()))
        {
            return Err(InputError::new("error_bias", factor, "it is at least 1, such as 1.5"));
        }
        self.own.stages.check()
    }
}

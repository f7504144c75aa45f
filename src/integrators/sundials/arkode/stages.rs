//! Solution of the equations of implicit stages.

use crate::base::input::InputError;
use crate::integrators::{
    common::{Error, check_count},
    ode::Ode,
    sundials::{
        functions::StageFunctions, ode_krylov::newton_setup_with_mass, options::SolverOptions,
        session::Session,
    },
};

/// Predictor of the iteration for an implicit stage (`ARKStepSetPredictorMethod`).
///
/// Interpolants are those of the step before, extrapolated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
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

/// Options of implicit stages.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub struct StageOptions {
    max_steps_between_jacobians: Option<u32>,
    max_iterations: u32,
    linear: bool,
    predictor: Predictor,
}

impl Default for StageOptions {
    fn default() -> Self {
        Self {
            max_steps_between_jacobians: None,
            max_iterations: 6,
            linear: false,
            predictor: Predictor::VariableOrder,
        }
    }
}

/// Options of an integrator with implicit stages: [`ArkodeOptions`](super::ArkodeOptions) and
/// [`MultirateOptions`](crate::integrators::sundials::MultirateOptions).
#[doc(hidden)]
pub trait OfStages {
    #[doc(hidden)]
    fn stages_mut(&mut self) -> &mut StageOptions;
}

impl<O: OfStages> SolverOptions<O> {
    /// Steps after which a new Newton matrix gets a new Jacobian in any case (`ARKStepSetJacEvalFrequency`).
    /// Default: 51.
    pub fn max_steps_between_jacobians(mut self, steps: u32) -> Self {
        self.own.stages_mut().max_steps_between_jacobians = Some(steps);
        self
    }

    /// Iterations allowed for each stage (`ARKStepSetMaxNonlinIters`). Default: 6.
    pub fn max_iterations(mut self, iterations: u32) -> Self {
        self.own.stages_mut().max_iterations = iterations;
        self
    }

    /// Declares that the right-hand side is linear in y, with a constant Jacobian (`ARKStepSetLinear`).
    /// Default: it is not.
    ///
    /// One iteration then solves a stage, with an exact Newton matrix.
    pub fn linear(mut self) -> Self {
        self.own.stages_mut().linear = true;
        self
    }

    /// Predictor of the iterations. Default: variable order.
    pub fn predictor(mut self, predictor: Predictor) -> Self {
        self.own.stages_mut().predictor = predictor;
        self
    }
}

impl StageOptions {
    pub(in crate::integrators::sundials) fn check(&self) -> Result<(), InputError> {
        self.max_steps_between_jacobians
            .map_or(Ok(()), |count| check_count("max_steps_between_jacobians", count))?;
        check_count("max_iterations", self.max_iterations)
    }

    /// Sets how a session, whose functions these are, solves the equations of its implicit stages.
    pub(in crate::integrators::sundials) fn set<K, S: Ode, O>(
        &self,
        session: &mut Session<K, S>,
        functions: &StageFunctions,
        options: &SolverOptions<O>,
    ) -> Result<(), Error> {
        // SAFETY: the functions are those of the session, and the callback fits the registered host; the values are
        // plain numbers.
        unsafe {
            session.set(functions.set_predictor, self.predictor as i32)?;
            session.set(functions.set_max_iterations, self.max_iterations as i32)?;
            // The slope of a stage follows from its equation: this spares an evaluation, which would
            // also stop the integration if it failed, and magnify errors of stiff components.
            session.set(functions.deduce_slopes, 1)?;
            if self.linear {
                session.set(functions.set_linear, 0)?;
            }
            if let Some(steps) = options.max_steps_between_setups {
                session.set(functions.set_setup_frequency, steps as i32)?;
            }
            session.set_nonlinear(functions.ode, options, |session| {
                session.set(functions.set_linear_system, Some(newton_setup_with_mass::<S> as _))
            })?;
            if let (Some(_), Some(steps)) =
                (options.newton_solver(), self.max_steps_between_jacobians)
            {
                session.set(functions.set_jacobian_frequency, i64::from(steps))?;
            }
        }
        Ok(())
    }
}

//! Why an integration stopped.

use std::error::Error as StdError;

use super::StabilityLimit;

/// Why an integration stopped, when and at which step size, and what to try.
///
/// The integrator stays at the end of the last accepted step: its `t()` and `y()` are good.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An argument or option that cannot be worked with.
    #[error("{input} = {value}: {mend}")]
    BadInput {
        /// Name of the argument or option.
        input: String,
        /// What was given.
        value: String,
        /// What to give instead.
        mend: String,
    },

    /// The error test fails at every step size that still changes t.
    #[error(
        "step size {step:e} at t = {t} no longer changes t, and the error test still fails: the \
         solution has a singularity or the right-hand side a jump there; end the phase at the \
         jump (stop_time, then reinit), or check the model, or loosen rtol and atol"
    )]
    StepUnderflow {
        /// Time reached.
        t: f64,
        /// Step size that was refused.
        step: f64,
    },

    /// The right-hand side failed with [`Failure::Recoverable`](crate::ode::Failure) at every
    /// step size, or at the initial state, where no smaller step helps.
    #[error(
        "the right-hand side cannot be evaluated near t = {t} (step size {step:e}): {message}; the \
         solution leaves the domain of the right-hand side there: check the state and the model"
    )]
    Refused {
        /// Time reached.
        t: f64,
        /// Step size that was refused; 0 at the initial state.
        step: f64,
        /// What the right-hand side said last.
        message: String,
    },

    /// The right-hand side gives NaN or infinity at every step size, or at the initial state.
    #[error(
        "component {component} of the right-hand side is {value} at t = {t} (step size {step:e}): \
         look for a division by zero, or a root or logarithm of a negative number, in the model \
         and its parameters"
    )]
    NonFinite {
        /// Time at which the right-hand side was evaluated.
        t: f64,
        /// Step size that was tried; 0 at the initial state.
        step: f64,
        /// The first component that is not finite, counted from 0.
        component: usize,
        /// Its value.
        value: f64,
    },

    /// [`solve_to`](super::DormandPrince::solve_to) took as many steps as one call may.
    ///
    /// Calling again continues.
    #[error(
        "{steps} steps taken, and t = {t} is still short of {target} (step size {step:e}): {}",
        advice(.stability_limited)
    )]
    TooManySteps {
        /// Time reached.
        t: f64,
        /// Last step size.
        step: f64,
        /// Time asked for.
        target: f64,
        /// Steps taken by this call.
        steps: usize,
        /// Whether stability is the reason for the small steps.
        stability_limited: Option<StabilityLimit>,
    },

    /// The right-hand side failed with [`Failure::Fatal`](crate::ode::Failure).
    #[error("the right-hand side failed at t = {t} (step size {step:e}): {source}")]
    Rhs {
        /// Time at which the right-hand side was evaluated.
        t: f64,
        /// Step size that was tried; 0 at the initial state.
        step: f64,
        /// The error it returned.
        source: Box<dyn StdError + Send + Sync>,
    },

    /// The root functions failed, or one is not finite.
    #[error("the root functions failed at t = {t}: {source}")]
    Roots {
        /// Time at which they were evaluated.
        t: f64,
        /// The error they returned, or which of them is not finite.
        source: Box<dyn StdError + Send + Sync>,
    },
}

impl Error {
    pub(crate) fn bad_input(
        input: impl Into<String>,
        value: impl ToString,
        mend: impl Into<String>,
    ) -> Self {
        Self::BadInput { input: input.into(), value: value.to_string(), mend: mend.into() }
    }
}

fn advice(stability_limited: &Option<StabilityLimit>) -> String {
    stability_limited.map_or_else(
        || "raise max_steps, or loosen rtol and atol if the motion is smooth".to_owned(),
        |limit| limit.to_string(),
    )
}

//! Runs that end before their time: where, why, and with what in hand.

use std::fmt;

use super::stepper::Failed;
use super::{Counts, Method};
use crate::trajectory::Trajectory;

/// An integration that gave up or was stopped: where, why, and what was computed until then.
#[derive(Debug)]
pub struct IntegrationFailure {
    /// Name of the phase.
    pub phase: String,
    /// The method.
    pub method: Method,
    /// Time reached (s).
    pub time: f64,
    /// Last step size (s).
    pub step: f64,
    /// What the integrator said, with the likely cause and what to try; [`Interrupted`] if it was
    /// stopped from outside.
    pub source: Failed,
    /// The motion until then, down to the last step.
    pub trajectory: Trajectory,
}

/// The cause of an [`IntegrationFailure`] that is none: the observer of
/// [`Scene::simulate_with`](crate::Scene::simulate_with) stopped the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("interrupted")]
pub struct Interrupted;

impl IntegrationFailure {
    /// Whether the run was stopped from outside, with nothing wrong with it.
    pub fn is_interruption(&self) -> bool {
        self.source.is::<Interrupted>()
    }

    /// What the integrator said, with all that lies behind it.
    pub fn cause(&self) -> String {
        let mut said = self.source.to_string();
        let mut behind = self.source.source();
        while let Some(inner) = behind {
            said = format!("{said}: {inner}");
            behind = inner.source();
        }
        said
    }
}

impl fmt::Display for IntegrationFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { phase, method, time, step, .. } = self;
        let cause = self.cause();
        write!(
            f,
            "phase \"{phase}\" ({method}) stopped at t = {time} s, step {step:.3e} s: {cause}"
        )
    }
}

impl std::error::Error for IntegrationFailure {}

/// Steps in a row that may be too small to move time ahead in double precision.
pub(super) const STANDING: usize = 100;

pub(super) fn standing_still(refusal: &str) -> Failed {
    let reason = match refusal {
        "" => "the motion changes without end in no time: check the model near this time",
        reason => reason,
    };
    format!("{STANDING} steps, too small to move time ahead, have not led past this: {reason}")
        .into()
}

pub(super) fn too_many_steps(steps: usize, counts: &Counts) -> Failed {
    let reason = counts.notice.as_deref().unwrap_or("loosen rtol, or choose another method");
    format!("{steps} steps taken, as many as max_steps allows: {reason}").into()
}

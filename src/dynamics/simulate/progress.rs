//! Progress of a run, for observers.

use std::ops::ControlFlow;

use crate::dynamics::trajectory::Trajectory;

/// Progress of a run, as reported to the observer after each step: see
/// [`Scene::simulate_with`](crate::Scene::simulate_with).
#[derive(Debug, Clone, Copy)]
pub struct Progress<'a> {
    /// Time reached (s).
    pub time: f64,
    /// Number of the phase, counted from 0.
    pub phase: usize,
    /// Its name.
    pub name: &'a str,
    /// Steps taken since t = 0.
    pub steps: usize,
    /// Size of the last step (s).
    pub step: f64,
    /// Order of the last step.
    pub order: u32,
    /// The cause of steps that are far too short for the phase, with what to try; none before a thousand such steps.
    pub notice: Option<&'a str>,
    /// The samples so far. Where a method could not be trusted, the run goes back and its samples are
    /// discarded.
    pub trajectory: &'a Trajectory,
}

/// Observer of a run, which may stop it.
pub(super) type Observer<'a> = &'a mut dyn FnMut(&Progress) -> ControlFlow<()>;

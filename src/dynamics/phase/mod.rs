//! The equations of a phase in the form of a run, and their integrators.
//!
//! Whether a phase is run in all unknowns or by a reduced model is decided in one place, [`Scene::phase_system`]. Each of both
//! has a file with its integrators, which return states of all nodes.

mod integrators;
mod lifted;
mod summary;

#[cfg(feature = "gradient")]
pub(crate) use integrators::repeating;
pub use summary::PhaseSummary;

use crate::base::input::InputError;
use crate::dynamics::reduced::ReducedSystem;
use crate::dynamics::report::Counts;
use crate::dynamics::system::{PhaseSystem, System};
use crate::scene::settings::{AbsoluteTolerances, Settings};
use crate::scene::timeline::Scene;

pub(crate) type Failed = Box<dyn std::error::Error + Send + Sync>;

/// The equations of a phase, with their integrators.
pub(crate) trait Integrable: PhaseSystem {
    /// Starts the integrator that the settings name.
    ///
    /// # Errors
    /// A method that is not for these equations; errors of the integrator.
    fn start(self: Box<Self>, start: &Start) -> Result<Box<dyn Stepper>, Failed>;
}

/// Start time (s) of an integrator, and kind of start.
pub(crate) struct Start<'a> {
    pub(crate) settings: &'a Settings,
    pub(crate) atol: &'a AbsoluteTolerances,
    pub(crate) state: &'a [f64],
    pub(crate) time: f64,
    /// Size of the first step (s), if it is known.
    pub(crate) first: Option<f64>,
    /// Whether one-step methods take the steps that the run prescribes.
    pub(crate) prescribed: bool,
}

/// An integrator at work on the equations of one phase.
pub(crate) trait Stepper: Send {
    /// Takes one step towards `end` and returns the time reached.
    fn step(&mut self, end: f64) -> Result<f64, Failed>;

    /// Lets the steps end at time `t` (s), exactly.
    fn stop_at(&mut self, t: f64) -> Result<(), Failed>;

    /// Continues from `state` at time `t` (s) after a change of the forces; `false` if that needs a new start.
    fn resume(&mut self, t: f64, state: &[f64]) -> Result<bool, Failed>;

    /// Starts again from `state` at time `t` (s), as a new integrator would, and returns the statistics until then; nothing if that needs a
    /// new integrator.
    fn restart(&mut self, t: f64, state: &[f64]) -> Result<Option<Counts>, Failed>;

    /// The state at a time within the last step.
    fn interpolate(&mut self, t: f64, state: &mut [f64]) -> Result<(), Failed>;

    /// Order of the last step.
    fn last_order(&self) -> u32;

    /// Size of the next step (s), if it is known.
    fn next_step(&self) -> f64;

    /// The state at the end of the last step.
    fn state(&self) -> &[f64];

    /// Number of its unknowns.
    fn unknowns(&self) -> usize {
        self.state().len()
    }

    fn system(&self) -> &dyn PhaseSystem;

    fn system_mut(&mut self) -> &mut dyn PhaseSystem;

    /// Ends the integrator and returns the equations.
    fn into_system(self: Box<Self>) -> Box<dyn Integrable>;

    /// Statistics of the integration so far, with its notice.
    fn counts(&self) -> Counts;
}

impl Scene {
    /// The equations of the phase `name`, `full` ones, or by the reduced model of the scene if it has one.
    ///
    /// # Errors
    /// Features that such models do not support, and constraints that this one has not learned.
    pub(crate) fn phase_system(
        &self,
        full: System,
        name: &str,
    ) -> Result<Box<dyn Integrable>, InputError> {
        Ok(match self.shared_reduced_model() {
            Some(model) => Box::new(ReducedSystem::new(full, self.body(), model, name)?),
            None => Box::new(full),
        })
    }
}

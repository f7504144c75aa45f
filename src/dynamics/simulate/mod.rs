//! Running a scene: phase by phase, with restarts in between and samples along the way.

#[cfg(feature = "gradient")]
mod adjoint;
mod angles;
mod at_rest;
mod auto;
mod changes;
mod checkpoint;
#[cfg(feature = "checkpoint")]
mod checkpoint_parts;
mod commands;
mod component;
mod contact_gauge;
mod crawl;
#[cfg(feature = "study")]
mod derivative;
mod events;
mod failure;
mod gauge;
mod inertial;
mod interval;
mod output;
mod outputs;
mod phase_end;
mod phase_run;
mod progress;
mod reading;
mod records;
mod reduced_checks;
mod resolution;
mod rigid_fit;
#[cfg(any(feature = "scene-file", feature = "study"))]
mod rod_reading;
mod run;
mod same_steps;
mod sampling;
mod sensor;
mod simulation;
#[cfg(any(feature = "scene-file", feature = "study"))]
mod smaller_reading;
mod spot;
mod spot_gauge;
mod stalled;
mod step_list;
mod steps;
#[cfg(feature = "gradient")]
mod tape;
mod view;
mod watch;
mod watching;

use std::ops::ControlFlow;
use std::time::Instant;

#[cfg(feature = "checkpoint")]
pub(crate) use angles::Angles;
pub use checkpoint::Checkpoint;
#[cfg(feature = "checkpoint")]
pub(crate) use checkpoint::Kept;
#[cfg(feature = "checkpoint")]
pub(crate) use checkpoint_parts::Choice;
pub use component::Component;
#[cfg(feature = "study")]
pub(crate) use derivative::{Linearized, Moved};
#[cfg(feature = "scene-file")]
pub(crate) use output::Output;
#[cfg(feature = "scene-file")]
pub(crate) use outputs::OUTPUTS;
pub use progress::Progress;
pub use reading::Reading;
use run::Run;
pub use sampling::Sampling;
pub use simulation::Simulation;
pub use spot::Spot;
pub use step_list::StepList;
#[cfg(feature = "gradient")]
pub(crate) use tape::Tape;
use view::Gauges;
pub use view::View;

pub use crate::base::root::Direction;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::Trajectory;
use crate::scene::settings::Settings;
use crate::scene::timeline::Scene;

impl Scene {
    /// Runs the scene, from rest in its undeformed shape unless a start was given.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings};
    ///
    /// let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    /// let body = Body::new(mesh, rubber).thickness(0.01).build()?;
    /// let scene = Scene::new(body)
    ///     .phase(Phase::until(0.1).hold("bottom").move_nodes([14, 15], [0.0, -0.16]));
    /// let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.01))?;
    /// assert!((trajectory.last().u[2 * 13 + 1] - -0.016).abs() < 1e-6);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// Bad input before anything is computed; [`Error::Integration`] with the motion until then
    /// when the integrator gives up.
    pub fn simulate(&self, settings: &Settings, sampling: &Sampling) -> Result<Trajectory, Error> {
        self.simulate_with(settings, sampling, |_| ControlFlow::Continue(()))
    }

    /// As [`simulate`](Self::simulate), calling `observer` after each step with the progress of the
    /// run. The observer stops the run by [`ControlFlow::Break`].
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// # use pliant::{Body, Cells, Error, Material, Mesh, Phase, Sampling, Scene, Settings};
    /// # let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    /// # let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    /// # let body = Body::new(mesh, rubber).thickness(0.01).build()?;
    /// # let scene = Scene::new(body)
    /// #     .phase(Phase::until(0.1).hold("bottom").move_nodes([14, 15], [0.0, -0.16]));
    ///
    /// let patience = |progress: &pliant::simulate::Progress| match progress.steps {
    ///     50 => ControlFlow::Break(()),
    ///     _ => ControlFlow::Continue(()),
    /// };
    /// match scene.simulate_with(&Settings::default(), &Sampling::every(0.01), patience) {
    ///     Err(Error::Integration(end)) if end.is_interruption() => {
    ///         assert_eq!(end.trajectory.report().steps(), 50);
    ///         assert_eq!(end.trajectory.last().time, end.time);
    ///     }
    ///     other => panic!("{other:?}"),
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`simulate`](Self::simulate); a run that was stopped also ends with [`Error::Integration`],
    /// for which this holds: [`is_interruption`](crate::IntegrationFailure::is_interruption).
    pub fn simulate_with(
        &self,
        settings: &Settings,
        sampling: &Sampling,
        mut observer: impl FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<Trajectory, Error> {
        let clock = Instant::now();
        settings.validate()?;
        let scene = &*settings.method.equations_of(self);
        let forces = scene.forces_from_start()?;
        let sensors = sampling.sensors(scene)?;
        let matrices = scene.matrices(&forces);
        let first = forces.into_iter().next().unwrap_or_default();
        let gauges = Gauges::new(scene)?;
        let mut run =
            Run::new(scene, settings, (sampling, sensors), clock, (matrices, gauges), first)?;
        while run.advance(&mut observer)? {}
        Ok(run.into_trajectory())
    }
}

//! Phases that end before their time: as a sensor passes a level.

use super::Scene;
use super::phase::{Phase, PhaseEnd};
use crate::base::input::{InputError, finite};

impl Phase {
    /// Ends the phase as a sensor rises above a `level` (in its unit), at [`until`](Self::until) at the latest.
    ///
    /// The sensor is one of the [`Sampling`](crate::Sampling) of the run, by the name of its column: `tip.y` of one with several components. The
    /// time is located to round-off within the step, by the dense output of the integrator; within a step, readings at eight
    /// times are compared. The reading has to pass the level: one that is above it at the start does not count before it has been below. The next phase begins at
    /// that time, and lasts until its own end; the last phase cannot end so, as the end of a scene is fixed. Signals and tables
    /// of later phases remain functions of the time since the start of the run. [`PhaseReport::ended_by`](crate::PhaseReport::ended_by) names the sensor
    /// that ended a phase.
    ///
    /// ```
    /// use pliant::simulate::{Component, Reading};
    /// use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings};
    ///
    /// let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles)?;
    /// let body = Body::new(mesh, Material::rigid(1000.0)).thickness(0.01).build()?;
    /// let scene = Scene::new(body)
    ///     .gravity([0.0, -9.8])
    ///     .phase(Phase::until(2.0).named("fall").ends_below("height", -0.45))
    ///     .phase(Phase::until(3.0).hold("all"));
    /// let height = Reading::centre_of_mass().component(Component::Y);
    /// let motion = scene.simulate(&Settings::default(), &Sampling::every(0.1).read("height", height))?;
    /// let fall = &motion.report().phases[0];
    /// assert!((fall.end - (2.0 * 0.5 / 9.8_f64).sqrt()).abs() < 1e-4);
    /// assert_eq!(fall.ended_by.as_deref(), Some("height"));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the scene is run: a sensor that the sampling does not read, the last phase, a reduced model. Studies that compare runs sample by sample
    /// refuse such scenes.
    pub fn ends_above(self, sensor: impl Into<String>, level: f64) -> Self {
        self.ending(sensor.into(), level, true)
    }

    /// As [`ends_above`](Self::ends_above), as the sensor falls below a `level`.
    pub fn ends_below(self, sensor: impl Into<String>, level: f64) -> Self {
        self.ending(sensor.into(), level, false)
    }

    fn ending(mut self, sensor: String, level: f64, rises: bool) -> Self {
        self.ends = Some(PhaseEnd { sensor, level, rises });
        self
    }
}

impl Scene {
    /// # Errors
    /// Ends of phases that cannot be found.
    pub(crate) fn check_ends(&self) -> Result<(), InputError> {
        let ends = self.phases.iter().filter_map(|phase| Some((phase, phase.ends.as_ref()?)));
        for (number, (phase, end)) in ends.enumerate() {
            let input = format!("end of phase \"{}\"", phase.name);
            finite(&input, &[end.level])?;
            let value = || format!("by sensor \"{}\"", end.sensor);
            if number == 0 && self.reduced_model().is_some() {
                let help = "a reduced model is learned for phases whose ends are known: run the scene without one";
                return Err(InputError::new(input, value(), help));
            }
            if self.phases.last().is_some_and(|last| std::ptr::eq(last, phase)) {
                let help = "the last phase ends at a time, that of the scene: let another one follow, which may be short";
                return Err(InputError::new(input, value(), help));
            }
        }
        Ok(())
    }

    /// # Errors
    /// Phases that end by sensors, of which `what` (as in "an accuracy") cannot be computed.
    pub(crate) fn refuse_ends(&self, what: &str) -> Result<(), InputError> {
        let end = self.phases.iter().find_map(|phase| Some((phase, phase.ends.as_ref()?)));
        let Some((phase, end)) = end else { return Ok(()) };
        let input = format!("end of phase \"{}\"", phase.name);
        let help = format!(
            "{what} needs runs that are compared at the same times, and each run ends such a phase at its own: leave the sensor out"
        );
        Err(InputError::new(input, format!("by sensor \"{}\"", end.sensor), help))
    }
}

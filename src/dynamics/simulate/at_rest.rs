//! Sensor readings of equilibria.

use super::angles::Angles;
use super::sampling::Sampling;
use super::sensor::Sensors;
use super::view::{Gauges, View};
use crate::base::input::InputError;
use crate::dynamics::equilibrium::{Equilibrium, NoEquilibrium};
use crate::dynamics::trajectory::Trajectory;

impl Equilibrium {
    /// Reads the sensors of `sampling` at each sample of the [trajectory](Self::trajectory).
    ///
    /// They become further columns of its tables, after those that it has. Nothing moves: velocities are 0,
    /// and dampers, viscosity and friction do not act.
    ///
    /// ```
    /// use pliant::simulate::Reading;
    /// use pliant::{Sampling, Statics, samples};
    ///
    /// let mut found = samples::square_jump(4)?.equilibrium(&Statics::default())?;
    /// found.read(&Sampling::phase_ends().read("pressed", Reading::constraint_force([14, 15])))?;
    /// assert!(found.sample().sensors[1] < 0.0); // downwards
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// A quantity that the scene does not have; two columns with one name.
    pub fn read(&mut self, sampling: &Sampling) -> Result<(), InputError> {
        read(&mut self.trajectory, sampling)
    }
}

impl NoEquilibrium {
    /// As [`Equilibrium::read`], for the equilibria that were found.
    ///
    /// # Errors
    /// As there.
    pub fn read(&mut self, sampling: &Sampling) -> Result<(), InputError> {
        read(&mut self.trajectory, sampling)
    }
}

fn read(trajectory: &mut Trajectory, sampling: &Sampling) -> Result<(), InputError> {
    let scene = trajectory.scene();
    let sensors = Sensors::new(sampling.asked(), scene)?;
    if sensors.is_empty() {
        return Ok(());
    }
    let (gauges, mut angles) = (Gauges::new(scene)?, Angles::default());
    let at_rest = vec![0.0; scene.body().dofs()];
    let mut rows = Vec::with_capacity(trajectory.samples().len());
    for sample in trajectory.samples() {
        let phase = trajectory.phase_of(sample)?;
        let view = View::of_sample((scene, &gauges), phase, sample);
        let view = View { accelerations: &at_rest, ..view };
        rows.push(sensors.read(&view, sample, &angles));
        sensors.follow(&view, &mut angles);
    }
    trajectory.add_columns(sensors.quantities, rows)
}

//! Commands: what a program changes while a scene is in motion.

use super::renewal::Change;
use super::simulation::Simulation;
use crate::constraint::{Axes, Axis, Constrained, Constraint, Motion};
use crate::error::Error;
use crate::external::{Obstacle, Signal, VectorSignal};
use crate::input::InputError;
use crate::mesh::Selection;
use crate::scene::{Load, Phase, Scene, find};

/// Commands. Each takes effect at the present time and stays in force until another one replaces it or the
/// phase ends: the next phase of the scene begins as the scene has it.
///
/// Commands that change forces alone keep matrices and orderings. `rk` and `arkode` go on with the step size they
/// had; `cvode-bdf`, `cvode-adams` and the IDA methods begin anew with small steps of order 1. So
/// [`Method::Auto`](crate::Method::Auto) goes on with `arkode` from the fourth such command of a phase on. (With
/// the history of BDF kept over 400 commands, a beam was fifty times less accurate at rtol 1e-6.)
impl Simulation {
    /// Pressure (Pa) in a chamber, in place of the present one.
    ///
    /// # Errors
    /// A name that no chamber has; numbers that are not finite.
    pub fn pressure(&mut self, chamber: &str, pressure: impl Into<Signal>) -> Result<(), Error> {
        let pressure = pressure.into();
        self.command(Change::Loads, |phase, scene| {
            scene.chamber_number(chamber, "pressure of chamber")?;
            phase.set_pressure(chamber, pressure);
            Ok(())
        })
    }

    /// Force (N) of the actuator of a spring, in place of the present one; a positive one extends it.
    ///
    /// # Errors
    /// A name that no spring has; numbers that are not finite.
    pub fn actuate(&mut self, spring: &str, force: impl Into<Signal>) -> Result<(), Error> {
        let force = force.into();
        self.command(Change::Loads, |phase, scene| {
            scene.spring_number(spring, "actuation of spring")?;
            phase.set_actuation(spring, force);
            Ok(())
        })
    }

    /// The pressure (Pa) in a chamber that is in force at the present time.
    ///
    /// # Errors
    /// A name that no chamber has.
    pub fn pressure_in(&self, chamber: &str) -> Result<f64, InputError> {
        self.scene().chamber_number(chamber, "pressure of chamber")?;
        let pressures = self.run.phase.pressures.iter().filter(|(name, _)| name == chamber);
        Ok(pressures.map(|(_, pressure)| pressure.at(self.time)).sum())
    }

    /// The force (N) of the actuator of a spring that is in force at the present time.
    ///
    /// # Errors
    /// A name that no spring has.
    pub fn actuation_of(&self, spring: &str) -> Result<f64, InputError> {
        let number = self.scene().spring_number(spring, "actuation of spring")?;
        Ok(self.scene().actuations(&self.run.phase, self.time)?[number])
    }

    /// A force (N) on each of the nodes, one component per dimension, in place of the load that was given for
    /// the same selection.
    ///
    /// # Errors
    /// Nodes that do not exist, a wrong number of components, numbers that are not finite.
    pub fn load(
        &mut self,
        nodes: impl Into<Selection>,
        force: impl Into<Vec<f64>>,
    ) -> Result<(), Error> {
        self.set_load(nodes.into(), Load::Each(force.into()))
    }

    /// As [`load`](Self::load), with a force (N) that changes with time (s).
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn load_with<const D: usize>(
        &mut self,
        nodes: impl Into<Selection>,
        force: impl Fn(f64) -> [f64; D] + Send + Sync + 'static,
    ) -> Result<(), Error> {
        self.set_load(nodes.into(), Load::Varying(VectorSignal::function(force)))
    }

    /// Holds nodes, in all components, where they are.
    ///
    /// # Errors
    /// Nodes that do not exist.
    pub fn hold(&mut self, nodes: impl Into<Selection>) -> Result<(), Error> {
        self.constrain(nodes.into(), Axes::All, Motion::Hold)
    }

    /// As [`hold`](Self::hold), for some components only; the others are free.
    ///
    /// # Errors
    /// Nodes or axes that do not exist.
    pub fn hold_axes(
        &mut self,
        nodes: impl Into<Selection>,
        axes: impl IntoIterator<Item = Axis>,
    ) -> Result<(), Error> {
        self.constrain(nodes.into(), Axes::These(axes.into_iter().collect()), Motion::Hold)
    }

    /// Moves nodes on from where they are with a constant `velocity` (m/s), one component per dimension.
    ///
    /// # Errors
    /// Nodes that do not exist, a velocity of the wrong length, numbers that are not finite.
    pub fn move_nodes(
        &mut self,
        nodes: impl Into<Selection>,
        velocity: impl Into<Vec<f64>>,
    ) -> Result<(), Error> {
        self.constrain(nodes.into(), Axes::All, Motion::Velocity(velocity.into()))
    }

    /// Frees nodes that are held or moved; linear combinations of several nodes stay.
    ///
    /// # Errors
    /// Nodes that do not exist, or none of which is held or moved.
    pub fn release(&mut self, nodes: impl Into<Selection>) -> Result<(), Error> {
        let nodes = nodes.into();
        self.command(Change::Constraints, |phase, scene| {
            let mesh = scene.body().mesh();
            if phase.release(mesh, &mesh.select(&nodes)?)? {
                return Ok(());
            }
            let mend = "none of these nodes is held or moved";
            Err(InputError::new("nodes to release", nodes, mend))
        })
    }

    /// Lets an obstacle act, or not.
    ///
    /// # Errors
    /// A name that no obstacle has.
    pub fn contact(&mut self, obstacle: &str, acts: bool) -> Result<(), Error> {
        self.command(Change::Contacts, |phase, scene| {
            let known: Vec<&str> = scene.obstacles().iter().map(Obstacle::name).collect();
            find(obstacle, &known, "contact with obstacle", "obstacles")?;
            phase.set_contact(obstacle, acts, &known);
            Ok(())
        })
    }

    fn set_load(&mut self, nodes: Selection, load: Load) -> Result<(), Error> {
        self.command(Change::Loads, |phase, _| {
            phase.set_load(nodes, load);
            Ok(())
        })
    }

    fn constrain(&mut self, nodes: Selection, axes: Axes, how: Motion) -> Result<(), Error> {
        self.command(Change::Constraints, |phase, scene| {
            let mesh = scene.body().mesh();
            phase.release(mesh, &mesh.select(&nodes)?)?;
            phase.constraints.push(Constraint { what: Constrained::Nodes(nodes, axes), how });
            Ok(())
        })
    }

    /// Gives a command: an `edit` of the phase in force.
    fn command(
        &mut self,
        change: Change,
        edit: impl FnOnce(&mut Phase, &Scene) -> Result<(), InputError>,
    ) -> Result<(), Error> {
        if self.run.time <= self.time {
            self.run.leave_phase()?;
        }
        let mut phase = (*self.run.phase).clone();
        edit(&mut phase, &self.run.scene)?;
        if self.run.time > self.time {
            self.run.set_state(self.time, &self.now)?;
        }
        self.run.change(phase, change)?;
        self.now.copy_from_slice(&self.run.state);
        self.commanded = true;
        Ok(())
    }
}

//! Commands: changes by a program while a scene is in motion.

use super::changes::Change;
use super::simulation::Simulation;
use crate::base::input::{InputError, finite};
use crate::dynamics::error::Error;
use crate::elements::mesh::Selection;
use crate::scene::constraint::{Axes, Axis, Constrained, Constraint, Motion};
use crate::scene::forces::{
    Drive, SharedValue, Signal, Signals, TimeTable, VectorSignal, WrenchKind,
};
use crate::scene::timeline::{DeviceValue, Input, LoadKind, Phase, Quantity, Scene, Target};

/// Commands. Each takes effect at the present time and stays in force until another one replaces it or the
/// phase ends: the next phase begins as the scene defines it. At the end of the scene, where nothing is left
/// for them to act on, all of them return errors.
///
/// Commands that change forces alone keep matrices and orderings. `rk` and `arkode` continue with the step
/// size they had; `cvode-bdf`, `cvode-adams` and the IDA methods restart with small steps of order 1.
/// Therefore [`Method::Auto`](crate::Method::Auto) continues with `arkode` from the fourth such command of a
/// phase on. (With the history of BDF kept over 400 commands, a beam was fifty times less accurate at rtol
/// 1e-6.)
impl Simulation {
    /// Sets the pressure (Pa) in a chamber, in place of the present one.
    ///
    /// # Errors
    /// A name that no chamber has; numbers that are not finite.
    pub fn pressure(&mut self, chamber: &str, pressure: impl Into<Signal>) -> Result<(), Error> {
        self.scene().chamber_number(chamber, "pressure of chamber")?;
        self.set_named(Quantity::Pressure, chamber, pressure.into())
    }

    /// Sets the opening of an orifice, from 0 (shut) to 1, in place of the present one.
    ///
    /// # Errors
    /// A name that no orifice has; a number that is not from 0 to 1.
    pub fn open(&mut self, orifice: &str, opening: impl Into<Signal>) -> Result<(), Error> {
        let (opening, input) = (opening.into(), "opening of orifice");
        self.scene().orifice_number(orifice, input)?;
        if let Some(value) = opening.value().filter(|value| !(0.0..=1.0).contains(value)) {
            return Err(InputError::new(input, value, "it must be from 0 (shut) to 1").into());
        }
        self.set_named(Quantity::Opening, orifice, opening)
    }

    /// Sets the flow (m^3/s) of liquid into a chamber, in place of the present one; negative for outflow.
    ///
    /// # Errors
    /// A name that no chamber with a liquid has; numbers that are not finite; a method without unknowns for amounts (`central-difference`).
    pub fn flow(&mut self, chamber: &str, flow: impl Into<Signal>) -> Result<(), Error> {
        self.scene().liquid_number(chamber, "flow into chamber")?;
        self.set_named(Quantity::Flow, chamber, flow.into())
    }

    /// Sets the force (N) of the actuator of a spring, in place of the present one; a positive one extends
    /// the spring. For a [cable](crate::Spring::cable) it is the tension, for one on a winch the length (m) that is drawn in; for a
    /// [muscle](crate::Muscle) the active stress (Pa), for a [growth](crate::Growth) the strain (1).
    ///
    /// # Errors
    /// A name that no spring, no muscle and no growth has; numbers that are not finite; a stress outside of the range of [Hill's law](crate::Hill) of a
    /// muscle.
    pub fn actuate(&mut self, spring: &str, force: impl Into<Signal>) -> Result<(), Error> {
        let force = force.into();
        let number = self.scene().actuator_number(spring, "actuation")?;
        force.value().map_or(Ok(()), |value| self.scene().actuators()[number].check(value))?;
        self.set_named(Quantity::Actuation, spring, force)
    }

    /// Sets a force (N) on each of the nodes, one component per dimension, in place of the load given for the
    /// same selection.
    ///
    /// # Errors
    /// Nodes that do not exist, a wrong number of components, numbers that are not finite.
    pub fn load(
        &mut self,
        nodes: impl Into<Selection>,
        force: impl Into<Vec<f64>>,
    ) -> Result<(), Error> {
        self.set_load(nodes.into(), VectorSignal::Constant(force.into()))
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
        self.set_load(nodes.into(), VectorSignal::function(force))
    }

    /// As [`load`](Self::load), with a force (N) that has the values `forces`, one component per dimension, at the
    /// `times` (s, ascending). In between it is interpolated linearly; before and after it is constant.
    ///
    /// # Errors
    /// As [`load`](Self::load); times that do not ascend, or are not as many as the forces.
    pub fn load_table(
        &mut self,
        nodes: impl Into<Selection>,
        times: impl Into<Vec<f64>>,
        forces: impl IntoIterator<Item: Into<Vec<f64>>>,
    ) -> Result<(), Error> {
        let table = TimeTable::new(times.into(), forces.into_iter().map(Into::into).collect());
        self.set_load(nodes.into(), VectorSignal::TimeTable(table))
    }

    /// Sets the magnetic field (T) that acts on magnets, one component per dimension, in place of the present one; its gradient does not change.
    ///
    /// # Errors
    /// A scene without magnets, a wrong number of components, numbers that are not finite.
    pub fn magnetic_field(&mut self, field: impl Into<Vec<f64>>) -> Result<(), Error> {
        let field = VectorSignal::Constant(field.into());
        self.set(Input::new(Quantity::Field, Target::Everything, field))
    }

    /// Sets an input of a [device](crate::Device), by the name of the device and the word of the input, in place of the present value.
    ///
    /// # Errors
    /// A name that no device has, a word that none of its inputs has, a value of another rank, numbers that are not finite.
    pub fn device_input(
        &mut self,
        device: &str,
        word: &str,
        value: impl Into<DeviceValue>,
    ) -> Result<(), Error> {
        let input = self.scene().device_input(device, word, value.into())?;
        self.set(input)
    }

    /// Sets a [moment](Phase::moment) (N m) on nodes, in place of the one given for the same selection.
    ///
    /// # Errors
    /// Nodes that do not exist or do not turn, a wrong number of components, numbers that are not finite.
    pub fn moment(
        &mut self,
        nodes: impl Into<Selection>,
        moment: impl Into<Signals>,
    ) -> Result<(), Error> {
        self.set_wrench(nodes.into(), WrenchKind::Moment, moment.into())
    }

    /// Sets a [force that follows nodes](Phase::follower_force) (N), likewise.
    ///
    /// # Errors
    /// As [`moment`](Self::moment).
    pub fn follower_force(
        &mut self,
        nodes: impl Into<Selection>,
        force: impl Into<Signals>,
    ) -> Result<(), Error> {
        self.set_wrench(nodes.into(), WrenchKind::FollowerForce, force.into())
    }

    /// Sets a [moment that follows nodes](Phase::follower_moment) (N m), likewise.
    ///
    /// # Errors
    /// As [`moment`](Self::moment).
    pub fn follower_moment(
        &mut self,
        nodes: impl Into<Selection>,
        moment: impl Into<Signals>,
    ) -> Result<(), Error> {
        self.set_wrench(nodes.into(), WrenchKind::FollowerMoment, moment.into())
    }

    fn set_wrench(
        &mut self,
        nodes: Selection,
        kind: WrenchKind,
        value: Signals,
    ) -> Result<(), Error> {
        self.set(Input::new(Quantity::Wrench(kind), Target::Nodes(nodes), value.0))
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
            let help = "none of these nodes is held or moved";
            Err(InputError::new("nodes to release", nodes, help))
        })
    }

    /// Lets an obstacle act, or not.
    ///
    /// # Errors
    /// A name that no obstacle has.
    pub fn contact(&mut self, obstacle: &str, acts: bool) -> Result<(), Error> {
        self.command(Change::Stores, |phase, scene| {
            scene.obstacle_number(obstacle, "contact with obstacle")?;
            phase.set_contact(obstacle, acts, scene.obstacles());
            Ok(())
        })
    }

    /// Lets an obstacle move on from where it is with a constant `velocity` (m/s), one component per dimension.
    ///
    /// In the next phase it also moves on from where it is, with the velocity that the scene gives it.
    ///
    /// # Errors
    /// A name that no obstacle has, a velocity of the wrong length, numbers that are not finite.
    pub fn move_obstacle(
        &mut self,
        obstacle: &str,
        velocity: impl Into<Vec<f64>>,
    ) -> Result<(), Error> {
        let (velocity, time) = (velocity.into(), self.time);
        self.command(Change::Stores, |phase, scene| {
            let number = scene.obstacle_number(obstacle, "velocity of obstacle")?;
            let obstacle = &scene.obstacles()[number];
            phase.redirect(obstacle, time, velocity);
            phase.moving(obstacle).validated(scene.body().dimension()).map(|_| ())
        })
    }

    /// Sets an input, in place of the present ones of its quantity on its target.
    pub(crate) fn set(&mut self, input: Input) -> Result<(), Error> {
        let Input { quantity, target, signal } = input;
        // a strain is a part of the energy of its cells
        let strains = |name: &String| {
            let actuator = self.scene().actuator_named(name);
            actuator.is_some_and(|own| own.kind().drive == Drive::Strain)
        };
        if quantity == Quantity::Actuation && target.names().iter().any(strains) {
            return self.command(Change::Stores, |phase, _| {
                phase.set(Input { quantity, target, signal });
                Ok(())
            });
        }
        if let Some(values) = signal.constant()
            && self.set_live(|phase| phase.live(quantity, &target).cloned(), quantity, values)?
        {
            return Ok(());
        }
        self.command(Change::Loads, |phase, _| {
            phase.set(Input { quantity, target, signal: signal.settable() });
            Ok(())
        })
    }

    /// The same for a component with a name, without allocations where a number takes the place of another one.
    fn set_named(&mut self, quantity: Quantity, name: &str, signal: Signal) -> Result<(), Error> {
        let shared = |phase: &Phase| phase.shared_of(quantity, name).cloned();
        if let Some(value) = signal.value()
            && self.set_live(shared, quantity, &[value])?
        {
            return Ok(());
        }
        self.set(Input::new(quantity, Target::one(name), signal))
    }

    fn set_load(&mut self, nodes: Selection, force: VectorSignal) -> Result<(), Error> {
        self.set(Input::load(nodes, LoadKind::Each, force))
    }

    /// Sets the numbers that `find` finds in the phase in force; `false` if there are none that a command can
    /// set. (The forces read them: nothing is rebuilt.)
    fn set_live(
        &mut self,
        find: impl Fn(&Phase) -> Option<SharedValue>,
        quantity: Quantity,
        values: &[f64],
    ) -> Result<bool, Error> {
        if self.run.is_past_phase(self.time) {
            return Ok(false);
        }
        let live = find(&self.run.phase).filter(|live| live.len() == values.len());
        let Some(live) = live else { return Ok(false) };
        self.check_goes_on()?;
        finite(quantity.row().name, values)?;
        if self.run.time > self.time {
            self.run.set_state(self.time, &self.now)?;
        }
        self.run.set_live(&live, values)?;
        self.now.copy_from_slice(&self.run.state);
        self.commanded = true;
        Ok(true)
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
        self.check_goes_on()?;
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

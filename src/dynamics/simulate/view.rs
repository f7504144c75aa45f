//! Quantities that can be read from a simulation at one time.

use std::fmt;
use std::sync::Arc;

use crate::base::input::InputError;
use crate::dynamics::trajectory::Sample;
use crate::elements::body::{Body, CellField, Grown};
use crate::elements::force::{Force, Forces, NodalForces};
use crate::elements::mesh::Selection;
use crate::scene::forces::{
    ActuatorGauge, ActuatorState, ChamberForce, Contact, GasInChamber, LiquidInChamber,
};
use crate::scene::timeline::{Amounts, DeviceGauge, LoadKind, Phase, Quantity, Scene};
#[cfg(feature = "play")]
use crate::scene::{forces::NodalContact, timeline::ContactReader};

/// The motion of a [`Simulation`](super::Simulation) or at a [sample](crate::Sampling::sensor), without copies.
pub struct View<'a> {
    pub(super) scene: &'a Scene,
    pub(super) phase: &'a Phase,
    pub(super) gauges: &'a Gauges,
    pub(super) time: f64,
    /// Displacements (m) and velocities (m/s), and the amounts of the scene; none of these where they are constants.
    pub(super) u: &'a [f64],
    pub(super) v: &'a [f64],
    pub(super) amounts: &'a [f64],
    /// Accelerations (m/s^2) where a sensor reads them, or else none.
    pub(super) accelerations: &'a [f64],
}

/// The forces and functions by which components are measured, in the order of the scene.
pub(super) struct Gauges {
    pub(super) chambers: Vec<Arc<ChamberForce>>,
    /// The functions that read the outputs of each actuator.
    pub(super) actuators: Vec<ActuatorGauge>,
    pub(super) gases: Vec<GasInChamber>,
    pub(super) liquids: Vec<LiquidInChamber>,
    /// Their masses at the start (kg), of gases and then of liquids.
    masses: Vec<f64>,
    /// By which the positions of nodes make the magnetic moment (A m); empty without magnets.
    poles: Vec<f64>,
    /// The functions that read the outputs of each device.
    pub(super) devices: Vec<Vec<DeviceGauge>>,
}

impl Gauges {
    pub(super) fn new(scene: &Scene) -> Result<Self, InputError> {
        let body = scene.body();
        let chambers = scene.chambers().iter();
        let chambers = chambers.map(|chamber| chamber.force(body, Vec::new()).map(Arc::new));
        let actuators = scene.actuators().iter().map(|actuator| actuator.gauge(body));
        let (gases, liquids) = (scene.filled()?, scene.poured(None)?);
        Ok(Self {
            chambers: chambers.collect::<Result<_, _>>()?,
            actuators: actuators.collect::<Result<_, _>>()?,
            masses: scene.starting_masses(&gases, &liquids),
            gases,
            liquids,
            poles: scene.magnetization()?.map_or_else(Vec::new, |magnets| magnets.poles),
            devices: scene.device_gauges()?,
        })
    }

    /// The forces of all chambers, without pressure.
    pub(super) fn chambers(&self) -> Forces {
        let mut forces = Forces::new();
        for chamber in &self.chambers {
            forces.push(chamber.clone());
        }
        forces
    }
}

/// Short: its time and phase.
impl fmt::Debug for View<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("View")
            .field("time", &self.time)
            .field("phase", &self.phase.name)
            .finish_non_exhaustive()
    }
}

impl<'a> View<'a> {
    /// The motion at a `sample`, in a phase of the scene.
    pub(super) fn of_sample(
        (scene, gauges): (&'a Scene, &'a Gauges),
        phase: &'a Phase,
        sample: &'a Sample,
    ) -> Self {
        let Sample { time, u, v, amounts, .. } = sample;
        View { scene, phase, gauges, time: *time, u, v, amounts, accelerations: &[] }
    }

    /// Time (s).
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The body.
    pub fn body(&self) -> &'a Body {
        self.scene.body()
    }

    /// Displacements (m), dimension components per node.
    pub fn displacements(&self) -> &'a [f64] {
        self.u
    }

    /// Velocities (m/s), dimension components per node.
    pub fn velocities(&self) -> &'a [f64] {
        self.v
    }

    /// Mean position (m) of the nodes of `selection`, one component per dimension.
    ///
    /// # Errors
    /// An unknown set, a number out of range, a selection without nodes.
    pub fn position(&self, selection: impl Into<Selection>) -> Result<Vec<f64>, InputError> {
        let selection = selection.into();
        let natural = self.mean(&selection, self.body().mesh().positions())?;
        let moved = self.mean(&selection, self.u)?;
        Ok(natural.iter().zip(moved).map(|(x, u)| x + u).collect())
    }

    /// Mean velocity (m/s) of the nodes of `selection`.
    ///
    /// # Errors
    /// As [`position`](Self::position).
    pub fn velocity(&self, selection: impl Into<Selection>) -> Result<Vec<f64>, InputError> {
        self.mean(&selection.into(), self.v)
    }

    /// Centre of mass (m).
    pub fn centre_of_mass(&self) -> Vec<f64> {
        self.body().centre_of_mass(self.u)
    }

    /// Velocity of the centre of mass (m/s).
    pub fn mean_velocity(&self) -> Vec<f64> {
        self.body().mass_average(self.v)
    }

    /// Opening of an orifice.
    ///
    /// # Errors
    /// A name that no orifice has.
    pub fn opening(&self, orifice: &str) -> Result<f64, InputError> {
        self.scene.orifice_number(orifice, "orifice")?;
        Ok(self.input(Quantity::Opening, orifice))
    }

    /// An input of one component, of a component of the scene.
    pub(super) fn input(&self, quantity: Quantity, name: &str) -> f64 {
        let signals = self.phase.signals_of(quantity, name).map(|signal| signal.at(self.time));
        signals.reduce(|sum, more| sum + more).unwrap_or(quantity.row().absent)
    }

    /// Calls `see` with the scene, the phase, displacements and velocities, and the amounts.
    #[cfg(feature = "play")]
    pub(crate) fn with_states<R>(
        &self,
        see: impl FnOnce(&Scene, &Phase, [&[f64]; 2], &[f64]) -> R,
    ) -> R {
        see(self.scene, self.phase, [self.u, self.v], self.amounts)
    }

    /// The liquid of that number, which has a surface, under the gravity of the phase.
    pub(super) fn with_surface(&self, number: usize) -> Result<LiquidInChamber, InputError> {
        self.scene.poured_in(Some(self.phase), &self.scene.liquids()[number])
    }

    /// Masses (kg) of the gases and of the liquids; where they are no unknowns, they stay what they are.
    fn masses(&self) -> [&[f64]; 2] {
        match self.scene.flowing(self.amounts) {
            Some(Amounts { gases, liquids, .. }) => [gases, liquids],
            None => self.gauges.masses.split_at(self.gauges.gases.len()).into(),
        }
    }

    /// The mass (kg) of the gas of that number.
    pub(super) fn gas_mass(&self, number: usize) -> f64 {
        self.masses()[0][number]
    }

    /// The mass (kg) of the liquid of that number.
    pub(super) fn liquid_mass(&self, number: usize) -> f64 {
        self.masses()[1][number]
    }

    /// Force of the actuator of a spring (N), above 0 where it extends the spring; of a cable its tension, of a winch the
    /// length (m) that it has drawn in, of a muscle its stress (Pa), of a
    /// growth its strain (1). With a [lag](crate::Lag) it is behind its [command](Self::command).
    ///
    /// # Errors
    /// A name that no spring, no muscle and no growth has.
    pub fn actuation(&self, spring: &str) -> Result<f64, InputError> {
        Ok(self.drive(self.scene.actuator_number(spring, "spring")?)[0])
    }

    /// Command of an actuator by phases and commands (see [`Phase::actuate`]): a power (W) if it is
    /// [heated](crate::Lag::heated), else as [`actuation`](Self::actuation).
    ///
    /// # Errors
    /// As [`actuation`](Self::actuation).
    pub fn command(&self, actuator: &str) -> Result<f64, InputError> {
        self.scene.actuator_number(actuator, "actuator")?;
        Ok(self.phase.command(actuator, self.time)[0])
    }

    /// Input of the actuator of that number, and its rate.
    pub(super) fn drive(&self, actuator: usize) -> [f64; 2] {
        let actuator = &*self.scene.actuators()[actuator];
        self.scene.drive_at(actuator, self.phase, self.time, self.amounts)
    }

    /// An output of an actuator, both by number.
    pub(super) fn actuator_value(&self, actuator: usize, output: usize) -> f64 {
        let state = ActuatorState { u: self.u, v: self.v, drive: self.drive(actuator) };
        (self.gauges.actuators[actuator])(output, &state)
    }

    /// Force (N) on each of the nodes of `selection`, as the mean over them, one component per dimension.
    ///
    /// Only loads given for exactly this selection count; 0 without one.
    ///
    /// # Errors
    /// Nodes that do not exist.
    pub fn load(&self, selection: impl Into<Selection>) -> Result<Vec<f64>, InputError> {
        self.load_of(&selection.into(), LoadKind::Each)
    }

    /// The same as a load of another `kind`.
    pub(crate) fn load_of(
        &self,
        selection: &Selection,
        kind: LoadKind,
    ) -> Result<Vec<f64>, InputError> {
        self.scene.load_on(self.phase, selection, kind, self.time)
    }

    /// Force (N) of an obstacle on the body, one component per dimension; 0 where it does not act.
    ///
    /// # Errors
    /// A name that no obstacle has; a distance function of your own that is undefined there.
    pub fn contact_force(&self, obstacle: &str) -> Result<Vec<f64>, InputError> {
        let (forces, d) = (self.contact_forces(obstacle)?, self.body().dimension());
        let along = |axis| forces.iter().skip(axis).step_by(d).sum();
        Ok((0..d).map(along).collect())
    }

    /// The part of the contact force on the nodes of `selection` (N).
    ///
    /// A stiffness per area acts between the nodes: its forces are distributed to them.
    ///
    /// # Errors
    /// As [`contact_force`](Self::contact_force) and [`position`](Self::position).
    pub fn contact_force_on(
        &self,
        obstacle: &str,
        selection: impl Into<Selection>,
    ) -> Result<Vec<f64>, InputError> {
        let nodes = self.body().mesh().select(&selection.into())?;
        let (forces, d) = (self.contact_forces(obstacle)?, self.body().dimension());
        let along = |axis| nodes.iter().map(|node| forces[node * d + axis]).sum();
        Ok((0..d).map(along).collect())
    }

    /// Force (N) of a fluid on the bodies, drag and pressure, one component per dimension.
    ///
    /// # Errors
    /// A name that no fluid has.
    pub fn fluid_force(&self, fluid: &str) -> Result<Vec<f64>, InputError> {
        let force = self.scene.fluid_force(fluid, self.phase, "fluid")?;
        let sum = force.on(self.time, self.u, self.v, None);
        Ok(sum[..self.body().dimension()].to_vec())
    }

    /// Nodal contact quantities; `None` where they are undefined.
    #[cfg(feature = "play")]
    pub(crate) fn nodal_contacts(&self, reader: &ContactReader) -> Option<Vec<NodalContact>> {
        let obstacles = self.scene.contacts(self.phase).ok()?;
        reader.read((self.phase, &obstacles), self.time, [self.u, self.v]).ok()
    }

    /// The forces of an obstacle (N) on all nodes, dimension components each.
    fn contact_forces(&self, obstacle: &str) -> Result<Vec<f64>, InputError> {
        self.scene.obstacle_number(obstacle, "obstacle")?;
        let (body, u, v) = (self.body(), self.u, self.v);
        let mut nodal = NodalForces::zeros(body.dofs());
        for acting in self.phase.contacts(self.scene.obstacles())? {
            if acting.name() == obstacle {
                let added = Contact::new(body, acting)?.add_forces(self.time, u, v, &mut nodal);
                added.map_err(|failure| {
                    let reason = failure.into_error().to_string();
                    InputError::new("obstacle", format!("\"{obstacle}\""), reason)
                })?;
            }
        }
        let mut forces = vec![0.0; body.dofs()];
        nodal.add_up(&mut forces);
        Ok(forces)
    }

    /// Angle (rad, counter-clockwise, between -pi and pi) by which a two-dimensional body has turned as a
    /// whole.
    ///
    /// It is that of the rotation that brings the undeformed shape nearest to the present one, weighted by
    /// mass. `None` in other dimensions. The sensor
    /// [`Reading::rotation`](crate::dynamics::simulate::Reading::rotation) is continuous over whole turns.
    pub fn rotation(&self) -> Option<f64> {
        self.body().rotation(self.u)
    }

    /// Magnetic moment (A m^2) of all magnets, one component per dimension.
    pub fn magnetic_moment(&self) -> Vec<f64> {
        let d = self.body().dimension();
        let mut moment = vec![0.0; d];
        let places = self.body().mesh().positions().chunks_exact(d).zip(self.u.chunks_exact(d));
        for ((x, u), pole) in places.zip(&self.gauges.poles) {
            for (axis, moment) in moment.iter_mut().enumerate() {
                *moment += pole * (x[axis] + u[axis]);
            }
        }
        moment
    }

    /// The uniform part of the magnetic field (T) that acts on magnets, one component per dimension.
    pub fn magnetic_field(&self) -> Vec<f64> {
        self.phase.magnetic_field_at(self.time, self.body().dimension())
    }

    /// Strain, stress and strain energy density of each cell.
    pub fn cell_fields(&self) -> Vec<CellField> {
        self.body().cell_fields_of(self.u, &self.grown())
    }

    /// The cells that have grown.
    pub(super) fn grown(&self) -> Vec<Grown> {
        // errors were found when the phase began
        self.scene.grown(self.phase, self.time, self.amounts).unwrap_or_default()
    }

    fn mean(&self, selection: &Selection, x: &[f64]) -> Result<Vec<f64>, InputError> {
        let nodes = self.body().mesh().select(selection)?;
        let dimension = self.body().dimension();
        Ok(mean(&nodes, x, dimension)[..dimension].to_vec())
    }
}

/// Mean of `x`, `dimension` components per node, over `nodes` (counted from 0); 0 beyond the dimension.
pub(super) fn mean(nodes: &[usize], x: &[f64], dimension: usize) -> [f64; 3] {
    let sum = |axis| nodes.iter().map(|node| x[node * dimension + axis]).sum::<f64>();
    std::array::from_fn(|axis| match axis < dimension {
        true => sum(axis) / nodes.len() as f64,
        false => 0.0,
    })
}

//! Quantities that can be read from a simulation at one time.

use std::fmt;
use std::sync::Arc;

use crate::base::input::InputError;
use crate::dynamics::state::State;
use crate::elements::body::{Body, CellField, Contraction, Grown, MagnetizedPoints, Strands};
use crate::elements::force::{Force, Forces, NodalForces};
use crate::elements::mesh::Selection;
use crate::scene::forces::{ChamberForce, Contact, Content, Filled, Poured, SpringGauge};
use crate::scene::timeline::{LoadKind, Phase, Quantity, Scene, Target};
#[cfg(feature = "play")]
use crate::scene::{forces::NodalContact, timeline::ContactReader};

/// The motion of a [`Simulation`](super::Simulation) or at a [sample](crate::Sampling::sensor), without copies.
pub struct View<'a> {
    pub(super) scene: &'a Scene,
    pub(super) phase: &'a Phase,
    pub(super) gauges: &'a Gauges,
    pub(super) time: f64,
    pub(super) state: State<'a>,
    /// Accelerations (m/s^2) where a sensor reads them, or else none.
    pub(super) accelerations: &'a [f64],
}

/// The forces by which chambers, springs and muscles are measured, in the order of the scene.
pub(super) struct Gauges {
    chambers: Vec<Arc<ChamberForce>>,
    springs: Vec<SpringGauge>,
    gases: Vec<Filled>,
    liquids: Vec<Poured>,
    /// Their masses at the start (kg), of gases and then of liquids.
    masses: Vec<f64>,
    muscles: Vec<Strands>,
    /// By which the positions of nodes make the magnetic moment (A m); empty without magnets.
    poles: Vec<f64>,
    /// On which dipoles act; empty without dipoles.
    pub(super) magnetized: Arc<[Box<dyn MagnetizedPoints>]>,
}

impl Gauges {
    pub(super) fn new(scene: &Scene) -> Result<Self, InputError> {
        let body = scene.body();
        let chambers = scene.chambers().iter();
        let chambers = chambers.map(|chamber| chamber.force(body, Vec::new()).map(Arc::new));
        let springs = scene.springs().iter().map(|spring| spring.gauge(body.mesh()));
        let muscles = scene.muscles().iter().map(|muscle| muscle.strands(body));
        let (gases, liquids) = (scene.filled()?, scene.poured(None)?);
        Ok(Self {
            chambers: chambers.collect::<Result<_, _>>()?,
            springs: springs.collect::<Result<_, _>>()?,
            masses: scene.starting_masses(&gases, &liquids),
            gases,
            liquids,
            muscles: muscles.collect::<Result<_, _>>()?,
            poles: scene.magnetization()?.map_or_else(Vec::new, |magnets| magnets.poles),
            magnetized: scene.magnetized_points()?,
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
        self.state.u
    }

    /// Velocities (m/s), dimension components per node.
    pub fn velocities(&self) -> &'a [f64] {
        self.state.v
    }

    /// Mean position (m) of the nodes of `selection`, one component per dimension.
    ///
    /// # Errors
    /// An unknown set, a number out of range, a selection without nodes.
    pub fn position(&self, selection: impl Into<Selection>) -> Result<Vec<f64>, InputError> {
        let selection = selection.into();
        let natural = self.mean(&selection, self.body().mesh().positions())?;
        let moved = self.mean(&selection, self.state.u)?;
        Ok(natural.iter().zip(moved).map(|(x, u)| x + u).collect())
    }

    /// Mean velocity (m/s) of the nodes of `selection`.
    ///
    /// # Errors
    /// As [`position`](Self::position).
    pub fn velocity(&self, selection: impl Into<Selection>) -> Result<Vec<f64>, InputError> {
        self.mean(&selection.into(), self.state.v)
    }

    /// Centre of mass (m).
    pub fn centre_of_mass(&self) -> Vec<f64> {
        self.body().centre_of_mass(self.state.u)
    }

    /// Velocity of the centre of mass (m/s).
    pub fn mean_velocity(&self) -> Vec<f64> {
        self.body().mass_average(self.state.v)
    }

    /// Volume that the walls of a chamber enclose (m^3).
    ///
    /// # Errors
    /// A name that no chamber has.
    pub fn chamber_volume(&self, chamber: &str) -> Result<f64, InputError> {
        let number = self.scene.chamber_number(chamber, "chamber")?;
        Ok(self.gauges.chambers[number].volume(self.state.u))
    }

    /// Pressure in a chamber (Pa): of gas and of a liquid what it exceeds that outside by, NaN where it has none; of a liquid with weight the mean,
    /// of one with a surface that at the lowest place of the walls.
    ///
    /// # Errors
    /// A name that no chamber has.
    pub fn pressure(&self, chamber: &str) -> Result<f64, InputError> {
        self.scene.chamber_number(chamber, "chamber")?;
        if let Some(number) = self.scene.gas_in(chamber) {
            let gas = &self.gauges.gases[number];
            return Ok(gas.gauge(self.state.u, self.amount(number)).unwrap_or(f64::NAN));
        }
        if let Some(number) = self.scene.liquid_in(chamber) {
            let amount = self.liquid_amount(number);
            let pressure = match self.scene.liquids()[number].has_surface() {
                true => self.with_surface(number)?.gauge(self.state.u, amount),
                false => self.gauges.liquids[number].gauge(self.state.u, amount),
            };
            return Ok(pressure.unwrap_or(f64::NAN));
        }
        Ok(self.input(Quantity::Pressure, chamber))
    }

    /// Absolute pressure (Pa) of the gas in a chamber.
    ///
    /// # Errors
    /// A name that no chamber has, or one without gas.
    pub fn absolute_pressure(&self, chamber: &str) -> Result<f64, InputError> {
        Ok(self.gas_pressure(self.scene.gas_number(chamber, "chamber")?))
    }

    /// Amount of gas (kg) in a chamber.
    ///
    /// # Errors
    /// As [`absolute_pressure`](Self::absolute_pressure).
    pub fn gas_amount(&self, chamber: &str) -> Result<f64, InputError> {
        Ok(self.amount(self.scene.gas_number(chamber, "chamber")?))
    }

    /// Flow (kg/s) through an orifice, from its first end to its second.
    ///
    /// # Errors
    /// A name that no orifice has; a supply or an opening out of range.
    pub fn gas_flow(&self, orifice: &str) -> Result<f64, InputError> {
        let number = self.scene.orifice_number(orifice, "orifice")?;
        let flow = self.scene.orifice_flow(number, self.phase)?;
        let gases = &self.gauges.gases;
        let pressures: Vec<f64> = (0..gases.len()).map(|gas| self.gas_pressure(gas)).collect();
        let rate = flow.rate(self.time, gases, &pressures);
        let [rate, ..] = rate.map_err(|failure| {
            InputError::new("orifice", format!("\"{orifice}\""), failure.into_error().to_string())
        })?;
        Ok(rate)
    }

    /// How far an orifice is open.
    ///
    /// # Errors
    /// A name that no orifice has.
    pub fn opening(&self, orifice: &str) -> Result<f64, InputError> {
        self.scene.orifice_number(orifice, "orifice")?;
        Ok(self.input(Quantity::Opening, orifice))
    }

    /// Natural volume (m^3) of the liquid in a chamber.
    ///
    /// # Errors
    /// A name that no chamber has, or one without liquid.
    pub fn liquid_volume(&self, chamber: &str) -> Result<f64, InputError> {
        let number = self.scene.liquid_number(chamber, "chamber")?;
        Ok(self.gauges.liquids[number].natural(self.liquid_amount(number)))
    }

    /// Flow (m^3/s, of natural volume) of liquid into a chamber.
    ///
    /// # Errors
    /// As [`liquid_volume`](Self::liquid_volume).
    pub fn liquid_flow(&self, chamber: &str) -> Result<f64, InputError> {
        self.scene.liquid_number(chamber, "chamber")?;
        Ok(self.input(Quantity::Flow, chamber))
    }

    /// An input of one component, of a component of the scene.
    fn input(&self, quantity: Quantity, name: &str) -> f64 {
        self.scene.input_at(self.phase, quantity, &Target::one(name), self.time)[0]
    }

    /// Height (m) above the origin, against gravity, of the surface of the liquid in a chamber; NaN where the chamber has no room for the liquid.
    ///
    /// # Errors
    /// A name that no chamber has, one without liquid, a liquid without a [surface](crate::Liquid::surface).
    pub fn liquid_level(&self, chamber: &str) -> Result<f64, InputError> {
        let number = self.scene.surface_number(chamber, "chamber")?;
        Ok(self.with_surface(number)?.level(self.state.u, self.liquid_amount(number)))
    }

    /// Calls `see` with the scene, the phase, the displacements and the extra unknowns.
    #[cfg(feature = "play")]
    pub(crate) fn with_states<R>(
        &self,
        see: impl FnOnce(&Scene, &Phase, &[f64], &[f64]) -> R,
    ) -> R {
        see(self.scene, self.phase, self.state.u, self.state.others)
    }

    /// The liquid of that number, which has a surface, under the gravity of the phase.
    fn with_surface(&self, number: usize) -> Result<Poured, InputError> {
        self.scene.poured_in(Some(self.phase), &self.scene.liquids()[number])
    }

    /// Flow (m^3/s) through a pipe, from its first end to its second.
    ///
    /// # Errors
    /// A name that no pipe has.
    pub fn pipe_flow(&self, pipe: &str) -> Result<f64, InputError> {
        let number = self.scene.pipe_number(pipe, "pipe")?;
        let flowing = self.scene.flowing(self.state.others);
        Ok(flowing.map_or(0.0, |all| all[all.len() - self.scene.pipes().len() + number]))
    }

    /// The amount (kg) of that number, of gases and then of liquids.
    fn amount(&self, number: usize) -> f64 {
        // where they are no unknowns, amounts stay what they are
        self.scene.flowing(self.state.others).unwrap_or(&self.gauges.masses)[number]
    }

    /// That of the liquid of that number.
    fn liquid_amount(&self, number: usize) -> f64 {
        self.amount(self.gauges.gases.len() + number)
    }

    fn gas_pressure(&self, number: usize) -> f64 {
        let pressure = self.gauges.gases[number].pressure(self.state.u, self.amount(number));
        pressure.map_or(f64::NAN, |[pressure, _]| pressure)
    }

    /// Force of the actuator of a spring (N), above 0 where it extends the spring; of a cable its tension, of a winch the
    /// length (m) that it has drawn in, of a muscle its stress (Pa), of a
    /// growth its strain (1). What [lags](crate::Lag) is behind its [command](Self::command).
    ///
    /// # Errors
    /// A name that no spring, no muscle and no growth has.
    pub fn actuation(&self, spring: &str) -> Result<f64, InputError> {
        self.scene.actuator_number(spring, "spring")?;
        Ok(self.actuation_with_rate(spring)[0])
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

    /// By how much a [heated](crate::Lag::heated) actuator is warmer than what is around it (K).
    ///
    /// # Errors
    /// A name that no heated actuator has.
    pub fn temperature(&self, actuator: &str) -> Result<f64, InputError> {
        let per_kelvin = self.scene.per_kelvin(actuator, "actuator")?;
        Ok(self.actuation_with_rate(actuator)[0] / per_kelvin)
    }

    fn actuation_with_rate(&self, spring: &str) -> [f64; 2] {
        self.scene.drive_at(spring, self.phase, self.time, self.state.others)
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

    /// Force (N) with which a spring pulls its ends together: that of its stiffness and damping minus that of
    /// its actuator.
    ///
    /// # Errors
    /// A name that no spring has.
    pub fn spring_pull(&self, spring: &str) -> Result<f64, InputError> {
        Ok(self.spring_pulls(spring)?[0])
    }

    /// Tension (N) of a cable at its first place, where it is driven, and at its last; they differ by friction.
    ///
    /// # Errors
    /// A name that no spring has.
    pub fn spring_pulls(&self, spring: &str) -> Result<[f64; 2], InputError> {
        let number = self.scene.spring_number(spring, "spring")?;
        let State { u, v, .. } = self.state;
        Ok(self.gauges.springs[number].pulls(u, v, self.actuation_with_rate(spring)))
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
        let sum = force.on(self.time, self.state.u, self.state.v, None);
        Ok(sum[..self.body().dimension()].to_vec())
    }

    /// Nodal contact quantities; `None` where they are undefined.
    #[cfg(feature = "play")]
    pub(crate) fn nodal_contacts(&self, reader: &ContactReader) -> Option<Vec<NodalContact>> {
        let obstacles = self.scene.contacts(self.phase).ok()?;
        reader.read(&obstacles, self.time, [self.state.u, self.state.v]).ok()
    }

    /// The forces of an obstacle (N) on all nodes, dimension components each.
    fn contact_forces(&self, obstacle: &str) -> Result<Vec<f64>, InputError> {
        self.scene.obstacle_number(obstacle, "obstacle")?;
        let (body, State { u, v, .. }) = (self.body(), self.state);
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
        self.body().rotation(self.state.u)
    }

    /// Length of a spring (m).
    ///
    /// # Errors
    /// A name that no spring has.
    pub fn spring_length(&self, spring: &str) -> Result<f64, InputError> {
        let number = self.scene.spring_number(spring, "spring")?;
        Ok(self.gauges.springs[number].length(self.state.u))
    }

    /// Stress (Pa) by which a muscle pulls: what actuates it, or by [Hill's law](crate::Hill) the mean over its volume of what becomes of that.
    ///
    /// # Errors
    /// A name that no muscle has.
    pub fn muscle_stress(&self, muscle: &str) -> Result<f64, InputError> {
        let number = self.scene.muscle_number(muscle, "muscle")?;
        let [stress, _] = self.actuation_with_rate(muscle);
        let Some(law) = self.scene.muscles()[number].law() else { return Ok(stress) };
        let contraction = Contraction { law, stress };
        Ok(self.gauges.muscles[number].mean_pull(contraction, self.state.u, self.state.v))
    }

    /// Activation of a muscle with [Hill's law](crate::Hill), from 0 to 1: what actuates it by the largest stress.
    ///
    /// # Errors
    /// A name that no muscle has, or one without that law.
    pub fn activation(&self, muscle: &str) -> Result<f64, InputError> {
        let largest = self.scene.largest_stress(muscle, "muscle")?;
        Ok((self.actuation_with_rate(muscle)[0] / largest).clamp(0.0, 1.0))
    }

    /// How much longer the fibres of a muscle are than in the undeformed shape, as a factor (1): the mean over their
    /// volume.
    ///
    /// # Errors
    /// A name that no muscle has.
    pub fn muscle_stretch(&self, muscle: &str) -> Result<f64, InputError> {
        let number = self.scene.muscle_number(muscle, "muscle")?;
        Ok(self.gauges.muscles[number].mean_stretch(self.state.u))
    }

    /// Magnetic moment (A m^2) of all magnets, one component per dimension.
    pub fn magnetic_moment(&self) -> Vec<f64> {
        let d = self.body().dimension();
        let mut moment = vec![0.0; d];
        let places =
            self.body().mesh().positions().chunks_exact(d).zip(self.state.u.chunks_exact(d));
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
        self.body().cell_fields_of(self.state.u, &self.grown())
    }

    /// The cells that have grown.
    pub(super) fn grown(&self) -> Vec<Grown> {
        // errors were found when the phase began
        self.scene.grown(self.phase, self.time, self.state.others).unwrap_or_default()
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

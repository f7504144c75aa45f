//! Scenes: a body, its surroundings, and a timeline of phases.

mod actuators;
mod around;
mod as_rod;
mod changed;
mod contacts;
mod device;
mod device_rows;
mod early;
mod finer;
mod fluid;
mod forces;
mod gas;
mod initial;
mod input;
mod inputs;
mod lag;
mod liquid;
mod loading;
mod magnet;
mod phase;
mod phase_end;
mod pipe;
mod reduced;
mod scene_devices;
mod scene_state;
mod smaller;
mod start;
mod start_state;
mod term;
mod tie;
mod varying;
mod written;

use std::collections::BTreeSet;
use std::sync::Arc;

#[cfg(any(feature = "scene-file", feature = "study"))]
pub(crate) use as_rod::RodScene;
pub(crate) use contacts::ContactReader;
pub use device::{
    Device, DeviceGauge, DeviceMultipliers, DeviceRow, DeviceSignals, DeviceSite, DeviceState,
    DeviceValue,
};
pub(crate) use device_rows::STEER;
pub use device_rows::{DeviceInput, DeviceOutput, InputLimit};
pub(crate) use gas::Amounts;
#[cfg(feature = "scene-file")]
pub(crate) use input::Row;
pub(crate) use input::{Input, InputSignal, LoadKind, Quantity, Target};
#[cfg(feature = "checkpoint")]
pub(crate) use phase::ContactWith;
pub use phase::Phase;
pub use scene_state::{BodyState, SceneState};
pub use smaller::Smaller;
#[cfg(any(feature = "scene-file", feature = "study"))]
pub(crate) use smaller::{Shrink, SmallerScene};
use start::Start;
pub use term::Term;
use tie::Tie;
pub(crate) use varying::Varying;
use written::WrittenKeys;

use crate::base::input::{InputError, find, finite};
use crate::base::vector::{largest, norm};
use crate::elements::body::Body;
use crate::elements::force::{Force, Forces, NodalForces};
use crate::elements::mesh::Selection;
use crate::integrators::ode::Failure;
use crate::scene::constraint::{
    Constrained, Constraint, ConstraintRow, PhaseStart, check_rigid_holds, prescribe, rows,
};
use crate::scene::forces::{
    ATMOSPHERE, Actuator, Chamber, Contact, Fluid, Gas, Lag, Liquid, Magnet, Obstacle, Orifice,
    Pipe, Supply, Touch, TouchDistance, TouchForce, TouchSite,
};
use crate::scene::reduced_model::ReducedModel;

/// A body, gravity, springs, muscles, magnets, chambers, fluids, obstacles, and a timeline of phases.
///
/// ```
/// use pliant::{Body, Cells, Material, Mesh, Obstacle, Phase, Scene};
///
/// let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
/// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
///     .obstacle(Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(100.0))
///     .phase(
///         Phase::until(0.5).hold("bottom").move_nodes([14, 15], [0.0, -0.16]).without_contact(),
///     )
///     .phase(Phase::until(1.0).named("free"));
/// scene.validate()?;
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Scene {
    body: Arc<Body>,
    gravity: Option<Vec<f64>>,
    /// In the order of their kinds.
    actuators: Vec<Arc<dyn Actuator>>,
    magnets: Vec<Magnet>,
    /// By the names of actuators.
    lags: Vec<(String, Lag)>,
    fluids: Vec<Fluid>,
    chambers: Vec<Chamber>,
    gases: Vec<Gas>,
    liquids: Vec<Liquid>,
    orifices: Vec<Orifice>,
    pipes: Vec<Pipe>,
    supplies: Vec<Supply>,
    /// Absolute pressure (Pa) around chambers with gas.
    atmosphere: f64,
    /// If true, gas and liquid masses are prescribed instead of integrated, and lagged actuators have their steady-state input.
    has_fixed_amounts: bool,
    /// If true, these masses and the inputs of springs and growths rise linearly: from zero load at t = 0 to their values at the
    /// end of the phase.
    rises: bool,
    ties: Vec<Tie>,
    touches: Vec<Touch>,
    obstacles: Vec<Obstacle>,
    /// Other forces.
    devices: Vec<Arc<dyn Device>>,
    forces: Forces,
    phases: Vec<Phase>,
    start: Start,
    unusual: Vec<String>,
    reduced: Option<Arc<ReducedModel>>,
    written: WrittenKeys,
}

/// The quantities of a scene that may be [unusual](Scene::unusual): the names of the indicators of its units.
pub(crate) const UNITS: [&str; 14] = [
    "size",
    "mass",
    "density",
    "young",
    "wave-speed",
    "thickness",
    "weight",
    "remanence",
    "magnetic-field",
    "dipole-moment",
    "absolute-pressure",
    "orifice-area",
    "touch-start",
    "facets",
];

impl Scene {
    /// A scene with a body alone, at rest in its undeformed shape at t = 0.
    pub fn new(body: Body) -> Self {
        Self {
            start: Start::rest(&body),
            body: Arc::new(body),
            gravity: None,
            actuators: Vec::new(),
            magnets: Vec::new(),
            lags: Vec::new(),
            fluids: Vec::new(),
            chambers: Vec::new(),
            gases: Vec::new(),
            liquids: Vec::new(),
            orifices: Vec::new(),
            pipes: Vec::new(),
            supplies: Vec::new(),
            atmosphere: ATMOSPHERE,
            has_fixed_amounts: false,
            rises: false,
            ties: Vec::new(),
            touches: Vec::new(),
            obstacles: Vec::new(),
            devices: Vec::new(),
            forces: Forces::new(),
            phases: Vec::new(),
            unusual: Vec::new(),
            reduced: None,
            written: WrittenKeys::default(),
        }
    }

    /// Acceleration of gravity (m/s^2), one component per dimension, in all phases that do not set
    /// [their own](Phase::gravity). Default: none.
    pub fn gravity(mut self, acceleration: impl Into<Vec<f64>>) -> Self {
        self.gravity = Some(acceleration.into());
        self
    }

    /// Adds a chamber, to be filled by the pressure that phases give it, or with [gas](Self::gas) or a [liquid](Self::liquid).
    pub fn chamber(mut self, chamber: Chamber) -> Self {
        self.chambers.push(chamber);
        self
    }

    /// Glues nodes to another of several [bodies](Body::join): in all phases each moves with the point of the body
    /// at which it is in the undeformed shape, by the shape functions there.
    ///
    /// The meshes need not match. Where `nodes` are all those of faces, either side may be named: nodes of the side with more of them
    /// follow the faces of the other one, and nodes of a deformable body those of a rigid one, so that no node between
    /// others is free. Nodes that form no face follow the body. A node that is not on the body may have a gap of up to a fifth of an edge, as where one
    /// of two curved surfaces has longer edges; the gap does not change.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh, Phase, Scene};
    ///
    /// let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 10.0 };
    /// let stiff = Material { young: 1e7, ..soft };
    /// let part = |name, x: f64, nodes, material| {
    ///     let mesh = Mesh::rectangle([0.1, 0.02], nodes, Cells::Rectangles)?.translated(&[x, 0.0])?;
    ///     Body::new(mesh, material).thickness(0.01).named(name).build()
    /// };
    /// let both = Body::join([part("base", 0.0, [11, 3], stiff)?, part("tip", 0.1, [21, 5], soft)?])?;
    /// let scene = Scene::new(both)
    ///     .tie("tip/left", "base")
    ///     .gravity([0.0, -9.8])
    ///     .phase(Phase::until(0.1).hold("base/left"));
    /// scene.validate()?;
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn tie(mut self, nodes: impl Into<Selection>, to: impl Into<String>) -> Self {
        self.ties.push(Tie::new(&self.body, nodes.into(), to.into()));
        self
    }

    /// Has bodies touch each other or themselves, in all phases.
    pub fn touch(mut self, touch: Touch) -> Self {
        self.touches.push(touch);
        self
    }

    /// Adds an obstacle, which acts in every phase that does not exclude it.
    pub fn obstacle(mut self, obstacle: Obstacle) -> Self {
        self.obstacles.push(obstacle);
        self
    }

    /// Adds any other force, which acts in every phase: a field, a wind, a coupling to something that is not
    /// of this crate.
    pub fn force(mut self, force: impl Force + 'static) -> Self {
        self.forces.push(Arc::new(force));
        self
    }

    /// Adds a phase, which begins where the one before it ends (the first one at t = 0).
    pub fn phase(mut self, phase: Phase) -> Self {
        let number = self.phases.len() + 1;
        self.phases.push(phase.or_named(format!("phase {number}")));
        self
    }

    /// Quantities that are meant as they are, although such values are rare for a soft body in SI units.
    ///
    /// They are among `size`, `mass`, `density`, `young`, `wave-speed`, `thickness`, `weight` (the strain
    /// of a column as high as the body under its own weight), `remanence`, `magnetic-field`, `dipole-moment`, `absolute-pressure` (of gas and
    /// supplies), `orifice-area`, `touch-start` and `facets` (of a mesh from a file). [Indicators](Self::indicators) with these names
    /// keep their numbers and do not warn.
    ///
    /// ```
    /// # use pliant::{Body, Cells, Material, Mesh, Phase, Scene};
    /// let mesh = Mesh::rectangle([15.0, 4.0], [16, 5], Cells::Triangles)?;
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 40.0 };
    /// let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?).phase(Phase::until(1.0));
    /// assert!(scene.warnings()[0].contains("15.524 m across"));
    /// assert!(scene.unusual(["size"]).warnings().is_empty());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn unusual(mut self, names: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.unusual.extend(names.into_iter().map(Into::into));
        self
    }

    /// The same scene, ended at time `end` (s) if it lasts longer.
    pub fn ended_at(mut self, end: f64) -> Self {
        let whole = self.phases.iter().filter(|phase| phase.until < end).count();
        self.phases.truncate(whole + 1);
        if let Some(last) = self.phases.last_mut()
            && (last.until > end || end.is_nan())
        {
            last.until = end;
        }
        self
    }

    /// The scene as [`ended_at`](Self::ended_at), but if it ends before time `end` (s), its last phase goes
    /// on until then.
    pub fn lasting(self, end: f64) -> Self {
        let mut scene = self.ended_at(end);
        if let Some(last) = scene.phases.last_mut() {
            last.until = end;
        }
        scene
    }

    /// The body.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// Acceleration of gravity (m/s^2), if there is any, except in phases that set their own.
    pub fn acceleration(&self) -> Option<&[f64]> {
        self.gravity.as_deref()
    }

    /// The chambers.
    pub fn chambers(&self) -> &[Chamber] {
        &self.chambers
    }

    /// The obstacles.
    pub fn obstacles(&self) -> &[Obstacle] {
        &self.obstacles
    }

    /// Number (from 0) of the chamber with a name; `input` is where that was given.
    pub(crate) fn chamber_number(&self, name: &str, input: &str) -> Result<usize, InputError> {
        find(name, self.chambers.iter().map(Chamber::name), input, "chambers")
    }

    /// Number (from 0) of the obstacle with a name; `input` is where that was given.
    pub(crate) fn obstacle_number(&self, name: &str, input: &str) -> Result<usize, InputError> {
        find(name, self.obstacles.iter().map(Obstacle::name), input, "obstacles")
    }

    /// The quantities that are [unusual](Self::unusual).
    pub fn unusual_quantities(&self) -> &[String] {
        &self.unusual
    }

    /// Forces other than gravity and those of springs, chambers and obstacles.
    pub(crate) fn other_forces(&self) -> &Forces {
        &self.forces
    }

    /// The phases, in order.
    pub fn phases(&self) -> &[Phase] {
        &self.phases
    }

    /// Times (s) within a phase, counted from 0, at which what it prescribes changes its law: those of its
    /// paths and tables, kinks and jumps of its formulas, and breaks of its functions.
    pub fn breaks(&self, phase: usize) -> Vec<f64> {
        let start = phase.checked_sub(1).and_then(|before| self.phases.get(before));
        let start = start.map_or(0.0, |before| before.until);
        let Some(phase) = self.phases.get(phase) else { return Vec::new() };
        self.breaks_within(phase, start)
    }

    /// Ends of the intervals of a phase, counted from 0: its [`breaks`](Self::breaks) and its own end.
    pub(crate) fn stops(&self, phase: usize) -> Vec<f64> {
        let mut stops = self.breaks(phase);
        stops.extend(self.phases.get(phase).map(Phase::end));
        stops
    }

    /// End of the last phase (s); 0 without phases.
    pub fn end(&self) -> f64 {
        self.phases.last().map_or(0.0, |phase| phase.until)
    }

    /// Checks everything that can be known before the scene is run.
    ///
    /// # Errors
    /// The first input that cannot be used: no phases, phases out of order, unknown nodes, springs,
    /// chambers or obstacles, numbers out of range, constraints that contradict each other, initial
    /// displacements in which a force has no meaning (an inverted cell of Green strain).
    pub fn validate(&self) -> Result<(), InputError> {
        self.forces_from_start().map(|_| ())
    }

    /// The [`forces`](Self::forces) of each phase, if those of the first one can be evaluated at t = 0.
    pub(crate) fn forces_from_start(&self) -> Result<Vec<Forces>, InputError> {
        let forces = self.forces()?;
        let (u, v) = (self.initial_displacements(), self.initial_velocities()?);
        let (phase, start) = (self.first_phase()?, PhaseStart { time: 0.0, u });
        check_rigid_holds(&self.rows(phase, &start)?, &self.body, &phase.name, &start)?;
        self.check_devices_at_start(phase, [u, &v])?;
        let mut nodal = NodalForces::zeros(self.body.dofs());
        let mut first = forces.iter().take(1).flatten();
        match first.try_for_each(|force| force.add_forces(0.0, u, &v, &mut nodal)) {
            Ok(()) => Ok(forces),
            Err(failure) => Err(self.bad_start(failure)),
        }
    }

    /// The error for a force that has no meaning at t = 0.
    pub(crate) fn bad_start(&self, failure: Failure) -> InputError {
        match failure {
            Failure::Recoverable(reason) => {
                let displacement = format!("up to {:e} m", largest(self.initial_displacements()));
                InputError::new("initial displacement", displacement, reason)
            }
            Failure::Fatal(error) => {
                InputError::new("start of the first phase", "t = 0 s", error.to_string())
            }
        }
    }

    /// The phase that a run begins with.
    pub(crate) fn first_phase(&self) -> Result<&Phase, InputError> {
        let none = || InputError::new("number of phases", 0, "a scene needs one phase at least");
        self.phases.first().ok_or_else(none)
    }

    /// The forces of each phase, except those of constant matrices, after the checks of
    /// [`validate`](Self::validate), except those of the initial state.
    pub(crate) fn forces(&self) -> Result<Vec<Forces>, InputError> {
        self.first_phase()?;
        self.initial_velocities()?;
        for name in &self.unusual {
            find(name, UNITS.into_iter(), "unusual", "quantities")?;
        }
        let mut start = 0.0;
        for phase in &self.phases {
            let input = format!("end of phase \"{}\"", phase.name);
            finite(&input, &[phase.until])?;
            if phase.until <= start {
                let help = format!("phases run one after the other: it must lie after {start} s");
                return Err(InputError::new(input, format!("{} s", phase.until), help));
            }
            start = phase.until;
        }
        let mut names = BTreeSet::new();
        if let Some(own) = self.actuators.iter().find(|own| !names.insert(own.name())) {
            return Err(taken(own.kind().name, own.name()));
        }
        self.check_lags()?;
        self.check_start_state()?;
        unique("chamber", self.chambers.iter().map(Chamber::name))?;
        unique("obstacle", self.obstacles.iter().map(Obstacle::name))?;
        unique("touch", self.touches.iter().map(Touch::name))?;
        self.magnetization()?;
        for chamber in &self.chambers {
            chamber.check_side(&self.body, &chamber.force(&self.body, Vec::new())?)?;
        }
        for obstacle in &self.obstacles {
            Contact::new(&self.body, obstacle)?;
        }
        self.check_flows()?;
        let (mut time, mut u) = (0.0, self.initial_displacements().to_vec());
        let forces = self.phases.iter().map(|phase| {
            let rows = self.rows(phase, &PhaseStart { time, u: &u })?;
            time = phase.until;
            prescribe(&rows, time, &mut u);
            self.forces_in(phase)
        });
        forces.collect()
    }

    /// How bodies touch.
    pub fn touches(&self) -> &[Touch] {
        &self.touches
    }

    /// The distance of each touch, given or by default, with the thickness of its bodies.
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub fn touch_distances(&self) -> Result<Vec<TouchDistance>, InputError> {
        let told = |touch: &Touch| {
            self.force_of(touch).map(|force| TouchDistance::new(touch, &force, &self.body))
        };
        self.touches.iter().map(told).collect()
    }

    /// The forces of all touches.
    pub(crate) fn touch_forces(&self) -> Result<Vec<TouchForce>, InputError> {
        self.touches.iter().map(|touch| self.force_of(touch)).collect()
    }

    /// The forces of those that act in a phase.
    pub(crate) fn touches_in(&self, phase: &Phase) -> Result<Vec<TouchForce>, InputError> {
        if phase.has_touch { self.touch_forces() } else { Ok(Vec::new()) }
    }

    /// The forces of the touch `name`; `input` is where that was given.
    pub(crate) fn touch_force(&self, name: &str, input: &str) -> Result<TouchForce, InputError> {
        let number = find(name, self.touches.iter().map(Touch::name), input, "touches")?;
        self.force_of(&self.touches[number])
    }

    /// The forces of a touch of bodies of the scene.
    pub(crate) fn force_of(&self, touch: &Touch) -> Result<TouchForce, InputError> {
        let of_devices = self.device_constraints()?;
        let glued = self.bodies_joined_by(self.tied()?.into_iter().chain(&of_devices));
        let gravity = self.phases.iter().filter_map(|phase| self.gravity_in(phase));
        touch.force(&TouchSite {
            body: &self.body,
            glued: &glued,
            planes: &self.planes_of_symmetry()?,
            u: self.initial_displacements(),
            v: &self.initial_velocities()?,
            gravity: gravity.map(norm).fold(0.0, f64::max),
        })
    }

    /// The pairs of numbers of bodies that devices join.
    pub(crate) fn jointed_bodies(&self) -> Result<Vec<[usize; 2]>, InputError> {
        Ok(self.bodies_joined_by(self.device_constraints()?.iter()))
    }

    /// The pairs of numbers of bodies that have terms in the same row.
    fn bodies_joined_by<'a>(
        &self,
        constraints: impl Iterator<Item = &'a Constraint>,
    ) -> Vec<[usize; 2]> {
        let number = |node: usize| self.body.parts().position(|part| part.nodes.contains(&node));
        let mut joined = Vec::new();
        for constraint in constraints {
            if let Constrained::Row(terms) = &constraint.what {
                let mut bodies: Vec<usize> =
                    terms.iter().filter_map(|&(node, ..)| number(node - 1)).collect();
                bodies.dedup();
                let pair = bodies.first().zip(bodies.get(1));
                joined.extend(pair.map(|(one, other)| [*one, *other]));
            }
        }
        joined.sort_unstable();
        joined.dedup();
        joined
    }

    /// The constraints of all ties.
    ///
    /// # Errors
    /// Nodes or bodies that do not exist, nodes of the body itself, nodes that are not at it.
    pub(crate) fn tied(&self) -> Result<Vec<&Constraint>, InputError> {
        let mut constraints = Vec::new();
        for tie in &self.ties {
            constraints.extend(tie.constraints.as_ref().map_err(Clone::clone)?.iter());
        }
        Ok(constraints)
    }

    /// The rows of the constraints of a phase.
    pub(crate) fn rows(
        &self,
        phase: &Phase,
        start: &PhaseStart,
    ) -> Result<Vec<ConstraintRow>, InputError> {
        let (tied, on_axis) = (self.tied()?, self.held_on_axis());
        let of_devices = self.device_constraints()?;
        let all = phase.constraints.iter().chain(tied).chain(&on_axis).chain(&of_devices);
        let rows = rows(all, &self.body, &phase.name, start)?;
        self.check_driven(phase, &rows, start.u)?;
        Ok(rows)
    }
}

fn unique<'a>(what: &str, names: impl Iterator<Item = &'a str>) -> Result<(), InputError> {
    let mut seen = BTreeSet::new();
    for name in names {
        if !seen.insert(name) {
            return Err(taken(what, name));
        }
    }
    Ok(())
}

/// The error for a name that two of a kind have.
fn taken(what: &str, name: &str) -> InputError {
    let help = "it is taken: name it otherwise";
    InputError::new(format!("{what} name"), format!("\"{name}\""), help)
}

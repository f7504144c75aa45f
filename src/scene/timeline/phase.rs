//! Phases: spans of time with their constraints, loads and contacts.

use std::fmt;
use std::sync::Arc;

use super::input::{Input, Quantity, Target};
#[cfg(feature = "scene-file")]
use crate::base::formula::Formula;
use crate::base::input::{InputError, find};
use crate::elements::mesh::Selection;
use crate::scene::constraint::{
    Axes, Axis, Constrained, Constraint, Motion, Prescribed, Spline, Turn,
};
use crate::scene::forces::{Gradient, MagneticField, Obstacle, Signal};

/// A stretch of time with its own constraints, loads and contacts. Displacements and velocities
/// carry over from phase to phase.
#[derive(Debug, Clone)]
pub struct Phase {
    pub(crate) name: String,
    pub(crate) until: f64,
    /// The level of a sensor that ends it before.
    pub(crate) ends: Option<PhaseEnd>,
    /// Acceleration of gravity (m/s^2), if it is another one than the scene's.
    pub(crate) gravity: Option<Vec<f64>>,
    pub(crate) constraints: Vec<Constraint>,
    pub(crate) inputs: Vec<Input>,
    pub(crate) projects_velocity: bool,
    pub(crate) contact: ContactWith,
    /// Whether bodies touch each other.
    pub(crate) has_touch: bool,
    /// Obstacles that move otherwise than in the scene.
    pub(crate) redirected: Vec<Obstacle>,
    /// Change of the magnetic field in space, beside its uniform part.
    pub(crate) gradient: Option<Gradient>,
}

/// The level of a sensor that ends a phase before its time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PhaseEnd {
    /// Name of the column of a sensor.
    pub(crate) sensor: String,
    /// The level (in the unit of the sensor) that it passes, upwards or downwards.
    pub(crate) level: f64,
    pub(crate) rises: bool,
}

impl fmt::Display for PhaseEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let passes = if self.rises { "rises above" } else { "falls below" };
        write!(f, "ends as \"{}\" {passes} {}", self.sensor, self.level)
    }
}

/// The obstacles that act.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(untagged))]
pub(crate) enum ContactWith {
    All,
    These(Vec<String>),
}

impl Phase {
    /// A phase that ends at time `until` (s). Without more it is free motion, in contact with all
    /// obstacles.
    pub fn until(until: f64) -> Self {
        Self {
            name: String::new(),
            until,
            ends: None,
            gravity: None,
            constraints: Vec::new(),
            inputs: Vec::new(),
            projects_velocity: false,
            contact: ContactWith::All,
            has_touch: true,
            redirected: Vec::new(),
            gradient: None,
        }
    }

    /// Name of the phase, for messages and tables (default: "phase 1", "phase 2", ...).
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Acceleration of gravity (m/s^2) in this phase, one component per dimension, in place of the
    /// [scene's](crate::Scene::gravity). Energy that the change of gravity adds to the body counts as
    /// supplied from outside.
    pub fn gravity(mut self, acceleration: impl Into<Vec<f64>>) -> Self {
        self.gravity = Some(acceleration.into());
        self
    }

    /// Whether it has a gravity of its own.
    #[cfg(feature = "study")]
    pub(crate) fn has_gravity(&self) -> bool {
        self.gravity.is_some()
    }

    /// Nodes that stay, in all components, where they are when the phase begins. Where the previous phase
    /// prescribed their position, they stay at the one prescribed for its end.
    pub fn hold(self, nodes: impl Into<Selection>) -> Self {
        self.constrain(nodes, Axes::All, Motion::Hold)
    }

    /// As [`hold`](Self::hold), for some components only.
    pub fn hold_axes(
        self,
        nodes: impl Into<Selection>,
        axes: impl IntoIterator<Item = Axis>,
    ) -> Self {
        self.constrain(nodes, Axes::These(axes.into_iter().collect()), Motion::Hold)
    }

    /// Nodes that move with a constant `velocity` (m/s), one component per dimension, from where they are
    /// when the phase begins.
    pub fn move_nodes(self, nodes: impl Into<Selection>, velocity: impl Into<Vec<f64>>) -> Self {
        self.constrain(nodes, Axes::All, Motion::Velocity(velocity.into()))
    }

    /// One component of nodes that moves with a constant `velocity` (m/s); the others are free.
    pub fn move_axis(self, nodes: impl Into<Selection>, axis: Axis, velocity: f64) -> Self {
        self.constrain(nodes, Axes::These(vec![axis]), Motion::Velocity(vec![velocity]))
    }

    /// One component of nodes that follows a smooth path: `path` gives b, b' and b'' at time t.
    pub fn follow(
        self,
        nodes: impl Into<Selection>,
        axis: Axis,
        path: impl Fn(f64) -> Prescribed + Send + Sync + 'static,
    ) -> Self {
        self.constrain(nodes, Axes::These(vec![axis]), Motion::Path(Arc::new(path)))
    }

    /// One component of nodes that follows a formula of time (m, from the undeformed position).
    #[cfg(feature = "scene-file")]
    pub(crate) fn follow_formula(
        self,
        nodes: impl Into<Selection>,
        axis: Axis,
        formula: Formula,
    ) -> Self {
        self.constrain(nodes, Axes::These(vec![axis]), Motion::Formula(Arc::new(formula)))
    }

    /// One component of nodes that follows a smooth path through points: at the `times` (s,
    /// ascending, two at least) it has the `displacements` (m, from the undeformed position).
    ///
    /// The path is a cubic spline, twice continuously differentiable, that starts and ends with
    /// velocity 0; before the first time and after the last the component rests.
    pub fn path(
        self,
        nodes: impl Into<Selection>,
        axis: Axis,
        times: impl Into<Vec<f64>>,
        displacements: impl Into<Vec<f64>>,
    ) -> Self {
        let spline = Spline::new(times.into(), displacements.into());
        self.constrain(nodes, Axes::These(vec![axis]), Motion::Spline(Arc::new(spline)))
    }

    /// Nodes on a plane of symmetry (a line, in the plane) with this `normal`, of any length: their
    /// displacements along it keep the values at the start of the phase, and they slide freely in the plane.
    ///
    /// Half of a body then moves as the whole body does. Its mass is half by itself, but quantities given node by
    /// node have to be halved on the plane: loads, point masses, springs, contact stiffness per node (not per
    /// area).
    pub fn symmetry(mut self, nodes: impl Into<Selection>, normal: impl Into<Vec<f64>>) -> Self {
        let what = Constrained::Along(nodes.into(), normal.into());
        self.constraints.push(Constraint { what, how: Motion::Hold });
        self
    }

    /// Nodes that turn about `centre` (m) with a constant angular velocity (rad/s).
    ///
    /// This has one component in the plane, counter-clockwise; in space three, and `centre` is any point of
    /// the axis. They turn from where they are when the phase begins, as [`move_nodes`](Self::move_nodes)
    /// moves them.
    pub fn rotate(
        self,
        nodes: impl Into<Selection>,
        centre: impl Into<Vec<f64>>,
        angular_velocity: impl Into<Vec<f64>>,
    ) -> Self {
        let turn = Turn { centre: centre.into(), axis: angular_velocity.into(), angles: None };
        self.constrain(nodes, Axes::All, Motion::Turn(Arc::new(turn)))
    }

    /// As [`rotate`](Self::rotate), by an angle that runs smoothly, as [`path`](Self::path) does, through the
    /// `angles` (rad) at the `times` (s, ascending, two at least).
    ///
    /// `axis` is the direction of the angular velocity, of any length: `[1.0]` is counter-clockwise in the
    /// plane.
    ///
    /// Nodes turn from where they are when the phase begins, by the change of the angle since then: phases
    /// that are given the same path follow it without a jump.
    pub fn rotate_path(
        self,
        nodes: impl Into<Selection>,
        centre: impl Into<Vec<f64>>,
        axis: impl Into<Vec<f64>>,
        times: impl Into<Vec<f64>>,
        angles: impl Into<Vec<f64>>,
    ) -> Self {
        let angles = Some(Spline::new(times.into(), angles.into()));
        let turn = Turn { centre: centre.into(), axis: axis.into(), angles };
        self.constrain(nodes, Axes::All, Motion::Turn(Arc::new(turn)))
    }

    /// A linear combination of displacements that keeps the value it has when the phase begins:
    /// `terms` are (node number from 1, axis, coefficient).
    pub fn hold_combination(mut self, terms: impl IntoIterator<Item = (usize, Axis, f64)>) -> Self {
        let what = Constrained::Row(terms.into_iter().collect());
        self.constraints.push(Constraint { what, how: Motion::Hold });
        self
    }

    /// An actuation force (N) in each of the named springs, a number or any other [`Signal`]; a positive one
    /// extends it. Forces on the same spring add up. Of a [cable](crate::Spring::cable) it is the tension, and of one on a winch
    /// the length (m) that is drawn in; of a [muscle](crate::Muscle) it is the stress (Pa) by which it pulls, of a
    /// [growth](crate::Growth) the strain (1).
    pub fn actuate<N: Into<String>>(
        self,
        springs: impl IntoIterator<Item = N>,
        force: impl Into<Signal>,
    ) -> Self {
        self.actuated(springs, force.into())
    }

    /// As [`actuate`](Self::actuate), with a force (N) that changes with time (s).
    pub fn actuate_with<N: Into<String>>(
        self,
        springs: impl IntoIterator<Item = N>,
        force: impl Fn(f64) -> f64 + Send + Sync + 'static,
    ) -> Self {
        self.actuated(springs, Signal::function(force))
    }

    /// As [`actuate`](Self::actuate), with a force that has the values `forces` (N) at the `times` (s,
    /// ascending). In between it is interpolated linearly; before and after it is constant.
    pub fn actuate_table<N: Into<String>>(
        self,
        springs: impl IntoIterator<Item = N>,
        times: impl Into<Vec<f64>>,
        forces: impl Into<Vec<f64>>,
    ) -> Self {
        self.actuated(springs, Signal::table(times, forces))
    }

    /// A pressure (Pa) in a chamber, a number or any other [`Signal`]; a positive one enlarges it. Pressures
    /// in the same chamber add up.
    pub fn pressure(self, chamber: impl Into<String>, pressure: impl Into<Signal>) -> Self {
        self.pressurized(chamber, pressure.into())
    }

    /// As [`pressure`](Self::pressure), with a pressure (Pa) that changes with time (s).
    pub fn pressure_with(
        self,
        chamber: impl Into<String>,
        pressure: impl Fn(f64) -> f64 + Send + Sync + 'static,
    ) -> Self {
        self.pressurized(chamber, Signal::function(pressure))
    }

    /// As [`pressure`](Self::pressure), with a pressure that has the `values` (Pa) at the `times` (s,
    /// ascending). In between it is interpolated linearly; before and after it is constant.
    pub fn pressure_table(
        self,
        chamber: impl Into<String>,
        times: impl Into<Vec<f64>>,
        values: impl Into<Vec<f64>>,
    ) -> Self {
        self.pressurized(chamber, Signal::table(times, values))
    }

    /// A pressure (Pa) on the faces of the boundary (edges in the plane) between the nodes; a positive one
    /// presses onto the body.
    ///
    /// The nodes all have to belong to such faces. The pressure follows the body: it acts on the deformed
    /// area, along its normal. (For a constant direction use [`traction`](Self::traction).) Pressures on the
    /// same faces add up.
    ///
    /// Cells of a membrane in space are pressed on the side from which their nodes run counter-clockwise.
    pub fn pressure_on(self, nodes: impl Into<Selection>, pressure: impl Into<Signal>) -> Self {
        let target = Target::Nodes(nodes.into());
        self.with(Input::new(Quantity::FacePressure, target, pressure.into()))
    }

    /// The magnetic field (T) that acts on the [magnets](crate::Magnet) of the scene, one component per dimension: a vector, or any other
    /// [`MagneticField`]. Default: none.
    pub fn magnetic_field(self, field: impl Into<MagneticField>) -> Self {
        let MagneticField { field, gradient } = field.into();
        let mut phase = Self { gradient, ..self };
        phase.set(Input::new(Quantity::Field, Target::Everything, field));
        phase
    }

    /// No obstacle acts in this phase, and bodies do not [touch](crate::Touch).
    pub fn without_contact(self) -> Self {
        self.contact_with::<String>([]).touching(false)
    }

    /// Whether bodies [touch](crate::Touch) each other in this phase (default: they do). If they overlap where this contact begins, the
    /// run ends with an error.
    pub fn touching(self, touch: bool) -> Self {
        Self { has_touch: touch, ..self }
    }

    /// Only the named obstacles act in this phase.
    pub fn contact_with<N: Into<String>>(mut self, obstacles: impl IntoIterator<Item = N>) -> Self {
        self.contact = ContactWith::These(obstacles.into_iter().map(Into::into).collect());
        self
    }

    /// Begins with the velocities nearest to the present ones that the constraints allow (an
    /// inelastic impact). Without it, the default, a jump of b' decays by the stabilization
    /// within a time of about 1/alpha.
    pub fn project_velocity(mut self) -> Self {
        self.projects_velocity = true;
        self
    }

    /// Name of the phase.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// End of the phase (s).
    pub fn end(&self) -> f64 {
        self.until
    }

    /// Times (s) at which what the phase prescribes changes its law, ascending; not only those
    /// within it. `obstacles` are those of the scene.
    pub(crate) fn breaks(&self, obstacles: &[Obstacle]) -> Vec<f64> {
        let paths = self.constraints.iter().map(|constraint| constraint.how.breaks());
        let inputs = self.inputs.iter().map(|input| input.signal.breaks());
        let acting = self.contacts(obstacles).unwrap_or_default();
        let obstacles = acting.into_iter().map(Obstacle::breaks);
        let all = paths.chain(inputs).chain(obstacles);
        let mut breaks = all.flatten().copied().collect::<Vec<f64>>();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }

    pub(super) fn or_named(self, name: String) -> Self {
        if self.name.is_empty() { self.named(name) } else { self }
    }

    /// The obstacles that act in this phase.
    pub(crate) fn contacts<'a>(
        &'a self,
        obstacles: &'a [Obstacle],
    ) -> Result<Vec<&'a Obstacle>, InputError> {
        let ContactWith::These(names) = &self.contact else {
            return Ok(obstacles.iter().map(|obstacle| self.moving(obstacle)).collect());
        };
        let input = format!("contact of phase \"{}\"", self.name);
        let find =
            |name: &String| find(name, obstacles.iter().map(Obstacle::name), &input, "obstacles");
        names.iter().map(|name| Ok(self.moving(&obstacles[find(name)?]))).collect()
    }

    /// An obstacle of the scene as it moves in this phase.
    pub(crate) fn moving<'a>(&'a self, obstacle: &'a Obstacle) -> &'a Obstacle {
        self.redirected
            .iter()
            .find(|redirected| redirected.name() == obstacle.name())
            .unwrap_or(obstacle)
    }

    /// Whether there are obstacles that move otherwise than in the scene.
    pub(crate) fn is_redirected(&self) -> bool {
        !self.redirected.is_empty()
    }

    fn actuated<N: Into<String>>(
        self,
        springs: impl IntoIterator<Item = N>,
        force: Signal,
    ) -> Self {
        let springs = Target::Named(springs.into_iter().map(Into::into).collect());
        self.with(Input::new(Quantity::Actuation, springs, force))
    }

    fn pressurized(self, chamber: impl Into<String>, pressure: Signal) -> Self {
        self.with(Input::new(Quantity::Pressure, Target::one(chamber), pressure))
    }

    fn constrain(mut self, nodes: impl Into<Selection>, axes: Axes, how: Motion) -> Self {
        self.constraints.push(Constraint { what: Constrained::Nodes(nodes.into(), axes), how });
        self
    }
}

pub(super) fn check_vector(
    input: &str,
    vector: &[f64],
    dimension: usize,
    unit: &str,
) -> Result<(), InputError> {
    if vector.len() == dimension {
        return Ok(());
    }
    let help = format!("it needs {dimension} component(s) ({unit})");
    Err(InputError::new(input, format!("{vector:?}"), help))
}

//! Joints between bodies, and motors in them.
//!
//! Teeth, threads and crosses, which linear rows cannot keep, hold by a stiffness ([`coupling`]).
//!
//! The rows of a joint are linear in the displacements: that two points, or two directions, of its sides stay together. On rigid bodies one of the
//! rows of a direction follows from the others, as both keep their lengths; the solver leaves out edges of a piece that follow from rows
//! (`dynamics/linear/edge_solver.rs`), so that such rows, and closed chains of bodies, do no harm.

mod assembly;
mod coordinate;
mod coupling;
mod force;
mod geometry;
mod kind;
mod law;
mod side;

use std::sync::Arc;

use self::assembly::Assembly;
use self::force::JointForce;
use self::geometry::{Gear, Geometry, Ratio};
pub use self::kind::JointKind;
use self::law::JointLaw;
use self::side::is_world;
use crate::base::input::InputError;
use crate::elements::body::Body;
use crate::elements::force::Force;
use crate::elements::mesh::Selection;
use crate::scene::timeline::{
    Device, DeviceGauge, DeviceInput, DeviceOutput, DeviceRow, DeviceSignals, DeviceSite,
    DeviceState, Scene,
};

/// A joint between two sides: rigid bodies or inserts, cross sections of rods, faces of solids, or the world, which is fixed in space.
///
/// A side is a selection of nodes: the name of a rigid body, a node on the axis of a rod, a set of nodes of a face. `"world"` is the world. The sides are
/// joined where they are in the undeformed shape, at a place that each side has: a rigid body has all of space, a section of a rod its plane, a face of a
/// solid its plane, by the mean of its nodes.
///
/// Along the coordinate of a joint, the angle of a [revolute](Self::revolute) or the displacement of a [prismatic](Self::prismatic) one, of the second side
/// from the first, act a spring, damping, friction, stops and a motor: a force that is [given](Self::TORQUE), and a [servo](Self::servo) that leads to an
/// angle that is. The energy balance counts the motor as supplied, the spring and the stops as energy, the rest as heat.
///
/// ```
/// use pliant::{Body, Cells, Joint, Material, Mesh, Phase, Sampling, Scene, Settings, simulate::Reading};
///
/// // a motor of 1 N m lifts a bar by a pin at its end: what it supplies is torque times angle
/// let mesh = Mesh::rectangle([0.2, 0.02], [2, 2], Cells::Rectangles)?;
/// let bar = Body::new(mesh, Material::rigid(1000.0)).thickness(0.02).named("bar").build()?;
/// let scene = Scene::new(bar)
///     .gravity([0.0, -9.81])
///     .joint(Joint::revolute("pin", ["world", "bar"], [0.0, 0.01]))
///     .phase(Phase::until(0.05).device_input("pin", &Joint::TORQUE, 1.0));
/// let sampling = Sampling::phase_ends().read("angle", Reading::device("pin", &Joint::ANGLE));
/// let motion = scene.simulate(&Settings::default(), &sampling)?;
/// let (angle, energy) = (motion.last().sensors[0], motion.last().energy);
/// assert!(angle > 0.1 && (energy.supplied - angle).abs() < 1e-3 * angle);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Joint {
    geometry: Geometry,
    law: JointLaw,
}

/// Lists of a phase in scene files, and the key of a joint in them.
const KEYS: [&str; 2] = ["motor", "joint"];

/// Angle (rad/s) and displacement (m/s) per second below which friction creeps.
const STICKING_SPEEDS: [f64; 2] = [0.1, 1e-3];

const fn input(word: &'static str, unit: &'static str, is_scaled: bool) -> DeviceInput {
    DeviceInput { keys: KEYS, is_scaled, ..DeviceInput::number(word, unit) }
}

const fn number(word: &'static str, unit: &'static str) -> DeviceOutput {
    DeviceOutput { word, unit, is_vector: false }
}

/// Outputs in the plane and in space, each of a hinge and of a slider: those of the constraints, then those of the coordinate.
static OUTPUTS: [[[DeviceOutput; 6]; 2]; 2] =
    [outputs(Joint::REACTION_COUPLE), outputs(Joint::REACTION_MOMENT)];

const fn outputs(moment: DeviceOutput) -> [[DeviceOutput; 6]; 2] {
    use Joint as J;
    let force = J::REACTION_FORCE;
    [
        [force, moment, J::ANGLE, J::SPEED, J::MOTOR_TORQUE, J::POWER],
        [force, moment, J::DISPLACEMENT, J::VELOCITY, J::MOTOR_FORCE, J::POWER],
    ]
}

impl Joint {
    /// Torque (N m) of the motor of a revolute joint, on the second side.
    pub const TORQUE: DeviceInput = input("torque", "N m", true);
    /// Angle (rad) to which the servo of a revolute joint leads.
    pub const TARGET_ANGLE: DeviceInput = input("angle", "rad", false);
    /// Angular speed (rad/s), likewise.
    pub const TARGET_SPEED: DeviceInput = input("speed", "rad/s", false);
    /// Force (N) of the motor of a prismatic joint, on the second side.
    pub const FORCE: DeviceInput = input("force", "N", true);
    /// Displacement (m) to which the servo of a prismatic joint leads.
    pub const TARGET_DISPLACEMENT: DeviceInput = input("displacement", "m", false);
    /// Speed (m/s), likewise.
    pub const TARGET_VELOCITY: DeviceInput = input("speed", "m/s", false);

    /// Angle (rad) of a revolute joint, from the undeformed shape, counter-clockwise about the axis; sensors follow it over whole turns.
    pub const ANGLE: DeviceOutput = number("angle", "rad");
    /// Its rate (rad/s).
    pub const SPEED: DeviceOutput = number("speed", "rad/s");
    /// Torque (N m) of the motor of a revolute joint.
    pub const MOTOR_TORQUE: DeviceOutput = number("torque", "N m");
    /// Displacement (m) of a prismatic joint, from the undeformed shape.
    pub const DISPLACEMENT: DeviceOutput = number("displacement", "m");
    /// Its rate (m/s).
    pub const VELOCITY: DeviceOutput = number("speed", "m/s");
    /// Force (N) of the motor of a prismatic joint.
    pub const MOTOR_FORCE: DeviceOutput = number("force", "N");
    /// Power (W) that the motor supplies.
    pub const POWER: DeviceOutput = number("power", "W");
    /// Force (N) by which the constraints of the joint act on the second side.
    pub const REACTION_FORCE: DeviceOutput =
        DeviceOutput { word: "reaction", unit: "N", is_vector: true };
    /// Moment (N m) of these about the place of the joint, in space.
    pub const REACTION_MOMENT: DeviceOutput =
        DeviceOutput { word: "reaction-moment", unit: "N m", is_vector: true };
    /// The same in the plane, counter-clockwise.
    pub const REACTION_COUPLE: DeviceOutput = number("reaction-moment", "N m");

    /// A joint of a kind with a name, between two sides at a place `at` of the undeformed shape (m).
    pub fn new<S: Into<Selection>>(
        kind: JointKind,
        name: impl Into<String>,
        between: [S; 2],
        at: impl Into<Vec<f64>>,
    ) -> Self {
        let (name, between, at) = (name.into(), between.map(Into::into), at.into());
        Self {
            geometry: Geometry {
                name,
                kind,
                between,
                at,
                axis: Vec::new(),
                second_axis: Vec::new(),
                lead: None,
                bearing: None,
                gear: None,
            },
            law: JointLaw::default(),
        }
    }

    /// A ball joint: both sides have the place in common.
    pub fn spherical<S: Into<Selection>>(
        name: impl Into<String>,
        between: [S; 2],
        at: impl Into<Vec<f64>>,
    ) -> Self {
        Self::new(JointKind::Spherical, name, between, at)
    }

    /// A hinge: both sides have the place and an [axis](Self::axis) in common; in the plane a pin.
    pub fn revolute<S: Into<Selection>>(
        name: impl Into<String>,
        between: [S; 2],
        at: impl Into<Vec<f64>>,
    ) -> Self {
        Self::new(JointKind::Revolute, name, between, at)
    }

    /// A slider along an [axis](Self::axis), without turning; on a body that moves its guide [holds](Self::bearing).
    pub fn prismatic<S: Into<Selection>>(
        name: impl Into<String>,
        between: [S; 2],
        at: impl Into<Vec<f64>>,
    ) -> Self {
        Self::new(JointKind::Prismatic, name, between, at)
    }

    /// A joint that lets the sides neither move nor turn against each other.
    pub fn fixed<S: Into<Selection>>(
        name: impl Into<String>,
        between: [S; 2],
        at: impl Into<Vec<f64>>,
    ) -> Self {
        Self::new(JointKind::Fixed, name, between, at)
    }

    /// A screw along an [axis](Self::axis) in the world: its angle, and for each turn a [lead](Self::lead), by a thread that [holds](Self::bearing).
    pub fn screw<S: Into<Selection>>(
        name: impl Into<String>,
        between: [S; 2],
        at: impl Into<Vec<f64>>,
        lead: f64,
    ) -> Self {
        let mut joint = Self::new(JointKind::Screw, name, between, at);
        joint.geometry.lead = Some(lead);
        joint
    }

    /// A universal joint (Hooke, Cardan): a cross with an axis in the first side and one in the second, at right angles, that [holds](Self::bearing).
    ///
    /// Between shafts at the angle beta, with the first axis across both of them at first, tan a_2 = tan a_1/cos beta.
    pub fn universal<S: Into<Selection>>(
        name: impl Into<String>,
        between: [S; 2],
        at: impl Into<Vec<f64>>,
        axes: [[f64; 3]; 2],
    ) -> Self {
        let joint = Self::new(JointKind::Universal, name, between, at);
        joint.axis(axes[0]).second_axis(axes[1])
    }

    /// The axis of the cross of a universal joint in the second side; [`axis`](Self::axis) is that in the first.
    pub fn second_axis(mut self, axis: impl Into<Vec<f64>>) -> Self {
        self.geometry.second_axis = axis.into();
        self
    }

    /// The displacement (m) of a screw for a turn; below 0 of a left-handed thread.
    pub fn lead(mut self, lead: f64) -> Self {
        self.geometry.lead = Some(lead);
        self
    }

    /// Stiffness and damping by which a thread (N/m, N s/m), the cross of a universal joint (N m/rad, N m s) or a guide on a body that moves (N/m,
    /// N s/m) holds.
    pub fn bearing(mut self, stiffness: f64, damping: f64) -> Self {
        self.geometry.bearing = Some([stiffness, damping]);
        self
    }

    /// Couples its angle with that of another joint by a pair of wheels with so many `teeth`, the other one's first: they turn against each other, with a
    /// negative number, of a ring, alike. The teeth have a stiffness (N m/rad) and a damping (N m s) at this joint.
    pub fn geared(mut self, other: &Self, teeth: [i32; 2], stiffness: f64, damping: f64) -> Self {
        self.geometry.gear = Some(Gear {
            first: Box::new(other.geometry.clone()),
            ratio: Ratio::Teeth(teeth),
            bearing: [stiffness, damping],
        });
        self
    }

    /// Couples its displacement with the angle of another joint, a `lead` (m) for a turn: a pinion of the radius lead/(2 pi) on a rack, a spindle
    /// in a nut. Teeth or thread have a stiffness (N/m) and a damping (N s/m).
    pub fn driven(mut self, other: &Self, lead: f64, stiffness: f64, damping: f64) -> Self {
        self.geometry.gear = Some(Gear {
            first: Box::new(other.geometry.clone()),
            ratio: Ratio::Lead(lead),
            bearing: [stiffness, damping],
        });
        self
    }

    /// The axis of a hinge in space, of a slider in the plane and in space; of any length.
    pub fn axis(mut self, axis: impl Into<Vec<f64>>) -> Self {
        self.geometry.axis = axis.into();
        self
    }

    /// A spring along the coordinate, of a stiffness (N m/rad, N/m), relaxed at `rest` (rad, m).
    pub fn spring(mut self, stiffness: f64, rest: f64) -> Self {
        (self.law.stiffness, self.law.rest) = (stiffness, rest);
        self
    }

    /// Viscous damping (N m s, N s/m) along the coordinate.
    pub fn damping(mut self, damping: f64) -> Self {
        self.law.damping = damping;
        self
    }

    /// Stops of a stiffness (N m/rad, N/m): springs below the first and above the second value of the coordinate (rad, m).
    pub fn stops(mut self, stops: [f64; 2], stiffness: f64) -> Self {
        self.law.stops = Some((stops, stiffness));
        self
    }

    /// Coulomb's friction: a torque (N m) or a force (N) against the motion, which below a speed (default: 0.1 rad/s, 1e-3 m/s) is less, and creeps.
    pub fn friction(mut self, force: f64, sticking_speed: Option<f64>) -> Self {
        let [of_angle, of_displacement] = STICKING_SPEEDS;
        let usual =
            if self.geometry.kind == JointKind::Prismatic { of_displacement } else { of_angle };
        self.law.friction = Some([force, sticking_speed.unwrap_or(usual)]);
        self
    }

    /// A servo: a motor with a torque or a force of `stiffness` (N m/rad, N/m) times the difference of the coordinate from its target, and `damping`
    /// (N m s, N s/m) times that of the rates. A target that no phase sets is 0.
    pub fn servo(mut self, stiffness: f64, damping: f64) -> Self {
        self.law.servo = [stiffness, damping];
        self
    }

    /// The largest torque (N m) or force (N) of the motor.
    pub fn limit(mut self, most: f64) -> Self {
        self.law.most = Some(most);
        self
    }

    /// The speed (rad/s, m/s) at which a motor with a [limit](Self::limit) has no force left: the limit falls along a line to there.
    pub fn no_load_speed(mut self, speed: f64) -> Self {
        self.law.no_load_speed = Some(speed);
        self
    }

    /// Checks it on a body.
    pub(crate) fn check(&self, body: &Body) -> Result<(), InputError> {
        let Geometry { name, kind, .. } = &self.geometry;
        Assembly::new(&self.geometry, body)?;
        self.law.validate(name, kind.moves(), kind.turns())
    }
}

impl Scene {
    /// Adds a joint, which acts in all phases.
    pub fn joint(self, joint: Joint) -> Self {
        self.device(joint)
    }
}

impl Device for Joint {
    fn name(&self) -> &str {
        &self.geometry.name
    }

    fn kind(&self) -> &'static str {
        KEYS[1]
    }

    fn inputs(&self) -> &'static [DeviceInput] {
        match self.geometry.kind {
            JointKind::Revolute | JointKind::Screw => {
                &[Self::TORQUE, Self::TARGET_ANGLE, Self::TARGET_SPEED]
            }
            JointKind::Prismatic => {
                &[Self::FORCE, Self::TARGET_DISPLACEMENT, Self::TARGET_VELOCITY]
            }
            JointKind::Spherical | JointKind::Fixed | JointKind::Universal => &[],
        }
    }

    /// Those of the constraints, then those of the coordinate.
    fn outputs(&self) -> &'static [DeviceOutput] {
        let Geometry { kind, at, .. } = &self.geometry;
        let of_dimension = &OUTPUTS[usize::from(at.len() > 2)];
        let all = &of_dimension[usize::from(*kind == JointKind::Prismatic)];
        if kind.moves() { all } else { &all[..2] }
    }

    fn rows(&self, site: &DeviceSite<'_>) -> Result<Vec<DeviceRow>, InputError> {
        Ok(Assembly::new(&self.geometry, site.body)?.rows())
    }

    fn force(
        &self,
        site: &DeviceSite<'_>,
        inputs: DeviceSignals,
    ) -> Result<Arc<dyn Force>, InputError> {
        self.check(site.body)?;
        self.law.check_targets(&self.geometry.name, |target| inputs.is_set(1 + target))?;
        let Assembly { coordinate, couplings, .. } = Assembly::new(&self.geometry, site.body)?;
        let (name, held) = (&self.geometry.name, (coordinate, couplings));
        Ok(Arc::new(JointForce::new(name, held, self.law.clone(), inputs)))
    }

    fn check_start(&self, site: &DeviceSite<'_>, now: &DeviceState<'_>) -> Result<(), InputError> {
        let assembly = Assembly::new(&self.geometry, site.body)?;
        assembly.check_together(&self.geometry, now.u)?;
        let Some(coordinate) = assembly.coordinate else { return Ok(()) };
        let q = coordinate.at(now.u, now.v, false).value;
        let wrapped = |difference| coordinate.wrapped(difference);
        self.law.check_start(&self.geometry.name, q, wrapped)
    }

    fn gauge(&self, number: usize, site: &DeviceSite<'_>) -> Result<DeviceGauge, InputError> {
        let assembly = Assembly::new(&self.geometry, site.body)?;
        let in_plane = site.body.dimension() == 2;
        if number < 2 {
            return Ok(Box::new(move |now| match now.multipliers {
                None => [f64::NAN; 3],
                Some(multipliers) => {
                    let reaction = assembly.reaction(multipliers, now.u)[number];
                    if in_plane && number == 1 { [reaction.z, 0.0, 0.0] } else { reaction.into() }
                }
            }));
        }
        let Some(coordinate) = assembly.coordinate else { return Ok(Box::new(|_| [0.0; 3])) };
        let law = self.law.clone();
        Ok(Box::new(move |now| {
            let at = coordinate.at(now.u, now.v, false);
            let inputs = [0, 1, 2].map(|input| now.input(input)[0]);
            let wrapped = |difference| coordinate.wrapped(difference);
            let motor = law.motor(inputs, [at.value, at.rate], wrapped).force;
            let all = [at.value, at.rate, motor, motor * at.rate];
            [all[number - 2], 0.0, 0.0]
        }))
    }

    fn on_finer_mesh(
        &self,
        nodes: &dyn Fn(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Arc<dyn Device>, InputError> {
        let mut finer = self.clone();
        let other = finer.geometry.gear.as_mut().map(|gear| &mut gear.first.between);
        let sides = other.into_iter().flatten().chain(&mut finer.geometry.between);
        for side in sides.filter(|side| !is_world(side)) {
            *side = nodes(side)?;
        }
        Ok(Arc::new(finer))
    }

    /// A dot at its place.
    fn needles(&self, now: &DeviceState<'_>) -> Vec<[[f64; 3]; 2]> {
        let built = Assembly::new(&self.geometry, now.body);
        let dot = |own: Assembly| [own.place.at(now.u, now.body.dimension()).into(), [0.0; 3]];
        built.map(dot).into_iter().collect()
    }

    /// A line along its axis.
    fn lines(&self, now: &DeviceState<'_>) -> Vec<[[f64; 3]; 2]> {
        let d = now.body.dimension();
        let line = |own: Assembly| {
            let half = own.axis?.at(now.u, d) * own.size;
            let place = own.place.at(now.u, d);
            Some([(place - half).into(), (place + half).into()])
        };
        Assembly::new(&self.geometry, now.body).ok().and_then(line).into_iter().collect()
    }
}

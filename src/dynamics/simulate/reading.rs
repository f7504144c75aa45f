//! Quantities that can be read from a motion, by name.

use std::f64::consts::TAU;
use std::iter::repeat_n;

use super::component::Component;
use super::output::{Output, Read};
use super::spot::Spot;
use crate::base::input::InputError;
use crate::dynamics::trajectory::DEGREES;
use crate::elements::mesh::Selection;
use crate::scene::timeline::{DeviceOutput, Scene};

/// A quantity that a sensor reads: see [`Sampling::read`](crate::Sampling::read).
///
/// Positions and the like of several nodes are means over them; forces are sums.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    pub(super) what: ReadingKind,
    pub(super) component: Option<Component>,
    /// Whether angles are in degrees.
    pub(super) in_degrees: bool,
    /// The name of the body that is read; all of them together without one.
    pub(super) body: Option<String>,
    /// How often each node counts in a mean, in their order; each once without.
    pub(super) counts: Option<Box<[usize]>>,
}

/// Quantity of a reading.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ReadingKind {
    Position(Spot),
    Displacement(Spot),
    Velocity(Spot),
    Acceleration(Spot),
    ConstraintForce(Selection),
    ConstraintMoment(Selection, Lever),
    /// Of an obstacle on all nodes, of a touch on the body that is read, of both on these nodes.
    Contact(OfContact, ContactSource, Option<Selection>),
    /// Of a touch.
    Gap(String),
    /// Of the component with a name.
    Of(&'static Output, String),
    /// Of the device with a name.
    OfDevice(&'static DeviceOutput, String),
    MagneticMoment,
    /// Of all nodes, or of these.
    FluidForce(String, Option<Selection>),
    Stress(FieldPoint),
    Strain(FieldPoint),
    Distance([Selection; 2]),
    Angle([[Selection; 2]; 2]),
    CentreOfMass,
    Momentum,
    /// Of a body, or of these nodes.
    Rotation(Option<Selection>),
    AngularVelocity(Option<Selection>),
    AngularAcceleration(Option<Selection>),
    Accelerometer(Option<Selection>),
    Gyroscope(Option<Selection>),
}

/// Quantity of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OfContact {
    Force,
    /// The area in contact.
    Area,
    /// The largest one.
    Pressure,
}

/// Source of a contact: an obstacle, or bodies that touch.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ContactSource {
    Obstacle(String),
    Touch(String),
}

/// The point and axis of a moment.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lever {
    /// A point (m).
    pub(super) about: Vec<f64>,
    /// The direction along which the moment is read; the whole vector if there is none.
    pub(super) axis: Option<Vec<f64>>,
}

/// Where a field is read.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum FieldPoint {
    Nodes(Selection),
    Point(Vec<f64>),
}

impl Reading {
    /// Position (m) of nodes, or of another [spot](Spot).
    pub fn position(place: impl Into<Spot>) -> Self {
        ReadingKind::Position(place.into()).into()
    }

    /// Displacement (m) of nodes, or of another [spot](Spot), from the undeformed position.
    pub fn displacement(place: impl Into<Spot>) -> Self {
        ReadingKind::Displacement(place.into()).into()
    }

    /// Velocity (m/s) of nodes, or of another [spot](Spot).
    pub fn velocity(place: impl Into<Spot>) -> Self {
        ReadingKind::Velocity(place.into()).into()
    }

    /// Acceleration (m/s^2) of nodes, or of another [spot](Spot), by the equations of motion in the state of a sample.
    /// In equilibria it is 0.
    pub fn acceleration(place: impl Into<Spot>) -> Self {
        ReadingKind::Acceleration(place.into()).into()
    }

    /// Force of the constraints on nodes together (N), their reaction:
    /// see [`Trajectory::constraint_force`](crate::Trajectory::constraint_force).
    pub fn constraint_force(nodes: impl Into<Selection>) -> Self {
        ReadingKind::ConstraintForce(nodes.into()).into()
    }

    /// Moment (N m) of the constraints on nodes together about the point `about` (m), fixed in space.
    ///
    /// It is the sum of (x - about) x f over the nodes, with x their present positions and f the constraint
    /// forces. In the plane it is a number, counter-clockwise; on a line there is none.
    pub fn constraint_moment(nodes: impl Into<Selection>, about: impl Into<Vec<f64>>) -> Self {
        ReadingKind::ConstraintMoment(nodes.into(), Lever { about: about.into(), axis: None })
            .into()
    }

    /// The component of the constraint moment along an `axis` through `about`, of a body in space.
    ///
    /// It is a number: the torque that [`Phase::rotate`](crate::Phase::rotate) requires about its axis. The
    /// axis may have any length above 0.
    pub fn constraint_torque(
        nodes: impl Into<Selection>,
        about: impl Into<Vec<f64>>,
        axis: impl Into<Vec<f64>>,
    ) -> Self {
        let lever = Lever { about: about.into(), axis: Some(axis.into()) };
        ReadingKind::ConstraintMoment(nodes.into(), lever).into()
    }

    /// Force of an obstacle on the body (N).
    pub fn contact_force(obstacle: impl Into<String>) -> Self {
        ReadingKind::Contact(OfContact::Force, ContactSource::Obstacle(obstacle.into()), None)
            .into()
    }

    /// Force of an obstacle on some nodes together (N), such as of one finger of a gripper whose forces on
    /// the body cancel each other: see [`View::contact_force_on`](crate::View::contact_force_on).
    pub fn contact_force_on(obstacle: impl Into<String>, nodes: impl Into<Selection>) -> Self {
        Self::contact_force(obstacle).on(nodes)
    }

    /// Force (N) of bodies that [touch](crate::Touch) on one [of them](Self::of_body) or [on](Self::on) some nodes.
    pub fn touch_force(touch: impl Into<String>) -> Self {
        ReadingKind::Contact(OfContact::Force, ContactSource::Touch(touch.into()), None).into()
    }

    /// Area (m^2) of the surface that an obstacle touches, of all bodies or [on](Self::on) some nodes: see
    /// [`NodalContact::area`](crate::NodalContact::area). A string has none.
    pub fn contact_area(obstacle: impl Into<String>) -> Self {
        ReadingKind::Contact(OfContact::Area, ContactSource::Obstacle(obstacle.into()), None).into()
    }

    /// Area (m^2) of the surface of one [of several bodies](Self::of_body), or [on](Self::on) some nodes, that others
    /// [touch](crate::Touch).
    pub fn touch_area(touch: impl Into<String>) -> Self {
        ReadingKind::Contact(OfContact::Area, ContactSource::Touch(touch.into()), None).into()
    }

    /// The largest contact pressure (Pa) of an obstacle at any node, or [at](Self::on) some of them: see
    /// [`NodalContact::pressure`](crate::NodalContact::pressure).
    pub fn contact_pressure(obstacle: impl Into<String>) -> Self {
        ReadingKind::Contact(OfContact::Pressure, ContactSource::Obstacle(obstacle.into()), None)
            .into()
    }

    /// The largest contact pressure (Pa) of bodies that [touch](crate::Touch) at any node of one
    /// [of them](Self::of_body), or [at](Self::on) some nodes.
    pub fn touch_pressure(touch: impl Into<String>) -> Self {
        ReadingKind::Contact(OfContact::Pressure, ContactSource::Touch(touch.into()), None).into()
    }

    /// The least gap (m) between the surfaces of bodies of a [touch](crate::Touch), at most its contact
    /// distance.
    pub fn gap(touch: impl Into<String>) -> Self {
        ReadingKind::Gap(touch.into()).into()
    }

    /// The part of the force of a contact or a fluid, or of an area in touch, that belongs to some nodes; the largest contact pressure at
    /// these; how these turn, instead of a body.
    pub fn on(mut self, nodes: impl Into<Selection>) -> Self {
        use ReadingKind::*;
        if let Contact(_, _, on)
        | FluidForce(_, on)
        | Rotation(on)
        | AngularVelocity(on)
        | AngularAcceleration(on)
        | Accelerometer(on)
        | Gyroscope(on) = &mut self.what
        {
            *on = Some(nodes.into());
        }
        self
    }

    /// Magnetic moment of all magnets (A m^2).
    pub fn magnetic_moment() -> Self {
        ReadingKind::MagneticMoment.into()
    }

    /// Force of a [fluid](crate::Fluid) (N), drag and pressure, on all nodes, on [some](Self::on) or on those of one
    /// [body](Self::of_body). The effect of added mass is inertia and not part of this force.
    pub fn fluid_force(fluid: impl Into<String>) -> Self {
        ReadingKind::FluidForce(fluid.into(), None).into()
    }

    /// Stress at nodes (Pa), of the elastic law and of Maxwell branches, without viscosity: see
    /// [`Body::nodal_fields`](crate::Body::nodal_fields), which has that of the elastic law alone.
    pub fn stress(nodes: impl Into<Selection>) -> Self {
        ReadingKind::Stress(FieldPoint::Nodes(nodes.into())).into()
    }

    /// Stress (Pa) at the point of the body whose undeformed position is `x` (m): interpolated from the nodes
    /// around it by their shape functions.
    pub fn stress_at(x: impl Into<Vec<f64>>) -> Self {
        ReadingKind::Stress(FieldPoint::Point(x.into())).into()
    }

    /// Strain at nodes, as [`stress`](Self::stress).
    pub fn strain(nodes: impl Into<Selection>) -> Self {
        ReadingKind::Strain(FieldPoint::Nodes(nodes.into())).into()
    }

    /// Strain at a point, as [`stress_at`](Self::stress_at).
    pub fn strain_at(x: impl Into<Vec<f64>>) -> Self {
        ReadingKind::Strain(FieldPoint::Point(x.into())).into()
    }

    /// Distance (m) between nodes, or the middles of sets.
    pub fn distance(from: impl Into<Selection>, to: impl Into<Selection>) -> Self {
        ReadingKind::Distance([from.into(), to.into()]).into()
    }

    /// Angle (rad) from one line to another, each from its first node (or middle of a set) to its second: in the plane
    /// counter-clockwise, in space without sign, between 0 and pi.
    ///
    /// In the plane it begins between -pi and pi and is continuous over whole turns from there: the run
    /// follows it from step to step of the integrator, whenever samples are taken, and checkpoints and forks
    /// keep it. A rotation by half a turn or more within one step, or one load step of statics, cannot be
    /// distinguished from one in the other direction. [`Simulation::record`](crate::Simulation::record) in
    /// the middle of a run starts again between -pi and pi, except for sensors of the name and kind that were
    /// read until then.
    pub fn angle<S: Into<Selection>>(from: [S; 2], to: [S; 2]) -> Self {
        ReadingKind::Angle([from, to].map(|line| line.map(Into::into))).into()
    }

    /// Where the centre of mass of all bodies is, or of one [of them](Self::of_body) (m).
    pub fn centre_of_mass() -> Self {
        ReadingKind::CentreOfMass.into()
    }

    /// Rotation (rad) of a body as a whole, or [of some nodes](Self::on), from the undeformed shape.
    ///
    /// It is the rotation that brings the undeformed shape nearest to the present one, in the mean square over the mass of a
    /// body, or over nodes with equal weights. In the plane it is an angle, counter-clockwise, continuous over whole turns like
    /// [`angle`](Self::angle) (and that of [`Trajectory::rotation`](crate::Trajectory::rotation) up to these); in space a vector along the axis, of a length
    /// between 0 and pi. It is not defined for nodes in one position, in space on one line.
    pub fn rotation() -> Self {
        ReadingKind::Rotation(None).into()
    }

    /// Angular velocity (rad/s) of a body as a whole, or [of some nodes](Self::on): in the plane a number, counter-clockwise, in
    /// space a vector.
    ///
    /// It is the rate at which the [rotation](Self::rotation) R changes, omega x = R' R^T. For a rigid motion it is inertia^-1
    /// times angular momentum, for any weights.
    pub fn angular_velocity() -> Self {
        ReadingKind::AngularVelocity(None).into()
    }

    /// Rate (rad/s^2) of the [angular velocity](Self::angular_velocity), from the accelerations of the equations of motion; 0 in
    /// equilibria.
    pub fn angular_acceleration() -> Self {
        ReadingKind::AngularAcceleration(None).into()
    }

    /// The reading of an accelerometer (m/s^2) that is fixed to a body, or to [some nodes](Self::on), in axes that turn with these: R^T (a - g)
    /// with their [rotation](Self::rotation) R and the acceleration a of their mean position, for a body its centre of mass. In free fall it reads
    /// 0, at rest g upwards.
    pub fn accelerometer() -> Self {
        ReadingKind::Accelerometer(None).into()
    }

    /// The reading of a gyroscope (rad/s) that is fixed to a body, or to [some nodes](Self::on): their [angular
    /// velocity](Self::angular_velocity) in axes that turn with them.
    pub fn gyroscope() -> Self {
        ReadingKind::Gyroscope(None).into()
    }

    /// Momentum of all bodies, or of one [of them](Self::of_body) (kg m/s).
    pub fn momentum() -> Self {
        ReadingKind::Momentum.into()
    }

    /// The reading of one of several bodies: its centre of mass, rotation and momentum, the force of a touch or a fluid on it. Default: that of all together.
    pub fn of_body(mut self, name: impl Into<String>) -> Self {
        self.body = Some(name.into());
        self
    }

    /// An angle in degrees. Default: rad.
    pub fn in_degrees(mut self) -> Self {
        self.in_degrees = true;
        self
    }

    /// One component alone. Default: all of them, each a column.
    pub fn component(mut self, component: Component) -> Self {
        self.component = Some(component);
        self
    }

    /// An output of the component with a `name`.
    #[cfg(feature = "scene-file")]
    pub(crate) fn of(output: &'static Output, name: impl Into<String>) -> Self {
        ReadingKind::Of(output, name.into()).into()
    }

    /// Unit of the numbers.
    pub(crate) fn unit(&self) -> &'static str {
        match self.what {
            ReadingKind::Position(_) | ReadingKind::Displacement(_) | ReadingKind::CentreOfMass => {
                "m"
            }
            ReadingKind::Distance(_) => "m",
            ReadingKind::Of(output, _) => output.unit,
            ReadingKind::OfDevice(..) if self.in_degrees => DEGREES,
            ReadingKind::OfDevice(output, _) => output.unit,
            ReadingKind::Velocity(_) => "m/s",
            ReadingKind::Acceleration(_) | ReadingKind::Accelerometer(_) => "m/s^2",
            ReadingKind::AngularVelocity(_) | ReadingKind::Gyroscope(_) => "rad/s",
            ReadingKind::AngularAcceleration(_) => "rad/s^2",
            ReadingKind::Momentum => "kg m/s",
            ReadingKind::MagneticMoment => "A m^2",
            ReadingKind::ConstraintForce(_) | ReadingKind::Contact(OfContact::Force, ..) => "N",
            ReadingKind::FluidForce(..) => "N",
            ReadingKind::Contact(OfContact::Area, ..) => "m^2",
            ReadingKind::Contact(OfContact::Pressure, ..) => "Pa",
            ReadingKind::Gap(_) => "m",
            ReadingKind::ConstraintMoment(..) => "N m",
            ReadingKind::Stress(_) => "Pa",
            ReadingKind::Strain(_) => "1",
            ReadingKind::Angle(_) | ReadingKind::Rotation(_) if self.in_degrees => DEGREES,
            ReadingKind::Angle(_) | ReadingKind::Rotation(_) => "rad",
        }
    }

    /// The nodes of a mean, each as often as it counts.
    pub(super) fn counted(&self, nodes: Vec<usize>) -> Vec<usize> {
        let Some(counts) = &self.counts else { return nodes };
        let counted = nodes.into_iter().zip(counts);
        counted.flat_map(|(node, count)| repeat_n(node, *count)).collect()
    }

    /// A full turn in the unit of an angle.
    pub(super) fn full_turn(&self) -> f64 {
        if self.in_degrees { 360.0 } else { TAU }
    }

    /// Whether it reads forces of constraints, which take an evaluation of all forces, or may.
    pub(super) fn is_of_constraints(&self, scene: &Scene) -> bool {
        match &self.what {
            ReadingKind::OfDevice(_, name) => scene.joins(name),
            what => {
                matches!(what, ReadingKind::ConstraintForce(_) | ReadingKind::ConstraintMoment(..))
            }
        }
    }

    /// Whether it reads accelerations, which take one, too.
    pub(super) fn is_of_accelerations(&self) -> bool {
        use ReadingKind::*;
        matches!(self.what, Acceleration(_) | AngularAcceleration(_) | Accelerometer(_))
    }

    /// Whether it follows from the places of nodes alone.
    pub(super) fn is_of_places(&self) -> bool {
        use ReadingKind::*;
        match &self.what {
            Of(output, _) => matches!(output.read, Read::OfPositions(_)),
            Position(_) | Displacement(_) | Distance(_) | Angle(_) => true,
            CentreOfMass | Rotation(_) | Strain(_) => true,
            _ => false,
        }
    }

    /// Whether it is continuous over whole turns, for a body in `dimension` dimensions.
    pub(super) fn turns(&self, dimension: usize) -> bool {
        self.is_angle() && (dimension == 2 || matches!(self.what, ReadingKind::OfDevice(..)))
    }

    fn is_angle(&self) -> bool {
        match &self.what {
            ReadingKind::OfDevice(output, _) => output.is_angle(),
            what => matches!(what, ReadingKind::Angle(_) | ReadingKind::Rotation(_)),
        }
    }

    /// The components that are read for a body in `dimension` dimensions; none for a number.
    ///
    /// # Errors
    /// A component that the quantity does not have; degrees for a quantity that is not an angle.
    pub(super) fn components(&self, dimension: usize) -> Result<Vec<Component>, InputError> {
        use Component::*;
        if self.in_degrees && !self.is_angle() {
            let help = format!("angles and rotations alone have it, this is in {}", self.unit());
            return Err(InputError::new("unit", format!("\"{DEGREES}\""), help));
        }
        let is_of_bodies = matches!(
            self.what,
            ReadingKind::CentreOfMass
                | ReadingKind::Rotation(_)
                | ReadingKind::AngularVelocity(_)
                | ReadingKind::AngularAcceleration(_)
                | ReadingKind::Accelerometer(_)
                | ReadingKind::Gyroscope(_)
                | ReadingKind::Momentum
                | ReadingKind::Contact(_, ContactSource::Touch(_), _)
                | ReadingKind::FluidForce(..)
        );
        if let Some(name) = self.body.as_ref().filter(|_| !is_of_bodies) {
            let help = "the centre of mass, how it turns, the momentum and what a touch or a fluid does are all that is read of a body: name its nodes instead";
            return Err(InputError::new("body", format!("\"{name}\""), help));
        }
        // the components that are columns by default, and one more that must be requested
        let (all, more): (&[Component], _) = match (&self.what, dimension) {
            (ReadingKind::Stress(_), 1) => (&[XX], Some(VonMises)),
            (ReadingKind::Stress(_), 2) => (&[XX, YY, ZZ, XY], Some(VonMises)),
            (ReadingKind::Stress(_), _) => (&[XX, YY, ZZ, XY, YZ, XZ], Some(VonMises)),
            (ReadingKind::Strain(_), 1) => (&[XX], None),
            (ReadingKind::Strain(_), 2) => (&[XX, YY, ZZ, XY], None),
            (ReadingKind::Strain(_), _) => (&[XX, YY, ZZ, XY, YZ, XZ], None),
            (ReadingKind::Position(_) | ReadingKind::Displacement(_), _)
            | (ReadingKind::Velocity(_) | ReadingKind::Acceleration(_), _)
            | (ReadingKind::Accelerometer(_), _)
            | (ReadingKind::ConstraintForce(_) | ReadingKind::Contact(OfContact::Force, ..), _)
            | (
                ReadingKind::CentreOfMass | ReadingKind::Momentum | ReadingKind::MagneticMoment,
                _,
            )
            | (
                ReadingKind::FluidForce(..)
                | ReadingKind::Of(Output { read: Read::Vector(_), .. }, _),
                _,
            )
            | (ReadingKind::OfDevice(DeviceOutput { is_vector: true, .. }, _), _) => {
                (&[X, Y, Z][..dimension], Some(Norm))
            }
            (ReadingKind::ConstraintMoment(_, Lever { axis: None, .. }), 3)
            | (ReadingKind::Rotation(_) | ReadingKind::AngularVelocity(_), 3)
            | (ReadingKind::AngularAcceleration(_) | ReadingKind::Gyroscope(_), 3) => {
                (&[X, Y, Z], Some(Norm))
            }
            _ => (&[], None),
        };
        let Some(one) = self.component else { return Ok(all.to_vec()) };
        let known: Vec<Component> = all.iter().copied().chain(more).collect();
        one.check(&known)?;
        Ok(vec![one])
    }
}

impl From<ReadingKind> for Reading {
    fn from(what: ReadingKind) -> Self {
        Self { what, component: None, in_degrees: false, body: None, counts: None }
    }
}

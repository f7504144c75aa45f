//! Springs between two nodes, or a node and a point of space, with damping and an actuator; cables, which run around places
//! in between and only pull.
//!
//! A spring couples nodes that may share no cell: `Force::couplings` widens the pattern for all phases at
//! once. Its direction is undefined at length 0. A force must not refuse trial points near such a state, as
//! integrators would approach it with ever smaller steps; instead each accepted step is checked
//! (`StepCheck::check_step`), and a spring shorter than a hundredth of its natural length, or turned by more than
//! a right angle, ends the run by name.

mod bend;
mod cable;
mod force;
mod path;
#[cfg(test)]
mod tests;

use std::cmp::Ordering;
use std::sync::Arc;

use cable::{Cable, CableForce};
use force::{Driven, Elastic};
use path::{COLLAPSED, Path};

use super::actuator::{
    Actuator, ActuatorGauge, ActuatorKind, ComponentMap, Drive, LinePoint, Placed,
};
use super::friction::Friction;
use super::signal::Signal;
use super::surface::natural;
use crate::base::input::{InputError, finite, not_negative, positive};
use crate::base::vector::norm;
use crate::elements::body::Body;
use crate::elements::force::{Force, Forces};
use crate::elements::mesh::{NodeMap, Selection};

/// A spring between two nodes, or between a node and a fixed point of space.
///
/// Its length is l, along the unit vector e from the first end to the second. With the natural length L,
/// stiffness k, damping c and actuation force f, the force on the second end is
///
/// (f - k (l - L) - c l') e
///
/// and the opposite on the first one: f > 0 extends the spring. It may join any nodes, also point masses
/// ([`point_mass`](crate::elements::body::BodyBuilder::point_mass)). Phases actuate it
/// ([`Phase::actuate`](crate::Phase::actuate)).
///
/// A run in which a spring gets shorter than a hundredth of L ends with an error that names it: it
/// has no direction there, and no real spring gets so short.
///
/// ```
/// use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings, Spring};
///
/// let mesh = Mesh::rectangle([0.02, 0.02], [2, 2], Cells::Triangles)?;
/// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// let body = Body::new(mesh, rubber).thickness(0.01).point_mass("bob", [0.0, -0.04], 0.001);
/// let scene = Scene::new(body.build()?)
///     .spring(Spring::between([1], "bob").named("A1").stiffness(20.0))
///     .phase(Phase::until(0.05).hold([1, 2, 3, 4]).actuate(["A1"], -0.1));
/// let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.01))?;
/// assert!(trajectory.last().u[2 * 4 + 1] > 0.0); // the bob is pulled up
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Spring {
    name: String,
    path: Vec<Guide>,
    kind: Kind,
    stiffness: f64,
    length: Option<f64>,
    damping: f64,
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    Spring,
    Cable { is_winch: bool, friction: Friction },
}

/// A point on the path of a [cable](Spring::cable): nodes that guide it, a point in the body, or a fixed point of space.
#[derive(Debug, Clone)]
pub struct Guide(GuidePoint);

#[derive(Debug, Clone)]
enum GuidePoint {
    Nodes(Selection),
    Inside(Vec<f64>),
    Point(Vec<f64>),
}

impl Guide {
    /// Nodes of the body: numbers in their order, those of a set or a box by their distance from the point before them, or
    /// from the first of them.
    pub fn nodes(nodes: impl Into<Selection>) -> Self {
        Self(GuidePoint::Nodes(nodes.into()))
    }

    /// The point in the body, within a cell or on its surface, whose undeformed position is `place` (m). It moves with the body, independently of
    /// nearby nodes, so that a finer mesh has the same guides. If several bodies contain it, it belongs to the first; in a rod it is a point of a cross
    /// section, on its axis or not.
    ///
    /// ```
    /// use pliant::{Body, Cells, Guide, Material, Mesh, Phase, Sampling, Scene, Settings, Spring};
    ///
    /// let tip = |cells: usize| -> Result<f64, pliant::Error> {
    ///     let mesh = Mesh::rectangle([0.1, 0.01], [cells + 1, 3], Cells::Rectangles9)?;
    ///     let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 1e4 };
    ///     let guides = (0..=4).map(|k| Guide::inside([0.025 * f64::from(k), 0.008]));
    ///     let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
    ///         .spring(Spring::cable(guides).named("tendon"))
    ///         .phase(Phase::until(0.2).hold("left").actuate(["tendon"], 0.1));
    ///     let motion = scene.simulate(&Settings::default(), &Sampling::every(0.2))?;
    ///     let end = motion.body().mesh().select(&"right".into())?[0];
    ///     Ok(motion.last().u[2 * end + 1])
    /// };
    /// assert!((tip(13)? / tip(26)? - 1.0).abs() < 0.01);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn inside(place: impl Into<Vec<f64>>) -> Self {
        Self(GuidePoint::Inside(place.into()))
    }

    /// A `point` of space (m), which stays where it is.
    pub fn point(point: impl Into<Vec<f64>>) -> Self {
        Self(GuidePoint::Point(point.into()))
    }
}

impl Spring {
    /// A spring from the node that `first` selects to the one that `second` selects.
    pub fn between(first: impl Into<Selection>, second: impl Into<Selection>) -> Self {
        Self::new(vec![Guide::nodes(first), Guide::nodes(second)], Kind::Spring)
    }

    /// A spring from the node that `node` selects to a `point` of space (m), which stays where it is.
    pub fn anchored(node: impl Into<Selection>, point: impl Into<Vec<f64>>) -> Self {
        Self::new(vec![Guide::nodes(node), Guide::point(point)], Kind::Spring)
    }

    /// A cable (tendon) along a path: straight from point to point, free to slide around those between its ends. It carries
    /// tension only, the same along the whole path if there is no [friction](Self::friction_coefficient).
    ///
    /// With the length l of the path, natural length L (default: that of the path in the undeformed shape),
    /// stiffness k and damping c its tension is
    ///
    /// max(0, k max(0, l - L) + f + c l')
    ///
    /// with the tension f (N) that [`Phase::actuate`](crate::Phase::actuate) sets (negative values count as 0); 0 where neither
    /// stretch nor f keeps it taut. A drive whose tension falls with its speed, from f at rest to 0 at the speed v
    /// (a motor), is a damping of f/v.
    ///
    /// ```
    /// use pliant::{Body, Cells, Guide, Material, Mesh, Phase, Sampling, Scene, Settings, Spring};
    ///
    /// let mesh = Mesh::rectangle([0.1, 0.01], [11, 2], Cells::Rectangles)?;
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 1e4 };
    /// let body = Body::new(mesh, rubber).thickness(0.01).build()?;
    /// let tendon = Spring::cable([Guide::point([-0.01, 0.01]), Guide::nodes("top")]).named("tendon");
    /// let pull = Phase::until(0.2).hold("left").actuate(["tendon"], 0.1);
    /// let scene = Scene::new(body).spring(tendon).phase(pull);
    /// let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.1))?;
    /// assert!(trajectory.last().u[2 * 10 + 1] > 0.001); // the tip is pulled up by 1 mm and more
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn cable(path: impl IntoIterator<Item = Guide>) -> Self {
        let kind = Kind::Cable { is_winch: false, friction: Friction::default() };
        Self::new(path.into_iter().collect(), kind)
    }

    /// A winch at the first point that drives a [cable](Self::cable): [`Phase::actuate`](crate::Phase::actuate) sets the length w (m)
    /// that it has drawn in, and the tension is
    ///
    /// max(0, k (l - L + w) + c (l' + w'))
    ///
    /// and 0 where the cable is slack. It needs a stiffness. The elastic energy of its cable counts as supplied by the winch.
    pub fn winch(mut self) -> Self {
        if let Kind::Cable { is_winch, .. } = &mut self.kind {
            *is_winch = true;
        }
        self
    }

    /// Coefficient mu of Coulomb's friction of a [cable](Self::cable) around the points between its ends, static and kinetic, 0 or
    /// above (default: no friction).
    ///
    /// Where the cable turns by the angle theta and slides towards its drive, the first point, the tension beyond is smaller
    /// by exp(-mu theta), and greater where it slides the other way. Below the [sticking speed](Self::sticking_speed) it creeps, as
    /// on [obstacles](crate::Obstacle#friction). At rest (statics) there is none.
    pub fn friction_coefficient(self, coefficient: f64) -> Self {
        self.friction_coefficients(coefficient, coefficient)
    }

    /// Coefficients of friction of a cable: `at_rest` (static), and `sliding` (kinetic), not above it.
    pub fn friction_coefficients(self, at_rest: f64, sliding: f64) -> Self {
        self.rubbing(|friction| friction.coefficients = Some([at_rest, sliding]))
    }

    /// The speed (m/s) below which a cable with friction creeps instead of sticking, above 0. Default: 0.001 times its natural
    /// length per second.
    pub fn sticking_speed(self, speed: f64) -> Self {
        self.rubbing(|friction| friction.sticking_speed = Some(speed))
    }

    fn rubbing(mut self, change: impl FnOnce(&mut Friction)) -> Self {
        if let Kind::Cable { friction, .. } = &mut self.kind {
            change(friction);
        }
        self
    }

    fn new(path: Vec<Guide>, kind: Kind) -> Self {
        Self { name: String::new(), path, kind, stiffness: 0.0, length: None, damping: 0.0 }
    }

    /// Name of the spring (default: "spring 1", "spring 2", ... in the order of the scene).
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Stiffness k (N/m), 0 or above (default 0: an actuator alone).
    pub fn stiffness(mut self, stiffness: f64) -> Self {
        self.stiffness = stiffness;
        self
    }

    /// Natural length L (m), above 0. Default: that in the undeformed shape.
    pub fn length(mut self, length: f64) -> Self {
        self.length = Some(length);
        self
    }

    /// Damping c (N s/m), 0 or above (default 0).
    pub fn damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// Name of the spring.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether it is a cable, whose actuation is a tension or a length that is drawn in.
    pub fn is_cable(&self) -> bool {
        matches!(self.kind, Kind::Cable { .. })
    }

    pub(crate) fn or_named(self, name: String) -> Self {
        if self.name.is_empty() { self.named(name) } else { self }
    }

    /// Attachments of a spring, or guide points of a cable, in order.
    ///
    /// # Errors
    /// Ends of a spring that are not one node each; less than two places; a point with a wrong number of coordinates.
    fn joints(&self, body: &Body) -> Result<Vec<LinePoint>, InputError> {
        let mesh = body.mesh();
        let mut joints: Vec<LinePoint> = Vec::new();
        for (number, Guide(place)) in (1..).zip(&self.path) {
            let input = |key: &str| match (self.is_cable(), number) {
                (true, _) => self.input(&format!("place {number}")),
                (_, 1) => self.input(&format!("first {key}")),
                _ => self.input(&format!("second {key}")),
            };
            match place {
                GuidePoint::Nodes(selection) => {
                    let mut nodes = mesh.select(selection)?;
                    if !self.is_cable() && nodes.len() != 1 {
                        let help = format!("it selects {} nodes: an end is one node", nodes.len());
                        return Err(InputError::new(input("end"), selection, help));
                    }
                    // numbers are in the order in which they are given
                    if !matches!(selection, Selection::Numbers(_)) {
                        let before = joints.last().map_or(natural(mesh, nodes[0]), |last| last.at);
                        let far = |node: usize| distance(&before, &natural(mesh, node));
                        nodes.sort_by(|a, b| far(*a).total_cmp(&far(*b)));
                    }
                    let joint =
                        |node| LinePoint { at: natural(mesh, node), shares: vec![(node, 1.0)] };
                    joints.extend(nodes.into_iter().map(joint));
                }
                GuidePoint::Inside(point) | GuidePoint::Point(point) => {
                    let given = || format!("{point:?}");
                    if point.len() != mesh.dimension() {
                        let help = format!("it needs {} coordinates (m)", mesh.dimension());
                        return Err(InputError::new(input("end"), given(), help));
                    }
                    finite(&input("end"), point)?;
                    let shares = match place {
                        GuidePoint::Inside(place) => body
                            .shares_at(place)
                            .map_err(|error| InputError { input: input("end"), ..error })?,
                        _ => Vec::new(),
                    };
                    let at = std::array::from_fn(|i| point.get(i).copied().unwrap_or(0.0));
                    joints.push(LinePoint { at, shares });
                }
            }
        }
        match joints.len() {
            0 | 1 => {
                let help = "a cable runs from one place to another: name two at least";
                Err(InputError::new(self.input("number of places"), joints.len(), help))
            }
            _ => Ok(joints),
        }
    }

    fn input(&self, key: &str) -> String {
        format!("{} \"{}\" {key}", self.what(), self.name)
    }

    fn what(&self) -> &'static str {
        if self.is_cable() { "cable" } else { "spring" }
    }

    /// Where the spring runs.
    ///
    /// # Errors
    /// As [`joints`](Self::joints); places that follow each other and are the same; numbers out of range.
    fn checked(&self, body: &Body) -> Result<Path, InputError> {
        let input = |key: &str| self.input(key);
        let joints = self.joints(body)?;
        not_negative(&input("stiffness"), self.stiffness, "N/m")?;
        not_negative(&input("damping"), self.damping, "N s/m")?;
        let places: Vec<[f64; 3]> = joints.iter().map(|joint| joint.at).collect();
        let along = |pair: &[[f64; 3]]| std::array::from_fn(|i| pair[1][i] - pair[0][i]);
        let lines: Vec<[f64; 3]> = places.windows(2).map(along).collect();
        let lengths = || lines.iter().map(|line| norm(line));
        let whole = lengths().sum::<f64>();
        let length = match self.length {
            Some(length) => positive(&input("length"), length, "m")?,
            None => whole,
        };
        let least = lengths().fold(f64::INFINITY, f64::min);
        let (key, scale, what) = match lines.len() {
            1 => ("distance of its ends", length, "its ends"),
            lines => {
                ("least distance of places that follow each other", whole / lines as f64, "they")
            }
        };
        if least <= COLLAPSED * scale {
            let help = format!(
                "{what} are in the same place, so that it has no direction: move them apart"
            );
            return Err(InputError::new(input(key), format!("{least} m"), help));
        }
        if joints.iter().all(|joint| joint.shares.is_empty()) {
            let help = "none of them is of the body, so that it moves nothing: name one at least";
            return Err(InputError::new(input("places"), format!("{places:?}"), help));
        }
        Ok(Path {
            what: self.what(),
            name: self.name.clone(),
            dimension: body.dimension(),
            places: joints.into_iter().map(|joint| joint.shares).collect(),
            natural: lines,
            length,
        })
    }

    /// The law of the spring without what drives it.
    ///
    /// # Errors
    /// As [`joints`](Self::joints); places that follow each other and are the same; numbers out of range.
    fn law(&self, body: &Body) -> Result<Pull, InputError> {
        let path = self.checked(body)?;
        let (stiffness, damping) = (self.stiffness, self.damping);
        let Kind::Cable { is_winch, friction } = self.kind else {
            return Ok(Pull::Spring(Elastic { path, stiffness, damping }));
        };
        friction.validate(&|key| self.input(key))?;
        if is_winch && stiffness == 0.0 {
            let help = "a winch stretches its cable: give it a stiffness (E A / L)";
            return Err(InputError::new(self.input("stiffness"), "0 N/m", help));
        }
        let friction = if friction.acts() { friction.coulomb(path.length) } else { None };
        Ok(Pull::Cable(Cable { path, stiffness, damping, is_winch, friction }))
    }

    /// The forces of the spring, driven by the sum of the signals `actuation`.
    ///
    /// # Errors
    /// As [`law`](Self::law).
    pub(super) fn forces(
        &self,
        body: &Body,
        actuation: Vec<Signal>,
    ) -> Result<Vec<Arc<dyn Force>>, InputError> {
        Ok(match self.law(body)? {
            Pull::Cable(cable) => vec![Arc::new(CableForce { cable, drive: actuation })],
            Pull::Spring(elastic) if actuation.is_empty() => vec![Arc::new(elastic)],
            Pull::Spring(elastic) => {
                let actuator = Driven { path: elastic.path.clone(), force: actuation };
                vec![Arc::new(elastic), Arc::new(actuator)]
            }
        })
    }
}

enum Pull {
    Spring(Elastic),
    Cable(Cable),
}

impl Pull {
    /// Length (m) under the displacements `u`.
    fn length(&self, u: &[f64]) -> f64 {
        let (Self::Spring(Elastic { path, .. }) | Self::Cable(Cable { path, .. })) = self;
        path.length(u)
    }

    /// The forces with which the first and the last line of its path pull (N), under an actuation with its rate.
    fn pulls(&self, u: &[f64], v: &[f64], actuation: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Spring(elastic) => [elastic.pull(u, v) - actuation[0]; 2],
            Self::Cable(cable) => cable.tensions_at_ends(u, v, actuation),
        }
    }
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    norm(&std::array::from_fn::<f64, 3, _>(|i| a[i] - b[i]))
}

pub(crate) const SPRING: ActuatorKind = ActuatorKind {
    name: "spring",
    list: "springs",
    drive: Drive::Force,
    label: "actuator",
    is_axisymmetric: true,
};

pub(crate) const CABLE: ActuatorKind =
    ActuatorKind { name: "cable", label: "tension", is_axisymmetric: false, ..SPRING };

pub(crate) const WINCH: ActuatorKind =
    ActuatorKind { drive: Drive::Length, label: "drawn in", ..CABLE };

impl Spring {
    /// Number of an output: the force (N) with which its ends pull each other, of a cable the tension at its first place.
    pub(crate) const PULL: usize = 0;
    /// That at its last place.
    pub(crate) const PULL_AT_END: usize = 1;
    /// Its length (m).
    pub(crate) const LENGTH: usize = 2;
}

impl Actuator for Spring {
    fn name(&self) -> &str {
        &self.name
    }

    fn kind(&self) -> &'static ActuatorKind {
        match self.kind {
            Kind::Spring => &SPRING,
            Kind::Cable { is_winch: false, .. } => &CABLE,
            Kind::Cable { is_winch: true, .. } => &WINCH,
        }
    }

    fn driven(&self, body: &Body, signals: Vec<Signal>) -> Result<Forces, InputError> {
        self.forces(body, signals)
    }

    fn gauge(&self, body: &Body) -> Result<ActuatorGauge, InputError> {
        let law = self.law(body)?;
        Ok(Box::new(move |output, now| match output {
            Self::PULL => law.pulls(now.u, now.v, now.drive)[0],
            Self::PULL_AT_END => law.pulls(now.u, now.v, now.drive)[1],
            _ => law.length(now.u),
        }))
    }

    /// A tension is not below 0, as a constant or in a table by itself.
    fn check_signals(&self, phase: &str, signals: &[Signal]) -> Result<(), InputError> {
        if !matches!(self.kind, Kind::Cable { is_winch: false, .. }) {
            return Ok(());
        }
        let least = match signals {
            [only] => only.least(),
            _ => signals.iter().map(Signal::value).sum::<Option<f64>>(),
        };
        match least.filter(|least| *least < 0.0) {
            None => Ok(()),
            Some(least) => {
                let input = format!("actuation of cable \"{}\" in phase \"{phase}\"", self.name);
                let help = "a cable cannot push: its tension (N) is 0 or above";
                Err(InputError::new(input, format!("{least} N"), help))
            }
        }
    }

    fn line(&self, body: &Body) -> Result<Vec<LinePoint>, InputError> {
        self.joints(body)
    }

    fn mapped(&self, map: &ComponentMap<'_>) -> Result<Arc<dyn Actuator>, InputError> {
        let path = self.path.iter().map(|Guide(place)| match place {
            GuidePoint::Nodes(nodes) => (map.nodes)(nodes).map(Guide::nodes),
            other => Ok(Guide(other.clone())),
        });
        let (stiffness, damping) = (map.share * self.stiffness, map.share * self.damping);
        let path = path.collect::<Result<_, InputError>>()?;
        Ok(Arc::new(Self { path, stiffness, damping, ..self.clone() }))
    }

    fn placed(&self, body: &Body, map: &NodeMap) -> Result<Placed, InputError> {
        let joints = self.joints(body)?;
        let numbers = |is_image: bool| {
            let number = |joint: &LinePoint| {
                let mut x = joint.at;
                if is_image {
                    x[map.axis] = 2.0 * map.ends[0] - x[map.axis];
                }
                x.rotate_left((map.axis + 1) % 3);
                [x[0], x[1], x[2], f64::from(u8::from(joint.shares.is_empty()))]
            };
            let mut numbers: Vec<[f64; 4]> = joints.iter().map(number).collect();
            if !self.is_cable() {
                // either end may be the first one
                numbers.sort_by(|a, b| a.partial_cmp(b).unwrap_or(Ordering::Equal));
            }
            numbers.concat()
        };
        let unnamed = Self { name: String::new(), path: Vec::new(), ..self.clone() };
        Ok(Placed {
            likeness: format!("{unnamed:?}"),
            at: [false, true].map(numbers),
            along: joints.iter().map(|joint| joint.at[map.axis]).collect(),
            is_line: true,
        })
    }
}

//! Springs between two nodes, or a node and a point of space, with damping and an actuator.

use super::faces::natural;
use super::signal::{self, Signal, finite_at};
use crate::base::input::{InputError, finite, not_negative, positive};
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{dot, norm};
use crate::elements::force::{Force, NodalForces, Reservoir, Tangents};
use crate::elements::mesh::{Mesh, Selection};
use crate::integrators::ode::Failure;

/// A spring that is shorter than this fraction of its natural length after a step has collapsed:
/// its direction, and with it the force, is about to flip.
const COLLAPSED: f64 = 0.01;

/// Below this fraction of its natural length the direction of a spring is round-off. At trial points of a
/// step it may be shorter than [`COLLAPSED`], so that steps are not made smaller to keep away from that.
const NO_DIRECTION: f64 = 1e-9;

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
    ends: [End; 2],
    stiffness: f64,
    length: Option<f64>,
    damping: f64,
}

/// What a spring is joined to, as it is given.
#[derive(Debug, Clone)]
enum End {
    Node(Selection),
    Point(Vec<f64>),
}

/// What a spring is joined to in a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Joint {
    /// A node, counted from 0.
    Node(usize),
    /// A point of space (m); components beyond the dimension are 0.
    Point([f64; 3]),
}

impl Spring {
    /// The nodes that it is joined to.
    pub(crate) fn selections(&self) -> impl Iterator<Item = &Selection> {
        self.ends.iter().filter_map(|end| match end {
            End::Node(nodes) => Some(nodes),
            End::Point(_) => None,
        })
    }

    /// A spring from the node that `first` selects to the one that `second` selects.
    pub fn between(first: impl Into<Selection>, second: impl Into<Selection>) -> Self {
        Self::new([End::Node(first.into()), End::Node(second.into())])
    }

    /// A spring from the node that `node` selects to a `point` of space (m), which stays where it is.
    pub fn anchored(node: impl Into<Selection>, point: impl Into<Vec<f64>>) -> Self {
        Self::new([End::Node(node.into()), End::Point(point.into())])
    }

    fn new(ends: [End; 2]) -> Self {
        Self { name: String::new(), ends, stiffness: 0.0, length: None, damping: 0.0 }
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

    /// Natural length L (m), above 0. Default: the distance of its nodes in the undeformed shape.
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

    pub(crate) fn or_named(self, name: String) -> Self {
        if self.name.is_empty() { self.named(name) } else { self }
    }

    /// Where the spring runs.
    ///
    /// # Errors
    /// Ends that are not one node each, or are the same; numbers out of range.
    fn line(&self, mesh: &Mesh) -> Result<Line, InputError> {
        let input = |key: &str| self.input(key);
        let joints = self.joints(mesh)?;
        not_negative(&input("stiffness"), self.stiffness, "N/m")?;
        not_negative(&input("damping"), self.damping, "N s/m")?;
        let [first, second] = joints.map(|joint| joint.place(mesh));
        let natural: [f64; 3] = std::array::from_fn(|i| second[i] - first[i]);
        let distance = norm(&natural);
        let length = match self.length {
            Some(length) => positive(&input("length"), length, "m")?,
            None => distance,
        };
        if distance <= COLLAPSED * length {
            let help =
                "its ends are in the same place, so that it has no direction: move them apart";
            return Err(InputError::new(
                input("distance of its ends"),
                format!("{distance} m"),
                help,
            ));
        }
        let (name, dimension, nodes) =
            (self.name.clone(), mesh.dimension(), joints.map(Joint::node));
        Ok(Line { name, dimension, nodes, natural, length })
    }

    /// What the spring is joined to.
    ///
    /// # Errors
    /// Ends that are not one node each; a point with a wrong number of coordinates.
    pub(crate) fn joints(&self, mesh: &Mesh) -> Result<[Joint; 2], InputError> {
        let joint = |which: &str, end: &End| match end {
            End::Node(selection) => match mesh.select(selection)?[..] {
                [node] => Ok(Joint::Node(node)),
                ref nodes => Err(InputError::new(
                    self.input(which),
                    selection,
                    format!("it selects {} nodes: an end is one node", nodes.len()),
                )),
            },
            End::Point(point) if point.len() == mesh.dimension() => {
                finite(&self.input(which), point)?;
                Ok(Joint::Point(std::array::from_fn(|i| point.get(i).copied().unwrap_or(0.0))))
            }
            End::Point(point) => {
                let help = format!("it needs {} coordinates (m)", mesh.dimension());
                Err(InputError::new(self.input(which), format!("{point:?}"), help))
            }
        };
        Ok([joint("first end", &self.ends[0])?, joint("second end", &self.ends[1])?])
    }

    fn input(&self, key: &str) -> String {
        format!("spring \"{}\" {key}", self.name)
    }

    /// The force of the spring, without that of its actuator.
    ///
    /// # Errors
    /// Ends that are not one node each, or are the same; numbers out of range.
    pub(crate) fn force(&self, mesh: &Mesh) -> Result<SpringForce, InputError> {
        let line = self.line(mesh)?;
        Ok(SpringForce { line, stiffness: self.stiffness, damping: self.damping })
    }

    /// The force of its actuator, the sum of the signals `force` (N). It is kept apart from that of the
    /// spring itself, as it is a load, which statics applies in steps.
    ///
    /// # Errors
    /// As [`force`](Self::force).
    pub(crate) fn actuator(&self, mesh: &Mesh, force: Vec<Signal>) -> Result<Actuator, InputError> {
        Ok(Actuator { line: self.line(mesh)?, force })
    }
}

impl Joint {
    fn node(self) -> Option<usize> {
        match self {
            Self::Node(node) => Some(node),
            Self::Point(_) => None,
        }
    }

    /// Its undeformed position (m); components beyond the dimension are 0.
    fn place(self, mesh: &Mesh) -> [f64; 3] {
        match self {
            Self::Node(node) => natural(mesh, node),
            Self::Point(point) => point,
        }
    }
}

/// The straight line between the ends of a spring.
struct Line {
    name: String,
    dimension: usize,
    /// Its ends; none where that is a point of space.
    nodes: [Option<usize>; 2],
    /// From the first end to the second in the undeformed shape.
    natural: [f64; 3],
    /// L
    length: f64,
}

/// The forces of one spring.
pub(crate) struct SpringForce {
    line: Line,
    stiffness: f64,
    damping: f64,
}

impl SpringForce {
    /// Length (m) under the displacements `u`.
    pub(crate) fn length(&self, u: &[f64]) -> f64 {
        self.line.length(u).0
    }

    /// The force that pulls its ends together (N), without that of its actuator.
    pub(crate) fn pull(&self, u: &[f64], v: &[f64]) -> f64 {
        let Stretch { length, rate, .. } = self.line.stretch(u, v);
        self.stiffness * (length - self.line.length) + self.damping * rate
    }
}

/// The force of an actuator along a spring.
pub(crate) struct Actuator {
    line: Line,
    force: Vec<Signal>,
}

/// A spring at one instant; components beyond the dimension are 0.
#[derive(Clone, Copy)]
struct Stretch {
    length: f64,
    /// Unit vector e from the first end to the second.
    direction: [f64; 3],
    /// l'
    rate: f64,
    /// e', the transverse velocity divided by the length.
    turning: [f64; 3],
}

impl Line {
    /// Difference of `x` between the two ends; it is 0 at a point of space.
    fn difference(&self, x: &[f64]) -> [f64; 3] {
        let d = self.dimension;
        let [first, second] =
            self.nodes.map(|node| node.map_or(&[0.0; 3][..d], |node| &x[node * d..][..d]));
        std::array::from_fn(|i| if i < d { second[i] - first[i] } else { 0.0 })
    }

    /// The nodes that the line joins, if it joins two.
    fn couplings(&self) -> Vec<[usize; 2]> {
        match self.nodes {
            [Some(first), Some(second)] => vec![[first, second]],
            _ => Vec::new(),
        }
    }

    fn length(&self, u: &[f64]) -> (f64, [f64; 3]) {
        let moved = self.difference(u);
        let along: [f64; 3] = std::array::from_fn(|i| self.natural[i] + moved[i]);
        (norm(&along), along)
    }

    fn collapsed(&self, t: f64, how: &str) -> Failure {
        Failure::Recoverable(format!(
            "spring \"{}\" has collapsed at t = {t} s: {how}, its natural length is {} m. Without a length it \
             has no direction: pull it with less force, or make it stiffer",
            self.name, self.length
        ))
    }

    /// # Errors
    /// No length, and so no direction.
    fn check_length(&self, t: f64, length: f64) -> Result<(), Failure> {
        match length <= NO_DIRECTION * self.length {
            true => Err(self.collapsed(t, "it has no length")),
            false => Ok(()),
        }
    }

    fn stretch(&self, u: &[f64], v: &[f64]) -> Stretch {
        let (length, along) = self.length(u);
        let direction = along.map(|x| x / length);
        let velocity = self.difference(v);
        let rate = dot(&direction, &velocity);
        let turning = std::array::from_fn(|i| (velocity[i] - rate * direction[i]) / length);
        Stretch { length, direction, rate, turning }
    }

    /// Adds a force `along` the line (N), which pushes its ends apart.
    fn add(&self, along: f64, direction: &[f64; 3], nodal: &mut [f64]) {
        for (node, sign) in self.nodes.into_iter().zip([-1.0, 1.0]) {
            let Some(node) = node else { continue };
            for i in 0..self.dimension {
                nodal[node * self.dimension + i] += sign * along * direction[i];
            }
        }
    }

    /// Adds the tangent `entry` of the second node by its own displacement.
    fn add_tangent(&self, matrix: &mut BlockMatrix, entry: impl Fn(usize, usize) -> f64) {
        let d = self.dimension;
        for row in self.nodes.into_iter().flatten() {
            for column in self.nodes.into_iter().flatten() {
                let sign = if row == column { 1.0 } else { -1.0 };
                let Some(block) = matrix.block_mut(row, column) else { continue };
                for (k, x) in block.iter_mut().enumerate() {
                    *x += sign * entry(k / d, k % d);
                }
            }
        }
    }
}

impl Stretch {
    /// Tangent of a constant force `along` the line, which turns with the line.
    fn turn(&self, along: f64, i: usize, j: usize) -> f64 {
        let e = &self.direction;
        -along / self.length * (f64::from(i == j) - e[i] * e[j])
    }
}

impl Force for SpringForce {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let Stretch { length, direction, rate, .. } = self.line.stretch(u, v);
        self.line.check_length(t, length)?;
        let elastic = -self.stiffness * (length - self.line.length);
        self.line.add(elastic, &direction, &mut forces.conservative);
        self.line.add(-self.damping * rate, &direction, &mut forces.dissipative);
        Ok(())
    }

    /// A spring that turns by more than a right angle in one step has passed through a length of 0.
    fn check_step(&self, t: f64, before: &[f64], after: &[f64]) -> Result<(), Failure> {
        let (length, along) = self.line.length(after);
        if length <= COLLAPSED * self.line.length {
            return Err(self.line.collapsed(t, &format!("it is {length:.1e} m long")));
        }
        if dot(&self.line.length(before).1, &along) <= 0.0 {
            return Err(self.line.collapsed(t, "its ends have passed each other within one step"));
        }
        Ok(())
    }

    /// With T the force along the spring, -df/du of the second node by its own displacement is
    /// k e e^T + c e e'^T - (T/l) (I - e e^T), and -df/dv is c e e^T.
    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        let stretch = self.line.stretch(u, v);
        let Stretch { length, direction: e, rate, turning } = stretch;
        let along = -self.stiffness * (length - self.line.length) - self.damping * rate;
        self.line.add_tangent(stiffness, |i, j| {
            e[i] * (self.stiffness * e[j] + self.damping * turning[j]) + stretch.turn(along, i, j)
        });
        self.line.add_tangent(damping, |i, j| self.damping * e[i] * e[j]);
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        0.5 * self.stiffness * (self.line.length(u).0 - self.line.length).powi(2)
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        self.line.couplings()
    }
}

impl Force for Actuator {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let Stretch { length, direction, .. } = self.line.stretch(u, v);
        self.line.check_length(t, length)?;
        let force = signal::sum(&self.force, t);
        finite_at(t, format_args!("the actuation of spring \"{}\"", self.line.name), force)?;
        self.line.add(force, &direction, &mut forces.applied);
        Ok(())
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        let (stretch, force) = (self.line.stretch(u, v), signal::sum(&self.force, t));
        self.line.add_tangent(stiffness, |i, j| stretch.turn(force, i, j));
        Tangents::Added
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        self.line.couplings()
    }
}

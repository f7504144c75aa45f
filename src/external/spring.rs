//! Springs between two nodes, with damping and an actuator.

use super::signal::{self, Signal, finite_at};
use crate::force::{Force, NodalForces, Reservoir};
use crate::input::{InputError, not_negative, positive};
use crate::mesh::{Mesh, Selection};
use crate::ode::Failure;
use crate::sparse::BlockMatrix;
use crate::vector::dot;

/// A spring that is shorter than this fraction of its natural length after a step has collapsed:
/// its direction, and with it the force, is about to flip.
const COLLAPSED: f64 = 0.01;

/// Below this fraction round-off alone makes the direction. Trial points of a step may come
/// nearer than [`COLLAPSED`], so that no step size is spent on keeping away from it.
const NO_DIRECTION: f64 = 1e-9;

/// A spring between two nodes, its length l along the unit vector e from the first node to the
/// second. With the natural length L, stiffness k, damping c and actuation force f, the second node
/// feels
///
/// (f - k (l - L) - c l') e
///
/// and the first one the opposite: f > 0 extends the spring. The nodes may be any, point masses
/// too ([`point_mass`](crate::body::BodyBuilder::point_mass)). Phases actuate it
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
    ends: [Selection; 2],
    stiffness: f64,
    length: Option<f64>,
    damping: f64,
}

impl Spring {
    /// A spring from the node that `first` selects to the one that `second` selects.
    pub fn between(first: impl Into<Selection>, second: impl Into<Selection>) -> Self {
        Self {
            name: String::new(),
            ends: [first.into(), second.into()],
            stiffness: 0.0,
            length: None,
            damping: 0.0,
        }
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

    /// Natural length L (m), above 0. Default: the distance of its nodes in the natural shape.
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

    pub(crate) fn ends(&self) -> &[Selection; 2] {
        &self.ends
    }

    pub(crate) fn or_named(self, name: String) -> Self {
        if self.name.is_empty() { self.named(name) } else { self }
    }

    /// The force of the spring in a phase in which `actuation` (N) acts along it.
    ///
    /// # Errors
    /// Ends that are not one node each, or the same; numbers out of range.
    pub(crate) fn force(
        &self,
        mesh: &Mesh,
        actuation: Vec<Signal>,
    ) -> Result<SpringForce, InputError> {
        let input = |key: &str| format!("spring \"{}\" {key}", self.name);
        let end = |which: &str, selection: &Selection| match mesh.select(selection)?[..] {
            [node] => Ok(node),
            ref nodes => Err(InputError::new(
                input(which),
                selection,
                format!("it selects {} nodes: an end is one node", nodes.len()),
            )),
        };
        let nodes = [end("first end", &self.ends[0])?, end("second end", &self.ends[1])?];
        not_negative(&input("stiffness"), self.stiffness, "N/m")?;
        not_negative(&input("damping"), self.damping, "N s/m")?;
        let mut natural = [0.0; 3];
        for (i, x) in natural.iter_mut().take(mesh.dimension()).enumerate() {
            *x = mesh.position(nodes[1])[i] - mesh.position(nodes[0])[i];
        }
        let distance = dot(&natural, &natural).sqrt();
        let length = match self.length {
            Some(length) => positive(&input("length"), length, "m")?,
            None => distance,
        };
        if distance <= COLLAPSED * length {
            let mend =
                "its ends are in the same place, so that it has no direction: move them apart";
            return Err(InputError::new(
                input("distance of its ends"),
                format!("{distance} m"),
                mend,
            ));
        }
        Ok(SpringForce {
            name: self.name.clone(),
            dimension: mesh.dimension(),
            nodes,
            natural,
            stiffness: self.stiffness,
            length,
            damping: self.damping,
            actuation,
        })
    }
}

/// The forces of one spring.
pub(crate) struct SpringForce {
    name: String,
    dimension: usize,
    nodes: [usize; 2],
    /// From the first node to the second in the natural shape.
    natural: [f64; 3],
    stiffness: f64,
    length: f64,
    damping: f64,
    actuation: Vec<Signal>,
}

/// A spring at one instant; components beyond the dimension are 0.
struct Stretch {
    length: f64,
    /// Unit vector e from the first node to the second.
    direction: [f64; 3],
    /// l'
    rate: f64,
    /// e', the velocity across over the length.
    turning: [f64; 3],
}

impl SpringForce {
    /// Difference of `x` between the two nodes.
    fn difference(&self, x: &[f64]) -> [f64; 3] {
        let [first, second] = self.nodes.map(|node| &x[node * self.dimension..]);
        std::array::from_fn(|i| if i < self.dimension { second[i] - first[i] } else { 0.0 })
    }

    fn length(&self, u: &[f64]) -> (f64, [f64; 3]) {
        let moved = self.difference(u);
        let along: [f64; 3] = std::array::from_fn(|i| self.natural[i] + moved[i]);
        (dot(&along, &along).sqrt(), along)
    }

    fn collapsed(&self, t: f64, how: &str) -> Failure {
        Failure::Recoverable(format!(
            "spring \"{}\" has collapsed at t = {t} s: {how}, its natural length is {} m. Without a length it \
             has no direction: pull it with less force, or make it stiffer",
            self.name, self.length
        ))
    }

    fn stretch(&self, u: &[f64], v: &[f64]) -> Stretch {
        let (length, along) = self.length(u);
        let direction = along.map(|x| x / length);
        let velocity = self.difference(v);
        let rate = dot(&direction, &velocity);
        let turning = std::array::from_fn(|i| (velocity[i] - rate * direction[i]) / length);
        Stretch { length, direction, rate, turning }
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
        let Stretch { length, direction, rate, .. } = self.stretch(u, v);
        if length <= NO_DIRECTION * self.length {
            return Err(self.collapsed(t, "it has no length"));
        }
        let actuation = signal::sum(&self.actuation, t);
        finite_at(t, format_args!("the actuation of spring \"{}\"", self.name), actuation)?;
        let elastic = -self.stiffness * (length - self.length);
        let parts = [
            (&mut forces.conservative, elastic),
            (&mut forces.dissipative, -self.damping * rate),
            (&mut forces.applied, actuation),
        ];
        for (nodal, along) in parts {
            for (node, sign) in self.nodes.into_iter().zip([-1.0, 1.0]) {
                for i in 0..self.dimension {
                    nodal[node * self.dimension + i] += sign * along * direction[i];
                }
            }
        }
        Ok(())
    }

    /// A spring that turns by more than a right angle in one step has passed through nothing.
    fn check_step(&self, t: f64, before: &[f64], after: &[f64]) -> Result<(), Failure> {
        let (length, along) = self.length(after);
        if length <= COLLAPSED * self.length {
            return Err(self.collapsed(t, &format!("it is {length:.1e} m long")));
        }
        if dot(&self.length(before).1, &along) <= 0.0 {
            return Err(self.collapsed(t, "its ends have passed each other within one step"));
        }
        Ok(())
    }

    /// With T the force along the spring, -df/du of the second node by its own displacement is
    /// k e e^T + c e e'^T - (T/l) (I - e e^T), and -df/dv is c e e^T.
    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let d = self.dimension;
        let Stretch { length, direction: e, rate, turning } = self.stretch(u, v);
        let tension = signal::sum(&self.actuation, t)
            - self.stiffness * (length - self.length)
            - self.damping * rate;
        let by_u = |i: usize, j: usize| {
            let across = f64::from(i == j) - e[i] * e[j];
            e[i] * (self.stiffness * e[j] + self.damping * turning[j]) - tension / length * across
        };
        let by_v = |i: usize, j: usize| self.damping * e[i] * e[j];
        for row in self.nodes {
            for column in self.nodes {
                let sign = if row == column { 1.0 } else { -1.0 };
                let add = |matrix: &mut BlockMatrix, entry: &dyn Fn(usize, usize) -> f64| {
                    let Some(block) = matrix.block_mut(row, column) else { return };
                    for (k, x) in block.iter_mut().enumerate() {
                        *x += sign * entry(k / d, k % d);
                    }
                };
                add(stiffness, &by_u);
                add(damping, &by_v);
            }
        }
    }

    fn is_nonlinear(&self) -> bool {
        true
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        0.5 * self.stiffness * (self.length(u).0 - self.length).powi(2)
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        vec![self.nodes]
    }
}

//! A hand that pulls a node.

use serde_json::{Value, json};

use crate::error::Error;
use crate::input::{InputError, finite};
use crate::mesh::Selection;
use crate::scene::Scene;
use crate::simulate::Simulation;

/// What a pull over the size of the body makes of its weight, about: its mass gets this acceleration (m/s^2).
const ACCELERATION: f64 = 100.0;
/// Damping of the pull, as a part of sqrt(k m).
const DAMPING: f64 = 0.2;
/// Parts of 1 / sqrt(k / m) after which the force is made anew: it lags behind by half of that on average,
/// which the damping outweighs.
const RENEWAL: f64 = 0.08;

/// A spring from a node to the mouse: the force k (target - position) - c velocity, kept from one renewal to the
/// next.
pub(super) struct Hand {
    place: usize,
    node: usize,
    selection: Selection,
    target: Vec<f64>,
    stiffness: f64,
    damping: f64,
    /// Time between renewals of the force (s).
    pub(super) period: f64,
}

impl Hand {
    /// A hand at `node` (from 0), which is drawn at `place`, pulling it to `target` (m).
    ///
    /// # Errors
    /// A target with a wrong number of coordinates.
    pub(super) fn new(
        scene: &Scene,
        [place, node]: [usize; 2],
        target: Vec<f64>,
        strength: f64,
    ) -> Result<Self, InputError> {
        let mesh = scene.body().mesh();
        let dimension = mesh.dimension();
        let drawn = dimension.max(2);
        if target.len() != drawn {
            let mend = format!("it needs {drawn} coordinates (m)");
            return Err(InputError::new("target of the pull", format!("{target:?}"), mend));
        }
        finite("the target of the pull", &target)?;
        // a bar is drawn upright
        let target = target[drawn - dimension..].to_vec();
        let mass = scene.body().mass();
        let stiffness = strength * ACCELERATION * mass / mesh.size();
        let period = RENEWAL * (mass / stiffness).sqrt();
        let damping = DAMPING * (stiffness * mass).sqrt();
        let selection = selection(scene, node)?;
        Ok(Self { place, node, selection, target, stiffness, damping, period })
    }

    /// Whether it pulls the same node as `other`.
    pub(super) fn is_at(&self, other: &Self) -> bool {
        self.node == other.node
    }

    /// Gives the node the force of the present moment.
    ///
    /// # Errors
    /// As [`Simulation::load`].
    pub(super) fn pull(&self, simulation: &mut Simulation) -> Result<(), Error> {
        let view = simulation.view();
        let from = self.node * self.target.len();
        let natural = view.body().mesh().position(self.node);
        let (u, v) = (&view.displacements()[from..], &view.velocities()[from..]);
        let force = self.target.iter().enumerate().map(|(axis, target)| {
            self.stiffness * (target - natural[axis] - u[axis]) - self.damping * v[axis]
        });
        let force: Vec<f64> = force.collect();
        simulation.load(self.selection.clone(), force)
    }

    /// Lets the node go.
    ///
    /// # Errors
    /// As [`Simulation::load`].
    pub(super) fn let_go(&self, simulation: &mut Simulation) -> Result<(), Error> {
        simulation.load(self.selection.clone(), vec![0.0; self.target.len()])
    }

    pub(super) fn to_json(&self) -> Value {
        let mut to = self.target.clone();
        if to.len() == 1 {
            to.insert(0, 0.0);
        }
        json!({ "node": self.place, "to": to })
    }
}

/// The node by the place where it is: loads of the scene, which name nodes by number or set, are others.
fn selection(scene: &Scene, node: usize) -> Result<Selection, InputError> {
    let mesh = scene.body().mesh();
    let at = mesh.position(node).to_vec();
    let place = Selection::Box { min: at.clone(), max: at };
    Ok(match mesh.select(&place)?.len() {
        1 => place,
        _ => Selection::Numbers(vec![node + 1]),
    })
}

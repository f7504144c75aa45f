//! A hand that pulls a node.

use serde_json::{Value, json};

use crate::base::input::{InputError, finite};
use crate::base::vector::norm;
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Simulation;
use crate::elements::mesh::Selection;
use crate::scene::timeline::Scene;

/// Approximate acceleration (m/s^2) of the body's mass by a pull over the size of the body.
const ACCELERATION: f64 = 100.0;
/// Damping of the pull, as a part of sqrt(k m).
const DAMPING: f64 = 0.2;
/// Time between updates of the force, as a part of 1 / sqrt(k / m): the force lags behind by half of that on
/// average, which the damping outweighs.
const RENEWAL: f64 = 0.25;
/// Changes of the force, as a part of it, that are ignored: each new force requires a new start of the
/// integrator.
const NEGLIGIBLE: f64 = 0.02;

/// A spring from a node to the mouse: the force k (target - position) - c velocity, kept from one renewal to
/// the next.
pub(super) struct Hand {
    place: usize,
    node: usize,
    selection: Selection,
    target: Vec<f64>,
    stiffness: f64,
    damping: f64,
    /// The number of the phase in which a force was given last, and that force (N).
    given: Option<(usize, Vec<f64>)>,
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
            let help = format!("it needs {drawn} coordinates (m)");
            return Err(InputError::new("target of the pull", format!("{target:?}"), help));
        }
        finite("the target of the pull", &target)?;
        // a bar is drawn upright
        let target = target[drawn - dimension..].to_vec();
        let mass = scene.body().mass();
        let stiffness = strength * ACCELERATION * mass / mesh.size();
        let period = RENEWAL * (mass / stiffness).sqrt();
        let damping = DAMPING * (stiffness * mass).sqrt();
        let selection = selection(scene, node)?;
        Ok(Self { place, node, selection, target, stiffness, damping, given: None, period })
    }

    /// Whether it pulls the same node as `other`, whose force it then takes over.
    pub(super) fn takes_over(&mut self, other: &Self) -> bool {
        let is_same = self.node == other.node;
        if is_same {
            self.given.clone_from(&other.given);
        }
        is_same
    }

    /// Applies the present force to the node.
    ///
    /// # Errors
    /// As [`Simulation::load`].
    pub(super) fn pull(&mut self, simulation: &mut Simulation) -> Result<(), Error> {
        let view = simulation.view();
        let from = self.node * self.target.len();
        let natural = view.body().mesh().position(self.node);
        let (u, v) = (&view.displacements()[from..], &view.velocities()[from..]);
        let force = self.target.iter().enumerate().map(|(axis, target)| {
            self.stiffness * (target - natural[axis] - u[axis]) - self.damping * v[axis]
        });
        let force: Vec<f64> = force.collect();
        if self.given.as_ref().is_some_and(|(phase, given)| {
            *phase == simulation.phase_number()
                && distance(given, &force) <= NEGLIGIBLE * norm(&force)
        }) {
            return Ok(());
        }
        simulation.load(self.selection.clone(), force.clone())?;
        self.given = Some((simulation.phase_number(), force));
        Ok(())
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

fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>())
}

/// Selects the node by its position, unless a load of the scene has the same selection: the pull would
/// replace that load.
fn selection(scene: &Scene, node: usize) -> Result<Selection, InputError> {
    let mesh = scene.body().mesh();
    let at = mesh.position(node).to_vec();
    let place = Selection::Box { min: at.clone(), max: at };
    let mut loads = scene.phases().iter().flat_map(|phase| phase.loads());
    let is_taken = loads.any(|(nodes, ..)| *nodes == place);
    Ok(match mesh.select(&place)?.len() {
        1 if !is_taken => place,
        _ => Selection::Numbers(vec![node + 1]),
    })
}

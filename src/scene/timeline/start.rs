//! Start of a scene: displacements and velocities at t = 0.

use std::sync::Arc;

use super::SceneState;
use super::phase::check_vector;
use super::scene_state::INPUT;
use crate::base::input::{InputError, finite};
use crate::base::vector::cross;
use crate::elements::body::Body;
use crate::elements::mesh::Selection;
use crate::scene::constraint::angular;

/// The start as the user of a scene gives it.
#[derive(Debug, Clone)]
pub(super) struct Start {
    /// The state that it was taken from, if it was; without bodies where these have another mesh by now.
    pub(super) state: Option<Arc<SceneState>>,
    /// Displacements (m).
    pub(super) displacements: Vec<f64>,
    /// Velocities (m/s), without `spin` and `of_nodes`.
    pub(super) velocities: Vec<f64>,
    /// Angular velocity (rad/s) about the centre of mass, added to them.
    pub(super) spin: Option<Vec<f64>>,
    /// Velocities (m/s) of some nodes, in place of both.
    pub(super) of_nodes: Vec<(Selection, Vec<f64>)>,
    /// Angular velocities (rad/s) of some bodies about their own centres of mass, added to all of these.
    pub(super) of_bodies: Vec<(String, Vec<f64>)>,
}

impl Start {
    /// At rest in the undeformed shape.
    pub(super) fn rest(body: &Body) -> Self {
        let rest = vec![0.0; body.dofs()];
        Self {
            state: None,
            displacements: rest.clone(),
            velocities: rest,
            spin: None,
            of_nodes: Vec::new(),
            of_bodies: Vec::new(),
        }
    }

    /// # Errors
    /// Branches in the state from which it starts: it is not known what `they` are in another mesh.
    pub(super) fn refuse_branches(&self, other: &str) -> Result<(), InputError> {
        let mut bodies = self.state.iter().flat_map(|state| &state.bodies);
        match bodies.any(|body| body.branches.is_some()) {
            false => Ok(()),
            true => {
                let help = format!(
                    "what they are in the cells of {other} is not known: start from a state of a scene with that mesh"
                );
                Err(InputError::new(INPUT, "with Maxwell branches", help))
            }
        }
    }

    /// Velocities at t = 0.
    ///
    /// # Errors
    /// A state of another mesh, numbers of components that do not fit the body, numbers that are not finite,
    /// unknown nodes.
    pub(super) fn velocities(&self, body: &Body) -> Result<Vec<f64>, InputError> {
        let dimension = body.dimension();
        let Self { state, displacements, velocities, spin, of_nodes, of_bodies } = self;
        if let Some(state) = state {
            state.check(body)?;
        }
        for (name, vector) in
            [("initial displacement", displacements), ("initial velocity", velocities)]
        {
            if vector.len() != body.dofs() {
                let help = format!("it needs {dimension} components at each node");
                let value = format!("{} numbers in all", vector.len());
                return Err(InputError::new(name, value, help));
            }
            finite(name, vector)?;
        }
        if let Some(rigid) = body.rigid_pieces() {
            rigid.check("initial displacement", displacements, "m", body.size())?;
        }
        let mut v = velocities.clone();
        if let Some(spin) = spin {
            add_spin(&angular("spin", spin, dimension)?, body, displacements, &mut v);
        }
        for (nodes, velocity) in of_nodes {
            check_vector("initial velocity", velocity, dimension, "m/s")?;
            finite("initial velocity", velocity)?;
            for node in body.mesh().select(nodes)? {
                v[node * dimension..][..dimension].copy_from_slice(velocity);
            }
        }
        for (name, spin) in of_bodies {
            let part = body.part_named(name, "body of a spin")?;
            let omega = angular("spin", spin, dimension)?;
            add_spin(&omega, part.body, &displacements[part.dofs()], &mut v[part.dofs()]);
        }
        Ok(v)
    }
}

/// Adds the velocities of a rotation with the angular velocity `omega` (rad/s) about the centre of mass.
fn add_spin(omega: &[f64; 3], body: &Body, displacements: &[f64], v: &mut [f64]) {
    let dimension = body.dimension();
    let positions = body.mesh().positions().iter();
    let x: Vec<f64> = positions.zip(displacements).map(|(x, u)| x + u).collect();
    let centre = body.mass_average(&x);
    for (v, x) in v.chunks_exact_mut(dimension).zip(x.chunks_exact(dimension)) {
        let mut arm = [0.0; 3];
        arm.iter_mut().zip(x.iter().zip(&centre)).for_each(|(arm, (x, c))| *arm = x - c);
        v.iter_mut().zip(cross(omega, &arm)).for_each(|(v, turning)| *v += turning);
    }
}

//! What a scene can start from.

use crate::base::input::InputError;
use crate::elements::body::Body;

/// Where the nodes of a body are and how fast they move: what
/// [`Scene::starting_from`](crate::Scene::starting_from) takes.
///
/// It is taken from a motion or an equilibrium by [`Trajectory::state`](crate::Trajectory::state), or read
/// from the files of an earlier run.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyState {
    /// Undeformed positions (m), dimension components per node: the mesh is identified by them.
    pub positions: Vec<f64>,
    /// Displacements (m), likewise.
    pub displacements: Vec<f64>,
    /// Velocities (m/s), likewise.
    pub velocities: Vec<f64>,
}

/// Equal positions may differ by this fraction of the size of a body: round-off when a mesh is made.
const SAME: f64 = 1e-9;

/// # Errors
/// Undeformed positions other than those of `body`.
pub(super) fn check_positions(positions: &[f64], body: &Body) -> Result<(), InputError> {
    let (mesh, dimension) = (body.mesh(), body.dimension());
    let help = "start from a state of a body with the same mesh";
    if positions.len() != mesh.positions().len() {
        let count = positions.len() / dimension;
        let help = format!("this body has {}: {help}", mesh.node_count());
        return Err(InputError::new("state at the start", format!("{count} nodes"), help));
    }
    let pairs = positions.chunks_exact(dimension).zip(mesh.positions().chunks_exact(dimension));
    let far = |(_, (theirs, ours)): &(usize, (&[f64], &[f64]))| {
        // NaN counts as far
        !theirs.iter().zip(*ours).all(|(a, b)| (a - b).abs() <= SAME * mesh.size())
    };
    match (1..).zip(pairs).find(far) {
        None => Ok(()),
        Some((node, (theirs, ours))) => Err(InputError::new(
            "state at the start",
            format!("node {node} at {theirs:?} undeformed"),
            format!("this body has it at {ours:?}: {help}"),
        )),
    }
}

//! On which side of its walls a chamber lies.

use std::collections::BTreeMap;

use super::ChamberForce;
use crate::base::sparse::NodePattern;
use crate::base::vector::dot;
use crate::elements::body::Body;
use crate::elements::force::Force;

/// The first of the separate closed walls of a chamber with this `force` that runs around the body instead of
/// around a room in it: one of its nodes, and the volume (m^3) that it encloses, which is below 0.
pub(super) fn around_the_body(force: &ChamberForce, body: &Body) -> Option<(usize, f64)> {
    let (mesh, d) = (body.mesh(), body.dimension());
    let degree = if body.is_axisymmetric() { 3 } else { d };
    let mut gradient = vec![0.0; mesh.positions().len()];
    force.add_gradient(1.0, &vec![0.0; mesh.positions().len()], &mut gradient);
    let walls = force.couplings();
    let pieces = NodePattern::new(mesh.node_count(), walls.iter().map(|pair| &pair[..])).pieces();
    let mut nodes: Vec<usize> = walls.into_iter().flatten().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let mut volumes: BTreeMap<usize, (usize, f64)> = BTreeMap::new();
    for node in nodes {
        // volumes are homogeneous in positions: Euler's theorem gives them by their gradients
        let part = dot(mesh.position(node), &gradient[node * d..][..d]) / degree as f64;
        volumes.entry(pieces[node]).or_insert((node, 0.0)).1 += part;
    }
    let whole: f64 = volumes.values().map(|(_, volume)| volume.abs()).sum();
    volumes.into_values().find(|(_, volume)| *volume < -1e-9 * whole)
}

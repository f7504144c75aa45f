//! Forces on single nodes, under which the displacement grows as the mesh gets finer.

use std::collections::BTreeSet;
use std::f64::consts::{LN_2, PI};

use super::rigid::travel;
use super::size::least_cell_sizes;
use crate::base::input::InputError;
use crate::base::vector::norm;
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::{Sample, Trajectory};

/// Largest growth of the displacement under a force with each halving of the cells, relative to the motion.
const MOST_GROWTH: f64 = 0.01;

/// Nodes that are loaded or held while no other node of their cells is. In the plane the displacement under a
/// force F on one node grows with each halving of the cells by 2 F ln 2 / (pi E h) (Flamant), h the
/// thickness; in space by some F / (E a), a the size of a cell (Boussinesq). Nodes where that is small
/// compared with the motion do not count.
pub(super) fn single(trajectory: &Trajectory, samples: &[&Sample]) -> Option<Indicator> {
    let body = trajectory.body();
    let way = travel(body, samples);
    let dimension = body.parts().map(|part| part.body.mesh().kind().dimension()).max()?;
    if dimension < 2 || way == 0.0 {
        return None;
    }
    let sizes = least_cell_sizes(body);
    let growth = |force: f64, node: usize| {
        let own = body.part_of(node).body;
        let moduli = own.materials().map(|material| material.young);
        let young = moduli.fold(f64::INFINITY, f64::min);
        match own.mesh().kind().dimension() {
            1 => 0.0,
            2 => 2.0 * force * LN_2 / (PI * young * own.section()),
            _ => force / (young * sizes[node]),
        }
    };
    // nodes that share a cell
    let pattern = body.inertia().pattern();
    let mut found = BTreeSet::new();
    let mut most: f64 = 0.0;
    for sample in samples {
        let Ok(forces) = forces(trajectory, sample) else { continue };
        for (node, &force) in forces.iter().enumerate() {
            let mut others =
                pattern.row(node).map(|(_, other)| other).filter(|other| *other != node).peekable();
            let has_cells = others.peek().is_some();
            let is_alone = has_cells && others.all(|other| forces[other] == 0.0);
            let part = growth(force, node) / way;
            if part > MOST_GROWTH && is_alone {
                found.insert(node);
                most = most.max(part);
            }
        }
    }
    let within = || {
        "no node is loaded or held by itself so much that the mesh would matter (limit: none)"
            .to_owned()
    };
    let beyond = || {
        let first = found.first().map_or(0, |node| node + 1);
        format!(
            "{} node(s), node {first} among them, are loaded or held with no neighbour (limit: none): the displacement there \
             grows without bound as cells get finer, by {:.0} % of the motion each time they are halved; share a load \
             out over the nodes of an edge or a face (`total`, `traction`), and hold an edge or a face",
            found.len(),
            100.0 * most
        )
    };
    let value = (found.len() as f64, "");
    Some(Indicator::trusted("single-nodes", value, [0.0, 0.0], within, beyond))
}

/// Sizes of the forces (N) of loads and constraints on each node.
fn forces(trajectory: &Trajectory, sample: &Sample) -> Result<Vec<f64>, InputError> {
    let (scene, phase) = (trajectory.scene(), trajectory.phase_of(sample)?);
    let d = scene.body().dimension();
    let mut forces = trajectory.constraint_forces(sample)?;
    for (node, force) in scene.loads_at(phase, sample.time)? {
        forces[node * d..][..d].iter_mut().zip(force).for_each(|(sum, force)| *sum += force);
    }
    Ok(forces.chunks_exact(d).map(norm).collect())
}

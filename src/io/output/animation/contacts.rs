//! Forces of the obstacles on the body.

use serde_json::{Value, json};

use super::geometry::in_view;
use super::pack;
use crate::base::vector::norm;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::io::output::svg::displaced;
use crate::scene::forces::Obstacle;

/// Resultants below this fraction of the sum of the force sizes count as 0: the round-off of forces that cancel each other.
const ROUND_OFF: f64 = 1e-10;

/// Of each obstacle that touches a body in one of `frames`, and of all that touch each of several bodies, sample by
/// sample: the resultant of its forces (N), and its centre of pressure (m), the mean position of the nodes weighted by
/// the sizes of their forces.
pub(super) fn resultants(trajectory: &Trajectory, frames: &[&Sample]) -> Result<Value, Error> {
    let scene = trajectory.scene();
    let d = scene.body().dimension();
    let touches = trajectory.touch_forces()?;
    let bodies: Vec<_> = match touches.is_empty() {
        true => Vec::new(),
        false => scene.body().parts().map(|part| part.nodes).collect(),
    };
    let everywhere = 0..scene.body().mesh().node_count();
    let mut tracks = vec![(Vec::new(), Vec::new()); scene.obstacles().len() + bodies.len()];
    for sample in frames {
        let phase = trajectory.phase_of(sample)?;
        let acting = scene.contacts(phase)?;
        let x = displaced(trajectory, sample);
        let of_obstacle = |obstacle: &Obstacle| {
            let of_it = acting.iter().filter(|acting| acting.obstacle().name() == obstacle.name());
            trajectory.forces_of(of_it.map(|acting| acting as _), sample)
        };
        let mut of_all = Vec::new();
        for obstacle in scene.obstacles() {
            of_all.push((of_obstacle(obstacle)?, everywhere.clone()));
        }
        if !bodies.is_empty() {
            let touching = touches.iter().filter(|_| phase.has_touch);
            let nodal = trajectory.forces_of(touching.map(|touch| touch as _), sample)?;
            of_all.extend(bodies.iter().map(|nodes| (nodal.clone(), nodes.clone())));
        }
        for ((nodal, nodes), (at, forces)) in of_all.into_iter().zip(&mut tracks) {
            let (mut force, mut centre, mut total) = ([0.0; 3], [0.0; 3], 0.0);
            let of_nodes = d * nodes.start..d * nodes.end;
            for (f, x) in nodal[of_nodes.clone()].chunks(d).zip(x[of_nodes].chunks(d)) {
                let size = norm(f);
                total += size;
                for axis in 0..d {
                    force[axis] += f[axis];
                    centre[axis] += size * x[axis];
                }
            }
            if norm(&force) <= ROUND_OFF * total {
                // as of a body that touches itself
                force = [0.0; 3];
            }
            if total > 0.0 {
                centre = centre.map(|part| part / total);
            }
            at.extend(in_view(&centre[..d]));
            forces.extend(in_view(&force[..d]));
        }
    }
    let touching =
        tracks.into_iter().filter(|(_, forces)| forces.iter().any(|force| *force != 0.0));
    let packed = touching
        .map(|(at, forces)| json!({ "at": pack::singles(at), "forces": pack::singles(forces) }));
    Ok(packed.collect())
}

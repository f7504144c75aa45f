//! Forces of the obstacles on the body.

use serde_json::{Value, json};

use super::geometry::in_view;
use super::pack;
use crate::base::vector::norm;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::io::output::svg::displaced;

/// Of each obstacle that touches the body in one of `frames`, sample by sample: the resultant of its forces
/// (N), and its centre of pressure (m), the mean position of the nodes weighted by the sizes of their forces.
pub(super) fn resultants(trajectory: &Trajectory, frames: &[&Sample]) -> Result<Value, Error> {
    let scene = trajectory.scene();
    let d = scene.body().dimension();
    let mut tracks = vec![(Vec::new(), Vec::new()); scene.obstacles().len()];
    for sample in frames {
        let acting = scene.contacts(trajectory.phase_of(sample)?)?;
        let x = displaced(trajectory, sample);
        for (obstacle, (at, forces)) in scene.obstacles().iter().zip(&mut tracks) {
            let of_it = acting.iter().filter(|acting| acting.obstacle().name() == obstacle.name());
            let (mut force, mut centre, mut total) = ([0.0; 3], [0.0; 3], 0.0);
            let nodal = trajectory.forces_of(of_it, sample)?;
            for (f, x) in nodal.chunks(d).zip(x.chunks(d)) {
                let size = norm(f);
                total += size;
                for axis in 0..d {
                    force[axis] += f[axis];
                    centre[axis] += size * x[axis];
                }
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

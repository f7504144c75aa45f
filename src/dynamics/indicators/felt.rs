//! Effects of contact and friction on a motion.

use super::rigid::travel;
use super::touch::Meeting;
use crate::base::input::{InputError, percent};
use crate::base::vector::norm;
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::scene::forces::Contact;

/// Impulse of friction over that of the normal forces, below which friction does not matter.
const FELT: f64 = 0.01;
/// Largest depth in an obstacle relative to the distance that nodes travel.
const MOST_DEPTH: f64 = 0.1;

/// Forces of friction and tangential damping over the normal forces: each is the sum over all samples and
/// nodes.
pub(super) fn friction(trajectory: &Trajectory, samples: &[&Sample]) -> Option<Indicator> {
    let scene = trajectory.scene();
    if !scene
        .obstacles()
        .iter()
        .any(|obstacle| obstacle.has_friction() || obstacle.has_tangential_damping())
    {
        return None;
    }
    let d = scene.body().dimension();
    let [mut rubs, mut presses] = [0.0; 2];
    for sample in samples {
        let Ok(([with, without], false)) = forces(trajectory, sample).map(|forces| {
            let nothing = forces[1].iter().all(|force| *force == 0.0);
            (forces, nothing)
        }) else {
            continue;
        };
        let along: Vec<f64> = with.iter().zip(&without).map(|(a, b)| a - b).collect();
        let sum = |forces: &[f64]| forces.chunks_exact(d).map(norm).sum::<f64>();
        rubs += sum(&along);
        presses += sum(&without);
    }
    if presses == 0.0 {
        return None;
    }
    let part = rubs / presses;
    let said = format!(
        "the friction force is {} of the normal force on obstacles (limit: {})",
        percent(part),
        percent(FELT)
    );
    let enough = || format!("{said}: obstacles without friction suffice");
    Some(Indicator::needed("friction", (part, "1"), FELT, || said.clone(), enough))
}

/// Forces (N) of obstacles on nodes, with their friction and without.
fn forces(trajectory: &Trajectory, sample: &Sample) -> Result<[Vec<f64>; 2], InputError> {
    let scene = trajectory.scene();
    let rough = scene.contacts(trajectory.phase_of(sample)?)?;
    let smooth = rough
        .iter()
        .map(|contact| Contact::new(scene.body(), &contact.obstacle().clone().without_friction()));
    let smooth = smooth.collect::<Result<Vec<_>, _>>()?;
    let of = |contacts: &[Contact]| {
        trajectory.forces_of(contacts.iter().map(|contact| contact as _), sample)
    };
    Ok([of(&rough)?, of(&smooth)?])
}

/// Depth of nodes in obstacles, relative to the distance that nodes travel.
pub(super) fn depth(
    trajectory: &Trajectory,
    samples: &[&Sample],
    meetings: &[Meeting],
) -> Option<Indicator> {
    let way = travel(trajectory.body(), samples);
    let soft = meetings.iter().filter(|meeting| meeting.may_be_soft());
    let deepest = soft.max_by(|a, b| a.depth().total_cmp(&b.depth()))?;
    if way == 0.0 {
        return None;
    }
    let part = deepest.depth() / way;
    let name = deepest.obstacle();
    let said = format!(
        "the penetration of obstacle \"{name}\" is {} of the travel of the nodes (limit: {})",
        percent(part),
        percent(MOST_DEPTH)
    );
    let beyond = || format!("{said}: it is too soft; raise its stiffness");
    let limits = [0.0, MOST_DEPTH];
    Some(Indicator::trusted("depth-of-way", (part, "1"), limits, || said.clone(), beyond))
}

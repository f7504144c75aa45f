//! How obstacles were met.

use std::ptr;

use crate::body::Body;
use crate::external::Contact;
use crate::scene::{Phase, Scene};
use crate::trajectory::{Sample, Trajectory};
use crate::vector::norm;

/// How far a node may be inside an obstacle: this part of its cell, or of the body if that is more.
const MOST_OF_CELL: f64 = 0.5;
const MOST_OF_BODY: f64 = 0.02;

/// How near the body came to an obstacle while that acted.
pub(super) struct Meeting {
    obstacle: String,
    /// A bound on its speed (m/s) at and between samples.
    speed: f64,
    /// Least distance (m), below 0 inside the obstacle.
    nearest: f64,
    /// The largest depth (m) for its limit (m), and the node there, counted from 0.
    deepest: Deepest,
}

#[derive(Clone, Copy)]
struct Deepest {
    depth: f64,
    limit: f64,
    node: usize,
}

/// How the obstacles that act at `samples` were met there.
pub(super) fn meetings(trajectory: &Trajectory, samples: &[&Sample]) -> Vec<Meeting> {
    let scene = trajectory.scene();
    if scene.obstacles().is_empty() {
        return Vec::new();
    }
    let limits = depth_limits(scene.body());
    // of speeds, for paths by formulas
    let precision = 1e-3 * scene.body().mesh().size();
    let mut meetings: Vec<Meeting> = Vec::new();
    let mut acting: Option<(&Phase, Vec<Contact>)> = None;
    let mut last = 0.0;
    for sample in samples {
        let Ok(phase) = trajectory.phase_of(sample) else { continue };
        if acting.as_ref().is_none_or(|(last, _)| !ptr::eq(*last, phase)) {
            acting = scene.contacts(phase).ok().map(|contacts| (phase, contacts));
        }
        for contact in acting.iter().flat_map(|(_, contacts)| contacts) {
            let name = contact.obstacle().name();
            let known = meetings.iter().position(|meeting| meeting.obstacle == name);
            let number = known.unwrap_or_else(|| {
                meetings.push(Meeting {
                    obstacle: name.to_owned(),
                    speed: 0.0,
                    nearest: f64::INFINITY,
                    deepest: Deepest { depth: 0.0, limit: 1.0, node: 0 },
                });
                meetings.len() - 1
            });
            let meeting = &mut meetings[number];
            let fastest = contact.obstacle().cubics([last, sample.time], precision).fastest;
            meeting.speed = meeting.speed.max(fastest);
            contact.each_distance(sample.time, &sample.u, |distance, node| {
                meeting.nearest = meeting.nearest.min(distance);
                let Deepest { depth, limit, .. } = meeting.deepest;
                if -distance / limits[node] > depth / limit {
                    meeting.deepest = Deepest { depth: -distance, limit: limits[node], node };
                }
            });
        }
        last = sample.time;
    }
    meetings
}

/// For each node the depth (m) up to which it may be inside an obstacle, by the smallest of its cells. The size of
/// a cell is the edge of a square or cube that is cut into such cells, or that is such a cell.
fn depth_limits(body: &Body) -> Vec<f64> {
    let mesh = body.mesh();
    let dimension = mesh.kind().dimension();
    // a simplex fills the parallelepiped of its edges to this part
    let is_simplex = mesh.kind().faces().len() == dimension + 1;
    let parts = if is_simplex { [1.0, 1.0, 2.0, 6.0][dimension] } else { 1.0 };
    let mut limits = vec![f64::INFINITY; mesh.node_count()];
    for (cell, volume) in mesh.cells().zip(body.cell_volumes()) {
        let size = (parts * volume / body.section()).powf(1.0 / dimension as f64);
        let limit = f64::max(MOST_OF_CELL * size, MOST_OF_BODY * mesh.size());
        cell.iter().for_each(|&node| limits[node] = limits[node].min(limit));
    }
    limits
}

/// Nodes deep inside obstacles.
pub(super) fn depths(meetings: &[Meeting]) -> impl Iterator<Item = String> {
    let is_deep = |meeting: &&Meeting| meeting.deepest.depth > meeting.deepest.limit;
    meetings.iter().filter(is_deep).map(|meeting| {
        let Deepest { depth, limit, node } = meeting.deepest;
        format!(
            "node {} is {depth:.2e} m inside obstacle \"{}\" (limit: {limit:.2e} m, half a cell or 2 % of the \
             body): raise the stiffness of the obstacle",
            node + 1,
            meeting.obstacle
        )
    })
}

/// Obstacles that touch and would hold the body by friction, in an equilibrium that knows none.
pub(super) fn slippery(
    trajectory: &Trajectory,
    meetings: &[Meeting],
) -> impl Iterator<Item = String> {
    let obstacles = trajectory.scene().obstacles().iter();
    let is_met = |name: &str| meetings.iter().any(|met| met.obstacle == name && met.nearest <= 0.0);
    obstacles.filter(move |obstacle| obstacle.has_friction() && is_met(obstacle.name())).map(|obstacle| {
        format!(
            "obstacle \"{}\" has friction, which does not act in statics (limit: none): the body slides as if there were \
             none; run the scene until it is at rest instead",
            obstacle.name()
        )
    })
}

/// Obstacles that acted and were further from the body at all times than it may come nearer unseen.
pub(super) fn missed(meetings: &[Meeting], reach: Reach) -> impl Iterator<Item = String> {
    let is_missed = move |meeting: &&Meeting| meeting.nearest > reach.towards(meeting.speed);
    meetings.iter().filter(is_missed).map(|meeting| {
        format!(
            "obstacle \"{}\" was never touched, though it acts: the body came as near as {:.2e} m (limit: 0 \
             m); move one of them, or leave the obstacle out",
            meeting.obstacle, meeting.nearest
        )
    })
}

/// How far a body may move unseen between samples.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    /// Longest time between samples (s).
    pause: f64,
    /// Speed that the body has at most then (m/s).
    speed: f64,
}

impl Reach {
    /// That of a body at rest.
    pub(super) const NONE: Self = Self { pause: 0.0, speed: 0.0 };

    /// That of a body which between `samples` becomes faster by gravity alone.
    pub(super) fn between(scene: &Scene, samples: &[&Sample]) -> Self {
        let pauses = samples.windows(2).map(|pair| pair[1].time - pair[0].time);
        let pause = pauses.fold(0.0, f64::max);
        let velocities =
            samples.iter().flat_map(|sample| sample.v.chunks_exact(scene.body().dimension()));
        let gravities = scene.phases().iter().filter_map(|phase| scene.gravity_in(phase));
        let gravity = gravities.map(norm).fold(0.0, f64::max);
        Self { pause, speed: velocities.map(norm).fold(0.0, f64::max) + gravity * pause }
    }

    /// How far the body may come nearer (m) to an obstacle that moves at `speed` (m/s).
    fn towards(&self, speed: f64) -> f64 {
        self.pause * (self.speed + speed)
    }
}

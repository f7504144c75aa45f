//! How obstacles were met.

use std::ptr;

use super::size::least_cell_sizes;
use crate::base::vector::norm;
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::body::Body;
use crate::scene::forces::Contact;
use crate::scene::timeline::{Phase, Scene};

/// How far a node may be inside an obstacle: this part of its cell, or of the body if that is more.
const MOST_OF_CELL: f64 = 0.5;
const MOST_OF_BODY: f64 = 0.02;
/// The name of the indicator of how deep a body begins inside an obstacle.
pub(super) const START_DEPTH: &str = "start-depth";

/// How near the body came to an obstacle while it acted.
pub(super) struct Meeting {
    obstacle: String,
    /// A bound on its speed (m/s) at and between samples.
    speed: f64,
    /// Least distance (m), below 0 inside the obstacle.
    nearest: f64,
    /// The largest depth (m) relative to its limit (m), and the node there, counted from 0.
    deepest: Deepest,
    /// Whether nodes were deeper than the limit at t = 0, which is [reported separately](begun_inside).
    is_begun_inside: bool,
}

impl Meeting {
    pub(super) fn obstacle(&self) -> &str {
        &self.obstacle
    }

    /// Whether the obstacle may be too soft: nodes were inside, and not from the beginning.
    pub(super) fn may_be_soft(&self) -> bool {
        self.deepest.depth > 0.0 && !self.is_begun_inside
    }

    /// How deep (m) nodes were inside.
    pub(super) fn depth(&self) -> f64 {
        self.deepest.depth
    }
}

#[derive(Clone, Copy)]
struct Deepest {
    depth: f64,
    limit: f64,
    node: usize,
}

impl Deepest {
    const NONE: Self = Self { depth: 0.0, limit: 1.0, node: 0 };

    fn see(&mut self, depth: f64, limit: f64, node: usize) {
        if depth / limit > self.depth / self.limit {
            *self = Self { depth, limit, node };
        }
    }

    fn is_beyond(&self) -> bool {
        self.depth > self.limit
    }
}

/// How near the body came, at `samples`, to the obstacles that act there.
pub(super) fn meetings(trajectory: &Trajectory, samples: &[&Sample]) -> Vec<Meeting> {
    let scene = trajectory.scene();
    if scene.obstacles().is_empty() {
        return Vec::new();
    }
    let limits = depth_limits(scene.body());
    // precision of speeds of paths given by formulas
    let precision = 1e-3 * scene.body().size();
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
                    deepest: Deepest::NONE,
                    is_begun_inside: false,
                });
                meetings.len() - 1
            });
            let meeting = &mut meetings[number];
            let fastest = contact.obstacle().cubics([last, sample.time], precision).fastest;
            meeting.speed = meeting.speed.max(fastest);
            contact.each_distance(sample.time, &sample.u, |distance, node| {
                meeting.nearest = meeting.nearest.min(distance);
                meeting.deepest.see(-distance, limits[node], node);
            });
            meeting.is_begun_inside |= sample.time <= 0.0 && meeting.deepest.is_beyond();
        }
        last = sample.time;
    }
    meetings
}

/// For each node the depth (m) up to which it may be inside an obstacle, by the smallest of its cells.
fn depth_limits(body: &Body) -> Vec<f64> {
    let least = MOST_OF_BODY * body.size();
    least_cell_sizes(body).into_iter().map(|size| f64::max(MOST_OF_CELL * size, least)).collect()
}

/// Nodes inside obstacles.
pub(super) fn depths(meetings: &[Meeting]) -> impl Iterator<Item = Indicator> {
    meetings.iter().filter(|meeting| meeting.may_be_soft()).map(|meeting| {
        let Deepest { depth, limit, node } = meeting.deepest;
        let told = format!(
            "node {} is {depth:.2e} m inside obstacle \"{}\" (limit: {limit:.2e} m, half a cell or 2 % of the \
             body)",
            node + 1,
            meeting.obstacle
        );
        let beyond = || format!("{told}: raise the stiffness of the obstacle");
        Indicator::trusted("depth", (depth, "m"), [0.0, limit], || told.clone(), beyond)
    })
}

/// Obstacles of the first phase that the body begins inside of.
pub(super) fn begun_inside(scene: &Scene) -> Vec<Indicator> {
    let contacts = scene.phases().first().and_then(|phase| scene.contacts(phase).ok());
    let contacts = contacts.unwrap_or_default();
    if contacts.is_empty() {
        return Vec::new();
    }
    let limits = depth_limits(scene.body());
    let of_contact = |contact: &Contact| {
        let (mut deepest, mut count) = (Deepest::NONE, 0);
        contact.each_distance(0.0, scene.initial_displacements(), |distance, node| {
            deepest.see(-distance, limits[node], node);
            count += usize::from(distance < 0.0);
        });
        let Deepest { depth, limit, node } = deepest;
        let name = contact.obstacle().name();
        let said = format!(
            "the body begins with {count} node(s) inside obstacle \"{name}\", node {} the deepest by {depth:.2e} m (limit: \
             {limit:.2e} m, half a cell or 2 % of the body)",
            node + 1
        );
        let beyond = || {
            format!(
                "{said}: it would be thrown out or torn; move the obstacle or the body, or leave the obstacle out of the \
                 first phase"
            )
        };
        let value = (depth, "m");
        (depth > 0.0)
            .then(|| Indicator::trusted(START_DEPTH, value, [0.0, limit], || said.clone(), beyond))
    };
    contacts.iter().filter_map(of_contact).collect()
}

/// Obstacles that touch and would hold the body by friction, in an equilibrium, where friction does not act.
pub(super) fn slippery(
    trajectory: &Trajectory,
    meetings: &[Meeting],
) -> impl Iterator<Item = Indicator> {
    let obstacles = trajectory.scene().obstacles().iter();
    let is_met = |name: &str| meetings.iter().any(|met| met.obstacle == name && met.nearest <= 0.0);
    obstacles.filter(|obstacle| obstacle.has_friction()).map(move |obstacle| {
        let within = || {
            let name = obstacle.name();
            format!("obstacle \"{name}\" has friction, but does not touch (limit: none)")
        };
        let beyond = || format!(
            "obstacle \"{}\" has friction, which does not act in statics (limit: none): the body slides as if there were \
             none; run the scene until it is at rest instead",
            obstacle.name()
        );
        let value = if is_met(obstacle.name()) { 1.0 } else { 0.0 };
        Indicator::trusted("friction-in-statics", (value, ""), [0.0, 0.0], within, beyond)
    })
}

/// Obstacles that acted, and from which the body was always farther away than it may move between samples.
pub(super) fn missed(meetings: &[Meeting], reach: Reach) -> impl Iterator<Item = Indicator> {
    meetings.iter().map(move |Meeting { obstacle, speed, nearest, .. }| {
        let within = || match *nearest <= 0.0 {
            true => format!("obstacle \"{obstacle}\" was touched"),
            false => format!(
                "obstacle \"{obstacle}\" may have been touched: the body came as near as {nearest:.2e} m, and nearer between \
                 samples"
            ),
        };
        let beyond = || {
            format!(
                "obstacle \"{obstacle}\" was never touched, though it acts: the body came as near as {nearest:.2e} m (limit: 0 \
                 m); move one of them, or leave the obstacle out"
            )
        };
        let limits = [f64::NEG_INFINITY, reach.towards(*speed)];
        Indicator::trusted("distance", (*nearest, "m"), limits, within, beyond)
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

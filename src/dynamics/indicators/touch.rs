//! Contact with obstacles: depth, passages, and obstacles that are never touched.

use std::ptr;

use super::penetration::depth_limits;
use crate::base::input::four_digits;
use crate::base::vector::norm;
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::{Deepest, DepthLimit, Sample, Trajectory};
use crate::scene::forces::{Contact, Obstacle};
use crate::scene::timeline::{Phase, Scene};

/// The name of the indicator of how deep a body begins inside an obstacle.
pub(super) const START_DEPTH: &str = "start-depth";

/// Least distance of the body from an obstacle while it acted.
pub(super) struct Meeting {
    obstacle: String,
    /// A bound on its speed (m/s) at and between samples.
    speed: f64,
    /// Least distance (m), below 0 inside the obstacle.
    nearest: f64,
    /// The deepest node.
    deepest: Option<Deepest>,
    /// Estimated factor by which its stiffness would have to be larger to keep nodes within their limits.
    stiffer: f64,
    /// Whether nodes were deeper than the limit at t = 0, which is [reported separately](begun_inside).
    is_begun_inside: bool,
}

impl Meeting {
    pub(super) fn obstacle(&self) -> &str {
        &self.obstacle
    }

    /// Whether the obstacle may be too soft: nodes were inside, and not from the beginning.
    pub(super) fn may_be_soft(&self) -> bool {
        self.deepest.is_some() && !self.is_begun_inside
    }

    /// Depth (m) of nodes inside.
    pub(super) fn depth(&self) -> f64 {
        self.deepest.map_or(0.0, |deepest| deepest.depth)
    }
}

/// Least distances of the body, at `samples`, from the obstacles that act there.
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
                    deepest: None,
                    stiffer: 1.0,
                    is_begun_inside: false,
                });
                meetings.len() - 1
            });
            let meeting = &mut meetings[number];
            let fastest = contact.obstacle().cubics([last, sample.time], precision).fastest;
            meeting.speed = meeting.speed.max(fastest);
            contact.each_distance(sample.time, &sample.u, |distance, node| {
                meeting.nearest = meeting.nearest.min(distance);
                see(&mut meeting.deepest, (-distance, node), &limits);
            });
            let is_beyond = meeting.deepest.is_some_and(|deepest| deepest.part() > 1.0);
            meeting.is_begun_inside |= sample.time <= 0.0 && is_beyond;
        }
        last = sample.time;
    }
    for known in &trajectory.penetrations {
        let of = meetings.iter_mut().find(|meeting| meeting.obstacle == known.obstacle);
        let (Some(meeting), Some(deepest)) = (of, known.at_nodes) else { continue };
        meeting.stiffer = known.stiffer;
        Deepest::replace(&mut meeting.deepest, deepest);
    }
    meetings
}

/// Considers a depth (m) of a node.
fn see(deepest: &mut Option<Deepest>, (depth, node): (f64, usize), limits: &[DepthLimit]) {
    let here = Deepest { depth, limit: limits[node], time: None, nodes: [node; 2] };
    Deepest::replace(deepest, here);
}

/// Nodes inside obstacles.
pub(super) fn depths(scene: &Scene, meetings: &[Meeting]) -> impl Iterator<Item = Indicator> {
    meetings.iter().filter(|meeting| meeting.may_be_soft()).filter_map(move |meeting| {
        let Deepest { depth, limit, time, nodes } = meeting.deepest?;
        let when = time.map_or(String::new(), |t| format!(" at t = {} s", four_digits(t)));
        let said = format!(
            "node {} is {depth:.2e} m inside obstacle \"{}\"{when} (limit: {:.2e} m, {})",
            nodes[0] + 1,
            meeting.obstacle,
            limit.depth,
            limit.reason
        );
        let beyond = || {
            let to = stiffness(scene, &meeting.obstacle, meeting.stiffer);
            format!("{said}: raise the stiffness of the obstacle{to}")
        };
        let limits = [0.0, limit.depth];
        Some(Indicator::trusted("depth", (depth, "m"), limits, || said.clone(), beyond))
    })
}

/// The required stiffness of an obstacle, in words, if the factor `stiffer` is known.
fn stiffness(scene: &Scene, name: &str, stiffer: f64) -> String {
    let of = scene.obstacles().iter().find(|obstacle| obstacle.name() == name);
    let Some(obstacle) = of.filter(|_| stiffer > 1.0) else { return String::new() };
    let (given, unit) = obstacle.given_stiffness();
    format!(", from {given:.1e} to about {:.1e} {unit} by its energy", stiffer * given)
}

/// Obstacles that points of the surface have passed through.
pub(super) fn passages(trajectory: &Trajectory) -> impl Iterator<Item = Indicator> {
    let known = trajectory.penetrations.iter().filter(|known| known.half_thickness.is_finite());
    known.map(|known| {
        let name = &known.obstacle;
        let within = || format!("no point passed the middle of obstacle \"{name}\" (limit: 0)");
        let beyond = || {
            let (time, nodes) = known.first_passage.unwrap_or_default();
            let to = stiffness(trajectory.scene(), name, known.stiffer);
            format!(
                "the body passed through obstacle \"{name}\": its surface went past the middle {} time(s) (limit: 0), first at \
                 {} at t = {} s, and was pushed out on the other side; raise the stiffness of the obstacle{to}, or make it \
                 thicker than {:.1e} m",
                known.passages,
                on(nodes),
                four_digits(time),
                2.0 * known.half_thickness
            )
        };
        let value = (known.passages as f64, "");
        Indicator::trusted("passage", value, [0.0, 0.0], within, beyond)
    })
}

/// Obstacles between nodes of the surface, where nothing pushes back.
pub(super) fn between_nodes(trajectory: &Trajectory) -> impl Iterator<Item = Indicator> {
    trajectory.penetrations.iter().filter_map(|known| {
        let deepest = known.between?;
        let at_nodes = known.at_nodes.map_or(0.0, |at_nodes| at_nodes.depth);
        if deepest.depth <= at_nodes {
            return None;
        }
        let Deepest { depth, limit, nodes, time } = deepest;
        let mesh = trajectory.body().mesh();
        let [a, b] = nodes.map(|node| mesh.position(node));
        let edge = norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>());
        let said = format!(
            "the surface between {}, {edge:.2e} m apart, is {depth:.2e} m inside obstacle \"{}\" at t = {} s (limit: {:.2e} m, \
             {})",
            on(nodes),
            known.obstacle,
            four_digits(time.unwrap_or_default()),
            limit.depth,
            limit.reason
        );
        let beyond = || {
            let least = f64::min(known.half_thickness, 0.5 * edge);
            format!(
                "{said}: contact does not act there; refine the surface to edges of at most {least:.1e} m, or round the obstacle"
            )
        };
        let limits = [0.0, limit.depth];
        Some(Indicator::trusted("depth-between-nodes", (depth, "m"), limits, || said.clone(), beyond))
    })
}

/// Nodes in words, counted from 1.
fn on([a, b]: [usize; 2]) -> String {
    if a == b { format!("node {}", a + 1) } else { format!("nodes {} and {}", a + 1, b + 1) }
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
        let (mut deepest, mut count) = (None, 0);
        contact.each_distance(0.0, scene.initial_displacements(), |distance, node| {
            see(&mut deepest, (-distance, node), &limits);
            count += usize::from(distance < 0.0);
        });
        let Deepest { depth, limit, nodes, .. } = deepest?;
        let name = contact.obstacle().name();
        let said = format!(
            "the body begins with {count} node(s) inside obstacle \"{name}\", node {} the deepest by {depth:.2e} m (limit: \
             {:.2e} m, {})",
            nodes[0] + 1,
            limit.depth,
            limit.reason
        );
        let beyond = || {
            format!(
                "{said}: it would be thrown out or torn; move the obstacle or the body, or leave the obstacle out of the \
                 first phase"
            )
        };
        let value = (depth, "m");
        let limits = [0.0, limit.depth];
        Some(Indicator::trusted(START_DEPTH, value, limits, || said.clone(), beyond))
    };
    contacts.iter().filter_map(of_contact).collect()
}

/// Obstacles and other bodies that touch and would hold the body by friction, in the search for an equilibrium, where friction does not act.
pub(super) fn slippery(trajectory: &Trajectory) -> Vec<Indicator> {
    let scene = trajectory.scene();
    let meetings = match scene.obstacles().iter().any(Obstacle::has_friction) {
        true => meetings(trajectory, &trajectory.samples().iter().collect::<Vec<_>>()),
        false => Vec::new(),
    };
    let is_met = |name: &str| meetings.iter().any(|met| met.obstacle == name && met.nearest <= 0.0);
    let obstacles = scene.obstacles().iter().filter(|obstacle| obstacle.has_friction());
    let obstacles = obstacles
        .map(|obstacle| (format!("obstacle \"{}\"", obstacle.name()), is_met(obstacle.name())));
    let rub = scene.touches().iter().any(|touch| touch.sticks_below(1.0).is_some());
    let touches = if rub { scene.touch_forces().unwrap_or_default() } else { Vec::new() };
    let touches = touches.iter().filter(|touch| touch.has_friction()).map(|touch| {
        let is_met = |sample: &Sample| touch.gap(&sample.u) < touch.distance();
        (format!("touch \"{}\"", touch.name), trajectory.samples().iter().any(is_met))
    });
    let told = |(name, is_met): (String, bool)| {
        let within = || format!("{name} has friction, but nothing touches there (limit: none)");
        let beyond = || {
            format!(
                "{name} has friction, which does not act in statics (limit: none): the body slides as if there were none; \
                 run the scene until it is at rest instead"
            )
        };
        let value = if is_met { 1.0 } else { 0.0 };
        Indicator::trusted("friction-in-statics", (value, ""), [0.0, 0.0], within, beyond)
    };
    obstacles.chain(touches).map(told).collect()
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

/// Bound of the motion of a body between samples.
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

    /// Bound of the approach (m) to an obstacle that moves at `speed` (m/s).
    fn towards(&self, speed: f64) -> f64 {
        self.pause * (self.speed + speed)
    }
}

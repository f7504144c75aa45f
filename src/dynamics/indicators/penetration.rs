//! Follows the surface of a body into obstacles, step by step: also between samples, and between nodes.

use std::sync::Arc;

use super::size::least_cell_sizes;
use super::skin::points;
use crate::base::vector::{difference, dot, norm};
use crate::dynamics::trajectory::{Deepest, DepthLimit, Penetration};
use crate::elements::body::{Body, Part};
use crate::elements::force::{Force, Step};
use crate::scene::forces::{Contact, SurfacePoint, boundary_nodes, thickness};
use crate::scene::timeline::{Phase, Scene};

/// Part of a cell, or of the body if that is more, by which a node may be inside an obstacle.
const MOST_OF_CELL: f64 = 0.5;
const MOST_OF_BODY: f64 = 0.02;
/// Part of the thickness of the body.
const MOST_OF_THICKNESS: f64 = 0.5;
/// Fraction of the distance to the middle of the obstacle, beyond which forces act towards its other side.
const MOST_OF_OBSTACLE: f64 = 0.5;
/// A point between nodes of quadratic faces moves at most this much farther than they do.
const REACH: f64 = 1.5;

/// For each node the depth up to which it may be inside an obstacle of any thickness: by the smallest of its cells, and by
/// the thickness of its body.
pub(super) fn depth_limits(body: &Body) -> Vec<DepthLimit> {
    let least = MOST_OF_BODY * body.size();
    let of_cell = |size: f64| DepthLimit {
        depth: f64::max(MOST_OF_CELL * size, least),
        reason: "half a cell or 2 % of the body",
    };
    let mut limits: Vec<DepthLimit> = least_cell_sizes(body).into_iter().map(of_cell).collect();
    for Part { body: own, nodes, .. } in body.parts() {
        let Some(thickness) = thickness(own) else { continue };
        let depth = MOST_OF_THICKNESS * thickness;
        let of_body = DepthLimit { depth, reason: "half of the thickness of the body" };
        limits[nodes].iter_mut().for_each(|limit| *limit = limit.or(of_body));
    }
    limits
}

/// The limit in an obstacle of this half thickness (m).
fn limit_within(half_thickness: f64) -> DepthLimit {
    let depth = MOST_OF_OBSTACLE * half_thickness;
    DepthLimit { depth, reason: "a quarter of the thickness of the obstacle" }
}

/// The surface of the body of a scene, and the obstacles that act on it.
#[derive(Default)]
pub(crate) struct Follower {
    points: Arc<[Followed]>,
    mass: f64,
    contacts: Vec<Contact>,
    /// Lower bounds of the distance (m) that each point can move before it is inside each obstacle.
    clearances: Vec<f64>,
}

struct Followed {
    on: SurfacePoint,
    /// Undeformed position (m).
    natural: [f64; 3],
    limit: DepthLimit,
    nodes: [usize; 2],
}

impl Follower {
    /// Nothing if the scene has no obstacles.
    pub(crate) fn new(scene: &Scene) -> Self {
        if scene.obstacles().is_empty() {
            return Self::default();
        }
        let body = scene.body();
        let (d, limits) = (body.dimension(), depth_limits(body));
        let fills_space = |part: Part| part.body.mesh().kind().dimension() == d;
        let all =
            if body.parts().any(fills_space) { points(body, 2) } else { boundary_nodes(body) };
        let positions = body.mesh().positions();
        let followed = |on: SurfacePoint| {
            // the ends of an edge come first
            let nodes: Vec<usize> = on.nodes().map(|(node, _)| node).collect();
            let limit = nodes.iter().map(|&node| limits[node]).reduce(DepthLimit::or)?;
            let ends = [nodes[0], *nodes.get(1).unwrap_or(&nodes[0])];
            Some(Followed { natural: on.at(positions, d), limit, nodes: ends, on })
        };
        let points = all.into_iter().filter_map(followed).collect();
        Self { points, mass: body.mass(), ..Self::default() }
    }

    /// The same surface, before it is followed.
    pub(crate) fn anew(&self) -> Self {
        Self { points: self.points.clone(), mass: self.mass, ..Self::default() }
    }

    /// From now on follows it into the obstacles of a phase.
    pub(crate) fn begin(&mut self, scene: &Scene, phase: &Phase) {
        if self.points.is_empty() {
            return;
        }
        self.contacts = scene.contacts(phase).unwrap_or_default();
        self.clearances.clear();
        self.clearances.resize(self.points.len() * self.contacts.len(), 0.0);
    }

    /// Adds the findings of a step to `known`; `kinetic` returns the kinetic energy (J) at its end.
    pub(crate) fn follow(
        &mut self,
        step: &Step,
        kinetic: impl Fn() -> f64,
        known: &mut Vec<Penetration>,
    ) {
        let Self { points, mass, contacts, clearances } = self;
        let Some(d) = contacts.first().map(Contact::dimension) else { return };
        let moved = step.u[0]
            .chunks_exact(d)
            .zip(step.u[1].chunks_exact(d))
            .map(|(a, b)| a.iter().zip(b).map(|(a, b)| (b - a) * (b - a)).sum::<f64>());
        let reach = REACH * moved.fold(0.0, f64::max).sqrt();
        for (contact, clearances) in contacts.iter().zip(clearances.chunks_mut(points.len())) {
            let obstacle = contact.obstacle();
            let [from, to] = step.times.map(|t| obstacle.displacement(t));
            let reach = reach + norm(&difference(&to, &from));
            for (point, clearance) in points.iter().zip(clearances) {
                *clearance -= reach;
                if *clearance > 0.0 {
                    continue;
                }
                let x = step.u.map(|u| {
                    let u = point.on.at(u, d);
                    std::array::from_fn(|i| point.natural[i] + u[i])
                });
                let [before, after] = [0, 1].map(|k| contact.distance_of(step.times[k], x[k]));
                *clearance = after.max(0.0);
                if before >= 0.0 && after >= 0.0 {
                    continue;
                }
                let half_thickness = contact.half_thickness(step.times[1], x[1]);
                let limit = point.limit.or(limit_within(half_thickness));
                let is_passed = contact.is_passed(step.times, x, point.limit.depth);
                let depth =
                    if is_passed && half_thickness.is_finite() { half_thickness } else { -after };
                let own = record(known, obstacle.name());
                own.half_thickness = own.half_thickness.min(half_thickness);
                let deepest =
                    Deepest { depth, limit, time: Some(step.times[1]), nodes: point.nodes };
                let is_node = point.nodes[0] == point.nodes[1];
                let kind = if is_node { &mut own.at_nodes } else { &mut own.between };
                let is_new = Deepest::replace(kind, deepest);
                if is_passed {
                    own.passages += 1;
                    own.first_passage.get_or_insert((step.times[1], point.nodes));
                }
                if is_node && (is_new && deepest.part() > 1.0 || own.passages == 1 && is_passed) {
                    // a moving body stops within the limit if the springs store its energy there
                    let stored = contact.potential(step.times[1], step.u[1]);
                    let w = obstacle.velocity_at(step.times[1]);
                    let speed = (2.0 * kinetic() / *mass).sqrt() + dot(&w, &w).sqrt();
                    let all = 1.0 + 0.5 * *mass * speed * speed / stored;
                    let squared = deepest.part() * deepest.part();
                    let stiffer = if all.is_finite() { squared * all } else { squared };
                    own.stiffer = own.stiffer.max(stiffer);
                }
            }
        }
    }
}

/// The record of an obstacle.
fn record<'a>(known: &'a mut Vec<Penetration>, obstacle: &str) -> &'a mut Penetration {
    let number = known.iter().position(|own| own.obstacle == obstacle).unwrap_or_else(|| {
        known.push(Penetration::none(obstacle));
        known.len() - 1
    });
    &mut known[number]
}

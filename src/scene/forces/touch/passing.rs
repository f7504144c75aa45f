//! Steps that lead through a surface between their ends.

use std::sync::Arc;

use super::crossing::Ways;
use super::force::TouchForce;
use super::law::Kind;
use super::near::NearPair;
use crate::elements::force::Step;
use crate::scene::forces::passage::Path;

/// Part of its distance to which a point may come near a facet within one step.
const ONTO: f64 = 0.02;

impl TouchForce {
    /// The first time (s) at which a step comes too near a facet or an edge between its ends.
    pub(super) fn first_passage(&self, step: &Step) -> Option<f64> {
        let ([start, end], acts_from) = (step.times, self.law.distance);
        let (mut near, mut moved) = self.near(step.u[0]);
        let nearer = 2.0 * self.surfaces.reach * step.reach(self.surfaces.dimension);
        if !near.covers(acts_from, moved + nearer) {
            near = Arc::new(self.search(step.u[0], acts_from + nearer));
            moved = 0.0;
        }
        let mut first = None;
        for near in &near.pairs {
            let is_far = near.distance - moved - nearer >= acts_from;
            if is_far || !self.surfaces.is_facet(near.feature) {
                continue;
            }
            let ways = self.ways(near, step);
            if !ways.stay_beyond(acts_from) {
                first = self.meets(&ways, acts_from, first).or(first);
            }
        }
        let acts_from = self.edges.law.distance;
        for near in near.edges.iter().filter(|near| near.distance - moved - nearer < acts_from) {
            let ways = self.edges.ways(&self.surfaces, near, step);
            first = self.meets(&ways, acts_from, first).or(first);
        }
        first.map(|part| start + part * (end - start))
    }

    /// The ways of a point relative to the nodes of a facet in a step.
    fn ways(&self, near: &NearPair, step: &Step) -> Ways<'_> {
        let d = self.surfaces.dimension;
        let duration = step.times[1] - step.times[0];
        let on = &self.surfaces.points[near.point].on;
        let facet = &self.surfaces.features[near.feature];
        let of = facet.nodes();
        let points = step.u.map(|u| self.surfaces.point_at(near.point, u));
        let nodes = step.u.map(|u| self.surfaces.nodes_at(near.feature, u));
        let velocities = step.v.map(|v| on.at(v, d));
        let paths = std::array::from_fn(|k| {
            let k = k.min(of.len() - 1);
            let x = [0, 1].map(|end| std::array::from_fn(|i| points[end][i] - nodes[end][k][i]));
            let v = [0, 1].map(|end| {
                let of_node = &step.v[end][of[k] * d..][..d];
                std::array::from_fn(|i| velocities[end][i] - of_node.get(i).copied().unwrap_or(0.0))
            });
            Path::new(x, v, duration)
        });
        let radii = self.surfaces.radii(near.point, near.feature);
        Ways::to_facet(facet, paths, self.surfaces.reach, radii)
    }

    /// The first place before `first` at which a step has to end.
    fn meets(&self, ways: &Ways, acts_from: f64, first: Option<f64>) -> Option<f64> {
        let limit = self.limit(ways.ends(), acts_from)?;
        ways.meets(limit, first.unwrap_or(1.0))
    }

    /// The distance (m) below which a step must not lead unseen, for these distances at its ends of what acts from
    /// `acts_from` (m) on. A step that ends on the surface itself is none that can be continued.
    fn limit(&self, [before, after]: [f64; 2], acts_from: f64) -> Option<f64> {
        let least = before.min(after);
        match self.law.kind {
            Kind::Barrier if after < ONTO * before.min(acts_from) => {
                Some(0.5 * before.min(acts_from))
            }
            // the force where it is entered is still small
            _ if least >= acts_from => Some(0.9 * acts_from),
            // a soft spring may be passed through where it has acted
            Kind::Spring if least < 0.5 * acts_from => None,
            _ => Some(0.5 * least),
        }
    }
}

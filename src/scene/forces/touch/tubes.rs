//! Rods as tubes: points and straight pieces of their axes, which feel others from their radius on.
//!
//! A point of the axis stands for the tube over its part of the length, as wide as it is seen from aside; the distance of surfaces is that from the
//! axis less the radii. Normal forces meet the axis. Friction and damping act where the surfaces meet, beside the axis by the radius: there the
//! point moves with the directors, and its nodes and shares are those of the axis and of theirs ([`Levers`]). A piece has the mean of
//! the radii at its ends, a point its own.

use std::collections::BTreeMap;

use super::pair::{Levers, Pair};
use super::surfaces::{Feature, Point, Surfaces};
use crate::base::vector::{difference, dot};
use crate::elements::mesh::FaceKind;
use crate::elements::rod::TubePiece;
use crate::scene::forces::surface::{HALVED_SIMPSON, SurfacePoint};

impl Surfaces {
    /// The nodes at the directors of the section at a node, if it is one of a rod's axis.
    pub(super) fn directors(&self, node: usize) -> &[usize] {
        match self.sections.get(node) {
            Some(Some(spokes)) => &spokes.nodes[..spokes.count],
            _ => &[],
        }
    }

    /// Adds the points and the pieces of a tube. Returns its size (m), as that of [facets](Surfaces::part).
    pub(super) fn add_tube(&mut self, body: usize, pieces: &[TubePiece]) -> f64 {
        let mut size = f64::INFINITY;
        // points at nodes are those of both pieces there
        let mut at_nodes: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
        for piece in pieces {
            let ends = piece.ends.map(|(node, _)| node);
            for &(node, spokes) in &piece.ends {
                let known = self.sections.len().max(node + 1);
                self.sections.resize(known, None);
                self.sections[node] = Some(spokes);
            }
            for (shares, part) in HALVED_SIMPSON {
                let area = part * piece.length * piece.width;
                let radius = dot(shares, &piece.radii);
                match shares.iter().position(|share| *share == 1.0) {
                    Some(end) => at_nodes.entry(ends[end]).or_insert((0.0, radius)).0 += area,
                    None => {
                        let on = SurfacePoint::between(&ends, shares, area);
                        self.points.push(Point::new(on, body, radius));
                    }
                }
            }
            let radius = 0.5 * (piece.radii[0] + piece.radii[1]);
            self.features.push(Feature::new(FaceKind::Segment, &ends, body, radius));
            self.nodes.extend(ends);
            size = size.min(piece.length).min(2.0 * radius);
        }
        for (node, (area, radius)) in at_nodes {
            let on = SurfacePoint::between(&[node], &[1.0], area);
            self.points.push(Point::new(on, body, radius));
        }
        size
    }

    /// Has damping and friction of a pair act where the tubes of its point, or its first edge, and its place, with these radii (m), meet at the
    /// displacements `u` (m).
    pub(super) fn add_levers(&self, pair: &mut Pair, radii: [f64; 2], u: &[f64]) {
        let mut levers = Levers::default();
        for base in 0..pair.count {
            let is_of_point = base < pair.of_point;
            // towards the other one
            let radius = if is_of_point { -radii[0] } else { radii[1] };
            let Some(Some(spokes)) = self.sections.get(pair.nodes[base]) else { continue };
            for k in 0..spokes.count {
                let (node, arm) = (spokes.nodes[k], spokes.arms[k]);
                let along = difference(&self.node_at(node, u), &self.node_at(pair.nodes[base], u));
                let at = pair.count;
                pair.nodes[at] = node;
                pair.count += 1;
                levers.push(base, at, [radius, arm], along.map(|x| x / arm));
            }
        }
        pair.set_levers(levers);
    }
}

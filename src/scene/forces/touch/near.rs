//! Which points and features, and which edges, are near each other.
//!
//! A list has the pairs nearer than D and a margin (`base/grid.rs`), and serves as long as no node has moved
//! by half of the margin. It changes the cost of an evaluation and not its result: forces stay functions of
//! (t, u, v). Curved faces in space count from boxes around them (`hull.rs`), and the nearest place is sought
//! only within these. A body's own points leave out the facets around them and everything nearer than 2 D in
//! the undeformed shape; weights of edges and corners are those of the rest.
//!
//! The pattern of the Newton matrix follows (`System::make_room`, `ContactForce::couplings_near`): before tangents
//! are evaluated, the force reports whether a pair that acts lacks entries, and then all near pairs get some.
//! Earlier ones keep theirs, unless they are many more.

use super::edge_pairs::{Edges, NearEdges};
use super::surfaces::Surfaces;
use crate::base::grid::Grid;

/// Points and features, and edges, that were nearer than a certain distance in some state.
pub(super) struct Near {
    /// The displacements then (m).
    u: Vec<f64>,
    /// The distance (m).
    within: f64,
    pub(super) pairs: Vec<NearPair>,
    pub(super) edges: Vec<NearEdges>,
}

/// A point and a feature, by their numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearPair {
    pub(super) point: usize,
    pub(super) feature: usize,
    /// The weight of the feature, times the part of the energy that the side of the point has.
    pub(super) weight: f64,
    /// The distance (m) of their surfaces in that state; no more than that from a curved face.
    pub(super) distance: f64,
}

impl Near {
    /// All pairs `within` a distance (m) under the displacements `u` (m), in the order of their numbers.
    pub(super) fn new(surfaces: &Surfaces, edges: &Edges, u: &[f64], within: f64) -> Self {
        let at: Vec<[f64; 3]> =
            surfaces.nodes.iter().map(|&node| surfaces.node_at(node, u)).collect();
        let mut pairs = Vec::new();
        let places: Vec<[f64; 3]> =
            (0..surfaces.points.len()).map(|point| surfaces.point_at(point, u)).collect();
        // a state that is no state has no neighbours
        let is_finite = places.iter().chain(&at).flatten().all(|x| x.is_finite());
        if is_finite && !places.is_empty() {
            let grid = Grid::new(&places);
            let widest =
                surfaces.points.iter().fold(0.0, |most: f64, point| most.max(point.radius));
            for feature in 0..surfaces.features.len() {
                let at = surfaces.nodes_at(feature, u);
                let known = &surfaces.features[feature];
                let [low, high] = surfaces.box_of(feature, &at);
                let reach = within + widest + known.radius;
                let [low, high] = [low.map(|x| x - reach), high.map(|x| x + reach)];
                let hull = known.hull(&at);
                grid.each_within(&[low, high], |point| {
                    let x = &places[point];
                    let radii = surfaces.radii(point, feature);
                    let bound = hull.as_ref().map(|hull| hull.distance(x) - radii);
                    if bound.is_some_and(|bound| bound > within) {
                        return;
                    }
                    let weight = surfaces.part(point, feature) * surfaces.weight(point, feature);
                    if weight == 0.0 {
                        return;
                    }
                    let exact = || known.nearest(&at, x).distance(&at, x) - radii;
                    let distance = bound.unwrap_or_else(exact);
                    if distance <= within {
                        pairs.push(NearPair { point, feature, weight, distance });
                    }
                });
            }
            pairs.sort_unstable_by_key(|pair| (pair.point, pair.feature));
        }
        let edges = if is_finite { edges.near(surfaces, u, within) } else { Vec::new() };
        Self { u: u.to_vec(), within, pairs, edges }
    }

    /// Upper bound of the approach (m) of any pair since then: twice the largest displacement on the surfaces.
    pub(super) fn moved(&self, surfaces: &Surfaces, u: &[f64]) -> f64 {
        let d = surfaces.dimension;
        2.0 * surfaces.farthest(|node| {
            let [from, to] = [&self.u[..], u].map(|u| &u[node * d..][..d]);
            std::array::from_fn(|i| to.get(i).zip(from.get(i)).map_or(0.0, |(to, from)| to - from))
        })
    }

    /// Whether the pairs include all that are within `distance` (m) once they may have come `nearer` (m).
    pub(super) fn covers(&self, distance: f64, nearer: f64) -> bool {
        distance + nearer <= self.within
    }
}

//! Edges of surfaces in space that cross edges: what points and facets do not see.
//!
//! Where the nearest places of two edges lie within both, their energy is
//!
//! ```text
//! F phi_e(d)
//! ```
//!
//! with the distance d, a [`Window`] F, and the [law](NormalLaw) phi_e: that of points and facets for half of the distance D, in which
//! pressures are the same at the same part of it. Points within D of the other surface share what presses; where only
//! edges cross, these come as near as D/2. So surfaces that lie on each other are carried by their points alone, as long
//! as the pressure is below that of the law at D/2.
//!
//! The area A of F is a quarter of the geometric mean of the areas of both edges, a third of the triangles beside each (of
//! halves of quadrilaterals). How many edges cross on an area goes with 1/(h h'), their lengths, so that the sum of F is the
//! same for all meshes. Between flat surfaces it adds 1.2 % to the force at 0.4 D, and 4.4 % at D/4.
//!
//! F falls to 0 with its slope over the last quarter of an edge (`window.rs`): beyond, the place is a node
//! that is near. Continuous forces, with one derivative by xi more than the distance has, are the price of
//! not using the distances of whole edges, as M. Li et al. (ACM Trans. Graph. 39 (2020) 49) do: those count a
//! node near an edge once for each edge that ends in it. Places run along edges that become parallel, by
//! d/sqrt(c) for each angle, c = |a x b|^2; F therefore falls as c^2, from where edges of undeformed lengths
//! a and b part by less than D over these, c < D^2 a b, so that their ends are within D of the other one.
//!
//! Pieces of the axes of tubes are edges, too, whose surfaces are nearer by their radii.
//!
//! Forces are internal, as F depends on the four nodes alone: momentum is kept. Edges are those of facets, in
//! two straight halves where they have a mid node; those that share a node with facets beside each other, are
//! glued, or lie within 3/2 D of each other in the undeformed shape of a body do not act. They add no area to
//! the nodal quantities of contact, as edges cross in points.

use super::crossing::Ways;
use super::law::NormalLaw;
use super::pair::Pair;
use super::surfaces::Surfaces;
use super::window::Window;
use crate::base::grid::Grid;
use crate::base::vector::{cross, difference, dot, norm};
use crate::elements::force::Step;
use crate::scene::forces::passage::Path;
use crate::scene::forces::surface::weighted;

/// The edges of some surfaces; none in the plane.
pub(super) struct Edges {
    edges: Vec<Edge>,
    /// Pairs that do not act, ascending.
    unfelt: Vec<[usize; 2]>,
    pub(super) law: NormalLaw,
}

struct Edge {
    /// Its number among the features.
    feature: usize,
    nodes: [usize; 2],
    /// The nodes of the facets beside it.
    around: Vec<usize>,
    /// A third of the undeformed areas (m^2) of triangles beside it, and its undeformed length (m).
    area: f64,
    length: f64,
    /// Of the tube whose axis it is (m), or 0.
    radius: f64,
}

/// Two edges, by their numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearEdges {
    pub(super) edges: [usize; 2],
    /// Their distance (m) in the state in which they were found.
    pub(super) distance: f64,
}

/// The part of the contact distance within which edges act.
const PART: f64 = 0.5;
/// The least c/e that counts: m is 3e-12 there, and the nearest places of edges that are exactly parallel mean nothing.
const PARALLEL: f64 = 1e-6;

impl Edges {
    /// The edges of surfaces whose points feel facets by a `law`; halves of edges with a mid node.
    pub(super) fn new(surfaces: &Surfaces, law: &NormalLaw) -> Self {
        let (damping, distance) = (law.damping / PART, law.distance * PART);
        let law = NormalLaw { stiffness: law.stiffness / PART, damping, distance, ..*law };
        let mut edges = Vec::new();
        if surfaces.dimension == 3 {
            for (feature, of) in surfaces.features.iter().enumerate() {
                match *of.nodes() {
                    [a, b] => edges.push(Edge::new(surfaces, feature, [a, b], 1.0)),
                    [a, b, middle] if !surfaces.is_facet(feature) => {
                        edges.push(Edge::new(surfaces, feature, [a, middle], 0.5));
                        edges.push(Edge::new(surfaces, feature, [middle, b], 0.5));
                    }
                    _ => {}
                }
            }
        }
        Self { edges, unfelt: Vec::new(), law }
    }

    /// Has pairs of edges not act that are `near` each other on bodies that are joined, as `is_joined` tells of the
    /// numbers of two bodies.
    pub(super) fn leave_out(
        &mut self,
        surfaces: &Surfaces,
        near: &[NearEdges],
        is_joined: impl Fn([usize; 2]) -> bool,
    ) {
        let bodies = |pair: &[usize; 2]| pair.map(|edge| self.body(surfaces, edge));
        self.unfelt =
            near.iter().map(|near| near.edges).filter(|pair| is_joined(bodies(pair))).collect();
    }

    /// All pairs `within` a distance (m) under the displacements `u` (m), in the order of their numbers.
    pub(super) fn near(&self, surfaces: &Surfaces, u: &[f64], within: f64) -> Vec<NearEdges> {
        let mut pairs = Vec::new();
        if self.edges.is_empty() {
            return pairs;
        }
        let ends: Vec<_> = (0..self.edges.len()).map(|edge| self.ends(surfaces, edge, u)).collect();
        let middles: Vec<[f64; 3]> =
            ends.iter().map(|[a, b]| std::array::from_fn(|i| 0.5 * (a[i] + b[i]))).collect();
        let halves: Vec<f64> = ends.iter().map(|[a, b]| 0.5 * norm(&difference(a, b))).collect();
        let longest = halves.iter().copied().fold(0.0, f64::max);
        let widest = self.edges.iter().map(|edge| edge.radius).fold(0.0, f64::max);
        let grid = Grid::new(&middles);
        for (a, middle) in middles.iter().enumerate() {
            let reach = halves[a] + longest + within + self.edges[a].radius + widest;
            let corners = [-reach, reach].map(|reach| middle.map(|x| x + reach));
            grid.each_within(&corners, |b| {
                let radii = self.edges[a].radius + self.edges[b].radius;
                let apart = || norm(&difference(middle, &middles[b])) - radii;
                if b <= a
                    || apart() > halves[a] + halves[b] + within
                    || !self.acts(surfaces, [a, b])
                {
                    return;
                }
                let distance = Pair::edges_apart(&ends[a], &ends[b]) - radii;
                if distance <= within {
                    pairs.push(NearEdges { edges: [a, b], distance });
                }
            });
        }
        pairs.sort_unstable_by_key(|pair| pair.edges);
        pairs
    }

    /// Whether two edges feel each other: neighbours do not, as points do not feel facets around those that they lie on.
    fn acts(&self, surfaces: &Surfaces, pair: [usize; 2]) -> bool {
        let [a, b] = pair.map(|edge| &self.edges[edge]);
        let [of_a, of_b] = pair.map(|edge| self.body(surfaces, edge));
        let touch = |a: &Edge, b: &Edge| a.nodes.iter().any(|node| b.around.contains(node));
        let are_neighbours = of_a == of_b && (!surfaces.itself || touch(a, b) || touch(b, a));
        !are_neighbours && self.unfelt.binary_search(&pair).is_err()
    }

    fn body(&self, surfaces: &Surfaces, edge: usize) -> usize {
        surfaces.features[self.edges[edge].feature].body
    }

    fn ends(&self, surfaces: &Surfaces, edge: usize, u: &[f64]) -> [[f64; 3]; 2] {
        self.edges[edge].nodes.map(|node| surfaces.node_at(node, u))
    }

    /// The nodes of two edges.
    pub(super) fn nodes(&self, near: &NearEdges) -> [[usize; 2]; 2] {
        near.edges.map(|edge| self.edges[edge].nodes)
    }

    /// The distance (m) of two edges under the displacements `u` (m).
    pub(super) fn apart(&self, surfaces: &Surfaces, near: &NearEdges, u: &[f64]) -> f64 {
        let [a, b] = near.edges.map(|edge| self.ends(surfaces, edge, u));
        Pair::edges_apart(&a, &b) - self.radii(near).iter().sum::<f64>()
    }

    /// The radii (m) of two edges.
    pub(super) fn radii(&self, near: &NearEdges) -> [f64; 2] {
        near.edges.map(|edge| self.edges[edge].radius)
    }

    /// The pair under the displacements `u` (m), whose [window](Pair::window) is its share of the energy per area (m^2);
    /// `None` where the nearest places do not lie within both edges, or these are parallel.
    pub(super) fn pair(&self, surfaces: &Surfaces, near: &NearEdges, u: &[f64]) -> Option<Pair> {
        let [of_a, of_b] = near.edges.map(|edge| &self.edges[edge]);
        let [a, b] = near.edges.map(|edge| self.ends(surfaces, edge, u));
        let [along_a, along_b] = [&a, &b].map(|[from, to]| difference(to, from));
        let (normal, between) = (cross(&along_a, &along_b), difference(&b[0], &a[0]));
        let (whole, size) = (dot(&normal, &normal), of_a.length * of_b.length);
        // edges that part by less than D over their lengths have ends within D of the other one, which feel it
        let unit = size * (self.law.distance / PART).powi(2);
        let places =
            [&along_b, &along_a].map(|along| dot(&cross(&between, along), &normal) / whole);
        let is_within = places.iter().all(|place| 0.0 < *place && *place < 1.0);
        if whole / unit <= PARALLEL || !is_within {
            return None;
        }
        let area = 0.25 * (of_a.area * of_b.area).sqrt();
        let window = Window::new(places, [whole / unit, unit], area);
        let radii = of_a.radius + of_b.radius;
        Some(Pair::of_edges([(of_a.nodes, &a), (of_b.nodes, &b)], places, window, radii))
    }

    /// The ways of two edges relative to each other in a step.
    pub(super) fn ways(&self, surfaces: &Surfaces, near: &NearEdges, step: &Step) -> Ways<'_> {
        let duration = step.times[1] - step.times[0];
        let ends = near.edges.map(|edge| step.u.map(|u| self.ends(surfaces, edge, u)));
        let speed = |node: usize, v: &[f64]| weighted([(node, 1.0)].into_iter(), v, 3);
        let speeds = self.nodes(near).map(|nodes| step.v.map(|v| nodes.map(|node| speed(node, v))));
        let paths = std::array::from_fn(|k| {
            let apart = |of: &[[[[f64; 3]; 2]; 2]; 2]| {
                [0, 1].map(|end| difference(&of[0][end][k % 2], &of[1][end][k / 2]))
            };
            Path::new(apart(&ends), apart(&speeds), duration)
        });
        Ways::of_edges(paths, self.radii(near).iter().sum())
    }
}

impl Edge {
    /// The part of an edge of a surface that is between two nodes.
    fn new(surfaces: &Surfaces, feature: usize, nodes: [usize; 2], part: f64) -> Self {
        let (mut around, mut area) = (Vec::new(), 0.0);
        let radius = surfaces.features[feature].radius;
        let [a, b] = nodes.map(|node| surfaces.at_rest(node));
        let length = norm(&difference(&a, &b));
        if surfaces.is_facet(feature) {
            // a tube: as wide as its points are
            let area = 2.0 * radius * length;
            return Self { feature, nodes, around: nodes.to_vec(), area, length, radius };
        }
        for &facet in &surfaces.features[feature].facets {
            around.extend_from_slice(surfaces.features[facet].nodes());
            area += part * surfaces.area_of_triangles(facet) / 3.0;
        }
        Self { feature, nodes, around, area, length, radius }
    }
}

//! The surfaces of bodies: quadrature points, and facets with their edges and corners. Those of rods are tubes ([`tubes`](super::tubes)).

use std::collections::BTreeMap;

use super::hull::Hull;
use crate::base::vector::{cross, difference, dot, norm, padded};
use crate::elements::basis::{MOST_NODES, NearestPoint, control_points, is_affine, nearest, reach};
use crate::elements::body::Body;
use crate::elements::mesh::FaceKind;
use crate::elements::rod::Spokes;
use crate::scene::forces::surface::{SurfacePoint, closed_points, is_within, pieces};

/// Ratio of the sizes of facets up to which the points of each have half of the energy. Fewer points, which move with the body
/// that slides, press more evenly than those of the other one, as long as none stands for more than lies over it.
const ALIKE: f64 = 2.0;

/// Size of the facets of a rigid body for that, over what they measure, opposite one that yields: as flat as it is between its edges, it needs
/// no points there.
const RIGID: f64 = 8.0;
/// Ratio of the areas around a point to the part that is seen along their normals from which it is at an edge of its surface: of two facets at an angle of 53 degrees.
const SHARP: f64 = 1.25;

/// Refused bodies, and what to do.
const STRING: [&str; 2] = ["a string among them", "a string has no surface: name the other bodies"];
const NOT_ROUND: [&str; 2] = [
    "a rod that is not round among them",
    "a rod touches other bodies as a round tube: give it the section of a circle or a ring, or name the other bodies",
];

/// The surfaces of some bodies.
pub(super) struct Surfaces {
    pub(super) dimension: usize,
    /// Undeformed positions of all nodes (m).
    natural: Vec<f64>,
    /// The nodes of the surfaces, ascending.
    pub(super) nodes: Vec<usize>,
    pub(super) points: Vec<Point>,
    /// Facets first.
    pub(super) features: Vec<Feature>,
    /// Whether a body touches itself.
    pub(super) itself: bool,
    /// Size (m) of the finer facets of each body; 0 of bodies that do not touch.
    sizes: Vec<f64>,
    are_rigid: Vec<bool>,
    /// The cross sections of rods, by the nodes of their axes, up to the last of these.
    pub(super) sections: Vec<Option<Spokes>>,
    /// No point or place on a surface moves farther than this times the nodes: 1 of linear cells.
    pub(super) reach: f64,
}

/// A quadrature point.
pub(super) struct Point {
    pub(super) on: SurfacePoint,
    /// The area (m^2) on which it bears: at an edge less than that of all faces around it.
    pub(super) bears: f64,
    /// Whether the surface around it is smooth.
    is_flat: bool,
    pub(super) body: usize,
    /// Of the tube (m) on whose axis it lies; 0 on a surface.
    pub(super) radius: f64,
    /// Facets that it does not feel, ascending: its neighbours on its own body, and on those it is glued to.
    unfelt: Vec<usize>,
}

/// A facet, which is a face of a cell, an edge or a corner.
pub(super) struct Feature {
    kind: FaceKind,
    nodes: [usize; MOST_NODES],
    count: usize,
    pub(super) body: usize,
    /// Of the tube (m) whose axis it is; 0 of a surface.
    pub(super) radius: f64,
    /// The facets that it belongs to, and for a corner its edges.
    pub(super) facets: Vec<usize>,
    edges: Vec<usize>,
    /// Its weight to points that feel all facets.
    weight: f64,
}

impl Surfaces {
    /// The surfaces of the bodies with these numbers, without faces between nodes (ascending) of one of the `planes`.
    ///
    /// # Errors
    /// A string, which has no surface, a rod that is not round: the value of the input, and what to do.
    pub(super) fn new(
        body: &Body,
        bodies: &[usize],
        itself: bool,
        planes: &[Vec<usize>],
    ) -> Result<Self, [&'static str; 2]> {
        let dimension = body.dimension();
        let mut surfaces = Self {
            dimension,
            natural: body.mesh().positions().to_vec(),
            nodes: Vec::new(),
            points: Vec::new(),
            features: Vec::new(),
            itself,
            sizes: vec![0.0; body.parts().count()],
            are_rigid: body.parts().map(|part| part.body.is_rigid()).collect(),
            sections: Vec::new(),
            reach: 1.0,
        };
        let parts: Vec<_> = body.parts().map(|part| part.nodes).collect();
        let faces = body.mesh().boundary_faces();
        for &number in bodies {
            if let Some(pieces) = body.tube_pieces(&parts[number]) {
                surfaces.sizes[number] = surfaces.add_tube(number, &pieces.ok_or(NOT_ROUND)?);
                continue;
            }
            let is_own =
                |face: &&Vec<usize>| parts[number].contains(&face[0]) && !is_within(face, planes);
            let own: Vec<Vec<usize>> = faces.iter().filter(is_own).cloned().collect();
            let points = closed_points(body, &own).ok_or(STRING)?.into_iter();
            let is_rigid = surfaces.are_rigid[number];
            surfaces.points.extend(points.map(|(on, seen)| {
                let is_flat = on.area < SHARP * seen;
                // a rigid body does not yield to uneven pressure: its edges are as stiff as they can be
                let bears = if is_rigid { on.area } else { seen };
                Point { bears, is_flat, ..Point::new(on, number, 0.0) }
            }));
            for face in &own {
                let kind = body.mesh().face_kind(face);
                surfaces.reach = surfaces.reach.max(reach(kind));
                surfaces.features.push(Feature::new(kind, face, number, 0.0));
            }
            surfaces.nodes.extend(own.concat());
            surfaces.sizes[number] = surfaces.usual_size(number);
        }
        surfaces.nodes.sort_unstable();
        surfaces.nodes.dedup();
        surfaces.add_edges_and_corners();
        Ok(surfaces)
    }

    /// A size (m) that a quarter of the facets of a body do not reach, where facets are all that there is yet; 0 without any.
    fn usual_size(&self, body: usize) -> f64 {
        let own = (0..self.features.len()).filter(|&facet| self.features[facet].body == body);
        let mut sizes: Vec<f64> = own.map(|facet| self.size_of(facet)).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        sizes.get(sizes.len() / 4).copied().unwrap_or_default()
    }

    /// Length (m) of a facet in the plane, the root of its area in space; 1 in one dimension.
    fn size_of(&self, facet: usize) -> f64 {
        match (self.dimension, self.features[facet].nodes()) {
            (2, &[a, b, ..]) => norm(&difference(&self.at_rest(b), &self.at_rest(a))),
            (3, _) => {
                let triangles = (self.features[facet].kind.corners() - 2) as f64;
                (self.area_of_triangles(facet) * triangles).sqrt()
            }
            _ => 1.0,
        }
    }

    fn add_edges_and_corners(&mut self) {
        // by their ends
        let mut edges: BTreeMap<[usize; 2], (Vec<usize>, Vec<usize>)> = BTreeMap::new();
        let mut corners: BTreeMap<usize, [Vec<usize>; 2]> = BTreeMap::new();
        for (number, facet) in self.features.iter_mut().enumerate() {
            facet.facets.push(number);
            if facet.kind == FaceKind::Point {
                continue;
            }
            for &node in &facet.nodes[..facet.kind.corners()] {
                corners.entry(node).or_default()[0].push(number);
            }
            for edge in facet.kind.edges() {
                let mut nodes: Vec<usize> = edge.iter().map(|&local| facet.nodes[local]).collect();
                nodes[..2].sort_unstable();
                edges.entry([nodes[0], nodes[1]]).or_insert((nodes, Vec::new())).1.push(number);
            }
        }
        let body = |surfaces: &Self, facet: usize| surfaces.features[facet].body;
        for (ends, (nodes, facets)) in edges {
            let number = self.features.len();
            for end in ends {
                corners.entry(end).or_default()[1].push(number);
            }
            let body = body(self, facets[0]);
            let kind = if nodes.len() == 2 { FaceKind::Segment } else { FaceKind::Segment3 };
            self.features.push(Feature { facets, ..Feature::new(kind, &nodes, body, 0.0) });
        }
        for (node, [facets, edges]) in corners {
            let body = body(self, facets[0]);
            let radii = facets.iter().map(|&facet| self.features[facet].radius);
            let radius = radii.sum::<f64>() / facets.len() as f64;
            let corner = Feature::new(FaceKind::Point, &[node], body, radius);
            self.features.push(Feature { facets, edges, ..corner });
        }
        for number in 0..self.features.len() {
            self.features[number].weight = self.weight_among(number, |_| true);
        }
    }

    /// Has all points feel all facets of other bodies.
    pub(super) fn feel_all(&mut self) {
        self.points.iter_mut().for_each(|point| point.unfelt.clear());
    }

    /// Has points not feel the facets that share a node with a facet they lie on, and the `pairs` of
    /// a point and a facet.
    pub(super) fn leave_out(&mut self, pairs: &[[usize; 2]]) {
        let mut facets_at: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (number, feature) in self.features.iter().enumerate() {
            if self.is_facet(number) {
                for &node in feature.nodes() {
                    facets_at.entry(node).or_default().push(number);
                }
            }
        }
        for point in &mut self.points {
            let nodes: Vec<usize> = point.on.nodes().map(|(node, _)| node).collect();
            let own = facets_at[&nodes[0]].iter().filter(|&&facet| {
                let facet = self.features[facet].nodes();
                nodes.iter().all(|node| facet.contains(node))
            });
            let around = own.flat_map(|&facet| self.features[facet].nodes());
            point.unfelt = around.flat_map(|node| &facets_at[node]).copied().collect();
        }
        for &[point, facet] in pairs {
            self.points[point].unfelt.push(facet);
        }
        for point in &mut self.points {
            point.unfelt.sort_unstable();
            point.unfelt.dedup();
        }
    }

    /// The distance (m) of the surfaces at a point and a feature under the displacements `u` (m).
    pub(super) fn apart(&self, point: usize, feature: usize, u: &[f64]) -> f64 {
        let (at, x) = (self.nodes_at(feature, u), self.point_at(point, u));
        self.features[feature].nearest(&at, &x).distance(&at, &x) - self.radii(point, feature)
    }

    /// The radii (m) of a point and a feature together: their surfaces are so much nearer than they.
    pub(super) fn radii(&self, point: usize, feature: usize) -> f64 {
        self.points[point].radius + self.features[feature].radius
    }

    /// The part of the energy that the points of a surface have, opposite a feature.
    pub(super) fn part(&self, point: usize, feature: usize) -> f64 {
        let bodies = self.bodies(point, feature);
        let [mut own, mut opposite] = bodies.map(|body| self.sizes[body]);
        match bodies.map(|body| self.are_rigid[body]) {
            [true, false] if self.points[point].is_flat => own *= RIGID,
            [false, true] => opposite *= RIGID,
            _ => {}
        }
        let of_coarse = |ratio: f64| 1.0 / (1.0 + (ratio / ALIKE).max(1.0).powi(4));
        match own > opposite {
            true => of_coarse(own / opposite),
            false => 1.0 - of_coarse(opposite / own),
        }
    }

    /// The weight of a feature for a point; 0 if the point does not feel it.
    pub(super) fn weight(&self, point: usize, feature: usize) -> f64 {
        let [of_point, of_feature] = self.bodies(point, feature);
        if of_point == of_feature && !self.itself {
            return 0.0;
        }
        let point = &self.points[point];
        if point.unfelt.is_empty() {
            return self.features[feature].weight;
        }
        let is_felt = |facet: usize| point.unfelt.binary_search(&facet).is_err();
        self.weight_among(feature, is_felt)
    }

    /// The weight of a feature on the surface of the facets that `is_felt` tells.
    fn weight_among(&self, feature: usize, is_felt: impl Fn(usize) -> bool) -> f64 {
        let facets = |feature: usize| {
            self.features[feature].facets.iter().filter(|&&facet| is_felt(facet)).count() as f64
        };
        let own = facets(feature);
        if own == 0.0 || self.is_facet(feature) {
            return own;
        }
        let of_edges = self.features[feature].edges.iter().map(|&edge| facets(edge));
        let shared: f64 = of_edges.filter(|&facets| facets > 0.0).map(|facets| facets - 1.0).sum();
        1.0 - own + shared
    }

    /// Whether a feature is a facet, not an edge or a corner of one.
    pub(super) fn is_facet(&self, feature: usize) -> bool {
        self.features[feature].facets == [feature]
    }

    /// The numbers of the bodies of a point and of a feature.
    pub(super) fn bodies(&self, point: usize, feature: usize) -> [usize; 2] {
        [self.points[point].body, self.features[feature].body]
    }

    /// Area (m^2) of the surface of the body with a number.
    pub(super) fn area(&self, body: usize) -> f64 {
        let own = self.points.iter().filter(|point| point.body == body);
        own.map(|point| point.on.area).sum()
    }

    /// Mean length (m) of the sides of the facets, of half a side where there is a mid node; 0 without any.
    pub(super) fn mean_side(&self) -> f64 {
        let side = |facet: usize| {
            let feature = &self.features[facet];
            let halved = if feature.count > feature.kind.corners() { 0.5 } else { 1.0 };
            match *feature.nodes() {
                [a, b, ..] => Some(halved * norm(&difference(&self.at_rest(b), &self.at_rest(a)))),
                _ => None,
            }
        };
        let facets = (0..self.features.len()).filter(|&feature| self.is_facet(feature));
        let sides: Vec<f64> = facets.filter_map(side).collect();
        sides.iter().sum::<f64>() / sides.len().max(1) as f64
    }

    /// Where a node is undeformed (m).
    pub(super) fn at_rest(&self, node: usize) -> [f64; 3] {
        padded(&self.natural[node * self.dimension..][..self.dimension])
    }

    /// Where a node is under the displacements `u` (m).
    pub(super) fn node_at(&self, node: usize, u: &[f64]) -> [f64; 3] {
        let mut x = self.at_rest(node);
        let of_node = &u[node * self.dimension..][..self.dimension];
        x.iter_mut().zip(of_node).for_each(|(x, u)| *x += u);
        x
    }

    /// Where a point is under the displacements `u` (m).
    pub(super) fn point_at(&self, point: usize, u: &[f64]) -> [f64; 3] {
        let on = &self.points[point].on;
        let (rest, moved) = (on.at(&self.natural, self.dimension), on.at(u, self.dimension));
        std::array::from_fn(|i| rest[i] + moved[i])
    }

    /// Where the nodes of a feature are under the displacements `u` (m); those beyond its count are 0.
    pub(super) fn nodes_at(&self, feature: usize, u: &[f64]) -> [[f64; 3]; MOST_NODES] {
        let mut places = [[0.0; 3]; MOST_NODES];
        let nodes = self.features[feature].nodes().iter();
        places.iter_mut().zip(nodes).for_each(|(place, &node)| *place = self.node_at(node, u));
        places
    }
}

impl Surfaces {
    /// Largest displacement (m) on the surfaces for nodal displacements `way` (m); infinite if one is not a number.
    pub(super) fn farthest(&self, way: impl Fn(usize) -> [f64; 3]) -> f64 {
        // what is no number has moved farther than anything
        let known = |way: f64| if way.is_finite() { way } else { f64::INFINITY };
        let longest = |most: f64, way: &[f64; 3]| most.max(known(dot(way, way)));
        if self.dimension < 3 || self.reach == 1.0 {
            let nodes = self.nodes.iter();
            return self.reach * nodes.fold(0.0, |most, &node| longest(most, &way(node))).sqrt();
        }
        let facets = (0..self.features.len()).take_while(|&feature| self.is_facet(feature));
        let of_facet = |most: f64, facet: usize| {
            let feature = &self.features[facet];
            let mut ways = [[0.0; 3]; MOST_NODES];
            ways.iter_mut().zip(feature.nodes()).for_each(|(to, &node)| *to = way(node));
            let (points, count) = control_points(feature.kind, &ways[..feature.count]);
            points[..count].iter().fold(most, longest)
        };
        facets.fold(0.0, of_facet).sqrt()
    }

    /// The undeformed area (m^2) of a triangle, of half of a quadrilateral.
    pub(super) fn area_of_triangles(&self, facet: usize) -> f64 {
        let feature = &self.features[facet];
        let triangles = (feature.kind.corners() - 2) as f64;
        let area = |part: &[usize]| match *part {
            [a, b, c] => {
                let [a, b, c] = [a, b, c].map(|local| self.at_rest(feature.nodes[local]));
                0.5 * norm(&cross(&difference(&b, &a), &difference(&c, &a)))
            }
            _ => 0.0,
        };
        pieces(feature.kind).map(|(part, weight)| weight * area(part) / triangles).sum()
    }

    /// A box (m) around a feature with its nodes `at` these positions.
    pub(super) fn box_of(&self, feature: usize, at: &[[f64; 3]; MOST_NODES]) -> [[f64; 3]; 2] {
        let Feature { kind, count, .. } = self.features[feature];
        if is_curved_face(kind) {
            let (points, count) = control_points(kind, &at[..count]);
            return box_around(&points[..count]);
        }
        let [low, high] = box_around(&at[..count]);
        // the middle of the nodes moves as they do, and no place is farther from it than this times the nodes
        let beyond = [0, 1, 2].map(|i| 0.5 * (reach(kind) - 1.0) * (high[i] - low[i]));
        [difference(&low, &beyond), [0, 1, 2].map(|i| high[i] + beyond[i])]
    }

    /// Whether `x` is farther than `distance` (m) from the boxes around a feature.
    pub(super) fn is_beyond(
        &self,
        feature: usize,
        at: &[[f64; 3]; MOST_NODES],
        x: &[f64; 3],
        distance: f64,
    ) -> bool {
        let [low, high] = self.box_of(feature, at);
        let is_outside = (0..3).any(|i| x[i] < low[i] - distance || x[i] > high[i] + distance);
        is_outside
            || self.features[feature].hull(at).is_some_and(|hull| hull.distance(x) > distance)
    }
}

impl Point {
    pub(super) fn new(on: SurfacePoint, body: usize, radius: f64) -> Self {
        Self { bears: on.area, on, is_flat: true, body, radius, unfelt: Vec::new() }
    }
}

impl Feature {
    /// A box around it, with its nodes `at` these positions (m), if its nearest place takes much longer to find: if it is a
    /// curved face.
    pub(super) fn hull(&self, at: &[[f64; 3]; MOST_NODES]) -> Option<Hull> {
        is_curved_face(self.kind).then(|| Hull::new(self.kind, &at[..self.count]))
    }

    /// As [`hull`](Self::hull), around it as it moves: with its nodes along cubics of which these are the control points (m).
    pub(super) fn hull_along(
        &self,
        control: impl Fn(usize) -> [[f64; 3]; MOST_NODES],
    ) -> Option<Hull> {
        if !is_curved_face(self.kind) {
            return None;
        }
        let mut hull = Hull::new(self.kind, &control(0)[..self.count]);
        (1..4).for_each(|k| hull.include(self.kind, &control(k)[..self.count]));
        Some(hull)
    }

    pub(super) fn new(kind: FaceKind, of: &[usize], body: usize, radius: f64) -> Self {
        let mut nodes = [0; MOST_NODES];
        nodes[..of.len()].copy_from_slice(of);
        let (facets, edges) = (Vec::new(), Vec::new());
        Self { kind, nodes, count: of.len(), body, radius, facets, edges, weight: 0.0 }
    }

    pub(super) fn nodes(&self) -> &[usize] {
        &self.nodes[..self.count]
    }

    /// Its place that is nearest to `x`, if its nodes are `at` these positions (m), as [`Surfaces::nodes_at`] gives them.
    pub(super) fn nearest(&self, at: &[[f64; 3]; MOST_NODES], x: &[f64; 3]) -> NearestPoint {
        nearest(self.kind, &at[..self.count], x)
    }
}

fn box_around(points: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let end =
        |i: usize, of: fn(f64, f64) -> f64| points.iter().map(|x| x[i]).fold(points[0][i], of);
    [[0, 1, 2].map(|i| end(i, f64::min)), [0, 1, 2].map(|i| end(i, f64::max))]
}

fn is_curved_face(kind: FaceKind) -> bool {
    kind.dimension() == 2 && !is_affine(kind)
}

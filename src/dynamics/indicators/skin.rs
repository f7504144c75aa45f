//! The boundary of a body that fills its space: points on it, and the depth of other points below it.

use std::collections::BTreeMap;

use super::size::block_volumes;
use crate::base::vector::{difference, norm};
use crate::elements::basis::closest;
use crate::elements::body::{Body, Part};
use crate::elements::mesh::{CellKind, Mesh};
use crate::scene::forces::{
    SurfacePoint, boundary_nodes, edge_points, face_centre, natural, pieces, weighted,
};

/// An edge is divided into at most this many parts.
const MOST_PARTS: usize = 20;

/// The boundary, cut into points, segments or triangles.
pub(super) struct Skin<'a> {
    body: &'a Body,
    /// Nodes of each part.
    parts: Vec<Vec<usize>>,
    /// For each node the parts that it belongs to.
    at_nodes: Vec<Vec<usize>>,
    /// The longest edge of a cell (m).
    longest: f64,
    /// For each node the last search that has reached it, counted from 1.
    seen: Vec<usize>,
    searches: usize,
}

impl<'a> Skin<'a> {
    pub(super) fn new(body: &'a Body) -> Self {
        let mesh = body.mesh();
        let faces = mesh.boundary_faces();
        let of_face = |face: &Vec<usize>| {
            let nodes = |part: &[usize]| part.iter().map(|&local| face[local]).collect();
            let cut = pieces(mesh.face_kind(face));
            cut.map(|(part, _)| nodes(part)).collect::<Vec<Vec<usize>>>()
        };
        let parts: Vec<Vec<usize>> = faces.iter().flat_map(of_face).collect();
        let mut at_nodes = vec![Vec::new(); mesh.node_count()];
        for (number, part) in parts.iter().enumerate() {
            part.iter().for_each(|&node| at_nodes[node].push(number));
        }
        let edges = mesh.cells_with_kinds().flat_map(|(kind, cell)| {
            kind.edges().iter().map(|edge| length(mesh, cell[edge[0]], cell[edge[1]]))
        });
        let longest = edges.fold(0.0, f64::max);
        Self { body, parts, at_nodes, longest, seen: vec![0; mesh.node_count()], searches: 0 }
    }

    /// Depth below the boundary (m) of the material point with these weights `shares` of the nodes of a cell:
    /// its distance, with nodes at `now`, from the point of the boundary that is nearest to it in the
    /// undeformed shape, within the same piece of the body.
    pub(super) fn depth(&mut self, shares: &[(usize, f64)], now: &[f64]) -> f64 {
        let (mesh, pattern) = (self.body.mesh(), self.body.inertia().pattern());
        let x = weighted(shares.iter().copied(), mesh.positions(), mesh.dimension());
        self.searches += 1;
        let mut open: Vec<usize> = shares.iter().map(|(node, _)| *node).collect();
        open.iter().for_each(|&node| self.seen[node] = self.searches);
        let (mut least, mut nearest) = (f64::INFINITY, Vec::new());
        // node by node away from the point: the straight line to the nearest point of the boundary passes
        // through cells that are all at least as near
        let mut next = 0;
        while let Some(&node) = open.get(next) {
            next += 1;
            for &part in &self.at_nodes[node] {
                let nodes = &self.parts[part];
                let corners: Vec<[f64; 3]> =
                    nodes.iter().map(|&node| natural(mesh, node)).collect();
                let places = closest(&corners, &x);
                let place = nodes.iter().copied().zip(places);
                let away =
                    distance(&weighted(place.clone(), mesh.positions(), mesh.dimension()), &x);
                if away < least {
                    (least, nearest) = (away, place.collect());
                }
            }
            for (_, other) in pattern.row(node) {
                let is_new = self.seen[other] != self.searches;
                if is_new && distance(&natural(mesh, other), &x) <= least + self.longest {
                    self.seen[other] = self.searches;
                    open.push(other);
                }
            }
        }
        let there = weighted(nearest.into_iter(), now, mesh.dimension());
        distance(&weighted(shares.iter().copied(), now, mesh.dimension()), &there)
    }
}

/// The nodes of the boundary, and points between them that divide edges into `least` parts, and into more where these are longer than their
/// cell is thick, so that nothing as thick as that slips through between two points. In space also the centres of faces: the
/// nodes of a body one cell thick all lie in the planes of its sides, and so do those of other parts of it.
pub(super) fn points(body: &Body, least: usize) -> Vec<SurfacePoint> {
    let mesh = body.mesh();
    let mut points = boundary_nodes(body);
    if mesh.dimension() < 2 {
        return points;
    }
    let of_body = |part: Part| {
        let blocks = block_volumes(part.body).zip(part.body.cell_sections());
        blocks.map(|(volume, section)| volume / section).collect::<Vec<f64>>()
    };
    let blocks: Vec<f64> = body.parts().flat_map(of_body).collect();
    // an edge of two cells is divided as the thinner one requires
    let mut edges: BTreeMap<[usize; 2], (Vec<usize>, usize)> = BTreeMap::new();
    let cells: Vec<(CellKind, &[usize])> = mesh.cells_with_kinds().collect();
    for (cell, face) in mesh.boundary_faces_of_cells() {
        points.extend(face_centre(mesh.face_kind(&face), &face));
        let (kind, nodes) = cells[cell];
        for edge in kind.edges() {
            let edge: Vec<usize> = edge.iter().map(|&local| nodes[local]).collect();
            if !edge[..2].iter().all(|end| face.contains(end)) {
                continue;
            }
            let length = length(mesh, edge[0], edge[1]);
            let thick = (blocks[cell] / length).powf(1.0 / (mesh.dimension() - 1) as f64);
            let count = ((length / thick).round() as usize).clamp(least, MOST_PARTS);
            let ends = [edge[0].min(edge[1]), edge[0].max(edge[1])];
            let known = edges.entry(ends).or_insert_with(|| (edge, least));
            known.1 = known.1.max(count);
        }
    }
    points.extend(
        edges.into_values().flat_map(|(edge, count)| edge_points(&edge, count).collect::<Vec<_>>()),
    );
    points
}

fn length(mesh: &Mesh, a: usize, b: usize) -> f64 {
    distance(&natural(mesh, a), &natural(mesh, b))
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    norm(&difference(a, b))
}

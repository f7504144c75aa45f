//! The nodes of one surface that lie at another one.

use std::collections::BTreeSet;

use super::reach::{MOST_APART, longest};
use crate::base::vector::{cross, difference, dot, norm};
use crate::elements::basis::closest;
use crate::elements::body::Body;
use crate::elements::mesh::{Face, Mesh};
use crate::scene::forces::{natural, pieces};

/// Largest tangential distance of a node beside a surface, relative to the length of the edges there.
const MOST_BESIDE: f64 = 0.02;
/// The largest cosine between the outer normals of surfaces that face each other.
const FACING: f64 = -0.5;

/// A straight piece of a surface: a segment in the plane, a triangle in space.
struct Facet {
    nodes: Vec<usize>,
    corners: Vec<[f64; 3]>,
    normal: [f64; 3],
    edge: f64,
}

/// Numbers of the nodes of the body `other` that lie at `faces` of the boundary of `own`, from the other side.
pub(super) fn facing(own: &Body, faces: &[Face], other: &Body) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    let own_facets = facets(own.mesh(), faces);
    let [mut low, mut high] = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for facet in &own_facets {
        for corner in &facet.corners {
            for axis in 0..3 {
                low[axis] = low[axis].min(corner[axis] - MOST_APART * facet.edge);
                high[axis] = high[axis].max(corner[axis] + MOST_APART * facet.edge);
            }
        }
    }
    // a membrane or string has two sides, which face all
    let has_sides = own.mesh().has_inside() && other.mesh().has_inside();
    for facet in facets(other.mesh(), &other.mesh().boundary_faces()) {
        for (node, x) in facet.nodes.iter().zip(&facet.corners) {
            if found.contains(node) || (0..3).any(|i| x[i] < low[i] || x[i] > high[i]) {
                continue;
            }
            let is_at = |one: &Facet| {
                let cosine = dot(&one.normal, &facet.normal);
                let is_facing = if has_sides { cosine < FACING } else { cosine.abs() > -FACING };
                is_facing && one.has_at_it(x)
            };
            if own_facets.iter().any(is_at) {
                found.insert(*node);
            }
        }
    }
    found
}

/// The pieces of faces of a mesh, with normals that point out of its body.
fn facets(mesh: &Mesh, faces: &[Face]) -> Vec<Facet> {
    let dimension = mesh.dimension();
    let mut facets = Vec::new();
    for face in faces {
        for (piece, _) in pieces(mesh.face_kind(face)) {
            let nodes: Vec<usize> = piece.iter().map(|&k| face[k]).collect();
            let corners: Vec<[f64; 3]> = nodes.iter().map(|&node| natural(mesh, node)).collect();
            let across = match (dimension, &corners[..]) {
                (2, [a, b]) => [b[1] - a[1], a[0] - b[0], 0.0],
                (3, [a, b, c]) => cross(&difference(b, a), &difference(c, a)),
                _ => continue,
            };
            let size = norm(&across);
            let edge = longest(&corners);
            facets.push(Facet { nodes, corners, normal: across.map(|x| x / size), edge });
        }
    }
    facets
}

impl Facet {
    /// Whether `x` is near to it and not beside it.
    fn has_at_it(&self, x: &[f64; 3]) -> bool {
        let shares = closest(&self.corners, x);
        let there = |i: usize| self.corners.iter().zip(shares).map(|(c, s)| s * c[i]).sum::<f64>();
        let gap: [f64; 3] = std::array::from_fn(|i| x[i] - there(i));
        let across = dot(&gap, &self.normal);
        let beside = (dot(&gap, &gap) - across * across).max(0.0).sqrt();
        across.abs() <= MOST_APART * self.edge && beside <= MOST_BESIDE * self.edge
    }
}

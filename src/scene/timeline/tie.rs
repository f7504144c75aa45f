//! Ties: nodes of one body glued to another body.
//!
//! A tie is one general row per node and axis, u = sum s_k u_k with the shape functions s of the point at
//! which the node is. Rows with the same nodes are the same whichever was named, so that surfaces may be tied
//! both ways. Where the named nodes make up faces, the side with more nodes follows, and a deformable body a
//! rigid one; `facing.rs` finds the nodes of the other side by outer normals that oppose each other. General
//! rows cost a Schur complement of their number: glued surfaces of some hundred nodes are cheap, those of
//! thousands are not.

mod facing;
mod reach;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use facing::facing;
use reach::{MOST_APART, longest};

use crate::base::input::InputError;
use crate::base::vector::{norm, padded};
use crate::elements::basis::closest;
use crate::elements::body::{Body, Part};
use crate::elements::mesh::Selection;
use crate::scene::constraint::{Axis, Constrained, Constraint, Motion};
use crate::scene::forces::{natural, pieces};

/// Shares of nodes below this are round-off.
const NO_SHARE: f64 = 1e-12;

/// Nodes that are glued to the body with the name `to`, with the constraints of that, found once: they are of one mesh.
#[derive(Debug, Clone)]
pub(super) struct Tie {
    pub(super) nodes: Selection,
    pub(super) to: String,
    pub(super) constraints: Result<Arc<[Constraint]>, InputError>,
}

impl Tie {
    pub(super) fn new(body: &Body, nodes: Selection, to: String) -> Self {
        Self { constraints: tied(body, &nodes, &to), nodes, to }
    }

    /// The same on a `body` with another mesh, where its nodes are those that `change` makes of them.
    pub(super) fn on(
        &self,
        body: &Body,
        change: impl FnOnce(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Self, InputError> {
        Ok(Self::new(body, change(&self.nodes)?, self.to.clone()))
    }
}

/// Nodes of a body (among those of all) by numbers, each with the nodes that it follows and their shares.
type Rows = BTreeMap<usize, Vec<(usize, f64)>>;

/// The constraints by which `nodes` move with the points of the body with the name `to` at which they are, or, where that is the finer
/// or the softer side, its nodes with points of their faces: see [`Scene::tie`](super::Scene::tie).
///
/// # Errors
/// Nodes or a body that do not exist, nodes of the body itself, nodes that are not at it.
fn tied(body: &Body, nodes: &Selection, to: &str) -> Result<Arc<[Constraint]>, InputError> {
    let to = body.part_named(to, "body of a tie")?;
    let target = Target::new(&to);
    let (mut rows, mut owners) = (Rows::new(), BTreeMap::new());
    for node in body.mesh().select(nodes)? {
        if to.nodes.contains(&node) {
            let help =
                format!("it is a node of body \"{}\" itself: name those of another body", to.name);
            return Err(InputError::new("node of a tie", node + 1, help));
        }
        rows.insert(node, target.shares_at(node, body.mesh().position(node))?);
        let owner = body.part_of(node);
        owners.entry(owner.nodes.start).or_insert(owner);
    }
    for own in owners.values() {
        turn_round(own, &to, &mut rows)?;
    }
    let mut constraints = Vec::new();
    for (node, shares) in rows {
        // rows of the same two nodes are the same, whichever of them was named
        let is_first = shares.iter().all(|(other, _)| node < *other);
        let sign = if is_first { 1.0 } else { -1.0 };
        for &axis in Axis::all(body.dimension()) {
            let others = shares.iter().map(|(other, share)| (other + 1, axis, -sign * share));
            let terms = [(node + 1, axis, sign)].into_iter().chain(others).collect();
            constraints.push(Constraint { what: Constrained::Row(terms), how: Motion::Hold });
        }
    }
    Ok(constraints.into())
}

/// Has nodes of the body `to` follow faces of `own` that all nodes of are tied, where these are the coarser or the rigid side.
///
/// Nodes of a coarse surface that follow a fine one leave its nodes between them free: there it bulges, and the joint is too soft.
fn turn_round(own: &Part, to: &Part, rows: &mut Rows) -> Result<(), InputError> {
    let first = own.nodes.start;
    let mut faces = own.body.mesh().boundary_faces();
    faces.retain(|face| face.iter().all(|node| rows.contains_key(&(first + node))));
    let named: BTreeSet<usize> = faces.iter().flatten().map(|node| first + node).collect();
    let followers = facing(own.body, &faces, to.body);
    let [own_is_rigid, to_is_rigid] = [own, to].map(|part| part.body.is_rigid());
    let are_to_follow = match (own_is_rigid, to_is_rigid) {
        (true, false) => !followers.is_empty(),
        (false, false) => followers.len() > named.len(),
        _ => false,
    };
    if !are_to_follow {
        return Ok(());
    }
    let followers: BTreeSet<usize> = followers.iter().map(|node| to.nodes.start + node).collect();
    // named nodes between a follower and a node beside the faces stay where they were glued
    let is_held = |shares: &[(usize, f64)]| shares.iter().all(|(on, _)| followers.contains(on));
    rows.retain(|node, shares| !(named.contains(node) && is_held(shares)));
    let target = Target::new(own);
    for node in followers {
        rows.insert(node, target.shares_at(node, to.body.mesh().position(node - to.nodes.start))?);
    }
    Ok(())
}

/// A body that nodes are glued to.
struct Target<'a> {
    part: &'a Part<'a>,
    /// Points, segments or triangles of its boundary.
    facets: Vec<Vec<usize>>,
}

impl<'a> Target<'a> {
    fn new(part: &'a Part<'a>) -> Self {
        let mesh = part.body.mesh();
        let mut facets = Vec::new();
        for face in mesh.boundary_faces() {
            let kind = mesh.face_kind(&face);
            facets.extend(pieces(kind).map(|(piece, _)| piece.iter().map(|&k| face[k]).collect()));
        }
        Self { part, facets }
    }

    /// The nodes of the body (among those of all) with their shares in the point where `node`, at `x` (m), is glued.
    fn shares_at(&self, node: usize, x: &[f64]) -> Result<Vec<(usize, f64)>, InputError> {
        if let Ok(shares) = self.part.body.shares_at(x) {
            return Ok(self.without_round_off(shares.into_iter()));
        }
        let x = padded(x);
        let placed = self.facets.iter().map(|facet| {
            let corners: Vec<[f64; 3]> =
                facet.iter().map(|&node| natural(self.part.body.mesh(), node)).collect();
            let shares = closest(&corners, &x);
            let at =
                |i: usize| corners.iter().zip(shares).map(|(x, share)| share * x[i]).sum::<f64>();
            let gap = norm(&std::array::from_fn::<f64, 3, _>(|i| at(i) - x[i]));
            (gap, facet, shares, longest(&corners))
        });
        let nearest = placed.min_by(|(a, ..), (b, ..)| a.total_cmp(b));
        match nearest {
            Some((gap, facet, shares, edge)) if gap <= MOST_APART * edge => {
                Ok(self.without_round_off(facet.iter().copied().zip(shares)))
            }
            nearest => {
                let (gap, edge) =
                    nearest.map_or((f64::INFINITY, 0.0), |(gap, _, _, edge)| (gap, edge));
                let help = format!(
                    "it is glued to body \"{}\", from which it may be {:.1e} m away at most: move one of the bodies, or name the nodes \
                     that are at it",
                    self.part.name,
                    MOST_APART * edge
                );
                Err(InputError::new(
                    format!("distance of tied node {}", node + 1),
                    format!("{gap:.3e} m"),
                    help,
                ))
            }
        }
    }

    /// The shares that are not 0. A node by itself has all, so that its row is the same from whichever side it was named.
    fn without_round_off(&self, shares: impl Iterator<Item = (usize, f64)>) -> Vec<(usize, f64)> {
        let first = self.part.nodes.start;
        let some = shares.filter(|(_, share)| share.abs() > NO_SHARE);
        let some: Vec<_> = some.map(|(node, share)| (first + node, share)).collect();
        match some[..] {
            [(node, _)] => vec![(node, 1.0)],
            _ => some,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::mesh::{Cells, Mesh};
    use crate::studies::samples::SQUARE_MATERIAL;

    /// A quadratic cell, and a row of nodes that is `gap` (m) away from its right side.
    fn bodies(gap: f64) -> Body {
        let body = |name: &str, x: f64, nodes: [usize; 2], cells: Cells| {
            let mesh = Mesh::rectangle([0.1, 0.1], nodes, cells).unwrap().translated(&[x, 0.0]);
            Body::new(mesh.unwrap(), SQUARE_MATERIAL).thickness(0.01).named(name).build().unwrap()
        };
        let tip = body("tip", 0.1 + gap, [2, 5], Cells::Rectangles);
        Body::join([body("base", 0.0, [2, 2], Cells::Rectangles9), tip]).unwrap()
    }

    /// The nodes that a node at height `y` (m) of the row is glued to: their heights, with their shares.
    fn glued(gap: f64, y: f64) -> Vec<(f64, f64)> {
        let body = bodies(gap);
        let constraints = tied(&body, &"tip/left".into(), "base").unwrap();
        let rows = constraints.iter().map(|constraint| match &constraint.what {
            Constrained::Row(terms) => terms,
            _ => panic!("{constraint:?}"),
        });
        let height = |node: usize| body.mesh().position(node - 1)[1];
        let mut rows = rows.filter(|terms| (height(terms[0].0) - y).abs() < 1e-12);
        let terms = rows.next().unwrap();
        let others = terms[1..].iter();
        let mut glued: Vec<_> =
            others.map(|(n, _, share)| (height(*n), -share / terms[0].2)).collect();
        glued.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        glued
    }

    fn is_close(a: &[(f64, f64)], b: &[(f64, f64)]) -> bool {
        let apart = |((x, p), (y, q)): (&(f64, f64), &(f64, f64))| (x - y).abs().max((p - q).abs());
        a.len() == b.len() && a.iter().zip(b).map(apart).all(|apart| apart < 1e-9)
    }

    /// Quadratic edges carry nodes by their shape functions, N = (1 - s)(1 - 2s), s(2s - 1), 4s(1 - s) at s = 3/4.
    #[test]
    fn nodes_on_a_quadratic_edge_follow_its_curve() {
        let found = glued(0.0, 0.075);
        assert!(is_close(&found, &[(0.0, -0.125), (0.05, 0.75), (0.1, 0.375)]), "{found:?}");
    }

    /// Across a gap it is the nearest piece of the boundary, cut into straight ones.
    #[test]
    fn nodes_across_a_gap_follow_the_nearest_piece() {
        let found = glued(0.004, 0.075);
        assert!(is_close(&found, &[(0.05, 0.5), (0.1, 0.5)]), "{found:?}");
    }
}

//! Ties: nodes of one body glued to another body.

use std::sync::Arc;

use crate::base::input::InputError;
use crate::base::vector::norm;
use crate::elements::basis::closest;
use crate::elements::body::{Body, Part};
use crate::elements::mesh::Selection;
use crate::scene::constraint::{Axis, Constrained, Constraint, Motion};
use crate::scene::forces::pieces;

/// How far a node may be from the body that it is glued to, over the length of the edges there: the straight edges of
/// cells leave gaps along a curve.
const MOST_APART: f64 = 0.2;
/// Shares of nodes below this are round-off.
const NO_SHARE: f64 = 1e-12;

/// The constraints by which `nodes` move with the points of the body with the name `to` at which they are.
///
/// # Errors
/// Nodes or a body that do not exist, nodes of the body itself, nodes that are not at it.
pub(super) fn tied(
    body: &Body,
    nodes: &Selection,
    to: &str,
) -> Result<Arc<[Constraint]>, InputError> {
    let to = body.part_named(to, "body of a tie")?;
    let target = Target::new(&to);
    let mut constraints = Vec::new();
    for node in body.mesh().select(nodes)? {
        if to.nodes.contains(&node) {
            let help =
                format!("it is a node of body \"{}\" itself: name those of another body", to.name);
            return Err(InputError::new("node of a tie", node + 1, help));
        }
        let shares = target.shares_at(node, body.mesh().position(node))?;
        // rows of the same two nodes are the same, whichever of them was named
        let is_first = shares.iter().all(|(other, _)| node < to.nodes.start + other);
        let sign = if is_first { 1.0 } else { -1.0 };
        for &axis in Axis::all(body.dimension()) {
            let others = shares
                .iter()
                .map(|(other, share)| (to.nodes.start + other + 1, axis, -sign * share));
            let terms = [(node + 1, axis, sign)].into_iter().chain(others).collect();
            constraints.push(Constraint { what: Constrained::Row(terms), how: Motion::Hold });
        }
    }
    Ok(constraints.into())
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

    /// The nodes of the body with their shares in the point where `node`, at `x` (m), is glued.
    fn shares_at(&self, node: usize, x: &[f64]) -> Result<Vec<(usize, f64)>, InputError> {
        let is_some = |share: &(usize, f64)| share.1.abs() > NO_SHARE;
        if let Ok(shares) = self.part.body.shares_at(x) {
            return Ok(shares.into_iter().filter(is_some).collect());
        }
        let x: [f64; 3] = std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0));
        let placed = self.facets.iter().map(|facet| {
            let corners: Vec<[f64; 3]> = facet.iter().map(|&node| self.position(node)).collect();
            let shares = closest(&corners, &x);
            let at =
                |i: usize| corners.iter().zip(shares).map(|(x, share)| share * x[i]).sum::<f64>();
            let gap = norm(&std::array::from_fn::<f64, 3, _>(|i| at(i) - x[i]));
            (gap, facet, shares, longest(&corners))
        });
        let nearest = placed.min_by(|(a, ..), (b, ..)| a.total_cmp(b));
        match nearest {
            Some((gap, facet, shares, edge)) if gap <= MOST_APART * edge => {
                Ok(facet.iter().copied().zip(shares).filter(is_some).collect())
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

    fn position(&self, node: usize) -> [f64; 3] {
        let x = self.part.body.mesh().position(node);
        std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
    }
}

/// The longest edge between corners (m).
fn longest(corners: &[[f64; 3]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let lengths = corners
        .iter()
        .zip(next)
        .map(|(a, b)| norm(&std::array::from_fn::<f64, 3, _>(|i| b[i] - a[i])));
    lengths.fold(0.0, f64::max)
}

//! Conformity of a mesh, whose cells meet in whole faces: hanging nodes, and separate nodes in the same position.

use super::size::least_cell_lengths;
use crate::base::grid::Grid;
use crate::base::vector::{difference, distinct, norm};
use crate::dynamics::report::Indicator;
use crate::elements::basis::nearest;
use crate::elements::body::Body;
use crate::elements::mesh::{Face, FaceKind, Mesh};
use crate::scene::forces::natural;

/// Nodes that are nearer to each other, or to a face, than this fraction of the least length of the cells there are meant to be
/// at it: round-off of files with few digits.
const SAME: f64 = 1e-3;
/// The same for a node that shares a cell with a node of the face: along a curve the nodes of finer cells are beside the faces of
/// coarser ones.
const ALONG_A_CURVE: f64 = 0.1;

/// Nodes on faces of cells that they do not belong to, and pairs of nodes in the same position: there the body opens without
/// resistance.
struct Defects {
    /// A node, and the cell on whose face it hangs.
    hanging: Vec<(usize, usize)>,
    /// Two nodes in the same position.
    double: Vec<[usize; 2]>,
}

/// Hanging nodes and double nodes within a piece of a body. (Pieces that nothing joins are an indicator of their own.)
pub(super) fn conformity(body: &Body) -> Option<Indicator> {
    let mesh = body.mesh();
    if mesh.is_surface() {
        return None;
    }
    let Defects { hanging, double } = Defects::of(body);
    let count = hanging.len() + double.len();
    let within = || "cells meet in whole faces (limit: 0 hanging or double nodes)".to_owned();
    let beyond = || {
        let mut places = Vec::new();
        if let Some(&(node, cell)) = hanging.first() {
            places.push(format!(
                "{} node(s) hang on faces of cells that they do not belong to, the first of them node {} at {} m on cell {}",
                hanging.len(),
                node + 1,
                mesh.told_middle(&[node]),
                cell + 1
            ));
        }
        if let Some(&[a, b]) = double.first() {
            places.push(format!(
                "{} pair(s) of nodes are in the same position and not joined, the first of them nodes {} and {} at {} m",
                double.len(),
                a + 1,
                b + 1,
                mesh.told_middle(&[a])
            ));
        }
        format!(
            "the {} does not hold together (limit: 0 hanging or double nodes): {}. It opens there without resistance, unless a slit is \
             meant: let neighbours share whole faces and their nodes (in Gmsh: BooleanFragments or Coherence before meshing, and \
             Mesh.MeshSizeFromPoints or transfinite curves alike on both sides), or make a body of each part and join them by [[tie]]",
            mesh.origin(),
            places.join("; ")
        )
    };
    Some(Indicator::trusted("conformity", (count as f64, ""), [0.0, 0.0], within, beyond))
}

impl Defects {
    fn of(body: &Body) -> Self {
        let mesh = body.mesh();
        let faces = open_faces(mesh);
        let mut found = Self { hanging: Vec::new(), double: Vec::new() };
        let lengths = least_cell_lengths(body);
        let nodes = distinct(mesh.outer_faces().concat());
        if nodes.is_empty() {
            return found;
        }
        // the least length of the cells of each node
        let mut length_at = vec![f64::INFINITY; mesh.node_count()];
        for (cell, length) in mesh.cells().zip(&lengths) {
            cell.iter().for_each(|&node| length_at[node] = length_at[node].min(*length));
        }
        let positions: Vec<[f64; 3]> = nodes.iter().map(|&node| natural(mesh, node)).collect();
        let (grid, pattern) = (Grid::new(&positions), body.inertia().pattern());
        let pieces = pattern.pieces();
        for (cell, face) in &faces {
            let corners: Vec<[f64; 3]> = face.iter().map(|&node| natural(mesh, node)).collect();
            let kind = match mesh.kind().dimension() {
                1 => FaceKind::Segment,
                2 => FaceKind::of_rim(face.len()),
                _ => mesh.face_kind(face),
            };
            let reach = ALONG_A_CURVE * lengths[*cell];
            let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
            for corner in &corners {
                for axis in 0..3 {
                    bounds[0][axis] = bounds[0][axis].min(corner[axis] - reach);
                    bounds[1][axis] = bounds[1][axis].max(corner[axis] + reach);
                }
            }
            grid.each_within(&bounds, |k| {
                let (node, x) = (nodes[k], &positions[k]);
                if face.contains(&node) || pieces[node] != pieces[face[0]] {
                    return;
                }
                let length = lengths[*cell].min(length_at[node]);
                let away = nearest(kind, &corners, x).distance(&corners, x);
                if away > ALONG_A_CURVE * length {
                    return;
                }
                let at = corners.iter().position(|at| norm(&difference(at, x)) <= SAME * length);
                match at.map(|at| face[at]) {
                    Some(other) => found.double.push([node.min(other), node.max(other)]),
                    None => {
                        let is_beside = || face.iter().any(|&of| pattern.find(node, of).is_some());
                        if away <= SAME * length || is_beside() {
                            found.hanging.push((node, *cell));
                        }
                    }
                }
            });
        }
        found.double.sort_unstable();
        found.double.dedup();
        found.hanging.sort_unstable();
        found.hanging.dedup_by_key(|(node, _)| *node);
        found
    }
}

/// The faces of one cell only, with that cell; of a string its segments.
fn open_faces(mesh: &Mesh) -> Vec<(usize, Face)> {
    match mesh.kind().dimension() {
        1 => mesh.cells().map(<[usize]>::to_vec).enumerate().collect(),
        _ => mesh.outer_faces_of_cells(),
    }
}

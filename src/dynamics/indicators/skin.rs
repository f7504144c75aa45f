//! The boundary of a body that fills its space: points on it, and how deep other points lie below it.

use std::collections::BTreeMap;

use super::size::block_volumes;
use crate::base::vector::{dot, norm};
use crate::elements::body::Body;
use crate::elements::mesh::Mesh;
use crate::scene::forces::{SurfacePoint, boundary_nodes, edge_points, face_centre, pieces};

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
        let cut = pieces(mesh.face_kind());
        let faces = mesh.boundary_faces();
        let of_face = |face: &Vec<usize>| {
            let nodes = |part: &[usize]| part.iter().map(|&local| face[local]).collect();
            cut.clone().map(|(part, _)| nodes(part)).collect::<Vec<Vec<usize>>>()
        };
        let parts: Vec<Vec<usize>> = faces.iter().flat_map(of_face).collect();
        let mut at_nodes = vec![Vec::new(); mesh.node_count()];
        for (number, part) in parts.iter().enumerate() {
            part.iter().for_each(|&node| at_nodes[node].push(number));
        }
        let edges = mesh.cells().flat_map(|cell| {
            mesh.kind().edges().iter().map(|edge| length(mesh, cell[edge[0]], cell[edge[1]]))
        });
        let longest = edges.fold(0.0, f64::max);
        Self { body, parts, at_nodes, longest, seen: vec![0; mesh.node_count()], searches: 0 }
    }

    /// How deep below the boundary (m) the material point with these `shares` of the nodes of a cell lies:
    /// its distance, with nodes at `now`, from the point of the boundary that is nearest to it in the
    /// undeformed shape, within the same piece of the body.
    pub(super) fn depth(&mut self, shares: &[(usize, f64)], now: &[f64]) -> f64 {
        let (mesh, pattern) = (self.body.mesh(), self.body.inertia().pattern());
        let x = mean(mesh.positions(), mesh.dimension(), shares.iter().copied());
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
                    nodes.iter().map(|&node| position(mesh, node)).collect();
                let places = closest(&corners, &x);
                let place = nodes.iter().copied().zip(places);
                let away = distance(&mean(mesh.positions(), mesh.dimension(), place.clone()), &x);
                if away < least {
                    (least, nearest) = (away, place.collect());
                }
            }
            for (_, other) in pattern.row(node) {
                let is_new = self.seen[other] != self.searches;
                if is_new && distance(&position(mesh, other), &x) <= least + self.longest {
                    self.seen[other] = self.searches;
                    open.push(other);
                }
            }
        }
        let there = mean(now, mesh.dimension(), nearest.into_iter());
        distance(&mean(now, mesh.dimension(), shares.iter().copied()), &there)
    }
}

/// The nodes of the boundary, and points between them on edges that are longer than their cell is thick, so
/// that nothing as thick as that slips through between two points. In space also the centres of faces: the
/// nodes of a body one cell thick all lie in the planes of its sides, and so do those of other parts of it.
pub(super) fn points(body: &Body) -> Vec<SurfacePoint> {
    let mesh = body.mesh();
    let mut points = boundary_nodes(body);
    if mesh.dimension() < 2 {
        return points;
    }
    let blocks: Vec<f64> = block_volumes(body).map(|volume| volume / body.section()).collect();
    // an edge of two cells is divided as the thinner one requires
    let mut edges: BTreeMap<[usize; 2], (Vec<usize>, usize)> = BTreeMap::new();
    let cells: Vec<&[usize]> = mesh.cells().collect();
    for (cell, face) in mesh.boundary_faces_of_cells() {
        points.extend(face_centre(mesh.face_kind(), &face));
        for edge in mesh.kind().edges() {
            let edge: Vec<usize> = edge.iter().map(|&local| cells[cell][local]).collect();
            if !edge[..2].iter().all(|end| face.contains(end)) {
                continue;
            }
            let length = length(mesh, edge[0], edge[1]);
            let thick = (blocks[cell] / length).powf(1.0 / (mesh.dimension() - 1) as f64);
            let count = ((length / thick).round() as usize).clamp(1, MOST_PARTS);
            let ends = [edge[0].min(edge[1]), edge[0].max(edge[1])];
            let known = edges.entry(ends).or_insert_with(|| (edge, 1));
            known.1 = known.1.max(count);
        }
    }
    points.extend(
        edges.into_values().flat_map(|(edge, count)| edge_points(&edge, count).collect::<Vec<_>>()),
    );
    points
}

fn length(mesh: &Mesh, a: usize, b: usize) -> f64 {
    distance(&position(mesh, a), &position(mesh, b))
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    norm(&difference(a, b))
}

fn difference(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Natural position of a node; components beyond the dimension are 0.
fn position(mesh: &Mesh, node: usize) -> [f64; 3] {
    mean(mesh.positions(), mesh.dimension(), [(node, 1.0)].into_iter())
}

/// The point with these shares of nodes that are at `positions`.
fn mean(
    positions: &[f64],
    dimension: usize,
    shares: impl Iterator<Item = (usize, f64)>,
) -> [f64; 3] {
    let mut x = [0.0; 3];
    for (node, share) in shares {
        let of_node = &positions[node * dimension..][..dimension];
        x.iter_mut().zip(of_node).for_each(|(x, y)| *x += share * y);
    }
    x
}

/// Barycentric coordinates, by the `corners` of a point, segment or triangle, of its point that is nearest to
/// `x`.
fn closest(corners: &[[f64; 3]], x: &[f64; 3]) -> [f64; 3] {
    match corners {
        [_] => [1.0, 0.0, 0.0],
        [a, b] => {
            let along = difference(b, a);
            let part = dot(&difference(x, a), &along) / dot(&along, &along);
            let part = part.clamp(0.0, 1.0);
            [1.0 - part, part, 0.0]
        }
        [a, b, c, ..] => {
            let (ab, ac, ax) = (difference(b, a), difference(c, a), difference(x, a));
            let [bb, bc, cc] = [dot(&ab, &ab), dot(&ab, &ac), dot(&ac, &ac)];
            let [bx, cx] = [dot(&ab, &ax), dot(&ac, &ax)];
            let whole = bb * cc - bc * bc;
            let [of_b, of_c] = [(cc * bx - bc * cx) / whole, (bb * cx - bc * bx) / whole];
            if of_b >= 0.0 && of_c >= 0.0 && of_b + of_c <= 1.0 {
                return [1.0 - of_b - of_c, of_b, of_c];
            }
            // outside the triangle: the nearest point is on one of its edges
            let on = [[0, 1], [1, 2], [2, 0]].map(|[from, to]| {
                let part = closest(&[corners[from], corners[to]], x);
                let mut shares = [0.0; 3];
                (shares[from], shares[to]) = (part[0], part[1]);
                shares
            });
            let away = |shares: &[f64; 3]| {
                let there = |i: usize| (0..3).map(|k| shares[k] * corners[k][i]).sum();
                distance(&std::array::from_fn(there), x)
            };
            on.into_iter().min_by(|p, q| away(p).total_cmp(&away(q))).unwrap_or([1.0, 0.0, 0.0])
        }
        [] => [0.0; 3],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::vector::noise;

    /// No point of a fine lattice on it is nearer.
    #[test]
    fn the_nearest_point_of_a_triangle() {
        let corners = [[0.0, 0.1, 0.0], [1.0, 0.0, 0.3], [0.2, 0.9, -0.2]];
        let at = |shares: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|i| (0..3).map(|k| shares[k] * corners[k][i]).sum())
        };
        const N: usize = 60;
        for x in noise(150, 3).chunks_exact(3) {
            let x: [f64; 3] = std::array::from_fn(|i| 1.5 * x[i]);
            let found = distance(&at(closest(&corners, &x)), &x);
            let lattice = (0..=N).flat_map(|i| (0..=N - i).map(move |j| [i, j, N - i - j]));
            let away = lattice.map(|parts| distance(&at(parts.map(|p| p as f64 / N as f64)), &x));
            let least = away.fold(f64::INFINITY, f64::min);
            // an edge of the lattice is 1/60 of 1.1
            assert!(found <= least + 1e-12 && least < found + 0.02, "{found} {least}");
        }
    }
}

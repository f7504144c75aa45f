//! Areas and volumes that walls enclose, with their gradients and second derivatives.
//!
//! With its nodes at x_a, an edge x = sum N_a x_a contributes (1/2) int x x x' ds to an area, a face
//! (1/3) int x . (x,1 x x,2) to a volume. Both are sums of determinants of nodal positions, with weights that
//! depend on the shape functions alone ([`volume_parts`](crate::scene::forces::faces::volume_parts)), so that
//! derivatives are exact, and the second ones symmetric for each part.

use crate::base::sparse::BlockMatrix;
use crate::base::vector::{cross, dot};
use crate::elements::mesh::Mesh;

/// The ends of an edge or the corners of a triangle, and its weight: walls that are curved, or means of
/// others, are weighted sums of such parts.
pub(super) type Part<const D: usize> = ([usize; D], f64);

/// The parts of the walls of a chamber in `D` dimensions.
pub(super) struct Enclosure<const D: usize> {
    parts: Vec<Part<D>>,
    /// Natural positions of their corners.
    corners: Vec<[[f64; D]; D]>,
    /// A node, and its natural position, that positions are counted from.
    anchor: Option<(usize, [f64; D])>,
}

/// Closed polygons.
pub(super) type Polygon = Enclosure<2>;

/// Closed surfaces.
pub(super) type Surface = Enclosure<3>;

impl<const D: usize> Enclosure<D> {
    pub(super) fn new(mesh: &Mesh, parts: Vec<Part<D>>) -> Self {
        let position = |node: usize| std::array::from_fn(|i| mesh.position(node)[i]);
        let corners = parts.iter().map(|(nodes, _)| nodes.map(position)).collect();
        Self { parts, corners, anchor: None }
    }

    /// Counts positions from one of its own nodes: closed walls enclose the same from wherever they are seen.
    pub(super) fn anchor(&mut self) {
        let first = self.parts.first().zip(self.corners.first());
        self.anchor = first.map(|((nodes, _), corners)| (nodes[0], corners[0]));
    }

    /// Parts with the present positions of their corners.
    fn iter<'a>(&'a self, u: &'a [f64]) -> impl Iterator<Item = (&'a Part<D>, [[f64; D]; D])> {
        let anchor = self.anchor.as_ref();
        let moved = anchor.map(|(node, from)| (&u[D * node..][..D], from));
        self.parts.iter().zip(&self.corners).map(move |(part, from)| {
            let at = |k: usize, i: usize| match moved {
                None => from[k][i] + u[D * part.0[k] + i],
                Some((u0, x0)) => (from[k][i] - x0[i]) + (u[D * part.0[k] + i] - u0[i]),
            };
            (part, std::array::from_fn(|k| std::array::from_fn(|i| at(k, i))))
        })
    }

    /// Number of parts.
    pub(super) fn parts(&self) -> usize {
        self.parts.len()
    }

    /// Pairs of nodes that the second derivative couples.
    pub(super) fn couplings(&self) -> Vec<[usize; 2]> {
        let pairs = |(nodes, _): &Part<D>| {
            let nodes = *nodes;
            (0..D).flat_map(move |k| (0..k).map(move |other| [nodes[other], nodes[k]]))
        };
        self.parts.iter().flat_map(pairs).collect()
    }
}

impl Polygon {
    /// Signed area S = (1/2) sum (x_a y_b - x_b y_a) over the edges ab.
    pub(super) fn measure(&self, u: &[f64]) -> f64 {
        self.iter(u).map(|((_, part), [a, b])| part * 0.5 * (a[0] * b[1] - b[0] * a[1])).sum()
    }

    /// Adds `factor` dS/du.
    pub(super) fn add_gradient(&self, factor: f64, u: &[f64], forces: &mut [f64]) {
        for ((nodes, part), [a, b]) in self.iter(u) {
            let half = 0.5 * factor * part;
            // both ends take half of the normal: edges that share a node make up the shoelace formula
            for node in nodes {
                forces[2 * node] += half * (b[1] - a[1]);
                forces[2 * node + 1] += half * (a[0] - b[0]);
            }
        }
    }

    /// Adds `factor` d^2S/du^2, which does not depend on u.
    pub(super) fn add_hessian(&self, factor: f64, matrix: &mut BlockMatrix) {
        for &([node, next], part) in &self.parts {
            let half = 0.5 * factor * part;
            for (row, column, sign) in [(node, next, 1.0), (next, node, -1.0)] {
                if let Some(block) = matrix.block_mut(row, column) {
                    block[1] += sign * half;
                    block[2] -= sign * half;
                }
            }
        }
    }
}

impl Surface {
    /// Signed volume V = (1/6) sum a . (b x c) over the triangles abc.
    pub(super) fn measure(&self, u: &[f64]) -> f64 {
        self.iter(u).map(|((_, part), [a, b, c])| part * dot(&a, &cross(&b, &c)) / 6.0).sum()
    }

    /// Adds `factor` dV/du.
    pub(super) fn add_gradient(&self, factor: f64, u: &[f64], forces: &mut [f64]) {
        for ((nodes, part), x) in self.iter(u) {
            let factor = factor * part;
            for k in 0..3 {
                let normal = cross(&x[(k + 1) % 3], &x[(k + 2) % 3]);
                for i in 0..3 {
                    forces[3 * nodes[k] + i] += factor / 6.0 * normal[i];
                }
            }
        }
    }

    /// Adds `factor` d^2V/du^2: for the edge from a to b of a triangle abc, the blocks
    /// -[c x]/6 and, transposed, [c x]/6.
    pub(super) fn add_hessian(&self, factor: f64, u: &[f64], matrix: &mut BlockMatrix) {
        for ((nodes, part), x) in self.iter(u) {
            let factor = factor * part;
            for k in 0..3 {
                let (a, b) = (nodes[k], nodes[(k + 1) % 3]);
                let c = x[(k + 2) % 3].map(|c| factor / 6.0 * c);
                let times = [0.0, -c[2], c[1], c[2], 0.0, -c[0], -c[1], c[0], 0.0];
                for (row, column, sign) in [(a, b, -1.0), (b, a, 1.0)] {
                    if let Some(block) = matrix.block_mut(row, column) {
                        block.iter_mut().zip(&times).for_each(|(x, c)| *x += sign * c);
                    }
                }
            }
        }
    }
}

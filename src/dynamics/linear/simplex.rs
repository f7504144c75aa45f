//! Motions of the nodes of a simplex, divided into those that are rigid and those that stretch its edges.
//!
//! The edges from the first node to the others, e_1 ... e_d, and their dual vectors e^1 ... e^d, e_i.e^j = 1 where i = j and 0 elsewhere, are
//! sufficient. Rigid motions are translations along the e_i and rotations about them: relative to the simplex they are the same
//! in any orientation. Strains move the node i by S_i1 e^1 + ... + S_id e^d with a symmetric S, which is 1:1 with the rates
//! r = x.x' of the edges,
//!
//! ```text
//! S_kk = r_k0,   S_kl = (r_k0 + r_l0 - r_kl)/2
//! ```

use crate::base::vector::dot;

/// Vectors at the nodes of a simplex.
pub(super) type Nodal = [[f64; 3]; 4];

/// Numbers of its edges: from node 1 to 0, 2 to 0, 2 to 1, 3 to 0, 3 to 1, 3 to 2.
pub(super) type ByEdge = [f64; 6];

/// The edges of a simplex from its first node, and their dual vectors.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Simplex {
    dimension: usize,
    edges: [[f64; 3]; 3],
    duals: [[f64; 3]; 3],
}

/// Number of the edge between the nodes a > b.
pub(super) fn edge_between(a: usize, b: usize) -> usize {
    a * (a - 1) / 2 + b
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl Simplex {
    /// For `edges` from the first node to the others, two in the plane and three in space.
    pub(super) fn new(dimension: usize, mut edges: [[f64; 3]; 3]) -> Self {
        if dimension == 2 {
            edges[2] = [0.0, 0.0, 1.0];
        }
        let [a, b, c] = edges;
        let volume = dot(&a, &cross(b, c));
        let duals = [cross(b, c), cross(c, a), cross(a, b)].map(|area| area.map(|x| x / volume));
        Self { dimension, edges, duals }
    }

    /// Number of rigid motions.
    pub(super) fn motions(dimension: usize) -> usize {
        dimension * (dimension + 1) / 2
    }

    /// The rigid motion with this number: translations along the edges, then turns about them, in the plane one.
    pub(super) fn motion(&self, number: usize) -> Nodal {
        let mut nodes = [[0.0; 3]; 4];
        if number < self.dimension {
            return [self.edges[number]; 4];
        }
        let axis = if self.dimension == 2 { 2 } else { number - 3 };
        for (node, edge) in nodes[1..=self.dimension].iter_mut().zip(self.edges) {
            *node = cross(self.edges[axis], edge);
        }
        nodes
    }

    /// The strain in which edges have these `rates`.
    pub(super) fn strain(&self, rates: &ByEdge) -> Nodal {
        let mut nodes = [[0.0; 3]; 4];
        for k in 1..=self.dimension {
            for l in 1..=self.dimension {
                let s = match k == l {
                    true => rates[edge_between(k, 0)],
                    false => {
                        let between = rates[edge_between(k.max(l), k.min(l))];
                        0.5 * (rates[edge_between(k, 0)] + rates[edge_between(l, 0)] - between)
                    }
                };
                let dual = &self.duals[l - 1];
                nodes[k].iter_mut().zip(dual).for_each(|(x, dual)| *x += s * dual);
            }
        }
        nodes
    }

    /// The work of nodal `forces` in the strain of each edge: the forces along the edges, over their lengths, that do the same.
    pub(super) fn along_edges(&self, forces: &Nodal) -> ByEdge {
        let mut along = [0.0; 6];
        for k in 1..=self.dimension {
            for l in 1..=self.dimension {
                let work = dot(&forces[k], &self.duals[l - 1]);
                if k == l {
                    along[edge_between(k, 0)] += work;
                } else {
                    along[edge_between(k, 0)] += 0.5 * work;
                    along[edge_between(l, 0)] += 0.5 * work;
                    along[edge_between(k.max(l), k.min(l))] -= 0.5 * work;
                }
            }
        }
        along
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn simplex(dimension: usize) -> (Simplex, Nodal) {
        let nodes = [[0.1, 0.2, 0.3], [1.1, 0.1, 0.4], [0.3, 0.9, -0.2], [0.2, 0.4, 1.3]];
        let nodes = nodes.map(|[x, y, z]| [x, y, if dimension == 2 { 0.0 } else { z }]);
        let edge = |k: usize| std::array::from_fn(|i| nodes[k][i] - nodes[0][i]);
        (Simplex::new(dimension, [edge(1), edge(2), edge(3)]), nodes)
    }

    /// The rates x.x' of all edges of the simplex with these nodes.
    fn rates(dimension: usize, nodes: &Nodal, motion: &Nodal) -> ByEdge {
        let mut rates = [0.0; 6];
        for a in 1..=dimension {
            for b in 0..a {
                rates[edge_between(a, b)] = (0..3)
                    .map(|i| (nodes[a][i] - nodes[b][i]) * (motion[a][i] - motion[b][i]))
                    .sum();
            }
        }
        rates
    }

    /// Rigid motions leave all lengths, strains have the requested rates, and forces along edges do the work of those at the nodes; the
    /// numbers are of the size 1, so that round-off is some 1e-16.
    #[test]
    fn motions_are_rigid_and_strains_stretch_as_asked() {
        for dimension in [2, 3] {
            let (simplex, nodes) = simplex(dimension);
            for number in 0..Simplex::motions(dimension) {
                let rates = rates(dimension, &nodes, &simplex.motion(number));
                assert!(rates.iter().all(|rate| rate.abs() < 1e-15), "{number}: {rates:?}");
            }
            let count = edge_between(dimension, dimension - 1) + 1;
            let asked: ByEdge =
                std::array::from_fn(|k| if k < count { (1.0 + k as f64).sin() } else { 0.0 });
            let found = rates(dimension, &nodes, &simplex.strain(&asked));
            assert!(found.iter().zip(&asked).all(|(x, y)| (x - y).abs() < 1e-14), "{found:?}");
            let forces: Nodal = std::array::from_fn(|node| {
                std::array::from_fn(|i| (3.0 + (3 * node + i) as f64).cos())
            });
            let along = simplex.along_edges(&forces);
            let strain = simplex.strain(&asked);
            let work: f64 = forces.iter().zip(&strain).map(|(f, x)| dot(f, x)).sum();
            let of_edges: f64 = along.iter().zip(&asked).map(|(f, rate)| f * rate).sum();
            assert!((work - of_edges).abs() < 1e-14, "{work} {of_edges}");
        }
    }
}

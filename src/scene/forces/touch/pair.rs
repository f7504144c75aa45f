//! A point of one surface and a facet, edge or corner of another: their distance, and how it changes.
//!
//! The offset of the point from the nearest place on the feature is r = sum_m c_m(xi) z_m over the nodes z of both; xi
//! are the coordinates of the place, two on a triangle, one on an edge, none at a corner. As it is nearest, r is normal
//! to the feature, r . r_a = 0 with r_a = dr/dxi_a, and with E = r.r/2 and G_ab = r_a . r_b
//!
//! ```text
//! E_am = c_m r_a + c_m,a r,   dxi = -G^-1 E_m . dz_m,
//! d2E/dz_m dz_n = c_m c_n I - E_am G^-1_ab E_bn^T
//! ```

use crate::base::vector::{dot, norm};
use crate::elements::basis::closest;

/// Most nodes of a pair: three of a point and three of a triangle.
pub(super) const MOST: usize = 6;

/// A point and the nearest place on a feature.
pub(super) struct Pair {
    /// Its nodes, and how many there are.
    pub(super) nodes: [usize; MOST],
    pub(super) count: usize,
    /// c_m
    pub(super) shares: [f64; MOST],
    /// The unit normal r/|r|, and |r| (m).
    pub(super) normal: [f64; 3],
    pub(super) distance: f64,
    /// c_m,a
    slopes: [[f64; 2]; MOST],
    /// E_am, and G^-1 E_m.
    turns: [[[f64; 3]; 2]; MOST],
    moves: [[[f64; 3]; 2]; MOST],
    /// r_a
    along: [[f64; 3]; 2],
}

/// What changes with one component of one node.
pub(super) struct Change {
    /// Of the distance (m).
    pub(super) distance: f64,
    pub(super) normal: [f64; 3],
    /// Of c_m.
    pub(super) shares: [f64; MOST],
}

impl Pair {
    /// The distance (m) of a point at `x` from the feature with these `corners`, and the shares of these in the
    /// nearest place.
    pub(super) fn apart(x: &[f64; 3], corners: &[[f64; 3]]) -> (f64, [f64; 3]) {
        let shares = closest(corners, x);
        (norm(&offset(x, corners, &shares)), shares)
    }

    /// The pair of a point at `x` with the nodes and shares `point`, and a feature of the nodes `of` at `corners`, of
    /// which the nearest place has the `shares` of [`apart`](Self::apart). It must not be at the point itself.
    pub(super) fn new(
        (x, point): (&[f64; 3], impl Iterator<Item = (usize, f64)>),
        (of, corners): (&[usize], &[[f64; 3]]),
        shares: &[f64; 3],
    ) -> Self {
        let r = offset(x, corners, shares);
        let distance = norm(&r);
        let mut pair = Self {
            nodes: [0; MOST],
            count: 0,
            shares: [0.0; MOST],
            normal: r.map(|r| r / distance),
            distance,
            slopes: [[0.0; 2]; MOST],
            turns: [[[0.0; 3]; 2]; MOST],
            moves: [[[0.0; 3]; 2]; MOST],
            along: [[0.0; 3]; 2],
        };
        for (node, share) in point {
            (pair.nodes[pair.count], pair.shares[pair.count]) = (node, share);
            pair.count += 1;
        }
        // the place moves on the part of the feature whose corners have a share in it
        let (mut free, mut first) = (0, None);
        for (k, &node) in of.iter().enumerate().filter(|(k, _)| shares[*k] != 0.0) {
            let m = pair.count;
            (pair.nodes[m], pair.shares[m]) = (node, -shares[k]);
            pair.count += 1;
            match first {
                None => first = Some((m, k)),
                Some((origin, from)) => {
                    (pair.slopes[m][free], pair.slopes[origin][free]) = (-1.0, 1.0);
                    pair.along[free] = std::array::from_fn(|i| corners[from][i] - corners[k][i]);
                    free += 1;
                }
            }
        }
        let along = pair.along;
        let inverse = match free {
            0 => [[0.0; 2]; 2],
            1 => [[1.0 / dot(&along[0], &along[0]), 0.0], [0.0; 2]],
            _ => {
                let [aa, ab, bb] = [[0, 0], [0, 1], [1, 1]].map(|[a, b]| dot(&along[a], &along[b]));
                let whole = aa * bb - ab * ab;
                [[bb / whole, -ab / whole], [-ab / whole, aa / whole]]
            }
        };
        for m in 0..pair.count {
            // those beyond `free` are 0
            let (share, slopes) = (pair.shares[m], pair.slopes[m]);
            let turns: [[f64; 3]; 2] = std::array::from_fn(|a| {
                std::array::from_fn(|i| share * along[a][i] + slopes[a] * r[i])
            });
            pair.moves[m] = inverse
                .map(|of| std::array::from_fn(|i| of[0] * turns[0][i] + of[1] * turns[1][i]));
            pair.turns[m] = turns;
        }
        pair
    }

    /// sum_m c_m v_m: the velocity (m/s) of the point relative to the nearest place, for velocities `v` with
    /// `dimension` components per node.
    pub(super) fn velocity(&self, v: &[f64], dimension: usize) -> [f64; 3] {
        weighted(&self.nodes[..self.count], &self.shares, v, dimension)
    }

    /// The same with other shares.
    pub(super) fn velocity_with(
        &self,
        shares: &[f64; MOST],
        v: &[f64],
        dimension: usize,
    ) -> [f64; 3] {
        weighted(&self.nodes[..self.count], shares, v, dimension)
    }

    /// The second derivative of an energy with the first two derivatives `slope` and `curvature` by the distance, by
    /// component `i` of node `m` and component `j` of node `n`.
    pub(super) fn second(
        &self,
        [slope, curvature]: [f64; 2],
        [m, i]: [usize; 2],
        [n, j]: [usize; 2],
    ) -> f64 {
        let across = self.normal[i] * self.normal[j];
        let both = self.shares[m] * self.shares[n];
        let turning: f64 = (0..2).map(|a| self.turns[m][a][i] * self.moves[n][a][j]).sum();
        let bent = both * (f64::from(i == j) - across) - turning;
        curvature * both * across + slope / self.distance * bent
    }

    /// What changes with component `j` of node `n`.
    pub(super) fn change(&self, [n, j]: [usize; 2]) -> Change {
        let places: [f64; 2] = std::array::from_fn(|a| -self.moves[n][a][j]);
        let distance = self.shares[n] * self.normal[j];
        let normal = std::array::from_fn(|i| {
            let own = if i == j { self.shares[n] } else { 0.0 };
            let r = own + self.along[0][i] * places[0] + self.along[1][i] * places[1];
            (r - self.normal[i] * distance) / self.distance
        });
        let slopes = &self.slopes;
        let shares = std::array::from_fn(|m| slopes[m][0] * places[0] + slopes[m][1] * places[1]);
        Change { distance, normal, shares }
    }
}

fn offset(x: &[f64; 3], corners: &[[f64; 3]], shares: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| {
        x[i] - corners.iter().zip(shares).map(|(corner, share)| share * corner[i]).sum::<f64>()
    })
}

fn weighted(nodes: &[usize], shares: &[f64], field: &[f64], dimension: usize) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (&node, share) in nodes.iter().zip(shares) {
        let of_node = &field[node * dimension..][..dimension];
        sum.iter_mut().zip(of_node).for_each(|(sum, x)| *sum += share * x);
    }
    sum
}

//! A point of one surface and a facet, edge or corner of another: their distance, and how it changes.
//!
//! The offset of the point from the nearest place on the feature is r = sum_m c_m(xi) z_m over the nodes z of both; xi
//! are the coordinates of the place, two on a facet, one on an edge, none at a corner. As it is nearest, r is normal
//! to the feature, r . r_a = 0 with r_a = dr/dxi_a, and with E = r.r/2 and G_ab = r_a . r_b + r . r_ab (the last term only
//! of curved facets and edges)
//!
//! ```text
//! E_am = c_m r_a + c_m,a r,   dxi = -G^-1 E_m . dz_m,
//! d2E/dz_m dz_n = c_m c_n I - E_am G^-1_ab E_bn^T
//! ```

use crate::base::vector::{dot, norm};
use crate::elements::basis::{MOST_NODES, Place};
use crate::scene::forces::surface::weighted;

/// Most nodes of a pair: those of the faces of a point and of a place.
pub(super) const MOST: usize = 2 * MOST_NODES;

/// A point and the nearest place on a feature.
pub(super) struct Pair {
    /// Its nodes, and how many there are.
    pub(super) nodes: [usize; MOST],
    pub(super) count: usize,
    /// How many of them, the first ones, are those of the point.
    pub(super) of_point: usize,
    /// c_m
    pub(super) shares: [f64; MOST],
    /// The unit normal r/|r|, and |r| (m).
    pub(super) normal: [f64; 3],
    pub(super) distance: f64,
    /// r (m), r_a and c_m,a; the number of the coordinates xi.
    offset: [f64; 3],
    along: [[f64; 3]; 2],
    slopes: [[f64; 2]; MOST],
    free: usize,
    /// r . r_ab for 11, 22 and 12.
    bending: [f64; 3],
}

/// How the nearest place of a pair moves, for the derivatives of its forces.
pub(super) struct Moving<'a> {
    pair: &'a Pair,
    /// E_am, and G^-1 E_m.
    turns: [[[f64; 3]; 2]; MOST],
    moves: [[[f64; 3]; 2]; MOST],
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
    /// The offset of `x` from a place on a feature with its nodes `at` these positions (m).
    pub(super) fn offset(x: &[f64; 3], place: &Place, at: &[[f64; 3]]) -> [f64; 3] {
        let shares = place.shape().values;
        std::array::from_fn(|i| {
            let along = place.nodes.iter().zip(&shares).map(|(&node, share)| share * at[node][i]);
            x[i] - along.sum::<f64>()
        })
    }

    /// The pair of a point at `x` with the nodes and shares `point`, and the nearest place of a feature of the nodes `of`,
    /// which are `at` these positions (m). It must not be at the point itself.
    pub(super) fn new(
        (x, point): (&[f64; 3], impl Iterator<Item = (usize, f64)>),
        (of, at): (&[usize], &[[f64; 3]]),
        place: &Place,
    ) -> Self {
        let r = Self::offset(x, place, at);
        let distance = norm(&r);
        let mut pair = Self {
            nodes: [0; MOST],
            count: 0,
            of_point: 0,
            shares: [0.0; MOST],
            normal: r.map(|r| r / distance),
            distance,
            offset: r,
            along: [[0.0; 3]; 2],
            slopes: [[0.0; 2]; MOST],
            free: place.dimension(),
            bending: [0.0; 3],
        };
        for (node, share) in point {
            (pair.nodes[pair.count], pair.shares[pair.count]) = (node, share);
            pair.count += 1;
        }
        pair.of_point = pair.count;
        let shape = place.shape();
        let seconds = place.second_derivatives();
        for (k, &node) in place.nodes.iter().enumerate() {
            let m = pair.count;
            (pair.nodes[m], pair.shares[m]) = (of[node], -shape.values[k]);
            pair.slopes[m] = shape.derivatives[k].map(|slope| -slope);
            for (along, slope) in pair.along.iter_mut().zip(pair.slopes[m]) {
                along.iter_mut().zip(at[node]).for_each(|(along, x)| *along += slope * x);
            }
            if let Some(seconds) = &seconds {
                let over = dot(&at[node], &r);
                let seconds = pair.bending.iter_mut().zip(seconds[k]);
                seconds.for_each(|(bending, second)| *bending -= second * over);
            }
            pair.count += 1;
        }
        pair
    }

    /// How its nearest place moves.
    pub(super) fn moving(&self) -> Moving<'_> {
        let (along, r) = (&self.along, &self.offset);
        let product = |a: usize, b: usize| dot(&along[a], &along[b]);
        let [by_first, by_second, by_both] = self.bending;
        let [aa, ab, bb] =
            [product(0, 0) + by_first, product(0, 1) + by_both, product(1, 1) + by_second];
        let inverse = match self.free {
            0 => [[0.0; 2]; 2],
            1 => [[1.0 / aa, 0.0], [0.0; 2]],
            _ => {
                let whole = aa * bb - ab * ab;
                [[bb / whole, -ab / whole], [-ab / whole, aa / whole]]
            }
        };
        let mut moving =
            Moving { pair: self, turns: [[[0.0; 3]; 2]; MOST], moves: [[[0.0; 3]; 2]; MOST] };
        for m in 0..self.count {
            // those beyond `free` are 0
            let (share, slopes) = (self.shares[m], self.slopes[m]);
            let turns: [[f64; 3]; 2] = std::array::from_fn(|a| {
                std::array::from_fn(|i| share * along[a][i] + slopes[a] * r[i])
            });
            moving.moves[m] = inverse
                .map(|of| std::array::from_fn(|i| of[0] * turns[0][i] + of[1] * turns[1][i]));
            moving.turns[m] = turns;
        }
        moving
    }

    /// sum_m c_m v_m for the `shares` c_m: with its own the velocity (m/s) of the point relative to the nearest place.
    /// `v` has `dimension` components per node.
    pub(super) fn velocity(&self, shares: &[f64; MOST], v: &[f64], dimension: usize) -> [f64; 3] {
        let nodes = self.nodes[..self.count].iter().copied();
        weighted(nodes.zip(shares.iter().copied()), v, dimension)
    }
}

impl Moving<'_> {
    /// The second derivative of an energy with the first two derivatives `slope` and `curvature` by the distance, by
    /// component `i` of node `m` and component `j` of node `n`.
    pub(super) fn second(
        &self,
        [slope, curvature]: [f64; 2],
        [m, i]: [usize; 2],
        [n, j]: [usize; 2],
    ) -> f64 {
        let across = self.pair.normal[i] * self.pair.normal[j];
        let both = self.pair.shares[m] * self.pair.shares[n];
        let turning: f64 = (0..2).map(|a| self.turns[m][a][i] * self.moves[n][a][j]).sum();
        let bent = both * (f64::from(i == j) - across) - turning;
        curvature * both * across + slope / self.pair.distance * bent
    }

    /// What changes with component `j` of node `n`.
    pub(super) fn change(&self, [n, j]: [usize; 2]) -> Change {
        let places: [f64; 2] = std::array::from_fn(|a| -self.moves[n][a][j]);
        let distance = self.pair.shares[n] * self.pair.normal[j];
        let normal = std::array::from_fn(|i| {
            let own = if i == j { self.pair.shares[n] } else { 0.0 };
            let r = own + self.pair.along[0][i] * places[0] + self.pair.along[1][i] * places[1];
            (r - self.pair.normal[i] * distance) / self.pair.distance
        });
        let slopes = &self.pair.slopes;
        let shares = std::array::from_fn(|m| slopes[m][0] * places[0] + slopes[m][1] * places[1]);
        Change { distance, normal, shares }
    }
}

//! A point of one surface and a facet, edge or corner of another, or two edges: their distance, and how it changes.
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
//!
//! Two edges are the same with a coordinate on each, r = (1 - xi_0) a_0 + xi_0 a_1 - (1 - xi_1) b_0 - xi_1 b_1. Their
//! common area depends on xi and on c = det G = |a x b|^2 by a [`Window`], whose derivatives need those of second order, too: with
//! S_ab = dG_ab = dr_a . r_b + r_a . dr_b, and d' for another direction,
//!
//! ```text
//! G_ab d'dxi_b = -(S_ab d'xi_b + S'_ab dxi_b + d'r_a . dr + dr_a . d'r),   dr = sum_m c_m dz_m, dr_a = sum_m c_m,a dz_m
//! ```

use super::window::Window;
use crate::base::vector::{cross, difference, dot, norm};
use crate::elements::basis::{FacePoint, MOST_NODES, NearestPoint, closest};
use crate::scene::forces::surface::weighted;

/// Most nodes of a pair: those of the faces of a point and of a place.
pub(super) const MOST: usize = 2 * MOST_NODES;

/// A point and the nearest place on a feature, or the nearest places of two edges.
pub(super) struct Pair {
    /// Its nodes, and how many there are.
    pub(super) nodes: [usize; MOST],
    pub(super) count: usize,
    /// How many of them, the first ones, are those of the point, or of the first edge.
    pub(super) of_point: usize,
    /// c_m
    pub(super) shares: [f64; MOST],
    /// c_m of damping and friction, which act beside the axis of a tube.
    pub(super) grips: [f64; MOST],
    /// The unit normal r/|r|, |r| (m), and the distance of the surfaces, less by the radii of tubes.
    pub(super) normal: [f64; 3],
    distance: f64,
    pub(super) gap: f64,
    /// r (m), r_a and c_m,a; the number of the coordinates xi.
    offset: [f64; 3],
    along: [[f64; 3]; 2],
    slopes: [[f64; 2]; MOST],
    free: usize,
    /// r . r_ab for 11, 22 and 12.
    bending: [f64; 3],
    /// The areas (m^2) of the faces around the point, times its weight; 0 of two edges, which cross at a place without an area.
    pub(super) around: f64,
    /// Window of two edges; `None` for a point.
    pub(super) window: Option<Window>,
    levers: Levers,
}

/// Directors of tubes along which what acts at their surface turns them.
#[derive(Default)]
pub(super) struct Levers {
    count: usize,
    all: [Lever; MOST_LEVERS],
}

/// Two at each end of two pieces.
const MOST_LEVERS: usize = 8;

/// One of them: the place beside the axis moves with the director's node by (o . d)/a, with its offset o = s n from the axis, s the radius with the sign
/// of the side, d the director and a its arm.
#[derive(Debug, Clone, Copy, Default)]
struct Lever {
    /// Of the node of the axis and of the director in the pair.
    base: usize,
    at: usize,
    radius: f64,
    arm: f64,
    director: [f64; 3],
}

impl Levers {
    pub(super) fn push(
        &mut self,
        base: usize,
        at: usize,
        [radius, arm]: [f64; 2],
        director: [f64; 3],
    ) {
        self.all[self.count] = Lever { base, at, radius, arm, director };
        self.count += 1;
    }

    fn each(&self) -> &[Lever] {
        &self.all[..self.count]
    }
}

/// How the nearest place of a pair moves, for the derivatives of its forces.
pub(super) struct Moving<'a> {
    pair: &'a Pair,
    /// G^-1; E_am, and G^-1 E_m.
    inverse: [[f64; 2]; 2],
    turns: [[[f64; 3]; 2]; MOST],
    moves: [[[f64; 3]; 2]; MOST],
}

/// Derivatives with respect to one displacement component of one node.
pub(super) struct Change {
    /// Of the distance (m).
    pub(super) distance: f64,
    pub(super) normal: [f64; 3],
    /// Of c_m of damping and friction.
    pub(super) grips: [f64; MOST],
}

impl Pair {
    /// The pair of a point with the nodes and shares `point`, and a place of the `shape` on a feature of the nodes `of`,
    /// which are `at` these positions (m), with the offset r from the place (m), which must not be 0, the areas (m^2) `around` the point, and the
    /// radii (m) of both together.
    pub(super) fn new(
        (r, point, around): ([f64; 3], impl Iterator<Item = (usize, f64)>, f64),
        (of, at): (&[usize], &[[f64; 3]]),
        (place, shape): (&NearestPoint, &FacePoint),
        radii: f64,
    ) -> Self {
        let distance = norm(&r);
        let mut pair = Self {
            nodes: [0; MOST],
            count: 0,
            of_point: 0,
            shares: [0.0; MOST],
            grips: [0.0; MOST],
            normal: r.map(|r| r / distance),
            distance,
            gap: distance - radii,
            offset: r,
            along: [[0.0; 3]; 2],
            slopes: [[0.0; 2]; MOST],
            free: place.dimension(),
            bending: [0.0; 3],
            around,
            window: None,
            levers: Levers::default(),
        };
        for (node, share) in point {
            (pair.nodes[pair.count], pair.shares[pair.count]) = (node, share);
            pair.count += 1;
        }
        pair.of_point = pair.count;
        for (k, &node) in place.nodes.iter().enumerate() {
            let m = pair.count;
            (pair.nodes[m], pair.shares[m]) = (of[node], -shape.values[k]);
            pair.slopes[m] = shape.derivatives[k].map(|slope| -slope);
            for (along, slope) in pair.along.iter_mut().zip(pair.slopes[m]) {
                along.iter_mut().zip(at[node]).for_each(|(along, x)| *along += slope * x);
            }
            pair.count += 1;
        }
        if let Some(seconds) = place.second_derivatives() {
            for (&node, seconds) in place.nodes.iter().zip(seconds) {
                let over = dot(&at[node], &r);
                let bending = pair.bending.iter_mut().zip(seconds);
                bending.for_each(|(bending, second)| *bending -= second * over);
            }
        }
        pair.grips = pair.shares;
        pair
    }

    /// The distance (m) of two edges with these ends.
    pub(super) fn edges_apart(a: &[[f64; 3]; 2], b: &[[f64; 3]; 2]) -> f64 {
        let from_edge = |x: &[f64; 3], of: &[[f64; 3]; 2]| {
            let shares = closest(of, x);
            norm(&std::array::from_fn::<_, 3, _>(|i| {
                x[i] - shares[0] * of[0][i] - shares[1] * of[1][i]
            }))
        };
        let ends = [(&a[0], b), (&a[1], b), (&b[0], a), (&b[1], a)];
        let least = ends.map(|(x, of)| from_edge(x, of)).into_iter().fold(f64::INFINITY, f64::min);
        let [along_a, along_b] = [a, b].map(|[from, to]| difference(to, from));
        let (normal, between) = (cross(&along_a, &along_b), difference(&b[0], &a[0]));
        let whole = dot(&normal, &normal);
        let is_within = [&along_b, &along_a].into_iter().all(|along| {
            let place = dot(&cross(&between, along), &normal);
            0.0 < place && place < whole
        });
        if is_within { least.min(dot(&between, &normal).abs() / whole.sqrt()) } else { least }
    }

    /// The pair of two edges, by their nodes and where these are, with the nearest `places` xi on them.
    pub(super) fn of_edges(
        edges: [([usize; 2], &[[f64; 3]; 2]); 2],
        places: [f64; 2],
        window: Window,
        radii: f64,
    ) -> Self {
        let [a, b] = edges.map(|(_, ends)| *ends);
        let nodes = edges.map(|(nodes, _)| nodes);
        let along = [difference(&a[1], &a[0]), difference(&b[0], &b[1])];
        let r = std::array::from_fn(|i| {
            a[0][i] + places[0] * along[0][i] - b[0][i] + places[1] * along[1][i]
        });
        let distance = norm(&r);
        let mut pair = Self {
            nodes: [0; MOST],
            count: 4,
            of_point: 2,
            shares: [0.0; MOST],
            grips: [0.0; MOST],
            normal: r.map(|r| r / distance),
            distance,
            gap: distance - radii,
            offset: r,
            along,
            slopes: [[0.0; 2]; MOST],
            free: 2,
            bending: [0.0; 3],
            around: 0.0,
            window: Some(window),
            levers: Levers::default(),
        };
        pair.nodes[..4].copy_from_slice(nodes.as_flattened());
        let shares = [1.0 - places[0], places[0], places[1] - 1.0, -places[1]];
        pair.shares[..4].copy_from_slice(&shares);
        pair.slopes[..4].copy_from_slice(&[[-1.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]);
        pair.grips = pair.shares;
        pair
    }

    /// A node of each side.
    pub(super) fn ends(&self) -> [usize; 2] {
        [self.nodes[0], self.nodes[self.count - 1 - self.levers.count]]
    }

    /// Has damping and friction act at the surfaces of tubes.
    pub(super) fn set_levers(&mut self, levers: Levers) {
        for lever in levers.each() {
            let offset = lever.radius * dot(&self.normal, &lever.director);
            let turned = self.shares[lever.base] * offset / lever.arm;
            self.grips[lever.at] += turned;
            self.grips[lever.base] -= turned;
        }
        self.levers = levers;
    }

    /// The forces (N) on its nodes by which two edges go where they share less of an `energy` per area (J/m^2); `None` of a
    /// point.
    pub(super) fn drift(&self, energy: f64) -> Option<[[f64; 3]; MOST]> {
        self.window.as_ref()?;
        let moving = self.moving();
        Some(std::array::from_fn(|m| [0, 1, 2].map(|i| -energy * moving.sharing([m, i]))))
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
        let mut moving = Moving {
            pair: self,
            inverse,
            turns: [[[0.0; 3]; 2]; MOST],
            moves: [[[0.0; 3]; 2]; MOST],
        };
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

    /// Derivatives with respect to component `j` of node `n`.
    pub(super) fn change(&self, [n, j]: [usize; 2]) -> Change {
        let places: [f64; 2] = std::array::from_fn(|a| -self.moves[n][a][j]);
        let distance = self.pair.shares[n] * self.pair.normal[j];
        let normal = std::array::from_fn(|i| {
            let own = if i == j { self.pair.shares[n] } else { 0.0 };
            let r = own + self.pair.along[0][i] * places[0] + self.pair.along[1][i] * places[1];
            (r - self.pair.normal[i] * distance) / self.pair.distance
        });
        let slopes = &self.pair.slopes;
        let mut shares = [0.0; MOST];
        for (share, slopes) in shares.iter_mut().zip(slopes).take(self.pair.count) {
            *share = slopes[0] * places[0] + slopes[1] * places[1];
        }
        let mut grips = shares;
        for lever in self.pair.levers.each() {
            let Lever { base, at, radius, arm, director } = *lever;
            let by_director = match n {
                _ if n == at => self.pair.normal[j] / arm,
                _ if n == base => -self.pair.normal[j] / arm,
                _ => 0.0,
            };
            let offset = radius * dot(&self.pair.normal, &director);
            let moved = radius * (dot(&normal, &director) + by_director);
            let turned = (shares[base] * offset + self.pair.shares[base] * moved) / arm;
            grips[at] += turned;
            grips[base] -= turned;
        }
        Change { distance, normal, grips }
    }

    /// dG_00, dG_01 and dG_11 with component `j` of node `n`.
    fn metric(&self, [n, j]: [usize; 2]) -> [f64; 3] {
        let (along, slopes) = (&self.pair.along, &self.pair.slopes[n]);
        [[0, 0], [0, 1], [1, 1]].map(|[a, b]| along[a][j] * slopes[b] + slopes[a] * along[b][j])
    }

    /// How the places xi of two edges and c change with component `j` of node `n`.
    fn steps(&self, [n, j]: [usize; 2]) -> [f64; 3] {
        let [aa, ab, bb] = self.metric([n, j]);
        let [along_a, along_b] = &self.pair.along;
        let crossed = dot(along_b, along_b) * aa + dot(along_a, along_a) * bb
            - 2.0 * dot(along_a, along_b) * ab;
        [-self.moves[n][0][j], -self.moves[n][1][j], crossed]
    }

    /// How what two edges share (m^2) changes with component `j` of node `n`; 0 of a point.
    pub(super) fn sharing(&self, at: [usize; 2]) -> f64 {
        self.pair.window.as_ref().map_or(0.0, |window| dot(&window.slopes, &self.steps(at)))
    }

    /// The second derivative of what two edges share, by components `i` of node `m` and `j` of node `n`; 0 of a point.
    pub(super) fn sharing_bends(&self, [m, i]: [usize; 2], [n, j]: [usize; 2]) -> f64 {
        let Some(window) = &self.pair.window else { return 0.0 };
        let (first, second) = (self.steps([m, i]), self.steps([n, j]));
        let ([aa, ab, bb], [aa2, ab2, bb2]) = (self.metric([m, i]), self.metric([n, j]));
        let ([p, q], [p2, q2]) = (self.pair.slopes[m], self.pair.slopes[n]);
        let same = f64::from(i == j);
        let across = |a: usize| {
            let [one, other] = [m, n].map(|m| (self.pair.slopes[m][a], self.pair.shares[m]));
            same * (one.0 * other.1 + other.0 * one.1)
        };
        let forced = [
            aa2 * first[0] + ab2 * first[1] + aa * second[0] + ab * second[1] + across(0),
            ab2 * first[0] + bb2 * first[1] + ab * second[0] + bb * second[1] + across(1),
        ];
        let [along_a, along_b] = &self.pair.along;
        let flat = dot(along_b, along_b) * p * p2 + dot(along_a, along_a) * q * q2
            - dot(along_a, along_b) * (p * q2 + p2 * q);
        let crossed = 2.0 * same * flat + bb * aa2 + aa * bb2 - 2.0 * ab * ab2;
        let [of_a, of_b] = self.inverse.map(|of| -(of[0] * forced[0] + of[1] * forced[1]));
        let bent: f64 =
            window.bends.iter().zip(&first).map(|(bends, step)| step * dot(bends, &second)).sum();
        bent + dot(&window.slopes, &[of_a, of_b, crossed])
    }
}

//! Liquid within walls up to a level: its volume, the integral S of its depth, and the level of a given volume.
//!
//! A point x lies at the depth d = h + e . x below the level h (m, upwards from the origin; e is the direction of
//! gravity). By the divergence theorem, over closed walls of outward normal n and with d = 0 above the level,
//!
//! ```text
//! S = int d dV = int (1/2) d^2 (e . n) dA,   V = dS/dh = int d (e . n) dA,   A = dV/dh = int_wet (e . n) dA,
//! ```
//!
//! with the volume V and the area A of its surface. Walls are straight pieces, segments or triangles, on which d is linear: with its
//! values d_a at the corners, N the normal times the area, and the exact M_ab = int_wet N_a N_b dA/area, the gradients
//! at a constant level are
//!
//! ```text
//! dS/dx_a = N sum_b M_ab d_b,   dV/dx_a = N sum_b M_ab,
//! ```
//!
//! the first of which is the force of the pressure d.
//!
//! Exact overlaps keep V as smooth as it is in nature, where quadrature points that come under the level one
//! by one would let A jump. The level of a volume is found by Newton's method within bounds, to round-off, in
//! some six passes over the walls, anew in each evaluation: forces are functions of the state alone.
//! Quadrilaterals are cut by both diagonals with half the weight, and lids are means of fans from each node
//! of their rim: means of closed surfaces, for which the divergence theorem holds one by one.

use super::followed::{add_block, cross_with};
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{cross, dot};
use crate::elements::mesh::Mesh;
use crate::scene::forces::surface::natural;

/// Straight walls that a liquid with a level surface stands in.
pub(crate) struct Basin {
    dimension: usize,
    pieces: Vec<Piece>,
    /// e, of length 1.
    down: [f64; 3],
}

struct Piece {
    /// As many as there are dimensions are used.
    nodes: [usize; 3],
    natural: [[f64; 3]; 3],
    /// The sense of the normal, times the thickness in the plane and the part of the walls that it is.
    weight: f64,
}

/// M_ab.
type Overlaps = [[f64; 3]; 3];

/// The level of a volume, and the area of its surface there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Level {
    /// h (m)
    pub(super) height: f64,
    /// A (m^2)
    pub(super) area: f64,
}

/// Reason for which a volume has no level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum NoLevel {
    /// The walls enclose no more than this (m^3).
    Full(f64),
    /// The walls have passed through each other: what they enclose (m^3).
    Turned(f64),
}

/// Steps of the search for a level before it is given up; bisection alone would be at round-off.
const MOST_STEPS: usize = 100;

/// Part of the height of the walls that a step towards the level may have to be the last one: the next one would be its square.
const LAST_STEP: f64 = 1e-12;

impl Basin {
    pub(super) fn new<const D: usize>(
        mesh: &Mesh,
        parts: Vec<([usize; D], f64)>,
        factor: f64,
        down: [f64; 3],
    ) -> Self {
        let piece = |(corners, part): ([usize; D], f64)| {
            let nodes = std::array::from_fn(|k| corners.get(k).copied().unwrap_or_default());
            Piece { nodes, natural: nodes.map(|node| natural(mesh, node)), weight: factor * part }
        };
        Self { dimension: D, pieces: parts.into_iter().map(piece).collect(), down }
    }

    /// The level of a `volume` (m^3) under the displacements `u` (m), by Newton's method within bounds.
    ///
    /// # Errors
    /// Walls that do not hold that much.
    pub(super) fn level(&self, volume: f64, u: &[f64]) -> Result<Level, NoLevel> {
        let [mut low, mut high] = self.extent(u);
        let (span, [whole, _]) = (high - low, self.below(high, u));
        if whole <= 0.0 {
            return Err(NoLevel::Turned(whole));
        }
        if volume >= whole {
            return Err(NoLevel::Full(whole));
        }
        let mut height = low + span * (volume / whole);
        for _ in 0..MOST_STEPS {
            let [found, area] = self.below(height, u);
            *if found > volume { &mut high } else { &mut low } = height;
            let next = height - (found - volume) / area;
            let is_within = low <= next && next <= high;
            let next = if is_within { next } else { low + 0.5 * (high - low) };
            let step = (next - height).abs();
            height = next;
            if step <= LAST_STEP * span {
                break;
            }
        }
        let [_, area] = self.below(height, u);
        if area.is_nan() || area <= 0.0 {
            return Err(NoLevel::Turned(whole));
        }
        Ok(Level { height, area })
    }

    /// The heights of the lowest corner and of the highest one (m).
    pub(super) fn extent(&self, u: &[f64]) -> [f64; 2] {
        let mut extent = [f64::INFINITY, f64::NEG_INFINITY];
        for piece in &self.pieces {
            for depth in &self.depths(0.0, &self.places(piece, u))[..self.dimension] {
                extent = [extent[0].min(-depth), extent[1].max(-depth)];
            }
        }
        extent
    }

    /// Lines along which a level (m) meets the walls; in the plane from wall to wall.
    #[cfg(feature = "output")]
    pub(super) fn waterline(&self, level: f64, u: &[f64]) -> Vec<[[f64; 3]; 2]> {
        let mut met: Vec<[f64; 3]> = Vec::new();
        for piece in &self.pieces {
            let places = self.places(piece, u);
            let depths = self.depths(level, &places);
            for from in 0..self.dimension {
                let to = (from + 1) % self.dimension;
                // a segment has one edge
                let is_met = (depths[from] > 0.0) != (depths[to] > 0.0);
                if is_met && (self.dimension == 3 || from == 0) {
                    let part = depths[from] / (depths[from] - depths[to]);
                    let [a, b] = [places[from], places[to]];
                    met.push(std::array::from_fn(|i| a[i] + part * (b[i] - a[i])));
                }
            }
        }
        if self.dimension == 2 {
            let [x, y, _] = self.down;
            let along = |p: &[f64; 3]| x * p[1] - y * p[0];
            met.sort_by(|a, b| along(a).total_cmp(&along(b)));
        }
        met.as_chunks().0.to_vec()
    }

    /// V (m^3) and A (m^2) of a level (m).
    fn below(&self, level: f64, u: &[f64]) -> [f64; 2] {
        let (mut volume, mut area) = (0.0, 0.0);
        self.each_wet(level, u, |wet| {
            let along = dot(&self.down, &wet.facing);
            for (row, depth) in wet.overlaps.iter().zip(wet.depths) {
                let share: f64 = row.iter().sum();
                volume += along * share * depth;
                area += along * share;
            }
        });
        [volume, area]
    }

    /// S (m^4) of a level (m).
    pub(super) fn moment(&self, level: f64, u: &[f64]) -> f64 {
        let mut moment = 0.0;
        self.each_wet(level, u, |wet| {
            let squares: f64 =
                wet.overlaps.iter().zip(wet.depths).map(|(row, d)| d * dot(row, &wet.depths)).sum();
            moment += 0.5 * dot(&self.down, &wet.facing) * squares;
        });
        moment
    }

    /// Adds `by_moment` times dS/du and `by_volume` times dV/du of a level that stays.
    pub(super) fn add_gradients(
        &self,
        [by_moment, by_volume]: [f64; 2],
        level: f64,
        u: &[f64],
        gradient: &mut [f64],
    ) {
        let d = self.dimension;
        self.each_wet(level, u, |wet| {
            for (row, node) in wet.overlaps.iter().zip(&wet.nodes[..d]) {
                let share = by_moment * dot(row, &wet.depths) + by_volume * row.iter().sum::<f64>();
                let own = gradient[node * d..][..d].iter_mut();
                own.zip(wet.facing).for_each(|(x, n)| *x += share * n);
            }
        });
    }

    /// Adds `factor` times d^2S/du^2 of a level that stays: with dN/dx_b = [c_b x] and m_a = sum_b M_ab d_b the blocks are
    /// N e^T M_ab + m_a [c_b x].
    pub(super) fn add_hessian(&self, factor: f64, level: f64, u: &[f64], matrix: &mut BlockMatrix) {
        let d = self.dimension;
        self.each_wet(level, u, |wet| {
            for (row, from) in wet.overlaps.iter().zip(&wet.nodes[..d]) {
                let depth = dot(row, &wet.depths);
                for (b, to) in wet.nodes[..d].iter().enumerate() {
                    let turned = cross_with(wet.turning(b));
                    let block = std::array::from_fn(|i| {
                        std::array::from_fn(|j| {
                            wet.facing[i] * self.down[j] * row[b] + depth * turned[i][j]
                        })
                    });
                    add_block(matrix, [*from, *to], factor, &block);
                }
            }
        });
    }

    /// Positions of the corners of a piece.
    fn places(&self, piece: &Piece, u: &[f64]) -> [[f64; 3]; 3] {
        let mut places = piece.natural;
        for (place, node) in places.iter_mut().zip(&piece.nodes[..self.dimension]) {
            let moved = &u[node * self.dimension..][..self.dimension];
            place.iter_mut().zip(moved).for_each(|(x, u)| *x += u);
        }
        places
    }

    fn depths(&self, level: f64, places: &[[f64; 3]; 3]) -> [f64; 3] {
        places.map(|place| level + dot(&self.down, &place))
    }

    /// Each piece that is below the level, or in part.
    fn each_wet(&self, level: f64, u: &[f64], mut see: impl FnMut(&Wet)) {
        for piece in &self.pieces {
            let places = self.places(piece, u);
            let mut depths = self.depths(level, &places);
            let corners = self.dimension;
            let Some(overlaps) = overlaps(&depths[..corners]) else { continue };
            depths[corners..].fill(0.0);
            let [a, b, c] = places;
            let first = std::array::from_fn(|i| b[i] - a[i]);
            let (second, area) = match corners {
                2 => (ACROSS, piece.weight),
                _ => (std::array::from_fn(|i| c[i] - a[i]), 0.5 * piece.weight),
            };
            let facing = cross(&first, &second).map(|x| area * x);
            let nodes = piece.nodes;
            see(&Wet { nodes, places, corners, area, depths, facing, overlaps });
        }
    }
}

/// The direction out of the plane.
const ACROSS: [f64; 3] = [0.0, 0.0, 1.0];

/// A piece of the walls that is below the level, or in part; what has no corner is 0.
struct Wet {
    nodes: [usize; 3],
    places: [[f64; 3]; 3],
    corners: usize,
    /// The factor from the product of the edges to N.
    area: f64,
    /// d_a (m), below 0 above the level.
    depths: [f64; 3],
    /// N
    facing: [f64; 3],
    overlaps: Overlaps,
}

impl Wet {
    /// c_b, with which dN/dx_b = [c_b x].
    fn turning(&self, corner: usize) -> [f64; 3] {
        if self.corners == 2 {
            let sense = if corner == 0 { self.area } else { -self.area };
            return ACROSS.map(|x| sense * x);
        }
        let [next, last] = [1, 2].map(|k| self.places[(corner + k) % 3]);
        std::array::from_fn(|i| self.area * (last[i] - next[i]))
    }
}

/// M_ab of a segment or a triangle with `depths` at its corners; `None` if it is above the level.
fn overlaps(depths: &[f64]) -> Option<Overlaps> {
    let is_wet = |depth: &f64| *depth > 0.0;
    match depths.iter().filter(|depth| is_wet(depth)).count() {
        0 => None,
        wet if wet == depths.len() => Some(whole(wet)),
        1 => depths.iter().position(is_wet).map(|corner| tip(depths, corner)),
        // a triangle with one corner above
        _ => {
            let above = depths.iter().position(|depth| !is_wet(depth))?;
            let dry = tip(depths, above);
            let mut rest = whole(depths.len());
            for (row, dry) in rest.iter_mut().zip(dry) {
                row.iter_mut().zip(dry).for_each(|(x, dry)| *x -= dry);
            }
            Some(rest)
        }
    }
}

/// M_ab over all of a piece: (1 + [a = b])/(n (n + 1)).
fn whole(corners: usize) -> Overlaps {
    let share = 1.0 / (corners * (corners + 1)) as f64;
    std::array::from_fn(|a| {
        std::array::from_fn(|b| match a.max(b) < corners {
            true => share * if a == b { 2.0 } else { 1.0 },
            false => 0.0,
        })
    })
}

/// M_ab over the tip of a piece, from one corner to where the depth is 0.
fn tip(depths: &[f64], corner: usize) -> Overlaps {
    let corners = depths.len();
    let (mut size, mut ends) = (1.0 / (corners * (corners + 1)) as f64, [[0.0; 3]; 3]);
    for (k, end) in ends.iter_mut().enumerate().take(corners) {
        end[corner] = 1.0;
        if k != corner {
            let part = depths[corner] / (depths[corner] - depths[k]);
            size *= part;
            (end[corner], end[k]) = (1.0 - part, part);
        }
    }
    let sum = |a: usize| -> f64 { ends.iter().map(|end| end[a]).sum() };
    std::array::from_fn(|a| {
        std::array::from_fn(|b| {
            let squares: f64 = ends.iter().map(|end| end[a] * end[b]).sum();
            size * (sum(a) * sum(b) + squares)
        })
    })
}

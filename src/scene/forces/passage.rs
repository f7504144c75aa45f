//! Whether a point has passed through an obstacle between the ends of a step.
//!
//! Integrators evaluate forces where their steps end (and at some stages), so that a long step may lead
//! through an obstacle without a force. Here the path of a point within a step is the cubic with the
//! positions and velocities at both ends. As a Bezier curve it is no longer than the polygon of its four
//! control points, and lies within their convex hull. As a distance d changes by no more than the length
//! travelled, it stays above (d_0 + d_1 - L)/2 on a piece of length L with d_0 and d_1 at its ends; that of a
//! convex shape is a convex function, and so also stays above its tangent plane at either end.
//!
//! Both ends alone rule out nearly all paths, and none is examined before the body has moved as far as its
//! distance was. Where a penetration is found the step is not taken: the integration goes on from its start
//! and stops within the obstacle at the deepest place, where events that are located are located as usual. A
//! path by formulas has no points at which intervals end: the step is searched in equal parts, halved until
//! the formula is within half the tolerance of the cubic of each part (at seven places in between, and by the
//! accelerations at both ends, so that an oscillation is seen even where all ends have the same phase). A
//! pulse that all these places miss is missed. Depths below the absolute tolerance of displacements, or below
//! twice those at the ends, do not count. Contact is at nodes or Gauss points: an obstacle smaller than their
//! distance may still pass between two of them.

use super::shape::{Kind, Shape};
use crate::base::vector::{difference, dot, norm};

/// Halvings of a path after which the search ends.
const HALVINGS: u32 = 10;

/// The path of a point within a step, or a piece of it, by its control points (m).
#[derive(Debug, Clone, Copy)]
pub(super) struct Path([[f64; 3]; 4]);

impl Path {
    /// The path between positions `x` (m) with velocities `v` (m/s) at both ends, `duration` (s)
    /// apart.
    pub(super) fn new(x: [[f64; 3]; 2], v: [[f64; 3]; 2], duration: f64) -> Self {
        let third = duration / 3.0;
        let beside = |k: usize, by: f64| std::array::from_fn(|i| x[k][i] + by * v[k][i]);
        Self([x[0], beside(0, third), beside(1, -third), x[1]])
    }

    pub(super) fn start(&self) -> &[f64; 3] {
        &self.0[0]
    }

    pub(super) fn end(&self) -> &[f64; 3] {
        &self.0[3]
    }

    /// Bezier's control points (m), in whose convex hull the path lies.
    pub(super) fn controls(&self) -> &[[f64; 3]; 4] {
        &self.0
    }

    /// Position (m) at `s`, from 0 to 1, and its derivative by `s`.
    pub(super) fn at(&self, s: f64) -> [[f64; 3]; 2] {
        let between =
            |a: &[f64; 3], b: &[f64; 3]| std::array::from_fn(|i| a[i] + s * (b[i] - a[i]));
        let [a, b, c, d] = &self.0;
        let [ab, bc, cd]: [[f64; 3]; 3] = [between(a, b), between(b, c), between(c, d)];
        let [abc, bcd]: [[f64; 3]; 2] = [between(&ab, &bc), between(&bc, &cd)];
        [between(&abc, &bcd), difference(&bcd, &abc).map(|x| 3.0 * x)]
    }

    /// The second derivatives (m) by `s` at both ends.
    pub(super) fn bends(&self) -> [[f64; 3]; 2] {
        let bend = |k: usize| {
            std::array::from_fn(|i| {
                6.0 * (self.0[k][i] - 2.0 * self.0[k + 1][i] + self.0[k + 2][i])
            })
        };
        [bend(0), bend(1)]
    }

    /// A bound on the speed (m/s), if it takes `duration` (s).
    pub(super) fn fastest(&self, duration: f64) -> f64 {
        let side = |ends: &[[f64; 3]]| norm(&difference(&ends[1], &ends[0]));
        3.0 / duration * self.0.windows(2).map(side).fold(0.0, f64::max)
    }

    /// A bound on its length (m).
    pub(super) fn length(&self) -> f64 {
        let side = |ends: &[[f64; 3]]| norm(&difference(&ends[1], &ends[0]));
        self.0.windows(2).map(side).sum()
    }

    pub(super) fn halves(&self) -> [Self; 2] {
        let mean = |a: &[f64; 3], b: &[f64; 3]| std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
        let [a, b, c, d] = &self.0;
        let [ab, bc, cd]: [[f64; 3]; 3] = [mean(a, b), mean(b, c), mean(c, d)];
        let [abc, bcd]: [[f64; 3]; 2] = [mean(&ab, &bc), mean(&bc, &cd)];
        let middle = mean(&abc, &bcd);
        [Self([*a, ab, abc, middle]), Self([middle, bcd, cd, *d])]
    }
}

/// The place along `path` (from 0 to 1) where a point is deeper within `shape` than `depth` (m), if there is
/// one; the point is at least half as deep there as it gets anywhere.
pub(super) fn deepest(shape: &Shape, path: &Path, dimension: usize, depth: f64) -> Option<f64> {
    let mut search = Search { dimension, limit: -depth, place: None };
    search.shape(shape, path);
    search.place
}

/// Places along a step at which the depth within a shape is looked at.
const PLACES: usize = 16;
/// Part of the half thickness of a shape at which a point that comes out on the other side has been: less than at its
/// middle, which lies between places.
const MIDDLE: f64 = 0.25;

/// Whether a point has passed the middle of a shape on its way between two positions (m), of which one is inside: the
/// nearest side is then an opposite one. Of a shape of unknown thickness, whether that is so, deeper than `depth` (m).
pub(super) fn is_passed(shape: &Shape, [from, to]: [&[f64]; 2], depth: f64) -> bool {
    if let Kind::Union(parts) = shape.kind() {
        return parts.iter().any(|part| is_passed(part, [from, to], depth));
    }
    let [start, end] = [from, to].map(|x| shape.nearest(x));
    if start.distance >= 0.0 && end.distance >= 0.0 || dot(&start.normal, &end.normal) >= 0.0 {
        return false;
    }
    let half = shape.half_thickness(to);
    let least = if half.is_finite() { MIDDLE * half } else { depth };
    let is_deep =
        |place: usize| {
            let s = place as f64 / PLACES as f64;
            let x: [f64; 3] = std::array::from_fn(|i| {
                if i < from.len() { from[i] + s * (to[i] - from[i]) } else { 0.0 }
            });
            shape.nearest(&x[..from.len()]).distance < -least
        };
    (0..=PLACES).any(is_deep)
}

struct Search {
    dimension: usize,
    /// The distance (m) below which a further place is looked for.
    limit: f64,
    place: Option<f64>,
}

impl Search {
    fn shape(&mut self, shape: &Shape, path: &Path) {
        match shape.kind() {
            Kind::Union(parts) => parts.iter().for_each(|part| self.shape(part, path)),
            _ => self.piece(shape, path, [0.0, 1.0], 0),
        }
    }

    fn piece(&mut self, shape: &Shape, path: &Path, [from, to]: [f64; 2], halvings: u32) {
        let d = self.dimension;
        let [start, end] = [path.start(), path.end()].map(|x| shape.nearest(&x[..d]));
        if halvings == HALVINGS
            || 0.5 * (start.distance + end.distance - path.length()) >= self.limit
        {
            return;
        }
        let is_above = match shape.kind() {
            // for a cavity, points with a distance of `limit` or more form a ball, which is convex
            Kind::Ball { cavity: true, .. } => {
                path.0.iter().all(|x| shape.nearest(&x[..d]).distance >= self.limit)
            }
            Kind::Custom(_) => false,
            _ => [(path.start(), &start), (path.end(), &end)].into_iter().any(|(x, nearest)| {
                let rise = |y: &[f64; 3]| dot(&nearest.normal, &difference(y, x));
                path.0.iter().all(|y| nearest.distance + rise(y) >= self.limit)
            }),
        };
        if is_above {
            return;
        }
        let (middle, halves) = (0.5 * (from + to), path.halves());
        let distance = shape.nearest(&halves[0].end()[..d]).distance;
        if distance < self.limit {
            (self.limit, self.place) = (2.0 * distance, Some(middle));
        }
        self.piece(shape, &halves[0], [from, middle], halvings + 1);
        self.piece(shape, &halves[1], [middle, to], halvings + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The search finds a place where it must, and only where it may: on random paths around shapes of all
    /// kinds, each sampled at two thousand places.
    #[test]
    fn no_path_through_a_shape_is_missed() {
        let shapes = [
            Shape::half_plane([0.1, 0.0], [0.6, 0.8]),
            Shape::disc([0.1, 0.2], 0.3),
            Shape::cavity([0.1, 0.2], 0.9),
            Shape::box_between([-0.2, -0.05], [0.4, 0.05]),
            Shape::capsule([-0.4, 0.0], [0.4, 0.2], 0.03),
            Shape::union([Shape::disc([0.5, 0.0], 0.1), Shape::disc([-0.5, 0.0], 0.1)]),
            Shape::custom(|x, normal| {
                let distance = x[0].hypot(x[1]);
                normal.copy_from_slice(&[x[0] / distance, x[1] / distance]);
                distance - 0.25
            }),
        ];
        let (mut state, mut found, mut clear) = (1_u64, 0, 0);
        let mut number = || {
            // splitmix64
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for shape in &shapes {
            for _ in 0..300 {
                let mut vector = || [number(), number(), 0.0];
                let (x, v) = ([vector(), vector()], [vector(), vector()]);
                let path = Path::new(x, v, 1.0);
                let at = |s: f64| {
                    let r = 1.0 - s;
                    let weights = [r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s];
                    let x: [f64; 2] =
                        std::array::from_fn(|i| (0..4).map(|k| weights[k] * path.0[k][i]).sum());
                    shape.nearest(&x).distance
                };
                let lowest =
                    (0..=2000).map(|k| at(f64::from(k) / 2000.0)).fold(f64::INFINITY, f64::min);
                let seen = f64::max(0.0, -at(0.0).min(at(1.0)));
                let depth = 2.0 * seen + 0.01;
                match deepest(shape, &path, 2, depth) {
                    Some(s) => {
                        found += 1;
                        assert!(
                            at(s) < -depth && 2.0 * at(s) < lowest + 1e-3,
                            "{shape:?} {path:?}"
                        );
                    }
                    None => {
                        clear += 1;
                        // the last halving leaves a thousandth of the path
                        assert!(lowest > -depth - 5e-3, "{shape:?} {path:?}");
                    }
                }
            }
        }
        assert!(found > 200 && clear > 200, "{found} {clear}");
    }
}

//! The point of a face that is nearest to a given point.

use super::closest;
use super::face::{FacePoint, MOST_NODES, is_affine, position, reference_node, second_derivatives};
use crate::base::vector::{difference, dot, norm};
use crate::elements::mesh::FaceKind;

/// A place on a face, and the part of the face on which it is: its inside, an edge or a corner.
#[derive(Debug, Clone)]
pub(crate) struct NearestPoint {
    /// The nodes of that part, by their numbers on the face.
    pub(crate) nodes: &'static [usize],
    kind: FaceKind,
    xi: [f64; 2],
}

impl NearestPoint {
    fn inside(kind: FaceKind, count: usize, xi: [f64; 2]) -> Self {
        Self { nodes: &[0, 1, 2, 3, 4, 5, 6, 7, 8][..count], kind, xi }
    }

    fn corner(node: usize) -> Self {
        const CORNERS: [&[usize]; 4] = [&[0], &[1], &[2], &[3]];
        Self { nodes: CORNERS[node], kind: FaceKind::Point, xi: [0.0; 2] }
    }

    /// The nearest place on an `edge` of a face with its nodes at `at`.
    fn on_edge(edge: &'static [usize], at: &[[f64; 3]], x: &[f64; 3]) -> Self {
        let kind = if edge.len() == 2 { FaceKind::Segment } else { FaceKind::Segment3 };
        let mut ends = [[0.0; 3]; 3];
        ends.iter_mut().zip(edge).for_each(|(end, &node)| *end = at[node]);
        let place = nearest(kind, &ends[..edge.len()], x);
        match place.nodes {
            [end] => Self::corner(edge[*end]),
            _ => Self { nodes: edge, ..place },
        }
    }

    /// Dimension of the part of the face: in so many directions the place moves.
    pub(crate) fn dimension(&self) -> usize {
        self.kind.dimension()
    }

    /// The shape functions of its nodes, and their derivatives by the coordinates of the place.
    pub(crate) fn shape(&self) -> FacePoint {
        FacePoint::new(self.kind, self.xi, 0.0)
    }

    /// The offset of `x` from it, on a face with its nodes at `at`; `shape` is [its own](Self::shape).
    pub(crate) fn offset(&self, shape: &FacePoint, at: &[[f64; 3]], x: &[f64; 3]) -> [f64; 3] {
        let mut there = [0.0; 3];
        for (&node, share) in self.nodes.iter().zip(&shape.values) {
            there.iter_mut().zip(at[node]).for_each(|(sum, x)| *sum += share * x);
        }
        difference(x, &there)
    }

    /// The distance of `x` from it.
    pub(crate) fn distance(&self, at: &[[f64; 3]], x: &[f64; 3]) -> f64 {
        norm(&self.offset(&self.shape(), at, x))
    }

    /// The second derivatives of the shape functions, by the first coordinate, by the second one, and by both; none if all
    /// are 0.
    pub(crate) fn second_derivatives(&self) -> Option<[[f64; 3]; MOST_NODES]> {
        (!is_affine(self.kind)).then(|| second_derivatives(self.kind, self.xi))
    }
}

/// The place of a face of a kind, with its nodes at `at`, that is nearest to `x`. Of a curved face that is the nearest one
/// around the node that is nearest: another one may be nearer where `x` is farther away than the face is curved.
pub(crate) fn nearest(kind: FaceKind, at: &[[f64; 3]], x: &[f64; 3]) -> NearestPoint {
    match (kind, at) {
        (FaceKind::Segment3, [a, b, middle]) => on_parabola([a, b, middle], x),
        _ if is_affine(kind) => of_affine(kind, at, x),
        _ => match inside(kind, at, x) {
            Some(xi) => NearestPoint::inside(kind, at.len(), xi),
            None => on_rim(kind, at, x),
        },
    }
}

/// The nearest place on the edges of a face.
fn on_rim(kind: FaceKind, at: &[[f64; 3]], x: &[f64; 3]) -> NearestPoint {
    let places = kind.edges().iter().map(|edge| {
        let place = NearestPoint::on_edge(edge, at, x);
        (place.distance(at, x), place)
    });
    let nearest = places.min_by(|(a, _), (b, _)| a.total_cmp(b));
    nearest.map_or(NearestPoint::corner(0), |(_, place)| place)
}

/// The nearest place of an edge with a mid node, p_0 + p_1 xi + p_2 xi^2 from `x`. Half of its squared distance has a cubic
/// as slope; where that changes its sign from one end to the other, its root is found by Newton's method, kept between
/// places at which the slope has either sign.
fn on_parabola([a, b, middle]: [&[f64; 3]; 3], x: &[f64; 3]) -> NearestPoint {
    let p0 = difference(a, x);
    let p1: [f64; 3] = std::array::from_fn(|i| 4.0 * middle[i] - 3.0 * a[i] - b[i]);
    let p2: [f64; 3] = std::array::from_fn(|i| 2.0 * (a[i] + b[i] - 2.0 * middle[i]));
    let (c0, c1) = (dot(&p0, &p1), dot(&p1, &p1) + 2.0 * dot(&p0, &p2));
    let (c2, c3) = (3.0 * dot(&p1, &p2), 2.0 * dot(&p2, &p2));
    let slope = |xi: f64| ((c3 * xi + c2) * xi + c1) * xi + c0;
    match (slope(0.0) < 0.0, slope(1.0) > 0.0) {
        (true, true) => {}
        (true, false) => return NearestPoint::corner(1),
        (false, true) => return NearestPoint::corner(0),
        (false, false) => {
            let away = |end: &[f64; 3]| norm(&difference(end, x));
            return NearestPoint::corner(usize::from(away(b) < away(a)));
        }
    }
    let (mut low, mut high, mut xi) = (0.0, 1.0, 0.5);
    for _ in 0..ROUNDS {
        let value = slope(xi);
        if value < 0.0 {
            low = xi;
        } else {
            high = xi;
        }
        let next = xi - value / ((3.0 * c3 * xi + 2.0 * c2) * xi + c1);
        let next = if low <= next && next <= high { next } else { 0.5 * (low + high) };
        let step = next - xi;
        xi = next;
        if step.abs() < LAST {
            break;
        }
    }
    NearestPoint::inside(FaceKind::Segment3, 3, [xi, 0.0])
}

/// The nearest place of a point, straight segment or triangle.
fn of_affine(kind: FaceKind, at: &[[f64; 3]], x: &[f64; 3]) -> NearestPoint {
    let shares = closest(at, x);
    let mut parts = (0..at.len()).filter(|&k| shares[k] != 0.0);
    match [parts.next(), parts.next(), parts.next()] {
        [Some(node), None, _] => NearestPoint::corner(node),
        [Some(_), Some(_), Some(_)] => NearestPoint::inside(kind, 3, [shares[1], shares[2]]),
        [Some(a), Some(b), None] if kind == FaceKind::Triangle => {
            const EDGES: [&[usize]; 3] = [&[0, 1], &[0, 2], &[1, 2]];
            NearestPoint { nodes: EDGES[a + b - 1], kind: FaceKind::Segment, xi: [shares[b], 0.0] }
        }
        _ => NearestPoint::inside(kind, at.len(), [shares[1], shares[2]]),
    }
}

/// Most steps of Newton's method: it takes three to six.
const ROUNDS: usize = 40;
/// Shorter steps in reference coordinates change the distance by no more than round-off may hide.
const SHORT: f64 = 1e-4;
/// A step after which the next one would be round-off.
const LAST: f64 = 1e-9;
/// A coordinate this near to the rim of a face is on it.
const ON_RIM: f64 = 1e-14;

/// The reference coordinates of the nearest place, if that is inside a curved triangle or quadrilateral: by Newton's method
/// for the squared distance, downhill within the face. `None` if it leads to the rim.
fn inside(kind: FaceKind, at: &[[f64; 3]], x: &[f64; 3]) -> Option<[f64; 2]> {
    let bounds = bounds(kind);
    let mut xi = start(kind, at, x);
    let mut here = Distance::new(kind, at, x, xi);
    for _ in 0..ROUNDS {
        let slope = here.slope;
        let leads_out = |bound: &&Bound| {
            bound.room(xi) <= ON_RIM && bound.rate(slope.map(|slope| -slope)) < 0.0
        };
        let mut held = bounds.iter().filter(leads_out);
        let curvature = here.curvature(kind, at, xi);
        let mut step = match (held.next(), held.next()) {
            (None, _) => newton_step(slope, curvature),
            (Some(bound), None) => step_along(bound, slope, curvature),
            _ => return None,
        };
        let mut part = reach_of(step, bounds, xi);
        if part == 0.0 {
            // Newton's step leads through a bound that the way downhill does not
            step = slope.map(|slope| -slope / (curvature[0] + curvature[2]));
            part = reach_of(step, bounds, xi);
        }
        let length = part * step[0].abs().max(step[1].abs());
        loop {
            let next = [xi[0] + part * step[0], xi[1] + part * step[1]];
            let there = Distance::new(kind, at, x, next);
            if length < SHORT || there.square <= here.square || part < SHORT {
                (xi, here) = (next, there);
                break;
            }
            part *= 0.5;
        }
        if length < LAST {
            break;
        }
    }
    bounds.iter().all(|bound| bound.room(xi) > ON_RIM).then_some(xi)
}

/// A bound of a reference face: `offset` + `normal` . xi is above 0 within it.
struct Bound {
    normal: [f64; 2],
    offset: f64,
}

impl Bound {
    fn room(&self, xi: [f64; 2]) -> f64 {
        self.offset + self.rate(xi)
    }

    fn rate(&self, step: [f64; 2]) -> f64 {
        self.normal[0] * step[0] + self.normal[1] * step[1]
    }
}

const LEFT: Bound = Bound { normal: [1.0, 0.0], offset: 0.0 };
const RIGHT: Bound = Bound { normal: [-1.0, 0.0], offset: 1.0 };
const LOWER: Bound = Bound { normal: [0.0, 1.0], offset: 0.0 };
const UPPER: Bound = Bound { normal: [0.0, -1.0], offset: 1.0 };
const SLANTED: Bound = Bound { normal: [-1.0, -1.0], offset: 1.0 };

fn bounds(kind: FaceKind) -> &'static [Bound] {
    match kind.corners() {
        3 => &[LEFT, LOWER, SLANTED],
        _ => &[LEFT, RIGHT, LOWER, UPPER],
    }
}

/// Inside the face, near the node that is nearest.
fn start(kind: FaceKind, at: &[[f64; 3]], x: &[f64; 3]) -> [f64; 2] {
    let away = |node: &usize| norm(&difference(&at[*node], x));
    let nearest = (0..at.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0);
    let node = reference_node(kind, nearest);
    let middle = if kind.corners() == 3 { 1.0 / 3.0 } else { 0.5 };
    node.map(|xi| 0.75 * xi + 0.25 * middle)
}

/// Half of the squared distance of a place from a point, with its slope.
struct Distance {
    /// From the point to the place.
    offset: [f64; 3],
    tangents: [[f64; 3]; 2],
    square: f64,
    slope: [f64; 2],
}

impl Distance {
    fn new(kind: FaceKind, at: &[[f64; 3]], x: &[f64; 3], xi: [f64; 2]) -> Self {
        let [there, tangents @ ..] = position(kind, at, xi);
        let offset = difference(&there, x);
        let slope = tangents.each_ref().map(|tangent| dot(tangent, &offset));
        Self { offset, tangents, square: 0.5 * dot(&offset, &offset), slope }
    }

    /// Its second derivatives 11, 12 and 22; without those of the position where they would not be positive definite.
    fn curvature(&self, kind: FaceKind, at: &[[f64; 3]], xi: [f64; 2]) -> [f64; 3] {
        let [along, across] = &self.tangents;
        let [aa, ab, bb] = [dot(along, along), dot(along, across), dot(across, across)];
        let [by_first, by_second, by_both] = self.bending(kind, at, xi);
        let whole = [aa + by_first, ab + by_both, bb + by_second];
        let is_definite = whole[0] > 0.0 && whole[0] * whole[2] > whole[1] * whole[1];
        if is_definite { whole } else { [aa, ab, bb] }
    }

    fn bending(&self, kind: FaceKind, at: &[[f64; 3]], xi: [f64; 2]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (x, seconds) in at.iter().zip(second_derivatives(kind, xi)) {
            let along = dot(x, &self.offset);
            sum.iter_mut().zip(seconds).for_each(|(sum, second)| *sum += second * along);
        }
        sum
    }
}

fn newton_step(slope: [f64; 2], [aa, ab, bb]: [f64; 3]) -> [f64; 2] {
    let whole = aa * bb - ab * ab;
    [(ab * slope[1] - bb * slope[0]) / whole, (ab * slope[0] - aa * slope[1]) / whole]
}

/// Newton's step along a bound.
fn step_along(bound: &Bound, slope: [f64; 2], [aa, ab, bb]: [f64; 3]) -> [f64; 2] {
    let [p, q] = [-bound.normal[1], bound.normal[0]];
    let part = -(p * slope[0] + q * slope[1]) / (p * p * aa + 2.0 * p * q * ab + q * q * bb);
    [part * p, part * q]
}

/// Fraction of a step within the bounds, 1 at most.
fn reach_of(step: [f64; 2], bounds: &[Bound], xi: [f64; 2]) -> f64 {
    let ahead = bounds.iter().filter(|bound| bound.rate(step) < 0.0);
    ahead.fold(1.0, |part, bound| part.min(bound.room(xi).max(0.0) / -bound.rate(step)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::vector::noise;
    use crate::elements::basis::reach;

    const KINDS: [FaceKind; 8] = [
        FaceKind::Segment,
        FaceKind::Segment3,
        FaceKind::Triangle,
        FaceKind::Triangle6,
        FaceKind::Triangle7,
        FaceKind::Quadrilateral,
        FaceKind::Quadrilateral8,
        FaceKind::Quadrilateral9,
    ];

    fn nodes(kind: FaceKind) -> usize {
        FacePoint::new(kind, [0.31, 0.23], 0.0).values.iter().filter(|value| **value != 0.0).count()
    }

    /// Places of a reference face, `n` along each side.
    fn lattice(kind: FaceKind, n: usize) -> Vec<[f64; 2]> {
        let rows = if kind.dimension() == 2 { n } else { 0 };
        let all =
            (0..=rows).flat_map(|j| (0..=n).map(move |i| [i, j].map(|k| k as f64 / n as f64)));
        all.filter(|xi| bounds(kind).iter().all(|bound| bound.room(*xi) > -1e-9)).collect()
    }

    /// On bent and warped faces of all kinds: no place of a fine lattice is nearer, and the distance is that of the
    /// lattice up to its width.
    #[test]
    fn no_place_is_nearer() {
        for kind in KINDS {
            let count = nodes(kind);
            let bent = noise(3 * count, 5);
            let at: Vec<[f64; 3]> = (0..count)
                .map(|node| {
                    let [x, y] = reference_node(kind, node);
                    std::array::from_fn(|i| [x, y, 0.0][i] + 0.03 * bent[3 * node + i])
                })
                .collect();
            let mut parts = [0; 3];
            let places = lattice(kind, 60);
            for x in noise(240, 3).chunks_exact(3) {
                let x = [0.5 + 0.6 * x[0], 0.5 + 0.6 * x[1], 0.15 * x[2]];
                let away = |there: [f64; 3]| norm(&difference(&there, &x));
                let place = nearest(kind, &at, &x);
                let found = place.distance(&at, &x);
                let lattice = places.iter().map(|xi| away(position(kind, &at, *xi)[0]));
                let least = lattice.fold(f64::INFINITY, f64::min);
                assert!(found <= least + 1e-12, "{kind:?} {x:?}: {found} {least}");
                assert!(least < found + 0.03, "{kind:?} {x:?}: {found} {least}");
                parts[place.dimension()] += 1;
            }
            assert!(parts[0] > 3 && parts[kind.dimension()] > 10, "{kind:?}: {parts:?}");
        }
    }

    /// Second derivatives against differences of the first ones, and the bound on the sizes of the shape functions, which
    /// are 1 together.
    #[test]
    fn shape_functions_of_faces() {
        for kind in KINDS {
            let mut most = 0.0_f64;
            for xi in lattice(kind, 40) {
                let values = FacePoint::new(kind, xi, 0.0).values;
                assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                most = most.max(values.iter().map(|value| value.abs()).sum());
            }
            assert!(most <= reach(kind) + 1e-12 && most > 0.99 * reach(kind), "{kind:?}: {most}");
            let (xi, h) = ([0.31, 0.23], 1e-5);
            let exact = second_derivatives(kind, xi);
            let slopes =
                |x: f64, y: f64| FacePoint::new(kind, [xi[0] + x, xi[1] + y], 0.0).derivatives;
            let (by_x, by_y) =
                ([slopes(h, 0.0), slopes(-h, 0.0)], [slopes(0.0, h), slopes(0.0, -h)]);
            for (a, exact) in exact.iter().enumerate() {
                let slope = |of: &[[[f64; 2]; MOST_NODES]; 2], k: usize| {
                    (of[0][a][k] - of[1][a][k]) / (2.0 * h)
                };
                let found = [slope(&by_x, 0), slope(&by_y, 1), slope(&by_y, 0)];
                for (found, exact) in found.iter().zip(exact) {
                    assert!((found - exact).abs() < 1e-9, "{kind:?} {a}: {found} {exact}");
                }
            }
        }
    }
}

//! Axes of rods: nodes on a path, and the directors there.

use nalgebra::{UnitQuaternion, Vector3};

use super::nodes::{Nodes, across};
use super::screw::Screw;
use crate::base::input::{InputError, finite};

/// The axis of a [rod](crate::Rod): a polygon, an arc or a helix. Lists of points are polygons.
///
/// ```
/// use pliant::RodPath;
///
/// // a coil spring of ten turns around the axis z
/// let coil = RodPath::helix([0.01, 0.0, 0.0], [0.0, 0.0, 0.0], 0.004, 10.0);
/// // a half circle in the plane
/// let arch = RodPath::arc([0.1, 0.0], [0.0, 0.0], std::f64::consts::PI);
/// let corner = RodPath::from([[0.0, 0.0], [0.1, 0.0], [0.1, 0.1]]);
/// ```
#[derive(Debug, Clone)]
pub struct RodPath(Shape);

#[derive(Debug, Clone)]
enum Shape {
    Polygon(Vec<Vec<f64>>),
    Screw(Screw),
}

impl<I: IntoIterator<Item: Into<Vec<f64>>>> From<I> for RodPath {
    /// The polygon through points (m; two coordinates each in the plane, three in space), whose sides share the elements by their lengths.
    /// It is a ring if it ends at its first point.
    fn from(points: I) -> Self {
        Self(Shape::Polygon(points.into_iter().map(Into::into).collect()))
    }
}

impl RodPath {
    /// The arc from `start` around `center` (m; two coordinates each in the plane, three in space) by an `angle` (rad), counterclockwise, in
    /// space about z, or the [axis](Self::about) given. It is a ring if that is a whole turn.
    pub fn arc(start: impl Into<Vec<f64>>, center: impl Into<Vec<f64>>, angle: f64) -> Self {
        let (start, center) = (start.into(), center.into());
        Self(Shape::Screw(Screw { start, center, axis: [0.0, 0.0, 1.0], pitch: 0.0, angle }))
    }

    /// The helix from `start` around an axis through `center` (m), along z, or the [axis](Self::about) given, which climbs by the `pitch` (m) in
    /// each of so many `turns`; it is right-handed, with negative turns and pitch left-handed.
    pub fn helix(start: [f64; 3], center: [f64; 3], pitch: f64, turns: f64) -> Self {
        let angle = turns * std::f64::consts::TAU;
        let (start, center) = (start.into(), center.into());
        Self(Shape::Screw(Screw { start, center, axis: [0.0, 0.0, 1.0], pitch, angle }))
    }

    /// The same about an axis of this direction, of any length. It does not change polygons and arcs in the plane.
    pub fn about(mut self, direction: [f64; 3]) -> Self {
        if let Shape::Screw(screw) = &mut self.0
            && screw.start.len() == 3
        {
            screw.axis = direction;
        }
        self
    }

    /// Number of coordinates of its points.
    pub(super) fn dimension(&self) -> usize {
        match &self.0 {
            Shape::Polygon(points) => points.first().map_or(3, Vec::len),
            Shape::Screw(screw) => screw.start.len(),
        }
    }

    /// The nodes of so many `elements` along it. d_1 at the first node lies as near to `normal` as it can; along a polygon it is carried without
    /// twist, along arcs and helices by their screw motion; in the plane it lies in the plane, to the left.
    ///
    /// # Errors
    /// Fewer than two points, points that coincide or are not finite, fewer elements than the path has sides, a kink that no section
    /// follows, a normal along the path, a helix whose start is on its axis.
    pub(super) fn nodes(
        &self,
        elements: usize,
        normal: Option<[f64; 3]>,
    ) -> Result<Nodes, InputError> {
        match &self.0 {
            Shape::Polygon(points) => polygon(points, elements, normal),
            Shape::Screw(screw) => screw.nodes(elements, normal),
        }
    }
}

/// A part of the length of a path below which two points are one.
const NO_LENGTH: f64 = 1e-9;

/// Cosine of the angle between two elements beyond which no section follows the kink (120 degrees).
const SHARP: f64 = -0.5;

/// The nodes on the polygon through `points` (m), which is a ring if it ends where it begins.
fn polygon(
    points: &[Vec<f64>],
    elements: usize,
    normal: Option<[f64; 3]>,
) -> Result<Nodes, InputError> {
    let dimension = points.first().map_or(0, Vec::len);
    for (number, point) in (1..).zip(points) {
        let input = format!("point {number} of the rod's path");
        if !(2..=3).contains(&point.len()) || point.len() != dimension {
            let help = "all points need two coordinates (m) in the plane, three in space";
            return Err(InputError::new(input, format!("{point:?}"), help));
        }
        finite(&input, point)?;
    }
    if points.len() < 2 {
        let help = "a path needs two points at least";
        return Err(InputError::new("number of points of the rod's path", points.len(), help));
    }
    let corners: Vec<Vector3<f64>> = points
        .iter()
        .map(|point| Vector3::from_fn(|i, _| point.get(i).copied().unwrap_or(0.0)))
        .collect();
    let sides: Vec<f64> = corners.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
    let length: f64 = sides.iter().sum();
    if let Some(number) = sides.iter().position(|side| *side <= NO_LENGTH * length) {
        let help = format!("it coincides with point {}: leave one of them out", number + 1);
        let input = format!("point {} of the rod's path", number + 2);
        return Err(InputError::new(input, format!("{:?}", points[number + 1]), help));
    }
    if elements < sides.len() {
        let help = format!(
            "each side of the path needs one, {} in all: raise it, or give fewer points",
            sides.len()
        );
        return Err(InputError::new("elements of the rod", elements, help));
    }
    let is_closed =
        sides.len() > 2 && (corners[0] - corners[corners.len() - 1]).norm() <= NO_LENGTH * length;
    let (mut x, mut lengths) = (vec![corners[0]], Vec::with_capacity(elements));
    for ((pair, count), side) in corners.windows(2).zip(shared_out(elements, &sides)).zip(&sides) {
        lengths.extend(std::iter::repeat_n(side / count as f64, count));
        let place = |k: usize| pair[0] + (pair[1] - pair[0]) * (k as f64 / count as f64);
        x.extend((1..count).map(place));
        x.push(pair[1]);
    }
    if is_closed {
        x.pop();
    }
    let tangents = tangents(&x, is_closed)?;
    let d = directors(&tangents, normal, dimension)?;
    Ok(Nodes { x, d, lengths, curvature: 0.0, is_closed })
}

/// The `elements`, shared out among `sides` by their lengths, one at least to each.
fn shared_out(elements: usize, sides: &[f64]) -> Vec<usize> {
    let mut counts = vec![1; sides.len()];
    for _ in sides.len()..elements {
        let longest = (0..sides.len()).max_by(|a, b| {
            let part = |k: usize| sides[k] / counts[k] as f64;
            part(*a).total_cmp(&part(*b))
        });
        longest.into_iter().for_each(|side| counts[side] += 1);
    }
    counts
}

/// Tangents at the nodes: the mean of the directions of the elements on both sides.
fn tangents(x: &[Vector3<f64>], is_closed: bool) -> Result<Vec<Vector3<f64>>, InputError> {
    let count = x.len();
    let between = |k: usize| (x[(k + 1) % count] - x[k]).normalize();
    let directions: Vec<_> = (0..if is_closed { count } else { count - 1 }).map(between).collect();
    let at = |k: usize| {
        let before = match (k, is_closed) {
            (0, false) => directions[0],
            (0, true) => directions[count - 1],
            _ => directions[k - 1],
        };
        let after = directions.get(k).copied().unwrap_or(before);
        if before.dot(&after) < SHARP {
            let angle = before.angle(&after).to_degrees();
            let help = "no cross section follows such a kink: round the path off by more points, or make two rods, tied to each other";
            let input = format!("angle of the rod's path at node {}", k + 1);
            return Err(InputError::new(input, format!("{angle:.0} degrees"), help));
        }
        Ok((before + after).normalize())
    };
    (0..count).map(at).collect()
}

/// The directors of sections whose normals are `tangents`.
fn directors(
    tangents: &[Vector3<f64>],
    normal: Option<[f64; 3]>,
    dimension: usize,
) -> Result<Vec<[Vector3<f64>; 2]>, InputError> {
    if dimension == 2 {
        let left = |t: &Vector3<f64>| [Vector3::new(-t.y, t.x, 0.0), Vector3::z()];
        return Ok(tangents.iter().map(left).collect());
    }
    let mut d = across(&tangents[0], normal)?;
    let mut all = Vec::with_capacity(tangents.len());
    for (k, t) in tangents.iter().enumerate() {
        if k > 0 {
            let turn = UnitQuaternion::rotation_between(&tangents[k - 1], t);
            d = turn.map_or(d, |turn| turn * d);
            d = (d - t * t.dot(&d)).normalize();
        }
        all.push([d, t.cross(&d)]);
    }
    Ok(all)
}

//! Axes of rods: nodes on a path, and the directors there.

use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::base::input::{InputError, finite};

/// The nodes of a rod.
pub(super) struct Nodes {
    /// Positions (m).
    pub(super) x: Vec<Vector3<f64>>,
    /// Directors d_1 and d_2.
    pub(super) d: Vec<[Vector3<f64>; 2]>,
    /// Whether the last node is followed by the first.
    pub(super) is_closed: bool,
}

impl Nodes {
    /// Number of the elements between them.
    pub(super) fn elements(&self) -> usize {
        if self.is_closed { self.x.len() } else { self.x.len() - 1 }
    }
}

/// A part of the length of a path below which two points are one.
const NO_LENGTH: f64 = 1e-9;

/// Cosine of the angle between two elements beyond which no section follows the kink (120 degrees).
const SHARP: f64 = -0.5;

/// The nodes of so many `elements` on the polygon through `points` (m), which is a ring if it ends where it begins. d_1 at the first node lies
/// as near to `normal` as it can and is carried along the path without twist; in the plane it lies in the plane, to the left.
///
/// # Errors
/// Fewer than two points, points that coincide or are not finite, fewer elements than the polygon has sides, a kink that no section
/// follows, a normal along the path.
pub(super) fn nodes(
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
            "the path has {} sides, each of which needs one: raise it, or give fewer points",
            sides.len()
        );
        return Err(InputError::new("elements of the rod", elements, help));
    }
    let is_closed =
        sides.len() > 2 && (corners[0] - corners[corners.len() - 1]).norm() <= NO_LENGTH * length;
    let mut x = vec![corners[0]];
    for (pair, count) in corners.windows(2).zip(shared_out(elements, &sides)) {
        let place = |k: usize| pair[0] + (pair[1] - pair[0]) * (k as f64 / count as f64);
        x.extend((1..count).map(place));
        x.push(pair[1]);
    }
    if is_closed {
        x.pop();
    }
    let tangents = tangents(&x, is_closed)?;
    let d = directors(&tangents, normal, dimension)?;
    Ok(Nodes { x, d, is_closed })
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
    let first = tangents[0];
    let wanted = match normal {
        Some(normal) => {
            finite("normal of the rod", &normal)?;
            Vector3::from(normal)
        }
        // the axis that is most across the path; the later one of two
        None => {
            let axes = [Vector3::z(), Vector3::y(), Vector3::x()];
            let across = |axis: &Vector3<f64>| (first.dot(axis).abs() * 1e6).round();
            axes.into_iter()
                .min_by(|a, b| across(a).total_cmp(&across(b)))
                .unwrap_or_else(Vector3::z)
        }
    };
    let across = wanted - first * first.dot(&wanted);
    let Some(across) = Unit::try_new(across, 1e-6 * wanted.norm()) else {
        let help = "it lies along the path at its first point: choose a direction across it";
        return Err(InputError::new("normal of the rod", format!("{wanted:?}"), help));
    };
    let mut d = across.into_inner();
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

//! Projection of space onto the plane of the drawing.

use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::body::Body;

/// A point in the plane of the drawing: (m) or (px).
pub(in crate::io::output) type Point = [f64; 2];

/// Direction of view: from the front, turned 30 degrees to the right and 20 degrees from above.
/// Axes of the drawing, to the right and upward, and the direction away from the viewer.
const RIGHTWARD: [f64; 3] = [0.866_025, 0.5, 0.0];
const UPWARD: [f64; 3] = [-0.171_010, 0.296_198, 0.939_693];
const AWAY: [f64; 3] = [-0.469_846, 0.813_798, -0.342_020];

/// Positions of all nodes as drawn: a one-dimensional body stands upright, space is seen obliquely.
pub(in crate::io::output) fn positions(trajectory: &Trajectory, sample: &Sample) -> Vec<Point> {
    let dimension = trajectory.body().dimension();
    displaced(trajectory, sample).chunks_exact(dimension).map(drawn).collect()
}

/// Depth of each node of a body in space from the viewer (m, from an arbitrary plane) under the
/// displacements `u` (m).
pub(super) fn depths(body: &Body, u: &[f64]) -> Vec<f64> {
    let moved: Vec<f64> = body.mesh().positions().iter().zip(u).map(|(x, u)| x + u).collect();
    moved.chunks_exact(3).map(|x| along(x, AWAY)).collect()
}

/// Positions of all nodes (m), dimension coordinates each.
pub(in crate::io::output) fn displaced(trajectory: &Trajectory, sample: &Sample) -> Vec<f64> {
    let natural = trajectory.body().mesh().positions().iter();
    natural.zip(&sample.u).map(|(x, u)| x + u).collect()
}

fn along(x: &[f64], direction: [f64; 3]) -> f64 {
    x.iter().zip(direction).map(|(x, d)| x * d).sum()
}

pub(in crate::io::output) fn drawn(x: &[f64]) -> Point {
    match *x {
        [x] => [0.0, x],
        [x, y] => [x, y],
        _ => [RIGHTWARD, UPWARD].map(|axis| along(x, axis)),
    }
}

//! The rigid motion of a body, and its motion relative to that. Means are over nodes.

use nalgebra::{Matrix3, Vector3};

use crate::base::rotation::nearest_rotation;
use crate::base::vector::norm;
use crate::dynamics::trajectory::Sample;
use crate::elements::body::Body;

/// Displacements (m) without the motion of the body as a whole: relative to a frame that moves and turns with
/// it.
pub(super) fn without_turn(body: &Body, u: &[f64]) -> Vec<f64> {
    let (d, positions) = (body.dimension(), body.mesh().positions());
    let now: Vec<f64> = positions.iter().zip(u).map(|(x, u)| x + u).collect();
    let (natural, now) = (arms(positions, d), arms(&now, d));
    // the rotation that brings the natural shape nearest to the present one
    let product: Matrix3<f64> = now.iter().zip(&natural).map(|(y, x)| y * x.transpose()).sum();
    let turn = if d > 1 { nearest_rotation(product) } else { Matrix3::identity() };
    let left = now.iter().zip(&natural).map(|(y, x)| turn.transpose() * y - x);
    left.flat_map(|u| u.as_slice()[..d].to_vec()).collect()
}

/// Velocities (m/s) without the mean velocity and the spin of the body as a whole.
pub(super) fn without_spin(body: &Body, u: &[f64], v: &[f64]) -> Vec<f64> {
    let d = body.dimension();
    let now: Vec<f64> = body.mesh().positions().iter().zip(u).map(|(x, u)| x + u).collect();
    let (now, v) = (arms(&now, d), arms(v, d));
    let spin: Vector3<f64> = now.iter().zip(&v).map(|(x, v)| x.cross(v)).sum();
    let inertia: Matrix3<f64> =
        now.iter().map(|x| Matrix3::identity() * x.norm_squared() - x * x.transpose()).sum();
    // a straight string has no spin about its own axis
    let spin = inertia.try_inverse().map_or(Vector3::zeros(), |inverse| inverse * spin);
    let left = now.iter().zip(&v).map(|(x, v)| v - spin.cross(x));
    left.flat_map(|v| v.as_slice()[..d].to_vec()).collect()
}

/// Vectors of nodes relative to their mean; components beyond the dimension are 0.
fn arms(x: &[f64], dimension: usize) -> Vec<Vector3<f64>> {
    let vector = |x: &[f64]| Vector3::from_fn(|i, _| x.get(i).copied().unwrap_or(0.0));
    let x: Vec<Vector3<f64>> = x.chunks_exact(dimension).map(vector).collect();
    let mean = x.iter().sum::<Vector3<f64>>() / x.len() as f64;
    x.into_iter().map(|x| x - mean).collect()
}

/// Largest distance (m) of a node from its place in the first sample.
pub(super) fn travel(body: &Body, samples: &[&Sample]) -> f64 {
    let way = |sample: &&Sample| {
        let way: Vec<f64> =
            sample.u.iter().zip(&samples[0].u).map(|(u, first)| u - first).collect();
        way.chunks_exact(body.dimension()).map(norm).fold(0.0, f64::max)
    };
    samples.iter().map(way).fold(0.0, f64::max)
}

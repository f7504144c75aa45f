//! Deviation of a motion from that of rigid bodies.

use nalgebra::Vector3;

use super::quantity::Seen;
use crate::base::rotation::nearest_rotation;

/// Deviation of the displacements of nodes that were `seen`, with undeformed `positions` (m), from the nearest ones
/// that keep the shape of each piece: root mean square over nodes and times, relative to the scale. `pieces` has the number of
/// the piece of each node.
///
/// At each time it is the least that any rigid motion can have. Below three dimensions rotations may turn shapes over, through
/// space, so that it may be less than that of rigid motions, and never more.
pub(crate) fn distance_from_rigid(seen: &Seen, positions: &[f64], pieces: &[usize]) -> f64 {
    let d = seen.dimension;
    let count = pieces.iter().max().map_or(0, |last| last + 1);
    let mut nodes = vec![Vec::new(); count];
    pieces.iter().enumerate().for_each(|(node, piece)| nodes[*piece].push(node));
    let vector =
        |x: &[f64], node: usize| Vector3::from_fn(|i, _| if i < d { x[node * d + i] } else { 0.0 });
    let mut sum = 0.0;
    for u in &seen.values {
        for nodes in &nodes {
            let count = nodes.len().max(1) as f64;
            let mean =
                |x: &[f64]| nodes.iter().map(|node| vector(x, *node)).sum::<Vector3<f64>>() / count;
            let [middle, moved] = [positions, u].map(mean);
            let pair = |node: &usize| {
                let arm = vector(positions, *node) - middle;
                (arm, arm + vector(u, *node) - moved)
            };
            let turn =
                nearest_rotation(nodes.iter().map(pair).map(|(x, y)| y * x.transpose()).sum());
            sum += nodes.iter().map(pair).map(|(x, y)| (turn * x - y).norm_squared()).sum::<f64>();
        }
    }
    let all = (seen.values.len() * pieces.len()).max(1) as f64;
    (sum / all).sqrt() / seen.scale
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Displacements of the corners of a square, at two times.
    fn seen(dimension: usize, values: Vec<Vec<f64>>) -> Seen {
        Seen { dimension, values, scale: 0.5 }
    }

    #[test]
    fn what_turns_is_rigid_and_what_stretches_is_not() {
        let positions = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
        let at = |map: &dyn Fn(f64, f64) -> [f64; 2]| -> Vec<f64> {
            let moved = positions.chunks(2).flat_map(|x| {
                let [a, b] = map(x[0], x[1]);
                [a - x[0], b - x[1]]
            });
            moved.collect()
        };
        let (sin, cos) = 2.5_f64.sin_cos();
        let turned = at(&|x, y| [3.0 + cos * x - sin * y, sin * x + cos * y - 1.0]);
        let pieces = [0; 4];
        let distance = |u: Vec<Vec<f64>>, pieces: &[usize]| {
            distance_from_rigid(&seen(2, u), &positions, pieces)
        };
        assert!(distance(vec![turned.clone()], &pieces) < 1e-14);
        // stretched by 2 e along x: each corner is e off
        let e = 0.01;
        let stretched = at(&|x, y| [(1.0 + 2.0 * e) * x, y]);
        assert!((distance(vec![stretched.clone()], &pieces) - e / 0.5).abs() < 1e-12);
        // half of the time
        let half = distance(vec![turned, stretched.clone()], &pieces);
        assert!((half - e / 0.5 / 2.0_f64.sqrt()).abs() < 1e-12);
        // sides that are pieces of their own move as rigid ones
        assert!(distance(vec![stretched], &[0, 1, 1, 0]) < 1e-14);
    }

    #[test]
    fn mirror_images_are_no_rotations_in_space() {
        let positions: Vec<f64> =
            [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]].concat();
        let mirrored: Vec<f64> =
            positions.chunks(3).flat_map(|x| [-2.0 * x[0], 0.0, 0.0]).collect();
        let off = distance_from_rigid(&seen(3, vec![mirrored]), &positions, &[0; 4]);
        assert!(off > 0.3, "{off}");
    }
}

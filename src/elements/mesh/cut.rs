//! Cuts of meshes by planes.

use std::collections::HashMap;

use super::Mesh;

/// Cut of a mesh across an axis: convex polygons (segments in the plane) between points on edges of cells.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cut {
    /// Coordinates across the axis (m); polygons share those on common edges of their cells.
    pub(crate) points: Vec<[f64; 2]>,
    /// Numbers of the corners (from 0), counter-clockwise.
    pub(crate) polygons: Vec<Vec<usize>>,
}

impl Mesh {
    /// The cut at a distance `at` (m) along an axis, between nodes; edges count as straight. `along` gives the distance of a
    /// position along the axis and its two coordinates across it (m).
    pub(crate) fn cut(&self, at: f64, along: impl Fn(&[f64]) -> [f64; 3]) -> Cut {
        let places: Vec<[f64; 3]> =
            (0..self.node_count()).map(|node| along(self.position(node))).collect();
        let (mut numbers, mut points) = (HashMap::new(), Vec::new());
        let mut polygons = Vec::new();
        for (kind, cell) in self.cells_with_kinds() {
            let mut polygon = Vec::new();
            for edge in kind.edges() {
                let ends = [cell[edge[0]], cell[edge[1]]];
                let [a, b] = [ends[0].min(ends[1]), ends[0].max(ends[1])].map(|end| places[end]);
                if (a[0] < at) == (b[0] < at) {
                    continue;
                }
                let share = (at - a[0]) / (b[0] - a[0]);
                let key = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                polygon.push(*numbers.entry(key).or_insert_with(|| {
                    points.push([1, 2].map(|i| a[i] + share * (b[i] - a[i])));
                    points.len() - 1
                }));
            }
            if !polygon.is_empty() {
                turn_around(&points, &mut polygon);
                polygons.push(polygon);
            }
        }
        Cut { points, polygons }
    }
}

/// Sorts the corners of a convex polygon by their angles about its middle.
fn turn_around(points: &[[f64; 2]], polygon: &mut [usize]) {
    let count = polygon.len() as f64;
    let middle = [0, 1].map(|i| polygon.iter().map(|&k| points[k][i]).sum::<f64>() / count);
    let angle = |k: usize| (points[k][1] - middle[1]).atan2(points[k][0] - middle[0]);
    polygon.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
}

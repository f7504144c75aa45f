//! Surfaces as programs write them: corners that differ by round-off, triangles without an area, corners on the sides of others.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::base::grid::Grid;
use crate::base::input::InputError;
use crate::base::vector::distinct;
use crate::elements::mesh::{CellKind, Mesh};

/// Numbers of points by the box of a grid that they are in.
type Places = BTreeMap<[i64; 3], Vec<usize>>;

/// Corners that are nearer to each other than this fraction of the largest coordinate are one: round-off of numbers of 4 bytes, of
/// which binary STL files consist.
const SAME: f64 = 4.0 * f32::EPSILON as f64;
/// Rounds in which triangles are divided: one for each of their sides, and a few for the rest.
const MOST_ROUNDS: usize = 8;

/// The mesh of triangles, by their `corners`, whose corners at the same place are one node; without triangles that have no area, and
/// divided at nodes on open sides.
pub(super) fn mended(corners: &[[f64; 3]]) -> Result<Mesh, InputError> {
    let largest = corners.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let same = SAME * largest;
    let (positions, nodes) = joined(corners, same);
    let mut triangles = nodes.as_chunks::<3>().0.to_vec();
    let all = triangles.len();
    triangles.retain(|triangle| !is_flat(triangle.map(|node| positions[node]), same));
    let left_out = all - triangles.len();
    let mut divided = 0;
    for _ in 0..MOST_ROUNDS {
        match divide(&positions, &mut triangles, same) {
            0 => break,
            count => divided += count,
        }
    }
    // nodes of omitted triangles may belong to no other one
    let mut numbers = vec![None; positions.len()];
    let mut kept = Vec::new();
    for node in triangles.iter_mut().flatten() {
        *node = *numbers[*node].get_or_insert_with(|| {
            kept.extend(positions[*node]);
            kept.len() / 3 - 1
        });
    }
    let mut mesh = Mesh::new(3, kept, CellKind::Triangle, triangles.concat())?;
    if left_out > 0 {
        mesh.notes.push(format!("{left_out} triangle(s) without an area are left out"));
    }
    if divided > 0 {
        mesh.notes
            .push(format!("{divided} triangle(s) are divided at corners of others on their sides"));
    }
    Ok(mesh)
}

/// The places of `corners`, those nearer to each other than `same` (m) once, and the number of the place of each corner.
fn joined(corners: &[[f64; 3]], same: f64) -> (Vec<[f64; 3]>, Vec<usize>) {
    let (mut positions, mut places): (Vec<[f64; 3]>, Places) = (Vec::new(), BTreeMap::new());
    let size = 4.0 * same.max(f64::MIN_POSITIVE);
    let number = |corner: &[f64; 3]| {
        let home = corner.map(|x| (x / size).floor() as i64);
        // the boxes in which a place as near as that may be
        let [low, high] = [-same, same].map(|by| corner.map(|x| ((x + by) / size).floor() as i64));
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                for k in low[2]..=high[2] {
                    let near = places.get(&[i, j, k]).into_iter().flatten();
                    let is_same = |node: &&usize| {
                        (Vector3::from(positions[**node]) - Vector3::from(*corner)).norm() <= same
                    };
                    if let Some(&node) = near.into_iter().find(is_same) {
                        return node;
                    }
                }
            }
        }
        places.entry(home).or_default().push(positions.len());
        positions.push(*corner);
        positions.len() - 1
    };
    let nodes = corners.iter().map(number).collect();
    (positions, nodes)
}

/// Whether a triangle has no area, but for round-off.
fn is_flat(corners: [[f64; 3]; 3], same: f64) -> bool {
    let [a, b, c] = corners.map(Vector3::from);
    let longest = [b - a, c - b, a - c].map(|side| side.norm()).into_iter().fold(0.0, f64::max);
    (b - a).cross(&(c - a)).norm() <= same * longest
}

/// Divides triangles with a side that no other one has at the nodes on it that belong to such sides, too, and returns how many.
fn divide(positions: &[[f64; 3]], triangles: &mut Vec<[usize; 3]>, same: f64) -> usize {
    // how many triangles have each side
    let mut counts: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    let side = |triangle: &[usize; 3], k: usize| [triangle[k], triangle[(k + 1) % 3]];
    let key = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
    for triangle in triangles.iter() {
        (0..3).for_each(|k| *counts.entry(key(side(triangle, k))).or_insert(0) += 1);
    }
    let is_open = |ends: [usize; 2]| counts[&key(ends)] == 1;
    let open = counts.iter().filter(|(_, count)| **count == 1).flat_map(|(ends, _)| *ends);
    let open = distinct(open);
    if open.is_empty() {
        return 0;
    }
    let places: Vec<[f64; 3]> = open.iter().map(|&node| positions[node]).collect();
    let grid = Grid::new(&places);
    let (mut parts, mut divided) = (Vec::new(), 0);
    for triangle in triangles.iter_mut() {
        for k in 0..3 {
            let ends = side(triangle, k);
            if !is_open(ends) {
                continue;
            }
            let [a, b] = ends.map(|node| Vector3::from(positions[node]));
            let along = b - a;
            let bounds = [a.inf(&b).add_scalar(-same), a.sup(&b).add_scalar(same)];
            let mut on = Vec::new();
            grid.each_within(&bounds.map(Into::into), |place| {
                let x = Vector3::from(places[place]) - a;
                let part = x.dot(&along) / along.norm_squared();
                let away = (x - part * along).norm();
                if !triangle.contains(&open[place]) && part > 0.0 && part < 1.0 && away <= same {
                    on.push((part, open[place]));
                }
            });
            if on.is_empty() {
                continue;
            }
            on.sort_by(|(a, _), (b, _)| a.total_cmp(b));
            let far = triangle[(k + 2) % 3];
            let stops = on.into_iter().map(|(_, node)| node).chain([ends[1]]);
            let mut from = ends[0];
            for (number, to) in stops.enumerate() {
                match number {
                    0 => *triangle = [from, to, far],
                    _ => parts.push([from, to, far]),
                }
                from = to;
            }
            divided += 1;
            break; // its other sides come in the next round
        }
    }
    triangles.extend(parts);
    divided
}

//! Magnetized elements of rods: moments that rotate and stretch with their sections, as those of cells do with F.
//!
//! Half of the volume of an element belongs to each of its ends. With the directors d_k = (p_k - x)/a_k there, and the mean m of the axes of both ends across
//! their sections, the remanence b = sum b_k d_k + b_3 r_3 has the moment
//!
//! ```text
//! V/(2 mu_0) sum over ends (sum b_k (p_k - x)/a_k + b_3 (x_2 - x_1)/l),
//! ```
//!
//! which is linear in the positions of the nodes, as that of cells is: one point with poles, in the middle of the element.

use super::magnetized_points::{Magnetized, MagnetizedCell, MagnetizedPoint, MagnetizedPoints};
use super::magnets::{Magnets, VACUUM};
use crate::base::sparse::NodePattern;
use crate::base::vector::{cross, difference, dot, norm, padded};
use crate::elements::mesh::Mesh;
use crate::elements::rod::RodElements;

/// Nodes of an element with their poles (A m) and their shares in the place of its moment.
type Poles = Vec<(usize, f64, f64)>;

/// Those of element `number` of a rod with a `remanence` (T) and a `density` (kg/m^3), on nodes of `mesh`.
fn poles(rod: &RodElements, number: usize, remanence: &[f64], density: f64, mesh: &Mesh) -> Poles {
    let (ends, volume) = (rod.spokes(number), rod.mass(number) / density);
    let b = padded(remanence);
    let at = |node: usize| padded(mesh.position(node));
    let axis = difference(&at(ends[1].0), &at(ends[0].0));
    let half = 0.5 * volume / VACUUM;
    let (mut all, mut along): (Poles, f64) = (Vec::new(), 0.0);
    for (node, spokes) in &ends {
        let mut of_centre = 0.0;
        let directors = (0..spokes.count)
            .map(|k| difference(&at(spokes.nodes[k]), &at(*node)).map(|x| x / spokes.arms[k]));
        let directors: Vec<[f64; 3]> = directors.collect();
        for (k, director) in directors.iter().enumerate() {
            let pole = half * dot(&b, director) / spokes.arms[k];
            all.push((spokes.nodes[k], pole, 0.0));
            of_centre -= pole;
        }
        let second = directors.get(1).copied().unwrap_or([0.0, 0.0, 1.0]);
        along += half * dot(&b, &cross(&directors[0], &second)) / norm(&axis);
        all.push((*node, of_centre, 0.5));
    }
    // the axis points from its first end to its second one
    for ((node, _), sign) in ends.iter().zip([-1.0, 1.0]) {
        all.iter_mut().filter(|own| own.0 == *node).for_each(|own| own.1 += sign * along);
    }
    all
}

/// Adds the contributions of a `remanence` (T) in some elements of a rod.
pub(super) fn add_magnets(
    (rod, elements): (&RodElements, &[usize]),
    (remanence, density): (&[f64], f64),
    mesh: &Mesh,
    magnets: &mut Magnets,
) {
    for &number in elements {
        let all = poles(rod, number, remanence, density, mesh);
        for &(node, pole, share) in &all {
            magnets.poles[node] += pole;
            for &(other, of_other, others) in &all {
                magnets.products.add(node, other, pole * others + share * of_other);
            }
        }
    }
}

/// The points of some elements of a rod, whose cells begin at number `first`.
pub(super) fn points(
    (rod, elements, first): (&RodElements, &[usize], usize),
    (remanence, density): (&[f64], f64),
    mesh: &Mesh,
    pattern: &NodePattern,
) -> Box<dyn MagnetizedPoints> {
    let all = |number: usize| poles(rod, number, remanence, density, mesh);
    let numbers = elements.iter().map(|&number| (first + number, all(number)));
    match mesh.dimension() {
        2 => Box::new(of::<4, 2>(numbers, mesh, pattern)),
        _ => Box::new(of::<6, 3>(numbers, mesh, pattern)),
    }
}

fn of<const N: usize, const D: usize>(
    elements: impl Iterator<Item = (usize, Poles)>,
    mesh: &Mesh,
    pattern: &NodePattern,
) -> Magnetized<N, D, 1> {
    let mut values = [0.0; N];
    let mut cells = Vec::new();
    for (number, all) in elements {
        let nodes: [usize; N] = std::array::from_fn(|a| all[a].0);
        values = std::array::from_fn(|a| all[a].2);
        let poles = std::array::from_fn(|a| all[a].1);
        let sum = |weights: &[f64; N]| -> [f64; D] {
            let along = |a: usize, i: usize| weights[a] * mesh.position(nodes[a])[i];
            std::array::from_fn(|i| (0..N).map(|a| along(a, i)).sum())
        };
        let centres: Vec<usize> = all.iter().filter(|own| own.2 > 0.0).map(|own| own.0).collect();
        let [first, second] = [0, 1].map(|end| padded(mesh.position(centres[end])));
        // all nodes of an element are coupled
        let entry =
            |a: usize, b: usize| pattern.find(nodes[a], nodes[b]).map_or(0, |entry| entry as u32);
        cells.push(MagnetizedCell {
            number,
            nodes,
            entries: std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b))),
            points: [MagnetizedPoint { poles, place: sum(&values), moment: sum(&poles) }],
            reach: 2.0 * norm(&difference(&second, &first)),
        });
    }
    Magnetized { cells, values: [values] }
}

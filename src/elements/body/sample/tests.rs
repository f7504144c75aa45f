use std::sync::Arc;

use super::*;
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{dot, largest};
use crate::elements::body::Dilatation;
use crate::elements::body::tests::noise;
use crate::elements::material::{Law, Material};
use crate::elements::mesh::{Cells, SolidCells};
use crate::studies::samples::SQUARE_MATERIAL;

/// Bodies of two regions with several kinds of cells, laws and projections of the dilatation, and two that are joined.
fn bodies() -> Vec<(&'static str, Body)> {
    let material = Material { viscosity: 30.0, ..SQUARE_MATERIAL };
    let stiff = Material { young: 3e6, ..material };
    let body = |name: &'static str, mesh: Result<Mesh, _>, dilatation, is_rubber: bool| {
        let of = |material: Material| match is_rubber {
            true => material.law(Law::NeoHookean),
            false => material.into(),
        };
        let body = Body::new(mesh.unwrap(), of(material)).dilatation(dilatation);
        let body = if name.ends_with("2D") { body.thickness(0.01) } else { body };
        let cells = crate::CellSelection::Numbers((5..=11).collect());
        (name, body.region(cells, of(stiff)).build().unwrap())
    };
    let plane = |cells| Mesh::rectangle([1.0, 0.5], [8, 5], cells);
    let solid = |nodes, cells| Mesh::cuboid([1.0, 0.5, 0.5], nodes, cells);
    let mut all = vec![
        body("triangles 2D", plane(Cells::Triangles), Dilatation::AtPoints, false),
        body("rectangles 2D", plane(Cells::Rectangles), Dilatation::Mean, true),
        body("rectangles of 9 nodes 2D", plane(Cells::Rectangles9), Dilatation::Linear, false),
        body("tetrahedra", solid([4, 3, 3], SolidCells::Tetrahedra), Dilatation::AtPoints, true),
        body("hexahedra", solid([5, 3, 3], SolidCells::Hexahedra), Dilatation::Mean, false),
        body(
            "hexahedra of 20",
            solid([5, 3, 3], SolidCells::Hexahedra20),
            Dilatation::Linear,
            true,
        ),
    ];
    let joined = [all[0].1.clone(), all[1].1.clone()];
    all.push(("joined 2D", Body::join(joined).unwrap()));
    all
}

fn pattern(body: &Body, cells: impl Iterator<Item = usize>) -> Arc<NodePattern> {
    let pairs = body.cell_pairs(cells);
    NodePattern::new(body.mesh().node_count(), pairs.iter().map(|pair| &pair[..])).into()
}

/// Displacements and velocities under which no cell is inverted.
fn state(body: &Body) -> [Vec<f64>; 2] {
    [noise(body.dofs(), 0.01, 1.0), noise(body.dofs(), 1.0, 7.0)]
}

/// Forces, stiffness and damping on a pattern.
struct Found {
    forces: [Vec<f64>; 2],
    energy: f64,
    matrices: [BlockMatrix; 2],
}

fn found(
    force: &dyn Force,
    body: &Body,
    pattern: &Arc<NodePattern>,
    [u, v]: &[Vec<f64>; 2],
) -> Found {
    let mut forces = NodalForces::zeros(body.dofs());
    force.add_forces(0.0, u, v, &mut forces).unwrap();
    let zeros = BlockMatrix::zeros(pattern, body.dimension());
    let mut matrices = [zeros.clone(), zeros];
    let [stiffness, damping] = &mut matrices;
    force.add_tangents(0.0, u, v, stiffness, damping);
    Found {
        forces: [forces.conservative.to_vec(), forces.dissipative.to_vec()],
        energy: force.potential(0.0, u),
        matrices,
    }
}

/// Largest difference, relative to the largest number.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&off) / largest(b)
}

#[test]
fn all_cells_with_weight_1_are_the_force_itself() {
    for (name, body) in bodies() {
        let (own, at) = (body.inertia().pattern(), state(&body));
        let cells = 0..body.mesh().cell_count();
        let pattern = pattern(&body, cells.clone());
        let weights = cells.map(|cell| (cell, 1.0)).collect();
        let elastic = body.elastic().unwrap();
        let sample = elastic.sampled(&weights, &pattern);
        let whole = found(&elastic, &body, own, &at);
        let sampled = found(&sample, &body, &pattern, &at);
        assert!(elastic.nodes().is_none());
        let nodes = sample.nodes().unwrap();
        assert!(nodes.into_iter().eq(0..body.mesh().node_count()), "{name}");
        // the same sums in the same order
        assert!(whole.forces == sampled.forces && whole.energy == sampled.energy, "{name}");
        for (a, b) in whole.matrices.iter().zip(&sampled.matrices) {
            assert!(largest(&a.values) > 0.0 && a.values == b.values, "{name}: tangents");
        }
    }
}

/// Some cells of each body with weights from 0.5 on.
fn some(body: &Body) -> BTreeMap<usize, f64> {
    let cells = (0..body.mesh().cell_count()).filter(|cell| cell * 7 % 5 < 2);
    cells.map(|cell| (cell, 0.5 + (cell % 4) as f64)).collect()
}

/// A sample is the sum of samples of single cells times their weights, in forces, energy and tangents; these depend on
/// its nodes alone.
#[test]
fn weights_multiply_cells() {
    for (name, body) in bodies() {
        let (at, weights) = (state(&body), some(&body));
        let pattern = pattern(&body, weights.keys().copied());
        let of = |weights: &BTreeMap<usize, f64>| {
            found(&body.elastic().unwrap().sampled(weights, &pattern), &body, &pattern, &at)
        };
        let all = of(&weights);
        let mut sum = of(&BTreeMap::new());
        let add = |sum: &mut [f64], weight: f64, x: &[f64]| {
            sum.iter_mut().zip(x).for_each(|(sum, x)| *sum += weight * x);
        };
        for (&cell, &weight) in &weights {
            let own = of(&BTreeMap::from([(cell, 1.0)]));
            sum.energy += weight * own.energy;
            for k in 0..2 {
                add(&mut sum.forces[k], weight, &own.forces[k]);
                add(&mut sum.matrices[k].values, weight, &own.matrices[k].values);
            }
        }
        // round-off
        assert!((all.energy / sum.energy - 1.0).abs() < 1e-14, "{name}: energy");
        for k in 0..2 {
            assert!(apart(&all.forces[k], &sum.forces[k]) < 1e-14, "{name}: forces {k}");
            let off = apart(&all.matrices[k].values, &sum.matrices[k].values);
            assert!(off < 1e-14, "{name}: tangents {k} {off:e}");
        }
    }
}

#[test]
fn a_sample_has_a_potential_and_tangents() {
    for (name, body) in bodies() {
        let ([u, v], weights) = (state(&body), some(&body));
        let pattern = pattern(&body, weights.keys().copied());
        let sample = body.elastic().unwrap().sampled(&weights, &pattern);
        let (along, h) = (noise(body.dofs(), 1.0, 3.0), 1e-6);
        let moved = |by: f64| u.iter().zip(&along).map(|(u, x)| u + by * x).collect::<Vec<_>>();
        let at = |u: Vec<f64>| found(&sample, &body, &pattern, &[u, v.clone()]);
        let (here, [ahead, behind]) = (at(u.clone()), [h, -h].map(|by| at(moved(by))));
        let slope = (ahead.energy - behind.energy) / (2.0 * h);
        let work = dot(&here.forces[0], &along);
        // round-off of 1e-16 of an energy whose slopes are of its size, over h, and less in the forces
        assert!((slope / work + 1.0).abs() < 2e-8, "{name}: {slope}, {work}");
        let mut product = vec![0.0; body.dofs()];
        here.matrices[0].add_product(1.0, &along, &mut product);
        let total = |at: &Found, i: usize| at.forces[0][i] + at.forces[1][i];
        let by_u: Vec<f64> =
            (0..body.dofs()).map(|i| (total(&behind, i) - total(&ahead, i)) / (2.0 * h)).collect();
        let off = apart(&product, &by_u);
        assert!(off < 3e-9, "{name}: tangents {off:e}");
    }
}

#[test]
fn the_work_of_cells_adds_up() {
    for (name, body) in bodies() {
        let [u, v] = state(&body);
        let elastic = body.elastic().unwrap();
        let shapes: Vec<Vec<f64>> = (0..3).map(|k| noise(body.dofs(), 1.0, k as f64)).collect();
        let by_cell = elastic.by_cell(body.mesh());
        let work = by_cell.work(&u, &v, &shapes).unwrap();
        assert_eq!(work.shape(), (3, body.mesh().cell_count()));
        let mut forces = NodalForces::zeros(body.dofs());
        elastic.add_forces(0.0, &u, &v, &mut forces).unwrap();
        let mut total = vec![0.0; body.dofs()];
        forces.add_up(&mut total);
        for (k, shape) in shapes.iter().enumerate() {
            let (sum, expected) =
                ((0..work.ncols()).map(|e| work[(k, e)]).sum::<f64>(), dot(shape, &total));
            let size: f64 = (0..work.ncols()).map(|e| work[(k, e)].abs()).sum();
            // round-off
            assert!((sum - expected).abs() < 1e-15 * size, "{name}: {sum}, {expected}");
        }
        // each cell by itself
        for cell in [0, 8] {
            let only =
                elastic.of_cells(&BTreeMap::from([(cell, 1.0)]), None, body.mesh().node_count());
            forces.clear();
            only.add_forces(0.0, &u, &v, &mut forces).unwrap();
            forces.add_up(&mut total);
            for (k, shape) in shapes.iter().enumerate() {
                let expected = dot(shape, &total);
                // round-off of sums in which numbers cancel
                assert!((work[(k, cell)] / expected - 1.0).abs() < 3e-13, "{name}: cell {cell}");
            }
        }
    }
}

/// Messages name cells by their numbers in the body.
#[test]
fn an_inverted_cell_is_named() {
    let (_, body) = bodies().swap_remove(3);
    let weights = BTreeMap::from([(4, 1.0), (20, 2.0)]);
    let pattern = pattern(&body, weights.keys().copied());
    let sample = body.elastic().unwrap().sampled(&weights, &pattern);
    let mut u = vec![0.0; body.dofs()];
    let corner = body.mesh().cells().nth(20).unwrap()[0];
    let others = body.mesh().cells().nth(4).unwrap();
    assert!(!others.contains(&corner));
    // through the opposite face
    let cell: Vec<&[f64]> =
        body.mesh().cells().nth(20).unwrap().iter().map(|&n| body.mesh().position(n)).collect();
    for i in 0..3 {
        let opposite = (cell[1][i] + cell[2][i] + cell[3][i]) / 3.0;
        u[3 * corner + i] = 1.5 * (opposite - cell[0][i]);
    }
    let mut forces = NodalForces::zeros(body.dofs());
    let failure = sample.add_forces(0.0, &u, &u, &mut forces).unwrap_err();
    let Failure::Recoverable(message) = failure else { panic!("{failure:?}") };
    assert!(message.starts_with("cell 21 "), "{message}");
}

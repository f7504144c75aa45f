//! Along any shapes, forces and tangents are those of all cells.

use super::*;
use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::base::vector::{dot, largest};
use crate::elements::body::tests::noise;
use crate::elements::body::{Body, Dilatation};
use crate::elements::force::Force;
use crate::elements::material::{Law, Material, Plane, Viscosity};
use crate::elements::mesh::{Cells, Mesh, SolidCells};
use crate::studies::samples::SQUARE_MATERIAL;

const SHAPES: usize = 4;

const MATERIAL: Material = Material { viscosity: 30.0, ..SQUARE_MATERIAL };

/// Bodies of two regions with another ratio of the moduli: in the plane, with and without a viscosity that follows the body, in
/// space, a sheet, and two that are joined.
fn bodies() -> Vec<(&'static str, Body)> {
    let other = Material { young: 3e6, poisson: 0.2, viscosity: 10.0, ..MATERIAL };
    let body = |name: &'static str, mesh: Result<Mesh, _>, viscosity, plane| {
        let mesh: Mesh = mesh.unwrap();
        let flat = mesh.kind().dimension() == 2;
        let body = Body::new(mesh, MATERIAL).viscosity(viscosity);
        let body = if flat { body.thickness(0.01).plane(plane) } else { body };
        let cells = crate::CellSelection::Numbers(vec![2, 3, 6]);
        (name, body.region(cells, other).build().unwrap())
    };
    let plane = |cells| Mesh::rectangle([1.0, 0.5], [4, 3], cells);
    let solid = |cells| Mesh::cuboid([1.0, 0.5, 0.5], [3, 3, 3], cells);
    let sheet = plane(Cells::Triangles).unwrap().mapped(|x| [x[0], x[1], 0.3 * x[0]]);
    let (objective, natural) = (Viscosity::Objective, Viscosity::Natural);
    let mut all = vec![
        body("triangles", plane(Cells::Triangles), objective, Plane::Strain),
        body("triangles of 6 nodes", plane(Cells::Triangles6), natural, Plane::Stress),
        body("hexahedra", solid(SolidCells::Hexahedra), objective, Plane::Strain),
        body("tetrahedra of 10 nodes", solid(SolidCells::Tetrahedra10), natural, Plane::Strain),
        body("a sheet", sheet, objective, Plane::Stress),
    ];
    all.push(("joined", Body::join([all[0].1.clone(), all[1].1.clone()]).unwrap()));
    all
}

#[test]
fn forces_and_tangents_are_those_of_all_cells() {
    for (name, body) in bodies() {
        let elastic = body.elastic().unwrap();
        let n = body.dofs();
        let shapes: Vec<Vec<f64>> = (0..SHAPES).map(|k| noise(n, 1.0, 1.0 + k as f64)).collect();
        let shapes: Vec<&[f64]> = shapes.iter().map(|shape| &shape[..]).collect();
        let origin = noise(n, 0.02, 9.0);
        let [z, rates] = [noise(SHAPES, 0.01, 4.0), noise(SHAPES, 1.0, 5.0)];
        let sum = |start: &[f64], z: &[f64]| {
            let mut sum = start.to_vec();
            for (z, shape) in z.iter().zip(&shapes) {
                sum.iter_mut().zip(*shape).for_each(|(sum, x)| *sum += z * x);
            }
            sum
        };
        let (u, v) = (sum(&origin, &z), sum(&vec![0.0; n], &rates));
        let mut nodal = NodalForces::zeros(n);
        elastic.add_forces(0.0, &u, &v, &mut nodal).unwrap();
        let pairs = body.cell_pairs(0..body.mesh().cell_count());
        let pattern = NodePattern::new(body.mesh().node_count(), pairs.iter().map(|p| &p[..]));
        let zeros = BlockMatrix::zeros(&pattern.into(), body.dimension());
        let mut blocks = [zeros.clone(), zeros];
        let [stiffness, damping] = &mut blocks;
        elastic.add_tangents(0.0, &u, &v, stiffness, damping);

        let mut own = elastic.strain_modes(&origin, &shapes);
        let mut forces = NodalForces::zeros(SHAPES);
        own.add_forces(0.0, [&z, &rates], &mut forces).unwrap();
        let mut matrices = [[0.0; SHAPES * SHAPES]; 2];
        let [stiffness, damping] = &mut matrices;
        own.add_tangents(0.0, [&z, &rates], stiffness, damping);

        let parts = [
            ("elastic", &nodal.conservative, &forces.conservative),
            ("viscous", &nodal.dissipative, &forces.dissipative),
        ];
        for (part, nodal, along) in parts {
            let exact: Vec<f64> = shapes.iter().map(|shape| dot(shape, nodal)).collect();
            assert_near(&exact, along, &format!("{part} force of {name}"));
        }
        for (part, blocks, own) in
            [("stiffness", &blocks[0], &matrices[0]), ("damping", &blocks[1], &matrices[1])]
        {
            let mut exact = Vec::new();
            for row in &shapes {
                for column in &shapes {
                    let mut product = vec![0.0; n];
                    blocks.add_product(1.0, column, &mut product);
                    exact.push(dot(row, &product));
                }
            }
            assert_near(&exact, own, &format!("{part} of {name}"));
        }
    }
}

/// Terms of the size 1 that cancel to a hundredth: some hundred units of round-off.
fn assert_near(exact: &[f64], own: &[f64], what: &str) {
    let off = exact.iter().zip(own).map(|(exact, own)| (exact - own).abs()).fold(0.0, f64::max);
    assert!(off <= 1e-13 * largest(exact), "{what}: {:e}", off / largest(exact));
}

#[test]
fn other_laws_and_more_shapes_than_pay_have_none() {
    let mesh = || Mesh::rectangle([1.0, 0.5], [9, 5], Cells::Triangles6).unwrap();
    let body = Body::new(mesh(), MATERIAL).thickness(0.01).build().unwrap();
    let elastic = body.elastic().unwrap();
    // 64 cells of 3 points with 6 nodes, 4 components of a gradient, twice to get it and once to use it: 13,824
    // multiplications, and 8 times the square of 1 + 7 + 28 and of 1 + 8 + 36 modes
    assert!(elastic.has_strain_modes(7) && !elastic.has_strain_modes(8));
    let rubber = Body::new(mesh(), MATERIAL.law(Law::NeoHookean)).thickness(0.01).build().unwrap();
    assert!(!rubber.elastic().unwrap().has_strain_modes(1));
    let quadrilaterals = Mesh::rectangle([1.0, 0.5], [9, 5], Cells::Rectangles).unwrap();
    let mean = Body::new(quadrilaterals, MATERIAL).thickness(0.01).dilatation(Dilatation::Mean);
    assert!(!mean.build().unwrap().elastic().unwrap().has_strain_modes(1));
}

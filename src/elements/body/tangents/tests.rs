//! Tangents of several cells at once, of many regions, and on wider patterns. That they are derivatives of
//! forces is tested with the forces (`body/tests.rs`).

use std::sync::Arc;

use pulp::{Scalar, WithSimd};

use super::*;
use crate::base::sparse::NodePattern;
use crate::elements::basis::{
    Hexahedron, Hexahedron20, Quadrilateral9, ReferenceCell, Segment, Tetrahedron10, Triangle,
    Triangle6, Triangle7,
};
use crate::elements::body::section::Section;
use crate::elements::body::tests::{bodies, noise};
use crate::elements::body::{Body, CellSelection, Dilatation};
use crate::elements::force::{Force, NodalForces};
use crate::elements::material::{Law, Material, Plane, Strain};
use crate::elements::mesh::{Cells, Mesh, SolidCells};
use crate::studies::samples::SQUARE_MATERIAL;

/// Tangents of some cells of a mesh, which begin and end within a register: the same to the last bit, whether
/// computed one by one or as many at once as the machine can.
fn is_the_same_on_all_machines<
    C: ReferenceCell<N, M>,
    const N: usize,
    const M: usize,
    const D: usize,
    const Q: usize,
>(
    mesh: &Mesh,
    dilatation: Dilatation,
) {
    let pattern = Arc::new(NodePattern::new(mesh.node_count(), mesh.cells()));
    let elements =
        ElementsOf::<N, M, D, Q>::new::<C>(mesh, Section::Uniform(1.0), dilatation, &pattern)
            .unwrap();
    let is_projected = elements.is_projected();
    let dofs = mesh.node_count() * D;
    let (u, v) = (noise(dofs, 0.01, 1.0), noise(dofs, 1.0, 2.0));
    let material = Material { density: 1.0, young: 1.0, poisson: 1.0 / 3.0, viscosity: 3.0 };
    let (lame, plane) = (material.elastic(), Plane::Strain);
    let rubber = Elastic::new(Strain::Green, Some(Law::NeoHookean), lame, M, plane);
    let ObjectiveViscosity::Newtonian(law) = ObjectiveViscosity::new(&rubber, &material, M, plane)
    else {
        panic!("rubber is no Hookean material")
    };
    let cells = 3..mesh.cell_count() - 1;
    let tangents =
        |add: &dyn Fn(Pass<'_, '_, _, N, M, D, Q, 2>, Pass<'_, '_, _, N, M, D, Q, 1>)| {
            let zeros = BlockMatrix::zeros(&pattern, D);
            let (mut by_place, mut by_rate) = (zeros.clone(), zeros);
            let (elements, cells) = (&elements, cells.clone());
            add(
                Pass {
                    elements,
                    rows: &mut by_place.rows_mut(),
                    cells: cells.clone(),
                    fields: [&u, &v],
                    slope: ViscousTangent { law: &law, is_projected },
                },
                Pass {
                    elements,
                    rows: &mut by_rate.rows_mut(),
                    cells,
                    fields: [&u],
                    slope: RateTangent { law: &law, is_projected },
                },
            );
            [by_place.values, by_rate.values]
        };
    let at_once = tangents(&|by_place, by_rate| {
        at_once(by_place);
        at_once(by_rate);
    });
    let one_by_one = tangents(&|by_place, by_rate| {
        by_place.with_simd(Scalar);
        by_rate.with_simd(Scalar);
    });
    assert!(at_once.iter().all(|values| values.iter().any(|value| *value != 0.0)));
    assert_eq!(at_once, one_by_one);
}

#[test]
fn several_cells_at_once() {
    let plane = |cells| Mesh::rectangle([0.3, 0.2], [4, 4], cells).unwrap();
    let solid = |cells| Mesh::cuboid([0.3, 0.2, 0.2], [6, 3, 3], cells).unwrap();
    let (points, linear) = (Dilatation::AtPoints, Dilatation::Linear);
    is_the_same_on_all_machines::<Segment, 2, 1, 1, 1>(&Mesh::bar(1.0, 12).unwrap(), points);
    is_the_same_on_all_machines::<Triangle, 3, 2, 2, 1>(&plane(Cells::Triangles), points);
    is_the_same_on_all_machines::<Triangle6, 6, 2, 2, 3>(&plane(Cells::Triangles6), points);
    let with_bubbles = plane(Cells::Triangles6).with_bubbles().unwrap();
    is_the_same_on_all_machines::<Triangle7, 7, 2, 2, 6>(&with_bubbles, linear);
    is_the_same_on_all_machines::<Quadrilateral9, 9, 2, 2, 9>(&plane(Cells::Rectangles9), linear);
    let hexahedra = solid(SolidCells::Hexahedra);
    is_the_same_on_all_machines::<Hexahedron, 8, 3, 3, 8>(&hexahedra, points);
    is_the_same_on_all_machines::<Hexahedron, 8, 3, 3, 8>(&hexahedra, Dilatation::Mean);
    let hexahedra20 = solid(SolidCells::Hexahedra20);
    is_the_same_on_all_machines::<Hexahedron20, 20, 3, 3, 14>(&hexahedra20, linear);
    let tetrahedra10 = solid(SolidCells::Tetrahedra10);
    is_the_same_on_all_machines::<Tetrahedron10, 10, 3, 3, 4>(&tetrahedra10, points);
}

fn tangents(body: &Body, pattern: &Arc<NodePattern>, u: &[f64], v: &[f64]) -> [BlockMatrix; 2] {
    let zeros = BlockMatrix::zeros(pattern, body.dimension());
    let (mut stiffness, mut damping) = (zeros.clone(), zeros);
    body.elastic().unwrap().add_tangents(0.0, u, v, &mut stiffness, &mut damping);
    [stiffness, damping]
}

/// Cells of another material begin and end anywhere within a register. Along one direction, by central
/// differences: forces are cubic, so that these are off by (1e-6/0.1)^2 of the tangents, and by round-off of
/// 1e-16/1e-6.
#[test]
fn regions_end_within_registers() {
    let (mesh, h) = (Mesh::rectangle([1.0, 0.5], [6, 5], Cells::Triangles).unwrap(), 1e-6);
    let stiff = Material { young: 1e7, viscosity: 900.0, ..SQUARE_MATERIAL };
    let numbers = CellSelection::Numbers(vec![2, 3, 7, 11, 12, 13, 14, 15, 16, 17, 18, 19, 29, 40]);
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).region(numbers, stiff);
    let body = body.build().unwrap();
    let n = body.dofs();
    let (u, v, x) = (noise(n, 0.02, 1.0), noise(n, 2.0, 2.0), noise(n, 1.0, 3.0));
    let [stiffness, damping] = tangents(&body, body.inertia().pattern(), &u, &v);
    let force = |by_u: f64, by_v: f64| {
        let moved = |from: &[f64], by: f64| -> Vec<f64> {
            from.iter().zip(&x).map(|(from, x)| from + by * x).collect()
        };
        let mut forces = NodalForces::zeros(n);
        let (u, v) = (moved(&u, by_u), moved(&v, by_v));
        body.elastic().unwrap().add_forces(0.0, &u, &v, &mut forces).unwrap();
        let both = forces.conservative.iter().zip(forces.dissipative.iter());
        both.map(|(elastic, viscous)| elastic + viscous).collect::<Vec<_>>()
    };
    let pairs =
        [(stiffness, force(-h, 0.0), force(h, 0.0)), (damping, force(0.0, -h), force(0.0, h))];
    for (tangent, behind, ahead) in pairs {
        let mut product = vec![0.0; n];
        tangent.add_product(1.0, &x, &mut product);
        let largest = product.iter().fold(0.0_f64, |largest, f| largest.max(f.abs()));
        for (i, product) in product.iter().enumerate() {
            let apart = ((behind[i] - ahead[i]) / (2.0 * h) - product).abs();
            assert!(apart < 1e-8 * largest, "{i}: {apart:e} of {largest:e}");
        }
    }
}

/// A pattern with more pairs has the same tangents where the body couples nodes, and zeros elsewhere; also if
/// it was widened twice.
#[test]
fn wider_patterns_have_the_same_tangents() {
    let mesh = Mesh::rectangle([1.0, 0.5], [6, 5], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).build().unwrap();
    let n = body.dofs();
    let (u, v) = (noise(n, 0.02, 1.0), noise(n, 2.0, 2.0));
    let own = body.inertia().pattern();
    let wide = own.with_pairs(&[[0, 29], [29, 0], [3, 17], [17, 3]]);
    let wider = wide.with_pairs(&[[1, 28], [28, 1]]);
    let expected = tangents(&body, own, &u, &v);
    for pattern in [wide, wider].map(Arc::new) {
        assert!(pattern.entries() > own.entries());
        for (matrix, expected) in tangents(&body, &pattern, &u, &v).iter().zip(&expected) {
            for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
                assert_eq!(matrix.get(row, column), expected.get(row, column));
            }
        }
    }
}

/// A shift of the whole body changes no force, and no motion the sum of the forces; elastic tangents are
/// symmetric.
#[test]
fn tangents_balance() {
    for (name, body) in bodies(Strain::Green) {
        let (d, n) = (body.dimension(), body.dofs());
        let (u, v) = (noise(n, 0.05, 1.0), noise(n, 2.0, 7.0));
        let still = vec![0.0; n];
        let [stiffness, _] = tangents(&body, body.inertia().pattern(), &u, &v);
        let [elastic, damping] = tangents(&body, body.inertia().pattern(), &u, &still);
        for matrix in [&stiffness, &elastic, &damping] {
            let scale = matrix.values.iter().fold(0.0_f64, |s, k| s.max(k.abs()));
            for (row, axis) in (0..n).flat_map(|row| (0..d).map(move |axis| (row, axis))) {
                let nodes = (axis..n).step_by(d);
                let sum: f64 = nodes.clone().map(|column| matrix.get(row, column)).sum();
                assert!(sum.abs() < 1e-14 * scale, "{name}: row {row} {sum:e}");
                let sum: f64 = nodes.map(|column| matrix.get(column, row)).sum();
                assert!(sum.abs() < 1e-14 * scale, "{name}: column {row} {sum:e}");
            }
        }
        for matrix in [&elastic, &damping] {
            for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
                assert_eq!(matrix.get(row, column), matrix.get(column, row), "{name}");
            }
        }
    }
}

//! One check for the elastic and viscous forces of all cells: force = -dU/du, tangents = -df/du and
//! -df/dv by finite differences, invariance to rigid motions.

use std::sync::Arc;

use super::*;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Force, NodalForces};
use crate::elements::material::Material;
use crate::elements::mesh::{CellKind, Cells, Mesh};
use crate::studies::samples::SQUARE_MATERIAL;

/// Bodies of every kind of cell, in every space they may live in, somewhat irregular.
pub(super) fn bodies(strain: Strain) -> Vec<(String, Body)> {
    bodies_with(strain, Inertia::Consistent)
}

fn bodies_with(strain: Strain, inertia: Inertia) -> Vec<(String, Body)> {
    let square = [0.0, 0.0, 1.0, 0.2, 1.3, 1.1, -0.1, 0.9];
    let wedge = [0.0, 0.0, 1.2, 0.1, 0.2, 1.0, 0.6, 0.1, 0.7, 0.6, 0.1, 0.5];
    let solid = [0.0, 0.0, 0.0, 1.1, 0.1, 0.0, 0.2, 1.0, -0.1, 0.1, 0.2, 1.2];
    let brick: Vec<f64> = (0..8_u8)
        .flat_map(|k| {
            let corner = [(k & 1) ^ (k >> 1 & 1), k >> 1 & 1, k >> 2 & 1].map(f64::from);
            let bump = 0.1 * f64::from(k);
            [corner[0] + bump.sin() * 0.2, corner[1] - bump.cos() * 0.1, corner[2] + bump * 0.1]
        })
        .collect();
    let kinds = [
        (CellKind::Segment, vec![0.0, 1.0, 2.2], vec![0, 1, 1, 2]),
        (CellKind::Triangle, square.to_vec(), vec![0, 1, 2, 0, 2, 3]),
        (CellKind::Triangle6, wedge.to_vec(), (0..6).collect()),
        (
            CellKind::Triangle7,
            with_mid_nodes(CellKind::Triangle7, &wedge[..6], 0.03),
            (0..7).collect(),
        ),
        (CellKind::Quadrilateral, square.to_vec(), (0..4).collect()),
        (
            CellKind::Quadrilateral9,
            with_mid_nodes(CellKind::Quadrilateral9, &square, 0.03),
            (0..9).collect(),
        ),
        (CellKind::Tetrahedron, solid.to_vec(), (0..4).collect()),
        (
            CellKind::Tetrahedron10,
            with_mid_nodes(CellKind::Tetrahedron10, &solid, 0.03),
            (0..10).collect(),
        ),
        (
            CellKind::Tetrahedron15,
            with_mid_nodes(CellKind::Tetrahedron15, &solid, 0.03),
            (0..15).collect(),
        ),
        (
            CellKind::Hexahedron20,
            with_mid_nodes(CellKind::Hexahedron20, &brick, 0.0),
            (0..20).collect(),
        ),
        (
            CellKind::Hexahedron27,
            with_mid_nodes(CellKind::Hexahedron27, &brick, 0.03),
            (0..27).collect(),
        ),
        (CellKind::Hexahedron, brick, (0..8).collect()),
    ];
    let mut bodies = Vec::new();
    for (kind, flat, cells) in kinds {
        let most = if kind.fills_space() { kind.dimension() } else { 3 };
        for dimension in kind.dimension()..=most {
            // lifted into space along skew directions
            let lift = [[0.8, 0.3, -0.5], [-0.2, 0.9, 0.4], [0.1, -0.3, 0.7]];
            let positions: Vec<f64> = flat
                .chunks(kind.dimension())
                .flat_map(|x| {
                    let plain = dimension == kind.dimension();
                    (0..dimension).map(move |i| match plain {
                        true => x[i],
                        false => x.iter().zip(&lift).map(|(x, direction)| x * direction[i]).sum(),
                    })
                })
                .collect();
            let mesh = Mesh::new(dimension, positions, kind, cells.clone()).unwrap();
            let mut builder = Body::new(mesh, SQUARE_MATERIAL).strain(strain).inertia(inertia);
            builder = match kind.dimension() {
                1 => builder.area(1e-4),
                2 => builder.thickness(0.01),
                _ => builder,
            };
            bodies.push((format!("{kind:?} in {dimension}D"), builder.build().unwrap()));
        }
    }
    bodies
}

/// The corners of a cell and the middles of its edges, faces and of itself, off by `bend` or less. (The strain points
/// of bent hexahedra of 20 nodes do not integrate their volumes exactly.)
fn with_mid_nodes(kind: CellKind, corners: &[f64], bend: f64) -> Vec<f64> {
    let (mut positions, d) = (corners.to_vec(), kind.dimension());
    let edges = kind.edges().iter().map(|edge| &edge[..2]);
    for (k, ends) in edges.chain(kind.middles().iter().copied()).enumerate() {
        for i in 0..d {
            let bend = bend * (k as f64 + 2.0 * i as f64).sin();
            let sum: f64 = ends.iter().map(|end| corners[d * end + i]).sum();
            positions.push(sum / ends.len() as f64 + bend);
        }
    }
    positions
}

/// Numbers between -`size` and `size` without a pattern.
pub(super) fn noise(length: usize, size: f64, seed: f64) -> Vec<f64> {
    (0..length)
        .map(|i| size * (12.9898 * (i as f64 + seed)).sin().mul_add(43.758, 0.3).sin())
        .collect()
}

fn forces(body: &Body, u: &[f64], v: &[f64]) -> NodalForces {
    let mut forces = NodalForces::zeros(body.dofs());
    body.elastic().unwrap().add_forces(0.0, u, v, &mut forces).unwrap();
    forces
}

/// The displacements along which a body of `n` of them is moved: all, or every fourth, of all axes in turn, where they are
/// many.
pub(super) fn some_of(n: usize) -> impl Iterator<Item = usize> {
    (0..n).step_by(if n > 40 { 4 } else { 1 })
}

fn moved(x: &[f64], j: usize, by: f64) -> Vec<f64> {
    let mut x = x.to_vec();
    x[j] += by;
    x
}

#[test]
fn forces_and_tangents_are_derivatives() {
    for (name, body) in bodies(Strain::Green) {
        let n = body.dofs();
        let (u, v) = (noise(n, 0.05, 1.0), noise(n, 2.0, 7.0));
        let elastic = body.elastic().unwrap();
        let pattern = body.inertia().pattern();
        let mut stiffness = BlockMatrix::zeros(pattern, body.dimension());
        let mut damping = stiffness.clone();
        elastic.add_tangents(0.0, &u, &v, &mut stiffness, &mut damping);
        let at = forces(&body, &u, &v);
        let scale = body.stiffness().values.iter().fold(0.0_f64, |s, k| s.max(k.abs()));
        // Forces are cubic: central differences are off by (h/L)^2 = 1e-8 with the size L = 0.1 of
        // the smallest cells, and by round-off of 1e-16/h.
        let h = 1e-5;
        for j in some_of(n) {
            let energy = |by: f64| elastic.potential(0.0, &moved(&u, j, by));
            let slope = (energy(h) - energy(-h)) / (2.0 * h);
            assert!((at.conservative[j] + slope).abs() < 1e-7 * scale, "{name}: dU/du {j}");
            let [ahead, behind] = [h, -h].map(|by| forces(&body, &moved(&u, j, by), &v));
            let [faster, slower] = [h, -h].map(|by| forces(&body, &u, &moved(&v, j, by)));
            for i in 0..n {
                let total = |f: &NodalForces| f.conservative[i] + f.dissipative[i];
                let by_u = (total(&behind) - total(&ahead)) / (2.0 * h);
                let by_v = (total(&slower) - total(&faster)) / (2.0 * h);
                let apart = (stiffness.get(i, j) - by_u).abs();
                assert!(apart < 1e-6 * scale, "{name}: -df/du ({i}, {j}) {by_u}");
                let apart = (damping.get(i, j) - by_v).abs();
                assert!(apart < 1e-9 * scale, "{name}: -df/dv ({i}, {j}) {by_v}");
            }
        }
    }
}

/// Rotation about a skew axis (about z in the plane), then translation; and its velocities.
pub(super) fn rigid_motion(body: &Body) -> (Vec<f64>, Vec<f64>) {
    let axis = match body.dimension() {
        3 => nalgebra::Vector3::new(0.3, -0.5, 0.8),
        _ => nalgebra::Vector3::z(),
    };
    let axis = nalgebra::Unit::new_normalize(axis);
    let angle = if body.dimension() == 1 { 0.0 } else { 2.1 };
    let rotation = nalgebra::Rotation3::from_axis_angle(&axis, angle);
    let (mut u, mut v) = (Vec::new(), Vec::new());
    for x in body.mesh().positions().chunks(body.dimension()) {
        let natural = nalgebra::Vector3::from_fn(|i, _| x.get(i).copied().unwrap_or(0.0));
        let turned = rotation * natural;
        let spin = axis.cross(&turned) * if body.dimension() == 1 { 0.0 } else { 5.0 };
        for i in 0..body.dimension() {
            u.push(turned[i] - natural[i] + 0.7);
            v.push(spin[i] - 1.1);
        }
    }
    (u, v)
}

#[test]
pub(super) fn rigid_motions_cost_green_bodies_nothing() {
    for (name, body) in bodies(Strain::Green) {
        let (u, v) = rigid_motion(&body);
        let forces = forces(&body, &u, &v);
        let scale = body.stiffness().get(0, 0);
        for i in 0..body.dofs() {
            // round-off of strains of size 1
            assert!(forces.conservative[i].abs() < 1e-13 * scale, "{name}: elastic force");
            assert!(forces.dissipative[i].abs() < 1e-13 * scale, "{name}: viscous force");
        }
        let energy = body.elastic().unwrap().potential(0.0, &u);
        assert!(energy.abs() < 1e-25 * scale, "{name}: energy {energy:e}");
    }
}

/// In the undeformed shape Green's tangents are the constant matrices of Cauchy's strain.
#[test]
fn at_rest_the_tangents_are_k_and_b() {
    for (name, body) in bodies(Strain::Green) {
        let rest = vec![0.0; body.dofs()];
        let mut stiffness = BlockMatrix::zeros(body.inertia().pattern(), body.dimension());
        let mut damping = stiffness.clone();
        let elastic = body.elastic().unwrap();
        elastic.add_tangents(0.0, &rest, &rest, &mut stiffness, &mut damping);
        for (k, b) in [(&stiffness, body.stiffness()), (&damping, body.damping())] {
            let scale = b.get(0, 0);
            let apart = k.values.iter().zip(&b.values).map(|(k, b)| (k - b).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-13 * scale, "{name}");
        }
    }
}

/// Two ways to compute linear forces: element by element, and by the assembled K.
#[test]
fn elastic_forces_of_cauchy_bodies_are_k_u() {
    for (name, body) in bodies(Strain::Cauchy) {
        let u = noise(body.dofs(), 0.05, 4.0);
        let (mut forces, mut by_k) = (NodalForces::zeros(body.dofs()), vec![0.0; body.dofs()]);
        body.add_elastic_forces(&u, &mut forces).unwrap();
        body.stiffness().add_product(-1.0, &u, &mut by_k);
        let scale = by_k.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
        let apart = by_k.iter().zip(forces.conservative.iter()).map(|(a, b)| (a - b).abs());
        // round-off of the largest force
        assert!(apart.fold(0.0, f64::max) < 1e-13 * scale, "{name}");
    }
}

/// -K u, -B v and the energy of bodies whose linear forces are computed cell by cell, against their matrices.
#[test]
fn linear_forces_by_cells_are_those_of_the_matrices() {
    for (name, body) in bodies(Strain::Cauchy) {
        let Some(cells) = body.linear_by_cells() else { continue };
        let (u, v) = (noise(body.dofs(), 0.05, 4.0), noise(body.dofs(), 2.0, 5.0));
        let mut forces = NodalForces::zeros(body.dofs());
        cells.add_forces(&u, &v, &mut forces).unwrap();
        let (k, b) = (body.stiffness(), body.damping());
        for (matrix, x, forces) in [(k, &u, &forces.conservative), (b, &v, &forces.dissipative)] {
            let mut by_matrix = vec![0.0; body.dofs()];
            matrix.add_product(-1.0, x, &mut by_matrix);
            let scale = by_matrix.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            assert!(scale > 0.0, "{name}");
            let apart = by_matrix.iter().zip(forces.iter()).map(|(a, b)| (a - b).abs());
            // round-off of the largest force
            assert!(apart.fold(0.0, f64::max) < 1e-13 * scale, "{name}");
        }
        let energy = 0.5 * k.quadratic_form(&u);
        assert!((cells.energy(&u) / energy - 1.0).abs() < 1e-13, "{name}");
    }
}

/// Slides, "Calculating based on Cauchy strain": a body turned by theta is strained by
/// cos(theta) - 1 along both axes; its stress is 2 (lambda + mu) (cos theta - 1).
#[test]
fn cauchy_strain_takes_rotation_for_swelling() {
    let mesh = Mesh::rectangle([1.0, 1.0], [3, 3], Cells::Triangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let theta = 0.7_f64;
    let (c, s) = (theta.cos(), theta.sin());
    let u: Vec<f64> = body
        .mesh()
        .positions()
        .chunks(2)
        .flat_map(|x| [(c - 1.0) * x[0] - s * x[1], s * x[0] + (c - 1.0) * x[1]])
        .collect();
    let mut force = vec![0.0; body.dofs()];
    body.stiffness().add_product(1.0, &u, &mut force);
    let lame = SQUARE_MATERIAL.elastic();
    let right = body.mesh().sets()["right"].iter();
    let pull: f64 = right.map(|&node| force[2 * node]).sum();
    let expected = 2.0 * (lame.lambda + lame.mu) * (c - 1.0) * 0.01;
    assert!((pull / expected - 1.0).abs() < 1e-12, "{pull} {expected}");
}

#[test]
fn an_inverted_cell_is_named() {
    let mesh = Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green);
    let elastic = body.build().unwrap().elastic().unwrap();
    // the upper right corner pushed through the diagonal
    let u = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.9, -0.9];
    let result = elastic.add_forces(0.0, &u, &[0.0; 8], &mut NodalForces::zeros(8));
    let Err(crate::integrators::ode::Failure::Recoverable(message)) = result else {
        panic!("{result:?}")
    };
    assert!(message.contains("cell 2 (nodes [4, 3, 2]) is inverted, det F = -0.8"), "{message}");
}

#[test]
fn regions_have_their_own_material() {
    let mesh = Mesh::rectangle([2.0, 1.0], [3, 2], Cells::Triangles).unwrap();
    let heavy = Material { density: 10_000.0, ..SQUARE_MATERIAL };
    let right = CellSelection::inside([1.0, 0.0], [2.0, 1.0]);
    let body = Body::new(mesh.clone(), SQUARE_MATERIAL)
        .strain(Strain::Cauchy)
        .thickness(0.01)
        .region(right, heavy);
    assert!((body.build().unwrap().mass() - (10.0 + 100.0)).abs() < 1e-10);
    let nowhere = CellSelection::inside([5.0, 0.0], [6.0, 1.0]);
    let body = Body::new(mesh, SQUARE_MATERIAL)
        .strain(Strain::Cauchy)
        .thickness(0.01)
        .region(nowhere, heavy)
        .build();
    assert!(body.unwrap_err().to_string().contains("contains no cell"));
}

#[test]
fn a_point_mass_is_a_node_without_cells() {
    let mesh = Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01);
    let body = body.point_mass("hub", [0.5, 0.5], 0.25).build().unwrap();
    assert!((body.mass() - 10.25).abs() < 1e-12);
    assert_eq!(body.mesh().sets()["hub"], [4]);
    assert_eq!(body.inertia().get(4, 4), 0.25);
    assert_eq!(body.stiffness().get(8, 8), 0.0);
    assert!(Arc::ptr_eq(body.inertia().pattern(), body.stiffness().pattern()));
}

/// Lumping keeps the mass of each body and gives every node some: with linear shape functions, the sum of its
/// row of the consistent matrix.
#[test]
fn lumped_inertia_is_diagonal_and_all_there() {
    let both = bodies(Strain::Cauchy).into_iter().zip(bodies_with(Strain::Cauchy, Inertia::Lumped));
    for ((name, consistent), (_, lumped)) in both {
        let mesh = lumped.mesh();
        assert!(lumped.inertia().is_diagonal() && !consistent.inertia().is_diagonal(), "{name}");
        let (masses, of_rows) = (lumped.nodal_masses(), consistent.nodal_masses());
        assert!(masses.iter().all(|mass| *mass > 0.0), "{name}: {masses:?}");
        assert!((lumped.mass() / consistent.mass() - 1.0).abs() < 1e-14, "{name}");
        if !mesh.kind().is_quadratic() {
            let apart = masses.iter().zip(&of_rows).map(|(a, b)| (a / b - 1.0).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-14, "{name}: {masses:?} {of_rows:?}");
        }
    }
}

/// Forces and tangents of a mesh that is shared out among threads: the same to the last bit on one
/// thread and on several; forces those of the direct computation, tangents their derivatives.
#[test]
fn threads_share_out_large_meshes() {
    let mesh = Mesh::rectangle([1.0, 0.5], [130, 65], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green);
    let body = body.build().unwrap();
    let (u, v) = (noise(body.dofs(), 1e-4, 1.0), noise(body.dofs(), 0.1, 2.0));
    let tangents = |u: &[f64], v: &[f64]| {
        let zeros = BlockMatrix::zeros(body.inertia().pattern(), 2);
        let (mut stiffness, mut damping) = (zeros.clone(), zeros);
        body.elastic().unwrap().add_tangents(0.0, u, v, &mut stiffness, &mut damping);
        (stiffness, damping)
    };
    let on_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (forces(&body, &u, &v), tangents(&u, &v)))
    };
    let (one, (stiffness, damping)) = on_threads(1);
    let (three, (stiffness_of_three, damping_of_three)) = on_threads(3);
    assert_eq!(one.conservative[..], three.conservative[..]);
    assert_eq!(one.dissipative[..], three.dissipative[..]);
    assert_eq!(stiffness.values, stiffness_of_three.values);
    assert_eq!(damping.values, damping_of_three.values);

    // along one direction, by central differences: third derivatives times 1e-14
    let (x, h) = (noise(body.dofs(), 1.0, 3.0), 1e-7);
    let shifted = |u: &[f64], h: f64| u.iter().zip(&x).map(|(u, x)| u + h * x).collect::<Vec<_>>();
    let at = |h: f64| forces(&body, &shifted(&u, h), &v).conservative.to_vec();
    let mut product = vec![0.0; body.dofs()];
    let (elastic_only, _) = tangents(&u, &vec![0.0; body.dofs()]);
    elastic_only.add_product(-1.0, &x, &mut product);
    let largest = product.iter().fold(0.0, |largest: f64, f| largest.max(f.abs()));
    let slopes = at(h).into_iter().zip(at(-h)).map(|(ahead, behind)| (ahead - behind) / (2.0 * h));
    let apart = slopes.zip(&product).map(|(a, b)| (a - b).abs());
    assert!(apart.fold(0.0, f64::max) < 1e-6 * largest);
}

/// A point mass comes after the nodes that are shared out in equal parts.
#[test]
fn a_point_mass_has_a_share() {
    let mesh = Mesh::rectangle([1.0, 1.0], [64, 64], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green);
    let body = body.point_mass("hub", [0.5, 0.5], 0.25).build().unwrap();
    let (u, v) = (noise(body.dofs(), 1e-4, 1.0), noise(body.dofs(), 0.1, 2.0));
    let at = forces(&body, &u, &v);
    assert_eq!(at.conservative[2 * 4096..], [0.0; 2]);
    assert!(at.conservative[..2 * 4096].iter().all(|force| *force != 0.0));
}

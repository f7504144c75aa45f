//! Along any shapes, the force of a chamber and its derivatives are those of its walls.

use super::super::Chamber;
use super::*;
use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::base::vector::noise;
use crate::elements::body::Body;
use crate::elements::force::Force;
use crate::elements::mesh::{CellKind, Mesh};
use crate::studies::samples::SQUARE_MATERIAL;

const SHAPES: usize = 3;

/// The largest number of `own` that is off, relative to the largest of `exact`.
fn off(exact: &[f64], own: &[f64]) -> f64 {
    let off = exact.iter().zip(own).map(|(exact, own)| (exact - own).abs()).fold(0.0, f64::max);
    off / largest(exact)
}

fn check(body: &Body, chamber: &Chamber) {
    let force = chamber.force(body, vec![3.0.into()]).unwrap();
    let n = body.dofs();
    let shapes: Vec<Vec<f64>> = (0..SHAPES).map(|k| noise(n, k)).collect();
    let shapes: Vec<&[f64]> = shapes.iter().map(|shape| &shape[..]).collect();
    let origin: Vec<f64> = noise(n, 7).iter().map(|x| 0.05 * x).collect();
    let z = [0.1, -0.2, 0.05];
    let mut u = origin.clone();
    for (z, shape) in z.iter().zip(&shapes) {
        u.iter_mut().zip(*shape).for_each(|(u, x)| *u += z * x);
    }
    let mut nodal = NodalForces::zeros(n);
    force.add_forces(0.0, &u, &u, &mut nodal).unwrap();
    let couplings = force.couplings();
    let pattern = NodePattern::new(body.mesh().node_count(), couplings.iter().map(|p| &p[..]));
    let mut stiffness = BlockMatrix::zeros(&pattern.into(), body.dimension());
    let mut damping = stiffness.clone();
    force.add_tangents(0.0, &u, &u, &mut stiffness, &mut damping);
    let exact: Vec<f64> = shapes.iter().map(|shape| dot(shape, &nodal.applied)).collect();
    let mut exact_tangent = Vec::new();
    for row in &shapes {
        for column in &shapes {
            let mut product = vec![0.0; n];
            stiffness.add_product(1.0, column, &mut product);
            exact_tangent.push(dot(row, &product));
        }
    }

    let mut own = force.along(&origin, &shapes);
    let mut forces = NodalForces::zeros(SHAPES);
    own.add_forces(0.0, [&z, &z], &mut forces).unwrap();
    let (mut tangent, mut none) = ([0.0; SHAPES * SHAPES], [0.0; SHAPES * SHAPES]);
    own.add_tangents(0.0, [&z, &z], &mut tangent, &mut none);
    // differences of numbers of the same size: some tens of units of round-off
    let [force, tangent] = [off(&exact, &forces.applied), off(&exact_tangent, &tangent)];
    assert!(force < 1e-13 && tangent < 1e-13, "{force:e}, {tangent:e}");
}

#[test]
fn areas_and_volumes_are_polynomials() {
    let plane = Mesh::rectangle([1.0, 0.5], [5, 3], crate::Cells::Triangles6).unwrap();
    let plate = Body::new(plane, SQUARE_MATERIAL).thickness(0.01).build().unwrap();
    let around: Vec<usize> = vec![1, 2, 3, 4, 5, 10, 15, 14, 13, 12, 11, 6];
    check(&plate, &Chamber::within("air", around));
    let corners = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let faces = vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3];
    let balloon = Mesh::new(3, corners, CellKind::Triangle, faces).unwrap();
    let balloon = Body::new(balloon, SQUARE_MATERIAL).thickness(0.01).build().unwrap();
    check(&balloon, &Chamber::within("air", "all"));
}

use super::*;
use crate::elements::body::Strain;
use crate::elements::mesh::{Cells, Mesh};
use crate::studies::samples::SQUARE_MATERIAL;

/// Slope 3:4 through (0, 0.1): half of a 2 x 2 grid of nodes lies inside.
fn contact(adhesion: bool) -> Contact {
    let mesh = Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Triangles).unwrap();
    let slope = Obstacle::half_plane([0.0, 0.1], [-3.0, 4.0]);
    let slope = slope.stiffness(50.0).damping(7.0).tangential_damping(3.0).adhesion(adhesion);
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    Contact::new(&body, &slope).unwrap()
}

const U: [f64; 8] = [0.02, -0.05, -0.03, 0.04, 0.01, 0.02, 0.03, -0.01];
const V: [f64; 8] = [0.3, -0.4, 0.7, 0.9, -0.5, 0.2, -0.1, 0.8];

fn forces(contact: &Contact, u: &[f64], v: &[f64]) -> NodalForces {
    let mut forces = NodalForces::zeros(8);
    contact.add_forces(0.0, u, v, &mut forces).unwrap();
    forces
}

/// Hirai (4.4.2), written out for node 2, the one at (1, 0).
#[test]
fn the_law_of_the_documents() {
    let forces = forces(&contact(true), &U, &V);
    let (n, x) = ([-0.6, 0.8], [1.0 + U[2], 0.0 + U[3] - 0.1]);
    let distance = n[0] * x[0] + n[1] * x[1];
    let rate = n[0] * V[2] + n[1] * V[3];
    assert!(distance < 0.0);
    for i in 0..2 {
        let sliding = V[2 + i] - rate * n[i];
        assert!((forces.conservative[2 + i] - -50.0 * distance * n[i]).abs() < 1e-13);
        let expected = -7.0 * rate * n[i] - 3.0 * sliding;
        assert!((forces.dissipative[2 + i] - expected).abs() < 1e-13);
    }
    // node 3 at (0, 1) is outside
    assert_eq!(forces.conservative[4..6], [0.0; 2]);
    assert_eq!(forces.dissipative[4..6], [0.0; 2]);
}

/// A node that separates faster than the spring can push is pulled back by the damper, but
/// not without adhesion.
#[test]
fn without_adhesion_the_normal_force_never_pulls() {
    let away = [0.0, 0.0, -60.0, 80.0, 0.0, 0.0, 0.0, 0.0];
    let normal_force = |adhesion| {
        let forces = forces(&contact(adhesion), &U, &away);
        let along = |f: &[f64]| -0.6 * f[2] + 0.8 * f[3];
        along(&forces.conservative) + along(&forces.dissipative)
    };
    assert!(normal_force(true) < -600.0);
    assert!(normal_force(false).abs() < 1e-12);
}

/// Coulomb's friction, written out: mu_k N against what slides fast, 11/16 mu_s N at half v0, the mean of
/// mu_s and mu_k at 2 v0, and none where the normal force pulls or nothing touches.
#[test]
fn friction_goes_with_what_presses() {
    let mesh = Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Triangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let floor = Obstacle::half_plane([0.0, 0.1], [0.0, 1.0]).stiffness(50.0).damping(7.0);
    // nodes 1 and 2 are 0.1 m deep
    let pressing = |rate: f64| 50.0 * 0.1 - 7.0 * rate;
    for adhesion in [true, false] {
        let floor = floor.clone().friction_coefficients(0.8, 0.5).sticking_speed(0.2);
        let contact = Contact::new(&body, &floor.adhesion(adhesion)).unwrap();
        let along = |speed: f64, rate: f64| {
            let v = [speed, rate, -speed, rate, speed, rate, speed, rate];
            let forces = forces(&contact, &[0.0; 8], &v).dissipative.to_vec();
            assert_eq!((forces[0], forces[4]), (-forces[2], 0.0));
            forces[0]
        };
        for (speed, rate, mu) in [
            (0.7, 0.2, 0.5),
            (-0.6, -0.2, -0.5),
            (0.2, 0.0, 0.8),
            (0.1, 0.1, 0.8 * 11.0 / 16.0),
            (0.4, 0.0, 0.65),
        ] {
            let expected = -mu * pressing(rate);
            assert!((along(speed, rate) - expected).abs() < 1e-14, "{speed} {rate}");
        }
        assert!(pressing(1.0) < 0.0 && along(0.7, 1.0) == 0.0);
        assert_eq!(along(0.0, 0.0), 0.0);
    }
}

/// The bound on explicit steps counts what slides as if it stuck: reserves and tangents add up to
/// 3 mu_s N/(2 v0).
#[test]
fn reserves_are_for_what_may_stick() {
    let mesh = Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Triangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let floor = Obstacle::half_plane([0.0, 0.1], [0.0, 1.0]).stiffness(50.0);
    let floor = floor.friction_coefficients(0.8, 0.5).sticking_speed(0.2);
    let contact = Contact::new(&body, &floor).unwrap();
    let pattern = crate::base::sparse::NodePattern::new(4, body.mesh().cells());
    let pattern = std::sync::Arc::new(pattern);
    for speed in [0.0, 0.1, 0.2, 0.7] {
        let mut stiffness = BlockMatrix::zeros(&pattern, 2);
        let mut damping = stiffness.clone();
        let v = [speed, 0.0, speed, 0.0, speed, 0.0, speed, 0.0];
        contact.add_tangents(0.0, &[0.0; 8], &v, &mut stiffness, &mut damping);
        let (mut of_k, mut of_d) = (vec![0.0; 4], vec![0.0; 4]);
        contact.add_reserves(0.0, &[0.0; 8], &v, &mut of_k, &mut of_d);
        assert_eq!(of_k, [0.0, 0.0, 50.0, 50.0]);
        assert_eq!(of_d[2..], [0.0; 2]);
        let steepest = 1.5 * 0.8 * 5.0 / 0.2;
        for (node, reserve) in of_d[..2].iter().enumerate() {
            let bound = damping.get(2 * node, 2 * node) + reserve;
            assert!((bound - steepest).abs() < 1e-12, "{speed}: {bound} {steepest}");
        }
    }
}

/// Friction that is larger backward, written out: r mu N straight backward, mu N forward and across, and
/// (1 + (r - 1) (3 q^2 - 2 q^3)) mu N with q = cos(a) at an angle a; at half v0, q is 11/16 of that.
#[test]
fn bristles_hold_what_slides_backward() {
    let mesh = Mesh::cuboid([1.0; 3], [2; 3], crate::elements::mesh::SolidCells::Hexahedra);
    let body = Body::new(mesh.unwrap(), SQUARE_MATERIAL).strain(Strain::Cauchy).build().unwrap();
    let floor = Obstacle::half_plane([0.0, 0.0, 0.1], [0.0, 0.0, 1.0]).stiffness(50.0);
    let floor = floor.friction_coefficients(0.3, 0.2).sticking_speed(0.2);
    let contact = Contact::new(&body, &floor.backward_friction([0.0, -2.0, 0.0], 0.9)).unwrap();
    let pressing = 50.0 * 0.1;
    let (backward, slanting) = ([0.0, -1.0], [0.6, -0.8]);
    let part = |q: f64| 1.0 + 2.0 * q * q * (3.0 - 2.0 * q);
    for (way, speed, expected) in [
        (backward, 0.7, 0.2 * 3.0),
        ([0.0, 1.0], 0.7, 0.2),
        ([1.0, 0.0], 0.7, 0.2),
        (backward, 0.2, 0.9),
        (slanting, 0.7, 0.2 * part(0.8)),
        (backward, 0.1, 0.3 * 11.0 / 16.0 * part(11.0 / 16.0)),
        (slanting, 0.1, 0.3 * 11.0 / 16.0 * part(0.8 * 11.0 / 16.0)),
    ] {
        let v = [speed * way[0], speed * way[1], 0.0].repeat(8);
        let mut forces = NodalForces::zeros(24);
        contact.add_forces(0.0, &[0.0; 24], &v, &mut forces).unwrap();
        for (force, way) in forces.dissipative[..2].iter().zip(way) {
            assert!((force + expected * pressing * way).abs() < 1e-14, "{way} {speed}: {force}");
        }
    }
}

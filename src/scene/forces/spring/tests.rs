//! Cables: their forces against their energy and differences, and against the formula of Euler and Eytelwein.

use super::*;
use crate::elements::force::NodalForces;
use crate::elements::mesh::{Cells, Mesh};
use crate::scene::forces::tests::{bar_body, check, nodal_forces, noise};
use crate::studies::samples::SQUARE_MATERIAL;

/// Cables of three lines around the nodes of a bar, from a fixed point: driven by a tension, stretched, damped, on a winch, and
/// slack.
#[test]
fn cables() {
    for dimension in 1..=3 {
        let body = bar_body(dimension);
        let point = [-0.9, 0.7, 0.4][..dimension].to_vec();
        let places = [Guide::point(point), Guide::nodes([3]), Guide::nodes([1]), Guide::nodes([2])];
        let cable =
            |places: &[Guide; 4]| Spring::cable(places.clone()).stiffness(20.0).damping(1.5);
        let (n, length) = (3 * dimension, cable(&places).law(&body).unwrap().length(&[0.0; 9]));
        let drive = || vec![Signal::constant(9.0), Signal::formula("3*t").unwrap()];
        let short = cable(&places).length(0.6 * length);
        let tension = Spring::cable(places.clone());
        for (cable, drive) in [
            (short.clone(), Vec::new()),
            (short.clone(), drive()),
            (short.winch(), vec![Signal::ramp(0.0, 0.2, 0.0, 1.0)]),
            (tension, drive()),
        ] {
            let force = &cable.forces(&body, drive).unwrap()[0];
            for seed in [1.0, 2.0] {
                let (u, v) = (noise(n, 0.1, seed), noise(n, 0.5, 10.0 * seed));
                // a tension alone has a tangent where its lines turn
                let largest = check(&**force, (dimension, &[]), 0.7, &u, &v, 1e-7);
                assert!(largest > 1.0 || dimension == 1);
            }
        }
        if dimension > 1 {
            // at rest, creeping and sliding
            let rubbing = cable(&places).length(0.6 * length).friction_coefficients(0.5, 0.4);
            for speed in [20.0, 1.0, 0.1] {
                let rubbing = rubbing.clone().sticking_speed(speed);
                let force = &rubbing.forces(&body, drive()).unwrap()[0];
                let (u, v) = (noise(n, 0.1, 5.0), noise(n, 0.5, 6.0));
                assert!(check(&**force, (dimension, &[]), 0.7, &u, &v, 1e-6) > 1.0);
            }
        }
        // around places within the cells
        let inside = |part: f64| {
            Guide::inside(body.mesh().position(1).iter().map(|x| part * x).collect::<Vec<_>>())
        };
        let through = [places[0].clone(), Guide::nodes([3]), inside(0.3), inside(1.4)];
        let through = Spring::cable(through).stiffness(20.0).damping(1.5).length(0.6 * length);
        let rubbing = through.clone().friction_coefficients(0.5, 0.4).sticking_speed(1.0);
        for cable in [through, rubbing] {
            let force = &cable.forces(&body, drive()).unwrap()[0];
            let (u, v) = (noise(n, 0.1, 7.0), noise(n, 0.5, 8.0));
            assert!(check(&**force, (dimension, &[]), 0.7, &u, &v, 1e-6) > 1.0);
        }
        // nothing is pushed
        let slack = &cable(&places).length(2.0 * length).forces(&body, Vec::new()).unwrap()[0];
        let (u, v) = (noise(n, 0.1, 3.0), noise(n, 0.5, 4.0));
        assert_eq!(check(&**slack, (dimension, &[]), 0.0, &u, &v, 1e-9), 0.0);
        assert!(nodal_forces(&**slack, 0.0, &u, &v).conservative.iter().all(|f| *f == 0.0));
    }
}

/// Euler and Eytelwein: a cable that turns by a right angle around a node and slides towards its drive has behind it the part
/// exp(-mu pi/2) of its tension, and the inverse when it slides back; what friction takes is heat.
#[test]
fn a_cable_rubs_around_its_places() {
    let mesh = Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).build().unwrap();
    let around = [Guide::nodes([1]), Guide::nodes([2]), Guide::nodes([4])];
    let cable = Spring::cable(around).friction_coefficients(0.4, 0.3).sticking_speed(1e-3);
    let force = &cable.forces(&body, vec![Signal::constant(2.0)]).unwrap()[0];
    let u = [0.0; 8];
    // a right angle is 3e-7 rad smaller where straight lines are smoothed
    let off = 5e-7;
    for (speed, friction) in [(0.1, 0.3), (-0.1, -0.3), (1e-3, 0.4), (0.0, 0.0)] {
        // the far end, node 4, moves towards the place that the cable turns around
        let v = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -speed];
        let mut forces = NodalForces::zeros(8);
        force.add_forces(0.0, &u, &v, &mut forces).unwrap();
        let behind = 2.0 * (-friction * std::f64::consts::FRAC_PI_2).exp();
        let total = |i: usize| forces.applied[i] + forces.dissipative[i];
        assert!((total(0) - 2.0).abs() < 1e-12 && (total(7) + behind).abs() < off, "{speed}");
        let (heat, supplied) = forces.powers(&v);
        assert!((supplied - 2.0 * speed).abs() < 1e-12 && heat >= 0.0);
        assert!((heat - (supplied - behind * speed)).abs() < off, "{heat}");
        let [first, last] = cable.law(&body).unwrap().pulls(&u, &v, [2.0, 0.0]);
        assert!((first - 2.0).abs() < 1e-12 && (last - behind).abs() < off);
    }
}

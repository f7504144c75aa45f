//! The stabilized form of index 2 against the ODE form: without alpha, and without drift.

use std::f64::consts::TAU;

use crate::common::{difference, run};
use pliant::samples::SQUARE_MATERIAL;
use pliant::{Axis, Body, Cells, Mesh, Method, Phase, Prescribed, Scene, Settings, Strain};

const UNTIL: f64 = 0.6;

/// A square that is pushed with a start like an impact, led along a path, and let go; two of its nodes
/// are tied together all the time.
fn pushed_and_led() -> Scene {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green);
    let tied = [(10, Axis::X, 1.0), (11, Axis::X, -1.0)];
    let wave = |t: f64| Prescribed {
        displacement: 0.01 * (TAU * t / 0.2).sin(),
        velocity: 0.01 * TAU / 0.2 * (TAU * t / 0.2).cos(),
        acceleration: -0.01 * (TAU / 0.2).powi(2) * (TAU * t / 0.2).sin(),
    };
    let held = |until: f64| {
        Phase::until(until).hold([1, 2, 3, 4]).hold_combination(tied).project_velocity()
    };
    Scene::new(body.build().unwrap())
        .gravity([0.0, -9.8])
        .phase(held(0.2).move_nodes([14, 15], [0.0, -0.1]))
        .phase(held(0.4).follow([14, 15], Axis::X, wave))
        .phase(held(UNTIL))
}

fn times() -> Vec<f64> {
    (0..=60).map(|k| f64::from(k) * UNTIL / 60.0).collect()
}

#[test]
fn the_motion_is_that_of_the_ode_form() {
    let scene = pushed_and_led();
    let by = |method, rtol| {
        run(&scene, &Settings { method, rtol, alpha: 1e4, ..Settings::default() }, &times())
    };
    let reference = by(Method::CvodeBdf, 1e-9);
    let errors = [(1e-5, 1e-4), (1e-7, 5e-6)].map(|(rtol, bound)| {
        let found = by(Method::IdaIndexTwo, rtol);
        let apart = difference(&found, &reference);
        let report = found.report();
        println!("rtol {rtol:e}: {apart:e}, {} steps\n{report}", report.steps());
        // measured: 3.4e-5 and 1.7e-6
        assert!(apart < bound, "{rtol:e}: {apart:e}");
        assert!(report.energy_error < 30.0 * rtol * report.energy_scale, "{}", report.energy_error);
        // round-off: 1e-12
        assert!(report.constraint_drift < 4e-12, "{:e}", report.constraint_drift);
        apart
    });
    // a hundredth of rtol: 20 times as near, as orders of about 2 to 3 make it
    assert!(errors[1] < errors[0] / 10.0, "{errors:?}");
}

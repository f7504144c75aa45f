//! What changes with time, said by points, against the same said by functions.

use pliant::samples::MEMBRANE_MATERIAL;
use pliant::{
    Axis, Body, Cells, Chamber, Mesh, Phase, Prescribed, Scene, Settings, Spring, Strain,
    Trajectory,
};

use crate::common::{difference, run, square};

/// The scenes are the same but for round-off in what they are told. Both integrations err by less
/// than the bound, a hundred times their tolerance.
#[track_caller]
fn alike(a: &Scene, b: &Scene) {
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    let motion = |scene| -> Trajectory { run(scene, &settings, &[0.05, 0.1, 0.15, 0.2]) };
    let difference = difference(&motion(a), &motion(b));
    assert!(difference < 1e-6, "{difference}");
}

/// Three points on the cubic 0.03 (3 s^2 - 2 s^3), s = t/0.2, which starts and ends at rest.
#[test]
fn paths() {
    let cubic = |t: f64| {
        let s = t / 0.2;
        Prescribed {
            displacement: -0.03 * s * s * (3.0 - 2.0 * s),
            velocity: -0.03 * 6.0 * s * (1.0 - s) / 0.2,
            acceleration: -0.03 * 6.0 * (1.0 - 2.0 * s) / 0.04,
        }
    };
    let times = [0.0, 0.06, 0.2];
    let points = times.map(|t| cubic(t).displacement);
    let hold = || Phase::until(0.2).hold("bottom");
    alike(
        &square().phase(hold().path([14, 15], Axis::Y, times, points)),
        &square().phase(hold().follow([14, 15], Axis::Y, cubic)),
    );
}

/// A trapezoid: up within 0.05 s, on until 0.12 s, down at 0.17 s.
fn trapezoid(t: f64) -> f64 {
    (t / 0.05).min(1.0).min((0.17 - t) / 0.05).max(0.0)
}

const TIMES: [f64; 4] = [0.0, 0.05, 0.12, 0.17];
const VALUES: [f64; 4] = [0.0, 1.0, 1.0, 0.0];

#[test]
fn loads() {
    let hold = || Phase::until(0.2).hold("bottom");
    let force = |share: f64| [30.0 * share, -20.0 * share];
    alike(
        &square().phase(hold().load_table("top", TIMES, VALUES.map(force))),
        &square().phase(hold().load_with("top", move |t| force(trapezoid(t)))),
    );
}

#[test]
fn pressures() {
    let membrane = || {
        let mesh = Mesh::rectangle([0.10, 0.01], [11, 2], Cells::Triangles).unwrap();
        let body = Body::new(mesh, MEMBRANE_MATERIAL)
            .strain(Strain::Cauchy)
            .thickness(0.01)
            .build()
            .unwrap();
        Scene::new(body).chamber(Chamber::within("chamber", (1..=11).rev().collect::<Vec<_>>()))
    };
    let hold = || Phase::until(0.2).hold([1, 11, 12, 22]);
    let values = VALUES.map(|share| 1000.0 * share);
    alike(
        &membrane().phase(hold().pressure_table("chamber", TIMES, values)),
        &membrane().phase(hold().pressure_with("chamber", |t| 1000.0 * trapezoid(t))),
    );
}

#[test]
fn actuators() {
    let scene = || square().spring(Spring::between([1], [16]).named("A1").stiffness(20.0));
    let hold = || Phase::until(0.2).hold("bottom");
    let forces = VALUES.map(|share| -40.0 * share);
    alike(
        &scene().phase(hold().actuate_table(["A1"], TIMES, forces)),
        &scene().phase(hold().actuate_with(["A1"], |t| -40.0 * trapezoid(t))),
    );
}

#[test]
fn breaks_are_the_points_within_a_phase() {
    let first = Phase::until(0.1).load_table("top", [0.0, 0.05, 0.1], [[0.0; 2]; 3]);
    let second = Phase::until(0.2).path([14], Axis::Y, [0.05, 0.15, 0.3], [0.0; 3]).load_table(
        "top",
        [0.12, 0.15],
        [[0.0; 2]; 2],
    );
    let scene = square().phase(first).phase(second).phase(Phase::until(0.3));
    assert_eq!(scene.breaks(0), [0.05]);
    assert_eq!(scene.breaks(1), [0.12, 0.15]);
    assert!(scene.breaks(2).is_empty() && scene.breaks(3).is_empty());
}

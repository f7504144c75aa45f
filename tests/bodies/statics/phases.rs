//! Equilibria of later phases.

use pliant::{Body, Cells, Error, Mesh, Phase, Scene, Statics, Strain};

use super::{RUBBER, bar};

/// A bar of stiffness E A/L = 100 N/m whose end is moved by 1 cm, then held there, and loaded at x = 4 cm: the closed form of
/// a bar between two ends. The load is that at the end of the phase.
#[test]
fn what_an_earlier_phase_has_moved_stays_there() {
    let scene = Scene::new(bar(Strain::Cauchy))
        .phase(Phase::until(2.0).named("stretch").hold("left").move_nodes("right", [0.005]))
        .phase(Phase::until(3.0).hold("left").hold("right").load_table(
            [3],
            [2.0, 3.0],
            [[0.0], [0.5]],
        ))
        .phase(Phase::until(4.0).named("let go").hold("left"));
    let (length, section) = (0.1, 10.0);
    for (phase, number, stretch, load) in
        [("stretch", 0, 0.01, 0.0), ("phase 2", 1, 0.01, 0.5), ("let go", 2, 0.0, 0.0)]
    {
        let rest = scene.equilibrium_of(phase, &Statics::default()).unwrap();
        assert_eq!((rest.sample().phase, rest.sample().time), (number, 2.0 + number as f64));
        for (node, u) in rest.displacements().iter().enumerate() {
            let x = 0.02 * node as f64;
            let share = f64::min(x * 0.06, 0.04 * (length - x)) / length;
            let exact = stretch * x / length + load * share / section;
            assert!((u - exact).abs() < 1e-15, "{phase} node {node}: {u} {exact}");
        }
        let left = rest.trajectory().constraint_force(rest.sample(), "left").unwrap()[0];
        let exact = -section * stretch / length - load * 0.6;
        assert!((left - exact).abs() < 1e-13, "{phase}: {left} {exact}");
    }
    let first = scene.equilibrium(&Statics::default()).unwrap();
    assert!((first.displacements()[5] - 0.01).abs() < 1e-15);
    let Err(Error::Input(unknown)) = scene.equilibrium_of("strech", &Statics::default()) else {
        panic!("no such phase");
    };
    let message = unknown.to_string();
    assert!(message.starts_with("phase of statics = \"strech\""), "{message}");
    assert!(message.contains("\"stretch\""), "{message}");
}

/// A pressed square that is held where it was pressed to is in the same equilibrium, step by step or at once.
#[test]
fn holding_is_pressing_that_has_ended() {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let body = Body::new(mesh, RUBBER).thickness(0.01).strain(Strain::Green).build().unwrap();
    let scene = Scene::new(body)
        .phase(Phase::until(0.5).named("push").hold("bottom").move_nodes([14, 15], [0.0, -0.16]))
        .phase(Phase::until(1.0).named("hold").hold("bottom").hold([14, 15]));
    let rest = |phase, load_steps| {
        scene.equilibrium_of(phase, &Statics { load_steps, ..Statics::default() }).unwrap()
    };
    let pushed = rest("push", 1);
    for held in [rest("hold", 1), rest("hold", 4)] {
        for (a, b) in held.displacements().iter().zip(pushed.displacements()) {
            // two solutions to round-off
            assert!((a - b).abs() < 1e-13, "{a} {b}");
        }
    }
}

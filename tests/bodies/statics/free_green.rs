//! Bodies with Green's strain that nothing holds, or not wholly: they turn to where loads balance each other.

use pliant::{
    Axis, Body, Cells, Equilibrium, Mesh, Phase, Sampling, Scene, Settings, Stability, Statics,
    Strain, Viscosity,
};

use super::{RUBBER, solve};

/// E/(1 - nu^2): the modulus of plane strain.
const MODULUS: f64 = 1e6 / (1.0 - 0.48 * 0.48);

fn rectangle(cells: Cells) -> Body {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], cells).unwrap();
    Body::new(mesh, RUBBER).thickness(0.01).strain(Strain::Green).build().unwrap()
}

/// The rectangle between two tractions (Pa, per undeformed area) on its ends, at an `angle` to its length.
fn between_tractions(cells: Cells, traction: f64, angle: f64) -> Scene {
    let [x, y] = [traction * angle.cos(), traction * angle.sin()];
    Scene::new(rectangle(cells))
        .phase(Phase::until(1.0).traction("left", [-x, -y]).traction("right", [x, y]))
}

/// Stretches along and across that St. Venant and Kirchhoff's law has under a traction T: s (s^2 - 1)/2 E' = T,
/// and no stress across.
fn stretches(traction: f64) -> [f64; 2] {
    let mut s: f64 = 1.0;
    for _ in 0..50 {
        s -= (0.5 * s * (s * s - 1.0) * MODULUS - traction) / (0.5 * MODULUS * (3.0 * s * s - 1.0));
    }
    let across = 0.48 / (1.0 - 0.48) * (s * s - 1.0);
    [s, (1.0 - across).sqrt()]
}

/// Farthest distance of a node from its place in the rectangle that has stretched and turned about its centre.
fn error(rest: &Equilibrium, [along, across]: [f64; 2], angle: f64) -> f64 {
    let mesh = rest.trajectory().body().mesh();
    let nodes = mesh.positions().chunks(2).zip(rest.displacements().chunks(2));
    let error = |(position, u): (&[f64], &[f64])| {
        let (x, y) = (along * (position[0] - 0.15), across * (position[1] - 0.1));
        let x = [0.15 + x * angle.cos() - y * angle.sin(), 0.1 + x * angle.sin() + y * angle.cos()];
        (position[0] + u[0] - x[0]).hypot(position[1] + u[1] - x[1])
    };
    nodes.map(error).fold(0.0, f64::max)
}

/// F S N = T: the length turns to the tractions, however far that is, and stretches.
#[test]
fn tractions_turn_and_stretch_a_rectangle() {
    for (traction, angle) in [(1e-1, 2.5), (1e4, 0.0), (1e5, 0.3), (1e5, 2.5), (1e5, -3.0)] {
        let rest = solve(&between_tractions(Cells::Triangles, traction, angle));
        assert_eq!(rest.removed, ["moving along (0, 1)", "moving along (1, 0)"]);
        // forces balance to 1e-10 of the traction, which stretches by 1e-7 to 1e-1; round-off
        let error = error(&rest, stretches(traction), angle);
        assert!(error < 1e-12, "{traction} Pa at {angle}: {error}");
        assert!(rest.iterations < 20, "{rest}");
    }
}

/// Pressed evenly along its length it stays as it is, but a push would turn it over: against a turn the loads have the stiffness
/// f . x < 0.
#[test]
fn a_pressed_rectangle_is_balanced_but_unstable() {
    let traction = -2e4;
    let rest = solve(&between_tractions(Cells::Rectangles, traction, 0.0));
    let stretches = stretches(traction);
    let error = error(&rest, stretches, 0.0);
    let [length, height] = [0.3 * stretches[0], 0.2 * stretches[1]];
    let [mass, work] = [1000.0 * 0.3 * 0.2 * 0.01, traction * 0.2 * 0.01 * length];
    let rigid = (-work / (mass * (length * length + height * height) / 12.0)).sqrt();
    let Stability::Unstable { growth } = rest.stability else { panic!("{rest}") };
    assert!(error < 1e-11, "{error}");
    // a body that is pressed by 2 % turns almost rigidly
    assert!((growth / rigid - 1.0).abs() < 0.01, "{growth} {rigid}");
}

/// Under pressure from within, a free ring is as one that is held on its planes of symmetry.
#[test]
fn a_free_ring_under_pressure_is_as_one_held_by_symmetry() {
    let ring = || {
        let mesh = Mesh::ring(0.04, 0.05, [24, 3], Cells::Rectangles).unwrap();
        Body::new(mesh, RUBBER).thickness(0.01).strain(Strain::Green).build().unwrap()
    };
    let body = ring();
    let on = |axis: usize| -> Vec<usize> {
        let nodes = body.mesh().positions().chunks(2).enumerate();
        nodes.filter(|(_, x)| x[axis].abs() < 1e-12).map(|(node, _)| node + 1).collect()
    };
    let pressed = || Phase::until(1.0).pressure_on("inner", 3e4);
    let held = pressed().hold_axes(on(0), [Axis::X]).hold_axes(on(1), [Axis::Y]);
    let [free, held] = [pressed(), held].map(|phase| solve(&Scene::new(ring()).phase(phase)));
    assert_eq!(free.removed.len(), 3);
    assert!(held.removed.is_empty());
    assert_eq!(free.stability, Stability::Neutral);
    let most = held.displacements().iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    let pairs = free.displacements().iter().zip(held.displacements());
    let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(most > 4e-3 && apart < 1e-14, "{apart} {most}");
}

/// What a slow motion comes to rest in, pulled at two corners askew: it turns by half a radian, and is strained unevenly.
#[test]
fn a_damped_motion_comes_to_rest_there() {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    let viscous = pliant::Material { viscosity: 2e4, ..RUBBER };
    let body = Body::new(mesh, viscous).thickness(0.01).strain(Strain::Green);
    let body = body.viscosity(Viscosity::Natural).build().unwrap();
    let pulled = Phase::until(60.0).load([1], [-60.0, 0.0]).load([12], [60.0, 0.0]);
    let scene = Scene::new(body).phase(pulled);
    let rest = solve(&scene);
    let motion = scene.simulate(&Settings::default(), &Sampling::every(60.0)).unwrap();
    let turned = rest.displacements()[1].atan2(0.15);
    assert!(turned > 0.4, "{turned}");
    let pairs = motion.last().u.iter().zip(rest.displacements());
    let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // rtol of the motion is 1e-5
    assert!(apart < 2e-6, "{apart}");
}

#[test]
fn loads_that_no_turn_balances_are_told() {
    let told = |phase: Phase| {
        let scene = Scene::new(rectangle(Cells::Triangles)).phase(phase);
        scene.equilibrium(&Statics::default()).unwrap_err().to_string()
    };
    let pushed = told(Phase::until(1.0).load([1], [0.5, 0.0]));
    assert!(
        pushed.contains("loads leave a force of 5.000e-1 N for moving along (1, 0)"),
        "{pushed}"
    );
    assert!(pushed.contains("hold more of its nodes, or balance the loads"), "{pushed}");
    // pressures that follow the body and turn it on and on: 10 kPa on 0.1 x 0.01 m, 0.1 m apart, twice
    let couple = Phase::until(1.0).pressure_on([1, 5], 1e4).pressure_on([8, 12], 1e4);
    let couple = told(couple);
    assert!(couple.contains("loads leave a moment of 1.953e-3 N m"), "{couple}");
    assert!(!couple.contains("a force of"), "{couple}");
    // held so that it may turn about a node, it hangs below it: nothing is left to remove
    let hung = Phase::until(1.0).hold([4]).load([1], [0.0, -1.0]);
    let hung = solve(&Scene::new(rectangle(Cells::Triangles)).phase(hung));
    assert!(hung.removed.is_empty() && matches!(hung.stability, Stability::Stable { .. }));
    let u = hung.displacements();
    assert!((u[0] - 0.3).abs() < 1e-11, "{}", u[0]);
    assert!(u[1] < -0.3 && u[6] == 0.0 && u[7] == 0.0, "{u:?}");
}

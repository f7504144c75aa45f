//! No step leads through an obstacle: thin, small, fast and moving ones, by every method. The
//! integrators see forces at the ends of their steps only, and nothing in free flight bounds a step.

use pliant::samples::SQUARE_MATERIAL;
use pliant::{
    Body, Cells, ContactEvents, Mesh, Method, Obstacle, Phase, Sampling, Scene, Settings,
    SolidCells, Strain,
};

fn square(side: f64, nodes: usize, at: [f64; 2]) -> Scene {
    let mesh = Mesh::rectangle([side, side], [nodes, nodes], Cells::Rectangles).unwrap();
    let mesh = mesh.translated(&[at[0] - 0.5 * side, at[1]]).unwrap();
    Scene::new(
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap(),
    )
}

fn cube(side: f64, at: [f64; 3]) -> Scene {
    let mesh = Mesh::cuboid([side; 3], [3; 3], SolidCells::Hexahedra).unwrap();
    let at = [at[0] - 0.5 * side, at[1] - 0.5 * side, at[2]];
    Scene::new(
        Body::new(mesh.translated(&at).unwrap(), SQUARE_MATERIAL)
            .strain(Strain::Cauchy)
            .build()
            .unwrap(),
    )
}

/// Centre of mass along the last axis at the end (m).
fn height(scene: &Scene, settings: &Settings) -> f64 {
    let motion = scene.simulate(settings, &Sampling::phase_ends()).unwrap();
    let report = motion.report();
    let height = *motion.centre_of_mass(motion.last()).last().unwrap();
    println!(
        "{} {:e} {}: {height} m, {} steps, {} events",
        settings.method,
        settings.rtol,
        settings.contact_events,
        report.steps(),
        report.phases[0].counts.contact_events
    );
    height
}

/// By every method, with contacts stepped over and located, `scene` ends where explicit Runge-Kutta
/// ends it whose steps (s) are too short to lead through anything. Tolerances (m) are some three to ten
/// times what was measured.
#[track_caller]
fn assert_seen(scene: &Scene, longest: f64, tolerance: f64) {
    let exact =
        Settings { method: Method::Rk, rtol: 1e-8, max_step: Some(longest), ..Settings::default() };
    let exact = height(scene, &exact);
    for method in Method::ALL {
        for contact_events in [ContactEvents::StepOver, ContactEvents::Locate] {
            let settings = Settings { method, contact_events, ..Settings::default() };
            let off = (height(scene, &settings) - exact).abs();
            assert!(off < tolerance, "{method} {contact_events}: {off:e}");
        }
    }
}

/// A square of 5 cm falls 5 m on a disc of 2 cm, and bounces to 3.5 m.
#[test]
fn a_square_bounces_off_a_small_disc() {
    let disc = Obstacle::disc([0.0, -0.02], 0.02).stiffness(1e5).damping(1.0);
    let scene = square(0.05, 3, [0.0, 5.0]).gravity([0.0, -9.8]).obstacle(disc);
    assert_seen(&scene.phase(Phase::until(1.6)), 1e-3, 5e-4);
}

/// A plate of 4 mm stops a square at 20 m/s; the way to it takes a step or two.
#[test]
fn a_thin_plate_stops_a_fast_square() {
    let plate = Obstacle::box_between([-1.0, -0.004], [1.0, 0.0]).stiffness(1e7).damping(5.0);
    let scene = square(0.05, 3, [0.0, 1.0]).initial_velocity(|_| vec![0.0, -20.0]).obstacle(plate);
    assert_seen(&scene.phase(Phase::until(0.08)), 1e-5, 2e-5);
}

/// A thin rod hits a square at rest at 20 m/s from below.
#[test]
fn a_moving_rod_is_met() {
    let rod = Obstacle::capsule([-1.0, -0.5], [1.0, -0.5], 0.005).stiffness(1e5).damping(1.0);
    let scene = square(0.05, 3, [0.0, 0.0]).obstacle(rod.velocity([0.0, 20.0]));
    assert_seen(&scene.phase(Phase::until(0.05)), 1e-4, 2e-4);
}

/// A thin rod is shot at a square at rest and drawn back before a long step would have ended.
#[test]
fn a_rod_that_comes_and_goes_is_met() {
    let rod = Obstacle::capsule([-1.0, -0.5], [1.0, -0.5], 0.005).stiffness(1e5).damping(1.0);
    let rod = rod.path([0.02, 0.06, 0.1], [[0.0, 0.0], [0.0, 0.52], [0.0, 0.0]]);
    let scene = square(0.05, 3, [0.0, 0.0]).obstacle(rod);
    assert_seen(&scene.phase(Phase::until(0.12)), 1e-4, 2e-4);
}

/// In space: a cube falls on a ball, and on a plate of 4 mm.
#[test]
fn a_cube_bounces_off_a_ball_and_a_plate() {
    let ball = Obstacle::disc([0.0, 0.0, -0.02], 0.02).stiffness(1e6).damping(10.0);
    let plate = Obstacle::box_between([-1.0, -1.0, -0.004], [1.0, 1.0, 0.0]);
    for obstacle in [ball, plate.stiffness(1e6).damping(10.0)] {
        let scene = cube(0.05, [0.0, 0.0, 0.5]).initial_velocity(|_| vec![0.0, 0.0, -10.0]);
        assert_seen(&scene.obstacle(obstacle).phase(Phase::until(0.075)), 1e-4, 1e-5);
    }
}

/// Bounds on steps hold for every method.
#[test]
fn no_step_is_longer_than_allowed() {
    let scene = square(0.05, 3, [0.0, 0.0]).gravity([0.0, -9.8]).phase(Phase::until(0.2));
    for method in Method::ALL {
        let mut longest = 0.0_f64;
        let settings = Settings { method, max_step: Some(2e-3), ..Settings::default() };
        let seen = |progress: &pliant::simulate::Progress| {
            longest = longest.max(progress.step);
            std::ops::ControlFlow::Continue(())
        };
        scene.simulate_with(&settings, &Sampling::phase_ends(), seen).unwrap();
        assert!(longest < 2.021e-3, "{method}: {longest:e}");
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let settings = Settings { max_step: Some(bad), ..Settings::default() };
        let error = scene.simulate(&settings, &Sampling::phase_ends()).unwrap_err().to_string();
        assert!(error.contains("max_step") && error.contains("above 0"), "{error}");
    }
}

/// A square at 3 m/s and a plate of 1 mm that is too soft to stop it: the motion is reported as doubtful, also where no
/// sample shows the square inside the plate, and on a plate with the stiffness that the report names it turns back.
#[test]
fn a_body_that_breaks_through_a_plate_is_reported_with_what_would_hold() {
    let run = |stiffness: f64| {
        let plate = Obstacle::box_between([-0.1, -0.001], [0.1, 0.0]).stiffness(stiffness);
        let scene = square(0.02, 3, [0.0, 0.005])
            .obstacle(plate.named("plate"))
            .initial_velocity(|_| vec![0.0, -3.0])
            .phase(Phase::until(0.01));
        scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap()
    };
    let soft = run(100.0);
    assert!(soft.centre_of_mass(soft.last())[1] < -0.01);
    let warnings = soft.report().warnings();
    let told =
        warnings.iter().find(|warning| warning.contains("passed through obstacle \"plate\""));
    let told = told.unwrap_or_else(|| panic!("{warnings:?}"));
    let enough = told.split("to about ").nth(1).and_then(|rest| rest.split(' ').next());
    let hard = run(enough.unwrap().parse().unwrap());
    assert!(hard.centre_of_mass(hard.last())[1] > 0.01, "{told}");
    let warnings = hard.report().warnings();
    assert!(!warnings.iter().any(|warning| warning.contains("inside obstacle")), "{warnings:?}");
    assert!(!warnings.iter().any(|warning| warning.contains("passed")), "{warnings:?}");
}

/// A pin between two nodes of a face, where no force acts: reported, and not where a node rests on the pin.
#[test]
fn a_pin_that_enters_between_nodes_is_reported() {
    let warnings = |x: f64| {
        let pin = Obstacle::disc([x, -0.011], 0.01).stiffness(1e4).damping(10.0).named("pin");
        let scene =
            square(0.1, 3, [0.0, 0.0]).obstacle(pin).gravity([0.0, -9.8]).phase(Phase::until(0.06));
        let motion = scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap();
        motion.report().warnings()
    };
    let between = warnings(0.025);
    let is_told = |warning: &String| {
        warning.contains("the surface between nodes") && warning.contains("obstacle \"pin\"")
    };
    assert!(between.iter().any(is_told), "{between:?}");
    let on_node = warnings(0.0);
    assert!(!on_node.iter().any(is_told), "{on_node:?}");
}

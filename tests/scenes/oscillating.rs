//! Obstacles that follow formulas of time, against the same motion in other words.

use std::path::Path;

use pliant::{ContactEvents, Method, Sampling, Scene, SceneFile, Settings};

/// A square of 5 cm, 3 x 3 nodes, with its lower edge at height 0, and what the rest says.
fn scene(rest: &str) -> Scene {
    let square = r#"
        [body]
        mesh = { kind = "rectangle", size = [0.05, 0.05], nodes = [3, 3], cells = "rectangles" }
        thickness = 0.01
        strain = "green"
        material = { density = 1000.0, young = 1e6, poisson = 0.48, viscosity = 40.0 }
    "#;
    SceneFile::parse(&[rest, square].concat(), Path::new("oscillating.toml")).unwrap().scene
}

/// Heights of the centre of mass (m) at all samples, and the steps it took.
fn heights(scene: &Scene, settings: &Settings, sampling: &Sampling) -> (Vec<f64>, usize) {
    let motion = scene.simulate(settings, sampling).unwrap();
    let height = |sample| motion.centre_of_mass(sample)[1];
    (motion.samples().iter().map(height).collect(), motion.report().steps())
}

fn furthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// A plate shakes a square by 2 mm at 20 Hz, faster than it falls, so that it is thrown: by a formula, and by 40 points
/// a period, from rest to rest. Between them the spline is off by (w h)^4/384 of the amplitude of 1 mm, 2e-9 m, which
/// throws and landings make larger; both ways at an rtol of 1e-8.
#[test]
fn a_formula_shakes_as_many_points_do() {
    let shaken = |path: &str| {
        scene(&format!(
            r#"
            gravity = [0.0, -9.8]
            phase = {{ until = 0.3 }}
            obstacle = {{ kind = "half-plane", point = [0.0, 0.0], normal = [0.0, 1.0], stiffness_density = 1e7, damping = 1e3, path = {path} }}
            "#
        ))
    };
    let times: Vec<f64> = (0..=240).map(|k| f64::from(k) / 800.0).collect();
    let at = |t: &f64| [0.0, 0.001 * (1.0 - (40.0 * std::f64::consts::PI * t).cos())];
    let points: Vec<[f64; 2]> = times.iter().map(at).collect();
    let by_points = shaken(&format!("{{ times = {times:?}, displacements = {points:?} }}"));
    let by_formula = shaken(r#"{ displacement = [0.0, "0.001*(1 - cos(2*pi*20*t))"] }"#);
    for method in [Method::Auto, Method::CvodeBdf, Method::Arkode, Method::Rk] {
        let settings = Settings { method, rtol: 1e-8, ..Settings::default() };
        let sampling = Sampling::every(0.01);
        let (points, many) = heights(&by_points, &settings, &sampling);
        let (formula, few) = heights(&by_formula, &settings, &sampling);
        let (off, way) = (furthest(&points, &formula), furthest(&points, &[points[0]; 31]));
        println!("{method}: {off:e} of {way} m, {many} and {few} steps");
        assert!(way > 0.01 && off < 6e-6, "{method}: {off:e} of {way}");
        assert!(few < many, "{method}: {few} {many}");
    }
}

/// A rod 5 cm below a square at rest comes and goes at 25 Hz and hits it each time it can: several periods are over within
/// one step of a body on which nothing acts, which so begins and ends with the rod far away. Explicit Runge-Kutta at steps of
/// 0.1 ms sees all of it; the others are within three times what was measured, 1e-5 m of 7 cm.
#[test]
fn a_rod_that_oscillates_within_a_step_is_met() {
    let rod = scene(
        r#"
        phase = { until = 0.2 }
        [[obstacle]]
        kind = "capsule"
        from = [-1.0, -0.055]
        to = [1.0, -0.055]
        radius = 0.005
        stiffness = 1e5
        damping = 1.0
        path = { displacement = ["0", "0.051*sin(2*pi*12.5*t)^2"] }
        "#,
    );
    let ends = Sampling::phase_ends();
    let exact =
        Settings { method: Method::Rk, rtol: 1e-8, max_step: Some(1e-4), ..Settings::default() };
    let (exact, _) = heights(&rod, &exact, &ends);
    assert!(exact[1] - exact[0] > 0.05, "{exact:?}");
    for method in Method::ALL {
        for contact_events in [ContactEvents::StepOver, ContactEvents::Locate] {
            let settings = Settings { method, contact_events, ..Settings::default() };
            let (found, steps) = heights(&rod, &settings, &ends);
            let off = furthest(&found, &exact);
            println!("{method} {contact_events}: {off:e} m, {steps} steps");
            assert!(off < 3e-5, "{method} {contact_events}: {off:e}");
        }
    }
}

/// A formula that has no value any more ends the run by name.
#[test]
fn a_path_without_a_value_ends_the_run() {
    let scene = scene(
        r#"
        phase = { until = 0.2 }
        [[obstacle]]
        name = "lid"
        kind = "half-plane"
        point = [0.0, 1.0]
        normal = [0.0, -1.0]
        stiffness = 1e5
        path = { displacement = ["0", "0.01*sqrt(0.1 - t)"] }
        "#,
    );
    let error = scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap_err();
    let error = error.to_string();
    // or its velocity, which is infinite at 0.1 s
    assert!(error.contains("path of obstacle \"lid\" is "), "{error}");
    assert!(error.contains(" at t = 0.1 s: it must be a finite number"), "{error}");
}

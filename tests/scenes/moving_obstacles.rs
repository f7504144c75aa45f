//! Obstacles that move along paths, stop and come back, against closed forms.

use pliant::{
    Axis, Body, Material, Mesh, Method, Obstacle, Phase, Prescribed, Sampling, Scene, Settings,
    Statics, Strain,
};

/// Stiffness of the contact (N/m), and of the bar, E A/L.
const CONTACT: f64 = 1e3;
const BAR: f64 = 1e5 * 1e-4 / 0.1;
/// How far the plate comes (m).
const WAY: f64 = 0.005;

/// A bar of 10 cm along x, held on its left.
fn bar() -> Body {
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.0, viscosity: 100.0 };
    Body::new(Mesh::bar(0.1, 5).unwrap(), soft).area(1e-4).strain(Strain::Cauchy).build().unwrap()
}

/// A plate at its right end.
fn plate() -> Obstacle {
    Obstacle::half_plane([0.1], [-1.0]).stiffness(CONTACT).named("plate")
}

/// A plate that presses the bar from 0.5 s to 2.5 s, and goes back until 4.5 s.
fn press() -> Scene {
    let plate = plate().path([0.5, 2.5, 4.5], [[0.0], [-WAY], [0.0]]);
    Scene::new(bar()).obstacle(plate).phase(Phase::until(5.0).hold("left"))
}

/// Where the plate is (m): with velocity 0 at all three points each half is a cubic of its own.
fn depth(t: f64) -> f64 {
    let s = (1.0 - (t - 2.5).abs() / 2.0).max(0.0);
    WAY * s * s * (3.0 - 2.0 * s)
}

/// The bar and the contact are springs in a row while the plate is slow: its speed of 4 mm/s drags by
/// viscosity, c/E = 1 ms, some 1e-3 of the force. What the plate supplied comes back but for the heat.
#[test]
fn a_plate_presses_and_goes_back() {
    for method in Method::ALL {
        let settings = Settings { method, rtol: 1e-8, ..Settings::default() };
        let motion = press().simulate(&settings, &Sampling::every(0.25)).unwrap();
        let mut worst = 0.0_f64;
        for sample in motion.samples() {
            let force: f64 = motion.contact_forces(sample).unwrap().iter().sum();
            let expected = -depth(sample.time) * BAR * CONTACT / (BAR + CONTACT);
            worst = worst.max((force - expected).abs() / (WAY * BAR));
        }
        let (report, last) = (motion.report(), motion.last());
        let balance = report.energy_error / report.energy_scale;
        println!("{method}: force off by {worst:.1e}, energy by {balance:.1e}");
        assert!(worst < 2e-3, "{method}: {worst:e}");
        assert!(balance < 1e-3, "{method}: {balance:e}");
        let stored = 0.5 * WAY * WAY * BAR * CONTACT / (BAR + CONTACT);
        let highest = motion.samples().iter().map(|s| s.energy.supplied).fold(0.0, f64::max);
        assert!((highest / stored - 1.0).abs() < 5e-3, "{method}: {highest} {stored}");
        let heat = last.energy.dissipated;
        assert!(last.energy.supplied < 0.01 * stored, "{:?}", last.energy);
        assert!((last.energy.supplied - heat).abs() < 1e-3 * stored, "{:?}", last.energy);
    }
}

/// A plate on a path presses as one that rests does on a bar whose other end is driven towards it, once
/// all stands still; in statics, too, where the path is gone along.
#[test]
fn a_plate_on_a_path_presses_as_one_that_is_driven_against() {
    let path = |t: f64| {
        let s = (t / 0.2).min(1.0);
        let on_the_way = f64::from(t < 0.2);
        Prescribed {
            displacement: WAY * s * s * (3.0 - 2.0 * s),
            velocity: on_the_way * WAY * 6.0 * s * (1.0 - s) / 0.2,
            acceleration: on_the_way * WAY * 6.0 * (1.0 - 2.0 * s) / 0.04,
        }
    };
    let moved = Scene::new(bar()).obstacle(plate().path([0.0, 0.2], [[0.0], [-WAY]]));
    let moved = moved.phase(Phase::until(2.0).hold("left"));
    let driven = Phase::until(2.0).follow("left", Axis::X, path);
    let driven = Scene::new(bar()).obstacle(plate()).phase(driven);
    let expected = WAY * BAR * CONTACT / (BAR + CONTACT);
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    for scene in [moved, driven] {
        let motion = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
        let force: f64 = motion.contact_forces(motion.last()).unwrap().iter().sum();
        assert!((force / -expected - 1.0).abs() < 1e-6, "{force} {expected}");
        let still = scene.equilibrium(&Statics::default()).unwrap();
        let left = still.trajectory().constraint_force(still.trajectory().last(), "left").unwrap();
        assert!((left[0] / expected - 1.0).abs() < 1e-10, "{left:?} {expected}");
    }
}

/// A command takes the plate from its path; in the next phase it follows the path again, from where it is.
/// A file knows both.
#[test]
#[cfg(feature = "checkpoint")]
fn a_plate_leaves_its_path_by_command() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plate.json");
    let plate = plate().path([0.0, 1.0, 2.0], [[0.0], [-WAY], [0.0]]);
    let scene = Scene::new(bar())
        .obstacle(plate)
        .phase(Phase::until(0.8).hold("left"))
        .phase(Phase::until(2.5).hold("left"));
    let start = || scene.start(&Settings { rtol: 1e-7, ..Settings::default() }).unwrap();
    let mut bar = start();
    bar.advance_to(0.5).unwrap();
    bar.move_obstacle("plate", [0.0]).unwrap();
    // from its depth, felt through both springs once all stands still
    let at = |bar: &pliant::Simulation, depth: f64| {
        let force = bar.view().contact_force("plate").unwrap()[0];
        let expected = -depth * BAR * CONTACT / (BAR + CONTACT);
        // while the plate moves, the bar's viscosity drags by 1.4e-3
        assert!((force - expected).abs() < 2e-3 * WAY * BAR, "{force} {expected}");
    };
    bar.advance_to(0.8).unwrap();
    at(&bar, 0.5 * WAY);
    let s = 0.8_f64;
    let there = s * s * (3.0 - 2.0 * s) * WAY;
    bar.advance_to(1.0).unwrap();
    bar.checkpoint().write(&file).unwrap();
    let mut other = start();
    other.restore(&other.read_checkpoint(&file).unwrap()).unwrap();
    bar.restore(&bar.checkpoint()).unwrap();
    bar.advance_to(1.5).unwrap();
    other.advance_to(1.5).unwrap();
    assert_eq!(bar.view().displacements(), other.view().displacements());
    at(&bar, 0.5 * WAY - there + 0.5 * WAY);
    bar.advance_to(2.5).unwrap();
    at(&bar, 0.0);
}

#[test]
fn paths_that_cannot_be_followed_are_refused() {
    let says = |plate: Obstacle, words: &[&str]| {
        let scene = Scene::new(bar()).obstacle(plate).phase(Phase::until(1.0).hold("left"));
        let message = scene.validate().unwrap_err().to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    };
    says(plate().path([0.0, 1.0], [[0.0, 1.0], [0.0, 0.0]]), &["plate", "path", "1 component(s)"]);
    says(plate().path([0.0, 1.0], [[0.0]]), &["path", "2 times"]);
    says(plate().path([1.0, 0.0], [[0.0], [1.0]]), &["must ascend", "0 s"]);
    says(plate().path([0.0, 1.0], [[0.0], [f64::NAN]]), &["plate", "path", "NaN"]);
    says(plate().path([], [] as [[f64; 1]; 0]), &["path", "two points"]);
}

//! All that acts is brought on by the load factor, step by step, against closed forms at each of them; and searches that start
//! from a given state.

use std::f64::consts::PI;

use pliant::simulate::Reading;
use pliant::{
    Body, CellSelection, Cells, Chamber, Equilibrium, Gas, Growth, Guide, Liquid, Material, Mesh,
    Phase, Plane, Sampling, Scene, Spring, Stability, Statics, Strain,
};

use super::stability::truss;
use super::{bar, solve};

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.0, viscosity: 0.0 };

/// Length and height (m) of a strip.
const STRIP: [f64; 2] = [0.2, 0.002];
const THICKNESS: f64 = 0.01;
/// Nodes at corners of cells along it.
const NODES: usize = 61;
/// Distance (m) between the nodes of its upper side.
const SPACING: f64 = 0.5 * STRIP[0] / (NODES - 1) as f64;

fn steps(load_steps: usize) -> Statics {
    Statics { load_steps, ..Statics::default() }
}

/// The strip of nu = 0 and St. Venant and Kirchhoff's law, held at the left.
fn strip(scene: impl FnOnce(Body) -> Scene) -> Scene {
    let mesh = Mesh::rectangle(STRIP, [NODES, 3], Cells::Rectangles9).unwrap();
    let mesh = mesh.translated(&[0.0, -0.5 * STRIP[1]]).unwrap();
    let body =
        Body::new(mesh, RUBBER).thickness(THICKNESS).plane(Plane::Stress).strain(Strain::Green);
    scene(body.build().unwrap())
}

/// The angle (rad) by which such a strip bends along which nothing changes: stretches a + b y at the height y, whose lower half
/// has grown by `growth`, under a tension (N) along its upper side, by the balance of force and moment. A tendon is straight between nodes:
/// of an arc that turns by phi between two of them, c apart, it is c phi/12 inside in the mean.
fn angle(growth: f64, tension: f64) -> f64 {
    let [length, height] = STRIP;
    let lacking = |[a, b]: [f64; 2]| {
        let chord = SPACING * (a + 0.5 * b * height);
        let arm = 0.5 * height - chord * b * SPACING / 12.0;
        let mut sums = [tension / THICKNESS, arm * tension / THICKNESS];
        for (grown, middle) in [(1.0 + growth, -0.25 * height), (1.0, 0.25 * height)] {
            for (x, weight) in
                [(-0.6f64.sqrt(), 5.0 / 18.0), (0.0, 4.0 / 9.0), (0.6f64.sqrt(), 5.0 / 18.0)]
            {
                let y = middle + 0.25 * height * x;
                let elastic = (a + b * y) / grown;
                let stress = RUBBER.young * 0.5 * (elastic * elastic - 1.0) * elastic;
                sums[0] += 0.5 * height * weight * stress;
                sums[1] += 0.5 * height * weight * stress * y;
            }
        }
        sums
    };
    let mut at = [1.0, 0.0];
    for _ in 0..50 {
        let [f, da, db] = [at, [at[0] + 1e-7, at[1]], [at[0], at[1] + 1e-4]].map(lacking);
        let (k, l) = (
            [(da[0] - f[0]) / 1e-7, (da[1] - f[1]) / 1e-7],
            [(db[0] - f[0]) / 1e-4, (db[1] - f[1]) / 1e-4],
        );
        let whole = k[0] * l[1] - l[0] * k[1];
        at[0] -= (f[0] * l[1] - l[0] * f[1]) / whole;
        at[1] -= (k[0] * f[1] - f[0] * k[1]) / whole;
    }
    -at[1] * length
}

/// The angle (rad) by which the right end of a strip has turned, near an `expected` one.
fn turned(scene: &Scene, u: &[f64], expected: f64) -> f64 {
    let mesh = scene.body().mesh();
    let right = mesh.select(&"right".into()).unwrap();
    let place = |node: usize| [0, 1].map(|i| mesh.position(node)[i] + u[2 * node + i]);
    let top =
        right.iter().copied().max_by(|&a, &b| mesh.position(a)[1].total_cmp(&mesh.position(b)[1]));
    let low =
        right.iter().copied().min_by(|&a, &b| mesh.position(a)[1].total_cmp(&mesh.position(b)[1]));
    let ([x, y], [x0, y0]) = (place(top.unwrap()), place(low.unwrap()));
    let angle = (-(x - x0)).atan2(y - y0);
    angle + 2.0 * PI * ((expected - angle) / (2.0 * PI)).round()
}

/// Each equilibrium of a load curve has the angle that a share of the load has, to a part of the last.
fn compare(scene: &Scene, found: &Equilibrium, angle: impl Fn(f64) -> f64, tolerance: f64) {
    let whole = angle(1.0).abs();
    for sample in found.trajectory().samples() {
        let factor = sample.sensors[0];
        let expected = angle(factor);
        let angle = turned(scene, &sample.u, expected);
        println!("load factor {factor}: {angle} rad, expected {expected} rad");
        assert!((angle - expected).abs() < tolerance * whole, "{factor}: {angle} {expected}");
    }
    let each = found.iterations as f64 / (found.load_steps + found.failed_steps) as f64;
    println!("{found}; {} failed, {each} iterations each", found.failed_steps);
}

/// A bimetal strip curls to two turns.
#[test]
fn growth_is_brought_on() {
    let grown = 0.0865;
    let scene = strip(|body| {
        let lower = CellSelection::inside([0.0, -0.5 * STRIP[1]], [STRIP[0], 0.0]);
        let phase = Phase::until(2.0).hold("left").actuate(["hot"], grown);
        Scene::new(body).growth(Growth::within(lower).named("hot").along([1.0, 0.0])).phase(phase)
    });
    assert!(angle(grown, 0.0) > 4.0 * PI);
    let found = scene.equilibrium(&steps(4)).unwrap();
    // cells that turn by 0.2 rad each; half as large ones are off by a quarter, 1.0e-3 at nearly two turns
    compare(&scene, &found, |factor| angle(factor * grown, 0.0), 6e-3);
}

/// A tendon along the upper side bends a strip by 3 pi.
#[test]
fn tension_is_brought_on() {
    let tension = 0.33;
    let scene = strip(|body| {
        let phase = Phase::until(2.0).hold("left").actuate(["tendon"], tension);
        Scene::new(body).spring(Spring::cable([Guide::nodes("top")]).named("tendon")).phase(phase)
    });
    assert!(angle(0.0, tension).abs() > 3.0 * PI, "{}", angle(0.0, tension));
    let found = scene.equilibrium(&steps(4)).unwrap();
    compare(&scene, &found, |factor| angle(0.0, factor * tension), 1e-3);
}

fn ring() -> Scene {
    let mesh = Mesh::ring(0.02, 0.03, [16, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, Material { young: 1e5, ..RUBBER }).thickness(0.01).build().unwrap();
    Scene::new(body).chamber(Chamber::within("air", "inner")).phase(Phase::until(2.0))
}

/// p V = p_0 V_0 for the part of an amount of gas that is there, and p = K (V_m - V)/V_m of a liquid.
#[test]
fn fills_are_brought_on() {
    let read = |scene: &Scene| {
        let mut found = scene.equilibrium(&steps(4)).unwrap();
        let sampling = Sampling::phase_ends().read("pressure", Reading::pressure("air"));
        found.read(&sampling.read("volume", Reading::chamber_volume("air"))).unwrap();
        let samples = found.trajectory().samples().iter();
        samples.map(|sample| [0, 1, 2].map(|k| sample.sensors[k])).collect::<Vec<_>>()
    };
    let (outside, inside) = (101_325.0, 1.1e5);
    let curve = read(&ring().gas(Gas::in_chamber("air").pressure(inside)));
    let first = curve[0][2];
    for [factor, gauge, volume] in curve {
        let expected = (outside + factor * (inside - outside)) * first / volume - outside;
        assert!((gauge - expected).abs() < 1e-8 * inside, "{factor}: {gauge} {expected}");
    }
    let (bulk, fill) = (1e6, 1.1);
    let curve = read(&ring().liquid(Liquid::in_chamber("air").bulk_modulus(bulk).fill(fill)));
    for [factor, gauge, volume] in curve {
        let natural = first * (1.0 + factor * (fill - 1.0));
        let expected = bulk * (natural - volume) / natural;
        assert!((gauge - expected).abs() < 1e-8 * bulk, "{factor}: {gauge} {expected}");
    }
}

/// What is held stays where the start has it, and a truss stays on the side on which it starts.
#[test]
fn a_search_begins_at_the_start() {
    let h = 0.2;
    let free = |phase| truss(h, phase);
    let unloaded = free(Phase::until(1.0));
    let below = unloaded.clone().initial_displacement(move |x| vec![0.0, -1.8 * x[1]]);
    assert!(solve(&unloaded).displacements().iter().all(|u| u.abs() < 1e-12));
    let found = solve(&below);
    // the other equilibrium without load is the mirror image
    assert!((found.displacements()[3] + 2.0 * h).abs() < 1e-10, "{:?}", found.displacements());
    assert!(matches!(found.stability, Stability::Stable { .. }));
    // one load step follows another by hand: from a half of the load to the whole
    let limit = 2.0 * 10.0 * (2.0 / 3.0 * h * h) / (2.0 * 1.04) * h / 3f64.sqrt() / 1.04f64.sqrt();
    let loaded = |part: f64| free(Phase::until(1.0).load([2], [0.0, -part * limit]));
    let half = solve(&loaded(0.45));
    let on = loaded(0.9).starting_from(&half.trajectory().state(half.sample()));
    let curve = on.equilibrium(&steps(2)).unwrap();
    let at_once = solve(&loaded(0.9));
    assert!((curve.displacements()[3] - at_once.displacements()[3]).abs() < 1e-10);
    // the load factor leads from the one load to the other
    let between = &curve.trajectory().samples()[1].u;
    let expected = solve(&loaded(0.675));
    assert!((between[3] - expected.displacements()[3]).abs() < 1e-10);
    // a bar that starts stretched is held so
    let stretched =
        Scene::new(bar(Strain::Green)).phase(Phase::until(1.0).hold("left").hold("right"));
    let stretched = stretched.initial_displacement(|x| vec![0.1 * x[0]; x.len()]);
    let u = solve(&stretched).displacements().to_vec();
    let right = u.iter().copied().fold(0.0, f64::max);
    assert!((right - 0.01).abs() < 1e-12, "{u:?}");
}

/// Where Newton's method fails, damped motion comes to the same equilibrium.
#[test]
fn damped_motion_is_the_last_resort() {
    let scene = strip(|body| {
        Scene::new(body).phase(Phase::until(1.0).hold("left").load_total("right", [0.0, -2e-3]))
    });
    let found = solve(&scene);
    let hasty = Statics { max_iterations: 2, min_load_step: 1.0, ..Statics::default() };
    let damped = scene.equilibrium(&hasty).unwrap();
    assert_eq!((found.damped_steps, damped.damped_steps), (0, 1));
    assert!(damped.to_string().contains("found by damped motion"), "{damped}");
    let apart = damped.displacements().iter().zip(found.displacements());
    let apart = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("{damped}, {apart} m apart");
    assert!(apart < 1e-7 * STRIP[0], "{apart}");
}

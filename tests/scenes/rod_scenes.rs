//! The scenes of rods that come with the crate, in short versions, against closed forms and invariants.

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use pliant::{Sampling, SceneFile, Trajectory};

const G: f64 = 9.81;

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"))
}

/// The scene of a file with other values for some keys. As it is written it has no warnings.
fn read(name: &str, set: &[&str]) -> SceneFile {
    let file = SceneFile::read(path(name)).unwrap();
    assert_eq!(file.scene.warnings(), Vec::<String>::new(), "{name}");
    let set: Vec<String> = set.iter().map(|&set| set.into()).collect();
    SceneFile::read_with(path(name), &set).unwrap()
}

fn run(file: &SceneFile, end: f64) -> Trajectory {
    let scene = file.scene.clone().ended_at(end);
    scene.simulate(&file.settings, &file.output.sampling()).unwrap()
}

/// By how much the balance of energy is off at the end, relative to what was exchanged.
fn unbalanced(motion: &Trajectory) -> f64 {
    let [first, last] = [&motion.samples()[0].energy, &motion.last().energy];
    let stored = |energy: &pliant::Energy| {
        energy.kinetic + energy.strain + energy.gravity + energy.contact + energy.springs
    };
    let exchanged = last.supplied.abs() + last.dissipated.abs();
    (stored(last) - stored(first) - last.supplied + last.dissipated).abs() / exchanged
}

/// Without its weight the arm is bent by one tendon to an arc of the curvature k = T e/(E I), towards its side, with the distance e of chords between places
/// that are s apart, k s^2/12 more than that of the places in the mean. All three together press it, by 3 T/(E A).
#[test]
fn three_tendons_bend_an_arm_to_their_sides() {
    let (length, radius, arm, young) = (0.3, 0.008, 0.006, 5e5);
    let bending = young * PI / 4.0 * f64::powi(radius, 4);
    for (k, tendon) in [(0.0, "first"), (1.0, "second"), (2.0, "third")] {
        let pull = format!("phase.1.actuate=[{{ springs = \"{tendon}\", force = 0.2 }}]");
        let file = read("three-tendon-arm", &["gravity=[0.0, 0.0, 0.0]", &pull]);
        let rest = file.equilibrium().unwrap();
        let [x, y, z, turn_x, turn_y, ..] = rest.sample().sensors[..] else { panic!() };
        let curvature = 0.2 * arm / (bending - 0.2 * f64::powi(0.1 * length, 2) / 12.0);
        let expected = curvature * length;
        let (side, turn) = ((TAU * k / 3.0).sin_cos(), turn_x.hypot(turn_y));
        // the axis of the arm is pressed, too
        let along = length * (1.0 - 0.2 / (young * PI * radius * radius));
        let aside = along / turn * (1.0 - turn.cos());
        println!("{tendon}: {x} {y} {z}, {turn} rad of {expected}, {aside} aside");
        // 2e-5 was found
        assert!((turn / expected - 1.0).abs() < 1e-4, "{turn} {expected}");
        let off = (x - aside * side.1).hypot(y - aside * side.0);
        assert!(off < 1e-5 * length, "{off}");
    }
    let pull = "phase.1.actuate=[{ springs = [\"first\", \"second\", \"third\"], force = 0.2 }]";
    let rest = read("three-tendon-arm", &["gravity=[0.0, 0.0, 0.0]", pull]).equilibrium().unwrap();
    let [x, y, z, ..] = rest.sample().sensors[..] else { panic!() };
    let expected = length * 3.0 * 0.2 / (young * PI * radius * radius);
    println!("{x} {y} {z}, of {expected}");
    assert!(x.hypot(y) < 1e-9 && (z / expected - 1.0).abs() < 1e-9, "{x} {y} {z}");
}

/// What a catheter takes up in bending as it is pushed into a bend, EI/(2 R^2) for each length, lies between those of the radii of both walls; so does the
/// mean push, which damping makes larger by some per cent.
#[test]
fn a_catheter_takes_up_energy_of_bending_in_a_bend() {
    let file = read("catheter", &[]);
    let motion = run(&file, 0.5);
    let at = |time: f64| motion.samples().iter().find(|s| (s.time - time).abs() < 1e-9).unwrap();
    let pushed = 0.1 * (0.5 - 0.35);
    let gained = (at(0.5).energy.strain - at(0.35).energy.strain) / pushed;
    let bending = 5e7 * PI / 4.0 * 0.0008_f64.powi(4);
    // its axis along the inner and along the outer wall
    let [most, least] = [0.0308, 0.0322].map(|radius| bending / (2.0 * radius * radius));
    println!("{gained} N within {least} and {most} N; balance off by {}", unbalanced(&motion));
    // the ends of the bend and the walls that give way: 5 %
    assert!(gained > 0.95 * least && gained < 1.05 * most, "{gained} {least} {most}");
    assert!(unbalanced(&motion) < 1e-3);
}

/// The fingers bear the weight of the disc once they have lifted it off the floor.
#[test]
fn fingers_bear_a_disc() {
    let file = read("rod-gripper", &[]);
    let motion = run(&file, 0.7);
    let bodies: Vec<f64> = file.scene.body().parts().map(|part| part.body.mass()).collect();
    let weight = bodies[0] * G;
    let [_, y, on_it] = motion.last().sensors[..] else { panic!() };
    println!("{:?} of {weight} N", motion.last().sensors);
    // lifted, and still settling by 1 %
    assert!(y > 5e-4 && (on_it / weight - 1.0).abs() < 0.03, "{y} {on_it} {weight}");
    assert!(unbalanced(&motion) < 1e-3, "{}", unbalanced(&motion));
}

/// A coarser rope, let go at half the way: it falls, and the floor bears its weight.
#[test]
fn a_floor_bears_a_rope() {
    let set = ["rod.1.elements=20", "phase.1.until=0.5", "phase.2.until=1.1", "solver.rtol=1e-4"];
    let file = read("rope-pile", &set);
    let motion = run(&file, 1.1);
    let weight = file.scene.body().mass() * G;
    let late: Vec<f64> =
        motion.samples().iter().filter(|s| s.time > 0.9).map(|s| s.sensors[0]).collect();
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    println!("{late:?}: {mean} of {weight} N; balance off by {}", unbalanced(&motion));
    assert!((mean / weight - 1.0).abs() < 0.05, "{mean} {weight}");
    assert!(unbalanced(&motion) < 1e-3);
}

/// The machine goes on by its legs, and not without friction: there its centre of mass stays where it is. Its motors supply what is dissipated.
#[test]
fn a_machine_walks_by_friction() {
    let set = ["solver.rtol=1e-3"];
    let gained = |set: &[&str]| {
        let file = read("walking-machine", set);
        let scene = file.scene.clone().ended_at(0.8);
        let motion = scene.simulate(&file.settings, &Sampling::every(0.1)).unwrap();
        let body = scene.body();
        let at = |number: usize| body.centre_of_mass(&motion.samples()[number].u)[0];
        println!("{}", unbalanced(&motion));
        assert!(unbalanced(&motion) < 1e-2);
        at(8) - at(3)
    };
    let walks = gained(&set);
    let on_ice = gained(&["solver.rtol=1e-3", "obstacle.1.friction_coefficient=0.0"]);
    println!("{walks} m, on ice {on_ice} m");
    assert!(walks > 0.08 && on_ice.abs() < 1e-6, "{walks} {on_ice}");
}

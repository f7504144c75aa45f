//! Checkpoints in files: what goes on from a file is, bit by bit, what goes on from memory.

use std::fs;
use std::path::{Path, PathBuf};

use pliant::samples::{SQUARE_MATERIAL, square_jump};
use pliant::{
    Axis, Body, Cells, Chamber, Energy, Material, Mesh, Method, Obstacle, Phase, Prescribed,
    Sampling, Scene, Selection, Settings, Signal, Simulation, Spring, Strain,
};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{apart, settings};

/// A clamped beam of rubber in the plane, its lower side within a floor, with a chamber and a spring.
pub fn beam() -> Scene {
    let mesh = Mesh::rectangle([0.1, 0.02], [11, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green);
    let floor = Obstacle::half_plane([0.0, 0.0003], [0.0, 1.0]).stiffness(500.0).named("floor");
    Scene::new(body.build().unwrap())
        .chamber(Chamber::within("inside", [1, 11, 33, 23]))
        .spring(Spring::between([11], [23]).named("tendon"))
        .obstacle(floor)
        .gravity([0.0, -9.8])
}

/// The beam with functions, paths and tables of the scene in the phase where commands come.
pub fn driven() -> Scene {
    let sway = |t: f64| Prescribed {
        displacement: 1e-4 * (1.0 - (100.0 * (t - 0.01)).cos()),
        velocity: 1e-2 * (100.0 * (t - 0.01)).sin(),
        acceleration: (100.0 * (t - 0.01)).cos(),
    };
    let drive = Phase::until(0.1)
        .named("drive")
        .hold_axes("left", [Axis::X])
        .follow([1, 12, 23], Axis::Y, sway)
        .hold_combination([(5, Axis::X, 1.0), (27, Axis::X, -1.0)])
        .load_with([22], |t| [0.0, 0.02 * (200.0 * t).sin()])
        .load_table([33], [0.0, 0.05], [[0.0, 0.0], [0.01, 0.0]])
        .load_total("top", [0.0, -0.01])
        .pressure_with("inside", |t| 500.0 * (1.0 + (50.0 * t).sin()))
        .actuate_with(["tendon"], |t| -0.1 * t);
    beam().phase(Phase::until(0.01).hold("left").named("rest")).phase(drive)
}

/// Commands of all kinds, to a state within a step; node 33 is held while it moves, so that it still swings
/// about its place.
pub fn command(beam: &mut Simulation) {
    beam.advance_to(0.012).unwrap();
    beam.contact("floor", false).unwrap();
    beam.move_nodes([33], [0.0, 0.1]).unwrap();
    beam.move_obstacle("floor", [0.0, 0.02]).unwrap();
    beam.advance_to(0.015).unwrap();
    beam.actuate("tendon", Signal::ramp(0.0, -0.2, 0.015, 0.01)).unwrap();
    beam.load([20, 21], [0.0, 0.02]).unwrap();
    let tip =
        Selection::Box { min: vec![0.085, f64::NEG_INFINITY], max: vec![f64::INFINITY, 0.001] };
    beam.load(tip, [0.01, 0.0]).unwrap();
    beam.hold([33]).unwrap();
    beam.advance_to(0.0155).unwrap();
    beam.pressure("inside", 1e3).unwrap();
    beam.advance_to(0.0163).unwrap();
}

/// Displacements, velocities, energies.
fn state(simulation: &Simulation) -> (Vec<f64>, Vec<f64>, Energy) {
    let view = simulation.view();
    (view.displacements().into(), view.velocities().into(), simulation.energy())
}

/// Goes on, with a command on the way, and looks now and then.
fn go_on(beam: &mut Simulation) -> Vec<(Vec<f64>, Vec<f64>, Energy)> {
    let mut seen = vec![state(beam)];
    beam.advance_to(0.02).unwrap();
    seen.push(state(beam));
    beam.release([33]).unwrap();
    beam.contact("floor", true).unwrap();
    beam.actuate("tendon", 0.1).unwrap();
    beam.advance_to(0.025).unwrap();
    seen.push(state(beam));
    seen
}

pub fn folder() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kept/beam.json");
    (folder, path)
}

/// Writes the checkpoint and restores it in a simulation of `scene`, made anew, that has just begun.
fn handed_over(
    simulation: &Simulation,
    scene: &Scene,
    settings: &Settings,
    path: &Path,
) -> Simulation {
    simulation.checkpoint().write(path).unwrap();
    let mut other = scene.start(settings).unwrap();
    let checkpoint = other.read_checkpoint(path).unwrap();
    assert_eq!(checkpoint.time(), simulation.time());
    other.restore(&checkpoint).unwrap();
    assert_eq!((other.time(), other.phase()), (simulation.time(), simulation.phase()));
    other
}

/// By every method, with commands of every kind in force: bit by bit as from memory; and, to the tolerances of
/// new starts, as the run that nobody interrupted. (Measured: 6e-7 at most.)
#[test]
fn from_a_file_the_motion_goes_on_as_from_memory() {
    let (_folder, path) = folder();
    let scene = driven();
    for method in Method::ALL {
        let settings = settings(method, 1e-7);
        let mut beam = scene.start(&settings).unwrap();
        command(&mut beam);
        let kept = beam.checkpoint();
        let mut other = handed_over(&beam, &driven(), &settings, &path);
        let undisturbed = go_on(&mut beam);
        beam.restore(&kept).unwrap();
        let from_memory = go_on(&mut beam);
        let from_file = go_on(&mut other);
        assert!(from_file == from_memory, "{method}");
        let off = undisturbed.iter().zip(&from_file).map(|(a, b)| apart(&a.0, &b.0));
        let off = off.fold(0.0, f64::max);
        println!("{method}: {off:.1e}");
        assert!(off < 2e-6, "{method}: {off:e}");
        // and on into what the scene has next
        for simulation in [&mut beam, &mut other] {
            simulation.advance_to(0.03).unwrap();
        }
        assert!(state(&beam) == state(&other), "{method}");
    }
}

/// From file to file, a command each: `auto` leaves BDF with the same command as where no file was, and a file that is
/// read and written is the same.
#[test]
fn files_are_handed_on_from_process_to_process() {
    let (_folder, path) = folder();
    let settings = settings(Method::Auto, 1e-5);
    let mesh = Mesh::rectangle([0.1, 0.01], [11, 3], Cells::Rectangles).unwrap();
    let rubber = Material { viscosity: 2e4, ..SQUARE_MATERIAL };
    let body = Body::new(mesh, rubber).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let scene = Scene::new(body).phase(Phase::until(1.0).hold("left"));
    let mut beam = scene.start(&settings).unwrap();
    let mut methods = Vec::new();
    for k in 1..=6 {
        let mut other = handed_over(&beam, &scene, &settings, &path);
        let before = fs::read(&path).unwrap();
        other.checkpoint().write(&path).unwrap();
        assert_eq!(before, fs::read(&path).unwrap());
        let kept = beam.checkpoint();
        beam.restore(&kept).unwrap();
        let [ours, theirs] = [&mut beam, &mut other].map(|simulation| {
            simulation.load("right", [0.0, 1e-3 * f64::from(k)]).unwrap();
            simulation.advance_by(1.5e-3).unwrap();
            let phase = simulation.report().phases.pop().unwrap();
            (state(simulation), phase.method, phase.reason)
        });
        assert!(ours == theirs, "command {k}: {:?} {:?}", ours.2, theirs.2);
        methods.push(ours.1);
    }
    use Method::{Arkode, CvodeBdf};
    assert_eq!(methods, [CvodeBdf, CvodeBdf, CvodeBdf, Arkode, Arkode, Arkode]);
}

/// A node that is held while it moves swings back to where it was when it was held, whatever comes in between.
#[test]
fn what_is_held_is_held_where_it_was() {
    let (_folder, path) = folder();
    let mesh = Mesh::rectangle([0.05, 0.05], [3, 3], Cells::Rectangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let scene = Scene::new(body).initial_velocity(|_| vec![1.0, 0.0]).phase(Phase::until(0.2));
    let settings = Settings { alpha: 1e3, ..settings(Method::Arkode, 1e-8) };
    let mut square = scene.start(&settings).unwrap();
    square.advance_to(0.01).unwrap();
    square.hold("all").unwrap();
    square.advance_to(0.011).unwrap();
    // u = v t exp(-alpha t) beyond 0.01 m
    let off = square.view().displacements()[0] - (0.01 + 1e-3 * (-1.0_f64).exp());
    assert!(off.abs() < 1e-9, "{off}");
    let mut other = handed_over(&square, &scene, &settings, &path);
    let kept = square.checkpoint();
    square.release("all").unwrap();
    square.restore(&kept).unwrap();
    for simulation in [&mut square, &mut other] {
        simulation.advance_to(0.05).unwrap();
        let off = simulation.view().displacements()[0] - 0.01;
        assert!(off.abs() < 1e-9, "{off}");
    }
}

/// Samples after the checkpoint are forgotten, those before stay; none is taken twice.
#[test]
fn samples_after_a_checkpoint_are_forgotten() {
    let (_folder, path) = folder();
    let settings = settings(Method::Arkode, 1e-3);
    let mut square = square_jump(4).unwrap().start(&settings).unwrap();
    square.record(&Sampling::every(0.001)).unwrap();
    square.advance_to(0.6005).unwrap();
    let mut other = handed_over(&square, &square_jump(4).unwrap(), &settings, &path);
    other.record(&Sampling::every(0.001)).unwrap();
    let kept = square.checkpoint();
    square.advance_to(0.62).unwrap();
    square.restore(&kept).unwrap();
    for (simulation, first) in [(&mut square, 0.001), (&mut other, 0.601)] {
        simulation.advance_to(0.63).unwrap();
        let times: Vec<f64> = simulation.trajectory().samples().iter().map(|s| s.time).collect();
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
        assert!((times[1] - first).abs() < 1e-9, "{}", times[1]);
    }
    let names = |simulation: &Simulation| -> Vec<String> {
        simulation.report().phases.iter().map(|phase| phase.name.clone()).collect()
    };
    assert_eq!(names(&square), ["push", "hold", "free"].map(String::from)[..names(&square).len()]);
    assert_eq!(names(&other).last(), names(&square).last());
    assert_eq!(names(&other).len(), 1);
}

/// A file of the format before, in which inputs of the phase stand by their quantities, is the same checkpoint.
#[test]
fn files_of_the_format_before_are_read() {
    let (_folder, path) = folder();
    let settings = settings(Method::Arkode, 1e-5);
    let mut beam = driven().start(&settings).unwrap();
    command(&mut beam);
    beam.checkpoint().write(&path).unwrap();
    let mut file: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    let in_force = file["in_force"].as_object_mut().unwrap();
    let mut lists = [vec![], vec![], vec![]];
    for input in in_force.remove("inputs").unwrap().as_array().unwrap() {
        let [quantity, target, signal] = [0, 1, 2].map(|k| &input[k]);
        match quantity.as_str() {
            Some("actuation") => lists[0].push(json!([target["named"], signal["number"]])),
            Some("pressure") => lists[1].push(json!([target["named"][0], signal["number"]])),
            _ => lists[2].push(json!([target["nodes"], quantity["load"], signal["vector"]])),
        }
    }
    assert!(lists.iter().all(|list| !list.is_empty()));
    for (name, list) in ["actuations", "pressures", "loads"].into_iter().zip(lists) {
        in_force.insert(name.into(), list.into());
    }
    file["format"] = json!(5);
    fs::write(&path, serde_json::to_vec(&file).unwrap()).unwrap();
    let mut other = driven().start(&settings).unwrap();
    let checkpoint = other.read_checkpoint(&path).unwrap();
    other.restore(&checkpoint).unwrap();
    let kept = beam.checkpoint();
    beam.restore(&kept).unwrap();
    assert_eq!(go_on(&mut beam), go_on(&mut other));
}

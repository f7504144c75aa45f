//! Devices, against the forces that they stand for: wind as a fluid that flows, and the jet of the example `own_device`, which is not of
//! the crate, as a load.

#[path = "../../examples/own_device/jet.rs"]
mod jet;

use std::path::Path;

use jet::Jet;
use pliant::simulate::Reading;
use pliant::{
    Body, Cells, DeviceTable, Fluid, Material, Mesh, Method, Phase, Sampling, Scene, SceneFile,
    SceneReader, Settings, Signals, Statics, Strain, Trajectory, Wind,
};

const RUBBER: Material = Material { density: 1100.0, young: 2e5, poisson: 0.4, viscosity: 400.0 };
/// Half of pi.
const UP: f64 = std::f64::consts::FRAC_PI_2;

fn strip() -> Scene {
    let mesh = Mesh::rectangle([0.01, 0.1], [3, 9], Cells::Triangles6).unwrap();
    Scene::new(Body::new(mesh, RUBBER).thickness(0.02).strain(Strain::Green).build().unwrap())
}

fn gust(t: f64) -> [f64; 2] {
    [6.0 * (5.0 * t).sin().powi(2), -1.0]
}

fn largest_apart(a: &Trajectory, b: &Trajectory) -> f64 {
    let pairs = a.samples().iter().zip(b.samples());
    let apart = pairs.flat_map(|(a, b)| a.u.iter().zip(&b.u).map(|(a, b)| (a - b).abs()));
    apart.fold(0.0, f64::max)
}

/// The same drag on the same faces, whoever says how fast the air is: in the phase, at rest, and what sensors read.
#[test]
fn wind_is_a_fluid_that_flows() {
    for method in [Method::Auto, Method::Ida] {
        let settings = Settings { method, rtol: 1e-4, ..Settings::default() };
        let phase = || Phase::until(0.4).hold("bottom");
        let air = Fluid::new(1.2).named("air").drag(0.7, 0.01);
        let fluid = strip().fluid(air.velocity_with(gust)).phase(phase());
        let wind = strip().device(Wind::new("air").drag(0.7, 0.01)).phase(phase().device_input(
            "air",
            &Wind::VELOCITY,
            Signals::function(gust),
        ));
        let every = Sampling::every(0.05);
        let force = every.clone().read("force", Reading::fluid_force("air"));
        let expected = fluid.simulate(&settings, &force).unwrap();
        let force = every.read("force", Reading::device("air", &Wind::FORCE));
        let found = wind.simulate(&settings, &force).unwrap();
        let tip = |motion: &Trajectory| {
            motion.samples().iter().flat_map(|s| &s.u).fold(0.0_f64, |a, u| a.max(u.abs()))
        };
        assert!(tip(&expected) > 0.02, "{}", tip(&expected));
        // the same sums in the same order
        assert_eq!(largest_apart(&expected, &found), 0.0, "{method}");
        for (a, b) in expected.samples().iter().zip(found.samples()) {
            assert_eq!(a.sensors, b.sensors, "{method}");
            assert_eq!(a.energy.supplied, b.energy.supplied, "{method}");
        }
    }
    let at_rest = |scene: &Scene| scene.equilibrium(&Statics::default()).unwrap();
    let air = Fluid::new(1.2).drag(0.7, 0.0).velocity([6.0, 0.0]);
    let fluid = strip().fluid(air).phase(Phase::until(1.0).hold("bottom"));
    let expected = at_rest(&fluid);
    let phase = Phase::until(1.0).hold("bottom");
    let phase = phase.device_input("air", &Wind::VELOCITY, [6.0, 0.0]);
    let wind = strip().device(Wind::new("air").drag(0.7, 0.0)).phase(phase);
    let found = at_rest(&wind);
    let size = expected.displacements().iter().fold(0.0_f64, |a, u| a.max(u.abs()));
    for (a, b) in expected.displacements().iter().zip(found.displacements()) {
        assert!((a - b).abs() < 1e-9 * size, "{a} {b}");
    }
    // a finer mesh has it, too
    let [expected, found] = [&fluid, &wind].map(|scene| at_rest(&scene.halved().unwrap()));
    for (a, b) in expected.displacements().iter().zip(found.displacements()) {
        assert!((a - b).abs() < 1e-9 * size, "finer: {a} {b}");
    }
}

/// The leaf of the scene file is bent by the gust and swings back against it: the drag at its peak is less than that of a plate that stands,
/// 2 C_n rho/2 v^2 A, as it has turned along the wind.
#[test]
fn a_gust_bends_a_leaf() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gust.toml");
    let file = SceneFile::read_with(path, &["output.step=0.25".into()]).unwrap();
    let scene = file.scene.ended_at(1.5);
    let settings = Settings { rtol: 1e-4, ..file.settings };
    let motion = scene.simulate(&settings, &file.output.sampling()).unwrap();
    let peak = &motion.samples()[3];
    let [x, drag] = [peak.sensors[0], peak.sensors[2]];
    let standing = 2.0 * 0.7 * 0.5 * 1.2 * 81.0 * 0.1 * 0.03;
    println!("tip at {x} m, drag {drag} N of {standing} N");
    assert!(x > 0.05 && drag > 0.1 * standing && drag < 0.6 * standing, "{x} {drag}");
    assert!(motion.last().sensors[0] < 0.02, "{:?}", motion.last().sensors);
}

fn with_jet(text: &str) -> Result<SceneFile, pliant::Error> {
    let path = std::env::temp_dir().join(format!("jet-{}-{}.toml", std::process::id(), text.len()));
    std::fs::write(&path, text).unwrap();
    let file = SceneReader::new(&[DeviceTable::of::<Jet>("jet")]).read_with(&path, &[]);
    std::fs::remove_file(&path).unwrap();
    file
}

fn own_scene() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/own_device/scene.toml");
    std::fs::read_to_string(path).unwrap()
}

/// The jet pushes as the load of its formulas does; its power is that of the load.
#[test]
fn a_jet_pushes_as_a_load() {
    let scene = with_jet(&own_scene()).unwrap().scene;
    let thrust = |t: f64| 0.02 * (t / 0.5_f64).min(1.0);
    let angle = |t: f64| UP + 0.5 * (6.0 * t).sin();
    let load = move |t: f64| [thrust(t) * angle(t).cos(), thrust(t) * angle(t).sin()];
    let nodes = scene.body().mesh().select(&"right".into()).unwrap().len() as f64;
    let each = move |t| load(t).map(|f| f / nodes);
    let loaded = Scene::new(scene.body().clone())
        .phase(Phase::until(0.5).hold("left").load_with("right", each))
        .phase(Phase::until(2.0).hold("left").load_with("right", each));
    let settings = Settings { rtol: 1e-7, ..Settings::default() };
    let sampling = Sampling::every(0.1).read("power", Reading::device("tail", &Jet::POWER));
    let found = scene.simulate(&settings, &sampling).unwrap();
    let expected = loaded.simulate(&settings, &Sampling::every(0.1)).unwrap();
    let apart = largest_apart(&found, &expected);
    let most = found.samples().iter().flat_map(|s| &s.u).fold(0.0_f64, |a, u| a.max(u.abs()));
    println!("{apart:e} of {most:e}");
    assert!(most > 0.01 && apart < 1e-5 * most, "{apart:e} of {most:e}");
    // the work of the jet is what was supplied
    let end = &found.last().energy;
    assert!((end.supplied / expected.last().energy.supplied - 1.0).abs() < 1e-5);
    // by the trapezoidal rule over samples of its sensor: 1e-3 of it
    let fine = Sampling::every(0.002).read("power", Reading::device("tail", &Jet::POWER));
    let fine = scene.simulate(&settings, &fine).unwrap();
    let work: f64 = fine
        .samples()
        .windows(2)
        .map(|pair| 0.5 * (pair[1].time - pair[0].time) * (pair[0].sensors[0] + pair[1].sensors[0]))
        .sum();
    assert!((work / end.supplied - 1.0).abs() < 1e-3, "{work:e} {:e}", end.supplied);
}

/// Commands set inputs, checkpoints hold them, and files of checkpoints, too.
#[test]
fn commands_stand_in_checkpoints() {
    let scene = with_jet(&own_scene()).unwrap().scene;
    let settings = Settings::default();
    let mut simulation = scene.start(&settings).unwrap();
    simulation.advance_to(0.2).unwrap();
    simulation.device_input("tail", "thrust", 0.03).unwrap();
    simulation.device_input("tail", "angle", UP).unwrap();
    simulation.advance_to(0.3).unwrap();
    simulation.device_input("tail", "thrust", -0.03).unwrap();
    let path = std::env::temp_dir().join(format!("jet-{}.checkpoint.json", std::process::id()));
    let kept = simulation.checkpoint();
    kept.write(&path).unwrap();
    let mut copy = scene.start(&settings).unwrap();
    let read = copy.read_checkpoint(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    // the one in memory and the one of the file go on alike
    simulation.restore(&kept).unwrap();
    copy.restore(&read).unwrap();
    for simulation in [&mut simulation, &mut copy] {
        simulation.advance_to(0.5).unwrap();
    }
    assert_eq!(simulation.sample().unwrap().u, copy.sample().unwrap().u);
    // pushed down since then
    assert!(simulation.view().velocity("right").unwrap()[1] < 0.0);
}

#[test]
fn what_does_not_fit_is_an_error() {
    let text = own_scene();
    for (old, new, expected) in [
        ("input = \"thrust\"", "input = \"trust\"", "did you mean \"thrust\""),
        ("device = \"tail\", input = \"angle\"", "device = \"tale\", input = \"angle\"", "tail"),
        ("nozzle = \"right\"", "nozzle = \"right\"\nthrust = 3", "unknown field `thrust`"),
        ("output = \"power\"", "output = \"force\"", "power"),
        ("values = [0.0, 0.02]", "values = [0.0, [1.0, 2.0]]", "a number"),
        ("nozzle = \"right\"", "nozzle = \"rigth\"", "right"),
    ] {
        assert!(text.contains(old), "{old}");
        let Err(error) = with_jet(&text.replace(old, new)) else { panic!("{new}") };
        let error = error.to_string();
        assert!(error.contains(expected), "{new}: {error}");
    }
    // files with tables of others are read with these alone
    let error = SceneFile::parse(&text, Path::new("a.toml")).unwrap_err().to_string();
    assert!(error.contains("a.toml:10: jet: unknown key"), "{error}");
    let phase =
        |value: [f64; 2]| Phase::until(1.0).hold("bottom").device_input("air", &Jet::THRUST, value);
    let scene = strip().device(Wind::new("air").drag(0.7, 0.0)).phase(phase([1.0, 0.0]));
    let error = scene.validate().unwrap_err().to_string();
    assert!(error.contains("thrust") && error.contains("velocity"), "{error}");
    let phase = Phase::until(1.0).hold("bottom").device_input("air", &Wind::VELOCITY, 3.0);
    let scene = strip().device(Wind::new("air").drag(0.7, 0.0)).phase(phase);
    let error = scene.validate().unwrap_err().to_string();
    assert!(error.contains("it needs 2 component(s) (m/s)"), "{error}");
    let wind = || Wind::new("air").drag(0.7, 0.0);
    let two = strip().device(wind()).device(wind());
    let error = two.phase(Phase::until(1.0)).validate().unwrap_err().to_string();
    assert!(error.contains("device name = \"air\"") && error.contains("taken"), "{error}");
}

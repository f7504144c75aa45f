//! Dipoles against closed forms: the pull of coaxial magnets, the motion of a point-like magnet, the uniform field far away, and the energy that a
//! magnet supplies as it passes.

use crate::common::run;
use pliant::{
    Body, Cells, Dipole, Error, Magnet, Material, Mesh, Method, Phase, Plane, Sampling, Scene,
    Settings, Signals, SolidCells, Statics, simulate::Reading,
};
use serde_json::{Value, json};

/// mu_0 (T m/A)
const VACUUM: f64 = 1.256_637_062_12e-6;

/// The pull of coaxial dipoles at the distance r is 3 mu_0 m_1 m_2/(2 pi r^4). On a block of the length 2 a and the width a along the axis it is the mean
/// of that over the block, which by Taylor's theorem, as the field has no sources, is (1 + (4 - 1) 20/24 (a/r)^2) times as
/// large, to order (a/r)^4.
#[test]
fn coaxial_magnets_pull_each_other() {
    let (a, remanence, moment) = (0.01, 1.3, 2.0);
    let mesh = Mesh::cuboid([a, a, 2.0 * a], [3, 3, 5], SolidCells::Hexahedra).unwrap();
    let body = Body::new(mesh, Material::rigid(7500.0)).build().unwrap();
    let (mass, until) = (7500.0 * 2.0 * a.powi(3), 1e-5);
    let own = remanence * 2.0 * a.powi(3) / VACUUM;
    let mut last: Option<f64> = None;
    for lengths in [10.0, 20.0, 40.0] {
        let r = lengths * a;
        let place = [0.5 * a, 0.5 * a, a - r];
        let scene = Scene::new(body.clone())
            .magnet(Magnet::new([0.0, 0.0, remanence]))
            .dipole(Dipole::new([0.0, 0.0, moment], place).named("lead"))
            .phase(Phase::until(until));
        let sampling = Sampling::phase_ends()
            .read("pull", Reading::dipole_force("lead"))
            .read("momentum", Reading::momentum());
        let motion = scene.simulate(&Settings::default(), &sampling).unwrap();
        let [x, y, pull, .., momentum] = motion.last().sensors[..] else { panic!() };
        let expected = -3.0 * VACUUM * own * moment / (2.0 * std::f64::consts::PI * r.powi(4));
        let off = pull / expected - 1.0;
        let part = off * (r / a).powi(2);
        let speed = momentum / (expected * until) - 1.0;
        println!("{lengths} a: {pull} N, off by {off:.2e} = {part} (a/r)^2, {speed:.2e}, {mass}");
        assert!(x.abs().max(y.abs()) < 1e-12 * pull.abs(), "{x} {y}");
        // 1.65 (a/r)^2 were found, the next order
        assert!((part - 2.5).abs() < 2.0 / lengths.powi(2), "{part}");
        assert!((speed - off).abs() < 1e-6, "{speed} {off}");
        if let Some(before) = last.replace(off) {
            assert!((before / off / 4.0 - 1.0).abs() < 0.01, "{before} {off}");
        }
    }
}

/// The rates of the place and the angle of a point-like magnet of the moment `own`, mass and moment of inertia in the plane beside a dipole at the origin along y,
/// and of their rates.
fn rates(y: [f64; 6], [own, moment, mass, inertia]: [f64; 4]) -> [f64; 6] {
    let [x, z, angle, ..] = y;
    let factor = VACUUM / (4.0 * std::f64::consts::PI);
    // energy of the pair, and its slopes by differences
    let energy = |x: f64, z: f64, angle: f64| {
        let (r, n) = (x.hypot(z), [angle.cos(), angle.sin()]);
        let across = 3.0 * (n[0] * x + n[1] * z) * z / r.powi(5);
        -factor * own * moment * (across - n[1] / r.powi(3))
    };
    let (h, turn) = (1e-6, 1e-5);
    let fx = -(energy(x + h, z, angle) - energy(x - h, z, angle)) / (2.0 * h);
    let fz = -(energy(x, z + h, angle) - energy(x, z - h, angle)) / (2.0 * h);
    let torque = -(energy(x, z, angle + turn) - energy(x, z, angle - turn)) / (2.0 * turn);
    [y[3], y[4], y[5], fx / mass, fz / mass, torque / inertia]
}

/// A small rigid magnet turns and is pulled by a dipole at rest 25 of its lengths away as a point-like one is, which is integrated by the Runge-Kutta method of order
/// 4. Its kinetic energy is what the dipole has supplied.
#[test]
fn a_free_magnet_turns_and_is_pulled() {
    let (length, height, thickness, remanence, moment) = (0.002, 0.001, 0.001, 1.2, 0.5);
    let mesh = Mesh::rectangle([length, height], [3, 2], Cells::Rectangles).unwrap();
    let mesh = mesh.translated(&[0.05 - 0.5 * length, -0.5 * height]).unwrap();
    let body = Body::new(mesh, Material::rigid(7500.0)).thickness(thickness).build().unwrap();
    let volume = length * height * thickness;
    let mass = 7500.0 * volume;
    let inertia = mass * (length * length + height * height) / 12.0;
    let numbers = [remanence * volume / VACUUM, moment, mass, inertia];
    let (until, steps) = (0.03, 20_000);
    let h = until / f64::from(steps);
    let mut y = [0.05, 0.0, 0.0, 0.0, 0.0, 0.0];
    let ahead = |y: [f64; 6], k: [f64; 6], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
    for _ in 0..steps {
        let a = rates(y, numbers);
        let b = rates(ahead(y, a, 0.5 * h), numbers);
        let c = rates(ahead(y, b, 0.5 * h), numbers);
        let d = rates(ahead(y, c, h), numbers);
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    let scene = Scene::new(body)
        .magnet(Magnet::new([remanence, 0.0]))
        .dipole(Dipole::new([0.0, moment], [0.0, 0.0]))
        .phase(Phase::until(until));
    let sampling = Sampling::phase_ends()
        .read("centre", Reading::centre_of_mass())
        .read("angle", Reading::rotation());
    for method in [Method::CvodeBdf, Method::Rosenbrock] {
        let settings = Settings { method, rtol: 1e-8, ..Settings::default() };
        let motion = scene.simulate(&settings, &sampling).unwrap();
        let last = motion.last();
        let [x, z, angle] = last.sensors[..] else { panic!("{:?}", last.sensors) };
        let pulled = 0.05 - y[0];
        let off = (x - y[0]).hypot(z - y[1]) / pulled.hypot(y[1]);
        let turned = (angle - y[2]).abs();
        let supplied = (last.energy.supplied / last.energy.kinetic - 1.0).abs();
        println!(
            "{method}: {x} {z} {angle}, point-like {y:?}: {off:.1e}, {turned:.1e}, {supplied:.1e}"
        );
        // (1/25)^2 = 1.6e-3 by the size of the magnet, and the tolerance
        assert!(off < 2e-3 && turned < 5e-3 && supplied < 1e-6, "{method}");
    }
}

/// A strip in plane stress of silicone, 20 mm long, magnetized along itself.
fn strip() -> Body {
    let mesh = Mesh::rectangle([0.02, 0.001], [21, 3], Cells::Rectangles9).unwrap();
    let material = Material { density: 2000.0, young: 1e6, poisson: 0.3, viscosity: 5e3 };
    Body::new(mesh, material).thickness(0.005).plane(Plane::Stress).build().unwrap()
}

/// The farther away a dipole of the same field at the strip is, the nearer is what it does to that of a uniform field: the difference, by the gradient, halves as
/// the distance doubles.
#[test]
fn a_dipole_far_away_has_a_uniform_field() {
    let field = 4e-3;
    let scene = || Scene::new(strip()).magnet(Magnet::new([0.1, 0.0]));
    let tip = |scene: Scene| {
        let bent = scene.equilibrium(&Statics::default()).unwrap();
        *bent.trajectory().last().u.last().unwrap()
    };
    let phase = || Phase::until(1.0).hold("left");
    let uniform = tip(scene().phase(phase().magnetic_field([0.0, field])));
    let apart = [0.5, 1.0, 2.0].map(|r: f64| {
        let moment = 2.0 * std::f64::consts::PI * r.powi(3) * field / VACUUM;
        let near = tip(scene().dipole(Dipole::new([0.0, moment], [0.01, -r])).phase(phase()));
        println!("{r} m: {near} m, uniform {uniform} m");
        near / uniform - 1.0
    });
    assert!(uniform > 4e-3 && apart[0].abs() < 0.05, "{uniform} {apart:?}");
    for pair in apart.windows(2) {
        assert!((pair[0] / pair[1] / 2.0 - 1.0).abs() < 0.03, "{apart:?}");
    }
}

/// A magnet passes a strip: it bends to it and back, and what the magnet has supplied in the end is what was dissipated.
#[test]
fn what_a_magnet_that_passes_supplies_is_dissipated() {
    let times = [0.0, 0.1];
    let path = Signals::table(times, [[-0.1, 0.02], [0.14, 0.02]]);
    let scene = Scene::new(strip())
        .magnet(Magnet::new([0.1, 0.0]))
        .dipole(Dipole::new([0.2, 0.0], path))
        .phase(Phase::until(0.1).hold("left"))
        .phase(Phase::until(1.2).hold("left").dipole_moment("dipole 1", [0.0, 0.0]));
    let settings = Settings { rtol: 1e-7, ..Settings::default() };
    let sampling = Sampling::every(0.005);
    let motion = scene.simulate(&settings, &sampling).unwrap();
    let most = motion.samples().iter().map(|s| s.u[s.u.len() - 1].abs()).fold(0.0, f64::max);
    let stored = motion.samples().iter().map(|s| s.energy.strain).fold(0.0, f64::max);
    let energy = &motion.last().energy;
    let left = (energy.supplied / energy.dissipated - 1.0).abs();
    let worst = motion.samples().iter().map(|s| s.energy.balance().abs()).fold(0.0, f64::max);
    println!(
        "bent by {most} m, {stored} J, {energy:?}, left {left:.1e}, worst {:.1e}",
        worst / stored
    );
    assert!(most > 1e-3 && energy.kinetic + energy.strain < 1e-6 * stored);
    assert!(left < 2e-6 && worst < 5e-6 * stored, "{left} {worst}");
}

/// A command that moves a dipole does what a phase with it does, and a checkpoint keeps it.
#[test]
fn dipoles_are_driven() {
    let start = || Scene::new(strip()).magnet(Magnet::new([0.1, 0.0]));
    let scene = |dipole: Dipole| {
        start().dipole(dipole.named("lead")).phase(Phase::until(0.02).hold("left"))
    };
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    let (moment, near) = ([0.0, 0.3], [0.02, 0.03]);
    let given = run(&scene(Dipole::new(moment, near)), &settings, &[]);
    let mut driven = scene(Dipole::new([1.0, 0.0], [5.0, 0.0])).start(&settings).unwrap();
    driven.dipole_position("lead", near).unwrap();
    driven.dipole_moment("lead", moment).unwrap();
    driven.advance_to(0.01).unwrap();
    let kept = driven.checkpoint();
    driven.dipole_position("lead", [0.02, -0.03]).unwrap();
    driven.dipole_position("lead", [0.02, -0.04]).unwrap();
    driven.advance_to(0.02).unwrap();
    driven.restore(&kept).unwrap();
    let view = driven.view();
    assert_eq!(view.dipole_position("lead").unwrap(), near);
    assert_eq!(view.dipole_moment("lead").unwrap(), moment);
    let error = driven.dipole_position("lead", [1.0]).unwrap_err().to_string();
    assert!(error.contains("2 component(s) (m)"), "{error}");
    let error = driven.dipole_moment("other", moment).unwrap_err().to_string();
    assert!(error.contains("\"other\"") && error.contains("lead"), "{error}");
    driven.advance_to(0.02).unwrap();
    let tip = given.last().u.len() - 1;
    let [a, b] = [given.last().u[tip], driven.view().displacements()[tip]];
    println!("{a} m and {b} m");
    assert!(a.abs() > 1e-4 && (a - b).abs() < 3e-9 * a.abs(), "{a} {b}");
    // on it the field is not resolved
    driven = scene(Dipole::new([1.0, 0.0], [5.0, 0.0])).start(&settings).unwrap();
    driven.dipole_position("lead", [0.01, 0.0012]).unwrap();
    let error = driven.advance_to(0.02).unwrap_err().to_string();
    assert!(error.contains("dipole \"lead\"") && error.contains("of a magnet"), "{error}");
}

/// A dipole is a device: inputs and outputs by their words are those of its own words, and sums where there are two.
#[test]
fn dipoles_are_devices() {
    let start = |moment: [f64; 2]| {
        let dipole = Dipole::new(moment, [5.0, 0.0]).named("lead");
        Scene::new(strip()).magnet(Magnet::new([0.1, 0.0])).dipole(dipole)
    };
    let phase = || Phase::until(0.02).hold("left");
    let (near, settings) = ([0.02, 0.03], Settings::default());
    let sampling = Sampling::every(0.005).read("pull", Reading::dipole_force("lead"));
    let own = phase().dipole_position("lead", near).dipole_moment("lead", [0.0, 0.1 + 0.2]);
    let own = start([1.0, 0.0]).phase(own).simulate(&settings, &sampling).unwrap();
    let sampling = Sampling::every(0.005).read("pull", Reading::device("lead", &Dipole::FORCE));
    let device = phase()
        .device_input("lead", &Dipole::POSITION, near)
        .device_input("lead", &Dipole::MOMENT, [0.0, 0.1])
        .device_input("lead", &Dipole::MOMENT, [0.0, 0.2]);
    let device = start([1.0, 0.0]).phase(device).simulate(&settings, &sampling).unwrap();
    for (own, device) in own.samples().iter().zip(device.samples()) {
        assert_eq!(own.sensors, device.sensors);
    }
    let mut driven = start([0.0, 0.3]).phase(phase()).start(&settings).unwrap();
    driven.device_input("lead", "position", near).unwrap();
    driven.advance_to(0.02).unwrap();
    assert_eq!(driven.view().device("lead", "position").unwrap(), near);
    assert_eq!(driven.view().device("lead", "moment").unwrap(), [0.0, 0.3]);
    let view = driven.view();
    assert_eq!(view.device("lead", "force").unwrap(), view.dipole_force("lead").unwrap());
}

/// Files of checkpoints from before dipoles were devices: with quantities of their own, and, before that, in a list of their own.
#[test]
fn files_from_before_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoint.json");
    let dipole = Dipole::new([0.0, 0.3], [0.02, 0.05]).named("lead");
    let scene = Scene::new(strip()).magnet(Magnet::new([0.1, 0.0])).dipole(dipole);
    let scene = scene.phase(Phase::until(0.02).hold("left"));
    let mut driven = scene.start(&Settings::default()).unwrap();
    driven.advance_to(0.005).unwrap();
    driven.dipole_position("lead", [0.02, 0.03]).unwrap();
    driven.dipole_moment("lead", [0.1, 0.3]).unwrap();
    let kept = driven.checkpoint();
    kept.write(&path).unwrap();
    driven.restore(&kept).unwrap();
    driven.advance_to(0.02).unwrap();
    let now: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    let words = |input: &Value| input[0]["input"].as_str().unwrap().to_owned();
    let inputs = now["in_force"]["inputs"].as_array().unwrap();
    let mut quantities = now.clone();
    let old = |i: &Value| json!([{ "dipole": words(i) }, i[1], i[2]]);
    quantities["in_force"]["inputs"] = inputs.iter().map(old).collect();
    let mut list = now.clone();
    let old = |i: &Value| json!(["lead", words(i), i[2]["vector"]]);
    list["format"] = json!(5);
    list["in_force"]["dipoles"] = inputs.iter().map(old).collect();
    list["in_force"].as_object_mut().unwrap().remove("inputs");
    for file in [now, quantities, list] {
        std::fs::write(&path, serde_json::to_vec(&file).unwrap()).unwrap();
        let mut other = scene.start(&Settings::default()).unwrap();
        let read = other.read_checkpoint(&path).unwrap();
        other.restore(&read).unwrap();
        other.advance_to(0.02).unwrap();
        assert_eq!(other.sample().unwrap().u, driven.sample().unwrap().u);
    }
}

#[test]
fn dipoles_that_cannot_be() {
    let refused = |scene: Scene, parts: &[&str]| {
        let error: Error = scene.validate().unwrap_err().into();
        assert!(parts.iter().all(|part| error.to_string().contains(part)), "{error}");
    };
    let phase = || Phase::until(0.1).named("p").hold("left");
    let with = |dipole: Dipole| {
        Scene::new(strip()).magnet(Magnet::new([0.1, 0.0])).dipole(dipole).phase(phase())
    };
    let far = [0.0, 0.1];
    refused(
        with(Dipole::new([1.0], far)),
        &["moment of dipole \"dipole 1\" = [1.0]", "2 component(s) (A m^2)"],
    );
    refused(with(Dipole::new([1.0, 0.0], [0.0; 3])), &["position of", "2 component(s) (m)"]);
    refused(with(Dipole::new([1.0, 0.0], [f64::NAN, 0.0])), &["position of dipole", "NaN"]);
    let wild = Signals::function(|t| [1.0 / t, 0.0]);
    refused(with(Dipole::new(wild, far)), &["the moment of dipole \"dipole 1\" is inf at t = 0 s"]);
    let inside = Dipole::new([1.0, 0.0], [0.0101, 0.0007]);
    refused(with(inside), &["position of dipole", "m from a point of cell", "smaller cells"]);
    refused(
        Scene::new(strip()).dipole(Dipole::new([1.0, 0.0], far)).phase(phase()),
        &["dipole = \"dipole 1\"", "no magnet"],
    );
    let twice = with(Dipole::new([1.0, 0.0], far).named("a"));
    refused(twice.dipole(Dipole::new([1.0, 0.0], far).named("a")), &["dipole name", "\"a\""]);
    let unknown =
        with(Dipole::new([1.0, 0.0], far)).phase(Phase::until(0.2).dipole_position("b", far));
    refused(unknown, &["\"b\"", "dipole 1"]);
    let strong = with(Dipole::new([2e4, 0.0], far));
    let warnings = strong.warnings().join("; ");
    assert!(warnings.contains("20000 A m^2") && warnings.contains("emu"), "{warnings}");
    assert!(strong.unusual(["dipole-moment"]).warnings().is_empty());
}

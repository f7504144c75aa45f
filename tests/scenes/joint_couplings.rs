//! Joints that hold by a stiffness: gears, racks, screws, universal joints and guides on bodies that move, against Lagrange's equations of exact ones.

use pliant::simulate::Reading;
use pliant::{
    Body, Cells, Joint, Material, Mesh, Method, Moments, Phase, RigidMass, Rod, RodSection, Sample,
    Sampling, Scene, Settings, SolidCells,
};

const MASS: f64 = 0.3;
const MOMENT: f64 = 1e-3;

/// A rigid plate around a place, in the plane.
fn plate(name: &str, at: [f64; 2], moment: f64) -> Body {
    let mesh = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Rectangles).unwrap();
    let mesh = mesh.translated(&[at[0] - 0.05, at[1] - 0.05]).unwrap();
    let mass = RigidMass::new(MASS).moments(Moments::Plane(moment));
    Body::new(mesh, Material::rigid_of(mass)).thickness(0.01).named(name).build().unwrap()
}

/// The same in space, a ball by its moments.
fn block(name: &str, at: [f64; 3], moment: f64) -> Body {
    let mesh = Mesh::cuboid([0.1; 3], [2; 3], SolidCells::Hexahedra).unwrap();
    let mesh = mesh.translated(&at.map(|x| x - 0.05)).unwrap();
    let mass = RigidMass::new(MASS).moments(Moments::Principal([moment; 3]));
    Body::new(mesh, Material::rigid_of(mass)).named(name).build().unwrap()
}

fn run(scene: &Scene, sampling: Sampling) -> Vec<Sample> {
    let settings = Settings { method: Method::CvodeBdf, rtol: 1e-8, ..Settings::default() };
    scene.simulate(&settings, &sampling).unwrap().samples().to_vec()
}

fn read(sampling: Sampling, joint: &str, what: &'static pliant::DeviceOutput) -> Sampling {
    sampling.read(joint, Reading::device(joint, what))
}

fn stored(sample: &Sample) -> f64 {
    let energy = &sample.energy;
    energy.kinetic + energy.gravity + energy.springs - energy.supplied
}

/// A torque on the first of two wheels of 12 and 36 teeth: angles in the ratio -1/3, the acceleration of T/(J_1 + J_2/9), over more than a turn.
#[test]
fn a_geared_pair_is_that_of_lagrange() {
    let wheels = [plate("a", [0.0, 0.0], MOMENT), plate("b", [0.2, 0.0], 2.0 * MOMENT)];
    let first = Joint::revolute("first", ["world", "a"], [0.0, 0.0]);
    let second = Joint::revolute("second", ["world", "b"], [0.2, 0.0]);
    let second = second.geared(&first, [12, 36], 200.0, 0.0);
    let torque = 0.05;
    let scene = Scene::new(Body::join(wheels).unwrap()).joint(first).joint(second);
    let scene = scene.phase(Phase::until(0.6).device_input("first", &Joint::TORQUE, torque));
    let sampling = read(Sampling::every(0.1), "first", &Joint::ANGLE);
    let samples = run(&scene, read(sampling, "second", &Joint::ANGLE));
    let rate = torque / (MOMENT + 2.0 * MOMENT / 9.0);
    for sample in &samples {
        let [a, b] = [sample.sensors[0], sample.sensors[1]];
        let expected = 0.5 * rate * sample.time.powi(2);
        println!("{}: {a} of {expected}, {:e}", sample.time, 3.0 * b + a);
        // teeth give way by up to twice the torque on them over their stiffness: 2 T J_2/9 3/(J_1 + J_2/9)/k = 3e-4 rad
        assert!((a - expected).abs() < 4e-4 && (3.0 * b + a).abs() < 1e-3);
    }
    let [first, last] = [&samples[0], &samples[samples.len() - 1]];
    assert!(last.sensors[0] > 6.5, "more than a turn");
    assert!((stored(last) - stored(first)).abs() < 1e-5 * last.energy.kinetic);
}

/// A torque on a pinion with a lead of 2 pi r drives a rack: T/(J + m r^2).
#[test]
fn a_pinion_drives_a_rack() {
    let bodies = [plate("a", [0.0, 0.0], MOMENT), plate("b", [0.0, 0.3], MOMENT)];
    let (radius, torque) = (0.03, 0.02);
    let first = Joint::revolute("first", ["world", "a"], [0.0, 0.0]);
    let rack = Joint::prismatic("rack", ["world", "b"], [0.0, 0.3]).axis([1.0, 0.0]);
    let rack = rack.driven(&first, 2.0 * std::f64::consts::PI * radius, 1e5, 0.0);
    let scene = Scene::new(Body::join(bodies).unwrap()).joint(first).joint(rack);
    let scene = scene.phase(Phase::until(1.0).device_input("first", &Joint::TORQUE, torque));
    let samples = run(&scene, read(Sampling::phase_ends(), "rack", &Joint::DISPLACEMENT));
    let expected = 0.5 * torque / (MOMENT + MASS * radius * radius) * radius;
    let off = samples[samples.len() - 1].sensors[0] / expected - 1.0;
    println!("{off:e}");
    assert!(off.abs() < 1e-4, "{off:e}");
}

/// A nut falls along a screw: x'' = -g m/(m + J (2 pi/p)^2), and a torque of m g p/(2 pi) holds it.
#[test]
fn a_nut_falls_along_a_screw() {
    let (g, lead) = (9.81, 0.2);
    let per_metre = 2.0 * std::f64::consts::PI / lead;
    for (torque, share) in
        [(0.0, MASS / (MASS + MOMENT * per_metre.powi(2))), (MASS * g / per_metre, 0.0)]
    {
        let screw = Joint::screw("screw", ["world", "nut"], [0.0; 3], lead).axis([0.0, 0.0, 1.0]);
        let scene = Scene::new(block("nut", [0.0; 3], MOMENT)).gravity([0.0, 0.0, -g]);
        let scene = scene.joint(screw.bearing(1e6, 200.0));
        let scene = scene.phase(Phase::until(0.3).device_input("screw", &Joint::TORQUE, torque));
        let sampling = read(Sampling::phase_ends(), "screw", &Joint::ANGLE);
        let sampling = sampling.read("height", Reading::centre_of_mass());
        let samples = run(&scene, sampling);
        let last = &samples[samples.len() - 1];
        let expected = -0.5 * share * g * 0.09;
        println!("{torque}: {:?} of {expected} m", last.sensors);
        assert!((last.sensors[3] - expected).abs() < 1e-5);
        assert!((last.sensors[0] - expected * per_metre).abs() < 1e-3);
    }
}

/// Two shafts at an angle of 40 degrees with a universal joint between them: tan a_2 = cos beta tan a_1, as the axis of the cross in the first shaft is at first normal to
/// the plane of both.
#[test]
fn a_universal_joint_turns_as_hookes_does() {
    let tilt = 40.0_f64.to_radians();
    let axis = [tilt.cos(), tilt.sin(), 0.0];
    let bodies = [block("a", [-0.1, 0.0, 0.0], MOMENT), block("b", axis.map(|x| 0.1 * x), MOMENT)];
    let first = Joint::revolute("first", ["world", "a"], [-0.1, 0.0, 0.0]).axis([1.0, 0.0, 0.0]);
    let second = Joint::revolute("second", ["world", "b"], axis.map(|x| 0.1 * x)).axis(axis);
    // normal to the plane in the first, in the plane and across the axis in the second
    let crossed = [[0.0, 0.0, 1.0], [-tilt.sin(), tilt.cos(), 0.0]];
    let cross = Joint::universal("cross", ["a", "b"], [0.0; 3], crossed).bearing(1e3, 0.0);
    let scene = Scene::new(Body::join(bodies).unwrap()).joint(first).joint(second).joint(cross);
    let scene = scene.phase(Phase::until(0.3).device_input("first", &Joint::TORQUE, 0.1));
    let sampling = read(Sampling::every(0.03), "first", &Joint::ANGLE);
    let samples = run(&scene, read(sampling, "second", &Joint::ANGLE));
    for sample in &samples {
        let [a, b] = [sample.sensors[0], sample.sensors[1]];
        let expected = (tilt.cos() * a.sin()).atan2(a.cos());
        let off = |expected: f64| (b - expected + 3.0).rem_euclid(std::f64::consts::PI * 2.0) - 3.0;
        println!("{}: {a} {b}, {:e}", sample.time, off(expected));
        // the cross gives way: 9e-5 was found
        assert!(off(expected).abs() < 2e-4);
    }
    let last = &samples[samples.len() - 1];
    assert!(last.sensors[0] > 1.5);
    assert!((stored(last) - stored(&samples[0])).abs() < 1e-5 * last.energy.kinetic);
}

/// A slider on a bar that turns about a pin: its angular momentum and its energy stay, so that the bar slows down as the slider goes out, with the speed by both.
#[test]
fn a_slider_goes_out_along_a_bar_that_turns() {
    let (rate, start) = (5.0, 0.1);
    let bodies = [plate("bar", [0.0, 0.0], MOMENT), plate("slider", [start, 0.0], MOMENT)];
    let pin = Joint::revolute("pin", ["world", "bar"], [0.0, 0.0]);
    let guide = Joint::prismatic("guide", ["bar", "slider"], [start, 0.0]).axis([1.0, 0.0]);
    let scene = Scene::new(Body::join(bodies).unwrap()).joint(pin).joint(guide.bearing(1e5, 0.0));
    let scene =
        scene.initial_velocity(move |x| vec![-rate * x[1], rate * x[0]]).phase(Phase::until(0.3));
    let sampling = Sampling::every(0.1)
        .read("out", Reading::device("guide", &Joint::DISPLACEMENT))
        .read("speed", Reading::device("guide", &Joint::VELOCITY))
        .read("rate", Reading::device("pin", &Joint::SPEED));
    let samples = run(&scene, sampling);
    let inertia = |r: f64| 2.0 * MOMENT + MASS * r * r;
    for sample in &samples {
        let [out, speed, turning] = [0, 1, 2].map(|k| sample.sensors[k]);
        let expected = rate * inertia(start) / inertia(start + out);
        let energy = rate * rate * inertia(start) - expected * expected * inertia(start + out);
        let of_speed = (energy.max(0.0) / MASS).sqrt();
        println!("{}: {out}, {turning} of {expected}, {speed} of {of_speed}", sample.time);
        assert!((turning / expected - 1.0).abs() < 2e-3 && (speed - of_speed).abs() < 2e-3);
    }
    assert!(samples[samples.len() - 1].sensors[0] > 0.08);
}

/// Couplings that make none are refused, with the joint and the key.
#[test]
fn what_couples_nothing_is_refused() {
    let wheels = || Body::join([plate("a", [0.0, 0.0], MOMENT), plate("b", [0.2, 0.0], MOMENT)]);
    let first = Joint::revolute("first", ["world", "a"], [0.0, 0.0]);
    let second = || Joint::revolute("second", ["world", "b"], [0.2, 0.0]);
    let slider = || Joint::prismatic("second", ["world", "b"], [0.2, 0.0]).axis([1.0, 0.0]);
    let guide = || Joint::prismatic("second", ["a", "b"], [0.2, 0.0]).axis([1.0, 0.0]);
    for (joint, words) in [
        (second().geared(&first, [0, 3], 1.0, 0.0), ["teeth of its gear", "need teeth"]),
        (slider().geared(&first, [1, 3], 1.0, 0.0), ["teeth of its gear", "slider has a lead"]),
        (second().driven(&first, 0.1, 1.0, 0.0), ["lead of its gear", "coupled by teeth"]),
        (second().geared(&first, [1, 3], 0.0, 0.0), ["stiffness of its gear", "above 0"]),
        (second().bearing(1.0, 0.0), ["bearing_stiffness of joint", "leave it out"]),
        (second().lead(1.0), ["lead of joint", "leave it out"]),
        (guide(), ["bearing_stiffness of joint", "give one"]),
        (Joint::screw("second", ["world", "b"], [0.2, 0.0], 0.1), ["kind of joint", "in space"]),
    ] {
        let scene = Scene::new(wheels().unwrap()).joint(first.clone()).joint(joint);
        let message = scene.phase(Phase::until(1.0)).validate().unwrap_err().to_string();
        println!("{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    }
    // a motor between the world and a section that is held
    let section = RodSection::Circle { radius: 0.01 };
    let steel = Material { density: 1000.0, young: 1e7, poisson: 0.3, viscosity: 0.0 };
    let rod = Body::rod(Rod::new([[0.0, 0.0], [0.2, 0.0]], 2, section), steel).unwrap();
    let pin = Joint::revolute("pin", ["world", "start"], [0.0, 0.0]);
    let scene = Scene::new(rod.build().unwrap()).joint(pin);
    let phase = Phase::until(1.0).hold("start-section").device_input("pin", &Joint::TORQUE, 1.0);
    let message = scene.phase(phase).simulate(&Settings::default(), &Sampling::phase_ends());
    let message = message.unwrap_err().to_string();
    assert!(message.contains("joint \"pin\"") && message.contains("held"), "{message}");
}

//! Joints and motors, against the equations of rigid bodies and mechanisms that others have computed.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

use pliant::simulate::Reading;
use pliant::{
    Body, Cells, InputError, Joint, JointKind, Material, Mesh, Method, Moments, Phase, RigidMass,
    Rod, RodSection, Sample, Sampling, Scene, SceneFile, Settings, Signal, SolidCells, Spring,
    Statics, Trajectory,
};

use crate::rigid::{METHODS, led};

const G: f64 = 9.81;

/// A rigid bar along x from `x`, of a length of 0.2 m, with its mass and its moment of inertia by numbers.
fn bar(name: &str, x: f64) -> Body {
    let mesh = Mesh::rectangle([LENGTH, 0.01], [3, 3], Cells::Rectangles).unwrap();
    let mesh = mesh.translated(&[x, -0.005]).unwrap();
    let mass = RigidMass::new(MASS).moments(Moments::Plane(MOMENT));
    Body::new(mesh, Material::rigid_of(mass)).thickness(0.01).named(name).build().unwrap()
}

const LENGTH: f64 = 0.2;
const MASS: f64 = 0.3;
/// About the centre: that of a thin bar.
const MOMENT: f64 = MASS * LENGTH * LENGTH / 12.0;
/// About an end.
const ABOUT_END: f64 = MASS * LENGTH * LENGTH / 3.0;

/// The same in space, along x; y is up.
fn beam(name: &str, x: f64) -> Body {
    let mesh = Mesh::cuboid([LENGTH, 0.01, 0.01], [2; 3], SolidCells::Hexahedra).unwrap();
    let mesh = mesh.translated(&[x, -0.005, -0.005]).unwrap();
    let across = MOMENT * 1.01;
    let mass = RigidMass::new(MASS).moments(Moments::Principal([0.02 * across, across, MOMENT]));
    Body::new(mesh, Material::rigid_of(mass)).named(name).build().unwrap()
}

fn pin() -> Joint {
    Joint::revolute("pin", ["world", "bar"], [0.0, 0.0])
}

/// A run to the ends of phases that reads the outputs of joints.
fn run(scene: &Scene, method: Method, rtol: f64, sampling: Sampling) -> Trajectory {
    let settings = Settings { method, rtol, ..Settings::default() };
    scene.simulate(&settings, &sampling).unwrap()
}

/// Energy that is not heat (J).
fn stored(sample: &Sample) -> f64 {
    let energy = &sample.energy;
    energy.kinetic + energy.gravity + energy.springs
}

fn angle(joint: &str) -> Reading {
    Reading::device(joint, &Joint::ANGLE)
}

/// The complete elliptic integral K of a modulus k, by the arithmetic-geometric mean.
fn elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    while (a - b).abs() > 1e-15 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    FRAC_PI_2 / a
}

/// A pendulum that is let go at the level is at the lowest point after a quarter of T = 4 sqrt(I/(m g s)) K(sin(45 degrees)), at the rate
/// sqrt(2 m g s/I); the pin bears the weight and the centripetal force there.
#[test]
fn a_physical_pendulum_has_its_period() {
    let arm = 0.5 * LENGTH;
    let quarter = (ABOUT_END / (MASS * G * arm)).sqrt() * elliptic(0.5_f64.sqrt());
    let rate = (2.0 * MASS * G * arm / ABOUT_END).sqrt();
    let in_plane = Scene::new(bar("bar", 0.0)).gravity([0.0, -G]).joint(pin());
    let hinge = Joint::revolute("pin", ["world", "bar"], [0.0; 3]).axis([0.0, 0.0, 2.0]);
    let in_space = Scene::new(beam("bar", 0.0)).gravity([0.0, -G, 0.0]).joint(hinge);
    let read = Sampling::phase_ends()
        .read("angle", angle("pin"))
        .read("speed", Reading::device("pin", &Joint::SPEED))
        .read("reaction", Reading::device("pin", &Joint::REACTION_FORCE));
    for (d, scene, methods) in [
        (2, in_plane, &METHODS[..]),
        (3, in_space, &[Method::Rk, Method::Ida, Method::IdaIndexTwo]),
    ] {
        let scene = scene.phase(Phase::until(quarter));
        for &method in methods {
            let motion = run(&scene, method, 1e-8, read.clone());
            let read = &motion.last().sensors;
            let bears = MASS * G + MASS * arm * rate * rate;
            let off = [
                (read[0] + FRAC_PI_2).abs(),
                (read[1] / rate + 1.0).abs(),
                (read[3] / bears - 1.0).abs(),
                read[2].abs() / bears,
            ];
            println!("{d} {method}: {off:?}, {} steps", motion.report().steps());
            // measured up to 2.3e-6, by central differences
            assert!(off.iter().all(|off| *off < 5e-6), "{d} {method}: {off:?}");
        }
    }
}

/// Two bars, of which the second hangs at the first by a pin that the scene puts there: their angles from the level are those of Lagrange's equations.
#[test]
fn a_double_pendulum_of_bars() {
    const TIME: f64 = 0.6;
    // angles from x: kinetic energy (a p'^2 + b q'^2)/2 + c p' q' cos(p - q)
    let (a, b) = (ABOUT_END + MASS * LENGTH * LENGTH, ABOUT_END);
    let c = MASS * LENGTH * 0.5 * LENGTH;
    let lagrange = move |y: &[f64], rates: &mut [f64]| {
        let [p, q, dp, dq] = [y[0], y[1], y[2], y[3]];
        let (sine, cosine) = (p - q).sin_cos();
        let f = [
            -c * dq * dq * sine - 1.5 * MASS * G * LENGTH * p.cos(),
            c * dp * dp * sine - 0.5 * MASS * G * LENGTH * q.cos(),
        ];
        let coupling = c * cosine;
        let determinant = a * b - coupling * coupling;
        rates[..2].copy_from_slice(&[dp, dq]);
        rates[2] = (b * f[0] - coupling * f[1]) / determinant;
        rates[3] = (a * f[1] - coupling * f[0]) / determinant;
    };
    let expected = led(&[0.0; 4], TIME, lagrange);
    let read = || Sampling::phase_ends().read("pin", angle("pin")).read("elbow", angle("elbow"));
    let in_plane = Scene::new(Body::join([bar("bar", 0.0), bar("lower", LENGTH)]).unwrap())
        .gravity([0.0, -G])
        .joint(pin())
        .joint(Joint::revolute("elbow", ["bar", "lower"], [LENGTH, 0.0]));
    let hinge = |name: &str, between: [&str; 2], x: f64| {
        Joint::revolute(name, between, [x, 0.0, 0.0]).axis([0.0, 0.0, 1.0])
    };
    let in_space = Scene::new(Body::join([beam("bar", 0.0), beam("lower", LENGTH)]).unwrap())
        .gravity([0.0, -G, 0.0])
        .joint(hinge("pin", ["world", "bar"], 0.0))
        .joint(hinge("elbow", ["bar", "lower"], LENGTH));
    for (d, scene, methods) in [
        (
            2,
            in_plane,
            &[Method::Auto, Method::CvodeBdf, Method::Ida, Method::CentralDifference][..],
        ),
        (3, in_space, &[Method::Rk, Method::IdaIndexTwo]),
    ] {
        let scene = scene.phase(Phase::until(TIME));
        for &method in methods {
            let motion = run(&scene, method, 1e-8, read());
            let found = &motion.last().sensors;
            let off = [found[0] - expected[0], found[0] + found[1] - expected[1]];
            println!("{d} {method}: {off:?} rad of {expected:?}");
            // measured up to 1.2e-5, by central differences
            assert!(off.iter().all(|off| off.abs() < 2e-5), "{d} {method}: {off:?}");
        }
    }
}

/// The slider-crank of SUNDIALS' example idasSlCrank_dns.c, whose output lists five digits.
///
/// Its connecting rod has its mass at the slider's pin, with the moment 2 kg m^2 about it; a spring and damper joins the middles of crank and rod, and the force is
/// at the point of the rod that is as far beyond the pin as the crank's end is before it. Half of the mass is the slider's here.
#[test]
fn a_slider_crank_as_in_the_example_of_sundials() {
    let (crank, start) = (0.5, [FRAC_PI_2, (-0.5_f64).asin()]);
    let heavy = |mass: f64, moment: f64, centre: [f64; 2]| {
        Material::rigid_of(RigidMass::new(mass).moments(Moments::Plane(moment)).centre(centre))
    };
    let mesh = |length: f64, nodes: usize, angle: f64, from: [f64; 2]| {
        let mesh = Mesh::rectangle([length, 0.02], [nodes, 3], Cells::Rectangles).unwrap();
        let mesh = mesh.translated(&[0.0, -0.01]).unwrap();
        mesh.turned(&[angle]).unwrap().translated(&from).unwrap()
    };
    let pin = [start[1].cos(), 0.0];
    let of_crank = mesh(crank, 3, start[0], [0.0, 0.0]);
    let of_rod = mesh(2.0, 5, start[1], [0.0, crank]);
    let slider = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Rectangles).unwrap();
    let slider = slider.translated(&[pin[0] - 0.05, -0.05]).unwrap();
    let body = |mesh: Mesh, material, name: &str| {
        Body::new(mesh, material).thickness(0.01).named(name).build().unwrap()
    };
    let bodies = Body::join([
        body(of_crank, heavy(1.0, 1.0, [0.0, 0.0]), "crank"),
        body(of_rod, heavy(0.5, 2.0, pin), "rod"),
        body(slider, Material::rigid_of(RigidMass::new(0.5)), "slider"),
    ])
    .unwrap();
    // of three rows with nodes along the bars, the middle one
    let node = |x: [f64; 2]| {
        let mesh = bodies.mesh();
        let near = |&n: &usize| {
            let at = mesh.position(n - 1);
            (at[0] - x[0]).hypot(at[1] - x[1]) < 1e-9
        };
        (1..=mesh.node_count()).find(near).unwrap()
    };
    let (sine, cosine) = start[1].sin_cos();
    let middles = [node([0.0, 0.25]), node([0.5 * cosine, crank + 0.5 * sine])];
    let tip = node([2.0 * cosine, crank + 2.0 * sine]);
    let scene = Scene::new(bodies)
        .spring(Spring::between([middles[0]], [middles[1]]).stiffness(1.0).length(1.0).damping(1.0))
        .joint(Joint::revolute("crank", ["world", "crank"], [0.0, 0.0]))
        .joint(Joint::revolute("crank pin", ["crank", "rod"], [0.0, crank]))
        .joint(Joint::revolute("wrist pin", ["rod", "slider"], pin))
        .joint(Joint::prismatic("guide", ["world", "slider"], pin).axis([1.0, 0.0]))
        .phase(Phase::until(10.0).load([tip], [1.0, 0.0]));
    let sampling = Sampling::every(2.0)
        .read("crank", angle("crank"))
        .read("guide", Reading::device("guide", &Joint::DISPLACEMENT))
        .read("pin", angle("wrist pin"));
    let expected = [
        [0.57904, 1.3803, -0.27714],
        [-1.2064, 1.0623, 0.48609],
        [-1.1080, 1.1176, 0.46386],
        [0.64422, 1.3536, -0.30500],
        [1.2757, 1.0236, -0.49881],
    ];
    for method in [Method::CvodeBdf, Method::IdaIndexTwo] {
        let motion = run(&scene, method, 1e-7, sampling.clone());
        for (sample, expected) in motion.samples()[1..].iter().zip(expected) {
            let read = &sample.sensors;
            let found = [start[0] + read[0], pin[0] + read[1], start[1] - read[2]];
            let off = [0, 1, 2].map(|i| (found[i] - expected[i]).abs());
            println!("{method} {}: {found:.5?}, off by {off:?}", sample.time);
            // half a unit of the last digit of the table, and rtol 1e-6 of the example
            assert!(off.iter().all(|off| *off < 6e-5), "{method} {}: {off:?}", sample.time);
        }
    }
}

/// Four-bar linkage in space whose hinges are parallel: three rows more than it needs. A parallelogram keeps its sides parallel and its energy.
#[test]
fn a_four_bar_linkage_in_space_has_rows_to_spare() {
    let upright = |name: &str, x: f64| {
        let mesh = Mesh::cuboid([0.01, LENGTH, 0.01], [2; 3], SolidCells::Hexahedra).unwrap();
        let mesh = mesh.translated(&[x - 0.005, 0.0, -0.005]).unwrap();
        Body::new(mesh, Material::rigid(1000.0)).named(name).build().unwrap()
    };
    let coupler = Mesh::cuboid([LENGTH, 0.01, 0.01], [2; 3], SolidCells::Hexahedra).unwrap();
    let coupler = coupler.translated(&[0.0, LENGTH - 0.005, -0.005]).unwrap();
    let coupler = Body::new(coupler, Material::rigid(1000.0)).named("coupler").build().unwrap();
    let bodies = Body::join([upright("left", 0.0), coupler, upright("right", LENGTH)]).unwrap();
    let hinge = |name: &str, between: [&str; 2], x: f64, y: f64| {
        Joint::revolute(name, between, [x, y, 0.0]).axis([0.0, 0.0, 1.0])
    };
    let scene = Scene::new(bodies)
        .gravity([0.5, -G, 0.0])
        .joint(hinge("a", ["world", "left"], 0.0, 0.0))
        .joint(hinge("b", ["left", "coupler"], 0.0, LENGTH))
        .joint(hinge("c", ["coupler", "right"], LENGTH, LENGTH))
        .joint(hinge("d", ["right", "world"], LENGTH, 0.0))
        .phase(Phase::until(0.4));
    let sampling = ["a", "b", "c", "d"]
        .into_iter()
        .fold(Sampling::every(0.1), |all, name| all.read(name, angle(name)));
    for method in [Method::Rk, Method::Ida] {
        let motion = run(&scene, method, 1e-7, sampling.clone());
        let [first, last] = [&motion.samples()[0], motion.last()];
        let a = last.sensors[0];
        assert!(a < -0.3, "it falls to the right: {a}");
        for sample in motion.samples() {
            let read = &sample.sensors;
            let off = [read[1] + read[0], read[2] - read[0], read[3] + read[0]];
            assert!(off.iter().all(|off| off.abs() < 1e-6), "{method}: {read:?}");
        }
        let off = (stored(last) - stored(first)).abs() / last.energy.kinetic;
        println!("{method}: {a} rad, energy off by {off:.1e}");
        // measured 1.6e-7
        assert!(off < 5e-7, "{method}: {off}");
    }
}

/// Bricard's linkage, five bars along edges of a cube and the ground, has six hinges and moves, though six equations would hold it. Every other angle is the
/// same, and with a and b from the shape in which neighbours are at right angles, sin a + sin b + sin a sin b = 0, its equation of closure (Chen, You and Tarnai, *Threefold-symmetric Bricard linkages for deployable structures*, 2005).
#[test]
fn bricards_linkage_moves() {
    let corners: [[f64; 3]; 6] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, -1.0, 1.0],
        [0.0, -1.0, 1.0],
        [0.0, 0.0, 1.0],
    ];
    let axes = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    let names = ["world", "1", "2", "3", "4", "5", "world"];
    let bar = |k: usize| {
        let (from, to) = (corners[k], corners[k + 1]);
        let size = std::array::from_fn(|i| f64::max((from[i] - to[i]).abs(), 0.04));
        let corner: [f64; 3] = std::array::from_fn(|i| 0.5 * (from[i] + to[i] - size[i]));
        let mesh = Mesh::cuboid(size, [2; 3], SolidCells::Hexahedra).unwrap();
        let bar =
            Body::new(mesh.translated(&corner).unwrap(), Material::rigid_of(RigidMass::new(1.0)));
        bar.named(names[k + 1]).build().unwrap()
    };
    let mut scene = Scene::new(Body::join((0..5).map(bar)).unwrap()).gravity([0.0, -G, 0.0]);
    let mut sampling = Sampling::every(0.4);
    for k in 0..6 {
        let name = format!("hinge {k}");
        let joint = Joint::revolute(&*name, [names[k], names[k + 1]], corners[k]).axis(axes[k % 3]);
        scene = scene.joint(joint);
        sampling = sampling.read(&*name, angle(&name));
    }
    let motion = run(&scene.phase(Phase::until(1.2)), Method::Rk, 1e-6, sampling);
    for sample in motion.samples() {
        let read = &sample.sensors;
        let off = (0..4).map(|k| (read[k] - read[k + 2]).abs()).fold(0.0, f64::max);
        let (a, b) = (read[0].sin(), read[1].sin());
        let closure = (a + b + a * b).abs();
        println!("{}: {read:.4?}, closure {closure:.1e}", sample.time);
        // measured 2e-9
        assert!(off < 1e-8, "{read:?}");
        assert!(closure < 1e-8, "{closure}");
    }
    let [first, last] = [&motion.samples()[0], motion.last()];
    assert!(last.sensors[0] > 1.0);
    let off = (stored(last) - stored(first)).abs() / last.energy.kinetic;
    assert!(off < 1e-4, "{off}");
}

/// A motor with a constant torque lifts a pendulum: its work is torque times angle, and the gain of energy.
#[test]
fn the_work_of_a_motor_is_the_gain_of_energy() {
    let torque = 1.2 * MASS * G * 0.5 * LENGTH;
    let scene = Scene::new(bar("bar", 0.0)).gravity([0.0, -G]).joint(pin());
    let scene = scene.phase(Phase::until(0.4).device_input("pin", &Joint::TORQUE, torque));
    let sampling = Sampling::phase_ends()
        .read("angle", angle("pin"))
        .read("power", Reading::device("pin", &Joint::POWER))
        .read("speed", Reading::device("pin", &Joint::SPEED));
    for method in [Method::Auto, Method::Ida, Method::IdaIndexTwo, Method::CentralDifference] {
        let motion = run(&scene, method, 1e-8, sampling.clone());
        let [first, last] = [&motion.samples()[0], motion.last()];
        let [turned, power, speed] = [0, 1, 2].map(|k| last.sensors[k]);
        let gain = stored(last) - stored(first);
        let off = [torque * turned / gain - 1.0, last.energy.supplied / gain - 1.0];
        println!("{method}: {turned} rad, {gain} J, off by {off:?}");
        // measured up to 4.4e-7
        assert!(turned > 1.0 && off.iter().all(|off| off.abs() < 1e-6), "{method}: {off:?}");
        assert!((power - torque * speed).abs() < 1e-12);
    }
}

/// A servo on a bar without weight is an oscillator, J q'' + d q' + k q = k q_t; its angle is that of the closed form, also from 2 pi - 0.5 to -0.5, which
/// is the nearest way.
#[test]
fn a_servo_is_a_damped_oscillator() {
    let (stiffness, damping) = (ABOUT_END * 400.0, ABOUT_END * 8.0);
    let (decay, omega) = (4.0, (400.0_f64 - 16.0).sqrt());
    for (target, expected) in [(0.5, 0.5), (2.0 * PI - 0.5, -0.5)] {
        let scene = Scene::new(bar("bar", 0.0)).joint(pin().servo(stiffness, damping));
        let phase = Phase::until(0.1).device_input("pin", &Joint::TARGET_ANGLE, target);
        let scene = scene.phase(phase);
        for method in [Method::Auto, Method::CvodeBdf, Method::Ida, Method::Rosenbrock] {
            let motion =
                run(&scene, method, 1e-8, Sampling::every(0.02).read("angle", angle("pin")));
            for sample in motion.samples() {
                let t = sample.time;
                let swing = (omega * t).cos() + decay / omega * (omega * t).sin();
                let off = sample.sensors[0] - expected * (1.0 - (-decay * t).exp() * swing);
                assert!(off.abs() < 1e-6, "{method} {target} at {t}: {off:.1e}");
            }
        }
    }
}

/// A motor on its line from stall torque to no-load speed runs up as 1 - exp(-t T/(J w)); Coulomb's friction brings it to rest along a line.
#[test]
fn a_motor_runs_up_and_friction_stops_it() {
    let (stall, no_load, friction) = (ABOUT_END * 30.0, 12.0, ABOUT_END * 10.0);
    let joint = pin().limit(stall).no_load_speed(no_load);
    let phase = || Phase::until(0.5).device_input("pin", &Joint::TORQUE, Signal::from(1.0));
    let speed = || Sampling::phase_ends().read("speed", Reading::device("pin", &Joint::SPEED));
    let scene = Scene::new(bar("bar", 0.0)).joint(joint.clone()).phase(phase());
    let found = run(&scene, Method::CvodeBdf, 1e-8, speed()).last().sensors[0];
    let expected = no_load * (1.0 - (-0.5 * 30.0 / no_load).exp());
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");

    let scene = Scene::new(bar("bar", 0.0)).joint(joint.friction(friction, Some(1e-3)));
    let scene = scene.phase(phase()).phase(Phase::until(0.8));
    let motion = run(&scene, Method::CvodeBdf, 1e-8, speed());
    let [driven, braked] = [1, 2].map(|k| motion.samples()[k].sensors[0]);
    // torque 30 (1 - w/12) - 10
    let expected = 8.0 * (1.0 - (-0.5 * 30.0 / no_load).exp());
    assert!((driven / expected - 1.0).abs() < 1e-4, "{driven} {expected}");
    assert!((braked - (expected - 3.0)).abs() < 1e-3, "{braked}");
    // what the motor supplied is kinetic energy and heat
    let energy = &motion.last().energy;
    let off = energy.supplied - energy.dissipated - energy.kinetic;
    assert!(off.abs() < 1e-5 * energy.supplied, "{off}");
}

/// Between stops a bar turns freely, and bounces back from a spring: half a period of it later it has the opposite speed.
#[test]
fn stops_throw_back() {
    let (stiffness, rate) = (MOMENT * 1e4, 2.0);
    let bounced = 0.4 / rate + PI / 100.0;
    // the pin is at the centre of the bar
    let scene = Scene::new(bar("bar", -0.5 * LENGTH)).joint(pin().stops([-0.5, 0.4], stiffness));
    let scene = scene.spin([rate]).phase(Phase::until(bounced)).phase(Phase::until(bounced + 0.1));
    let motion =
        run(&scene, Method::CvodeBdf, 1e-7, Sampling::phase_ends().read("angle", angle("pin")));
    let [stopped, back] = [1, 2].map(|k| motion.samples()[k].sensors[0]);
    assert!((stopped - 0.4).abs() < 1e-5 && (back - 0.2).abs() < 1e-5, "{stopped} {back}");
}

/// A spring of a joint holds a bar at the level where its torque is that of the weight; statics finds it, and the pin bears the weight.
#[test]
fn a_spring_holds_a_bar() {
    let stiffness = 2.0;
    let joint = pin().spring(stiffness, MASS * G * 0.5 * LENGTH / stiffness);
    let scene = Scene::new(bar("bar", 0.0)).gravity([0.0, -G]).joint(joint);
    let scene = scene.phase(Phase::until(1.0));
    let found = scene.equilibrium(&Statics::default()).unwrap();
    let u = found.displacements();
    assert!(u.iter().all(|u| u.abs() < 1e-6), "{u:?}");
}

/// A rod whose end a fixed joint holds is one whose end section is clamped, in the plane and in space; a hinge across it lets it swing down.
#[test]
fn a_fixed_joint_clamps_a_rod() {
    let material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 1e3 };
    let section = RodSection::Circle { radius: 0.01 };
    let plane = || Body::rod(Rod::new([[0.0, 0.0], [0.2, 0.0]], 4, section), material);
    let space = || Body::rod(Rod::new([[0.0, 0.0, 0.0], [0.2, 0.0, 0.0]], 4, section), material);
    for (d, body) in
        [(2, plane().unwrap().build().unwrap()), (3, space().unwrap().build().unwrap())]
    {
        let gravity = if d == 2 { vec![0.0, -G] } else { vec![0.0, -G, 0.0] };
        let scene = Scene::new(body).gravity(gravity);
        let clamped = scene.clone().phase(Phase::until(0.1).hold("start-section"));
        let joint = Joint::fixed("wall", ["world", "start"], vec![0.0; d]);
        let fixed = scene.joint(joint).phase(Phase::until(0.1));
        let [a, b] = [&clamped, &fixed].map(|scene| {
            let motion = run(scene, Method::CvodeBdf, 1e-8, Sampling::phase_ends());
            motion.last().u.clone()
        });
        let off = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let most = a.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        println!("{d}: {off:.1e} m of {most:.1e} m");
        assert!(most > 1e-3 && off < 1e-8, "{off} of {most}");
    }
}

/// A soft block hangs at the mean of its upper face: the ball joint bears its weight, wherever its nodes go.
#[test]
fn a_ball_joint_bears_a_soft_block() {
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 2e3 };
    let mesh = Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Rectangles9).unwrap();
    let body = Body::new(mesh, soft).thickness(0.02).build().unwrap();
    let joint = Joint::spherical("hook", ["world", "top"], [0.05, 0.05]);
    let scene = Scene::new(body).gravity([0.0, -G]).joint(joint).phase(Phase::until(3.0));
    let sampling = Sampling::phase_ends()
        .read("reaction", Reading::device("hook", &Joint::REACTION_FORCE))
        .read("top", Reading::displacement("top"));
    let motion = run(&scene, Method::CvodeBdf, 1e-6, sampling);
    let read = &motion.last().sensors;
    let weight = 1000.0 * 0.1 * 0.05 * 0.02 * G;
    println!("{read:?} of {weight} N");
    assert!((read[1] / weight - 1.0).abs() < 1e-4, "{read:?}");
    assert!(read[2].abs() < 1e-9 && read[3].abs() < 1e-9, "{read:?}");
}

/// The leg of the scene file stands with its weight on the foot, and is pushed up from it by its servos; power and heat close the balance of energy.
#[test]
fn a_leg_pushes_off() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/hopping-leg.toml");
    let file = SceneFile::read(path).unwrap();
    let scene = file.scene.ended_at(0.34);
    assert_eq!(scene.warnings(), Vec::<String>::new());
    let motion = scene.simulate(&file.settings, &file.output.sampling()).unwrap();
    let at = |time: f64| motion.samples().iter().find(|s| (s.time - time).abs() < 1e-9).unwrap();
    let [standing, last] = [at(0.2), motion.last()];
    // torso, knee, torque, on the ankle, on the floor
    let weight = scene.body().mass() * G;
    println!("{:?} {:?} of {weight} N", standing.sensors, last.sensors);
    assert!((standing.sensors[6] / weight - 1.0).abs() < 0.05, "{:?}", standing.sensors);
    assert!(last.sensors[0] > 0.05 && last.sensors[1] > 40.0, "{:?}", last.sensors);
    assert!(motion.report().energy_error < 1e-3 * last.energy.supplied);
}

fn refusal(scene: Scene) -> InputError {
    scene.phase(Phase::until(1.0)).validate().unwrap_err()
}

/// A table that makes no joint is refused with the name of the joint, before anything runs.
#[test]
fn what_is_no_joint_is_refused() {
    let scene = || Scene::new(Body::join([bar("bar", 0.0), bar("lower", LENGTH)]).unwrap());
    let revolute = |between: [&str; 2]| Joint::revolute("elbow", between, [LENGTH, 0.0]);
    let prismatic = |between: [&str; 2]| Joint::prismatic("elbow", between, [LENGTH, 0.0]);
    let cases = [
        (revolute(["world", "world"]), "between of joint \"elbow\"", "nothing moves"),
        (revolute(["bar", "bar/left"]), "between of joint \"elbow\"", "one rigid piece"),
        (revolute(["bar", "upper"]), "node set", "upper"),
        (revolute(["bar", "lower"]).axis([0.0, 1.0]), "axis of joint \"elbow\"", "leave it out"),
        (prismatic(["world", "lower"]), "axis of joint \"elbow\"", "2 components"),
        (prismatic(["world", "lower"]).axis([0.0, 0.0]), "axis of joint \"elbow\"", "direction"),
        (
            prismatic(["bar", "lower"]).axis([1.0, 0.0]),
            "bearing_stiffness of joint \"elbow\"",
            "give one",
        ),
        (revolute(["bar", "lower"]).stops([0.5, -0.5], 1.0), "stops of joint", "lower one"),
        (revolute(["bar", "lower"]).stops([-4.0, 4.0], 1.0), "stops of joint", "whole turn"),
        (revolute(["bar", "lower"]).stops([0.2, 1.0], 1.0), "stops of joint", "0.2 beyond a stop"),
        (revolute(["bar", "lower"]).stops([-2.0, -1.0], 1.0), "stops of joint", "1 beyond a stop"),
        (revolute(["bar", "lower"]).damping(-1.0), "damping of joint", "0 or above"),
        (revolute(["bar", "lower"]).no_load_speed(3.0), "no_load_speed of joint", "limit"),
        (
            Joint::fixed("elbow", ["bar", "lower"], [LENGTH, 0.0]).damping(1.0),
            "kind of joint",
            "alone have",
        ),
        (
            Joint::new(JointKind::Revolute, "elbow", ["bar", "lower"], [0.0; 3]),
            "at of joint",
            "2 components",
        ),
    ];
    for (joint, input, help) in cases {
        let error = refusal(scene().joint(joint)).to_string();
        println!("{error}");
        assert!(error.contains(input) && error.contains(help), "{error}");
    }
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };
    let block = Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Rectangles).unwrap();
    let block = Scene::new(Body::new(block, soft).thickness(0.02).build().unwrap());
    let beside = Joint::spherical("hook", ["world", "top"], [0.05, 0.06]);
    let error = refusal(block.joint(beside)).to_string();
    assert!(error.contains("at of joint \"hook\"") && error.contains("beside"), "{error}");
    // one that leans on a stop is not thrown back
    for (angle, is_refused) in [(-0.01, false), (-0.5, true)] {
        let about = |x: &[f64]| {
            let (s, c) = if x[0] > LENGTH + 5e-4 { f64::sin_cos(angle) } else { (0.0, 1.0) };
            let [x, y] = [x[0] - LENGTH, x[1]];
            vec![c * x - s * y - x, s * x + c * y - y]
        };
        let joint = revolute(["bar", "lower"]).stops([0.0, 1.0], 1.0);
        let bent = Scene::new(Body::join([bar("bar", 0.0), bar("lower", LENGTH + 1e-3)]).unwrap());
        let bent = bent.initial_displacement(about).joint(joint);
        let result = bent.phase(Phase::until(1.0)).validate();
        assert_eq!(result.is_err(), is_refused, "{result:?}");
    }
    // a servo is what leads to an angle
    let aimless = scene().joint(revolute(["bar", "lower"]).servo(0.0, 1.0));
    let phase = Phase::until(1.0).device_input("elbow", &Joint::TARGET_ANGLE, 0.5);
    let error = aimless.clone().phase(phase).validate().unwrap_err().to_string();
    println!("{error}");
    assert!(error.contains("of joint \"elbow\"") && error.contains("servo_stiffness"), "{error}");
    let phase = Phase::until(1.0).device_input("elbow", &Joint::TARGET_SPEED, 0.5);
    aimless.phase(phase).validate().unwrap();
    // both sides are held: all nodes of rigid bodies, or as many of their components as they have freedoms
    for (held, is_refused) in [("lower/left", false), ("bar/left", true), ("bar", true)] {
        let driven = scene().joint(revolute(["bar", "lower"]));
        let phase = Phase::until(1.0).hold(held);
        let phase = if is_refused { phase.hold("lower") } else { phase };
        let phase = phase.device_input("elbow", &Joint::TORQUE, 0.5);
        let result = driven.phase(phase).validate();
        let error = result.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains("both of its sides are held") == is_refused, "{held}: {error}");
    }
    // the joint holds them together across a gap
    let apart = Scene::new(Body::join([bar("bar", 0.0), bar("lower", LENGTH + 0.05)]).unwrap())
        .joint(revolute(["bar", "lower"]))
        .initial_displacement(|x| vec![if x[0] > LENGTH + 0.02 { 0.01 } else { 0.0 }, 0.0]);
    let error = refusal(apart).to_string();
    assert!(error.contains("between of joint") && error.contains("apart at the start"), "{error}");
}

//! Bodies that touch each other, and themselves.

use std::path::Path;

use pliant::body::BodyBuilder;
use pliant::simulate::{Component, Reading};
use pliant::{
    Axis, Body, Cells, Law, Material, Mesh, Method, Phase, Sampling, Scene, SceneFile, Settings,
    SolidCells, Statics, Touch, Trajectory,
};

const SOFT: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };

fn block(name: &str, at: [f64; 2], size: [f64; 2], nodes: [usize; 2], cells: Cells) -> BodyBuilder {
    let mesh = Mesh::rectangle(size, nodes, cells).unwrap().translated(&at).unwrap();
    Body::new(mesh, SOFT).thickness(0.01).named(name)
}

fn joined(bodies: impl IntoIterator<Item = BodyBuilder>) -> Body {
    Body::join(bodies.into_iter().map(|body| body.build().unwrap())).unwrap()
}

fn run(scene: &Scene, settings: &Settings, step: f64) -> Trajectory {
    scene.simulate(settings, &Sampling::every(step)).unwrap()
}

fn momentum(motion: &Trajectory, sample: usize, part: usize, axis: usize) -> f64 {
    let part = motion.body().parts().nth(part).unwrap();
    let d = part.body.dimension();
    let masses = part.body.nodal_masses();
    let v = &motion.samples()[sample].v[part.dofs()];
    masses.iter().zip(v.chunks_exact(d)).map(|(mass, v)| mass * v[axis]).sum()
}

/// Two squares with meshes that do not match, one of them thrown at the other one off its centre.
fn collision(touch: Touch) -> Scene {
    let left = block("left", [0.0, 0.0], [0.1, 0.1], [5, 5], Cells::Triangles);
    let right = block("right", [0.12, 0.03], [0.1, 0.1], [4, 4], Cells::Rectangles);
    Scene::new(joined([left, right]))
        .touch(touch)
        .initial_velocity(|x| vec![if x[0] < 0.11 { 1.0 } else { 0.0 }, 0.0])
        .phase(Phase::until(0.06))
}

/// All methods agree on a collision with friction and damping, momentum is kept to round-off, and the energy balance
/// within their tolerances. The reference is BDF at rtol 1e-9.
#[test]
fn a_collision_by_all_methods() {
    let touch = Touch::all().distance(3e-3).damping_density(3e3).friction_coefficient(0.3);
    let scene = collision(touch.sticking_speed(0.02));
    let of = |method, rtol| {
        let settings = Settings { method, rtol, ..Settings::default() };
        run(&scene, &settings, 0.03)
    };
    let exact = of(Method::CvodeBdf, 1e-9);
    let pushed = momentum(&exact, 2, 1, 0);
    assert!(pushed > 0.05, "{pushed} kg m/s were handed on");
    for (method, rtol, tolerance) in [
        (Method::CvodeBdf, 1e-6, 3e-7),
        (Method::Arkode, 1e-6, 3e-7),
        (Method::Ida, 1e-6, 3e-7),
        (Method::Rk, 1e-6, 3e-7),
        (Method::Rosenbrock, 1e-6, 3e-7),
        (Method::Auto, 1e-6, 3e-7),
    ] {
        let motion = of(method, rtol);
        let off = motion.last().u.iter().zip(&exact.last().u).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max);
        println!(
            "{method}: {off:.2e} m, {} steps, balance {:.1e}",
            motion.report().steps(),
            motion.report().energy_error
        );
        assert!(off < tolerance, "{method} is {off} m off");
        let changes: usize =
            motion.report().phases.iter().map(|phase| phase.counts.pattern_changes).sum();
        // explicit steps need no matrix
        assert!(changes > 0 || method == Method::Rk, "{method}: no room for contact");
        for sample in 1..3 {
            for axis in 0..2 {
                let sum = |at| momentum(&motion, at, 0, axis) + momentum(&motion, at, 1, axis);
                assert!((sum(sample) - sum(0)).abs() < 1e-12, "{method}: momentum");
            }
        }
    }
}

/// Two equal bars that collide exchange their velocities, and touch for the time that a wave takes to the far end and
/// back, 2 L/c (Saint-Venant): the nearer, the shorter and the harder the contact, the nearer.
#[test]
fn two_bars_exchange_their_velocities() {
    const LENGTH: f64 = 0.1;
    let bar = |name: &str, at: f64| {
        let mesh = Mesh::bar(LENGTH, 41).unwrap().translated(&[at]).unwrap();
        let material = Material { poisson: 0.0, ..SOFT };
        Body::new(mesh, material).area(1e-4).named(name).build().unwrap()
    };
    let distance = 5e-4;
    let bodies = Body::join([bar("left", 0.0), bar("right", LENGTH + distance)]).unwrap();
    let touch = Touch::all().distance(distance).stiffness_density(2e9);
    let scene = Scene::new(bodies)
        .touch(touch)
        .initial_velocity(|x| vec![if x[0] <= LENGTH { 0.1 } else { 0.0 }])
        .phase(Phase::until(0.04));
    let settings = Settings { rtol: 1e-7, ..Settings::default() };
    let sampling = Sampling::every(1e-4)
        .read("push", Reading::touch_force("touch").of_body("right").component(Component::X));
    let motion = scene.simulate(&settings, &sampling).unwrap();
    let mass = 1000.0 * 1e-4 * LENGTH;
    let last = motion.samples().len() - 1;
    let [left, right] = [0, 1].map(|part| momentum(&motion, last, part, 0) / mass);
    println!("left {left}, right {right}");
    // what is missing vibrates within the bars
    assert!(left.abs() < 2e-3 && (right - 0.1).abs() < 2e-3, "{left} {right}");
    let pushes: Vec<f64> = motion.samples().iter().map(|sample| sample.sensors[0]).collect();
    let touching =
        pushes.iter().filter(|push| **push > 0.05 * pushes.iter().copied().fold(0.0, f64::max));
    let time = 1e-4 * touching.count() as f64;
    let wave = 2.0 * LENGTH / (SOFT.young / SOFT.density).sqrt();
    println!("touching for {time} s, wave {wave} s");
    assert!((time / wave - 1.0).abs() < 0.05, "{time} s instead of {wave} s");
}

/// A block on a block that is held carries its own weight: forces between them, on the lower one and of what holds it.
/// In motion it comes to rest there.
#[test]
fn a_block_rests_on_a_block() {
    let lower = block("lower", [0.0, 0.0], [0.1, 0.03], [7, 3], Cells::Triangles);
    let upper = block("upper", [0.02, 0.031], [0.05, 0.04], [5, 4], Cells::Rectangles);
    let scene = Scene::new(joined([lower, upper]))
        .touch(Touch::between(["lower", "upper"]).distance(2e-3))
        .gravity([0.0, -9.8])
        // a body that rests on another one can slide
        .phase(Phase::until(1.0).hold("lower/bottom").hold_axes("upper/top", [Axis::X]));
    let found = scene.equilibrium(&Statics::default()).unwrap();
    let weight = 9.8 * 1000.0 * 0.05 * 0.04 * 0.01;
    let motion = found.trajectory();
    let both = weight + 9.8 * 1000.0 * 0.1 * 0.03 * 0.01;
    let held = motion.constraint_force(found.sample(), "lower/bottom").unwrap();
    assert!((held[1] - both).abs() < 1e-6 * both, "{held:?} for {both}");
}

/// A bar that one load step would move into another one presses on it in statics, too: load steps become smaller.
#[test]
fn equilibria_do_not_leap() {
    let bar = |name: &str, at: f64| {
        let mesh = Mesh::bar(0.02, 5).unwrap().translated(&[at]).unwrap();
        let material = Material { poisson: 0.0, ..SOFT };
        Body::new(mesh, material).area(1e-4).named(name).build().unwrap()
    };
    let scene = Scene::new(Body::join([bar("left", 0.0), bar("right", 0.03)]).unwrap())
        .touch(Touch::all().distance(1e-4))
        .phase(Phase::until(1.0).hold("left/left").move_nodes("right/right", [-0.02]));
    let found = scene.equilibrium(&Statics::default()).unwrap();
    let held = found.trajectory().constraint_force(found.sample(), "left/left").unwrap();
    // a quarter shorter, less a part of the contact distance: E A times Green's strain times the stretch
    let stretch: f64 = 1.0 - 0.25 * 0.995;
    let force = 10.0 * 0.5 * (1.0 - stretch * stretch) * stretch;
    assert!((held[0] / force - 1.0).abs() < 0.01, "{held:?} {force}");
}

/// A fast block of rubber and a contact distance much less than a step leads it: it does not pass a plate, whatever the
/// method.
#[test]
fn nothing_is_passed_through() {
    let rubber = SOFT.law(Law::NeoHookean);
    let plate = block("plate", [0.05, -0.05], [0.004, 0.15], [2, 16], Cells::Rectangles);
    let bullet = block("bullet", [0.0, 0.0], [0.02, 0.02], [3, 3], Cells::Triangles);
    let bodies = joined([plate, bullet].map(|body| body.material(rubber.clone())));
    let scene = Scene::new(bodies)
        .touch(Touch::all().distance(1e-4))
        .initial_velocity(|x| vec![if x[0] < 0.03 { 3.0 } else { 0.0 }, 0.0])
        .phase(Phase::until(0.02).hold("plate/bottom"));
    for method in [Method::CvodeBdf, Method::Arkode, Method::Rk] {
        let settings = Settings { method, rtol: 1e-2, ..Settings::default() };
        let motion = run(&scene, &settings, 0.001);
        let indicators = motion.indicators();
        let overlap = indicators.iter().find(|indicator| indicator.name == "overlap").unwrap();
        assert!(overlap.value == 0.0, "{method}: {overlap:?}");
        let left = momentum(&motion, 20, 1, 0) / momentum(&motion, 0, 1, 0);
        assert!(left < 0.7, "{method}: {left} of its momentum is left");
        println!("{method}: {} steps", motion.report().steps());
    }
}

/// Glued bodies do not push each other apart where they are glued, though all bodies of the scene touch: a beam of two
/// halves sags as without contact.
#[test]
fn what_is_glued_does_not_touch() {
    let sag = |touches: bool| {
        let arm = block("arm", [0.0, 0.0], [0.1, 0.02], [11, 3], Cells::Triangles);
        let hand = block("hand", [0.1, 0.0], [0.1, 0.02], [9, 4], Cells::Triangles);
        let mut scene = Scene::new(joined([arm, hand]))
            .tie("hand/left", "arm")
            .gravity([0.0, -1.0])
            .phase(Phase::until(1.0).hold("arm/left"));
        if touches {
            scene = scene.touch(Touch::all());
        }
        scene.equilibrium(&Statics::default()).unwrap().displacements().to_vec()
    };
    assert_eq!(sag(true), sag(false));
}

/// Blocks in space press each other.
#[test]
fn cubes_in_space_collide() {
    let cube = |name: &str, at: [f64; 3], nodes: [usize; 3], cells| {
        let mesh = Mesh::cuboid([0.1, 0.1, 0.1], nodes, cells).unwrap().translated(&at).unwrap();
        Body::new(mesh, SOFT).named(name)
    };
    let left = cube("left", [0.0, 0.0, 0.0], [3, 3, 3], SolidCells::Tetrahedra);
    let right = cube("right", [0.12, 0.03, 0.04], [3, 4, 3], SolidCells::Hexahedra);
    let scene = Scene::new(joined([left, right]))
        .touch(Touch::all().distance(5e-3).friction_coefficient(0.2))
        .initial_velocity(|x| vec![if x[0] < 0.11 { 1.0 } else { 0.0 }, 0.0, 0.0])
        .phase(Phase::until(0.06));
    let motion = run(&scene, &Settings { rtol: 1e-5, ..Settings::default() }, 0.03);
    let pushed = momentum(&motion, 2, 1, 0);
    assert!(pushed > 0.4, "{pushed}");
    for axis in 0..3 {
        let sum = |at| momentum(&motion, at, 0, axis) + momentum(&motion, at, 1, axis);
        assert!((sum(2) - sum(0)).abs() < 1e-11, "{} {}", sum(2), sum(0));
    }
}

/// A strip that is rolled up touches itself: its ends do not pass through each other, which the indicator of overlaps
/// confirms, and without the contact they do.
#[test]
fn a_body_touches_itself() {
    // a hairpin whose legs are pressed together
    let scene = |touches: bool| {
        let mesh = Mesh::rectangle([0.2, 0.004], [41, 2], Cells::Rectangles).unwrap();
        let bend = |x: &[f64]| {
            let (s, z) = (x[0], x[1]);
            let (leg, radius) = (0.08, 0.04 / std::f64::consts::PI);
            match s {
                s if s < leg => [s, z - radius],
                s if s <= leg + 0.04 => {
                    let angle = (s - leg) / radius;
                    let r = radius - z;
                    [leg + r * angle.sin(), -r * angle.cos()]
                }
                _ => [2.0 * leg + 0.04 - s, radius - z],
            }
        };
        let mesh = mesh.mapped(bend).unwrap();
        let body =
            Body::new(mesh, Material { viscosity: 300.0, ..SOFT }).thickness(0.01).build().unwrap();
        let mut scene =
            Scene::new(body).phase(Phase::until(0.2).hold([1]).load_total([41], [0.0, -0.05]));
        if touches {
            scene = scene.touch(Touch::all());
        }
        run(&scene, &Settings::default(), 0.02)
    };
    let value = |motion: &Trajectory| {
        let indicators = motion.indicators();
        indicators.iter().find(|indicator| indicator.name == "overlap").unwrap().value
    };
    let [free, touching] = [false, true].map(scene);
    println!("overlap {} {}", value(&free), value(&touching));
    assert!(value(&free) > 1e-4 && value(&touching) == 0.0);
}

/// On a finer mesh contact begins at the same distance, though its default is a part of the edges.
#[test]
fn a_finer_mesh_keeps_the_contact() {
    let body = block("block", [0.0, 0.0], [0.1, 0.1], [4, 4], Cells::Triangles).build().unwrap();
    let scene = Scene::new(body).touch(Touch::all()).phase(Phase::until(1e-3));
    let from = |scene: &Scene| {
        let sampling = Sampling::every(1e-3).read("gap", Reading::gap("touch"));
        let motion = scene.simulate(&Settings::default(), &sampling).unwrap();
        motion.samples()[0].sensors[0]
    };
    assert!(from(&scene) > 0.0);
    assert_eq!(from(&scene.halved().unwrap()), from(&scene));
}

/// Bad input is told before anything is computed: what, which value, what to do.
#[test]
fn bad_touches_are_told() {
    let scene = |x: f64, touch: Touch| {
        let left = block("left", [0.0, 0.0], [0.1, 0.1], [3, 3], Cells::Triangles);
        let right = block("right", [0.1 + x, 0.013], [0.1, 0.1], [3, 3], Cells::Triangles);
        Scene::new(joined([left, right])).touch(touch).phase(Phase::until(0.01))
    };
    let told = |x: f64, touch: Touch, words: &[&str]| {
        let error = scene(x, touch).simulate(&Settings::default(), &Sampling::phase_ends());
        let error = error.unwrap_err().to_string();
        words.iter().for_each(|word| assert!(error.contains(word), "{error}: {word}"));
    };
    let touch = Touch::all;
    told(0.01, Touch::between(["left", "rihgt"]), &["touch \"touch\" bodies", "right"]);
    told(0.01, touch().distance(0.0), &["distance", "above 0"]);
    told(0.01, touch().stiffness_density(-1.0), &["stiffness_density", "-1"]);
    told(0.01, touch().damping_density(f64::NAN), &["damping_density", "NaN"]);
    told(0.01, touch().friction_coefficients(0.3, 0.5), &["kinetic", "static"]);
    told(0.01, touch().sticking_speed(0.1), &["sticking_speed", "friction coefficient"]);
    // drawn side by side, and one within the other
    told(
        0.0,
        touch(),
        &["distance at the start", " m cannot be used", "\"left\"", "\"right\"", "apart"],
    );
    told(
        -0.02,
        touch(),
        &["start of what touches", "body \"left\" within body \"right\"", "apart"],
    );
    let twice = scene(0.01, touch()).touch(touch());
    assert!(twice.validate().unwrap_err().to_string().contains("touch name"));
    let string = Mesh::bar(0.1, 3).unwrap().mapped(|x| [x[0], 0.5]).unwrap();
    let string = Body::new(string, SOFT).area(1e-6).named("string");
    let block = block("block", [0.0, 0.0], [0.1, 0.1], [3, 3], Cells::Triangles);
    let scene = Scene::new(joined([block, string])).touch(touch()).phase(Phase::until(0.01));
    assert!(scene.validate().unwrap_err().to_string().contains("no surface"));
}

/// Two blocks with meshes that do not match hand on an even pressure: the contact patch test. Points are loaded one by
/// one on the other surface, so that the pressure there is even on the average, not at each node: cells beside the contact
/// are 3 % off.
#[test]
fn an_even_pressure_passes_through() {
    let material = Material { poisson: 0.0, ..SOFT };
    let lower = block("lower", [0.0, 0.0], [0.1, 0.05], [6, 4], Cells::Rectangles);
    let upper = block("upper", [0.0, 0.0505], [0.1, 0.05], [9, 4], Cells::Rectangles);
    let bodies = joined([lower, upper].map(|body| body.material(material)));
    let pressure = 100.0;
    let scene = Scene::new(bodies).touch(Touch::all().distance(1e-3)).phase(
        Phase::until(1.0)
            .hold_axes("lower/bottom", [Axis::Y])
            .hold_axes("lower/left", [Axis::X])
            .hold_axes("upper/left", [Axis::X])
            .traction("upper/top", [0.0, -pressure]),
    );
    let found = scene.equilibrium(&Statics::default()).unwrap();
    let fields = found.trajectory().body().cell_fields(&found.sample().u);
    let off = fields.iter().map(|field| (field.stress[1][1] / -pressure - 1.0).abs());
    let worst = off.fold(0.0, f64::max);
    println!("patch test: {worst}");
    assert!(worst < 0.035, "{worst}");
}

/// The ring of the scenes presses on its table, folds onto itself without passing through it, and comes off again.
#[test]
fn a_ring_bounces_off_a_soft_table() {
    const TEXT: &str = include_str!("../../scenes/ring-on-table.toml");
    let file = SceneFile::parse(TEXT, Path::new("ring-on-table.toml")).unwrap();
    let settings = Settings { rtol: 1e-3, ..file.settings.clone() };
    let scene = file.scene.clone().ended_at(0.32);
    let motion = scene.simulate(&settings, &file.output.sampling()).unwrap();
    let pushes: Vec<f64> = motion.samples().iter().map(|sample| sample.sensors[0]).collect();
    let most = pushes.iter().copied().fold(0.0, f64::min);
    assert!(most < -1.0, "{pushes:?}");
    assert!(pushes[0] == 0.0 && pushes[pushes.len() - 1] == 0.0, "{pushes:?}");
    let overlap = motion.indicators();
    let overlap = overlap.iter().find(|indicator| indicator.name == "overlap").unwrap();
    assert!(overlap.value == 0.0, "{overlap:?}");
}

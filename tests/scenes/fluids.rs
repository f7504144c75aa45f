//! Bodies in a fluid against closed forms: falling, coasting, floating, heaving, a gate, a beam that vibrates; methods against each other.

use pliant::{
    Body, Cells, Fluid, Material, Mesh, Method, Phase, Plane, Sampling, Scene, SolidCells,
    Stability, Statics, Strain, simulate::Reading,
};

use crate::common::{imbalance, run, settings};

const WATER: f64 = 1000.0;
const GRAVITY: f64 = 9.8;

/// Methods of all forms of the equations that know rigid bodies.
const METHODS: [Method; 5] =
    [Method::CvodeBdf, Method::CvodeAdams, Method::Arkode, Method::Rk, Method::Rosenbrock];

/// A block of this density, 0.1 m wide, 0.06 m high and 0.05 m thick, whose lower corner is at the origin.
fn block(density: f64, in_space: bool) -> Body {
    if in_space {
        let mesh = Mesh::cuboid([0.1, 0.06, 0.05], [3, 2, 2], SolidCells::Hexahedra).unwrap();
        return Body::new(mesh, Material::rigid(density)).build().unwrap();
    }
    let mesh = Mesh::rectangle([0.1, 0.06], [3, 2], Cells::Rectangles).unwrap();
    Body::new(mesh, Material::rigid(density)).thickness(0.05).build().unwrap()
}

const VOLUME: f64 = 0.1 * 0.06 * 0.05;
/// Of the lower face and the upper one, each.
const AREA: f64 = 0.1 * 0.05;

fn down(body: &Body) -> Vec<f64> {
    [0.0, -GRAVITY, 0.0][..body.dimension()].to_vec()
}

/// A block heavier than water sinks in it as tanh, from rest to the speed at which drag carries its weight less its buoyancy. Both the face below and the one above
/// brake, and those at the sides by their skin.
#[test]
fn a_block_sinks_to_its_terminal_speed() {
    for in_space in [false, true] {
        let body = block(1500.0, in_space);
        // the sides along which it moves: two in the plane, four in space
        let sides = 0.06 * if in_space { 0.3 } else { 0.1 };
        let added = 4.0;
        let water = Fluid::new(WATER).drag(0.9, 0.05).added_mass(added).level(50.0);
        let drag = 0.5 * WATER * (0.9 * 2.0 * AREA + 0.05 * sides);
        let mass = 1500.0 * VOLUME + added * (2.0 * AREA + sides);
        let weight = (1500.0 - WATER) * VOLUME * GRAVITY;
        let terminal = (weight / drag).sqrt();
        let rate = (weight * drag).sqrt() / mass;
        let gravity = down(&body);
        let scene = Scene::new(body).gravity(gravity).fluid(water).phase(Phase::until(3.0 / rate));
        let times = [0.5 / rate, 3.0 / rate];
        for method in METHODS {
            let motion = run(&scene, &settings(method, 1e-7), &times);
            for sample in &motion.samples()[1..] {
                let expected = -terminal * (rate * sample.time).tanh();
                let sunk = -terminal / rate * (rate * sample.time).cosh().ln();
                let off = (motion.mean_velocity(sample)[1] / expected - 1.0).abs();
                let apart = ((motion.centre_of_mass(sample)[1] - 0.03) / sunk - 1.0).abs();
                let across = motion.centre_of_mass(sample)[0] - 0.05;
                println!("{method} {in_space}: {off:.1e} {apart:.1e} {across:.1e}");
                assert!(off < 2e-5 && apart < 2e-5 && across.abs() < 1e-7, "{method}");
            }
            println!("{method}: balance {:.1e}", imbalance(&motion));
            assert!(imbalance(&motion) < 1e-5, "{method}");
        }
    }
}

/// A soft block that coasts slows down as 1/(1 + t/tau), tau = m/(k v); one at rest in a current is taken along likewise. Central differences do so, too.
#[test]
fn a_block_coasts_and_is_taken_along() {
    let speed = 0.5;
    let mesh = Mesh::rectangle([0.1, 0.06], [3, 2], Cells::Rectangles).unwrap();
    // so stiff that its strains, 1e-7, do not matter
    let stiff = Material { density: 1500.0, young: 1e8, poisson: 0.0, viscosity: 1e4 };
    let body = Body::new(mesh, stiff).strain(Strain::Cauchy).thickness(0.05).build().unwrap();
    let mass = 1500.0 * VOLUME;
    let drag = 0.5 * WATER * (0.9 * 2.0 * 0.06 * 0.05 + 0.05 * 2.0 * AREA);
    let tau = mass / (drag * speed);
    let fluid = Fluid::new(WATER).drag(0.9, 0.05);
    let phase = Phase::until(2.0 * tau);
    let coasting = Scene::new(body.clone())
        .fluid(fluid.clone())
        .initial_velocity(move |_| vec![speed, 0.0])
        .phase(phase.clone());
    let taken = Scene::new(body).fluid(fluid.velocity([speed, 0.0])).phase(phase);
    let slower = 1.0 / 3.0;
    for (scene, expected) in [(&coasting, slower), (&taken, 1.0 - slower)] {
        for method in [Method::CvodeBdf, Method::Arkode, Method::CentralDifference] {
            let motion = run(scene, &settings(method, 1e-5), &[2.0 * tau]);
            let last = motion.last();
            let off = motion.mean_velocity(last)[0] / speed - expected;
            println!("{method}: {off:.1e}, balance {:.1e}", imbalance(&motion));
            assert!(off.abs() < 1e-4 && imbalance(&motion) < 1e-3, "{method}: {off:.1e}");
            // heat and motion together are what the current supplied, or the start
            let energy = 0.5 * mass * speed * speed;
            let heat = last.energy.dissipated / energy;
            let (first, drawn) = match last.energy.supplied == 0.0 {
                true => (1.0 - expected * expected, 0.0),
                // the current gives its momentum at its speed
                false => (2.0 * expected - expected * expected, 2.0 * expected),
            };
            let supplied = last.energy.supplied / energy;
            assert!((heat - first).abs() < 1e-3 && (supplied - drawn).abs() < 1e-3, "{method}");
        }
    }
}

/// A block comes to Archimedes' depth in statics, whatever holds it not, and heaves about it with sqrt(rho g A/(m + m_a)).
#[test]
fn a_block_floats_and_heaves() {
    let (density, added, level) = (600.0, 5.0, 0.02);
    let body = block(density, false);
    let water = Fluid::new(WATER).added_mass(added).level(level);
    let gravity = down(&body);
    let scene = Scene::new(body).gravity(gravity).fluid(water).phase(Phase::until(1.0));
    let floating = scene.equilibrium(&Statics::default()).unwrap();
    let draught = density / WATER * 0.06;
    let height = floating.trajectory().centre_of_mass(floating.sample())[1];
    let off = height - (level - draught + 0.03);
    println!("{off:.1e} m, {:?}, {:?}", floating.stability, floating.removed);
    // in equilibria what is rigid is only stiff, and the round-off of its elasticity is some 1e-6 of its weight
    assert!(off.abs() < 3e-7, "{off:.1e}");

    let area = 2.0 * (AREA + 0.05 * 0.06);
    let rate = (WATER * GRAVITY * AREA / (density * VOLUME + added * area)).sqrt();
    let scene = scene.initial_displacement(move |x| {
        let mut raised = vec![0.0; x.len()];
        raised[1] = level - draught + 0.01;
        raised
    });
    for method in METHODS {
        let until = 2.3 / rate;
        let scene = scene.clone().ended_at(until);
        let motion = run(&scene, &settings(method, 1e-8), &[until]);
        let height = motion.centre_of_mass(motion.last())[1] - (level - draught + 0.03);
        let off = (height - 0.01 * 2.3_f64.cos()).abs() / 0.01;
        println!("{method}: {off:.1e}, balance {:.1e}", imbalance(&motion));
        assert!(off < 1e-4 && imbalance(&motion) < 1e-4, "{method}: {off:.1e}");
    }
}

/// Water on one side of a gate pushes it by rho g h^2/2 per width, and turns it about its foot by rho g h^3/6. Where its surface is between nodes, the force is
/// right up to what the quadrature points of one face miss.
#[test]
fn water_pushes_a_gate() {
    let (height, thickness) = (0.2, 0.1);
    for (cells, off_between) in [(Cells::Rectangles, 0.05), (Cells::Rectangles9, 0.02)] {
        let mesh = Mesh::rectangle([0.02, height], [2, 9], cells).unwrap();
        let stiff = Material { density: 1000.0, young: 1e9, poisson: 0.0, viscosity: 0.0 };
        let gate =
            Body::new(mesh, stiff).plane(Plane::Stress).thickness(thickness).build().unwrap();
        for (deep, most) in [(0.2, 1e-4), (0.1, 1e-4), (0.11, off_between)] {
            let scene = Scene::new(gate.clone())
                .gravity([0.0, -GRAVITY])
                .fluid(Fluid::new(WATER).named("sea").level(deep).on("left"))
                .phase(Phase::until(1.0).hold("bottom"));
            let mut found = scene.equilibrium(&Statics::default()).unwrap();
            let sampling = Sampling::phase_ends()
                .read("sea", Reading::fluid_force("sea"))
                .read("foot", Reading::constraint_force("bottom"))
                .read("moment", Reading::constraint_moment("bottom", [0.0, 0.0]));
            found.read(&sampling).unwrap();
            let n = found.sample().sensors.len();
            let [sea, _, foot, _, moment] = found.sample().sensors[n - 5..] else { panic!() };
            let force = 0.5 * WATER * GRAVITY * deep * deep * thickness;
            let turn = force * deep / 3.0;
            // the weight of the gate turns it, too
            let own = 1000.0 * 0.02 * height * thickness * GRAVITY * 0.01;
            let off = [sea / force - 1.0, -foot / force - 1.0, (moment - own) / turn - 1.0];
            println!("{cells:?} {deep}: {off:?}");
            assert!(off[..2].iter().all(|off| off.abs() < most), "{cells:?} {deep}: {off:?}");
            assert!(off[2].abs() < 10.0 * most, "{cells:?} {deep}: {off:?}");
        }
    }
}

/// A slender beam vibrates slower in a fluid by the root of its mass per length by that with what it carries along on both sides.
#[test]
fn a_beam_is_slower_in_a_fluid() {
    let [length, height] = [0.2, 0.004];
    let mesh = Mesh::rectangle([length, height], [41, 3], Cells::Rectangles9).unwrap();
    let material = Material { density: 1100.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
    let body = Body::new(mesh, material).plane(Plane::Stress).thickness(0.02).build().unwrap();
    let dry = Scene::new(body).phase(Phase::until(1.0).hold("left"));
    let frequency = |scene: &Scene| match scene.equilibrium(&Statics::default()).unwrap().stability
    {
        Stability::Stable { frequency } => frequency,
        other => panic!("{other:?}"),
    };
    let added = std::f64::consts::PI / 8.0 * WATER * 0.02;
    // its end has none, as the mass there is not that of the beam
    let carried = |side: &str| Fluid::new(WATER).added_mass(added).on(side);
    let wet = dry.clone().fluid(carried("top")).fluid(carried("bottom"));
    let expected = (1100.0 * height / (1100.0 * height + 2.0 * added)).sqrt();
    let found = frequency(&wet) / frequency(&dry);
    println!("{found} {expected}");
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    // finer meshes keep the fluid
    let finer = frequency(&wet.quadratic().or_else(|_| wet.halved()).unwrap());
    assert!((finer / frequency(&wet) - 1.0).abs() < 1e-3, "{finer}");
}

/// A soft block falls askew into water that flows, turns and comes up again: methods of different families agree, and the energy is accounted for, although the surface of the
/// water crosses its faces and gives forces kinks.
#[test]
fn methods_agree_on_a_splash() {
    let (sin, cos) = (0.4_f64.sin(), 0.4_f64.cos());
    let mesh = Mesh::rectangle([0.1, 0.06], [5, 4], Cells::Triangles6).unwrap();
    let mesh = mesh.mapped(|x| [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]]).unwrap();
    let soft = Material { density: 500.0, young: 5e4, poisson: 0.3, viscosity: 100.0 };
    let body = Body::new(mesh, soft).thickness(0.05).build().unwrap();
    let water = Fluid::new(WATER).drag(0.8, 0.02).added_mass(2.0).level(-0.02);
    let scene = Scene::new(body)
        .gravity([0.0, -GRAVITY])
        .fluid(water.velocity_with(|t| [0.2 * (5.0 * t).sin(), 0.0]))
        .phase(Phase::until(0.4));
    let times = [0.1, 0.2, 0.3, 0.4];
    let solve = |method, rtol| run(&scene, &settings(method, rtol), &times);
    let reference = solve(Method::Arkode, 1e-7);
    for (method, rtol, most) in [
        (Method::CvodeBdf, 1e-6, 1e-3),
        (Method::Ida, 1e-6, 1e-3),
        (Method::Rk, 1e-5, 1e-3),
        (Method::Rosenbrock, 1e-5, 1e-3),
        (Method::CentralDifference, 1e-4, 1e-3),
    ] {
        let motion = solve(method, rtol);
        let apart = crate::common::difference(&motion, &reference);
        println!("{method}: {apart:.1e}, balance {:.1e}", imbalance(&motion));
        assert!(apart < most && imbalance(&motion) < most, "{method}: {apart:.1e}");
    }
}

/// The scene of a block that falls into water: it turns over, and comes to rest at Archimedes' depth, but for the last of its heaving.
#[test]
fn a_block_of_foam_comes_to_rest() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/float.toml");
    let file = pliant::SceneFile::read(path).unwrap();
    assert_eq!(file.scene.warnings(), Vec::<String>::new());
    let motion = file.scene.simulate(&file.settings, &Sampling::phase_ends()).unwrap();
    let height = motion.centre_of_mass(motion.last())[1];
    let off = height - (0.03 - 0.4 * 0.06);
    println!("{off:.1e} m, balance {:.1e}", imbalance(&motion));
    // 0.7 mm were found, of 50 mm from which it falls
    assert!(off.abs() < 1e-3 && imbalance(&motion) < 1e-3, "{off:.1e}");
}

/// The fish swims head first: after its first second it has left where it was, and its centre of mass moves to the left.
#[test]
fn a_fish_swims_head_first() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/fish.toml");
    let file = pliant::SceneFile::read(path).unwrap();
    assert_eq!(file.scene.warnings(), Vec::<String>::new());
    let scene = file.scene.ended_at(1.0);
    let motion = scene.simulate(&file.settings, &Sampling::phase_ends()).unwrap();
    let [first, last] = [&motion.samples()[0], motion.last()];
    let moved = motion.centre_of_mass(last)[0] - motion.centre_of_mass(first)[0];
    let speed = motion.mean_velocity(last)[0];
    println!("{moved} m, {speed} m/s, balance {:.1e}", imbalance(&motion));
    assert!(moved < -0.005 && speed < -0.03 && imbalance(&motion) < 1e-2);
}

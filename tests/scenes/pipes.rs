//! Pipes between liquids: against closed forms, and one method against another.

use pliant::simulate::Reading;
use pliant::{
    Body, Cells, Chamber, Gas, Liquid, Material, Mesh, Method, Phase, Pipe, Sampling, Scene,
    Spring, Statics, Strain,
};

use super::gas::{BASE, HALF, VOLUME, cylinders, phase};

use crate::common::{imbalance, settings};

const WATER: f64 = 1000.0;
const OUTSIDE: f64 = 101_325.0;

/// Methods with unknowns for flows, but those that follow the sound of water.
const METHODS: [Method; 5] =
    [Method::CvodeBdf, Method::Ida, Method::IdaIndexTwo, Method::Arkode, Method::Rosenbrock];

/// Two cylinders full of water under pistons on springs of the compliances C = B^2/k, joined by a pipe, one spring of which pushes from t = 0 on: what has flowed follows
/// L Q'' + R Q' + (1/C_1 + 1/C_2) (Q - Q_end) = 0, where the pistons add m/B^2 each to the inertance L = rho l/A.
#[test]
fn two_vessels_swing_through_a_pipe() {
    let (stiff, soft, pushed) = (3000.0, 1000.0, 1e-3);
    let (length, area) = (2.0, 2e-4);
    let inertance = WATER * length / area + 2.0 * (2.0 * HALF) / (BASE * BASE);
    let rate = ((stiff + soft) / (BASE * BASE) / inertance).sqrt();
    let end = BASE * pushed * stiff / (stiff + soft);
    let per_viscosity = 8.0 * std::f64::consts::PI * length / (area * area);
    for damping in [0.0, 0.15] {
        let resistance = 2.0 * damping * rate * inertance;
        let pipe = Pipe::new("pipe", "0", "1", length, area).viscosity(resistance / per_viscosity);
        let scene = (0..2).fold(cylinders(2).pipe(pipe), |scene, number| {
            let scene = scene.liquid(Liquid::in_chamber(format!("{number}")));
            let (stiffness, more) = [(stiff, pushed), (soft, 0.0)][number];
            [5, 6].into_iter().fold(scene, |scene, node| {
                let x = number as f64 + if node == 6 { 0.1 } else { 0.0 };
                let spring = Spring::anchored([6 * number + node], [x, 1.11]);
                let spring = spring.named(format!("{number}{node}")).stiffness(0.5 * stiffness);
                scene.spring(spring.length(1.0 + more))
            })
        });
        let scene = scene.phase(phase(10.0 / rate, true, 2));
        let sampling = Sampling::every(0.5 / rate)
            .read("flow", Reading::pipe_flow("pipe"))
            .read("there", Reading::liquid_volume("1"));
        // BDF of CVODE takes 130,000 steps, as pistons on water vibrate undamped
        for method in [Method::Ida, Method::Arkode, Method::Rosenbrock] {
            let motion = scene.simulate(&settings(method, 1e-6), &sampling).unwrap();
            let (fading, swinging) = (damping * rate, rate * (1.0_f64 - damping * damping).sqrt());
            let each = motion.samples().iter().map(|sample| {
                let (t, [flow, there]) = (sample.time, [sample.sensors[0], sample.sensors[1]]);
                let fade = (-fading * t).exp();
                let (sin, cos) = (swinging * t).sin_cos();
                let flowed = end * (1.0 - fade * (cos + fading / swinging * sin));
                let rising = end * fade * rate * rate / swinging * sin;
                [(there - VOLUME - flowed) / end, (flow - rising) / (end * rate)]
            });
            let apart = each
                .fold([0.0_f64; 2], |most, each| [0, 1].map(|k| most[k].max(f64::abs(each[k]))));
            let energy = imbalance(&motion);
            println!(
                "{damping}, {method}: off by {apart:?}, balance {energy:e}, {} steps",
                motion.report().steps()
            );
            // the methods, and the compression of the water itself
            assert!(apart.iter().all(|apart| *apart < 1e-3), "{method}: {apart:?}");
            assert!(energy < 1e-3, "{method}: {energy:e}");
        }
    }
}

/// A ring of rubber on a long tube from a basin swings by its compliance dV/dp, as equilibria under pressures tell it: as 1/sqrt(L C).
#[test]
fn a_soft_ring_swings_by_its_compliance() {
    let mesh = Mesh::ring(0.02, 0.03, [24, 3], Cells::Rectangles).unwrap();
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 0.0 };
    let body = Body::new(mesh, rubber).thickness(0.02).strain(Strain::Green).build().unwrap();
    let ring = Scene::new(body).chamber(Chamber::within("bag", "inner"));
    let held = |until: f64| Phase::until(until).hold([1, 25, 49]).hold([13, 37, 61]);
    let volume = |pressure: f64| {
        let rest = ring.clone().phase(held(1.0).pressure("bag", pressure));
        let mut rest = rest.equilibrium(&Statics::default()).unwrap();
        rest.read(&Sampling::phase_ends().read("V", Reading::chamber_volume("bag"))).unwrap();
        rest.sample().sensors[0]
    };
    let step = 100.0;
    let compliance = (volume(step) - volume(-step)) / (2.0 * step);
    // so long that the mass of the ring is nothing beside it
    let (length, area) = (30.0, 1e-5);
    let rate = 1.0 / (compliance * WATER * length / area).sqrt();
    let end = 7.0 / rate;
    let scene = ring
        .liquid(Liquid::in_chamber("bag"))
        .supply("basin", OUTSIDE + step)
        .pipe(Pipe::new("tube", "basin", "bag", length, area).viscosity(0.0))
        .phase(held(end));
    let sampling = Sampling::every(end / 28.0).read("p", Reading::pressure("bag"));
    let motion = scene.simulate(&settings(Method::Arkode, 1e-8), &sampling).unwrap();
    let apart = motion.samples().iter().map(|sample| {
        let volume = sample.amounts[0] / WATER;
        let first = motion.samples()[0].amounts[0] / WATER;
        let expected = compliance * step * (1.0 - (rate * sample.time).cos());
        (volume - first - expected).abs() / (compliance * step)
    });
    let apart = apart.fold(0.0, f64::max);
    println!("{rate} rad/s, off by {apart:e}, balance {:e}", imbalance(&motion));
    assert!(apart < 1e-2, "{apart:e}");
}

/// Rigid vessels with upright walls, 0.2 m wide and high and 0.1 m thick, the second of which stands higher, joined by a pipe.
fn communicating(raised: f64, fills: [f64; 2], pipe: Pipe) -> Scene {
    let vessel = |number: usize| {
        let mesh = Mesh::rectangle([0.2, 0.2], [2, 2], Cells::Rectangles).unwrap();
        let mesh = mesh.translated(&[number as f64, raised * number as f64]).unwrap();
        let body = Body::new(mesh, Material::rigid(1000.0)).thickness(0.1);
        body.named(format!("{number}")).build().unwrap()
    };
    let scene = Scene::new(Body::join([vessel(0), vessel(1)]).unwrap()).gravity([0.0, -9.8]);
    let scene = (0..2).fold(scene, |scene, number| {
        let name = format!("{number}");
        let chamber = Chamber::within(&name, [1, 2, 4, 3].map(|node| 4 * number + node));
        let liquid = Liquid::in_chamber(&name).fill(fills[number]).surface();
        scene.chamber(chamber).liquid(liquid)
    });
    scene.pipe(pipe)
}

/// The levels of two vessels swing as in a U-tube, as sqrt(2 g A/(B l)) with their bases B, and end at the same height with losses, wherever the vessels stand.
#[test]
fn levels_swing_and_become_equal() {
    let (length, area, base) = (1.5_f64, 4e-4, 0.02);
    let rate = (2.0 * 9.8 * area / (base * length)).sqrt();
    let sampling = Sampling::every(0.5 / rate)
        .read("first", Reading::liquid_level("0"))
        .read("second", Reading::liquid_level("1"));
    let pipe = || Pipe::new("pipe", "0", "1", length, area).viscosity(0.0);
    let scene = communicating(0.03, [0.6, 0.35], pipe());
    // 0.12 m and 0.03 m + 0.07 m
    let end = 10.0 / rate;
    let free = scene.phase(Phase::until(end).hold("all"));
    for method in METHODS.into_iter().chain([Method::Rk, Method::CvodeAdams]) {
        let motion = free.simulate(&settings(method, 1e-7), &sampling).unwrap();
        let apart = motion.samples().iter().map(|sample| {
            let expected = 0.11 + 0.01 * (rate * sample.time).cos();
            let other = 0.22 - expected;
            (sample.sensors[0] - expected).abs().max((sample.sensors[1] - other).abs()) / 0.01
        });
        let apart = apart.fold(0.0, f64::max);
        println!("{method}: off by {apart:e}, balance {:e}", imbalance(&motion));
        assert!(apart < 1e-3 && imbalance(&motion) < 1e-3, "{method}: {apart:e}");
    }
    let braked = communicating(0.03, [0.6, 0.35], pipe().viscosity(0.01).loss(1.5));
    let braked = braked.phase(Phase::until(10.0 * end).hold("all"));
    let motion = braked.simulate(&settings(Method::CvodeBdf, 1e-6), &sampling).unwrap();
    let [first, second] = motion.last().sensors[..] else { panic!("two levels") };
    // what is lost has become heat: rho g B (0.01 m)^2
    let lost = motion.last().energy.dissipated / (WATER * 9.8 * base * 1e-4);
    println!("{first} m, {second} m, {lost} of the heat");
    assert!((first - 0.11).abs() < 1e-6 && (second - 0.11).abs() < 1e-6);
    assert!((lost - 1.0).abs() < 1e-3, "{lost}");
}

/// From a supply of constant pressure through a pipe with losses alone the flow starts as q = q_end tanh(t sqrt(p Z)/L), q_end = sqrt(p/Z), Z = zeta rho/(2 A^2); with friction alone as
/// 1 - exp(-R t/L). All that a supply gives is motion, heat, and the weight that is lifted.
#[test]
fn flows_start_as_losses_let_them() {
    let (length, area, pressure) = (0.5_f64, 1e-5_f64, 2000.0_f64);
    let inertance = WATER * length / area;
    for (viscosity, loss) in [(0.0, 1.5), (2e-3, 0.0)] {
        let turbulent = loss * WATER / (2.0 * area * area);
        let friction = 8.0 * std::f64::consts::PI * viscosity * length / (area * area);
        let (end, time) = match loss > 0.0 {
            true => ((pressure / turbulent).sqrt(), inertance / (pressure * turbulent).sqrt()),
            false => (pressure / friction, inertance / friction),
        };
        let pipe = Pipe::new("pipe", "pump", "0", length, area).viscosity(viscosity).loss(loss);
        // so little gravity that the level does not matter
        let scene = communicating(0.0, [0.5, 0.5], pipe).gravity([0.0, -1e-6]);
        let scene = scene.supply("pump", OUTSIDE + pressure);
        let scene = scene.phase(Phase::until(3.0 * time).hold("all"));
        let sampling = Sampling::every(0.25 * time).read("flow", Reading::pipe_flow("pipe"));
        for method in METHODS {
            let motion = scene.simulate(&settings(method, 1e-7), &sampling).unwrap();
            let apart = motion.samples().iter().map(|sample| {
                let t = sample.time / time;
                let expected = if loss > 0.0 { t.tanh() } else { 1.0 - (-t).exp() };
                (sample.sensors[0] / end - expected).abs()
            });
            let apart = apart.fold(0.0, f64::max);
            println!("{loss}, {method}: off by {apart:e}, balance {:e}", imbalance(&motion));
            assert!(apart < 1e-4 && imbalance(&motion) < 1e-4, "{method}: {apart:e}");
        }
    }
}

/// A checkpoint in a file goes on bit by bit, flows included; methods and equilibria that have no flows say so, and mistakes are told.
#[test]
fn limits_are_told() {
    let pipe = || Pipe::new("pipe", "0", "1", 1.0, 1e-4);
    let scene = communicating(0.0, [0.6, 0.4], pipe()).phase(Phase::until(2.0).hold("all"));
    let start = || scene.start(&settings(Method::Arkode, 1e-4)).unwrap();
    let mut vessels = start();
    vessels.advance_to(0.5).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("pipe.json");
    let kept = vessels.checkpoint();
    kept.write(&file).unwrap();
    vessels.restore(&kept).unwrap();
    vessels.advance_to(1.0).unwrap();
    let flow = vessels.view().pipe_flow("pipe").unwrap();
    assert!(flow > 0.0);
    let mut other = start();
    let kept = other.read_checkpoint(&file).unwrap();
    other.restore(&kept).unwrap();
    other.advance_to(1.0).unwrap();
    assert_eq!(other.view().pipe_flow("pipe").unwrap(), flow);
    let told = vessels.view().pipe_flow("pope").unwrap_err().to_string();
    assert!(told.contains("did you mean \"pipe\""), "{told}");
    let central = settings(Method::CentralDifference, 1e-4);
    let told = scene.simulate(&central, &Sampling::every(0.1)).unwrap_err();
    assert!(told.to_string().contains("through pipes"), "{told}");
    let told = scene.equilibrium(&Statics::default()).unwrap_err().to_string();
    assert!(told.contains("pipe of statics"), "{told}");
    let with = |scene: Scene| match scene.phase(Phase::until(1.0).hold("all")).validate() {
        Err(error) => error.to_string(),
        Ok(()) => panic!("it is taken"),
    };
    let filled = |pipe: Pipe| communicating(0.0, [0.5, 0.5], pipe);
    let oil = || {
        let gas = cylinders(1).gas(Gas::in_chamber("0")).supply("pump", 2e5);
        gas.pipe(Pipe::new("pipe", "pump", "0", 1.0, 1e-4))
    };
    let heavy = cylinders(2)
        .liquid(Liquid::in_chamber("0"))
        .liquid(Liquid::in_chamber("1").density(900.0))
        .pipe(pipe());
    for (scene, words) in [
        (filled(Pipe::new("pipe", "0", "1", 0.0, 1e-4)), "pipe \"pipe\" length = 0"),
        (filled(Pipe::new("pipe", "0", "1", 1.0, -1.0)), "pipe \"pipe\" area = -1"),
        (filled(pipe().viscosity(-1.0)), "viscosity = -1"),
        (filled(pipe().loss(f64::NAN)), "loss = NaN"),
        (filled(Pipe::new("pipe", "0", "0", 1.0, 1e-4)), "from one place to another"),
        (filled(Pipe::new("pipe", "0", "2", 1.0, 1e-4)), "ends of pipes"),
        (filled(pipe()).pipe(pipe()), "pipe name = \"pipe\" cannot be used: it is taken"),
        (oil(), "the chamber has no liquid"),
        (heavy, "1000 and 900 kg/m^3"),
    ] {
        let told = with(scene);
        println!("{told}");
        assert!(told.contains(words), "{told}: {words}");
    }
}

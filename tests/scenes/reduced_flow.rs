//! Reduced models of bodies with gas and liquids that flow and actuators that lag, against the full ones.

use std::ops::ControlFlow;

use pliant::reduce::{Training, error, reduce};
use pliant::simulate::Reading;
use pliant::{
    Body, Cells, Chamber, Gas, Lag, Law, Liquid, Material, Mesh, Method, Orifice, Phase, Pipe,
    ReducedModel, Sampling, Scene, Signal, Spring, Trajectory,
};

use crate::common::settings;

const RUBBER: Material = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 100.0 };
const TIP: usize = 2 * 38 + 1;

fn run(scene: &Scene, method: Method, rtol: f64) -> Trajectory {
    scene.simulate(&settings(method, rtol), &Sampling::every(0.01)).unwrap()
}

fn learned(scenes: Vec<Scene>, within: f64, most_unknowns: usize) -> ReducedModel {
    let settings = settings(Method::Arkode, 1e-6);
    let training = Training { scenes, held_out: Vec::new(), settings, within, most_unknowns };
    reduce(&training, &mut |_| ControlFlow::Continue(())).unwrap().model
}

/// A finger, clamped on the left, with a chamber in its upper half that a pump of that absolute pressure (Pa) fills through an orifice,
/// and a wire below it that pulls late by up to `force` (N).
fn finger(pump: f64, force: f64) -> Scene {
    let mesh = Mesh::rectangle([0.1, 0.02], [13, 4], Cells::Rectangles).unwrap();
    let law = RUBBER.law(Law::NeoHookean);
    let body = Body::new(mesh, law).thickness(0.01).build().unwrap();
    let walls: Vec<usize> = (27..=39).chain((40..=52).rev()).collect();
    let wire = Spring::between([1], [13]).named("wire").stiffness(0.5).damping(1e-2);
    Scene::new(body)
        .chamber(Chamber::within("bellows", walls))
        .gas(Gas::in_chamber("bellows"))
        .supply("pump", pump)
        .orifice(Orifice::new("inlet", "pump", "bellows", 1e-11))
        .orifice(Orifice::new("outlet", "bellows", "atmosphere", 5e-12))
        .spring(wire)
        .lag(Lag::first_order(0.05), ["wire"])
        .phase(
            Phase::until(0.3)
                .named("fed")
                .hold("left")
                .open("outlet", 0.0)
                .actuate(["wire"], force),
        )
        .phase(Phase::until(0.5).named("vented").hold("left").open("inlet", 0.0))
}

/// Both ends of the ranges of what drives it.
fn corners() -> Vec<Scene> {
    let ends = [(1.04e5, 0.0), (1.04e5, 0.1), (1.08e5, 0.0), (1.08e5, 0.1)];
    ends.map(|(pump, force)| finger(pump, force)).into()
}

/// Of the amounts and of the states that lag the largest part by which two runs differ.
fn apart(one: &Trajectory, other: &Trajectory) -> f64 {
    let amounts = one.samples()[0].amounts.len();
    let of = |k: usize| {
        let pairs = one.samples().iter().zip(other.samples());
        let (off, most) = pairs.fold((0.0_f64, 0.0_f64), |(off, most), (a, b)| {
            (off.max((a.amounts[k] - b.amounts[k]).abs()), most.max(a.amounts[k].abs()))
        });
        off / most
    };
    (0..amounts).map(of).fold(0.0, f64::max)
}

/// A run that it was not learned from: motion, amounts, the flow that a sensor reads, the error that it tells, energy.
#[test]
fn a_finger_that_is_blown_up_through_an_orifice_is_reduced() {
    let model = learned(corners(), 0.01, 64);
    assert!(model.unknowns() <= 12, "{model}");
    let full = finger(1.06e5, 0.07);
    let sampling = Sampling::every(0.01).read("in", Reading::gas_flow("inlet"));
    let [exact, own] = [full.clone(), full.reduced(model).unwrap()]
        .map(|scene| scene.simulate(&settings(Method::Arkode, 1e-6), &sampling).unwrap());
    let off = error(&exact, &own);
    let told = own.report().reduced.as_ref().unwrap().estimated_error;
    let amounts = apart(&exact, &own);
    println!("off by {off:.1e}, told {told:.1e}, amounts by {amounts:.1e}");
    // between the points that it was learned from
    assert!(off < 0.02, "{off:e}");
    assert!(told > 0.5 * off && told < 10.0 * off, "told {told:e} of {off:e}");
    assert!(amounts < 1e-4, "{amounts:e}");
    let flow = |run: &Trajectory| run.samples()[10].sensors[0];
    assert!((flow(&own) / flow(&exact) - 1.0).abs() < 0.01, "{:e}", flow(&own));
    let report = own.report();
    let balance = report.energy_error / report.energy_scale;
    println!("energy by {balance:.1e}");
    // the sample is a potential, and amounts have theirs: as in full runs
    assert!(balance < 5e-5, "{balance:e}");
}

/// All methods that have unknowns for amounts integrate the same few equations.
#[test]
fn methods_agree_on_a_reduced_model_with_amounts() {
    let scene = finger(1.06e5, 0.07);
    let reduced = scene.clone().reduced(learned(vec![scene], 0.02, 8)).unwrap();
    let exact = run(&reduced, Method::Arkode, 1e-10);
    for method in
        [Method::CvodeBdf, Method::CvodeAdams, Method::Rosenbrock, Method::Rk, Method::Auto]
    {
        let own = run(&reduced, method, 1e-7);
        let (off, amounts) = (error(&exact, &own), apart(&exact, &own));
        let report = own.report();
        let balance = report.energy_error / report.energy_scale;
        println!("{method}: off by {off:.1e}, amounts by {amounts:.1e}, energy by {balance:.1e}");
        assert!(off < 1e-5 && amounts < 1e-5 && balance < 1e-5, "{method}: {off:e} {amounts:e}");
    }
    for method in [Method::Ida, Method::IdaIndexTwo, Method::CentralDifference] {
        let settings = settings(method, 1e-4);
        let message = reduced.simulate(&settings, &Sampling::every(0.1)).unwrap_err().to_string();
        assert!(message.contains("method"), "{message}");
    }
}

/// As many shapes as there are free displacements: liquids with a pipe between them, gas with an orifice and a wire that lags.
#[test]
fn with_all_shapes_it_is_the_full_motion() {
    let mesh = Mesh::rectangle([0.03, 0.02], [4, 3], Cells::Triangles).unwrap();
    let law = RUBBER.law(Law::NeoHookean);
    let body = Body::new(mesh, law).thickness(0.01).build().unwrap();
    let wire = Spring::between([1], [8]).named("wire").stiffness(0.5).damping(1e-2);
    let scene = |node: usize, load: [f64; 2]| {
        Scene::new(body.clone())
            .gravity([0.0, -9.8])
            .chamber(Chamber::within("air", [2, 3, 7, 6]))
            .chamber(Chamber::within("left", [5, 6, 10, 9]))
            .chamber(Chamber::within("right", [7, 8, 12, 11]))
            .gas(Gas::in_chamber("air").exponent(1.4))
            .supply("pump", 1.06e5)
            .orifice(Orifice::new("inlet", "pump", "air", 1e-12))
            .liquid(Liquid::in_chamber("left").bulk_modulus(1e7))
            .liquid(Liquid::in_chamber("right").bulk_modulus(1e7))
            .pipe(Pipe::new("between", "left", "right", 0.02, 1e-3))
            .spring(wire.clone())
            .lag(Lag::rise_and_fall(0.02, 0.05), ["wire"])
            .phase(
                Phase::until(0.2)
                    .named("p")
                    .hold("left")
                    .flow("left", Signal::function(|t| 1e-7 * (20.0 * t).sin()))
                    .actuate(["wire"], 0.1)
                    .load([node], load),
            )
    };
    // pushed everywhere it moves in all ways
    let free = 2 * 9;
    let pushed = [2, 3, 4, 6, 7, 8, 10, 11, 12].map(|node| scene(node, [0.03, 0.02]));
    let model = learned(pushed.into(), 1e-13, free);
    assert_eq!(model.unknowns(), free, "{model}");
    let scene = scene(4, [0.0, 0.02]);
    let exact = run(&scene, Method::Arkode, 1e-9);
    let own = run(&scene.reduced(model).unwrap(), Method::Arkode, 1e-9);
    let (off, amounts) = (error(&exact, &own), apart(&exact, &own));
    println!("off by {off:.1e}, amounts by {amounts:.1e}");
    // some hundred rtol, as steps differ; of the pipe, whose flow swings fast between the liquids, more
    assert!(off < 5e-7 && amounts < 1e-5, "{off:e} {amounts:e}");
    let [a, b] = [&exact, &own].map(|run| run.last().energy);
    println!("{a:?}\n{b:?}");
    assert!((a.supplied / b.supplied - 1.0).abs() < 1e-5, "{a:?} {b:?}");
    assert!((a.dissipated / b.dissipated - 1.0).abs() < 1e-5, "{a:?} {b:?}");
}

/// Valves and wires under the commands of a program; checkpoints and forks have the amounts.
#[test]
fn valves_are_commanded_in_a_reduced_model() {
    let model = learned(corners(), 0.01, 64);
    let full = finger(1.06e5, 0.0);
    let reduced = full.clone().reduced(model).unwrap();
    let drive = |scene: &Scene| {
        let mut simulation = scene.start(&settings(Method::Arkode, 1e-6)).unwrap();
        let mut way = Vec::new();
        for tick in 1..=25 {
            let t = simulation.time();
            simulation.open("inlet", (15.0 * t).sin().abs()).unwrap();
            simulation.actuate("wire", 0.08 * (20.0 * t).sin().abs()).unwrap();
            simulation.advance_to(f64::from(tick) * 0.01).unwrap();
            let view = simulation.view();
            way.push([view.displacements()[TIP], view.gas_amount("bellows").unwrap()]);
        }
        (simulation, way)
    };
    let ((_, exact), (mut simulation, own)) = (drive(&full), drive(&reduced));
    for (k, within) in [(0, 0.03), (1, 1e-3)] {
        let most = exact.iter().fold(0.0_f64, |most, at| most.max(at[k].abs()));
        let off = exact.iter().zip(&own).map(|(a, b)| (a[k] - b[k]).abs()).fold(0.0, f64::max);
        println!("{k}: off by {:.1e}", off / most);
        assert!(off < within * most, "{k}: {:e}", off / most);
    }
    let kept = simulation.checkpoint();
    let mut fork = simulation.fork().unwrap();
    let go_on = |simulation: &mut pliant::Simulation| {
        simulation.advance_to(0.45).unwrap();
        let view = simulation.view();
        [view.displacements()[TIP], view.gas_amount("bellows").unwrap()]
    };
    let first = go_on(&mut simulation);
    simulation.restore(&kept).unwrap();
    for again in [go_on(&mut simulation), go_on(&mut fork)] {
        for (again, first) in again.iter().zip(first) {
            assert!((again / first - 1.0).abs() < 1e-4, "{again} {first}");
        }
    }
}

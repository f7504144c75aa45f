//! Reduced models against the full ones that they are learned from, and against runs that they have not seen.

use std::ops::ControlFlow;

use pliant::reduce::{Training, error, reduce};
use pliant::{
    Axis, Body, CellSelection, Cells, Error, Growth, Inertia, Law, Material, Mesh, Method,
    Obstacle, Phase, Plane, Prescribed, ReducedModel, Sampling, Scene, Settings, Statics, Strain,
    Trajectory, Viscosity,
};

const RUBBER: Material = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 20.0 };

fn settings(rtol: f64) -> Settings {
    Settings { method: Method::Arkode, rtol, ..Settings::default() }
}

/// A strip of rubber, 0.1 x 0.02 m, clamped on the left.
fn strip(material: Material) -> Body {
    let mesh = Mesh::rectangle([0.1, 0.02], [13, 4], Cells::Rectangles).unwrap();
    let law = material.law(Law::NeoHookean);
    Body::new(mesh, law).thickness(0.01).build().unwrap()
}

/// The strip, pushed at its tip by up to `force` (N) with an angular frequency (rad/s).
fn pushed(force: f64, frequency: f64) -> Scene {
    let at = move |t: f64| force * 0.5 * (1.0 - (frequency * t).cos());
    let phase = Phase::until(0.5).named("pushed").hold("left");
    Scene::new(strip(RUBBER)).phase(phase.load_with([52], move |t| [0.0, at(t)]))
}

fn learned(scenes: Vec<Scene>, rtol: f64, within: f64) -> ReducedModel {
    let settings = settings(rtol);
    let training = Training { scenes, held_out: Vec::new(), settings, within, most_unknowns: 64 };
    let found = reduce(&training, &mut |_| ControlFlow::Continue(())).unwrap();
    assert!(found.is_within, "{found}");
    found.model
}

fn run(scene: &Scene, rtol: f64) -> Trajectory {
    scene.simulate(&settings(rtol), &Sampling::every(0.01)).unwrap()
}

/// Runs that it was not learned from, by frequency and by size, and what they tell of their errors.
#[test]
fn held_out_runs_are_within_what_was_wanted_and_tell_their_errors() {
    // at rest, too: errors are parts of the largest displacement in all runs
    let scenes = vec![pushed(0.04, 9.0), pushed(0.02, 40.0), pushed(0.0, 9.0)];
    let model = learned(scenes, 1e-6, 0.01);
    assert!(model.unknowns() <= 12 && (3..30).contains(&model.cells()), "{model}");
    for (force, frequency) in [(0.03, 12.0), (0.02, 45.0)] {
        let full = pushed(force, frequency);
        let own = run(&full.clone().reduced(model.clone()).unwrap(), 1e-6);
        let exact = error(&run(&full, 1e-6), &own);
        let told = own.report().reduced.as_ref().unwrap().estimated_error;
        assert!(exact < 0.01, "{exact:e}");
        // an estimate, by the ratio in the runs that were learned from
        assert!(told > 0.5 * exact && told < 10.0 * exact, "told {told:e} of {exact:e}");
        let report = own.report();
        let (balance, scale) = (report.energy_error, report.energy_scale);
        // the sample is a potential: rtol, as in full runs
        assert!(balance < 5e-5 * scale, "{:e}", balance / scale);
        let warnings = report.named_warnings();
        assert!(warnings.iter().all(|(name, _)| !name.starts_with("reduced")), "{warnings:?}");
    }
    // three times the force: nothing like it was learned
    let far = run(&pushed(0.12, 15.0).reduced(model).unwrap(), 1e-6);
    let warnings = far.report().named_warnings();
    for name in ["reduced-error", "reduced-range"] {
        assert!(warnings.iter().any(|(other, _)| *other == name), "{warnings:?}");
    }
}

/// Saint Venant and Kirchhoff's law needs no sample of the cells, however the body is loaded: forces are exact along the shapes.
#[test]
fn quadratic_strains_need_no_cells() {
    let mesh = Mesh::rectangle([0.1, 0.02], [21, 5], Cells::Triangles6).unwrap();
    let body = Body::new(mesh, RUBBER).strain(Strain::Green).viscosity(Viscosity::Objective);
    let body = body.thickness(0.01).build().unwrap();
    let scene = |force: f64| {
        let loaded = Phase::until(0.2).named("loaded").hold("left").load("right", [0.0, force]);
        // another start, in a shape that the body has not had at rest
        let let_go = Phase::until(0.4).named("let go").hold("left");
        Scene::new(body.clone()).phase(loaded).phase(let_go)
    };
    let model = learned(vec![scene(0.004)], 1e-6, 0.01);
    assert_eq!(model.cells(), 0, "{model}");
    // the run that it was learned from is known by what it tells, and others are warned of
    let is_other = |run: &Trajectory| {
        let warnings = run.report().named_warnings();
        warnings.iter().any(|(name, _)| *name == "reduced-one-run")
    };
    for (force, is_another) in [(0.004, false), (0.007, true)] {
        let own = run(&scene(force).reduced(model.clone()).unwrap(), 1e-7);
        assert_eq!(is_other(&own), is_another, "{:?}", own.report().reduced);
    }
    let full = scene(0.003);
    let own = run(&full.clone().reduced(model).unwrap(), 1e-6);
    let exact = error(&run(&full, 1e-6), &own);
    assert!(exact < 0.01, "{exact:e}");
    let report = own.report();
    let (balance, scale) = (report.energy_error, report.energy_scale);
    // the energy is that of all cells: rtol, as in full runs
    assert!(balance < 1e-5 * scale, "{:e}", balance / scale);
}

/// All methods integrate the same few equations, and the same powers.
#[test]
fn methods_agree_on_a_reduced_model() {
    let scene = pushed(0.03, 15.0);
    let model = learned(vec![scene.clone()], 1e-6, 0.02);
    let reduced = scene.reduced(model).unwrap();
    let exact = run(&reduced, 1e-10);
    let methods =
        [Method::CvodeBdf, Method::CvodeAdams, Method::Arkode, Method::Rosenbrock, Method::Rk];
    for method in methods {
        let settings = Settings { method, ..settings(1e-7) };
        let own = reduced.simulate(&settings, &Sampling::every(0.01)).unwrap();
        let off = error(&exact, &own);
        assert!(off < 1e-5, "{method}: {off:e}");
    }
    let energies = |motion: &Trajectory| motion.last().energy;
    let settings = Settings { method: Method::CvodeBdf, ..settings(1e-8) };
    let other = reduced.simulate(&settings, &Sampling::every(0.01)).unwrap();
    let (a, b) = (energies(&exact), energies(&other));
    assert!((a.supplied / b.supplied - 1.0).abs() < 1e-5, "{a:?} {b:?}");
    assert!((a.dissipated / b.dissipated - 1.0).abs() < 1e-5, "{a:?} {b:?}");
}

/// A plate that flies and turns: learned from an eighth of a turn, run for three turns.
#[test]
fn a_free_body_turns_by_any_angle() {
    let body = || {
        let mesh = Mesh::rectangle([0.1, 0.02], [13, 4], Cells::Rectangles).unwrap();
        let body = Body::new(mesh, RUBBER).strain(Strain::Green).viscosity(Viscosity::Objective);
        body.thickness(0.01).build().unwrap()
    };
    // bent at first
    let bent = |x: &[f64]| vec![0.0, 2.0 * (x[0] - 0.05) * (x[0] - 0.05)];
    let scene = |end: f64| {
        let scene = Scene::new(body()).initial_displacement(bent).spin([15.0]);
        scene.phase(Phase::until(end).named("flight"))
    };
    let quarter = std::f64::consts::TAU / 8.0 / 15.0;
    let model = learned(vec![scene(quarter)], 1e-6, 0.01);
    let full = scene(24.0 * quarter);
    let own = run(&full.clone().reduced(model).unwrap(), 1e-6);
    let full = run(&full, 1e-6);
    let [exact, turned] = [&full, &own].map(|motion| motion.rotation(motion.last()).unwrap());
    assert!((exact - turned).abs() < 0.02, "{exact} {turned}");
    assert!(error(&full, &own) < 0.01, "{:e}", error(&full, &own));
    let momentum = |sample| own.angular_momentum(sample)[0];
    let [first, last] = [&own.samples()[0], own.last()].map(momentum);
    // the sample of the cells turns with the body
    assert!((last / first - 1.0).abs() < 1e-5, "{first} {last}");
}

/// A plate that falls as it vibrates: its shapes hold the fall with a little of the vibration, which makes it no slow vibration.
/// What follows some shapes alone vibrates no slower than what is free (Rayleigh).
#[test]
fn falling_is_no_vibration() {
    let mesh = Mesh::rectangle([0.1, 0.02], [13, 4], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, RUBBER.law(Law::NeoHookean)).thickness(0.01).build().unwrap();
    let bent = |x: &[f64]| vec![0.0, 2.0 * (x[0] - 0.05) * (x[0] - 0.05)];
    let scene = Scene::new(body).initial_displacement(bent).gravity([0.0, -9.8]);
    let scene = scene.phase(Phase::until(0.1).named("fall").hold_axes("left", [Axis::X]));
    // too few shapes to hold the fall exactly
    let training = Training {
        scenes: vec![scene.clone()],
        held_out: Vec::new(),
        settings: settings(1e-6),
        within: 1e-6,
        most_unknowns: 2,
    };
    let model = reduce(&training, &mut |_| ControlFlow::Continue(())).unwrap().model;
    let slowest = |scene: &Scene| scene.spectrum().unwrap()[0].lowest_frequency.unwrap();
    let own = slowest(&scene.clone().reduced(model).unwrap());
    let exact = slowest(&scene);
    // the slowest one is known to three digits
    assert!(own > 0.999 * exact, "{own} of {exact} rad/s");
}

/// What constraints move, and what the work of that is.
#[test]
fn constraints_move_the_body_and_supply_energy() {
    let scene = |most: f64, frequency: f64| {
        let path = move |t: f64| Prescribed {
            displacement: most * (frequency * t).sin(),
            velocity: most * frequency * (frequency * t).cos(),
            acceleration: -most * frequency * frequency * (frequency * t).sin(),
        };
        let phase = Phase::until(0.3).named("shaken").hold_axes("left", [pliant::Axis::X]);
        let phase = phase.follow("left", pliant::Axis::Y, path);
        let start = move |_: &[f64]| vec![0.0, most * frequency];
        Scene::new(strip(RUBBER)).initial_velocity(start).phase(phase)
    };
    let model = learned(vec![scene(0.004, 30.0), scene(0.002, 50.0)], 1e-6, 0.002);
    let full = scene(0.003, 40.0);
    let own = run(&full.clone().reduced(model).unwrap(), 1e-6);
    let full = run(&full, 1e-6);
    let report = own.report();
    let [exact, supplied] = [&full, &own].map(|motion| motion.last().energy.supplied);
    assert!((supplied / exact - 1.0).abs() < 0.01, "{exact} {supplied}");
    assert!(error(&full, &own) < 0.002, "{:e}", error(&full, &own));
    assert!(report.energy_error < 2e-5 * report.energy_scale);
    assert!(report.constraint_drift < 1e-12, "{}", report.constraint_drift);
}

/// A body that is pressed down, let go, and jumps off the floor: contact, and constraints that change.
#[test]
fn phases_have_shapes_of_their_own() {
    let mesh = Mesh::rectangle([0.1, 0.1], [5, 5], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, RUBBER.law(Law::NeoHookean)).inertia(Inertia::Lumped);
    let body = body.thickness(0.01).build().unwrap();
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(200.0).damping(0.5);
    let scene = Scene::new(body)
        .gravity([0.0, -9.8])
        .obstacle(floor)
        .phase(Phase::until(0.1).named("press").hold("bottom").move_nodes([23], [0.0, -0.1]))
        .phase(Phase::until(0.2).named("hold").hold("bottom").hold([23]))
        .phase(Phase::until(0.4).named("free"));
    let model = learned(vec![scene.clone()], 1e-6, 0.02);
    let full = run(&scene, 1e-6);
    let own = run(&scene.reduced(model).unwrap(), 1e-6);
    assert!(error(&full, &own) < 0.02);
    let top = |motion: &Trajectory| {
        motion.samples().iter().map(|sample| motion.centre_of_mass(sample)[1]).fold(0.0, f64::max)
    };
    assert!((top(&own) - top(&full)).abs() < 0.02 * 0.1, "{} {}", top(&own), top(&full));
}

/// A program that commands forces at every tick sees the motion of the full model; checkpoints and forks go on.
#[test]
fn commands_act_on_a_reduced_model() {
    let model = learned(vec![pushed(0.04, 9.0), pushed(0.02, 40.0)], 1e-6, 0.01);
    let held = Scene::new(strip(RUBBER)).phase(Phase::until(0.5).named("pushed").hold("left"));
    let drive = |scene: &Scene| {
        let mut simulation = scene.start(&settings(1e-6)).unwrap();
        let mut way = Vec::new();
        for tick in 1..=40 {
            let t = simulation.time();
            simulation.load([52], [0.0, 0.03 * (20.0 * t).sin().abs()]).unwrap();
            simulation.advance_to(f64::from(tick) * 0.01).unwrap();
            way.push(simulation.view().displacements()[103]);
        }
        (simulation, way)
    };
    let (_, full) = drive(&held);
    let (mut simulation, own) = drive(&held.clone().reduced(model.clone()).unwrap());
    let most = full.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let off = full.iter().zip(&own).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 0.01 * most, "{:e}", off / most);

    let kept = simulation.checkpoint();
    let mut fork = simulation.fork().unwrap();
    let go_on = |simulation: &mut pliant::Simulation| {
        simulation.advance_to(0.5).unwrap();
        simulation.view().displacements()[103]
    };
    let first = go_on(&mut simulation);
    simulation.restore(&kept).unwrap();
    for again in [go_on(&mut simulation), go_on(&mut fork)] {
        assert!((again - first).abs() < 1e-5 * most, "{again} {first}");
    }

    // what it has not learned is refused, and nothing has changed
    simulation.restore(&kept).unwrap();
    let refused = simulation.hold("right").unwrap_err().to_string();
    assert!(refused.contains("constraints") && refused.contains("unreduced"), "{refused}");
    assert!((go_on(&mut simulation) - first).abs() < 1e-5 * most);
}

/// A strip of rubber whose lower half swells and, in a phase of its own, shrinks, at strains that were not learned.
#[test]
fn cells_that_grow_have_the_forces_of_their_time() {
    let swelling = |most: f64| {
        let mesh = Mesh::rectangle([0.1, 0.02], [13, 5], Cells::Rectangles).unwrap();
        let material = RUBBER.law(Law::NeoHookean);
        let body = Body::new(mesh, material).thickness(0.01).plane(Plane::Stress).build().unwrap();
        let swells = Phase::until(0.3).named("swells").hold("left");
        let still = Phase::until(0.5).named("as it was").hold("left");
        Scene::new(body)
            .growth(Growth::within(CellSelection::inside([0.0, 0.0], [0.1, 0.01])).named("lower"))
            .phase(swells.actuate_with(["lower"], move |t| most * (1.0 - (-20.0 * t).exp())))
            .phase(still)
    };
    let model = learned([0.05, 0.1, 0.15].map(swelling).to_vec(), 1e-6, 0.02);
    assert!(model.cells() > 0 && model.cells() < 48, "{model}");
    for most in [0.07, 0.13] {
        let full = swelling(most);
        let own = run(&full.clone().reduced(model.clone()).unwrap(), 1e-6);
        let exact = error(&run(&full, 1e-6), &own);
        let report = own.report();
        let told = report.reduced.as_ref().unwrap().estimated_error;
        assert!(exact < 0.02, "{exact:e}");
        assert!(told > 0.5 * exact && told < 10.0 * exact, "told {told:e} of {exact:e}");
        // what growth supplies is counted: rtol, as in full runs
        let (balance, scale) = (report.energy_error, report.energy_scale);
        assert!(balance.abs() < 1e-4 * scale, "{balance:e} J of {scale:e} J");
    }
    // where other cells grow, others are sampled
    let mesh = Mesh::rectangle([0.1, 0.02], [13, 5], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, RUBBER.law(Law::NeoHookean)).thickness(0.01);
    let dry = Scene::new(body.plane(Plane::Stress).build().unwrap())
        .phase(Phase::until(0.3).named("swells").hold("left"))
        .phase(Phase::until(0.5).named("as it was").hold("left"));
    let training = Training {
        scenes: vec![swelling(0.1), dry],
        held_out: Vec::new(),
        settings: settings(1e-4),
        within: 0.02,
        most_unknowns: 8,
    };
    let refused = reduce(&training, &mut |_| ControlFlow::Continue(())).unwrap_err().to_string();
    assert!(refused.contains("materials"), "{refused}");
}

#[test]
fn what_cannot_be_reduced_is_told() {
    let scene = pushed(0.04, 9.0);
    let training = |scenes: Vec<Scene>, within| Training {
        scenes,
        held_out: Vec::new(),
        settings: settings(1e-4),
        within,
        most_unknowns: 64,
    };
    let refused = |training: &Training| {
        reduce(training, &mut |_| ControlFlow::Continue(())).unwrap_err().to_string()
    };
    let message = refused(&training(Vec::new(), 0.01));
    assert!(message.contains("one run at least"), "{message}");
    let message = refused(&training(vec![scene.clone()], 0.0));
    assert!(message.contains("error that is wanted"), "{message}");
    let other = Scene::new(strip(Material { young: 2e5, ..RUBBER }))
        .phase(Phase::until(0.5).named("pushed").hold("left"));
    let message = refused(&training(vec![scene.clone(), other.clone()], 0.01));
    assert!(message.contains("materials"), "{message}");
    let still = Scene::new(strip(RUBBER)).phase(Phase::until(0.1).named("p").hold("left"));
    let message = refused(&training(vec![still], 0.01));
    assert!(message.contains("nothing to learn"), "{message}");
    // a tolerance that no size meets: the best one
    let mut hopeless = training(vec![scene.clone()], 1e-12);
    hopeless.most_unknowns = 6;
    let best = reduce(&hopeless, &mut |_| ControlFlow::Continue(())).unwrap();
    assert!(!best.is_within && best.model.unknowns() <= 6 && best.model.error() < 0.2, "{best}");

    let model = best.model;
    let ida = Settings { method: Method::IdaIndexTwo, ..Settings::default() };
    let reduced = scene.clone().reduced(model.clone()).unwrap();
    let message = reduced.simulate(&ida, &Sampling::every(0.1)).unwrap_err().to_string();
    assert!(message.contains("rosenbrock"), "{message}");
    let mesh = Mesh::rectangle([0.1, 0.02], [9, 4], Cells::Rectangles).unwrap();
    let coarse = Body::new(mesh, RUBBER).thickness(0.01).build().unwrap();
    let coarse = Scene::new(coarse).phase(Phase::until(0.5).named("pushed").hold("left"));
    let Err(error) = coarse.reduced(model) else { panic!() };
    assert!(Error::from(error).to_string().contains("another scene or mesh"));
    // equilibria are those of all unknowns
    let (full, of_model) =
        (scene.equilibrium(&Statics::default()), reduced.equilibrium(&Statics::default()));
    assert_eq!(full.unwrap().displacements(), of_model.unwrap().displacements());
}

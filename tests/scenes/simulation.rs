//! Simulations that are driven from outside: against the same scenes run as films, closed forms, and
//! themselves after they went back.

use std::thread;

use pliant::samples::{SQUARE_MATERIAL, ring_jump, spring_ring, square_jump};
use pliant::{
    Body, Cells, ContactEvents, Error, Mesh, Method, Obstacle, Phase, Sampling, Scene, Settings,
    Signal, Simulation, Spring, Strain, Viscosity,
};

use crate::common::{apart, settings};

fn displacements(simulation: &Simulation) -> Vec<f64> {
    simulation.view().displacements().to_vec()
}

/// Step by step, or looked at hundreds of times, a scene moves bit by bit as in a film.
#[test]
fn looking_changes_nothing() {
    let (square, ring) =
        (square_jump(4).unwrap().ended_at(1.15), ring_jump().unwrap().ended_at(0.3));
    for method in Method::ALL {
        let scenes = match method {
            Method::Auto | Method::CvodeBdf | Method::Arkode => vec![&square, &ring],
            _ => vec![&square],
        };
        for scene in scenes {
            let settings = settings(method, 1e-3);
            let every = Sampling::every(0.05);
            let film = scene.simulate(&settings, &every).unwrap();

            let mut stepped = scene.start(&settings).unwrap();
            stepped.record(&every).unwrap();
            while stepped.step().unwrap() {}
            assert_eq!(stepped.time(), scene.end());
            assert_eq!(stepped.report().steps(), film.report().steps(), "{method}");
            let stepped = stepped.into_trajectory();
            assert_eq!(stepped.samples(), film.samples(), "{method}");
            assert_eq!(stepped.report().phases.len(), film.report().phases.len());

            let mut watched = scene.start(&settings).unwrap();
            for k in 1..=400 {
                watched.advance_to(scene.end() * f64::from(k) / 400.0).unwrap();
                if let Some(sample) = film.samples().iter().find(|s| s.time == watched.time()) {
                    assert_eq!(watched.view().displacements(), sample.u, "{method}");
                    assert_eq!(watched.energy(), sample.energy, "{method}");
                }
            }
            assert_eq!(watched.sample().unwrap(), *film.last(), "{method}");
        }
    }
}

/// A clamped beam of rubber in the plane, with a chamber and a spring.
fn beam() -> Scene {
    let mesh = Mesh::rectangle([0.1, 0.02], [11, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green);
    Scene::new(body.build().unwrap())
        .chamber(pliant::Chamber::within("inside", [1, 11, 33, 23]))
        .spring(Spring::between([11], [23]).named("tendon"))
        .gravity([0.0, -9.8])
}

/// What commands bring about is what phases bring about that say the same beforehand.
#[test]
fn commands_are_phases_that_nobody_wrote_down() {
    let clamped = |until: f64| Phase::until(until).hold("left");
    let film = beam()
        .phase(clamped(0.02))
        .phase(clamped(0.05).pressure("inside", 2e3))
        .phase(clamped(0.08).pressure("inside", 2e3).actuate(["tendon"], -0.2))
        .phase(clamped(0.1).actuate(["tendon"], -0.2).load([33], [0.0, 0.05]))
        .phase(Phase::until(0.12));
    let live = beam().phase(clamped(0.12));
    for method in Method::ALL {
        // central differences are of order 2
        let rtol = if method == Method::CentralDifference { 1e-7 } else { 1e-6 };
        let settings = Settings { alpha: 1e3, ..settings(method, rtol) };
        let film = film.simulate(&settings, &Sampling::phase_ends()).unwrap();
        let mut beam = live.start(&settings).unwrap();
        let balance = beam.energy().balance();
        beam.advance_to(0.02).unwrap();
        beam.pressure("inside", 2e3).unwrap();
        beam.advance_to(0.05).unwrap();
        beam.actuate("tendon", -0.2).unwrap();
        beam.advance_to(0.08).unwrap();
        beam.pressure("inside", 0.0).unwrap();
        beam.load([33], [0.0, 0.05]).unwrap();
        beam.advance_to(0.1).unwrap();
        beam.release("left").unwrap();
        beam.actuate("tendon", 0.0).unwrap();
        beam.load([33], [0.0, 0.0]).unwrap();
        beam.advance_to(0.12).unwrap();
        let off = apart(&film.last().u, beam.view().displacements());
        println!("{method}: {off:.1e}");
        assert!(off < 2e-5, "{method}: {off:e}");
        let [live, film] = [beam.energy(), film.last().energy];
        let scale = film.supplied.abs();
        assert!(
            (live.supplied - film.supplied).abs() < 1e-4 * scale,
            "{method}: {live:?} {film:?}"
        );
        assert!((live.balance() - balance).abs() < 1e-4 * scale, "{method}: {live:?}");
    }
}

/// A free square under a force that comes and goes: its momentum is the integral of the force.
#[test]
fn commands_take_effect_exactly_at_the_present_time() {
    let mesh = Mesh::rectangle([0.05, 0.05], [3, 3], Cells::Rectangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let mass = body.mass();
    let scene = Scene::new(body).phase(Phase::until(1.0));
    for method in Method::ALL {
        let mut square = scene.start(&settings(method, 1e-6)).unwrap();
        let mut momentum = 0.0;
        for (k, force) in [0.01, -0.03, 0.0, 0.05, 0.05, -0.02].into_iter().enumerate() {
            square.load("top", [force, 0.0]).unwrap();
            square.advance_to(0.0137 * (k + 1) as f64).unwrap();
            momentum += 3.0 * force * 0.0137;
        }
        let found = mass * square.view().mean_velocity()[0];
        println!("{method}: {found} {momentum}");
        assert!((found / momentum - 1.0).abs() < 1e-11, "{method}: {found} {momentum}");
    }
}

/// Signals run on between commands, and their kinks end steps.
#[test]
fn signals_change_with_time_between_commands() {
    let mesh = Mesh::rectangle([0.05, 0.05], [3, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01);
    let body = body.point_mass("bob", [0.0, 0.1], 0.01).build().unwrap();
    let scene = Scene::new(body)
        .spring(Spring::between([7], "bob").named("arm"))
        .phase(Phase::until(0.2).hold("all").named("pull"));
    let signals = [
        Signal::ramp(0.0, 0.1, 0.05, 0.1),
        Signal::function(|t| ((t - 0.05) / 0.1).clamp(0.0, 1.0) * 0.1).with_breaks([0.05, 0.15]),
    ];
    for method in [Method::Rk, Method::CvodeBdf, Method::Arkode] {
        for signal in &signals {
            let mut simulation = scene.start(&settings(method, 1e-8)).unwrap();
            simulation.actuate("arm", signal.clone()).unwrap();
            simulation.advance_to(0.2).unwrap();
            // the integral of the ramp over the mass
            let expected = (0.5 * 0.1 * 0.1 + 0.05 * 0.1) / 0.01;
            let found = simulation.view().velocity("bob").unwrap()[1];
            println!("{method}: {found} {expected}");
            assert!((found / expected - 1.0).abs() < 5e-7, "{method}: {found} {expected}");
            let length = simulation.view().spring_length("arm").unwrap();
            let bob = simulation.view().position("bob").unwrap();
            assert!((length - (bob[1] - 0.05)).abs() < 1e-12);
        }
    }
}

/// From a checkpoint the motion goes on as it did: to the tolerances within a step, bit by bit from where an
/// integrator began. Commands in force come back with it.
#[test]
fn a_simulation_goes_back_to_a_checkpoint() {
    let scene = beam().phase(Phase::until(0.03).hold("left")).phase(Phase::until(0.1).hold("left"));
    for method in Method::ALL {
        let mut beam = scene.start(&settings(method, 1e-7)).unwrap();
        let start = beam.checkpoint();
        let play = |beam: &mut Simulation| {
            beam.advance_to(0.01).unwrap();
            beam.pressure("inside", 2e3).unwrap();
            beam.advance_to(0.0203).unwrap();
            let kept = beam.checkpoint();
            beam.advance_to(0.04).unwrap();
            let first = displacements(beam);
            beam.pressure("inside", 0.0).unwrap();
            beam.advance_to(0.05).unwrap();
            beam.restore(&kept).unwrap();
            assert_eq!((beam.time(), beam.phase()), (kept.time(), "phase 1"));
            beam.advance_to(0.04).unwrap();
            let off = apart(&first, beam.view().displacements());
            println!("{method}: {off:.1e}");
            assert!(off < 2e-6, "{method}: {off:e}");
            displacements(beam)
        };
        let first = play(&mut beam);
        beam.restore(&start).unwrap();
        assert_eq!(play(&mut beam), first, "{method}");
    }
}

/// The report after a restore is that of the checkpoint, and later that of a run which never went elsewhere: nothing is left of the future that
/// was given up, such as the notice of an explicit method that stability limits there.
#[test]
fn a_report_goes_back_to_a_checkpoint() {
    let scene = beam().phase(Phase::until(0.03).hold("left")).phase(Phase::until(0.1).hold("left"));
    let told = |beam: &Simulation| {
        let report = beam.report();
        let phases: Vec<_> = report
            .phases
            .iter()
            .map(|phase| format!("{} {} {:?}", phase.name, phase.method, phase.counts))
            .collect();
        (phases, report.constraint_drift, report.warnings())
    };
    for method in [Method::Rk, Method::CvodeBdf, Method::Auto] {
        let settings = settings(method, 1e-4);
        let mut beam = scene.start(&settings).unwrap();
        beam.advance_to(0.002).unwrap();
        for (back, away) in [(0.002, 0.02), (0.02, 0.08)] {
            beam.advance_to(back).unwrap();
            let (kept, before) = (beam.checkpoint(), told(&beam));
            beam.advance_to(away).unwrap();
            assert_ne!(told(&beam), before, "{method}");
            beam.restore(&kept).unwrap();
            let after = told(&beam);
            println!("{method}: {after:?}");
            assert_eq!(after, before, "{method}");
        }
    }
}

/// An episode that begins with a checkpoint is the same, bit by bit, whatever the simulation did before, and in
/// a fork: the automatic choice looks at the energy balance at the same steps.
#[test]
fn an_episode_is_the_same_however_often_it_is_played() {
    let scene = spring_ring(Viscosity::Objective).unwrap().phase(Phase::until(1.0));
    let mut ring = scene.start(&settings(Method::Auto, 1e-3)).unwrap();
    ring.advance_to(0.1).unwrap();
    let settled = ring.checkpoint();
    let jump = |ring: &mut Simulation, forces: [f64; 4]| {
        ring.restore(&settled).unwrap();
        let pairs = [["A1", "A5"], ["A2", "A6"], ["A3", "A7"], ["A4", "A8"]];
        for (pair, force) in pairs.into_iter().zip(forces) {
            for spring in pair {
                ring.actuate(spring, Signal::ramp(0.0, -force, 0.1, 0.1)).unwrap();
            }
        }
        ring.advance_by(0.1).unwrap();
        for spring in pairs.concat() {
            ring.actuate(spring, 0.0).unwrap();
        }
        ring.advance_by(0.15).unwrap();
        (displacements(ring), ring.energy())
    };
    let mut fork = ring.fork().unwrap();
    let episodes =
        [[0.9, 0.0, 0.0, 0.0], [0.1, 0.3, 0.2, 0.0], [0.05, 0.1, 0.0, 0.4], [0.2, 0.2, 0.3, 0.1]];
    let first = episodes.map(|forces| jump(&mut ring, forces));
    for (forces, first) in episodes.into_iter().zip(&first).rev() {
        assert_eq!(jump(&mut ring, forces), *first, "{forces:?}");
        assert_eq!(jump(&mut fork, forces), *first, "{forces:?}");
    }
    assert_ne!(first[0], first[1]);
}

/// Forks go their own ways, on other threads, and the one that is not touched goes where the first went.
#[test]
fn forks_are_independent() {
    let mut beam =
        beam().phase(Phase::until(0.05).hold("left")).start(&settings(Method::Auto, 1e-6)).unwrap();
    beam.advance_to(0.01).unwrap();
    let ends: Vec<f64> = thread::scope(|scope| {
        let forks: Vec<_> = [0.0, 1e3, 2e3, 4e3]
            .into_iter()
            .map(|pressure| {
                let mut fork = beam.fork().unwrap();
                scope.spawn(move || {
                    fork.pressure("inside", pressure).unwrap();
                    fork.advance_to(0.05).unwrap();
                    fork.view().chamber_volume("inside").unwrap()
                })
            })
            .collect();
        forks.into_iter().map(|fork| fork.join().unwrap()).collect()
    });
    assert!(ends.windows(2).all(|pair| pair[1] > 1.001 * pair[0]), "{ends:?}");
    beam.advance_to(0.05).unwrap();
    let alone = beam.view().chamber_volume("inside").unwrap();
    assert!((alone / ends[0] - 1.0).abs() < 1e-6, "{alone} {ends:?}");
}

/// Events are found within steps: the fall from 1 m, and a clamped bob that swings through its lowest point.
#[test]
fn an_event_is_met_where_the_closed_form_has_it() {
    let mesh = Mesh::rectangle([0.05, 0.05], [3, 3], Cells::Rectangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let scene = Scene::new(body).gravity([0.0, -9.8]).phase(Phase::until(2.0));
    for method in Method::ALL {
        let mut square = scene.start(&settings(method, 1e-8)).unwrap();
        let fallen =
            |depth: f64| move |view: &pliant::View| view.centre_of_mass()[1] - 0.025 + depth;
        assert!(square.advance_until(2.0, fallen(1.0)).unwrap(), "{method}");
        let exact = (2.0 / 9.8_f64).sqrt();
        println!("{method}: {:.1e}", square.time() - exact);
        assert!((square.time() / exact - 1.0).abs() < 5e-11, "{method}: {}", square.time());
        // an impact law: half of the velocity comes back
        let before = square.view().mean_velocity()[1];
        let energy = square.energy();
        square.change_state(|_, v| v.iter_mut().for_each(|v| *v *= -0.5)).unwrap();
        assert!((square.view().mean_velocity()[1] / (-0.5 * before) - 1.0).abs() < 1e-12);
        let lost = energy.kinetic - square.energy().kinetic;
        assert!((lost / (0.75 * energy.kinetic) - 1.0).abs() < 1e-9);
        assert!((square.energy().balance() - energy.balance()).abs() < 1e-12);
        // up again to a quarter of the height, and down to where it was
        let impact = square.time();
        square.advance_by(0.1).unwrap();
        assert!(square.advance_until(2.0, fallen(1.0)).unwrap());
        let off = (square.time() - impact) / (-before / 9.8) - 1.0;
        println!("{method}: {off:.1e} after the impact");
        assert!(off.abs() < 1e-6, "{method}: {off:e}");
        assert!(!square.advance_until(1.0, fallen(10.0)).unwrap());
        assert_eq!(square.time(), 1.0);
    }
}

/// A controller that is called a thousand times a second holds a beam up against gravity.
#[test]
fn a_controller_brings_a_beam_where_it_should_be() {
    let scene = beam().phase(Phase::until(1.0).hold("left"));
    for method in [Method::Auto, Method::CvodeBdf, Method::Arkode] {
        let mut beam = scene.start(&settings(method, 1e-4)).unwrap();
        let (mut integral, mut ticks) = (0.0, 0);
        beam.control(1e-3, 1.0, |beam| {
            let view = beam.view();
            assert!((view.time() - 1e-3 * f64::from(ticks)).abs() < 1e-12);
            ticks += 1;
            let (height, speed) = (view.position("right")?[1], view.velocity("right")?[1]);
            integral += 1e-3 * (0.015 - height);
            let force = 200.0 * integral + 2.0 * (0.015 - height) - 0.02 * speed;
            beam.load("right", [0.0, force])
        })
        .unwrap();
        let height = beam.view().position("right").unwrap()[1];
        println!("{method}: {height}, {} steps", beam.report().steps());
        assert_eq!(ticks, 1000);
        assert!((height - 0.015).abs() < 2e-4, "{method}: {height}");
    }
}

/// A ring whose springs pull by how far it has turned rolls: it comes as far as its rim has turned.
#[test]
fn a_ring_rolls_by_feedback() {
    let scene = spring_ring(Viscosity::Objective).unwrap().phase(Phase::until(1.5));
    let mut ring = scene.start(&settings(Method::Auto, 1e-4)).unwrap();
    let (mut before, mut turned) = (std::f64::consts::FRAC_PI_2, 0.0);
    ring.control(0.01, 1.5, |ring| {
        for pair in 1..=4 {
            let [near, far] = [pair, pair + 4].map(|spring| [12 * (spring - 1) + 1]);
            let (near, far) = (ring.view().position(near)?, ring.view().position(far)?);
            let direction = (far[1] - near[1]).atan2(far[0] - near[0]);
            if pair == 1 {
                // clockwise
                turned += (before - direction).sin();
                before = direction;
            }
            for spring in [pair, pair + 4] {
                ring.actuate(&format!("A{spring}"), 0.2 * (2.0 * direction).sin().min(0.0))?;
            }
        }
        Ok(())
    })
    .unwrap();
    let distance = ring.view().centre_of_mass()[0];
    println!("{distance} m, turned by {turned}");
    assert!(distance > 0.2, "{distance}");
    // it slips on a floor with tangential damping, and its rim is squashed
    assert!((distance / (0.05 * turned) - 1.0).abs() < 0.1, "{distance} {turned}");
}

/// Contact comes and goes by command; what is stored in it comes from outside.
#[test]
fn obstacles_act_when_told_to() {
    let mesh = Mesh::rectangle([0.05, 0.05], [3, 3], Cells::Rectangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(500.0).named("floor");
    let scene = Scene::new(body)
        .gravity([0.0, -9.8])
        .obstacle(floor)
        .phase(Phase::until(1.0).named("fall"));
    for contact_events in [ContactEvents::StepOver, ContactEvents::Locate] {
        let settings = Settings { contact_events, ..settings(Method::Arkode, 1e-6) };
        let mut square = scene.start(&settings).unwrap();
        square.contact("floor", false).unwrap();
        square.advance_to(0.03).unwrap();
        let depth = 0.5 * 9.8 * 0.03_f64.powi(2);
        let before = square.energy();
        assert!(
            before.contact == 0.0
                && (square.view().position("bottom").unwrap()[1] + depth).abs() < 1e-6
        );
        square.contact("floor", true).unwrap();
        let after = square.energy();
        assert!((after.contact / (3.0 * 250.0 * depth * depth) - 1.0).abs() < 1e-3, "{after:?}");
        assert!((after.balance() - before.balance()).abs() < 1e-12, "{before:?} {after:?}");
        square.advance_to(0.2).unwrap();
        assert!(square.view().centre_of_mass()[1] > 0.02);
    }
}

#[test]
fn bad_commands_are_named_and_change_nothing() {
    let scene = beam().phase(Phase::until(0.1).hold("left"));
    let mut beam = scene.start(&settings(Method::Auto, 1e-5)).unwrap();
    beam.advance_to(0.011).unwrap();
    let before = beam.sample().unwrap();
    let mut other = scene.start(&settings(Method::Auto, 1e-5)).unwrap();
    let foreign = other.checkpoint();
    type Attempt<'a> = &'a mut dyn FnMut(&mut Simulation) -> Result<(), Error>;
    let attempts: [(Attempt, &[&str]); 14] = [
        (&mut |beam| beam.pressure("outside", 1.0), &["chamber", "\"outside\"", "inside"]),
        (&mut |beam| beam.pressure("inside", f64::NAN), &["pressure", "NaN"]),
        (&mut |beam| beam.actuate("string", 1.0), &["actuation", "\"string\"", "tendon"]),
        (
            &mut |beam| beam.actuate("tendon", Signal::table([0.2, 0.1], [0.0, 1.0])),
            &["times", "0.1"],
        ),
        (&mut |beam| beam.load("nowhere", [0.0, 1.0]), &["\"nowhere\"", "right"]),
        (&mut |beam| beam.load("right", [1.0]), &["load", "2 component"]),
        (&mut |beam| beam.hold([400]), &["400"]),
        (&mut |beam| beam.release("right"), &["release", "right", "none"]),
        (&mut |beam| beam.move_nodes("right", [1.0]), &["velocity"]),
        (&mut |beam| beam.contact("floor", true), &["obstacle", "floor"]),
        (&mut |beam| beam.advance_to(0.005).map(drop), &["0.005", "present", "0.011"]),
        (&mut |beam| beam.advance_to(f64::NAN).map(drop), &["NaN"]),
        (&mut |beam| beam.control(0.0, 0.05, |_| Ok(())).map(drop), &["control period", "above 0"]),
        (&mut |beam| beam.restore(&foreign), &["checkpoint", "another"]),
    ];
    for (attempt, words) in attempts {
        let message = attempt(&mut beam).unwrap_err().to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
        assert_eq!(beam.sample().unwrap(), before, "{message}");
    }
    assert!(beam.change_state(|u, _| u[0] = f64::INFINITY).is_err());
    assert_eq!(beam.sample().unwrap(), before);
    beam.advance_to(0.02).unwrap();
    other.advance_to(0.02).unwrap();
    assert!(apart(&displacements(&beam), &displacements(&other)) < 1e-4);
}

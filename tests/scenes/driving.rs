//! Obstacles that commands move, events with actions, sensors, and functions that panic.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use pliant::samples::SQUARE_MATERIAL;
use pliant::simulate::Direction;
use pliant::{
    Body, Cells, Error, Mesh, Method, Obstacle, Phase, Sampling, Scene, Settings, Signal,
    Simulation, Spring, Strain,
};

use crate::common::settings;

fn square() -> Body {
    let mesh = Mesh::rectangle([0.1, 0.1], [4, 4], Cells::Rectangles).unwrap();
    Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap()
}

/// A plate with its surface at height `y` (m).
fn plate(y: f64) -> Obstacle {
    Obstacle::half_plane([0.0, y], [0.0, 1.0]).named("plate").stiffness(100.0).damping(0.5)
}

/// A plate at rest that a command sets in motion hits as one that has always moved; stopped, it stays where it
/// is, also in the next phase.
#[test]
fn an_obstacle_moves_by_command() {
    let moving =
        Scene::new(square()).obstacle(plate(-0.045).velocity([0.0, 0.5])).phase(Phase::until(0.12));
    let resting = Scene::new(square())
        .obstacle(plate(-0.02))
        .phase(Phase::until(0.15))
        .phase(Phase::until(0.2));
    for method in Method::ALL {
        let settings = settings(method, 1e-7);
        let film = moving.simulate(&settings, &Sampling::phase_ends()).unwrap();
        let mut live = resting.start(&settings).unwrap();
        live.record(&Sampling::every(0.01)).unwrap();
        live.advance_to(0.05).unwrap();
        live.move_obstacle("plate", [0.0, 0.5]).unwrap();
        live.advance_to(0.12).unwrap();
        let apart = live.view().displacements().iter().zip(&film.last().u);
        let apart = apart.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        println!("{method}: {apart:.1e} m apart");
        assert!(apart < 5e-8, "{method}: {apart:e}"); // of 12 mm

        let pushed = live.view().contact_force("plate").unwrap();
        assert!(pushed[1] > 0.1, "{pushed:?}");
        live.move_obstacle("plate", [0.0, 0.0]).unwrap();
        let stopped = live.sample().unwrap();
        let trajectory = live.trajectory();
        let forces = trajectory.contact_forces(&stopped).unwrap();
        let sum: f64 = forces.iter().skip(1).step_by(2).sum();
        let now = live.view().contact_force("plate").unwrap();
        assert!((sum - now[1]).abs() < 1e-12 * sum.abs());
        // the spring's part is as it was: the plate has not jumped
        let balance = stopped.energy.balance();
        assert!((balance - film.last().energy.balance()).abs() < 1e-7, "{method}");
        live.advance_to(0.2).unwrap();
        assert_eq!(live.phase_number(), 1);
        assert!((live.energy().balance() - balance).abs() < 1e-6, "{method}");
        // what is left of the motion goes up from a plate at 15 mm
        let low = live.view().body().mesh().positions().chunks(2);
        let low = low.zip(live.view().displacements().chunks(2)).map(|(x, u)| x[1] + u[1]);
        assert!(low.fold(f64::MAX, f64::min) > 0.014, "{method}");
    }
}

/// A fall from 1 m with half of the velocity back after each impact: times and heights of the closed form.
#[test]
fn an_action_gives_the_velocity_back() {
    let scene = Scene::new(square()).gravity([0.0, -9.8]).phase(Phase::until(2.0));
    let fall = (2.0 / 9.8_f64).sqrt();
    for method in Method::ALL {
        let mut square = scene.start(&settings(method, 1e-8)).unwrap();
        let floor = square.view().centre_of_mass()[1] - 1.0;
        let impacts = Arc::new(AtomicUsize::new(0));
        let count = impacts.clone();
        square.when(
            move |view| view.centre_of_mass()[1] - floor,
            Direction::Falling,
            move |square| {
                let impact = count.fetch_add(1, Ordering::Relaxed);
                // each flight is half as long as the one before
                let exact =
                    (0..impact).fold(fall, |t, k| t + 2.0 * fall * 0.5_f64.powi(k as i32 + 1));
                println!("{method}: impact {impact} {:.1e} s off", square.time() - exact);
                assert!((square.time() - exact).abs() < 5e-7, "{} {exact}", square.time());
                square.change_state(|_, v| v.iter_mut().for_each(|v| *v *= -0.5))?;
                Ok(ControlFlow::Continue(()))
            },
        );
        // in the middle of the third flight
        let apex = fall + 2.0 * fall * (0.5 + 0.25 / 2.0);
        assert!(square.advance_to(apex).unwrap());
        assert_eq!(impacts.load(Ordering::Relaxed), 2);
        let height = square.view().centre_of_mass()[1] - floor;
        println!("{method}: {:.1e}", height - 1.0 / 16.0);
        assert!((height - 1.0 / 16.0).abs() < 5e-7, "{method}: {height}");
        // another one stops it at the next apex
        square.advance_by(0.01).unwrap();
        square.when(
            |view| view.mean_velocity()[1],
            Direction::Falling,
            |_| Ok(ControlFlow::Break(())),
        );
        assert!(!square.advance_to(2.0).unwrap());
        assert_eq!(impacts.load(Ordering::Relaxed), 3);
        let off = square.time() - apex - 0.375 * fall;
        println!("{method}: apex {off:.1e} s off");
        assert!(off.abs() < 5e-7, "{method}: {off:e}");
    }
}

/// A clamped strip with a chamber and a tendon above a plate.
fn strip() -> Scene {
    let mesh = Mesh::rectangle([0.1, 0.02], [11, 3], Cells::Rectangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    Scene::new(body)
        .chamber(pliant::Chamber::within("inside", [1, 11, 33, 23]))
        .spring(Spring::between([11], [23]).named("tendon").stiffness(3.0))
        .obstacle(plate(-0.001))
        .gravity([0.0, -9.8])
        .phase(Phase::until(0.1).hold("left"))
}

/// Sensors read what samples say otherwise, with commands in force, and stand in tables.
#[test]
fn sensors_read_what_the_samples_say() {
    let sampling = Sampling::every(0.01)
        .sensor("tip", "m", |view, _| view.position([11]).map_or(f64::NAN, |x| x[1]))
        .sensor("floor", "N", |view, _| view.contact_force("plate").map_or(f64::NAN, |f| f[1]))
        .sensor("pressure", "Pa", |view, _| view.pressure("inside").unwrap_or(f64::NAN))
        .sensor("pull", "N", |view, _| view.spring_pull("tendon").unwrap_or(f64::NAN))
        .sensor("kinetic energy", "J", |_, sample| sample.energy.kinetic);
    let mut strip = strip().start(&settings(Method::Auto, 1e-5)).unwrap();
    strip.record(&sampling).unwrap();
    strip.advance_to(0.03).unwrap();
    strip.pressure("inside", 500.0).unwrap();
    strip.actuate("tendon", -0.1).unwrap();
    strip.advance_to(0.05).unwrap();
    strip.contact("plate", false).unwrap();
    strip.pressure("inside", 700.0).unwrap();
    strip.advance_to(0.1).unwrap();
    let trajectory = strip.into_trajectory();
    assert_eq!(trajectory.sensors()[1].unit, "N");
    assert_eq!(trajectory.samples().len(), 11);
    for sample in trajectory.samples() {
        let [tip, floor, pressure, pull, kinetic] = sample.sensors[..] else { panic!() };
        assert_eq!(tip, sample.u[21]);
        assert_eq!(kinetic, sample.energy.kinetic);
        let forces = trajectory.contact_forces(sample).unwrap();
        let sum: f64 = forces.iter().skip(1).step_by(2).sum();
        assert!((floor - sum).abs() <= 1e-12 * sum.abs());
        let (from, to) = (0.03 + 1e-9, 0.05 + 1e-9);
        let expected = match sample.time {
            t if t < from => 0.0,
            t if t < to => 500.0,
            _ => 700.0,
        };
        assert_eq!(pressure, expected, "at {} s", sample.time);
        assert_eq!(floor != 0.0, (0.005..to).contains(&sample.time) && sum != 0.0);
        let ends = [[0.1, 0.0], [0.0, 0.02]];
        let d = [0, 1].map(|i| ends[0][i] + sample.u[20 + i] - ends[1][i] - sample.u[44 + i]);
        let stretch = d[0].hypot(d[1]) - 0.1_f64.hypot(0.02);
        let actuation = if sample.time < from { 0.0 } else { -0.1 };
        assert!((pull - 3.0 * stretch + actuation).abs() < 1e-12, "{pull} {stretch}");
    }
    assert!(trajectory.samples().iter().any(|sample| sample.sensors[1] > 0.0), "it has touched");
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("motion.csv");
    pliant::output::write_csv(&trajectory, &path, None).unwrap();
    let table = std::fs::read_to_string(path).unwrap();
    let header = table.lines().next().unwrap();
    assert!(header.contains(",tip,floor,pressure,pull,kinetic energy,dissipated,"), "{header}");
    let twice = Sampling::phase_ends().sensor("a", "m", |_, _| 0.0).sensor("a", "m", |_, _| 0.0);
    let message = self::strip().simulate(&Settings::default(), &twice).unwrap_err().to_string();
    assert!(message.contains("\"a\"") && message.contains("sensor"), "{message}");
}

/// A function that panics leaves an error with its words, and a simulation that goes on.
#[test]
fn a_panic_becomes_an_error() {
    type Attempt<'a> = &'a dyn Fn(&mut Simulation) -> Result<(), Error>;
    let stays: [Attempt; 3] = [
        &|strip| strip.change_state(|_, _| panic!("sabotage")),
        &|strip| strip.control(0.01, 0.05, |_| panic!("sabotage")).map(drop),
        &|strip| strip.advance_until(0.05, |_| panic!("sabotage")).map(drop),
    ];
    let breaks: [Attempt; 4] = [
        &|strip| {
            strip.pressure(
                "inside",
                Signal::function(|t| if t > 0.02 { panic!("sabotage") } else { 0.0 }),
            )?;
            strip.advance_to(0.05).map(drop)
        },
        &|strip| {
            strip.load_with("right", |t| if t > 0.02 { panic!("sabotage") } else { [0.0, 0.0] })?;
            strip.advance_to(0.05).map(drop)
        },
        &|strip| {
            strip.record(&Sampling::at([0.02]).sensor("bad", "1", |_, _| panic!("sabotage")))?;
            strip.advance_to(0.05).map(drop)
        },
        &|strip| {
            let event = |view: &pliant::View| view.time() - 0.02;
            strip.when(event, Direction::Rising, |_| panic!("sabotage"));
            strip.advance_to(0.05).map(drop)
        },
    ];
    for method in [Method::Auto, Method::CvodeBdf, Method::Arkode, Method::Ida, Method::Rk] {
        let settings = settings(method, 1e-6);
        let mut calm = strip().start(&settings).unwrap();
        calm.advance_to(0.05).unwrap();
        for attempt in stays {
            let mut strip = strip().start(&settings).unwrap();
            strip.advance_to(0.01).unwrap();
            let before = strip.sample().unwrap();
            let message = attempt(&mut strip).unwrap_err().to_string();
            assert!(message.contains("panicked: sabotage"), "{message}");
            assert_eq!(strip.sample().unwrap(), before);
        }
        for attempt in breaks {
            let mut strip = strip().start(&settings).unwrap();
            strip.advance_to(0.01).unwrap();
            let message = attempt(&mut strip).unwrap_err().to_string();
            assert!(message.contains("panicked: sabotage"), "{message}");
            let time = strip.time();
            assert!((0.01..0.03).contains(&time), "{time}");
            strip.pressure("inside", 0.0).unwrap();
            strip.load("right", [0.0, 0.0]).unwrap();
            strip.record(&Sampling::phase_ends()).unwrap();
            strip.advance_to(0.05).unwrap();
            let ends = strip.view().displacements().iter().zip(calm.view().displacements());
            let apart = ends.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            println!("{method}: {apart:.1e} m apart after a panic at {time} s");
            assert!(apart < 1e-5, "{method}: {apart:e}");
        }
    }
}

/// The nearest known name is offered.
#[test]
fn names_with_typing_errors_are_understood() {
    let mut strip = strip().start(&Settings::default()).unwrap();
    let messages = [
        strip.pressure("insdie", 1.0).unwrap_err(),
        strip.actuate("tenton", 1.0).unwrap_err(),
        strip.contact("plat", true).unwrap_err(),
        strip.move_obstacle("Plate", [0.0, 0.0]).unwrap_err(),
        strip.load("rihgt", [0.0, 0.0]).unwrap_err(),
    ];
    for (message, word) in messages.into_iter().zip(["inside", "tendon", "plate", "plate", "right"])
    {
        let message = message.to_string();
        assert!(message.contains(&format!("did you mean \"{word}\"?")), "{message}");
    }
    let message = strip.move_obstacle("plate", [0.0]).unwrap_err().to_string();
    assert!(message.contains("velocity") && message.contains("2 component"), "{message}");
}

/// After a panic a fork is held where the simulation is, and both have energies.
#[test]
fn a_fork_after_a_panic_keeps_what_is_held() {
    for method in [Method::Auto, Method::CvodeBdf, Method::Arkode, Method::Rk] {
        let mut strip = strip().start(&settings(method, 1e-6)).unwrap();
        strip.advance_to(0.01).unwrap();
        strip
            .load_with("right", |t| if t > 0.02 { panic!("sabotage") } else { [0.0, 0.0] })
            .unwrap();
        strip.advance_to(0.05).unwrap_err();
        let mut fork = strip.fork().unwrap();
        let energies = [strip.energy(), fork.energy()];
        assert_eq!(energies[0], energies[1], "{method}");
        assert!(energies[0].gravity != 0.0, "{method}: {energies:?}");
        fork.load("right", [0.0, 0.0]).unwrap();
        fork.advance_to(0.05).unwrap();
        let clamped = fork.view().position("left").unwrap();
        let natural = strip.view().position("left").unwrap();
        let moved = (clamped[0] - natural[0]).hypot(clamped[1] - natural[1]);
        // free, it would fall by some 4 mm
        assert!(moved < 1e-9, "{method}: {moved:e} m");
    }
}

/// At the end of a scene commands have nothing to act on, and say so.
#[test]
fn commands_after_the_end_are_refused() {
    type Command<'a> = &'a dyn Fn(&mut Simulation) -> Result<(), Error>;
    let commands: [Command; 10] = [
        &|strip| strip.pressure("inside", 1.0),
        &|strip| strip.actuate("tendon", 1.0),
        &|strip| strip.load("right", [0.0, 1.0]),
        &|strip| strip.load_with("right", |_| [0.0, 1.0]),
        &|strip| strip.hold("right"),
        &|strip| strip.move_nodes("right", [0.0, 1.0]),
        &|strip| strip.release("left"),
        &|strip| strip.contact("plate", false),
        &|strip| strip.move_obstacle("plate", [0.0, 1.0]),
        &|strip| strip.change_state(|_, v| v.fill(0.0)),
    ];
    let mut strip = strip().start(&settings(Method::Arkode, 1e-4)).unwrap();
    strip.pressure("inside", 0.0).unwrap();
    strip.load("right", [0.0, 0.0]).unwrap();
    let start = strip.checkpoint();
    strip.advance_to(0.1).unwrap();
    let last = strip.sample().unwrap();
    for command in commands {
        let message = command(&mut strip).unwrap_err().to_string();
        assert!(message.contains("0.1 s") && message.contains("has ended"), "{message}");
        assert_eq!(strip.sample().unwrap(), last);
    }
    strip.restore(&start).unwrap();
    commands.into_iter().for_each(|command| command(&mut strip).unwrap());
}

/// What is printed of a simulation, of a checkpoint and of a view is where they are, in one line.
#[test]
fn debug_tells_where_it_is() {
    let mut strip = strip().start(&settings(Method::Arkode, 1e-4)).unwrap();
    strip.advance_to(0.025).unwrap();
    let checkpoint = strip.checkpoint();
    for told in [format!("{strip:?}"), format!("{checkpoint:?}"), format!("{:?}", strip.view())] {
        println!("{told}");
        assert!(told.contains("time: 0.025") && told.contains("phase: \"phase 1\""), "{told}");
        assert!(told.len() < 100 && !told.contains('\n'), "{told}");
    }
}

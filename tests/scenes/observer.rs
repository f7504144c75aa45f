//! Watching a run step by step, and stopping it.

use std::ops::ControlFlow;
use std::thread::sleep;
use std::time::Duration;

use pliant::samples::{ring_jump, square_jump};
use pliant::simulate::Progress;
use pliant::{Error, Method, Sampling, Scene, Settings, Trajectory};

fn settings(method: Method) -> Settings {
    Settings { method, rtol: 1e-5, ..Settings::default() }
}

/// Runs `scene` until `stop` says so.
fn run_until(
    scene: &Scene,
    settings: &Settings,
    stop: impl Fn(&Progress) -> bool,
) -> Result<Trajectory, Error> {
    scene.simulate_with(settings, &Sampling::every(0.1), |progress| match stop(progress) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    })
}

/// Steps are told one by one, and add up to the time; watching changes nothing.
#[test]
fn every_step_is_told() {
    let scene = square_jump(4).unwrap().ended_at(1.15);
    for method in Method::ALL {
        let settings = settings(method);
        let (mut time, mut steps, mut phase, mut highest) = (0.0, 0, 0, 0);
        let watched = scene.simulate_with(&settings, &Sampling::every(0.1), |progress| {
            assert!(progress.time >= time && progress.phase >= phase, "{method}: {progress:?}");
            // the sizes are differences of the times
            assert_eq!(progress.step, progress.time - time, "{method}: {progress:?}");
            assert_eq!(progress.steps, steps + 1);
            assert_eq!(progress.name, scene.phases()[progress.phase].name());
            assert!(progress.time <= scene.phases()[progress.phase].end());
            (time, steps, phase) = (progress.time, progress.steps, progress.phase);
            highest = highest.max(progress.order);
            ControlFlow::Continue(())
        });
        let watched = watched.unwrap();
        assert_eq!((time, phase), (scene.end(), scene.phases().len() - 1));
        assert_eq!(steps, watched.report().steps());
        // at this tolerance all that can climb above order 2 (CVODE's Adams up to 12), unless `auto`
        // bounds the order
        let least = if matches!(method, Method::Auto | Method::CentralDifference) { 2 } else { 3 };
        assert!((least..=12).contains(&highest), "{method}: order {highest}");
        let alone = scene.simulate(&settings, &Sampling::every(0.1)).unwrap();
        assert_eq!(watched.samples(), alone.samples(), "{method}");
    }
}

/// A run that is stopped keeps its samples and the state of the last step: the one that the whole
/// run goes through.
#[test]
fn a_stopped_run_keeps_its_motion() {
    let scene = square_jump(4).unwrap().ended_at(1.0);
    for method in Method::ALL {
        let stopped = run_until(&scene, &settings(method), |progress| progress.time > 0.62);
        let Err(Error::Integration(end)) = stopped else { panic!("{method}: not stopped") };
        assert!(end.is_interruption());
        assert_eq!(end.phase, "hold");
        let message = end.to_string();
        assert!(message.contains("hold") && message.ends_with("interrupted"), "{message}");

        let trajectory = &end.trajectory;
        assert_eq!(trajectory.last().time, end.time);
        assert!((0.62..1.0).contains(&end.time), "{method}: {}", end.time);
        let report = trajectory.report();
        assert_eq!(report.phases.len(), 2);
        assert_eq!(report.phases[1].end, end.time);
        assert!(report.wall_seconds >= report.phases.iter().map(|p| p.wall_seconds).sum());

        let whole = scene.simulate(&settings(method), &Sampling::at([end.time])).unwrap();
        let same = whole.samples().iter().find(|sample| sample.time == end.time).unwrap();
        // dense output at the end of a step is its state but for the round-off of an interpolation
        for (a, b) in same.u.iter().zip(&trajectory.last().u) {
            assert!((a - b).abs() < 1e-13, "{method}: {a} {b}");
        }
        assert!((same.energy.balance() - trajectory.last().energy.balance()).abs() < 1e-12);
    }
}

/// Who stops at the last step has the whole motion.
#[test]
fn the_last_step_leaves_nothing_to_stop() {
    let scene = square_jump(4).unwrap();
    let whole = run_until(&scene, &settings(Method::CvodeBdf), |progress| progress.time >= 1.5);
    assert_eq!(whole.unwrap().last().time, scene.end());
    // at the end of another phase there is
    let part = run_until(&scene, &settings(Method::CvodeBdf), |progress| progress.time >= 0.5);
    let Err(Error::Integration(end)) = part else { panic!("not stopped") };
    assert_eq!((end.phase.as_str(), end.time), ("push", 0.5));
}

/// What gave up was not interrupted, and also keeps the state of its last step.
#[test]
fn a_failure_is_no_interruption() {
    let settings = Settings { max_steps: 40, ..settings(Method::CvodeBdf) };
    let failed = square_jump(4).unwrap().simulate(&settings, &Sampling::phase_ends());
    let Err(Error::Integration(end)) = failed else { panic!("no failure") };
    assert!(!end.is_interruption());
    assert!(end.time > 0.0 && end.trajectory.last().time == end.time);
    assert_eq!(end.trajectory.report().steps(), 40);
}

/// A run ends at its limit of wall-clock time, here by an observer that takes 20 ms for each step, and keeps what it has. Time
/// between the calls of a simulation does not count.
#[test]
fn a_run_ends_at_its_limit_of_time() {
    let scene = square_jump(4).unwrap();
    let limited = Settings { max_time: Some(0.1), ..settings(Method::CvodeBdf) };
    let out = run_until(&scene, &limited, |_| {
        sleep(Duration::from_millis(20));
        false
    });
    let Err(Error::Integration(end)) = out else { panic!("no failure") };
    assert!(!end.is_interruption());
    assert!((1..=5).contains(&end.trajectory.report().steps()), "{:?}", end.trajectory.report());
    assert!(end.time > 0.0 && end.trajectory.last().time == end.time && end.step > 0.0);
    let message = end.to_string();
    for part in ["phase \"push\"", "the 0.1 s", "max_time", "(cvode-bdf", "raise"] {
        assert!(message.contains(part), "{message}");
    }
    // far more than all steps take, and less than the pause
    let limited = Settings { max_time: Some(30.0), ..limited };
    let whole = scene.simulate(&limited, &Sampling::phase_ends()).unwrap();
    let taken = whole.report().wall_seconds;
    let limited = Settings { max_time: Some(10.0 * taken + 0.5), ..limited };
    let mut simulation = scene.start(&limited).unwrap();
    sleep(Duration::from_secs_f64(10.0 * taken + 0.6));
    simulation.advance_to(scene.end()).unwrap();
    let error = Settings { max_time: Some(0.0), ..limited }.validate().unwrap_err().to_string();
    assert!(error.contains("max_time = 0"), "{error}");
}

/// Tangents are evaluated where forces are not linear: by IDA for each factorization, by CVODE
/// for as few of them as do.
#[test]
fn jacobian_evaluations_are_counted() {
    let counts = |scene: &Scene, method| -> Vec<(usize, usize)> {
        let trajectory = scene.simulate(&settings(method), &Sampling::phase_ends()).unwrap();
        let phases = trajectory.report().phases.iter();
        phases.map(|p| (p.counts.jacobian_evaluations, p.counts.factorizations)).collect()
    };
    let ring = ring_jump().unwrap().ended_at(0.3);
    assert!(counts(&ring, Method::Ida).iter().all(|&(evaluated, made)| evaluated == made));
    assert!(counts(&ring, Method::CvodeBdf).iter().all(|&(few, many)| 0 < few && few < many));
    // a square that is pressed is linear; its contacts in free motion are not
    let square = counts(&square_jump(4).unwrap(), Method::CvodeBdf);
    assert_eq!((square[0].0, square[1].0), (0, 0));
    assert!(square[2].0 > 0);
    let explicit = counts(&square_jump(4).unwrap(), Method::Rk);
    assert!(explicit.iter().all(|&counts| counts == (0, 0)));
}

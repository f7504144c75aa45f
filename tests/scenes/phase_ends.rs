//! Phases that end as a sensor passes a level.

use pliant::simulate::{Component, Reading};
use pliant::{Body, Cells, Material, Mesh, Method, Phase, Sampling, Scene, Settings};

const GRAVITY: f64 = 9.8;
const DROP: f64 = 0.45;

/// A block falls from rest until its middle is lower by [`DROP`], unless it is `until` before, and is caught.
fn falling(until: f64) -> Scene {
    let mesh = Mesh::rectangle([0.1, 0.06], [3, 3], Cells::Triangles).unwrap();
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 40.0 };
    let body = Body::new(mesh, rubber).thickness(0.01).build().unwrap();
    let fall = Phase::until(until).named("fall").ends_below("height", 0.03 - DROP);
    Scene::new(body).gravity([0.0, -GRAVITY]).phase(fall).phase(Phase::until(0.6).hold("all"))
}

fn sampling() -> Sampling {
    let height = Reading::centre_of_mass().component(Component::Y);
    Sampling::every(0.05).read("height", height)
}

fn expected() -> f64 {
    (2.0 * DROP / GRAVITY).sqrt()
}

/// By every kind of method the fall lasts as long as Galilei says; what follows begins there, and stays there.
#[test]
fn a_fall_to_a_height() {
    for method in [
        Method::CvodeBdf,
        Method::Arkode,
        Method::Rosenbrock,
        Method::Rk,
        Method::Ida,
        Method::CentralDifference,
        Method::Auto,
    ] {
        let settings = Settings { method, rtol: 1e-7, ..Settings::default() };
        let motion = falling(0.5).simulate(&settings, &sampling()).unwrap();
        let fall = &motion.report().phases[0];
        let late = (fall.end - expected()).abs();
        assert!(late < 1e-9, "{method}: {late:e}");
        assert_eq!(fall.ended_by.as_deref(), Some("height"), "{method}");
        assert_eq!(motion.report().phases[1].ended_by, None);
        // the end of the phase is a sample, after those of the fall and before those of the rest
        let times: Vec<f64> = motion.samples().iter().map(|sample| sample.time).collect();
        let number = times.iter().position(|t| *t == fall.end).unwrap();
        let before = motion.samples()[..=number].iter().all(|sample| sample.phase == 0);
        let after = motion.samples()[number + 1..].iter().all(|sample| sample.phase == 1);
        assert!(before && after && times.is_sorted(), "{method}: {times:?}");
        assert_eq!((number, times.len()), (7, 14), "{method}: {times:?}");
        for sample in &motion.samples()[number..] {
            let apart = (sample.sensors[0] - (0.03 - DROP)).abs();
            let tolerance = if sample.phase == 0 { 1e-12 } else { 1e-10 };
            assert!(apart < tolerance, "{method}: {apart:e} at {}", sample.time);
        }
    }
}

/// A height that is not reached ends nothing; nor does a level that is passed the other way, or that the sensor begins beyond.
#[test]
fn until_at_the_latest() {
    let told = falling(0.25).summary().unwrap();
    let words = told[0].ends.as_deref();
    assert_eq!(words.unwrap(), format!("ends as \"height\" falls below {}", 0.03 - DROP));
    assert_eq!((told[0].end, told[1].ends.as_deref()), (0.25, None));
    let early = falling(0.25).simulate(&Settings::default(), &sampling()).unwrap();
    let fall = &early.report().phases[0];
    assert_eq!((fall.end, fall.ended_by.as_deref()), (0.25, None));
    let body = || {
        let mesh = Mesh::rectangle([0.1, 0.06], [3, 3], Cells::Triangles).unwrap();
        Body::new(mesh, Material::rigid(1000.0)).thickness(0.01).build().unwrap()
    };
    // thrown upwards at 1 m/s: at 0.03 m again after 0.204 s
    for (phase, end) in [
        (Phase::until(0.5).ends_above("height", -0.2), 0.5),
        (Phase::until(0.5).ends_below("height", 0.05), {
            // on the way down: 0.02 m above the start
            (1.0 + (1.0 - 2.0 * GRAVITY * 0.02_f64).sqrt()) / GRAVITY
        }),
        (Phase::until(0.5).ends_above("height", 0.05), {
            (1.0 - (1.0 - 2.0 * GRAVITY * 0.02_f64).sqrt()) / GRAVITY
        }),
    ] {
        let scene = Scene::new(body())
            .gravity([0.0, -GRAVITY])
            .initial_velocity(|_| vec![0.0, 1.0])
            .phase(phase)
            .phase(Phase::until(0.6));
        let settings = Settings { rtol: 1e-8, ..Settings::default() };
        let motion = scene.simulate(&settings, &sampling()).unwrap();
        let late = (motion.report().phases[0].end - end).abs();
        assert!(late < 2e-9, "{late:e}");
    }
}

/// A simulation that is stopped in the middle of the fall, or exactly at its end, and goes on from there, ends the phase at the same time;
/// a command within the step that would have ended it gives the phase its time back.
#[test]
fn checkpoints_and_commands() {
    let mut fall = falling(0.5).start(&Settings { rtol: 1e-7, ..Settings::default() }).unwrap();
    fall.record(&sampling()).unwrap();
    fall.advance_to(0.2).unwrap();
    let checkpoint = fall.checkpoint();
    let ended = |fall: &pliant::Simulation| fall.trajectory().report().phases[0].end;
    fall.advance_to(0.4).unwrap();
    let first = ended(&fall);
    assert!((first - expected()).abs() < 1e-8, "{first}");
    fall.restore(&checkpoint).unwrap();
    fall.advance_to(first).unwrap();
    let at_end = fall.checkpoint();
    fall.advance_to(0.4).unwrap();
    assert!((ended(&fall) - first).abs() < 1e-8, "{}", ended(&fall) - first);
    fall.restore(&at_end).unwrap();
    fall.advance_to(0.4).unwrap();
    assert!((ended(&fall) - first).abs() < 1e-8, "{}", ended(&fall) - first);
    // thrown up again a moment before: it rises by v^2/2g, and is at the height as late as it takes
    fall.restore(&checkpoint).unwrap();
    fall.advance_to(first - 1e-3).unwrap();
    let (at, v) = (fall.view().centre_of_mass()[1], 0.5);
    fall.change_state(|_, speed| speed.chunks_mut(2).for_each(|speed| speed[1] = v)).unwrap();
    let again = (v + (v * v + 2.0 * GRAVITY * (at - 0.03 + DROP)).sqrt()) / GRAVITY;
    fall.advance_to(0.55).unwrap();
    let late = ended(&fall) - (first - 1e-3 + again);
    assert!(late.abs() < 1e-7, "{late:e}");
}

/// Ends that cannot be found.
#[test]
fn refusals() {
    let refused = |scene: &Scene, sampling: Sampling, words: &str| {
        let error = scene.simulate(&Settings::default(), &sampling).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    refused(&falling(0.5), Sampling::phase_ends(), "end of phase \"fall\"");
    let nowhere = falling(0.5).phase(Phase::until(0.7).ends_above("height", f64::NAN));
    refused(&nowhere.phase(Phase::until(0.8)), sampling(), "end of phase");
    let last = falling(0.5).phase(Phase::until(0.7).ends_above("height", 0.0));
    refused(&last, sampling(), "let another one follow");
}

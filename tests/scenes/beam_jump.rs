//! The jumping beam of Fig. 4.1 on every method: against an independent reference, closed forms
//! and each other.

use crate::common::{Table, difference, global_error, run, tolerances};
use pliant::samples::{BEAM_MATERIAL, BeamJump, beam_jump};
use pliant::{Body, Mesh, Method, Phase, Sampling, Scene, Settings, Strain, Trajectory};

const ALPHAS: [f64; 4] = [10.0, 1e2, 1e4, 1e6];

/// Largest distance of nodes 1, 3 and 6 from the reference while the beam deforms and jumps,
/// relative to the displacement of its tip under the push (2 cm).
fn error(trajectory: &Trajectory, reference: &Table) -> f64 {
    let samples = trajectory.samples();
    let mut worst = 0.0_f64;
    for node in [1, 3, 6] {
        let expected = reference.get(&format!("u{node}"));
        assert_eq!(samples.len(), expected.len() + 1); // the end of the push is a sample, too
        for (t, expected) in reference.get("t").iter().zip(expected) {
            let sample = samples.iter().find(|sample| (sample.time - t).abs() < 1e-12).unwrap();
            worst = worst.max((sample.u[node - 1] - expected).abs());
        }
    }
    worst / 0.02
}

/// The beam starts at rest in the held position, so alpha should make no difference at all. The
/// explicit method is spared alpha = 1e6 (it needs 60,000 steps for nothing).
#[test]
fn every_method_meets_the_reference_whatever_alpha() {
    let reference = Table::read("beam_jump.csv");
    let scene = beam_jump().unwrap();
    for method in Method::ALL {
        for alpha in ALPHAS.into_iter().filter(|&alpha| method != Method::Rk || alpha < 1e6) {
            let [coarse, fine] = tolerances(method).map(|rtol| {
                let settings = Settings { method, rtol, alpha, ..Settings::default() };
                error(&run(&scene, &settings, &reference.get("t")), &reference)
            });
            println!("{method} alpha {alpha:e}: {coarse:.1e}, at a hundredth of rtol {fine:.1e}");
            // the jump carries errors of the take-off velocity over 0.4 s, or 35 cm
            assert!(
                fine < global_error(method, tolerances(method)[1]),
                "{method}, alpha {alpha}: {fine:e}"
            );
            assert!(fine < coarse / 7.0, "{method}, alpha {alpha}: {coarse:e} to {fine:e}");
        }
    }
}

/// Pressed long enough the beam shortens by F L / (E A) = 2 cm.
#[test]
fn static_shortening() {
    let body = Body::new(Mesh::bar(0.10, 6).unwrap(), BEAM_MATERIAL)
        .strain(Strain::Cauchy)
        .area(2e-4)
        .build()
        .unwrap();
    let push = Phase::until(5.0).hold("left").load("right", [-2.0]);
    let settings = Settings { rtol: 1e-9, ..Settings::default() };
    let trajectory =
        Scene::new(body).phase(push).simulate(&settings, &Sampling::phase_ends()).unwrap();
    let last = trajectory.last();
    assert!((last.u[5] + 0.02).abs() < 1e-11, "{}", last.u[5]);
    // the wall carries the load: the body is pushed up by 2 N
    assert!((last.multipliers[0] - 2.0).abs() < 1e-11, "{}", last.multipliers[0]);
}

/// With gravity (all to a few times the digits of the reference): leaves the floor at 0.2144264711 s with 0.85940414 m/s; its centre of mass
/// rises to 8.46279063 cm at 0.3021208 s (computed independently, 8 digits trusted). After
/// take-off the centre of mass flies as a stone does, whatever the bar's vibration.
#[test]
fn jump_under_gravity() {
    let scene = BeamJump { gravity: 9.8, until: 0.3021208 }.scene().unwrap();
    for method in [Method::CvodeBdf, Method::Ida, Method::Rk] {
        let settings = Settings { method, rtol: 1e-9, ..Settings::default() };
        let trajectory = run(&scene, &settings, &[0.2144264711]);
        let [_, _, leaving, apex] = trajectory.samples() else { panic!("four samples") };
        let velocity = trajectory.mean_velocity(leaving)[0];
        assert!((velocity - 0.85940414).abs() < 1e-8, "{method}: {velocity}");
        assert!(leaving.u[0].abs() < 1e-10, "{method}: foot at {}", leaving.u[0]);
        let height = trajectory.centre_of_mass(apex)[0];
        assert!((height - 0.0846279063).abs() < 2e-9, "{method}: {height}");
        let seconds = apex.time - leaving.time;
        let start = trajectory.centre_of_mass(leaving)[0];
        let ballistic = start + velocity * seconds - 4.9 * seconds * seconds;
        assert!((height - ballistic).abs() < 1e-10, "{method}: {height} {ballistic}");
        let weight_lifted = 0.02 * 9.8 * (height - 0.05);
        assert!((apex.energy.gravity - 0.02 * 9.8 * 0.05 - weight_lifted).abs() < 1e-16);
        assert!(trajectory.report().energy_error < 3e-8 * trajectory.report().energy_scale);
    }
}

/// Samples come from the dense output: asking for more of them changes nothing.
#[test]
fn samples_do_not_change_the_motion() {
    let scene = beam_jump().unwrap();
    for method in Method::ALL {
        let settings = Settings { method, ..Settings::default() };
        let few = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
        let many = scene.simulate(&settings, &Sampling::every(1e-4)).unwrap();
        assert_eq!(few.last().u, many.last().u, "{method}");
        assert_eq!(few.report().steps(), many.report().steps(), "{method}");
        assert_eq!(many.samples().len(), 6001, "{method}");
    }
}

/// Between its steps a method is as accurate as at them: samples at odd times against a run
/// with a hundredth of the tolerance.
#[test]
fn dense_output_is_as_accurate_as_the_steps() {
    let scene = beam_jump().unwrap();
    let times: Vec<f64> = (1..600).map(|k| 1e-3 * f64::from(k) + 1.234e-4).collect();
    for method in Method::ALL {
        let [coarse, fine] = [1e-6, 1e-8]
            .map(|rtol| run(&scene, &Settings { method, rtol, ..Settings::default() }, &times));
        let apart = difference(&coarse, &fine);
        // measured: 11 rtol at most
        assert!(apart < 30.0 * 1e-6, "{method}: {apart:e}");
    }
}

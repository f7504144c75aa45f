//! The estimates of the spectrum against all eigenvalues of the dense matrices.

use faer::Mat;
use faer::prelude::Solve;
use pliant::samples::{self, SquareJump};
use pliant::{Phase, Scene, Spectrum};

/// Eigenvalues of M^-1 X at the degrees of freedom that `is_free`, ascending.
fn eigenvalues(scene: &Scene, matrix: &Mat<f64>, is_free: impl Fn(usize) -> bool) -> Vec<f64> {
    let (body, d) = (scene.body(), scene.body().dimension());
    let free: Vec<usize> = (0..body.dofs()).filter(|&dof| is_free(dof)).collect();
    let mass = |i: usize, j: usize| match free[i] % d == free[j] % d {
        true => body.inertia().get(free[i] / d, free[j] / d),
        false => 0.0,
    };
    let size = free.len();
    let mass = Mat::from_fn(size, size, mass);
    let right = Mat::from_fn(size, size, |i, j| matrix[(free[i], free[j])]);
    let product = mass.partial_piv_lu().solve(&right);
    let mut values: Vec<f64> =
        product.eigenvalues().unwrap().iter().map(|value| value.re).collect();
    values.sort_by(f64::total_cmp);
    values
}

fn compare(scene: &Scene, spectrum: &Spectrum, is_free: impl Fn(usize) -> bool, rigid: usize) {
    let body = scene.body();
    let stiffness = eigenvalues(scene, &body.stiffness().to_dense(), &is_free);
    let damping = eigenvalues(scene, &body.damping().to_dense(), &is_free);
    let (highest, fastest) = (stiffness.last().unwrap().sqrt(), *damping.last().unwrap());
    // power iteration comes from below; 5 % is what it is meant to be good to (and the dense settings
    // with a matrix that is not symmetric is good to 1e-5)
    let near = |found: f64, exact: f64| (0.95 * exact..=exact * (1.0 + 1e-4)).contains(&found);
    let Spectrum { highest_frequency, damping_rate, .. } = *spectrum;
    assert!(near(highest_frequency, highest), "{highest_frequency} {highest}");
    assert!(near(damping_rate, fastest), "{damping_rate} {fastest}");
    // subspace iteration stops when two values in a row agree to 1e-4
    let lowest = stiffness[rigid].sqrt();
    let found = spectrum.lowest_frequency.unwrap();
    assert!((found / lowest - 1.0).abs() < 1e-3, "{found} {lowest}");
    assert!(stiffness[..rigid].iter().all(|value| value.abs() < 1e-9 * stiffness.last().unwrap()));
}

/// The body alone.
fn in_the_air(scene: &Scene) -> Scene {
    Scene::new(scene.body().clone()).phase(Phase::until(1.0))
}

#[test]
fn a_held_body_and_a_free_one() {
    let scene = samples::square_jump(4).unwrap();
    let phases = scene.spectrum().unwrap();
    let held = |dof: usize| dof / 2 > 3 && ![13, 14].contains(&(dof / 2));
    compare(&scene, &phases[1], held, 0);
    // on the floor, which its bottom touches, it bobs as a whole
    let omega = (4.0 * 100.0 / scene.body().mass()).sqrt();
    let found = phases[2].lowest_frequency.unwrap();
    assert!((0.85 * omega..omega).contains(&found), "{found} {omega}");
    let free = in_the_air(&scene);
    let spectrum = free.spectrum().unwrap()[0];
    compare(&free, &spectrum, |_| true, 3);
    // viscosity is c/E = 4e-5 s times stiffness
    assert!((spectrum.retardation_time() / 4e-5 - 1.0).abs() < 1e-13);
}

#[test]
fn a_body_of_two_materials_and_one_in_a_line() {
    let ring = in_the_air(&samples::RingRoll::default().scene().unwrap());
    compare(&ring, &ring.spectrum().unwrap()[0], |_| true, 3);
    let beam = samples::beam_jump().unwrap();
    compare(&beam, &beam.spectrum().unwrap()[0], |dof| dof > 0, 0);
    compare(&beam, &in_the_air(&beam).spectrum().unwrap()[0], |_| true, 1);
}

/// Hirai's bodies: largest eigenvalues of the equations of motion, found by an independent
/// program (two digits).
#[test]
fn the_stiffest_rates_are_those_of_the_documents_bodies() {
    let rate = |scene: Scene, phase: usize| scene.spectrum().unwrap()[phase].stiffest_rate();
    let large = SquareJump { nodes: 10, ..SquareJump::default() }.scene().unwrap();
    for (found, known) in [
        (rate(samples::beam_jump().unwrap(), 1), 5.7e3),
        (rate(samples::square_press(4).unwrap(), 0), 4.6e3),
        (rate(large, 2), 1.5e4),
    ] {
        // 5 % of the estimate and half a digit of what is known
        assert!((0.92..1.05).contains(&(found / known)), "{found} {known}");
    }
}

#[test]
fn what_cannot_move_has_no_vibration() {
    let scene = samples::square_jump(4).unwrap();
    let held = Scene::new(scene.body().clone()).phase(Phase::until(1.0).hold("all"));
    let spectrum = held.spectrum().unwrap()[0];
    assert_eq!((spectrum.highest_frequency, spectrum.lowest_frequency), (0.0, None));
    assert_eq!((spectrum.stiffest_rate(), spectrum.retardation_time()), (0.0, 0.0));
}

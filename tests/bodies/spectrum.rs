//! The estimates of the spectrum against all eigenvalues of the dense matrices.

use faer::Mat;
use faer::prelude::Solve;
use pliant::samples::{self, SquareJump};
use pliant::{Body, Cells, Material, Mesh, Phase, Plane, Scene, SolidCells, Spectrum, Strain};

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

/// Bodies that nothing holds, alone in a phase of one second.
fn free(mesh: Mesh, material: Material) -> Scene {
    let is_flat = mesh.dimension() == 2;
    let body = Body::new(mesh, material);
    let body = if is_flat { body.thickness(0.01).plane(Plane::Stress) } else { body };
    Scene::new(body.build().unwrap()).phase(Phase::until(1.0))
}

/// Thin rings and beams swing as slowly as bars of the same length would a thousand times: their slowest vibrations are those
/// of Euler's bending, without extension (Love), not what round-off makes of rigid motions. Damping is that of the material.
#[test]
fn slender_bodies_that_nothing_holds_bend() {
    let material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 10.0 };
    let euler = |thickness: f64| (1e6 * thickness * thickness / 12.0 / 1000.0).sqrt();
    let mut cases = Vec::new();
    for (thickness, around) in [(1e-3, 48), (1e-3, 96), (5e-4, 128)] {
        let [inner, outer] = [0.05 - 0.5 * thickness, 0.05 + 0.5 * thickness];
        let mesh = Mesh::ring(inner, outer, [around, 3], Cells::Triangles6).unwrap();
        cases.push((mesh, euler(thickness) / 0.05_f64.powi(2) * (36.0_f64 / 5.0).sqrt()));
    }
    for thickness in [2e-3, 5e-4] {
        let mesh = Mesh::rectangle([0.1, thickness], [41, 3], Cells::Triangles6).unwrap();
        cases.push((mesh, euler(thickness) / 0.1_f64.powi(2) * 4.730_040_745_f64.powi(2)));
    }
    for (mesh, expected) in cases {
        let spectrum = free(mesh, material).spectrum().unwrap()[0];
        let found = spectrum.lowest_frequency.unwrap();
        println!("{found:.5} for {expected:.5} 1/s: {:.1e}", found / expected - 1.0);
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
        assert!((spectrum.retardation_time() / 1e-5 - 1.0).abs() < 1e-6, "{spectrum:?}");
    }
}

#[test]
fn a_block_that_nothing_holds() {
    let material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 10.0 };
    let mesh = Mesh::cuboid([0.1, 0.02, 0.01], [6, 3, 2], SolidCells::Hexahedra).unwrap();
    let body = Body::new(mesh, material).strain(Strain::Cauchy).build().unwrap();
    let scene = Scene::new(body).phase(Phase::until(1.0));
    compare(&scene, &scene.spectrum().unwrap()[0], |_| true, 6);
}

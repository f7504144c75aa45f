//! Central differences on bodies, at fixed steps, against known closed forms for the scheme.

use std::f64::consts::PI;

use super::*;
use crate::base::vector::dot;
use crate::integrators::central_difference::{CentralDifference, Integrator, Options};
use crate::scene::constraint::PhaseStart;
use crate::{
    Axis, Body, Cells, Inertia, Material, Mesh, Method, Obstacle, Phase, Prescribed, Sampling,
    Scene, Settings, SolidCells, Strain, Viscosity,
};

/// So fast that a held node that is set in motion follows within the first step.
const ALPHA: f64 = 1e12;

fn form(scene: &Scene) -> SecondOrderForm {
    let natural = vec![0.0; scene.body().dofs()];
    let start = PhaseStart { time: 0.0, u: &natural };
    let forces = scene.forces().unwrap();
    let matrices = scene.matrices(&forces);
    let of_phase = forces.into_iter().next().unwrap();
    SecondOrderForm::new(
        scene.system(&matrices, &scene.phases()[0], of_phase, &start, ALPHA).unwrap(),
    )
}

/// The method on the first phase of a scene, with steps of a given size: no error test, no
/// other step sizes.
fn fixed(scene: &Scene, h: f64) -> CentralDifference<SecondOrderForm> {
    let (u, v) = (scene.initial_displacements(), scene.initial_velocities().unwrap());
    let (y, end) = ([u, &v, &[0.0; 2]].concat(), scene.phases()[0].until);
    let options = Options::new(0.5, 1e300);
    let mut central = CentralDifference::new(form(scene), 0.0, &y, &options).unwrap();
    central.set_stop_time(Some(end)).unwrap();
    central.fix_steps(h);
    central
}

/// Displacements after `steps` steps.
fn after(central: &mut CentralDifference<SecondOrderForm>, steps: usize) -> &[f64] {
    for _ in 0..steps {
        central.step(1e9).unwrap();
    }
    &central.y()[..central.system().system.dofs()]
}

/// A bar of 1 m whose left end is held, with lumped inertia and waves of 1 m/s; `viscosity` is the
/// time c/E (s).
fn bar(cells: usize, viscosity: f64) -> Scene {
    let material = Material { density: 1.0, young: 1.0, poisson: 0.0, viscosity };
    let body = Body::new(Mesh::bar(1.0, cells + 1).unwrap(), material).strain(Strain::Cauchy);
    let body = body.area(1.0).inertia(Inertia::Lumped).build().unwrap();
    Scene::new(body).phase(Phase::until(1e9).hold("left"))
}

/// Frequency (rad/s) of the k-th vibration (from 1) of the lumped bar.
fn frequency(cells: usize, k: usize) -> f64 {
    2.0 * cells as f64 * ((2 * k - 1) as f64 * PI / (4 * cells) as f64).sin()
}

/// The bounds on the rates of a bar, without shear and transverse waves, are sharp.
#[test]
fn rates_of_a_bar() {
    for cells in [1, 2, 10, 100] {
        let scene = bar(cells, 0.01);
        let still = vec![0.0; scene.body().dofs()];
        let rates = form(&scene).rates(0.0, &still, &still);
        let omega = frequency(cells, cells);
        for (found, exact) in [(rates.frequency, omega), (rates.decay, 0.01 * omega * omega)] {
            println!("{cells} cells: {found} {exact}");
            assert!(found > (1.0 - 1e-12) * exact && found < 1.01 * exact, "{found} {exact}");
        }
    }
}

/// kinetic + potential + dissipated - supplied, minus h^2 a.M a/8.
fn balance(central: &mut CentralDifference<SecondOrderForm>, h: f64) -> f64 {
    let (t, y) = (central.t(), central.y().to_vec());
    let (n, form) = (y.len() / 2 - 1, central.system_mut());
    let (u, v) = (&y[..n], &y[n..2 * n]);
    let energy = form.balance(t, u, v, &y[2 * n..]).unwrap().energy;
    let (mut f, mut a) = (vec![0.0; n], vec![0.0; n]);
    form.forces(t, u, v, &mut f).unwrap();
    form.accelerations(&Kick { duration: h, force: &f, before: v }, &mut a);
    energy - h * h / 8.0 * dot(&f, &a)
}

/// A clamped rubber square of 3 x 3 cells, lumped.
fn square(strain: Strain, viscosity: f64, phase: Phase) -> Scene {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.4, viscosity };
    let body = Body::new(mesh, rubber).thickness(0.01).strain(strain).inertia(Inertia::Lumped);
    Scene::new(body.build().unwrap()).phase(phase.hold("bottom"))
}

/// Under linear forces the balance of the scheme is constant to round-off, whatever the step, even if held
/// nodes are suddenly set in motion.
#[test]
fn linear_forces_keep_the_energy_of_the_scheme() {
    let phase = Phase::until(1e9).move_nodes([13, 14], [0.02, -0.05]);
    let scene = square(Strain::Cauchy, 0.0, phase);
    for h in [1e-5, 3e-4] {
        let mut central = fixed(&scene, h);
        let dofs = after(&mut central, 1000).len();
        let scale = central.y()[2 * dofs + 1].abs();
        let mut worst = 0.0_f64;
        for _ in 0..20 {
            after(&mut central, 1000);
            worst = worst.max(balance(&mut central, h).abs() / scale);
        }
        println!("h {h:e}: balance {worst:.1e} of the energy supplied, {scale:.3} J");
        // 20,000 sums of numbers of the size of the energy
        assert!(worst < 1e-11, "h {h:e}: {worst:e}");
    }
}

/// The heat of natural and of objective viscosity is accounted for to second order.
#[test]
fn heat_is_second_order() {
    for strain in [Strain::Cauchy, Strain::Green] {
        let phase = Phase::until(1e9).load([16], [20.0, 50.0]);
        let scene = square(strain, 200.0, phase);
        let errors = [400, 800, 1600].map(|steps| {
            let h = 0.04 / steps as f64;
            let mut central = fixed(&scene, h);
            after(&mut central, steps);
            let dissipated = central.y()[central.y().len() - 2];
            (dissipated, balance(&mut central, h).abs() / dissipated)
        });
        println!("{strain:?}: heat (J) and error of the balance {errors:?}");
        for pair in errors.windows(2) {
            let ratio = pair[0].1 / pair[1].1;
            assert!((ratio - 4.0).abs() < 0.4, "{strain:?}: {errors:?}");
        }
    }
}

/// Without damping the energy of a beam that swings with large amplitude does not drift in 100,000 steps.
#[test]
fn energy_does_not_drift() {
    let material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
    let mesh = Mesh::rectangle([1.0, 0.1], [11, 2], Cells::Triangles).unwrap();
    let body = Body::new(mesh, material).thickness(0.1).strain(Strain::Green);
    let scene = Scene::new(body.inertia(Inertia::Lumped).build().unwrap());
    let scene = scene.gravity([0.0, -2.0]).phase(Phase::until(1e9).hold("left"));
    let still = vec![0.0; scene.body().dofs()];
    let omega = form(&scene).rates(0.0, &still, &still).frequency;
    let h = 0.8 * 2.0 / omega;
    let mut central = fixed(&scene, h);
    let start = balance(&mut central, 0.0);
    let mut scale = 0.0_f64;
    let stretches = [(); 10].map(|()| {
        let mut worst = 0.0_f64;
        for _ in 0..1000 {
            after(&mut central, 10);
            worst = worst.max((balance(&mut central, h) - start).abs());
            let (t, y) = (central.t(), central.y());
            let energy = central.system().system.energy(t, &y[..44], &y[44..88], &[]);
            scale = scale.max(energy.kinetic);
        }
        worst
    });
    println!("scale {scale:.3} J, balance off by at most {stretches:?} J in each tenth");
    assert!(stretches.iter().all(|worst| *worst < 0.02 * scale), "{stretches:?} of {scale}");
    assert!(stretches[9] < 2.0 * stretches[0], "{stretches:?}");
}

/// A node held only by a stiff floor: the step is stable even before the node touches it.
#[test]
fn contacts_count_before_they_touch() {
    let body = Body::new(
        Mesh::bar(1.0, 2).unwrap(),
        Material { density: 1.0, young: 1.0, poisson: 0.0, viscosity: 0.0 },
    )
    .strain(Strain::Cauchy);
    let body =
        body.area(1.0).inertia(Inertia::Lumped).viscosity(Viscosity::Natural).build().unwrap();
    let floor = Obstacle::half_plane([-1.0], [1.0]).stiffness(1e4).damping(30.0);
    let scene = Scene::new(body).obstacle(floor).phase(Phase::until(1.0));
    let (mut form, still) = (form(&scene), [0.0; 2]);
    let far = form.rates(0.0, &still, &still);
    let touching = form.rates(0.0, &[-1.5, -2.5], &still);
    // on half a kilogramme, in addition to springs of 1 N/m
    assert!((far.frequency / 2e4f64.sqrt() - 1.0).abs() < 1e-3, "{far:?}");
    assert!((far.decay / 60.0 - 1.0).abs() < 1e-3, "{far:?}");
    assert!((touching.frequency / far.frequency - 1.0).abs() < 1e-3, "{touching:?}");
}

/// The work of a force that moves a node along a path is computed with the mean rates: energies balance to
/// the order of the method.
#[test]
fn work_along_a_path_is_booked() {
    let material = Material { density: 1.0, young: 1.0, poisson: 0.0, viscosity: 0.0 };
    let body = Body::new(Mesh::bar(1.0, 41).unwrap(), material).strain(Strain::Cauchy);
    let body = body.area(1.0).inertia(Inertia::Lumped).build().unwrap();
    let wave = |t: f64| Prescribed {
        displacement: 0.01 * (1.0 - (PI * t).cos()),
        velocity: 0.01 * PI * (PI * t).sin(),
        acceleration: 0.01 * PI * PI * (PI * t).cos(),
    };
    let scene = Scene::new(body).phase(Phase::until(3.3).follow("left", Axis::X, wave));
    let method = Method::CentralDifference;
    let settings = Settings { method, rtol: 1e-2, ..Settings::default() };
    let motion = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
    let report = motion.report();
    let supplied = motion.last().energy.supplied;
    println!("{:e} of {:e}, {supplied:e} J supplied", report.energy_error, report.energy_scale);
    // 80 steps per period: (2 pi / 80)^2 / 12 of the largest energy, with a factor of two as margin
    assert!(supplied > 0.1 * report.energy_scale);
    assert!(report.energy_error < 1e-3 * report.energy_scale, "{:e}", report.energy_error);
}

#[test]
fn a_path_without_numbers_within_a_step_is_an_error() {
    let path = |t: f64| {
        let velocity = if (0.004..0.006).contains(&t) { f64::NAN } else { 0.0 };
        Prescribed { displacement: 0.0, velocity, acceleration: 0.0 }
    };
    let body = Body::new(Mesh::bar(1.0, 5).unwrap(), crate::studies::samples::SQUARE_MATERIAL)
        .strain(Strain::Cauchy)
        .area(1.0);
    let scene = Scene::new(body.inertia(Inertia::Lumped).build().unwrap())
        .phase(Phase::until(1.0).follow("left", Axis::X, path));
    let error = fixed(&scene, 0.01).step(1.0).unwrap_err();
    let source = std::error::Error::source(&error).unwrap().to_string();
    assert!(source.contains("b' = NaN"), "{source}");
}

/// kinetic + potential + dissipated - supplied.
fn energy(central: &CentralDifference<SecondOrderForm>) -> f64 {
    let (form, y) = (central.system(), central.y());
    let n = form.system.dofs();
    form.balance(central.t(), &y[..n], &y[n..2 * n], &y[2 * n..]).unwrap().energy
}

/// A box that tumbles about its middle axis, at 20 rad/s: edges keep their lengths, and momenta and the energy stay, but for
/// round-off. (On a free rigid body the method is that of Moser and Veselov, which has both as invariants: R. I. McLachlan,
/// A. Zanna, Found. Comput. Math. 5 (2005) 87-123.)
#[test]
fn a_free_top_keeps_its_invariants() {
    let mesh = Mesh::cuboid([0.03, 0.02, 0.01], [3, 3, 2], SolidCells::Hexahedra).unwrap();
    let body = Body::new(mesh, Material::rigid(2000.0)).build().unwrap();
    let scene = Scene::new(body).spin([1.0, 20.0, 2.0]).phase(Phase::until(1e9));
    let momentum = |central: &CentralDifference<SecondOrderForm>| -> [f64; 3] {
        let (system, y) = (&central.system().system, central.y());
        let (n, positions) = (system.dofs(), scene.body().mesh().positions());
        let mut momenta = vec![0.0; n];
        system.matrices().add_momentum(1.0, &y[n..2 * n], &mut momenta);
        let x: Vec<f64> = positions.iter().zip(y).map(|(x, u)| x + u).collect();
        std::array::from_fn(|axis| {
            let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
            x.chunks(3).zip(momenta.chunks(3)).map(|(x, p)| x[i] * p[j] - x[j] * p[i]).sum()
        })
    };
    let mut central = fixed(&scene, 0.01);
    let (first, before) = (energy(&central), momentum(&central));
    // 64 turns, of 31 steps each
    after(&mut central, 2000);
    let (system, y) = (&central.system().system, central.y());
    let drift = system.drift(0.0, &y[..system.dofs()]);
    let now = momentum(&central);
    let lost = (0..3).map(|i| (now[i] - before[i]).abs()).fold(0.0, f64::max) / before[1];
    let gained = energy(&central) / first - 1.0;
    println!("edges off by {drift:.1e} m, momentum by {lost:.1e}, energy by {gained:.1e}");
    assert!(drift < 1e-15 && lost < 1e-12 && gained.abs() < 1e-12);
}

/// The energy of a rigid plate that swings about one of its corners, for 40 s, is off in proportion to h^2, and no more in
/// the end than at first.
#[test]
fn the_energy_of_a_pendulum_does_not_drift() {
    let mesh = Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Triangles).unwrap();
    let body = Body::new(mesh, Material::rigid(2000.0)).thickness(0.01).build().unwrap();
    let scene = Scene::new(body).gravity([0.0, -9.8]).phase(Phase::until(1e9).hold([1]));
    let off = [400, 800].map(|steps| {
        let mut central = fixed(&scene, 2.0 / f64::from(steps));
        let mut scale = 0.0_f64;
        let start = energy(&central);
        let tenths = [(); 10].map(|()| {
            let mut worst = 0.0_f64;
            for _ in 0..2 * steps {
                after(&mut central, 1);
                let (t, y) = (central.t(), central.y());
                let kinetic = central.system().system.energy(t, &y[..30], &y[30..60], &[]).kinetic;
                scale = scale.max(kinetic);
                worst = worst.max((energy(&central) - start).abs());
            }
            worst
        });
        println!("{steps}: off by {tenths:?} J, of {scale} J");
        assert!(tenths.iter().all(|worst| *worst < 2e-3 * scale), "{tenths:?} of {scale}");
        tenths
    });
    for tenth in off[0].iter().zip(off[1]) {
        assert!((tenth.0 / tenth.1 - 4.0).abs() < 0.2, "{off:?}");
    }
    assert!((off[1][9] / off[1][0] - 1.0).abs() < 0.05, "{off:?}");
}

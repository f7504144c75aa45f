//! Damping in proportion to mass and stiffness, against closed forms.

use std::f64::consts::PI;

use pliant::samples::ClampedBeam;
use pliant::{
    Body, Cells, Inertia, Material, Mesh, Method, Phase, Sampling, Scene, Settings, SolidCells,
    Strain, Substance, Trajectory,
};

pub const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.0, viscosity: 0.0 };
/// Cells, and length (m), of the bar.
const CELLS: usize = 8;
const LENGTH: f64 = 0.1;

/// A bar that is held at its left end and let go from its `k`-th shape of vibration, 1 mm at most.
pub fn plucked(substance: Substance, inertia: Inertia, k: usize, until: f64) -> Scene {
    let body = Body::new(Mesh::bar(LENGTH, CELLS + 1).unwrap(), substance).area(1e-4);
    let body = body.strain(Strain::Cauchy).inertia(inertia).build().unwrap();
    let phase = Phase::until(until).hold("left");
    Scene::new(body).initial_displacement(move |x| vec![1e-3 * shape(k, x[0])]).phase(phase)
}

pub fn shape(k: usize, x: f64) -> f64 {
    ((2 * k - 1) as f64 * PI * x / (2.0 * LENGTH)).sin()
}

/// Frequency (rad/s) of that shape, which is one of the mesh, too: (E/rho h^2) (2 - 2 cos kh) over the same of the inertia.
pub fn frequency(inertia: Inertia, k: usize) -> f64 {
    let h = LENGTH / CELLS as f64;
    let cos = ((2 * k - 1) as f64 * PI / (2 * CELLS) as f64).cos();
    let mass = match inertia {
        Inertia::Consistent => (2.0 + cos) / 3.0,
        Inertia::Lumped => 1.0,
    };
    (RUBBER.young / RUBBER.density * 2.0 * (1.0 - cos) / mass).sqrt() / h
}

pub fn run(scene: &Scene, method: Method, rtol: f64) -> Trajectory {
    let settings = Settings { method, rtol, ..Settings::default() };
    scene.simulate(&settings, &Sampling::every(scene.end() / 40.0)).unwrap()
}

/// Two to three times what was measured at the tolerances below.
fn error(method: Method) -> f64 {
    match method {
        Method::CentralDifference => 6e-4,
        Method::CvodeBdf | Method::Ida | Method::IdaIndexTwo => 1.5e-4,
        _ => 1e-5,
    }
}

/// Each shape of vibration decays as exp(-(a + beta omega^2) t / 2), whatever the method and the inertia, and what it loses is
/// booked as dissipated.
#[test]
fn vibrations_decay_by_both_parts() {
    let (a, beta) = (60.0, 1e-5);
    let damped = RUBBER.mass_damping(a).stiffness_damping(beta);
    for (method, rtol) in Method::ALL.into_iter().map(|method| match method {
        Method::CentralDifference => (method, 1e-6),
        _ => (method, 1e-7),
    }) {
        for inertia in [Inertia::Consistent, Inertia::Lumped] {
            for k in [1, 3] {
                let omega = frequency(inertia, k);
                let half = 0.5 * (a + beta * omega * omega);
                let turn = (omega * omega - half * half).sqrt();
                let trajectory = run(&plucked(damped.clone(), inertia, k, 0.05), method, rtol);
                let first = trajectory.samples()[0].energy.balance();
                let mut worst = 0.0_f64;
                for sample in trajectory.samples() {
                    let (sin, cos) = (turn * sample.time).sin_cos();
                    let part = (-half * sample.time).exp() * (cos + half / turn * sin);
                    for (u, x) in sample.u.iter().zip(trajectory.body().mesh().positions()) {
                        worst = worst.max((u - 1e-3 * part * shape(k, *x)).abs() / 1e-3);
                    }
                    let lost = (sample.energy.balance() / first - 1.0).abs();
                    worst = worst.max(lost);
                }
                assert!(worst < error(method), "{method} {inertia:?} {k}: {worst:e}");
                assert!(trajectory.last().energy.dissipated > 0.9 * first);
            }
        }
    }
}

/// A body that nothing holds slows down as exp(-a t) in all its motion, without strain; what is dissipated is what it has lost.
#[test]
fn rigid_motion_decays() {
    let a = 3.0;
    let silicone = Material { poisson: 0.45, viscosity: 100.0, ..RUBBER }.mass_damping(a);
    let plane = |strain| {
        let mesh = Mesh::rectangle([0.1, 0.06], [4, 3], Cells::Triangles).unwrap();
        Body::new(mesh, silicone.clone()).thickness(0.01).strain(strain).build().unwrap()
    };
    let mesh = Mesh::cuboid([0.1, 0.06, 0.06], [3, 3, 3], SolidCells::Hexahedra20).unwrap();
    let solid = Body::new(mesh, silicone.clone()).build().unwrap();
    let lumped = solid.to_builder().inertia(Inertia::Lumped).build().unwrap();
    for body in [plane(Strain::Cauchy), plane(Strain::Green), solid, lumped] {
        let mut velocity = vec![0.7, -0.4];
        velocity.resize(body.dimension(), 0.3);
        let scene = Scene::new(body).initial_velocity(move |_| velocity.clone());
        let trajectory = run(&scene.phase(Phase::until(1.0)), Method::CvodeBdf, 1e-7);
        let before = &trajectory.samples()[0];
        for sample in trajectory.samples() {
            let part = (-a * sample.time).exp();
            for (v, first) in sample.v.iter().zip(&before.v) {
                assert!((v - part * first).abs() < 1e-6, "{v} {first}"); // measured: 3.6e-7
            }
            let (lost, all) = (sample.energy.dissipated, before.energy.kinetic);
            // measured: 1.7e-5; energies have loose tolerances
            assert!((lost / all - (1.0 - part * part)).abs() < 5e-5, "{lost} {all}");
        }
    }
}

/// Angular momentum decays as exp(-a t) of what spins and swings under large strain, too, in a straight line by another method.
#[test]
fn spin_decays_with_objective_viscosity() {
    let soft = Material { young: 1e4, poisson: 0.4, viscosity: 20.0, ..RUBBER }.mass_damping(4.0);
    let mesh = Mesh::rectangle([0.1, 0.03], [6, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, soft).thickness(0.01).build().unwrap();
    let scene = Scene::new(body).spin([25.0]).phase(Phase::until(0.4));
    let [bdf, rk] = [(Method::CvodeBdf, 1e-7), (Method::Rk, 1e-7)]
        .map(|(method, rtol)| run(&scene, method, rtol));
    let first = rk.angular_momentum(&rk.samples()[0])[0];
    for (sample, other) in rk.samples().iter().zip(bdf.samples()) {
        let part = (-4.0 * sample.time).exp();
        let found = rk.angular_momentum(sample)[0] / first;
        assert!((found - part).abs() < 1e-9, "{found} {part}"); // measured: 1e-10
        for (x, y) in sample.u.iter().zip(&other.u) {
            assert!((x - y).abs() < 1e-5 * 0.1, "{x} {y}");
        }
    }
    let strain = rk.samples().iter().map(|sample| sample.energy.strain).fold(0.0, f64::max);
    assert!(strain > 0.01 * rk.samples()[0].energy.kinetic);
}

/// Each region has its own rate, and point masses have none.
#[test]
fn the_matrix_is_that_of_the_regions() {
    let cuboid = |damped: [f64; 2], inertia| {
        let mesh = Mesh::cuboid([0.2, 0.1, 0.1], [3, 2, 2], SolidCells::Tetrahedra).unwrap();
        let [left, right] = damped.map(|rate| RUBBER.stiffness_damping(1e-3).mass_damping(rate));
        let half = pliant::CellSelection::inside([0.1, -1.0, -1.0], [1.0; 3]);
        let body = Body::new(mesh, left).region(half, right).inertia(inertia);
        body.point_mass("bob", [0.3, 0.0, 0.0], 0.2).build().unwrap()
    };
    for inertia in [Inertia::Consistent, Inertia::Lumped] {
        let [none, left, both] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]].map(|a| cuboid(a, inertia));
        let bob = none.mesh().node_count() - 1;
        let (mut of_left, mut of_both) = (0.0, 0.0);
        for i in 0..none.dofs() {
            for j in 0..none.dofs() {
                let mass = if i % 3 == j % 3 { none.inertia().get(i / 3, j / 3) } else { 0.0 };
                let mass = if i / 3 == bob { 0.0 } else { mass };
                let added = both.damping().get(i, j) - none.damping().get(i, j);
                assert!((added - 2.0 * mass).abs() < 1e-12, "({i}, {j}): {added} {mass}");
                of_both += added;
                of_left += left.damping().get(i, j) - none.damping().get(i, j);
            }
        }
        // rates of mass (kg/s) along three axes: 2 kg in all
        assert!((of_both - 3.0 * 2.0 * 2.0).abs() < 1e-10 && (of_left - 6.0).abs() < 1e-10);
    }
}

/// The forces are -K u - B v, whether cells or matrices are summed up, and whatever else is constant.
#[test]
fn forces_are_those_of_the_matrices() {
    let plane = |kind, viscosity: f64, inertia| {
        let mesh = Mesh::rectangle([0.1, 0.1], [4, 3], kind).unwrap();
        let material = Material { viscosity, poisson: 0.3, ..RUBBER }.mass_damping(500.0);
        let body = Body::new(mesh, material).thickness(0.01).strain(Strain::Cauchy);
        body.inertia(inertia).build().unwrap()
    };
    for kind in [Cells::Triangles, Cells::Rectangles, Cells::Triangles6] {
        for (viscosity, inertia) in [(0.0, Inertia::Consistent), (40.0, Inertia::Lumped)] {
            let body = plane(kind, viscosity, inertia);
            let scene = Scene::new(body.clone()).phase(Phase::until(1.0));
            let n = body.dofs();
            let u: Vec<f64> = (0..n).map(|k| 1e-3 * (0.7 * k as f64).sin()).collect();
            let v: Vec<f64> = (0..n).map(|k| (0.3 * k as f64 + 1.0).sin()).collect();
            let mut equations = scene.equations(0, &u).unwrap();
            let mut f = vec![0.0; n];
            equations.forces(0.0, &u, &v, &mut f).unwrap();
            let (k, b) = (body.stiffness().to_dense(), body.damping().to_dense());
            let scale = f.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            for i in 0..n {
                let sum: f64 = (0..n).map(|j| k[(i, j)] * u[j] + b[(i, j)] * v[j]).sum();
                assert!((f[i] + sum).abs() < 1e-13 * scale, "{kind:?} {viscosity} {i}");
            }
        }
    }
}

#[test]
fn a_rate_out_of_range_is_named() {
    for rate in [-1.0, f64::NAN, f64::INFINITY] {
        let mesh = Mesh::bar(0.1, 2).unwrap();
        let error = Body::new(mesh, RUBBER.mass_damping(rate)).area(1e-4).build().unwrap_err();
        assert!(error.to_string().starts_with("material.mass_damping = "), "{error}");
    }
}

/// Damping by mass leaves fast vibrations as they are, which BDF would follow one by one.
#[test]
fn the_choice_knows_what_damping_is_by_mass() {
    let scene = ClampedBeam { nodes: [10, 3], viscosity: 4000.0, ..ClampedBeam::default() };
    let scene = scene.scene().unwrap();
    let viscous = *scene.body().material();
    let plan = |substance: Substance| {
        let body = scene.body().to_builder().material(substance).build().unwrap();
        let beam = Scene::new(body).phase(Phase::until(0.2).hold("left"));
        let spectrum = beam.spectrum().unwrap()[0];
        let report = run(&beam, Method::Auto, 1e-3).report().phases[0].clone();
        (spectrum, report.method, report.reason.unwrap())
    };
    let still = Material { viscosity: 0.0, ..viscous };
    let (spectrum, method, reason) = plan(still.mass_damping(4.0));
    let ratio = 4.0 / (2.0 * spectrum.lowest_frequency.unwrap());
    assert!((spectrum.mass_damping_ratio / ratio - 1.0).abs() < 1e-12 && ratio > 0.1);
    assert_eq!(spectrum.lowest_damping_ratio, spectrum.mass_damping_ratio);
    assert_eq!(method, Method::Arkode);
    assert!(reason.contains("0.0e0 besides that of its mass, below"), "{reason}");
    let (spectrum, method, _) = plan(viscous.mass_damping(4.0));
    assert!(spectrum.lowest_damping_ratio > spectrum.mass_damping_ratio + 0.006);
    assert_eq!(method, Method::CvodeBdf);
}

//! Scenes that start in motion: thrown and spinning bodies, against closed forms.

use pliant::{
    Body, Cells, Inertia, Material, Mesh, Method, Phase, Sampling, Scene, Settings, SolidCells,
    Strain, Viscosity,
};

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 100.0 };
const G: f64 = 9.8;

/// A body thrown with a spin flies along a parabola, and keeps the angular momentum m (a^2 + b^2)/12 omega of
/// a rectangle, whatever the method.
#[test]
fn a_thrown_body_flies_along_a_parabola_and_keeps_its_spin() {
    let ([a, b], [vx, vy], omega) = ([0.2, 0.1], [1.5, 3.0], 8.0);
    let mesh = Mesh::rectangle([a, b], [5, 3], Cells::Rectangles).unwrap();
    for method in Method::ALL {
        let body = Body::new(mesh.clone(), RUBBER).thickness(0.1);
        let body = body.strain(Strain::Green).viscosity(Viscosity::Objective);
        let scene = Scene::new(body.build().unwrap())
            .initial_velocity(move |_| vec![vx, vy])
            .spin([omega])
            .gravity([0.0, -G])
            .phase(Phase::until(0.1));
        let settings = Settings { method, rtol: 1e-7, ..Settings::default() };
        let motion = scene.simulate(&settings, &Sampling::every(0.025)).unwrap();
        let spin = scene.body().mass() * (a * a + b * b) / 12.0 * omega;
        let (mut off_way, mut off_spin) = (0.0_f64, 0.0_f64);
        for sample in motion.samples() {
            let (t, x) = (sample.time, motion.centre_of_mass(sample));
            let expected = [a / 2.0 + vx * t, b / 2.0 + vy * t - 0.5 * G * t * t];
            off_way = off_way.max((x[0] - expected[0]).hypot(x[1] - expected[1]));
            off_spin = off_spin.max((motion.angular_momentum(sample)[0] / spin - 1.0).abs());
        }
        println!("{method}: centre off by {off_way:.1e} m, spin by {off_spin:.1e}");
        // round-off at the start; then what steps at rtol 1e-7 leave
        assert!((motion.angular_momentum(&motion.samples()[0])[0] / spin - 1.0).abs() < 1e-14);
        assert!(off_way < 1e-9 && off_spin < 1e-6, "{method}: {off_way:e} {off_spin:e}");
    }
}

/// In space the spin is a vector: a cuboid's angular momentum is m/12 (b^2 + c^2) omega_x and so on, about a
/// centre that the initial displacements have moved.
#[test]
fn a_cuboid_spins_about_any_axis() {
    let (size, omega) = ([0.3, 0.2, 0.1], [1.0, -2.0, 3.0]);
    let mesh = Mesh::cuboid(size, [3, 3, 3], SolidCells::Hexahedra).unwrap();
    let scene = Scene::new(Body::new(mesh, RUBBER).build().unwrap())
        .spin(omega)
        .initial_displacement(|_| vec![0.5, 0.0, -1.0])
        .initial_velocity(|_| vec![0.0, 4.0, 0.0])
        .phase(Phase::until(1e-6));
    let motion = scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap();
    let (start, mass) = (&motion.samples()[0], scene.body().mass());
    let [a, b, c] = size.map(|x| x * x);
    let expected = [(b + c) * omega[0], (c + a) * omega[1], (a + b) * omega[2]];
    for (found, expected) in motion.angular_momentum(start).into_iter().zip(expected) {
        assert!((found / (mass * expected / 12.0) - 1.0).abs() < 1e-11, "{found}");
    }
    for (found, expected) in motion.momentum(start).into_iter().zip([0.0, 4.0 * mass, 0.0]) {
        assert!((found - expected).abs() < 1e-12 * mass, "{found}");
    }
}

/// A bar of one cell that is thrown and held on its left starts with the velocity nearest to that: with
/// M = m/6 [2 1; 1 2], 3/2 of it on the right; lumped, all of it. The rest of the kinetic energy goes to what
/// holds it. One that is thrown as it is moved starts as it was told.
#[test]
fn what_is_held_at_the_start_takes_its_part_of_a_throw() {
    let start = |inertia, phase: Phase| {
        let mesh = Mesh::bar(1.0, 2).unwrap();
        let body = Body::new(mesh, RUBBER).area(1e-4).inertia(inertia).build().unwrap();
        let scene = Scene::new(body).initial_velocity(|_| vec![2.0]).phase(phase);
        let motion = scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap();
        motion.samples()[0].clone()
    };
    let held = || Phase::until(1e-6).hold([1]);
    for (inertia, expected) in [(Inertia::Consistent, 3.0), (Inertia::Lumped, 2.0)] {
        let sample = start(inertia, held());
        assert!(sample.v[0] == 0.0 && (sample.v[1] - expected).abs() < 1e-14, "{:?}", sample.v);
        let free = start(inertia, Phase::until(1e-6)).energy.kinetic;
        assert!((sample.energy.balance() / free - 1.0).abs() < 1e-14, "{:?}", sample.energy);
    }
    let moved = start(Inertia::Consistent, Phase::until(1e-6).move_nodes([1], [2.0]));
    assert_eq!(moved.v, [2.0, 2.0]);
    // the stabilization brings a body at rest to the velocity of what moves it, as ever
    let mesh = Mesh::bar(1.0, 2).unwrap();
    let scene = Scene::new(Body::new(mesh, RUBBER).area(1e-4).build().unwrap())
        .phase(Phase::until(1e-6).move_nodes([1], [2.0]));
    let motion = scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap();
    assert_eq!(motion.samples()[0].v, [0.0, 0.0]);
}

/// Nodes with a velocity of their own, and what cannot be one.
#[test]
fn nodes_may_have_velocities_of_their_own() {
    let scene = || {
        let mesh = Mesh::rectangle([0.2, 0.1], [3, 2], Cells::Rectangles).unwrap();
        let body = Body::new(mesh, RUBBER).thickness(0.1).build().unwrap();
        Scene::new(body).phase(Phase::until(1e-6))
    };
    let one = scene().initial_velocity_of([2, 3], [1.0, -2.0]).initial_velocity_of([3], [0.0, 5.0]);
    let motion = one.spin([0.0]).simulate(&Settings::default(), &Sampling::phase_ends()).unwrap();
    let expected = [0.0, 0.0, 1.0, -2.0, 0.0, 5.0];
    assert_eq!(motion.samples()[0].v[..6], expected);
    let says = |scene: Scene, words: &[&str]| {
        let message = scene.validate().unwrap_err().to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    };
    says(scene().spin([0.0, 0.0, 1.0]), &["spin", "[0.0, 0.0, 1.0]", "1 component"]);
    says(scene().spin([f64::NAN]), &["spin", "NaN"]);
    says(scene().initial_velocity_of([2], [1.0]), &["initial velocity", "2 component(s) (m/s)"]);
    says(scene().initial_velocity_of([7], [1.0, 0.0]), &["7"]);
    says(scene().initial_velocity_of("lid", [1.0, 0.0]), &["lid"]);
    let bar = Body::new(Mesh::bar(1.0, 2).unwrap(), RUBBER).area(1e-4).build().unwrap();
    says(Scene::new(bar).spin([1.0]).phase(Phase::until(1.0)), &["spin", "1 dimension"]);
}

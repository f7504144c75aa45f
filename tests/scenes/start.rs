//! Scenes that start in motion: thrown and spinning bodies, against closed forms.

use pliant::{
    Body, Cells, Inertia, Material, Mesh, Method, Phase, Sampling, Scene, Settings, SolidCells,
    Statics, Strain, Viscosity,
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

/// A run that is cut in two at the end of a phase, the second scene starting from the last state of the first, is the whole run.
/// (Nodes that begin to be held while they move are stopped by an impact at the start of a scene, and at the rate alpha later.)
#[test]
fn a_run_cut_in_two_is_the_whole_run() {
    let body = || {
        let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
        Body::new(mesh, RUBBER).thickness(0.01).strain(Strain::Green).build().unwrap()
    };
    let press = |phase: Phase| phase.hold("bottom").load("top", [0.5, -4.0]);
    let free = |phase: Phase| phase.hold("bottom");
    let floor = |scene: Scene| scene.gravity([0.0, -G]);
    for method in [Method::CvodeBdf, Method::Arkode, Method::Rk] {
        let settings = Settings { method, rtol: 1e-9, ..Settings::default() };
        let simulate =
            |scene: Scene| floor(scene).simulate(&settings, &Sampling::every(0.01)).unwrap();
        let whole = simulate(
            Scene::new(body()).phase(press(Phase::until(0.04))).phase(free(Phase::until(0.1))),
        );
        let first = simulate(Scene::new(body()).phase(press(Phase::until(0.04))));
        let state = first.state(first.last());
        let second =
            simulate(Scene::new(body()).starting_from(&state).phase(free(Phase::until(0.06))));
        assert_eq!(second.samples().len(), 7);
        let most = |x: &[f64]| x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let apart =
            |a: &[f64], b: &[f64]| most(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>());
        let (end, begin) = (second.last(), &second.samples()[0]);
        assert_eq!(begin.u, first.last().u);
        let off = apart(&whole.last().u, &end.u) / most(&end.u);
        println!("{method}: {off:.1e}, moved {:.1e} since", apart(&begin.u, &end.u) / most(&end.u));
        // round-off of the times, which differ by 0.04 s: 6e-13 at most
        assert!(off < 1e-11, "{method}: {off:e}");
        assert!(apart(&begin.u, &end.u) > 0.1 * most(&end.u));
    }
}

/// A bar of one cell, in equilibrium with a pull F at its end, and let go: u = F/k cos(omega t), with k = E A/L and
/// the mass rho A L/3 at its end.
#[test]
fn an_equilibrium_let_go_swings() {
    let (length, area, force) = (0.1, 2e-4, 0.5);
    let material = Material { viscosity: 0.0, ..RUBBER };
    let bar = || {
        let mesh = Mesh::bar(length, 2).unwrap();
        Body::new(mesh, material).area(area).strain(Strain::Cauchy).build().unwrap()
    };
    let pulled = Scene::new(bar()).phase(Phase::until(1.0).hold("left").load("right", [force]));
    let pulled = pulled.equilibrium(&Statics::default()).unwrap();
    let state = pulled.trajectory().state(pulled.sample());
    let scene = Scene::new(bar()).starting_from(&state).phase(Phase::until(0.02).hold("left"));
    let settings = Settings { rtol: 1e-9, ..Settings::default() };
    let motion = scene.simulate(&settings, &Sampling::every(0.001)).unwrap();
    let stiffness = RUBBER.young * area / length;
    let omega = (stiffness / (RUBBER.density * area * length / 3.0)).sqrt();
    for sample in motion.samples() {
        let expected = force / stiffness * (omega * sample.time).cos();
        let error = (sample.u[1] - expected).abs() / (force / stiffness);
        assert!(error < 1e-6, "t {}: {error:e}", sample.time);
    }
}

#[test]
fn a_state_of_another_mesh_is_refused() {
    let scene = |size: f64, nodes: [usize; 2]| {
        let mesh = Mesh::rectangle([size, 0.1], nodes, Cells::Triangles).unwrap();
        Scene::new(Body::new(mesh, RUBBER).thickness(0.01).build().unwrap())
            .phase(Phase::until(1e-4))
    };
    let motion = scene(0.2, [3, 2]).simulate(&Settings::default(), &Sampling::phase_ends());
    let motion = motion.unwrap();
    let state = motion.state(motion.last());
    let told = |scene: Scene| scene.starting_from(&state).validate().unwrap_err().to_string();
    scene(0.2, [3, 2]).starting_from(&state).validate().unwrap();
    let more = told(scene(0.2, [3, 3]));
    assert!(more.contains("state at the start = 6 nodes"), "{more}");
    assert!(more.contains("this body has 9"), "{more}");
    let longer = told(scene(0.2 + 1e-6, [3, 2]));
    assert!(longer.contains("node 2 at [0.1, 0.0] undeformed"), "{longer}");
    assert!(longer.contains("same mesh"), "{longer}");
    let mut turned = state.clone();
    turned.bodies[0].velocities[3] = f64::NAN;
    let scene = scene(0.2, [3, 2]).starting_from(&turned);
    assert!(scene.validate().unwrap_err().to_string().contains("initial velocity"));
}

//! Equilibria against printed and closed forms, and against what mechanics demands of them.

mod brought_on;
mod chambers;
mod free;
mod free_green;
mod load_curve;
mod oblique;
mod phases;
mod slender;
mod spread;
mod stability;

use std::f64::consts::{PI, TAU};

use pliant::mesh::CellKind;
use pliant::{
    Axis, Body, Cells, Equilibrium, Error, Material, Mesh, Obstacle, Phase, Prescribed, Scene,
    Spring, Stability, Statics, Strain, samples,
};

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };

fn solve(scene: &Scene) -> Equilibrium {
    scene.equilibrium(&Statics::default()).unwrap()
}

fn frequency(equilibrium: &Equilibrium) -> f64 {
    match equilibrium.stability {
        Stability::Stable { frequency } => frequency,
        other => panic!("{other:?}"),
    }
}

/// Slides, "Example (static simulation)": 4 x 4 nodes, bottom fixed, nodes 14 and 15 pressed down
/// by 0.3 (unit cells, E = 1e6, thickness 1). Displacements and constraint forces were computed
/// independently; trusted to 12 digits.
#[test]
fn static_square() {
    #[rustfmt::skip]
    let expected = [
        -0.10898434108450147, -0.015540996841346223, -0.07134640040085799, -0.03920332073808863,
        0.000607108153257671, -0.06640042531084175, 0.1421223163363305, -0.13457823155375725,
        -0.16551704332716716, -0.059086102373863476, -0.089829581327084, -0.1311567604264059,
        0.06715127132770206, -0.2401393583861693, 0.11526328480515981, -0.18015694233983356,
        -0.1535438568533657, -0.1319595617924208, 0.0, -0.3,
        0.0, -0.3, -8.807255490403375e-05, -0.18024501489473752,
    ];
    let multipliers = [
        81413.55832378718,
        86663.8950945124,
        124028.86794261461,
        185409.48670431576,
        114647.53344802432,
        279389.25714710884,
        -281681.5401273009,
        17445.292594121813,
        216080.07662838307,
        -226066.72553784316,
        -254488.4962155085,
        -342841.2060022152,
    ];
    let equilibrium = solve(&samples::static_square(Strain::Cauchy).unwrap());
    let u = equilibrium.displacements();
    assert!(u[..8].iter().all(|&u| u == 0.0), "the bottom is held");
    for (i, (u, expected)) in u[8..].iter().zip(expected).enumerate() {
        // 12 digits of displacements of 0.3
        assert!((u - expected).abs() < 1e-13, "dof {}: {u} {expected}", i + 8);
    }
    let sample = equilibrium.sample();
    assert_eq!(sample.multipliers.len(), multipliers.len());
    for (k, (found, expected)) in sample.multipliers.iter().zip(multipliers).enumerate() {
        // 12 digits of forces of size 1e5
        assert!((found - expected).abs() < 2e-8, "row {k}: {found} {expected}");
    }
    assert!((sample.energy.strain - 85336.18973100882).abs() < 5e-9);
    assert_eq!(equilibrium.factorizations, 1);
}

const SOFT: Material = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };

fn bar(strain: Strain) -> Body {
    let mesh = Mesh::bar(0.1, 6).unwrap();
    Body::new(mesh, SOFT).area(2e-4).strain(strain).build().unwrap()
}

#[test]
fn bars_stretch_as_in_the_textbook() {
    let pulled = Phase::until(1.0).hold("left").load("right", [1.5]);
    let pulled = solve(&Scene::new(bar(Strain::Cauchy)).phase(pulled));
    let hung = Phase::until(1.0).hold("left");
    let hung = solve(&Scene::new(bar(Strain::Cauchy)).gravity([9.8]).phase(hung));
    for node in 0..6 {
        let x = 0.02 * node as f64;
        // F x / (E A), and rho g (L x - x^2/2) / E, which linear cells meet at their nodes: round-off
        let stretch = 1.5 * x / (5e4 * 2e-4);
        assert!((pulled.displacements()[node] - stretch).abs() < 1e-15, "node {node}");
        let weight = 1000.0 * 9.8 * (0.1 * x - 0.5 * x * x) / 5e4;
        assert!((hung.displacements()[node] - weight).abs() < 1e-15, "node {node}");
    }
    // the support carries the whole weight: rho A L g
    assert!((hung.sample().multipliers[0] - -0.196).abs() < 1e-14);
    // what is stored is half the work of a load that comes on slowly: F^2 L / (2 E A)
    assert!((pulled.sample().energy.strain - 0.5 * 1.5 * 0.015).abs() < 1e-15);
    // the lowest of omega = (c/h) sqrt(6 (1 - cos t) / (2 + cos t)), t = (2k - 1) pi / (2 N)
    let t = (PI / 10.0).cos();
    let omega = 50f64.sqrt() / 0.02 * (6.0 * (1.0 - t) / (2.0 + t)).sqrt();
    // inverse iteration stops when the eigenvalue stands to 1e-8, and converges by its square
    assert!((TAU * frequency(&pulled) / omega - 1.0).abs() < 5e-10);
}

/// A bar of Green strain stretched by s pulls with F S A = (E A / 2) (s^3 - s).
#[test]
fn a_green_bar_meets_its_cubic() {
    for s in [0.7_f64, 1.3, 2.5] {
        let force = 0.5 * 5e4 * 2e-4 * (s.powi(3) - s);
        let pulled = Phase::until(1.0).hold("left").load("right", [force]);
        let equilibrium = solve(&Scene::new(bar(Strain::Green)).phase(pulled));
        for (node, u) in equilibrium.displacements().iter().enumerate() {
            // rtol 1e-10, and the last Newton step goes far below it: to round-off
            assert!((u - (s - 1.0) * 0.02 * node as f64).abs() < 1e-13, "s {s} node {node}: {u}");
        }
    }
}

/// The inner nodes of a 4 x 4 grid pushed about.
fn irregular_square() -> Mesh {
    let grid = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let mut positions = grid.positions().to_vec();
    for (node, dx, dy) in
        [(5, 0.021, -0.013), (6, -0.017, 0.024), (9, 0.011, 0.019), (10, -0.023, -0.008)]
    {
        positions[2 * node] += dx;
        positions[2 * node + 1] += dy;
    }
    let connectivity = grid.cells().flatten().copied().collect();
    let mesh = Mesh::new(2, positions, grid.kind(), connectivity).unwrap();
    mesh.name_nodes("left", [1, 5, 9, 13]).unwrap().name_nodes("right", [4, 8, 12, 16]).unwrap()
}

/// Uniaxial stretch s in plane strain: E_yy = -lambda/(lambda + 2 mu) E_xx makes S_yy vanish, so
/// that S_xx = 4 mu (lambda + mu)/(lambda + 2 mu) E_xx, and the right side pulls with s S_xx per
/// area. A patch of any cells must meet it.
#[test]
fn a_green_patch_stretches_uniaxially() {
    let s = 1.4;
    let body = Body::new(irregular_square(), RUBBER).thickness(0.01).strain(Strain::Green);
    let stretch = Phase::until(1.0)
        .hold_axes("left", [Axis::X])
        .hold_axes([1], [Axis::Y])
        .move_axis("right", Axis::X, (s - 1.0) * 0.3);
    let equilibrium = solve(&Scene::new(body.build().unwrap()).phase(stretch));
    let lame = RUBBER.elastic();
    let strain = 0.5 * (s * s - 1.0);
    let across = -lame.lambda / (lame.lambda + 2.0 * lame.mu) * strain;
    let narrow = (1.0 + 2.0 * across).sqrt();
    let positions = irregular_square().positions().to_vec();
    for (i, (u, x)) in equilibrium.displacements().iter().zip(&positions).enumerate() {
        let factor = if i % 2 == 0 { s } else { narrow };
        // the last Newton step goes far below rtol 1e-10: to round-off
        assert!((u - (factor - 1.0) * x).abs() < 1e-13, "dof {i}: {u}");
    }
    let modulus = 4.0 * lame.mu * (lame.lambda + lame.mu) / (lame.lambda + 2.0 * lame.mu);
    let pull: f64 = equilibrium.sample().multipliers[5..].iter().sum();
    let exact = s * modulus * strain * (0.3 * 0.01);
    assert!((pull / exact - 1.0).abs() < 2e-12, "{pull} {exact}");
}

/// A beam 10 x 2 x 1 cm of 11 x 3 nodes, turned by `angle` about the origin, its left end held and
/// node 22, the middle of the other one, loaded across.
fn beam(strain: Strain, angle: f64, force: f64) -> Scene {
    let (c, s) = (angle.cos(), angle.sin());
    let straight = Mesh::rectangle([0.1, 0.02], [11, 3], Cells::Triangles).unwrap();
    let turned = |x: &[f64]| [c * x[0] - s * x[1], s * x[0] + c * x[1]];
    let positions = straight.positions().chunks(2).flat_map(turned).collect();
    let connectivity = straight.cells().flatten().copied().collect();
    let mesh = Mesh::new(2, positions, CellKind::Triangle, connectivity).unwrap();
    let rubber = Material { young: 1e5, viscosity: 4.0, ..RUBBER };
    let body = Body::new(mesh, rubber).thickness(0.01).strain(strain).build().unwrap();
    let load = [s * force, -c * force];
    Scene::new(body).phase(Phase::until(1.0).hold([1, 12, 23]).load([22], load))
}

#[test]
fn green_equilibria_turn_with_their_frame() {
    let straight = solve(&beam(Strain::Green, 0.0, 0.5));
    let turned = solve(&beam(Strain::Green, 0.8, 0.5));
    let (c, s) = (0.8_f64.cos(), 0.8_f64.sin());
    let (a, b) = (straight.displacements(), turned.displacements());
    assert!(a[43] < -0.02, "it bends: {}", a[43]);
    for (a, b) in a.chunks(2).zip(b.chunks(2)) {
        let expected = [c * a[0] - s * a[1], s * a[0] + c * a[1]];
        // two solutions, both to round-off by their last Newton step
        assert!((b[0] - expected[0]).hypot(b[1] - expected[1]) < 1e-13);
    }
    assert!((frequency(&straight) / frequency(&turned) - 1.0).abs() < 2e-10);
}

/// U - W of the bent beam is least where it is in equilibrium, and its slope vanishes there.
#[test]
fn the_energy_is_least_in_equilibrium() {
    let force = 0.1;
    let scene = beam(Strain::Green, 0.0, force);
    let least = solve(&scene);
    let energy = |u: &[f64]| {
        // St. Venant-Kirchhoff, written out for one triangle after the other
        let (mesh, lame) = (scene.body().mesh(), scene.body().material().elastic());
        let of_cell = |cell: &[usize]| {
            let at = |k: usize, i: usize| mesh.position(cell[k])[i];
            let now = |k: usize, i: usize| at(k, i) + u[2 * cell[k] + i];
            let edges =
                |x: &dyn Fn(usize, usize) -> f64| [0, 1].map(|i| [1, 2].map(|k| x(k, i) - x(0, i)));
            let (natural, deformed) = (edges(&at), edges(&now));
            let twice = natural[0][0] * natural[1][1] - natural[0][1] * natural[1][0];
            let [[a, b], [c, d]] = natural;
            let inverse = [[d / twice, -b / twice], [-c / twice, a / twice]];
            let f = [0, 1].map(|i| {
                [0, 1].map(|j| (0..2).map(|k| deformed[i][k] * inverse[k][j]).sum::<f64>())
            });
            let e = |i: usize, j: usize| {
                let square: f64 = (0..2).map(|k| f[k][i] * f[k][j]).sum();
                0.5 * (square - f64::from(i == j))
            };
            let trace = e(0, 0) + e(1, 1);
            let square = e(0, 0).powi(2) + e(1, 1).powi(2) + 2.0 * e(0, 1).powi(2);
            0.5 * twice * 0.01 * (0.5 * lame.lambda * trace * trace + lame.mu * square)
        };
        let strain: f64 = mesh.cells().map(of_cell).sum();
        strain - -force * u[43]
    };
    let u = least.displacements();
    let at = energy(u);
    let held = |dof: usize| [0, 11, 22].contains(&(dof / 2));
    for seed in 1..20 {
        let push: Vec<f64> = (0..u.len())
            .map(|dof| (12.9898 * (dof + 100 * seed) as f64).sin().mul_add(43.758, 0.3).sin())
            .enumerate()
            .map(|(dof, x)| if held(dof) { 0.0 } else { x })
            .collect();
        let moved =
            |by: f64| -> Vec<f64> { u.iter().zip(&push).map(|(u, p)| u + by * p).collect() };
        let (ahead, behind) = (energy(&moved(1e-4)), energy(&moved(-1e-4)));
        assert!(ahead > at && behind > at, "seed {seed}");
        // the slope against the curvature: h/3 U'''/U'' apart from 0, not of the order of 1
        assert!((ahead - behind).abs() < 0.05 * (ahead + behind - 2.0 * at), "seed {seed}");
    }
}

/// The end of the beam turned by 90 degrees on a circular arc: all at once its cells turn inside
/// out, so the load must come on in steps; the result is that of many small ones.
#[test]
fn large_motions_are_brought_on_in_steps() {
    let turned = |node: usize, axis: Axis| {
        let arm = (node as f64 - 22.0) / 11.0 * 0.01; // nodes 11, 22, 33 from the middle
        move |t: f64| {
            let angle = PI / 2.0 * t;
            let displacement = match axis {
                Axis::X => {
                    0.1 * (angle.sin() / angle.max(1e-9) - 1.0) * f64::from(t > 0.0)
                        - arm * angle.sin()
                }
                _ => 0.1 * (1.0 - angle.cos()) / angle.max(1e-9) + arm * (angle.cos() - 1.0),
            };
            Prescribed { displacement, velocity: 0.0, acceleration: 0.0 }
        }
    };
    let mut phase = Phase::until(1.0).hold([1, 12, 23]);
    for node in [11, 22, 33] {
        for axis in [Axis::X, Axis::Y] {
            phase = phase.follow([node], axis, turned(node, axis));
        }
    }
    let scene = Scene::new(beam(Strain::Green, 0.0, 0.0).body().clone()).phase(phase);
    let bent = solve(&scene);
    println!("{bent}");
    let slowly = scene.equilibrium(&Statics { load_steps: 32, ..Statics::default() }).unwrap();
    assert_eq!((slowly.load_steps, slowly.failed_steps), (32, 0));
    for (a, b) in bent.displacements().iter().zip(slowly.displacements()) {
        assert!((a - b).abs() < 2e-13, "{a} {b}");
    }
    assert!((frequency(&bent) / frequency(&slowly) - 1.0).abs() < 5e-11);
}

#[test]
fn what_is_not_held_is_told() {
    let square = || {
        let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
        let body = Body::new(mesh, RUBBER).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
        Scene::new(body).gravity([1.0, -9.8])
    };
    for (phase, told) in [
        (
            Phase::until(1.0),
            ["moving along (1, 0)", "moving along (0, 1)", "turning about the point (0.15, 0.15)"]
                .as_slice(),
        ),
        (Phase::until(1.0).hold([4]), &["free for turning about the point (0.3, 0); loads"]),
        (Phase::until(1.0).hold_axes("left", [Axis::X]), &["free for moving along (0, 1); loads"]),
        (
            Phase::until(1.0)
                .hold_combination([(1, Axis::X, 1.0), (1, Axis::Y, -1.0)])
                .hold_axes([1], [Axis::X]),
            &["free for turning about the point (0, 0); loads"],
        ),
    ] {
        let message =
            square().phase(phase).equilibrium(&Statics::default()).unwrap_err().to_string();
        assert!(message.contains("= leaving the body free"), "{message}");
        told.iter().for_each(|told| assert!(message.contains(told), "{message}"));
    }
    for (bad, name) in [
        (Statics { rtol: 0.0, ..Statics::default() }, "statics.rtol = 0"),
        (Statics { load_steps: 0, ..Statics::default() }, "statics.load_steps = 0"),
        (Statics { load_steps: 100_001, ..Statics::default() }, "statics.load_steps = 100001"),
        (Statics { arc_steps: 100_001, ..Statics::default() }, "statics.arc_steps = 100001"),
        (Statics { max_iterations: 0, ..Statics::default() }, "statics.max_iterations = 0"),
        (Statics { min_load_step: f64::NAN, ..Statics::default() }, "statics.min_load_step = NaN"),
    ] {
        let message = square().phase(Phase::until(1.0)).equilibrium(&bad).unwrap_err().to_string();
        assert!(message.starts_with(name), "{message}");
    }
}

/// A row over two nodes and its multiplier: K u = f + A lambda, row by row.
#[test]
fn general_rows_and_their_forces() {
    let phase = Phase::until(1.0)
        .hold("left")
        .load([3], [2.0])
        .hold_combination([(5, Axis::X, 1.0), (6, Axis::X, 3.0)]);
    let linear = solve(&Scene::new(bar(Strain::Cauchy)).phase(phase.clone()));
    let u = linear.displacements();
    assert!((u[4] + 3.0 * u[5]).abs() < 1e-15);
    let k = bar(Strain::Cauchy).stiffness().to_dense();
    let [held, row] = linear.sample().multipliers[..] else { panic!("two rows") };
    let expected = [held, 0.0, 2.0, 0.0, row, 3.0 * row];
    for i in 0..6 {
        let force: f64 = (0..6).map(|j| k[(i, j)] * u[j]).sum();
        // round-off of forces of some newtons
        assert!((force - expected[i]).abs() < 1e-13, "node {}: {force} {}", i + 1, expected[i]);
    }
    // small loads leave no difference between the measures of strain but the square of strain
    let scale = 1e-6;
    let phase = Phase::until(1.0)
        .hold("left")
        .load([3], [2.0 * scale])
        .hold_combination([(5, Axis::X, 1.0), (6, Axis::X, 3.0)]);
    let green = solve(&Scene::new(bar(Strain::Green)).phase(phase));
    for (found, expected) in green.sample().multipliers.iter().zip([held, row]) {
        assert!((found / scale - expected).abs() < 1e-5, "{found} {expected}");
    }
}

/// Turek and Hron's flag under its weight with 35 x 2 linear cells, clamped at a straight edge: an
/// independent program, with the arc as clamp, finds -28.98e-3 m; the clamps differ by 0.25 %.
#[test]
fn the_flag_of_turek_and_hron() {
    let mesh = Mesh::rectangle([0.35, 0.02], [36, 3], Cells::Triangles).unwrap();
    let mu = 0.5e6;
    let flag = Material { density: 1000.0, young: 2.8 * mu, poisson: 0.4, viscosity: 0.0 };
    let body = Body::new(mesh, flag).thickness(1.0).strain(Strain::Green).build().unwrap();
    let scene = Scene::new(body).gravity([0.0, -2.0]).phase(Phase::until(1.0).hold("left"));
    let equilibrium = solve(&scene);
    let tip = equilibrium.displacements()[2 * 71 + 1];
    assert!((tip / -28.98e-3 - 1.0).abs() < 0.02, "{tip}");
    assert!(equilibrium.iterations < 20 && equilibrium.load_steps == 1, "{equilibrium}");
}

/// An actuator of force f pulls the end of a bar, of stiffness k = E A/L = 100 N/m, towards a point that is
/// held, against a spring of stiffness c: u = f/(k + c). In steps or at once.
#[test]
fn actuators_pull_as_in_the_textbook() {
    let body = Body::new(Mesh::bar(0.1, 6).unwrap(), SOFT).strain(Strain::Cauchy).area(2e-4);
    let body = body.point_mass("hook", [0.15], 0.01).build().unwrap();
    for (c, f) in [(0.0, 0.3), (25.0, 0.3), (25.0, -1.0)] {
        let scene = Scene::new(body.clone())
            .spring(Spring::between("right", "hook").named("A1").stiffness(c))
            .phase(Phase::until(1.0).hold("left").hold("hook").actuate(["A1"], -f));
        for load_steps in [1, 7] {
            let statics = Statics { load_steps, ..Statics::default() };
            let pulled = scene.equilibrium(&statics).unwrap();
            let found = pulled.displacements()[5];
            // forces balanced to 1e-10 of f, and one Newton step more: round-off
            assert!((found - f / (100.0 + c)).abs() < 1e-13, "{c} {f} {load_steps}: {found}");
            assert_eq!((pulled.load_steps, pulled.failed_steps), (load_steps, 0));
        }
    }
}

/// A plate that has come down by 4 cm presses the end of a bar by 2 cm less what its own spring gives way:
/// u = -c d/(k + c). It stands there: its speed, damping and drag are those of no motion.
#[test]
fn obstacles_press_from_where_they_have_come_to() {
    let body = Body::new(Mesh::bar(0.1, 6).unwrap(), SOFT)
        .strain(Strain::Cauchy)
        .area(2e-4)
        .build()
        .unwrap();
    for (damping, adhesion) in [(0.0, true), (50.0, true), (50.0, false)] {
        let plate = Obstacle::half_plane([0.12], [-1.0]).velocity([-0.04]).stiffness(300.0);
        let plate = plate.damping(damping).tangential_damping(damping).adhesion(adhesion);
        let scene = Scene::new(body.clone()).obstacle(plate).phase(Phase::until(1.0).hold("left"));
        for load_steps in [1, 8] {
            let statics = Statics { load_steps, ..Statics::default() };
            let pressed = scene.equilibrium(&statics).unwrap();
            let (found, exact) = (pressed.displacements()[5], -300.0 * 0.02 / 400.0);
            assert!((found - exact).abs() < 1e-13, "{damping} {adhesion} {load_steps}: {found}");
            // the plate has done what bar and contact have stored; nothing was stored at the start
            let energy = pressed.sample().energy;
            let stored = 0.5 * 100.0 * exact.powi(2) + 0.5 * 300.0 * (0.02 + exact).powi(2);
            assert!((energy.strain + energy.contact - stored).abs() < 1e-13);
            assert!((energy.supplied - stored).abs() < 1e-13, "{}", energy.supplied);
        }
    }
}

/// A tendon that pulls the end of a beam to a hook above its clamp turns a cell inside out at 0.88 N, whatever
/// force it is asked for: the search comes so far, in steps of a thousandth of that force at the least.
#[test]
fn actuators_come_on_in_steps_up_to_what_the_body_bears() {
    let mesh = Mesh::rectangle([0.1, 0.02], [11, 3], Cells::Triangles).unwrap();
    let rubber = Material { young: 1e5, viscosity: 4.0, ..RUBBER };
    let body = Body::new(mesh, rubber).thickness(0.01).strain(Strain::Green);
    let body = body.point_mass("hook", [0.02, 0.1], 0.1).build().unwrap();
    let pulled = |force: f64| {
        let phase = Phase::until(1.0).hold("left").hold("hook").actuate(["tendon"], -force);
        let tendon = Spring::between([22], "hook").named("tendon");
        Scene::new(body.clone()).spring(tendon).phase(phase).equilibrium(&Statics::default())
    };
    assert!(pulled(0.87).is_ok());
    for force in [2.0, 10.0, 30.0] {
        let Err(Error::Statics(failure)) = pulled(force) else { panic!("{force} N") };
        let [reached, tried] = [failure.fraction, failure.tried].map(|part| part * force);
        println!("{force} N: between {reached} and {tried} N");
        // bisection: the step that fails is between one and two thousandths
        assert!(tried - reached < 2e-3 * force, "{failure}");
        assert!(reached < 0.887 && tried > 0.882, "{failure}");
    }
}

//! Bodies in pieces that nothing joins, and nodes that belong to no cell: each piece does what it would do
//! alone. Masses, spectrum, statics and dynamics against closed forms.

use std::f64::consts::PI;

use pliant::mesh::CellKind;
use pliant::{
    Body, Cells, Inertia, Material, Mesh, Method, Phase, Sampling, Scene, Settings, Stability,
    Statics, Strain,
};

const SOFT: Material = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };
/// E A (N), cell length (m), speed of waves (m/s).
const STIFFNESS: f64 = 10.0;
const CELL: f64 = 0.02;
const SPEED: f64 = 7.0710678118654755;

/// Two bars on a line, of 6 and of 4 nodes, and a point mass of 3 g: nodes 1 to 6, 7 to 10 and 11.
fn pieces(inertia: Inertia) -> Body {
    let at = |from: f64, count: usize| (0..count).map(move |k| from + CELL * k as f64);
    let positions = at(0.0, 6).chain(at(0.2, 4)).collect();
    let cells = (0..5).chain(6..9).flat_map(|node| [node, node + 1]).collect();
    let mesh = Mesh::new(1, positions, CellKind::Segment, cells).unwrap();
    let body = Body::new(mesh, SOFT).strain(Strain::Cauchy).area(2e-4).inertia(inertia);
    body.point_mass("bob", [0.4], 0.003).build().unwrap()
}

/// Frequency (rad/s) of mode `k` of a free bar of `cells` linear cells with consistent inertia: omega^2 =
/// 6 (c/h)^2 (1 - cos t) / (2 + cos t), t = k pi / cells, with the shape cos(t j).
fn free_bar(k: usize, cells: usize) -> f64 {
    let cos = (PI * k as f64 / cells as f64).cos();
    SPEED / CELL * (6.0 * (1.0 - cos) / (2.0 + cos)).sqrt()
}

#[test]
fn masses_are_those_of_the_pieces() {
    for inertia in [Inertia::Consistent, Inertia::Lumped] {
        let body = pieces(inertia);
        // rho A h a cell, half of it at each end
        for (node, mass) in body.nodal_masses().iter().enumerate() {
            let exact = match node + 1 {
                1 | 6 | 7 | 10 => 0.002,
                11 => 0.003,
                _ => 0.004,
            };
            assert!((mass - exact).abs() < 1e-17, "node {}: {mass}", node + 1);
        }
        assert!((body.mass() - (0.02 + 0.012 + 0.003)).abs() < 1e-16);
        assert!((body.volume() - 8.0 * CELL * 2e-4).abs() < 1e-19);
    }
}

/// Three rigid motions are told apart from vibrations: the slowest one is that of the longer bar, the
/// fastest that of cells which all swing against each other.
#[test]
fn the_spectrum_is_that_of_all_pieces() {
    let spectrum =
        |phase: Phase| Scene::new(pieces(Inertia::Consistent)).phase(phase).spectrum().unwrap()[0];
    let free = spectrum(Phase::until(1.0));
    let (lowest, exact) = (free.lowest_frequency.unwrap(), free_bar(1, 5));
    println!("{:e} {:e}", lowest / exact - 1.0, free.highest_frequency / free_bar(5, 5) - 1.0);
    // subspace iteration stops when two values agree to 1e-3: the last one is good to 6e-6 here
    assert!((lowest / exact - 1.0).abs() < 2e-5, "{lowest} {exact}");
    let (highest, exact) = (free.highest_frequency, free_bar(5, 5));
    assert!(highest < exact * (1.0 + 1e-12) && highest > 0.95 * exact, "{highest} {exact}");
    // with the longer bar held as a whole the other one remains
    let other = spectrum(Phase::until(1.0).hold([1, 2, 3, 4, 5, 6]));
    let (lowest, exact) = (other.lowest_frequency.unwrap(), free_bar(1, 3));
    assert!((lowest / exact - 1.0).abs() < 2e-5, "{lowest} {exact}");
    // nothing vibrates where the bars are held and the point mass alone is free
    assert_eq!(
        spectrum(Phase::until(1.0).hold((1..=10).collect::<Vec<_>>())).lowest_frequency,
        None
    );
}

#[test]
fn equilibria_are_those_of_the_pieces_alone() {
    let scene = |phase: Phase| Scene::new(pieces(Inertia::Consistent)).gravity([9.8]).phase(phase);
    let held = || Phase::until(1.0).hold([1]).hold([10]).hold("bob").load([6], [0.3]);
    let equilibrium = scene(held()).equilibrium(&Statics::default()).unwrap();
    let u = equilibrium.displacements();
    for (node, u) in u[..6].iter().enumerate() {
        // F x/(E A) + rho g (L x - x^2/2)/E
        let x = CELL * node as f64;
        let exact = 0.3 * x / STIFFNESS + 9.8e3 * (0.1 * x - 0.5 * x * x) / 5e4;
        assert!((u - exact).abs() < 3e-17, "node {}: {u}", node + 1);
    }
    for (node, u) in u[..10].iter().enumerate().skip(6) {
        // standing on its end: compressed towards it
        let x = CELL * (9 - node) as f64;
        let exact = 9.8e3 * (0.06 * x - 0.5 * x * x) / 5e4;
        assert!((u - exact).abs() < 1e-15, "node {}: {u}", node + 1);
    }
    assert_eq!(u[10], 0.0);
    // supports carry load and weights, each its own
    let exact = [-0.3 - 0.02 * 9.8, -0.012 * 9.8, -0.003 * 9.8];
    for (found, exact) in equilibrium.sample().multipliers.iter().zip(exact) {
        assert!((found - exact).abs() < 3e-15, "{found} {exact}");
    }
    // a bar held at one end, in its lowest mode: t = pi / (2 cells), the longer one
    let cos = (PI / 10.0).cos();
    let omega = SPEED / CELL * (6.0 * (1.0 - cos) / (2.0 + cos)).sqrt();
    let Stability::Stable { frequency } = equilibrium.stability else { panic!("{equilibrium}") };
    assert!((2.0 * PI * frequency / omega - 1.0).abs() < 1e-8, "{frequency}");
    // what is left free is told piece by piece
    for (phase, told) in [
        (Phase::until(1.0).hold([10]).hold("bob"), "the piece with node 1 moving along (1)"),
        (Phase::until(1.0).hold([1]).hold("bob"), "the piece with node 7 moving along (1)"),
        (Phase::until(1.0).hold([1]).hold([10]), "the piece with node 11 moving along (1)"),
    ] {
        let message = scene(phase).equilibrium(&Statics::default()).unwrap_err().to_string();
        assert!(message.contains(told) && message.matches("piece").count() == 2, "{message}");
    }
}

/// Each piece in the plane has its own three rigid motions, with its own centre.
#[test]
fn pieces_in_the_plane_turn_about_their_own_centres() {
    let square = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles).unwrap();
    let count = square.node_count();
    let mut positions = square.positions().to_vec();
    positions.extend(square.positions().iter().map(|x| x + 0.3));
    let mut cells: Vec<usize> = square.cells().flatten().copied().collect();
    cells.extend(cells.clone().iter().map(|node| node + count));
    let mesh = Mesh::new(2, positions, CellKind::Triangle, cells).unwrap();
    let scene = |strain, phase: Phase| {
        let body = Body::new(mesh.clone(), SOFT).thickness(0.01).strain(strain);
        Scene::new(body.build().unwrap()).phase(phase)
    };
    let free = scene(Strain::Cauchy, Phase::until(1.0).load([1], [0.1, 0.0]));
    let message = free.equilibrium(&Statics::default()).unwrap_err().to_string();
    for told in [
        "the piece with node 1 turning about the point (0.05, 0.05)",
        "the piece with node 10 turning about the point (0.35, 0.35)",
    ] {
        assert!(message.contains(told), "{message}");
    }
    assert_eq!(message.matches("moving along").count(), 4, "{message}");
    // spinning at different rates in opposite ways, free of forces: angular momenta stay what they are
    let spin = |x: &[f64]| match x[0] < 0.2 {
        true => vec![-2.0 * (x[1] - 0.05), 2.0 * (x[0] - 0.05)],
        false => vec![3.0 * (x[1] - 0.35), -3.0 * (x[0] - 0.35)],
    };
    let spinning = scene(Strain::Green, Phase::until(0.5)).initial_velocity(spin);
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    let motion = spinning.simulate(&settings, &Sampling::phase_ends()).unwrap();
    let masses = motion.body().nodal_masses();
    let turned = |piece: usize| {
        let sample = motion.last();
        let nodes = count * piece..count * (piece + 1);
        let centre = 0.05 + 0.3 * piece as f64;
        let (mut along, mut across) = (0.0, 0.0);
        for node in nodes {
            let arm = [0, 1].map(|i| mesh.position(node)[i] - centre);
            let now = [0, 1].map(|i| arm[i] + sample.u[2 * node + i]);
            along += masses[node] * (arm[0] * now[0] + arm[1] * now[1]);
            across += masses[node] * (arm[0] * now[1] - arm[1] * now[0]);
        }
        across.atan2(along)
    };
    // by omega t, less what the centrifugal force widens: (rho omega^2 r^2/E) of it, 1e-3
    println!("{} {}", turned(0), turned(1));
    assert!((turned(0) - 1.0).abs() < 2e-4 && (turned(1) + 1.5).abs() < 8e-4);
}

/// The longer bar swings in its first mode, the shorter one flies, the point mass falls: in one run.
#[test]
fn pieces_move_as_they_would_alone() {
    let swing = |x: f64| 1e-3 * (PI * x / 0.1).cos();
    let scene = Scene::new(pieces(Inertia::Consistent))
        .gravity([-9.8])
        .initial_displacement(move |x| vec![if x[0] < 0.15 { swing(x[0]) } else { 0.0 }])
        .initial_velocity(|x| vec![if x[0] > 0.15 && x[0] < 0.35 { 0.5 } else { 0.0 }])
        .phase(Phase::until(0.1));
    let omega = free_bar(1, 5);
    for method in Method::ALL {
        let settings = Settings { method, rtol: 1e-8, ..Settings::default() };
        let motion = scene.simulate(&settings, &Sampling::every(0.01)).unwrap();
        let mut worst = [0.0_f64; 3];
        for sample in motion.samples() {
            let (t, fall) = (sample.time, -4.9 * sample.time.powi(2));
            for (node, u) in sample.u.iter().enumerate() {
                let (piece, exact) = match node {
                    0..6 => (0, fall + swing(CELL * node as f64) * (omega * t).cos()),
                    6..10 => (1, fall + 0.5 * t),
                    _ => (2, fall),
                };
                worst[piece] = worst[piece].max((u - exact).abs());
            }
        }
        println!("{method}: {worst:?}");
        // 30 swings of 1 mm, measured: 5.3e-8 m by central differences, of order 2, 1.4e-8 m by BDF, 6e-9 m
        // and less by the others; flights are parabolas, which all follow to 2e-10 m and better
        let bound = match method {
            Method::CentralDifference => 1.5e-7,
            Method::CvodeBdf => 4e-8,
            _ => 2e-8,
        };
        assert!(worst[0] < bound, "{method}: {worst:?}");
        assert!(worst[1..].iter().all(|&worst| worst < 1e-9), "{method}: {worst:?}");
    }
}

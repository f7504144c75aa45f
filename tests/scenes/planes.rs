//! Planes of symmetry: parts of bodies against the whole ones, and planes that lie askew.

use pliant::{
    Body, Cells, Material, Mesh, Method, Phase, Sampling, Scene, Settings, SolidCells, Statics,
    Strain, Trajectory, Viscosity,
};

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 100.0 };
/// Pull on each node of an end (N).
const PULL: f64 = 2.0;

fn body(mesh: Mesh) -> Body {
    let body = Body::new(mesh, RUBBER).thickness(0.01).strain(Strain::Green);
    body.viscosity(Viscosity::Objective).build().unwrap()
}

fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    [cosine * x - sine * y, sine * x + cosine * y]
}

/// A plate of 20 cm x 10 cm, pulled at both ends.
fn plate() -> Scene {
    let mesh = Mesh::rectangle([0.2, 0.1], [9, 5], Cells::Rectangles).unwrap();
    let pull = Phase::until(0.02).load("left", [-PULL, 0.0]).load("right", [PULL, 0.0]);
    Scene::new(body(mesh)).phase(pull)
}

/// Its upper right quarter, turned by `angle`; half of the node on the plane belongs to it.
fn quarter(angle: f64) -> Scene {
    let mesh = Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Rectangles).unwrap();
    let mesh = mesh.mapped(|x| turned([x[0], x[1]], angle)).unwrap();
    let phase = Phase::until(0.02)
        .symmetry("left", turned([2.0, 0.0], angle))
        .symmetry("bottom", turned([0.0, 1.0], angle))
        .symmetry([1], turned([-1.0, 0.0], angle)) // what "left" says of it already
        .load([5], turned([PULL / 2.0, 0.0], angle))
        .load([10, 15], turned([PULL, 0.0], angle));
    Scene::new(body(mesh)).phase(phase)
}

/// Largest distance between displacements of the quarter, turned by `angle`, and those of other nodes,
/// as part of the largest.
fn off(quarter: &[f64], angle: f64, other: impl Fn(usize) -> [f64; 2]) -> f64 {
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (node, u) in quarter.chunks(2).enumerate() {
        let (u, other) = (turned([u[0], u[1]], -angle), other(node));
        worst = worst.max((u[0] - other[0]).hypot(u[1] - other[1]));
        largest = largest.max(other[0].hypot(other[1]));
    }
    worst / largest
}

fn run(scene: &Scene, method: Method, rtol: f64) -> Trajectory {
    let settings = Settings { method, rtol, ..Settings::default() };
    scene.simulate(&settings, &Sampling::phase_ends()).unwrap()
}

/// A quarter between two planes moves as it does in the whole plate, also if both planes lie askew, as
/// general rows, by every method.
#[test]
fn a_quarter_moves_as_the_whole_plate() {
    for method in Method::ALL {
        let (whole, rtol) = (run(&plate(), method, 1e-7), 1e-7);
        let in_whole = |node: usize| {
            let node = (node / 5 + 2) * 9 + node % 5 + 4;
            [whole.last().u[2 * node], whole.last().u[2 * node + 1]]
        };
        for angle in [0.0, 0.5] {
            let part = run(&quarter(angle), method, rtol);
            let off = off(&part.last().u, angle, in_whole);
            println!("{method}, turned by {angle}: off by {off:.1e}");
            assert!(off < 1e-5, "{method}, {angle}: {off:e}");
        }
    }
}

/// The quarter of a plate in equilibrium: its planes lie askew, and its end is clamped, so that the node at the
/// corner has all that a plane asks of it already.
#[test]
fn a_plane_may_end_at_a_clamp() {
    let half = |angle: f64| {
        let mesh = Mesh::rectangle([0.2, 0.05], [9, 3], Cells::Rectangles).unwrap();
        let mesh = mesh.mapped(|x| turned([x[0], x[1]], angle)).unwrap();
        let phase = Phase::until(1.0)
            .hold("left")
            .symmetry("bottom", turned([0.0, 1.0], angle))
            .load([9], turned([PULL / 2.0, 0.0], angle))
            .load([18, 27], turned([PULL, 0.0], angle));
        Scene::new(body(mesh)).phase(phase).equilibrium(&Statics::default()).unwrap()
    };
    let mesh = Mesh::rectangle([0.2, 0.1], [9, 5], Cells::Rectangles).unwrap();
    let pull = Phase::until(1.0).hold("left").load("right", [PULL, 0.0]);
    let whole = Scene::new(body(mesh)).phase(pull).equilibrium(&Statics::default()).unwrap();
    let in_whole = |node: usize| {
        let node = node + 18;
        [whole.displacements()[2 * node], whole.displacements()[2 * node + 1]]
    };
    for angle in [0.0, 0.5, std::f64::consts::FRAC_PI_2] {
        let off = off(half(angle).displacements(), angle, in_whole);
        println!("turned by {angle}: off by {off:.1e}");
        assert!(off < 1e-14, "{angle}: {off:e}");
    }
}

/// Half of a clamped block in space bends as the whole, to round-off, with half of its mass, energy and reaction: what is told
/// is of the part that is computed.
#[test]
fn half_a_block_bends_as_the_whole() {
    let solve = |width: f64, nodes: usize, shear: f64| {
        let (size, grading) = ([0.1, width, 0.03], [3.0, 1.0, 1.0]);
        let mesh = Mesh::graded_cuboid(size, [5, nodes, 3], grading, SolidCells::Hexahedra20);
        let body = Body::new(mesh.unwrap(), RUBBER).strain(Strain::Green).build().unwrap();
        let phase = Phase::until(1.0).hold("left").load_total("right", [0.0, 0.0, shear]);
        let phase = if nodes == 3 { phase.symmetry("front", [0.0, 1.0, 0.0]) } else { phase };
        Scene::new(body).phase(phase).equilibrium(&Statics::default()).unwrap()
    };
    let (whole, half) = (solve(0.04, 5, -0.8), solve(0.02, 3, -0.4));
    let [of_whole, of_half] = [&whole, &half].map(|found| found.trajectory().body().mesh());
    let mut worst = 0.0_f64;
    for node in 0..of_half.node_count() {
        let x = of_half.position(node);
        // the plane lies in the middle of the whole
        let at = [x[0], x[1] + 0.02, x[2]];
        let is_same = |other: &usize| {
            of_whole.position(*other).iter().zip(at).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        let same = (0..of_whole.node_count()).find(is_same).unwrap();
        for axis in 0..3 {
            let u = [(&half, node), (&whole, same)];
            let [a, b] = u.map(|(found, node)| found.displacements()[3 * node + axis]);
            worst = worst.max((a - b).abs());
        }
    }
    let largest = whole.displacements().iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    println!("off by {:.1e} of {largest:.1e} m", worst / largest);
    assert!(largest > 0.003 && worst < 1e-13 * largest, "{worst:e} {largest:e}");
    let mass = [&half, &whole].map(|found| found.trajectory().body().mass());
    let energy = [&half, &whole].map(|found| found.sample().energy.strain);
    let pull = [&half, &whole]
        .map(|found| found.trajectory().constraint_force(found.sample(), "left").unwrap()[2]);
    for [half, whole] in [mass, energy, pull] {
        assert!((2.0 * half / whole - 1.0).abs() < 1e-11, "{half} {whole}");
    }
}

/// What two sets of nodes demand alike of a corner counts once: the same digits as without.
#[test]
fn holds_may_overlap_in_a_corner() {
    let mesh = Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Rectangles).unwrap();
    let scene = |phase: Phase| Scene::new(body(mesh.clone())).phase(phase);
    let once = Phase::until(0.02).move_nodes([1, 2, 3, 4, 5, 6, 11], [0.01, 0.0]);
    let twice = Phase::until(0.02).move_nodes("bottom", [0.01, 0.0]);
    let twice = twice.move_nodes("left", [0.01, 0.0]).hold_axes([1], [pliant::Axis::Y]);
    let [once, twice] = [once, twice].map(|phase| run(&scene(phase), Method::Auto, 1e-6));
    assert_eq!(once.last().u, twice.last().u);
    let [a, b] =
        [&once, &twice].map(|motion| motion.constraint_force(motion.last(), "all").unwrap());
    assert_eq!(a, b);
}

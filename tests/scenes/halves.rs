//! Halves of symmetric scenes against the whole ones.

use pliant::body::BodyBuilder;
use pliant::{
    Axis, Body, CellSelection, Cells, Inertia, InputError, Material, Mesh, Obstacle, Phase,
    Sampling, Scene, Settings, SolidCells, Spring,
};

const RUBBER: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 20.0 };
const TIGHT: f64 = 1e-9;

/// The largest distance (m) of nodes of the half, which are at the same undeformed places, from those of the whole, and the largest
/// displacement (m), at the end of both.
fn apart(scene: &Scene, axis: Axis) -> [f64; 2] {
    let half = scene.symmetric_half(axis).unwrap();
    let settings = Settings { rtol: TIGHT, max_steps: 200_000, ..Settings::default() };
    let run = |scene: &Scene| scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
    let [whole, own] = [scene, &half].map(run);
    let (d, mesh) = (scene.body().dimension(), scene.body().mesh());
    let place = |mesh: &Mesh, node: usize| mesh.position(node).to_vec();
    let [mut far, mut moved] = [0.0_f64; 2];
    for node in 0..half.body().mesh().node_count() {
        let x = place(half.body().mesh(), node);
        let same = (0..mesh.node_count())
            .find(|&other| place(mesh, other).iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-12));
        let same = same.unwrap();
        for i in 0..d {
            let [a, b] = [own.last().u[node * d + i], whole.last().u[same * d + i]];
            far = far.max((a - b).abs());
            moved = moved.max(b.abs());
        }
    }
    println!("{far:.2e} of {moved:.2e} m");
    [far, moved]
}

/// Both agree as far as the integration is exact: to some errors of its steps, which are not the same ones (measured: 6e-10).
#[track_caller]
fn agrees(scene: &Scene, axis: Axis) {
    let [far, moved] = apart(scene, axis);
    assert!(far < 10.0 * TIGHT * moved, "{far:e} of {moved:e}");
}

fn block(change: impl FnOnce(BodyBuilder) -> BodyBuilder) -> Body {
    let mesh = Mesh::rectangle([0.2, 0.1], [5, 4], Cells::Rectangles).unwrap();
    change(Body::new(mesh, RUBBER).thickness(0.05)).build().unwrap()
}

/// Falls 1 mm onto the floor `below` it, loaded by forces on nodes, on all nodes of a side together, by a traction and a pressure.
fn pressed(body: Body, floor: Obstacle) -> Scene {
    Scene::new(body)
        .gravity([0.0, -9.8])
        .obstacle(floor)
        .phase(
            Phase::until(0.05)
                .load([18], [0.0, -1.0])
                .load_total("top", [0.0, -2.0])
                .load_with("bottom", |t| [0.0, 2.0 * t])
                .traction("top", [0.0, -100.0])
                .pressure_on("left", 200.0)
                .pressure_on("right", 200.0),
        )
        .phase(Phase::until(0.1).hold([18]))
}

#[test]
fn a_block_on_a_floor_moves_as_its_half() {
    let floor = || Obstacle::half_plane([0.0, -0.001], [0.0, 1.0]);
    let per_node = floor().stiffness(2000.0).damping(2.0).friction_coefficient(0.4);
    agrees(&pressed(block(|body| body), per_node), Axis::X);
    let per_area = floor().stiffness_density(1e6).damping(1e3).friction_coefficient(0.4);
    let stiff = Material { young: 5e5, ..RUBBER };
    let middle = CellSelection::inside([0.04, 0.0], [0.16, 0.1]);
    let skinned = |body: BodyBuilder| body.region(middle, stiff).inertia(Inertia::Lumped);
    agrees(&pressed(block(skinned), per_area), Axis::X);
}

/// A beam in space that is held at both ends and carries a weight in its middle, of hexahedra without mid nodes and with them, cut along
/// two axes.
#[test]
fn a_beam_in_space_moves_as_its_half() {
    let mesh = Mesh::cuboid([0.2, 0.04, 0.02], [3, 3, 2], SolidCells::Hexahedra).unwrap();
    for mesh in [mesh.clone(), mesh.quadratic().unwrap()] {
        let body =
            Body::new(mesh, RUBBER).point_mass("weight", [0.1, 0.02, 0.05], 0.01).build().unwrap();
        let scene = Scene::new(body)
            .gravity([0.0, 0.0, -9.8])
            .initial_velocity(|x| vec![0.1 * (x[0] - 0.1), 0.0, 0.2])
            .phase(
                Phase::until(0.01)
                    .hold("left")
                    .hold("right")
                    .load_total("top", [0.0, 0.0, -0.1])
                    .load("weight", [0.0, 0.0, 0.2]),
            );
        agrees(&scene, Axis::X);
        agrees(&scene, Axis::Y);
    }
}

/// What the half lacks is refused by its name.
#[test]
fn what_is_not_symmetric_is_refused() {
    let floor = || Obstacle::half_plane([0.0, -0.001], [0.0, 1.0]).stiffness(2000.0);
    let scene = || pressed(block(|body| body), floor());
    let phase = || Phase::until(0.1);
    let plain = || Scene::new(block(|body| body));
    let mesh = Mesh::rectangle([0.2, 0.1], [4, 4], Cells::Rectangles).unwrap();
    let odd = Body::new(mesh, RUBBER).thickness(0.05).build().unwrap();
    let left = CellSelection::inside([0.0, 0.0], [0.05, 0.1]);
    let patched = block(|body| body.region(left, Material { young: 1e6, ..RUBBER }));
    let askew = Obstacle::half_plane([0.0, -0.1], [0.1, 1.0]).stiffness(100.0);
    let ball = Obstacle::disc([0.0, -0.1], 0.05).stiffness(100.0).named("ball");
    let spring = Spring::between([1], [5]).stiffness(1.0);
    let cases: [(Scene, &[&str]); 12] = [
        (Scene::new(odd).phase(phase()), &["cell = 2", "lies across"]),
        (Scene::new(patched).phase(phase()), &["material of cell = 1", "not symmetric"]),
        (
            plain().gravity([1.0, 0.0]).phase(phase()),
            &["gravity of phase \"phase 1\"", "x = 0.1 m"],
        ),
        (plain().phase(phase().hold("left")), &["held and moved nodes", "node 1 x"]),
        (
            plain().phase(phase().move_nodes("left", [0.1, 0.0]).move_nodes("right", [0.1, 0.0])),
            &["moved nodes"],
        ),
        (plain().phase(phase().load([20], [0.0, 1.0])), &["loads of phase"]),
        (plain().phase(phase().pressure_on("left", 10.0)), &["pressure on faces", "left"]),
        (plain().spin([1.0]).phase(phase()), &["initial velocities = of node 1"]),
        (plain().obstacle(askew).phase(phase()), &["obstacle", "floor"]),
        (scene().obstacle(ball), &["obstacle", "ball"]),
        (plain().spring(spring).phase(phase()), &["springs = 1", "not known"]),
        (plain().obstacle(floor().velocity([0.1, 0.0])).phase(phase()), &["obstacle", "floor"]),
    ];
    for (number, (scene, parts)) in cases.into_iter().enumerate() {
        let told = refusal(&scene, Axis::X);
        assert!(parts.iter().all(|part| told.contains(part)), "{number}: {told}");
    }
    assert!(refusal(&plain().phase(phase()), Axis::Z).contains("axis of symmetry"));
    let bent =
        block(|body| body).mesh().clone().mapped(|x| [x[0], x[1] + 0.1 * x[0] * x[0]]).unwrap();
    let bent = Scene::new(Body::new(bent, RUBBER).thickness(0.05).build().unwrap()).phase(phase());
    assert!(refusal(&bent, Axis::X).contains("mesh along x"));
}

fn refusal(scene: &Scene, axis: Axis) -> String {
    let error: InputError = scene.symmetric_half(axis).unwrap_err();
    println!("{error}");
    error.to_string()
}

/// A half on a finer mesh is that of the finer mesh: the cut stays one.
#[test]
fn halves_can_be_divided() {
    let scene = Scene::new(block(|body| body)).phase(Phase::until(0.1));
    let [one, other] = [
        scene.symmetric_half(Axis::X).unwrap().halved().unwrap(),
        scene.halved().unwrap().symmetric_half(Axis::X).unwrap(),
    ];
    let boundary = |scene: &Scene| scene.body().mesh().boundary_faces().len();
    assert_eq!(boundary(&one), boundary(&other));
    assert_eq!(boundary(&one), 2 * (2 + 2 + 3));
}

//! Sections of scenes that are the same all along an axis, against the scenes in space and closed forms.

use pliant::{
    Axis, Body, CellSelection, Cells, InputError, Law, Material, Mesh, Obstacle, Phase, Sampling,
    Scene, Selection, Settings, SolidCells, Spring, Statics,
};

const RUBBER: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 20.0 };
const TIGHT: f64 = 1e-9;
const SIZE: [f64; 3] = [0.2, 0.1, 0.05];

/// The largest distance (m) of nodes of the section from those in their places in space, and the largest displacement (m), at the end.
fn apart(scene: &Scene, axis: Axis) -> [f64; 2] {
    let plane = scene.in_plane(axis).unwrap();
    let settings = Settings { rtol: TIGHT, max_steps: 200_000, ..Settings::default() };
    let run = |scene: &Scene| scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
    let [space, own] = [scene, &plane].map(run);
    let axes = [[1, 2], [0, 2], [0, 1]][axis.index()];
    let (mesh, section) = (scene.body().mesh(), plane.body().mesh());
    let [mut far, mut moved] = [0.0_f64; 2];
    for node in 0..mesh.node_count() {
        let x = axes.map(|i| mesh.position(node)[i]);
        let is_there = |other: &usize| {
            section.position(*other).iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        let place = (0..section.node_count()).find(is_there).unwrap();
        for (k, i) in axes.into_iter().enumerate() {
            let [a, b] = [own.last().u[2 * place + k], space.last().u[3 * node + i]];
            far = far.max((a - b).abs());
            moved = moved.max(b.abs());
        }
    }
    println!("{far:.2e} of {moved:.2e} m");
    [far, moved]
}

fn block(nodes: [usize; 3], cells: SolidCells) -> Mesh {
    Mesh::cuboid(SIZE, nodes, cells).unwrap()
}

/// A section of a block, across y, that falls onto a floor, sheared on top and pressed from both sides; its front and back are held.
fn pressed(body: Body, floor: Obstacle) -> Scene {
    Scene::new(body)
        .gravity([0.0, 0.0, -9.8])
        .initial_velocity(|x| vec![0.1 * x[2], 0.0, -0.05])
        .obstacle(floor.velocity([0.01, 0.0, 0.0]))
        .phase(
            Phase::until(0.05)
                .hold_axes("front", [Axis::Y])
                .symmetry("back", [0.0, -1.0, 0.0])
                .load_total("top", [1.0, 0.0, -0.5])
                .load_with("left", |t| [0.0, 0.0, 2.0 * t])
                .traction("right", [0.0, 0.0, -100.0])
                .pressure_on("left", 200.0)
                .pressure_on("right", 100.0),
        )
        .phase(
            Phase::until(0.1)
                .hold_axes(
                    Selection::Box { min: vec![-1.0; 3], max: vec![0.19, 1.0, 1.0] },
                    [Axis::Y],
                )
                .gravity([1.0, 0.0, -5.0])
                .rotate("right", [0.2, 0.0, 0.02], [0.0, 1.0, 0.0]),
        )
}

/// In plane strain hexahedra that are the same all along an axis are quadrilaterals: both agree to some errors of the steps (measured:
/// 6e-10, of several layers and materials, too).
#[test]
fn plane_strain_is_the_block_between_held_ends() {
    let floor = || Obstacle::half_plane([0.0, 0.0, -0.0005], [0.0, 0.0, 1.0]);
    let per_node = floor().stiffness(500.0).damping(0.5).friction_coefficient(0.4);
    let body = Body::new(block([5, 2, 3], SolidCells::Hexahedra), RUBBER).build().unwrap();
    agrees(&pressed(body, per_node.clone()));
    let stiff = Material { young: 5e5, ..RUBBER }.law(Law::NeoHookean);
    let root = CellSelection::inside([0.0; 3], [0.1, 0.1, 0.05]);
    let body = Body::new(block([3, 3, 2], SolidCells::Hexahedra27), RUBBER).region(root, stiff);
    let scene = |body: Body| {
        Scene::new(body)
            .gravity([0.0, 0.0, -9.8])
            .phase(Phase::until(0.05).hold("left").hold_axes("all", [Axis::Y]))
            .phase(
                Phase::until(0.1).hold_axes("all", [Axis::Y]).traction("right", [50.0, 0.0, 20.0]),
            )
    };
    agrees(&scene(body.build().unwrap()));
    // a box that goes on beyond the ends, and two pins along the axis
    let box_below = Obstacle::box_between([-1.0, -0.2, -0.1], [1.0, 0.4, -0.0005]);
    let pins = Obstacle::union(
        [0.02, 0.15].map(|x| pliant::Shape::capsule([x, -0.1, -0.0105], [x, 0.2, -0.0105], 0.01)),
    );
    for below in [box_below, pins] {
        let body = Body::new(block([5, 2, 3], SolidCells::Hexahedra), RUBBER).build().unwrap();
        agrees(&pressed(body, below.stiffness(500.0).damping(0.5)));
    }
}

#[track_caller]
fn agrees(scene: &Scene) {
    let [far, moved] = apart(scene, Axis::Y);
    assert!(far < 10.0 * TIGHT * moved, "{far:e} of {moved:e}");
}

/// The displacements of an equilibrium at the last node of a set, of the scene in space and its section across y.
fn at_rest(scene: &Scene, set: &str) -> [Vec<f64>; 2] {
    let plane = scene.in_plane(Axis::Y).unwrap();
    [scene, &plane].map(|scene| {
        let found = scene.equilibrium(&Statics::default()).unwrap();
        let d = scene.body().dimension();
        let node = *scene.body().mesh().sets()[set].last().unwrap();
        found.displacements()[node * d..][..d].to_vec()
    })
}

/// A strip under tension s: s L/E and -nu s W/E in plane stress, (1 - nu^2) s L/E and -nu (1 + nu) s W/E between held ends, linear
/// displacements that all cells have (to round-off and the tolerance of statics, 1e-10 of the forces).
#[test]
fn strips_under_tension_stretch_by_the_closed_form() {
    let (tension, nu) = (500.0, RUBBER.poisson);
    for cells in SolidCells::ALL {
        let body = Body::new(block([3, 2, 2], cells), RUBBER).strain(pliant::Strain::Cauchy);
        let phase = || {
            Phase::until(1.0)
                .hold_axes("left", [Axis::X])
                .hold_axes("bottom", [Axis::Z])
                .hold_axes("front", [Axis::Y])
                .traction("right", [tension, 0.0, 0.0])
        };
        let scene = Scene::new(body.build().unwrap());
        let unit = tension / RUBBER.young;
        for (phase, factors) in [
            (phase(), [1.0, nu]),
            (phase().hold_axes("back", [Axis::Y]), [1.0 - nu * nu, nu * (1.0 + nu)]),
        ] {
            let expected = [factors[0] * unit * SIZE[0], -factors[1] * unit * SIZE[2]];
            let [space, plane] = at_rest(&scene.clone().phase(phase), "right");
            for (k, i) in [0, 2].into_iter().enumerate() {
                for found in [space[i], plane[k]] {
                    assert!(
                        (found - expected[k]).abs() < 1e-9 * expected[0],
                        "{cells:?} {found:e} {expected:?}"
                    );
                }
            }
        }
    }
}

/// A plate that is bent in its plane by shear on its end comes to plane stress by the square of its thickness, so that each half of that
/// comes nearer by a quarter of what the one before did (measured: 0.26), up to what the mesh leaves (5e-5): strain across the plate is continuous from
/// cell to cell in space, and not in the plane.
#[test]
fn thin_plates_come_to_plane_stress() {
    let off = |thickness: f64| {
        let size = [0.2, thickness, 0.05];
        let mesh = Mesh::cuboid(size, [5, 2, 3], SolidCells::Hexahedra27).unwrap();
        let body = Body::new(mesh, RUBBER).build().unwrap();
        let phase = Phase::until(1.0).hold_axes("left", [Axis::X, Axis::Z]);
        let phase = phase.hold_axes("front", [Axis::Y]).traction("right", [0.0, 0.0, 20.0]);
        let [space, plane] = at_rest(&Scene::new(body).phase(phase), "right");
        ((space[2] - plane[1]) / space[2]).abs()
    };
    let [thick, thin, thinner] = [0.004, 0.002, 0.001].map(off);
    let share = (thin - thinner) / (thick - thin);
    println!("{thick:e} {thin:e} {thinner:e}: {share}");
    assert!((share - 0.25).abs() < 0.03 && thinner < 1e-4, "{share} {thinner:e}");
}

/// What is not the same all along is refused by its name.
#[test]
fn what_changes_along_the_axis_is_refused() {
    let body = || Body::new(block([3, 3, 3], SolidCells::Hexahedra), RUBBER);
    let plain = || Scene::new(body().build().unwrap());
    let phase = || Phase::until(0.1);
    let half = CellSelection::inside([0.0; 3], [1.0, 0.05, 1.0]);
    let patched = body().region(half, Material { young: 1e6, ..RUBBER }).build().unwrap();
    let ball = Obstacle::disc([0.0, 0.0, -0.1], 0.05).stiffness(100.0).named("ball");
    let short = Obstacle::box_between([-1.0, 0.0, -0.1], [1.0, 0.1, -0.01]).stiffness(100.0);
    let away = Obstacle::half_plane([0.0; 3], [0.0, 0.0, 1.0]).stiffness(100.0);
    let floor = Obstacle::half_plane([0.0; 3], [0.0, 0.0, 1.0]).stiffness(100.0);
    let uneven = Body::new(block([3, 3, 3], SolidCells::Hexahedra20), RUBBER).build().unwrap();
    let point = body().point_mass("weight", [0.1, 0.02, 0.05], 0.01).build().unwrap();
    let cases: [(Scene, &[&str]); 16] = [
        (Scene::new(patched).phase(phase()), &["material of cell = 3", "same all along y"]),
        (Scene::new(point).phase(phase()), &["point mass = \"weight\""]),
        (plain().gravity([0.0, 1.0, 0.0]).phase(phase()), &["gravity of phase", "points along y"]),
        (plain().phase(phase().hold([1])), &["held and moved nodes", "node 1 x"]),
        (plain().phase(phase().move_axis("all", Axis::Y, 0.1)), &["moved nodes", "node 1 y"]),
        (
            plain().phase(phase().hold_combination([(1, Axis::X, 1.0), (2, Axis::X, 1.0)])),
            &["together"],
        ),
        (
            plain().phase(phase().hold_axes("all", [Axis::Y])).phase(Phase::until(0.2)),
            &["ends held along y", "not as in phase \"phase 1\""],
        ),
        (
            plain().phase(phase().load([3], [0.0, 0.0, 1.0])),
            &["loads of phase", "some nodes of a line"],
        ),
        (
            plain().phase(phase().load("left", [0.0, 1.0, 0.0])),
            &["loads of phase", "points along y"],
        ),
        (plain().phase(phase().pressure_on("front", 10.0)), &["pressure on faces", "on an end"]),
        (plain().spin([0.0, 0.0, 1.0]).phase(phase()), &["initial velocities = of node 1"]),
        (plain().obstacle(ball).phase(phase()), &["obstacle = \"ball\""]),
        (plain().obstacle(short).phase(phase()), &["obstacle = \"floor\""]),
        (
            plain().obstacle(away.velocity([0.0, 0.1, 0.0])).phase(phase()),
            &["obstacle = \"floor\""],
        ),
        (Scene::new(uneven).obstacle(floor).phase(phase()), &["per area"]),
        (
            plain().spring(Spring::between([1], [5]).stiffness(1.0)).phase(phase()),
            &["springs = 1", "a section"],
        ),
    ];
    for (number, (scene, parts)) in cases.into_iter().enumerate() {
        let told = refusal(&scene, Axis::Y);
        assert!(parts.iter().all(|part| told.contains(part)), "{number}: {told}");
    }
    let flat = Mesh::rectangle([0.2, 0.1], [3, 3], Cells::Rectangles).unwrap();
    let flat = Scene::new(Body::new(flat, RUBBER).thickness(0.1).build().unwrap()).phase(phase());
    assert!(refusal(&flat, Axis::Y).contains("no body in space"));
}

fn refusal(scene: &Scene, axis: Axis) -> String {
    let error: InputError = scene.in_plane(axis).unwrap_err();
    println!("{error}");
    error.to_string()
}

//! Halves of symmetric scenes against the whole ones.

use pliant::body::BodyBuilder;
use pliant::{
    Axis, Body, CellSelection, Cells, Chamber, Gas, Growth, Guide, Inertia, InputError, Lag,
    Material, Mesh, Muscle, Obstacle, Orifice, Phase, Sampling, Scene, Selection, Settings, Signal,
    SolidCells, Spring,
};

pub(super) const RUBBER: Material =
    Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 20.0 };
const TIGHT: f64 = 1e-9;

/// The largest distance (m) of nodes of the half, which are at the same undeformed places, from those of the whole, and the largest
/// displacement (m), at the end of both.
pub(super) fn apart(scene: &Scene, axis: Axis) -> [f64; 2] {
    let half = scene.symmetric_half(axis).unwrap();
    let settings = Settings { rtol: TIGHT, max_steps: 200_000, ..Settings::default() };
    let run = |scene: &Scene| scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
    let [whole, own] = [scene, &half].map(run);
    let d = scene.body().dimension();
    let [mut far, mut moved] = [0.0_f64; 2];
    for own_part in half.body().parts() {
        let part = scene.body().parts().find(|part| part.name == own_part.name).unwrap();
        for (node, x) in own_part.nodes.zip(own_part.body.mesh().positions().chunks(d)) {
            let is_there = |other: &usize| {
                let there = scene.body().mesh().position(*other);
                there.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-12)
            };
            let same = part.nodes.clone().find(is_there).unwrap();
            for i in 0..d {
                let [a, b] = [own.last().u[node * d + i], whole.last().u[same * d + i]];
                far = far.max((a - b).abs());
                moved = moved.max(b.abs());
            }
        }
    }
    println!("{far:.2e} of {moved:.2e} m");
    [far, moved]
}

/// Both agree as far as the integration is exact: to some errors of its steps, which are not the same ones (measured: 6e-10).
#[track_caller]
pub(super) fn agrees(scene: &Scene, axis: Axis) {
    let [far, moved] = apart(scene, axis);
    assert!(far < 10.0 * TIGHT * moved, "{far:e} of {moved:e}");
}

pub(super) fn block(change: impl FnOnce(BodyBuilder) -> BodyBuilder) -> Body {
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

/// Springs and cables beside the plane and in it, between nodes and to points of space, driven and not.
#[test]
fn springs_and_cables_act_on_the_half() {
    let cable = |guides: [Guide; 3]| Spring::cable(guides);
    let side = |x: [f64; 3]| {
        let [far, near, end] = x.map(|x| [x, 0.08]);
        cable([Guide::point(far), Guide::inside(near), Guide::inside(end)])
    };
    let middle = || [Guide::point([0.1, 0.15]), Guide::nodes([18]), Guide::nodes([8])];
    let stiff = |spring: Spring| spring.stiffness(30.0).damping(0.1);
    let scene = Scene::new(block(|body| body))
        .gravity([0.0, -9.8])
        .spring(stiff(Spring::between([1], [12])))
        .spring(stiff(Spring::between([14], [5])))
        .spring(stiff(Spring::anchored([16], [-0.05, 0.2])).named("left"))
        .spring(stiff(Spring::anchored([20], [0.25, 0.2])).named("right"))
        .spring(stiff(Spring::between([3], [13])).named("middle"))
        .spring(side([-0.01, 0.02, 0.07]).named("left cable"))
        .spring(side([0.21, 0.18, 0.13]).named("right cable"))
        .spring(cable(middle()).named("tendon"))
        .spring(cable(middle()).winch().stiffness(50.0).named("winch"))
        .lag(Lag::first_order(0.01), ["left", "right"]);
    let phase = |own: f64| {
        Phase::until(0.05)
            .actuate(["left", "right"], 0.1)
            .actuate(["middle", "tendon"], Signal::ramp(0.0, 0.3, 0.0, 0.05))
            .actuate(["winch"], Signal::ramp(0.0, 0.01, 0.0, 0.05))
            .actuate(["left cable"], 0.2)
            .actuate(["right cable"], own)
    };
    agrees(&scene.clone().phase(phase(0.2)), Axis::X);
    let told = refusal(&scene.clone().phase(phase(0.3)), Axis::X);
    assert!(told.contains("of \"left cable\"") && told.contains("not symmetric"), "{told}");
    let lonely = scene.spring(stiff(Spring::between([2], [12]))).phase(phase(0.2));
    assert!(refusal(&lonely, Axis::X).contains("component = \"spring 10\""));
}

/// Muscles and growths across the plane, and those that are images of each other: along vectors and around axes.
#[test]
fn muscles_and_growths_act_on_the_half() {
    let slant = |x: f64, cells: [usize; 3]| {
        Muscle::along([x, 1.0]).within(CellSelection::Numbers(cells.into()))
    };
    let swelling = |x: f64, cells: [usize; 2]| {
        Growth::within(CellSelection::Numbers(cells.into())).around([x, 0.0], []).across(0.3)
    };
    let scene = Scene::new(block(|body| body))
        .muscle(Muscle::along([2.0, 0.0]).within(CellSelection::inside([0.0, 0.0], [0.2, 0.04])))
        .muscle(slant(0.5, [1, 5, 9]).named("left"))
        .muscle(slant(-0.5, [8, 12, 4]).named("right"))
        .growth(Growth::within(CellSelection::Numbers(vec![10, 11])).named("top"))
        .growth(swelling(0.03, [2, 6]).named("left growth"))
        .growth(swelling(0.17, [3, 7]).named("right growth"));
    let phase = |own: f64| {
        Phase::until(0.05)
            .actuate(["muscle 1"], Signal::ramp(0.0, 2e3, 0.0, 0.05))
            .actuate(["left", "right"], 1e3)
            .actuate(["top"], Signal::ramp(0.0, 0.02, 0.0, 0.05))
            .actuate(["left growth"], 0.01)
            .actuate(["right growth"], own)
    };
    agrees(&scene.clone().phase(phase(0.01)), Axis::X);
    let other = scene.muscle(slant(0.5, [2, 6, 10]).named("other"));
    assert!(refusal(&other.phase(phase(0.01)), Axis::X).contains("component = \"other\""));
}

/// The cells of a mesh without those whose centres are in one of some boxes.
pub(super) fn hollow(mesh: &Mesh, boxes: &[[Vec<f64>; 2]]) -> Mesh {
    let d = mesh.dimension();
    let is_left = |cell: &&[usize]| {
        let x = |i: usize| {
            cell.iter().map(|&node| mesh.position(node)[i]).sum::<f64>() / cell.len() as f64
        };
        !boxes.iter().any(|[min, max]| (0..d).all(|i| x(i) > min[i] && x(i) < max[i]))
    };
    let cells = mesh.cells().filter(is_left).flatten().copied().collect();
    Mesh::new(d, mesh.positions().to_vec(), mesh.kind(), cells).unwrap()
}

/// Chambers that the plane cuts, in the plane and in space, and two that are images of each other.
#[test]
fn chambers_press_on_the_half() {
    let around = |[min, max]: &[Vec<f64>; 2]| {
        let wider = |x: &Vec<f64>, by: f64| x.iter().map(|x| x + by).collect::<Vec<f64>>();
        Selection::Box { min: wider(min, -1e-6), max: wider(max, 1e-6) }
    };
    let room = |from: f64, to: f64| [vec![from, 0.01], vec![to, 0.02]];
    let rooms = [room(0.01, 0.02), room(0.03, 0.05), room(0.06, 0.07)];
    let mesh = Mesh::rectangle([0.08, 0.03], [9, 4], Cells::Rectangles).unwrap();
    let body = Body::new(hollow(&mesh, &rooms), RUBBER).thickness(0.02).build().unwrap();
    let mut scene = Scene::new(body);
    for (name, room) in ["left", "middle", "right"].into_iter().zip(&rooms) {
        scene = scene.chamber(Chamber::within(name, around(room)));
    }
    let phase = |own: f64| {
        Phase::until(0.05)
            .pressure("left", 1e3)
            .pressure("right", own)
            .pressure("middle", Signal::ramp(0.0, 2e3, 0.0, 0.05))
    };
    agrees(&scene.clone().phase(phase(1e3)), Axis::X);
    assert!(refusal(&scene.phase(phase(2e3)), Axis::X).contains("chamber \"left\""));

    let room = [vec![0.01; 3], vec![0.03, 0.02, 0.02]];
    let mesh = Mesh::cuboid([0.04, 0.03, 0.03], [5, 4, 4], SolidCells::Hexahedra).unwrap();
    let body = Body::new(hollow(&mesh, std::slice::from_ref(&room)), RUBBER).build().unwrap();
    let scene = Scene::new(body).chamber(Chamber::within("room", around(&room)));
    let scene = scene.phase(Phase::until(0.03).pressure("room", Signal::ramp(0.0, 4e3, 0.0, 0.03)));
    agrees(&scene, Axis::X);
}

/// Gas in a chamber that the plane cuts and in two that are images of each other, with a pump, valves and orifices between them.
#[test]
fn gas_flows_in_the_half() {
    let around = |from: f64, to: f64| Selection::Box {
        min: vec![from - 1e-6, 0.01 - 1e-6],
        max: vec![to + 1e-6, 0.02 + 1e-6],
    };
    let rooms = [(0.01, 0.02), (0.03, 0.05), (0.06, 0.07)];
    let boxes = rooms.map(|(from, to)| [vec![from, 0.01], vec![to, 0.02]]);
    let mesh = Mesh::rectangle([0.08, 0.03], [9, 4], Cells::Rectangles).unwrap();
    let body = Body::new(hollow(&mesh, &boxes), RUBBER).thickness(0.02).build().unwrap();
    let mut scene = Scene::new(body).supply("pump", 1.1e5);
    for (name, (from, to)) in ["left", "middle", "right"].into_iter().zip(rooms) {
        scene = scene
            .chamber(Chamber::within(name, around(from, to)))
            .gas(Gas::in_chamber(name).exponent(1.2));
    }
    let scene = scene
        .orifice(Orifice::nozzle("inlet", "pump", "middle", 1e-7))
        .orifice(Orifice::new("to left", "middle", "left", 2e-9))
        .orifice(Orifice::new("to right", "right", "middle", 2e-9))
        .orifice(Orifice::new("across", "left", "right", 1e-9))
        .orifice(Orifice::new("left valve", "left", "atmosphere", 1e-9));
    let phase = |own: f64| {
        Phase::until(0.03)
            .open("inlet", Signal::ramp(0.0, 1.0, 0.0, 0.02))
            .open("left valve", 0.3)
            .open("right valve", own)
    };
    let whole = scene.clone().orifice(Orifice::new("right valve", "right", "atmosphere", 1e-9));
    agrees(&whole.clone().phase(phase(0.3)), Axis::X);
    let half = whole.clone().phase(phase(0.3)).symmetric_half(Axis::X).unwrap();
    let left: Vec<&str> = half.orifices().iter().map(Orifice::name).collect();
    assert_eq!(left, ["inlet", "to left", "left valve"]);
    assert!(refusal(&whole.phase(phase(0.5)), Axis::X).contains("left valve"));
    let other = scene.orifice(Orifice::new("right valve", "right", "atmosphere", 2e-9));
    assert!(refusal(&other.phase(phase(0.3)), Axis::X).contains("orifice"));
}

/// A rigid plate that the plane cuts, on a soft block that falls onto a floor.
#[test]
fn rigid_cells_move_as_their_half() {
    let plate = CellSelection::inside([0.0, 0.07], [0.2, 0.1]);
    let floor = Obstacle::half_plane([0.0, -0.001], [0.0, 1.0]).stiffness_density(1e6);
    let body = block(|body| body.region(plate, Material::rigid(2000.0)));
    let scene = Scene::new(body)
        .gravity([0.0, -9.8])
        .obstacle(floor)
        .phase(Phase::until(0.05).load_total("top", [0.0, -2.0]));
    agrees(&scene, Axis::X);
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
        (plain().spring(spring).phase(phase()), &["component = \"spring 1\"", "crosses the plane"]),
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

pub(super) fn refusal(scene: &Scene, axis: Axis) -> String {
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

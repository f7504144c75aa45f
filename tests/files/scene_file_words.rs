//! Every word of scene files means what it means in the API: scenes that use all of them, built both
//! ways, move alike, bit by bit.

use std::path::Path;

use pliant::scene_file::Format;
use pliant::{
    Axis, Body, CellSelection, Cells, Chamber, ContactEvents, Material, Mesh, Method, Obstacle,
    OutputRequest, Phase, Prescribed, Sampling, Scene, SceneFile, Selection, Settings, Shape,
    Signal, SolidCells, Spring, Strain,
};

fn read(name: &str) -> SceneFile {
    SceneFile::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)).unwrap()
}

#[track_caller]
fn agree(file: &SceneFile, scene: &Scene) {
    let run = |scene: &Scene| scene.simulate(&file.settings, &file.output.sampling()).unwrap();
    assert_eq!(run(&file.scene).samples(), run(scene).samples());
}

fn corners<const D: usize>(min: [f64; D], max: [f64; D]) -> Selection {
    Selection::Box { min: min.into(), max: max.into() }
}

#[test]
fn in_the_plane() {
    let file = read("rich.toml");
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    let body = Body::new(Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap(), rubber)
        .thickness(0.01)
        .strain(Strain::Green)
        .region(CellSelection::inside([0.0, 0.0], [0.1, 0.3]), Material { young: 2e6, ..rubber })
        .point_mass("mass", [0.15, 0.5], 0.01)
        .build();
    let push = Phase::until(0.5)
        .hold("bottom")
        .move_axis([14, 15], Axis::Y, -0.16)
        .path([16], Axis::X, [0.0, 0.3, 0.5], [0.0, 0.02, 0.01])
        .load_total("right", [1.0, 0.0])
        .pressure("cell", 100.0)
        .actuate_table(["A1"], [0.0, 0.2, 0.5], [0.0, -0.1, 0.0])
        .without_contact();
    let scene = Scene::new(body.unwrap())
        .gravity([0.0, -9.8])
        .spring(Spring::between([14], "mass").named("A1").stiffness(20.0))
        .chamber(Chamber::within("cell", [6, 7, 11, 10]))
        .obstacle(Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(100.0))
        .phase(push.named("push"))
        .phase(Phase::until(1.0).contact_with(["floor"]));
    agree(&file, &scene);
    assert_eq!(file.title, "A bit of everything");
    assert_eq!(
        file.settings,
        Settings { method: Method::CvodeBdf, rtol: 1e-5, ..Settings::default() }
    );
    let output = OutputRequest {
        times: None,
        step: Some(0.01),
        track: Some(corners([0.0, 0.2], [0.3, 0.3])),
        sensors: Vec::new(),
        formats: vec![Format::Csv, Format::Vtk],
    };
    assert_eq!(file.output, output);
    assert_eq!(file.scene.breaks(0), [0.2, 0.3]);
    assert!(file.scene.breaks(1).is_empty());
}

#[test]
fn in_space() {
    let file = read("solid.toml");
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.4, viscosity: 100.0 };
    let mesh = Mesh::cuboid([0.1, 0.1, 0.2], [3, 3, 3], SolidCells::Hexahedra).unwrap();
    let mesh = mesh.translated(&[-0.05, -0.05, 0.0]).unwrap();
    let floor = Obstacle::half_plane([0.0, 0.0, -0.001], [0.0, 0.0, 2.0]).stiffness_density(1e7);
    let ball = Obstacle::disc([0.06, 0.0, 0.1], 0.02).named("ball").stiffness(200.0);
    let ball = ball.friction_coefficients(0.6, 0.5).sticking_speed(0.01);
    let hull = Obstacle::cavity([0.0, 0.0, 0.1], 0.12).named("hull").stiffness(50.0);
    let step = Shape::box_between([-0.2, -0.2, -1.0], [-0.04, 0.2, 0.01]);
    let rail = Obstacle::capsule([0.0, -1.0, 0.21], [0.0, 1.0, 0.21], 0.015).named("rail");
    let times = [0.0, 0.022, 0.03];
    let press = Phase::until(0.03)
        .project_velocity()
        .hold(corners([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]))
        .move_axis("top", Axis::X, 0.05)
        .move_axis("top", Axis::Z, -0.1)
        .load_table("left", times, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let scene = Scene::new(Body::new(mesh, rubber).strain(Strain::Green).build().unwrap())
        .gravity([0.0, 0.0, -9.8])
        .obstacle(floor.damping(1e3).tangential_damping(1e4).adhesion(false))
        .obstacle(ball.velocity([-0.1, 0.0, 0.0]))
        .obstacle(hull.friction_coefficient(0.3))
        .obstacle(Obstacle::new(step).named("step").stiffness(100.0))
        .obstacle(rail.stiffness(100.0))
        .chamber(Chamber::within("drum", "top").closed_by_lid())
        .phase(Phase::until(0.02).named("fall").contact_with(["floor", "hull"]))
        .phase(press);
    agree(&file, &scene);
    assert_eq!(file.notes, [""; 0]);
    // the same by the old name of tangential damping, with a note
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/solid.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let old = text.replace("tangential_damping", "friction");
    let old = SceneFile::parse(&old, &path).unwrap();
    agree(&old, &scene);
    assert_eq!(old.notes.len(), 1);
    let note = "line 21: obstacle.friction is read as tangential_damping";
    assert!(old.notes[0].starts_with(note), "{:?}", old.notes);
    let settings = Settings {
        method: Method::CvodeBdf,
        rtol: 1e-4,
        atol_position: Some(1e-7),
        atol_velocity: Some(1e-5),
        alpha: 500.0,
        max_order: Some(4),
        stability_limit_detection: true,
        contact_events: ContactEvents::Locate,
        max_step: Some(0.01),
        max_steps: 5000,
        max_time: Some(3600.0),
    };
    assert_eq!(file.settings, settings);
    assert_eq!(file.output, OutputRequest::default());
    assert_eq!(file.scene.breaks(1), [0.022]);
}

/// Formulas are the functions that they say, with their derivatives on paths.
#[test]
fn loads_of_all_kinds() {
    let file = read("loads.toml");
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.4, viscosity: 100.0 };
    let body = Body::new(Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Triangles6).unwrap(), rubber)
        .thickness(0.01)
        .strain(Strain::Green)
        .point_mass("tip", [0.12, 0.05], 0.01)
        .build();
    let omega = 2.0 * std::f64::consts::PI * 30.0;
    let pushed = Phase::until(0.02)
        .gravity([1.0, 0.0])
        .hold("left")
        .traction_with("right", move |t| [100.0, -(2000.0 * (omega * t).sin())])
        .traction_table("top", [0.0, 0.01], [[0.0, 0.0], [0.0, -50.0]])
        .load_total_table("right", [0.0, 0.01], [[0.0, 0.0], [0.1, 0.0]])
        .load_with("tip", |t| [0.01 * t, 0.0])
        .pressure_with("below", |t| 100.0 * (-t).exp())
        .pressure_on("right", Signal::function(|t| if t < 0.01 { 0.0 } else { 200.0 }))
        .pressure_on("top", Signal::table([0.0, 0.01], [0.0, 100.0]))
        .actuate_with(["spring 1"], |t| t.min(0.01));
    let rest = |_| Prescribed { displacement: 0.0, velocity: 0.0, acceleration: 0.0 };
    let swing = |t: f64| {
        let angle = 100.0 * (t - 0.02);
        Prescribed {
            displacement: 0.001 * (1.0 - angle.cos()),
            velocity: 0.1 * angle.sin(),
            acceleration: 10.0 * angle.cos(),
        }
    };
    let fall = |t: f64| Prescribed {
        displacement: -0.001 * t.powi(2),
        velocity: -0.002 * t,
        acceleration: -0.002,
    };
    let led = Phase::until(0.04)
        .follow("left", Axis::X, swing)
        .follow("left", Axis::Y, rest)
        .follow("tip", Axis::Y, fall);
    let scene = Scene::new(body.unwrap())
        .gravity([0.0, -9.8])
        .spring(Spring::anchored("tip", [0.15, 0.1]).stiffness(20.0))
        .spring(Spring::anchored([9], [0.0, 0.1]).stiffness(10.0))
        .chamber(Chamber::within("below", "bottom").closed_by_line())
        .phase(pushed)
        .phase(led);
    let run = |scene: &Scene| scene.simulate(&file.settings, &file.output.sampling()).unwrap();
    let [read, built] = [&file.scene, &scene].map(run);
    for (a, b) in read.samples().iter().zip(built.samples()) {
        let scale = b.u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        let apart = a.u.iter().zip(&b.u).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{} s: {apart:e} of {scale:e} m", a.time);
        // derivatives of formulas are rounded otherwise; both runs choose their steps by rtol 1e-3
        assert!(apart <= 1e-6 * scale, "{apart:e} of {scale:e}");
    }
    assert_eq!(file.scene.breaks(0), [0.01]);
}

#[test]
fn a_string_in_the_plane() {
    let file = read("string.toml");
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.0, viscosity: 10.0 };
    let mesh = Mesh::bar(0.2, 9).unwrap().mapped(|x| [x[0], 0.0]).unwrap();
    let mesh = mesh.translated(&[-0.1, 0.05]).unwrap();
    let body = Body::new(mesh, rubber).area(1e-5).point_mass("weight", [0.0, -0.05], 0.01).build();
    let bag = Chamber::within("bag", [9, 8, 7, 6, 5, 4, 3, 2, 1, 10]).thickness(0.01);
    let phase = Phase::until(0.1)
        .hold("weight")
        .path([1], Axis::X, [0.0, 0.05, 0.1], [0.0, -0.01, -0.01])
        .path([1], Axis::Y, [0.0, 0.05, 0.1], [0.0, 0.0, 0.02])
        .path([9], Axis::X, [0.0, 0.1], [0.0, 0.01])
        .path([9], Axis::Y, [0.0, 0.1], [0.0, 0.0])
        .pressure_table("bag", [0.02, 0.08], [0.0, 50.0])
        .actuate(["spring 1"], -0.01);
    let scene = Scene::new(body.unwrap())
        .spring(Spring::between([5], "weight").stiffness(2.0).damping(0.1))
        .chamber(bag)
        .phase(phase);
    agree(&file, &scene);
    assert_eq!(file.scene.breaks(0), [0.02, 0.05, 0.08]);
}

/// What moves by itself: in the plane and in space.
#[test]
fn of_motion() {
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 100.0 };
    let common = "material = { density = 1000.0, young = 1e5, poisson = 0.3, viscosity = 100.0 }
        [output]
        step = 0.01\n";
    let parse =
        |text: &str| SceneFile::parse(&[text, common].concat(), Path::new("motion.toml")).unwrap();
    let file = parse(
        r#"
        gravity = [0.0, -9.8]
        initial = { velocity = [0.1, 0.5], spin = 2.0, nodes = [{ nodes = 9, velocity = [0.0, 0.6] }] }
        obstacle = { kind = "half-plane", point = [0.0, 0.0], normal = [0.0, 1.0], stiffness = 100.0, path = { times = [0.0, 0.05], displacements = [[0.0, 0.0], [0.0, 0.01]] } }
        phase = [
            { until = 0.05 },
            { until = 0.1, symmetry = [{ nodes = "left", normal = [1.0, 1.0] }], rotate = [{ nodes = 3, centre = [0.1, 0.1], rate = -3.0 }, { nodes = 6, centre = [0.0, 0.0], times = [0.05, 0.1], angles = [0.0, 0.2] }] },
        ]
        [body]
        mesh = { kind = "rectangle", size = [0.1, 0.1], nodes = [3, 3], cells = "rectangles" }
        thickness = 0.01
        "#,
    );
    let body = Body::new(Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Rectangles).unwrap(), rubber);
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(100.0);
    let turn = Phase::until(0.1)
        .rotate([3], [0.1, 0.1], [-3.0])
        .rotate_path([6], [0.0, 0.0], [1.0], [0.05, 0.1], [0.0, 0.2])
        .symmetry("left", [1.0, 1.0]);
    let scene = Scene::new(body.thickness(0.01).build().unwrap())
        .gravity([0.0, -9.8])
        .initial_velocity(|_| vec![0.1, 0.5])
        .spin([2.0])
        .initial_velocity_of([9], [0.0, 0.6])
        .obstacle(floor.path([0.0, 0.05], [[0.0, 0.0], [0.0, 0.01]]))
        .phase(Phase::until(0.05))
        .phase(turn);
    agree(&file, &scene);
    let file = parse(
        r#"
        initial = { spin = [1.0, 0.0, -2.0] }
        phase = { until = 0.02, rotate = { nodes = 1, centre = [0.1, 0.0, 0.0], axis = [0.0, 3.0, 4.0], rate = 5.0 } }
        [body]
        mesh = { kind = "cuboid", size = [0.1, 0.1, 0.1], nodes = [3, 2, 3], cells = "hexahedra", grading = [3, 1, 0.5] }
        "#,
    );
    let (size, grading) = ([0.1, 0.1, 0.1], [3.0, 1.0, 0.5]);
    let mesh = Mesh::graded_cuboid(size, [3, 2, 3], grading, SolidCells::Hexahedra).unwrap();
    let scene = Scene::new(Body::new(mesh, rubber).build().unwrap())
        .spin([1.0, 0.0, -2.0])
        .phase(Phase::until(0.02).rotate([1], [0.1, 0.0, 0.0], [0.0, 3.0, 4.0]));
    agree(&file, &scene);
}

/// A union, whose parts are felt as the API's; samples at times; a row of constraints.
#[test]
fn of_lists() {
    let file = SceneFile::parse(
        r#"
        gravity = [0.0, -9.8]
        [body]
        mesh = { kind = "rectangle", size = [0.1, 0.1], nodes = [3, 3], cells = "rectangles", origin = [0.0, 0.01], grading = [1, 2] }
        thickness = 0.01
        material = { density = 1000.0, young = 1e5, poisson = 0.3, viscosity = 100.0 }
        [[obstacle]]
        kind = "union"
        parts = [
            { kind = "half-plane", point = [0.0, 0.0], normal = [0.0, 2.0] },
            { kind = "disc", centre = [0.05, 0.0], radius = 0.005 },
            { kind = "box", min = [0.08, -0.1], max = [0.2, 0.002] },
            { kind = "capsule", from = [-0.1, 0.0], to = [0.0, 0.0], radius = 0.003 },
            { kind = "disc", cavity = true, centre = [0.0, 0.0], radius = 1.0 },
        ]
        stiffness = 100.0
        [[phase]]
        until = 0.1
        hold_combination = [
            { terms = [{ node = 1, axis = "x", coefficient = 1.0 }, { node = 3, axis = "x", coefficient = -1 }] },
            { terms = { node = 8, axis = "x", coefficient = 2 } },
        ]
        [output]
        times = [0.07, 0.02, 0.1]
        "#,
        Path::new("lists.toml"),
    );
    let (file, rubber) =
        (file.unwrap(), Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 100.0 });
    let mesh = Mesh::graded_rectangle([0.1, 0.1], [3, 3], [1.0, 2.0], Cells::Rectangles).unwrap();
    let body = Body::new(mesh.translated(&[0.0, 0.01]).unwrap(), rubber).thickness(0.01);
    let floor = Obstacle::union([
        Shape::half_plane([0.0, 0.0], [0.0, 2.0]),
        Shape::disc([0.05, 0.0], 0.005),
        Shape::box_between([0.08, -0.1], [0.2, 0.002]),
        Shape::capsule([-0.1, 0.0], [0.0, 0.0], 0.003),
        Shape::cavity([0.0, 0.0], 1.0),
    ]);
    let fall = Phase::until(0.1)
        .hold_combination([(1, Axis::X, 1.0), (3, Axis::X, -1.0)])
        .hold_combination([(8, Axis::X, 2.0)]);
    let scene = Scene::new(body.build().unwrap())
        .gravity([0.0, -9.8])
        .obstacle(floor.stiffness(100.0))
        .phase(fall);
    agree(&file, &scene);
    let motion = file.scene.simulate(&file.settings, &file.output.sampling()).unwrap();
    let times: Vec<f64> = motion.samples().iter().map(|sample| sample.time).collect();
    assert_eq!(times, [0.0, 0.02, 0.07, 0.1]);
    // the row holds, and the disc is touched before the floor would be
    let u = &motion.last().u;
    assert!((u[0] - u[4]).abs() < 1e-9 && u[14].abs() < 1e-9, "{u:?}");
    assert!(motion.contact_forces(motion.last()).unwrap()[3] > 0.0);
}

/// Regions and walls by numbers, in space.
#[test]
fn of_numbers() {
    let file = SceneFile::parse(
        r#"
        [body]
        mesh = { kind = "cuboid", size = [0.1, 0.1, 0.1], nodes = [2, 2, 2], cells = "tetrahedra" }
        material = { density = 1000.0, young = 1e5, poisson = 0.3, viscosity = 100.0 }
        region = { cells = [1, 4], material = { young = 2e5 } }
        [[chamber]]
        name = "bag"
        triangles = [[1, 2, 3], [1, 3, 5], [2, 1, 5], [2, 5, 3]]
        [[phase]]
        until = 0.01
        pressure = { chamber = "bag", value = 100.0 }
        "#,
        Path::new("numbers.toml"),
    );
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 100.0 };
    let mesh = Mesh::cuboid([0.1, 0.1, 0.1], [2, 2, 2], SolidCells::Tetrahedra).unwrap();
    let tough = Material { young: 2e5, ..rubber };
    let body = Body::new(mesh, rubber).region(CellSelection::Numbers(vec![1, 4]), tough);
    let bag = Chamber::surface("bag", [[1, 2, 3], [1, 3, 5], [2, 1, 5], [2, 5, 3]]);
    let scene = Scene::new(body.build().unwrap()).chamber(bag);
    agree(&file.unwrap(), &scene.phase(Phase::until(0.01).pressure("bag", 100.0)));
}

/// A mesh that is listed is the one that its lists were taken from, with its sets and groups.
#[test]
fn listed_meshes() {
    let mesh = Mesh::rectangle([0.1, 0.02], [6, 2], Cells::Triangles6).unwrap();
    let list = |numbers: &mut dyn Iterator<Item = String>| numbers.collect::<Vec<_>>().join(", ");
    let positions = list(&mut mesh.positions().chunks(2).map(|x| format!("{x:?}")));
    let numbered = |nodes: &[usize]| nodes.iter().map(|node| node + 1).collect::<Vec<_>>();
    let cells = list(&mut mesh.cells().map(|nodes| format!("{:?}", numbered(nodes))));
    let left = numbered(&mesh.sets()["left"]);
    let text = |cells: &str, more: &str| {
        format!(
            "[body]\nthickness = 0.01\nmaterial = {{ density = 1000.0, young = 1e6, poisson = 0.3, viscosity = 0.0 }}\n\
             region = {{ group = \"soft\", material = {{ young = 2e5 }} }}\n\
             [body.mesh]\nkind = \"listed\"\ncells = \"triangles6\"\npositions = [{positions}]\n\
             connectivity = [{cells}]\nsets = {{ name = \"wall\", nodes = {left:?} }}\n\
             groups = {{ name = \"soft\", cells = [1, 4] }}\n{more}\n[[phase]]\nuntil = 0.01\nhold = {{ nodes = \"wall\" }}\n"
        )
    };
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
    let soft = Material { young: 2e5, ..rubber };
    let body = Body::new(mesh.clone(), rubber).thickness(0.01);
    let body = body.region(CellSelection::Numbers(vec![1, 4]), soft).build().unwrap();
    agree(&parse(&text(&cells, "")), &Scene::new(body).phase(Phase::until(0.01).hold("left")));

    let error = |text: &str| SceneFile::parse(text, Path::new("s.toml")).unwrap_err().to_string();
    for (cells, more, part) in [
        ("[1, 2, 3]", "", "body.mesh.connectivity: expected the nodes of each cell"),
        (
            "[1, 2, 3, 4, 5, 99]",
            "",
            "node of cell 1 = 99 cannot be used: the mesh has the nodes 1 to 33",
        ),
        ("[0, 1, 2, 3, 4, 5]", "", "a number, 1 or above; found 0"),
        (&cells, "origin = [0.0]", "body.mesh.origin"),
    ] {
        let message = error(&text(cells, more));
        assert!(message.contains(part), "{message}");
    }
    let message = error(&text(&cells, "").replace("[1, 4]", "[1, 400]"));
    assert!(
        message.contains("cell = 400 cannot be used: the mesh has the cells 1 to 10"),
        "{message}"
    );
    let message = error(&text(&cells, "").replace("\"triangles6\"", "\"triangles\""));
    assert!(
        message.contains("expected the nodes of each cell, by number (from 1): 3 nodes"),
        "{message}"
    );
}

fn parse(text: &str) -> SceneFile {
    SceneFile::parse(text, Path::new("scene.toml")).unwrap()
}

/// What a file leaves to be chosen is chosen, and the report says why.
#[test]
fn what_is_left_to_be_chosen_is_said() {
    let text = |strain: &str, cells: &str| {
        format!(
            "[body]\nmesh = {{ kind = \"rectangle\", size = [0.1, 0.02], nodes = [6, 2], cells = \"{cells}\" }}\n\
             thickness = 0.01\nstrain = \"{strain}\"\n\
             material = {{ density = 1000.0, young = 1e6, poisson = 0.3, viscosity = 100.0 }}\n\
             [initial]\nspin = 0.5\n[[phase]]\nuntil = 0.4\n"
        )
    };
    let run = |text: &str, spin: &str| {
        let file = parse(&text.replace("spin = 0.5", spin));
        let mut motion = file.scene.simulate(&file.settings, &Sampling::every(0.1)).unwrap();
        file.explain(&mut motion);
        motion.report().clone()
    };
    let auto = text("auto", "auto");
    // turned by 0.4 * 0.5 rad: 11.5 degrees, and 1 - cos of that is 2.0 %
    let turned = run(&auto, "spin = 0.5").chosen;
    assert!(turned[0].contains("11 degrees") && turned[0].contains("strain of 2 %"), "{turned:?}");
    assert!(turned[1].starts_with("cells: triangles of 6 nodes"), "{turned:?}");
    // by 0.004 rad: Cauchy strain would do
    let still = run(&auto, "spin = 0.01");
    assert!(still.chosen[0].contains("Cauchy strain would do"), "{:?}", still.chosen);
    assert!(still.to_string().contains("\nchosen: strain: Green"));
    // the same scene, said in full
    assert_eq!(
        format!("{:?}", parse(&auto).scene),
        format!("{:?}", parse(&text("green", "triangles6")).scene)
    );
    assert_eq!(run(&text("green", "triangles6"), "spin = 0.5").chosen, [""; 0]);
}

/// Of several bodies the report tells of those that leave it open, whichever comes first, and how far they turn by
/// themselves.
#[test]
fn what_each_body_leaves_to_be_chosen_is_said() {
    let body = |name: &str, strain: &str, cells: &str, spin: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nthickness = 0.01\nstrain = \"{strain}\"\nspin = {spin}\n\
             mesh = {{ kind = \"rectangle\", size = [0.1, 0.02], nodes = [6, 2], cells = \"{cells}\" }}\n\
             material = {{ density = 1000.0, young = 1e6, poisson = 0.3, viscosity = 100.0 }}\n"
        )
    };
    let bodies = [
        body("linear", "cauchy", "triangles", 0.1),
        body("still", "auto", "rectangles", 0.01),
        body("turning", "green", "auto", 0.5),
    ];
    let file = parse(&(bodies.concat() + "[[phase]]\nuntil = 0.4\n"));
    let mut motion = file.scene.simulate(&file.settings, &Sampling::every(0.1)).unwrap();
    file.explain(&mut motion);
    let [strain, cells] = &motion.report().chosen[..] else { panic!("{:?}", motion.report()) };
    assert!(strain.starts_with("strain of body \"still\": Green"), "{strain}");
    assert!(strain.contains("Cauchy strain would do"), "{strain}");
    assert!(cells.starts_with("cells of body \"turning\": triangles of 6 nodes"), "{cells}");
}

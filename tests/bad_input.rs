//! What bad input gets: an error that names the input, its value and the mend; never a panic.

use pliant::samples::{SQUARE_MATERIAL, square_press};
use pliant::{
    Axis, Body, Cells, Chamber, Error, Material, Mesh, Method, Obstacle, Phase, Plane, Prescribed,
    Sampling, Scene, Selection, Settings, Shape, SolidCells, Spring, Statics, Strain, Trajectory,
};

fn grid() -> Mesh {
    Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap()
}

fn scene() -> Scene {
    Scene::new(
        Body::new(grid(), SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap(),
    )
}

fn simulate(scene: &Scene) -> Result<Trajectory, Error> {
    scene.simulate(&Settings::default(), &Sampling::every(0.1))
}

/// The message of the error says all of `parts`.
#[track_caller]
fn says<T>(result: Result<T, impl Into<Error>>, parts: &[&str]) {
    let Err(error) = result else { panic!("accepted; expected {parts:?}") };
    let message = error.into().to_string();
    println!("{message}");
    for part in parts {
        assert!(message.contains(part), "\"{part}\" is missing from: {message}");
    }
}

#[test]
fn meshes() {
    let rectangle = |size, nodes| Mesh::rectangle(size, nodes, Cells::Triangles);
    says(rectangle([0.0, 0.3], [4, 4]), &["rectangle.size[0] = 0", "above 0", "(m)"]);
    says(rectangle([0.3, f64::NAN], [4, 4]), &["rectangle.size[1] = NaN"]);
    says(rectangle([0.3, 0.3], [4, 1]), &["rectangle.nodes[1] = 1", "at least 2"]);
    says(Mesh::bar(-1.0, 5), &["bar.length = -1"]);
    let triangle = |positions: [f64; 6], cell: [usize; 3]| {
        let kind = grid().kind();
        let mesh = Mesh::new(2, positions.into(), kind, cell.into())?;
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build()
    };
    let corners = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    let square = vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let twice = Mesh::new(2, square, grid().kind(), vec![0, 1, 2, 0, 2, 3, 1, 2, 0]);
    says(twice, &["nodes of cell 3 = [2, 3, 1]", "those of cell 1", "count twice"]);
    assert!(triangle(corners, [0, 1, 2]).is_ok());
    says(triangle(corners, [0, 2, 1]), &["cell 1", "[1, 3, 2]", "clockwise", "reverse"]);
    says(triangle([0.0, 0.0, 1.0, 0.0, 2.0, 0.0], [0, 1, 2]), &["cell 1", "flat"]);
    says(triangle(corners, [0, 1, 3]), &["node of cell 1 = 4", "1 to 3"]);
    says(triangle(corners, [0, 1, 1]), &["cell 1", "flat"]);
    says(triangle([0.0, 0.0, f64::INFINITY, 0.0, 0.0, 1.0], [0, 1, 2]), &["mesh.positions", "inf"]);
}

#[test]
fn loose_nodes() {
    let mut positions = grid().positions().to_vec();
    positions.extend([1.0, 1.0]);
    let cells = grid().cells().flatten().copied().collect();
    let mesh = Mesh::new(2, positions, grid().kind(), cells).unwrap();
    says(
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build(),
        &["node", "17", "no cell"],
    );
}

#[test]
fn materials_and_sections() {
    let body =
        |material| Body::new(grid(), material).strain(Strain::Cauchy).thickness(0.01).build();
    let good = SQUARE_MATERIAL;
    says(body(Material { poisson: 0.5, ..good }), &["material.poisson = 0.5", "below 0.5"]);
    says(body(Material { density: -1000.0, ..good }), &["material.density = -1000", "kg/m^3"]);
    says(body(Material { young: f64::NAN, ..good }), &["material.young = NaN", "Pa"]);
    says(body(Material { viscosity: -1.0, ..good }), &["material.viscosity = -1", "Pa s"]);
    says(Body::new(grid(), good).strain(Strain::Cauchy).build(), &["thickness", "missing"]);
    says(Body::new(grid(), good).strain(Strain::Cauchy).thickness(0.0).build(), &["thickness = 0"]);
    says(
        Body::new(grid(), good).strain(Strain::Cauchy).area(1.0).build(),
        &["area = 1", "Triangle"],
    );
    let bar = || Mesh::bar(0.1, 6).unwrap();
    says(Body::new(bar(), good).strain(Strain::Cauchy).build(), &["area", "missing"]);
    says(
        Body::new(bar(), good).strain(Strain::Cauchy).thickness(1.0).plane(Plane::Stress).build(),
        &["thickness = 1"],
    );
}

#[test]
fn selections() {
    let hold = |nodes: Selection| simulate(&scene().phase(Phase::until(0.1).hold(nodes)));
    says(hold([17].into()), &["node = 17", "1 to 16"]);
    says(hold([0].into()), &["node = 0", "count from 1"]);
    says(hold("buttom".into()), &["\"buttom\"", "bottom"]);
    says(hold(vec![].into()), &["contains no node"]);
    says(hold([3, 3].into()), &["node = 3", "twice"]);
    let nowhere = Selection::Box { min: vec![5.0, 5.0], max: vec![6.0, 6.0] };
    says(hold(nowhere), &["contains no node"]);
}

#[test]
fn constraints() {
    let run = |phase: Phase| simulate(&scene().phase(phase.named("press")));
    let hold = || Phase::until(0.1).hold("bottom");
    let contradiction = &["press", "node 4 y", "held, and moved at 0.1 m/s", "contradict"];
    says(run(hold().move_nodes([4], [0.0, 0.1])), contradiction);
    let along = |scale: f64| {
        move |t| Prescribed { displacement: scale * t, velocity: scale, acceleration: 0.0 }
    };
    let two = Phase::until(0.1).follow([4], Axis::X, along(0.0)).follow([4], Axis::X, along(1.0));
    says(run(two), &["node 4 x", "along a function of time, and moved along a function of time"]);
    says(run(hold().move_nodes([14], [0.1])), &["velocity", "[0.1]", "2 component"]);
    says(run(hold().move_nodes([14], [0.0, f64::NAN])), &["velocity", "NaN"]);
    says(run(hold().hold_axes([14], [Axis::Z])), &["axis", "Z", "2 dimension"]);
    says(
        run(hold().hold_combination([(14, Axis::X, 0.0), (15, Axis::X, 1.0)])),
        &["coefficient of a constraint row = 0"],
    );
    let more = [(14, Axis::X, 1.0), (15, Axis::X, 1.0), (4, Axis::X, 1.0)];
    says(
        run(hold().hold_combination(more.into_iter().take(2)).hold_combination(more)),
        &["press", "node 14 x + node 15 x", "leave it out"],
    );
    says(
        run(Phase::until(0.1)
            .move_nodes([14, 15], [1.0, 0.0])
            .hold_combination(more.into_iter().take(2))),
        &["press", "node 14 x + node 15 x", "moved at 2 m/s in all, one by one", "together held"],
    );
    says(run(hold().symmetry([14], [0.0, 0.0])), &["normal", "[0.0, 0.0]", "not all of them 0"]);
    says(run(hold().symmetry([14], [1.0])), &["normal", "2 component(s)"]);
    says(run(hold().rotate([14], [0.0], [1.0])), &["centre", "[0.0]", "2 component(s) (m)"]);
    says(run(hold().rotate([14], [0.0, 0.0], [1.0, 0.0])), &["angular velocity", "1 component"]);
    let path = |axis: f64, angles: &[f64]| {
        run(hold().rotate_path([14], [0.0, 0.0], [axis], [0.0, 0.1], angles))
    };
    says(path(0.0, &[0.0, 1.0]), &["axis", "[0.0]", "direction"]);
    says(path(1.0, &[1.0]), &["angles of a rotation", "[1.0]", "2 times (rad)"]);
}

/// NaN in b(t): at the start it is bad input; later the integration stops and keeps what it has.
#[test]
fn nan_in_a_path() {
    let path = |from: f64| {
        move |t: f64| Prescribed {
            displacement: if t < from { -0.01 * t * t } else { f64::NAN },
            velocity: -0.02 * t,
            acceleration: -0.02,
        }
    };
    let scene = |from| {
        let phase = Phase::until(0.5).named("probe").hold("bottom");
        scene().phase(phase.follow([14], Axis::Y, path(from)))
    };
    says(simulate(&scene(0.0)), &["probe", "node 14 y", "(NaN, -0, -0.02)", "t = 0 s"]);
    for method in Method::ALL {
        let settings = Settings { method, ..Settings::default() };
        let result = scene(0.25).simulate(&settings, &Sampling::every(0.1));
        let Err(Error::Integration(failure)) = &result else { panic!("{method}: {result:?}") };
        // the last sample before 0.25 s is kept
        let times: Vec<f64> = failure.trajectory.samples().iter().map(|s| s.time).collect();
        assert_eq!(times[..3], [0.0, 0.1, 0.2], "{method}");
        assert!((failure.time - 0.25).abs() < 0.05, "{method}: {}", failure.time);
        says(result, &["probe", method.name(), "t = 0.2", "step", "node 14 y", "b = NaN"]);
    }
}

#[test]
fn phases() {
    let phase = |until| Phase::until(until).hold("bottom");
    says(simulate(&scene()), &["number of phases = 0"]);
    let backwards = scene().phase(phase(0.5)).phase(phase(0.3).named("late"));
    says(simulate(&backwards), &["end of phase \"late\" = 0.3 s", "after 0.5 s"]);
    says(simulate(&scene().phase(phase(0.0))), &["end of phase \"phase 1\" = 0 s"]);
    says(simulate(&scene().phase(phase(f64::NAN))), &["end of phase \"phase 1\" = NaN"]);
    says(simulate(&scene().phase(phase(0.1).load([1], [1.0]))), &["load = [1.0]", "2 component"]);
    says(
        simulate(&scene().phase(phase(0.1).load([1], [1.0, f64::INFINITY]))),
        &["component 2 of load = inf"],
    );
    says(
        simulate(&scene().phase(phase(0.1).load_total("top", [1.0]))),
        &["load = [1.0]", "2 component"],
    );
    says(
        simulate(&scene().phase(phase(0.1).load_with("top", |_| [1.0; 3]))),
        &["components of a load = 3", "2 component"],
    );
    says(
        simulate(&scene().phase(phase(0.1).load_with("top", |t| [1.0, t / t]))),
        &["component 2 of a load is NaN at t = 0 s"],
    );
    says(
        simulate(&scene().phase(phase(0.1).contact_with(["wall"]))),
        &["contact of phase \"phase 1\" = \"wall\""],
    );
    says(simulate(&scene().gravity([9.8]).phase(phase(0.1))), &["gravity = [9.8]", "2 component"]);
}

/// A start in which a force has no meaning is refused by name before anything is computed.
#[test]
fn starts() {
    let turned = |x: &[f64]| vec![-2.0 * x[0], 0.0];
    let green = || {
        let body = Body::new(grid(), SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green);
        Scene::new(body.build().unwrap()).phase(Phase::until(0.1).named("fly"))
    };
    let inverted = ["initial displacement = up to 6e-1 m", "cell 1 (nodes [1, 2, 5]) is inverted"];
    for method in Method::ALL {
        let settings = Settings { method, ..Settings::default() };
        let scene = green().initial_displacement(turned);
        says(scene.simulate(&settings, &Sampling::phase_ends()), &inverted);
    }
    says(green().initial_displacement(turned).validate(), &inverted);
    says(green().initial_displacement(turned).summary(), &inverted);
    // small strain knows no inversion
    let linear = scene().initial_displacement(turned).phase(Phase::until(1e-3));
    assert!(simulate(&linear).is_ok());
    let collapsed = scene()
        .spring(Spring::between([1], [4]).named("A1").stiffness(20.0))
        .initial_displacement(|x| vec![0.15 - x[0], 0.0])
        .phase(Phase::until(0.1));
    says(simulate(&collapsed), &["initial displacement", "spring \"A1\" has collapsed"]);
    let beyond = scene().initial_displacement(|_| vec![1e200, 0.0]).phase(Phase::until(0.1));
    says(simulate(&beyond), &["initial displacement = 1e200", "1e30 at most"]);
    let beyond = scene().initial_velocity(|_| vec![1e200, 0.0]).phase(Phase::until(0.1));
    says(simulate(&beyond), &["initial velocity = 1e200", "1e30 at most"]);
}

#[test]
fn obstacles() {
    let with = |obstacle| simulate(&scene().obstacle(obstacle).phase(Phase::until(0.1)));
    let floor = || Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(100.0);
    assert!(with(floor()).is_ok());
    says(with(floor().stiffness(0.0)), &["obstacle \"floor\" stiffness = 0", "N/m"]);
    says(with(floor().damping(-1.0)), &["obstacle \"floor\" damping = -1"]);
    says(
        with(floor().tangential_damping(f64::NAN)),
        &["obstacle \"floor\" tangential_damping = NaN"],
    );
    let rough = |mu| with(floor().friction_coefficient(mu));
    says(rough(-0.5), &["obstacle \"floor\" friction_coefficient = -0.5", "0 or above"]);
    says(rough(f64::INFINITY), &["obstacle \"floor\" friction_coefficient = inf"]);
    let swapped = with(floor().friction_coefficients(0.4, 0.5));
    says(swapped, &["0.4 at rest, 0.5 sliding", "must not be above the static one"]);
    let still = with(floor().friction_coefficient(0.5).sticking_speed(0.0));
    says(still, &["obstacle \"floor\" sticking_speed = 0", "m/s"]);
    says(
        with(floor().sticking_speed(0.1)),
        &["sticking_speed = 0.1", "give a friction coefficient"],
    );
    let flat = Obstacle::half_plane([0.0, 0.0], [0.0, 0.0]).named("ramp").stiffness(1.0);
    says(with(flat), &["obstacle \"ramp\" normal", "must not be zero"]);
    says(with(Obstacle::half_plane([0.0], [0.0, 1.0]).stiffness(1.0)), &["point", "2 component"]);
    let stiff = |shape| Obstacle::new(shape).stiffness(1.0);
    says(with(stiff(Shape::disc([0.0], 1.0))), &["centre = [0.0]", "2 component"]);
    says(with(stiff(Shape::disc([0.0, 0.0], 0.0))), &["obstacle \"floor\" radius = 0"]);
    says(with(stiff(Shape::cavity([0.0, f64::NAN], 1.0))), &["centre = NaN"]);
    says(with(stiff(Shape::box_between([0.0, 0.0], [1.0, 0.0]))), &["max", "above min"]);
    says(with(stiff(Shape::capsule([1.0, 0.0], [1.0, 0.0], 1.0))), &["to = [1.0, 0.0]", "disc"]);
    says(with(stiff(Shape::union([]))), &["number of parts = 0"]);
    let parts = [Shape::disc([0.0, 0.0], 1.0), Shape::disc([0.0, 0.0], -1.0)];
    says(with(stiff(Shape::union(parts))), &["obstacle \"floor\" part 2 radius = -1"]);
    says(with(floor().stiffness_density(-1.0)), &["stiffness_density = -1", "N/m^3"]);
    says(with(floor().velocity([1.0])), &["velocity = [1.0]", "2 component", "m/s"]);
    says(with(floor().velocity([1.0, f64::INFINITY])), &["component 2", "velocity = inf"]);
    let wrong = |distance: f64, slope: f64| {
        let shape = Obstacle::custom(move |_, gradient| {
            gradient.copy_from_slice(&[0.0, slope]);
            distance
        });
        with(shape.named("own").stiffness(1.0))
    };
    says(wrong(-1.0, 2.0), &["obstacle \"own\"", "node [1]", "gradient of length 2", "t = 0 s"]);
    says(wrong(f64::NAN, 1.0), &["obstacle \"own\"", "distance NaN"]);
    let twice = scene().obstacle(floor()).obstacle(floor()).phase(Phase::until(0.1));
    says(simulate(&twice), &["obstacle name = \"floor\"", "taken"]);
}

#[test]
fn springs() {
    let phase = || Phase::until(0.1).named("walk");
    let with = |spring: Spring| simulate(&scene().spring(spring).phase(phase()));
    let good = || Spring::between([1], [16]).named("A1").stiffness(20.0);
    assert!(with(good()).is_ok());
    says(with(good().stiffness(-1.0)), &["spring \"A1\" stiffness = -1", "0 or above (N/m)"]);
    says(with(good().damping(f64::NAN)), &["spring \"A1\" damping = NaN"]);
    says(with(good().length(0.0)), &["spring \"A1\" length = 0", "above 0 (m)"]);
    says(with(Spring::between([1], "top")), &["\"spring 1\" second end", "4 nodes", "one node"]);
    says(with(Spring::between([1, 2], [16])), &["first end", "2 nodes"]);
    says(with(Spring::between([1], "hub")), &["node set = \"hub\"", "the node sets"]);
    says(with(Spring::between([1], [1])), &["distance of its ends = 0 m", "no direction"]);
    let run = |phase| simulate(&scene().spring(good()).phase(phase));
    says(run(phase().actuate(["A2"], 1.0)), &["phase \"walk\"", "\"A2\"", "actuators \"A1\""]);
    says(run(phase().actuate(["A1"], f64::NAN)), &["actuation of phase \"walk\"", "NaN"]);
    says(
        run(phase().actuate_with(["A1"], |t| if t < 0.05 { 0.0 } else { f64::NAN })),
        &["actuation of spring \"A1\" is NaN at t = 0.0"],
    );
    let twice = scene().spring(good()).spring(good()).phase(phase());
    says(simulate(&twice), &["spring name = \"A1\"", "taken"]);
}

/// On the outer wall of a ring or a shell, alone or together with the inner one, pressure would shrink the body.
#[test]
fn chambers_around_the_body() {
    let ring = |cells| Mesh::ring(0.04, 0.05, [16, 3], cells).unwrap();
    for cells in [Cells::Triangles, Cells::Triangles6, Cells::Rectangles] {
        let body = Body::new(ring(cells), SQUARE_MATERIAL).thickness(0.01).build().unwrap();
        let with = |nodes: &str| {
            let chamber = Chamber::within("c", nodes);
            Scene::new(body.clone()).chamber(chamber).phase(Phase::until(0.1)).validate()
        };
        with("inner").unwrap();
        says(
            with("outer"),
            &["chamber \"c\" nodes = ", "outer", "run around the body", "pressure_on"],
        );
        says(with("boundary"), &["chamber \"c\" nodes = ", "boundary", "run around the body"]);
    }
    for cells in [SolidCells::Tetrahedra10, SolidCells::Hexahedra] {
        let mesh = Mesh::cuboid([0.1, 0.1, 0.1], [3, 3, 3], cells).unwrap();
        let body = Body::new(mesh, SQUARE_MATERIAL).build().unwrap();
        let around = Scene::new(body).chamber(Chamber::within("c", "boundary"));
        let around = around.phase(Phase::until(0.1));
        says(around.validate(), &["chamber \"c\" nodes", "(-1.0e-3 m^3)"]);
    }
}

#[test]
fn chambers() {
    let phase = || Phase::until(0.1).named("inflate").hold("bottom");
    let with = |chamber: Chamber| simulate(&scene().chamber(chamber).phase(phase()));
    let polygon = |nodes: Selection| with(Chamber::within("cell", nodes));
    assert!(polygon([6, 7, 11, 10].into()).is_ok());
    says(polygon([6, 7].into()), &["chamber \"cell\" number of nodes = 2", "3 nodes"]);
    says(polygon([6, 7, 17].into()), &["node = 17", "1 to 16"]);
    // a row inside the body has no side
    says(polygon([5, 6, 7, 8].into()), &["chamber \"cell\" area (m^2)", "enclose nothing"]);
    let corners = Selection::Box { min: vec![0.0, 0.0], max: vec![0.31, 0.0] };
    assert!(with(Chamber::within("cell", corners.clone()).closed_by_line()).is_ok());
    says(polygon(corners), &["chamber \"cell\" nodes", "nodes 1 and 4", "closed_by_line"]);
    says(
        polygon("all".into()),
        &["chamber \"cell\" nodes", "boundary of the body", "node(s) 6, 7, 10, 11 are on none"],
    );
    says(
        with(Chamber::surface("bag", [[1, 2, 3]])),
        &["chamber \"bag\" in dimension = 2", "3 dimensions"],
    );
    let cell = || Chamber::within("cell", [6, 7, 11, 10]);
    says(with(cell().thickness(-1.0)), &["chamber \"cell\" thickness = -1"]);
    let run = |phase| simulate(&scene().chamber(cell()).phase(phase));
    says(
        run(phase().pressure("lung", 1.0)),
        &["pressure of phase \"inflate\" = \"lung\"", "chambers \"cell\""],
    );
    says(run(phase().pressure("cell", f64::INFINITY)), &["pressure of phase \"inflate\"", "inf"]);
    says(
        run(phase().pressure_with("cell", |_| f64::NAN)),
        &["pressure in chamber \"cell\" is NaN at t = 0 s"],
    );
    let twice = scene().chamber(cell()).chamber(cell()).phase(phase());
    says(simulate(&twice), &["chamber name = \"cell\"", "taken"]);
}

#[test]
fn closed_surfaces() {
    let mesh = Mesh::cuboid([1.0, 1.0, 1.0], [2, 2, 2], SolidCells::Tetrahedra).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).build().unwrap();
    let with = |walls: &[[usize; 3]]| {
        let chamber = Chamber::surface("bag", walls.iter().copied());
        simulate(&Scene::new(body.clone()).chamber(chamber).phase(Phase::until(0.01)))
    };
    let closed = [[1, 2, 3], [1, 3, 5], [2, 1, 5], [2, 5, 3]];
    assert!(with(&closed).is_ok());
    says(with(&closed[..3]), &["chamber \"bag\"", "must be closed", "node(s) 2, 3, 5"]);
    let turned = [[1, 2, 3], [1, 3, 5], [1, 2, 5], [2, 5, 3]];
    says(with(&turned), &["chamber \"bag\"", "edge of node(s) 1, 2", "the same way"]);
    says(with(&[[1, 2, 9]]), &["node = 9", "1 to 8"]);
    says(with(&[]), &["volume (m^3)", "enclose nothing"]);
}

#[test]
fn solvers_and_samplings() {
    let scene = square_press(4).unwrap();
    let with = |settings: Settings| scene.simulate(&settings, &Sampling::phase_ends());
    let good = Settings::default;
    says(with(Settings { rtol: 0.0, ..good() }), &["rtol = 0", "above 0"]);
    says(with(Settings { rtol: f64::NAN, ..good() }), &["rtol = NaN"]);
    says(with(Settings { rtol: 1.0, ..good() }), &["rtol = 1", "below 1"]);
    says(with(Settings { alpha: 0.0, ..good() }), &["alpha = 0", "1/s"]);
    says(
        with(Settings { atol_position: Some(-1e-9), ..good() }),
        &["atol_position = -0.000000001"],
    );
    says(with(Settings { max_order: Some(6), ..good() }), &["max_order = 6", "1 to 5"]);
    assert!(with(Settings { max_order: Some(12), method: Method::CvodeAdams, ..good() }).is_ok());
    says(
        with(Settings { max_order: Some(2), method: Method::Rk, ..good() }),
        &["max_order", "leave it out"],
    );
    says(with(Settings { max_steps: 0, ..good() }), &["max_steps = 0"]);
    let sampled = |sampling| scene.simulate(&good(), &sampling);
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        says(sampled(Sampling::every(step)), &[&format!("sampling step = {step}")]);
    }
    says(sampled(Sampling::every(1e-13)), &["sampling step = 0.0000000000001", "2 s"]);
    says(sampled(Sampling::at([0.1, f64::NAN])), &["sampling time = NaN"]);
    says(sampled(Sampling::at([-0.1])), &["sampling time = -0.1"]);
    says(sampled(Sampling::at([0.1, 3.0])), &["sampling time = 3", "2 s"]);
    says("cvode".parse::<Method>(), &["method = \"cvode\"", "cvode-bdf, cvode-adams, ida"]);
    says(square_press(3), &["nodes = 3", "4 nodes"]);
}

/// Statics knows no motion, and so minds no bad start.
#[test]
fn statics() {
    let held = || scene().phase(Phase::until(1.0).hold("bottom").load("top", [0.0, -1.0]));
    let with = |statics: Statics| held().equilibrium(&statics);
    let good = Statics::default;
    assert!(with(Statics { rtol: 1e-3, ..good() }).is_ok());
    for rtol in [0.0, -1e-10, 1e-16, 0.1, 1.0, f64::NAN, f64::INFINITY] {
        let said = format!("statics.rtol = {rtol}");
        says(with(Statics { rtol, ..good() }), &[&said, "1e-14", "1e-2"]);
    }
    for min_load_step in [0.0, -0.1, 1.5, f64::NAN, f64::INFINITY] {
        let said = format!("statics.min_load_step = {min_load_step}");
        says(with(Statics { min_load_step, ..good() }), &[&said, "at most 1"]);
    }
    says(with(Statics { load_steps: 0, ..good() }), &["statics.load_steps = 0"]);
    says(with(Statics { max_iterations: 0, ..good() }), &["statics.max_iterations = 0"]);
    says(scene().equilibrium(&good()), &["number of phases = 0"]);
    assert!(held().initial_displacement(|_| vec![1e20, 0.0]).equilibrium(&good()).is_ok());
}

/// A step limit ends the run with what it has, and says what to do.
#[test]
fn step_limits() {
    let scene = square_press(4).unwrap();
    for method in Method::ALL {
        let settings = Settings { method, max_steps: 100, alpha: 1e4, ..Settings::default() };
        let result = scene.simulate(&settings, &Sampling::every(1e-3));
        let Err(Error::Integration(failure)) = &result else { panic!("{method}: {result:?}") };
        assert!(failure.trajectory.samples().len() > 1, "{method}");
        assert_eq!(failure.trajectory.report().steps(), 100, "{method}");
        says(result, &["push", method.name(), "100 steps", "max_steps"]);
    }
}

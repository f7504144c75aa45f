//! Loads that are spread over faces: bodies under them have the stress that they were given.

use pliant::mesh::CellKind;
use pliant::samples::SQUARE_MATERIAL;
use pliant::{Axis, Body, Cells, Mesh, Phase, Scene, SolidCells, Strain};

use super::solve;

/// Largest distance of a component of the stress of any cell from that of a pull along x, `pull` (Pa), in the
/// axes that are not left to plane strain, over `pull`.
fn roughness(scene: &Scene, pull: f64) -> f64 {
    let found = solve(scene);
    let fields = scene.body().cell_fields(found.displacements());
    let axes = scene.body().mesh().kind().dimension();
    let apart = fields.iter().flat_map(|field| {
        (0..axes).flat_map(move |i| {
            (0..axes).map(move |j| {
                let expected = if (i, j) == (0, 0) { pull } else { 0.0 };
                (field.stress[i][j] - expected).abs() / pull
            })
        })
    });
    apart.fold(0.0, f64::max)
}

/// Cells of different sizes and shapes; sides of the box of 2 m (x 1 m x 1 m) stay straight.
fn uneven<const D: usize>(x: &[f64]) -> [f64; D] {
    std::array::from_fn(|i| match i {
        0 => x[0] + 0.1 * x[0] * (2.0 - x[0]) * (1.0 + x[1]),
        _ => x[i] + 0.3 * x[i] * (1.0 - x[i]),
    })
}

/// The patch test: a body that is pulled along x, free to become thinner, has the same stress all over, by round-off.
/// Its mesh is uneven, so that each node has a part of its own in the pull. `load` gives the phase a pull of
/// 1 kPa on "right", of the given dimension and area (m^2).
fn patch_test(load: impl Fn(Phase, usize, f64) -> Phase) {
    let pull = 1000.0;
    let plane = Phase::until(1.0).hold_axes("left", [Axis::X]).hold_axes([1], [Axis::Y]);
    for cells in Cells::ALL {
        let mesh = Mesh::rectangle([2.0, 1.0], [4, 5], cells).unwrap().mapped(uneven::<2>);
        let body = Body::new(mesh.unwrap(), SQUARE_MATERIAL)
            .thickness(0.01)
            .strain(Strain::Cauchy)
            .build()
            .unwrap();
        let rough = roughness(&Scene::new(body).phase(load(plane.clone(), 2, 0.01)), pull);
        println!("{cells}: {rough:e}");
        assert!(rough < 1e-11, "{cells}: {rough:e}");
        // a membrane in space is pulled at its rim; cells of 9 nodes fill a plane
        if cells == Cells::Rectangles9 {
            continue;
        }
        let mesh = Mesh::rectangle([2.0, 1.0], [4, 5], cells).unwrap();
        let mesh = mesh.mapped(|x| [uneven::<2>(x)[0], uneven::<2>(x)[1], 0.0]).unwrap();
        let body = Body::new(mesh, SQUARE_MATERIAL)
            .thickness(0.01)
            .strain(Strain::Cauchy)
            .build()
            .unwrap();
        let flat = plane.clone().hold_axes("all", [Axis::Z]);
        let rough = roughness(&Scene::new(body).phase(load(flat, 3, 0.01)), pull);
        println!("membrane of {cells}: {rough:e}");
        assert!(rough < 1e-11, "membrane of {cells}: {rough:e}");
    }
    for cells in SolidCells::ALL {
        let mesh = Mesh::cuboid([2.0, 1.0, 1.0], [3, 4, 3], cells).unwrap();
        // the quadrature of quadratic cells is exact of 10 and 20 nodes is exact with mid nodes in the middles only
        let mesh = match cells {
            SolidCells::Tetrahedra10 | SolidCells::Hexahedra20 => mesh,
            _ => mesh.mapped(uneven::<3>).unwrap(),
        };
        let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).build().unwrap();
        let held = Phase::until(1.0).hold_axes("left", [Axis::X]);
        let held = held.hold_axes("front", [Axis::Y]).hold_axes("bottom", [Axis::Z]);
        let rough = roughness(&Scene::new(body).phase(load(held, 3, 1.0)), pull);
        println!("{cells:?}: {rough:e}");
        assert!(rough < 1e-11, "{cells:?}: {rough:e}");
    }
}

#[test]
fn a_total_is_spread_by_the_shape_functions() {
    patch_test(|phase, dimension, area| {
        phase.load_total("right", &[1000.0 * area, 0.0, 0.0][..dimension])
    });
}

/// Where nodes make up no whole faces, each has the same part: a node within takes part as those of the side do.
#[test]
fn a_total_on_nodes_without_faces_is_shared_equally() {
    let mesh = Mesh::rectangle([2.0, 1.0], [4, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).build().unwrap();
    let held = || Phase::until(1.0).hold("left");
    for nodes in [vec![4, 8, 12, 7], vec![4, 12], vec![7]] {
        let each = 3.0 / nodes.len() as f64;
        let [shared, given] = [
            held().load_total(nodes.clone(), [3.0, -1.5]),
            held().load(nodes.clone(), [each, -0.5 * each]),
        ]
        .map(|phase| solve(&Scene::new(body.clone()).phase(phase)));
        assert_eq!(shared.displacements(), given.displacements(), "{nodes:?}");
    }
}

/// A string that is loaded along its length hangs in the parabola y = q x (l - x)/(2 T), if it is stretched
/// by much: its nodes take the load of the segments beside them, which are uneven.
#[test]
fn a_total_along_a_string_is_spread_over_its_length() {
    let stations = [0.0, 0.1, 0.25, 0.5, 0.6, 0.9, 1.0];
    let mesh = Mesh::new(
        2,
        stations.iter().flat_map(|x| [*x, 0.0]).collect(),
        CellKind::Segment,
        (0..6).flat_map(|k| [k, k + 1]).collect(),
    );
    let body = Body::new(mesh.unwrap(), SQUARE_MATERIAL).area(1e-4).build().unwrap();
    let trajectory = Scene::new(body)
        .phase(Phase::until(1e-3).load_total("all", [0.0, -2.0]))
        .simulate(&pliant::Settings::default(), &pliant::Sampling::phase_ends());
    // no force across acts on a straight string but the load: M a = f has the same a all over
    let found = trajectory.unwrap();
    let (v, expected) = (&found.last().v, -2.0 / found.body().mass() * 1e-3);
    for node in 0..7 {
        let error = (v[2 * node + 1] / expected - 1.0).abs();
        assert!(error < 1e-9, "{node}: {error:e}");
    }
}

/// Tractions count per area: no area is given here. Tables and functions of time are spread as constants are.
#[test]
fn a_traction_is_the_stress_below_it() {
    let along = |dimension: usize| vec![1000.0, 0.0, 0.0][..dimension].to_vec();
    patch_test(|phase, dimension, _| phase.traction("right", along(dimension)));
    patch_test(|phase, dimension, _| {
        let [none, twice] =
            [0.0, 2.0].map(|times| along(dimension).iter().map(|x| times * x).collect());
        phase.traction_table("right", [0.0, 2.0], [none, twice] as [Vec<f64>; 2])
    });
    patch_test(|phase, dimension, _| match dimension {
        2 => phase.traction_with("right", |t| [1000.0 * t, 0.0]),
        _ => phase.traction_with("right", |t| [1000.0 * t, 0.0, 0.0]),
    });
}

/// A bar of 2 cm^2 under a pull of 1 kPa at its end, and a string in space likewise.
#[test]
fn ends_have_the_area_of_the_cross_section() {
    let bar = Mesh::bar(0.1, 6).unwrap();
    for (mesh, traction) in [
        (bar.clone(), vec![1000.0]),
        (bar.mapped(|x| [0.0, x[0], 0.0]).unwrap(), vec![0.0, 1000.0, 0.0]),
    ] {
        let axis = traction.len() / 2;
        let body =
            Body::new(mesh, SQUARE_MATERIAL).area(2e-4).strain(Strain::Cauchy).build().unwrap();
        let mut phase = Phase::until(1.0).hold("left").traction("right", traction);
        if axis > 0 {
            phase = phase.hold_axes([2, 3, 4, 5, 6], [Axis::X, Axis::Z]);
        }
        let found = solve(&Scene::new(body.clone()).phase(phase));
        for field in body.cell_fields(found.displacements()) {
            assert!((field.stress[axis][axis] - 1000.0).abs() < 1e-8, "{:?}", field.stress);
        }
    }
}

#[test]
fn tractions_need_faces() {
    let plate = Mesh::rectangle([2.0, 1.0], [4, 3], Cells::Rectangles).unwrap();
    let string = Mesh::bar(0.1, 6).unwrap().mapped(|x| [x[0], 0.0]).unwrap();
    for (mesh, nodes, traction, parts) in [
        (
            &plate,
            vec![4, 8, 7],
            vec![1.0, 0.0],
            ["traction nodes = [4, 8, 7]", "node(s) 7 are on none"],
        ),
        (&plate, vec![4], vec![1.0, 0.0], ["traction nodes = [4]", "node(s) 4 are on none"]),
        (&plate, vec![4, 8], vec![1.0], ["traction = [1.0]", "2 component(s) (N/m^2)"]),
        (&plate, vec![4, 8], vec![1.0, f64::NAN], ["traction", "finite"]),
        (&string, vec![1, 2, 3], vec![1.0, 0.0], ["traction nodes", "a string has no surface"]),
    ] {
        let body = match mesh.kind() {
            CellKind::Segment => Body::new(mesh.clone(), SQUARE_MATERIAL).area(1e-4),
            _ => Body::new(mesh.clone(), SQUARE_MATERIAL).thickness(0.01),
        };
        let scene = Scene::new(body.build().unwrap());
        let phase = Phase::until(1.0).hold([1]).traction(nodes, traction);
        let error = scene.phase(phase).validate().unwrap_err().to_string();
        parts.iter().for_each(|part| assert!(error.contains(part), "{error}"));
    }
}

/// A body that is pressed from all sides, symmetric about planes through three of them, has the true stress -p all
/// over, however much smaller it becomes: the pressure follows its faces.
#[test]
fn pressure_follows_the_faces() {
    let pressure = 2e5;
    let mut scenes = Vec::new();
    let plane = || Phase::until(1.0).hold_axes("left", [Axis::X]).hold_axes("bottom", [Axis::Y]);
    for cells in Cells::ALL {
        let mesh = Mesh::rectangle([2.0, 1.0], [4, 5], cells).unwrap().mapped(uneven::<2>);
        let body = Body::new(mesh.unwrap(), SQUARE_MATERIAL).thickness(0.01);
        scenes.push((body, plane().pressure_on("right", pressure).pressure_on("top", pressure)));
    }
    for cells in SolidCells::ALL {
        let body =
            Body::new(Mesh::cuboid([2.0, 1.0, 1.0], [3, 4, 3], cells).unwrap(), SQUARE_MATERIAL);
        let held = Phase::until(1.0).hold_axes("left", [Axis::X]).hold_axes("front", [Axis::Y]);
        let held = held.hold_axes("bottom", [Axis::Z]);
        let sides = ["right", "back", "top"];
        let pressed = sides.into_iter().fold(held, |phase, side| {
            phase.pressure_on(side, pliant::Signal::ramp(0.0, pressure, 0.0, 1.0))
        });
        scenes.push((body, pressed));
    }
    for (body, phase) in scenes {
        let body = body.strain(Strain::Green).build().unwrap();
        let found = solve(&Scene::new(body.clone()).phase(phase));
        let axes = body.dimension();
        let mut rough = 0.0_f64;
        for field in body.cell_fields(found.displacements()) {
            for (i, row) in field.stress[..axes].iter().enumerate() {
                for (j, stress) in row[..axes].iter().enumerate() {
                    let expected = if i == j { -pressure } else { 0.0 };
                    rough = rough.max((stress - expected).abs() / pressure);
                }
            }
        }
        println!("{:?}: {rough:e}, {} factorizations", body.mesh().kind(), found.factorizations);
        assert!(rough < 1e-9, "{:?}: {rough:e}", body.mesh().kind());
    }
}

//! Files that Gmsh itself has written: volumes, groups and stiffness of what was drawn, in closed form.

use super::*;

/// A brick of 2 x 1 x 1 m in two halves, its bottom face, and the edge of that, as Gmsh 4.8 writes
/// them; tetrahedra and hexahedra in binary, quadratic ones with their tags out of order.
#[test]
fn gmsh_draws_a_brick() {
    for (cells, kind, volume) in [
        ("line", CellKind::Segment, 0.02),
        ("triangles", CellKind::Triangle, 0.02),
        ("triangles6", CellKind::Triangle6, 0.02),
        ("quadrilaterals", CellKind::Quadrilateral, 0.02),
        ("tetrahedra", CellKind::Tetrahedron, 2.0),
        ("tetrahedra10", CellKind::Tetrahedron10, 2.0),
        ("hexahedra", CellKind::Hexahedron, 2.0),
    ] {
        let mesh = committed(&format!("tests/data/gmsh/brick-{cells}.msh"));
        assert_eq!((mesh.kind(), mesh.dimension()), (kind, kind.dimension()), "{cells}");
        // round-off of some hundred sums
        let body = body(&mesh).unwrap();
        assert!((body.volume() / volume - 1.0).abs() < 1e-13, "{cells} {}", body.volume());
        assert!(patch_test(&mesh) < 2e-12, "{cells} {}", patch_test(&mesh));

        // each half is a region; its nodes are a set, too
        let groups: Vec<&str> = mesh.cell_groups().keys().map(String::as_str).collect();
        assert_eq!(groups, ["first", "second"], "{cells}");
        let both = mesh.cell_groups().values().map(Vec::len).sum::<usize>();
        assert_eq!(both, mesh.cell_count());
        let heavy = Material { density: 3000.0, ..RUBBER };
        let builder = match kind.dimension() {
            1 => Body::new(mesh.clone(), RUBBER).strain(Strain::Cauchy).area(0.01),
            2 => Body::new(mesh.clone(), RUBBER).strain(Strain::Cauchy).thickness(0.01),
            _ => Body::new(mesh.clone(), RUBBER).strain(Strain::Cauchy),
        };
        let halves = builder.region("second", heavy).build().unwrap();
        assert!((halves.mass() / (2000.0 * volume) - 1.0).abs() < 1e-13, "{cells}");
        for (name, from, to) in [("first", 0.0, 1.0), ("second", 1.0, 2.0)] {
            let inside = |node: &usize| (from..=to).contains(&mesh.position(*node)[0]);
            assert!(mesh.sets()[name].iter().all(inside), "{cells} {name}");
        }

        let end = &mesh.sets()["end"];
        assert_eq!(end.len(), 1);
        assert_eq!(mesh.position(end[0])[..], [2.0, 0.0, 0.0][..mesh.dimension()], "{cells}");
        if let Some(bottom) = mesh.sets().get("bottom") {
            let on_it = |&node: &usize| mesh.position(node)[mesh.dimension() - 1] == 0.0;
            let expected: Vec<usize> = (0..mesh.node_count()).filter(on_it).collect();
            assert_eq!(*bottom, expected, "{cells}");
        }
    }
}

/// Mid nodes lie between their corners, so that no node of a quadratic cell is at another's place.
#[test]
fn mid_nodes_are_where_they_belong() {
    for cells in ["triangles6", "tetrahedra10"] {
        let mesh = committed(&format!("tests/data/gmsh/brick-{cells}.msh"));
        for cell in mesh.cells() {
            for edge in mesh.kind().edges() {
                let [a, b, middle] = [0, 1, 2].map(|k| mesh.position(cell[edge[k]]));
                for i in 0..mesh.dimension() {
                    // Gmsh places them to some 1e-13
                    assert!((middle[i] - 0.5 * (a[i] + b[i])).abs() < 5e-12, "{cells} {cell:?}");
                }
            }
        }
    }
}

/// The bending actuator: what was drawn, in closed form.
#[test]
fn the_bending_actuator_is_as_drawn() {
    let mesh = committed("scenes/meshes/bending-actuator.msh");
    assert_eq!((mesh.kind(), mesh.dimension()), (CellKind::Triangle6, 2));
    let light = Material { density: 1.0, ..RUBBER };
    let weightless = Material { density: 1e-30, ..RUBBER };
    let body = |region: &str| {
        let body = Body::new(mesh.clone(), weightless).strain(Strain::Cauchy).thickness(1.0);
        body.region(region, light).build().unwrap()
    };
    // mm^2: what is below the gaps, and the bellows above that, without the rooms
    let rubber = 51.5 * 4.0 + 6.0 * 6.5 * 9.0 - 6.0 * 3.5 * 9.5;
    assert!((body("rubber").mass() / (1e-6 * rubber) - 1.0).abs() < 1e-13);
    assert!((body("strain limiting layer").mass() / (1e-6 * 51.5) - 1.0).abs() < 1e-13);
    let at = |name: &str, k: usize| -> Vec<f64> {
        mesh.sets()[name].iter().map(|&node| mesh.position(node)[k]).collect()
    };
    assert_eq!((at("tip", 0), at("tip", 1)), (vec![0.0515], vec![0.0]));
    assert!(at("clamp", 0).iter().all(|&x| x == 0.0) && at("clamp", 1).contains(&0.005));
}

/// Air bends the actuator toward its stiff layer, and sucked empty it bends away.
#[test]
fn the_bending_actuator_bends_to_its_stiff_side() {
    let scene = bending_actuator(committed("scenes/meshes/bending-actuator.msh")).unwrap();
    let tip = scene.body().mesh().sets()["tip"][0];
    let height = |pressure: f64| {
        let phase = Phase::until(1.0).hold("clamp").pressure("air", pressure);
        let scene = Scene::new(scene.body().clone()).chamber(Chamber::within("air", "chamber"));
        let equilibrium = scene.phase(phase).equilibrium(&Statics::default()).unwrap();
        equilibrium.displacements()[2 * tip + 1]
    };
    let (blown, sucked) = (height(500.0), height(-500.0));
    println!("{blown} {sucked}");
    assert!(blown < -2e-3 && sucked > 2e-3, "{blown} {sucked}");
}

/// The hollow block on its plate, in space: volumes in closed form, and it bends to the plate.
#[test]
fn a_hollow_finger_bends_to_its_plate() {
    let mesh = committed("tests/data/gmsh/finger.msh");
    assert_eq!((mesh.kind(), mesh.dimension()), (CellKind::Tetrahedron10, 3));
    let rubber = Material { density: 1100.0, young: 5e5, poisson: 0.45, viscosity: 2e3 };
    let plate = Material { density: 2000.0, young: 1e7, ..rubber };
    let body = Body::new(mesh, rubber).region("plate", plate).strain(Strain::Green);
    let body = body.build().unwrap();
    let (block, air, below) = (30.0 * 10.0 * 6.0, 22.0 * 4.0 * 3.0, 30.0 * 10.0 * 2.0);
    let mass = 1e-9 * (1100.0 * (block - air) + 2000.0 * below);
    assert!((body.mass() / mass - 1.0).abs() < 2e-13, "{} {mass}", body.mass());
    let scene = Scene::new(body)
        .chamber(Chamber::within("air", "chamber"))
        .phase(Phase::until(1.0).hold("clamp").pressure("air", 2e4));
    let equilibrium = scene.equilibrium(&Statics::default()).unwrap();
    let mesh = scene.body().mesh();
    let end = (0..mesh.node_count()).filter(|&node| mesh.position(node)[0] > 0.03 - 1e-9);
    for node in end {
        let z = equilibrium.displacements()[3 * node + 2];
        assert!(z < -1e-4, "{z}");
    }
}

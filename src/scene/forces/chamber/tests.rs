//! Chambers next to a body: areas and volumes in closed form, and walls that enclose none.

use super::{Chamber, Geometry};
use crate::base::sparse::BlockMatrix;
use crate::elements::body::{Body, Strain};
use crate::elements::force::Force;
use crate::elements::mesh::{CellKind, Cells, Mesh, Selection, SolidCells};
use crate::studies::samples::SQUARE_MATERIAL;

fn body(mesh: Mesh) -> Body {
    let dimension = mesh.kind().dimension();
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy);
    match dimension {
        1 => body.area(1e-4),
        2 => body.thickness(0.01),
        _ => body,
    }
    .build()
    .unwrap()
}

/// `mesh` without the cells whose nodes all lie between `min` and `max` (in all axes), with the nodes on the
/// rim of that hole named "walls"; nodes that are left without cells are dropped.
fn hollow(mesh: &Mesh, min: f64, max: f64) -> Mesh {
    let d = mesh.dimension();
    let inside = |&node: &usize| mesh.position(node).iter().all(|x| (min..=max).contains(x));
    let kept: Vec<&[usize]> = mesh.cells().filter(|cell| !cell.iter().all(inside)).collect();
    let mut numbers = vec![None; mesh.node_count()];
    kept.iter().for_each(|cell| cell.iter().for_each(|&node| numbers[node] = Some(0)));
    numbers.iter_mut().flatten().enumerate().for_each(|(number, place)| *place = number);
    let walls: Vec<usize> = (0..mesh.node_count())
        .filter(inside)
        .filter_map(|node| numbers[node])
        .map(|n| n + 1)
        .collect();
    let nodes = (0..mesh.node_count()).filter(|&node| numbers[node].is_some());
    let positions = nodes.flat_map(|node| mesh.position(node).to_vec()).collect();
    let connectivity = kept.concat().into_iter().filter_map(|node| numbers[node]).collect();
    let mesh = Mesh::new(d, positions, mesh.kind(), connectivity).unwrap();
    mesh.name_nodes("walls", walls).unwrap()
}

/// Area or volume of the chamber within `walls`, as the force counts it: positive, if pressure
/// enlarges it.
fn enclosed(body: &Body, walls: impl Into<Selection>) -> f64 {
    let force = Chamber::within("air", walls).force(body, Vec::new()).unwrap();
    let rest = vec![0.0; body.dofs()];
    match &force.geometry {
        Geometry::Polygon(polygon, factor) => factor / 0.01 * polygon.measure(&rest),
        Geometry::Surface(surface, factor) => factor * surface.measure(&rest),
        Geometry::Circles(circles, factor) => factor * circles.measure(&rest),
    }
}

fn problem(body: &Body, walls: impl Into<Selection>) -> String {
    match Chamber::within("air", walls).force(body, Vec::new()) {
        Ok(_) => panic!("accepted"),
        Err(error) => error.to_string(),
    }
}

/// A hole of 2 x 2 m in a plate, and of 2 x 2 x 2 m in a block. Closed boundaries of all kinds of cells give
/// these values up to round-off.
#[test]
fn holes() {
    for cells in Cells::ALL {
        let mesh = Mesh::rectangle([4.0, 4.0], [5, 5], cells).unwrap();
        let hollowed = body(hollow(&mesh, 1.0, 3.0));
        assert!((enclosed(&hollowed, "walls") - 4.0).abs() < 1e-13, "{cells}");
        let around = Selection::Box { min: vec![0.9; 2], max: vec![3.1; 2] };
        assert!((enclosed(&hollowed, around) - 4.0).abs() < 1e-13, "{cells}");
    }
    for cells in SolidCells::ALL {
        let mesh = Mesh::cuboid([4.0; 3], [5; 3], cells).unwrap();
        let hollowed = body(hollow(&mesh, 1.0, 3.0));
        let volume = enclosed(&hollowed, "walls");
        assert!((volume - 8.0).abs() < 1e-13, "{cells:?}: {volume}");
    }
}

/// A pit of 2 x 2 x 2 m in a block, open at the top, under a lid: its volume, its derivatives against finite
/// differences, and no net force of the pressure in it, whatever the displacements.
#[test]
fn lids() {
    for cells in SolidCells::ALL {
        let mesh = Mesh::cuboid([4.0, 4.0, 3.0], [5, 5, 4], cells).unwrap();
        let pit = body(hollow(&mesh, 1.0, 3.0));
        assert!(problem(&pit, "walls").contains("closed_by_lid"));
        let pressure = vec![crate::scene::forces::Signal::from(2.0)];
        let chamber = Chamber::within("air", "walls").closed_by_lid();
        let force = chamber.force(&pit, pressure).unwrap();
        let volume = force.volume(&vec![0.0; pit.dofs()]);
        assert!((volume - 8.0).abs() < 1e-13, "{cells:?}: {volume}");
        let u: Vec<f64> = (0..pit.dofs()).map(|dof| 0.1 * (1.7 * dof as f64).sin()).collect();
        let gradient = |u: &[f64]| {
            let mut forces = crate::elements::force::NodalForces::zeros(u.len());
            force.add_forces(0.0, u, u, &mut forces).unwrap();
            forces.applied
        };
        let forces = gradient(&u);
        for axis in 0..3 {
            let net: f64 = forces.iter().skip(axis).step_by(3).sum();
            assert!(net.abs() < 1e-13, "{cells:?}: {net}");
        }
        let pattern = std::sync::Arc::new(pit.inertia().pattern().with_pairs(&force.couplings()));
        let [mut tangents, mut none] = [(); 2].map(|()| BlockMatrix::zeros(&pattern, 3));
        force.add_tangents(0.0, &u, &u, &mut tangents, &mut none);
        // V is linear in each component of u: differences are off by round-off alone
        let step = 1e-3;
        for dof in (0..pit.dofs()).step_by(7) {
            let mut moved = [u.clone(), u.clone()];
            (moved[0][dof], moved[1][dof]) = (u[dof] - step, u[dof] + step);
            let slope = moved.each_ref().map(|u| 2.0 * force.volume(u));
            let slope = (slope[1] - slope[0]) / (2.0 * step);
            assert!((slope - forces[dof]).abs() < 2e-11, "{cells:?} {dof}: {slope}");
            let sides = moved.each_ref().map(|u| gradient(u));
            for (other, (up, down)) in sides[1].iter().zip(sides[0].iter()).enumerate() {
                let slope = (up - down) / (2.0 * step);
                let found = -tangents.get(other, dof);
                assert!((slope - found).abs() < 1e-11, "{cells:?} {other} {dof}: {slope} {found}");
            }
        }
    }
    let flat = body_of_rectangle();
    let force = Chamber::within("air", "top").closed_by_lid().force(&flat, Vec::new());
    assert!(force.err().unwrap().to_string().contains("say closed_by_line"));
}

/// Two rooms with the same pressure, apart or corner to corner.
#[test]
fn reservoirs() {
    let plate = Mesh::rectangle([5.0, 5.0], [6, 6], Cells::Rectangles).unwrap();
    for min in [2.0, 3.0] {
        let mesh = hollow(&hollow(&plate, 1.0, 2.0), min, min + 1.0);
        let inner = |node: &&usize| mesh.position(**node).iter().all(|x| (0.5..=4.5).contains(x));
        let walls: Vec<usize> =
            mesh.boundary_nodes().iter().filter(inner).map(|node| node + 1).collect();
        let mesh = mesh.clone().name_nodes("walls", walls).unwrap();
        assert!((enclosed(&body(mesh), "walls") - 2.0).abs() < 1e-13);
    }
}

/// The chamber is on the side of its walls that is opposite to the body: if that is the outside, pressure
/// makes the body smaller.
#[test]
fn the_world_around_a_body() {
    let mesh = Mesh::rectangle([4.0, 3.0], [5, 4], Cells::Triangles6).unwrap();
    assert!((enclosed(&body(mesh), "boundary") + 12.0).abs() < 1e-13);
    let mesh = Mesh::cuboid([4.0, 3.0, 2.0], [3, 3, 3], SolidCells::Tetrahedra10).unwrap();
    let volume = enclosed(&body(mesh), "boundary");
    assert!((volume + 24.0).abs() < 1e-13, "{volume}");
}

/// Chains may be closed by the line between their ends: the inner side of half a ring, with the area of
/// half a polygon of n corners on its circle; and a side of a rectangle, which encloses nothing yet.
#[test]
fn chains() {
    let mesh = Mesh::half_ring(0.04, 0.05, [21, 3], Cells::Triangles).unwrap();
    let inner: Vec<usize> = (0..21).rev().map(|station| 3 * station + 1).collect();
    let arch = body(mesh.name_nodes("inner side", inner).unwrap());
    let area = 10.0 * 0.04_f64.powi(2) * (std::f64::consts::PI / 20.0).sin();
    let closed = |body: &Body, nodes: &str| {
        Chamber::within("air", nodes).closed_by_line().force(body, Vec::new()).unwrap()
    };
    let rest = vec![0.0; arch.dofs()];
    assert!((closed(&arch, "inner side").volume(&rest) / (0.01 * area) - 1.0).abs() < 1e-12);
    let flat = body_of_rectangle();
    let force = closed(&flat, "top");
    assert_eq!(force.volume(&vec![0.0; flat.dofs()]), 0.0);
    let Geometry::Polygon(polygon, factor) = &force.geometry else { panic!() };
    // lifted by 1 m with the ends at rest, the chamber loses 3 m^2: 4 x 1 m less the two slopes,
    // 1 m wide each
    let mut u = vec![0.0; flat.dofs()];
    for &node in &flat.mesh().sets()["top"] {
        let x = flat.mesh().position(node)[0];
        u[2 * node + 1] = if x == 0.0 || x == 4.0 { 0.0 } else { 1.0 };
    }
    assert!((factor / 0.01 * polygon.measure(&u) + 3.0).abs() < 1e-13);
}

fn body_of_rectangle() -> Body {
    body(Mesh::rectangle([4.0, 3.0], [5, 4], Cells::Triangles).unwrap())
}

/// Strings and membranes have no inside: pressure enlarges what they enclose, whichever way round
/// their cells run.
#[test]
fn bags() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for cells in [[0, 1, 1, 2, 2, 3, 3, 0], [1, 0, 2, 1, 3, 2, 0, 3]] {
        let mesh = Mesh::new(2, square.concat(), CellKind::Segment, cells.to_vec());
        let string = body(mesh.unwrap());
        let chamber = Chamber::within("air", "all").thickness(0.01).force(&string, Vec::new());
        let Geometry::Polygon(polygon, factor) = &chamber.unwrap().geometry else { panic!() };
        assert_eq!(factor / 0.01 * polygon.measure(&[0.0; 8]), 1.0);
    }
    let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    for cells in [[0, 1, 2, 0, 3, 1, 1, 3, 2, 0, 2, 3], [1, 0, 2, 3, 0, 1, 3, 1, 2, 2, 0, 3]] {
        let mesh = Mesh::new(3, corners.to_vec(), CellKind::Triangle, cells.to_vec()).unwrap();
        assert!((enclosed(&body(mesh), "all") - 1.0 / 6.0).abs() < 1e-15);
    }
    let one_turned = vec![1, 0, 1, 2, 2, 3, 3, 0];
    let mesh = Mesh::new(2, square.concat(), CellKind::Segment, one_turned).unwrap();
    assert!(problem(&body(mesh), "all").contains("node(s) 1, 2: "));
    let one_turned = vec![1, 0, 2, 0, 3, 1, 1, 3, 2, 0, 2, 3];
    let mesh = Mesh::new(3, corners.to_vec(), CellKind::Triangle, one_turned).unwrap();
    assert!(problem(&body(mesh), "all").contains("the same way"));
}

#[test]
fn walls_that_enclose_nothing() {
    let plate = body_of_rectangle();
    let named = |numbers: &[usize]| {
        let mesh = plate.mesh().clone().name_nodes("walls", numbers.to_vec()).unwrap();
        problem(&body(mesh), "walls")
    };
    let says = |message: &str, parts: &[&str]| {
        println!("{message}");
        assert!(message.starts_with("chamber \"air\" "), "{message}");
        parts.iter().for_each(|part| assert!(message.contains(part), "{message}"));
    };
    // inside the body; two sides; a part of one
    says(&named(&[1, 2, 3, 7]), &["node(s) 7 are on none"]);
    says(&named(&[1, 2, 3, 18, 19, 20]), &["open chains", "ends at node(s) 1, 3, 18, 20"]);
    says(&named(&[1, 2]), &["number of nodes = 2"]);
    // one side, open between its ends
    says(&problem(&plate, "top"), &["open between the nodes 16 and 20: ", "closed_by_line"]);

    let cube = body(Mesh::cuboid([1.0; 3], [3; 3], SolidCells::Hexahedra).unwrap());
    let by_line = Chamber::within("air", "top").closed_by_line().force(&cube, Vec::new());
    says(&by_line.err().unwrap().to_string(), &["closed_by_line = true", "in the plane only"]);
    says(&problem(&cube, "top"), &["must be closed", "node(s) 19, 20, 21, 22, 24, 25, 26, 27"]);
    says(&problem(&cube, "all"), &["node(s) 14 are on none"]);
    let line = Mesh::bar(1.0, 4).unwrap();
    for mesh in [line.clone(), line.mapped(|x| [x[0], 0.0, 0.0]).unwrap()] {
        says(&problem(&body(mesh), "all"), &[]);
    }
}

/// A chamber is as thick as the body of its walls.
#[test]
fn the_thickness_is_that_of_the_body_of_the_walls() {
    let square = |name: &str, thickness: f64| {
        let mesh = Mesh::rectangle([0.2, 0.1], [2, 2], Cells::Triangles).unwrap();
        Body::new(mesh, SQUARE_MATERIAL).thickness(thickness).named(name).build().unwrap()
    };
    let both = Body::join([square("thin", 0.01), square("thick", 0.03)]).unwrap();
    for (walls, thickness) in [([1, 2, 4, 3], 0.01), ([5, 6, 8, 7], 0.03)] {
        let force = Chamber::within("air", walls).force(&both, Vec::new()).unwrap();
        let volume = force.volume(&vec![0.0; both.dofs()]);
        assert!((volume - 0.02 * thickness).abs() < 1e-15, "{volume}");
    }
}

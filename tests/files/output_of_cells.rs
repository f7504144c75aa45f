//! Pictures and files for ParaView of every kind of cell.

use std::fs;

use pliant::output::{Snapshots, write_vtk};
use pliant::{
    Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings, SolidCells, Strain, Trajectory,
};

use crate::vtu::arrays;

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 40.0 };

/// A bar, rectangle or cuboid, pulled at its upper or right end.
fn pulled(mesh: Mesh) -> Trajectory {
    let (kind, dimension) = (mesh.kind(), mesh.dimension());
    let body = Body::new(mesh, RUBBER).strain(Strain::Cauchy);
    let body = match kind.dimension() {
        1 => body.area(1e-4),
        2 => body.thickness(0.01),
        _ => body,
    };
    let [still, moving] = if kind.dimension() == 1 { ["left", "right"] } else { ["bottom", "top"] };
    let mut velocity = vec![0.3; dimension];
    velocity[0] = 0.5;
    let phase = Phase::until(0.01).hold(still).move_nodes(moving, velocity);
    let scene = Scene::new(body.build().unwrap()).phase(phase);
    scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap()
}

/// A body of every kind of cell, the number of its type in VTK files, and the polygons (or lines)
/// of its picture with their numbers of points.
fn bodies() -> Vec<(Trajectory, u8, usize, usize)> {
    let flat = |cells| Mesh::rectangle([0.04, 0.02], [4, 3], cells).unwrap();
    let solid = |cells| Mesh::cuboid([0.04, 0.02, 0.03], [4, 3, 5], cells).unwrap();
    let bar = Mesh::bar(0.04, 5).unwrap();
    let membrane = flat(Cells::Triangles).mapped(|x| [x[0], 0.0, x[1]]).unwrap();
    // squares on the three sides of the cuboid that look at the viewer
    let seen = 3 * 2 + 3 * 4 + 2 * 4;
    let cases = [
        (bar.clone(), 3, 4, 4),
        (bar.mapped(|x| [x[0], 0.1 * x[0]]).unwrap(), 3, 4, 2),
        (flat(Cells::Triangles), 5, 12, 3),
        (flat(Cells::Triangles6), 22, 12, 6),
        (flat(Cells::Rectangles), 9, 6, 4),
        (flat(Cells::Rectangles9), 28, 6, 8),
        (membrane, 5, 12, 3),
        (solid(SolidCells::Hexahedra), 12, seen, 4),
        (solid(SolidCells::Tetrahedra), 10, 2 * seen, 3),
        (solid(SolidCells::Tetrahedra10), 24, 2 * seen, 6),
        (solid(SolidCells::Hexahedra20), 25, seen, 8),
        (solid(SolidCells::Hexahedra27), 29, seen, 8),
    ];
    cases.map(|(mesh, vtk, shapes, points)| (pulled(mesh), vtk, shapes, points)).into()
}

#[test]
fn pictures_show_all_cells_or_their_surface() {
    let directory = tempfile::tempdir().unwrap();
    for (number, (trajectory, _, shapes, points)) in bodies().into_iter().enumerate() {
        let kind = trajectory.body().mesh().kind();
        let path = directory.path().join(format!("{number}.svg"));
        Snapshots::at([0.0]).write(&trajectory, &path).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let group = document.descendants().find(|node| node.attribute("class") == Some("cells"));
        let paths = group.unwrap().descendants().filter_map(|node| node.attribute("d"));
        let data: String = paths.collect();
        assert_eq!(data.matches('M').count(), shapes, "{kind:?}: {data}");
        assert_eq!(data.matches('l').count(), shapes * (points - 1), "{kind:?}: {data}");
    }
}

/// Marks of nodes that a solid hides are left out: of the 4 x 3 nodes that are held at its bottom two edges are seen, of those that
/// are moved all 12 at its top.
#[test]
fn marks_behind_a_solid_are_hidden() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("cuboid.svg");
    let mesh = Mesh::cuboid([0.04, 0.02, 0.03], [4, 3, 5], SolidCells::Hexahedra).unwrap();
    Snapshots::at([0.0]).write(&pulled(mesh), &path).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let panel = document.descendants().find(|node| node.attribute("class") == Some("panel"));
    let dots = panel.unwrap().descendants().filter(|node| node.has_tag_name("circle"));
    let radii: Vec<&str> = dots.map(|dot| dot.attribute("r").unwrap()).collect();
    let count = |radius| radii.iter().filter(|r| **r == radius).count();
    assert_eq!([count("3.2"), count("3.8")], [6, 12], "{radii:?}");
}

/// Mid nodes are drawn between the corners that they lie between.
#[test]
fn quadratic_triangles_are_drawn_through_their_mid_nodes() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("triangle.svg");
    let mesh = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Triangles6).unwrap();
    Snapshots::at([0.0]).write(&pulled(mesh), &path).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let path = document.descendants().find(|node| node.attribute("class") == Some("cells"));
    let data = path.unwrap().attribute("d").unwrap().replace("-", " -");
    let first = data.split('z').next().unwrap().split('l').skip(1);
    // around the lower triangle: twice to the right, twice up to the left, once down
    let steps: Vec<[f64; 2]> = first
        .map(|step| {
            let mut numbers = step.split_whitespace().map(|x| x.parse().unwrap());
            [numbers.next().unwrap(), numbers.next().unwrap()]
        })
        .collect();
    let half = steps[0][0];
    let expected = [[1, 0], [1, 0], [-1, -1], [-1, -1], [0, 1]];
    for (step, expected) in steps.iter().zip(expected) {
        for (x, e) in step.iter().zip(expected) {
            assert!((x - half * f64::from(e)).abs() < 0.021, "{steps:?}");
        }
    }
    assert_eq!(steps.len(), 5);
}

#[test]
fn vtk_files_name_the_kind_of_cell() {
    let directory = tempfile::tempdir().unwrap();
    for (trajectory, number, ..) in bodies() {
        let mesh = trajectory.body().mesh();
        write_vtk(&trajectory, directory.path(), "body").unwrap();
        let path = directory.path().join("body_0000.vtu");
        let [nodes, ends, types] = &*arrays(&path, "Cells") else { panic!() };
        assert_eq!(types.numbers, vec![f64::from(number); mesh.cell_count()], "{:?}", mesh.kind());
        assert_eq!(ends.numbers.len(), mesh.cell_count());
        assert_eq!(ends.numbers.last(), Some(&(nodes.numbers.len() as f64)));
        assert_eq!(arrays(&path, "Points")[0].numbers.len(), 3 * mesh.node_count());
    }
}

/// Of several bodies each cell has the number of its body, and stretches by its own measure of strain.
#[test]
fn vtk_files_tell_bodies_apart() {
    let body = |strain: Strain, x: f64| {
        let mesh = Mesh::rectangle([0.04, 0.02], [2, 2], Cells::Rectangles).unwrap();
        let mesh = mesh.translated(&[x, 0.0]).unwrap();
        Body::new(mesh, RUBBER).thickness(0.01).strain(strain).build().unwrap()
    };
    let both = Body::join([body(Strain::Cauchy, 0.0), body(Strain::Green, 0.1)]).unwrap();
    // twice as long, and as high as before
    let stretched = |x: &[f64]| vec![if x[0] < 0.05 { x[0] } else { x[0] - 0.1 }, 0.0];
    let scene = Scene::new(both).initial_displacement(stretched).phase(Phase::until(1e-6));
    let motion = scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap();
    let directory = tempfile::tempdir().unwrap();
    write_vtk(&motion, directory.path(), "both").unwrap();
    let arrays = arrays(&directory.path().join("both_0000.vtu"), "CellData");
    let of_cells = |wanted: &str| {
        let array = arrays.iter().find(|array| array.name == wanted);
        &array.unwrap().numbers
    };
    assert_eq!(*of_cells("body"), [0.0, 1.0]);
    assert!(of_cells("largest_stretch").iter().all(|stretch| (stretch - 2.0).abs() < 1e-9));
}

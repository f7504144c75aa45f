//! Meshes whose cells do not meet in whole faces, or lie on each other: nodes and pairs counted by hand.

use pliant::mesh::CellKind;
use pliant::{Body, Cells, Indicator, InputError, Material, Mesh, Phase, Scene, SolidCells};

const SOFT: Material = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };

fn body(mesh: Mesh) -> Result<Body, InputError> {
    let body = Body::new(mesh.clone(), SOFT);
    if mesh.kind().dimension() == 2 { body.thickness(0.01) } else { body }.build()
}

fn indicator(mesh: Mesh, name: &str) -> Indicator {
    let scene = Scene::new(body(mesh).unwrap()).phase(Phase::until(0.1));
    scene.indicators().into_iter().find(|told| told.name == name).unwrap()
}

fn conformity(mesh: Mesh) -> Indicator {
    indicator(mesh, "conformity")
}

/// A cell beside two (in the plane) or four (in space) of half its size, shifted far from the origin: nodes of the small ones in
/// the middles of edges and faces of the large one hang.
#[test]
fn nodes_on_faces_of_other_cells() {
    let plane = |kind, cells: &[usize], places: &[[f64; 2]]| {
        let positions = places.iter().flat_map(|[x, y]| [0.1 * x + 3.0, 0.1 * y - 2.0]);
        Mesh::new(2, positions.collect(), kind, cells.to_vec()).unwrap()
    };
    let corners =
        [[0., 0.], [1., 0.], [1., 1.], [0., 1.], [2., 0.], [2., 0.5], [1., 0.5], [2., 1.]];
    let quads = [0, 1, 2, 3, 1, 4, 5, 6, 6, 5, 7, 2];
    let told = conformity(plane(CellKind::Quadrilateral, &quads, &corners));
    assert_eq!(told.value, 1.0, "{told}");
    assert!(
        told.text.contains("1 node(s) hang")
            && told.text.contains("node 7 at (3.1, -1.95) m on cell 1"),
        "{told}"
    );
    let triangles = [0, 1, 2, 0, 2, 3, 1, 4, 6, 4, 5, 6, 6, 5, 7, 6, 7, 2];
    assert_eq!(conformity(plane(CellKind::Triangle, &triangles, &corners)).value, 1.0);
    // the middle of the large cell's edge is a corner of the small ones, whose own middles there hang
    let nine = |at: [f64; 2], size: f64| {
        let places = [
            [0., 0.],
            [1., 0.],
            [1., 1.],
            [0., 1.],
            [0.5, 0.],
            [1., 0.5],
            [0.5, 1.],
            [0., 0.5],
            [0.5, 0.5],
        ];
        places.map(|[x, y]| [at[0] + size * x, at[1] + size * y])
    };
    let (mut places, mut cells) = (Vec::new(), Vec::new());
    for place in [nine([0., 0.], 1.), nine([1., 0.], 0.5), nine([1., 0.5], 0.5)].concat() {
        let known = places.iter().position(|other| *other == place);
        cells.push(known.unwrap_or(places.len()));
        if known.is_none() {
            places.push(place);
        }
    }
    assert_eq!(conformity(plane(CellKind::Quadrilateral9, &cells, &places)).value, 2.0);
    // in space: four middles of edges and that of the face
    let cube = |at: [f64; 3], size: f64| {
        [
            [0., 0., 0.],
            [1., 0., 0.],
            [1., 1., 0.],
            [0., 1., 0.],
            [0., 0., 1.],
            [1., 0., 1.],
            [1., 1., 1.],
            [0., 1., 1.],
        ]
        .map(|x| [0, 1, 2].map(|i| at[i] + size * x[i]))
    };
    let small = [[0., 0.], [0.5, 0.], [0., 0.5], [0.5, 0.5]].map(|[y, z]| cube([1., y, z], 0.5));
    let (mut places, mut cells) = (Vec::new(), Vec::new());
    for place in [&[cube([0.; 3], 1.)], &small[..]].concat().concat() {
        let known = places.iter().position(|other: &[f64; 3]| *other == place);
        cells.push(known.unwrap_or(places.len()));
        if known.is_none() {
            places.push(place);
        }
    }
    let mesh = Mesh::new(3, places.concat(), CellKind::Hexahedron, cells).unwrap();
    assert_eq!(conformity(mesh).value, 5.0);
}

/// A row of cells that is cut open between the first and the second of two layers, but for its right end: pairs of nodes in the same
/// position. One pair is 1e-7 m apart, as of a file with few digits.
#[test]
fn nodes_in_the_same_position() {
    let whole = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Rectangles).unwrap();
    let mut positions = whole.positions().to_vec();
    let mut cells: Vec<usize> = whole.cells().flatten().copied().collect();
    for node in [4, 5, 6] {
        let double = positions.len() / 2;
        positions.extend([positions[2 * node], positions[2 * node + 1] + 1e-7 * (node % 2) as f64]);
        cells[12..].iter_mut().filter(|other| **other == node).for_each(|other| *other = double);
    }
    let told = conformity(Mesh::new(2, positions, CellKind::Quadrilateral, cells).unwrap());
    assert_eq!(told.value, 3.0, "{told}");
    assert!(
        told.text.contains("3 pair(s)") && told.text.contains("nodes 5 and 13 at (0, 0.1) m"),
        "{told}"
    );
}

/// Generated meshes of all kinds, thin ones and curved ones, hold together.
#[test]
fn whole_meshes_hold_together() {
    let mut meshes = vec![];
    for cells in Cells::ALL {
        meshes.push(Mesh::rectangle([0.1, 0.1], [4, 4], cells).unwrap());
        meshes.push(Mesh::rectangle([1.0, 1e-3], [5, 3], cells).unwrap());
        meshes.push(Mesh::ring(0.04, 0.05, [24, 3], cells).unwrap());
        meshes.push(Mesh::graded_rectangle([0.1, 0.1], [7, 7], [1e3, 1.0], cells).unwrap());
    }
    for cells in SolidCells::ALL {
        meshes.push(Mesh::cuboid([0.1, 0.1, 0.1], [3, 3, 3], cells).unwrap());
        meshes.push(Mesh::cuboid([1.0, 0.5, 1e-3], [4, 3, 2], cells).unwrap());
    }
    for mesh in meshes {
        let told = conformity(mesh.clone());
        assert_eq!(told.value, 0.0, "{:?}: {told}", mesh.kind());
        let overlap = indicator(mesh, "drawn-overlap");
        assert_eq!(overlap.value, 0.0, "{overlap}");
    }
}

/// Cells on the same side of a face that they share are refused, and so is a third cell at a face; cells that share a node alone and
/// lie on each other are warned of.
#[test]
fn cells_on_each_other() {
    let triangles = |places: &[f64], cells: &[usize]| {
        Mesh::new(2, places.to_vec(), CellKind::Triangle, cells.to_vec()).unwrap()
    };
    let places = [0.0, 0.0, 0.1, 0.0, 0.0, 0.1, 0.03, 0.03, 0.1, 0.1];
    let refused = |mesh: Mesh| body(mesh).unwrap_err().to_string();
    let folded = refused(triangles(&places[..8], &[0, 1, 2, 1, 2, 3]));
    // also where (1, 2, 3) runs clockwise
    assert!(folded.contains("cells 1 and 2 are on the same side"), "{folded}");
    let folded = refused(triangles(&places[..8], &[0, 1, 2, 3, 1, 2]));
    assert!(
        folded.contains("in the mesh = 1 ")
            && folded.contains("cells 1 and 2 are on the same side"),
        "{folded}"
    );
    assert!(folded.contains("nodes [2, 3], around (0.05, 0.05) m"), "{folded}");
    let third = refused(triangles(&places, &[0, 1, 2, 3, 1, 2, 1, 4, 2]));
    assert!(third.contains("in the mesh = 1 "), "{third}");
    assert!(
        body(triangles(&[0.0, 0.0, 0.1, 0.0, 0.0, 0.1, 0.1, 0.1], &[0, 1, 2, 1, 3, 2])).is_ok()
    );

    let mut cubes = Mesh::cuboid([0.1, 0.1, 0.2], [2, 2, 3], SolidCells::Hexahedra).unwrap();
    assert!(body(cubes.clone()).is_ok());
    // the upper cell is folded over the lower one: its top is below its bottom, mirrored to have a volume above 0
    cubes = cubes.mapped(|x| [x[0], x[1], if x[2] > 0.15 { 0.05 } else { x[2] }]).unwrap();
    let mut cells: Vec<usize> = cubes.cells().flatten().copied().collect();
    let upper: Vec<usize> = [4, 5, 6, 7, 0, 1, 2, 3].map(|k| cells[8 + k]).to_vec();
    cells.splice(8.., upper);
    let positions = cubes.positions().to_vec();
    let folded = refused(Mesh::new(3, positions, CellKind::Hexahedron, cells).unwrap());
    assert!(folded.contains("cells 1 and 2 are on the same side"), "{folded}");

    // they share the node at the origin
    let places = [0.0, 0.0, 0.1, 0.0, 0.0, 0.1, 0.06, -0.02, 0.06, 0.1];
    let told = indicator(triangles(&places, &[0, 1, 2, 0, 3, 4]), "drawn-overlap");
    assert!(told.is_doubtful() && told.text.contains("overlaps itself as it is drawn"), "{told}");
}

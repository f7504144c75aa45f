//! Mesh generators: numbering, counts, volumes, boundaries, and how they meet bad input.

mod boundaries;
mod grading;

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

use pliant::mesh::CellKind;
use pliant::{Body, Cells, InputError, Material, Mesh, SolidCells, Strain};

/// Area or volume of all cells (m^2, m^3).
fn volume(mesh: &Mesh) -> f64 {
    let unit = Material { density: 1.0, young: 1.0, poisson: 0.3, viscosity: 0.0 };
    let body = Body::new(mesh.clone(), unit).strain(Strain::Cauchy);
    let body = if mesh.dimension() == 2 { body.thickness(1.0) } else { body };
    body.build().unwrap().mass()
}

/// The corners of edges, faces and cells that have a node in their middle, and that node, as local numbers (from 0).
pub(crate) fn middles(kind: CellKind) -> Vec<(Vec<usize>, usize)> {
    let edges = kind.edges().iter().filter(|edge| edge.len() == 3);
    let faces = kind.faces().iter().filter(|face| face.len() == 9);
    let mut middles: Vec<_> = edges.map(|edge| (edge[..2].to_vec(), edge[2])).collect();
    middles.extend(faces.map(|face| (face[..4].to_vec(), face[8])));
    match kind {
        CellKind::Quadrilateral9 => middles.push(((0..4).collect(), 8)),
        CellKind::Hexahedron27 => middles.push(((0..8).collect(), 26)),
        _ => {}
    }
    middles
}

fn cells(mesh: &Mesh) -> Vec<Vec<usize>> {
    mesh.cells().map(<[usize]>::to_vec).collect()
}

fn one_based(nodes: &[usize]) -> Vec<usize> {
    nodes.iter().map(|node| node + 1).collect()
}

#[test]
fn rectangles_divide_alike() {
    for (kind, nodes, cells_of_row) in [
        (Cells::Triangles, 20, 8),
        (Cells::Crossed, 20, 8),
        (Cells::Rectangles, 20, 4),
        (Cells::Triangles6, 63, 8),
        (Cells::Rectangles9, 63, 4),
    ] {
        let mesh = Mesh::rectangle([2.0, 0.7], [5, 4], kind).unwrap();
        assert_eq!((mesh.node_count(), mesh.cell_count()), (nodes, 3 * cells_of_row), "{kind:?}");
        assert!((volume(&mesh) - 1.4).abs() < 1e-14, "{kind:?}");
        // corner nodes stand where they stand in every grid
        let plain = Mesh::rectangle([2.0, 0.7], [5, 4], Cells::Triangles).unwrap();
        assert_eq!(mesh.positions()[..40], *plain.positions(), "{kind:?}");
    }
}

#[test]
fn quadrilaterals_run_counter_clockwise() {
    let mesh = Mesh::rectangle([3.0, 3.0], [4, 4], Cells::Rectangles).unwrap();
    assert_eq!(one_based(&cells(&mesh)[0]), [1, 2, 6, 5]);
    assert_eq!(one_based(&cells(&mesh)[8]), [11, 12, 16, 15]);
}

#[test]
fn crossed_diagonals_alternate() {
    let mesh = Mesh::rectangle([3.0, 3.0], [4, 4], Cells::Crossed).unwrap();
    let cells = cells(&mesh);
    // grid cells (0, 0) rising, (1, 0) falling, (2, 0) rising; above them (0, 1) falling
    let of_cell =
        |row: usize, column: usize| [0, 3].map(|part| one_based(&cells[6 * row + part + column]));
    assert_eq!(of_cell(0, 0), [[1, 2, 6], [1, 6, 5]]);
    assert_eq!(of_cell(0, 1), [[2, 3, 6], [7, 6, 3]]);
    assert_eq!(of_cell(0, 2), [[3, 4, 8], [3, 8, 7]]);
    assert_eq!(of_cell(1, 0), [[5, 6, 9], [10, 9, 6]]);
}

/// The cells as sets of positions, on a lattice of 1e-6 m.
fn shapes(mesh: &Mesh) -> BTreeSet<BTreeSet<[i64; 2]>> {
    let place = |&node: &usize| [0, 1].map(|i| (mesh.position(node)[i] * 1e6).round() as i64);
    mesh.cells().map(|cell| cell.iter().map(place).collect()).collect()
}

#[test]
fn crossed_grids_are_their_own_mirror_image() {
    let mirrored = |cells: Cells, nodes: [usize; 2]| {
        let mesh = Mesh::rectangle([2.0, 1.0], nodes, cells).unwrap();
        let mirror = mesh.clone().mapped(|x| [2.0 - x[0], x[1]]).unwrap();
        shapes(&mesh) == shapes(&mirror)
    };
    assert!(mirrored(Cells::Crossed, [5, 4]));
    assert!(!mirrored(Cells::Crossed, [4, 4]));
    assert!(mirrored(Cells::Rectangles, [5, 4]));
    assert!(!mirrored(Cells::Triangles, [5, 4]));
}

#[test]
fn mid_nodes_come_last_row_by_row() {
    let mesh = Mesh::rectangle([2.0, 2.0], [3, 3], Cells::Triangles6).unwrap();
    // bottom line: 10, 11; between: 12 to 16; middle line: 17, 18; and so on
    assert_eq!(mesh.position(9), [0.5, 0.0]);
    assert_eq!(mesh.position(11), [0.0, 0.5]);
    assert_eq!(mesh.position(12), [0.5, 0.5]);
    assert_eq!(mesh.position(16), [0.5, 1.0]);
    assert_eq!(mesh.position(24), [1.5, 2.0]);
    assert_eq!(one_based(&cells(&mesh)[0]), [1, 2, 4, 10, 13, 12]);
    let set = |name: &str| one_based(&mesh.sets()[name]);
    assert_eq!(set("bottom"), [1, 10, 2, 11, 3]);
    assert_eq!(set("top"), [7, 24, 8, 25, 9]);
    assert_eq!(set("left"), [1, 12, 4, 19, 7]);
    assert_eq!(set("right"), [3, 16, 6, 23, 9]);
    let whole = Mesh::rectangle([2.0, 2.0], [3, 3], Cells::Rectangles9).unwrap();
    assert_eq!((whole.positions(), whole.sets()), (mesh.positions(), mesh.sets()));
    assert_eq!(one_based(&cells(&whole)[0]), [1, 2, 5, 4, 10, 14, 17, 12, 13]);
}

/// Every mid node of a straight-sided mesh is the middle of its edge, face or cell, and of no other.
#[test]
fn mid_nodes_are_in_the_middle() {
    for mesh in [
        Mesh::rectangle([2.0, 1.0], [4, 3], Cells::Triangles6).unwrap(),
        Mesh::rectangle([2.0, 1.0], [4, 3], Cells::Rectangles9).unwrap(),
        Mesh::cuboid([2.0, 1.0, 1.5], [3, 4, 3], SolidCells::Tetrahedra10).unwrap(),
        Mesh::cuboid([2.0, 1.0, 1.5], [3, 4, 3], SolidCells::Hexahedra20).unwrap(),
        Mesh::cuboid([2.0, 1.0, 1.5], [3, 4, 3], SolidCells::Hexahedra27).unwrap(),
    ] {
        let mut around = BTreeMap::new();
        for cell in mesh.cells() {
            for (corners, middle) in middles(mesh.kind()) {
                let middle = cell[middle];
                let corners: BTreeSet<usize> = corners.iter().map(|&corner| cell[corner]).collect();
                for axis in 0..mesh.dimension() {
                    let sum: f64 = corners.iter().map(|&node| mesh.position(node)[axis]).sum();
                    let mean = sum / corners.len() as f64;
                    assert!((mesh.position(middle)[axis] - mean).abs() < 1e-15);
                }
                let known = around.entry(middle).or_insert_with(|| corners.clone());
                assert_eq!(*known, corners, "node {middle}");
            }
        }
        let corners = mesh.node_count() - around.len();
        assert!(around.keys().all(|&middle| middle >= corners));
    }
}

/// Hirai's numbering: node (station) radial + k + 1, triangles (inner i, outer i,
/// outer i + 1) and (inner i, outer i + 1, inner i + 1).
#[test]
fn rings_are_numbered_by_station() {
    let mesh = Mesh::ring(0.02, 0.04, [16, 3], Cells::Triangles).unwrap();
    assert_eq!((mesh.node_count(), mesh.cell_count()), (48, 64));
    assert_eq!(mesh.position(0), [0.0, -0.02]);
    assert_eq!(mesh.position(1), [0.0, -0.03]);
    assert_eq!(mesh.position(2), [0.0, -0.04]);
    assert_eq!(mesh.position(4 * 3 + 2), [0.04, 0.0]); // counter-clockwise
    assert_eq!(mesh.position(8 * 3), [0.0, 0.02]);
    let cells = cells(&mesh);
    let of_quad =
        |station: usize, k: usize| [0, 2].map(|part| one_based(&cells[4 * station + part + k]));
    assert_eq!(of_quad(0, 0), [[1, 2, 5], [1, 5, 4]]);
    assert_eq!(of_quad(0, 1), [[2, 3, 6], [2, 6, 5]]);
    assert_eq!(of_quad(15, 1), [[47, 48, 3], [47, 3, 2]]);
    assert_eq!(mesh.sets()["inner"], (0..16).map(|i| 3 * i).collect::<Vec<_>>());
    assert_eq!(mesh.sets()["outer"], (0..16).map(|i| 3 * i + 2).collect::<Vec<_>>());
    assert_eq!(mesh.boundary_nodes().len(), 32);
}

#[test]
fn rings_have_the_area_of_their_polygons() {
    let polygons = |m: f64, angle: f64| 0.5 * m * (angle / m).sin() * (25.0 - 16.0);
    for cells in Cells::ALL {
        let ring = Mesh::ring(4.0, 5.0, [24, 3], cells).unwrap();
        let half = Mesh::half_ring(4.0, 5.0, [13, 3], cells).unwrap();
        let (whole, tolerance) = match cells {
            // parabolas through three points of a circle: the area is short by theta^4 / 480
            Cells::Triangles6 | Cells::Rectangles9 => (9.0 * PI, 2e-5),
            _ => (polygons(24.0, 2.0 * PI), 1e-14),
        };
        assert!((volume(&ring) / whole - 1.0).abs() < tolerance, "{cells:?}");
        assert!((volume(&half) / whole - 0.5).abs() < tolerance, "{cells:?}");
    }
}

#[test]
fn rings_are_symmetric_to_the_last_digit() {
    for around in [12, 32, 44] {
        let ring = Mesh::ring(0.04, 0.05, [around, 3], Cells::Rectangles).unwrap();
        for station in 0..around {
            for k in 0..3 {
                let [x, y] = [0, 1].map(|i| ring.position(station * 3 + k)[i]);
                let mirror = ring.position((around - station) % around * 3 + k);
                assert_eq!([-x, y], mirror, "station {station} of {around}");
                let turned = ring.position((station + around / 4) % around * 3 + k);
                assert_eq!([-y, x], turned, "station {station} of {around}");
            }
        }
    }
}

#[test]
fn quadratic_rings_are_round() {
    for (cells, name, radius) in [Cells::Triangles6, Cells::Rectangles9]
        .into_iter()
        .flat_map(|cells| [(cells, "inner", 0.02), (cells, "outer", 0.04)])
    {
        let ring = Mesh::ring(0.02, 0.04, [6, 2], cells).unwrap();
        assert_eq!(ring.sets()[name].len(), 12);
        // counter-clockwise from straight down
        for (k, &node) in ring.sets()[name].iter().enumerate() {
            let angle = PI * (k as f64 / 6.0 - 0.5);
            let position = ring.position(node);
            assert!((position[0] - radius * angle.cos()).abs() < 1e-16);
            assert!((position[1] - radius * angle.sin()).abs() < 1e-16);
        }
    }
}

#[test]
fn half_rings_stand_on_their_ends() {
    let arch = Mesh::half_ring(0.04, 0.05, [9, 2], Cells::Triangles).unwrap();
    assert_eq!(arch.position(0), [0.04, 0.0]);
    assert_eq!(arch.position(9), [0.0, 0.05]);
    assert_eq!(arch.position(16), [-0.04, 0.0]);
    assert_eq!(one_based(&arch.sets()["right"]), [1, 2]);
    assert_eq!(one_based(&arch.sets()["left"]), [17, 18]);
    assert_eq!(one_based(&arch.sets()["inner"]), [1, 3, 5, 7, 9, 11, 13, 15, 17]);
    assert_eq!(arch.boundary_nodes().len(), 18);
}

#[test]
fn cuboids_number_along_x_then_y_then_z() {
    let size = [2.0, 1.0, 1.5];
    for (kind, nodes, count) in [
        (SolidCells::Hexahedra, 36, 12),
        (SolidCells::Tetrahedra, 36, 72),
        (SolidCells::Tetrahedra10, 5 * 7 * 5, 72),
        // 36 corners, and the edges along x, y and z
        (SolidCells::Hexahedra20, 36 + 2 * 4 * 3 + 3 * 3 * 3 + 3 * 4 * 2, 12),
        (SolidCells::Hexahedra27, 5 * 7 * 5, 12),
    ] {
        let mesh = Mesh::cuboid(size, [3, 4, 3], kind).unwrap();
        assert_eq!((mesh.node_count(), mesh.cell_count()), (nodes, count), "{kind:?}");
        assert!((volume(&mesh) - 3.0).abs() < 1e-13, "{kind:?}");
        assert_eq!(mesh.position(1), [1.0, 0.0, 0.0]);
        assert_eq!(mesh.position(6), [0.0, 2.0 / 3.0, 0.0]);
        assert_eq!(mesh.position(12), [0.0, 0.0, 0.75]);
        for (name, axis, at) in [
            ("left", 0, 0.0),
            ("right", 0, 2.0),
            ("front", 1, 0.0),
            ("back", 1, 1.0),
            ("bottom", 2, 0.0),
            ("top", 2, 1.5),
        ] {
            let there: BTreeSet<usize> =
                (0..nodes).filter(|&node| mesh.position(node)[axis] == at).collect();
            assert_eq!(mesh.sets()[name].iter().copied().collect::<BTreeSet<_>>(), there, "{name}");
        }
    }
    let mesh = Mesh::cuboid(size, [3, 4, 3], SolidCells::Hexahedra).unwrap();
    assert_eq!(one_based(&cells(&mesh)[0]), [1, 2, 5, 4, 13, 14, 17, 16]);
}

#[test]
fn maps_move_nodes_and_keep_the_rest() {
    // Cook's membrane: 48 long, 44 high on the left, from 44 to 60 on the right
    let grid = Mesh::rectangle([1.0, 1.0], [5, 5], Cells::Rectangles).unwrap();
    let before = cells(&grid);
    let cook = grid.mapped(|x| [48.0 * x[0], 44.0 * x[0] + x[1] * (44.0 - 28.0 * x[0])]).unwrap();
    assert_eq!(cook.position(4), [48.0, 44.0]);
    assert_eq!(cook.position(24), [48.0, 60.0]);
    assert_eq!((cells(&cook), cook.sets()["left"].len()), (before, 5));
    assert!((volume(&cook) - 48.0 * (44.0 + 16.0) / 2.0).abs() < 1e-11);
}

#[test]
fn bad_input_is_named() {
    let says = |mesh: Result<Mesh, InputError>, parts: &[&str]| {
        let message = mesh.unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "\"{part}\" is missing from: {message}");
        }
    };
    let triangles = Cells::Triangles;
    says(Mesh::bar(f64::NAN, 3), &["bar.length = NaN"]);
    says(Mesh::bar(1.0, 1), &["bar.nodes = 1 "]);
    says(Mesh::bar(1.0, usize::MAX), &["bar.nodes", "are free"]);
    says(Mesh::rectangle([0.3, 0.0], [4, 4], triangles), &["rectangle.size[1] = 0 "]);
    says(Mesh::rectangle([0.3, 0.3], [4, 1], triangles), &["rectangle.nodes[1] = 1 "]);
    says(Mesh::rectangle([0.3, 0.3], [usize::MAX, 2], triangles), &["rectangle.nodes", "are free"]);
    says(Mesh::ring(0.0, 0.4, [8, 2], triangles), &["ring.inner = 0 "]);
    says(Mesh::ring(0.4, 0.4, [8, 2], triangles), &["ring.outer = 0.4 ", "above the inner"]);
    says(Mesh::ring(0.2, f64::INFINITY, [8, 2], triangles), &["ring.outer = inf"]);
    says(Mesh::ring(0.2, 0.4, [2, 2], triangles), &["ring.nodes[0] = 2 ", "at least 3"]);
    says(Mesh::ring(0.2, 0.4, [8, 1], triangles), &["ring.nodes[1] = 1 "]);
    says(Mesh::ring(0.2, 0.4, [7, 2], Cells::Crossed), &["ring.nodes[0] = 7 ", "even"]);
    says(Mesh::half_ring(0.2, 0.1, [7, 2], triangles), &["half_ring.outer = 0.1"]);
    says(Mesh::half_ring(0.2, 0.4, [1, 2], triangles), &["half_ring.nodes[0] = 1 "]);
    let cuboid = |size, nodes| Mesh::cuboid(size, nodes, SolidCells::Hexahedra);
    says(cuboid([1.0, 1.0, -1.0], [2, 2, 2]), &["cuboid.size[2] = -1 "]);
    says(cuboid([1.0, 1.0, 1.0], [2, 1, 2]), &["cuboid.nodes[1] = 1 "]);
    says(cuboid([1.0, 1.0, 1.0], [2, 3000000, 3000000]), &["cuboid.nodes", "are free"]);
    let grid = || Mesh::rectangle([1.0, 1.0], [2, 2], triangles).unwrap();
    says(
        grid().mapped(|x| [1.0 / x[0], x[1]]),
        &["mapped position of node 1", "inf", "[0.0, 0.0]"],
    );
    says(grid().mapped(|x| [x[0]]), &["mesh.dimension = 1 ", "2 to 3"]);
    says(grid().mapped(|x| [x[0], x[1], 0.0, 0.0]), &["mesh.dimension = 4 "]);
    let solid = cuboid([1.0, 1.0, 1.0], [2, 2, 2]).unwrap();
    says(solid.mapped(|x| [x[0], x[1]]), &["mesh.dimension = 2 ", "dimension 3"]);
    says(Mesh::new(0, vec![], CellKind::Segment, vec![]), &["mesh.dimension = 0 "]);
}

//! How meshes hang together and where they end: neighbours, faces, boundaries.

use super::*;

/// Corners minus edges plus faces minus cells: 1 for a body without holes, 0 for a ring.
fn euler_characteristic(mesh: &Mesh) -> isize {
    let kind = mesh.kind();
    let distinct = |parts: &'static [&'static [usize]], corners: fn(&[usize]) -> usize| {
        let sets: BTreeSet<BTreeSet<usize>> = mesh
            .cells()
            .flat_map(|cell| {
                parts.iter().map(move |part| {
                    part[..corners(part)].iter().map(|&local| cell[local]).collect()
                })
            })
            .collect();
        sets.len() as isize
    };
    let corners_of_face = |face: &[usize]| if face.len() == 6 { 3 } else { face.len() };
    let edges = kind.edges();
    let ends: BTreeSet<usize> = mesh
        .cells()
        .flat_map(|cell| edges.iter().flat_map(move |edge| [cell[edge[0]], cell[edge[1]]]))
        .collect();
    let mut total = ends.len() as isize - distinct(edges, |_| 2) + mesh.cell_count() as isize;
    if kind.dimension() == 3 {
        total += distinct(kind.faces(), corners_of_face) - 2 * mesh.cell_count() as isize;
    }
    total
}

#[test]
fn meshes_are_connected_as_they_look() {
    for cells in Cells::ALL {
        let rectangle = Mesh::rectangle([1.0, 1.0], [4, 3], cells).unwrap();
        assert_eq!(euler_characteristic(&rectangle), 1, "{cells:?}");
        let ring = Mesh::ring(1.0, 2.0, [8, 3], cells).unwrap();
        assert_eq!(euler_characteristic(&ring), 0, "{cells:?}");
        let half = Mesh::half_ring(1.0, 2.0, [8, 3], cells).unwrap();
        assert_eq!(euler_characteristic(&half), 1, "{cells:?}");
    }
    for cells in SolidCells::ALL {
        let cuboid = Mesh::cuboid([1.0, 1.0, 1.0], [4, 3, 3], cells).unwrap();
        assert_eq!(euler_characteristic(&cuboid), 1, "{cells:?}");
    }
}

/// Area vector of a face (m^2): in the plane its length and outward normal.
fn area_vector(mesh: &Mesh, face: &[usize]) -> [f64; 3] {
    let corner = |k: usize| -> [f64; 3] {
        let x = mesh.position(face[k]);
        [x[0], x[1], x.get(2).copied().unwrap_or(0.0)]
    };
    let from = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| b[i] - a[i]);
    if mesh.dimension() == 2 {
        let along = from(corner(0), corner(1));
        return [along[1], -along[0], 0.0];
    }
    let (p, q) = match face.len() {
        4 | 8 | 9 => (from(corner(0), corner(2)), from(corner(1), corner(3))),
        _ => (from(corner(0), corner(1)), from(corner(0), corner(2))),
    };
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        (p[j] * q[k] - p[k] * q[j]) / 2.0
    })
}

/// The boundary of every mesh is closed, looks outward and encloses the volume of the cells; inner
/// faces belong to two cells.
#[test]
fn boundaries_enclose_the_body() {
    let mut meshes = Vec::new();
    for cells in Cells::ALL {
        meshes.push(Mesh::rectangle([2.0, 1.0], [4, 3], cells).unwrap());
        // whose rims are curved
        if !matches!(cells, Cells::Triangles6 | Cells::Rectangles9) {
            meshes.push(Mesh::ring(1.0, 2.0, [8, 3], cells).unwrap());
        }
    }
    for cells in SolidCells::ALL {
        meshes.push(Mesh::cuboid([2.0, 1.0, 1.5], [4, 3, 3], cells).unwrap());
    }
    for mesh in meshes {
        let (kind, dimension) = (mesh.kind(), mesh.dimension());
        let shear = |x: &[f64]| [x[0] + 0.3 * x[1] + 1.0, x[1] - 0.2 * x[0] + 2.0];
        let mesh = match dimension {
            2 => mesh.mapped(shear).unwrap(),
            _ => mesh.mapped(|x| [x[0] + 0.3 * x[2], x[1] - 0.2 * x[0], x[2] + 3.0]).unwrap(),
        };
        let faces = mesh.boundary_faces();
        let (mut sum, mut flux) = ([0.0; 3], 0.0);
        for face in &faces {
            let area = area_vector(&mesh, face);
            let corners = match kind {
                CellKind::Hexahedron | CellKind::Hexahedron20 | CellKind::Hexahedron27 => 4,
                _ => dimension,
            };
            for i in 0..dimension {
                sum[i] += area[i];
                let mean: f64 = face[..corners].iter().map(|&node| mesh.position(node)[i]).sum();
                flux += mean / corners as f64 * area[i];
            }
        }
        assert!(sum.iter().all(|x| x.abs() < 1e-13), "{kind:?}: {sum:?}");
        let enclosed = flux / dimension as f64;
        assert!((enclosed / volume(&mesh) - 1.0).abs() < 1e-13, "{kind:?}: {enclosed}");
        // faces of cells: each once on the boundary or twice inside
        let mut seen: BTreeMap<BTreeSet<usize>, usize> = BTreeMap::new();
        for cell in mesh.cells() {
            for face in kind.faces() {
                *seen.entry(face.iter().map(|&local| cell[local]).collect()).or_default() += 1;
            }
        }
        assert!(seen.values().all(|&times| times <= 2), "{kind:?}");
        let once: BTreeSet<_> = seen.into_iter().filter(|(_, times)| *times == 1).collect();
        let boundary: BTreeSet<(BTreeSet<usize>, usize)> =
            faces.iter().map(|face| (face.iter().copied().collect(), 1)).collect();
        assert_eq!(once, boundary, "{kind:?}");
    }
}

/// The mid nodes of a face stand in the order of its edges, each between the corners that the cell has it between.
#[test]
fn mid_nodes_of_faces_lie_on_their_edges() {
    for cells in [SolidCells::Tetrahedra10, SolidCells::Hexahedra20, SolidCells::Hexahedra27] {
        let kind = Mesh::cuboid([1.0; 3], [2; 3], cells).unwrap().kind();
        for face in kind.faces() {
            let (corners, middles) = face.split_at(face.len() / 2);
            for (k, &middle) in middles.iter().take(corners.len()).enumerate() {
                let ends = [corners[k], corners[(k + 1) % corners.len()]];
                let edge = kind.edges().iter().find(|edge| edge[2] == middle).unwrap();
                let of_cell = [edge[0], edge[1]];
                assert!(of_cell == ends || of_cell == [ends[1], ends[0]], "{kind:?}: {face:?}");
            }
        }
    }
}

#[test]
fn cuboids_have_faces_on_their_sides_only() {
    for (cells, per_square) in [
        (SolidCells::Hexahedra, 1),
        (SolidCells::Tetrahedra, 2),
        (SolidCells::Tetrahedra10, 2),
        (SolidCells::Hexahedra20, 1),
        (SolidCells::Hexahedra27, 1),
    ] {
        let mesh = Mesh::cuboid([2.0, 1.0, 1.5], [4, 3, 5], cells).unwrap();
        let squares = 2 * (3 * 2 + 3 * 4 + 2 * 4);
        assert_eq!(mesh.boundary_faces().len(), per_square * squares, "{cells:?}");
        let sides = ["left", "right", "front", "back", "bottom", "top"];
        let on_sides: BTreeSet<usize> =
            sides.iter().flat_map(|side| mesh.sets()[*side].iter().copied()).collect();
        assert_eq!(mesh.boundary_nodes(), on_sides.into_iter().collect::<Vec<_>>());
    }
}

#[test]
fn strings_and_membranes_are_all_boundary() {
    let string = Mesh::bar(1.0, 5).unwrap().mapped(|x| [0.0, -x[0]]).unwrap();
    assert_eq!((string.dimension(), string.kind()), (2, CellKind::Segment));
    assert_eq!(string.position(4), [0.0, -1.0]);
    assert_eq!(string.boundary_nodes(), [0, 1, 2, 3, 4]);
    assert_eq!(string.boundary_faces(), cells(&string));
    assert_eq!(string.sets()["right"], [4]);

    let membrane = Mesh::rectangle([1.0, 1.0], [3, 3], Cells::Triangles).unwrap();
    let membrane = membrane.mapped(|x| [x[0], 0.0, x[1]]).unwrap();
    assert_eq!(membrane.boundary_nodes().len(), 9);
    assert_eq!(membrane.boundary_faces().len(), 8);
    assert_eq!(membrane.sets()["top"], [6, 7, 8]);
}

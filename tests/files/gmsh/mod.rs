//! Meshes from Gmsh: what was written comes back, and files made by Gmsh itself (`tests/data/gmsh`)
//! have the volumes, groups and stiffness of what was drawn.

mod drawn;
mod mistakes;
mod version_2;

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use pliant::mesh::CellKind;
use pliant::samples::bending_actuator;
use pliant::{
    Body, CellSelection, Cells, Chamber, InputError, Material, Mesh, Phase, Scene, SolidCells,
    Statics, Strain,
};

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.4, viscosity: 40.0 };

fn committed(file: &str) -> Mesh {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    Mesh::read_gmsh(root.join(file)).unwrap()
}

fn read(content: impl AsRef<[u8]>) -> Result<Mesh, InputError> {
    read_by(content, Mesh::read_gmsh)
}

/// In a space of `dimension`.
fn read_in(dimension: usize, content: impl AsRef<[u8]>) -> Result<Mesh, InputError> {
    read_by(content, |path| Mesh::read_gmsh_in(path, dimension))
}

fn read_by(
    content: impl AsRef<[u8]>,
    read: impl Fn(PathBuf) -> Result<Mesh, InputError>,
) -> Result<Mesh, InputError> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("test.msh");
    fs::write(&path, content).unwrap();
    read(path)
}

/// The message of the error says all of `parts`, and names the file.
#[track_caller]
fn says(result: Result<Mesh, InputError>, parts: &[&str]) {
    let Err(error) = result else { panic!("accepted; expected {parts:?}") };
    let message = error.to_string();
    println!("{message}");
    assert!(message.starts_with("mesh file = ") && message.contains("test.msh"));
    for part in parts {
        assert!(message.contains(part), "\"{part}\" is missing from: {message}");
    }
}

/// A mesh as Gmsh writes it: format 4.1, text, one entity; node k gets the tag `tag(k)`.
fn msh(mesh: &Mesh, tag: impl Fn(usize) -> usize) -> String {
    let code = match mesh.kind() {
        CellKind::Segment => 1,
        CellKind::Triangle => 2,
        CellKind::Quadrilateral => 3,
        CellKind::Tetrahedron => 4,
        CellKind::Hexahedron => 5,
        CellKind::Triangle6 => 9,
        CellKind::Quadrilateral9 => 10,
        CellKind::Tetrahedron10 => 11,
        CellKind::Hexahedron27 => 12,
        CellKind::Hexahedron20 => 17,
        _ => unreachable!(),
    };
    let d = mesh.kind().dimension();
    let (nodes, cells) = (mesh.node_count(), mesh.cell_count());
    let mut file = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    writeln!(file, "$Nodes\n1 {nodes} 1 {nodes}\n{d} 1 0 {nodes}").unwrap();
    (0..nodes).for_each(|node| writeln!(file, "{}", tag(node)).unwrap());
    for position in mesh.positions().chunks(mesh.dimension()) {
        let at = |axis: usize| position.get(axis).copied().unwrap_or(0.0);
        writeln!(file, "{} {} {}", at(0), at(1), at(2)).unwrap();
    }
    writeln!(file, "$EndNodes\n$Elements\n1 {cells} 1 {cells}\n{d} 1 {code} {cells}").unwrap();
    for (number, cell) in (1..).zip(mesh.cells()) {
        let mut cell: Vec<String> = cell.iter().map(|&node| tag(node).to_string()).collect();
        match mesh.kind() {
            CellKind::Tetrahedron10 => cell.swap(8, 9),
            // Gmsh numbers the mid nodes of a hexahedron by the edges at its corners, one corner after the other; and
            // those of faces by the axes across them, first those of the lower faces
            CellKind::Hexahedron20 | CellKind::Hexahedron27 => {
                let edges = [8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14];
                let faces = [24, 22, 20, 21, 23, 25, 26];
                let middles = edges.iter().chain(&faces).take(cell.len() - 8);
                let middles: Vec<String> = middles.map(|&local| cell[local].clone()).collect();
                cell[8..].clone_from_slice(&middles);
            }
            _ => {}
        }
        writeln!(file, "{number} {}", cell.join(" ")).unwrap();
    }
    file + "$EndElements\n"
}

fn generated() -> Vec<Mesh> {
    let plane = Cells::ALL.map(|cells| Mesh::rectangle([0.3, 0.2], [4, 3], cells));
    let solid = SolidCells::ALL.map(|cells| Mesh::cuboid([0.3, 0.2, 0.1], [4, 3, 2], cells));
    let all = plane.into_iter().chain(solid).chain([Mesh::bar(0.1, 5)]);
    all.collect::<Result<_, _>>().unwrap()
}

/// To the last bit: numbers are written so that reading them gives the same ones.
#[track_caller]
fn assert_same(a: &Mesh, b: &Mesh) {
    assert_eq!((a.dimension(), a.kind()), (b.dimension(), b.kind()));
    assert_eq!(a.positions(), b.positions());
    assert!(a.cells().eq(b.cells()), "{:?}", a.kind());
    assert_eq!(a.boundary_nodes(), b.boundary_nodes());
}

#[test]
fn every_kind_of_mesh_comes_back_as_it_was() {
    for mesh in generated() {
        assert_same(&read(msh(&mesh, |node| node + 1)).unwrap(), &mesh);
    }
}

/// Tags without gaps, but in another order than the nodes: so they are after the order of a mesh was
/// raised in Gmsh. And tags with gaps.
#[test]
fn tags_may_come_in_any_order() {
    for mesh in generated() {
        let nodes = mesh.node_count();
        assert_same(&read(msh(&mesh, |node| nodes - node)).unwrap(), &mesh);
        assert_same(&read(msh(&mesh, |node| 10 * (nodes - node))).unwrap(), &mesh);
    }
}

/// Where all cells of an entity run the wrong way round they are turned over.
#[test]
fn meshes_that_were_drawn_the_other_way_round_are_turned_over() {
    for mesh in generated() {
        let kind = mesh.kind();
        let turned = read(msh(&mirrored(&mesh), |node| node + 1)).unwrap();
        assert!(body(&mirrored(&mesh)).is_err());
        let [volume, expected] = [&turned, &mesh].map(|mesh| body(mesh).unwrap().volume());
        // the mapped positions are the same numbers, but for their sign
        assert!((volume / expected - 1.0).abs() < 1e-13, "{kind:?} {volume} {expected}");
        assert_eq!(turned.boundary_nodes(), mesh.boundary_nodes());
        assert!(patch_test(&turned) < 2e-13, "{kind:?}");
        assert!(turned.notes().is_empty(), "{:?}", turned.notes());
    }
}

/// Cells of both windings, as they are after a mesh was mirrored in part, are turned to one, with a note that counts them.
#[test]
fn cells_of_both_windings_are_turned_to_one() {
    for mesh in generated() {
        let kind = mesh.kind();
        let mut cells: Vec<Vec<usize>> = mesh.cells().map(<[usize]>::to_vec).collect();
        let turned_over = read(msh(&mirrored(&mesh), |node| node + 1)).unwrap();
        let other_way: Vec<&[usize]> = turned_over.cells().collect();
        // cells that were turned over, in the mesh that was not mirrored, run the wrong way round
        let wrong: Vec<usize> = (1..cells.len()).step_by(2).collect();
        wrong.iter().for_each(|&cell| cells[cell] = other_way[cell].to_vec());
        let mixed =
            Mesh::new(mesh.dimension(), mesh.positions().to_vec(), kind, cells.concat()).unwrap();
        assert!(body(&mixed).is_err());
        let mended = read(msh(&mixed, |node| node + 1)).unwrap();
        let [volume, expected] = [&mended, &mesh].map(|mesh| body(mesh).unwrap().volume());
        assert!((volume / expected - 1.0).abs() < 1e-13, "{kind:?} {volume} {expected}");
        assert!(patch_test(&mended) < 2e-13, "{kind:?}");
        let told = format!("{} of {} cells run the other way round", wrong.len(), cells.len());
        let notes = mended.notes();
        assert!(notes.len() == 1 && notes[0].starts_with(&told), "{notes:?}");
        assert!(notes[0].contains("such as cell 2,"), "{notes:?}");
    }
}

/// With all cells inverted.
fn mirrored(mesh: &Mesh) -> Mesh {
    let d = mesh.dimension();
    let positions = mesh.positions().chunks(d);
    let positions = positions.flat_map(|x| [-x[0], x[1 % d], x[2 % d]].into_iter().take(d));
    let cells = mesh.cells().flatten().copied().collect();
    Mesh::new(d, positions.collect(), mesh.kind(), cells).unwrap()
}

/// Faces in space are membranes where that is asked for, and lines in the plane are strings.
#[test]
fn space_has_the_dimensions_that_the_body_needs() {
    let square = Mesh::rectangle([1.0, 1.0], [3, 3], Cells::Triangles).unwrap();
    let tent = square.clone().mapped(|x| [x[0], x[1], x[0] * x[1]]).unwrap();
    let upright = square.clone().mapped(|x| [x[0], 0.0, x[1]]).unwrap();
    let above = square.clone().mapped(|x| [x[0], x[1], 1.0]).unwrap();
    let bar = Mesh::bar(1.0, 5).unwrap();
    let arc = bar.clone().mapped(|x| [x[0], x[0] * x[0]]).unwrap();
    let helix = bar.clone().mapped(|x| [x[0].cos(), x[0].sin(), x[0]]).unwrap();
    for mesh in [&arc, &helix] {
        assert_same(&read(msh(mesh, |node| node + 1)).unwrap(), mesh);
    }
    for mesh in [&tent, &upright, &above, &helix] {
        assert_same(&read_in(3, msh(mesh, |node| node + 1)).unwrap(), mesh);
    }
    for mesh in [&tent, &upright] {
        let file = msh(mesh, |node| node + 1);
        says(
            read(&file),
            &[
                "triangles alone",
                "along z, from 0 to 1 m",
                "(dimension = 3 in a scene file)",
                "3D mesh",
            ],
        );
        says(read_in(2, &file), &["along z, from 0 to 1 m", "two dimensions"]);
    }
}

/// A plane mesh that was drawn at another height, or whose z was rounded, is one: with a note, but for round-off.
#[test]
fn a_plane_need_not_be_at_z_0() {
    let square = Mesh::rectangle([1.0, 1.0], [3, 3], Cells::Triangles).unwrap();
    for (z, noise, note) in [
        (0.0, 1e-12, None),
        (0.0, 1e-8, Some("z from -1e-8 to 1e-8 m, which is round-off beside its size of 1 m,")),
        (0.5, 0.0, Some("z = 0.5 m, the same everywhere,")),
        (-2.0, 1e-12, Some("z = -2 m, the same everywhere,")),
    ] {
        let mut sign = -1.0;
        let moved = |x: &[f64]| {
            sign = -sign;
            [x[0], x[1], z + sign * noise]
        };
        let file = msh(&square.clone().mapped(moved).unwrap(), |node| node + 1);
        for mesh in [read(&file), read_in(2, &file)] {
            let mesh = mesh.unwrap();
            assert_same(&mesh, &square);
            match (mesh.notes(), note) {
                ([], None) => {}
                ([told], Some(note)) => assert!(told.starts_with(note), "{told}"),
                (told, note) => panic!("{told:?} {note:?}"),
            }
        }
    }
}

/// A body of any kind of cells, section 0.01.
fn body(mesh: &Mesh) -> Result<Body, InputError> {
    let body = Body::new(mesh.clone(), RUBBER).strain(Strain::Cauchy);
    match mesh.kind().dimension() {
        1 => body.area(0.01),
        2 => body.thickness(0.01),
        _ => body,
    }
    .build()
}

/// Under a linear displacement u = H x: largest force on an inner node, over the largest of all, or
/// the relative error of the energy u.K u/2 = V (lambda tr(E)^2 / 2 + mu E:E), if that is larger.
fn patch_test(mesh: &Mesh) -> f64 {
    let (body, d) = (body(mesh).unwrap(), mesh.dimension());
    let gradient = [[0.02, -0.03, 0.01], [0.05, 0.04, -0.02], [0.03, 0.01, -0.05]];
    let u: Vec<f64> = mesh
        .positions()
        .chunks(d)
        .flat_map(|x| (0..d).map(|i| (0..d).map(|j| gradient[i][j] * x[j]).sum::<f64>()))
        .collect();
    let stiffness = body.stiffness().to_dense();
    let force: Vec<f64> = (0..u.len())
        .map(|i| u.iter().enumerate().map(|(j, u)| stiffness[(i, j)] * u).sum())
        .collect();
    let size = |i: &usize| force[*i].abs();
    let inner = (0..u.len()).filter(|i| mesh.boundary_nodes().binary_search(&(i / d)).is_err());
    let largest = (0..u.len()).map(|i| size(&i)).fold(0.0, f64::max);
    let unbalanced = inner.map(|i| size(&i)).fold(0.0, f64::max) / largest;

    let strain = |i: usize, j: usize| 0.5 * (gradient[i][j] + gradient[j][i]);
    let trace: f64 = (0..d).map(|i| strain(i, i)).sum();
    let squares: f64 = (0..d * d).map(|k| strain(k / d, k % d).powi(2)).sum();
    let Material { young, poisson, .. } = RUBBER;
    let density = match d {
        1 => 0.5 * young * trace * trace,
        _ => {
            let (lambda, mu) = (
                young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)),
                0.5 * young / (1.0 + poisson),
            );
            0.5 * lambda * trace * trace + mu * squares
        }
    };
    let energy = 0.5 * force.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
    unbalanced.max((energy / (density * body.volume()) - 1.0).abs())
}

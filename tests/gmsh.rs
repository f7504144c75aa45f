//! Meshes from Gmsh: what was written comes back, and files made by Gmsh itself (`tests/data/gmsh`)
//! have the volumes, groups and stiffness of what was drawn.

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
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("test.msh");
    fs::write(&path, content).unwrap();
    Mesh::read_gmsh(path)
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
        CellKind::Tetrahedron10 => 11,
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
        if mesh.kind() == CellKind::Tetrahedron10 {
            cell.swap(8, 9);
        }
        writeln!(file, "{number} {}", cell.join(" ")).unwrap();
    }
    file + "$EndElements\n"
}

fn generated() -> Vec<Mesh> {
    let plane = Cells::ALL.map(|cells| Mesh::rectangle([0.3, 0.2], [4, 3], cells));
    let solid = [SolidCells::Tetrahedra, SolidCells::Hexahedra, SolidCells::Tetrahedra10]
        .map(|cells| Mesh::cuboid([0.3, 0.2, 0.1], [4, 3, 2], cells));
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
        let (d, kind) = (mesh.dimension(), mesh.kind());
        // mirrored, all cells are inverted
        let mirrored = |mesh: &Mesh| {
            let positions = mesh.positions().chunks(d);
            let positions = positions.flat_map(|x| [-x[0], x[1 % d], x[2 % d]].into_iter().take(d));
            let cells = mesh.cells().flatten().copied().collect();
            Mesh::new(d, positions.collect(), kind, cells).unwrap()
        };
        let turned = read(msh(&mirrored(&mesh), |node| node + 1)).unwrap();
        assert!(body(&mirrored(&mesh)).is_err());
        let [volume, expected] = [&turned, &mesh].map(|mesh| body(mesh).unwrap().volume());
        // the mapped positions are the same numbers, but for their sign
        assert!((volume / expected - 1.0).abs() < 1e-13, "{kind:?} {volume} {expected}");
        assert_eq!(turned.boundary_nodes(), mesh.boundary_nodes());
        assert!(patch_test(&turned) < 1e-12, "{kind:?}");
    }
}

/// Surfaces in space are membranes, and lines in the plane are strings.
#[test]
fn space_has_the_dimensions_that_the_body_needs() {
    let square = Mesh::rectangle([1.0, 1.0], [3, 3], Cells::Triangles).unwrap();
    let tent = square.clone().mapped(|x| [x[0], x[1], x[0] * x[1]]).unwrap();
    let upright = square.clone().mapped(|x| [x[0], 0.0, x[1]]).unwrap();
    let above = square.clone().mapped(|x| [x[0], x[1], 1.0]).unwrap();
    let flat = square.clone().mapped(|x| [x[0], x[1], 1e-12]).unwrap();
    let bar = Mesh::bar(1.0, 5).unwrap();
    let arc = bar.clone().mapped(|x| [x[0], x[0] * x[0]]).unwrap();
    let helix = bar.clone().mapped(|x| [x[0].cos(), x[0].sin(), x[0]]).unwrap();
    for mesh in [&tent, &upright, &above, &arc, &helix] {
        assert_same(&read(msh(mesh, |node| node + 1)).unwrap(), mesh);
    }
    assert_same(&read(msh(&flat, |node| node + 1)).unwrap(), &square);
}

/// A body of any kind of cells, section 0.01.
fn body(mesh: &Mesh) -> Result<Body, InputError> {
    let body = Body::new(mesh.clone(), RUBBER);
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
        assert!((body.volume() / volume - 1.0).abs() < 1e-12, "{cells} {}", body.volume());
        assert!(patch_test(&mesh) < 1e-11, "{cells} {}", patch_test(&mesh));

        // each half is a region; its nodes are a set, too
        let groups: Vec<&str> = mesh.cell_groups().keys().map(String::as_str).collect();
        assert_eq!(groups, ["first", "second"], "{cells}");
        let both = mesh.cell_groups().values().map(Vec::len).sum::<usize>();
        assert_eq!(both, mesh.cell_count());
        let heavy = Material { density: 3000.0, ..RUBBER };
        let builder = match kind.dimension() {
            1 => Body::new(mesh.clone(), RUBBER).area(0.01),
            2 => Body::new(mesh.clone(), RUBBER).thickness(0.01),
            _ => Body::new(mesh.clone(), RUBBER),
        };
        let halves = builder.region("second", heavy).build().unwrap();
        assert!((halves.mass() / (2000.0 * volume) - 1.0).abs() < 1e-12, "{cells}");
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
                    assert!((middle[i] - 0.5 * (a[i] + b[i])).abs() < 1e-9, "{cells} {cell:?}");
                }
            }
        }
    }
}

/// Nodes outside the body are dropped, and the others count on in the order of the file; groups
/// without names are called by their tags, and groups of nothing but dropped nodes left out.
#[test]
fn loose_nodes_are_dropped() {
    let file = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n\
        $PhysicalNames\n2\n1 5 \"foot \"of\" it\"\n2 5 \"all\"\n$EndPhysicalNames\n\
        $Entities\n2 1 1 0\n1 9 9 0 1 3\n2 0 0 0 2 8 -9\n\
        1 0 0 0 1 0 0 1 5 0\n1 0 0 0 1 1 0 1 5 0\n$EndEntities\n\
        $Nodes\n2 5 2 40\n0 1 0 1\n40\n9 9 0\n2 1 0 4\n2\n3\n30\n4\n0 0 0\n1 0 0\n5 5 0\n0 1 0\n$EndNodes\n\
        $Elements\n4 4 1 4\n0 1 15 1\n1 40\n0 2 15 1\n2 2\n1 1 1 1\n3 2 3\n2 1 2 1\n4 2 3 4\n$EndElements\n\
        $Periodic\n1\n1 1 2\n0\n1\n2 2\n$EndPeriodic\n";
    let mesh = read(file).unwrap();
    assert_eq!(mesh.positions(), [0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    assert_eq!(mesh.cells().collect::<Vec<_>>(), [[0, 1, 2]]);
    let sets: Vec<(&str, &[usize])> =
        mesh.sets().iter().map(|(name, nodes)| (name.as_str(), nodes.as_slice())).collect();
    let all: &[usize] = &[0, 1, 2];
    assert_eq!(
        sets,
        [
            ("all", all),
            ("boundary", all),
            ("foot \"of\" it", &[0, 1]),
            ("point 8", &[0]),
            ("point 9", &[0])
        ]
    );
    says(read(file.replace("2 5 \"all\"", "1 5 \"all\"")), &["\"all\"", "rename it"]);
}

#[test]
fn regions_that_do_not_exist() {
    let mesh = committed("tests/data/gmsh/brick-triangles.msh");
    let body = |mesh: Mesh| {
        let body = Body::new(mesh, RUBBER).thickness(0.01);
        body.region(CellSelection::Group("bottom".into()), RUBBER).build()
    };
    let message = body(mesh.clone()).unwrap_err().to_string();
    assert!(message.contains("group of cells = \"bottom\"") && message.contains("first, second"));
    let message = body(generated().swap_remove(0)).unwrap_err().to_string();
    assert!(message.contains("no groups of cells"), "{message}");
}

#[test]
fn what_is_no_mesh_gets_a_message() {
    let good =
        msh(&Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Triangles).unwrap(), |node| node + 1);
    assert!(read(&good).is_ok());
    assert!(read(good.replace('\n', "\r\n")).is_ok());
    let with = |old: &str, new: &str| {
        assert!(good.contains(old), "{old}");
        read(good.replacen(old, new, 1))
    };
    says(read(""), &["it is empty"]);
    says(read("solid cube\nfacet normal 0 0 1\n"), &["$MeshFormat"]);
    says(read("$MeshFormat\n"), &["format is missing"]);
    says(with("4.1 0 8", "2.2 0 8"), &["version 2.2", "gmsh -format msh41"]);
    says(with("4.1 0 8", "4 0 8"), &["version 4", "gmsh -format msh41"]);
    says(with("4.1 0 8", "4.1 1 4"), &["\"4.1 1 4\"", "4.1 1 8"]);
    says(with("4.1 0 8", "4.1 0 99999999999999999999"), &["4.1 0 8"]);
    says(read(&good[..good.find("$Nodes").unwrap()]), &["one section $Nodes"]);
    says(read(&good[..good.find("$Elements").unwrap()]), &["one section $Elements"]);
    says(with("$Nodes", "$Nodes\n$EndNodes\n$Nodes"), &["one section $Nodes"]);
    says(with("1 4 1 4", "0 0 1 1"), &["$Nodes is empty", "mesh the geometry"]);
    says(with("1 2 1 2", "0 0 1 1"), &["$Elements is empty"]);
    says(with("1 2 1 2", "0 2 1 2"), &["broken at line"]);
    says(with("1 4 1 4", "1 4 1"), &["header of its section $Nodes"]);
    says(with("1 4 1 4", "1 four 1 4"), &["header of its section $Nodes"]);
    says(with("\n0 1 0", "\n0 one 0"), &["broken at line 13", "y coordinate"]);
    says(with("\n0 1 0", "\n0 NaN 0"), &["NaN", "finite"]);
    says(with("\n0 1 0", "\n0 1e999 0"), &["inf"]);
    says(with("\n4\n", "\n3\n"), &["same tag"]);
    says(with("1 1 2 3\n", "1 1 2 9\n"), &["node 9", "does not exist"]);
    says(with("2 1 2 2", "2 1 141 2"), &["broken at line", "value 141"]);
    says(with("2 1 2 2", "2 1 34 2"), &["cannot be read at line", "simple cells"]);
    says(with("2 1 0 4", "2 1 1 4"), &["cannot be read at line 7", "Mesh.SaveParametric = 0"]);
    says(with("2 1 0 4", "2 1 0 99999999999"), &["broken at line"]);
    says(with("$Nodes", "$PartitionedEntities\n$EndPartitionedEntities\n$Nodes"), &["partitioned"]);
    says(with("$Nodes", "$Comments\nno end\n$Nodes"), &["broken at line"]);
    let missing = Mesh::read_gmsh("no/such/test.msh");
    says(missing, &["no/such/test.msh", "No such file"]);
}

/// Cells that do not exist here, and several kinds of them.
#[test]
fn unsuitable_cells_get_a_message() {
    let file = |elements: &str| {
        let nodes: String = (1..=9).map(|tag| format!("{tag}\n")).collect();
        let places: String = (0..9).map(|k| format!("{} {} 0\n", k % 3, k / 3)).collect();
        format!(
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 9 1 9\n2 1 0 9\n{nodes}{places}$EndNodes\n\
             $Elements\n{elements}$EndElements\n"
        )
    };
    let mixed = file("3 4 1 4\n2 1 2 2\n1 1 2 4\n2 2 5 4\n1 1 1 1\n3 1 2\n2 1 3 1\n4 2 3 6 5\n");
    says(
        read(mixed),
        &[
            "2 triangles of 3 node(s) and 1 quadrilaterals of 4 node(s)",
            "one kind",
            "Mesh.RecombineAll",
        ],
    );
    let nine = file("1 1 1 1\n2 1 10 1\n1 1 3 9 7 2 6 8 4 5\n");
    says(
        read(nine),
        &[
            "1 quadrilaterals of 9 node(s)",
            "triangles, triangles of 6 nodes, quadrilaterals, tetrahedra",
            "Mesh.ElementOrder",
        ],
    );
    says(read(file("1 1 1 1\n3 1 6 1\n1 1 2 4 3 5 6\n")), &["1 prisms of 6 node(s)"]);
    says(read(file("1 1 1 1\n1 1 8 1\n1 1 3 2\n")), &["1 lines of 3 node(s)"]);
    says(read(file("1 1 1 1\n0 1 15 1\n1 1\n")), &["1 points of 1 node(s)"]);
    // an element that is no cell of the body does not matter
    assert!(read(file("2 2 1 2\n1 1 8 1\n1 1 3 2\n2 1 2 1\n2 1 2 4\n")).is_ok());
}

/// No cut of a file is read, and none panics: text and binary.
#[test]
fn files_that_end_early_get_a_message() {
    for cells in ["triangles6", "hexahedra"] {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let file = root.join(format!("tests/data/gmsh/brick-{cells}.msh"));
        let file = fs::read(file).unwrap();
        assert!(read(&file).is_ok());
        // the line break at the very end may be missing
        for length in (0..file.len() - 1).step_by(7) {
            let refused = read(&file[..length]).unwrap_err();
            assert_eq!(refused.input, "mesh file", "{length}: {refused}");
        }
    }
}

/// A byte that is changed makes another mesh or an error, never a panic.
#[test]
fn damaged_files_do_not_panic() {
    for cells in ["triangles6", "hexahedra"] {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let file = fs::read(root.join(format!("tests/data/gmsh/brick-{cells}.msh"))).unwrap();
        for at in (0..file.len()).step_by(5) {
            let mut damaged = file.clone();
            damaged[at] = [b'0', b'9', b'-', b'$', 0xff, 0, b'\n'][at % 7];
            if let Err(error) = read(&damaged) {
                assert_eq!(error.input, "mesh file", "{at}: {error}");
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
        let body = Body::new(mesh.clone(), weightless).thickness(1.0);
        body.region(region, light).build().unwrap()
    };
    // mm^2: what is below the gaps, and the bellows above that, without the rooms
    let rubber = 51.5 * 4.0 + 6.0 * 6.5 * 9.0 - 6.0 * 3.5 * 9.5;
    assert!((body("rubber").mass() / (1e-6 * rubber) - 1.0).abs() < 1e-9);
    assert!((body("strain limiting layer").mass() / (1e-6 * 51.5) - 1.0).abs() < 1e-9);
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
    assert!((body.mass() / mass - 1.0).abs() < 1e-9, "{} {mass}", body.mass());
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

//! Files with parts that belong to no body, and files that are no mesh: a message, never a panic.

use super::*;

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
        let body = Body::new(mesh, RUBBER).strain(Strain::Cauchy).thickness(0.01);
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
    says(with("4.1 0 8", "1.0 0 8"), &["version 1.0", "gmsh -format msh41"]);
    says(with("4.1 0 8", "4 0 8"), &["version 4", "gmsh -format msh41"]);
    says(with("4.1 0 8", "4.1 1 4"), &["\"4.1 1 4\"", "4.1 1 8"]);
    says(with("4.1 0 8", "4.1 0 99999999999999999999"), &["4.1 0 8"]);
    says(read(&good[..good.find("$Nodes").unwrap()]), &["one section $Nodes"]);
    says(read(&good[..good.find("$Elements").unwrap()]), &["one section $Elements"]);
    says(with("$Nodes", "$Nodes\n0 0 0 0\n$EndNodes\n$Nodes"), &["one section $Nodes"]);
    let up_to = |name: &str| &good[..good.find(name).unwrap()];
    let no_elements = "$Elements\n0 0 0 0\n$EndElements\n";
    let no_nodes = format!("{}$Nodes\n0 0 0 0\n$EndNodes\n{no_elements}", up_to("$Nodes"));
    says(read(no_nodes), &["$Nodes is empty", "mesh the geometry"]);
    says(
        read(up_to("$Elements").to_owned() + no_elements),
        &["$Elements is empty", "mesh the geometry"],
    );
    says(with("1 2 1 2", "0 2 1 2"), &["broken at line", "$Elements", "its end is expected"]);
    says(with("1 4 1 4", "1 4 1"), &["broken at line", "$Nodes"]);
    says(
        with("1 4 1 4", "1 four 1 4"),
        &["broken at line 5, in its section $Nodes", "\"four\" is no number of nodes"],
    );
    says(with("\n0 1 0", "\n0 one 0"), &["broken at line 13", "\"one\" is no y coordinate"]);
    says(with("\n0 1 0", "\n0 NaN 0"), &["NaN", "finite"]);
    says(with("\n0 1 0", "\n0 1e999 0"), &["inf"]);
    says(with("\n4\n", "\n3\n"), &["same tag"]);
    says(with("1 1 2 3\n", "1 1 2 9\n"), &["node 9", "does not exist"]);
    says(with("2 1 2 2", "2 1 141 2"), &["broken at line", "type 141"]);
    says(with("2 1 2 2", "2 1 34 2"), &["broken at line", "type 34", "Mesh.ElementOrder"]);
    says(with("2 1 0 4", "2 1 1 4"), &["broken at line 15", "\"$EndNodes\" is no z coordinate"]);
    says(with("2 1 0 4", "2 1 0 99999999999"), &["broken at line"]);
    says(with("$Nodes", "$PartitionedEntities\n$EndPartitionedEntities\n$Nodes"), &["partitioned"]);
    says(with("$Nodes", "$Comments\nno end\n$Nodes"), &["broken at line", "$Comments", "no end"]);
    // nodes with coordinates on their surface, as of Mesh.SaveParametric = 1
    let parametric = good.replacen("2 1 0 4", "2 1 1 4", 1);
    let parametric = ["\n0 0 0", "\n1 0 0", "\n0 1 0", "\n1 1 0"]
        .iter()
        .fold(parametric, |file, point| file.replacen(point, &format!("{point} 0.5 0.25"), 1));
    assert_same(&read(parametric).unwrap(), &read(&good).unwrap());
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
    let eight = file("1 1 1 1\n2 1 16 1\n1 1 3 9 7 2 6 8 4\n");
    says(
        read(eight),
        &[
            "1 quadrilaterals of 8 node(s)",
            "triangles, triangles of 6 nodes, quadrilaterals, quadrilaterals of 9 nodes, tetrahedra",
            "Mesh.ElementOrder",
        ],
    );
    assert!(read(file("1 1 1 1\n2 1 10 1\n1 1 3 9 7 2 6 8 4 5\n")).is_ok());
    says(read(file("1 1 1 1\n3 1 6 1\n1 1 2 4 3 5 6\n")), &["1 prisms of 6 node(s)"]);
    says(read(file("1 1 1 1\n1 1 8 1\n1 1 3 2\n")), &["1 lines of 3 node(s)"]);
    says(read(file("1 1 1 1\n0 1 15 1\n1 1\n")), &["1 points of 1 node(s)"]);
    // an element that is no cell of the body does not matter
    assert!(read(file("2 2 1 2\n1 1 8 1\n1 1 3 2\n2 1 2 1\n2 1 2 4\n")).is_ok());
}

/// Memory stays in proportion to the file: 3000 blocks on a curve of 3000 groups would be nine million names.
#[test]
fn groups_of_many_blocks_are_bounded() {
    let file = |groups: usize, blocks: usize| {
        let names: String = (1..=groups).map(|tag| format!("{tag} ")).collect();
        let lines = "1 7 1 1\n1 1 2\n".repeat(blocks);
        format!(
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 1 0 0\n7 0 0 0 1 0 0 {groups} {names} 0\n$EndEntities\n\
             $Nodes\n1 2 1 2\n1 7 0 2\n1\n2\n0 0 0\n1 0 0\n$EndNodes\n\
             $Elements\n{blocks} {blocks} 1 1\n{lines}$EndElements\n"
        )
    };
    assert_eq!(read(file(20, 1)).unwrap().cell_groups().len(), 20);
    says(read(file(3000, 3000)), &["broken at line", "$Elements", "too many physical groups"]);
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

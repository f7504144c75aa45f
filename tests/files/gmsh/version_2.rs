//! Files of version 2.2, which fTetWild and meshio write, and Gmsh by `-format msh22`.

use super::*;

/// Files that meshio 5.3 has made of those that Gmsh has written: all that they hold is there, groups as well.
#[test]
fn files_of_meshio_are_those_of_gmsh() {
    for cells in ["triangles6", "hexahedra"] {
        let [old, new] = ["-2.2", ""]
            .map(|version| committed(&format!("tests/data/gmsh/brick-{cells}{version}.msh")));
        assert_same(&old, &new);
        assert_eq!((old.sets(), old.cell_groups()), (new.sets(), new.cell_groups()), "{cells}");
        assert!(old.sets().contains_key("bottom") && old.cell_groups().len() == 2);
    }
}

/// Version 2.2 of a mesh of one kind: text.
fn msh_2(mesh: &Mesh, tags: &str) -> String {
    let file = msh(mesh, |node| node + 1);
    let all: Vec<&str> = file.lines().collect();
    let nodes = mesh.node_count();
    let place = |line: &str| all.iter().position(|of| *of == line).unwrap();
    let (head, elements) = (place("$Nodes") + 3 + nodes, place("$Elements"));
    let code = all[elements + 2].split(' ').nth(2).unwrap();
    let mut old = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}\n");
    (1..).zip(&all[head..head + nodes]).for_each(|(n, at)| writeln!(old, "{n} {at}").unwrap());
    writeln!(old, "$EndNodes\n$Elements\n{}", mesh.cell_count()).unwrap();
    for line in &all[elements + 3..all.len() - 1] {
        let (number, nodes) = line.split_once(' ').unwrap();
        writeln!(old, "{number} {code} {tags} {nodes}").unwrap();
    }
    old + "$EndElements\n"
}

#[test]
fn every_kind_of_mesh_comes_back() {
    for mesh in generated() {
        for tags in ["0", "2 0 0", "2 7 3", "4 7 3 1 1"] {
            let back = read(msh_2(&mesh, tags)).unwrap();
            assert_same(&back, &mesh);
            // a group of its own dimension has a name by it
            let name = ["curve 7", "surface 7", "volume 7"][mesh.kind().dimension() - 1];
            assert_eq!(back.cell_groups().contains_key(name), tags.contains('7'));
        }
    }
}

/// As fTetWild writes it: binary, elements without tags behind a single head.
#[test]
fn binary_files_of_both_byte_orders() {
    let mesh = Mesh::cuboid([0.3, 0.2, 0.1], [4, 3, 2], SolidCells::Tetrahedra).unwrap();
    for is_big in [false, true] {
        let int =
            |k: usize| if is_big { (k as i32).to_be_bytes() } else { (k as i32).to_le_bytes() };
        let real = |x: &f64| if is_big { x.to_be_bytes() } else { x.to_le_bytes() };
        let mut file = b"$MeshFormat\n2.2 1 8\n".to_vec();
        file.extend(int(1));
        file.extend(format!("\n$EndMeshFormat\n$Nodes\n{}\n", mesh.node_count()).bytes());
        for (node, position) in (1..).zip(mesh.positions().chunks(3)) {
            file.extend(int(node));
            file.extend(position.iter().flat_map(real));
        }
        file.extend(format!("$EndNodes\n$Elements\n{}\n", mesh.cell_count()).bytes());
        file.extend([4, mesh.cell_count(), 0].iter().flat_map(|k| int(*k)));
        for (number, cell) in (1..).zip(mesh.cells()) {
            file.extend(int(number));
            file.extend(cell.iter().flat_map(|node| int(node + 1)));
        }
        file.extend(b"$EndElements\n$ElementData\n1\n\"color\"\n\x01\x02\n$EndElementData\n");
        assert_same(&read(&file).unwrap(), &mesh);
        for length in (0..file.len() - 80).step_by(11) {
            let refused = read(&file[..length]).unwrap_err();
            assert_eq!(refused.input, "mesh file", "{length}: {refused}");
        }
    }
}

/// Gmsh writes an element of several physical groups once for each of them: it is one cell of several groups.
#[test]
fn cells_of_several_groups_are_written_several_times() {
    let mesh = Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Triangles).unwrap();
    let file = msh_2(&mesh, "2 1 1");
    let elements: Vec<&str> = file.lines().filter(|line| line.contains(" 2 1 1 ")).collect();
    let twice: Vec<String> = elements
        .iter()
        .flat_map(|line| [line.to_string(), line.replace(" 2 1 1 ", " 2 5 1 ")])
        .collect();
    let names = "$PhysicalNames\n2\n2 1 \"skin\"\n2 5 \"left half\"\n$EndPhysicalNames\n$Nodes";
    let doubled = file
        .replace("$Elements\n2", "$Elements\n4")
        .replace(&elements.join("\n"), &twice.join("\n"))
        .replace("$Nodes", names);
    let read_back = read(doubled).unwrap();
    assert_same(&read_back, &mesh);
    let groups: Vec<(&str, &[usize])> =
        read_back.cell_groups().iter().map(|(name, cells)| (name.as_str(), &cells[..])).collect();
    assert_eq!(groups, [("left half", &[0, 1][..]), ("skin", &[0, 1][..])]);
}

#[test]
fn what_is_broken_is_named() {
    let mesh = Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Triangles).unwrap();
    let good = msh_2(&mesh, "2 0 1");
    let with = |old: &str, new: &str| {
        assert!(good.contains(old), "{old}");
        read(good.replacen(old, new, 1))
    };
    says(with("2.2 0 8", "2.2 0 4"), &["\"2.2 0 4\"", "\"2.2 1 8\""]);
    says(with("$Nodes\n4", "$Nodes\n5"), &["broken at line", "$Nodes", "number of a node"]);
    says(with("$Nodes\n4", "$Nodes\n99999999999999999"), &["broken at line", "$Nodes"]);
    says(with("$Elements\n2", "$Elements\n99999999999999999"), &["broken at line", "$Elements"]);
    says(with("$Elements\n2", "$Elements\n0"), &["broken at line", "its end is expected"]);
    says(with("$Elements\n2", "$Elements\n-2"), &["\"-2\" is no count"]);
    says(with("1 2 2 0 1", "1 2 2000000000 0 1"), &["broken at line", "$Elements"]);
    says(with("1 2 2 0 1", "1 77 2 0 1"), &["type 77"]);
    says(with("\n1 0 0 0", "\n-1 0 0 0"), &["below 0"]);
    says(with("\n1 0 0 0", "\n2 0 0 0"), &["same tag"]);
}

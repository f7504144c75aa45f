//! Closed surfaces against closed forms, and files of them.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use crate::elements::mesh::{CellKind, Mesh};

/// The surface of the prism along z, `height` (m) high, over a polygon, counter-clockwise, that is divided into `triangles`.
fn prism(polygon: &[[f64; 2]], triangles: &[[usize; 3]], height: f64) -> (Vec<f64>, Vec<usize>) {
    let n = polygon.len();
    let level = |z: f64| polygon.iter().flat_map(move |[x, y]| [*x, *y, z]);
    let mut cells: Vec<usize> = triangles.iter().flat_map(|[a, b, c]| [*a, *c, *b]).collect();
    cells.extend(triangles.iter().flatten().map(|node| n + node));
    for a in 0..n {
        let b = (a + 1) % n;
        cells.extend([a, b, n + b, a, n + b, n + a]);
    }
    (level(0.0).chain(level(height)).collect(), cells)
}

fn cube() -> (Vec<f64>, Vec<usize>) {
    let square = [[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]];
    prism(&square, &[[0, 1, 2], [0, 2, 3]], 0.1)
}

fn closed((positions, cells): (Vec<f64>, Vec<usize>)) -> Result<Mesh, String> {
    let mesh = Mesh::new(3, positions, CellKind::Triangle, cells).unwrap();
    mesh.closed().map_err(|error| error.to_string())
}

/// An L, which is not convex, far from the origin: two boxes by the theorem of parallel axes. Some triangles run the wrong way
/// round.
#[test]
fn an_angle_is_two_boxes() {
    let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let (mut positions, mut cells) =
        prism(&corners, &[[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]], 0.5);
    for (i, x) in positions.iter_mut().enumerate() {
        *x += [10.0, -20.0, 30.0][i % 3];
    }
    for triangle in [0, 3, 7] {
        cells.swap(3 * triangle, 3 * triangle + 1);
    }
    let enclosed = closed((positions, cells)).unwrap().enclosed();
    // the lengths and the middles of both boxes
    let boxes = [
        (Vector3::new(3.0, 1.0, 0.5), Vector3::new(11.5, -19.5, 30.25)),
        (Vector3::new(1.0, 1.0, 0.5), Vector3::new(10.5, -18.5, 30.25)),
    ];
    let volumes = boxes.map(|(lengths, _)| lengths.product());
    let centre = (volumes[0] * boxes[0].1 + volumes[1] * boxes[1].1) / (volumes[0] + volumes[1]);
    let mut second = nalgebra::Matrix3::zeros();
    for ((lengths, middle), volume) in boxes.into_iter().zip(volumes) {
        let own = lengths.component_mul(&lengths) / 12.0;
        let arm: Vector3<f64> = middle - centre;
        second += volume * (nalgebra::Matrix3::from_diagonal(&own) + arm * arm.transpose());
    }
    assert!((enclosed.volume / (volumes[0] + volumes[1]) - 1.0).abs() < 1e-13);
    assert!((enclosed.centre - centre).norm() < 1e-13);
    assert!((enclosed.second - second).norm() < 1e-13 * second.norm());
}

/// A torus of flat triangles comes near a round one as the squares of their sides do: volume 2 pi^2 R r^2, second moments
/// m (R^2/2 + 3 r^2/8) in its plane and m r^2/4 across.
#[test]
fn a_torus_of_triangles() {
    let (big, small) = (2.0, 0.5);
    let off = |around: usize| {
        let across = around / 2;
        let mut positions = Vec::new();
        for i in 0..around {
            for j in 0..across {
                let [a, b] = [TAU * i as f64 / around as f64, TAU * j as f64 / across as f64];
                let r = big + small * b.cos();
                positions.extend([r * a.cos(), r * a.sin(), small * b.sin()]);
            }
        }
        let node = |i: usize, j: usize| (i % around) * across + j % across;
        let mut cells = Vec::new();
        for i in 0..around {
            for j in 0..across {
                let [a, b] = [node(i, j), node(i + 1, j)];
                let [c, d] = [node(i + 1, j + 1), node(i, j + 1)];
                // inside out: they are turned over
                cells.extend([a, c, b, a, d, c]);
            }
        }
        let enclosed = closed((positions, cells)).unwrap().enclosed();
        let volume = 2.0 * PI * PI * big * small * small;
        let along = volume * (big * big / 2.0 + 3.0 * small * small / 8.0);
        let exact = [volume, along, along, volume * small * small / 4.0];
        let second = &enclosed.second;
        let found = [enclosed.volume, second[(0, 0)], second[(1, 1)], second[(2, 2)]];
        assert!(enclosed.centre.norm() < 1e-12 && second[(0, 1)].abs() < 1e-12 * along);
        [0, 1, 2, 3].map(|k| found[k] / exact[k] - 1.0)
    };
    let [coarse, fine] = [off(64), off(128)];
    println!("{coarse:?}, {fine:?}");
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(fine < 0.0 && fine > -4e-3, "{fine}");
        // 4 in the limit
        assert!((coarse / fine - 4.0).abs() < 0.04, "{coarse} and {fine}");
    }
}

#[test]
fn surfaces_that_enclose_nothing_are_refused() {
    let (positions, cells) = cube();
    let told = |positions: &[f64], cells: &[usize]| {
        closed((positions.to_vec(), cells.to_vec())).unwrap_err()
    };
    let open = told(&positions, &cells[..cells.len() - 3]);
    let edge = "triangles at the edge (0, 0.1, 0) - (0, 0, 0.1) = 1";
    assert!(open.contains(edge), "{open}");
    assert!(open.contains("close the hole"), "{open}");
    // a wall within it
    let wall = [&cells[..], &[0, 1, 6]].concat();
    let wall = told(&positions, &wall);
    assert!(wall.contains("= 3") && wall.contains("leave walls within it out"), "{wall}");
    let mut flat = positions.clone();
    flat[3 * 4..3 * 5].copy_from_slice(&[0.05, 0.05, 0.0]);
    let flat = told(&flat, &[&cells[..], &[0, 4, 2]].concat());
    assert!(flat.contains("no area"), "{flat}");
    let other: Vec<f64> = positions.iter().map(|x| x + 1.0).collect();
    let apart: Vec<usize> =
        cells.iter().copied().chain(cells.iter().map(|node| node + 8)).collect();
    let apart = told(&[positions.clone(), other].concat(), &apart);
    assert!(apart.contains("first one = 12") && apart.contains("a body of each"), "{apart}");
    let squashed: Vec<f64> = positions
        .iter()
        .enumerate()
        .map(|(i, x)| if i % 3 == 2 { x * 1e-14 } else { *x })
        .collect();
    let squashed = told(&squashed, &cells);
    assert!(squashed.contains("no area") || squashed.contains("volume of a surface"), "{squashed}");
    let plane = Mesh::new(2, vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0], CellKind::Triangle, vec![0, 1, 2]);
    let plane = plane.unwrap().closed().unwrap_err().to_string();
    assert!(plane.contains("triangles in a space of dimension 2"), "{plane}");
}

/// The cube in a binary STL file, whose first word is that of a text, and in an OBJ file.
fn files() -> (Vec<u8>, String) {
    let (positions, cells) = cube();
    let points = positions.as_chunks::<3>().0;
    let mut binary = b"solid, but not a text".to_vec();
    binary.resize(80, b' ');
    binary.extend(12_u32.to_le_bytes());
    for triangle in cells.chunks(3) {
        binary.extend([0; 12]);
        triangle
            .iter()
            .flat_map(|&node| points[node])
            .for_each(|x| binary.extend((x as f32).to_le_bytes()));
        binary.extend([0; 2]);
    }
    let mut obj = String::from("# a cube\no cube\n");
    points.iter().for_each(|[x, y, z]| obj += &format!("v {x} {y} {z}\n"));
    obj += "vn 0 0 1\nf 4/1/1 3//1 2 1\nf -4 -3 -2 -1\n";
    for a in 1..=4 {
        let b = a % 4 + 1;
        obj += &format!("f {a} {b} {} {}\n", b + 4, a + 4);
    }
    (binary, obj)
}

#[test]
fn files_give_what_they_say() {
    let directory = tempfile::tempdir().unwrap();
    let read = |name: &str, contents: &[u8]| {
        let path = directory.path().join(name);
        std::fs::write(&path, contents).unwrap();
        Mesh::read_surface(&path).map_err(|error| error.to_string())
    };
    let (binary, obj) = files();
    let (positions, cells) = cube();
    let points = positions.as_chunks::<3>().0;
    let mut text = String::from("solid cube\n");
    for triangle in cells.chunks(3) {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for &node in triangle {
            let [x, y, z] = points[node];
            // 0 and -0 are one place
            let x = if x == 0.0 && node % 2 == 0 { "-0.0".into() } else { format!("{x:e}") };
            text += &format!("      vertex {x} {y} {z}\n");
        }
        text += "    endloop\n  endfacet\n";
    }
    // a triangle with two corners at one place, between two others
    text += "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0.1 0 0\nvertex 0 0 0\nendloop\n";
    text += "endfacet\nendsolid cube\n";
    let volume = 0.1_f64.powi(3);
    // numbers of 4 bytes have 7 digits
    for (name, contents, tolerance) in [
        ("text.STL", text.as_bytes(), 1e-14),
        ("binary.stl", &binary, 1e-7),
        ("cube.obj", obj.as_bytes(), 1e-14),
    ] {
        let mesh = read(name, contents).unwrap();
        assert_eq!((mesh.node_count(), mesh.cell_count()), (8, 12), "{name}");
        assert!((mesh.enclosed().volume / volume - 1.0).abs() < tolerance, "{name}");
        assert!((mesh.area() / 0.06 - 1.0).abs() < tolerance, "{name}");
    }
    let cut = &text[..text.rfind("vertex").unwrap()];
    for (name, contents, told) in [
        ("cut.stl", cut.as_bytes(), "within a triangle"),
        ("short.stl", &binary[..binary.len() - 1], "of the length of a binary one"),
        ("empty.stl", b"solid\nendsolid\n", "no triangles"),
        ("letters.stl", b"vertex 0 a 0\n", "line 1 has no three coordinates"),
        ("two.stl", b"vertex 0 0 0\nvertex 1 0 0\nendloop\n", "line 3 ends a loop"),
        ("points.obj", b"v 0 0 0\n", "no faces"),
        ("beyond.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4 is no face"),
        ("open.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "the surface is open there"),
        ("cube.ply", b"ply", ".stl, .obj"),
    ] {
        let error = read(name, contents).unwrap_err();
        assert!(error.contains(told) && error.contains(name), "{name}: {error}");
    }
    let error = Mesh::read_surface("nowhere.stl").unwrap_err().to_string();
    assert!(error.contains("cannot be read"), "{error}");
}

/// The cube as programs write it: corners off by round-off from triangle to triangle, a triangle without an area on a side and corners
/// of others on sides, words in capitals; a binary file with bytes to spare.
#[test]
fn surfaces_as_programs_write_them() {
    let directory = tempfile::tempdir().unwrap();
    let read = |name: &str, contents: &[u8]| {
        let path = directory.path().join(name);
        std::fs::write(&path, contents).unwrap();
        Mesh::read_surface(&path).unwrap()
    };
    let text = |triangles: &[[[f64; 3]; 3]], noise: f64| {
        let noise =
            crate::base::vector::noise(9 * triangles.len(), 3).into_iter().map(|x| noise * x);
        let mut noise = noise.collect::<Vec<_>>().into_iter();
        let mut text = String::from("SOLID CUBE\n");
        for triangle in triangles {
            text += "FACET NORMAL 0 0 0\nOUTER LOOP\n";
            for corner in triangle {
                let [x, y, z] = corner.map(|x| x + noise.next().unwrap());
                text += &format!("VERTEX {x:e} {y:e} {z:e}\n");
            }
            text += "ENDLOOP\nENDFACET\n";
        }
        text + "ENDSOLID\n"
    };
    let (positions, cells) = cube();
    let points = positions.as_chunks::<3>().0;
    let triangles: Vec<[[f64; 3]; 3]> =
        cells.as_chunks::<3>().0.iter().map(|cell| cell.map(|node| points[node])).collect();
    let whole = read("noise.stl", text(&triangles, 1e-16).as_bytes());
    assert_eq!((whole.node_count(), whole.cell_count()), (8, 12));
    assert!((whole.enclosed().volume / 1e-3 - 1.0).abs() < 1e-13);
    assert!(whole.notes().is_empty());
    // the first triangle is cut in two at a corner on a side of its neighbour; beside it in a flat one, or not
    let [a, b, c] = triangles[0];
    let [halved, flat] = [0, 1].map(|flat| {
        let long = [[a, b], [b, c], [c, a]].into_iter().enumerate().max_by(|(_, p), (_, q)| {
            let length = |[p, q]: &[[f64; 3]; 2]| (Vector3::from(*q) - Vector3::from(*p)).norm();
            length(p).total_cmp(&length(q))
        });
        let (k, [from, to]) = long.unwrap();
        let far = triangles[0][(k + 2) % 3];
        let middle: [f64; 3] = std::array::from_fn(|i| 0.3 * from[i] + 0.7 * to[i]);
        let mut all = triangles[1..].to_vec();
        all.extend([[from, middle, far], [middle, to, far]]);
        all.extend([[from, to, middle]].into_iter().take(flat));
        read("cut.stl", text(&all, 1e-16).as_bytes())
    });
    for (mesh, notes) in [(halved, 1), (flat, 2)] {
        assert_eq!((mesh.node_count(), mesh.cell_count(), mesh.notes().len()), (9, 14, notes));
        assert!((mesh.enclosed().volume / 1e-3 - 1.0).abs() < 1e-13);
        assert!((mesh.area() / 0.06 - 1.0).abs() < 1e-13);
    }
    let mut binary = files().0;
    binary.extend(b"made by a program\xff");
    assert_eq!(read("spare.stl", &binary).cell_count(), 12);
}

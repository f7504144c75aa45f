//! Meshes divided in some places only: no node hangs, cells keep their shape, and corners gain by it.

use pliant::{Body, Cells, Material, Mesh, Phase, Scene, SolidCells, Statics, Strain};

const SIZE: [f64; 3] = [0.2, 0.1, 0.1];

/// A rectangle or a block, divided six times at its first corner.
fn divided(mesh: Mesh) -> Mesh {
    let divide = |mesh: Mesh| mesh.halved_in(&mesh.cells_at([1]).unwrap()).unwrap();
    (0..6).fold(mesh, |mesh, _| divide(mesh))
}

fn meshes() -> [Mesh; 4] {
    let plane = |cells| Mesh::rectangle([SIZE[0], SIZE[1]], [5, 3], cells).unwrap();
    let solid = |cells| Mesh::cuboid(SIZE, [5, 3, 3], cells).unwrap();
    [
        plane(Cells::Triangles),
        plane(Cells::Triangles6),
        solid(SolidCells::Tetrahedra),
        solid(SolidCells::Tetrahedra10),
    ]
}

/// The smallest angle between edges of a cell at a corner, in the plane or in a face (rad).
fn least_angle(mesh: &Mesh) -> f64 {
    let corners = mesh.kind().dimension() + 1;
    let mut least = f64::INFINITY;
    for cell in mesh.cells() {
        let edge = |a: usize, b: usize| -> Vec<f64> {
            let (a, b) = (mesh.position(cell[a]), mesh.position(cell[b]));
            a.iter().zip(b).map(|(a, b)| b - a).collect()
        };
        let dot = |u: &[f64], v: &[f64]| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
        for a in 0..corners {
            for b in (0..corners).filter(|&b| b != a) {
                for c in (b + 1..corners).filter(|&c| c != a) {
                    let (u, v) = (edge(a, b), edge(a, c));
                    let cosine = dot(&u, &v) / (dot(&u, &u) * dot(&v, &v)).sqrt();
                    least = least.min(cosine.acos());
                }
            }
        }
    }
    least
}

/// Faces that belong to one cell only are on the surface of the block, so that cells beside each other have their faces in common; the
/// body weighs what it weighed; the smallest cell is 1/64 of the others across, and no angle is less than half of the least before.
#[test]
fn no_node_hangs_and_angles_stay() {
    for mesh in meshes() {
        let fine = divided(mesh.clone());
        let d = mesh.dimension();
        let on_side = |x: &[f64], axis: usize, at: f64| (x[axis] - at).abs() < 1e-12;
        for face in fine.boundary_faces() {
            let is_outside = (0..d).any(|axis| {
                [0.0, SIZE[axis]]
                    .into_iter()
                    .any(|side| face.iter().all(|&node| on_side(fine.position(node), axis, side)))
            });
            assert!(is_outside, "{:?}: {face:?}", mesh.kind());
        }
        let mass = |mesh: &Mesh| {
            let material = Material { density: 1e3, young: 1e5, poisson: 0.3, viscosity: 0.0 };
            let body = Body::new(mesh.clone(), material).strain(Strain::Cauchy);
            let body = if d == 2 { body.thickness(1.0) } else { body };
            body.build().unwrap().mass()
        };
        assert!((mass(&fine) / mass(&mesh) - 1.0).abs() < 1e-13, "{:?}", mesh.kind());
        assert_eq!(fine.positions()[..mesh.positions().len()], *mesh.positions());
        // what is on a side stays on it, in order of names
        for (name, nodes) in fine.sets().iter().filter(|(name, _)| *name == "left") {
            assert!(nodes.iter().all(|&node| on_side(fine.position(node), 0, 0.0)), "{name}");
            let all = (0..fine.node_count()).filter(|&n| on_side(fine.position(n), 0, 0.0));
            assert_eq!(nodes.len(), all.count(), "{:?}", mesh.kind());
        }
        let corner = fine.cells().find(|cell| cell.contains(&0)).unwrap();
        let reach = corner[..=d].iter().map(|&node| fine.position(node));
        let reach = reach.flat_map(|x| x.iter().copied()).fold(0.0, f64::max);
        let angles = [least_angle(&mesh), least_angle(&fine)];
        println!("{:?}: {} cells, {reach}, angles {angles:?}", mesh.kind(), fine.cell_count());
        assert!(reach <= 0.05 / 32.0, "{reach}");
        assert!(angles[1] >= 0.5 * angles[0], "{:?}: {angles:?}", mesh.kind());
    }
}

/// Clamped corners are singular: a cantilever that is divided there sinks as far as on a mesh that is divided everywhere, with a
/// fifth of the nodes.
#[test]
fn clamped_corners_gain() {
    let material = Material { density: 1e3, young: 1e5, poisson: 0.4, viscosity: 0.0 };
    let sinks = |mesh: Mesh| {
        let nodes = mesh.node_count();
        let body = Body::new(mesh, material).thickness(0.01).strain(Strain::Cauchy);
        let phase = Phase::until(1.0).hold("left").traction("right", [0.0, -10.0]);
        let scene = Scene::new(body.build().unwrap()).phase(phase);
        let rest = scene.equilibrium(&Statics::default()).unwrap();
        let tip = rest.trajectory().body().mesh().sets()["right"][0];
        (nodes, rest.displacements()[2 * tip + 1])
    };
    let mesh = Mesh::rectangle([0.1, 0.02], [21, 5], Cells::Triangles6).unwrap();
    let corners = [mesh.sets()["left"][0] + 1, *mesh.sets()["left"].last().unwrap() + 1];
    let corners = [1, corners[0].max(corners[1])];
    let local = |times| {
        let divide = |mesh: Mesh| mesh.halved_in(&mesh.cells_at(corners).unwrap()).unwrap();
        (0..times).fold(mesh.clone(), |mesh, _| divide(mesh))
    };
    let everywhere = [mesh.clone(), mesh.halved(), mesh.halved().halved()].map(sinks);
    let at_corners = [3, 6].map(|times| sinks(local(times)));
    let (_, exact) = sinks(local(6).halved());
    let off = |(nodes, u): (usize, f64)| (nodes, u / exact - 1.0);
    println!("everywhere {:?}, at corners {:?}", everywhere.map(off), at_corners.map(off));
    assert!(at_corners[1].0 < everywhere[2].0 / 5);
    assert!(off(at_corners[1]).1.abs() < off(everywhere[2]).1.abs());
}

#[test]
fn what_cannot_be_divided_is_told() {
    let grid = |cells| Mesh::rectangle([1.0; 2], [3; 2], cells).unwrap();
    let message = |mesh: Mesh, cells: &[usize]| mesh.halved_in(cells).unwrap_err().to_string();
    assert!(message(grid(Cells::Rectangles), &[0]).contains("a grid that is graded"));
    assert!(message(grid(Cells::Triangles), &[8]).contains("the mesh has the cells 1 to 8"));
    let with_bubbles = grid(Cells::Triangles).with_bubbles().unwrap();
    assert!(message(with_bubbles, &[0]).contains("before they get bubbles"));
}

//! Thirty scenes of silicone: ten soft bodies, each with Poisson's ratio 0.45, 0.49 and 0.499. Chambers with corners, bending,
//! contact, friction, in a plane and in space.

use pliant::body::BodyBuilder;
use pliant::{
    Body, Cells, Chamber, Error, Law, Material, Mesh, Obstacle, Phase, Scene, SolidCells, Strain,
    Substance,
};

const RATIOS: [f64; 3] = [0.45, 0.49, 0.499];

type MakeScene = fn(f64) -> Result<Scene, Error>;

/// Names and scenes.
pub fn all() -> Result<Vec<(String, Scene)>, Error> {
    let bodies: [(&str, MakeScene); 10] = [
        ("finger under its weight", finger),
        ("finger of triangles", finger_of_triangles),
        ("finger pulled at its tip", pulled_finger),
        ("two rooms blown up", rooms),
        ("room blown up and emptied", emptied_room),
        ("block pressed and let go", pressed_block),
        ("pad thrown at the floor", thrown_pad),
        ("pad dragged with friction", dragged_pad),
        ("finger in space", finger_in_space),
        ("block in space, twisted", twisted_block),
    ];
    let mut all = Vec::new();
    for (name, scene) in bodies {
        for poisson in RATIOS {
            all.push((format!("{name}, {poisson}"), scene(poisson)?));
        }
    }
    Ok(all)
}

/// Silicone of a soft robot.
fn silicone(poisson: f64) -> Substance {
    let material = Material { density: 1070.0, young: 2e5, poisson, viscosity: 200.0 };
    Substance::from(material).law(Law::NeoHookean)
}

fn plane(mesh: Mesh, poisson: f64) -> BodyBuilder {
    Body::new(mesh, silicone(poisson)).thickness(0.02).strain(Strain::Green)
}

fn finger_mesh(cells: Cells) -> Result<Mesh, Error> {
    Ok(Mesh::rectangle([0.08, 0.015], [13, 3], cells)?)
}

/// Let go under its weight.
fn finger(poisson: f64) -> Result<Scene, Error> {
    let body = plane(finger_mesh(Cells::Triangles6)?, poisson).build()?;
    Ok(Scene::new(body).gravity([0.0, -9.81]).phase(Phase::until(0.3).hold("left")))
}

fn finger_of_triangles(poisson: f64) -> Result<Scene, Error> {
    let body = plane(finger_mesh(Cells::Triangles)?, poisson).build()?;
    Ok(Scene::new(body).gravity([0.0, -9.81]).phase(Phase::until(0.3).hold("left")))
}

/// The upper corner of its tip is led sideways, then let go.
fn pulled_finger(poisson: f64) -> Result<Scene, Error> {
    let body = plane(finger_mesh(Cells::Rectangles)?, poisson).build()?;
    let pulled = Phase::until(0.1).hold("left").move_nodes("right", [0.0, -0.15]);
    Ok(Scene::new(body).phase(pulled).phase(Phase::until(0.3).hold("left")))
}

/// Two rooms with sharp corners over a layer.
fn room_scene(poisson: f64) -> Result<Scene, Error> {
    let rooms = [[[0.006, 0.006], [0.021, 0.015]], [[0.024, 0.006], [0.039, 0.015]]];
    let (mesh, walls) = with_holes([0.045, 0.018], [16, 7], &rooms)?;
    let mut scene = Scene::new(plane(mesh, poisson).build()?);
    for (number, wall) in walls.into_iter().enumerate() {
        scene = scene.chamber(Chamber::within(format!("room {}", number + 1), wall));
    }
    Ok(scene)
}

fn rooms(poisson: f64) -> Result<Scene, Error> {
    let mut phase = Phase::until(0.3).hold("left");
    for room in ["room 1", "room 2"] {
        phase = phase.pressure_table(room, [0.0, 0.1], [0.0, 1.5e4]);
    }
    Ok(room_scene(poisson)?.phase(phase))
}

/// One of both, whose air is let out at once.
fn emptied_room(poisson: f64) -> Result<Scene, Error> {
    let blown = Phase::until(0.15).hold("left");
    let blown = blown.pressure_table("room 1", [0.0, 0.1], [0.0, 1.5e4]);
    Ok(room_scene(poisson)?.phase(blown).phase(Phase::until(0.3).hold("left")))
}

/// On the floor, pressed by its top and let go.
fn pressed_block(poisson: f64) -> Result<Scene, Error> {
    let mesh = Mesh::rectangle([0.04, 0.03], [9, 7], Cells::Triangles)?;
    let pressed = Phase::until(0.1).hold("bottom").move_nodes("top", [0.0, -0.06]);
    Ok(Scene::new(plane(mesh, poisson).build()?)
        .phase(pressed)
        .phase(Phase::until(0.3).hold("bottom")))
}

/// Falls on the floor and leaves it again.
fn thrown_pad(poisson: f64) -> Result<Scene, Error> {
    let mesh =
        Mesh::rectangle([0.04, 0.02], [9, 5], Cells::Triangles6)?.translated(&[0.0, 0.005])?;
    Ok(Scene::new(plane(mesh, poisson).build()?)
        .gravity([0.0, -9.81])
        .obstacle(Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(2e3).damping(2.0))
        .phase(Phase::until(0.15)))
}

/// Lies on the floor and is dragged by its top.
fn dragged_pad(poisson: f64) -> Result<Scene, Error> {
    let mesh = Mesh::rectangle([0.04, 0.02], [9, 5], Cells::Triangles6)?;
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(2e3).damping(2.0);
    Ok(Scene::new(plane(mesh, poisson).build()?)
        .gravity([0.0, -9.81])
        .obstacle(floor.friction_coefficient(0.5))
        .phase(Phase::until(0.05))
        .phase(Phase::until(0.2).move_nodes("top", [0.1, -0.01])))
}

fn finger_in_space(poisson: f64) -> Result<Scene, Error> {
    let mesh = Mesh::cuboid([0.06, 0.015, 0.015], [9, 3, 3], SolidCells::Hexahedra20)?;
    let body = Body::new(mesh, silicone(poisson)).strain(Strain::Green).build()?;
    Ok(Scene::new(body).gravity([0.0, 0.0, -9.81]).phase(Phase::until(0.2).hold("left")))
}

/// Its right end is led aside and up, then let go.
fn twisted_block(poisson: f64) -> Result<Scene, Error> {
    let mesh = Mesh::cuboid([0.04, 0.02, 0.02], [5, 3, 3], SolidCells::Hexahedra)?;
    let body = Body::new(mesh, silicone(poisson)).strain(Strain::Green).build()?;
    let turned = Phase::until(0.1).hold("left").move_nodes("right", [0.0, 0.05, 0.05]);
    Ok(Scene::new(body).phase(turned).phase(Phase::until(0.2).hold("left")))
}

/// A rectangle of quadratic triangles with rectangular holes along its grid lines, and the nodes on the wall of each.
fn with_holes(
    size: [f64; 2],
    nodes: [usize; 2],
    holes: &[[[f64; 2]; 2]],
) -> Result<(Mesh, Vec<Vec<usize>>), Error> {
    let whole = Mesh::rectangle(size, nodes, Cells::Triangles6)?;
    let is_in_hole = |cell: &&[usize]| {
        let corners = cell[..3].iter().map(|&node| whole.position(node));
        let [x, y] =
            corners.fold([0.0; 2], |[x, y], corner| [x + corner[0] / 3.0, y + corner[1] / 3.0]);
        holes.iter().any(|[min, max]| x > min[0] && x < max[0] && y > min[1] && y < max[1])
    };
    let kept = whole.cells().filter(|cell| !is_in_hole(cell));
    let mut renamed = vec![usize::MAX; whole.node_count()];
    let (mut positions, mut connectivity) = (Vec::new(), Vec::new());
    for &node in kept.flatten() {
        if renamed[node] == usize::MAX {
            renamed[node] = positions.len() / 2;
            positions.extend_from_slice(whole.position(node));
        }
        connectivity.push(renamed[node]);
    }
    let mesh = Mesh::new(2, positions, whole.kind(), connectivity)?;
    let numbers_in = |[min, max]: [[f64; 2]; 2]| -> Vec<usize> {
        let is_in = |&node: &usize| {
            let x = mesh.position(node);
            (0..2).all(|i| x[i] >= min[i] - 1e-9 && x[i] <= max[i] + 1e-9)
        };
        mesh.boundary_nodes().iter().copied().filter(is_in).map(|node| node + 1).collect()
    };
    let walls = holes.iter().map(|&hole| numbers_in(hole)).collect();
    let left = numbers_in([[0.0, 0.0], [0.0, size[1]]]);
    Ok((mesh.name_nodes("left", left)?, walls))
}

//! Halves of scenes of several bodies, glued to each other or touching, against the whole ones.

use pliant::body::BodyBuilder;
use pliant::{
    Axis, Body, Cells, Material, Mesh, Obstacle, Phase, RigidMass, Scene, SolidCells, Spring, Touch,
};

use super::halves::{RUBBER, agrees, apart, refusal};

fn part(name: &str, x: f64, y: f64, [width, height]: [f64; 2], nodes: [usize; 2]) -> BodyBuilder {
    let mesh = Mesh::rectangle([width, height], nodes, Cells::Rectangles).unwrap();
    Body::new(mesh.translated(&[x, y]).unwrap(), RUBBER).thickness(0.05).named(name)
}

fn joined(bodies: impl IntoIterator<Item = BodyBuilder>) -> Body {
    Body::join(bodies.into_iter().map(|body| body.build().unwrap())).unwrap()
}

/// A base across the plane, two posts that are images of each other, and a lid across them with a weight.
fn table(lid_at: f64, change: impl Fn(BodyBuilder) -> BodyBuilder) -> Body {
    let lid = part("lid", 0.0, lid_at, [0.2, 0.03], [5, 2]);
    joined([
        part("left", 0.0, 0.03, [0.05, 0.06], [4, 3]),
        part("base", 0.0, 0.0, [0.2, 0.03], [5, 2]),
        change(part("right", 0.15, 0.03, [0.05, 0.06], [4, 3])),
        lid.point_mass("weight", [0.1, 0.2], 0.2),
    ])
}

/// Posts are glued on a base that falls onto a floor, and a lid is glued on them, from either side of the joints.
#[test]
fn glued_bodies_move_as_their_half() {
    let floor = Obstacle::half_plane([0.0, -0.001], [0.0, 1.0]).stiffness_density(1e6);
    let scene = Scene::new(table(0.09, |body| body))
        .gravity([0.0, -9.8])
        .obstacle(floor.friction_coefficient(0.3))
        .tie("left/bottom", "base")
        .tie("right/bottom", "base")
        .tie("left/top", "lid")
        .tie("right/top", "lid")
        .spring(Spring::between([45], [42]).stiffness(200.0).damping(1.0))
        .phase(
            Phase::until(0.05)
                .load_total("left/top", [1.0, -1.0])
                .load_total("right/top", [-1.0, -1.0]),
        );
    agrees(&scene, Axis::X);
    let half = scene.symmetric_half(Axis::X).unwrap();
    let names: Vec<&str> = half.body().parts().map(|part| part.name).collect();
    assert_eq!(names, ["left", "base", "lid"]);
    let masses = [&half, &scene].map(|scene| scene.body().mass());
    assert!((2.0 * masses[0] - masses[1]).abs() < 1e-12 * masses[1], "{masses:?}");
    let lonely = Scene::new(table(0.09, |body| body)).tie("right/bottom", "base");
    let told = refusal(&lonely.phase(Phase::until(0.1)), Axis::X);
    assert!(told.contains("tie to \"base\" = \"right/bottom\""), "{told}");
}

/// Posts stand on the base, by friction, and a lid falls on them: all numbers of the touches are those of the whole.
#[test]
fn touching_bodies_move_as_their_half() {
    let touch = |bodies: [&str; 2]| {
        Touch::between(bodies).named("floor").damping_density(1e3).friction_coefficient(0.3)
    };
    let scene = Scene::new(table(0.0922, |body| body))
        .gravity([0.0, -9.8])
        .tie("left/bottom", "base")
        .tie("right/bottom", "base")
        .touch(touch(["left", "lid"]).distance(2e-3).named("left"))
        .touch(touch(["lid", "right"]).distance(2e-3).named("right"))
        .phase(Phase::until(0.015).hold("base/bottom").load_total("lid/top", [0.0, -20.0]));
    agrees(&scene, Axis::X);
    let half = scene.symmetric_half(Axis::X).unwrap();
    assert_eq!(half.body().parts().count(), 3);
    let across = scene.clone().touch(Touch::between(["left", "right"]).named("across"));
    assert!(
        refusal(&across, Axis::X)
            .contains("touch = \"across\" cannot be used: bodies on both sides")
    );
    let stiffer = scene.touch(touch(["left", "base"]).named("other"));
    assert!(refusal(&stiffer, Axis::X).contains("touch = \"other\""));
}

/// Blocks that the plane cuts are pressed on each other, in the plane and in space, where edges cross.
#[test]
fn blocks_that_touch_at_the_plane_move_as_their_half() {
    let cube = |name: &str, at: [f64; 3], size: [f64; 3], nodes: [usize; 3]| {
        let mesh = Mesh::cuboid(size, nodes, SolidCells::Hexahedra).unwrap();
        Body::new(mesh.translated(&at).unwrap(), RUBBER).named(name)
    };
    let pressed = |body: Body, force: Vec<f64>, friction: f64| {
        let touch = Touch::all().distance(2e-3).friction_coefficient(friction);
        Scene::new(body)
            .touch(touch)
            .phase(Phase::until(0.005).hold("lower/bottom").load_total("upper/top", force))
    };
    let flat = joined([
        part("lower", 0.0, 0.0, [0.06, 0.02], [5, 2]),
        part("upper", 0.01, 0.0215, [0.04, 0.02], [7, 2]),
    ]);
    let solid = joined([
        cube("lower", [0.0; 3], [0.06, 0.04, 0.02], [3, 2, 2]),
        cube("upper", [0.01, 0.013, 0.0215], [0.04, 0.05, 0.02], [5, 2, 2]),
    ]);
    // points on the plane feel facets beyond it, which the half does not have, where these rise towards them; measured: 8.1e-7, 2.6e-5, 4.5e-5
    for (body, force, friction, limit) in [
        (flat.clone(), vec![0.0, -4.0], 0.0, 2e-6),
        (flat, vec![0.0, -4.0], 0.3, 1e-4),
        (solid, vec![0.0, 0.0, -1.0], 0.3, 1e-4),
    ] {
        let [far, moved] = apart(&pressed(body, force, friction), Axis::X);
        assert!(far < limit * moved, "{far:e} of {moved:e}");
    }
}

/// One body is left of two, with its own names; a rigid one is cut.
#[test]
fn one_of_two_images_is_left() {
    let slab = part("slab", 0.05, 0.02, [0.1, 0.03], [5, 2]).material(Material::rigid(2000.0));
    let scene = |change: fn(BodyBuilder) -> BodyBuilder| {
        let left = part("left", 0.0, 0.0, [0.05, 0.1], [3, 3]);
        let right = change(part("right", 0.15, 0.0, [0.05, 0.1], [3, 3]));
        Scene::new(joined([left, right, slab.clone()]))
            .gravity([0.0, -9.8])
            .spring(Spring::between([8], [26]).stiffness(50.0).named("left"))
            .spring(Spring::between([17], [26]).stiffness(50.0).named("right"))
            .phase(Phase::until(0.05).hold("left/bottom").hold("right/bottom"))
    };
    agrees(&scene(|body| body), Axis::X);
    let pair = |change: fn(BodyBuilder) -> BodyBuilder| {
        let left = part("left", 0.0, 0.0, [0.05, 0.1], [3, 3]);
        let right = change(part("right", 0.15, 0.0, [0.05, 0.1], [3, 3]));
        Scene::new(joined([left, right]))
            .gravity([0.0, -9.8])
            .spring(Spring::anchored([8], [-0.1, 0.2]).stiffness(50.0).named("left"))
            .spring(Spring::anchored([17], [0.3, 0.2]).stiffness(50.0).named("right"))
            .phase(Phase::until(0.05).hold("left/bottom").hold("right/bottom"))
    };
    agrees(&pair(|body| body), Axis::X);
    let half = pair(|body| body).symmetric_half(Axis::X).unwrap();
    assert_eq!(half.body().name(), Some("left"));
    assert_eq!(half.body().mesh().sets()["left/top"], half.body().mesh().sets()["top"]);
    // the names stay: a finer mesh of the half is half of the finer mesh
    let [one, other] = [half.halved(), pair(|body| body).halved().unwrap().symmetric_half(Axis::X)];
    assert_eq!(one.unwrap().body().dofs(), other.unwrap().body().dofs());
    let told = refusal(&pair(|body| body.thickness(0.04)), Axis::X);
    assert!(told.contains("body \"left\" = not made as \"right\""), "{told}");
    let told = refusal(&pair(|body| body.material(Material { young: 2e5, ..RUBBER })), Axis::X);
    assert!(told.contains("material of cell = 1"), "{told}");
    let cut = Scene::new(joined([slab.clone()]))
        .gravity([0.0, -9.8])
        .obstacle(Obstacle::half_plane([0.0, 0.0199], [0.0, 1.0]).stiffness_density(1e6))
        .phase(Phase::until(0.04));
    agrees(&cut, Axis::X);
    let weighed = Scene::new(joined([slab.material(Material::rigid_of(RigidMass::new(2.0)))]))
        .phase(Phase::until(0.1));
    assert!(
        refusal(&weighed, Axis::X)
            .contains("body = \"slab\" cannot be used: the plane of symmetry cuts it")
    );
}

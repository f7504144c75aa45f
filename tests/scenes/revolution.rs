//! Bodies of revolution beside the same in space, on floors, under weight, and what they do not have.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::common::run;
use pliant::{
    Axis, Body, Cells, Chamber, Fibres, Growth, Guide, InputError, Law, Material, Mesh, Method,
    Obstacle, Phase, Plane, Scene, Settings, SolidCells, Spring, Statics, Touch, body::BodyBuilder,
};

const SOFT: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 20.0 };

fn turned(mesh: Mesh) -> BodyBuilder {
    Body::new(mesh, SOFT).plane(Plane::Axisymmetric)
}

fn tube(nodes: [usize; 2]) -> Mesh {
    let mesh = Mesh::rectangle([0.01, 0.02], nodes, Cells::Rectangles9).unwrap();
    mesh.translated(&[0.01, 0.0]).unwrap()
}

/// A thick tube that stands, clamped, is blown up within 5 ms, and swings: a quarter of it in space, of quadratic hexahedra between planes of symmetry, and its
/// section. Displacements at the top differ by 1 % of the largest, more than either changes with a finer mesh; forces on the base are four
/// times those of the quarter.
#[test]
fn as_in_space() {
    let law = SOFT.law(Law::NeoHookean);
    let pressure = |t: f64| 4e3 * (t / 5e-3).min(1.0);
    let phase = || Phase::until(0.03).hold("bottom");
    let times: Vec<f64> = (0..=30).map(|k| 0.001 * f64::from(k)).collect();
    let settings = Settings { method: Method::CvodeBdf, rtol: 1e-4, ..Settings::default() };
    let body = Body::new(tube([4, 6]), law.clone()).plane(Plane::Axisymmetric).build().unwrap();
    let scene =
        Scene::new(body).phase(phase().pressure_on("left", pliant::Signal::function(pressure)));
    let flat = run(&scene, &settings, &times);
    let bend = |x: &[f64]| {
        let (r, angle) = (0.01 + x[0], FRAC_PI_2 * x[1]);
        [r * angle.cos(), r * angle.sin(), x[2]]
    };
    let block = Mesh::cuboid([0.01, 1.0, 0.02], [3, 5, 5], SolidCells::Hexahedra20).unwrap();
    let quarter = Body::new(block.mapped(bend).unwrap(), law).build().unwrap();
    println!("{:?}", quarter.mesh().sets().keys());
    assert!((4.0 * quarter.mass() / flat.body().mass() - 1.0).abs() < 1e-3);
    let phase = phase().symmetry("front", [0.0, 1.0, 0.0]).symmetry("back", [1.0, 0.0, 0.0]);
    let scene =
        Scene::new(quarter).phase(phase.pressure_on("left", pliant::Signal::function(pressure)));
    let solid = run(&scene, &settings, &times);
    let corner = |body: &Body, at: &[f64]| {
        let near = |node: &usize| {
            body.mesh().position(*node).iter().zip(at).all(|(x, at)| (x - at).abs() < 1e-9)
        };
        (0..body.mesh().node_count()).find(near).unwrap()
    };
    let [a, b] = [corner(flat.body(), &[0.01, 0.02]), corner(solid.body(), &[0.01, 0.0, 0.02])];
    let (mut most, mut apart) = (0.0_f64, 0.0_f64);
    for (flat, solid) in flat.samples().iter().zip(solid.samples()) {
        for (i, j) in [(0, 0), (1, 2)] {
            most = most.max(flat.u[2 * a + i].abs());
            apart = apart.max((flat.u[2 * a + i] - solid.u[3 * b + j]).abs());
        }
    }
    println!("{:e} of {most:e}", apart / most);
    assert!(most > 1e-3 && apart < 0.01 * most, "{apart:e} of {most:e}");
}

/// A column of nu = 0 stands on a floor with a stiffness k per area: it sinks by rho g L / k everywhere, is shortened by rho g L^2 / 2 E, and the floor carries
/// all of its weight; a traction on top adds to both. Contact acts at nodes, by areas of straight edges: the bottom is level to 0.2 %.
#[test]
fn a_column_on_a_floor() {
    let (length, k, g, traction) = (0.05, 1e7, 9.8, 30.0);
    let material = Material { poisson: 0.0, ..SOFT };
    let mesh = Mesh::rectangle([0.02, length], [5, 7], Cells::Triangles6).unwrap();
    let body = Body::new(mesh, material).plane(Plane::Axisymmetric).strain(pliant::Strain::Cauchy);
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness_density(k).named("floor");
    let phase = Phase::until(1.0).traction("top", [0.0, -traction]);
    let scene = Scene::new(body.build().unwrap()).gravity([0.0, -g]).obstacle(floor).phase(phase);
    let found = scene.equilibrium(&Statics::default()).unwrap();
    let (u, body) = (found.displacements(), found.trajectory().body());
    let weight = material.density * g * length;
    let at = |set: &str| body.mesh().sets()[set].iter().map(|node| u[2 * node + 1]);
    let sunk = -(weight + traction) / k;
    for y in at("bottom") {
        assert!((y / sunk - 1.0).abs() < 3e-3, "{y} {sunk}");
    }
    let short = (0.5 * weight + traction) * length / material.young;
    for y in at("top") {
        assert!((y / (sunk - short) - 1.0).abs() < 3e-3, "{y} {}", sunk - short);
    }
    let forces = found.trajectory().contact_forces(found.sample()).unwrap();
    let force: f64 = forces.chunks(2).map(|force| force[1]).sum();
    let expected = PI * 0.02 * 0.02 * (weight + traction);
    assert!((force / expected - 1.0).abs() < 1e-6, "{force} {expected}");
}

fn refused(found: Result<(), InputError>, words: &[&str]) {
    let message = found.unwrap_err().to_string();
    for word in words {
        assert!(message.contains(word), "{message}: no \"{word}\"");
    }
}

/// Parts that a body of revolution cannot have are named, with the mend.
#[test]
fn refusals() {
    let build = |body: BodyBuilder| body.build().map(|_| ());
    let disc = || Mesh::rectangle([0.02, 0.01], [3, 3], Cells::Rectangles).unwrap();
    let beyond = disc().translated(&[-0.01, 0.0]).unwrap();
    refused(build(turned(beyond)), &["beyond the axis", "nodes [1, 4, 7]", "Move the mesh"]);
    refused(build(turned(disc()).thickness(0.01)), &["thickness", "2 pi r", "leave it out"]);
    let bar = Body::new(Mesh::bar(0.1, 3).unwrap(), SOFT).plane(Plane::Axisymmetric);
    refused(build(bar), &["axisymmetric body", "two dimensions"]);
    let fibres = Fibres::along([0.0, 1.0], 1e5);
    for (substance, word) in [
        (SOFT.maxwell(0.5, 0.1), "material.branch"),
        (SOFT.fibres(fibres), "material.fibres"),
        (Material::rigid(1000.0), "material.rigid"),
    ] {
        refused(build(turned(disc()).material(substance)), &[word, "mesh the body in space"]);
    }
    let flat = Body::new(disc(), SOFT).thickness(0.01).build().unwrap();
    let both = Body::join([turned(disc()).build().unwrap(), flat]).map(|_| ());
    refused(both, &["body 2", "not axisymmetric", "all are, or none"]);

    let scene = || Scene::new(turned(disc()).build().unwrap());
    let free = || Phase::until(1.0);
    let cases = [
        (scene().gravity([1.0, 0.0]).phase(free()), "gravity"),
        (scene().phase(free().rotate("right", [0.0, 0.0], [1.0])), "rotation"),
        (scene().spin([1.0]).phase(free()), "spin"),
        (scene().growth(Growth::everywhere().named("g")).phase(free()), "growth"),
        (scene().touch(Touch::all()).phase(free()), "touch"),
        (
            scene()
                .spring(Spring::cable([Guide::point([0.0, -0.01]), Guide::nodes("top")]))
                .phase(free()),
            "cable",
        ),
        (scene().initial_velocity_of("all", [1.0, 0.0]).phase(free()), "initial velocity"),
        (scene().phase(free().move_nodes("left", [1.0, 0.0])), "contradict"),
        (
            scene().chamber(Chamber::within("air", "right")).phase(free().pressure("air", 1.0)),
            "open",
        ),
    ];
    for (scene, word) in cases {
        refused(scene.validate(), &[word]);
    }
    refused(scene().phase(free()).symmetric_half(Axis::Y).map(|_| ()), &["half", "axisymmetric"]);
}

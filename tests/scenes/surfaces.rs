//! Rigid bodies that are closed surfaces of triangles, against the same ones filled with cells.

use std::path::Path;

use super::rigid::run;
use pliant::mesh::CellKind;
use pliant::{
    Body, Fluid, Material, Mesh, Method, Obstacle, Phase, Scene, SceneFile, SolidCells, Stability,
    Statics, Touch,
};

const SIDE: f64 = 0.02;

/// A cube as an STL file has it: two triangles for each face, each with three points.
fn stl_of_a_cube() -> String {
    let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|i| i as f64 * SIDE);
    // the corners around each face
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut text = String::from("solid cube\n");
    for [a, b, c, d] in faces {
        for triangle in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in triangle.map(corner) {
                text += &format!("vertex {x} {y} {z}\n");
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid cube\n"
}

/// The cube by its surface and by one hexahedron.
fn cubes() -> [Mesh; 2] {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("cube.stl");
    std::fs::write(&path, stl_of_a_cube()).unwrap();
    let cells = Mesh::cuboid([SIDE; 3], [2; 3], SolidCells::Hexahedra).unwrap();
    [Mesh::read_surface(&path).unwrap(), cells]
}

/// Numbers (three for each node) at the corner at a place.
fn at<'a>(mesh: &Mesh, values: &'a [f64], place: &[f64]) -> &'a [f64] {
    let near = |x: &[f64]| x.iter().zip(place).all(|(a, b)| (a - b).abs() < 1e-12);
    let node = mesh.positions().chunks_exact(3).position(near).unwrap();
    &values[3 * node..][..3]
}

/// A cube falls onto the ground on an edge, spinning, and tumbles with friction: by its surface as by its cell, but for what the
/// tolerance leaves (other nodes are the frame, so that steps differ); both have the same eight corners, which feel the ground.
#[test]
fn a_cube_tumbles_by_its_surface_as_by_its_cell() {
    let motions = cubes().map(|mesh| {
        let tilted = mesh.turned(&[0.5, 0.3, 0.2]).unwrap().translated(&[0.0, 0.0, 0.01]).unwrap();
        let body = Body::new(tilted, Material::rigid(1000.0)).build().unwrap();
        assert!((body.mass() / (1000.0 * SIDE.powi(3)) - 1.0).abs() < 1e-12);
        assert!((body.volume() / SIDE.powi(3) - 1.0).abs() < 1e-12);
        assert_eq!(body.independent_dofs(), 12);
        let ground = Obstacle::half_plane([0.0; 3], [0.0, 0.0, 1.0]);
        let ground = ground.stiffness(200.0).damping(0.1).friction_coefficient(0.3);
        let scene = Scene::new(body)
            .gravity([0.0, 0.0, -9.8])
            .spin([5.0, -10.0, 3.0])
            .initial_velocity(|_| vec![0.2, 0.1, 0.0])
            .obstacle(ground.sticking_speed(0.01))
            .phase(Phase::until(0.3));
        run(&scene, Method::Rk, 1e-9)
    });
    let [surface, cells] = &motions;
    let mut off = 0.0_f64;
    for (node, place) in cells.body().mesh().positions().chunks_exact(3).enumerate() {
        let own = at(surface.body().mesh(), &surface.last().u, place);
        let other = &cells.last().u[3 * node..][..3];
        off = own.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(off, f64::max);
    }
    let way = cells.last().u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    println!(
        "{off:.1e} m off after {way} m; balances {:.1e}, {:.1e} J; {} and {} steps",
        surface.report().energy_error,
        cells.report().energy_error,
        surface.report().steps(),
        cells.report().steps()
    );
    assert!(way > 0.02 && off < 4e-7, "{off} m off");
    let kinetic = motions.each_ref().map(|motion| motion.samples()[0].energy.kinetic);
    assert!((kinetic[0] / kinetic[1] - 1.0).abs() < 1e-12, "{kinetic:?}");
}

/// A cube flies into a soft block: the momentum of both is kept, and the cube slows down as much by its surface as by its cell,
/// whose square faces have other quadrature points.
#[test]
fn a_surface_touches_what_is_soft() {
    let speeds = cubes().map(|mesh| {
        let cube = mesh.translated(&[0.0, 0.0, 0.0225]).unwrap();
        let block = Mesh::cuboid([0.03, 0.03, 0.02], [4, 4, 3], SolidCells::Hexahedra).unwrap();
        let block = block.translated(&[-0.004, -0.006, 0.0]).unwrap();
        let soft = Material { density: 1000.0, young: 2e5, poisson: 0.3, viscosity: 100.0 };
        let bodies = [
            Body::new(cube, Material::rigid(2000.0)).named("cube").build().unwrap(),
            Body::new(block, soft).named("block").build().unwrap(),
        ];
        let scene = Scene::new(Body::join(bodies).unwrap())
            .touch(Touch::all().distance(2e-3).stiffness_density(1e8))
            .initial_velocity(|x| vec![0.0, 0.0, if x[2] > 0.0221 { -0.4 } else { 0.0 }])
            .phase(Phase::until(0.04));
        let motion = run(&scene, Method::CvodeBdf, 1e-6);
        let momentum = motion.momentum(motion.last());
        let start = 2000.0 * SIDE.powi(3) * 0.4;
        let off = [momentum[0], momentum[1], momentum[2] + start];
        assert!(off.iter().all(|p| p.abs() < 1e-6 * start), "{momentum:?}");
        assert!(motion.report().warnings().is_empty(), "{:?}", motion.report().warnings());
        let cube = motion.body().parts().next().unwrap();
        cube.body.mean_velocity(&motion.last().v[cube.dofs()])[2]
    });
    println!("{speeds:?} m/s, {:.2e} apart", speeds[0] / speeds[1] - 1.0);
    assert!(speeds[0] > -0.3 && (speeds[0] / speeds[1] - 1.0).abs() < 0.01, "{speeds:?}");
}

/// Under water a surface rises as Archimedes says, as water presses on it from outside: by g (1000 - 400)/400.
#[test]
fn a_surface_rises_in_water() {
    let [surface, _] = cubes();
    let surface = surface.turned(&[0.3, 0.8, -0.2]).unwrap().translated(&[0.0, 0.0, -0.2]).unwrap();
    let body = Body::new(surface, Material::rigid(400.0)).build().unwrap();
    let scene = Scene::new(body)
        .gravity([0.0, 0.0, -9.8])
        .fluid(Fluid::new(1000.0).level(0.0))
        .phase(Phase::until(0.1));
    let motion = run(&scene, Method::Rk, 1e-8);
    let rise = 0.5 * 9.8 * 1.5 * 0.01;
    let off = motion
        .last()
        .u
        .chunks_exact(3)
        .map(|u| u[0].abs().max(u[1].abs()).max((u[2] - rise).abs()));
    let off = off.fold(0.0, f64::max);
    println!("{off:.1e} m off after {rise} m");
    assert!(off < 2e-11, "{off}");
}

/// Held by one face, it carries its weight at rest, in shape.
#[test]
fn a_surface_rests() {
    let [surface, _] = cubes();
    let body = Body::new(surface, Material::rigid(1000.0)).build().unwrap();
    let bottom = pliant::Selection::Box { min: vec![-1.0, -1.0, -1e-6], max: vec![1.0, 1.0, 1e-6] };
    let scene = Scene::new(body).gravity([0.0, 0.0, -9.8]).phase(Phase::until(1.0).hold(bottom));
    let still = scene.equilibrium(&Statics::default()).unwrap();
    assert!(matches!(still.stability, Stability::Stable { .. }), "{:?}", still.stability);
    let rest = still.trajectory();
    let forces = rest.constraint_forces(rest.last()).unwrap();
    let weight: f64 = forces.iter().skip(2).step_by(3).sum();
    let sag = rest.last().u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    println!("{:.1e}, {sag:.1e} m", weight / (9.8 * rest.body().mass()) - 1.0);
    assert!((weight / (9.8 * rest.body().mass()) - 1.0).abs() < 1e-6);
    // rho g H^2/(2 E) in a column, some times of it by walls alone
    assert!(sag > 0.0 && sag < 1e-7, "{sag}");
}

/// What a surface alone cannot be is told.
#[test]
fn a_surface_is_no_soft_body() {
    let [surface, _] = cubes();
    let soft = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
    let rigid = || Material::rigid(1000.0);
    let mirrored = surface.clone().mapped(|x| [-x[0], x[1], x[2]]).unwrap();
    let cells = || pliant::body::CellSelection::inside([0.0; 3], [0.01; 3]);
    let cases = [
        (Body::new(surface.clone(), soft), "a body that deforms needs a mesh of cells"),
        (Body::new(surface.clone(), rigid()).thickness(0.01), "has no thickness"),
        (Body::new(surface.clone(), rigid()).region(cells(), rigid()), "no cells within"),
        (Body::new(mirrored, rigid()), "volume within the surface = -"),
    ];
    for (body, told) in cases {
        let error = body.build().unwrap_err().to_string();
        assert!(error.contains(told), "{error}");
    }
    // finer triangles of the same solid
    let fine = surface.halved();
    assert_eq!((fine.cell_count(), fine.kind()), (48, CellKind::Triangle));
    let fine = Body::new(fine, rigid()).build().unwrap();
    assert!((fine.mass() / (1000.0 * SIDE.powi(3)) - 1.0).abs() < 1e-12);
    let file = |mesh: &str| {
        let text = format!(
            "[body]\nmesh = {mesh}\nmaterial = {{ density = 1000.0, rigid = true }}\n[[phase]]\nuntil = 1.0\n"
        );
        SceneFile::parse(&text, Path::new("scenes/none.toml"))
    };
    let bowl = file(r#"{ kind = "surface", file = "meshes/bowl.stl", scale = 0.001 }"#).unwrap();
    assert!(bowl.scene.body().mass() > 0.01 && bowl.scene.body().mass() < 0.03);
    let told = file(r#"{ kind = "surface", file = "meshes/ball.msh" }"#).unwrap_err().to_string();
    assert!(told.contains("tetrahedra"), "{told}");
    let told = file(r#"{ kind = "surface", file = "meshes/none.stl" }"#).unwrap_err().to_string();
    assert!(told.contains("body.mesh.file") && told.contains("cannot be read"), "{told}");
}

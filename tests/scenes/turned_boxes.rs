//! Boxes that are turned as obstacles: against half-planes, and against the same scene in which all else is turned the other way.

use nalgebra::{Rotation3, Vector3};
use pliant::{
    Body, Cells, Material, Mesh, Method, Obstacle, Phase, Sampling, Scene, Settings, SolidCells,
    Trajectory,
};

const RUBBER: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 40.0 };

/// The largest difference of displacements (m).
fn apart(a: &Trajectory, b: &Trajectory) -> f64 {
    let samples = a.samples().iter().zip(b.samples());
    let each = samples.flat_map(|(a, b)| a.u.iter().zip(&b.u).map(|(a, b)| (a - b).abs()));
    each.fold(0.0, f64::max)
}

fn settings() -> Settings {
    // counted work, by which the automatic choice goes, may differ by round-off
    Settings { method: Method::Rosenbrock, rtol: 1e-6, ..Settings::default() }
}

/// A soft block slides down a slope of 30 degrees that is lifted meanwhile: a face of a large box, or a half-plane.
#[test]
fn a_slope_in_the_plane() {
    const ANGLE: f64 = std::f64::consts::PI / 6.0;
    let (sine, cosine) = ANGLE.sin_cos();
    let mesh = Mesh::rectangle([0.04, 0.02], [5, 3], Cells::Rectangles).unwrap();
    let mesh = mesh.turned(&[ANGLE]).unwrap().translated(&[0.0, 1e-4]).unwrap();
    let motion = |slope: Obstacle| {
        let body = Body::new(mesh.clone(), RUBBER).thickness(0.02).build().unwrap();
        let slope = slope.stiffness(1e3).damping(1.0).friction_coefficient(0.2);
        let scene = Scene::new(body)
            .gravity([0.0, -9.8])
            .obstacle(slope.velocity([0.0, 0.1]))
            .phase(Phase::until(0.3));
        scene.simulate(&settings(), &Sampling::every(0.05)).unwrap()
    };
    // the middle of the upper face is at the origin
    let box_middle = [0.1 * sine, -0.1 * cosine];
    let (min, max) = ([-1.0, -0.1], [1.0, 0.1]);
    let placed = |corner: [f64; 2]| [corner[0] + box_middle[0], corner[1] + box_middle[1]];
    let of_box = motion(Obstacle::turned_box(placed(min), placed(max), [ANGLE]));
    let of_plane = motion(Obstacle::half_plane([0.0, 0.0], [-sine, cosine]));
    assert!(of_plane.last().u[0] < -0.05, "{}", of_plane.last().u[0]);
    let apart = apart(&of_box, &of_plane);
    assert!(apart < 1e-9, "{apart:e}");
}

/// A soft block falls on the edge of a box and slides off: in space it does not matter whether the box is turned about its middle, or all
/// else the other way.
#[test]
fn a_scene_that_is_turned() {
    let turn = [0.4, -0.7, 0.5];
    let rotation = Rotation3::new(Vector3::from(turn));
    let mesh = Mesh::cuboid([0.03, 0.02, 0.02], [3, 3, 3], SolidCells::Hexahedra).unwrap();
    let mesh = mesh.translated(&[0.004, 0.003, 0.021]).unwrap();
    let (min, max) = ([-0.02, -0.01, -0.02], [0.02, 0.01, 0.02]);
    let motion = |mesh: Mesh, gravity: Vector3<f64>, obstacle: Obstacle| {
        let body = Body::new(mesh, RUBBER).build().unwrap();
        let obstacle = obstacle.stiffness(200.0).damping(0.2).tangential_damping(0.1);
        let scene = Scene::new(body)
            .gravity(gravity.as_slice())
            .obstacle(obstacle)
            .phase(Phase::until(0.15));
        scene.simulate(&settings(), &Sampling::every(0.05)).unwrap()
    };
    let gravity = Vector3::new(1.0, 2.0, -9.0);
    let upright = motion(mesh.clone(), gravity, Obstacle::box_between(min, max));
    let turned = mesh.turned(&turn).unwrap();
    let turned = motion(turned, rotation * gravity, Obstacle::turned_box(min, max, turn));
    let [(here, there), ..] = [(upright.last(), turned.last())];
    let moved = here.u.chunks(3).zip(there.u.chunks(3));
    let apart = moved.map(|(here, there)| {
        (rotation * Vector3::from_column_slice(here) - Vector3::from_column_slice(there)).norm()
    });
    let apart = apart.fold(0.0, f64::max);
    let way = Vector3::from_column_slice(&here.u[..3]).norm();
    assert!(way > 0.02, "{way}");
    assert!(apart < 2e-7 * way, "{apart:e} of {way}");
}

/// Turns that a box cannot have.
#[test]
fn refusals() {
    let mesh = Mesh::rectangle([0.04, 0.02], [5, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, RUBBER).thickness(0.02).build().unwrap();
    for turn in [vec![], vec![0.1, 0.2, 0.3], vec![f64::NAN]] {
        let slope = Obstacle::turned_box([0.0, -1.0], [1.0, -0.5], turn).stiffness(1e3);
        let scene = Scene::new(body.clone()).obstacle(slope).phase(Phase::until(0.1));
        let error = scene.simulate(&settings(), &Sampling::phase_ends()).unwrap_err().to_string();
        assert!(error.contains("turn"), "{error}");
    }
}

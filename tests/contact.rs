//! Bodies on a floor, against closed forms.

use pliant::samples::SQUARE_MATERIAL;
use pliant::{Axis, Body, Cells, Mesh, Method, Obstacle, Phase, Sampling, Scene, Solver};

const MASS: f64 = 0.9;

fn square() -> Scene {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    Scene::new(Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).build().unwrap())
}

/// At rest the penalty springs carry the weight, and store (K/2) sum d^2.
#[test]
fn the_floor_carries_the_weight() {
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(2000.0).damping(40.0);
    let scene = square().gravity([0.0, -9.8]).obstacle(floor).phase(Phase::until(6.0));
    for method in [Method::CvodeBdf, Method::Ida] {
        let solver = Solver { method, rtol: 1e-7, ..Solver::default() };
        let trajectory = scene.simulate(&solver, &Sampling::phase_ends()).unwrap();
        let last = trajectory.last();
        let depths: Vec<f64> = (0..4).map(|node| -last.u[2 * node + 1]).collect();
        let carried: f64 = depths.iter().map(|depth| 2000.0 * depth).sum();
        // what is left of the bouncing after 6 s is of the size of the tolerance
        assert!((carried / (MASS * 9.8) - 1.0).abs() < 1e-5, "{method}: {carried}");
        let stored: f64 = depths.iter().map(|depth| 1000.0 * depth * depth).sum();
        assert!((last.energy.contact / stored - 1.0).abs() < 1e-9);
    }
}

/// A square set sliding at 1 m/s over the floor is slowed by B_t at its four lower nodes:
/// v = exp(-4 B_t t / m), as a rigid body, for the springs keep all four in touch.
#[test]
fn friction_slows_a_sliding_square() {
    let floor = Obstacle::half_plane([0.0, 0.002], [0.0, 1.0]).stiffness(5000.0).friction(0.05);
    let touching: Vec<usize> = (1..=16).collect();
    let scene = square()
        .obstacle(floor)
        .phase(
            Phase::until(0.1)
                .named("towed")
                .move_axis(touching.clone(), Axis::X, 1.0)
                .hold_axes(touching.clone(), [Axis::Y])
                .without_contact()
                .project_velocity(),
        )
        // a sledge: the lower nodes stay at their depth
        .phase(Phase::until(2.1).named("slides").hold_axes("bottom", [Axis::Y]));
    for method in [Method::CvodeBdf, Method::Ida, Method::Rk] {
        let solver = Solver { method, rtol: 1e-8, ..Solver::default() };
        let trajectory = scene.simulate(&solver, &Sampling::at([1.1])).unwrap();
        for sample in trajectory.samples().iter().filter(|s| s.phase == 1) {
            let expected = (-4.0 * 0.05 * (sample.time - 0.1) / MASS).exp();
            let found = trajectory.mean_velocity(sample)[0];
            // the square shears under the friction: a soft body, not a rigid one
            assert!((found / expected - 1.0).abs() < 1e-3, "{method}: {found} {expected}");
        }
    }
}

/// A body that touches no floor feels none: the motion is the same to the last bit.
#[test]
fn an_obstacle_out_of_reach_changes_nothing() {
    let phase = || Phase::until(0.2).hold("bottom").load([15], [3.0, 1.0]);
    let far = Obstacle::half_plane([0.0, -1.0], [0.0, 1.0]).stiffness(1e5);
    let alone = square().phase(phase()).simulate(&Solver::default(), &Sampling::every(0.05));
    let near = square().obstacle(far).phase(phase());
    let near = near.simulate(&Solver::default(), &Sampling::every(0.05));
    let u = |trajectory: Result<pliant::Trajectory, pliant::Error>| {
        trajectory.unwrap().samples().iter().map(|s| s.u.clone()).collect::<Vec<_>>()
    };
    assert_eq!(u(alone), u(near));
}

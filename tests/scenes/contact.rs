//! Bodies on a floor, against closed forms.

use pliant::samples::SQUARE_MATERIAL;
use pliant::{
    Axis, Body, Cells, Mesh, Method, Obstacle, Phase, Sampling, Scene, Settings, Shape, Strain,
    Trajectory,
};

use crate::common::square;

const MASS: f64 = 0.9;

/// At rest the penalty springs carry the weight, and store (K/2) sum d^2.
#[test]
fn the_floor_carries_the_weight() {
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(2000.0).damping(40.0);
    let scene = square().gravity([0.0, -9.8]).obstacle(floor).phase(Phase::until(6.0));
    for method in [Method::CvodeBdf, Method::Ida] {
        let settings = Settings { method, rtol: 1e-7, ..Settings::default() };
        let trajectory = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
        let last = trajectory.last();
        let depths: Vec<f64> = (0..4).map(|node| -last.u[2 * node + 1]).collect();
        let carried: f64 = depths.iter().map(|depth| 2000.0 * depth).sum();
        // what is left of the bouncing after 6 s is 1e-8
        assert!((carried / (MASS * 9.8) - 1.0).abs() < 5e-7, "{method}: {carried}");
        let stored: f64 = depths.iter().map(|depth| 1000.0 * depth * depth).sum();
        assert!((last.energy.contact / stored - 1.0).abs() < 1e-9);
    }
}

/// A square set sliding at 1 m/s over the floor is slowed by B_t at its four lower nodes:
/// v = exp(-4 B_t t / m), as a rigid body, for the springs keep all four in touch.
#[test]
fn tangential_damping_slows_a_sliding_square() {
    let floor =
        Obstacle::half_plane([0.0, 0.002], [0.0, 1.0]).stiffness(5000.0).tangential_damping(0.05);
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
        let settings = Settings { method, rtol: 1e-8, ..Settings::default() };
        let trajectory = scene.simulate(&settings, &Sampling::at([1.1])).unwrap();
        for sample in trajectory.samples().iter().filter(|s| s.phase == 1) {
            let expected = (-4.0 * 0.05 * (sample.time - 0.1) / MASS).exp();
            let found = trajectory.mean_velocity(sample)[0];
            // the square shears under it: a soft body, not a rigid one
            assert!((found / expected - 1.0).abs() < 2e-4, "{method}: {found} {expected}");
        }
    }
}

/// A body that touches no floor feels none: the motion is the same to the last bit.
#[test]
fn an_obstacle_out_of_reach_changes_nothing() {
    let phase = || Phase::until(0.2).hold("bottom").load([15], [3.0, 1.0]);
    let far = Obstacle::half_plane([0.0, -1.0], [0.0, 1.0]).stiffness(1e5);
    // (not with ARKODE, which is told that a phase without contact is linear)
    let settings = Settings { method: Method::CvodeBdf, ..Settings::default() };
    let alone = square().phase(phase()).simulate(&settings, &Sampling::every(0.05));
    let near = square().obstacle(far).phase(phase());
    let near = near.simulate(&settings, &Sampling::every(0.05));
    let u = |trajectory: Result<pliant::Trajectory, pliant::Error>| {
        trajectory.unwrap().samples().iter().map(|s| s.u.clone()).collect::<Vec<_>>()
    };
    assert_eq!(u(alone), u(near));
}

/// The energy balance closes to `tolerance` of all energy there was.
#[track_caller]
fn assert_balanced(trajectory: &Trajectory, tolerance: f64) {
    let report = trajectory.report();
    println!("energy off by {:e} of {:e} J", report.energy_error, report.energy_scale);
    assert!(report.energy_error < tolerance * report.energy_scale, "{}", report.energy_error);
}

/// A stiffness per area needs no retuning: under a weight of p per area, which all bodies of one
/// height have, the floor gives way by p over its stiffness, whatever the mesh.
#[test]
fn a_stiffness_per_area_suits_all_meshes() {
    let (stiffness, pressure) = (1e6, 1000.0 * 0.1 * 9.8);
    for (cells, nodes) in [
        (Cells::Triangles, [4, 2]),
        (Cells::Triangles, [13, 5]),
        (Cells::Rectangles, [6, 3]),
        (Cells::Triangles6, [4, 3]),
    ] {
        let mesh = Mesh::rectangle([0.3, 0.1], nodes, cells).unwrap();
        let body = Body::new(mesh, SQUARE_MATERIAL)
            .strain(Strain::Cauchy)
            .thickness(0.02)
            .build()
            .unwrap();
        let bottom = body.mesh().sets()["bottom"].clone();
        let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness_density(stiffness);
        let scene = Scene::new(body)
            .gravity([0.0, -9.8])
            .obstacle(floor.damping(1e5))
            .phase(Phase::until(3.0));
        let method = Method::Arkode;
        let settings = Settings { method, rtol: 1e-6, ..Settings::default() };
        let trajectory = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
        let last = trajectory.last();
        let depths: Vec<f64> = bottom.iter().map(|&node| -last.u[2 * node + 1]).collect();
        // the mean along the bottom by its shape functions: nodes at equal distances are those of straight edges, or of
        // parabolas
        let mean = match cells {
            Cells::Triangles6 => {
                let whole: Vec<&[f64]> = depths.windows(3).step_by(2).collect();
                let of = |edge: &&[f64]| (edge[0] + 4.0 * edge[1] + edge[2]) / 6.0;
                whole.iter().map(of).sum::<f64>() / whole.len() as f64
            }
            _ => {
                let pairs = depths.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
                pairs.sum::<f64>() / (depths.len() - 1) as f64
            }
        };
        println!("{cells:?} {nodes:?}: {mean:e} m, {depths:?}");
        // what is left of the bouncing after 3 s is 4e-10
        assert!((mean * stiffness / pressure - 1.0).abs() < 1e-8, "{cells:?} {nodes:?}: {mean}");
        // the bottom is bulged by its own weight
        assert!(depths.iter().all(|depth| (depth / mean - 1.0).abs() < 0.1));
    }
}

/// A conveyor belt: tangential damping B_t at the four lower nodes brings the square to the speed of the
/// belt, v = w (1 - exp(-4 B_t t / m)). The belt's drive pays for motion and heat.
#[test]
fn a_belt_carries_a_square_along() {
    let (w, damping) = (0.5, 0.2);
    let belt = Obstacle::half_plane([0.0, 0.002], [0.0, 1.0])
        .stiffness(5000.0)
        .tangential_damping(damping);
    let scene = square()
        .obstacle(belt.named("belt").velocity([w, 0.0]))
        .phase(Phase::until(1.0).hold_axes("bottom", [Axis::Y]));
    for method in [Method::CvodeBdf, Method::Ida, Method::Rk] {
        let settings = Settings { method, rtol: 1e-7, ..Settings::default() };
        let trajectory = scene.simulate(&settings, &Sampling::every(0.1)).unwrap();
        for sample in trajectory.samples() {
            let expected = w * (1.0 - (-4.0 * damping * sample.time / MASS).exp());
            let found = trajectory.mean_velocity(sample)[0];
            // a soft body, whose lower edge is ahead
            assert!((found - expected).abs() < 3e-3 * w, "{method}: {found} {expected}");
        }
        let energy = trajectory.last().energy;
        let start = trajectory.samples()[0].energy;
        let gained = energy.kinetic + energy.strain + energy.contact - start.contact;
        assert!(energy.dissipated > 0.1 * gained, "{energy:?}");
        // all that there is has come from the belt
        let supplied = energy.supplied - energy.dissipated - gained;
        assert!(supplied.abs() < 1e-6 * energy.supplied, "{method}: {energy:?}");
        assert_balanced(&trajectory, 1e-5);
    }
}

/// A ram, a disc on its way up, throws a square into the air: energy balances, and what the square
/// flies with, the ram has supplied.
#[test]
fn a_ram_throws_a_square() {
    for strain in [Strain::Cauchy, Strain::Green] {
        let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
        let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(strain);
        let ram = Obstacle::disc([0.16, -0.301], 0.3)
            .stiffness(2000.0)
            .damping(5.0)
            .tangential_damping(1.0);
        let scene = Scene::new(body.build().unwrap())
            .gravity([0.0, -9.8])
            .obstacle(ram.named("ram").velocity([0.0, 2.0]).adhesion(false))
            .phase(Phase::until(0.2))
            .phase(Phase::until(0.3).without_contact());
        for method in [Method::CvodeBdf, Method::Ida, Method::Rk] {
            let settings = Settings { method, rtol: 1e-7, ..Settings::default() };
            let trajectory = scene.simulate(&settings, &Sampling::every(0.02)).unwrap();
            let before = trajectory.samples().iter().rfind(|s| s.time < 0.201).unwrap();
            println!("{strain:?} {method}: {:?}", before.energy);
            assert!(trajectory.mean_velocity(before)[1] > 1.0);
            assert!(before.energy.supplied > 1.0 && before.energy.dissipated > 1e-3);
            // it has left the ram before contact is switched off, with all that contact stores
            assert_eq!(before.energy.contact, 0.0);
            assert_balanced(&trajectory, 1e-5);
        }
    }
}

/// In a bowl a body finds the lowest place, below the centre, and its weight rests on the bowl.
#[test]
fn a_square_settles_in_a_bowl() {
    let bowl =
        Obstacle::cavity([0.2, 0.5], 0.6).stiffness(2000.0).damping(10.0).tangential_damping(5.0);
    let scene = square().gravity([0.0, -9.8]).obstacle(bowl).phase(Phase::until(6.0));
    let settings = Settings { rtol: 1e-6, ..Settings::default() };
    let trajectory = scene.simulate(&settings, &Sampling::every(0.5)).unwrap();
    let last = trajectory.last();
    let centre = trajectory.centre_of_mass(last);
    assert!((centre[0] - 0.2).abs() < 2e-3, "{centre:?}");
    assert!(last.energy.kinetic < 5e-11);
    assert_balanced(&trajectory, 1e-4);
}

/// A function of one's own that says what a known shape says gives the same motion.
#[test]
fn a_distance_of_ones_own_is_as_good_as_a_known_one() {
    let run = |obstacle: Obstacle| {
        let peg = obstacle.stiffness(2000.0).damping(5.0);
        let scene = square().gravity([0.0, -9.8]).obstacle(peg).phase(Phase::until(0.3));
        let settings = Settings { rtol: 1e-8, ..Settings::default() };
        scene.simulate(&settings, &Sampling::every(0.05)).unwrap()
    };
    let known = run(Obstacle::disc([0.1, -0.2], 0.19));
    let own = run(Obstacle::custom(|x, gradient| {
        let away = [x[0] - 0.1, x[1] + 0.2];
        let distance = away[0].hypot(away[1]);
        gradient.copy_from_slice(&away.map(|x| x / distance));
        distance - 0.19
    }));
    let union = run(Obstacle::union([
        Shape::disc([0.1, -0.2], 0.19),
        Shape::box_between([0.0, -3.0], [1.0, -2.0]),
    ]));
    assert!(known.last().energy.contact > 0.0 || known.last().energy.dissipated > 1e-3);
    for other in [own, union] {
        let pairs = known.last().u.iter().zip(&other.last().u);
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("apart by {apart:e} m");
        assert!(apart < 5e-12, "{apart:e}");
    }
}

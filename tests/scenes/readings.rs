//! What is read from samples: forces of contacts and constraints, angular momentum.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use pliant::{
    Axis, Body, Cells, Error, InputError, Material, Mesh, Obstacle, Phase, Sample, Sampling, Scene,
    Settings, SolidCells, Statics, Strain, Trajectory,
};

type Outcome = Result<(), Error>;

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };

/// A square of 30 cm, 1 cm thick: 0.9 kg.
fn square(nodes: usize) -> Result<Body, InputError> {
    let mesh = Mesh::rectangle([0.3, 0.3], [nodes, nodes], Cells::Triangles)?;
    Body::new(mesh, RUBBER).strain(Strain::Cauchy).thickness(0.01).build()
}

/// Pressed on a floor and a slope that moves, then free over the floor alone, then without contact.
fn pressed(sampling: &Sampling) -> Result<Trajectory, Error> {
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).named("floor");
    let slope = Obstacle::half_plane([0.31, 0.0], [-4.0, 3.0]).named("slope");
    let press = Phase::until(0.05).hold([1]).move_nodes([14, 15], [0.2, -0.16]);
    Scene::new(square(4)?)
        .gravity([0.0, -9.8])
        .obstacle(floor.stiffness(100.0).damping(3.0).tangential_damping(2.0))
        .obstacle(slope.stiffness(500.0).damping(1.0).velocity([-0.3, 0.0]))
        .phase(press)
        .phase(Phase::until(0.08).contact_with(["floor"]))
        .phase(Phase::until(0.1).without_contact().hold_axes([5], [Axis::Y]))
        .simulate(&Settings { rtol: 1e-9, ..Settings::default() }, sampling)
}

fn sum(forces: &[f64]) -> [f64; 2] {
    [0, 1].map(|axis| forces.iter().skip(axis).step_by(2).sum())
}

/// Node by node, the law written out for the obstacles of the phase.
#[test]
fn contact_forces_follow_the_law() -> Outcome {
    let trajectory = pressed(&Sampling::every(0.01))?;
    let mesh = trajectory.body().mesh();
    let mut touching = [0; 3];
    for sample in trajectory.samples() {
        let forces = trajectory.contact_forces(sample)?;
        let mut expected = vec![0.0; forces.len()];
        let floor = ([0.0, 0.0], [0.0, 1.0], [100.0, 3.0, 2.0], 0.0);
        let slope = ([0.31 - 0.3 * sample.time, 0.0], [-0.8, 0.6], [500.0, 1.0, 0.0], -0.3);
        let obstacles = [vec![floor, slope], vec![floor], vec![]];
        for (point, n, [stiffness, damping, tangential], w) in obstacles[sample.phase].clone() {
            for &node in mesh.boundary_nodes() {
                let at = |i: usize| mesh.position(node)[i] + sample.u[2 * node + i] - point[i];
                let distance = n[0] * at(0) + n[1] * at(1);
                let velocity = [sample.v[2 * node] - w, sample.v[2 * node + 1]];
                let rate = n[0] * velocity[0] + n[1] * velocity[1];
                if distance > 0.0 {
                    continue;
                }
                touching[sample.phase] += 1;
                for i in 0..2 {
                    let sliding = velocity[i] - rate * n[i];
                    expected[2 * node + i] +=
                        (-stiffness * distance - damping * rate) * n[i] - tangential * sliding;
                }
            }
        }
        for (found, expected) in forces.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-13, "{found} is not {expected}");
        }
    }
    assert!(touching[0] > 4 && touching[1] > 4 && touching[2] == 0, "{touching:?}");
    Ok(())
}

/// What changes the momentum: gravity, contacts and constraints, in every phase.
#[test]
fn forces_change_the_momentum() -> Outcome {
    let h = 1e-5;
    // away from the ends of phases and from the jump at t = 0, which the stabilization works off
    let middles = [0.02, 0.035, 0.06, 0.07, 0.09];
    let times: Vec<f64> = middles.iter().flat_map(|t| [t - h, *t, t + h]).collect();
    let trajectory = pressed(&Sampling::at(times))?;
    let at = |t: f64| trajectory.samples().iter().find(|s| (s.time - t).abs() < 1e-12).unwrap();
    for t in middles {
        let [before, after] = [t - h, t + h].map(|t| trajectory.momentum(at(t)));
        let contact = sum(&trajectory.contact_forces(at(t))?);
        let constraint = trajectory.constraint_force(at(t), "all")?;
        for axis in 0..2 {
            let weight = [0.0, -0.9 * 9.8][axis];
            let force = weight + contact[axis] + constraint[axis];
            let found = (after[axis] - before[axis]) / (2.0 * h);
            // momenta to about 1e-9 of 0.1 kg m/s, over 2 h, and h^2/6 times the second derivative
            // of forces of 10 N that swing at up to 4e3/s: 3e-5 was found
            assert!((found - force).abs() < 2e-4, "t = {t} s: {found} N is not {force} N");
        }
        assert!(t > 0.05 || constraint[1].abs() > 1.0, "{constraint:?}");
    }
    Ok(())
}

#[test]
fn weight_is_carried_by_what_holds_or_stops_a_body() -> Outcome {
    let weight = 0.9 * 9.8;
    let scene = |phase| Ok::<_, Error>(Scene::new(square(4)?).gravity([0.0, -9.8]).phase(phase));
    // round-off: the last Newton step goes far below rtol 1e-10
    let close = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 2e-12, "{found} is not {expected}");
    };
    let held = Phase::until(1.0).hold([16]).hold_axes("left", [Axis::Y]);
    let held = scene(held)?.equilibrium(&Statics::default())?;
    let force = |nodes: &[usize]| held.trajectory().constraint_force(held.sample(), nodes.to_vec());
    close(force(&[16])?[0], 0.0);
    close(force(&[1, 5, 9, 13])?[1] + force(&[16])?[1], weight);
    assert!(force(&[16])?[1] > 1.0);
    assert_eq!(force(&[2, 3])?, [0.0, 0.0]);

    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(1e4);
    let lying = scene(Phase::until(1.0).hold_axes([1], [Axis::X]))?.obstacle(floor);
    let lying = lying.equilibrium(&Statics::default())?;
    let forces = lying.trajectory().contact_forces(lying.sample())?;
    let depths: f64 = (0..4).map(|node| -lying.displacements()[2 * node + 1]).sum();
    close(sum(&forces)[1], weight);
    close(1e4 * depths, weight);
    assert!(forces[8..].iter().all(|force| *force == 0.0), "only the bottom touches: {forces:?}");
    Ok(())
}

/// A row over two nodes pulls them as its coefficients say, and carries part of the weight.
#[test]
fn a_combination_shares_its_force_out() -> Outcome {
    let bar = Body::new(Mesh::bar(0.1, 6)?, RUBBER).strain(Strain::Cauchy).area(1e-4).build()?;
    let phase = Phase::until(1.0).hold([1]);
    let phase = phase.hold_combination([(5, Axis::X, 0.5), (6, Axis::X, 1.5)]);
    let hung = Scene::new(bar).gravity([-9.8]).phase(phase).equilibrium(&Statics::default())?;
    let forces = hung.trajectory().constraint_forces(hung.sample())?;
    // 10 g; forces balance to round-off
    assert!((forces.iter().sum::<f64>() - 0.01 * 9.8).abs() < 1e-13, "{forces:?}");
    assert!(forces[4] > 0.01 && (forces[5] / forces[4] - 3.0).abs() < 1e-12, "{forces:?}");
    assert_eq!(forces[1..4], [0.0; 3]);
    Ok(())
}

/// A block that spins about a skew axis: J omega about its centre, J = m/12 (b^2 + c^2) about the
/// axis along a, whatever velocity it has as a whole.
#[test]
fn angular_momentum_of_a_spinning_block() -> Outcome {
    let (a, b, c) = (0.1, 0.2, 0.3);
    let (omega, drift) = ([3.0, -2.0, 5.0], [1.0, 2.0, 3.0]);
    let spin = |x: &[f64]| {
        vec![
            omega[1] * x[2] - omega[2] * x[1] + drift[0],
            omega[2] * x[0] - omega[0] * x[2] + drift[1],
            omega[0] * x[1] - omega[1] * x[0] + drift[2],
        ]
    };
    for cells in SolidCells::ALL {
        let body = Body::new(Mesh::cuboid([a, b, c], [2, 3, 4], cells)?, RUBBER)
            .strain(Strain::Cauchy)
            .build()?;
        let scene = Scene::new(body).initial_velocity(spin).phase(Phase::until(1e-6));
        let trajectory = scene.simulate(&Settings::default(), &Sampling::phase_ends())?;
        let found = trajectory.angular_momentum(&trajectory.samples()[0]);
        let mass = 1000.0 * a * b * c;
        let inertia = [b * b + c * c, a * a + c * c, a * a + b * b].map(|x| mass / 12.0 * x);
        for i in 0..3 {
            let expected = inertia[i] * omega[i];
            // velocities are linear, and integrated exactly
            assert!((found[i] / expected - 1.0).abs() < 1e-12, "{cells:?}: {found:?}");
        }
    }
    Ok(())
}

#[test]
fn angular_momentum_of_a_turning_square() -> Outcome {
    let (omega, drift) = (3.0, [1.0, -2.0]);
    let spin = |x: &[f64]| vec![drift[0] - omega * x[1], drift[1] + omega * x[0]];
    let scene = Scene::new(square(4)?).initial_velocity(spin).phase(Phase::until(1e-6));
    let trajectory = scene.simulate(&Settings::default(), &Sampling::phase_ends())?;
    let found = trajectory.angular_momentum(&trajectory.samples()[0]);
    // m w^2 / 6
    assert!((found[0] / (0.9 * 0.09 / 6.0 * omega) - 1.0).abs() < 2e-13, "{found:?}");
    assert_eq!(found.len(), 1);
    Ok(())
}

#[test]
fn samples_of_other_trajectories_are_refused() -> Outcome {
    let trajectory = pressed(&Sampling::phase_ends())?;
    let last = trajectory.last();
    let spoiled = [
        |sample: &mut Sample| sample.phase = 3,
        |sample: &mut Sample| sample.u = vec![0.0; 8],
        |sample: &mut Sample| sample.v.clear(),
        |sample: &mut Sample| sample.multipliers = vec![0.0; 7],
    ];
    for spoil in spoiled {
        let mut bad = last.clone();
        spoil(&mut bad);
        let refused = trajectory.constraint_forces(&bad).unwrap_err().to_string();
        assert!(refused.contains("not a sample of this trajectory"), "{refused}");
        let contact = trajectory.contact_forces(&bad);
        assert_eq!(contact.is_err(), bad.multipliers.len() == last.multipliers.len());
    }
    assert!(trajectory.constraint_force(last, "nowhere").is_err());
    Ok(())
}

/// An obstacle of one's own that does not say any more what it said during the run.
#[test]
fn an_obstacle_that_has_lost_its_meaning_is_named() -> Outcome {
    let lost = Arc::new(AtomicBool::new(false));
    let flag = lost.clone();
    let floor = Obstacle::custom(move |x, gradient| {
        gradient.copy_from_slice(&[0.0, 1.0]);
        if flag.load(Ordering::Relaxed) { f64::NAN } else { x[1] }
    });
    let scene = Scene::new(square(4)?).phase(Phase::until(0.01));
    let scene = scene.obstacle(floor.named("own").stiffness(100.0));
    let trajectory = scene.simulate(&Settings::default(), &Sampling::phase_ends())?;
    assert!(trajectory.contact_forces(trajectory.last()).is_ok());
    lost.store(true, Ordering::Relaxed);
    let refused = trajectory.contact_forces(trajectory.last()).unwrap_err().to_string();
    assert!(refused.contains("obstacle \"own\" gives the distance NaN"), "{refused}");
    Ok(())
}

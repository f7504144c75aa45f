//! Named sensors against closed forms, and against what trajectories say of the same samples.

use pliant::simulate::{Component, Reading};
use pliant::{
    Body, Cells, Chamber, Error, Material, Mesh, Obstacle, Phase, Plane, Sampling, Scene, Settings,
    Shape, SolidCells, Spring, Statics, Strain, Trajectory,
};

type Outcome = Result<(), Error>;

const SOFT: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };

/// What a sensor read with each sample.
fn read(trajectory: &Trajectory, name: &str) -> Vec<f64> {
    let names: Vec<&str> = trajectory.sensors().iter().map(|sensor| &sensor.name[..]).collect();
    let number = names.iter().position(|other| *other == name);
    let number = number.unwrap_or_else(|| panic!("no {name} among {names:?}"));
    trajectory.samples().iter().map(|sample| sample.sensors[number]).collect()
}

fn assert_close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected}");
}

/// What is read at t = 0, in the shape that `u` gives.
fn at_start(
    body: Body,
    u: impl Fn(&[f64]) -> Vec<f64>,
    sampling: Sampling,
    of: impl Fn(Scene) -> Scene,
) -> Result<Trajectory, Error> {
    let scene = Scene::new(body).initial_displacement(u);
    let scene = of(scene).phase(Phase::until(1e-7));
    scene.simulate(&Settings::default(), &sampling)
}

/// A bar of rectangles, pulled by 1 %: stress E e along it, none across, strain -nu e across.
#[test]
fn a_stretched_bar_has_the_stress_of_hooke() -> Outcome {
    let (e, nu) = (0.01, SOFT.poisson);
    for cells in [Cells::Triangles, Cells::Triangles6, Cells::Rectangles] {
        let mesh = Mesh::rectangle([0.3, 0.1], [7, 3], cells)?;
        let body = Body::new(mesh, SOFT).thickness(0.01).plane(Plane::Stress);
        let body = body.strain(Strain::Cauchy).build()?;
        let sampling = Sampling::phase_ends()
            .read("stress", Reading::stress("right"))
            .read("mises", Reading::stress_at([0.123, 0.045]).component(Component::VonMises))
            .read("strain", Reading::strain([1]))
            .read("thinner", Reading::strain_at([0.3, 0.1]).component(Component::YY))
            .read("pulled", Reading::displacement("right").component(Component::X));
        let stretched = |x: &[f64]| vec![e * x[0], -nu * e * x[1]];
        let trajectory = at_start(body, stretched, sampling, |scene| scene)?;
        // round-off of differences of displacements: 2.5e-12 Pa and 4e-18 were found
        let (stress, strain) = (2e-11, 2e-17);
        let expected = [
            ("stress.xx", SOFT.young * e, stress),
            ("stress.yy", 0.0, stress),
            ("stress.zz", 0.0, stress),
            ("stress.xy", 0.0, stress),
            ("mises", SOFT.young * e, stress),
            ("strain.xx", e, strain),
            ("strain.yy", -nu * e, strain),
            ("strain.zz", -nu * e, strain),
            ("thinner", -nu * e, strain),
            ("pulled", 0.003, 1e-16),
        ];
        for (name, expected, tolerance) in expected {
            assert_close(read(&trajectory, name)[0], expected, tolerance);
        }
        let units: Vec<&str> = trajectory.sensors().iter().map(|sensor| &sensor.unit[..]).collect();
        assert_eq!(units, ["Pa", "Pa", "Pa", "Pa", "Pa", "1", "1", "1", "1", "1", "m"]);
    }
    Ok(())
}

/// A square of 10 cm that is blown up by a tenth: 1.1^2 of its area; its sides, diagonals and angles.
#[test]
fn lengths_angles_and_volumes_of_a_square() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Rectangles)?;
    let body = Body::new(mesh, SOFT).thickness(0.02).strain(Strain::Green).build()?;
    let sampling = Sampling::phase_ends()
        .read("volume", Reading::chamber_volume("inside"))
        .read("pressure", Reading::pressure("inside"))
        .read("diagonal", Reading::distance([1], [9]))
        .read("half", Reading::distance("left", [5]))
        .read("angle", Reading::angle([[1], [3]], [[1], [7]]))
        .read("back", Reading::angle([[1], [7]], [[1], [3]]))
        .read("length", Reading::spring_length("tendon"))
        .read("pull", Reading::spring_pull("tendon"))
        .read("corner", Reading::position([9]))
        .read("far", Reading::position([9]).component(Component::Norm));
    let (s, k) = (1.1, 0.25);
    let scene = |scene: Scene| {
        scene
            .chamber(Chamber::within("inside", [1, 3, 9, 7]))
            .spring(Spring::between([1], [9]).named("tendon").stiffness(50.0))
    };
    // larger by s, then sheared: the volume stays
    let larger = |x: &[f64]| vec![(s - 1.0) * x[0] + s * k * x[1], (s - 1.0) * x[1]];
    let trajectory = at_start(body, larger, sampling, scene)?;
    let diagonal = 0.11 * (1.25_f64.powi(2) + 1.0).sqrt();
    let expected = [
        ("volume", 0.11 * 0.11 * 0.02, 1e-18),
        ("pressure", 0.0, 0.0),
        ("diagonal", diagonal, 1e-16),
        ("half", 0.055, 1e-16),
        ("angle", (1.0 / k).atan(), 1e-15),
        ("back", -(1.0 / k).atan(), 1e-15),
        ("length", diagonal, 1e-16),
        ("pull", 50.0 * (diagonal - 0.1 * 2.0_f64.sqrt()), 1e-14),
        ("corner.x", 0.11 * 1.25, 1e-16),
        ("corner.y", 0.11, 1e-16),
        ("far", diagonal, 1e-16),
    ];
    for (name, expected, tolerance) in expected {
        assert_close(read(&trajectory, name)[0], expected, tolerance);
    }
    Ok(())
}

#[test]
fn angles_in_space_have_no_sign() -> Outcome {
    let mesh = Mesh::cuboid([0.1, 0.2, 0.3], [2, 2, 2], SolidCells::Hexahedra)?;
    let sampling = Sampling::phase_ends()
        .read("angle", Reading::angle([[1], [3]], [[1], [8]]))
        .read("back", Reading::angle([[1], [8]], [[1], [3]]));
    let body = Body::new(mesh, SOFT).build()?;
    let trajectory = at_start(body, |_| vec![0.0; 3], sampling, |scene| scene)?;
    // between an edge and the diagonal of the block
    let expected = (0.2 / (0.14_f64).sqrt()).acos();
    assert_close(read(&trajectory, "angle")[0], expected, 1e-14);
    assert_close(read(&trajectory, "back")[0], expected, 1e-14);
    Ok(())
}

/// A square hangs, then lies on a floor: both carry its weight once it rests.
#[test]
fn at_rest_reactions_are_the_weight() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles)?;
    let damped = Material { viscosity: 500.0, ..SOFT };
    let body = Body::new(mesh, damped).thickness(0.1).build()?;
    let weight = body.mass() * 9.8;
    let floor = Obstacle::half_plane([0.0, -0.01], [0.0, 1.0]).named("floor");
    let sampling = Sampling::every(0.05)
        .read("hung", Reading::constraint_force("top"))
        .read("corner", Reading::constraint_force([1]))
        .read("floor", Reading::contact_force("floor"))
        .read("pressed", Reading::contact_force("floor").component(Component::Norm))
        .read("falling", Reading::velocity("all").component(Component::Y));
    let trajectory = Scene::new(body)
        .gravity([0.0, -9.8])
        .obstacle(floor.stiffness(2e3).damping(100.0))
        .phase(Phase::until(1.0).hold("top").without_contact())
        .phase(Phase::until(3.0))
        .simulate(&Settings { rtol: 1e-8, ..Settings::default() }, &sampling)?;
    let end_of_phase = trajectory.samples().iter().rposition(|sample| sample.phase == 0).unwrap();
    let last = trajectory.samples().len() - 1;
    // what is left of the motion then: 2.3e-8 N was found
    let close = |name: &str, at: usize, expected: f64| {
        assert_close(read(&trajectory, name)[at], expected, 1e-8 * weight);
    };
    close("hung.y", end_of_phase, weight);
    close("hung.x", end_of_phase, 0.0);
    close("floor.y", last, weight);
    close("pressed", last, weight);
    for (k, sample) in trajectory.samples().iter().enumerate() {
        let held = trajectory.constraint_force(sample, "top")?;
        assert_eq!([read(&trajectory, "hung.x")[k], read(&trajectory, "hung.y")[k]], held[..]);
        let touched: f64 = trajectory.contact_forces(sample)?.iter().skip(1).step_by(2).sum();
        assert_close(read(&trajectory, "floor.y")[k], touched, 1e-14);
    }
    assert!(read(&trajectory, "falling").iter().any(|v| *v < -0.1));
    assert!(read(&trajectory, "corner.y").iter().all(|force| *force == 0.0));
    Ok(())
}

/// Commands change what holds and touches: sensors follow.
#[test]
fn sensors_follow_commands() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles)?;
    let body = Body::new(mesh, SOFT).thickness(0.1).build()?;
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).named("floor").stiffness(1e3);
    let scene = Scene::new(body).gravity([0.0, -9.8]).obstacle(floor).phase(Phase::until(0.3));
    let mut run = scene.start(&Settings::default())?;
    run.record(
        &Sampling::every(0.01)
            .read("top", Reading::constraint_force("top"))
            .read("floor", Reading::contact_force("floor")),
    )?;
    run.advance_to(0.1)?;
    run.hold("top")?;
    run.advance_to(0.2)?;
    run.contact("floor", false)?;
    run.advance_to(0.3)?;
    let trajectory = run.into_trajectory();
    let (mut held, mut touched) = (0, 0);
    for (k, sample) in trajectory.samples().iter().enumerate().skip(1) {
        let top = trajectory.constraint_force(sample, "top")?;
        let floor: f64 = trajectory.contact_forces(sample)?.iter().skip(1).step_by(2).sum();
        assert_eq!(read(&trajectory, "top.y")[k], top[1]);
        assert_close(read(&trajectory, "floor.y")[k], floor, 1e-14);
        held += usize::from(top[1] != 0.0);
        touched += usize::from(floor != 0.0);
    }
    assert!((5..25).contains(&held) && (5..25).contains(&touched), "{held}, {touched}");
    Ok(())
}

#[test]
fn what_the_scene_lacks_is_named_before_the_run() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Rectangles)?;
    let scene = Scene::new(Body::new(mesh, SOFT).thickness(0.1).build()?)
        .chamber(Chamber::within("inside", [1, 3, 9, 7]))
        .spring(Spring::between([1], [9]).named("tendon"))
        .obstacle(Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).named("floor").stiffness(1.0))
        .phase(Phase::until(1.0));
    for (reading, part) in [
        (
            Reading::position("rigth"),
            "node set of sensor \"it\" = \"rigth\" cannot be used: did you mean \"right\"?",
        ),
        (Reading::constraint_force([10]), "the nodes 1 to 9"),
        (Reading::contact_force("flor"), "did you mean \"floor\"?"),
        (Reading::spring_pull("tendom"), "did you mean \"tendon\"?"),
        (Reading::spring_length("inside"), "the springs \"tendon\""),
        (Reading::pressure("insid"), "did you mean \"inside\"?"),
        (Reading::chamber_volume("tendon"), "the chambers \"inside\""),
        (Reading::stress_at([0.2, 0.0]), "outside the body"),
        (Reading::strain_at([0.2]), "it needs 2 component(s)"),
        (Reading::angle(["left", "left"], ["left", "right"]), "it has no direction"),
        (Reading::position([1]).component(Component::Z), "component of sensor \"it\" = \"z\""),
        (
            Reading::position([1]).component(Component::XX),
            "the quantity has the components \"x\", \"y\", \"norm\"",
        ),
        (Reading::strain([1]).component(Component::VonMises), "\"von-mises\" cannot be used"),
        (Reading::pressure("inside").component(Component::X), "the quantity has no components"),
    ] {
        let sampling = Sampling::phase_ends().read("it", reading);
        let refused = scene.simulate(&Settings::default(), &sampling).unwrap_err().to_string();
        assert!(refused.contains(part), "{refused}");
        assert!(refused.contains("sensor \"it\""), "{refused}");
    }
    let twice =
        Sampling::phase_ends().sensor("tip.x", "m", |_, _| 0.0).read("tip", Reading::position([1]));
    let refused = scene.simulate(&Settings::default(), &twice).unwrap_err().to_string();
    assert!(refused.contains("name of a sensor = \"tip.x\""), "{refused}");
    Ok(())
}

/// The moment of a clamp about a point: the sum over its nodes in motion, and at rest that of a force at the end of the arm as it
/// is, in the plane and about an axis in space. A clamp that moves acts where it is by then.
#[test]
fn moments_of_constraints() -> Outcome {
    let damped = Material { viscosity: 3000.0, ..SOFT };
    let plane = Mesh::rectangle([0.1, 0.02], [11, 3], Cells::Triangles6)?;
    let solid = Mesh::cuboid([0.1, 0.02, 0.02], [6, 2, 2], SolidCells::Hexahedra20)?;
    let about = [0.01, -0.02, 0.005];
    for (mesh, moves) in [(&plane, false), (&solid, false), (&plane, true), (&solid, true)] {
        let (mesh, d) = (mesh.clone(), mesh.dimension());
        let body = Body::new(mesh, damped);
        let body = if d == 2 { body.thickness(0.02) } else { body }.build()?;
        let force = &[0.002, -0.005, 0.003][..d];
        let mut sampling = Sampling::every(0.5)
            .read("moment", Reading::constraint_moment("left", &about[..d]))
            .read("tip", Reading::position("right"));
        if d == 3 {
            let axis = [1.0, 2.0, -2.0];
            let torque = Reading::constraint_torque("left", about, axis);
            sampling = sampling.read("torque", torque);
        }
        let phase = match moves {
            true => Phase::until(4.0).move_nodes("left", &[0.003, 0.002, -0.001][..d]),
            false => Phase::until(4.0).hold("left"),
        };
        let trajectory = Scene::new(body)
            .phase(phase.load_total("right", force))
            .simulate(&Settings { rtol: 1e-8, ..Settings::default() }, &sampling)?;
        let mesh = trajectory.body().mesh();
        let vector =
            |x: &[f64]| -> [f64; 3] { std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0)) };
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let arm = |x: &[f64]| -> [f64; 3] {
            std::array::from_fn(|i| vector(x)[i] - vector(&about[..d])[i])
        };
        let names = if d == 2 { vec!["moment"] } else { vec!["moment.x", "moment.y", "moment.z"] };
        for (at, sample) in trajectory.samples().iter().enumerate() {
            let forces = trajectory.constraint_forces(sample)?;
            let mut expected = [0.0; 3];
            for &node in &mesh.sets()["left"] {
                let x = mesh.position(node).iter().zip(&sample.u[d * node..]);
                let x: Vec<f64> = x.map(|(x, u)| x + u).collect();
                let moment = cross(arm(&x), vector(&forces[d * node..][..d]));
                expected.iter_mut().zip(moment).for_each(|(sum, x)| *sum += x);
            }
            for (k, name) in names.iter().enumerate() {
                assert_close(
                    read(&trajectory, name)[at],
                    expected[if d == 2 { 2 } else { k }],
                    1e-15,
                );
            }
            if d == 3 {
                let along = (expected[0] + 2.0 * expected[1] - 2.0 * expected[2]) / 3.0;
                assert_close(read(&trajectory, "torque")[at], along, 1e-15);
            }
        }
        if moves {
            continue;
        }
        // at rest: the load is spread over an end that has turned, so that its middle is the arm but for the strain there
        let last = trajectory.samples().len() - 1;
        let tip: Vec<f64> = ["tip.x", "tip.y", "tip.z"][..d]
            .iter()
            .map(|name| read(&trajectory, name)[last])
            .collect();
        let expected = cross(arm(&tip), vector(force)).map(|x| -x);
        for (k, name) in names.iter().enumerate() {
            let expected = expected[if d == 2 { 2 } else { k }];
            println!("{name}: {} {expected}", read(&trajectory, name)[last]);
            assert_close(read(&trajectory, name)[last], expected, 2e-6);
        }
    }
    Ok(())
}

/// A corridor that is narrower than the square in it, as a grip is: its forces cancel each other, those on each side do not.
#[test]
fn both_sides_of_a_grip_are_told_apart() -> Outcome {
    let (stiffness, depth) = (200.0, 1e-3);
    let corridor = move |x: &[f64], gradient: &mut [f64]| {
        gradient[1] = -x[1].signum();
        0.05 - depth - x[1].abs()
    };
    let grip = || Obstacle::new(Shape::custom(corridor)).named("grip").stiffness(stiffness);
    let density = || Obstacle::new(Shape::custom(corridor)).named("grip").stiffness_density(2e5);
    for (grip, total) in [
        // three nodes on each side; 0.1 m times 0.02 m
        (&grip as &dyn Fn() -> Obstacle, 3.0 * stiffness * depth),
        (&density, 2e5 * depth * 0.1 * 0.02),
    ] {
        let mesh =
            Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Rectangles)?.translated(&[0.0, -0.05])?;
        let body = Body::new(mesh, SOFT).thickness(0.02).build()?;
        let sampling = Sampling::phase_ends()
            .read("all", Reading::contact_force("grip"))
            .read("top", Reading::contact_force_on("grip", "top"))
            .read("bottom", Reading::contact_force_on("grip", "bottom"))
            .read("corner", Reading::contact_force_on("grip", [9]))
            .read("middle", Reading::contact_force_on("grip", [5]));
        let at_rest = |_: &[f64]| vec![0.0; 2];
        let trajectory = at_start(body, at_rest, sampling, |scene| scene.obstacle(grip()))?;
        // a corner has half of what a middle node has where the stiffness is that of an area
        let corner = if total > 0.5 { total / 3.0 } else { total / 4.0 };
        let expected =
            [("all.y", 0.0), ("top.y", -total), ("bottom.y", total), ("corner.y", -corner)];
        for (name, expected) in expected.into_iter().chain([("middle.y", 0.0), ("top.x", 0.0)]) {
            // round-off of a few sums of such forces
            assert_close(read(&trajectory, name)[0], expected, 1e-14 * total.max(1.0));
        }
        let scene = trajectory.scene().clone();
        let view = scene.start(&Settings::default())?;
        let top = view.view().contact_force_on("grip", "top")?;
        assert_close(top[1], -total, 1e-14 * total.max(1.0));
    }
    Ok(())
}

/// Half of a press's way, and half of a pressure, at half of the load: forces in balance, of what stands still.
#[test]
fn equilibria_are_read_by_sensors() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Rectangles)?;
    let body = Body::new(mesh, SOFT).thickness(0.02).build()?;
    let press = Obstacle::half_plane([0.0, 0.1], [0.0, -1.0]).named("press").stiffness(5e3);
    let press = press.damping(100.0).tangential_damping(50.0).velocity([0.0, -2e-3]);
    let scene = Scene::new(body)
        .obstacle(press)
        .chamber(Chamber::within("air", [1, 3, 9, 7]))
        .spring(Spring::between([1], [9]).named("tendon").stiffness(10.0))
        .phase(
            Phase::until(2.0)
                .hold("bottom")
                .pressure_table("air", [0.0, 2.0], [0.0, 40.0])
                .actuate(["tendon"], -0.1),
        );
    let sampling = Sampling::phase_ends()
        .read("held", Reading::constraint_force("bottom").component(Component::Y))
        .read("pressed", Reading::contact_force("press").component(Component::Y))
        .read("pressure", Reading::pressure("air"))
        .read("pull", Reading::spring_pull("tendon"))
        .read("length", Reading::spring_length("tendon"))
        .read("speed", Reading::velocity("top").component(Component::Norm));
    let statics = Statics { load_steps: 2, ..Statics::default() };
    let mut found = scene.equilibrium(&statics)?;
    found.read(&sampling)?;
    let trajectory = found.trajectory();
    assert_eq!(trajectory.sensors().len(), 7);
    let of = |name: &str| read(trajectory, name);
    let [held, pressed, length] = ["held", "pressed", "length"].map(of);
    assert_eq!(of("pressure"), [0.0, 20.0, 40.0]);
    assert_eq!(of("speed"), [0.0; 3]);
    for k in 0..3 {
        // to what statics balances forces to, 1e-10 of the largest
        assert_close(held[k] + pressed[k], 0.0, 1e-9);
        let pull = 10.0 * (length[k] - length[0]) + 0.05 * k as f64;
        assert_close(of("pull")[k], pull, 1e-13);
    }
    assert!(pressed[2] < pressed[1] && pressed[1] < -1.0 && pressed[0] == 0.0, "{pressed:?}");
    // what follows from samples agrees
    for (sample, pressed) in trajectory.samples().iter().zip(&pressed) {
        let forces = trajectory.contact_forces(sample)?;
        assert_close(forces.iter().skip(1).step_by(2).sum(), *pressed, 1e-14);
    }
    let again = found.read(&sampling).unwrap_err().to_string();
    assert!(again.contains("\"held\"") && again.contains("otherwise"), "{again}");
    Ok(())
}

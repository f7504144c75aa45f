//! Rigid bodies, and rigid parts of soft ones, against the equations of rigid bodies.

use pliant::body::BodyBuilder;
use pliant::solve::{Options, Problem, solve};
use pliant::{
    Body, Cells, Inertia, Material, Mesh, Method, Phase, Sampling, Scene, Settings, SolidCells,
    Statics, Strain, Touch, Trajectory,
};

/// The methods that have equations for rigid bodies.
pub(crate) const METHODS: [Method; 9] = [
    Method::CvodeBdf,
    Method::CvodeAdams,
    Method::Arkode,
    Method::Rosenbrock,
    Method::Rk,
    Method::Auto,
    Method::CentralDifference,
    Method::Ida,
    Method::IdaIndexTwo,
];

/// The numbers that the equations y' = f(y) lead to, by the integrators alone.
pub(crate) fn led(
    start: &[f64],
    time: f64,
    f: impl Fn(&[f64], &mut [f64]) + Send + 'static,
) -> Vec<f64> {
    let rates = move |_: f64, y: &[f64], rates: &mut [f64]| {
        f(y, rates);
        Ok(())
    };
    let problem = Problem::ode(rates, start.to_vec());
    let method = pliant::solve::Method::DormandPrince;
    let solution = solve(problem, method, (0.0, time), &Options::new(1e-12, 1e-14)).unwrap();
    solution.at(time).unwrap()
}

pub(crate) fn run(scene: &Scene, method: Method, rtol: f64) -> Trajectory {
    let settings = Settings { method, rtol, ..Settings::default() };
    scene.simulate(&settings, &Sampling::phase_ends()).unwrap()
}

/// A bar of 10 cm whose middle line begins at `x`, 1 cm high.
fn bar(name: &str, x: f64) -> BodyBuilder {
    let mesh = Mesh::rectangle([0.1, 0.01], [5, 3], Cells::Triangles).unwrap();
    let mesh = mesh.translated(&[x, -0.005]).unwrap();
    Body::new(mesh, Material::rigid(2000.0)).thickness(0.01).named(name)
}

/// A box turns freely near its middle axis, where its motion is unstable. Euler's equations say where each of its nodes goes.
#[test]
fn an_asymmetric_top() {
    const SIZE: [f64; 3] = [0.03, 0.02, 0.01];
    const TIME: f64 = 0.5;
    let mesh = Mesh::cuboid(SIZE, [4, 3, 2], SolidCells::Hexahedra).unwrap();
    let body = Body::new(mesh, Material::rigid(2000.0)).build().unwrap();
    assert_eq!((body.dofs(), body.independent_dofs()), (72, 12));
    let spin = [1.0, 20.0, 2.0];
    let scene = Scene::new(body).spin(spin).phase(Phase::until(TIME));
    let squares = SIZE.map(|a| a * a);
    let inertia = [squares[1] + squares[2], squares[2] + squares[0], squares[0] + squares[1]];
    // the rows of the rotation R, and the angular velocity w in the axes of the box: R' = R [w x]
    let euler = move |y: &[f64], rates: &mut [f64]| {
        let w = &y[9..];
        for row in 0..3 {
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                rates[3 * row + i] = y[3 * row + j] * w[k] - y[3 * row + k] * w[j];
            }
        }
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            rates[9 + i] = (inertia[j] - inertia[k]) * w[j] * w[k] / inertia[i];
        }
    };
    let start = [&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0][..], &spin].concat();
    let turned = led(&start, TIME, euler);
    for (method, (tolerance, most)) in METHODS.into_iter().zip(TOP) {
        let motion = run(&scene, method, 1e-8);
        let mesh = motion.body().mesh();
        let mut off = 0.0_f64;
        for (node, u) in motion.last().u.chunks_exact(3).enumerate() {
            let arm: Vec<f64> =
                mesh.position(node).iter().zip(SIZE).map(|(x, size)| x - size / 2.0).collect();
            for axis in 0..3 {
                let place: f64 = (0..3).map(|i| turned[3 * axis + i] * arm[i]).sum();
                off = off.max((u[axis] + arm[axis] - place).abs());
            }
        }
        let report = motion.report();
        println!(
            "{method}: {off:.2e} m, {} steps, balance {:.1e}",
            report.steps(),
            report.energy_error
        );
        assert!(off < tolerance, "{method} is {off} m off");
        // with wrong tangents iterations fail, and order is lost
        assert!(report.steps() < most, "{method} takes {} steps", report.steps());
    }
}
const TOP: [(f64, usize); 10] = [
    (2e-7, 400),
    (1e-8, 500),
    (3e-7, 300),
    (4e-9, 2400),
    (1e-9, 2400),
    (1e-8, 3000),
    (6e-7, 5000),
    (2e-7, 500),
    (2e-7, 1400),
    (1.5e-8, 600),
];

/// Two bars, one on a pin and one hinged to its end: both turn as the equations of Lagrange say.
#[test]
fn a_double_pendulum() {
    const TIME: f64 = 0.5;
    const G: f64 = 9.8;
    let bodies = Body::join([bar("upper", 0.0), bar("lower", 0.1)].map(|bar| bar.build().unwrap()));
    let scene = Scene::new(bodies.unwrap())
        .gravity([0.0, -G])
        .tie([15 + 6], "upper")
        .phase(Phase::until(TIME).hold([6]));
    let mass = 2000.0 * 0.1 * 0.01 * 0.01;
    let (l, r) = (0.1_f64, 0.05_f64);
    let inertia = mass * (l * l + 0.01 * 0.01) / 12.0 + mass * r * r;
    let lagrange = move |y: &[f64], rates: &mut [f64]| {
        let [a, b, va, vb] = [y[0], y[1], y[2], y[3]];
        let (coupling, sine) = (mass * l * r * (a - b).cos(), mass * l * r * (a - b).sin());
        let upper = -sine * vb * vb - mass * G * (r + l) * a.cos();
        let lower = sine * va * va - mass * G * r * b.cos();
        let first = inertia + mass * l * l;
        let determinant = first * inertia - coupling * coupling;
        rates[0] = va;
        rates[1] = vb;
        rates[2] = (inertia * upper - coupling * lower) / determinant;
        rates[3] = (first * lower - coupling * upper) / determinant;
    };
    let turned = led(&[0.0; 4], TIME, lagrange);
    for (method, tolerance) in METHODS.into_iter().zip(PENDULUM) {
        let motion = run(&scene, method, 1e-8);
        let u = &motion.last().u;
        let mut off = 0.0_f64;
        for (number, angle) in turned[..2].iter().enumerate() {
            let [start, end] = [5, 9].map(|node| 2 * (15 * number + node));
            let along = [0.1 + u[end] - u[start], u[end + 1] - u[start + 1]];
            off = off.max((along[0] - 0.1 * angle.cos()).hypot(along[1] - 0.1 * angle.sin()));
        }
        let report = motion.report();
        println!(
            "{method}: {off:.2e} m, {} steps, drift {:.1e}",
            report.steps(),
            report.constraint_drift
        );
        assert!(off < tolerance, "{method} is {off} m off");
    }
}
const PENDULUM: [f64; 9] = [2e-7, 2e-7, 1e-6, 6e-9, 3e-10, 2e-7, 4e-6, 3e-7, 6e-7];

/// Rigid squares of one mass that meet head on exchange their velocities, whatever stands between them.
#[test]
fn rigid_squares_exchange_their_velocities() {
    let square = |name: &str, x: f64, cells: Cells| {
        let mesh = Mesh::rectangle([0.02, 0.02], [4, 4], cells).unwrap();
        let mesh = mesh.translated(&[x, 0.0]).unwrap();
        Body::new(mesh, Material::rigid(2000.0)).thickness(0.01).named(name).build().unwrap()
    };
    let left = square("left", 0.0, Cells::Rectangles);
    let bodies = Body::join([left, square("right", 0.03, Cells::Triangles)]).unwrap();
    let scene = Scene::new(bodies)
        .touch(Touch::all().distance(2e-3).stiffness_density(1e8))
        .initial_velocity(|x| vec![if x[0] < 0.025 { 0.5 } else { 0.0 }, 0.0])
        .phase(Phase::until(0.05));
    for method in METHODS {
        let motion = run(&scene, method, 1e-8);
        let off = |node: usize, speed: f64| {
            let [along, across] = [0, 1].map(|axis| motion.last().v[2 * node + axis]);
            (along - speed).abs().max(across.abs())
        };
        let off = (0..32).map(|node| off(node, if node < 16 { 0.0 } else { 0.5 }));
        let off = off.fold(0.0, f64::max);
        println!("{method}: {off:.2e} m/s, {} steps", motion.report().steps());
        assert!(off < 3e-6, "{method} is {off} m/s off");
    }
}

/// A rigid block falls askew on a soft one with a rigid insert.
fn landing(inertia: Inertia) -> Scene {
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 20.0 };
    {
        let mesh = Mesh::rectangle([0.06, 0.02], [13, 5], Cells::Rectangles).unwrap();
        let cells = pliant::body::CellSelection::inside([0.02, 0.004], [0.03, 0.011]);
        let pad = Body::new(mesh, soft).thickness(0.01).region(cells, Material::rigid(5000.0));
        let mesh = Mesh::rectangle([0.02, 0.01], [3, 2], Cells::Rectangles).unwrap();
        let block = Body::new(mesh.translated(&[0.015, 0.0215]).unwrap(), Material::rigid(2000.0));
        let block = block.thickness(0.01).named("block");
        let pad = pad.named("pad").inertia(inertia).build().unwrap();
        Scene::new(Body::join([pad, block.build().unwrap()]).unwrap())
            .gravity([0.0, -9.8])
            .touch(Touch::all().distance(1e-3).stiffness_density(1e8))
            .initial_velocity(|x| match x[1] < 0.021 {
                true => vec![0.0; 2],
                false => vec![8.0 * (0.0265 - x[1]), 8.0 * (x[0] - 0.025)],
            })
            .phase(Phase::until(0.06).hold("pad/bottom"))
    }
}

/// Central differences, whose edges hold at the ends of steps, land a block where ARKODE does with its stabilized ones.
#[test]
fn central_differences_land_a_block() {
    for inertia in [Inertia::Lumped, Inertia::Consistent] {
        let scene = landing(inertia);
        let exact = run(&scene, Method::Arkode, 1e-9);
        // it has hit the pad
        assert!(exact.last().energy.strain > 1e-3 * exact.report().energy_scale);
        let motion = run(&scene, Method::CentralDifference, 1e-3);
        let off = motion.last().u.iter().zip(&exact.last().u).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max);
        let report = motion.report();
        println!(
            "{inertia:?}: {off:.2e} m, {} steps, drift {:.1e} m, balance {:.1e} of {:.1e}",
            report.steps(),
            report.constraint_drift,
            report.energy_error,
            report.energy_scale
        );
        // stability bounds the steps: 1.4e-8 m lumped, 1e-8 m consistent
        assert!(off < 3e-8, "{inertia:?}: {off} m off");
        assert!(report.constraint_drift < 5e-17, "{}", report.constraint_drift);
        assert!(report.energy_error < 3e-4 * report.energy_scale);
    }
}

/// IDA, to which the multipliers of edges are unknowns, lands a block where ARKODE does.
#[test]
fn differential_algebraic_forms_land_a_block() {
    let scene = landing(Inertia::Consistent);
    let exact = run(&scene, Method::Arkode, 1e-9);
    for (method, tolerance, drift) in DAE_FORMS {
        let motion = run(&scene, method, 1e-7);
        let off = motion.last().u.iter().zip(&exact.last().u).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max);
        let report = motion.report();
        println!(
            "{method}: {off:.2e} m, {} steps, {} rejected, drift {:.1e} m, balance {:.1e} of {:.1e}",
            report.steps(),
            report.phases[0].counts.convergence_failures,
            report.constraint_drift,
            report.energy_error,
            report.energy_scale
        );
        assert!(off < tolerance, "{method}: {off} m off");
        assert!(report.constraint_drift < drift, "{method}: {}", report.constraint_drift);
        assert!(report.energy_error < 5e-5 * report.energy_scale);
    }
}
const DAE_FORMS: [(Method, f64, f64); 2] =
    [(Method::Ida, 1.2e-8, 1.5e-10), (Method::IdaIndexTwo, 1.2e-8, 2e-9)];

/// What flies freely keeps its momenta: a soft bar with a rigid end, which turns and vibrates, in space and by the whole
/// Jacobian, too.
#[test]
fn differential_algebraic_forms_keep_momenta() {
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 5.0 };
    let mesh = Mesh::cuboid([0.06, 0.01, 0.01], [7, 2, 2], SolidCells::Hexahedra).unwrap();
    let cells = pliant::body::CellSelection::inside([0.0, 0.0, 0.0], [0.021, 0.01, 0.01]);
    let body = Body::new(mesh, soft).region(cells, Material::rigid(4000.0)).build().unwrap();
    let scene = Scene::new(body).spin([5.0, 10.0, 20.0]).phase(Phase::until(0.2));
    let exact = run(&scene, Method::Rosenbrock, 1e-8);
    let momenta = |motion: &Trajectory, sample: usize| {
        let sample = &motion.samples()[sample];
        let [along, about] = [motion.momentum(sample), motion.angular_momentum(sample)];
        [along, about].concat()
    };
    for (method, tolerance, lost) in FREE {
        let motion = run(&scene, method, 1e-7);
        let off = motion.last().u.iter().zip(&exact.last().u).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max);
        let (before, after) = (momenta(&motion, 0), momenta(&motion, motion.samples().len() - 1));
        let change = before.iter().zip(&after).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let report = motion.report();
        println!(
            "{method}: {off:.2e} m, momenta {change:.1e}, {} steps, balance {:.1e} of {:.1e}",
            report.steps(),
            report.energy_error,
            report.energy_scale
        );
        // some five times what was measured, as in the other tables
        assert!(off < tolerance, "{method}: {off} m off");
        assert!(change < lost, "{method}: {before:?} {after:?}");
        assert!(report.energy_error < 2e-6 * report.energy_scale);
    }
}
const FREE: [(Method, f64, f64); 2] =
    [(Method::Ida, 1.2e-8, 3e-11), (Method::IdaIndexTwo, 1.2e-8, 1.5e-11)];

/// A beam with an insert of its own material times 100 and 1000 comes near one with a rigid insert, in proportion to the
/// flexibility of the insert.
#[test]
fn a_rigid_insert_is_the_limit_of_stiff_ones() {
    let soft = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
    let frequency = |insert: pliant::Substance| {
        let mesh = Mesh::rectangle([0.1, 0.01], [21, 3], Cells::Rectangles9).unwrap();
        let cells = pliant::body::CellSelection::inside([0.04, 0.0], [0.06, 0.01]);
        let body = Body::new(mesh, soft).thickness(0.01).region(cells, insert).build().unwrap();
        let scene = Scene::new(body).phase(Phase::until(1.0).hold("left"));
        scene.spectrum().unwrap()[0].lowest_frequency.unwrap()
    };
    let rigid = frequency(Material::rigid(5000.0));
    let off = [1e8, 1e9].map(|young| {
        let stiff = Material { density: 5000.0, young, poisson: 0.0, viscosity: 0.0 };
        frequency(stiff.into()) / rigid - 1.0
    });
    println!("lowest frequency {rigid} rad/s, off by {off:?}");
    assert!(off[0] < 0.0 && off[0] > -5e-4, "{off:?}");
    assert!((off[0] / off[1] - 10.0).abs() < 0.05, "{off:?}");
}

/// A rigid bar is held by its whole left side: as many rows act as it has degrees of freedom, and they carry its weight, at
/// rest and in motion.
#[test]
fn a_held_side_carries_the_weight() {
    let scene = Scene::new(bar("bar", 0.0).build().unwrap())
        .gravity([0.0, -9.8])
        .phase(Phase::until(0.1).hold("left"));
    let weight = 9.8 * scene.body().mass();
    let still = scene.equilibrium(&Statics::default()).unwrap();
    let moving = [Method::CvodeBdf, Method::CentralDifference, Method::Ida, Method::IdaIndexTwo]
        .map(|method| run(&scene, method, 1e-6));
    assert_eq!(scene.summary().unwrap()[0].constraints, 4);
    for motion in std::iter::once(still.trajectory()).chain(&moving) {
        let forces = motion.constraint_forces(motion.last()).unwrap();
        let sum = |axis: usize| forces.iter().skip(axis).step_by(2).sum::<f64>();
        let moment: f64 = (0..15)
            .map(|node| {
                let x = motion.body().mesh().position(node);
                x[0] * forces[2 * node + 1] - x[1] * forces[2 * node]
            })
            .sum();
        println!("{} {} {moment}", sum(0), sum(1));
        assert!(sum(0).abs() < 1e-6 * weight && (sum(1) / weight - 1.0).abs() < 1e-6);
        assert!((moment / (0.05 * weight) - 1.0).abs() < 1e-4, "{moment}");
    }
    for motion in moving {
        assert!(motion.last().u.iter().all(|u| u.abs() < 1e-9), "{:?}", motion.last().u);
    }
}

/// A rigid body of which all nodes are moved follows: at one velocity, and about one of its nodes, which rests.
#[test]
fn a_rigid_body_is_moved_as_a_whole() {
    let moved = |phase: Phase, place: &dyn Fn(&[f64]) -> [f64; 2]| {
        let scene = Scene::new(bar("bar", 0.0).build().unwrap()).phase(phase);
        let of_edges =
            [Method::CvodeBdf, Method::CentralDifference, Method::Ida, Method::IdaIndexTwo];
        for method in of_edges {
            let motion = run(&scene, method, 1e-8);
            let failures = motion.report().phases[0].counts.convergence_failures;
            println!("{method}: {} steps, {failures} failures", motion.report().steps());
            assert!(failures == 0, "{method}: {failures} failures");
            for (node, u) in motion.last().u.chunks_exact(2).enumerate() {
                let x = motion.body().mesh().position(node);
                let off = (0..2).map(|i| (x[i] + u[i] - place(x)[i]).abs()).fold(0.0, f64::max);
                assert!(off < 1e-7, "node {node} is {off} m off by {method}");
            }
        }
    };
    moved(Phase::until(0.1).move_nodes("all", [0.3, -0.1]), &|x| [x[0] + 0.03, x[1] - 0.01]);
    // three corners, which hold all of the frame
    moved(Phase::until(0.1).move_nodes([1, 5, 15], [0.3, -0.1]), &|x| [x[0] + 0.03, x[1] - 0.01]);
    let pin = [0.05, 0.005];
    let turned = |x: &[f64]| {
        let (r, (sin, cos)) = ([x[0] - pin[0], x[1] - pin[1]], 0.4_f64.sin_cos());
        [pin[0] + cos * r[0] - sin * r[1], pin[1] + sin * r[0] + cos * r[1]]
    };
    moved(Phase::until(0.1).rotate_path("all", pin, [1.0], [0.0, 0.1], [0.0, 0.4]), &turned);
}

/// A run goes on from a checkpoint in a file bit by bit as it goes on from memory, with a hinge and a contact in action.
#[test]
fn checkpoints_keep_rigid_bodies() {
    let stone = Mesh::rectangle([0.02, 0.02], [3, 3], Cells::Triangles).unwrap();
    let stone = stone.translated(&[0.04, -0.03]).unwrap();
    let stone = Body::new(stone, Material::rigid(2500.0)).thickness(0.01).named("stone");
    let bodies = Body::join([bar("bar", 0.0), stone].map(|body| body.build().unwrap()));
    let scene = Scene::new(bodies.unwrap())
        .gravity([0.0, -9.8])
        .touch(Touch::all().distance(1e-3).stiffness_density(1e9).friction_coefficient(0.5))
        .obstacle(
            pliant::Obstacle::half_plane([0.0, -0.032], [0.0, 1.0]).stiffness(1e4).damping(10.0),
        )
        .phase(Phase::until(0.2).hold([6]));
    let settings = Settings { rtol: 1e-5, ..Settings::default() };
    let mut first = scene.start(&settings).unwrap();
    first.advance_to(0.06).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("kept.json");
    let kept = first.checkpoint();
    kept.write(&path).unwrap();
    first.restore(&kept).unwrap();
    first.advance_to(0.12).unwrap();
    let mut second = scene.start(&settings).unwrap();
    let read = second.read_checkpoint(&path).unwrap();
    second.restore(&read).unwrap();
    second.advance_to(0.12).unwrap();
    assert_eq!(first.view().displacements(), second.view().displacements());
    assert!(first.view().displacements()[2 * 9 + 1] < -1e-3);
    // another stone is another scene
    let other = Scene::new(bar("bar", 0.0).build().unwrap())
        .phase(Phase::until(0.2).hold([6]))
        .start(&settings)
        .unwrap();
    assert!(other.read_checkpoint(&path).is_err());
}

/// What a rigid body cannot do is told before anything is computed.
#[test]
fn impossible_rigid_bodies() {
    let error = |scene: Scene, method| {
        let settings = Settings { method, ..Settings::default() };
        scene.simulate(&settings, &Sampling::phase_ends()).unwrap_err().to_string()
    };
    let scene = || Scene::new(bar("bar", 0.0).build().unwrap());
    let free = || Phase::until(0.1);
    let cauchy = bar("bar", 0.0).strain(Strain::Cauchy).build().unwrap_err().to_string();
    assert!(cauchy.contains("measure strain by Green's"), "{cauchy}");
    let torn = free().move_nodes("left", [-0.1, 0.0]).move_nodes("right", [0.1, 0.0]);
    let told = error(scene().phase(torn), Method::Auto);
    assert!(told.contains("apart") && told.contains("keeps its shape"), "{told}");
    let sheared = free().hold("left").move_nodes([10], [0.1, 0.0]);
    let told = error(scene().phase(sheared), Method::Auto);
    assert!(told.contains("rigid piece"), "{told}");
    let mut running = scene().phase(free()).start(&Settings::default()).unwrap();
    let told = running.change_state(|u, _| u[3] += 1e-3).unwrap_err().to_string();
    assert!(told.contains("displacements") && told.contains("rigid"), "{told}");
    let told = running.change_state(|_, v| v[3] += 1.0).unwrap_err().to_string();
    assert!(told.contains("velocities") && told.contains("rigid"), "{told}");
    let bent = scene().initial_displacement(|x| vec![0.0, x[0] * x[0]]).phase(free());
    let told = error(bent, Method::Auto);
    assert!(told.contains("initial displacement") && told.contains("shape"), "{told}");
}

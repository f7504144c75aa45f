//! Rigid bodies whose mass, centre and moments of inertia are numbers, against the equations of rigid bodies.

use super::rigid::{METHODS, led, run};
use pliant::{
    Body, Cells, Material, Mesh, Method, Moments, Phase, RigidMass, Scene, Settings, SolidCells,
    Stability, Statics,
};

const BOX: [f64; 3] = [0.03, 0.02, 0.01];

fn cuboid() -> Mesh {
    Mesh::cuboid(BOX, [4, 3, 2], SolidCells::Hexahedra).unwrap()
}

/// A box with the inertia of something else, off its axes and about a point near one of its corners, tumbles about that point
/// as Euler's equations say.
#[test]
fn a_top_of_given_inertia() {
    const TIME: f64 = 0.5;
    const CENTRE: [f64; 3] = [0.028, 0.004, 0.012];
    let inertia = [[6e-6, 1e-6, -5e-7], [1e-6, 4e-6, 7e-7], [-5e-7, 7e-7, 3e-6]];
    let given = RigidMass::new(0.05).centre(CENTRE).moments(Moments::Matrix(inertia));
    let body = Body::new(cuboid(), Material::rigid_of(given)).build().unwrap();
    assert!((body.mass() / 0.05 - 1.0).abs() < 1e-13);
    let spin = [3.0, 20.0, 5.0];
    let scene = Scene::new(body).spin(spin).phase(Phase::until(TIME));
    let matrix = nalgebra::Matrix3::from_fn(|i, j| inertia[i][j]);
    let inverse = matrix.try_inverse().unwrap();
    // the rows of the rotation R, and the angular velocity w in the axes of the box: R' = R [w x], I w' = I w x w
    let euler = move |y: &[f64], rates: &mut [f64]| {
        let w = nalgebra::Vector3::from_column_slice(&y[9..]);
        for row in 0..3 {
            let of_row = nalgebra::Vector3::from_column_slice(&y[3 * row..3 * row + 3]).cross(&w);
            rates[3 * row..3 * row + 3].copy_from_slice(of_row.as_slice());
        }
        rates[9..].copy_from_slice((inverse * (matrix * w).cross(&w)).as_slice());
    };
    let start = [&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0][..], &spin].concat();
    let turned = led(&start, TIME, euler);
    for (method, tolerance) in METHODS.into_iter().zip(TOP) {
        let motion = run(&scene, method, 1e-8);
        let mesh = motion.body().mesh();
        let mut off = 0.0_f64;
        for (node, u) in motion.last().u.chunks_exact(3).enumerate() {
            let arm: Vec<f64> =
                mesh.position(node).iter().zip(CENTRE).map(|(x, c)| x - c).collect();
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
    }
}
/// Two to five times what was measured, as in `rigid.rs`.
const TOP: [f64; 10] = [2e-7, 3e-8, 3e-7, 4e-9, 6e-10, 8e-9, 8e-7, 2e-7, 3e-7, 8e-8];

/// A plate on a pin, with a centre outside of it and a moment that it does not have, is back after the period of its physical
/// pendulum (the arithmetic-geometric mean gives it), at rest.
#[test]
fn a_pendulum_of_given_inertia() {
    const G: f64 = 9.8;
    let (mass, moment, centre) = (0.3, 2e-3, [0.05, -0.12]);
    let mesh = Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Triangles).unwrap();
    let given = RigidMass::new(mass).centre(centre).moments(Moments::Plane(moment));
    let body = Body::new(mesh, Material::rigid_of(given)).thickness(0.01).build().unwrap();
    // it begins at rest, the centre below and beside the pin, its first node
    let r = f64::hypot(centre[0], centre[1]);
    let first = centre[0].atan2(-centre[1]);
    let stiffness = mass * G * r / (moment + mass * r * r);
    let mut means = [1.0, (first / 2.0).cos()];
    for _ in 0..6 {
        means = [(means[0] + means[1]) / 2.0, (means[0] * means[1]).sqrt()];
    }
    let period = std::f64::consts::TAU / (stiffness.sqrt() * means[0]);
    let until =
        |time: f64| Scene::new(body.clone()).gravity([0.0, -G]).phase(Phase::until(time).hold([1]));
    let scene = until(period);
    for (method, tolerance) in METHODS.into_iter().zip(PENDULUM) {
        let motion = run(&scene, method, 1e-8);
        // what is left of its speed tells how far the period is off
        let v = &motion.last().v;
        let turn = f64::hypot(v[2 * 4], v[2 * 4 + 1]) / 0.1;
        let off = turn / (stiffness * first.sin()) / period;
        let report = motion.report();
        println!("{method}: {off:.2e} of the period, balance {:.1e}", report.energy_error);
        assert!(off < tolerance, "the period is {off} off by {method}");
        assert!(report.energy_error < 1e-7, "{}", report.energy_error);
    }
    // and turned by what the sensor of the rotation tells
    let half = run(&until(period / 2.0), Method::Rk, 1e-8);
    let turned = half.rotation(half.last()).unwrap();
    assert!((turned + 2.0 * first).abs() < 1e-5, "{turned} and {first}");
}
const PENDULUM: [f64; 10] = [2e-7, 4e-8, 4e-7, 5e-8, 1e-9, 1e-7, 1e-6, 1e-7, 3e-7, 1.3e-7];

/// A body of a density moves as one whose mass and moments are given by the numbers of its shape, but for round-off.
#[test]
fn numbers_of_the_shape_are_its_density() {
    let mass = 2000.0 * BOX.iter().product::<f64>();
    let squares = BOX.map(|a| a * a / 12.0 * mass);
    let principal = [squares[1] + squares[2], squares[2] + squares[0], squares[0] + squares[1]];
    let numbers = RigidMass::new(mass).moments(Moments::Principal(principal));
    let placed = numbers.clone().centre(BOX.map(|a| a / 2.0));
    let moved = |substance: pliant::Substance| {
        let body = Body::new(cuboid(), substance).build().unwrap();
        let scene = Scene::new(body)
            .gravity([0.0, 0.0, -9.8])
            .spin([1.0, 20.0, 2.0])
            .phase(Phase::until(0.2).hold([1]));
        run(&scene, Method::Rk, 1e-8)
    };
    let by_density = moved(Material::rigid(2000.0));
    for substance in [RigidMass::new(mass), numbers, placed].map(Material::rigid_of) {
        let by_numbers = moved(substance);
        let (u, other) = (&by_density.last().u, &by_numbers.last().u);
        let off = u.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!(
            "{off:.1e} m off; {} and {} steps",
            by_density.report().steps(),
            by_numbers.report().steps()
        );
        assert!(off < 1e-14, "{off} m off");
        let energies = [&by_density, &by_numbers].map(|motion| motion.last().energy.kinetic);
        assert!((energies[0] / energies[1] - 1.0).abs() < 1e-12, "{energies:?}");
    }
}

/// The weight of a body by numbers acts at its centre, at rest and in motion; what dampens its mass stops it at the same rate
/// in turning as in falling.
#[test]
fn the_weight_acts_at_the_centre() {
    let body = |given: RigidMass| {
        let mesh = Mesh::rectangle([0.1, 0.01], [5, 3], Cells::Rectangles).unwrap();
        Body::new(mesh, Material::rigid_of(given).mass_damping(3.0))
            .thickness(0.01)
            .build()
            .unwrap()
    };
    let given = RigidMass::new(0.4).centre([0.13, 0.02]).moments(Moments::Plane(1e-3));
    let scene =
        Scene::new(body(given.clone())).gravity([0.0, -9.8]).phase(Phase::until(0.1).hold("left"));
    let still = scene.equilibrium(&Statics::default()).unwrap();
    let moving = run(&scene, Method::CvodeBdf, 1e-6);
    assert!(matches!(still.stability, Stability::Stable { .. }), "{:?}", still.stability);
    for motion in [still.trajectory(), &moving] {
        let forces = motion.constraint_forces(motion.last()).unwrap();
        let weight: f64 = forces.iter().skip(1).step_by(2).sum();
        let nodes = motion.body().mesh().positions().chunks_exact(2).zip(forces.chunks_exact(2));
        let moment: f64 = nodes.map(|(x, f)| x[0] * f[1] - x[1] * f[0]).sum();
        println!("{} {}", weight / (0.4 * 9.8) - 1.0, moment / (0.13 * 0.4 * 9.8) - 1.0);
        // in an equilibrium it yields a little: by 5e-7
        assert!((weight / (0.4 * 9.8) - 1.0).abs() < 2e-9);
        assert!((moment / (0.13 * 0.4 * 9.8) - 1.0).abs() < 2e-6);
    }
    let free = Scene::new(body(given)).spin([7.0]).phase(Phase::until(0.5));
    let motion = run(&free, Method::Rk, 1e-9);
    let rate = motion.last().v.chunks_exact(2).map(|v| [v[0], v[1]]).collect::<Vec<_>>();
    let turn = f64::hypot(rate[4][0] - rate[0][0], rate[4][1] - rate[0][1]) / 0.1;
    assert!((turn / (7.0 * (-1.5_f64).exp()) - 1.0).abs() < 1e-7, "{turn}");
}

/// Checkpoints are of bodies with these numbers; what they cannot be of is told.
#[test]
fn other_numbers_are_another_body() {
    let scene = |moment: f64| {
        let mesh = Mesh::rectangle([0.1, 0.01], [5, 3], Cells::Rectangles).unwrap();
        let given = RigidMass::new(0.4).moments(Moments::Plane(moment));
        let body = Body::new(mesh, Material::rigid_of(given)).thickness(0.01).build().unwrap();
        Scene::new(body).spin([3.0]).phase(Phase::until(1.0).hold([1]))
    };
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("kept.json");
    let mut first = scene(1e-3).start(&Settings::default()).unwrap();
    first.advance_to(0.1).unwrap();
    first.checkpoint().write(&path).unwrap();
    assert!(scene(1e-3).start(&Settings::default()).unwrap().read_checkpoint(&path).is_ok());
    assert!(scene(2e-3).start(&Settings::default()).unwrap().read_checkpoint(&path).is_err());

    let soft = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
    let given = || Material::rigid_of(RigidMass::new(1.0).moments(Moments::Principal([1.0; 3])));
    let not_rigid = pliant::Substance { is_rigid: false, ..given() };
    let cells = || pliant::body::CellSelection::inside([0.0; 3], [0.01; 3]);
    let apart = Mesh::new(
        3,
        vec![
            0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, //
            5.0, 0.0, 0.0, 6.0, 0.0, 0.0, 5.0, 1.0, 0.0, 5.0, 0.0, 1.0,
        ],
        pliant::mesh::CellKind::Tetrahedron,
        (0..8).collect(),
    );
    let flat = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles).unwrap();
    let flat = flat.mapped(|x| [x[0], x[1], 0.0]).unwrap();
    let moment = RigidMass::new(1.0).moments(Moments::Plane(1.0));
    let aside = RigidMass::new(1.0).moments(Moments::Principal([1.0; 3])).centre([0.0, 1.0]);
    let cases = [
        (Body::new(cuboid(), not_rigid), "only rigid bodies"),
        (Body::new(cuboid(), given()).region(cells(), Material::rigid(1.0)), "without regions"),
        (Body::new(cuboid(), soft).region(cells(), given()), "give a density"),
        (Body::new(apart.unwrap(), given()), "number of pieces of the mesh = 2"),
        (Body::new(flat, given()).thickness(0.01), "mesh = flat"),
        (Body::new(cuboid(), Material::rigid_of(moment)), "three principal moments"),
        (Body::new(cuboid(), Material::rigid_of(aside)), "it needs 3 coordinates"),
    ];
    for (body, told) in cases {
        let error = body.build().unwrap_err().to_string();
        assert!(error.contains(told), "{error}");
    }
}

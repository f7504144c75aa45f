//! Magnets against closed forms: the elastica of a beam in a field across it, a needle that turns as a pendulum swings, and the pull of a
//! gradient.

use crate::common::run;
use pliant::{
    Body, CellSelection, Cells, Error, Magnet, MagneticField, Material, Mesh, Method, Phase, Plane,
    Sampling, Scene, Settings, SolidCells, Statics, Strain, simulate::Reading,
};

/// mu_0 (T m/A)
const VACUUM: f64 = 1.256_637_062_12e-6;

/// Tip (x, y) of a beam of length 1, clamped along x, that is magnetized along itself, in a field along y: with the angle theta of its
/// axis theta'' = -`load` cos theta, theta(0) = 0, theta'(1) = 0, by shooting with the Runge-Kutta method of order 4.
fn elastica(load: f64) -> [f64; 2] {
    let steps = 1000;
    let shoot = |bend: f64| {
        let h = 1.0 / f64::from(steps);
        let mut y = [0.0, bend, 0.0, 0.0]; // theta, theta', x, y
        let slope = |y: [f64; 4]| [y[1], -load * y[0].cos(), y[0].cos(), y[0].sin()];
        let ahead = |y: [f64; 4], k: [f64; 4], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
        for _ in 0..steps {
            let a = slope(y);
            let b = slope(ahead(y, a, 0.5 * h));
            let c = slope(ahead(y, b, 0.5 * h));
            let d = slope(ahead(y, c, h));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        y
    };
    let (mut low, mut high) = (0.0, load);
    for _ in 0..60 {
        let bend = 0.5 * (low + high);
        if shoot(bend)[1] > 0.0 { high = bend } else { low = bend }
    }
    let end = shoot(0.5 * (low + high));
    [end[2], end[3]]
}

/// Slender beams in plane stress, 40 times as long as they are high. What is left is the strain along them, which the elastica does not have.
#[test]
fn a_beam_bends_as_the_elastica_does() {
    let [length, height, young, remanence] = [0.04, 0.001, 1e6, 0.1];
    let mesh = Mesh::rectangle([length, height], [41, 3], Cells::Rectangles9).unwrap();
    let material = Material { density: 2000.0, young, poisson: 0.3, viscosity: 0.0 };
    let body = Body::new(mesh, material).thickness(0.005).plane(Plane::Stress).build().unwrap();
    for load in [1.0, 3.0, 8.0_f64] {
        let stress = load * young / 12.0 * (height / length).powi(2); // b B / mu_0
        let scene = Scene::new(body.clone()).magnet(Magnet::new([remanence, 0.0])).phase(
            Phase::until(1.0).hold("left").magnetic_field([0.0, stress * VACUUM / remanence]),
        );
        let equilibrium = scene.equilibrium(&Statics::default()).unwrap();
        let view = &equilibrium.trajectory().last().u;
        let mesh = scene.body().mesh();
        // the middle of the right end
        let is_tip = |node: &usize| {
            let x = mesh.position(*node);
            (x[0] - length).abs() < 1e-9 && (x[1] - 0.5 * height).abs() < 1e-9
        };
        let tip = (0..mesh.node_count()).find(is_tip).unwrap();
        let found = [length + view[2 * tip], view[2 * tip + 1]].map(|x| x / length);
        let expected = elastica(load);
        let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
        println!("load {load}: {found:?}, the elastica {expected:?}, {off:.1e} apart");
        assert!(off < 1e-3, "load {load}: {found:?} {expected:?}");
    }
}

/// A rigid needle, magnetized along itself, is at rest across a uniform field: it turns as a pendulum swings down from the horizontal, and comes
/// along the field after K(1/sqrt 2) sqrt(I/(m B)) with the angular velocity sqrt(2 m B/I). Its centre of mass stays, and the
/// field has supplied m B.
#[test]
fn a_needle_turns_as_a_pendulum_swings() {
    let [length, height, thickness, remanence, field] = [0.02, 0.004, 0.003, 1.2, 0.01];
    let mesh = Mesh::rectangle([length, height], [5, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, Material::rigid(7500.0)).thickness(thickness).build().unwrap();
    let volume = length * height * thickness;
    let inertia = 7500.0 * volume * (length * length + height * height) / 12.0;
    let moment = remanence * volume / VACUUM;
    let rate = (moment * field / inertia).sqrt();
    let until = 1.854_074_677_301_372 / rate;
    let scene = Scene::new(body)
        .magnet(Magnet::new([remanence, 0.0]))
        .phase(Phase::until(until).magnetic_field([0.0, field]));
    let sampling = Sampling::phase_ends()
        .read("moment", Reading::magnetic_moment())
        .read("centre", Reading::centre_of_mass())
        .read("angle", Reading::rotation());
    for method in [Method::CvodeBdf, Method::Arkode, Method::Rk, Method::Rosenbrock] {
        let settings = Settings { method, rtol: 1e-8, ..Settings::default() };
        let motion = scene.simulate(&settings, &sampling).unwrap();
        let last = motion.last();
        let [along, up, x, y, angle] = last.sensors[..] else { panic!("{:?}", last.sensors) };
        let turned = (angle - std::f64::consts::FRAC_PI_2).abs();
        let across = (along / moment).abs().max((up / moment - 1.0).abs());
        let drift = (x - 0.5 * length).hypot(y - 0.5 * height) / length;
        let supplied = (last.energy.supplied / (moment * field) - 1.0).abs();
        let kinetic = (last.energy.kinetic / (moment * field) - 1.0).abs();
        println!(
            "{method}: {turned:.1e} rad, {across:.1e}, {drift:.1e}, {supplied:.1e}, {kinetic:.1e}"
        );
        assert!(turned < 2e-7 && across < 2e-7 && drift < 1e-14, "{method}");
        assert!(supplied < 2e-7 && kinetic < 5e-7, "{method}");
    }
}

/// A field whose gradient is G along the moment m of a rigid magnet pulls it by m G, in the plane and in space; it begins where the gradient adds
/// nothing, in a field along its moment.
#[test]
fn a_gradient_pulls() {
    let (remanence, strength, until) = (1.0, 2.0, 0.1);
    let plane = Mesh::rectangle([0.01, 0.01], [3, 3], Cells::Rectangles).unwrap();
    let solid = Mesh::cuboid([0.01; 3], [2, 2, 2], SolidCells::Hexahedra).unwrap();
    for (mesh, thickness) in [(plane, Some(0.01)), (solid, None)] {
        let d = mesh.dimension();
        let body = Body::new(mesh, Material::rigid(5000.0));
        let body = match thickness {
            Some(thickness) => body.thickness(thickness),
            None => body,
        };
        let mut rows = vec![vec![0.0; d]; d];
        rows[0][0] = strength;
        for (axis, row) in rows.iter_mut().enumerate().skip(1) {
            row[axis] = -strength / (d - 1) as f64;
        }
        let along = |x: f64| {
            let mut vector = vec![0.0; d];
            vector[0] = x;
            vector
        };
        let field = MagneticField::uniform(along(0.05)).gradient(rows, vec![0.005; d]);
        let scene = Scene::new(body.build().unwrap())
            .magnet(Magnet::new(along(remanence)))
            .phase(Phase::until(until).magnetic_field(field));
        let settings = Settings { rtol: 1e-8, ..Settings::default() };
        let motion = run(&scene, &settings, &[]);
        let expected = 0.5 * (remanence / VACUUM * strength / 5000.0) * until * until;
        let far: Vec<f64> = motion.last().u.chunks(d).map(|u| u[0]).collect();
        let off = far.iter().map(|x| (x / expected - 1.0).abs()).fold(0.0, f64::max);
        let aside =
            motion.last().u.chunks(d).flat_map(|u| &u[1..]).fold(0.0_f64, |m, u| m.max(u.abs()));
        println!("{d} dimensions: {expected} m, off by {off:.1e}, aside {aside:.1e} m");
        assert!(off < 1e-12 && aside < 1e-12, "{d} dimensions: {off:e}, {aside:e}");
    }
}

/// A command that sets the field does what a phase with it does; a checkpoint keeps it.
#[test]
fn fields_are_driven() {
    let mesh = Mesh::rectangle([0.02, 0.001], [21, 3], Cells::Rectangles9).unwrap();
    let material = Material { density: 2000.0, young: 1e6, poisson: 0.3, viscosity: 5e3 };
    let body = Body::new(mesh, material).thickness(0.005).build().unwrap();
    let half = CellSelection::inside([0.01, 0.0], [0.02, 0.001]);
    let scene = |phase: Phase| {
        Scene::new(body.clone())
            .magnet(Magnet::new([0.1, 0.0]).within(half.clone()))
            .phase(phase.hold("left"))
    };
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    let field = [0.0, 2e-3];
    let given = run(&scene(Phase::until(0.02).magnetic_field(field)), &settings, &[]);
    let mut driven = scene(Phase::until(0.02)).start(&settings).unwrap();
    driven.magnetic_field(field).unwrap();
    driven.advance_to(0.01).unwrap();
    let kept = driven.checkpoint();
    driven.magnetic_field([0.0, -1e-3]).unwrap();
    driven.advance_to(0.02).unwrap();
    driven.restore(&kept).unwrap();
    assert_eq!(driven.view().magnetic_field(), field);
    let error = driven.magnetic_field([1.0]).unwrap_err().to_string();
    assert!(error.contains("2 component(s) (T)"), "{error}");
    driven.advance_to(0.02).unwrap();
    let tip = given.last().u.len() - 1;
    let [a, b] = [given.last().u[tip], driven.view().displacements()[tip]];
    println!("{a} m and {b} m");
    assert!(a > 1e-3 && (a - b).abs() < 1e-9 * a, "{a} {b}");
}

#[test]
fn magnets_and_fields_that_cannot_be() {
    let mesh = Mesh::rectangle([0.02, 0.02], [3, 3], Cells::Rectangles).unwrap();
    let material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 1.0 };
    let body = Body::new(mesh, material).thickness(0.01).strain(Strain::Green).build().unwrap();
    let scene = || Scene::new(body.clone());
    let refused = |scene: Scene, parts: &[&str]| {
        let error: Error = scene.validate().unwrap_err().into();
        assert!(parts.iter().all(|part| error.to_string().contains(part)), "{error}");
    };
    let phase = || Phase::until(0.1).named("p");
    let with = |magnet: Magnet| scene().magnet(magnet).phase(phase());
    refused(with(Magnet::new([0.1])), &["magnet 1 remanence = [0.1]", "2 component(s) (T)"]);
    refused(with(Magnet::new([0.1, f64::NAN])), &["magnet 1 component 2 of remanence = NaN"]);
    refused(with(Magnet::new([0.1, 0.0]).within("rod")), &["magnet 1 group", "\"rod\""]);
    let under = |field: MagneticField| {
        scene().magnet(Magnet::new([0.1, 0.0])).phase(phase().magnetic_field(field))
    };
    refused(under([0.1].into()), &["magnetic field of phase \"p\"", "2 component(s) (T)"]);
    let gradient =
        |rows: [[f64; 2]; 2]| under(MagneticField::uniform([0.0, 0.0]).gradient(rows, [0.0, 0.0]));
    refused(gradient([[0.0, 1.0], [2.0, 0.0]]), &["gradient of magnetic field", "symmetric"]);
    gradient([[0.0, 1.0], [1.0, 2.0]]).validate().unwrap();
    refused(scene().phase(phase().magnetic_field([0.0, 0.1])), &["phase \"p\"", "no magnet"]);
    let warned = under([0.0, 50.0].into()).magnet(Magnet::new([100.0, 0.0]));
    let warnings = warned.warnings().join("; ");
    assert!(
        warnings.contains("a remanence is 100 T") && warnings.contains("is 50 T"),
        "{warnings}"
    );
    assert!(warned.unusual(["remanence", "magnetic-field"]).warnings().is_empty());
}

//! How bodies, places within them and markers beside them move, as sensors read it: against closed forms of rigid motions, and of
//! soft ones against differences of what was read before and after.

use pliant::simulate::{Reading, Spot};
use pliant::{
    Body, Cells, Material, Mesh, Method, Phase, Sampling, Scene, Settings, SolidCells, Strain,
    Trajectory,
};

const GRAVITY: [f64; 2] = [0.0, -9.8];

/// The readings of a sensor, sample by sample.
fn series(motion: &Trajectory, name: &str) -> Vec<f64> {
    let number = motion.sensors().iter().position(|sensor| sensor.name == name).unwrap();
    motion.samples().iter().map(|sample| sample.sensors[number]).collect()
}

/// A rigid bar that is thrown and turns four times in the plane: a parabola, an angle in proportion to time, and a marker on a
/// post that is not meshed on its circle, with the acceleration of gravity and r omega^2 inwards.
#[test]
fn a_rigid_bar_in_flight() {
    const SPIN: f64 = 25.0;
    const THROWN: [f64; 2] = [0.3, 2.0];
    let mesh = Mesh::rectangle([0.1, 0.02], [6, 3], Cells::Rectangles).unwrap();
    let centre = [0.05, 0.01];
    let body = Body::new(mesh, Material::rigid(1200.0)).thickness(0.01).build().unwrap();
    let scene = Scene::new(body)
        .gravity(GRAVITY)
        .initial_velocity(|_| THROWN.to_vec())
        .spin([SPIN])
        .phase(Phase::until(1.0));
    let lamp = || Spot::marker("right", [0.15, 0.03]);
    let sampling = Sampling::every(0.1)
        .read("turn", Reading::rotation())
        .read("side", Reading::rotation().on("right"))
        .read("spin", Reading::angular_velocity())
        .read("change", Reading::angular_acceleration().on("top"))
        .read("middle", Reading::position(Spot::inside(centre)))
        .read("fall", Reading::acceleration(Spot::inside(centre)))
        .read("lamp", Reading::position(lamp()))
        .read("way", Reading::displacement(lamp()))
        .read("speed", Reading::velocity(lamp()))
        .read("lamp'", Reading::acceleration(lamp()))
        .read("felt", Reading::accelerometer())
        .read("side felt", Reading::accelerometer().on("right"))
        .read("gyro", Reading::gyroscope().on("right"));
    for method in [Method::CvodeBdf, Method::Rosenbrock, Method::Ida] {
        let settings = Settings { method, rtol: 1e-9, ..Settings::default() };
        let motion = scene.simulate(&settings, &sampling).unwrap();
        let (arm, angle) = ([0.1_f64, 0.02], |t: f64| SPIN * t);
        for (number, sample) in motion.samples().iter().enumerate() {
            let t = sample.time;
            let (sine, cosine) = angle(t).sin_cos();
            let out = [cosine * arm[0] - sine * arm[1], sine * arm[0] + cosine * arm[1]];
            let along = [-SPIN * out[1], SPIN * out[0]];
            let middle: [f64; 2] =
                [0, 1].map(|i| centre[i] + THROWN[i] * t + 0.5 * GRAVITY[i] * t * t);
            let drift: [f64; 2] = [0, 1].map(|i| THROWN[i] + GRAVITY[i] * t);
            let lamp: [f64; 2] = [0, 1].map(|i| middle[i] + out[i]);
            let expected = [
                ("turn", angle(t), 1e-5),
                ("side", angle(t), 1e-5),
                ("spin", SPIN, 4e-5),
                ("change", 0.0, 2e-4),
                ("middle.x", middle[0], 2e-7),
                ("middle.y", middle[1], 2e-7),
                ("fall.x", GRAVITY[0], 2e-5),
                ("fall.y", GRAVITY[1], 2e-5),
                ("lamp.x", lamp[0], 1e-6),
                ("lamp.y", lamp[1], 1e-6),
                ("way.x", lamp[0] - centre[0] - arm[0], 1e-6),
                ("way.y", lamp[1] - centre[1] - arm[1], 1e-6),
                ("speed.x", drift[0] + along[0], 3e-5),
                ("speed.y", drift[1] + along[1], 3e-5),
                ("lamp'.x", GRAVITY[0] - SPIN * SPIN * out[0], 6e-4),
                ("lamp'.y", GRAVITY[1] - SPIN * SPIN * out[1], 6e-4),
                // in free fall nothing but the turn is felt, towards the middle in axes of the body
                ("felt.x", 0.0, 2e-5),
                ("felt.y", 0.0, 2e-5),
                ("side felt.x", -SPIN * SPIN * 0.05, 4e-4),
                ("side felt.y", 0.0, 4e-4),
                ("gyro", SPIN, 4e-5),
            ];
            for (name, expected, tolerance) in expected {
                let apart = (series(&motion, name)[number] - expected).abs();
                assert!(apart < tolerance, "{method} {name} at {t}: {apart:e}");
            }
        }
    }
}

/// A box that begins to tumble about no principal axis: Euler's equations say how its spin begins to change, and the vector of
/// its rotation begins along the spin.
#[test]
fn a_tumbling_box() {
    const SIZE: [f64; 3] = [0.03, 0.02, 0.01];
    let spin = [1.0, 20.0, 2.0];
    let mesh = Mesh::cuboid(SIZE, [4, 3, 2], SolidCells::Hexahedra).unwrap();
    let body = Body::new(mesh, Material::rigid(2000.0)).build().unwrap();
    let scene = Scene::new(body).spin(spin).phase(Phase::until(1e-4));
    let sampling = Sampling::phase_ends()
        .read("turn", Reading::rotation().on("top"))
        .read("spin", Reading::angular_velocity())
        .read("change", Reading::angular_acceleration());
    let motion = scene.simulate(&Settings::default(), &sampling).unwrap();
    let squares = SIZE.map(|a| a * a);
    let inertia = [squares[1] + squares[2], squares[2] + squares[0], squares[0] + squares[1]];
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let change = (inertia[j] - inertia[k]) * spin[j] * spin[k] / inertia[i];
        let at = |name: &str, sample: usize| series(&motion, &format!("{name}.{axis}"))[sample];
        // round-off alone
        assert!((at("spin", 0) - spin[i]).abs() < 1e-12, "{axis}");
        assert!((at("change", 0) - change).abs() < 1e-9, "{axis}: {}", at("change", 0) - change);
        // the spin changes by 4e-3 rad/s until then
        assert!((at("turn", 1) - 1e-4 * spin[i]).abs() < 5e-7, "{axis}: {}", at("turn", 1));
    }
}

/// A square plate that spins freely: in its own axes the angular velocity goes around the axis of symmetry at (I3 - I1)/I1 of the spin about
/// that; in space it does so about the angular momentum, at another rate.
#[test]
fn a_gyroscope_turns_with_the_body() {
    const SIZE: [f64; 3] = [0.02, 0.02, 0.01];
    let [across, along] = [3.0, 10.0];
    let mesh = Mesh::cuboid(SIZE, [2, 2, 2], SolidCells::Hexahedra).unwrap();
    let body = Body::new(mesh, Material::rigid(2000.0)).build().unwrap();
    let scene = Scene::new(body)
        .gravity([0.0, 0.0, -9.8])
        .spin([across, 0.0, along])
        .phase(Phase::until(0.3));
    let sampling = Sampling::every(0.1)
        .read("own", Reading::gyroscope())
        .read("top felt", Reading::accelerometer().on("top"));
    let settings = Settings { method: Method::Rosenbrock, rtol: 1e-9, ..Settings::default() };
    let motion = scene.simulate(&settings, &sampling).unwrap();
    let [first, third] = [SIZE[1] * SIZE[1] + SIZE[2] * SIZE[2], 2.0 * SIZE[0] * SIZE[0]];
    let rate = (third - first) / first * along;
    for (number, sample) in motion.samples().iter().enumerate() {
        let (sine, cosine) = (rate * sample.time).sin_cos();
        let own = [across * cosine, across * sine, along];
        // w x (w x r) + w' x r of the top, r = (0, 0, h), w' = (-rate w_y, rate w_x, 0)
        let h = 0.5 * SIZE[2];
        let felt = [
            h * (own[2] * own[0] + rate * own[0]),
            h * (own[2] * own[1] + rate * own[1]),
            -h * across * across,
        ];
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let at = |name: &str| series(&motion, &format!("{name}.{axis}"))[number];
            assert!((at("own") - own[i]).abs() < 1e-5, "{axis}: {} {}", at("own"), own[i]);
            let apart = (at("top felt") - felt[i]).abs();
            assert!(apart < 1e-4, "{axis}: {} {}", at("top felt"), felt[i]);
        }
    }
}

/// A beam that sways: the middle of a cell of four nodes moves as the mean of these; on a mesh of another division the same place
/// moves alike, which none of its nodes has to be near.
#[test]
fn a_place_within_a_cell() {
    let sway = |cells: [usize; 2], kind: Cells| {
        let mesh = Mesh::rectangle([0.1, 0.02], cells.map(|n| n + 1), kind).unwrap();
        let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 20.0 };
        let body = Body::new(mesh, rubber).thickness(0.01).strain(Strain::Green).build().unwrap();
        let place = || Spot::inside([0.095, 0.015]);
        let sampling = Sampling::every(0.01)
            .read("at", Reading::position(place()))
            .read("by", Reading::displacement(place()))
            .read("v", Reading::velocity(place()))
            .read("nodes", Reading::displacement([21, 22, 32, 33]))
            .read("node v", Reading::velocity([21, 22, 32, 33]));
        let scene = Scene::new(body).gravity(GRAVITY).phase(Phase::until(0.1).hold("left"));
        let settings = Settings { rtol: 1e-7, ..Settings::default() };
        scene.simulate(&settings, &sampling).unwrap()
    };
    let coarse = sway([10, 2], Cells::Rectangles);
    let close = |a: &[f64], b: &[f64], tolerance: f64| {
        a.iter().zip(b).for_each(|(a, b)| assert!((a - b).abs() < tolerance, "{a} {b}"));
    };
    for axis in ["x", "y"] {
        let read = |name: &str| series(&coarse, &format!("{name}.{axis}"));
        close(&read("by"), &read("nodes"), 1e-16);
        close(&read("v"), &read("node v"), 1e-14);
    }
    let at: Vec<f64> = series(&coarse, "by.y").iter().map(|u| u + 0.015).collect();
    close(&series(&coarse, "at.y"), &at, 1e-16);
    // 7 mm of sway; rectangles with mid nodes of two divisions, neither of which has a node there
    let fine = [[9, 3], [14, 4]].map(|cells| series(&sway(cells, Cells::Rectangles9), "by.y"));
    let sway = fine[0].iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    assert!(sway > 5e-3, "{sway}");
    // measured: 2.9e-5 m
    close(&fine[0], &fine[1], 6e-3 * sway);
}

/// Readings at three times in a row: the rate in between by differences, and the largest rate.
fn rates(motion: &Trajectory, of: &str, rate: &str) -> (f64, f64) {
    let (values, rates) = (series(motion, of), series(motion, rate));
    let times: Vec<f64> = motion.samples().iter().map(|sample| sample.time).collect();
    let (mut apart, mut most) = (0.0_f64, 0.0_f64);
    for k in 2..times.len() - 1 {
        if k % 3 == 2 {
            let difference = (values[k + 1] - values[k - 1]) / (times[k + 1] - times[k - 1]);
            (apart, most) = (apart.max((difference - rates[k]).abs()), most.max(rates[k].abs()));
        }
    }
    (apart, most)
}

/// A soft block that tumbles and quivers: whatever is read is the rate of what is read of it one order lower, in the plane and in space,
/// of nodes, of places, of markers and of rotations.
#[test]
fn rates_are_those_of_what_is_read() {
    let rubber = Material { density: 1000.0, young: 3e4, poisson: 0.3, viscosity: 5.0 };
    let plane = Mesh::rectangle([0.1, 0.04], [6, 3], Cells::Triangles).unwrap();
    let space = Mesh::cuboid([0.1, 0.04, 0.03], [4, 3, 2], SolidCells::Hexahedra).unwrap();
    for (mesh, spin, axes) in
        [(plane, vec![9.0], &["x", "y"][..]), (space, vec![2.0, 9.0, 4.0], &["x", "y", "z"])]
    {
        let d = mesh.dimension();
        let place = [0.031, 0.017, 0.011][..d].to_vec();
        let beside = [0.15, 0.03, 0.02][..d].to_vec();
        let body = Body::new(mesh, rubber).strain(Strain::Green);
        let body = if d == 2 { body.thickness(0.03) } else { body }.build().unwrap();
        // it is stretched, and let go
        let stretched = |x: &[f64]| {
            x.iter().enumerate().map(|(i, x)| if i == 0 { 0.1 * x } else { 0.02 * x }).collect()
        };
        let scene =
            Scene::new(body).initial_displacement(stretched).spin(spin).phase(Phase::until(0.2));
        let spots = || {
            [
                ("node", Spot::from([1])),
                ("inside", Spot::inside(place.clone())),
                ("marker", Spot::marker("right", beside.clone())),
            ]
        };
        // three times around each of a few
        let times: Vec<f64> = (1..8)
            .flat_map(|k| [-1.0, 0.0, 1.0].map(|by| 0.025 * f64::from(k) + 1e-5 * by))
            .collect();
        let mut sampling = Sampling::at(times)
            .read("turn", Reading::rotation())
            .read("spin", Reading::angular_velocity())
            .read("change", Reading::angular_acceleration())
            .read("side turn", Reading::rotation().on("right"))
            .read("side spin", Reading::angular_velocity().on("right"))
            .read("side change", Reading::angular_acceleration().on("right"));
        for (name, spot) in spots() {
            sampling = sampling
                .read(format!("{name} x"), Reading::position(spot.clone()))
                .read(format!("{name} u"), Reading::displacement(spot.clone()))
                .read(format!("{name} v"), Reading::velocity(spot.clone()))
                .read(format!("{name} a"), Reading::acceleration(spot));
        }
        let settings = Settings { method: Method::Rk, rtol: 1e-10, ..Settings::default() };
        let motion = scene.simulate(&settings, &sampling).unwrap();
        let check = |of: String, rate: String| {
            let (apart, most) = rates(&motion, &of, &rate);
            assert!(apart < 3e-5 * most && most > 1e-3, "{of} and {rate}: {apart:e} of {most}");
        };
        for axis in axes {
            for (name, _) in spots() {
                check(format!("{name} x.{axis}"), format!("{name} v.{axis}"));
                check(format!("{name} u.{axis}"), format!("{name} v.{axis}"));
                check(format!("{name} v.{axis}"), format!("{name} a.{axis}"));
            }
            if d == 3 {
                for name in ["", "side "] {
                    check(format!("{name}spin.{axis}"), format!("{name}change.{axis}"));
                }
            }
        }
        if d == 2 {
            for name in ["", "side "] {
                check(format!("{name}turn"), format!("{name}spin"));
                check(format!("{name}spin"), format!("{name}change"));
            }
        }
    }
}

/// Sensors that cannot be read say why.
#[test]
fn refusals() {
    let mesh = Mesh::cuboid([0.1; 3], [2; 3], SolidCells::Hexahedra).unwrap();
    let scene = Scene::new(Body::new(mesh, Material::rigid(1000.0)).named("box").build().unwrap())
        .phase(Phase::until(0.1));
    let refused = |reading: Reading, words: &str| {
        let sampling = Sampling::phase_ends().read("it", reading);
        let error = scene.simulate(&Settings::default(), &sampling).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    refused(Reading::angular_velocity().on([1, 2]), "on a line");
    refused(Reading::position(Spot::marker([1], [0.0; 3])), "on a line");
    refused(Reading::position(Spot::marker("top", [0.0; 2])), "3 component");
    refused(Reading::velocity(Spot::inside([0.2, 0.0, 0.0])), "outside the body");
    refused(Reading::angular_velocity().in_degrees(), "angles and rotations alone");
    refused(Reading::rotation().on("top").of_body("box"), "leave one of them out");
}

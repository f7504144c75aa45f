//! Branches with a yield stress: relaxation down to it, creep and what stays, against closed forms and scalar models of their own.

use pliant::{
    Axis, Body, Cells, Dilatation, Material, Mesh, Method, Phase, Plane, Prescribed, Scene,
    SolidCells, Strain,
};

use crate::common::difference;
use crate::damping::{RUBBER, run};

const SHARE: f64 = 1.5;
const TIME: f64 = 0.05;
/// Of dough that hardly weighs anything.
const DOUGH: Material = Material { density: 1e-3, young: 1e5, poisson: 0.3, viscosity: 100.0 };
/// How far and until when (s) it is pressed, until when held, and looked at.
const PRESSED: f64 = 0.02;
const TIMES: [f64; 3] = [0.1, 0.3, 0.6];

/// One cell in one mode of deformation e with the stress s of the branch: s' = modulus SHARE e' - rate s (1 - yield/q)/TIME, q = mises |s|.
struct Mode {
    body: Body,
    /// Of the set "right" or "top", and the axis along which it is led.
    led: (&'static str, Axis),
    held: &'static str,
    /// Length (m) that makes a strain of a displacement.
    length: f64,
    /// Area (m^2) times what makes a modulus of Young's.
    area: f64,
    of_young: f64,
    rate: f64,
    mises: f64,
}

fn modes(yield_stress: f64) -> [Mode; 3] {
    let dough = || DOUGH.yielding(SHARE, TIME, yield_stress);
    let bar = Body::new(Mesh::bar(0.1, 2).unwrap(), dough()).area(1e-4);
    let plane = Mesh::rectangle([0.1, 0.05], [2, 2], Cells::Rectangles).unwrap();
    let plane = Body::new(plane, dough()).thickness(0.01).dilatation(Dilatation::Mean);
    let solid = Mesh::cuboid([0.1, 0.05, 0.05], [2, 2, 2], SolidCells::Hexahedra).unwrap();
    let [bar, plane, solid] =
        [bar, plane, Body::new(solid, dough())].map(|body| body.strain(Strain::Cauchy).build());
    let shear = 0.5 / (1.0 + DOUGH.poisson);
    let mode = |body, held, led, length, area, [of_young, rate, mises]: [f64; 3]| Mode {
        body,
        led,
        held,
        length,
        area,
        of_young,
        rate,
        mises,
    };
    // stretching a string shears it by 2/3 (1 + nu); nothing but shear does that by 1
    let slow = 2.0 / 3.0 * (1.0 + DOUGH.poisson);
    let sheared = [shear, 1.0, 3_f64.sqrt()];
    [
        mode(bar.unwrap(), "left", ("right", Axis::X), 0.1, 1e-4, [1.0, slow, 1.0]),
        mode(plane.unwrap(), "bottom", ("top", Axis::X), 0.05, 1e-3, sheared),
        mode(solid.unwrap(), "left", ("right", Axis::Y), 0.1, 2.5e-3, sheared),
    ]
}

/// The path of a press: half of a swing.
fn press(t: f64) -> [f64; 2] {
    let omega = std::f64::consts::PI / TIMES[0];
    [0.5 * PRESSED * (1.0 - (omega * t).cos()), 0.5 * PRESSED * omega * (omega * t).sin()]
}

impl Mode {
    fn phase(&self, until: f64) -> Phase {
        let across: Vec<Axis> = [Axis::X, Axis::Y, Axis::Z][..self.body.dimension()]
            .iter()
            .copied()
            .filter(|axis| *axis != self.led.1)
            .collect();
        let phase = Phase::until(until).hold(self.held);
        if across.is_empty() { phase } else { phase.hold_axes(self.led.0, across) }
    }

    fn scene(&self) -> Scene {
        let length = self.length;
        let path = move |t: f64| {
            let omega = std::f64::consts::PI / TIMES[0];
            let [strain, rate] = press(t);
            let acceleration = 0.5 * PRESSED * omega * omega * (omega * t).cos();
            Prescribed {
                displacement: length * strain,
                velocity: length * rate,
                acceleration: length * acceleration,
            }
        };
        let pressed = self.phase(TIMES[0]).follow(self.led.0, self.led.1, path);
        let held = Phase::until(TIMES[1]).hold(self.held).hold(self.led.0);
        Scene::new(self.body.clone()).phase(pressed).phase(held).phase(self.phase(TIMES[2]))
    }

    /// Strain and stress at a time, by Runge and Kutta's method, and the work that has become heat (J/m^3).
    fn expected(&self, yield_stress: f64, until: f64) -> [f64; 3] {
        let modulus = self.of_young * DOUGH.young;
        let viscosity = self.of_young * DOUGH.viscosity;
        let slope = |t: f64, [strain, branch, _]: [f64; 3]| {
            let rate = match t {
                t if t < TIMES[0] => press(t)[1],
                t if t < TIMES[1] => 0.0,
                _ => -(modulus * strain + branch) / viscosity,
            };
            let over = (1.0 - yield_stress / (self.mises * branch.abs()).max(1e-9)).max(0.0);
            let flow = self.rate * over * branch / TIME;
            let heat = branch * flow / (SHARE * modulus) + viscosity * rate * rate;
            [rate, SHARE * modulus * rate - flow, heat]
        };
        let (mut y, mut t) = ([0.0; 3], 0.0);
        for end in TIMES.map(|time| time.min(until)) {
            let steps = 4000;
            let h = (end - t) / f64::from(steps);
            for _ in 0..steps {
                let ahead = |k: [f64; 3], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
                let inside = t.min(end - 1e-12);
                let a = slope(inside, y);
                let b = slope((t + 0.5 * h).min(end - 1e-12), ahead(a, 0.5 * h));
                let c = slope((t + 0.5 * h).min(end - 1e-12), ahead(b, 0.5 * h));
                let d = slope((t + h).min(end - 1e-12), ahead(c, h));
                y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
                t += h;
            }
            t = end;
        }
        y
    }
}

/// Pressed, held and let go: strain, stress and heat are those of the scalar model at all times, and part of the strain stays.
#[test]
fn part_of_the_shape_stays() {
    for yield_stress in [500.0, 1e9] {
        for mode in modes(yield_stress) {
            let node = mode.body.mesh().sets()[mode.led.0][0];
            let axis = [Axis::X, Axis::Y].iter().position(|axis| *axis == mode.led.1).unwrap();
            let place = node * mode.body.dimension() + axis;
            let stress = PRESSED * mode.of_young * DOUGH.young * mode.area;
            for method in [Method::Auto, Method::CvodeBdf, Method::Arkode] {
                let trajectory = run(&mode.scene(), method, 1e-7);
                let mut worst = [0.0_f64; 3];
                for sample in &trajectory.samples()[1..] {
                    let [strain, branch, heat] = mode.expected(yield_stress, sample.time);
                    let found = sample.u[place] / mode.length;
                    worst[0] = worst[0].max((found - strain).abs() / PRESSED);
                    if sample.phase == 1 {
                        let pull = trajectory.constraint_force(sample, mode.led.0).unwrap();
                        let pull = pull[if pull.len() > 1 { axis } else { 0 }];
                        let expected = mode.area * (mode.of_young * DOUGH.young * strain + branch);
                        worst[1] = worst[1].max((pull - expected).abs() / stress);
                    }
                    let heat = heat * mode.area * mode.length;
                    let off = sample.energy.dissipated - heat;
                    worst[2] = worst[2].max(off.abs() / (stress * PRESSED * mode.length));
                }
                let left = trajectory.last().u[place] / mode.length / PRESSED;
                let scale = trajectory.report().energy_scale;
                let balance = trajectory.last().energy.balance().abs() / scale;
                println!("{method} {yield_stress}: {worst:?}, left {left}, balance {balance:e}");
                assert!(worst.iter().all(|off| *off < 1e-4), "{method}: {worst:?}");
                assert!(balance < 1e-4, "{balance:e}");
                let stays = if yield_stress > 1e6 { -1e-3..1e-3 } else { 0.03..0.9 };
                assert!(stays.contains(&left), "{left}");
            }
        }
    }
}

/// A load that stays on a string: below the yield stress nothing creeps, above it s = Y + (s0 - Y) exp(-rate t/(TIME (1 + g))).
#[test]
fn creep_goes_on_to_the_yield_stress() {
    let yield_stress = 300.0;
    let [string, ..] = modes(yield_stress);
    let share = SHARE / (1.0 + SHARE);
    for load in [0.8 * yield_stress / share, 3.0 * yield_stress / share] {
        let phase = Phase::until(1.5).hold("left").load("right", [load * string.area]);
        let trajectory = run(&Scene::new(string.body.clone()).phase(phase), Method::Auto, 1e-7);
        for sample in trajectory.samples().iter().filter(|sample| sample.time > 0.1) {
            let over = (load * share - yield_stress).max(0.0);
            // what viscosity delays has died out
            let decay = (-sample.time * string.rate / (TIME * (1.0 + SHARE))).exp();
            let branch = (load * share).min(yield_stress) + over * decay;
            let (found, expected) = (sample.u[1] / 0.1, (load - branch) / DOUGH.young);
            assert!((found / expected - 1.0).abs() < 2e-2, "{load} {found} {expected}");
        }
        let last = trajectory.last().u[1] / 0.1 * DOUGH.young;
        let end = load - (load * share).min(yield_stress);
        assert!((last / end - 1.0).abs() < 1e-3, "{last} {end}");
    }
}

/// A body in plane strain is a slice that is held across: what flows across it is the same in both.
#[test]
fn plane_strain_is_that_of_a_slice() {
    let dough = Material { density: 1000.0, ..DOUGH }.yielding(SHARE, TIME, 800.0);
    let flat = Mesh::rectangle([0.1, 0.04], [5, 3], Cells::Rectangles).unwrap();
    let slice = Mesh::cuboid([0.1, 0.04, 0.02], [5, 3, 2], SolidCells::Hexahedra).unwrap();
    for dilatation in [Dilatation::AtPoints, Dilatation::Mean] {
        let flat = Body::new(flat.clone(), dough.clone()).thickness(0.02).dilatation(dilatation);
        let slice = Body::new(slice.clone(), dough.clone()).dilatation(dilatation);
        let [flat, slice] = [(flat, 2), (slice, 3)].map(|(body, d)| {
            let body = body.build().unwrap();
            let all: Vec<usize> = (1..=body.mesh().node_count()).collect();
            let phase = Phase::until(0.2).hold("left");
            let phase = match d {
                2 => phase.load_total("right", [-0.6, -0.3]),
                _ => phase.load_total("right", [-0.6, -0.3, 0.0]).hold_axes(all, [Axis::Z]),
            };
            run(&Scene::new(body).phase(phase), Method::CvodeBdf, 1e-7)
        });
        let nodes = flat.body().mesh().node_count();
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for (a, b) in flat.samples().iter().zip(slice.samples()) {
            for node in 0..nodes {
                for axis in 0..2 {
                    let (a, b) = (a.u[2 * node + axis], b.u[3 * node + axis]);
                    worst = worst.max((a - b).abs());
                    largest = largest.max(a.abs());
                }
            }
        }
        let [heat, of_slice] = [&flat, &slice].map(|motion| motion.last().energy.dissipated);
        println!("{:e}, heat {:e}", worst / largest, heat / of_slice - 1.0);
        assert!(worst < 1e-5 * largest && (heat / of_slice - 1.0).abs() < 1e-5);
    }
}

/// A beam that swings far and flows where it is bent most: methods agree, heat only grows, and energy is work less heat.
#[test]
fn methods_agree_where_flow_begins() {
    let dough = Material { density: 1000.0, poisson: 0.4, viscosity: 5.0, ..DOUGH };
    let dough = dough.yielding(SHARE, TIME, 4e3);
    let mesh = || Mesh::rectangle([0.1, 0.02], [5, 2], Cells::Triangles6).unwrap();
    let solid = Mesh::cuboid([0.1, 0.02, 0.02], [6, 2, 2], SolidCells::Hexahedra).unwrap();
    let stress = Body::new(mesh(), dough.clone()).thickness(0.02).plane(Plane::Stress);
    let mean = Body::new(mesh(), dough.clone()).thickness(0.02).dilatation(Dilatation::Mean);
    let solid = Body::new(solid, dough).dilatation(Dilatation::Mean);
    for (body, down) in [(stress, 1), (mean, 1), (solid, 2)] {
        let gravity = (0..=down).map(|axis| if axis == down { -40.0 } else { 0.0 });
        let scene = Scene::new(body.build().unwrap()).gravity(gravity.collect::<Vec<_>>());
        let scene = scene.phase(Phase::until(0.2).hold("left"));
        let reference = run(&scene, Method::Rk, 1e-8);
        for method in [Method::Auto, Method::CvodeBdf, Method::Arkode] {
            let trajectory = run(&scene, method, 1e-6);
            let apart = difference(&trajectory, &reference);
            let first = trajectory.samples()[0].energy.balance();
            let scale = trajectory.report().energy_scale;
            let (mut before, mut worst) = (0.0, 0.0_f64);
            for sample in trajectory.samples() {
                worst = worst.max((sample.energy.balance() - first).abs() / scale);
                assert!(sample.energy.dissipated >= before);
                before = sample.energy.dissipated;
            }
            let steps = trajectory.report().steps();
            println!("{method}: {apart:e}, balance {worst:e}, {steps} steps, heat {before:e}");
            assert!(apart < 1e-5 && worst < 5e-6, "{method}: {apart:e} {worst:e}");
            assert!(before > 1e-2 * scale, "{before}");
        }
    }
}

/// Without a yield stress it is a Maxwell branch, bit by bit.
#[test]
fn no_yield_stress_is_none() {
    let mesh = || Mesh::rectangle([0.1, 0.02], [5, 2], Cells::Triangles).unwrap();
    let [a, b] = [RUBBER.maxwell(0.5, 0.01), RUBBER.yielding(0.5, 0.01, 0.0)].map(|substance| {
        let body = Body::new(mesh(), substance).thickness(0.02).build().unwrap();
        let scene = Scene::new(body).gravity([0.0, -9.8]);
        run(&scene.phase(Phase::until(0.05).hold("left")), Method::Auto, 1e-4)
    });
    assert_eq!(a.samples(), b.samples());
    let bar = Mesh::bar(0.1, 2).unwrap();
    let error = Body::new(bar, RUBBER.yielding(0.5, 0.01, -1.0)).area(1.0).build().unwrap_err();
    assert!(error.to_string().starts_with("material.branch.yield_stress = -1"), "{error}");
}

//! Springs, chambers and changing loads in motion, against closed forms and conservation laws.

use std::sync::{Arc, Mutex};

use pliant::force::{Capabilities, Force, NodalForces, Reservoir, Switches, Tangents};
use pliant::ode::Failure;
use pliant::samples::SQUARE_MATERIAL;
use pliant::sparse::BlockMatrix;
use pliant::{
    Body, Cells, Chamber, ContactEvents, Error, Material, Mesh, Method, Phase, Sampling, Scene,
    Selection, Settings, Signal, Spring, Strain, Trajectory,
};

/// A square of rubber, 3 cm wide, with point masses of 10 g and 30 g beside it, 4 cm apart.
fn two_masses() -> Body {
    let mesh = Mesh::rectangle([0.03, 0.03], [2, 2], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01);
    let body = body.point_mass("light", [0.10, 0.0], 0.01).point_mass("heavy", [0.14, 0.0], 0.03);
    body.build().unwrap()
}

fn fine(method: Method) -> Settings {
    Settings { method, rtol: 1e-9, alpha: 1e4, ..Settings::default() }
}

/// The energy balance closes to `tolerance` of all energy there was.
#[track_caller]
fn assert_balanced(trajectory: &Trajectory, tolerance: f64) {
    let report = trajectory.report();
    println!("energy off by {:e} of {:e} J", report.energy_error, report.energy_scale);
    assert!(report.energy_scale > 0.0);
    assert!(report.energy_error < tolerance * report.energy_scale, "{}", report.energy_error);
}

/// A mass on a spring whose other end is held swings with omega = sqrt(k/m): set going by a
/// constant actuation f, x = (f/k) (1 - cos(omega t)).
#[test]
fn a_mass_on_a_spring_swings() {
    let (k, m, f) = (20.0_f64, 0.03, -0.1);
    let spring = Spring::between("light", "heavy").named("A1").stiffness(k);
    let phase = Phase::until(1.0).hold("light").hold("all-but-heavy").actuate(["A1"], f);
    let mesh = Mesh::rectangle([0.03, 0.03], [2, 2], Cells::Triangles).unwrap();
    let mesh = mesh.name_nodes("all-but-heavy", [1, 2, 3, 4]).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01);
    let body = body.point_mass("light", [0.10, 0.0], 0.01).point_mass("heavy", [0.14, 0.0], m);
    let scene = Scene::new(body.build().unwrap()).spring(spring).phase(phase);
    let omega = (k / m).sqrt();
    for method in Method::ALL {
        let trajectory = scene.simulate(&fine(method), &Sampling::every(0.01)).unwrap();
        for sample in trajectory.samples() {
            let expected = f / k * (1.0 - (omega * sample.time).cos());
            let apart = (sample.u[10] - expected).abs();
            // four swings at rtol 1e-9: BDF adds up the errors of some 2000 steps
            assert!(apart < 1e-5 * (f / k).abs(), "{method}: {apart:e} at {} s", sample.time);
            assert_eq!(sample.u[11], 0.0);
        }
        // the energy that central differences conserve is off by (omega h)^2/8
        assert_balanced(&trajectory, if method == Method::CentralDifference { 1e-5 } else { 1e-6 });
    }
}

/// Two free masses on a spring swing with the reduced mass against each other; what they do to
/// the square between them and to their centre is nothing.
#[test]
fn two_masses_swing_against_each_other() {
    let (k, reduced, f) = (20.0_f64, 0.01 * 0.03 / 0.04, 0.2);
    let spring = Spring::between("light", "heavy").named("A1").stiffness(k);
    let phase = Phase::until(0.5).actuate_with(["A1"], move |_| f);
    let scene = Scene::new(two_masses()).spring(spring).phase(phase);
    let omega = (k / reduced).sqrt();
    for method in [Method::CvodeBdf, Method::Ida, Method::Rk] {
        let trajectory = scene.simulate(&fine(method), &Sampling::every(0.01)).unwrap();
        for sample in trajectory.samples() {
            let stretch = sample.u[10] - sample.u[8];
            let expected = f / k * (1.0 - (omega * sample.time).cos());
            assert!((stretch - expected).abs() < 1e-6 * f / k, "{method}: {stretch} {expected}");
            let momentum = 0.01 * sample.v[8] + 0.03 * sample.v[10];
            assert!(momentum.abs() < 1e-13, "{method}: {momentum:e}");
        }
    }
}

/// A damped spring between two bodies in free flight, turning: energy balances, momentum and
/// angular momentum stay.
#[test]
fn a_turning_pair_keeps_its_angular_momentum() {
    let spring = Spring::between("light", "heavy").stiffness(20.0).damping(0.05);
    let throw = Phase::until(0.05).load("light", [0.0, 0.2]).load("heavy", [0.1, -0.2]);
    let scene = Scene::new(two_masses()).spring(spring).phase(throw).phase(Phase::until(0.5));
    for method in [Method::CvodeBdf, Method::Ida, Method::Rk] {
        let trajectory = scene.simulate(&fine(method), &Sampling::every(0.05)).unwrap();
        let free: Vec<_> = trajectory.samples().iter().filter(|s| s.time >= 0.05).collect();
        let spin = |k: usize| trajectory.angular_momentum(free[k])[0];
        println!("{method}: angular momentum {:e} and {:e}", spin(0), spin(free.len() - 1));
        assert!(spin(0).abs() > 1e-4);
        for (k, sample) in free.iter().enumerate() {
            assert!((spin(k) / spin(0) - 1.0).abs() < 1e-6, "{method}");
            let (p, q) = (trajectory.momentum(sample), trajectory.momentum(free[0]));
            assert!((0..2).all(|i| (p[i] - q[i]).abs() < 1e-9), "{method}: {p:?} {q:?}");
        }
        assert!(trajectory.last().energy.dissipated > 1e-5);
        assert_balanced(&trajectory, 1e-6);
    }
}

/// An actuator that pulls harder than its spring can resist: the run stops when the spring is at
/// its end, about when the closed form says, and says which spring and when.
#[test]
fn a_collapsed_spring_is_named() {
    let (k, length, f) = (20.0_f64, 0.04_f64, -5.0);
    let spring = Spring::between("light", "heavy").named("A2").stiffness(k).length(length);
    let scene = Scene::new(two_masses())
        .spring(spring)
        .phase(Phase::until(0.02).named("settle"))
        .phase(Phase::until(1.0).named("shrink").actuate(["A2"], f));
    let omega = (k / (0.01 * 0.03 / 0.04)).sqrt();
    // 1 % of the length is left
    let expected = 0.02 + (1.0 + 0.99 * length * k / f).acos() / omega;
    for method in Method::ALL {
        for rtol in [1e-2, 1e-3, 1e-6, 1e-9] {
            let settings = Settings { method, rtol, ..Settings::default() };
            let result = scene.simulate(&settings, &Sampling::every(0.001));
            let Err(Error::Integration(failure)) = &result else { panic!("{method}: {result:?}") };
            let message = failure.to_string();
            println!("{message}");
            for part in ["shrink", "spring \"A2\" has collapsed at t = 0.03", "step"] {
                assert!(message.contains(part), "{method} {rtol}: {message}");
            }
            // it happened in the last step, but for the error of the integration
            let (start, slack) = (failure.time, 10.0 * rtol * (expected - 0.02));
            let last_step = start - slack..start + failure.step + slack;
            assert!(last_step.contains(&expected), "{method} {rtol}: {last_step:?} {expected}");
        }
    }
}

/// A strip, clamped at its ends, over a chamber: pressure bulges it upward, and when it ends the
/// strip comes back. Energy balances throughout.
#[test]
fn a_chamber_bulges_a_strip() {
    let mesh = Mesh::rectangle([0.1, 0.01], [11, 2], Cells::Triangles).unwrap();
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.48, viscosity: 40.0 };
    for strain in [Strain::Cauchy, Strain::Green] {
        let body = Body::new(mesh.clone(), soft).thickness(0.01).strain(strain).build().unwrap();
        let phase = |until| Phase::until(until).hold([1, 11, 12, 22]);
        let bottom: Vec<usize> = (1..=11).rev().collect();
        // in any order and by name the same chamber
        let forward: Vec<usize> = (1..=11).collect();
        for nodes in [Selection::from(bottom.clone()), forward.into(), "bottom".into()] {
            let chamber = Chamber::within("below", nodes).closed_by_line();
            let pressed = phase(0.01).pressure("below", 500.0);
            let scene = Scene::new(body.clone()).chamber(chamber).phase(pressed);
            let trajectory = scene.simulate(&fine(Method::CvodeBdf), &Sampling::phase_ends());
            assert!(trajectory.unwrap().last().u[2 * 5 + 1] > 0.0);
        }
        let scene = Scene::new(body)
            .chamber(Chamber::within("below", bottom))
            .phase(phase(0.1).pressure("below", 500.0))
            .phase(phase(0.2).pressure_with("below", |t| 500.0 * (0.2 - t) / 0.1))
            .phase(phase(0.6));
        for method in [Method::CvodeBdf, Method::Ida] {
            let settings = Settings { method, rtol: 1e-7, ..Settings::default() };
            let trajectory = scene.simulate(&settings, &Sampling::every(0.1)).unwrap();
            let height = |time: f64| {
                let at = |sample: &&pliant::Sample| (sample.time - time).abs() < 1e-9;
                trajectory.samples().iter().find(at).unwrap().u[2 * 5 + 1]
            };
            println!("{strain:?} {method}: {} {}", height(0.1), height(0.6));
            assert!(height(0.1) > 1e-3 && height(0.6).abs() < 0.1 * height(0.1));
            assert_balanced(&trajectory, 1e-5);
        }
    }
}

/// Loads that change with time, and those that are shared: a free body moves as a point mass,
/// v = (1/m) times the integral of the force.
#[test]
fn loads_push_the_centre_of_mass() {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let mass = body.mass();
    let phase = Phase::until(0.5)
        .load_with("top", |t| [0.5 * t, 0.0])
        .load_total("bottom", [0.0, 3.0])
        .load([6], [0.0, -1.0]);
    let scene = Scene::new(body).phase(phase);
    let trajectory = scene.simulate(&fine(Method::CvodeBdf), &Sampling::phase_ends()).unwrap();
    let v = trajectory.mean_velocity(trajectory.last());
    // four nodes at the top: 4 x 0.5 x 0.5^2 / 2 N s
    assert!((v[0] * mass / 0.25 - 1.0).abs() < 5e-11, "{v:?}");
    assert!((v[1] * mass / 1.0 - 1.0).abs() < 1e-10, "{v:?}");
    assert_balanced(&trajectory, 1e-6);
}

/// Formulas are the functions that they say, to the last bit; checkpoints in files keep their text, also where a command
/// has given them.
#[test]
fn formulas_are_functions_of_time() {
    let spring = || Spring::anchored([4], [0.3, 0.2]).named("A1").stiffness(20.0).damping(0.1);
    let body = || {
        let mesh = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Rectangles).unwrap();
        Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).build().unwrap()
    };
    let formula = Signal::formula("0.3*sin(20*t) - exp(-t)/10").unwrap();
    let press = Signal::formula("-500*t^2").unwrap();
    // a power that is known beforehand would be compiled as a product, which rounds otherwise
    let square = std::hint::black_box(2.0);
    let held = || Phase::until(0.2).hold("left");
    let written = held().actuate(["A1"], formula).pressure_on("right", press);
    let function = held()
        .actuate_with(["A1"], |t| 0.3 * (20.0 * t).sin() - (-t).exp() / 10.0)
        .pressure_on("right", Signal::function(move |t| -(500.0 * t.powf(square))));
    let [written, function] =
        [written, function].map(|phase| Scene::new(body()).spring(spring()).phase(phase));
    let settings = Settings::default();
    let [a, b] = [&written, &function]
        .map(|scene| scene.simulate(&settings, &Sampling::every(0.05)).unwrap());
    assert!(a.last().u[6].abs() > 1e-6);
    for (a, b) in a.samples().iter().zip(b.samples()) {
        assert_eq!(a.u, b.u, "{} s", a.time);
    }

    let mut simulation = written.start(&settings).unwrap();
    simulation.advance_to(0.1).unwrap();
    simulation.actuate("A1", Signal::formula("0.2*cos(30*t)").unwrap()).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("formula.json");
    simulation.checkpoint().write(&path).unwrap();
    assert!(std::fs::read_to_string(&path).unwrap().contains("0.2*cos(30*t)"));
    let mut other = written.start(&settings).unwrap();
    other.restore(&other.read_checkpoint(&path).unwrap()).unwrap();
    for simulation in [&mut simulation, &mut other] {
        simulation.advance_to(0.2).unwrap();
    }
    assert_eq!(simulation.view().displacements(), other.view().displacements());
    // another formula is another scene
    let phase = held().actuate(["A1"], Signal::formula("0.3*sin(21*t)").unwrap());
    let mut others = Scene::new(body()).spring(spring()).phase(phase).start(&settings).unwrap();
    others.advance_to(0.01).unwrap();
    assert!(others.read_checkpoint(&path).err().unwrap().to_string().contains("phases: what"));

    let error = Signal::formula("2*sinn(t)").unwrap_err().to_string();
    assert!(error.starts_with("formula = 2*sinn(t) cannot be used: unknown word"), "{error}");
}

/// A square in free flight, first down and then, by the gravity of another phase, upward and to the right: its centre
/// moves on parabolas, and what a change of gravity adds to its potential energy is supplied.
#[test]
fn gravity_of_a_phase() {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).build().unwrap();
    let (mass, [x, y]) = (body.mass(), [0.15, 0.15]);
    let scene = Scene::new(body)
        .gravity([0.0, -9.8])
        .phase(Phase::until(0.5))
        .phase(Phase::until(0.8).gravity([2.0, 1.0]))
        .phase(Phase::until(1.0));
    let found = scene.simulate(&fine(Method::CvodeBdf), &Sampling::phase_ends()).unwrap();
    let velocities = [[0.0, -4.9], [0.6, -4.6], [0.6, -6.56]];
    let fallen = [-0.5 * 9.8 * 0.25, -0.5 * 9.8 * 0.25 - 4.9 * 0.3 + 0.5 * 0.09];
    for (sample, expected) in found.samples()[1..].iter().zip(velocities) {
        let v = found.mean_velocity(sample);
        assert!((0..2).all(|i| (v[i] - expected[i]).abs() < 1e-8), "{v:?} {expected:?}");
    }
    let height = |number: usize| found.centre_of_mass(&found.samples()[number])[1] - y;
    assert!((0..2).all(|k| (height(k + 1) - fallen[k]).abs() < 1e-8));
    // potential energies -m g . x of the centre, before and after the jump at 0.5 s
    let before = mass * 9.8 * (y + fallen[0]);
    let after = -mass * (2.0 * x + y + fallen[0]);
    let supplied = found.samples()[2].energy.supplied - found.samples()[0].energy.supplied;
    assert!((supplied - (after - before)).abs() < 1e-8 * before.abs(), "{supplied}");
    assert_balanced(&found, 1e-6);
}

/// A mass on a spring whose other end is a point of space: as one whose other end is a node that is held
/// ([above](a_mass_on_a_spring_swings)), and turned round.
#[test]
fn a_mass_on_an_anchored_spring_swings() {
    let (k, m, f) = (20.0_f64, 0.03, -0.1);
    let mesh = Mesh::rectangle([0.03, 0.03], [2, 2], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).point_mass("bob", [0.14, 0.0], m);
    let spring = Spring::anchored("bob", [0.10, 0.0]).named("A1").stiffness(k);
    let phase = Phase::until(1.0).hold([1, 2, 3, 4]).actuate(["A1"], f);
    let scene = Scene::new(body.build().unwrap()).spring(spring).phase(phase);
    let omega = (k / m).sqrt();
    for method in Method::ALL {
        let sampling = Sampling::every(0.01)
            .sensor("pull", "N", |view, _| view.spring_pull("A1").unwrap_or(f64::NAN));
        let trajectory = scene.simulate(&fine(method), &sampling).unwrap();
        for sample in trajectory.samples() {
            let expected = f / k * (1.0 - (omega * sample.time).cos());
            let apart = (sample.u[8] - expected).abs();
            assert!(apart < 1e-5 * (f / k).abs(), "{method}: {apart:e} at {} s", sample.time);
            assert_eq!(sample.u[9], 0.0);
            let pull = k * sample.u[8] - f;
            assert!((sample.sensors[0] - pull).abs() < 1e-12, "{} {pull}", sample.sensors[0]);
        }
        assert_balanced(&trajectory, if method == Method::CentralDifference { 1e-5 } else { 1e-6 });
    }
    for (point, part) in [
        (vec![0.14, 0.0], "same place"),
        (vec![0.1], "2 coordinates"),
        (vec![0.1, f64::NAN], "finite"),
    ] {
        let spring = Spring::anchored("bob", point).named("A2");
        let error = scene.clone().spring(spring).validate().unwrap_err().to_string();
        assert!(error.contains("spring \"A2\"") && error.contains(part), "{error}");
    }
}

/// A spring that pulls a corner of a square through its diagonal turns cells inside out, which
/// Green strain does not survive. The run ends there and says so, instead of taking steps that are
/// too small to move time ahead.
#[test]
fn a_run_that_cannot_go_on_ends() {
    let mesh = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green);
    let scene = Scene::new(body.build().unwrap())
        .spring(Spring::between([1], [4]).named("A1").stiffness(20.0))
        .phase(Phase::until(1.0).named("crush").hold([2, 3, 4]).actuate(["A1"], -5e4));
    for method in Method::ALL {
        for rtol in [1e-3, 1e-6] {
            let settings = Settings { method, rtol, ..Settings::default() };
            let result = scene.simulate(&settings, &Sampling::phase_ends());
            let Err(Error::Integration(failure)) = &result else { panic!("{method}: {result:?}") };
            let message = failure.to_string();
            println!("{message}");
            assert!(message.contains("crush") && message.contains("is inverted"), "{message}");
            assert!(failure.trajectory.report().steps() < 100_000, "{message}");
        }
    }
}

/// A field that draws each node back to where it was, in proportion to its mass.
struct Trap {
    masses: Vec<f64>,
    omega: f64,
}

impl Trap {
    /// Mass (kg) times omega^2 of a component.
    fn stiffness(&self, dof: usize) -> f64 {
        self.masses[dof / 2] * self.omega.powi(2)
    }
}

impl Force for Trap {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let own = forces.conservative.iter_mut().zip(u).enumerate();
        own.for_each(|(dof, (f, u))| *f -= self.stiffness(dof) * u);
        Ok(())
    }

    fn add_tangents(
        &self,
        _t: f64,
        _u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        for node in 0..self.masses.len() {
            let block = stiffness.block_mut(node, node).unwrap();
            block[0] += self.stiffness(2 * node);
            block[3] += self.stiffness(2 * node);
        }
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        u.iter().enumerate().map(|(dof, u)| 0.5 * self.stiffness(dof) * u * u).sum()
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }
}

/// A force that is not of the crate: a body without strain swings in it as u = a cos(omega t).
#[test]
fn forces_of_other_crates_act() {
    let (omega, a) = (20.0, 0.01);
    let mesh = Mesh::rectangle([0.03, 0.03], [3, 3], Cells::Triangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let masses = body.nodal_masses().to_vec();
    let scene = Scene::new(body)
        .initial_displacement(|_| vec![a, 0.0])
        .force(Trap { masses, omega })
        .phase(Phase::until(1.0));
    for method in [Method::CvodeBdf, Method::Arkode, Method::Rk] {
        let settings = fine(method);
        let trajectory = scene.simulate(&settings, &Sampling::every(0.1)).unwrap();
        let error = |sample: &pliant::Sample| {
            let expected = a * (omega * sample.time).cos();
            sample.u.chunks(2).map(|u| (u[0] - expected).hypot(u[1])).fold(0.0, f64::max)
        };
        let worst = trajectory.samples().iter().map(error).fold(0.0, f64::max);
        println!("{method}: off by {worst:e} m");
        // three times what BDF, the least precise, is off by
        assert!(worst < 2e-7 * a, "{method}: {worst:e}");
        assert_balanced(&trajectory, 3e-7);
    }
}

/// Two traps: one acts where the first component is above 0, and one below it. The side is a switch.
struct Kinked {
    above: Trap,
    below: Trap,
    /// The switch as it is held, and as it has ever been held.
    held: Mutex<Option<bool>>,
    ever: Arc<Mutex<Vec<bool>>>,
}

impl Kinked {
    fn acting(&self, u: &[f64]) -> &Trap {
        let is_below = self.held.lock().unwrap().unwrap_or(u[0] <= 0.0);
        if is_below { &self.below } else { &self.above }
    }
}

impl Force for Kinked {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.acting(u).add_forces(t, u, v, forces)
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        self.acting(u).add_tangents(t, u, v, stiffness, damping)
    }

    fn potential(&self, t: f64, u: &[f64]) -> f64 {
        self.acting(u).potential(t, u)
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { switches: Some(self), ..Capabilities::default() }
    }
}

impl Switches for Kinked {
    fn switches(&self) -> usize {
        1
    }

    fn switch_values(&self, _t: f64, u: &[f64], _v: &[f64], values: &mut [f64]) {
        values[0] = u[0];
    }

    fn hold_switches(&self, on: Option<&[bool]>) {
        *self.held.lock().unwrap() = on.map(|on| on[0]);
        self.ever.lock().unwrap().extend(on.into_iter().flatten());
    }
}

/// The switch of a force that is not of the crate is held between the events at which it changes: a body without strain swings by
/// half periods of either side, a cos(omega t) above and -a/2 sin(2 omega t) below, where the trap is four times as stiff.
#[test]
fn switches_of_other_crates_are_held() {
    let (omega, a) = (20.0, 0.01);
    let mesh = Mesh::rectangle([0.03, 0.03], [3, 3], Cells::Triangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let trap = |omega| Trap { masses: body.nodal_masses().to_vec(), omega };
    let ever = Arc::new(Mutex::new(Vec::new()));
    let force = Kinked {
        above: trap(omega),
        below: trap(2.0 * omega),
        held: Mutex::new(None),
        ever: ever.clone(),
    };
    let scene = Scene::new(body.clone())
        .initial_displacement(|_| vec![a, 0.0])
        .force(force)
        .phase(Phase::until(0.5));
    let settings = Settings { contact_events: ContactEvents::Locate, ..fine(Method::CvodeBdf) };
    let trajectory = scene.simulate(&settings, &Sampling::every(0.02)).unwrap();
    let half = std::f64::consts::PI / omega;
    let expected = |t: f64| {
        // from the middle of a half period above on
        let t = (t + 0.5 * half) % (1.5 * half);
        match t < half {
            true => a * (omega * t).sin(),
            false => -0.5 * a * (2.0 * omega * (t - half)).sin(),
        }
    };
    let error = |sample: &pliant::Sample| (sample.u[0] - expected(sample.time)).abs();
    let worst = trajectory.samples().iter().map(error).fold(0.0, f64::max);
    let held = ever.lock().unwrap();
    println!("off by {worst:e} m, held {held:?}");
    // three times what was found, by the tolerance of the steps
    assert!(worst < 2e-7 * a, "{worst:e}");
    assert!(held.windows(2).filter(|pair| pair[0] != pair[1]).count() >= 3, "{held:?}");
    assert_eq!(trajectory.report().phases[0].counts.contact_events, 4);
}

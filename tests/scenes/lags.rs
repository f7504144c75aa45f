//! Actuators that lag behind their commands, against closed forms: springs, heat, the activation of muscles; commands, checkpoints, equilibria, and energy.

use std::path::Path;

use pliant::{
    Body, CellSelection, Cells, Error, Growth, Guide, Hill, Lag, Material, Mesh, Method, Muscle,
    Phase, Sampling, Scene, SceneFile, Settings, Signal, Spring, Statics, simulate::Reading,
};

const METHODS: [Method; 7] = [
    Method::CvodeBdf,
    Method::CvodeAdams,
    Method::Ida,
    Method::IdaIndexTwo,
    Method::Arkode,
    Method::Rosenbrock,
    Method::Rk,
];

const STIFFNESS: f64 = 50.0; // N/m
const MASS: f64 = 0.02; // kg

/// A mass on a spring, beside a bar that is held.
fn mass_on_spring() -> Scene {
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };
    let bar = Body::new(Mesh::bar(0.1, 2).unwrap(), rubber).area(1e-4);
    let body = bar.point_mass("bob", [0.3], MASS).build().unwrap();
    Scene::new(body).spring(Spring::between([2], "bob").named("coil").stiffness(STIFFNESS))
}

/// The displacement of that mass as the force on it nears `force` with the time constant `tau`.
fn swings(force: f64, tau: f64, t: f64) -> f64 {
    let omega = (STIFFNESS / MASS).sqrt();
    let product = omega * tau;
    let (sine, cosine) = (omega * t).sin_cos();
    let moved = product * product * (-t / tau).exp() + cosine + product * sine;
    force / STIFFNESS * (1.0 - moved / (1.0 + product * product))
}

/// A step of the command swings the mass as the closed form has it, by every method that has unknowns for the state; and energy is balanced.
#[test]
fn a_step_of_the_command_arrives_late() {
    let (force, tau) = (0.4, 0.03);
    let phase = Phase::until(0.5).hold([1, 2]).actuate(["coil"], force);
    let scene = mass_on_spring().lag(Lag::first_order(tau), ["coil"]).phase(phase);
    for method in METHODS {
        let settings = Settings { method, rtol: 1e-8, ..Settings::default() };
        let motion = scene.simulate(&settings, &Sampling::every(0.05)).unwrap();
        let mut off = 0.0_f64;
        for sample in motion.samples() {
            let state = force * (1.0 - (-sample.time / tau).exp());
            off = off.max((sample.amounts[0] - state).abs() / force);
            off =
                off.max((sample.u[2] - swings(force, tau, sample.time)).abs() * STIFFNESS / force);
        }
        let report = motion.report();
        let balance = report.energy_error / report.energy_scale;
        println!("{method}: off by {off:.1e}, energy by {balance:.1e}");
        assert!(off < 5e-6 && balance < 1e-5, "{method}: {off:e}, {balance:e}");
    }
}

/// What is heated nears P/loss and cools, with the time constant capacity/loss; in equilibrium it has come to rest, and shortens its spring by
/// per_kelvin P/(loss k).
#[test]
fn warmth_comes_and_goes() {
    let (capacity, loss, per_kelvin, power) = (0.2, 0.1, -0.02, 1.5);
    let tau = capacity / loss;
    let scene = mass_on_spring();
    let scene = scene
        .lag(Lag::heated(capacity, loss, per_kelvin), ["coil"])
        .phase(Phase::until(4.0).hold([1, 2]).actuate(["coil"], power))
        .phase(Phase::until(9.0).hold([1, 2]));
    let sampling = Sampling::every(0.5).read("warmth", Reading::temperature("coil"));
    let settings = Settings { rtol: 1e-7, ..Settings::default() };
    let motion = scene.simulate(&settings, &sampling).unwrap();
    let hot = power / loss * (1.0 - (-4.0 / tau).exp());
    for sample in motion.samples().iter().skip(1) {
        let warmth = match sample.time {
            t if t <= 4.0 => power / loss * (1.0 - (-t / tau).exp()),
            t => hot * (-(t - 4.0) / tau).exp(),
        };
        let off = (sample.sensors[0] - warmth).abs() * loss / power;
        println!("{} s: {warmth:.4} K, off by {off:.1e} of the most", sample.time);
        assert!(off < 1e-10, "{}: {off:e}", sample.time);
    }
    let rest = scene.equilibrium(&Statics::default()).unwrap();
    let shorter = per_kelvin * power / loss / STIFFNESS;
    let off = rest.trajectory().last().u[2] / shorter - 1.0;
    assert!(off.abs() < 1e-9, "{off:e}");
}

/// The time that Thelen's activation takes from 0 to a under an excitation, and from one to another without any, by the integrals of his equation.
#[test]
fn muscles_are_activated_as_by_thelen() {
    let (rise, fall, excited) = (0.015, 0.05, 0.6);
    let hill = Hill::new(2e5);
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };
    let bar = Body::new(Mesh::bar(0.1, 3).unwrap(), rubber).area(1e-4).build().unwrap();
    let held = |until: f64| Phase::until(until).hold("all");
    let scene = Scene::new(bar)
        .muscle(Muscle::along([1.0]).hill(hill).named("biceps"))
        .lag(Lag::activation(rise, fall), ["biceps"])
        .phase(held(0.04).actuate(["biceps"], excited * hill.largest))
        .phase(held(0.14));
    let to = |a: f64| rise * (-1.5 * a - (0.5 + 1.5 * excited) * (1.0 - a / excited).ln());
    let part = |a: f64| (a / (0.5 + 1.5 * a)).ln();
    let sampling = Sampling::every(0.01)
        .read("activation", Reading::activation("biceps"))
        .read("stress", Reading::muscle_stress("biceps"))
        .read("force", Reading::constraint_force("right"));
    for method in METHODS {
        let settings = Settings { method, rtol: 1e-7, ..Settings::default() };
        let motion = scene.simulate(&settings, &sampling).unwrap();
        let most = motion.samples()[4].sensors[0];
        let mut off = 0.0_f64;
        for sample in motion.samples().iter().skip(1) {
            let [a, stress, force] = [0, 1, 2].map(|number| sample.sensors[number]);
            let time = match sample.time {
                t if t < 0.045 => to(a) - t,
                t => 0.04 + fall / 0.5 * (part(most) - part(a)) - t,
            };
            off = off.max(time.abs());
            // held at the natural length, which is the best one
            assert!((stress / (a * hill.largest) - 1.0).abs() < 1e-9);
            assert!((force / (1e-4 * stress) - 1.0).abs() < 1e-6, "{force} {stress}");
        }
        println!("{method}: times off by {off:.1e} s");
        assert!(off < 1e-6, "{method}: {off:e}");
    }
}

/// A strip with a muscle, a swelling layer, a tendon on a winch and one with a tension.
fn strip() -> Scene {
    let mesh = Mesh::rectangle([0.1, 0.01], [11, 3], Cells::Rectangles9).unwrap();
    let material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 50.0 };
    let body = Body::new(mesh, material).thickness(0.01).plane(pliant::Plane::Stress);
    let upper = CellSelection::inside([0.0, 0.005], [0.1, 0.01]);
    let lower = CellSelection::inside([0.0, 0.0], [0.1, 0.005]);
    Scene::new(body.build().unwrap())
        .muscle(Muscle::along([1.0, 0.0]).within(upper).named("muscle"))
        .growth(Growth::within(lower).named("layer"))
        .spring(Spring::cable([Guide::point([-0.02, 0.0]), Guide::nodes([21])]).named("pull"))
        .spring(
            Spring::cable([Guide::point([-0.02, 0.01]), Guide::nodes([105])])
                .winch()
                .stiffness(50.0)
                .damping(0.1)
                .named("winch"),
        )
}

/// With a lag on each kind of actuator all methods find one motion, and what they supply is what the strip has and has lost.
#[test]
fn all_actuators_lag_alike() {
    let phase = Phase::until(0.1)
        .hold("left")
        .actuate(["muscle"], 5e3)
        .actuate(["layer"], Signal::function(|t| 0.02 * (40.0 * t).sin()))
        .actuate(["pull"], 0.02)
        .actuate(["winch"], 2e-3);
    let scene = strip()
        .lag(Lag::rise_and_fall(0.02, 0.05), ["muscle", "pull"])
        .lag(Lag::first_order(0.01), ["layer", "winch"])
        .phase(phase);
    let run = |method: Method, rtol: f64| {
        let settings = Settings { method, rtol, ..Settings::default() };
        scene.simulate(&settings, &Sampling::every(0.02)).unwrap()
    };
    let exact = run(Method::Arkode, 1e-8);
    let size = exact.last().u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let implicit =
        METHODS.into_iter().filter(|method| !matches!(method, Method::Rk | Method::CvodeAdams));
    for method in implicit {
        let motion = run(method, 1e-6);
        let off = motion.last().u.iter().zip(&exact.last().u);
        let off = off.map(|(u, exact)| (u - exact).abs()).fold(0.0, f64::max) / size;
        let report = motion.report();
        let balance = report.energy_error / report.energy_scale;
        let steps = report.steps();
        println!("{method}: off by {off:.1e}, energy by {balance:.1e}, {steps} steps");
        assert!(off < 5e-6 && balance < 2e-5, "{method}: {off:e} {balance:e}");
    }
}

/// A command changes what the state nears and not the state; checkpoints keep it, also in files, and a fork goes on from it.
#[test]
fn commands_and_checkpoints_keep_the_state() {
    let tau = 0.05;
    let scene = mass_on_spring()
        .lag(Lag::first_order(tau), ["coil"])
        .phase(Phase::until(1.0).hold([1, 2]).actuate(["coil"], 0.4));
    let settings = Settings { rtol: 1e-7, ..Settings::default() };
    let mut mass = scene.start(&settings).unwrap();
    mass.advance_to(0.1).unwrap();
    let reached = 0.4 * (1.0 - (-0.1_f64 / tau).exp());
    mass.actuate("coil", -0.2).unwrap();
    let view = mass.view();
    assert!((view.actuation("coil").unwrap() - reached).abs() < 1e-6);
    assert_eq!(view.command("coil").unwrap(), -0.2);
    let path = std::env::temp_dir().join(format!("pliant-lag-{}.json", std::process::id()));
    let kept = mass.checkpoint();
    kept.write(&path).unwrap();
    let mut fork = mass.fork().unwrap();
    let mut again = scene.start(&settings).unwrap();
    let read = again.read_checkpoint(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    again.restore(&read).unwrap();
    let expected = -0.2 + (reached + 0.2) * (-0.1_f64 / tau).exp();
    let states = [&mut mass, &mut fork, &mut again].map(|mass| {
        mass.advance_to(0.2).unwrap();
        mass.view().actuation("coil").unwrap()
    });
    for state in states {
        assert!((state - expected).abs() < 1e-6, "{state} {expected}");
    }
    mass.restore(&kept).unwrap();
    mass.advance_to(0.2).unwrap();
    assert_eq!(mass.view().actuation("coil").unwrap(), states[2]);
}

/// What cannot be is refused, by the method or before anything runs.
#[test]
fn nonsense_is_refused() {
    let hold = || Phase::until(0.1).hold([1, 2]);
    let with = |lag: Lag, name: &str| mass_on_spring().lag(lag, [name]).phase(hold());
    for (scene, told) in [
        (with(Lag::first_order(0.0), "coil"), "rise"),
        (with(Lag::rise_and_fall(0.1, f64::NAN), "coil"), "fall"),
        (with(Lag::heated(1.0, -1.0, 1.0), "coil"), "loss"),
        (with(Lag::heated(1.0, 1.0, 0.0), "coil"), "its warmth does nothing"),
        (with(Lag::activation(0.01, 0.04), "coil"), "Hill's law"),
        (with(Lag::first_order(0.1), "coal"), "\"coil\""),
        (with(Lag::first_order(0.1), "coil").lag(Lag::first_order(0.2), ["coil"]), "coil"),
    ] {
        let error = scene.validate().unwrap_err().to_string();
        println!("{error}");
        assert!(error.contains(told), "{error}");
    }
    let scene = with(Lag::first_order(0.1), "coil");
    let settings = Settings { method: Method::CentralDifference, ..Settings::default() };
    let error = scene.simulate(&settings, &Sampling::phase_ends()).unwrap_err();
    assert!(error.to_string().contains("that lag"), "{error}");
    let scene = mass_on_spring().lag(Lag::first_order(0.1), ["coil"]);
    let scene = scene.phase(hold().actuate_with(["coil"], |t| 1.0 / (0.05 - t).max(0.0)));
    let error = scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap_err();
    assert!(matches!(error, Error::Integration(_)), "{error}");
    assert!(error.to_string().contains("actuation of \"coil\" is inf"), "{error}");
}

/// Scene files say the same.
#[test]
fn files_have_lags() {
    let read = |lag: &str, actuate: &str| {
        let text = format!(
            r#"
            [body]
            mesh = {{ kind = "bar", length = 0.1, nodes = 3 }}
            material = {{ density = 1000.0, young = 1.0e5, poisson = 0.3, viscosity = 0.0 }}
            area = 1e-4
            [[muscle]]
            name = "biceps"
            along = [1.0]
            hill = {{ largest = 2e4 }}
            [[lag]]
            actuators = "biceps"
            {lag}
            [[phase]]
            until = 0.1
            hold = [{{ nodes = "left" }}]
            actuate = [{actuate}]
            "#
        );
        SceneFile::parse(&text, Path::new("lag.toml"))
    };
    let stress = "{ muscles = \"biceps\", stress = 1e4 }";
    let power = "{ heated = \"biceps\", power = 1.0 }";
    let lag = |scene: &SceneFile| format!("{:?}", scene.scene.lags().collect::<Vec<_>>());
    for (keys, actuate, expected) in [
        ("time = 0.1", stress, Lag::first_order(0.1)),
        ("rise = 0.1\nfall = 0.2", stress, Lag::rise_and_fall(0.1, 0.2)),
        ("rise = 0.1\nfall = 0.2\nactivation = true", stress, Lag::activation(0.1, 0.2)),
        ("capacity = 1.0\nloss = 2.0\nper_kelvin = 30.0", power, Lag::heated(1.0, 2.0, 30.0)),
    ] {
        let scene = read(keys, actuate).unwrap();
        assert_eq!(lag(&scene), format!("{:?}", [("biceps", &expected)]));
    }
    for (keys, actuate, told) in [
        ("time = 0.1\nactivation = true", stress, "rise and a fall"),
        ("time = 0.1\nfall = 0.2", stress, "time"),
        ("rise = 0.1", stress, "fall"),
        ("time = 0.1", power, "biceps"),
        ("capacity = 1.0\nloss = 2.0\nper_kelvin = 30.0", stress, "give a power"),
        ("time = -1.0", stress, "above 0"),
    ] {
        let error = read(keys, actuate).unwrap_err().to_string();
        println!("{error}\n");
        assert!(error.contains(told), "{error}");
    }
}

/// The finger on coiled threads, warmed up slowly, is where statics has it under the same warmth but for what viscosity and mass hold back; a thread that cools
/// holds it back longer.
#[test]
fn a_finger_follows_its_threads() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/coiled-finger.toml");
    let file = SceneFile::read(path).unwrap();
    let motion = file.scene.simulate(&file.settings, &file.output.sampling()).unwrap();
    assert_eq!(motion.report().warnings(), Vec::<String>::new());
    let warm = motion.samples().iter().find(|sample| sample.time >= 8.0).unwrap();
    let power = 0.12 * warm.sensors[0];
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.replace("\"upper\", power = 6.0", &format!("\"upper\", power = {power}"));
    let scene = SceneFile::parse(&text, Path::new(path)).unwrap().scene;
    let rest = scene.equilibrium(&Statics::default()).unwrap();
    let tip = 2 * 83 + 1;
    let off = warm.u[tip] / rest.trajectory().last().u[tip] - 1.0;
    println!("{} K, {} deg: off by {off:.1e}", warm.sensors[0], warm.sensors[2]);
    assert!(off.abs() < 5e-4, "{off:e}");
}

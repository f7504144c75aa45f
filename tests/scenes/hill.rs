//! Hill's law of muscles against closed forms: the force of fibres that are stretched and shortened by prescribed motions, the speed at which a load is lifted,
//! and the balance of energy.

use std::path::Path;

use pliant::{
    Axis, Body, CellSelection, Cells, Error, Hill, Material, Mesh, Method, Muscle, Phase, Sampling,
    Scene, SceneFile, Settings, Signal, simulate::Reading,
};

const LENGTH: f64 = 0.1; // m
const YOUNG: f64 = 1e5; // Pa
const AREA: f64 = 1e-4; // m^2

fn bar(young: f64, density: f64) -> Body {
    let material = Material { density, young, poisson: 0.3, viscosity: 0.0 };
    Body::new(Mesh::bar(LENGTH, 3).unwrap(), material).area(AREA).build().unwrap()
}

/// A bar is stretched, held, shortened and held by its ends and its middle, so that its stretch and the rate of that are known. The force that holds it is that
/// of St. Venant and Kirchhoff's law plus s f_l f_v, of which f_v solves Hill's equation (P + a)(v + b) = (P_0 + a) b where
/// the fibres shorten, and Thelen's for those that lengthen, by bisection.
#[test]
fn the_force_is_that_of_length_and_speed() {
    let hill = Hill { optimal: 1.1, width: 0.3, rate: 4.0, ..Hill::new(2e5) };
    let (young, stress) = (1e5, 1.5e5);
    let bar = bar(young, 1000.0);
    let mut scene = Scene::new(bar).muscle(Muscle::along([1.0]).hill(hill));
    // rates of the stretch (1/s)
    let rates = [2.0, 0.0, -3.0, 0.0, -5.0];
    let (mut until, mut stretch, mut expected) = (0.0, 1.0, Vec::new());
    for rate in rates {
        until += 0.1;
        stretch += 0.1 * rate;
        let phase = Phase::until(until).hold("left").actuate(["muscle 1"], stress);
        let phase = phase.move_axis([2], Axis::X, 0.5 * LENGTH * rate);
        scene = scene.phase(phase.move_axis("right", Axis::X, LENGTH * rate));
        let speed = rate / (hill.optimal * hill.rate);
        // P in P_0 at the speed V in fastest speeds, by the equations of both hyperbolas
        let wrong = |p: f64| match speed < 0.0 {
            true => (p + hill.shape) * (hill.shape - speed) - (1.0 + hill.shape) * hill.shape,
            // V (1 + 1/shape) (eccentric - p) = (p - 1) (eccentric - 1)
            false => {
                let slope = (1.0 + 1.0 / hill.shape) * (hill.eccentric - p);
                (p - 1.0) * (hill.eccentric - 1.0) - speed * slope
            }
        };
        let (mut low, mut high) = (0.0, hill.eccentric);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if wrong(middle) < 0.0 { low = middle } else { high = middle }
        }
        // faster than the fastest there is no pull
        let of_speed = if speed < -1.0 { 0.0 } else { low };
        let off: f64 = stretch / hill.optimal - 1.0;
        let pull = stress * (-off * off / hill.width).exp() * of_speed;
        expected.push((pull, 0.5 * young * (stretch.powi(3) - stretch) + pull));
    }
    let sampling = Sampling::phase_ends()
        .read("pull", Reading::muscle_stress("muscle 1"))
        .read("force", Reading::constraint_force("right"));
    let motion = scene.simulate(&Settings::default(), &sampling).unwrap();
    let ends = &motion.samples()[motion.samples().len() - rates.len()..];
    for ((sample, (pull, section)), rate) in ends.iter().zip(expected).zip(rates) {
        let [off, of_force] =
            [sample.sensors[0] - pull, sample.sensors[1] / AREA - section].map(|x| x / stress);
        println!("rate {rate}/s: {pull} Pa, off by {off:.1e}, the force by {of_force:.1e}");
        // round-off in the velocities of nodes that are held
        assert!(off.abs() < 1e-9 && of_force.abs() < 1e-9, "{rate}: {off:e}, {of_force:e}");
    }
}

/// A muscle without length dependence (a wide f_l), mass or elasticity to speak of lifts a load P at the speed of Hill's hyperbola, V = (1 - P)/(1 + P/shape) in
/// fastest speeds; under a load above the largest it gives way as the other hyperbola says.
#[test]
fn loads_are_lifted_at_the_speed_of_hill() {
    let hill = Hill { width: 1e12, rate: 2.0, ..Hill::new(1e5) };
    let bar = bar(1.0, 1e-3);
    for part in [0.2, 0.5, 0.9, 1.2] {
        let phase = Phase::until(0.1).hold("left").actuate(["muscle 1"], hill.largest);
        let phase = phase.load("right", [part * hill.largest * AREA]);
        let scene = Scene::new(bar.clone()).muscle(Muscle::along([1.0]).hill(hill)).phase(phase);
        let sampling = Sampling::phase_ends().read("v", Reading::velocity("right"));
        let motion = scene.simulate(&Settings::default(), &sampling).unwrap();
        let speed = -motion.last().sensors[0] / (LENGTH * hill.rate);
        let expected = match part < 1.0 {
            true => (1.0 - part) / (1.0 + part / hill.shape),
            false => {
                let (most, slope) = (hill.eccentric - 1.0, 1.0 + 1.0 / hill.shape);
                -(part - 1.0) * most / (slope * (hill.eccentric - part))
            }
        };
        let off = speed / expected - 1.0;
        println!("{part} of the largest stress: speed {speed}, off by {off:.1e}");
        // the elasticity of 1 Pa
        assert!(off.abs() < 1e-5, "{part}: {speed} and {expected}");
    }
}

/// A strip that swings under a muscle whose signal changes: what it supplies, less where it is stretched, is what the strip has and has lost to viscosity, whatever
/// the integrator; and all of them find the same motion. Without its law the muscle bends the strip more.
#[test]
fn the_balance_closes() {
    let mesh = Mesh::rectangle([0.1, 0.01], [11, 3], Cells::Rectangles9).unwrap();
    let material = Material { density: 1000.0, young: YOUNG, poisson: 0.3, viscosity: 50.0 };
    let body = Body::new(mesh, material).thickness(0.01).build().unwrap();
    let upper = CellSelection::inside([0.0, 0.005], [0.1, 0.01]);
    let hill = Hill { rate: 1.0, ..Hill::new(2e4) };
    let stress = || Signal::function(|t| 1e4 * (1.0 - (20.0 * t).cos()));
    let scene = |muscle: Muscle| {
        let muscle = muscle.within(upper.clone()).named("upper");
        let phase = Phase::until(0.15).hold("left").actuate(["upper"], stress());
        Scene::new(body.clone()).muscle(muscle).phase(phase)
    };
    let tip = 2 * (21 * 5 - 1) + 1;
    let run = |muscle: Muscle, method: Method| {
        // at 1e-6 the balance of BDF, by its first steps, is off by 3e-6 to 4e-5, as it happens
        let settings = Settings { method, rtol: 1e-7, ..Settings::default() };
        scene(muscle).simulate(&settings, &Sampling::phase_ends()).unwrap()
    };
    let along = || Muscle::along([1.0, 0.0]);
    let [free, held] = [along(), along().hill(hill)].map(|muscle| run(muscle, Method::CvodeBdf));
    let more = free.last().u[tip] / held.last().u[tip];
    println!("the tip at {} m, without the law {more} times as far", held.last().u[tip]);
    assert!(more > 1.2, "{more}");
    // explicit ones would take steps by the damping of the muscle
    for method in [Method::CvodeBdf, Method::Arkode, Method::Rosenbrock] {
        let motion = run(along().hill(hill), method);
        let energy = motion.last().energy;
        let off = energy.balance() / energy.supplied;
        let apart = motion.last().u[tip] / held.last().u[tip] - 1.0;
        println!("{method}: supplied {} J, off by {off:.1e}, {apart:.1e}", energy.supplied);
        assert!(off.abs() < 2e-5 && apart.abs() < 2e-6, "{method}: {off:e} {apart:e}");
    }
}

/// The scene of the page says what it shows: without the law the strip swings about its last length, with it there is one way to it from the largest.
#[test]
fn the_scene_of_the_page() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/hill-muscle.toml");
    let file = SceneFile::read(path).unwrap();
    let motion = file.scene.simulate(&file.settings, &file.output.sampling()).unwrap();
    assert_eq!(motion.report().warnings(), Vec::<String>::new());
    let of = |at: usize| -> Vec<f64> { motion.samples().iter().map(|s| s.sensors[at]).collect() };
    let [hill, plain, of_hill, of_plain] = [0, 1, 2, 3].map(of);
    let least = plain.iter().copied().fold(f64::INFINITY, f64::min);
    let last = hill.len() - 1;
    println!("plain {} at the end and {least}, by Hill {}", plain[last], hill[last]);
    assert!(least < plain[last] - 0.01, "{least}");
    let top = (0..=last).max_by(|a, b| hill[*a].total_cmp(&hill[*b])).unwrap();
    assert!(hill[top..].is_sorted_by(|a, b| a >= b) && hill[last] > plain[last]);
    assert!(of_hill[last] < of_plain[last]);
}

/// Numbers that are none of the law, and stresses beyond the largest, are refused: before a run, by a command, and at the time at which a signal has them.
#[test]
fn laws_and_stresses_that_cannot_be() {
    let usual = Hill::new(1e5);
    let scene = |hill: Hill, stress: Signal| {
        let phase = Phase::until(0.1).hold("left").actuate(["m"], stress);
        let muscle = Muscle::along([1.0]).hill(hill).named("m");
        Scene::new(bar(1e5, 1000.0)).muscle(muscle).phase(phase)
    };
    let says = |error: Error, part: &str| assert!(error.to_string().contains(part), "{error}");
    for (hill, part) in [
        (Hill::new(-1.0), "muscle \"m\" hill.largest = -1"),
        (Hill { optimal: 0.0, ..usual }, "muscle \"m\" hill.optimal = 0"),
        (Hill { width: f64::NAN, ..usual }, "muscle \"m\" hill.width = NaN"),
        (Hill { rate: 0.0, ..usual }, "muscle \"m\" hill.rate = 0"),
        (Hill { shape: -0.25, ..usual }, "muscle \"m\" hill.shape = -0.25"),
        (Hill { eccentric: 1.0, ..usual }, "muscle \"m\" hill.eccentric = 1 "),
    ] {
        says(scene(hill, 0.0.into()).validate().unwrap_err().into(), part);
    }
    for stress in [-1.0, 1.1e5] {
        let part = format!("muscle \"m\" stress = {stress} Pa");
        says(scene(usual, stress.into()).validate().unwrap_err().into(), &part);
    }
    let text = |hill: &str| {
        format!(
            "[body]\nmesh = {{ kind = \"bar\", length = 0.1, nodes = 3 }}\narea = 1e-4\n\
             material = {{ density = 1e3, young = 1e5, poisson = 0.3, viscosity = 1.0 }}\n\
             [[muscle]]\nalong = [1.0]\nhill = {{ {hill} }}\n[[phase]]\nuntil = 0.1\n"
        )
    };
    let read = |hill: &str| SceneFile::parse(&text(hill), Path::new("h.toml"));
    let given =
        "largest = 1e5, optimal = 1.0, width = 0.45, rate = 10.0, shape = 0.25, eccentric = 1.4";
    for keys in ["largest = 1e5", given] {
        assert_eq!(read(keys).unwrap().scene.muscles()[0].law(), Some(&usual));
    }
    says(read("rate = 5.0").unwrap_err(), "largest");
    says(read("largest = 1e5, shape = 0.0").unwrap_err(), "muscle.hill.shape: 0.0 cannot be used");
    says(read("largest = 1e5, widht = 1.0").unwrap_err(), "did you mean \"width\"");
    let mut driven = scene(usual, 1e5.into()).start(&Settings::default()).unwrap();
    says(driven.actuate("m", 2e5).unwrap_err(), "from 0 to 100000 Pa");
    driven.actuate("m", 5e4).unwrap();
    says(driven.actuate("m", -1.0).unwrap_err(), "muscle \"m\" stress = -1 Pa");
    let late = scene(usual, Signal::formula("3e6*t").unwrap());
    let error = late.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap_err();
    says(error, "s muscle \"m\" stress = 1");
}

//! Gas in chambers and through orifices: against closed forms, and one method against another.

use std::f64::consts::FRAC_PI_2;

use pliant::simulate::Reading;
use pliant::{
    Axis, Body, Cells, Chamber, Error, Gas, Material, Mesh, Method, Orifice, Phase, Sampling,
    Scene, Settings, Signal, Statics, Strain,
};

use crate::common::{column, settings};

/// rho_0 (kg/m^3) and R T (J/kg) of the reference air.
const DENSITY: f64 = 1.185;
const RT: f64 = 1e5 / DENSITY;
const OUTSIDE: f64 = 101_325.0;
/// Volume (m^3) and base (m^2) of a cylinder, and half of the mass (kg) of its piston.
pub(super) const VOLUME: f64 = 1e-3;
pub(super) const BASE: f64 = 1e-2;
pub(super) const HALF: f64 = 0.5;

/// Cylinders, 0.1 m wide, high and thick, on blocks that do not move, with two point masses as pistons on each.
pub(super) fn cylinders(count: usize) -> Scene {
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
    let block = |number: usize| {
        let x = number as f64;
        let mesh = Mesh::rectangle([0.1, 0.01], [2, 2], Cells::Rectangles).unwrap();
        let body = Body::new(mesh.translated(&[x, 0.0]).unwrap(), rubber).thickness(0.1);
        let body = body.point_mass("left piston", [x, 0.11], HALF);
        body.point_mass("right piston", [x + 0.1, 0.11], HALF)
            .named(format!("{number}"))
            .build()
            .unwrap()
    };
    let body = match count {
        1 => block(0),
        _ => Body::join((0..count).map(block)).unwrap(),
    };
    (0..count).fold(Scene::new(body), |scene, number| {
        let first = 6 * number;
        scene.chamber(
            Chamber::within(format!("{number}"), [3, 4, 6, 5].map(|node| first + node))
                .thickness(0.1),
        )
    })
}

/// A phase in which pistons are free to rise or held.
pub(super) fn phase(until: f64, is_free: bool, count: usize) -> Phase {
    (0..count).fold(Phase::until(until), |phase, number| {
        let at = |node: usize| 6 * number + node;
        let phase = phase.hold([1, 2, 3, 4].map(at)).hold_axes([5, 6].map(at), [Axis::X]);
        if is_free { phase } else { phase.hold_axes([5, 6].map(at), [Axis::Y]) }
    })
}

fn worst(found: &[f64], expected: impl Fn(usize) -> f64) -> f64 {
    let apart = |(k, found): (usize, &f64)| (found / expected(k) - 1.0).abs();
    found.iter().enumerate().map(apart).fold(0.0, f64::max)
}

/// A piston on gas that is closed in has the frequency sqrt(n p_0 A^2/(V_0 m)) of small vibrations. A large one has the speeds that
/// follow from its energy, whose sum stays.
#[test]
fn a_piston_on_gas_is_a_spring() {
    for exponent in [1.0, 1.4] {
        let scene = cylinders(1)
            .gas(Gas::in_chamber("0").pressure(OUTSIDE).exponent(exponent))
            .initial_velocity(|x| vec![0.0, if x[1] > 0.1 { -2.0 } else { 0.0 }])
            .phase(phase(0.2, true, 1));
        let mass = 2.0 * HALF;
        let expected = (exponent * OUTSIDE * BASE * BASE / (VOLUME * mass)).sqrt();
        let found = scene.spectrum().unwrap()[0].lowest_frequency.unwrap();
        println!("n = {exponent}: {found} rad/s, {expected}");
        // as far as the spectrum is iterated
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        for method in [Method::CvodeBdf, Method::Arkode, Method::CentralDifference] {
            let sampling = Sampling::every(1e-3).read("volume", Reading::chamber_volume("0"));
            let motion = scene.simulate(&settings(method, 1e-6), &sampling).unwrap();
            let stored = |volume: f64| {
                let ratio: f64 = VOLUME / volume;
                let gas = match exponent {
                    1.0 => ratio.ln(),
                    n => (ratio.powf(n - 1.0) - 1.0) / (n - 1.0),
                };
                OUTSIDE * (VOLUME * gas + volume - VOLUME)
            };
            let first = 0.5 * mass * 4.0;
            let volumes = column(&motion, 0);
            let least = volumes.iter().copied().fold(f64::INFINITY, f64::min);
            let apart = volumes.iter().zip(motion.samples()).map(|(&volume, sample)| {
                let kinetic = HALF * sample.v[11] * sample.v[11];
                ((stored(volume) + kinetic) / first - 1.0).abs()
            });
            let apart = apart.fold(0.0, f64::max);
            let drift = motion.samples().iter().map(|s| (s.energy.balance() / first - 1.0).abs());
            let drift = drift.fold(0.0, f64::max);
            println!(
                "{method}: least volume {least:e}, energies off by {apart:e}, balance {drift:e}"
            );
            assert!(least < 0.85 * VOLUME);
            // measured: up to 2.7e-4
            assert!(apart < 5e-4 && drift < 5e-4, "{method}: {apart:e} {drift:e}");
        }
    }
}

/// A rigid vessel is filled from a supply of 6 bar: at first the flow is choked and the pressure rises along a line; with x =
/// (p/p_1 - b)/(1 - b) it then is x = sin(k (t - t_b)), k = C p_0/(V (1 - b)), up to where the flow becomes laminar.
#[test]
fn a_vessel_is_filled_in_time() {
    let (supply, conductance, ratio) = (6e5, 5e-9, 0.3);
    let rise = conductance * 1e5 / VOLUME; // of p/p_1 (1/s)
    let begin = (ratio - OUTSIDE / supply) / rise;
    let k = rise / (1.0 - ratio);
    let pressure = |t: f64| match t {
        t if t < begin => OUTSIDE / supply + rise * t,
        t => ratio + (1.0 - ratio) * (k * (t - begin)).sin(),
    };
    let end = begin + 0.9 * FRAC_PI_2 / k;
    let scene = cylinders(1)
        .gas(Gas::in_chamber("0"))
        .supply("pump", supply)
        .orifice(Orifice::new("valve", "pump", "0", conductance).critical_ratio(ratio))
        .phase(phase(end, false, 1));
    let sampling = Sampling::every(end / 50.0)
        .read("p", Reading::absolute_pressure("0"))
        .read("gauge", Reading::pressure("0"))
        .read("m", Reading::gas_amount("0"))
        .read("q", Reading::gas_flow("valve"));
    for (method, rtol, tolerance) in [
        (Method::CvodeBdf, 1e-7, 2e-6),
        (Method::CvodeAdams, 1e-7, 2e-6),
        (Method::Arkode, 1e-7, 3e-6),
        (Method::Ida, 1e-7, 1e-5),
        (Method::Rosenbrock, 1e-7, 5e-7),
        (Method::Rk, 1e-7, 5e-6),
    ] {
        let motion = scene.simulate(&settings(method, rtol), &sampling).unwrap();
        let times: Vec<f64> = motion.samples().iter().map(|sample| sample.time).collect();
        let apart = worst(&column(&motion, 0), |n| supply * pressure(times[n]));
        println!("{method}: off by {apart:e} in {} steps", motion.report().steps());
        assert!(apart < tolerance, "{method}: {apart:e}");
        let [p, gauge, m, q] = [0, 1, 2, 3].map(|k| column(&motion, k));
        assert!(worst(&gauge, |n| p[n] - OUTSIDE) < 1e-12);
        assert!(worst(&m, |n| p[n] * VOLUME / RT) < 1e-12);
        assert!((q[0] / (conductance * DENSITY * supply) - 1.0).abs() < 1e-12);
    }
}

/// Two vessels come to one pressure, through an orifice that is laminar in the end, and what left one is in the other; as much
/// energy as was free is lost.
#[test]
fn vessels_come_to_balance() {
    let scene = cylinders(2)
        .gas(Gas::in_chamber("0").pressure(5e5))
        .gas(Gas::in_chamber("1").pressure(2e5))
        .orifice(Orifice::new("between", "0", "1", 1e-8))
        .phase(phase(10.0, false, 2));
    let sampling = Sampling::every(0.5)
        .read("p 0", Reading::absolute_pressure("0"))
        .read("p 1", Reading::absolute_pressure("1"))
        .read("m 0", Reading::gas_amount("0"))
        .read("m 1", Reading::gas_amount("1"));
    for method in [Method::CvodeBdf, Method::Arkode, Method::Rosenbrock, Method::Ida] {
        let motion = scene.simulate(&settings(method, 1e-6), &sampling).unwrap();
        let [p0, p1, m0, m1] = [0, 1, 2, 3].map(|k| column(&motion, k));
        println!("{method}: {} and {} Pa in {} steps", p0[20], p1[20], motion.report().steps());
        assert!((p0[20] / 3.5e5 - 1.0).abs() < 1e-6 && (p1[20] / 3.5e5 - 1.0).abs() < 1e-6);
        let all = m0[0] + m1[0];
        assert!(m0.iter().zip(&m1).all(|(a, b)| ((a + b) / all - 1.0).abs() < 1e-12));
        // R T (m_0 ln(p_0/p) + m_1 ln(p_1/p)) is what was lost; it counts as taken out with the gas
        let lost = VOLUME * (5e5 * (5.0_f64 / 3.5).ln() + 2e5 * (2.0_f64 / 3.5).ln());
        let [first, last] = [&motion.samples()[0], motion.last()].map(|sample| sample.energy);
        let stored = last.springs - first.springs;
        println!("stored {stored} J, supplied {} J, {lost}", last.supplied);
        // kinetic energies are tolerances alone
        assert!((stored / lost + 1.0).abs() < 1e-6, "{stored} {lost}");
        assert!((last.supplied / lost + 1.0).abs() < 1e-3, "{} {lost}", last.supplied);
    }
}

/// A ring of rubber that is blown up by a valve and let down again, as a scene of its own.
fn ring() -> Scene {
    let mesh = Mesh::ring(0.02, 0.03, [16, 3], Cells::Rectangles).unwrap();
    let rubber = Material { density: 1000.0, young: 2e5, poisson: 0.4, viscosity: 200.0 };
    let body = Body::new(mesh, rubber).thickness(0.02).strain(Strain::Green).build().unwrap();
    Scene::new(body)
        .chamber(Chamber::within("air", "inner"))
        .gas(Gas::in_chamber("air").exponent(1.4))
        .supply("pump", Signal::ramp(OUTSIDE, 1.1e5, 0.0, 0.02))
        .orifice(Orifice::new("in", "pump", "air", 2e-8))
        .orifice(Orifice::new("leak", "air", "atmosphere", 2e-9))
        .phase(Phase::until(0.06).hold([1]))
        .phase(Phase::until(0.1).hold([1]).open("in", Signal::ramp(1.0, 0.0, 0.06, 0.01)))
}

fn readings() -> Sampling {
    Sampling::every(0.005)
        .read("volume", Reading::chamber_volume("air"))
        .read("pressure", Reading::pressure("air"))
        .read("amount", Reading::gas_amount("air"))
}

/// By every method that has unknowns for amounts the motion is the same; the others say which have.
#[test]
fn methods_agree_on_a_ring_that_is_blown_up() {
    let run = |method, rtol| ring().simulate(&settings(method, rtol), &readings()).unwrap();
    let truth = run(Method::Arkode, 1e-9);
    let scales: Vec<f64> = (0..3)
        .map(|k| column(&truth, k).iter().fold(0.0_f64, |most, x| most.max(x.abs())))
        .collect();
    println!("up to {scales:?}");
    for method in Method::ALL {
        if method == Method::CentralDifference {
            let refused = ring().simulate(&settings(method, 1e-4), &readings()).unwrap_err();
            assert!(refused.to_string().contains("amounts of gas"), "{refused}");
            continue;
        }
        let motion = run(method, 1e-6);
        let apart = (0..3).map(|k| {
            let [found, expected] = [&motion, &truth].map(|motion| column(motion, k));
            let apart = found.iter().zip(&expected).map(|(a, b)| (a - b).abs());
            apart.fold(0.0, f64::max) / scales[k]
        });
        let apart = apart.fold(0.0, f64::max);
        let error = motion.report().energy_error;
        println!(
            "{method}: off by {apart:e}, {} steps, energy error {error:e}",
            motion.report().steps()
        );
        // measured: up to 6e-6, by BDF
        assert!(apart < 2e-5, "{method}: {apart:e}");
    }
}

/// A chamber with a shut orifice moves as one without; where the amount is a constant, in equilibria, the chamber comes to rest where
/// the motion does.
#[test]
fn a_shut_orifice_is_a_closed_chamber() {
    let closed = || {
        let mesh = Mesh::ring(0.02, 0.03, [16, 3], Cells::Rectangles).unwrap();
        let rubber = Material { density: 1000.0, young: 2e5, poisson: 0.4, viscosity: 200.0 };
        let body = Body::new(mesh, rubber).thickness(0.02).strain(Strain::Green).build().unwrap();
        Scene::new(body)
            .chamber(Chamber::within("air", "inner"))
            .gas(Gas::in_chamber("air").pressure(1.2e5))
    };
    let hold = || Phase::until(0.05).hold([1, 2]);
    let shut = closed().orifice(Orifice::new("valve", "air", "atmosphere", 1e-8));
    let run = |scene: Scene, method| scene.simulate(&settings(method, 1e-8), &readings()).unwrap();
    let shut = run(shut.phase(hold().open("valve", 0.0)), Method::Arkode);
    let scene = closed().phase(hold());
    let closed = run(scene.clone(), Method::Ida);
    let apart = closed.samples().iter().zip(shut.samples()).flat_map(|(a, b)| a.u.iter().zip(&b.u));
    let apart = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!(
        "apart by {apart:e} m, {} and {} steps",
        closed.report().steps(),
        shut.report().steps()
    );
    // measured: 6.6e-11, of 3e-3
    assert!(apart < 5e-10, "{apart:e}");
    let [first, second] = [&shut, &closed].map(|motion| column(motion, 2));
    assert!(worst(&first, |n| second[n]) < 1e-12);
    let rest = scene.equilibrium(&Statics::default()).unwrap();
    let damped = run(scene.lasting(3.0), Method::CvodeBdf);
    let apart = rest.displacements().iter().zip(&damped.last().u).map(|(a, b)| (a - b).abs());
    let apart = apart.fold(0.0, f64::max);
    println!("at rest apart by {apart:e} m");
    // measured: 1.5e-12, what is left of the motion after 3 s
    assert!(apart < 1e-11, "{apart:e}");
}

/// Commands open and shut valves; a checkpoint goes on bit by bit.
#[test]
fn valves_are_commanded() {
    let scene = ring();
    let mut ring = scene.start(&settings(Method::Arkode, 1e-5)).unwrap();
    ring.advance_to(0.03).unwrap();
    ring.open("in", 0.0).unwrap();
    let kept = ring.checkpoint();
    let full = ring.view().gas_amount("air").unwrap();
    let go_on = |ring: &mut pliant::Simulation| {
        ring.advance_to(0.05).unwrap();
        (ring.view().gas_amount("air").unwrap(), ring.view().displacements().to_vec())
    };
    ring.restore(&kept).unwrap();
    let first = go_on(&mut ring);
    // by the leak alone
    assert!(first.0 < full && ring.view().gas_flow("in").unwrap() == 0.0);
    assert_eq!(ring.view().opening("in").unwrap(), 0.0);
    ring.restore(&kept).unwrap();
    assert_eq!(go_on(&mut ring), first);
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("gas.json");
    kept.write(&file).unwrap();
    let mut other = scene.start(&settings(Method::Arkode, 1e-5)).unwrap();
    let read = other.read_checkpoint(&file).unwrap();
    other.restore(&read).unwrap();
    assert_eq!(go_on(&mut other), first);
    ring.open("in", 0.5).unwrap();
    ring.advance_to(0.055).unwrap();
    assert!(ring.view().gas_amount("air").unwrap() > first.0);
    let wrong = ring.open("in", 1.5).unwrap_err().to_string();
    assert!(wrong.contains("from 0 (shut) to 1"), "{wrong}");
    let wrong = ring.open("inn", 1.0).unwrap_err().to_string();
    assert!(wrong.contains("did you mean \"in\""), "{wrong}");
}

/// What is no gas and no orifice is told, by name, value and mend, before anything is computed.
#[test]
fn mistakes_are_named() {
    let with = |scene: Scene, phase: Phase| match scene.phase(phase).validate() {
        Err(error) => error.to_string(),
        Ok(()) => panic!("it is taken"),
    };
    let one = || cylinders(1).gas(Gas::in_chamber("0")).supply("pump", 2e5);
    let free = || phase(1.0, true, 1);
    let orifice = |conductance| Orifice::new("valve", "pump", "0", conductance);
    for (scene, phase, words) in [
        (cylinders(1).gas(Gas::in_chamber("1")), free(), "chamber of gas"),
        (cylinders(1).gas(Gas::in_chamber("0").pressure(0.0)), free(), "pressure = 0"),
        (cylinders(1).gas(Gas::in_chamber("0").exponent(-1.0)), free(), "exponent = -1"),
        (one().gas(Gas::in_chamber("0")), free(), "it is taken"),
        (one(), free().pressure("0", 1e3), "the gas in it has a pressure of its own"),
        (one().atmosphere(-1.0), free(), "atmosphere = -1"),
        (one().orifice(orifice(0.0)), free(), "conductance = 0"),
        (one().orifice(orifice(-1e-9)), free(), "conductance = -0.000000001"),
        (one().orifice(orifice(1e-9).critical_ratio(1.0)), free(), "critical_ratio = 1"),
        (one().orifice(Orifice::nozzle("valve", "pump", "0", 0.0)), free(), "area = 0"),
        (
            one().orifice(Orifice::nozzle("valve", "pump", "0", 1e-6).discharge(1.1)),
            free(),
            "discharge = 1.1",
        ),
        (one().orifice(orifice(1e-9)).orifice(orifice(1e-9)), free(), "orifice name"),
        (one().supply("pump", 3e5), free(), "it is taken"),
        (one().supply("vacuum", -1.0), free(), "supply \"vacuum\" pressure = -1"),
        (one().orifice(Orifice::new("valve", "pimp", "0", 1e-9)), free(), "did you mean \"pump\""),
        (
            one().orifice(Orifice::new("valve", "pump", "atmosphere", 1e-9)),
            free(),
            "a chamber with gas",
        ),
        (one().orifice(Orifice::new("valve", "0", "0", 1e-9)), free(), "a chamber with gas"),
        (one().orifice(orifice(1e-9)), free().open("valv", 1.0), "did you mean \"valve\""),
        (one().orifice(orifice(1e-9)), free().open("valve", 2.0), "from 0 (shut) to 1"),
        (cylinders(1).supply("pump", 2e5).orifice(orifice(1e-9)), free(), "the chamber has no gas"),
    ] {
        let told = with(scene, phase);
        println!("{told}");
        assert!(told.contains(words), "{told}: {words}");
    }
    let fed = one().orifice(orifice(1e-9)).phase(free());
    let told = fed.equilibrium(&Statics::default()).unwrap_err().to_string();
    assert!(told.contains("orifice of statics"), "{told}");
    // what is known only as it goes
    let late =
        one().orifice(orifice(1e-9)).phase(free().open("valve", Signal::function(|t| 3.0 * t)));
    let Err(Error::Integration(end)) = late.simulate(&Settings::default(), &Sampling::every(0.1))
    else {
        panic!("it went on")
    };
    println!("{end}");
    assert!(end.to_string().contains("the opening of orifice \"valve\""), "{end}");
}

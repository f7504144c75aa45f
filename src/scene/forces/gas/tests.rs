//! Gas and orifices against their own derivatives and against values of the standard.

use super::{AmountFlow, GAS_CONSTANT_TIMES_TEMPERATURE, Gas, GasInChamber, Orifice};
use crate::base::sparse::BlockMatrix;
use crate::elements::body::Body;
use crate::elements::force::{Flow, FlowDerivatives, NodalForces};
use crate::elements::material::Material;
use crate::elements::mesh::{Cells, Mesh};
use crate::scene::forces::{Chamber, End};

/// A room of 0.1 m x 0.1 m in a square, 1 m thick.
fn filled(pressure: f64, exponent: f64) -> (Body, GasInChamber) {
    let mesh = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Rectangles).unwrap();
    let material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
    let body = Body::new(mesh, material).thickness(1.0).build().unwrap();
    let walls = Chamber::within("room", [1, 2, 4, 3]).force(&body, Vec::new()).unwrap();
    let gas = Gas::in_chamber("room").pressure(pressure).exponent(exponent);
    (body, gas.fill(walls, 8, 1e5).unwrap())
}

fn flow(conductance: f64, ratio: f64, pressures: [f64; 2]) -> [f64; 3] {
    let orifice = Orifice::new("o", "a", "b", conductance).critical_ratio(ratio);
    let ends = pressures.map(|pressure| End::Given(pressure.into()));
    orifice.flow(ends, Vec::new()).unwrap().rate(0.0, &[], &[]).unwrap()
}

/// A valve of 2 dm^3/(s bar) (ISO 6358's unit) passes 2 x 6 dm^3/s of reference air from 6 bar into the open, choked, and as
/// much the other way; where its pressures are in the middle between b and 1 it passes sqrt(3/4) of that.
#[test]
fn flows_are_those_of_the_standard() {
    let (c, choked) = (2e-8, 2e-8 * 6e5 * 1.185);
    for (pressures, expected) in
        [([6e5, 1e5], choked), ([1e5, 6e5], -choked), ([6e5, 3.9e5], 0.75_f64.sqrt() * choked)]
    {
        let [found, ..] = flow(c, 0.3, pressures);
        assert!((found / expected - 1.0).abs() < 1e-14, "{pressures:?}: {found} {expected}");
    }
    assert_eq!(flow(c, 0.3, [2e5, 2e5])[0], 0.0);
    assert_eq!(flow(c, 0.3, [0.0, 0.0])[0], 0.0);
}

/// A nozzle of 1 mm^2 lets 0.0404 p/sqrt(T) kg/s through for each m^2 and Pa where it is choked (the constant for air in textbooks), either way; else what
/// Bernoulli's equation for the density behind an adiabatic expansion gives, w = sqrt(2 c_p (T_1 - T_2)).
#[test]
fn nozzles_have_the_flow_of_an_expansion() {
    let flow = |pressures: [f64; 2], discharge: f64| {
        let nozzle = Orifice::nozzle("n", "a", "b", 1e-6).discharge(discharge);
        let ends = pressures.map(|pressure| End::Given(pressure.into()));
        nozzle.flow(ends, Vec::new()).unwrap().rate(0.0, &[], &[]).unwrap()
    };
    let temperature = 293.15_f64;
    let choked = 0.0404 * 1e-6 * 6e5 / temperature.sqrt();
    for (pressures, sign) in [([6e5, 1e5], 1.0), ([1e5, 6e5], -1.0), ([6e5, 3.1e5], 1.0)] {
        let [found, ..] = flow(pressures, 0.8);
        // as many digits as the constant has: R is 287.9 J/(kg K) here, 287.05 in it
        assert!((found / (sign * 0.8 * choked) - 1.0).abs() < 2e-3, "{found} {choked}");
    }
    for ratio in [0.53, 0.6, 0.8, 0.95, 0.99, 0.998] {
        let gas_constant = GAS_CONSTANT_TIMES_TEMPERATURE / temperature;
        let behind = temperature * f64::powf(ratio, 0.4 / 1.4);
        let speed = (2.0 * 3.5 * gas_constant * (temperature - behind)).sqrt();
        let density = ratio * 2e5 / (gas_constant * behind);
        for (pressures, sign) in [([2e5, 2e5 * ratio], 1.0), ([2e5 * ratio, 2e5], -1.0)] {
            let [found, ..] = flow(pressures, 1.0);
            let expected = sign * 1e-6 * density * speed;
            assert!((found / expected - 1.0).abs() < 1e-13, "{ratio}: {found} {expected}");
        }
    }
    for up in [0.5281e5, 0.5284e5, 0.7e5, 0.9989e5, 0.9991e5, 1e5, 1.0005e5, 1.5e5, 3e5] {
        let at = |apart: [f64; 2]| flow([1e5 + apart[0], up + apart[1]], 1.0);
        let [_, by_first, by_second] = at([0.0; 2]);
        for (slope, along) in [(by_first, [0.01, 0.0]), (by_second, [0.0, 0.01])] {
            let [ahead, behind] = [at(along)[0], at(along.map(|x| -x))[0]];
            let difference = (ahead - behind) / 0.02;
            // of the largest, at equal pressures
            assert!((slope - difference).abs() < 1e-4 * 1e-7, "{up}: {slope} {difference}");
        }
    }
}

/// Its slopes are those of differences, without a jump where it becomes choked or laminar, or turns.
#[test]
fn flows_have_the_slopes_that_are_told() {
    for up in [0.2e5, 0.49e5, 0.5e5, 0.9e5, 0.9989e5, 0.9991e5, 1e5, 1.0005e5, 1.002e5, 1.5e5, 3e5]
    {
        let at = |apart: [f64; 2]| flow(1e-8, 0.5, [1e5 + apart[0], up + apart[1]]);
        let [_, by_first, by_second] = at([0.0; 2]);
        let step = 0.01;
        for (slope, along) in [(by_first, [step, 0.0]), (by_second, [0.0, step])] {
            let [ahead, behind] = [at(along)[0], at(along.map(|x| -x))[0]];
            let difference = (ahead - behind) / (2.0 * step);
            // of the largest slope, C rho_0 5/4 sqrt(2/(0.002 0.5)) or so; curvature at the seams is most of it
            assert!((slope - difference).abs() < 1e-4 * 1e-8 * 30.0, "{up}: {slope} {difference}");
        }
    }
}

/// p is -dU/dV, what a kilogram brings dU/dm, and the power of what flows has the derivatives that are told.
#[test]
fn energies_belong_to_the_pressures() {
    for exponent in [1.0, 1.2, 1.4] {
        let (body, gas) = filled(1.3e5, exponent);
        let orifice = Orifice::new("o", "supply", "room", 1e-6);
        let orifice = orifice.flow([End::Given(2e5.into()), End::Gas(0)], Vec::new()).unwrap();
        let start = vec![gas.amount];
        let none = Vec::new;
        let flow = AmountFlow::new(vec![gas], vec![orifice], none(), Vec::new(), Vec::new(), start);
        let first = flow.start()[0];
        let at = |swelling: f64, amount: f64| -> ([f64; 4], FlowDerivatives) {
            // the upper nodes rise
            let u = [0.0, 0.0, 0.0, 0.0, 0.0, swelling, 0.0, swelling];
            let mut forces = NodalForces::zeros(8);
            let ([mut rates, mut work], amounts) = ([[0.0], [0.0]], [amount]);
            let power = flow
                .add_forces_of(0.0, [&u, &amounts], &mut forces, [&mut rates, &mut work])
                .unwrap();
            let mut derivatives = FlowDerivatives::zeros([1, 1], 8);
            let mut stiffness = BlockMatrix::zeros(body.inertia().pattern(), 2);
            flow.linearize(0.0, [&u, &[], &amounts], &mut stiffness, &mut derivatives);
            let lifting = forces.conservative[5] + forces.conservative[7];
            ([flow.potential_of(&u, &amounts), lifting, rates[0], power], derivatives)
        };
        let (rise, amount) = (0.02, 1.3 * first);
        let ([_, lifting, rate, power], derivatives) = at(rise, amount);
        assert!(rate > 0.0);
        let by = |k: usize, [up, more]: [f64; 2]| {
            (at(rise + up, amount + more).0[k] - at(rise - up, amount - more).0[k]) / 2.0
        };
        let (up, more) = (1e-6, 1e-5 * first);
        let close = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 1e-8, "{exponent}: {found} {expected}");
        };
        // dV is 0.1 m^2 du
        close(by(0, [up, 0.0]) / up, -lifting);
        close(by(0, [0.0, more]) / more * rate, power);
        close(by(1, [up, 0.0]) / up, -0.01 * derivatives.pressures[0][0]);
        close(by(1, [0.0, more]) / more, 0.1 * derivatives.pressures[1][0]);
        close(by(2, [up, 0.0]) / up, 0.1 * derivatives.rates[0][0]);
        close(by(2, [0.0, more]) / more, derivatives.rates[1][0]);
        close(by(3, [up, 0.0]) / up, 0.1 * derivatives.power[0][0]);
        close(by(3, [0.0, more]) / more, derivatives.power[1][0]);
    }
}

//! d. Spinning bodies.

use pliant::{Strain, Viscosity};

use crate::gallery::rotation::{SPIN, Square, green_energy, watch};

/// Each node flies straight on: the angle is atan(omega t), the size 1/cos of it.
#[test]
fn a_body_of_cauchy_strain_swells_and_never_turns_by_90_degrees() {
    let square = Square::undamped(Strain::Cauchy);
    let motion = square.spun(1.0).unwrap();
    for (sample, spin) in motion.samples().iter().zip(watch(&motion)) {
        let turned = SPIN * sample.time;
        // far below rtol, as each node turns in step with the others
        assert!((spin.angle - turned.atan()).abs() < 1e-10, "{turned}: {}", spin.angle);
        assert!((spin.size - turned.hypot(1.0)).abs() < 5e-10, "{turned}: {}", spin.size);
    }
    let report = motion.report();
    assert!(report.energy_error < 2e-9 * report.energy_scale, "{}", report.energy_error);
    // and yet a square of that shape would hold ten million times the energy of the spin
    let energy = green_energy(&square, &motion).unwrap();
    assert!(energy > 1e6 * motion.samples()[0].energy.kinetic, "{energy}");
}

#[test]
fn a_body_of_green_strain_turns_on() {
    // the momentum of the square is kept up to some hundred times rtol
    let square = Square { rtol: 1e-7, ..Square::undamped(Strain::Green) };
    let motion = square.spun(1.0).unwrap();
    for (sample, spin) in motion.samples().iter().zip(watch(&motion)) {
        // strains by centrifugal forces are some 1e-5
        assert!((spin.angle - SPIN * sample.time).abs() < 2e-4, "{}", spin.angle);
        assert!((spin.size - 1.0).abs() < 1e-4, "{}", spin.size);
        assert!((spin.momentum - 1.0).abs() < 2e-5, "{}", spin.momentum);
    }
}

#[test]
fn vibrations_turn_a_body_of_cauchy_strain() {
    let off = |strain| {
        let square = Square { stretch: 0.05, ..Square::undamped(strain) };
        let spins = watch(&square.spun(0.5).unwrap());
        spins.iter().map(|spin| (spin.momentum - 1.0).abs()).fold(0.0, f64::max)
    };
    assert!(off(Strain::Cauchy) > 1.0);
    // rtol 1e-6 of velocities, whose vibration is some hundred times the spin's
    assert!(off(Strain::Green) < 1e-3);
}

#[test]
fn natural_viscosity_stops_a_spin() {
    let heat = |viscosity| {
        let square = Square { viscosity, c: 40.0, ..Square::undamped(Strain::Green) };
        let motion = square.spun(1.0).unwrap();
        motion.last().energy.dissipated / motion.samples()[0].energy.kinetic
    };
    assert!(heat(Viscosity::Natural) > 0.9);
    assert!(heat(Viscosity::Objective) < 1e-4);
}

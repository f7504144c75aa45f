//! The transistor amplifier: a DAE of index 1.

use faer::MatMut;

use super::{QUADRUPLE, Reference};
use crate::integrators::ode::{Failure, MassKind, Ode};

/// The transistor amplifier (TRANSAMP): M y' = f(t, y) with a singular matrix M of capacitances; eight
/// voltages, index 1. [`MassForm`](crate::integrators::sundials::MassForm) hands it to IDA.
///
/// P. Rentrop, M. Roche, G. Steinebach, "The application of Rosenbrock-Wanner type methods with
/// stepsize control in differential-algebraic equations", Numer. Math. 55 (1989).
#[derive(Clone, Copy, Debug, Default)]
pub struct TransistorAmplifier;

/// 1 / resistance of all resistors but the first.
const CONDUCTANCE: f64 = 1.0 / 9000.0;
const FIRST_CONDUCTANCE: f64 = 1.0 / 1000.0;
const SUPPLY: f64 = 6.0;
const ALPHA: f64 = 0.99;
const BETA: f64 = 1e-6;
const THERMAL: f64 = 0.026;

impl TransistorAmplifier {
    /// Initial state at t = 0, at which the algebraic equations hold.
    pub const Y0: [f64; 8] = [0.0, 3.0, 3.0, 6.0, 3.0, 3.0, 6.0, 0.0];

    /// Its time derivative. M y' = f leaves the sum of the rates of the two voltages at each of three
    /// capacitors open; the algebraic equations, which are sums of two rows each, give it when differentiated
    /// with respect to time.
    pub const YP0: [f64; 8] = [
        51.339_276_517_180_72,
        51.339_276_517_180_72,
        -500.0 / 3.0,
        -24.970_328_515_406_33,
        -24.970_328_515_406_33,
        -250.0 / 3.0,
        -10.000_276_402_456_337,
        -10.000_276_402_456_337,
    ];

    /// End state.
    pub const REFERENCE: Reference = Reference {
        t: 0.2,
        y: &[
            -5.562_145_012_262_273e-3,
            3.006_522_471_903_043,
            2.849_958_788_608_128_6,
            2.926_422_536_206_242,
            2.704_617_865_010_555,
            2.761_837_778_393_144,
            4.770_927_631_616_773,
            1.236_995_868_091_547_6,
        ],
        digits: 13,
        source: QUADRUPLE,
    };
}

impl Ode for TransistorAmplifier {
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), Failure> {
        let signal = 0.1 * (200.0 * std::f64::consts::PI * t).sin();
        let current = |voltage: f64| BETA * (voltage / THERMAL).exp_m1();
        f[0] = (signal - y[0]) * FIRST_CONDUCTANCE;
        for (k, current) in [(1, current(y[1] - y[2])), (4, current(y[4] - y[5]))] {
            f[k] = (SUPPLY - 2.0 * y[k]) * CONDUCTANCE - (1.0 - ALPHA) * current;
            f[k + 1] = current - y[k + 1] * CONDUCTANCE;
            f[k + 2] = (SUPPLY - y[k + 2]) * CONDUCTANCE - ALPHA * current;
        }
        f[7] = -y[7] * CONDUCTANCE;
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        jacobian[(0, 0)] = -FIRST_CONDUCTANCE;
        jacobian[(7, 7)] = -CONDUCTANCE;
        for k in [1, 4] {
            let slope = BETA / THERMAL * ((y[k] - y[k + 1]) / THERMAL).exp();
            for (i, factor, conductance) in
                [(k, ALPHA - 1.0, 2.0), (k + 1, 1.0, 1.0), (k + 2, -ALPHA, 1.0)]
            {
                jacobian[(i, k)] = factor * slope;
                jacobian[(i, k + 1)] = -factor * slope;
                jacobian[(i, i)] -= conductance * CONDUCTANCE;
            }
        }
        Ok(())
    }

    fn mass_kind(&self) -> MassKind {
        MassKind::Constant
    }

    /// Capacitances between two nodes, and from one node to ground.
    fn dense_mass(&mut self, _t: f64, mut mass: MatMut<'_, f64>) -> Result<(), Failure> {
        for (i, capacity) in [(0, 1e-6), (3, 3e-6), (6, 5e-6)] {
            mass[(i, i)] = capacity;
            mass[(i + 1, i + 1)] = capacity;
            mass[(i, i + 1)] = -capacity;
            mass[(i + 1, i)] = -capacity;
        }
        mass[(2, 2)] = 2e-6;
        mass[(5, 5)] = 4e-6;
        Ok(())
    }
}

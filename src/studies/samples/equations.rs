//! Standard stiff problems, DAEs and a pendulum, each with a trusted end state.

mod car_axis;
mod chemistry;
mod fields;
mod pendulum;
#[cfg(test)]
mod tests;
mod transistor;

use faer::MatMut;

use crate::integrators::{
    ode::{BandMut, Dae, Failure, Ode},
    sundials::Pattern,
};

pub use car_axis::CarAxis;
pub use chemistry::{Oregonator, Pollution};
pub use fields::{Brusselator, HeatedSquare};
pub use pendulum::Pendulum;
pub use transistor::TransistorAmplifier;

/// The state that a problem reaches, and how far it can be trusted.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    /// Time of the state.
    pub t: f64,
    /// The state.
    pub y: &'static [f64],
    /// Correct significant digits of each component.
    pub digits: u32,
    /// Source of the numbers.
    pub source: &'static str,
}

impl Reference {
    /// Largest relative error of a component of `y`.
    #[must_use]
    pub fn error(&self, y: &[f64]) -> f64 {
        assert_eq!(y.len(), self.y.len());
        self.y.iter().zip(y).map(|(r, y)| ((y - r) / r).abs()).fold(0.0, f64::max)
    }
}

const QUADRUPLE: &str = "integrated in quadruple precision; two tolerances agree";

/// A problem that lists the entries of its Jacobian.
trait Entries {
    /// Calls `put` with row, column and value of each entry of df/dy. The places do not depend on
    /// the state.
    fn entries(y: &[f64], put: impl FnMut(usize, usize, f64));

    fn pattern_of(n: usize) -> Pattern {
        let mut places = Vec::new();
        Self::entries(&vec![0.0; n], |i, j, _| places.push((i, j)));
        Pattern::from_entries(n, places).expect("the entries lie within the matrix")
    }
}

/// Implements `Ode`'s Jacobians by [`Entries`].
macro_rules! jacobians_from_entries {
    () => {
        fn dense_jacobian(
            &mut self,
            _t: f64,
            y: &[f64],
            _ydot: &[f64],
            mut jacobian: MatMut<'_, f64>,
        ) -> Result<(), Failure> {
            Self::entries(y, |i, j, value| jacobian[(i, j)] = value);
            Ok(())
        }

        fn banded_jacobian(
            &mut self,
            _t: f64,
            y: &[f64],
            _ydot: &[f64],
            mut jacobian: BandMut<'_>,
        ) -> Result<(), Failure> {
            Self::entries(y, |i, j, value| jacobian[(i, j)] = value);
            Ok(())
        }

        fn sparse_jacobian(
            &mut self,
            _t: f64,
            y: &[f64],
            _ydot: &[f64],
            values: &mut [f64],
        ) -> Result<(), Failure> {
            let pattern = &self.pattern;
            Self::entries(y, |i, j, value| {
                values[pattern.position(i, j).expect("made from the same entries")] = value;
            });
            Ok(())
        }
    };
}

/// Common implementation of problems with a fixed number of unknowns.
macro_rules! of_unknowns {
    ($problem:ty, $n:literal) => {
        impl $problem {
            /// The problem.
            #[must_use]
            pub fn new() -> Self {
                Self { pattern: Self::pattern_of($n) }
            }

            /// Pattern of its Jacobian.
            #[must_use]
            pub fn pattern(&self) -> &Pattern {
                &self.pattern
            }
        }

        impl Default for $problem {
            fn default() -> Self {
                Self::new()
            }
        }
    };
}

use {jacobians_from_entries, of_unknowns};

/// HIRES: eight reactions of plant photomorphogenesis; stiff.
///
/// E. Schäfer, "A new approach to explain the high irradiance responses of photomorphogenesis on
/// the basis of phytochrome", J. Math. Biology 2 (1975).
#[derive(Clone, Debug)]
pub struct Hires {
    pattern: Pattern,
}

impl Hires {
    /// Initial state at t = 0.
    pub const Y0: [f64; 8] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057];

    /// End state.
    pub const REFERENCE: Reference = Reference {
        t: 321.8122,
        y: &[
            7.371_312_573_325_668e-4,
            1.442_485_726_316_184_7e-4,
            5.888_729_740_967_575e-5,
            1.175_651_343_283_149_2e-3,
            2.386_356_198_831_330_5e-3,
            6.238_968_252_742_796e-3,
            2.849_998_395_185_768_7e-3,
            2.850_001_604_814_231_3e-3,
        ],
        digits: 13,
        source: QUADRUPLE,
    };
}

of_unknowns!(Hires, 8);

impl Ode for Hires {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let exchange = 280.0 * y[5] * y[7];
        ydot[0] = -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007;
        ydot[1] = 1.71 * y[0] - 8.75 * y[1];
        ydot[2] = -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4];
        ydot[3] = 8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3];
        ydot[4] = -1.745 * y[4] + 0.43 * (y[5] + y[6]);
        ydot[5] = -exchange + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6];
        ydot[6] = exchange - 1.81 * y[6];
        ydot[7] = -ydot[6];
        Ok(())
    }

    jacobians_from_entries!();
}

impl Entries for Hires {
    fn entries(y: &[f64], mut put: impl FnMut(usize, usize, f64)) {
        for (i, j, value) in [
            (0, 0, -1.71),
            (0, 1, 0.43),
            (0, 2, 8.32),
            (1, 0, 1.71),
            (1, 1, -8.75),
            (2, 2, -10.03),
            (2, 3, 0.43),
            (2, 4, 0.035),
            (3, 1, 8.32),
            (3, 2, 1.71),
            (3, 3, -1.12),
            (4, 4, -1.745),
            (4, 5, 0.43),
            (4, 6, 0.43),
            (5, 3, 0.69),
            (5, 4, 1.71),
            (5, 5, -280.0 * y[7] - 0.43),
            (5, 6, 0.69),
            (5, 7, -280.0 * y[5]),
            (6, 5, 280.0 * y[7]),
            (6, 6, -1.81),
            (6, 7, 280.0 * y[5]),
            (7, 5, -280.0 * y[7]),
            (7, 6, 1.81),
            (7, 7, -280.0 * y[5]),
        ] {
            put(i, j, value);
        }
    }
}

/// Robertson's three reactions, whose rates differ by nine orders of magnitude; very stiff.
///
/// As an ODE; as a DAE the third equation is replaced by conservation, y1 + y2 + y3 = 1.
///
/// H. H. Robertson, "The solution of a set of reaction rate equations", in Numerical Analysis: An
/// Introduction, Academic Press (1966).
#[derive(Clone, Debug)]
pub struct Robertson {
    pattern: Pattern,
}

impl Robertson {
    /// Initial state at t = 0.
    pub const Y0: [f64; 3] = [1.0, 0.0, 0.0];

    /// Its time derivative.
    pub const YP0: [f64; 3] = [-0.04, 0.04, 0.0];

    /// Which unknowns of the DAE are differential.
    pub const DIFFERENTIAL: [bool; 3] = [true, true, false];

    /// A late state.
    pub const REFERENCE: Reference = Reference {
        t: 4e10,
        y: &[5.208_345_176_799_24e-8, 2.083_338_177_925_49e-13, 0.999_999_947_916_340],
        digits: 14,
        source: QUADRUPLE,
    };

    /// A still later one.
    pub const LATE_REFERENCE: Reference = Reference {
        t: 1e11,
        y: &[2.083_340_149_701_29e-8, 8.333_360_770_334_78e-14, 0.999_999_979_166_515],
        digits: 14,
        source: QUADRUPLE,
    };

    /// The problem.
    #[must_use]
    pub fn new() -> Self {
        Self { pattern: Self::pattern_of(3) }
    }

    /// Patterns of the Jacobians of the ODE and of the DAE.
    #[must_use]
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn dae_entries(cj: f64, y: &[f64], mut put: impl FnMut(usize, usize, f64)) {
        Self::entries(y, |i, j, value| {
            let slope = if i == j { cj } else { 0.0 };
            put(i, j, if i < 2 { value - slope } else { 1.0 });
        });
    }
}

impl Default for Robertson {
    fn default() -> Self {
        Self::new()
    }
}

impl Ode for Robertson {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
        ydot[2] = 3e7 * y[1] * y[1];
        ydot[1] = -ydot[0] - ydot[2];
        Ok(())
    }

    jacobians_from_entries!();
}

impl Entries for Robertson {
    fn entries(y: &[f64], mut put: impl FnMut(usize, usize, f64)) {
        let rows = [
            [-0.04, 1e4 * y[2], 1e4 * y[1]],
            [0.04, -1e4 * y[2] - 6e7 * y[1], -1e4 * y[1]],
            [0.0, 6e7 * y[1], 0.0],
        ];
        for (i, row) in rows.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                put(i, j, *value);
            }
        }
    }
}

impl Dae for Robertson {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self.rhs(t, y, residual)?;
        residual[0] -= yp[0];
        residual[1] -= yp[1];
        residual[2] = y[0] + y[1] + y[2] - 1.0;
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        Self::dae_entries(cj, y, |i, j, value| jacobian[(i, j)] = value);
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let pattern = &self.pattern;
        Self::dae_entries(cj, y, |i, j, value| {
            values[pattern.position(i, j).expect("made from the same entries")] = value;
        });
        Ok(())
    }
}

/// Van der Pol's oscillator with mu = 1000: long slow phases between sudden jumps; stiff.
#[derive(Clone, Debug)]
pub struct VanDerPol {
    pattern: Pattern,
}

impl VanDerPol {
    /// Initial state at t = 0.
    pub const Y0: [f64; 2] = [2.0, 0.0];

    /// Its parameter.
    pub const MU: f64 = 1000.0;

    /// End state.
    pub const REFERENCE: Reference = Reference {
        t: 2000.0,
        y: &[1.706_167_732_170_465, -8.928_097_010_248_165e-4],
        digits: 15,
        source: QUADRUPLE,
    };
}

of_unknowns!(VanDerPol, 2);

impl Ode for VanDerPol {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = y[1];
        ydot[1] = Self::MU * (1.0 - y[0] * y[0]) * y[1] - y[0];
        Ok(())
    }

    jacobians_from_entries!();
}

impl Entries for VanDerPol {
    fn entries(y: &[f64], mut put: impl FnMut(usize, usize, f64)) {
        put(0, 0, 0.0);
        put(0, 1, 1.0);
        put(1, 0, -2.0 * Self::MU * y[0] * y[1] - 1.0);
        put(1, 1, Self::MU * (1.0 - y[0] * y[0]));
    }
}

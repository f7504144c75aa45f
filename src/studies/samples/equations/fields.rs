//! Semi-discrete partial differential equations of any size.

use faer::MatMut;

use super::{Entries, QUADRUPLE, Reference, jacobians_from_entries};
use crate::integrators::{
    ode::{BandMut, Failure, Ode},
    sundials::Pattern,
};

/// The Brusselator with diffusion on a line, at n points between fixed ends: A = 1, B = 3,
/// diffusion 1/50. Unknowns are interleaved, u1, v1, u2, v2, ..., so that two diagonals lie on each
/// side of the main one.
///
/// E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", section IV.10 (BRUSS).
#[derive(Clone, Debug)]
pub struct Brusselator {
    pattern: Pattern,
    points: usize,
}

impl Brusselator {
    /// Half bandwidth of its Jacobian, on either side.
    pub const BANDWIDTH: usize = 2;

    /// End state with 20 points.
    pub const REFERENCE_20: Reference = Reference {
        t: 10.0,
        y: &[
            8.776_530_097_283_123e-1,
            3.154_703_909_060_436_7,
            7.658_928_273_838_27e-1,
            3.295_548_820_090_868_7,
            6.712_478_470_947_835e-1,
            3.413_643_265_486_846_7,
            5.958_550_017_513_676e-1,
            3.505_830_090_092_761,
            5.386_469_677_140_998e-1,
            3.573_451_166_362_831,
            4.969_386_018_731_104e-1,
            3.620_405_791_383_73,
            4.676_720_876_727_652_5e-1,
            3.651_446_867_541_759_7,
            4.481_320_348_200_727_4e-1,
            3.671_045_423_089_885_7,
            4.362_471_260_013_675e-1,
            3.682_770_846_861_899_4,
            4.306_606_757_477_103e-1,
            3.689_013_042_768_437_8,
            4.307_112_500_402_71e-1,
            3.690_887_551_249_250_3,
            4.364_053_271_659_524e-1,
            3.688_219_383_002_272_7,
            4.484_169_183_817_862_7e-1,
            3.679_556_662_845_482,
            4.681_131_789_868_525e-1,
            3.662_214_785_967_886,
            4.975_692_041_709_549_6e-1,
            3.632_401_031_451_001,
            5.394_886_457_356_802e-1,
            3.585_523_548_819_228_5,
            5.968_897_247_446_976e-1,
            3.516_839_975_568_438_5,
            6.723_805_302_574_589e-1,
            3.422_609_112_102_876,
            7.669_226_841_236_81e-1,
            3.301_778_439_248_172,
            8.782_943_216_042_928e-1,
            3.157_853_117_242_124_7,
        ],
        digits: 15,
        source: QUADRUPLE,
    };

    /// The problem at `points` points.
    #[must_use]
    pub fn new(points: usize) -> Self {
        Self { pattern: Self::pattern_of(2 * points), points }
    }

    /// Initial state at t = 0: u = 1 + sin(2 pi x), v = 3.
    #[must_use]
    pub fn y0(&self) -> Vec<f64> {
        let x = |i| (i + 1) as f64 / (self.points + 1) as f64;
        let u = |i| 1.0 + (std::f64::consts::TAU * x(i)).sin();
        (0..self.points).flat_map(|i| [u(i), 3.0]).collect()
    }

    /// Pattern of its Jacobian.
    #[must_use]
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// Diffusion coefficient over the square of the distance of points.
    fn exchange(points: usize) -> f64 {
        let intervals = (points + 1) as f64;
        intervals * intervals / 50.0
    }
}

impl Ode for Brusselator {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let (n, c) = (self.points, Self::exchange(self.points));
        for i in 0..n {
            let (u, v) = (y[2 * i], y[2 * i + 1]);
            let (left_u, left_v) = if i > 0 { (y[2 * i - 2], y[2 * i - 1]) } else { (1.0, 3.0) };
            let (right_u, right_v) =
                if i + 1 < n { (y[2 * i + 2], y[2 * i + 3]) } else { (1.0, 3.0) };
            ydot[2 * i] = 1.0 + u * u * v - 4.0 * u + c * (left_u - 2.0 * u + right_u);
            ydot[2 * i + 1] = 3.0 * u - u * u * v + c * (left_v - 2.0 * v + right_v);
        }
        Ok(())
    }

    jacobians_from_entries!();
}

impl Entries for Brusselator {
    fn entries(y: &[f64], mut put: impl FnMut(usize, usize, f64)) {
        let c = Self::exchange(y.len() / 2);
        for i in (0..y.len()).step_by(2) {
            let (u, v) = (y[i], y[i + 1]);
            put(i, i, 2.0 * u * v - 4.0 - 2.0 * c);
            put(i, i + 1, u * u);
            put(i + 1, i, 3.0 - 2.0 * u * v);
            put(i + 1, i + 1, -u * u - 2.0 * c);
            for k in [i, i + 1] {
                if i > 0 {
                    put(k, k - 2, c);
                }
                if i + 2 < y.len() {
                    put(k, k + 2, c);
                }
            }
        }
    }
}

/// Heat in the unit square with cold edges, at n x n points, heated from within: in closed form.
///
/// Source and initial state are sines, which the five-point Laplacian only scales, so the answer of
/// the discrete equations is known:
/// [`Self::exact`].
#[derive(Clone, Debug)]
pub struct HeatedSquare {
    pattern: Pattern,
    source: Vec<f64>,
    side: usize,
}

impl HeatedSquare {
    /// The problem at `side` x `side` points inside the square.
    #[must_use]
    pub fn new(side: usize) -> Self {
        let sine = |i: usize| (std::f64::consts::PI * (i + 1) as f64 / (side + 1) as f64).sin();
        let source = (0..side * side).map(|k| sine(k / side) * sine(k % side)).collect();
        Self { pattern: Self::pattern_of(side * side), source, side }
    }

    /// The state at time t: phi = sin(pi x) sin(pi y), from phi at t = 0 to phi / lambda, where -lambda is
    /// the eigenvalue of the discrete Laplacian.
    #[must_use]
    pub fn exact(&self, t: f64) -> Vec<f64> {
        let intervals = (self.side + 1) as f64;
        let half = (0.5 * std::f64::consts::PI / intervals).sin();
        let lambda = 8.0 * intervals * intervals * half * half;
        let factor = (-lambda * t).exp() - (-lambda * t).exp_m1() / lambda;
        self.source.iter().map(|phi| factor * phi).collect()
    }

    /// Pattern of its Jacobian.
    #[must_use]
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }
}

impl Ode for HeatedSquare {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.copy_from_slice(&self.source);
        Self::entries(y, |i, j, value| ydot[i] += value * y[j]);
        Ok(())
    }

    jacobians_from_entries!();
}

impl Entries for HeatedSquare {
    fn entries(y: &[f64], mut put: impl FnMut(usize, usize, f64)) {
        let side = y.len().isqrt();
        let c = ((side + 1) * (side + 1)) as f64;
        for k in 0..y.len() {
            put(k, k, -4.0 * c);
            let (row, column) = (k / side, k % side);
            let neighbours = [
                (column > 0, k.wrapping_sub(1)),
                (column + 1 < side, k + 1),
                (row > 0, k.wrapping_sub(side)),
                (row + 1 < side, k + side),
            ];
            neighbours.into_iter().filter(|(inside, _)| *inside).for_each(|(_, j)| put(k, j, c));
        }
    }
}

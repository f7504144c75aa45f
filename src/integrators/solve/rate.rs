//! The fastest mode of the equations at a state, by differences.

use super::engine::Engine;
use crate::base::vector::noise;
use crate::integrators::common::Tolerances;

/// Products with the Jacobian by which the largest rate of the equations is estimated: an even number, as they alternate between two sizes
/// where an oscillation has unknowns of two scales.
const PRODUCTS: i32 = 12;
/// Evaluations of the right-hand side that the estimate takes.
pub(super) const EVALUATIONS: u64 = PRODUCTS as u64 + 1;
/// Change of the state along which they are differences, relative to its size.
const SHIFT: f64 = 1e-7;

/// The dominant eigenvalue of df/dy.
pub(super) struct Rate {
    /// Its absolute value.
    pub(super) size: f64,
    /// Whether it lies nearer to the imaginary axis than to the real one.
    pub(super) oscillates: bool,
}

impl Rate {
    /// That at time `t` and the state `y` of an ODE, by power iteration with differences: [`EVALUATIONS`] of the right-hand side.
    pub(super) fn of(
        engine: &mut dyn Engine,
        tolerances: &Tolerances,
        t: f64,
        y: &[f64],
    ) -> Option<Self> {
        let n = y.len();
        let here = slope_of(engine, t, y)?;
        let sizes: Vec<f64> = (0..n).map(|i| tolerances.size_of(i, y[i])).collect();
        let norm = |change: &[f64]| norm(tolerances, y, change);
        let mut v: Vec<f64> = noise(n, 1).iter().zip(&sizes).map(|(v, size)| v * size).collect();
        let mut last = v.clone();
        let (mut product, mut cosine) = (0.0, 0.0);
        for k in 0..PRODUCTS {
            let length = norm(&v);
            if length == 0.0 || !length.is_finite() {
                return None;
            }
            v.iter_mut().for_each(|v| *v /= length);
            let moved: Vec<f64> = y.iter().zip(&v).map(|(y, v)| y + SHIFT * v).collect();
            let slope = slope_of(engine, t, &moved)?;
            let next: Vec<f64> = slope.iter().zip(&here).map(|(a, b)| (a - b) / SHIFT).collect();
            // half of them lead to the dominant mode
            if k >= PRODUCTS / 2 {
                product += norm(&next).ln();
            }
            let scaled = |a: &[f64], b: &[f64]| -> f64 {
                (0..n).map(|i| a[i] * b[i] / (sizes[i] * sizes[i])).sum::<f64>() / n as f64
            };
            cosine = scaled(&next, &last) / (norm(&next) * norm(&last));
            last = std::mem::replace(&mut v, next);
        }
        let size = (product / f64::from(PRODUCTS - PRODUCTS / 2)).exp();
        size.is_finite().then_some(Self { size, oscillates: cosine < 0.0 })
    }
}

/// The right-hand side of an ODE at time `t` and the state `y`; none where it has no value.
pub(super) fn slope_of(engine: &mut dyn Engine, t: f64, y: &[f64]) -> Option<Vec<f64>> {
    let mut slope = vec![0.0; y.len()];
    engine.slope(t, y, &mut slope).ok()?;
    slope.iter().all(|slope| slope.is_finite()).then_some(slope)
}

/// The root mean square of a change of the state `y`, relative to the sizes of the unknowns.
pub(super) fn norm(tolerances: &Tolerances, y: &[f64], change: &[f64]) -> f64 {
    let squares = change.iter().enumerate().map(|(i, x)| (x / tolerances.size_of(i, y[i])).powi(2));
    (squares.sum::<f64>() / change.len() as f64).sqrt()
}

//! Confidence intervals of fitted values, and which values cannot be identified.

use std::f64::consts::PI;

use nalgebra::DMatrix;

use super::unknown::Unknown;
use crate::base::input::InputError;

/// Half widths, in parts of the ranges, of the 95 % confidence intervals of the unknowns.
///
/// They are Student's, with the covariance s^2 (J^T J)^-1, where J has a column of `slopes` for each unknown
/// and s^2 is the variance of the `residuals`, which count as `independent` independent ones.
///
/// # Errors
/// Slopes below the `noise`, a part of the largest of them, or linearly dependent to within that part.
pub(super) fn confidence(
    unknowns: &[Unknown],
    slopes: &[Vec<f64>],
    residuals: &[f64],
    independent: f64,
    noise: f64,
) -> Result<Vec<f64>, InputError> {
    let norms: Vec<f64> = slopes.iter().map(|column| norm(column)).collect();
    let largest = norms.iter().copied().fold(0.0, f64::max);
    if let Some(at) = norms.iter().position(|norm| norm.is_nan() || *norm <= noise * largest) {
        let help = "what is measured hardly changes with it, or less than the tolerance of the runs: leave it out, measure what \
                    depends on it, or tighten rtol";
        return Err(InputError::new("unknown", &unknowns[at].name, help));
    }
    let (rows, columns) = (residuals.len(), slopes.len());
    let scaled = DMatrix::from_fn(rows, columns, |row, column| slopes[column][row] / norms[column]);
    let svd = scaled.svd(false, true);
    let (Some(directions), sizes) = (svd.v_t, svd.singular_values) else {
        return Ok(vec![f64::INFINITY; columns]);
    };
    let least = sizes.imin();
    if sizes[least] <= noise {
        let together = directions.row(least);
        let together = unknowns.iter().zip(together.iter()).filter(|(_, part)| part.abs() > 0.1);
        let names = together.map(|(unknown, _)| &unknown.name[..]).collect::<Vec<_>>().join(", ");
        let help = "changes of one are made up for by the others, so that what is measured does not tell them apart: leave one \
                    of them out, or measure more";
        return Err(InputError::new("unknowns", names, help));
    }
    let free = independent - columns as f64;
    if free < 1.0 {
        return Ok(vec![f64::INFINITY; columns]);
    }
    let deviation = norm(residuals) / free.sqrt();
    let half_width = |at: usize| {
        let parts = directions.column(at);
        let spread = parts.iter().zip(sizes.iter()).map(|(part, size)| (part / size).powi(2));
        student(free) * deviation * spread.sum::<f64>().sqrt() / norms[at]
    };
    Ok((0..columns).map(half_width).collect())
}

/// Effective number of independent numbers of a series: n / (1 + 2 sum |rho_k|), with the autocorrelations rho_k
/// up to n/2 that are larger than three times 1/sqrt(n), their standard deviation for independent numbers.
///
/// The variance of the fitted values grows by the factor 1 + 2 sum rho_k r_k, with the autocorrelations r_k
/// of the slopes (M. S. Bartlett, Journal of the Royal Statistical Society 98 (1935) 536-543): by the factor
/// above or less, for any slopes.
pub(super) fn independent(series: &[f64]) -> f64 {
    let count = series.len() as f64;
    let square = norm(series).powi(2);
    let correlation = |lag: usize| {
        let products = series.iter().zip(&series[lag..]).map(|(a, b)| a * b);
        (products.sum::<f64>() / square).abs()
    };
    let alike: f64 =
        (1..=series.len() / 2).map(correlation).filter(|rho| *rho > 3.0 / count.sqrt()).sum();
    count / (1.0 + 2.0 * alike)
}

pub(super) fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// The 97.5 % quantile of Student's distribution with `free` >= 1 degrees of freedom, n.
///
/// With t = sqrt(n) tan(a) its density is Gamma((n + 1)/2) / (sqrt(pi) Gamma(n/2)) cos(a)^(n - 1) da, smooth
/// up to the quantile: Simpson's rule integrates it from 0, and bisection finds where the integral is 0.475.
fn student(free: f64) -> f64 {
    const PANELS: usize = 400;
    let density = |angle: f64| angle.cos().powf(free - 1.0);
    let asked = 0.475 * PI.sqrt() / half_step_of_gamma(0.5 * free);
    // 12.7 with one degree of freedom, and less with more
    let [mut low, mut high] = [0.0, (13.0 / free.sqrt()).atan()];
    for _ in 0..f64::MANTISSA_DIGITS {
        let angle: f64 = 0.5 * (low + high);
        let width = angle / PANELS as f64;
        let inner = (1..PANELS).map(|k| [2.0, 4.0][k % 2] * density(k as f64 * width));
        let sum = (density(0.0) + inner.sum::<f64>() + density(angle)) * width / 3.0;
        *if sum < asked { &mut low } else { &mut high } = angle;
    }
    free.sqrt() * low.tan()
}

/// Gamma(a + 1/2) / Gamma(a): by its expansion for large a, off by 1e-13 from 30 on; by Gamma(a + 1) = a
/// Gamma(a) for smaller a.
fn half_step_of_gamma(mut a: f64) -> f64 {
    let mut factor = 1.0;
    while a < 30.0 {
        factor *= a / (a + 0.5);
        a += 1.0;
    }
    let exponent = -1.0 / (8.0 * a) + 1.0 / (192.0 * a.powi(3)) - 1.0 / (640.0 * a.powi(5));
    factor * a.sqrt() * exponent.exp()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::{independent, norm, student};

    /// Against a table (Abramowitz, Stegun, 26.10).
    #[test]
    fn quantiles_are_those_of_tables() {
        for (free, quantile) in [
            (1.0, 12.706),
            (2.0, 4.303),
            (3.0, 3.182),
            (5.0, 2.571),
            (10.0, 2.228),
            (30.0, 2.042),
            (1e9, 1.960),
        ] {
            // half a unit of the last digit of the table
            assert!((student(free) - quantile).abs() <= 5.1e-4, "{free}: {}", student(free));
        }
    }

    /// In closed form with 1 and 2 degrees of freedom; between whole numbers, the probability beyond a
    /// quantile, by the trapezoidal rule over ln t.
    #[test]
    fn quantiles_are_those_of_closed_forms_and_sums() {
        let cauchy = (0.475 * PI).tan();
        let second = 0.95 * (2.0 / (1.0 - 0.95_f64.powi(2))).sqrt();
        // bisection stops at the round-off of the angle, 1e-16 of which is 1e-15 of such a tangent
        for (free, quantile) in [(1.0, cauchy), (2.0, second)] {
            let found = student(free) / quantile - 1.0;
            println!("{free}: {found:e}");
            assert!(found.abs() < 1e-11, "{free}: {found}");
        }
        for free in [1.05, 1.5, 2.7, 7.3, 150.5] {
            let density = |t: f64| (1.0 + t * t / free).powf(-0.5 * (free + 1.0));
            let sum = |from: f64| -> f64 {
                let times = (0..400_000).map(|k| (from.ln() + 1e-4 * f64::from(k)).exp());
                let all: f64 = times.map(|t| t * density(t)).sum();
                1e-4 * (all - 0.5 * from * density(from))
            };
            // the whole integral: from 1e-8 on, and below, where the density is 1, its length
            let part = sum(student(free)) / (sum(1e-8) + 1e-8);
            println!("{free}: {part}");
            // the trapezoidal rule is off by 1e-9 of the density at its end
            assert!((part - 0.05).abs() < 1e-8, "{free}: {part}");
        }
    }

    /// Numbers of variance 1 from an autoregression of order 1; `alike` is the correlation of each with the
    /// one before.
    fn noise(count: usize, alike: f64, state: &mut u64) -> Vec<f64> {
        let mut last = 0.0;
        let mut next = || {
            // the sum of twelve random numbers between 0 and 1 is nearly normal
            let sum = (0..12).map(|_| {
                *state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (*state >> 11) as f64 / 2_f64.powi(53)
            });
            last = alike * last + (1.0 - alike * alike).sqrt() * (sum.sum::<f64>() - 6.0);
            last
        };
        let numbers: Vec<f64> = (0..50 + count).map(|_| next()).collect();
        numbers[50..].to_vec()
    }

    /// How often the 95 % interval of a number that is fitted to 400 errors with the slopes `slope` contains
    /// it.
    fn held(alike: f64, counts: &dyn Fn(&[f64]) -> f64, slope: &dyn Fn(usize) -> f64) -> f64 {
        let slopes: Vec<f64> = (0..400).map(slope).collect();
        let (trials, mut state, mut held) = (400, 7, 0);
        for _ in 0..trials {
            let errors = noise(slopes.len(), alike, &mut state);
            let found = errors.iter().zip(&slopes).map(|(error, slope)| error * slope).sum::<f64>()
                / norm(&slopes).powi(2);
            let left: Vec<f64> =
                errors.iter().zip(&slopes).map(|(error, slope)| error - found * slope).collect();
            let free = counts(&left) - 1.0;
            let half = student(free) * norm(&left) / free.sqrt() / norm(&slopes);
            held += usize::from(found.abs() < half);
        }
        held as f64 / trials as f64
    }

    /// Errors that are correlated from one time to the next make intervals wider: intervals that count all
    /// errors as independent are wrong half of the time.
    #[test]
    fn intervals_hold_what_they_say() {
        let constant = |_: usize| 1.0;
        let swing = |t: usize| (0.05 * t as f64).sin();
        let all = |left: &[f64]| left.len() as f64;
        for (alike, slope) in [
            (0.9, &constant as &dyn Fn(usize) -> f64),
            (0.9, &swing),
            (0.0, &constant),
            (0.0, &swing),
        ] {
            let [naive, found] = [&all as &dyn Fn(&[f64]) -> f64, &independent]
                .map(|counts| held(alike, counts, slope));
            println!("{alike}: {naive} {found}");
            // 95 % in 400 trials is 0.95 +- 0.022; an autocorrelation estimated from so few numbers is a
            // little too small
            assert!(found > 0.87, "{alike}: {found}");
            match alike > 0.0 {
                true => assert!(naive < 0.6, "{naive}"),
                false => assert!((found - 0.95).abs() < 0.04, "{found}"),
            }
        }
    }
}

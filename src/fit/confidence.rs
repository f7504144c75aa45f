//! How sure fitted values are, and which cannot be told.

use nalgebra::DMatrix;

use super::unknown::Unknown;
use crate::input::InputError;

/// Half widths, in parts of the ranges, of the intervals in which the unknowns lie with a confidence of 95 %: Student's, by
/// the covariance s^2 (J^T J)^-1, where J has a column of `slopes` for each unknown and s^2 is the variance of the `residuals`,
/// of which `independent` ones are independent of the others.
///
/// # Errors
/// Slopes below the `noise`, a part of the largest of them, or alike to that part.
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
        let mend = "what is measured hardly changes with it, or less than the tolerance of the runs: leave it out, measure what \
                    depends on it, or tighten rtol";
        return Err(InputError::new("unknown", &unknowns[at].name, mend));
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
        let mend = "changes of one are made up for by the others, so that what is measured does not tell them apart: leave one \
                    of them out, or measure more";
        return Err(InputError::new("unknowns", names, mend));
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

/// How many independent numbers a series counts as: n / (1 + 2 sum |rho_k|), of the autocorrelations rho_k up to n/2 that are larger than three
/// times what chance makes of independent ones, 1/sqrt(n).
///
/// With the slopes' own autocorrelation r_k the variance of what is fitted grows by 1 + 2 sum rho_k r_k (M. S. Bartlett, Journal of the Royal
/// Statistical Society 98 (1935) 536-543): by this or less, whatever the slopes are.
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

/// The 97.5 % quantile of Student's distribution with `free` degrees of freedom, by the expansion about the normal one
/// (M. Abramowitz, I. A. Stegun, *Handbook of Mathematical Functions*, 26.7.5); off by less than 1 % from 3 on.
fn student(free: f64) -> f64 {
    let z: f64 = 1.959_963_985;
    let [z3, z5, z7] = [3, 5, 7].map(|power| z.powi(power));
    z + (z3 + z) / (4.0 * free)
        + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * free.powi(2))
        + (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * free.powi(3))
}

#[cfg(test)]
mod tests {
    use super::{independent, norm, student};

    /// Against a table (Abramowitz, Stegun, 26.10).
    #[test]
    fn quantiles_are_those_of_tables() {
        for (free, quantile) in
            [(3.0, 3.182), (5.0, 2.571), (10.0, 2.228), (30.0, 2.042), (1e9, 1.960)]
        {
            assert!((student(free) / quantile - 1.0).abs() < 0.01, "{free}: {}", student(free));
        }
    }

    /// Numbers of variance 1, each `alike` to the one before: an autoregression of order 1.
    fn noise(count: usize, alike: f64, state: &mut u64) -> Vec<f64> {
        let mut last = 0.0;
        let mut next = || {
            // twelve numbers between 0 and 1 are nearly normal
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

    /// How often the interval of 95 % of a number, fitted to 400 errors around it that go with `slope`, holds it.
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

    /// Errors that are alike from one time to the next make intervals wider: those that count all as independent are wrong half of the time.
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
            // of 400 trials 95 % are 0.95 +- 0.022; an autocorrelation of so few numbers is a little too small
            assert!(found > 0.87, "{alike}: {found}");
            match alike > 0.0 {
                true => assert!(naive < 0.6, "{naive}"),
                false => assert!((found - 0.95).abs() < 0.04, "{found}"),
            }
        }
    }
}

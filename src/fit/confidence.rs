//! How sure fitted values are, and which cannot be told.

use nalgebra::DMatrix;

use super::unknown::Unknown;
use crate::input::InputError;

/// Half widths, in parts of the ranges, of the intervals in which the unknowns lie with a confidence of 95 %: Student's, by
/// the covariance s^2 (J^T J)^-1, where J has a column of `slopes` for each unknown and s^2 is the variance of the `residuals`.
///
/// # Errors
/// Slopes below the `noise`, a part of the largest of them, or alike to that part.
pub(super) fn confidence(
    unknowns: &[Unknown],
    slopes: &[Vec<f64>],
    residuals: &[f64],
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
    let free = (rows - columns) as f64;
    let deviation = norm(residuals) / free.sqrt();
    let half_width = |at: usize| {
        let parts = directions.column(at);
        let spread = parts.iter().zip(sizes.iter()).map(|(part, size)| (part / size).powi(2));
        student(free) * deviation * spread.sum::<f64>().sqrt() / norms[at]
    };
    Ok((0..columns).map(half_width).collect())
}

fn norm(values: &[f64]) -> f64 {
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
    use super::student;

    /// Against a table (Abramowitz, Stegun, 26.10).
    #[test]
    fn quantiles_are_those_of_tables() {
        for (free, quantile) in
            [(3.0, 3.182), (5.0, 2.571), (10.0, 2.228), (30.0, 2.042), (1e9, 1.960)]
        {
            assert!((student(free) / quantile - 1.0).abs() < 0.01, "{free}: {}", student(free));
        }
    }
}

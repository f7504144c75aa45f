//! Comparison of supplied derivatives with differences.

use faer::MatMut;
use thiserror::Error;

use crate::base::input::InputError;
use crate::integrators::ode::{
    band::BandMut, entries::Entries, failure::Failure, storage::Storage,
};

/// Error of a check of supplied derivatives.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CheckError {
    /// A supplied derivative does not agree with differences.
    #[error(
        "{method}: entry {entry:?} is {supplied:?}, but {difference:?} by central differences, which are right to \
         {tolerance:.1e}"
    )]
    Mismatch {
        /// The method that supplied it.
        method: &'static str,
        /// Row and column: equation or result, unknown or parameter.
        entry: (usize, usize),
        /// The supplied value.
        supplied: f64,
        /// The value by central differences.
        difference: f64,
        /// Largest difference allowed between both.
        tolerance: f64,
    },
    /// The equations have no value here.
    #[error("the equations can not be evaluated: {0}")]
    Failed(Failure),
    /// The point does not fit the equations.
    #[error(transparent)]
    Input(#[from] InputError),
}

impl From<Failure> for CheckError {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

impl Storage<'_> {
    pub(super) fn method(&self) -> &'static str {
        match self {
            Self::Dense => "dense_jacobian",
            Self::Band { .. } => "banded_jacobian",
            Self::Sparse { .. } => "sparse_jacobian",
        }
    }

    fn check(&self, n: usize) -> Result<(), InputError> {
        match self {
            Self::Band { lower, upper } if *lower >= n || *upper >= n => Err(InputError::new(
                "bandwidths (lower, upper)",
                format!("({lower}, {upper})"),
                format!("both are smaller than the number of unknowns, {n}"),
            )),
            Self::Sparse { column_pointers, row_indices } => {
                let ends =
                    column_pointers.windows(2).all(|ends| 0 <= ends[0] && ends[0] <= ends[1]);
                let all = row_indices.len() as i64;
                let rows = row_indices.iter().all(|row| (0..n as i64).contains(row));
                if ends && rows && column_pointers.len() == n + 1 && column_pointers[n] == all {
                    return Ok(());
                }
                let help = format!("they are those of a Pattern of {n} unknowns");
                Err(InputError::new("column_pointers and row_indices", "given", help))
            }
            _ => Ok(()),
        }
    }
}

/// The supplied Jacobian as a full matrix, column after column.
pub(super) fn full_matrix(
    n: usize,
    storage: Storage<'_>,
    fill: impl FnOnce(Entries<'_>) -> Result<(), Failure>,
) -> Result<Vec<f64>, CheckError> {
    storage.check(n)?;
    let mut matrix = vec![0.0; n * n];
    match storage {
        Storage::Dense => {
            fill(Entries::Dense(MatMut::from_column_major_slice_mut(&mut matrix, n, n)))?
        }
        Storage::Band { lower, upper } => {
            let stride = lower + upper + 1;
            let mut data = vec![0.0; n * stride];
            fill(Entries::Band(BandMut::new(&mut data, stride, upper, lower, upper)))?;
            let band = BandMut::new(&mut data, stride, upper, lower, upper);
            for j in 0..n {
                for i in j.saturating_sub(upper)..=(j + lower).min(n - 1) {
                    matrix[j * n + i] = band[(i, j)];
                }
            }
        }
        Storage::Sparse { column_pointers, row_indices } => {
            let mut values = vec![0.0; row_indices.len()];
            fill(Entries::Sparse(&mut values))?;
            for (j, ends) in column_pointers.windows(2).enumerate() {
                for place in ends[0] as usize..ends[1] as usize {
                    matrix[j * n + row_indices[place] as usize] += values[place];
                }
            }
        }
    }
    Ok(matrix)
}

/// The slope of `evaluate(step, out)` at step 0, and its largest error, for each result; `size` is that of
/// the number that is varied.
pub(super) fn slope(
    count: usize,
    size: f64,
    mut evaluate: impl FnMut(f64, &mut [f64]) -> Result<(), Failure>,
) -> Result<Vec<(f64, f64)>, CheckError> {
    let step = 1e-3 * size;
    let mut at = |step: f64| {
        let mut out = vec![0.0; count];
        evaluate(step, &mut out).map(|()| out)
    };
    let (wide, near) = ([at(step)?, at(-step)?], [at(step / 2.0)?, at(-step / 2.0)?]);
    let largest = wide.iter().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let rounding = 1e3 * f64::EPSILON * largest / step;
    let estimate = |i: usize| {
        let wide = (wide[0][i] - wide[1][i]) / (2.0 * step);
        let near = (near[0][i] - near[1][i]) / step;
        let best = near + (near - wide) / 3.0;
        (best, (near - wide).abs() + 1e-8 * best.abs() + rounding)
    };
    Ok((0..count).map(estimate).collect())
}

pub(super) fn compare(
    method: &'static str,
    column: usize,
    supplied: &[f64],
    differences: &[(f64, f64)],
) -> Result<(), CheckError> {
    for (row, (&supplied, &(difference, tolerance))) in supplied.iter().zip(differences).enumerate()
    {
        let fits = (supplied - difference).abs() <= tolerance;
        if !fits {
            let entry = (row, column);
            return Err(CheckError::Mismatch { method, entry, supplied, difference, tolerance });
        }
    }
    Ok(())
}

/// The size of a number among others: its own, or a thousandth of the largest, or 1 if all are zero.
pub(super) fn size(values: &[f64], i: usize) -> f64 {
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    match values[i].abs().max(1e-3 * largest) {
        0.0 => 1.0,
        size => size,
    }
}

/// The distance along `s` at which the first number of `y` has changed by its size.
pub(super) fn along(y: &[f64], s: &[f64]) -> f64 {
    let ratios = s.iter().enumerate().map(|(i, s)| size(y, i) / s.abs());
    ratios.fold(f64::INFINITY, f64::min)
}

pub(super) fn moved(values: &[f64], i: usize, step: f64) -> Vec<f64> {
    let mut moved = values.to_vec();
    moved[i] += step;
    moved
}

pub(super) fn shifted(values: &[f64], direction: &[f64], step: f64) -> Vec<f64> {
    values.iter().zip(direction).map(|(value, direction)| value + step * direction).collect()
}

pub(super) fn same_length(input: &str, len: usize, n: usize) -> Result<(), InputError> {
    if len == n {
        return Ok(());
    }
    Err(InputError::new(input, len, format!("there are {n} unknowns")))
}

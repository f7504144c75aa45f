//! Checks of supplied derivatives against central differences, without a solver: for tests of equations.
//!
//! Each function compares at one point, which should be a general one, not zero. Differences are taken with
//! two step sizes, whose results show how accurate they are.
//!
//! ```
//! use pliant::ode::{check, with_jacobian};
//!
//! let mut wrong = with_jacobian(
//!     |_t, y, ydot| {
//!         ydot[0] = y[0] * y[1];
//!         ydot[1] = -y[1];
//!         Ok(())
//!     },
//!     |_t, y, _ydot, mut jacobian| {
//!         jacobian[(0, 0)] = y[1];
//!         jacobian[(0, 1)] = -y[0];
//!         jacobian[(1, 1)] = -1.0;
//!         Ok(())
//!     },
//! );
//! let error = check::jacobian(&mut wrong, 0.0, &[2.0, 3.0], check::Storage::Dense).unwrap_err();
//! assert!(error.to_string().starts_with("dense_jacobian: entry (0, 1) is -2.0"));
//! ```

use faer::MatMut;
use thiserror::Error;

pub use super::storage::Storage;
use super::{
    band::BandMut,
    call,
    dae::Dae,
    entries::Entries,
    failure::Failure,
    first_order::Ode,
    functional::{Functional, Slopes},
};
use crate::base::input::InputError;

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

/// Checks df/dy of an [`Ode`].
///
/// # Errors
/// The first entry that is wrong, or why none can be checked.
pub fn jacobian(
    system: &mut (impl Ode + ?Sized),
    t: f64,
    y: &[f64],
    storage: Storage<'_>,
) -> Result<(), CheckError> {
    let n = y.len();
    let mut ydot = vec![0.0; n];
    call::rhs(system, t, y, &mut ydot)?;
    let fill = |entries: Entries<'_>| entries.jacobian(system, t, y, &ydot);
    let supplied = full_matrix(n, storage, fill)?;
    for j in 0..n {
        let column =
            slope(n, size(y, j), |step, out| call::rhs(system, t, &moved(y, j, step), out))?;
        compare(storage.method(), j, &supplied[j * n..][..n], &column)?;
    }
    Ok(())
}

/// Checks dF/dy + cj dF/dy' of a [`Dae`].
///
/// # Errors
/// As for [`jacobian`].
pub fn dae_jacobian(
    system: &mut (impl Dae + ?Sized),
    t: f64,
    cj: f64,
    y: &[f64],
    yp: &[f64],
    storage: Storage<'_>,
) -> Result<(), CheckError> {
    let n = y.len();
    same_length("length of yp", yp.len(), n)?;
    let fill = |entries: Entries<'_>| entries.dae_jacobian(system, t, cj, y, yp);
    let supplied = full_matrix(n, storage, fill)?;
    for j in 0..n {
        let column = slope(n, size(y, j), |step, out| {
            call::residual(system, t, &moved(y, j, step), &moved(yp, j, cj * step), out)
        })?;
        compare(storage.method(), j, &supplied[j * n..][..n], &column)?;
    }
    Ok(())
}

/// Checks [`Ode::sensitivity_rhs`] of all parameters, with the sensitivity `s`.
///
/// # Errors
/// As for [`jacobian`].
pub fn sensitivity_rhs(
    system: &mut (impl Ode + ?Sized),
    t: f64,
    y: &[f64],
    s: &[f64],
) -> Result<(), CheckError> {
    let n = y.len();
    same_length("length of s", s.len(), n)?;
    let (mut ydot, mut sdot, p) = (vec![0.0; n], vec![0.0; n], system.parameters().to_vec());
    call::rhs(system, t, y, &mut ydot)?;
    for parameter in 0..p.len() {
        call::sensitivity_rhs(system, t, y, &ydot, parameter, s, &mut sdot)?;
        let column = slope(n, along(y, s).min(size(&p, parameter)), |step, out| {
            system.set_parameters(&moved(&p, parameter, step));
            let outcome = call::rhs(system, t, &shifted(y, s, step), out);
            system.set_parameters(&p);
            outcome
        })?;
        compare("sensitivity_rhs", parameter, &sdot, &column)?;
    }
    Ok(())
}

/// Checks [`Dae::sensitivity_residual`] of all parameters, with the sensitivity `s` and its derivative `sp`.
///
/// # Errors
/// As for [`jacobian`].
pub fn sensitivity_residual(
    system: &mut (impl Dae + ?Sized),
    t: f64,
    (y, yp): (&[f64], &[f64]),
    (s, sp): (&[f64], &[f64]),
) -> Result<(), CheckError> {
    let n = y.len();
    for (input, len) in [("yp", yp.len()), ("s", s.len()), ("sp", sp.len())] {
        same_length(input, len, n)?;
    }
    let (mut supplied, p) = (vec![0.0; n], system.parameters().to_vec());
    for parameter in 0..p.len() {
        call::sensitivity_residual(system, t, y, yp, parameter, s, sp, &mut supplied)?;
        let column = slope(n, along(y, s).min(size(&p, parameter)), |step, out| {
            system.set_parameters(&moved(&p, parameter, step));
            let outcome =
                call::residual(system, t, &shifted(y, s, step), &shifted(yp, sp, step), out);
            system.set_parameters(&p);
            outcome
        })?;
        compare("sensitivity_residual", parameter, &supplied, &column)?;
    }
    Ok(())
}

/// Checks [`Ode::adjoint_rhs`] with the adjoint `lambda`.
///
/// # Errors
/// As for [`jacobian`].
pub fn adjoint_rhs(
    system: &mut (impl Ode + ?Sized),
    t: f64,
    y: &[f64],
    lambda: &[f64],
) -> Result<(), CheckError> {
    let n = y.len();
    same_length("length of lambda", lambda.len(), n)?;
    let (mut supplied, mut ydot) = (vec![0.0; n], vec![0.0; n]);
    call::adjoint_rhs(system, t, y, lambda, &mut supplied)?;
    for (j, supplied) in supplied.iter().enumerate() {
        let number = slope(1, size(y, j), |step, out| {
            call::rhs(system, t, &moved(y, j, step), &mut ydot)?;
            out[0] = ydot.iter().zip(lambda).map(|(f, lambda)| f * lambda).sum();
            Ok(())
        })?;
        compare("adjoint_rhs", j, &[*supplied], &number)?;
    }
    Ok(())
}

/// Checks [`Ode::adjoint_parameters`] with the adjoint `lambda`.
///
/// # Errors
/// As for [`jacobian`].
pub fn adjoint_parameters(
    system: &mut (impl Ode + ?Sized),
    t: f64,
    y: &[f64],
    lambda: &[f64],
) -> Result<(), CheckError> {
    same_length("length of lambda", lambda.len(), y.len())?;
    let p = system.parameters().to_vec();
    let (mut supplied, mut ydot) = (vec![0.0; p.len()], vec![0.0; y.len()]);
    call::adjoint_parameters(system, t, y, lambda, &mut supplied)?;
    for (j, supplied) in supplied.iter().enumerate() {
        let number = slope(1, size(&p, j), |step, out| {
            system.set_parameters(&moved(&p, j, step));
            let outcome = call::rhs(system, t, y, &mut ydot);
            system.set_parameters(&p);
            outcome?;
            out[0] = ydot.iter().zip(lambda).map(|(f, lambda)| f * lambda).sum();
            Ok(())
        })?;
        compare("adjoint_parameters", j, &[*supplied], &number)?;
    }
    Ok(())
}

/// Checks the slopes of a [`Functional`]. Columns of [`CheckError::Mismatch`] are the unknowns, then the
/// parameters.
///
/// # Errors
/// As for [`jacobian`].
pub fn functional<F: Functional + ?Sized>(
    functional: &mut F,
    t: f64,
    y: &[f64],
    p: &[f64],
) -> Result<(), CheckError> {
    type Value<F> = fn(&mut F, f64, &[f64], &[f64], Option<Slopes<'_>>) -> Result<f64, Failure>;
    let methods: [(&'static str, Value<F>); 2] =
        [("running", F::running), ("terminal", F::terminal)];
    for (method, value) in methods {
        let (mut by_y, mut by_p) = (vec![0.0; y.len()], vec![0.0; p.len()]);
        value(functional, t, y, p, Some(Slopes { y: &mut by_y, p: &mut by_p }))?;
        for (j, supplied) in by_y.iter().enumerate() {
            let number = slope(1, size(y, j), |step, out| {
                out[0] = value(functional, t, &moved(y, j, step), p, None)?;
                Ok(())
            })?;
            compare(method, j, &[*supplied], &number)?;
        }
        for (j, supplied) in by_p.iter().enumerate() {
            let number = slope(1, size(p, j), |step, out| {
                out[0] = value(functional, t, y, &moved(p, j, step), None)?;
                Ok(())
            })?;
            compare(method, y.len() + j, &[*supplied], &number)?;
        }
    }
    Ok(())
}

impl Storage<'_> {
    fn method(&self) -> &'static str {
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
fn full_matrix(
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
fn slope(
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

fn compare(
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
fn size(values: &[f64], i: usize) -> f64 {
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    match values[i].abs().max(1e-3 * largest) {
        0.0 => 1.0,
        size => size,
    }
}

/// The distance along `s` at which the first number of `y` has changed by its size.
fn along(y: &[f64], s: &[f64]) -> f64 {
    let ratios = s.iter().enumerate().map(|(i, s)| size(y, i) / s.abs());
    ratios.fold(f64::INFINITY, f64::min)
}

fn moved(values: &[f64], i: usize, step: f64) -> Vec<f64> {
    let mut moved = values.to_vec();
    moved[i] += step;
    moved
}

fn shifted(values: &[f64], direction: &[f64], step: f64) -> Vec<f64> {
    values.iter().zip(direction).map(|(value, direction)| value + step * direction).collect()
}

fn same_length(input: &str, len: usize, n: usize) -> Result<(), InputError> {
    if len == n {
        return Ok(());
    }
    Err(InputError::new(input, len, format!("there are {n} unknowns")))
}

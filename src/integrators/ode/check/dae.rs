//! Derivatives of DAEs.

use super::differences::{
    CheckError, along, compare, full_matrix, moved, same_length, shifted, size, slope,
};
use crate::base::vector::dot;
use crate::integrators::ode::{call, dae::Dae, entries::Entries, storage::Storage};

/// Checks dF/dy + cj dF/dy' of a [`Dae`].
///
/// # Errors
/// As for [`jacobian`](super::jacobian).
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

/// Checks [`Dae::sensitivity_residual`] of all parameters, with the sensitivity `s` and its derivative `sp`.
///
/// # Errors
/// As for [`jacobian`](super::jacobian).
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

/// Checks [`Dae::adjoint_residual`] with the multipliers `lambda` of dF/dy and `mu` of dF/dy'.
///
/// # Errors
/// As for [`jacobian`](super::jacobian).
pub fn adjoint_residual(
    system: &mut (impl Dae + ?Sized),
    t: f64,
    (y, yp): (&[f64], &[f64]),
    (lambda, mu): (&[f64], &[f64]),
) -> Result<(), CheckError> {
    let n = y.len();
    for (input, len) in [("yp", yp.len()), ("lambda", lambda.len()), ("mu", mu.len())] {
        same_length(input, len, n)?;
    }
    let (mut supplied, mut residual) = (vec![0.0; n], vec![0.0; n]);
    call::adjoint_residual(system, t, y, yp, lambda, mu, &mut supplied)?;
    for (j, supplied) in supplied.iter().enumerate() {
        // y and y' differ in size
        let mut total = (0.0, 0.0);
        for (values, factors, by_state) in [(y, lambda, true), (yp, mu, false)] {
            let number = slope(1, size(values, j), |step, out| {
                let moved = moved(values, j, step);
                let at = if by_state { [&moved, yp] } else { [y, &moved] };
                call::residual(system, t, at[0], at[1], &mut residual)?;
                out[0] = dot(&residual, factors);
                Ok(())
            })?;
            total = (total.0 + number[0].0, total.1 + number[0].1);
        }
        compare("adjoint_residual", j, &[*supplied], &[total])?;
    }
    Ok(())
}

/// Checks [`Dae::adjoint_parameters`] with the adjoint `lambda`.
///
/// # Errors
/// As for [`jacobian`](super::jacobian).
pub fn dae_adjoint_parameters(
    system: &mut (impl Dae + ?Sized),
    t: f64,
    (y, yp): (&[f64], &[f64]),
    lambda: &[f64],
) -> Result<(), CheckError> {
    for (input, len) in [("yp", yp.len()), ("lambda", lambda.len())] {
        same_length(input, len, y.len())?;
    }
    let p = system.parameters().to_vec();
    let (mut supplied, mut residual) = (vec![0.0; p.len()], vec![0.0; y.len()]);
    call::dae_adjoint_parameters(system, t, y, yp, lambda, &mut supplied)?;
    for (j, supplied) in supplied.iter().enumerate() {
        let number = slope(1, size(&p, j), |step, out| {
            system.set_parameters(&moved(&p, j, step));
            let outcome = call::residual(system, t, y, yp, &mut residual);
            system.set_parameters(&p);
            outcome?;
            out[0] = dot(&residual, lambda);
            Ok(())
        })?;
        compare("adjoint_parameters", j, &[*supplied], &number)?;
    }
    Ok(())
}

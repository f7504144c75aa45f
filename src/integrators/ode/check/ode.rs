//! Derivatives of ODEs.

use super::differences::{
    CheckError, along, compare, full_matrix, moved, same_length, shifted, size, slope,
};
use crate::integrators::ode::{call, entries::Entries, first_order::Ode, storage::Storage};

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

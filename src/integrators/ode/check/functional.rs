//! Slopes of functionals.

use super::differences::{CheckError, compare, moved, size, slope};
use crate::integrators::ode::{
    failure::Failure,
    functional::{Functional, Slopes},
};

/// Checks the slopes of a [`Functional`]. Columns of [`CheckError::Mismatch`] are the unknowns, then the
/// parameters.
///
/// # Errors
/// As for [`jacobian`](super::jacobian).
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

//! Where the constraints lead.
//!
//! Their stabilized equation R'' + 2 alpha R' + alpha^2 R = 0 for R = A^T u - b has the solution
//!
//! ```text
//! R(t) = (R_0 + (R_0' + alpha R_0) (t - t_0)) exp(-alpha (t - t_0))
//! ```
//!
//! so that A^T u is known beforehand and can be prescribed as it is: no alpha, however large, bounds
//! the step, and nothing drifts.

use crate::constraint::{Prescribed, Row};
use crate::ode::Failure;
use crate::system::System;

/// The motion that each row prescribes.
pub(super) struct Guide {
    since: f64,
    alpha: f64,
    /// R_0 and R_0' + alpha R_0, row by row.
    remainders: Vec<(f64, f64)>,
    /// A^T u and A^T v at the time last aimed at, row by row.
    positions: Vec<f64>,
    pub(super) rates: Vec<f64>,
    means: Vec<f64>,
}

impl Guide {
    /// The guide from (t, u, v) on.
    pub(super) fn new(system: &System, t: f64, u: &[f64], v: &[f64]) -> Result<Self, Failure> {
        let alpha = system.alpha();
        let remainder = |row: &Row| -> Result<(f64, f64), Failure> {
            let Prescribed { displacement, velocity, .. } = system.prescribed(row, t)?;
            let off = row.apply(u) - displacement;
            Ok((off, row.apply(v) - velocity + alpha * off))
        };
        let remainders: Vec<_> = system.rows().iter().map(remainder).collect::<Result<_, _>>()?;
        let zeros = vec![0.0; remainders.len()];
        Ok(Self {
            since: t,
            alpha,
            remainders,
            positions: zeros.clone(),
            means: zeros.clone(),
            rates: zeros,
        })
    }

    /// Finds out `positions` and `rates` at time `t`.
    pub(super) fn aim(&mut self, system: &System, t: f64) -> Result<(), Failure> {
        let Self { since, alpha, remainders, positions, rates, .. } = self;
        let elapsed = t - *since;
        let decay = (-*alpha * elapsed).exp();
        for (k, (row, &(off, slope))) in system.rows().iter().zip(&*remainders).enumerate() {
            let Prescribed { displacement, velocity, .. } = system.prescribed(row, t)?;
            let remainder = off + slope * elapsed;
            positions[k] = displacement + remainder * decay;
            rates[k] = velocity + (slope - *alpha * remainder) * decay;
        }
        Ok(())
    }

    /// Mean rates from `t` on over a time `h`, free of the round-off in differences of positions.
    pub(super) fn mean_rates(
        &mut self,
        system: &System,
        t: f64,
        h: f64,
    ) -> Result<&[f64], Failure> {
        let Self { since, alpha, remainders, means, .. } = self;
        let elapsed = t - *since;
        let decay = (-*alpha * elapsed).exp();
        let [ahead, change] = [(-*alpha * h).exp(), (-*alpha * h).exp_m1() / h];
        for (k, (row, &(off, slope))) in system.rows().iter().zip(&*remainders).enumerate() {
            let velocity = |s: f64| system.prescribed(row, t + s * h).map(|motion| motion.velocity);
            let prescribed = match row.constant_velocity() {
                Some(velocity) => velocity,
                // Simpson's rule
                None => (velocity(0.0)? + 4.0 * velocity(0.5)? + velocity(1.0)?) / 6.0,
            };
            let remainder = (off + slope * elapsed) * change + slope * ahead;
            means[k] = prescribed + remainder * decay;
        }
        Ok(means)
    }

    /// Puts the components that nodal rows prescribe where they were found to be.
    pub(super) fn place(&self, system: &System, u: &mut [f64], v: &mut [f64]) {
        for (k, row) in system.rows().iter().enumerate() {
            if let Some((dof, coefficient)) = row.nodal() {
                u[dof] = self.positions[k] / coefficient;
                v[dof] = self.rates[k] / coefficient;
            }
        }
    }
}

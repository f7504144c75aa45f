//! The motion that the constraints prescribe.
//!
//! Their stabilized equation R'' + 2 alpha R' + alpha^2 R = 0 for R = A^T u - b has the solution
//!
//! ```text
//! R(t) = (R_0 + (R_0' + alpha R_0) (t - t_0)) exp(-alpha (t - t_0))
//! ```
//!
//! so that A^T u is known beforehand and can be prescribed directly: no alpha, however large, bounds the
//! step, and nothing drifts. The same holds for g of the edges of rigid pieces, in place of R.

use super::System;
use crate::integrators::ode::Failure;
use crate::scene::constraint::Prescribed;

/// The motion that each row prescribes.
pub(super) struct Guide {
    since: f64,
    /// R_0 and R_0' + alpha R_0, row by row.
    remainders: Vec<(f64, f64)>,
    /// Whether all of them are 0, so that no decay has to be computed.
    is_on_path: bool,
    /// A^T v after kicks, row by row.
    pub(super) rates: Vec<f64>,
    /// g_0 and g_0' + alpha g_0, edge by edge.
    of_edges: Vec<(f64, f64)>,
    /// g at the end of the step, then g' there.
    pub(super) edges: Vec<f64>,
}

impl Guide {
    /// Without motion, for `rows` rows and `edges` edges.
    pub(super) fn new([rows, edges]: [usize; 2]) -> Self {
        Self {
            since: 0.0,
            remainders: vec![(0.0, 0.0); rows],
            is_on_path: true,
            rates: vec![0.0; rows],
            of_edges: vec![(0.0, 0.0); edges],
            edges: vec![0.0; edges],
        }
    }

    /// Starts the motion from (t, u, v).
    pub(super) fn start(
        &mut self,
        system: &System,
        t: f64,
        u: &[f64],
        v: &[f64],
    ) -> Result<(), Failure> {
        self.since = t;
        for (remainder, row) in self.remainders.iter_mut().zip(&system.rows) {
            let Prescribed { displacement, velocity, .. } = system.prescribed(row, t)?;
            let off = row.apply(u) - displacement;
            *remainder = (off, row.apply(v) - velocity + system.alpha * off);
        }
        self.is_on_path = self.remainders.iter().all(|remainder| *remainder == (0.0, 0.0));
        let of_edges = self.of_edges.iter_mut().zip(system.edges.remainders(u, v));
        of_edges.for_each(|(remainder, [off, rate])| *remainder = (off, rate + system.alpha * off));
        Ok(())
    }

    /// Sets the rates to their means over a time `h` from `t` on, without the round-off in differences of
    /// positions.
    pub(super) fn aim_at_mean_rates(
        &mut self,
        system: &System,
        t: f64,
        h: f64,
    ) -> Result<(), Failure> {
        let (alpha, elapsed) = (system.alpha, t - self.since);
        let [decay, ahead, change] = match self.is_on_path {
            true => [0.0; 3],
            false => [(-alpha * elapsed).exp(), (-alpha * h).exp(), (-alpha * h).exp_m1() / h],
        };
        for (k, (row, &(off, slope))) in system.rows.iter().zip(&self.remainders).enumerate() {
            let velocity = |s: f64| system.prescribed(row, t + s * h).map(|motion| motion.velocity);
            let prescribed = match row.constant_velocity() {
                Some(velocity) => velocity,
                // Simpson's rule
                None => (velocity(0.0)? + 4.0 * velocity(0.5)? + velocity(1.0)?) / 6.0,
            };
            let remainder = (off + slope * elapsed) * change + slope * ahead;
            self.rates[k] = prescribed + remainder * decay;
        }
        let elapsed = elapsed + h;
        for (goal, &(off, slope)) in self.edges.iter_mut().zip(&self.of_edges) {
            *goal = (off + slope * elapsed) * (-alpha * elapsed).exp();
        }
        Ok(())
    }

    /// Sets the components that nodal rows prescribe to their values at time `t`, and the rates to those of
    /// all rows there.
    pub(super) fn prescribe(
        &mut self,
        system: &System,
        t: f64,
        u: &mut [f64],
        v: &mut [f64],
    ) -> Result<(), Failure> {
        let (alpha, elapsed) = (system.alpha, t - self.since);
        let decay = if self.is_on_path { 0.0 } else { (-alpha * elapsed).exp() };
        for (k, (row, &(off, slope))) in system.rows.iter().zip(&self.remainders).enumerate() {
            let Prescribed { displacement, velocity, .. } = system.prescribed(row, t)?;
            let remainder = off + slope * elapsed;
            self.rates[k] = velocity + (slope - alpha * remainder) * decay;
            if let Some((dof, coefficient)) = row.nodal() {
                u[dof] = (displacement + remainder * decay) / coefficient;
                v[dof] = self.rates[k] / coefficient;
            }
        }
        for (goal, &(off, slope)) in self.edges.iter_mut().zip(&self.of_edges) {
            *goal = (slope - alpha * (off + slope * elapsed)) * (-alpha * elapsed).exp();
        }
        Ok(())
    }
}

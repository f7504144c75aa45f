//! The ODE form: y = (u, v, energy dissipated, energy supplied).

use super::System;
use crate::ode::{Failure, Ode};

/// Unknowns that ride along behind u and v.
pub(crate) const ENERGIES: usize = 2;

impl Ode for System {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let n = self.dofs();
        let (u, v) = (&y[..n], &y[n..2 * n]);
        self.evaluate(t, u, v)?;
        ydot[..n].copy_from_slice(v);
        ydot[n..2 * n].copy_from_slice(&self.at.acceleration);
        (ydot[2 * n], ydot[2 * n + 1]) = self.powers(v, &self.at.multipliers);
        Ok(())
    }

    fn newton_setup(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        gamma: f64,
        reuse: bool,
    ) -> Result<bool, Failure> {
        let n = self.dofs();
        let current = self.update_tangents(t, &y[..n], &y[n..2 * n], reuse);
        self.factorize_newton(gamma)?;
        Ok(current)
    }

    /// Leaves the accelerations to [`newton_solve`](Self::newton_solve), and with them the
    /// power of the constraints.
    fn newton_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let n = self.dofs();
        let (u, v) = (&y[..n], &y[n..2 * n]);
        self.evaluate_forces(t, u, v)?;
        self.evaluate_rows(t, u, v)?;
        self.at.multipliers.fill(0.0);
        ydot[..n].copy_from_slice(v);
        ydot[n..2 * n].fill(0.0);
        (ydot[2 * n], ydot[2 * n + 1]) = self.at.nodal.powers(v);
        Ok(())
    }

    fn newton_solve(&mut self, gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        let (motion, energies) = r.split_at_mut(2 * self.dofs());
        let (ru, rv) = motion.split_at_mut(self.dofs());
        self.solve_newton_ode(gamma, ru, rv);
        let (dissipated, supplied) = self.power_changes();
        energies[0] += self.gamma() * dissipated;
        energies[1] += self.gamma() * supplied;
        Ok(())
    }
}

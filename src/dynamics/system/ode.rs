//! The ODE form: y = (u, v, strains of Maxwell branches, amounts, energy dissipated, energy supplied).

use super::System;
use crate::dynamics::state::{ENERGIES, State};
use crate::integrators::ode::{Failure, Ode};

impl Ode for System {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let State { u, v, internal, .. } = self.layout.of(y);
        self.evaluate(t, u, v, internal)?;
        let rates = self.layout.of_mut(ydot);
        rates.u.copy_from_slice(v);
        rates.v.copy_from_slice(&self.at.acceleration);
        (*rates.dissipated, *rates.supplied) = self.powers(v, &self.at.multipliers);
        self.copy_internal_rates(rates.internal);
        Ok(())
    }

    fn integrals(&self) -> usize {
        ENERGIES
    }

    fn newton_setup(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        gamma: f64,
        reuse: bool,
    ) -> Result<bool, Failure> {
        let State { u, v, internal, .. } = self.layout.of(y);
        self.linearize_edges(t, u, v, internal)?;
        self.linearize(t, y, gamma, reuse)
    }

    /// Leaves the accelerations to [`newton_solve`](Self::newton_solve), and with them the
    /// power of the constraints; but where rigid pieces turn and there is no iteration that would follow them.
    fn newton_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        if self.has_fixed_edges() {
            return self.rhs(t, y, ydot);
        }
        let State { u, v, internal, .. } = self.layout.of(y);
        self.evaluate_forces(t, u, v, internal)?;
        self.evaluate_rows(t, u, v)?;
        self.at.multipliers.fill(0.0);
        let rates = self.layout.of_mut(ydot);
        rates.u.copy_from_slice(v);
        rates.v.fill(0.0);
        (*rates.dissipated, *rates.supplied) = self.powers(v, &self.at.multipliers);
        self.copy_internal_rates(rates.internal);
        Ok(())
    }

    fn newton_solve(&mut self, gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        let r = self.layout.of_mut(r);
        let share = if self.has_fixed_edges() { 0.0 } else { gamma };
        self.solve_newton_ode(share, r.u, r.v, r.internal);
        let [dissipated, supplied] = self.solve_internal(r.u, r.internal);
        *r.dissipated += self.gamma() * dissipated;
        *r.supplied += self.gamma() * supplied;
        Ok(())
    }
}

//! The ODE form: y = (u, v, energy dissipated, energy supplied).

use super::System;
use crate::ode::{Failure, Ode};
use crate::state::{ENERGIES, State, StateMut};

impl Ode for System {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let State { u, v, .. } = State::of(y, self.dofs());
        self.evaluate(t, u, v)?;
        let rates = StateMut::of(ydot, self.dofs());
        rates.u.copy_from_slice(v);
        rates.v.copy_from_slice(&self.at.acceleration);
        (*rates.dissipated, *rates.supplied) = self.powers(v, &self.at.multipliers);
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
        let State { u, v, .. } = State::of(y, self.dofs());
        let current = self.update_tangents(t, u, v, reuse);
        self.factorize_newton(gamma)?;
        Ok(current)
    }

    /// Leaves the accelerations to [`newton_solve`](Self::newton_solve), and with them the
    /// power of the constraints.
    fn newton_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let State { u, v, .. } = State::of(y, self.dofs());
        self.evaluate_forces(t, u, v)?;
        self.evaluate_rows(t, u, v)?;
        self.at.multipliers.fill(0.0);
        let rates = StateMut::of(ydot, self.dofs());
        rates.u.copy_from_slice(v);
        rates.v.fill(0.0);
        (*rates.dissipated, *rates.supplied) = self.at.nodal.powers(v);
        Ok(())
    }

    fn newton_solve(&mut self, gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        let r = StateMut::of(r, self.dofs());
        self.solve_newton_ode(gamma, r.u, r.v);
        let (dissipated, supplied) = self.power_changes();
        *r.dissipated += self.gamma() * dissipated;
        *r.supplied += self.gamma() * supplied;
        Ok(())
    }
}

//! The ODE form: y = (u, v, energy dissipated, energy supplied, internal strains of Maxwell branches, amounts of gas).

use super::System;
use crate::dynamics::state::{ENERGIES, State, StateMut};
use crate::integrators::ode::{Failure, Ode};

impl Ode for System {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let State { u, v, others, .. } = State::of(y, self.dofs());
        self.evaluate(t, u, v, others)?;
        let rates = StateMut::of(ydot, self.dofs());
        rates.u.copy_from_slice(v);
        rates.v.copy_from_slice(&self.at.acceleration);
        (*rates.dissipated, *rates.supplied) = self.powers(v, &self.at.multipliers);
        self.copy_internal_rates(rates.others);
        Ok(())
    }

    fn integrals(&self) -> usize {
        // integrals must be the last unknowns: internal ones come after the energies
        if self.internal() == 0 { ENERGIES } else { 0 }
    }

    fn newton_setup(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        gamma: f64,
        reuse: bool,
    ) -> Result<bool, Failure> {
        let State { u, v, others, .. } = State::of(y, self.dofs());
        self.linearize_edges(t, u, v, others)?;
        // what Maxwell branches add depends on gamma
        let (strains, amounts) = self.parts_of(others);
        self.set_lagging(t, others);
        let current = self.update_tangents(t, u, v, reuse && strains.is_empty());
        self.add_branch_tangents(gamma, u, strains);
        if current {
            self.add_flow_tangents(t, [u, v, amounts]);
        }
        self.factorize_newton(gamma)?;
        Ok(current)
    }

    /// Leaves the accelerations to [`newton_solve`](Self::newton_solve), and with them the
    /// power of the constraints; but where rigid pieces turn and there is no iteration that would follow them.
    fn newton_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        if self.has_fixed_edges() {
            return self.rhs(t, y, ydot);
        }
        let State { u, v, others, .. } = State::of(y, self.dofs());
        self.evaluate_forces(t, u, v, others)?;
        self.evaluate_rows(t, u, v)?;
        self.at.multipliers.fill(0.0);
        let rates = StateMut::of(ydot, self.dofs());
        rates.u.copy_from_slice(v);
        rates.v.fill(0.0);
        (*rates.dissipated, *rates.supplied) = self.powers(v, &self.at.multipliers);
        self.copy_internal_rates(rates.others);
        Ok(())
    }

    fn newton_solve(&mut self, gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        let r = StateMut::of(r, self.dofs());
        let share = if self.has_fixed_edges() { 0.0 } else { gamma };
        self.solve_newton_ode(share, r.u, r.v, r.others);
        let (dissipated, supplied) = self.power_changes();
        let (strains, amounts) = r.others.split_at_mut(self.at.relaxing.len());
        let relaxed = self.solve_branches(r.u, strains);
        let [heated, brought] = self.solve_amounts(r.u, amounts);
        *r.dissipated += self.gamma() * (dissipated + relaxed + heated);
        *r.supplied += self.gamma() * (supplied + brought);
        Ok(())
    }
}

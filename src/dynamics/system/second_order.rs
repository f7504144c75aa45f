//! The second-order form, M u'' = f(t, u, u'), whose constraints are known motion.
//!
//! The energies dissipated and supplied are its integrals over time. alpha costs nothing, as constraints are
//! followed along the known solution of their stabilized equation (`guide.rs`).

#[cfg(test)]
mod tests;

use super::System;
use super::guide::Guide;
use super::mobility::Mobility;
use super::rates::RatesBound;
use crate::dynamics::state::ENERGIES;
use crate::integrators::ode::{EnergyBalance, Failure, Kick, Rates, SecondOrder};
use crate::scene::constraint::{ConstraintRow, Prescribed};

/// The equations of a phase as central differences take them. The integrals are the energies
/// dissipated and supplied (J).
pub(crate) struct SecondOrderForm {
    pub(crate) system: System,
    guide: Guide,
    mobility: Mobility,
    bound: RatesBound,
    /// Size of a step (s) until its first kick.
    departs: Option<f64>,
}

impl SecondOrderForm {
    pub(crate) fn new(mut system: System) -> Self {
        let counts = [system.rows.len(), system.edges.list.len()];
        let (guide, mobility) = (Guide::new(counts), Mobility::new(&system));
        let bound = RatesBound::new(&mut system);
        Self { system, guide, mobility, bound, departs: None }
    }
}

impl SecondOrder for SecondOrderForm {
    fn forces(&mut self, t: f64, u: &[f64], v: &[f64], f: &mut [f64]) -> Result<(), Failure> {
        self.system.forces(t, u, v, f)
    }

    fn accelerations(&mut self, kick: &Kick<'_>, a: &mut [f64]) {
        let Self { system, guide, mobility, departs, .. } = self;
        match departs.take() {
            Some(h) => system.aim_edges(h, kick, &guide.edges),
            None => system.lead_edges(kick, &guide.edges),
        }
        mobility.accelerations(system, kick, &guide.rates, a);
    }

    /// Contacts that do not touch are counted as if they did.
    fn rates(&mut self, t: f64, u: &[f64], v: &[f64]) -> Rates {
        self.system.rates(t, u, v, &mut self.bound)
    }

    fn integrals(&self) -> usize {
        ENERGIES
    }

    fn powers(&self, v: &[f64], powers: &mut [f64]) {
        (powers[0], powers[1]) = self.system.at.nodal.powers(v);
    }

    fn balance(&self, t: f64, u: &[f64], v: &[f64], integrals: &[f64]) -> Option<EnergyBalance> {
        let mut energy = self.system.energy(t, u, v, &[]);
        (energy.dissipated, energy.supplied) = (integrals[0], integrals[1]);
        Some(EnergyBalance { energy: energy.balance(), scale: energy.size() })
    }

    fn start(&mut self, t: f64, u: &[f64], v: &[f64]) -> Result<(), Failure> {
        self.guide.start(&self.system, t, u, v)
    }

    fn aim_at_mean_rates(&mut self, t: f64, h: f64) -> Result<bool, Failure> {
        self.guide.aim_at_mean_rates(&self.system, t, h)?;
        Ok(!self.mobility.is_diagonal())
    }

    fn is_curved(&self) -> bool {
        self.system.has_edges()
    }

    fn depart(&mut self, h: f64, u: &[f64]) {
        self.system.edges.place(u);
        self.departs = Some(h);
    }

    fn prescribe(&mut self, t: f64, u: &mut [f64], v: &mut [f64]) -> Result<(), Failure> {
        self.guide.prescribe(&self.system, t, u, v)?;
        let Some(solver) = &self.system.inertia.edges else { return Ok(()) };
        if solver.arrival.is_missed {
            let reason = "a rigid piece turns by more than 60 degrees in a step";
            return Err(Failure::Recoverable(reason.into()));
        }
        self.system.matrices.rigid.iter().for_each(|rigid| rigid.carry(u));
        self.system.edges.place(u);
        Ok(())
    }

    fn lead(&mut self, kick: &Kick<'_>, after: &mut [f64], work: &mut [f64]) {
        work[1] += self.mobility.lead(&self.system, kick, &self.guide.rates, after);
    }
}

impl System {
    /// The sum of all forces at (t, u, v) except those of the constraints.
    pub(crate) fn forces(
        &mut self,
        t: f64,
        u: &[f64],
        v: &[f64],
        total: &mut [f64],
    ) -> Result<(), Failure> {
        self.collect_forces(t, u, v)?;
        self.at.nodal.add_up(total);
        Ok(())
    }

    /// Whether M is diagonal, and each node moves by itself.
    pub(crate) fn is_lumped(&self) -> bool {
        self.matrices.inertia.is_diagonal() && self.matrices.rigid.is_none()
    }

    /// Prescribed motion of a row at time `t`.
    ///
    /// # Errors
    /// A path that gives no finite numbers.
    pub(super) fn prescribed(&self, row: &ConstraintRow, t: f64) -> Result<Prescribed, Failure> {
        let prescribed = row.prescribed(t);
        let Prescribed { displacement, velocity, acceleration } = prescribed;
        match (displacement + velocity + acceleration).is_finite() {
            true => Ok(prescribed),
            false => Err(self.not_finite(row, t)),
        }
    }
}

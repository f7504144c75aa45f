//! The equations of a phase by a reduced model, as an ODE: y = (q, q', internal unknowns, energy dissipated, energy supplied).
//!
//! A phase by a reduced model is a form of the same `System`, as the differential-algebraic forms are. The
//! run sees states of all nodes (`dynamics/simulate/stepper/lifted.rs`), so that samples, sensors, events,
//! commands, checkpoints and forks know nothing of q. u_0 is the state at the start of the phase or after a
//! command: where a new phase has other shapes nothing is lost but the part of the velocities beyond them,
//! which is booked as energy supplied. Constraints are part of the shapes (A^T Phi = 0, and E for those that
//! move), hold exactly and need no multipliers.

#[cfg(test)]
mod tests;

use super::System;
use super::form::Form;
use crate::base::vector::largest;
use crate::dynamics::state::{ENERGIES, State};
use crate::integrators::ode::{Failure, Ode};

/// The equations of a phase in the unknowns of a reduced model.
pub(crate) struct ReducedForm {
    system: System,
    /// Unknowns q.
    free: usize,
}

impl ReducedForm {
    /// The equations of a `system` that has a reduced model, from its `state` at time t
    /// on; with the unknowns of that state. Kinetic energy lost by projecting the velocities onto the model counts as supplied,
    /// below 0.
    ///
    /// # Errors
    /// The system, if it has no reduced model.
    pub(crate) fn new(
        system: System,
        t: f64,
        state: &[f64],
    ) -> Result<(Self, Vec<f64>), Box<System>> {
        let Some(free) = system.reduction.as_ref().map(|own| own.shapes.free()) else {
            return Err(Box::new(system));
        };
        let mut form = Self { system, free };
        // after a rest the motion goes on from where its phase began
        if let Some(y) = form.unknowns_of(t, state) {
            return Ok((form, y));
        }
        let layout = form.system.layout;
        let State { u, v, internal, dissipated, supplied, .. } = layout.of(state);
        let kinetic = form.system.energy(t, u, v, &[]).kinetic;
        let (strains, amounts) = layout.split(internal);
        let System { reduction, matrices, rows, .. } = &mut form.system;
        let [p, of_branches] = match reduction {
            Some(own) => own.begin(matrices, rows, t, [u, v, strains]),
            None => Default::default(),
        };
        let energies = [dissipated, supplied];
        let mut y = [&vec![0.0; free][..], &p, &of_branches, amounts, &energies].concat();
        let mut lifted = vec![0.0; state.len()];
        form.lift(t, &y, &mut lifted);
        let State { u, v, .. } = layout.of(&lifted);
        let kept = form.system.energy(t, u, v, &[]).kinetic;
        parts_mut(&mut y, free)[3][1] += kept - kinetic;
        Ok((form, y))
    }

    /// Writes the state of all nodes for the unknowns y at time t.
    pub(crate) fn lift(&mut self, t: f64, y: &[f64], state: &mut [f64]) {
        let System { reduction, rows, layout, .. } = &mut self.system;
        let [q, p, internal, energies] = parts(y, self.free);
        let all = layout.of_mut(state);
        if let Some(reduction) = reduction {
            reduction.lift(rows, t, [q, p, internal], [all.u, all.v, all.internal]);
        }
        (*all.dissipated, *all.supplied) = (energies[0], energies[1]);
    }

    /// The unknowns of a state of all nodes at time t, if the model has it.
    pub(crate) fn unknowns_of(&mut self, t: f64, state: &[f64]) -> Option<Vec<f64>> {
        let layout = self.system.layout;
        let State { u, v, internal, dissipated, supplied, .. } = layout.of(state);
        let reduction = self.system.reduction.as_ref().filter(|own| own.has_begun())?;
        let [q, p] = reduction.coordinates(&self.system.rows, t, [u, v]);
        let (strains, amounts) = layout.split(internal);
        let of_branches = reduction.branch_unknowns_of(strains)?;
        let y = [&q[..], &p, &of_branches, amounts, &[dissipated, supplied]].concat();
        let mut lifted = vec![0.0; state.len()];
        self.lift(t, &y, &mut lifted);
        let differs = |own: &[f64], lifted: &[f64]| {
            let most = own.iter().zip(lifted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            most > ROUND_OFF * largest(own)
        };
        let own = layout.of(&lifted);
        (!differs(u, own.u) && !differs(v, own.v)).then_some(y)
    }

    /// Number of shapes that are free: q comes first, then as many numbers q', then the internal unknowns.
    pub(crate) fn free(&self) -> usize {
        self.free
    }

    /// Absolute tolerances of the unknowns of Maxwell branches, where that of strains is `strain`.
    pub(crate) fn branch_tolerances(&self, strain: f64) -> Vec<f64> {
        let reduction = self.system.reduction.as_ref();
        reduction.map_or(Vec::new(), |reduction| reduction.branch_tolerances(strain))
    }

    fn evaluate(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let [q, p, internal, _] = parts(y, self.free);
        let System { reduction, rows, refusal, .. } = &mut self.system;
        let Some(reduction) = reduction else { return Ok(()) };
        let evaluated = reduction.evaluate(rows, t, [q, p, internal]);
        if let Err(Failure::Recoverable(reason)) = &evaluated {
            refusal.clone_from(reason);
        }
        evaluated
    }
}

/// q, q', internal unknowns and energies of y, or of y' or a residual.
fn parts(y: &[f64], free: usize) -> [&[f64]; 4] {
    let (q, rest) = y.split_at(free);
    let (p, rest) = rest.split_at(free);
    let (internal, energies) = rest.split_at(rest.len() - ENERGIES);
    [q, p, internal, energies]
}

/// As [`parts`], to be written to.
fn parts_mut(y: &mut [f64], free: usize) -> [&mut [f64]; 4] {
    let (q, rest) = y.split_at_mut(free);
    let (p, rest) = rest.split_at_mut(free);
    let (internal, energies) = rest.split_at_mut(rest.len() - ENERGIES);
    [q, p, internal, energies]
}

/// Part by which a state may differ from one that the model has.
const ROUND_OFF: f64 = 1e-9;

impl Form for ReducedForm {
    fn system(&self) -> &System {
        &self.system
    }

    fn system_mut(&mut self) -> &mut System {
        &mut self.system
    }

    fn into_system(self) -> System {
        self.system
    }
}

impl Ode for ReducedForm {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.evaluate(t, y)?;
        let Some(reduction) = &self.system.reduction else { return Ok(()) };
        let [_, velocities, ..] = parts(y, self.free);
        let [q, p, internal, energies] = parts_mut(ydot, self.free);
        q.copy_from_slice(velocities);
        p.copy_from_slice(reduction.acceleration());
        reduction.copy_internal_rates(internal);
        energies.copy_from_slice(&reduction.powers());
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
        let is_old =
            self.system.reduction.as_ref().is_some_and(|own| reuse && own.keeps_tangents());
        if !is_old {
            self.evaluate(t, y)?;
        }
        let System { reduction, newton, .. } = &mut self.system;
        let Some(reduction) = reduction else { return Ok(true) };
        if !is_old {
            reduction.update_tangents(t);
            newton.tangent_evaluations += 1;
        }
        reduction.factorize(gamma);
        Ok(!is_old || self.system.is_linear())
    }

    fn newton_solve(&mut self, gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        let [ru, rv, internal, energies] = parts_mut(r, self.free);
        let Some(reduction) = &mut self.system.reduction else { return Ok(()) };
        let powers = reduction.solve([ru, rv, internal]);
        energies.iter_mut().zip(powers).for_each(|(energy, power)| *energy += gamma * power);
        Ok(())
    }
}

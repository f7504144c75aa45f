//! The equations of a phase by a reduced model, as an ODE: y = (q, q', internal unknowns, energy dissipated, energy supplied).
//!
//! [`ReducedSystem`] is another implementation of the interface of a run to the equations of a phase (`dynamics/phase/mod.rs`). The
//! run sees states of all nodes (`dynamics/phase/lifted.rs`), so that samples, sensors, events,
//! commands, checkpoints and forks do not depend on q. u_0 is the state at the start of the phase or after a
//! command: if a new phase has other shapes, only the part of the velocities outside of them is lost,
//! which is accounted as energy supplied. Constraints are part of the shapes (A^T Phi = 0, and E for those that
//! move), hold exactly and need no multipliers: those of samples follow from M u'' - f at the held nodes, with the forces of all
//! cells and the accelerations of the model.

mod branches;
mod factors;
mod flow;
mod projection;
mod shapes;
mod spectrum;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use projection::Projection;

use crate::base::input::InputError;
use crate::base::vector::largest;
use crate::dynamics::matrices::Matrices;
use crate::dynamics::state::{ENERGIES, State};
use crate::dynamics::system::{Energy, PhaseSystem, ResidualSnapshot, Spectrum, System};
use crate::elements::body::Body;
use crate::elements::force::Forces;
use crate::integrators::ode::{Failure, Ode};
use crate::scene::constraint::PhaseStart;
use crate::scene::reduced_model::ReducedModel;
use crate::scene::settings::AbsoluteTolerances;
use crate::scene::timeline::Scene;

/// The equations of a phase in the unknowns of a reduced model.
pub(crate) struct ReducedSystem {
    /// Those in all unknowns.
    full: System,
    projection: Projection,
    tangent_evaluations: usize,
    /// Part of the phase after which the equations are to be checked next, once they have been.
    next_check: Option<f64>,
}

/// Part by which a state may differ from one that the model has.
const ROUND_OFF: f64 = 1e-9;

/// # Errors
/// Features that reduced models do not support.
fn check_reducible(matrices: &Matrices) -> Result<(), InputError> {
    if matrices.rigid.is_none() {
        return Ok(());
    }
    let help = "a scene with rigid pieces cannot be reduced yet: run it unreduced";
    Err(InputError::new("reduced model", "of a scene with rigid pieces", help))
}

impl ReducedSystem {
    /// The equations of the phase `name`, `full` ones, by a `model`.
    ///
    /// # Errors
    /// Features that such models do not support, and constraints that this one has not learned.
    pub(crate) fn new(
        full: System,
        body: &Body,
        model: &Arc<ReducedModel>,
        name: &str,
    ) -> Result<Self, InputError> {
        check_reducible(full.matrices())?;
        let (matrices, forces, rows) = (full.matrices(), full.all_forces(), full.rows());
        let projection = Projection::new(body, matrices, &forces, rows, model, name)?;
        Ok(Self { full, projection, tangent_evaluations: 0, next_check: None })
    }

    /// Number of shapes that are free: q comes first, then as many numbers q', then the internal unknowns.
    pub(crate) fn free(&self) -> usize {
        self.projection.shapes.free()
    }

    /// Begins at a `state` at time `t`, and returns the unknowns there. Kinetic energy lost by projecting the velocities onto
    /// the model counts as supplied, below 0.
    pub(crate) fn begin(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        // after a rest the motion goes on from where its phase began
        if let Some(y) = self.unknowns_of(t, state) {
            return y;
        }
        let layout = self.full.layout();
        let State { u, v, internal, dissipated, supplied, .. } = layout.of(state);
        let (strains, amounts) = layout.split(internal);
        let Self { full, projection, .. } = self;
        let [p, of_branches] = projection.begin(full.matrices(), full.rows(), t, [u, v, strains]);
        let q = vec![0.0; p.len()];
        let mut y = [&q[..], &p, &of_branches, amounts, &[dissipated, supplied]].concat();
        let mut lifted = vec![0.0; state.len()];
        self.lift(t, &y, &mut lifted);
        let kept = self.full.kinetic_energy(layout.of(&lifted).v);
        parts_mut(&mut y, q.len())[3][1] += kept - self.full.kinetic_energy(v);
        y
    }

    /// Writes the state of all nodes for the unknowns y at time t.
    pub(crate) fn lift(&mut self, t: f64, y: &[f64], state: &mut [f64]) {
        let [q, p, internal, energies] = parts(y, self.free());
        let all = self.full.layout().of_mut(state);
        let unknowns = [q, p, internal];
        self.projection.lift(self.full.rows(), t, unknowns, [all.u, all.v, all.internal]);
        (*all.dissipated, *all.supplied) = (energies[0], energies[1]);
    }

    /// The unknowns of a state of all nodes at time t, if the model has it and a motion has begun.
    pub(crate) fn unknowns_of(&mut self, t: f64, state: &[f64]) -> Option<Vec<f64>> {
        if !self.projection.has_begun {
            return None;
        }
        let layout = self.full.layout();
        let State { u, v, internal, dissipated, supplied, .. } = layout.of(state);
        let [q, p] = self.projection.coordinates(self.full.rows(), t, [u, v]);
        let (strains, amounts) = layout.split(internal);
        let of_branches = match &self.projection.branches {
            Some(own) => own.unknowns_of(strains)?,
            None => Vec::new(),
        };
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

    /// Absolute tolerances of the unknowns, once a motion has begun, where those of all unknowns are `atol`.
    pub(crate) fn tolerances(&self, atol: &AbsoluteTolerances) -> Vec<f64> {
        let (free, full) = (self.free(), &self.full);
        let (ones, matrices) = (vec![1.0; full.dofs()], full.matrices());
        let mass = matrices.square(&ones) / matrices.dimension as f64;
        // shapes are orthonormal in M: a displacement of all nodes counts times the root of the mass
        let mut tolerances = vec![atol.position * mass.sqrt(); free];
        tolerances.resize(2 * free, atol.velocity * mass.sqrt());
        let branches = self.projection.branches.iter();
        tolerances.extend(branches.flat_map(|own| own.tolerances(atol.strain)));
        tolerances.extend(full.flow_tolerances(atol.strain, atol.velocity));
        tolerances.resize(tolerances.len() + ENERGIES, atol.energy);
        tolerances
    }

    fn evaluate_along(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let [q, p, internal, _] = parts(y, self.free());
        let evaluated = self.projection.evaluate(self.full.rows(), t, [q, p, internal]);
        self.full.noting_refusal(evaluated)
    }

    /// Accelerations (m/s^2) of all nodes in a state of all nodes.
    fn accelerations(
        &mut self,
        t: f64,
        [u, v, internal]: [&[f64]; 3],
    ) -> Result<Vec<f64>, Failure> {
        let Self { full, projection, .. } = self;
        let (strains, amounts) = full.layout().split(internal);
        let [q, p] = projection.coordinates(full.rows(), t, [u, v]);
        // the strains of all cells are known here
        projection.evaluate_parts(full.rows(), t, [&q, &p, &[], amounts])?;
        if let (Some(branches), [_, ..]) = (&full.matrices().branches, strains) {
            let (mut forces, mut rates) = (vec![0.0; u.len()], vec![0.0; strains.len()]);
            branches.add_forces(u, strains, &mut forces, &mut rates);
            projection.push(&forces);
        }
        Ok(projection.accelerations())
    }
}

impl PhaseSystem for ReducedSystem {
    fn full(&self) -> &System {
        &self.full
    }

    fn full_mut(&mut self) -> &mut System {
        &mut self.full
    }

    fn freedoms(&self) -> usize {
        self.free()
    }

    /// As [`System`], if the forces see only nodes that the present ones see.
    fn change_forces(&mut self, forces: Forces) -> bool {
        let can_change =
            self.projection.has_room(&forces) && self.full.change_forces(forces.clone());
        if can_change {
            self.projection.take(&forces);
        }
        can_change
    }

    fn forget_tangents(&mut self) {
        self.full.forget_tangents();
        self.projection.forget_tangents();
    }

    fn forget_counts(&mut self) {
        self.full.forget_counts();
        self.projection.tangents.differences.forget_counts();
        self.tangent_evaluations = 0;
    }

    fn tangent_evaluations(&self) -> usize {
        self.full.tangent_evaluations() + self.tangent_evaluations
    }

    fn difference_evaluations(&self) -> usize {
        self.full.difference_evaluations() + self.projection.tangents.differences.evaluations()
    }

    fn energy(&self, t: f64, state: [&[f64]; 3]) -> Energy {
        self.full.energy_under(&self.projection.forces, t, state)
    }

    /// Evaluates the forces of all cells, and the constraint forces with the accelerations of the model.
    fn evaluate(&mut self, t: f64, state: [&[f64]; 3]) -> Result<(), Failure> {
        let accelerations = self.accelerations(t, state)?;
        self.full.evaluate_with(accelerations, t, state)
    }

    fn spectrum(&mut self, t: f64, u: &[f64], v: &[f64]) -> Spectrum {
        self.full.update_stiffest_tangents(t, u, v);
        self.projection.spectrum(&self.full, u)
    }

    fn left_over(
        &mut self,
        t: f64,
        state: &[f64],
        [start, end]: [f64; 2],
    ) -> Result<Option<ResidualSnapshot>, Failure> {
        let age = t - start;
        let part = age / (end - start);
        let is_due = part >= self.next_check.unwrap_or(CHECKS[0]);
        if !is_due {
            return Ok(None);
        }
        let next = CHECKS.into_iter().find(|check| *check > part);
        self.next_check = Some(next.unwrap_or(f64::INFINITY));
        let State { u, v, internal, .. } = self.full.layout().of(state);
        let forces = self.full.forces_without_cells(t, [u, v, internal])?;
        let accelerations = self.accelerations(t, [u, v, internal])?;
        Ok(Some(ResidualSnapshot {
            time: t,
            age,
            state: [u.to_vec(), v.to_vec(), accelerations],
            internal: internal.to_vec(),
            forces,
            outside: self.projection.outside(u),
        }))
    }
}

/// Fractions of a phase after which states are checked: often at first, where forces have just changed.
const CHECKS: [f64; 6] = [0.02, 0.05, 0.12, 0.25, 0.5, 0.8];

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

impl Ode for ReducedSystem {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.evaluate_along(t, y)?;
        let [_, velocities, ..] = parts(y, self.free());
        let [q, p, internal, energies] = parts_mut(ydot, self.free());
        q.copy_from_slice(velocities);
        p.copy_from_slice(self.projection.acceleration());
        self.projection.copy_internal_rates(internal);
        energies.copy_from_slice(&self.projection.powers());
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
        let is_old = reuse && self.projection.keeps_tangents();
        if !is_old {
            self.evaluate_along(t, y)?;
            self.projection.update_tangents(t);
            self.tangent_evaluations += 1;
        }
        self.projection.factorize(gamma);
        Ok(!is_old || self.full.is_linear())
    }

    fn newton_solve(&mut self, gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        let [ru, rv, internal, energies] = parts_mut(r, self.free());
        let powers = self.projection.solve([ru, rv, internal]);
        energies.iter_mut().zip(powers).for_each(|(energy, power)| *energy += gamma * power);
        Ok(())
    }
}

impl Scene {
    /// # Errors
    /// Features of the scene that reduced models do not support; bad input.
    pub(crate) fn check_reducible(&self) -> Result<(), InputError> {
        let forces = self.forces()?;
        let (matrices, phase) = (self.matrices(&forces), self.first_phase()?);
        let start = PhaseStart { time: 0.0, u: self.initial_displacements() };
        let first = forces.into_iter().next().unwrap_or_default();
        self.system(&matrices, phase, first, &start, 0.0)?;
        check_reducible(&matrices)
    }
}

//! The residual of a state of a reduced model in the equations with all unknowns: the forces on the other nodes and cells, and
//! the displacements that would balance them.
//!
//! The residual f - M u'' along all directions is divided by K + D/gamma + M/gamma^2, with gamma 30 times the
//! time of a wave across the body, or the time since the start of the phase if that is shorter. Tangents are
//! those of the first or the last of the states of a phase, whichever resist more, as a body that is about to buckle
//! would move far under any force; indefinite ones are factorized only where the others report more than the
//! requested error, or nothing. The ratio to the largest displacement, times the largest ratio of error to it in the
//! verification runs of the model, is the error estimate of a run. Sensors read the state with and
//! without these displacements: one solve serves all of them and all nodes, to first order the dual-weighted
//! residual (R. Becker, R. Rannacher, *Acta Numerica* 10 (2001) 1-102), as s'.(A^-1 r) = (A^-T s').r, and
//! nonlinear sensors keep their nonlinearity.

use super::System;
use crate::base::simd::add;
use crate::base::vector::largest;
use crate::integrators::ode::Failure;

/// A state of a reduced model, with the forces on all unknowns in it except those of cells, which depend on nothing else.
#[derive(Debug, Clone)]
pub(crate) struct ResidualSnapshot {
    /// Time (s), and how long the phase has lasted then (s).
    pub(crate) time: f64,
    pub(crate) age: f64,
    /// Displacements (m), velocities (m/s) and accelerations (m/s^2) of all nodes.
    pub(crate) state: [Vec<f64>; 3],
    /// Strains of Maxwell branches, and amounts of flowing gas and liquids.
    pub(crate) internal: Vec<f64>,
    /// The nodal forces (N) of all but the cells and their branches.
    pub(crate) forces: Vec<f64>,
    /// Extrapolation: distance of the state outside the training range, relative to the largest modal range.
    pub(crate) outside: f64,
}

/// Displacements (m) of all nodes that a reduced model lacks, as determined from a state in a phase.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MissingDisplacement {
    pub(crate) phase: usize,
    pub(crate) displacement: Vec<f64>,
}

impl System {
    /// The nodal forces (N) of all but the cells and their branches.
    pub(crate) fn forces_without_cells(
        &mut self,
        t: f64,
        [u, v, internal]: [&[f64]; 3],
    ) -> Result<Vec<f64>, Failure> {
        self.at.nodal.clear();
        self.set_lagging(t, internal);
        self.add_forces_where(|force| force.capabilities().by_cells.is_none(), t, u, v)?;
        self.add_flow_forces(t, u, self.layout.split(internal).1)?;
        self.at.nodal.add_up(&mut self.at.total);
        Ok(self.at.total.clone())
    }

    /// For each of some states of a phase the displacements (m) that would balance the residual of a reduced model; none
    /// without suitable tangents.
    ///
    /// Of the tangents of the first and of the last state the stiffer ones are used: a body on its way to
    /// rest may be about to buckle, and move far under any force. Indefinite ones, which take longer to factorize, are used only where
    /// the others give more than `enough` (m), or nothing.
    pub(crate) fn imbalances(
        &mut self,
        states: &[ResidualSnapshot],
        enough: f64,
    ) -> Vec<Option<Vec<f64>>> {
        let mut least = vec![None; states.len()];
        let residuals: Result<Vec<_>, Failure> =
            states.iter().map(|state| self.residual(state)).collect();
        let Ok(residuals) = residuals else { return least };
        let (first, others) = (states.first(), states.get(1..).unwrap_or_default());
        let at: Vec<&ResidualSnapshot> = first.into_iter().chain(others.last()).collect();
        for are_definite in [true, false] {
            for at in &at {
                let found = self.imbalances_by(at, states, &residuals, are_definite);
                least.iter_mut().zip(found).for_each(|(least, own)| take_less(least, own));
            }
            let is_enough =
                |least: &Option<Vec<f64>>| least.as_ref().is_some_and(|x| largest(x) <= enough);
            if least.iter().all(is_enough) {
                break;
            }
        }
        least
    }

    /// The nodal forces (N) that a state leaves over.
    fn residual(&mut self, state: &ResidualSnapshot) -> Result<Vec<f64>, Failure> {
        let ResidualSnapshot { time, state: [u, v, a], internal, forces, .. } = state;
        self.at.nodal.clear();
        self.add_forces_of_matrices(u, v)?;
        self.add_forces_where(|force| force.capabilities().by_cells.is_some(), *time, u, v)?;
        self.add_branch_forces(u, internal);
        let Self { at, matrices, .. } = self;
        at.nodal.add_up(&mut at.total);
        add(forces, &mut at.total);
        matrices.add_momentum(-1.0, a, &mut at.total);
        Ok(at.total.clone())
    }

    /// The imbalances with the tangents of one of the states, where these can be factorized: if they `are_definite`.
    fn imbalances_by(
        &mut self,
        at: &ResidualSnapshot,
        states: &[ResidualSnapshot],
        residuals: &[Vec<f64>],
        are_definite: bool,
    ) -> Vec<Option<Vec<f64>>> {
        let ResidualSnapshot { time, state: [u, v, _], internal, .. } = at;
        // a step so long that inertia hardly matters, except where nothing resists a motion
        let [size, speed] = self.matrices.scales;
        let slow = SLOW * size / speed;
        let step = |state: &ResidualSnapshot| slow.min(state.age);
        // Maxwell branches are least stiff in the longest step
        let longest = states.iter().map(step).fold(0.0, f64::max);
        let (strains, amounts) = self.layout.split(internal);
        self.set_lagging(*time, internal);
        self.newton.is_set = false;
        self.update_tangents(*time, u, v, false);
        self.add_branch_tangents(longest, u, strains);
        self.add_flow_tangents(*time, [u, v, amounts]);
        let (mut gamma, mut is_factorized) = (0.0, false);
        let mut imbalances = Vec::new();
        for (state, residual) in states.iter().zip(residuals) {
            // a force that has just begun to act has not moved the body far
            if gamma != step(state) {
                gamma = step(state);
                is_factorized = match are_definite {
                    true => self.factorize_definite_newton(gamma),
                    false => self.factorize_newton(gamma).is_ok(),
                };
            }
            if !is_factorized {
                imbalances.push(None);
                continue;
            }
            let right = self.newton.right.iter_mut().zip(residual);
            right.for_each(|(right, force)| *right = force * (gamma * gamma));
            self.newton.demands.fill(0.0);
            self.solve_resisted();
            imbalances.push(Some(self.newton.xv.clone()));
        }
        imbalances
    }

    /// The displacement nearest to `x`, in the sense of kinetic energy, that constraints at rest allow.
    pub(crate) fn constrain(&mut self, x: &mut [f64]) {
        let momentum = self.matrices.momentum(x);
        x.copy_from_slice(&self.inertia.solve_free(&self.rows, &momentum));
    }

    /// For each row that moves the displacements in equilibrium, in the undeformed shape at time `t`, where it moves by 1
    /// and the others by 0.
    pub(crate) fn lifts(&mut self, t: f64) -> Result<Vec<Vec<f64>>, Failure> {
        let moves = |&row: &usize| self.rows[row].moves();
        let moved: Vec<usize> = (0..self.rows.len()).filter(moves).collect();
        if moved.is_empty() {
            return Ok(Vec::new());
        }
        let rest = vec![0.0; self.dofs()];
        self.update_tangents_at_rest(t);
        self.factorize_at_rest()?;
        let lift = |row: &usize| {
            let mut demands = vec![0.0; self.rows.len()];
            demands[*row] = 1.0;
            let (mut x, mut mu) = (vec![0.0; rest.len()], vec![0.0; demands.len()]);
            self.newton.solver.solve(&self.rows, &rest, &demands, &mut x, &mut mu);
            x
        };
        Ok(moved.iter().map(lift).collect())
    }

    /// Sets the Newton matrix of a step in which all shapes reach equilibrium.
    pub(super) fn factorize_at_rest(&mut self) -> Result<(), Failure> {
        let [size, speed] = self.matrices.scales;
        self.factorize_newton(STATIC * size / speed)
    }
}

/// Takes the smaller one of two displacements.
fn take_less(least: &mut Option<Vec<f64>>, own: Option<Vec<f64>>) {
    let Some(own) = own else { return };
    if least.as_ref().is_none_or(|least| largest(&own) < largest(least)) {
        *least = Some(own);
    }
}

/// Times that a wave takes across the body: in those the slowest shapes of slender bodies move, and in these all of them
/// reach equilibrium.
const SLOW: f64 = 30.0;
const STATIC: f64 = 1e3;

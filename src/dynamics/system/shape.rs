//! Rigidity of the rigid pieces of a phase: by their [edges](crate::dynamics::linear::Edges), or in equilibria by their elasticity.
//!
//! In equilibria nothing turns fast and the search needs an energy, so edges are released and the elasticity
//! of the pieces acts. With rigid pieces Newton matrices are always factorized, as conjugate gradients would
//! need W^T X W.

use super::System;
use crate::base::vector::largest;
use crate::dynamics::linear::{ConstrainedSolver, Edges};
use crate::integrators::ode::Failure;

/// Round-off tolerance for the velocities of a rigid piece, relative to the largest.
const ROUND_OFF: f64 = 1e-12;

/// Round-off tolerance for the rate of an edge, relative to the largest velocity.
const TORN: f64 = 1e-9;

impl System {
    /// Whether rigid pieces do not allow the velocities `v` (m/s).
    pub(crate) fn distorts(&self, v: &[f64]) -> bool {
        let off = self.matrices.rigid.as_ref().map_or(0.0, |rigid| rigid.distortion(v));
        off > ROUND_OFF * largest(v)
    }

    /// Whether the constraints ask the nodes of a rigid piece to leave each other at time `t` and the displacements `u`.
    pub(super) fn tears_apart(&mut self, t: f64, u: &[f64]) -> bool {
        if self.all_edges.list.len() == self.edges.list.len() {
            return false;
        }
        let mut v = vec![0.0; self.dofs()];
        self.project(t, u, &mut v);
        self.all_edges.move_to(0.0, u, &v);
        self.all_edges.stretches(TORN * largest(&v))
    }

    /// Has solutions with M follow the edges of rigid pieces as they are now, and what is demanded of them, or else
    /// nothing.
    pub(super) fn turn_inertia(&mut self, is_demanded: bool) {
        let Some(solver) = &mut self.inertia.edges else { return };
        match is_demanded {
            true => solver.demands.copy_from_slice(&self.edges.demands),
            false => solver.demands.fill(0.0),
        }
        solver.turn(&self.edges, None);
    }

    /// Whether rigid pieces enter Newton's linear systems as they were where the matrix is from: where each system is
    /// solved once.
    pub(super) fn has_fixed_edges(&self) -> bool {
        self.has_edges() && !self.newton.iterates()
    }

    /// Takes the state (t, u, v) for that in which rigid pieces enter the Newton matrix.
    pub(super) fn linearize_edges(
        &mut self,
        t: f64,
        u: &[f64],
        v: &[f64],
        internal: &[f64],
    ) -> Result<(), Failure> {
        if self.has_edges() {
            self.evaluate(t, u, v, internal)?;
            self.linear_edges.copy_from(&self.edges);
        }
        Ok(())
    }

    /// Leaves the shape of rigid pieces to their elasticity.
    pub(super) fn release_edges(&mut self) {
        self.forces.append(&mut self.of_rigid);
        self.edges = Edges::default();
        self.inertia.edges = None;
        self.newton.solver =
            ConstrainedSolver::of_newton_matrix(&self.matrices, &self.rows, &self.edges);
    }

    /// Whether bodies may touch obstacles or each other.
    pub(crate) fn touches(&self) -> bool {
        self.forces.iter().any(|force| force.capabilities().contact.is_some())
    }

    /// Whether rigid pieces move in it.
    pub(crate) fn has_edges(&self) -> bool {
        !self.edges.list.is_empty()
    }

    /// The rate (1/s) by which constraints are stabilized.
    pub(crate) fn alpha(&self) -> f64 {
        self.alpha
    }

    /// Whether constraints are stabilized, those of rigid pieces included.
    pub(crate) fn is_constrained(&self) -> bool {
        !self.rows.is_empty() || self.has_edges()
    }
}

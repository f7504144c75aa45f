//! Forces, accelerations and multipliers at a state.

use super::{Evaluation, System};
use crate::base::vector::dot;
use crate::dynamics::linear::nodal_multipliers;
use crate::elements::force::Force;
use crate::integrators::ode::Failure;
use crate::scene::constraint::{ConstraintRow, Prescribed};

impl System {
    /// Evaluates forces, accelerations and multipliers. Without `internal` unknowns Maxwell branches have relaxed, and
    /// there is no gas that flows.
    pub(crate) fn evaluate(
        &mut self,
        t: f64,
        u: &[f64],
        v: &[f64],
        internal: &[f64],
    ) -> Result<(), Failure> {
        self.evaluate_forces(t, u, v, internal)?;
        self.evaluate_rows(t, u, v)?;
        self.turn_inertia(true);
        let Evaluation { total, demands, acceleration, multipliers, .. } = &mut self.at;
        self.inertia.solve_whole(
            &self.rows,
            total,
            demands,
            acceleration,
            multipliers,
            |dof, a| self.matrices.momentum_of(dof, a),
        );
        if let Some(solver) = &self.inertia.edges {
            self.edges.multipliers.copy_from_slice(&solver.multipliers);
            self.edges.accelerate(&self.at.acceleration);
        }
        Ok(())
    }

    /// Evaluates forces and multipliers, with `accelerations` (m/s^2) that are known.
    pub(crate) fn evaluate_with(
        &mut self,
        accelerations: Vec<f64>,
        t: f64,
        [u, v, internal]: [&[f64]; 3],
    ) -> Result<(), Failure> {
        self.evaluate_forces(t, u, v, internal)?;
        let Self { matrices, rows, inertia, at, .. } = self;
        at.acceleration = accelerations;
        let mut left_over = at.total.clone();
        matrices.add_momentum(-1.0, &at.acceleration, &mut left_over);
        if rows.iter().any(|row| row.nodal().is_none()) {
            let (mut x, demands) = (vec![0.0; left_over.len()], vec![0.0; rows.len()]);
            inertia.solve(rows, &left_over, &demands, &mut x, &mut at.multipliers);
        }
        nodal_multipliers(rows, &mut at.multipliers, |dof| -left_over[dof]);
        Ok(())
    }

    pub(super) fn evaluate_forces(
        &mut self,
        t: f64,
        u: &[f64],
        v: &[f64],
        internal: &[f64],
    ) -> Result<(), Failure> {
        self.set_lagging(t, internal);
        self.collect_forces(t, u, v)?;
        self.add_branch_forces(u, internal);
        self.add_flow_forces(t, u, self.layout.split(internal).1)?;
        self.at.nodal.add_up(&mut self.at.total);
        Ok(())
    }

    /// Adds the forces of Maxwell branches, and sets the rates of their strains.
    pub(super) fn add_branch_forces(&mut self, u: &[f64], internal: &[f64]) {
        let (strains, _) = self.layout.split(internal);
        let Evaluation { nodal, relaxing, relaxed, .. } = &mut self.at;
        if let (Some(branches), [_, ..]) = (&self.matrices.branches, strains) {
            *relaxed = branches.add_forces(u, strains, &mut nodal.conservative, relaxing);
        }
    }

    pub(super) fn collect_forces(&mut self, t: f64, u: &[f64], v: &[f64]) -> Result<(), Failure> {
        self.at.nodal.clear();
        self.add_forces_of_matrices(u, v)?;
        self.add_forces_where(|_| true, t, u, v)
    }

    /// Adds -K u and -B v.
    pub(super) fn add_forces_of_matrices(&mut self, u: &[f64], v: &[f64]) -> Result<(), Failure> {
        let nodal = &mut self.at.nodal;
        let matrices = &*self.matrices;
        match (&matrices.linear_by_cells, &matrices.stiffness) {
            (Some(cells), _) => cells.add_forces(u, v, nodal)?,
            (None, Some(k)) => k.add_product(-1.0, u, &mut nodal.conservative),
            (None, None) => {}
        }
        match (&matrices.damping, &matrices.mass_damping) {
            (Some(b), _) if matrices.damps_by_matrix => {
                b.add_product(-1.0, v, &mut nodal.dissipative)
            }
            (_, Some(m)) => m.add_product(matrices.dimension, -1.0, v, &mut nodal.dissipative),
            (_, None) => {}
        }
        Ok(())
    }

    /// Adds the forces that have no constant matrix, if they are `among` the requested ones.
    pub(super) fn add_forces_where(
        &mut self,
        among: impl Fn(&dyn Force) -> bool,
        t: f64,
        u: &[f64],
        v: &[f64],
    ) -> Result<(), Failure> {
        let mut forces = self.forces.iter().filter(|force| among(&***force));
        let added = forces.try_for_each(|force| force.add_forces(t, u, v, &mut self.at.nodal));
        self.noting_refusal(added)
    }

    /// The outcome of an evaluation of forces, whose [refusal](Self::refusal) is noted.
    pub(crate) fn noting_refusal<T>(&mut self, outcome: Result<T, Failure>) -> Result<T, Failure> {
        if let Err(Failure::Recoverable(reason)) = &outcome {
            self.refusal.clone_from(reason);
        }
        outcome
    }

    pub(super) fn evaluate_rows(&mut self, t: f64, u: &[f64], v: &[f64]) -> Result<(), Failure> {
        let alpha = self.alpha;
        for (k, row) in self.rows.iter().enumerate() {
            let Prescribed { displacement, velocity, acceleration } = row.prescribed(t);
            let (position, rate) = (row.apply(u), row.apply(v));
            if !(displacement + velocity + acceleration).is_finite() {
                return Err(self.not_finite(row, t));
            }
            self.at.rates[k] = rate;
            self.at.demands[k] = acceleration
                - 2.0 * alpha * (rate - velocity)
                - alpha * alpha * (position - displacement);
        }
        self.edges.move_to(alpha, u, v);
        Ok(())
    }

    /// Power dissipated and power supplied (W) at the last evaluation.
    pub(super) fn powers(&self, v: &[f64], multipliers: &[f64]) -> (f64, f64) {
        let (dissipated, applied) = self.at.nodal.powers(v);
        let supplied = applied + dot(multipliers, &self.at.rates);
        (dissipated + self.at.relaxed, supplied + self.at.brought)
    }

    pub(super) fn not_finite(&self, row: &ConstraintRow, t: f64) -> Failure {
        let Prescribed { displacement, velocity, acceleration } = row.prescribed(t);
        let label = row.label(self.matrices.dimension);
        Failure::Fatal(
            format!(
                "the path of {label} gives b = {displacement}, b' = {velocity}, \
                 b'' = {acceleration} at t = {t} s: it must give finite numbers"
            )
            .into(),
        )
    }
}

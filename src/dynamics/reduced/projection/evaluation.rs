//! Forces and accelerations along the shapes.

use super::{LastEvaluation, Projection};
use crate::base::simd::add;
use crate::base::vector::dot;
use crate::dynamics::reduced::branches::ReducedBranches;
use crate::integrators::ode::Failure;
use crate::scene::constraint::ConstraintRow;

impl Projection {
    /// Evaluates the forces and q'' at (q, q', internal unknowns).
    pub(crate) fn evaluate(
        &mut self,
        rows: &[ConstraintRow],
        t: f64,
        [q, p, internal]: [&[f64]; 3],
    ) -> Result<(), Failure> {
        let (of_branches, amounts) = internal.split_at(self.branch_unknowns());
        self.evaluate_parts(rows, t, [q, p, of_branches, amounts])
    }

    /// The same, without branches if there are no unknowns of these.
    pub(crate) fn evaluate_parts(
        &mut self,
        rows: &[ConstraintRow],
        t: f64,
        [q, p, of_branches, amounts]: [&[f64]; 4],
    ) -> Result<(), Failure> {
        self.place(rows, t, [q, p]);
        let Self { at, shapes, origin, generalized, acting, branches, flow, constant, .. } = self;
        let (s, free) = (shapes.count(), shapes.free());
        let LastEvaluation { z: [z, rates], pushed, u, v, nodal, generalized: along, .. } = at;
        nodal.clear();
        along.clear();
        let are_seen = branches.as_ref().is_some_and(ReducedBranches::see_all);
        if !acting.is_empty() || are_seen || flow.is_some() {
            shapes.lift_active([z, rates], [u, v], origin);
        }
        let (mut relaxed, mut brought) = (0.0, 0.0);
        if let (Some(branches), [_, ..]) = (branches, of_branches) {
            relaxed = branches.add_forces([u, z, of_branches], nodal, along);
        }
        if let Some(flow) = flow {
            brought = flow.add_forces(t, u, amounts, nodal)?;
        }
        for force in &*acting {
            force.add_forces(t, u, v, nodal)?;
        }
        for force in generalized.iter_mut().flatten() {
            force.add_forces(t, [z, rates], along)?;
        }
        at.carried = [nodal.carried_heat + relaxed, nodal.carried_power + brought];

        // forces of constant matrices, and steady ones
        at.applied.copy_from_slice(&constant.steady[1]);
        times(&constant.damping, rates, |i, sum| at.dissipative[i] = -sum);
        times(&constant.stiffness, z, |i, sum| {
            at.force[i] = constant.rest[i] + constant.steady[0][i] - sum;
        });
        // each part of its own only where there is one, for the powers
        for (part, along, sum) in [
            (&nodal.dissipative, &along.dissipative, &mut at.dissipative),
            (&nodal.applied, &along.applied, &mut at.applied),
            (&nodal.conservative, &along.conservative, &mut at.force),
        ] {
            if !part.is_zero() {
                shapes.add_projected_active(part, sum);
            }
            if !along.is_zero() {
                sum.iter_mut().zip(&along[..]).for_each(|(sum, along)| *sum += along);
            }
        }
        for i in 0..s {
            at.force[i] += at.dissipative[i] + at.applied[i];
        }

        at.acceleration.copy_from_slice(&at.force[..free]);
        for (k, push) in pushed.iter().enumerate() {
            for i in 0..free {
                at.acceleration[i] -= constant.inertia[i * s + free + k] * push;
            }
        }
        for k in 0..pushed.len() {
            let row = &constant.inertia[(free + k) * s..][..s];
            let inertia = dot(&row[..free], &at.acceleration) + dot(&row[free..], pushed);
            at.reactions[k] = inertia - at.force[free + k];
        }
        Ok(())
    }

    /// q'' at the last evaluation.
    pub(crate) fn acceleration(&self) -> &[f64] {
        &self.at.acceleration
    }

    /// Writes the rates of the internal unknowns at the last evaluation.
    pub(crate) fn copy_internal_rates(&self, rates: &mut [f64]) {
        let (strains, amounts) = rates.split_at_mut(self.branch_unknowns());
        if let Some(branches) = &self.branches {
            strains.copy_from_slice(branches.rates());
        }
        if let Some(flow) = &self.flow {
            amounts.copy_from_slice(flow.rates());
        }
    }

    /// Adds the projection of `forces` (N) on all nodes to q''.
    pub(crate) fn push(&mut self, forces: &[f64]) {
        let mut along = vec![0.0; self.shapes.count()];
        self.shapes.add_projected(forces, &mut along);
        add(&along[..self.shapes.free()], &mut self.at.acceleration);
    }

    /// u'' of all nodes at the last evaluation.
    pub(crate) fn accelerations(&self) -> Vec<f64> {
        let all = [&self.at.acceleration[..], &self.at.pushed].concat();
        let mut of_nodes = vec![0.0; self.origin.len()];
        self.shapes.add_lifted(&all, &mut of_nodes);
        of_nodes
    }

    /// Power dissipated and supplied (W) at the last evaluation.
    pub(crate) fn powers(&self) -> [f64; 2] {
        let LastEvaluation { z: [_, rates], dissipative, applied, carried, reactions, .. } =
            &self.at;
        let pushed = dot(reactions, &rates[self.shapes.free()..]);
        [carried[0] - dot(dissipative, rates), carried[1] + dot(applied, rates) + pushed]
    }
}

/// Calls `each` with every component of A x, A square and row by row.
fn times(matrix: &[f64], x: &[f64], mut each: impl FnMut(usize, f64)) {
    let rows = matrix.chunks_exact(x.len().max(1)).enumerate();
    rows.for_each(|(i, row)| each(i, dot(row, x)));
}

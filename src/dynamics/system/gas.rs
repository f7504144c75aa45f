//! Gas that flows, and actuators that lag, in the equations of a phase and in their Newton systems.

use super::{Evaluation, System, flow_of};
use crate::base::vector::dot;
use crate::integrators::ode::Failure;

impl System {
    /// Absolute tolerances of the amounts and flows, where those of strains (1) and velocities (m/s) are these.
    pub(crate) fn flow_tolerances(&self, strain: f64, velocity: f64) -> Vec<f64> {
        flow_of(&self.flow).map_or_else(Vec::new, |flow| flow.tolerances(strain, velocity))
    }

    /// The amounts of gas (kg) the states of actuators that lag and the flows of pipes (m^3/s) at the start of the scene; none without any.
    pub(crate) fn amounts(&self) -> &[f64] {
        flow_of(&self.flow).map_or(&[], |flow| flow.start())
    }

    /// Writes the rates of the internal unknowns.
    pub(super) fn copy_internal_rates(&self, rates: &mut [f64]) {
        let (strains, amounts) = self.layout.split_mut(rates);
        strains.copy_from_slice(&self.at.relaxing);
        amounts.copy_from_slice(&self.at.flowing[0]);
    }

    /// Brings forces of actuators that lag to the `internal` unknowns at time `t`.
    pub(super) fn set_lagging(&self, t: f64, internal: &[f64]) {
        if let (Some(flow), (_, amounts @ [_, ..])) =
            (flow_of(&self.flow), self.layout.split(internal))
        {
            flow.set(t, amounts);
        }
    }

    /// Adds the forces of the `amounts`, if there are any.
    pub(super) fn add_flow_forces(
        &mut self,
        t: f64,
        u: &[f64],
        amounts: &[f64],
    ) -> Result<(), Failure> {
        let Evaluation { nodal, flowing, .. } = &mut self.at;
        if let (Some(flow), [_, ..]) = (flow_of(&self.flow), amounts) {
            let rates = flowing.each_mut().map(|rates| &mut rates[..]);
            let added = flow.add_forces_of(t, [u, amounts], nodal, rates);
            self.at.brought = self.noting_refusal(added)?;
        }
        Ok(())
    }

    /// Adds to Kt, just updated, the tangent of gas that flows under constant pressures, and takes its other derivatives, `at` (u, v, m).
    pub(super) fn add_flow_tangents(&mut self, t: f64, at: [&[f64]; 3]) {
        let (Some(flow), Some(matrix)) = (flow_of(&self.flow), &mut self.newton.flow) else {
            return;
        };
        if let Some(stiffness) = self.newton.stiffness.own() {
            flow.linearize(t, at, stiffness, &mut matrix.derivatives);
        }
    }

    /// Prepares the contribution of flowing gas that the Newton matrix, just factorized, lacks.
    pub(super) fn condense_flow(&mut self) {
        let newton = &mut self.newton;
        if newton.flow.is_none() {
            return;
        }
        newton.demand_nothing();
        let Some(matrix) = &mut newton.flow else { return };
        matrix.condense(newton.gamma);
        let (dofs, k) = (matrix.column.len(), matrix.rooms);
        for column in 0..k {
            if !matrix.is_stiff(column) {
                continue;
            }
            let gradients = &matrix.derivatives.gradients;
            let (own, x) = (&gradients[column * dofs..][..dofs], &mut matrix.column);
            newton.solver.solve(&self.rows, own, &newton.demands, x, &mut newton.mu);
            for row in 0..k {
                let gradient = &gradients[row * dofs..][..dofs];
                matrix.compliance[row * k + column] = dot(gradient, &matrix.column);
            }
        }
        matrix.resist_by(newton.gamma);
    }
}

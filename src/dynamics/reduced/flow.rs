//! Gas and liquids that flow, and actuators that lag, in a reduced model: their amounts are unknowns beside q, all of them,
//! and their nodal forces are projected onto the shapes.
//!
//! It is the Newton system of `dynamics/linear/flow_matrix.rs` with Phi^T G in place of G. As the matrix is dense, gamma^2 C of the amounts, eliminated, is
//! added to it.

use std::sync::Arc;

use faer::Mat;

use super::shapes::Shapes;
use crate::base::sparse::BlockMatrix;
use crate::base::vector::dot;
use crate::dynamics::linear::FlowMatrix;
use crate::elements::force::{FlowDerivatives, Force, NodalForces};
use crate::integrators::ode::Failure;

/// Flow states along the shapes of a reduced model: gas, liquids, lag states and pipe flows.
pub(super) struct ReducedFlow {
    force: Arc<dyn Force>,
    /// The amounts at the last evaluation, their rates, and a workspace of the same size.
    amounts: Vec<f64>,
    rates: [Vec<f64>; 2],
    /// The derivatives at the nodes, and along the shapes that are free.
    nodal: FlowDerivatives,
    matrix: FlowMatrix,
    /// dV/dz of the shapes that constraints move, of one reservoir after the other.
    moved: Vec<f64>,
    /// dV/dz of a reservoir.
    along: Vec<f64>,
}

impl ReducedFlow {
    /// That of a `force` with amounts.
    pub(super) fn new(force: &Arc<dyn Force>, shapes: &Shapes) -> Self {
        let flow = force.capabilities().flow;
        let unknowns = flow.map_or(0, |flow| flow.start().len());
        let rooms = flow.map_or(0, |flow| flow.reservoirs());
        let (count, free) = (shapes.count(), shapes.free());
        Self {
            force: force.clone(),
            amounts: vec![0.0; unknowns],
            rates: [vec![0.0; unknowns], vec![0.0; unknowns]],
            nodal: FlowDerivatives::zeros([rooms, unknowns], shapes.dofs()),
            matrix: FlowMatrix::new([rooms, unknowns], free),
            moved: vec![0.0; rooms * (count - free)],
            along: vec![0.0; count],
        }
    }

    /// Brings actuators that lag to the `amounts`, adds the forces of all others under the displacements `u`, and returns the power (W)
    /// that is supplied with the flow.
    ///
    /// # Errors
    /// As [`Force::add_forces`].
    pub(super) fn add_forces(
        &mut self,
        t: f64,
        u: &[f64],
        amounts: &[f64],
        forces: &mut NodalForces,
    ) -> Result<f64, Failure> {
        let Some(flow) = self.force.capabilities().flow else { return Ok(0.0) };
        self.amounts.copy_from_slice(amounts);
        flow.set(t, amounts);
        flow.add_forces_of(
            t,
            [u, amounts],
            forces,
            self.rates.each_mut().map(|rates| &mut rates[..]),
        )
    }

    /// Rates of the amounts at the last evaluation.
    pub(super) fn rates(&self) -> &[f64] {
        &self.rates[0]
    }

    /// Takes the derivatives under the displacements and velocities `u` and `v` and the amounts of the last evaluation; adds the
    /// tangent under constant pressures to `stiffness`.
    pub(super) fn linearize(
        &mut self,
        t: f64,
        [u, v]: [&[f64]; 2],
        stiffness: &mut BlockMatrix,
        shapes: &mut Shapes,
    ) {
        let Self { force, amounts, nodal, matrix, moved, along, .. } = self;
        let Some(flow) = force.capabilities().flow else { return };
        flow.linearize(t, [u, v, amounts], stiffness, nodal);
        let own = &mut matrix.derivatives;
        own.pressures.clone_from(&nodal.pressures);
        own.rates.clone_from(&nodal.rates);
        own.power.clone_from(&nodal.power);
        own.heat.clone_from(&nodal.heat);
        let free = shapes.free();
        for (room, gradient) in nodal.gradients.chunks(u.len()).enumerate() {
            along.fill(0.0);
            shapes.add_projected_active(gradient, along);
            let (of_free, of_moved) = along.split_at(free);
            own.gradients[room * free..][..free].copy_from_slice(of_free);
            moved[room * of_moved.len()..][..of_moved.len()].copy_from_slice(of_moved);
        }
    }

    /// Adds the resistance of the amounts to the Newton matrix of a step of the parameter `gamma`.
    pub(super) fn add_stiffness(&mut self, gamma: f64, newton: &mut Mat<f64>) {
        let free = newton.nrows();
        self.matrix.condense(gamma);
        for (row, stiffness) in self.matrix.stiffness().enumerate() {
            let gradients = &self.matrix.derivatives.gradients;
            for j in 0..free {
                let each = stiffness.iter().enumerate();
                let pressure: f64 = each.map(|(room, x)| x * gradients[room * free + j]).sum();
                if pressure != 0.0 {
                    for i in 0..free {
                        newton[(i, j)] += gamma * gamma * gradients[row * free + i] * pressure;
                    }
                }
            }
        }
    }

    /// Adds the effect of the residuals `ru` and of those of the `amounts` to the right-hand side.
    pub(super) fn add_residuals(
        &mut self,
        gamma: f64,
        ru: &[f64],
        amounts: &[f64],
        right: &mut [f64],
    ) {
        self.matrix.add_residuals(gamma, ru, amounts, right);
    }

    /// Turns the residuals `x` of the amounts into their changes, by those of q, `xu`. Returns the changes of the power (W) that
    /// becomes heat and of that which is supplied with them, and by constraints that move at `speeds`.
    pub(super) fn solve(&mut self, xu: &[f64], x: &mut [f64], speeds: &[f64]) -> [f64; 2] {
        let [heated, mut brought] = self.matrix.solve(xu, x);
        if !speeds.is_empty() {
            let changes = self.matrix.pressure_changes(x);
            for (gradient, change) in self.moved.chunks(speeds.len()).zip(changes) {
                brought -= change * dot(gradient, speeds);
            }
        }
        [heated, brought]
    }
}

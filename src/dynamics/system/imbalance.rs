//! What a reduced model leaves out, measured now and then with all unknowns: the forces that the other nodes and cells
//! would feel, as the displacement that would balance them.

use std::sync::Arc;

use super::{Reduction, System};
use crate::base::input::InputError;
use crate::base::vector::largest;
use crate::dynamics::state::State;
use crate::elements::body::Body;
use crate::integrators::ode::Failure;
use crate::scene::reduced_model::ReducedModel;

/// How far a state of a reduced model is from what all unknowns would do.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Imbalance {
    /// Largest component (m) of the displacements by which the forces left over would be balanced.
    pub(crate) displacement: f64,
    /// How far the state is outside of those learned from, in parts of the widest range of a shape.
    pub(crate) outside: f64,
}

/// Checks in a phase.
const CHECKS: f64 = 4.0;

impl System {
    /// Has the phase `name` be run by a reduced model.
    ///
    /// # Errors
    /// What such models do not have, and constraints that this one has not learned.
    pub(crate) fn reduce(
        &mut self,
        body: &Body,
        model: &Arc<ReducedModel>,
        name: &str,
    ) -> Result<(), InputError> {
        self.check_reducible()?;
        let own = Reduction::new(body, &self.matrices, &self.forces, &self.rows, model, name)?;
        self.reduction = Some(Box::new(own));
        Ok(())
    }

    /// # Errors
    /// What reduced models do not have.
    pub(crate) fn check_reducible(&self) -> Result<(), InputError> {
        let missing = [
            (self.matrices.rigid.is_some(), "rigid pieces"),
            (self.matrices.branches.is_some(), "Maxwell branches"),
            (self.flow.is_some(), "gas or a liquid that flows"),
        ];
        match missing.iter().find(|(is_there, _)| *is_there) {
            Some((_, what)) => {
                let help = format!("a scene with {what} cannot be reduced yet: run it unreduced");
                Err(InputError::new("reduced model", format!("of a scene with {what}"), help))
            }
            None => Ok(()),
        }
    }

    /// Mass (kg) that moves along one axis.
    pub(crate) fn mass(&self) -> f64 {
        let ones = vec![1.0; self.dofs()];
        let dimension = self.matrices.dimension;
        self.matrices.inertia.quadratic_form(dimension, &ones) / dimension as f64
    }

    /// Whether it is run by a reduced model.
    pub(crate) fn is_reduced(&self) -> bool {
        self.reduction.is_some()
    }

    /// Evaluations for tangents by differences in the reduced model.
    pub(super) fn reduced_differences(&self) -> usize {
        self.reduction.as_ref().map_or(0, |reduction| reduction.difference_evaluations())
    }

    /// The imbalance of `state` = (u, v, ...) of a reduced model at time `t`, if it is due: some times in a phase that
    /// lasts `span` (s).
    pub(crate) fn imbalance(
        &mut self,
        t: f64,
        state: &[f64],
        span: f64,
    ) -> Result<Option<Imbalance>, Failure> {
        match &mut self.reduction {
            Some(reduction) if t >= reduction.next_check => {
                reduction.next_check = t + span / CHECKS;
            }
            _ => return Ok(None),
        }
        let State { u, v, .. } = State::of(state, self.dofs());
        self.evaluate_forces(t, u, v, &[])?;
        let Some(mut reduction) = self.reduction.take() else { return Ok(None) };
        let [q, p] = reduction.coordinates(&self.rows, t, [u, v]);
        let evaluated = reduction.evaluate(&self.rows, t, [&q, &p]);
        let accelerations = reduction.accelerations();
        let outside = reduction.outside(u);
        let can_check = reduction.can_check;
        reduction.can_check = true;
        self.reduction = Some(reduction);
        evaluated?;
        if !can_check {
            // a step so long that inertia hardly matters, except where nothing resists a motion
            let [size, speed] = self.matrices.scales;
            self.newton.is_set = false;
            self.update_tangents(t, u, v, false);
            self.factorize_newton(SLOW * size / speed)?;
        }
        let gamma = self.newton.gamma;
        let mut left = self.at.total.clone();
        self.matrices.inertia.add_product(self.matrices.dimension, -1.0, &accelerations, &mut left);
        left.iter_mut().for_each(|force| *force *= gamma * gamma);
        let none = vec![0.0; self.rows.len()];
        let (mut x, mut mu) = (vec![0.0; left.len()], none.clone());
        self.newton.solver.solve(&self.rows, &left, &none, &mut x, &mut mu);
        Ok(Some(Imbalance { displacement: largest(&x), outside }))
    }

    /// The displacement nearest to `x`, in the sense of kinetic energy, that constraints at rest allow.
    pub(crate) fn constrain(&mut self, x: &mut [f64]) {
        let none = vec![0.0; self.rows.len()];
        let mut mu = none.clone();
        let mut momentum = vec![0.0; x.len()];
        let dimension = self.matrices.dimension;
        self.matrices.inertia.add_product(dimension, 1.0, x, &mut momentum);
        self.inertia.solve(&self.rows, &momentum, &none, x, &mut mu);
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
        self.newton.is_set = false;
        self.update_tangents(t, &rest, &rest, false);
        let [size, speed] = self.matrices.scales;
        self.factorize_newton(STATIC * size / speed)?;
        let lift = |row: &usize| {
            let mut demands = vec![0.0; self.rows.len()];
            demands[*row] = 1.0;
            let (mut x, mut mu) = (vec![0.0; rest.len()], vec![0.0; demands.len()]);
            self.newton.solver.solve(&self.rows, &rest, &demands, &mut x, &mut mu);
            x
        };
        Ok(moved.iter().map(lift).collect())
    }
}

/// Times that a wave takes across the body: in those the slowest shapes of slender bodies move, and in these all of them
/// reach equilibrium.
const SLOW: f64 = 30.0;
const STATIC: f64 = 1e3;

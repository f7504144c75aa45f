//! What an explicit method of second order asks for: forces, and accelerations under given demands of
//! the constraints.

use super::{System, nodal_multipliers};
use crate::constraint::{Prescribed, Row};
use crate::model::Model;
use crate::ode::Failure;

impl System {
    /// The sum of all forces at (t, u, v), but those of the constraints.
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

    /// Power that the forces last evaluated dissipate and supply (W) at the velocities `v`.
    pub(crate) fn force_powers(&self, v: &[f64]) -> (f64, f64) {
        self.at.nodal.powers(v)
    }

    /// Accelerations a and multipliers lambda with M a - A lambda = f, A^T a = d.
    pub(crate) fn accelerations(
        &mut self,
        f: &[f64],
        d: &[f64],
        a: &mut [f64],
        multipliers: &mut [f64],
    ) {
        self.inertia.solve(&self.rows, f, d, a, multipliers);
        let Model { inertia, dimension, .. } = &*self.model;
        nodal_multipliers(&self.rows, multipliers, |dof| {
            inertia.row_product(*dimension, dof, a) - f[dof]
        });
    }

    /// Whether M is diagonal.
    pub(crate) fn is_lumped(&self) -> bool {
        self.model.inertia.is_diagonal()
    }

    /// Mass (kg) at each degree of freedom; `None` if nodes share inertia.
    pub(crate) fn lumped_masses(&self) -> Option<Vec<f64>> {
        let Model { inertia, dimension, .. } = &*self.model;
        let mass = |dof: usize| inertia.get(dof / dimension, dof / dimension);
        self.is_lumped().then(|| (0..self.dofs()).map(mass).collect())
    }

    /// What a row prescribes at time `t`.
    ///
    /// # Errors
    /// A path that gives no finite numbers.
    pub(crate) fn prescribed(&self, row: &Row, t: f64) -> Result<Prescribed, Failure> {
        let prescribed = row.prescribed(t);
        let Prescribed { displacement, velocity, acceleration } = prescribed;
        match (displacement + velocity + acceleration).is_finite() {
            true => Ok(prescribed),
            false => Err(self.not_finite(row, t)),
        }
    }

    /// Stabilization rate alpha (1/s).
    pub(crate) fn alpha(&self) -> f64 {
        self.alpha
    }
}

//! Loads: given forces on nodes.

use super::{Force, NodalForces, Reservoir};
use crate::ode::Failure;

/// Constant forces on some degrees of freedom.
pub(crate) struct Load {
    /// (degree of freedom, force in N)
    pub(crate) forces: Vec<(usize, f64)>,
}

impl Force for Load {
    fn add_forces(
        &self,
        _t: f64,
        _u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        for &(dof, force) in &self.forces {
            forces.applied[dof] += force;
        }
        Ok(())
    }

    fn is_nonlinear(&self) -> bool {
        false
    }

    fn potential(&self, _t: f64, _u: &[f64]) -> f64 {
        0.0
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::None
    }
}

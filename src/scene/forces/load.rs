//! Loads: given forces on nodes.

use super::signal::{VectorSignal, finite_at};
use crate::base::vector::distinct;
use crate::elements::force::{Capabilities, Force, NodalForces};
use crate::integrators::ode::Failure;

/// Constant forces on some degrees of freedom.
pub(crate) struct Load {
    /// (degree of freedom, force in N)
    pub(crate) forces: Vec<(usize, f64)>,
    /// Components of a force.
    pub(crate) dimension: usize,
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

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(distinct(self.forces.iter().map(|(dof, _)| dof / self.dimension)))
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { is_steady: true, ..Capabilities::default() }
    }
}

impl VectorSignal {
    /// Its components, `dimension` of them, at time `t`.
    pub(crate) fn components(&self, t: f64, dimension: usize) -> Vec<f64> {
        let mut components = vec![0.0; dimension];
        self.at(t, &mut components);
        components
    }
}

/// A force which changes with time, on some nodes.
pub(crate) struct VaryingLoad {
    /// Nodes, counted from 0, and the factor of the force on each of them.
    pub(crate) nodes: Vec<(usize, f64)>,
    /// Force (N), or force per area (N/m^2) if the factors are areas.
    pub(crate) force: VectorSignal,
    /// Components of the force.
    pub(crate) dimension: usize,
}

impl Force for VaryingLoad {
    fn add_forces(
        &self,
        t: f64,
        _u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let mut buffer = [0.0; 3];
        let force = &mut buffer[..self.dimension];
        self.force.at(t, force);
        for (i, &component) in force.iter().enumerate() {
            let what = format_args!("component {} of a load", i + 1);
            finite_at(t, what, component)?;
            for (node, times) in &self.nodes {
                forces.applied[node * self.dimension + i] += times * component;
            }
        }
        Ok(())
    }

    fn is_nonlinear(&self) -> bool {
        false
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(distinct(self.nodes.iter().map(|(node, _)| *node)))
    }
}

//! An amount of gas that is closed in: a force with a potential.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use super::Filled;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Force, NodalForces, Reservoir, Tangents};
use crate::integrators::ode::Failure;

/// The force of a closed gas. The pressure on one wall depends on where all others are: its tangent is full over the
/// nodes of the walls.
pub(crate) struct ClosedGas {
    gas: Filled,
    /// The nodes of the walls.
    nodes: Vec<usize>,
    /// dV/du (m^2) at all nodes.
    gradient: Mutex<Vec<f64>>,
}

impl ClosedGas {
    pub(crate) fn new(gas: Filled, dofs: usize) -> Self {
        let nodes: BTreeSet<usize> = gas.walls.couplings().into_iter().flatten().collect();
        Self { gas, nodes: nodes.into_iter().collect(), gradient: Mutex::new(vec![0.0; dofs]) }
    }
}

impl Force for ClosedGas {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let [pressure, _] = self.gas.pressure(u, self.gas.amount)?;
        self.gas.walls.add_gradient(self.gas.gauge(pressure), u, &mut forces.conservative);
        Ok(())
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        let gas = &self.gas;
        // the forces refuse such a state
        let Ok([pressure, volume]) = gas.pressure(u, gas.amount) else { return Tangents::Added };
        gas.walls.add_hessian(-gas.gauge(pressure), u, stiffness);
        let mut gradient = self.gradient.lock().unwrap_or_else(PoisonError::into_inner);
        gradient.fill(0.0);
        gas.walls.add_gradient(1.0, u, &mut gradient);
        let (d, factor) = (stiffness.dimension(), gas.exponent * pressure / volume);
        for &row in &self.nodes {
            for &column in &self.nodes {
                let Some(block) = stiffness.block_mut(row, column) else { continue };
                for (axis, line) in block.chunks_mut(d).enumerate() {
                    let along = factor * gradient[d * row + axis];
                    let of_column = &gradient[d * column..][..d];
                    line.iter_mut().zip(of_column).for_each(|(k, g)| *k += along * g);
                }
            }
        }
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        self.gas.potential(u, self.gas.amount)
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(self.nodes.clone())
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        let before = |(k, &node): (usize, &usize)| {
            self.nodes[..k].iter().map(move |&other| [other, node]).collect::<Vec<_>>()
        };
        self.nodes.iter().enumerate().flat_map(before).collect()
    }
}

//! An amount of gas or liquid that is closed in: a force with a potential.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use super::chamber_fluid::{ChamberFluid, Fill};
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Capabilities, Force, NodalForces, Reservoir, StepCheck, Tangents};
use crate::integrators::ode::Failure;

/// The force of an amount that stays. The pressure on one wall depends on where all others are: its tangent is full over the
/// nodes of the walls.
pub(crate) struct FixedAmount<C> {
    content: C,
    /// The whole amount (kg).
    amount: f64,
    /// The amount (kg) at t = 0, and the time (s) at which it has risen along a straight line to the whole one, and its weight from nothing; none where
    /// they are constant.
    rise: Option<[f64; 2]>,
    /// The nodes of the walls.
    nodes: Vec<usize>,
    /// dV/du (m^2) at all nodes.
    gradient: Mutex<Vec<f64>>,
}

impl<C: ChamberFluid> FixedAmount<C> {
    /// With an `amount` (kg), among `dofs` displacement components.
    pub(crate) fn new(content: C, amount: f64, dofs: usize) -> Self {
        let nodes: BTreeSet<usize> = content.walls().couplings().into_iter().flatten().collect();
        let (nodes, gradient) = (nodes.into_iter().collect(), Mutex::new(vec![0.0; dofs]));
        Self { content, amount, rise: None, nodes, gradient }
    }

    /// With an amount that rises along a straight line `from` one (kg) at t = 0 to `amount` at time `end` (s), and a weight that rises with it.
    pub(crate) fn rising(content: C, amount: f64, dofs: usize, [from, end]: [f64; 2]) -> Self {
        Self { rise: Some([from, end]), ..Self::new(content, amount, dofs) }
    }

    /// The fill of the chamber at time `t` (s).
    fn at(&self, t: f64) -> Fill {
        self.rise.map_or(Fill::of(self.amount), |[from, end]| Fill {
            amount: from + t / end * (self.amount - from),
            weight: t / end,
        })
    }
}

impl<C: ChamberFluid> Force for FixedAmount<C> {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.content.press(u, self.at(t), forces)
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        let mut gradient = self.gradient.lock().unwrap_or_else(PoisonError::into_inner);
        gradient.fill(0.0);
        let linear = self.content.linearize(u, self.at(t), stiffness, &mut gradient);
        // the forces refuse such a state
        let Some([_, factor, _]) = linear else { return Tangents::Added };
        let d = stiffness.dimension();
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

    fn potential(&self, t: f64, u: &[f64]) -> f64 {
        self.content.potential(u, self.at(t))
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

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { step_check: Some(self), ..Capabilities::default() }
    }
}

impl<C: ChamberFluid> StepCheck for FixedAmount<C> {
    fn check_step(&self, t: f64, _before: &[f64], after: &[f64]) -> Result<(), Failure> {
        self.content.check(t, after, self.at(t).amount)
    }
}

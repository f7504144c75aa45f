//! The Maxwell branches of a body, whatever its elements are.

use std::sync::Arc;

use super::assembly::Elements;
use super::regions::Regions;
use crate::base::sparse::BlockMatrix;

/// The branches of a body.
pub(crate) struct Branches {
    pub(super) elements: Arc<dyn Elements>,
    pub(super) regions: Arc<Regions>,
}

impl Branches {
    /// Number of internal strains, each component counted.
    pub(crate) fn unknowns(&self) -> usize {
        self.elements.internal_strains(&self.regions)
    }

    /// Largest rate of relaxation (1/s).
    pub(crate) fn fastest(&self) -> f64 {
        self.regions.branches().map(|branch| 1.0 / branch.time).fold(0.0, f64::max)
    }

    /// Writes the internal strains with which the branches have no stress at the displacements `u` (m).
    pub(crate) fn relax(&self, u: &[f64], internal: &mut [f64]) {
        self.elements.relax(&self.regions, u, internal);
    }

    /// Adds the forces (N) at the displacements `u` (m), and writes the rates (1/s) of the internal strains;
    /// returns the power (W) that is dissipated.
    pub(crate) fn add_forces(
        &self,
        u: &[f64],
        internal: &[f64],
        forces: &mut [f64],
        rates: &mut [f64],
    ) -> f64 {
        self.elements.add_branch_forces(&self.regions, u, internal, forces, rates)
    }

    /// Strain energy (J).
    pub(crate) fn energy(&self, u: &[f64], internal: &[f64]) -> f64 {
        self.elements.branch_energy(&self.regions, u, internal)
    }

    /// Adds the stiffness of the branches in a step of the parameter `gamma` (s); 0 is a sudden change.
    pub(crate) fn add_tangents(
        &self,
        gamma: f64,
        u: &[f64],
        internal: &[f64],
        stiffness: &mut BlockMatrix,
    ) {
        self.elements.add_branch_tangents(&self.regions, gamma, [u, internal], stiffness);
    }

    /// Adds gamma sum B^T C P rG, of the `residuals` rG, in a step from the displacements and internal
    /// strains `at`.
    pub(crate) fn add_residuals(
        &self,
        gamma: f64,
        at: [&[f64]; 2],
        residuals: &[f64],
        right: &mut [f64],
    ) {
        self.elements.add_branch_residuals(&self.regions, gamma, at, residuals, right);
    }

    /// Turns the residuals `x` into xG, with the changes `xu` of the displacements. Returns the change of the
    /// dissipated power (W) from where the internal strains had the `rates`; it is exact under small strains
    /// and without a yield stress.
    pub(crate) fn solve(
        &self,
        gamma: f64,
        at: [&[f64]; 2],
        rates: &[f64],
        xu: &[f64],
        x: &mut [f64],
    ) -> f64 {
        self.elements.solve_branches(&self.regions, gamma, at, rates, xu, x)
    }
}

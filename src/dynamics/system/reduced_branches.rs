//! Maxwell branches in a reduced model: their strains in all cells are unknowns beside q, and what they do at the nodes is
//! seen along the shapes.
//!
//! Only the displacements couple the strains of two points. So these are eliminated point by point, as they are among all
//! unknowns (`elements/body/branches.rs`), and what is left is the dense system of q with Psi^T B^T C P B Psi added to the
//! stiffness.

use super::shapes::Shapes;
use crate::base::sparse::BlockMatrix;
use crate::dynamics::matrices::Matrices;
use crate::elements::body::Branches;

/// The branches of all cells, along the shapes of a reduced model.
pub(super) struct ReducedBranches {
    branches: Branches,
    /// The internal strains at the last evaluation, and their rates (1/s).
    strains: Vec<f64>,
    rates: Vec<f64>,
    /// Displacements (m) and internal strains where they were eliminated last, by a step of the parameter gamma (s).
    place: [Vec<f64>; 2],
    gamma: f64,
    tangents: BlockMatrix,
    /// The stiffness in such a step along Psi, row by row.
    stiffness: Vec<f64>,
    /// Room for vectors of all nodes, and for one along Psi.
    room: Vec<f64>,
    along: Vec<f64>,
}

impl ReducedBranches {
    /// Those of a body with these matrices, if it has any. They see all nodes.
    pub(super) fn new(matrices: &Matrices, shapes: usize) -> Option<Self> {
        let branches = matrices.branches.clone()?;
        let (dofs, unknowns) = (matrices.dofs(), branches.unknowns());
        Some(Self {
            branches,
            strains: vec![0.0; unknowns],
            rates: vec![0.0; unknowns],
            place: [vec![0.0; dofs], vec![0.0; unknowns]],
            gamma: 0.0,
            tangents: BlockMatrix::zeros(matrices.pattern(), matrices.dimension),
            stiffness: vec![0.0; shapes * shapes],
            room: vec![0.0; dofs],
            along: vec![0.0; shapes],
        })
    }

    /// Number of internal strains.
    pub(super) fn unknowns(&self) -> usize {
        self.strains.len()
    }

    /// Adds the nodal forces under the displacements `u` (m) and internal `strains`, and returns the power (W) that is dissipated.
    pub(super) fn add_forces(&mut self, u: &[f64], strains: &[f64], forces: &mut [f64]) -> f64 {
        self.strains.copy_from_slice(strains);
        self.branches.add_forces(u, strains, forces, &mut self.rates)
    }

    /// Rates (1/s) of the internal strains at the last evaluation.
    pub(super) fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// Eliminates the internal strains of the last evaluation, under the displacements `u` (m), from a step of the parameter `gamma`
    /// (s), and adds the stiffness that this leaves.
    pub(super) fn add_stiffness(
        &mut self,
        gamma: f64,
        u: &[f64],
        shapes: &mut Shapes,
        stiffness: &mut [f64],
    ) {
        let Self { branches, strains, place, tangents, stiffness: own, .. } = self;
        self.gamma = gamma;
        place[0].copy_from_slice(u);
        place[1].copy_from_slice(strains);
        tangents.values.fill(0.0);
        branches.add_tangents(gamma, u, strains, tangents);
        own.fill(0.0);
        shapes.add_projected_matrix(tangents, own);
        stiffness.iter_mut().zip(own).for_each(|(sum, own)| *sum += *own);
    }

    /// gamma times the forces along Psi of what the `residuals` of the internal strains pass to the springs.
    pub(super) fn of_residuals(&mut self, residuals: &[f64], shapes: &mut Shapes) -> &[f64] {
        let Self { branches, place, gamma, room, along, .. } = self;
        room.fill(0.0);
        branches.add_residuals(*gamma, place.each_ref().map(|at| &at[..]), residuals, room);
        along.fill(0.0);
        shapes.add_projected_active(room, along);
        along
    }

    /// Turns the residuals `x` of the internal strains into their changes, by those of q, `xu`. Returns the change of the power (W)
    /// that they dissipate.
    pub(super) fn solve(&mut self, xu: &[f64], x: &mut [f64], shapes: &Shapes) -> f64 {
        let Self { branches, rates, place, gamma, room, .. } = self;
        room.fill(0.0);
        shapes.add_lifted(xu, room);
        branches.solve(*gamma, place.each_ref().map(|at| &at[..]), rates, room, x)
    }
}

//! Maxwell branches in a reduced model: their internal strains are unknowns beside q.
//!
//! Without a yield stress these are amplitudes of modes of the strain, exactly (`elements/body/branch_modes.rs`), as long as that
//! is less work. Else they are the strains in all cells: only the displacements couple the strains of two points, so that these are
//! eliminated point by point, as they are among all unknowns (`elements/body/branches.rs`), which leaves the dense system
//! of q with gamma^2 Psi^T B^T C P B Psi added.
//!
//! Modes are used as long as N^2 for all relaxation times is at most an eighth of the work of all cells.
//! Strains of all cells are written for each returned state.

use super::shapes::Shapes;
use crate::base::simd::add;
use crate::base::sparse::BlockMatrix;
use crate::dynamics::matrices::Matrices;
use crate::elements::body::{BranchModes, Branches};
use crate::elements::force::NodalForces;

/// The branches along the shapes of a reduced model.
pub(super) struct ReducedBranches {
    branches: Branches,
    way: Way,
    /// Their unknowns at the last evaluation, and the rates (1/s).
    unknowns: Vec<f64>,
    rates: Vec<f64>,
    /// Step parameter (s) of the last elimination.
    gamma: f64,
    /// Room for a vector along Psi.
    along: Vec<f64>,
}

enum Way {
    Modes(Option<Box<InModes>>),
    Cells(Box<InCells>),
}

/// Amplitudes as unknowns.
struct InModes {
    modes: BranchModes,
    /// The internal strains that were written last, and their amplitudes.
    lifted: [Vec<f64>; 2],
}

/// The strains in all cells as unknowns.
struct InCells {
    /// Displacements (m) and strains where they were eliminated last.
    place: [Vec<f64>; 2],
    tangents: BlockMatrix,
    /// The stiffness that this leaves along Psi, row by row.
    stiffness: Vec<f64>,
    /// Room for a vector of all nodes.
    room: Vec<f64>,
}

impl ReducedBranches {
    /// Those of a body with these matrices, if it has any, along so many shapes.
    pub(super) fn new(matrices: &Matrices, shapes: usize) -> Option<Self> {
        let branches = matrices.branches.clone()?;
        let (dofs, strains) = (matrices.dofs(), branches.unknowns());
        let (way, unknowns) = match branches.have_modes(shapes) {
            // as many as there are modes, once a motion has begun
            true => (Way::Modes(None), 0),
            false => {
                let cells = InCells {
                    place: [vec![0.0; dofs], vec![0.0; strains]],
                    tangents: BlockMatrix::zeros(matrices.pattern(), matrices.dimension),
                    stiffness: vec![0.0; shapes * shapes],
                    room: vec![0.0; dofs],
                };
                (Way::Cells(Box::new(cells)), strains)
            }
        };
        let none = vec![0.0; unknowns];
        let along = vec![0.0; shapes];
        Some(Self { branches, way, unknowns: none.clone(), rates: none, gamma: 0.0, along })
    }

    /// Whether they see all nodes.
    pub(super) fn see_all(&self) -> bool {
        matches!(self.way, Way::Cells(_))
    }

    /// Begins at displacements `origin` (m) and internal `strains`, and returns its unknowns there.
    pub(super) fn begin(&mut self, origin: &[f64], strains: &[f64], shapes: &Shapes) -> Vec<f64> {
        let Way::Modes(own) = &mut self.way else { return strains.to_vec() };
        let modes = self.branches.modes(origin, strains, &shapes.all());
        let start = modes.start();
        let lifted = [strains.to_vec(), start.clone()];
        *own = Some(Box::new(InModes { modes, lifted }));
        self.rates = start.clone();
        self.unknowns = start.clone();
        start
    }

    /// Number of unknowns.
    pub(super) fn unknowns(&self) -> usize {
        self.unknowns.len()
    }

    /// Absolute tolerances of the unknowns, where that of strains is `strain`.
    pub(super) fn tolerances(&self, strain: f64) -> Vec<f64> {
        match &self.way {
            Way::Modes(own) => own.as_ref().map_or(Vec::new(), |own| own.modes.tolerances(strain)),
            Way::Cells(_) => vec![strain; self.unknowns()],
        }
    }

    /// Writes the internal `strains` of all cells for its unknowns.
    pub(super) fn lift(&mut self, unknowns: &[f64], strains: &mut [f64]) {
        match &mut self.way {
            Way::Cells(_) => strains.copy_from_slice(unknowns),
            Way::Modes(None) => {}
            Way::Modes(Some(own)) => {
                own.modes.lift(unknowns, strains);
                own.lifted[0].copy_from_slice(strains);
                own.lifted[1].copy_from_slice(unknowns);
            }
        }
    }

    /// The unknowns of internal `strains`, if they are known: those written last.
    pub(super) fn unknowns_of(&self, strains: &[f64]) -> Option<Vec<f64>> {
        match &self.way {
            Way::Cells(_) => Some(strains.to_vec()),
            Way::Modes(own) => {
                let [lifted, unknowns] = &own.as_ref()?.lifted;
                (lifted == strains).then(|| unknowns.clone())
            }
        }
    }

    /// Adds the forces under the displacements `u` (m) or at `z` along the shapes, and returns the power (W) that is dissipated.
    pub(super) fn add_forces(
        &mut self,
        [u, z, unknowns]: [&[f64]; 3],
        nodal: &mut NodalForces,
        along: &mut NodalForces,
    ) -> f64 {
        self.unknowns.copy_from_slice(unknowns);
        let rates = &mut self.rates;
        match &mut self.way {
            Way::Modes(None) => 0.0,
            Way::Modes(Some(own)) => {
                own.modes.add_forces(z, unknowns, &mut along.conservative, rates)
            }
            Way::Cells(_) => self.branches.add_forces(u, unknowns, &mut nodal.conservative, rates),
        }
    }

    /// Rates (1/s) of the unknowns at the last evaluation.
    pub(super) fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// Whether tangents are kept while only the step parameter changes.
    pub(super) fn keep_tangents(&self) -> bool {
        matches!(self.way, Way::Modes(_))
    }

    /// Updates the stored tangents to the last evaluation.
    pub(super) fn update_tangents(&mut self) {
        if let Way::Modes(Some(own)) = &mut self.way {
            own.modes.update_tangents();
        }
    }

    /// Eliminates the unknowns from a step of the parameter `gamma` (s), those of strains where they were evaluated last, under
    /// the displacements `u` (m); and adds the stiffness that this leaves.
    pub(super) fn add_stiffness(
        &mut self,
        gamma: f64,
        u: &[f64],
        shapes: &mut Shapes,
        stiffness: &mut [f64],
    ) {
        self.gamma = gamma;
        match &mut self.way {
            Way::Modes(None) => {}
            Way::Modes(Some(own)) => own.modes.add_stiffness(gamma, stiffness),
            Way::Cells(cells) => {
                let InCells { place, tangents, stiffness: own, .. } = &mut **cells;
                place[0].copy_from_slice(u);
                place[1].copy_from_slice(&self.unknowns);
                tangents.values.fill(0.0);
                self.branches.add_tangents(gamma, u, &self.unknowns, tangents);
                own.fill(0.0);
                shapes.add_projected_matrix(tangents, own);
                add(own, stiffness);
            }
        }
    }

    /// gamma times the forces along Psi that the `residuals` of the unknowns cause in the springs.
    pub(super) fn of_residuals(&mut self, residuals: &[f64], shapes: &mut Shapes) -> &[f64] {
        let Self { branches, way, gamma, along, .. } = self;
        along.fill(0.0);
        match way {
            Way::Modes(None) => {}
            Way::Modes(Some(own)) => own.modes.add_residuals(*gamma, residuals, along),
            Way::Cells(cells) => {
                let InCells { place, room, .. } = &mut **cells;
                room.fill(0.0);
                branches.add_residuals(*gamma, place.each_ref().map(|at| &at[..]), residuals, room);
                shapes.add_projected_active(room, along);
            }
        }
        along
    }

    /// Turns the residuals `x` of the unknowns into their changes, by those of q, `xu`. Returns the change of the power (W) that is
    /// dissipated.
    pub(super) fn solve(&mut self, xu: &[f64], x: &mut [f64], shapes: &Shapes) -> f64 {
        match &mut self.way {
            Way::Modes(None) => 0.0,
            Way::Modes(Some(own)) => own.modes.solve(self.gamma, xu, x),
            Way::Cells(cells) => {
                let InCells { place, room, .. } = &mut **cells;
                room.fill(0.0);
                shapes.add_lifted(xu, room);
                let place = place.each_ref().map(|at| &at[..]);
                self.branches.solve(self.gamma, place, &self.rates, room, x)
            }
        }
    }
}

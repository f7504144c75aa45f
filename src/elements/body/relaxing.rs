//! The Maxwell branches of a body with any elements.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::Matrix3;

use super::assembly::Elements;
use super::branch_modes::{BranchModes, ModeSet};
use super::branch_state::{BranchCells, BranchState};
use super::continuum::Continuum;
use super::fields::Probe;
use super::regions::Regions;
use super::strain_modes::pay;
use crate::base::sparse::BlockMatrix;
use crate::elements::material::Relaxing;
use crate::elements::rod::RodElements;

/// The branches of a body: of each of several bodies that have any, one after the other.
#[derive(Clone)]
pub(crate) struct Branches {
    bodies: Vec<OfBody>,
}

#[derive(Clone)]
struct OfBody {
    /// Number of the body (from 0) among those of the scene.
    body: usize,
    elements: Arc<dyn Elements>,
    regions: Arc<Regions>,
    /// Those of a rod, in the place of its cells'.
    rod: Option<Arc<RodElements>>,
    /// Its first cell, and its internal strains, among those of all.
    first_cell: usize,
    internal: Range<usize>,
}

impl OfBody {
    fn cells(&self) -> Vec<BranchCells> {
        let Some(rod) = &self.rod else { return self.elements.branch_cells(&self.regions) };
        let [branches, count] = rod.branch_counts();
        let variables = vec!["strain of a rod".to_owned(); branches];
        vec![BranchCells { count, variables, components: rod.internal_of_element() }]
    }
}

impl Branches {
    /// Those of `bodies`, if there are any.
    pub(super) fn of<'a>(bodies: impl Iterator<Item = &'a Continuum>) -> Option<Self> {
        let mut first = 0;
        let relaxing =
            bodies.enumerate().filter(|(_, body)| body.regions.branches().next().is_some());
        let bodies: Vec<OfBody> = relaxing
            .map(|(body, Continuum { elements, regions, rod, cells, .. })| {
                let count = match rod {
                    Some(rod) => rod.internal_of_element() * cells.len(),
                    None => elements.internal_strains(regions),
                };
                let internal = first..first + count;
                first = internal.end;
                let (elements, regions, rod) = (elements.clone(), regions.clone(), rod.clone());
                OfBody { body, elements, regions, rod, first_cell: cells.start, internal }
            })
            .collect();
        (!bodies.is_empty()).then_some(Self { bodies })
    }

    /// Whether the forces along so many shapes follow from the modes of the strains, in less time than from all cells.
    pub(crate) fn have_modes(&self, shapes: usize) -> bool {
        if self.bodies.iter().any(|own| own.rod.is_some()) {
            return false;
        }
        let times = self.bodies.iter().flat_map(|body| body.regions.branches());
        let mut times: Vec<f64> = times.map(|branch| branch.time).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let work: usize = self.bodies.iter().map(|body| body.elements.work()).sum();
        let mut all = self.bodies.iter().flat_map(|body| body.regions.branches());
        all.all(Relaxing::is_linear) && pay(shapes, times.len(), work)
    }

    /// The branches along `shapes` from displacements `origin` (m) and internal strains on.
    pub(crate) fn modes(&self, origin: &[f64], strains: &[f64], shapes: &[&[f64]]) -> BranchModes {
        let mut all = self.bodies.iter().flat_map(|body| body.regions.branches());
        let mut found = ModeSet::new(shapes.len(), !all.any(Relaxing::is_quadratic));
        for OfBody { elements, regions, internal, .. } in &self.bodies {
            let at = [origin, &strains[internal.clone()]];
            elements.add_branch_modes(regions, at, shapes, internal.start, &mut found);
        }
        BranchModes::new(shapes.len(), found)
    }

    /// Number of internal strains, each component counted.
    pub(crate) fn unknowns(&self) -> usize {
        self.bodies.last().map_or(0, |last| last.internal.end)
    }

    /// The state of the branches of the body of that number (from 0), whose components are among `internal`; none
    /// without branches.
    pub(crate) fn state_of(&self, body: usize, internal: &[f64]) -> Option<BranchState> {
        let own = self.bodies.iter().find(|own| own.body == body)?;
        Some(BranchState {
            cells: own.cells(),
            components: internal[own.internal.clone()].to_vec(),
        })
    }

    /// Whether the body of that number (from 0) has branches.
    pub(crate) fn are_of(&self, body: usize) -> bool {
        self.bodies.iter().any(|own| own.body == body)
    }

    /// Writes a `state` to the components of that body among `internal`, if its branches are of the same kinds.
    pub(crate) fn set_state(&self, body: usize, state: &BranchState, internal: &mut [f64]) -> bool {
        let Some(own) = self.bodies.iter().find(|own| own.body == body) else { return false };
        let fits = state.components.len() == own.internal.len() && own.cells() == state.cells;
        if fits {
            internal[own.internal.clone()].copy_from_slice(&state.components);
        }
        fits
    }

    /// Largest rate of relaxation (1/s).
    pub(crate) fn fastest(&self) -> f64 {
        let branches = self.bodies.iter().flat_map(|body| body.regions.branches());
        branches.map(|branch| 1.0 / branch.time).fold(0.0, f64::max)
    }

    /// The stress (Pa) of the branches that `probe` reads at the displacements `u` (m).
    pub(crate) fn probed(&self, probe: &Probe, u: &[f64], internal: &[f64]) -> [[f64; 3]; 3] {
        let mut sum = Matrix3::zeros();
        let solids = self.bodies.iter().filter(|own| own.rod.is_none());
        for OfBody { elements, regions, first_cell, internal: own, .. } in solids {
            let shares = |cell: usize| probe.shares(first_cell + cell);
            let at = [u, &internal[own.clone()]];
            let mut see = |cell: usize, a: usize, stress: &Matrix3<f64>| {
                sum += stress * shares(cell).map_or(0.0, |shares| shares[a]);
            };
            elements.each_branch_stress(regions, at, &|cell| shares(cell).is_some(), &mut see);
        }
        ((sum + sum.transpose()) * 0.5).into()
    }

    /// Writes the internal strains with which the branches have no stress at the displacements `u` (m).
    pub(crate) fn relax(&self, u: &[f64], internal: &mut [f64]) {
        for OfBody { elements, regions, rod, internal: own, .. } in &self.bodies {
            let internal = &mut internal[own.clone()];
            match rod {
                Some(rod) => rod.relax(u, internal),
                None => elements.relax(regions, u, internal),
            }
        }
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
        let of_body = |OfBody { elements, regions, rod, internal: own, .. }: &OfBody| {
            let (internal, rates) = (&internal[own.clone()], &mut rates[own.clone()]);
            match rod {
                Some(rod) => rod.add_branch_forces(u, internal, forces, rates),
                None => elements.add_branch_forces(regions, u, internal, forces, rates),
            }
        };
        self.bodies.iter().map(of_body).sum()
    }

    /// Strain energy (J).
    pub(crate) fn energy(&self, u: &[f64], internal: &[f64]) -> f64 {
        let of_body = |OfBody { elements, regions, rod, internal: own, .. }: &OfBody| match rod {
            Some(rod) => rod.branch_energy(u, &internal[own.clone()]),
            None => elements.branch_energy(regions, u, &internal[own.clone()]),
        };
        self.bodies.iter().map(of_body).sum()
    }

    /// Adds the stiffness of the branches in a step of the parameter `gamma` (s); 0 is a sudden change. Without
    /// `internal` strains they are those without stress.
    pub(crate) fn add_tangents(
        &self,
        gamma: f64,
        u: &[f64],
        internal: &[f64],
        stiffness: &mut BlockMatrix,
    ) {
        for OfBody { elements, regions, rod, internal: own, .. } in &self.bodies {
            // none means without stress
            let own = internal.get(own.clone()).unwrap_or_default();
            match rod {
                Some(rod) => rod.add_branch_tangents(gamma, u, own, stiffness),
                None => elements.add_branch_tangents(regions, gamma, [u, own], stiffness),
            }
        }
    }

    /// Adds gamma sum B^T C P rG, of the `residuals` rG, in a step from the displacements and internal
    /// strains `at`.
    pub(crate) fn add_residuals(
        &self,
        gamma: f64,
        [u, internal]: [&[f64]; 2],
        residuals: &[f64],
        right: &mut [f64],
    ) {
        for OfBody { elements, regions, rod, internal: own, .. } in &self.bodies {
            let (at, residuals) = ([u, &internal[own.clone()]], &residuals[own.clone()]);
            match rod {
                Some(rod) => rod.add_branch_residuals(gamma, u, residuals, right),
                None => elements.add_branch_residuals(regions, gamma, at, residuals, right),
            }
        }
    }

    /// Turns the residuals `x` into xG, with the changes `xu` of the displacements. Returns the change of the
    /// dissipated power (W) from where the internal strains had the `rates`; it is exact under small strains
    /// and without a yield stress.
    pub(crate) fn solve(
        &self,
        gamma: f64,
        [u, internal]: [&[f64]; 2],
        rates: &[f64],
        xu: &[f64],
        x: &mut [f64],
    ) -> f64 {
        let of_body = |OfBody { elements, regions, rod, internal: own, .. }: &OfBody| {
            let (at, rates) = ([u, &internal[own.clone()]], &rates[own.clone()]);
            let x = &mut x[own.clone()];
            match rod {
                Some(rod) => rod.solve_branches(gamma, u, rates, xu, x),
                None => elements.solve_branches(regions, gamma, at, rates, xu, x),
            }
        };
        self.bodies.iter().map(of_body).sum()
    }
}

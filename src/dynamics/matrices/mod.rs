//! The constant matrices of a scene, on one pattern that fits all forces.

mod dissection;

use std::sync::Arc;

use dissection::nested_dissection;

use crate::base::sparse::{BlockMatrix, NodeMatrix, NodePattern};
use crate::elements::body::{Body, Branches, LinearByCells, RigidPieces};
use crate::elements::force::Force;
use crate::elements::material::Substance;

/// Inertia and the constant parts of the tangents. `None` for those that are not needed.
pub(crate) struct Matrices {
    pub(crate) dimension: usize,
    /// Undeformed positions of the nodes (m), and the size of the body (m).
    pub(crate) positions: Vec<f64>,
    pub(crate) size: f64,
    /// M = m (x) I.
    pub(crate) inertia: Arc<NodeMatrix>,
    /// Constant part of -df/du: K, for Cauchy strain.
    pub(crate) stiffness: Option<Arc<BlockMatrix>>,
    /// Constant part of -df/dv: B, for natural viscosity; a M, for mass damping.
    pub(crate) damping: Option<Arc<BlockMatrix>>,
    /// The forces of K and B element by element, if that is less work.
    pub(crate) linear_by_cells: Option<LinearByCells>,
    /// a M, the part of `damping` that is due to mass damping.
    pub(crate) mass_damping: Option<Arc<NodeMatrix>>,
    /// Whether damping forces are least work by the matrix `damping`, and not by cells and by mass damping.
    pub(crate) damps_by_matrix: bool,
    /// The Maxwell branches.
    pub(crate) branches: Option<Branches>,
    /// The longest of the times (s) that viscosities are over moduli, among soft materials; infinite if there are none.
    pub(crate) retardation_time: f64,
    /// Typical displacements (m) and velocities (m/s) at small strains of 0.01.
    pub(crate) scales: [f64; 2],
    /// The nodes in an order of elimination that may leave less fill than minimum degree, on meshes
    /// that are large enough for that to matter.
    pub(crate) dissection: Option<Vec<usize>>,
    /// Nodes that move with others.
    pub(crate) rigid: Option<Arc<RigidPieces>>,
}

/// Number of nodes from which a second order of elimination is worth computing.
const LARGE: usize = 2000;

impl Matrices {
    /// The matrices of `body` under `forces`.
    pub(crate) fn new<'a>(body: &Body, forces: impl Iterator<Item = &'a dyn Force>) -> Self {
        let pattern = body.inertia().pattern();
        let strangers: Vec<[usize; 2]> = forces
            .flat_map(Force::couplings)
            .filter(|&[a, b]| pattern.find(a, b).is_none())
            .collect();
        let (dimension, positions) = (body.dimension(), body.mesh().positions());
        let size = body.size();
        let scales = [size, body.largest_wave_speed()].map(|scale| 0.01 * scale);
        let (inertia, stiffness, damping) =
            (body.shared_inertia(), body.constant_stiffness(), body.constant_damping());
        let (linear_by_cells, mass_damping) = (body.linear_by_cells(), body.mass_damping());
        let (damps_by_matrix, branches) = (body.damps_by_matrix(), body.branches());
        let matrices = Self {
            dimension,
            positions: positions.to_vec(),
            size,
            inertia,
            stiffness,
            damping,
            linear_by_cells,
            mass_damping,
            damps_by_matrix,
            branches,
            retardation_time: retardation_time(body),
            scales,
            dissection: None,
            rigid: body.rigid_pieces().cloned(),
        };
        if strangers.is_empty() && matrices.rigid.is_none() {
            return Self { dissection: dissection(pattern, positions, dimension), ..matrices };
        }
        matrices.with_pairs(&strangers)
    }

    /// The same matrices with entries for some more pairs of nodes, and for the nodes by which those move.
    pub(crate) fn with_pairs(&self, pairs: &[[usize; 2]]) -> Self {
        let mut pattern = self.pattern().with_pairs(pairs);
        if let Some(rigid) = &self.rigid {
            pattern = pattern.with_pairs(&rigid.couplings(&pattern));
        }
        let pattern = Arc::new(pattern);
        let moved = |matrix: &Arc<BlockMatrix>| Arc::new(matrix.moved_to(&pattern));
        Self {
            positions: self.positions.clone(),
            inertia: Arc::new(self.inertia.moved_to(&pattern)),
            stiffness: self.stiffness.as_ref().map(moved),
            damping: self.damping.as_ref().map(moved),
            linear_by_cells: self.linear_by_cells.clone(),
            mass_damping: self.mass_damping.clone(),
            branches: self.branches.clone(),
            rigid: self.rigid.clone(),
            dissection: dissection(&pattern, &self.positions, self.dimension),
            ..*self
        }
    }

    /// y += factor M x
    pub(crate) fn add_momentum(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        self.inertia.add_product(self.dimension, factor, x, y);
    }

    /// M x
    pub(crate) fn momentum(&self, x: &[f64]) -> Vec<f64> {
        let mut momentum = vec![0.0; x.len()];
        self.add_momentum(1.0, x, &mut momentum);
        momentum
    }

    /// Component `dof` of M x.
    pub(crate) fn momentum_of(&self, dof: usize, x: &[f64]) -> f64 {
        self.inertia.row_product(self.dimension, dof, x)
    }

    /// x.M x
    pub(crate) fn square(&self, x: &[f64]) -> f64 {
        self.inertia.quadratic_form(self.dimension, x)
    }

    /// Adds the mass of the surroundings that moves along with pairs of nodes (kg).
    pub(crate) fn carry(&mut self, masses: &[([usize; 2], f64)]) {
        if masses.is_empty() {
            return;
        }
        let inertia = Arc::make_mut(&mut self.inertia);
        masses.iter().for_each(|&([a, b], mass)| inertia.add(a, b, mass));
    }

    /// Number of displacement components.
    pub(crate) fn dofs(&self) -> usize {
        self.pattern().nodes() * self.dimension
    }

    /// Moves nodal forces of rigid pieces to the nodes of their frames, where they do the same work.
    pub(crate) fn gather(&self, f: &mut [f64]) {
        self.rigid.iter().for_each(|rigid| rigid.gather(f));
    }

    pub(crate) fn pattern(&self) -> &Arc<NodePattern> {
        self.inertia.pattern()
    }
}

fn retardation_time(body: &Body) -> f64 {
    let soft = body.substances().filter(|substance| !substance.is_rigid);
    let time = |substance: &Substance| substance.material.viscosity / substance.material.young;
    soft.map(time).reduce(f64::max).unwrap_or(f64::INFINITY)
}

/// A second order of elimination, where it pays.
fn dissection(pattern: &NodePattern, positions: &[f64], dimension: usize) -> Option<Vec<usize>> {
    (pattern.nodes() >= LARGE).then(|| nested_dissection(pattern, positions, dimension))
}

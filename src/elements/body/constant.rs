//! The constant parts of stiffness and damping.
//!
//! Mass damping, -a M v, is a constant part of D with any viscosity: a product with one number per
//! pair of nodes (with lumped inertia per node) beside the loop over cells or objective viscosity. Where
//! natural viscosity is a product with B, B contains it.

use std::sync::Arc;

use super::assembled::Body;
use super::continuum::Continuum;
use crate::base::sparse::{BlockMatrix, NodeMatrix};

impl Body {
    /// The constant part of K, if it is not 0: that of the bodies whose elastic force is -K u.
    pub(crate) fn constant_stiffness(&self) -> Option<Arc<BlockMatrix>> {
        if self.continua.iter().all(Continuum::is_linear) {
            return Some(self.stiffness.clone());
        }
        self.join_some(|body| body.constant_stiffness())
    }

    /// The part of B that is constant, if it is not 0: all of it if viscosity is natural, a M otherwise.
    pub(crate) fn constant_damping(&self) -> Option<Arc<BlockMatrix>> {
        if !self.is_single() {
            return self.join_some(|body| body.constant_damping());
        }
        if self.has_natural_viscosity() {
            return Some(self.damping.clone());
        }
        self.mass_damping.as_ref().map(|by_mass| {
            let mut matrix = BlockMatrix::zeros(self.damping.pattern(), self.dimension());
            matrix.add_on_all_axes(by_mass);
            Arc::new(matrix)
        })
    }

    /// The matrices that some of the joined bodies have, as one.
    fn join_some(
        &self,
        matrix: impl Fn(&Self) -> Option<Arc<BlockMatrix>>,
    ) -> Option<Arc<BlockMatrix>> {
        let all: Vec<_> = self.joined.iter().map(|part| (&part.body, matrix(&part.body))).collect();
        let parts = all.iter().map(|(body, of)| of.as_deref().ok_or(&**body.inertia.pattern()));
        let is_some = all.iter().any(|(_, of)| of.is_some());
        is_some.then(|| {
            let pattern = self.stiffness.pattern();
            Arc::new(BlockMatrix::join(pattern, self.dimension(), parts))
        })
    }

    /// Whether a viscous force is that of a constant matrix, and not 0.
    fn has_natural_viscosity(&self) -> bool {
        self.continua.iter().any(Continuum::has_natural_viscosity)
    }

    /// The part a M of B, if it is not 0.
    pub(crate) fn mass_damping(&self) -> Option<Arc<NodeMatrix>> {
        self.mass_damping.clone()
    }

    /// Whether -B v costs least by the matrix of all constant damping.
    pub(crate) fn damps_by_matrix(&self) -> bool {
        self.has_natural_viscosity() && !self.is_linear_by_cells()
    }
}

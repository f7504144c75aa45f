//! Masses of nodes, and means that are weighted by them.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use crate::base::sparse::NodeMatrix;
use crate::elements::mesh::Mesh;

/// Masses that means are weighted by.
#[derive(Debug)]
pub(super) struct NodalMasses {
    /// kg
    pub(super) total: f64,
    /// Of each node, the row sums of m (kg).
    pub(super) of_nodes: Vec<f64>,
    /// The centre of mass of the undeformed shape (m).
    pub(super) centre: Vec<f64>,
}

impl NodalMasses {
    /// Those of a body with this inertia.
    pub(super) fn new(inertia: &NodeMatrix, mesh: &Mesh) -> Self {
        let pattern = inertia.pattern();
        let row_sum = |row| pattern.row(row).map(|(entry, _)| inertia.values[entry]).sum();
        let of_nodes = (0..pattern.nodes()).map(row_sum).collect();
        let masses = Self { total: inertia.values.iter().sum(), of_nodes, centre: Vec::new() };
        let centre = masses.average(mesh.positions(), mesh.dimension());
        Self { centre, ..masses }
    }

    /// Mean of `x` (`dimension` components per node), weighted by mass.
    pub(super) fn average(&self, x: &[f64], dimension: usize) -> Vec<f64> {
        match dimension {
            1 => self.average_of::<1>(x).into(),
            2 => self.average_of::<2>(x).into(),
            _ => self.average_of::<3>(x).into(),
        }
    }

    fn average_of<const D: usize>(&self, x: &[f64]) -> [f64; D] {
        let mut average = [0.0; D];
        for (nodal_mass, x) in self.of_nodes.iter().zip(x.as_chunks::<D>().0) {
            for axis in 0..D {
                average[axis] += nodal_mass * x[axis] / self.total;
            }
        }
        average
    }
}

//! Walls of a body of revolution, and the volume within them.
//!
//! With V = pi int r^2 z' ds along the walls, edges on the axis and level discs, where z does not change, contribute nothing. It is a
//! polynomial of the positions, which the quadrature of the edges integrates exactly.

use std::f64::consts::PI;

use crate::base::sparse::BlockMatrix;
use crate::elements::body::Body;
use crate::elements::mesh::{Face, FaceKind};
use crate::scene::forces::faces::LoadedFace;
use crate::scene::forces::followed::{FollowedFaces, add_block};

/// Walls in the plane (r, z), turned about the axis.
pub(super) struct Circles {
    faces: FollowedFaces,
    edges: Vec<Face>,
}

impl Circles {
    /// # Errors
    /// Edges without a normal, in words.
    pub(super) fn new(body: &Body, edges: Vec<Face>) -> Result<Self, &'static str> {
        let loaded = edges.iter().map(|nodes| LoadedFace {
            nodes: nodes.clone(),
            kind: if nodes.len() == 2 { FaceKind::Segment } else { FaceKind::Segment3 },
            section: Some(1.0),
        });
        Ok(Self { faces: FollowedFaces::new(body.mesh(), loaded.collect())?, edges })
    }

    /// Number of edges.
    pub(super) fn edges(&self) -> usize {
        self.edges.len()
    }

    /// Pairs of nodes that the second derivative couples.
    pub(super) fn couplings(&self) -> Vec<[usize; 2]> {
        let pairs = |edge: &Face| {
            let all = (0..edge.len()).flat_map(|k| (0..k).map(move |other| [other, k]));
            all.map(|pair| pair.map(|k| edge[k])).collect::<Vec<_>>()
        };
        self.edges.iter().flat_map(pairs).collect()
    }

    /// V, signed.
    pub(super) fn measure(&self, u: &[f64]) -> f64 {
        let mut sum = 0.0;
        self.faces.each_point(u, |at| {
            let r = at.place()[0];
            sum += PI * at.point.weight * r * r * at.tangents[0][1];
        });
        sum
    }

    /// Adds `factor` dV/du.
    pub(super) fn add_gradient(&self, factor: f64, u: &[f64], forces: &mut [f64]) {
        self.faces.each_point(u, |at| {
            let (r, rise) = (at.place()[0], at.tangents[0][1]);
            let factor = PI * factor * at.point.weight * r;
            let shapes = at.point.values.iter().zip(&at.point.derivatives);
            for (node, (value, [along, _])) in at.nodes.iter().zip(shapes) {
                forces[2 * node] += 2.0 * factor * rise * value;
                forces[2 * node + 1] += factor * r * along;
            }
        });
    }

    /// Adds `factor` d^2V/du^2.
    pub(super) fn add_hessian(&self, factor: f64, u: &[f64], matrix: &mut BlockMatrix) {
        self.faces.each_point(u, |at| {
            let (r, rise) = (at.place()[0], at.tangents[0][1]);
            let factor = 2.0 * PI * factor * at.point.weight;
            let shapes = || at.nodes.iter().zip(at.point.values.iter().zip(&at.point.derivatives));
            for (row, (of_row, [along_row, _])) in shapes() {
                for (column, (of_column, [along_column, _])) in shapes() {
                    let mut block = [[0.0; 3]; 3];
                    block[0][0] = of_row * of_column * rise;
                    block[0][1] = r * of_row * along_column;
                    block[1][0] = r * of_column * along_row;
                    add_block(matrix, [*row, *column], factor, &block);
                }
            }
        });
    }
}

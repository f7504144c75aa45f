//! Depth of the volume within a closed surface.

use super::followed::{FollowedFaces, add_block};
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{cross, dot};

/// The integral S of the depth d = l + e . x over what a closed surface encloses, by the divergence theorem and at the quadrature points of
/// its faces:
///
/// ```text
/// S = int d dV = int (1/2) d^2 (e . n) dA.
/// ```
pub(crate) struct Moment {
    faces: FollowedFaces,
    /// e, of length 1.
    down: [f64; 3],
    /// l (m)
    level: f64,
    /// 1 if the normals of the faces lead outside, else -1.
    sense: f64,
}

impl Moment {
    pub(super) fn new(faces: FollowedFaces, down: [f64; 3], sense: f64) -> Self {
        Self { faces, down, level: 0.0, sense }
    }

    /// The same with depths that are larger by `more` (m).
    pub(super) fn deeper(self, more: f64) -> Self {
        Self { level: self.level + more, ..self }
    }

    /// S (m^4) under the displacements `u` (m).
    pub(super) fn value(&self, u: &[f64]) -> f64 {
        let mut sum = 0.0;
        self.faces.each_point(u, |at| {
            let depth = self.level + dot(&self.down, &at.place());
            sum += at.point.weight * depth * depth * dot(&self.down, &at.facing());
        });
        0.5 * self.sense * sum
    }

    /// Adds `factor` times dS/du.
    pub(super) fn add_gradient(&self, factor: f64, u: &[f64], gradient: &mut [f64]) {
        let (d, e) = (self.faces.dimension, &self.down);
        self.faces.each_point(u, |at| {
            let depth = self.level + dot(e, &at.place());
            let factor = factor * self.sense * at.point.weight * depth;
            let straight = factor * dot(e, &at.facing());
            for ((node, share), c) in at.nodes.iter().zip(at.point.values).zip(at.turning()) {
                let turned = cross(e, &c);
                let own = gradient[node * d..][..d].iter_mut().enumerate();
                own.for_each(|(i, x)| {
                    *x += straight * share * e[i] + 0.5 * factor * depth * turned[i];
                });
            }
        });
    }

    /// Adds `factor` times d^2S/du^2.
    pub(super) fn add_hessian(&self, factor: f64, u: &[f64], matrix: &mut BlockMatrix) {
        self.faces.each_point(u, |at| {
            let (facing, depth) = (at.facing(), self.level + dot(&self.down, &at.place()));
            let factor = factor * self.sense * at.point.weight;
            for (b, (column, to)) in at.nodes.iter().zip(at.turning()).enumerate() {
                for (a, (row, from)) in at.nodes.iter().zip(at.turning()).enumerate() {
                    let hessian = at.bending(&self.down, depth, &facing, [(a, from), (b, to)]);
                    add_block(matrix, [*row, *column], factor, &hessian);
                }
            }
        });
    }
}

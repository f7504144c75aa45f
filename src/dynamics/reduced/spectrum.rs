//! The spectrum along the shapes of a reduced model, which are orthonormal by M.
//!
//! Shapes have the motion of a free body with a little strain: it is recognized by a kinetic energy that is rigid to 99 %.

use nalgebra::{DMatrix, SymmetricEigen};

use super::projection::Projection;
use crate::base::vector::dot;
use crate::dynamics::system::{Spectrum, System};

/// Part of the highest eigenvalue along shapes below which one is round-off of 0.
const ROUND_OFF: f64 = 1e-10;

/// Part of the kinetic energy of a shape in rigid motions from which on it is no vibration.
const NEARLY_RIGID: f64 = 0.99;

impl Projection {
    /// The spectrum by the tangents of the `full` equations, under the displacements `u` (m).
    pub(super) fn spectrum(&self, full: &System, u: &[f64]) -> Spectrum {
        let shapes = &self.shapes;
        let (count, free) = (shapes.count(), shapes.free());
        let along = |product: &dyn Fn(&[f64], &mut [f64])| {
            let all = shapes.products(product);
            let entry = |i: usize, j: usize| 0.5 * (all[i * count + j] + all[j * count + i]);
            DMatrix::from_fn(free, free, entry)
        };
        let d = full.tangents().1;
        let stiffness = SymmetricEigen::new(along(&|x, y| full.add_stiffness(x, y)));
        let damping = along(&|x, y| d.add_product(1.0, x, y));
        let highest = stiffness.eigenvalues.iter().copied().fold(0.0, f64::max);
        // shapes hold rigid motions with a little strain
        let rigid = full.rigid_motions(u, ROUND_OFF * highest);
        let rigid: Vec<Vec<f64>> = rigid.iter().map(|motion| shapes.coordinates(motion)).collect();
        let is_vibration = |&i: &usize| {
            let x = stiffness.eigenvectors.column(i);
            let part: f64 = rigid.iter().map(|motion| dot(motion, x.as_slice()).powi(2)).sum();
            stiffness.eigenvalues[i] > ROUND_OFF * highest && part < NEARLY_RIGID
        };
        let lowest = (0..free)
            .filter(is_vibration)
            .min_by(|&i, &j| stiffness.eigenvalues[i].total_cmp(&stiffness.eigenvalues[j]));
        let lowest = lowest.map(|lowest| {
            let x = stiffness.eigenvectors.column(lowest);
            let form = |matrix: &DMatrix<f64>| (matrix * x).dot(&x);
            let by_mass = full.matrices().mass_damping.as_ref().map_or(0.0, |m| {
                form(&along(&|x, y| m.add_product(full.matrices().dimension, 1.0, x, y)))
            });
            [stiffness.eigenvalues[lowest], form(&damping), by_mass]
        });
        let damping_rate = damping.symmetric_eigenvalues().iter().copied().fold(0.0, f64::max);
        Spectrum::new([highest, damping_rate], lowest)
    }
}

//! Strain, stress and energy density of the cells, to look at.
//!
//! Tensors are those of the three-dimensional body that a cell stands for. With the frame F_0, E and
//! S of a cell, and n its unit normals (none in a solid, one in a plane or membrane, two in a string):
//!
//! | | strain | stress |
//! | --- | --- | --- |
//! | Cauchy | F_0 E F_0^T + e sum n n^T, n of the natural shape | F_0 S F_0^T + s sum n n^T, the same n |
//! | Green | the same | (F S F^T + s sum n n^T) / det F, n of the present shape |
//!
//! Across a cell there is either no strain (plane strain: e = 0, s = lambda tr E) or no stress (plane
//! stress and segments: s = 0, e = -lambda tr E / (2 mu) with their reduced lambda).

#[cfg(test)]
mod tests;

use nalgebra::{Matrix3, SMatrix};

use super::Strain;
use super::strain::{cauchy_strain, energy_density, green_strain, stress, stretch_of};
use crate::element::StrainPoint;
use crate::material::{Lame, Plane};

/// Strain, stress and strain energy density of one cell: means over its natural volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellField {
    /// Cauchy's or Green's strain, as the body's; a tensor along the axes of space. Strains across
    /// cells in plane stress and across strings are those that leave them without stress.
    pub strain: [[f64; 3]; 3],
    /// Stress (Pa), a tensor along the axes of space. With Green strain it is the true stress, force
    /// per present area, but that thickness and cross-section count as those of the natural shape.
    pub stress: [[f64; 3]; 3],
    /// Strain energy per natural volume (J/m^3).
    pub energy_density: f64,
}

impl CellField {
    /// The stress of von Mises (Pa): sqrt(3/2) times the norm of the stress without its mean pressure.
    pub fn von_mises(&self) -> f64 {
        let stress = Matrix3::from(self.stress);
        let deviator = stress - Matrix3::identity() * (stress.trace() / 3.0);
        1.5_f64.sqrt() * deviator.norm()
    }
}

/// How strain is measured and what there is across a cell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measure {
    pub(super) strain: Strain,
    pub(super) across: Plane,
}

/// The fields at one strain point.
pub(super) struct PointField {
    strain: Matrix3<f64>,
    stress: Matrix3<f64>,
    energy_density: f64,
}

impl PointField {
    /// `h` is the displacement gradient H at `point`.
    pub(super) fn new<const N: usize, const M: usize, const D: usize>(
        measure: Measure,
        lame: Lame,
        point: &StrainPoint<N, M, D>,
        h: &SMatrix<f64, D, M>,
    ) -> Self {
        let strain = match measure.strain {
            Strain::Cauchy => cauchy_strain(point, h),
            Strain::Green => green_strain(point, h),
        };
        let inner = stress(lame, &strain);
        let (strain_across, stress_across) = match measure.across {
            Plane::Strain => (0.0, lame.lambda * strain.trace()),
            Plane::Stress => (-lame.lambda / (2.0 * lame.mu) * strain.trace(), 0.0),
        };
        let f = point.frame + h;
        let (frame, present) = (in_space(&point.frame), in_space(&f));
        let embed = |tensor, frame: &SMatrix<f64, 3, M>, across| {
            frame * tensor * frame.transpose() + normal_part(frame) * across
        };
        Self {
            strain: embed(strain, &frame, strain_across),
            stress: match measure.strain {
                Strain::Cauchy => embed(inner, &frame, stress_across),
                Strain::Green => embed(inner, &present, stress_across) / stretch_of(&f),
            },
            energy_density: energy_density(lame, &strain),
        }
    }
}

/// The mean of `points`, each with the volume that it stands for.
pub(super) fn mean(points: impl Iterator<Item = (f64, PointField)>) -> CellField {
    let (mut volume, mut strain, mut stress) = (0.0, Matrix3::zeros(), Matrix3::zeros());
    let mut energy = 0.0;
    for (share, point) in points {
        volume += share;
        strain += point.strain * share;
        stress += point.stress * share;
        energy += point.energy_density * share;
    }
    let tensor = |sum: Matrix3<f64>| ((sum + sum.transpose()) / (2.0 * volume)).into();
    CellField { strain: tensor(strain), stress: tensor(stress), energy_density: energy / volume }
}

/// `frame` with a row for each axis of three-dimensional space.
fn in_space<const M: usize, const D: usize>(frame: &SMatrix<f64, D, M>) -> SMatrix<f64, 3, M> {
    SMatrix::from_fn(|i, j| if i < D { frame[(i, j)] } else { 0.0 })
}

/// sum n n^T over the unit normals of the space that the columns of `frame` span.
fn normal_part<const M: usize>(frame: &SMatrix<f64, 3, M>) -> Matrix3<f64> {
    match frame.tr_mul(frame).try_inverse() {
        Some(inverse) if M < 3 => Matrix3::identity() - frame * inverse * frame.transpose(),
        // nothing is across a solid; what is across a cell pressed flat has no direction
        _ => Matrix3::zeros(),
    }
}

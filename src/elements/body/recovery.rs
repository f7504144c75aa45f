//! A-posteriori estimate of the discretization error, from jumps of the strains between cells.
//!
//! Zienkiewicz and Zhu's estimate (Int. J. Numer. Meth. Eng. 24, 1987): the error of the strains of linear
//! cells is about their difference from a continuous field, which at each node is the mean of the cells
//! around it. Each material has its own mean, as strains jump at interfaces of materials.

use super::elements::ElementsOf;
use super::regions::Regions;
use super::revolved::Revolved;
use crate::base::tensor::Matrix;
use crate::elements::material::{Deformation, Strain};

/// Elements whose strains can be made continuous.
pub(super) trait Recovery {
    /// Strain energy (J), and that of the difference between the strain and its continuous mean, cell by cell, both by
    /// Hooke's law of small strains, and without the energy of a change of volume if the dilatation is
    /// a projected one.
    fn jumps(&self, regions: &Regions, strain: Strain, u: &[f64]) -> (f64, Vec<f64>);
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Recovery
    for ElementsOf<N, M, D, Q>
{
    fn jumps(&self, regions: &Regions, strain: Strain, u: &[f64]) -> (f64, Vec<f64>) {
        if const { M == 2 && D == 2 }
            && let Some(revolved) = &self.revolved
        {
            return self.jumps_of(regions, u, |cell| revolved.strains(cell, strain, u));
        }
        self.jumps_of(regions, u, |cell| self.strains(cell, strain, u))
    }
}

impl Revolved {
    /// The strain points of a cell: their volumes, and twice the strain.
    fn strains(
        &self,
        cell: usize,
        strain: Strain,
        u: &[f64],
    ) -> impl Iterator<Item = (f64, Matrix<f64, 3, 3>)> {
        let twice = move |point| twice_strain(strain, &self.deformed(cell, point, u));
        self.points_of(cell).map(move |point| (self.volumes[point], twice(point)))
    }
}

fn twice_strain<const M: usize, const D: usize>(
    strain: Strain,
    at: &Deformation<f64, M, D>,
) -> Matrix<f64, M, M> {
    match strain {
        Strain::Cauchy => at.twice_cauchy(),
        Strain::Green => at.twice_green(),
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// The energy, and that of the jumps of the `strains` at the points of cells, of `S` axes.
    fn jumps_of<const S: usize, I: Iterator<Item = (f64, Matrix<f64, S, S>)>>(
        &self,
        regions: &Regions,
        u: &[f64],
        strains: impl Fn(usize) -> I,
    ) -> (f64, Vec<f64>) {
        let (mut energy, mut jumps) = (0.0, vec![0.0; self.nodes.len()]);
        for cells in regions.by_substance(self.nodes.len()) {
            let means = self.means(&cells, u.len() / D, &strains);
            for &cell in &cells {
                let mut hooke = regions.of(cell).hooke;
                if self.is_projected() {
                    // nothing resists a change of volume at the points
                    hooke = hooke.of_shear();
                }
                for ((volume, own), values) in strains(cell).zip(&self.values) {
                    let mut apart = own;
                    for (node, value) in self.nodes[cell].iter().zip(values) {
                        add(&mut apart, -value, &means[*node]);
                    }
                    energy += volume * hooke.energy(&own);
                    jumps[cell] += volume * hooke.energy(&apart);
                }
            }
        }
        (energy, jumps)
    }

    /// The strain points of a cell: their volumes, and twice the strain.
    fn strains(
        &self,
        cell: usize,
        strain: Strain,
        u: &[f64],
    ) -> impl Iterator<Item = (f64, Matrix<f64, M, M>)> {
        self.deformed(cell, u).map(move |(volume, at)| (volume, twice_strain(strain, &at)))
    }

    /// Means at the `count` nodes of twice the `strains` that the `cells` around them have there, weighted by their
    /// volumes.
    fn means<const S: usize, I: Iterator<Item = (f64, Matrix<f64, S, S>)>>(
        &self,
        cells: &[usize],
        count: usize,
        strains: &impl Fn(usize) -> I,
    ) -> Vec<Matrix<f64, S, S>> {
        let (mut means, mut volumes) = (vec![[[0.0; S]; S]; count], vec![0.0; count]);
        for &cell in cells {
            let own: [_; Q] = {
                let mut points = strains(cell);
                std::array::from_fn(|_| points.next().unwrap_or((0.0, [[0.0; S]; S])))
            };
            let volume: f64 = own.iter().map(|(volume, _)| volume).sum();
            for (a, &node) in self.nodes[cell].iter().enumerate() {
                volumes[node] += volume;
                for ((_, strain), factor) in own.iter().zip(self.extrapolation[a]) {
                    add(&mut means[node], volume * factor, strain);
                }
            }
        }
        for (mean, volume) in means.iter_mut().zip(volumes) {
            mean.as_flattened_mut().iter_mut().for_each(|x| *x /= volume);
        }
        means
    }
}

fn add<const M: usize>(sum: &mut Matrix<f64, M, M>, factor: f64, part: &Matrix<f64, M, M>) {
    let parts = part.as_flattened();
    sum.as_flattened_mut().iter_mut().zip(parts).for_each(|(sum, part)| *sum += factor * part);
}

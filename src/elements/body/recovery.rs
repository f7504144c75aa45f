//! How far strains jump from cell to cell: an estimate, from the result, of the error that the mesh causes.
//!
//! Zienkiewicz and Zhu's estimate (Int. J. Numer. Meth. Eng. 24, 1987): the error of the strains of linear
//! cells is about their difference from a continuous field, which at each node is the mean of the cells
//! around it. Each material has its own mean, for strains do jump where materials meet.

use super::elements::ElementsOf;
use super::regions::Regions;
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
        let (mut energy, mut jumps) = (0.0, vec![0.0; self.nodes.len()]);
        for cells in regions.by_substance(self.nodes.len()) {
            let means = self.means(&cells, strain, u);
            for &cell in &cells {
                let mut hooke = regions.of(cell).hooke;
                if self.is_projected() {
                    // nothing resists a change of volume at the points
                    hooke = hooke.of_shear();
                }
                for ((volume, own), values) in self.strains(cell, strain, u).zip(&self.values) {
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
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// The strain points of a cell: their volumes, and twice the strain.
    fn strains(
        &self,
        cell: usize,
        strain: Strain,
        u: &[f64],
    ) -> impl Iterator<Item = (f64, Matrix<f64, M, M>)> {
        self.deformed(cell, u).map(move |(volume, at): (f64, Deformation<f64, M, D>)| {
            let twice = match strain {
                Strain::Cauchy => at.twice_cauchy(),
                Strain::Green => at.twice_green(),
            };
            (volume, twice)
        })
    }

    /// Means at the nodes of twice the strain that the `cells` around them have there, weighted by their
    /// volumes.
    fn means(&self, cells: &[usize], strain: Strain, u: &[f64]) -> Vec<Matrix<f64, M, M>> {
        let count = u.len() / D;
        let (mut means, mut volumes) = (vec![[[0.0; M]; M]; count], vec![0.0; count]);
        for &cell in cells {
            let own: [_; Q] = {
                let mut points = self.strains(cell, strain, u);
                std::array::from_fn(|_| points.next().unwrap_or((0.0, [[0.0; M]; M])))
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

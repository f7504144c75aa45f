//! The Maxwell branches of all elements: their forces, and their internal strains as unknowns.
//!
//! A branch has a strain G at each strain point of a cell, its components one after the other: those of the branches of a point, of
//! the points of a cell, of the cells. Nothing couples those of two points but the displacements, so that the Newton system
//! is solved for them point by point: with part = 1 / (1 + gamma/tau) and the change B xu of the strain,
//!
//! ```text
//! xG = part rG + (1 - part) B xu
//! (... + gamma^2 sum part B^T C B) xv = ... + gamma sum part B^T C rG
//! ```

use super::elements::{ElementsOf, gradient, pairs};
use super::forces::{collect, relative};
use super::regions::Regions;
use crate::element::StrainPoint;
use crate::material::{Blocks, Relaxing, components};
use crate::sparse::BlockMatrix;
use crate::tensor::Matrix;

/// Components of a strain, at most.
const MOST: usize = components(3);

/// Elements with branches.
pub(super) trait Branched {
    fn internal_strains(&self, regions: &Regions) -> usize;

    fn relax(&self, regions: &Regions, u: &[f64], internal: &mut [f64]);

    fn add_branch_forces(
        &self,
        regions: &Regions,
        u: &[f64],
        internal: &[f64],
        forces: &mut [f64],
        rates: &mut [f64],
    ) -> f64;

    fn branch_energy(&self, regions: &Regions, u: &[f64], internal: &[f64]) -> f64;

    fn add_branch_tangents(
        &self,
        regions: &Regions,
        gamma: f64,
        at: [&[f64]; 2],
        stiffness: &mut BlockMatrix,
    );

    fn add_branch_residuals(
        &self,
        regions: &Regions,
        gamma: f64,
        at: [&[f64]; 2],
        right: &mut [f64],
    );

    fn solve_branches(&self, regions: &Regions, gamma: f64, at: [&[f64]; 3], x: &mut [f64]) -> f64;
}

/// A branch at a point of a cell.
struct Site<'a, const N: usize, const M: usize, const D: usize> {
    branch: &'a Relaxing,
    point: &'a StrainPoint<f64, N, M, D>,
    /// Gradient of the displacements.
    h: Matrix<f64, D, M>,
    cell: usize,
    /// Place of its internal strain among all.
    first: usize,
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Visits all branches at all points.
    fn visit(&self, regions: &Regions, u: &[f64], mut work: impl FnMut(Site<'_, N, M, D>)) {
        let u = u.as_chunks::<D>().0;
        let mut first = 0;
        for (cell, nodes) in self.nodes.iter().enumerate() {
            let branches = &regions.of(cell).branches;
            if branches.is_empty() {
                continue;
            }
            let x = relative(nodes, u);
            for point in self.points(cell) {
                let h = gradient(1, &x, &point.gradients);
                for branch in branches {
                    work(Site { branch, point: &point, h, cell, first });
                    first += components(M);
                }
            }
        }
    }

    /// Adds `factor` sum P g_a to the vectors of the nodes of a cell.
    fn pull(
        &self,
        site: &Site<'_, N, M, D>,
        stress: &Matrix<f64, D, M>,
        factor: f64,
        vectors: &mut [f64],
    ) {
        let vectors = vectors.as_chunks_mut::<D>().0;
        let mut pulls = [[0.0; D]; N];
        collect(&site.point.gradients, stress, &mut pulls);
        let nodes = &self.nodes[site.cell];
        for (pull, &node) in pulls.iter().zip(nodes).skip(1) {
            for i in 0..D {
                vectors[node][i] += factor * pull[i];
                vectors[nodes[0]][i] -= factor * pull[i];
            }
        }
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Branched
    for ElementsOf<N, M, D, Q>
{
    fn internal_strains(&self, regions: &Regions) -> usize {
        let of_cell = |cell| Q * components(M) * regions.of(cell).branches.len();
        (0..self.nodes.len()).map(of_cell).sum()
    }

    fn relax(&self, regions: &Regions, u: &[f64], internal: &mut [f64]) {
        self.visit(regions, u, |site| {
            let at = site.branch.at(site.point.frame, site.h);
            at.strain(&mut internal[site.first..][..components(M)]);
        });
    }

    fn add_branch_forces(
        &self,
        regions: &Regions,
        u: &[f64],
        internal: &[f64],
        forces: &mut [f64],
        rates: &mut [f64],
    ) -> f64 {
        let mut power = 0.0;
        self.visit(regions, u, |site| {
            let (at, volume) = (site.branch.at(site.point.frame, site.h), site.point.volume);
            let own = site.first..site.first + components(M);
            let apart = &mut [0.0; MOST][..components(M)];
            at.strain(apart);
            apart.iter_mut().zip(&internal[own.clone()]).for_each(|(e, g)| *e -= g);
            self.pull(&site, &site.branch.stress(&at, apart, volume), -1.0, forces);
            power += volume * site.branch.twice_energy::<M>(apart) / site.branch.time;
            rates[own].iter_mut().zip(apart).for_each(|(rate, e)| *rate = *e / site.branch.time);
        });
        power
    }

    fn branch_energy(&self, regions: &Regions, u: &[f64], internal: &[f64]) -> f64 {
        let mut twice = 0.0;
        self.visit(regions, u, |site| {
            let apart = &mut [0.0; MOST][..components(M)];
            site.branch.at(site.point.frame, site.h).strain(apart);
            apart.iter_mut().zip(&internal[site.first..]).for_each(|(e, g)| *e -= g);
            twice += site.point.volume * site.branch.twice_energy::<M>(apart);
        });
        0.5 * twice
    }

    fn add_branch_tangents(
        &self,
        regions: &Regions,
        gamma: f64,
        [u, internal]: [&[f64]; 2],
        stiffness: &mut BlockMatrix,
    ) {
        let mut stiffness = stiffness.rows_mut::<D>();
        self.visit(regions, u, |site| {
            let at = site.branch.at(site.point.frame, site.h);
            let apart = &mut [0.0; MOST][..components(M)];
            if !internal.is_empty() {
                at.strain(apart);
                apart.iter_mut().zip(&internal[site.first..]).for_each(|(e, g)| *e -= g);
            }
            let (part, gradients) = (site.branch.part(gamma), &site.point.gradients);
            let tangent = site.branch.tangent(&at, apart, part, gradients, site.point.volume);
            for (a, b) in pairs::<N>() {
                if let Some(sum) = stiffness.block_mut(self.entries[site.cell][a][b]) {
                    let block = tangent.block(a, b);
                    for i in 0..D {
                        (0..D).for_each(|k| sum[i][k] += block[i][k]);
                    }
                }
            }
        });
    }

    fn add_branch_residuals(
        &self,
        regions: &Regions,
        gamma: f64,
        [u, residuals]: [&[f64]; 2],
        right: &mut [f64],
    ) {
        self.visit(regions, u, |site| {
            let at = site.branch.at(site.point.frame, site.h);
            let residual = &residuals[site.first..][..components(M)];
            let stress = site.branch.stress(&at, residual, site.point.volume);
            self.pull(&site, &stress, gamma * site.branch.part(gamma), right);
        });
    }

    fn solve_branches(
        &self,
        regions: &Regions,
        gamma: f64,
        [u, rates, xu]: [&[f64]; 3],
        x: &mut [f64],
    ) -> f64 {
        let xu = xu.as_chunks::<D>().0;
        let mut change = 0.0;
        self.visit(regions, u, |site| {
            let (branch, point) = (site.branch, site.point);
            let (part, of_nodes) = (branch.part(gamma), relative(&self.nodes[site.cell], xu));
            let strain = &mut [0.0; MOST][..components(M)];
            let h = gradient(1, &of_nodes, &point.gradients);
            branch.at(point.frame, site.h).change(&h, strain);
            let (before, after) = (&mut [0.0; MOST], &mut [0.0; MOST]);
            let x = &mut x[site.first..][..components(M)];
            for (v, (x, strain)) in x.iter_mut().zip(strain).enumerate() {
                *x = part * *x + (1.0 - part) * *strain;
                before[v] = branch.time * rates[site.first + v];
                after[v] = before[v] + *strain - *x;
            }
            let [after, before] =
                [after, before].map(|apart| branch.twice_energy::<M>(&apart[..components(M)]));
            change += point.volume * (after - before) / branch.time;
        });
        change
    }
}

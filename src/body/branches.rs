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
//!
//! With a mean dilatation the stress at a point takes the mean over the cell of the trace of E - G, which no other equation does.

use super::elements::{ElementsOf, gradient};
use super::forces::{collect, relative};
use super::regions::Regions;
use super::tangents::add_blocks;
use crate::element::StrainPoint;
use crate::material::{Block, Blocks, Components, Relaxing, Strained, Stretch, components, trace};
use crate::sparse::{BlockMatrix, Rows};
use crate::tensor::Matrix;

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
    at: Strained<M, D>,
    cell: usize,
    /// Place of its internal strain among all.
    first: usize,
}

impl<'a, const N: usize, const M: usize, const D: usize> Site<'a, N, M, D> {
    /// Of a point of a `cell` whose nodes are displaced by `x`, relative to the first.
    fn new(
        branch: &'a Relaxing,
        point: &'a StrainPoint<f64, N, M, D>,
        x: &[[f64; D]; N],
        cell: usize,
        first: usize,
    ) -> Self {
        let at = branch.at(point.frame, gradient(1, x, &point.gradients));
        Self { branch, point, at, cell, first }
    }

    /// Its own of the internal strains, or of their rates or residuals.
    fn own(&self, internal: &[f64]) -> Components {
        let mut own = Components::default();
        own.iter_mut().zip(&internal[self.first..][..components(M)]).for_each(|(g, all)| *g = *all);
        own
    }

    fn own_mut<'i>(&self, internal: &'i mut [f64]) -> &'i mut [f64] {
        &mut internal[self.first..][..components(M)]
    }

    /// E - G
    fn apart(&self, internal: &[f64]) -> Components {
        let own = self.own(internal);
        let mut apart = self.at.strain();
        apart.iter_mut().zip(own).for_each(|(e, g)| *e -= g);
        apart
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Visits all branches at all points, with the strains of their springs that `strains` tells of each.
    fn visit<const K: usize>(
        &self,
        regions: &Regions,
        u: &[f64],
        strains: impl Fn(&Site<'_, N, M, D>) -> [Components; K],
        mut work: impl FnMut(&Site<'_, N, M, D>, [Stretch; K]),
    ) {
        let u = u.as_chunks::<D>().0;
        let mut of_cells = 0;
        for (cell, nodes) in self.nodes.iter().enumerate() {
            let branches = &regions.of(cell).branches;
            if branches.is_empty() {
                continue;
            }
            let x = relative(nodes, u);
            let own = |point: usize, branch: usize| {
                of_cells + (point * branches.len() + branch) * components(M)
            };
            // a mean is that of one branch
            let together = if self.mean_dilatation { 1 } else { branches.len() };
            for start in (0..branches.len()).step_by(together) {
                let mean = self.mean_dilatation.then(|| {
                    let (mut sums, mut volume) = ([0.0; K], 0.0);
                    for (q, point) in self.points(cell).enumerate() {
                        let (branch, first) = (&branches[start], own(q, start));
                        let strains = strains(&Site::new(branch, &point, &x, cell, first));
                        for k in 0..K {
                            sums[k] += point.volume * trace::<M>(&strains[k]);
                        }
                        volume += point.volume;
                    }
                    sums.map(|sum| sum / volume)
                });
                for (q, point) in self.points(cell).enumerate() {
                    for k in start..start + together {
                        let site = Site::new(&branches[k], &point, &x, cell, own(q, k));
                        let strains = strains(&site);
                        let traces =
                            mean.unwrap_or_else(|| strains.map(|strain| trace::<M>(&strain)));
                        let stretch = |k: usize| Stretch { strain: strains[k], trace: traces[k] };
                        work(&site, std::array::from_fn(stretch));
                    }
                }
            }
            of_cells += Q * branches.len() * components(M);
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

    /// Adds what the mean dilatation of each cell adds to the tangents: lambda/V G_a G_b^T of what a branch feels of a step, with
    /// G_a = sum w F g_a.
    fn add_mean_tangents(
        &self,
        regions: &Regions,
        gamma: f64,
        u: &[f64],
        stiffness: &mut Rows<'_, D>,
    ) {
        let (mut swelling, mut volume, mut points) = ([[0.0; D]; N], 0.0, 0);
        self.visit(
            regions,
            u,
            |_| [],
            |Site { branch, point, at, cell, .. }, []| {
                let of_point = at.swelling(&point.gradients, point.volume);
                for (sum, part) in
                    swelling.as_flattened_mut().iter_mut().zip(of_point.as_flattened())
                {
                    *sum += part;
                }
                (volume, points) = (volume + point.volume, points + 1);
                if points == Q {
                    let share = branch.part(gamma) * branch.lambda() / volume;
                    add_blocks(&self.entries[*cell], stiffness, &OfMean { swelling, share });
                    (swelling, volume, points) = ([[0.0; D]; N], 0.0, 0);
                }
            },
        );
    }
}

/// `share` G_a G_b^T
struct OfMean<const N: usize, const D: usize> {
    swelling: [[f64; D]; N],
    share: f64,
}

impl<const N: usize, const D: usize> Blocks<f64, D> for OfMean<N, D> {
    fn block(&self, a: usize, b: usize) -> Block<f64, D> {
        let Self { swelling, share } = self;
        std::array::from_fn(|i| swelling[b].map(|along| share * swelling[a][i] * along))
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
        let strain = |site: &Site<'_, N, M, D>| [site.at.strain()];
        self.visit(regions, u, strain, |site, [Stretch { strain, .. }]| {
            site.own_mut(internal).copy_from_slice(&strain[..components(M)]);
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
        let apart = |site: &Site<'_, N, M, D>| [site.apart(internal)];
        self.visit(regions, u, apart, |site, [apart]| {
            let (branch, volume) = (site.branch, site.point.volume);
            self.pull(site, &branch.stress(&site.at, &apart, volume), -1.0, forces);
            power += volume * branch.twice_energy::<M>(&apart) / branch.time;
            let rates = site.own_mut(rates).iter_mut();
            rates.zip(apart.strain).for_each(|(rate, e)| *rate = e / branch.time);
        });
        power
    }

    fn branch_energy(&self, regions: &Regions, u: &[f64], internal: &[f64]) -> f64 {
        let mut twice = 0.0;
        let apart = |site: &Site<'_, N, M, D>| [site.apart(internal)];
        self.visit(regions, u, apart, |site, [apart]| {
            twice += site.point.volume * site.branch.twice_energy::<M>(&apart);
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
        let apart = |site: &Site<'_, N, M, D>| match internal {
            [] => [Components::default()],
            internal => [site.apart(internal)],
        };
        self.visit(regions, u, apart, |site, [apart]| {
            let Site { branch, point, at, cell, .. } = site;
            let part = branch.part(gamma);
            let lambda = if self.mean_dilatation { 0.0 } else { branch.lambda() };
            let tangent =
                branch.tangent(at, &apart, (part, lambda), &point.gradients, point.volume);
            add_blocks(&self.entries[*cell], &mut stiffness, &tangent);
        });
        if self.mean_dilatation {
            self.add_mean_tangents(regions, gamma, u, &mut stiffness);
        }
    }

    fn add_branch_residuals(
        &self,
        regions: &Regions,
        gamma: f64,
        [u, residuals]: [&[f64]; 2],
        right: &mut [f64],
    ) {
        let residual = |site: &Site<'_, N, M, D>| [site.own(residuals)];
        self.visit(regions, u, residual, |site, [residual]| {
            let stress = site.branch.stress(&site.at, &residual, site.point.volume);
            self.pull(site, &stress, gamma * site.branch.part(gamma), right);
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
        let change = |site: &Site<'_, N, M, D>| {
            let of_nodes = relative(&self.nodes[site.cell], xu);
            site.at.change(&gradient(1, &of_nodes, &site.point.gradients))
        };
        self.visit(
            regions,
            u,
            |site| [change(site)],
            |site, [Stretch { strain, .. }]| {
                let part = site.branch.part(gamma);
                for (x, strain) in site.own_mut(x).iter_mut().zip(strain) {
                    *x = part * *x + (1.0 - part) * strain;
                }
            },
        );
        let mut power = 0.0;
        let apart = |site: &Site<'_, N, M, D>| {
            let before = site.own(rates).map(|rate| site.branch.time * rate);
            let (strain, x) = (change(site), site.own(x));
            [before, std::array::from_fn(|v| before[v] + strain[v] - x[v])]
        };
        self.visit(regions, u, apart, |site, apart| {
            let [before, after] = apart.map(|apart| site.branch.twice_energy::<M>(&apart));
            power += site.point.volume * (after - before) / site.branch.time;
        });
        power
    }
}

//! The Maxwell branches of all elements: their forces, and their internal strains as unknowns.
//!
//! A branch has a strain G at each strain point of a cell. Their components are stored one after the other:
//! by cell, then by point, then by branch. Only the displacements couple the strains of two points, so that
//! the Newton system is solved for them point by point: with P = 1 / (1 + gamma/tau) (another P, in a flow
//! above the yield stress) and the change B xu of the strain,
//!
//! ```text
//! xG = P rG + (I - P) B xu
//! (... + gamma^2 sum B^T C P B) xv = ... + gamma sum B^T C P rG
//! ```
//!
//! With a projected dilatation the stress at a point takes the projected trace of E - G; no other equation does. Beside a law of
//! rubber nothing is projected, as the bulk modulus of a branch is bounded there, and the system of a point is solved by numbers.

use super::branch_state::{BranchCells, runs};
use super::elements::{ElementsOf, gradient};
use super::forces::{collect, relative};
use super::projection::{COEFFICIENTS, Projected};
use super::regions::Regions;
use super::tangents::add_blocks;
use crate::base::sparse::{BlockMatrix, Rows};
use crate::base::tensor::Matrix;
use crate::elements::basis::StrainPoint;
use crate::elements::material::{
    Block, Blocks, Components, Maxwell, Relaxing, Sprung, Step, Strained, Stretch, trace,
};

/// Elements with branches.
pub(super) trait Branched {
    fn internal_strains(&self, regions: &Regions) -> usize;

    /// Runs of cells with branches of the same kind.
    fn branch_cells(&self, regions: &Regions) -> Vec<BranchCells>;

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
        residuals: &[f64],
        right: &mut [f64],
    );

    fn solve_branches(
        &self,
        regions: &Regions,
        gamma: f64,
        at: [&[f64]; 2],
        rates: &[f64],
        xu: &[f64],
        x: &mut [f64],
    ) -> f64;
}

/// A branch at a point of a cell.
pub(super) struct Site<'a, const N: usize, const M: usize, const D: usize> {
    pub(super) branch: &'a Relaxing,
    pub(super) point: &'a StrainPoint<f64, N, M, D>,
    pub(super) at: Strained<M, D>,
    pub(super) cell: usize,
    /// The number of the point in its cell.
    pub(super) number: usize,
    /// Index of the first component of its internal strain.
    pub(super) first: usize,
}

impl<'a, const N: usize, const M: usize, const D: usize> Site<'a, N, M, D> {
    /// Of a point of that number in a `cell` whose nodes are displaced by `x`, relative to the first.
    fn new(
        branch: &'a Relaxing,
        point: &'a StrainPoint<f64, N, M, D>,
        x: &[[f64; D]; N],
        [cell, number, first]: [usize; 3],
    ) -> Self {
        let at = branch.at(point.frame, gradient(1, x, &point.gradients));
        Self { branch, point, at, cell, number, first }
    }

    /// Its components of the internal strains, or of their rates or residuals.
    fn own(&self, internal: &[f64]) -> Components {
        let mut own = Components::default();
        let all = &internal[self.first..][..self.branch.components()];
        own[..all.len()].copy_from_slice(all);
        own
    }

    fn own_mut<'i>(&self, internal: &'i mut [f64]) -> &'i mut [f64] {
        &mut internal[self.first..][..self.branch.components()]
    }

    /// Derivative of E - G by the strain in a step of the parameter `gamma`: see `Step`.
    fn step(&self, gamma: f64, internal: &[f64]) -> Step {
        self.branch.step::<M>(gamma, &self.apart(internal))
    }

    /// Its spring and damper at the point, beside a law of rubber; without `internal` strains those without stress.
    pub(super) fn rubber(&self, internal: &[f64]) -> Option<(&'a Maxwell, Sprung)> {
        let spring = self.branch.rubber.as_ref()?;
        let strain = self.at.strain();
        let own = if internal.is_empty() { strain } else { self.own(internal) };
        Some((spring, spring.at::<M>(&strain, &own)))
    }

    /// E - G
    pub(super) fn apart(&self, internal: &[f64]) -> Components {
        let own = self.own(internal);
        let mut apart = self.at.strain();
        apart.iter_mut().zip(own).for_each(|(e, g)| *e -= g);
        apart
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Visits all branches at all points, with the strains that `strains` returns for each. The loop is compiled once for
    /// a kind of cell, not for each use of it.
    pub(super) fn visit<const K: usize>(
        &self,
        regions: &Regions,
        u: &[f64],
        strains: &dyn Fn(&Site<'_, N, M, D>) -> [Components; K],
        work: &mut dyn FnMut(&Site<'_, N, M, D>, [Stretch; K]),
    ) {
        let u = u.as_chunks::<D>().0;
        let mut of_cells = 0;
        for (cell, nodes) in self.nodes.iter().enumerate() {
            let branches = &regions.of(cell).branches;
            if branches.is_empty() {
                continue;
            }
            let x = relative(nodes, u);
            let of_point =
                |count: usize| branches[..count].iter().map(Relaxing::components).sum::<usize>();
            let all = of_point(branches.len());
            let own = |point: usize, branch: usize| of_cells + point * all + of_point(branch);
            // each branch has its own projection
            let is_projected = self.is_projected() && branches[0].rubber.is_none();
            let together = if is_projected { 1 } else { branches.len() };
            for start in (0..branches.len()).step_by(together) {
                let projected = is_projected.then(|| {
                    let (mut sums, mut volume) = ([Projected::new(0.0); K], 0.0);
                    for (q, point) in self.points(cell).enumerate() {
                        let (branch, first) = (&branches[start], own(q, start));
                        let strains = strains(&Site::new(branch, &point, &x, [cell, q, first]));
                        let modes = self.modes_of(cell, q);
                        for k in 0..K {
                            sums[k].add(point.volume * trace::<M>(&strains[k]), modes.as_ref());
                        }
                        volume += point.volume;
                    }
                    sums.map(|sum| sum.over(volume))
                });
                for (q, point) in self.points(cell).enumerate() {
                    let mut first = own(q, start);
                    let modes = self.modes_of(cell, q);
                    for branch in &branches[start..start + together] {
                        let site = Site::new(branch, &point, &x, [cell, q, first]);
                        let strains = strains(&site);
                        let traces = match &projected {
                            Some(projected) => {
                                projected.map(|function| function.at(modes.as_ref()))
                            }
                            None => strains.map(|strain| trace::<M>(&strain)),
                        };
                        let stretch = |k: usize| Stretch { strain: strains[k], trace: traces[k] };
                        work(&site, std::array::from_fn(stretch));
                        first += branch.components();
                    }
                }
            }
            of_cells += Q * all;
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

    /// Adds the tangents of the projected dilatation of each cell: lambda/V sum G_a G_b^T over its functions p, with
    /// G_a = sum w p F g_a, times the `part` of a step that passes to the spring of a branch.
    fn add_volume_tangents(
        &self,
        regions: &Regions,
        gamma: f64,
        u: &[f64],
        stiffness: &mut Rows<'_, D>,
    ) {
        let (mut swelling, mut volume, mut points) = ([[[0.0; D]; N]; COEFFICIENTS], 0.0, 0);
        self.visit(regions, u, &|_| [], &mut |Site { branch, point, at, cell, .. }, []| {
            if branch.rubber.is_some() {
                return;
            }
            let of_point = at.swelling(&point.gradients, point.volume);
            let modes = self.modes_of(*cell, points);
            let values = std::iter::once(1.0).chain(modes.into_iter().flatten());
            for (value, sums) in values.zip(&mut swelling) {
                let sums = sums.as_flattened_mut().iter_mut();
                sums.zip(of_point.as_flattened()).for_each(|(sum, part)| *sum += value * part);
            }
            (volume, points) = (volume + point.volume, points + 1);
            if points == Q {
                // flow above a yield stress keeps the volume: the part is that without strain
                let part = branch.step::<M>(gamma, &Components::default()).part;
                let share = part * branch.lambda() / volume;
                for swelling in swelling.into_iter().take(self.coefficients()) {
                    add_blocks(&self.entries[*cell], stiffness, &OfVolume { swelling, share });
                }
                (swelling, volume, points) = ([[[0.0; D]; N]; COEFFICIENTS], 0.0, 0);
            }
        });
    }
}

/// `share` G_a G_b^T
struct OfVolume<const N: usize, const D: usize> {
    swelling: [[f64; D]; N],
    share: f64,
}

impl<const N: usize, const D: usize> Blocks<f64, D> for OfVolume<N, D> {
    fn block(&self, a: usize, b: usize) -> Block<f64, D> {
        let Self { swelling, share } = self;
        std::array::from_fn(|i| swelling[b].map(|along| share * swelling[a][i] * along))
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Branched
    for ElementsOf<N, M, D, Q>
{
    fn internal_strains(&self, regions: &Regions) -> usize {
        let of_point =
            |cell| -> usize { regions.of(cell).branches.iter().map(Relaxing::components).sum() };
        (0..self.nodes.len()).map(|cell| Q * of_point(cell)).sum()
    }

    fn branch_cells(&self, regions: &Regions) -> Vec<BranchCells> {
        let of_cell = |cell| {
            let branches = &regions.of(cell).branches;
            let variables = branches.iter().map(Relaxing::variable).collect();
            (variables, Q * branches.iter().map(Relaxing::components).sum::<usize>())
        };
        runs((0..self.nodes.len()).map(of_cell))
    }

    fn relax(&self, regions: &Regions, u: &[f64], internal: &mut [f64]) {
        let strain = |site: &Site<'_, N, M, D>| [site.at.strain()];
        self.visit(regions, u, &strain, &mut |site, [Stretch { strain, .. }]| {
            site.own_mut(internal).iter_mut().zip(strain).for_each(|(g, e)| *g = e);
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
        self.visit(regions, u, &apart, &mut |site, [apart]| {
            let (branch, volume) = (site.branch, site.point.volume);
            if let Some((spring, at)) = site.rubber(internal) {
                let stress = site.at.first(&spring.stress::<M>(&at), volume);
                self.pull(site, &stress, -1.0, forces);
                power += volume * spring.heat(&at);
                let own = spring.rate::<M>(&at);
                site.own_mut(rates).iter_mut().zip(own).for_each(|(rate, own)| *rate = own);
                return;
            }
            self.pull(site, &branch.stress(&site.at, &apart, volume), -1.0, forces);
            power += volume * branch.loss::<M>(&apart) / branch.time;
            let own = branch.rate::<M>(&apart.strain);
            site.own_mut(rates).iter_mut().zip(own).for_each(|(rate, own)| *rate = own);
        });
        power
    }

    fn branch_energy(&self, regions: &Regions, u: &[f64], internal: &[f64]) -> f64 {
        let mut twice = 0.0;
        let apart = |site: &Site<'_, N, M, D>| [site.apart(internal)];
        self.visit(regions, u, &apart, &mut |site, [apart]| {
            let twice_own = match site.rubber(internal) {
                Some((spring, at)) => 2.0 * spring.energy(&at),
                None => site.branch.twice_energy::<M>(&apart),
            };
            twice += site.point.volume * twice_own;
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
        self.visit(regions, u, &apart, &mut |site, [apart]| {
            let Site { branch, point, at, cell, .. } = site;
            if let Some((spring, sprung)) = site.rubber(internal) {
                let elasticity = spring.step::<M>(gamma, &sprung).elasticity::<M>();
                let stress = spring.stress::<M>(&sprung);
                let tangent = at.tangent(&stress, elasticity, &point.gradients, point.volume);
                add_blocks(&self.entries[*cell], &mut stiffness, &tangent);
                return;
            }
            let step = branch.step::<M>(gamma, &apart.strain);
            let lambda = if self.is_projected() { 0.0 } else { branch.lambda() };
            let tangent =
                branch.tangent(at, &apart, (&step, lambda), &point.gradients, point.volume);
            add_blocks(&self.entries[*cell], &mut stiffness, &tangent);
        });
        if self.is_projected() {
            self.add_volume_tangents(regions, gamma, u, &mut stiffness);
        }
    }

    fn add_branch_residuals(
        &self,
        regions: &Regions,
        gamma: f64,
        [u, internal]: [&[f64]; 2],
        residuals: &[f64],
        right: &mut [f64],
    ) {
        // the part that passes differs from point to point, so that the projection includes it
        let passed = |site: &Site<'_, N, M, D>| {
            let step = site.step(gamma, internal);
            let passed = step.passed::<M>(&site.own(residuals));
            [passed, passed.map(|passed| step.part * passed)]
        };
        self.visit(regions, u, &passed, &mut |site, [mut passed, whole]| {
            if let Some((spring, at)) = site.rubber(internal) {
                let change = spring.step::<M>(gamma, &at).stress(&site.own(residuals));
                let stress = site.at.first(&change, site.point.volume);
                self.pull(site, &stress, -gamma, right);
                return;
            }
            let part = site.step(gamma, internal).part;
            if self.is_projected() {
                passed.trace = whole.trace / part;
            }
            let stress = site.branch.stress(&site.at, &passed, site.point.volume);
            self.pull(site, &stress, gamma * part, right);
        });
    }

    fn solve_branches(
        &self,
        regions: &Regions,
        gamma: f64,
        [u, internal]: [&[f64]; 2],
        rates: &[f64],
        xu: &[f64],
        x: &mut [f64],
    ) -> f64 {
        let xu = xu.as_chunks::<D>().0;
        let change = |site: &Site<'_, N, M, D>| {
            let of_nodes = relative(&self.nodes[site.cell], xu);
            site.at.change(&gradient(1, &of_nodes, &site.point.gradients))
        };
        let mut power = 0.0;
        self.visit(regions, u, &|site| [change(site)], &mut |site, [Stretch { strain, .. }]| {
            if let Some((spring, at)) = site.rubber(internal) {
                let step = spring.step::<M>(gamma, &at);
                let own = step.own(&strain, &site.own(x));
                site.own_mut(x).iter_mut().zip(own).for_each(|(x, own)| *x = own);
                power += site.point.volume * step.heat(&strain, &own);
                return;
            }
            let step = site.step(gamma, internal);
            let [passed, left] = [site.own(x), strain].map(|strain| step.passed::<M>(&strain));
            for (v, x) in site.own_mut(x).iter_mut().enumerate() {
                let flows = step.part * (left[v] - strain[v]);
                *x = step.part * passed[v] + (1.0 - step.part) * strain[v] - flows;
            }
        });
        let apart = |site: &Site<'_, N, M, D>| {
            // with a yield stress the rates do not determine E - G: below it they are 0
            let before = match site.branch.yields() {
                true => site.apart(internal),
                false => site.own(rates).map(|rate| site.branch.time * rate),
            };
            let (strain, x) = (change(site), site.own(x));
            [before, std::array::from_fn(|v| before[v] + strain[v] - x[v])]
        };
        self.visit(regions, u, &apart, &mut |site, [before, after]| {
            if site.branch.rubber.is_some() {
                return;
            }
            let change = site.branch.loss_change::<M>(&before, &after);
            power += site.point.volume * change / site.branch.time;
        });
        power
    }
}

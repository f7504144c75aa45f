//! Maxwell branches of rods: springs with a share of the stiffness along each strain of an element, in series with dampers.
//!
//! A branch has internal strains Gamma, six of an element, that follow its strains eps by Gamma' = (eps - Gamma)/tau; its energy is
//! l g K (eps - Gamma)^2/2. They are stored by element, then by branch. In a step of the parameter gamma, with P = 1/(1 + gamma/tau),
//!
//! ```text
//! xG = P rG + (1 - P) B xu,   (... + gamma^2 sum B^T g K P B) xv = ... + gamma sum B^T g K P rG
//! ```

use super::elements::{RodBranch, RodElement, RodElements, add_row, own};
use super::strain::{Deformed, Strains};
use crate::base::sparse::BlockMatrix;

/// Internal strains of a branch in an element.
const COMPONENTS: usize = 6;

impl RodBranch {
    /// P in a step of the parameter `gamma` (s).
    fn passed(self, gamma: f64) -> f64 {
        1.0 / (1.0 + gamma / self.time)
    }
}

type Six = [f64; COMPONENTS];

fn six(strains: &Strains<f64>) -> Six {
    let ([a, b, c], [d, e, f]) = (strains.gamma, strains.kappa);
    [a, b, c, d, e, f]
}

fn strains([a, b, c, d, e, f]: Six) -> Strains<f64> {
    Strains { gamma: [a, b, c], kappa: [d, e, f] }
}

impl RodElements {
    /// Whether it has branches.
    pub(crate) fn relaxes(&self) -> bool {
        !self.branches.is_empty()
    }

    /// Internal strains of an element.
    pub(crate) fn internal_of_element(&self) -> usize {
        COMPONENTS * self.branches.len()
    }

    /// The number of its branches, and of its elements.
    pub(crate) fn branch_counts(&self) -> [usize; 2] {
        [self.branches.len(), self.elements.len()]
    }

    /// Calls `see` with each element at displacements `u` (m), its shape, its strains, and where its internal ones begin.
    fn each_relaxing(
        &self,
        u: &[f64],
        mut see: impl FnMut(&RodElement, &Deformed<f64>, &Six, usize),
    ) {
        for (number, element) in self.elements.iter().enumerate() {
            let deformed = Deformed::new(element.length, self.state(element, u, true));
            let strain = six(&deformed.strains());
            see(element, &deformed, &strain, number * self.internal_of_element());
        }
    }

    /// Each branch with its components of internal strains that begin at `first`.
    fn each_branch<'a>(
        &'a self,
        internal: &'a [f64],
        first: usize,
    ) -> impl Iterator<Item = (RodBranch, &'a [f64])> {
        let own = internal[first..].chunks_exact(COMPONENTS);
        self.branches.iter().copied().zip(own)
    }

    /// Adds `factor` times the forces on the nodes of stresses along the strains of an element.
    fn pull(
        &self,
        element: &RodElement,
        deformed: &Deformed<f64>,
        stress: Six,
        factor: f64,
        vectors: &mut [f64],
    ) {
        let d = self.dimension;
        for (end, on) in element.ends.iter().zip(deformed.forces(strains(stress))) {
            end.scatter(d, &on, |v, i, force| vectors[end.nodes[v] * d + i] += factor * force);
        }
    }

    /// Writes the internal strains with which the branches have no stress.
    pub(crate) fn relax(&self, u: &[f64], internal: &mut [f64]) {
        self.each_relaxing(u, |_, _, strain, first| {
            let all = &mut internal[first..][..self.internal_of_element()];
            all.chunks_exact_mut(COMPONENTS).for_each(|own| own.copy_from_slice(strain));
        });
    }

    /// Adds the forces (N) and writes the rates (1/s) of the internal strains; returns the power (W) that is dissipated.
    pub(crate) fn add_branch_forces(
        &self,
        u: &[f64],
        internal: &[f64],
        forces: &mut [f64],
        rates: &mut [f64],
    ) -> f64 {
        let mut power = 0.0;
        self.each_relaxing(u, |element, deformed, strain, first| {
            let mut stress = [0.0; COMPONENTS];
            let branches = self.each_branch(internal, first);
            for ((branch, own), rates) in branches.zip(rates[first..].chunks_exact_mut(COMPONENTS))
            {
                for k in 0..COMPONENTS {
                    let apart = strain[k] - own[k];
                    let pull = branch.share * element.stiffness[k] * apart;
                    stress[k] += pull;
                    rates[k] = apart / branch.time;
                    power += element.length * pull * rates[k];
                }
            }
            self.pull(element, deformed, stress, -1.0, forces);
        });
        power
    }

    /// Strain energy of the branches (J).
    pub(crate) fn branch_energy(&self, u: &[f64], internal: &[f64]) -> f64 {
        let mut twice = 0.0;
        self.each_relaxing(u, |element, _, strain, first| {
            for (branch, own) in self.each_branch(internal, first) {
                let stiff = element.stiffness.iter().zip(strain).zip(own);
                let square: f64 = stiff.map(|((k, e), g)| k * (e - g).powi(2)).sum();
                twice += element.length * branch.share * square;
            }
        });
        0.5 * twice
    }

    /// Adds their stiffness in a step of the parameter `gamma` (s); without `internal` strains they are those without stress.
    pub(crate) fn add_branch_tangents(
        &self,
        gamma: f64,
        u: &[f64],
        internal: &[f64],
        stiffness: &mut BlockMatrix,
    ) {
        let d = self.dimension;
        let share: f64 =
            self.branches.iter().map(|branch| branch.share * branch.passed(gamma)).sum();
        self.each_relaxing(u, |element, _, strain, first| {
            let mut stress = [0.0; COMPONENTS];
            if !internal.is_empty() {
                for (branch, own) in self.each_branch(internal, first) {
                    for k in 0..COMPONENTS {
                        stress[k] += branch.share * element.stiffness[k] * (strain[k] - own[k]);
                    }
                }
            }
            let deformed = Deformed::new(element.length, self.dual_state(element, u));
            let mut along = deformed.strains();
            for k in 0..3 {
                let [bent, stretched] = [3 + k, k];
                along.gamma[k] = (along.gamma[k] - strain[stretched])
                    * (share * element.stiffness[stretched])
                    + stress[stretched];
                along.kappa[k] = (along.kappa[k] - strain[bent])
                    * (share * element.stiffness[bent])
                    + stress[bent];
            }
            for (end, on) in element.ends.iter().zip(deformed.forces(along)) {
                end.scatter(d, &on, |v, i, force| {
                    let row = end.nodes[v];
                    add_row(stiffness, &element.ends, d, row, i, |end, w, j| {
                        force.eps.0.map_or(0.0, |slopes| slopes[own(d, [end, w, j])])
                    });
                });
            }
        });
    }

    /// Adds gamma sum B^T g K P rG of the `residuals` rG.
    pub(crate) fn add_branch_residuals(
        &self,
        gamma: f64,
        u: &[f64],
        residuals: &[f64],
        right: &mut [f64],
    ) {
        self.each_relaxing(u, |element, deformed, _, first| {
            let mut stress = [0.0; COMPONENTS];
            for (branch, own) in self.each_branch(residuals, first) {
                let part = branch.share * branch.passed(gamma);
                let stiff = stress.iter_mut().zip(&element.stiffness).zip(own);
                stiff.for_each(|((stress, k), r)| *stress += part * k * r);
            }
            self.pull(element, deformed, stress, gamma, right);
        });
    }

    /// Turns the residuals `x` into xG, with the changes `xu` of the displacements. Returns the change of the dissipated power (W) from where the
    /// internal strains had the `rates`.
    pub(crate) fn solve_branches(
        &self,
        gamma: f64,
        u: &[f64],
        rates: &[f64],
        xu: &[f64],
        x: &mut [f64],
    ) -> f64 {
        let mut power = 0.0;
        self.each_relaxing(u, |element, deformed, _, first| {
            let change = six(&deformed.rates(self.state(element, xu, false)));
            let branches = self.each_branch(rates, first);
            for ((branch, rates), x) in branches.zip(x[first..].chunks_exact_mut(COMPONENTS)) {
                let part = branch.passed(gamma);
                for k in 0..COMPONENTS {
                    x[k] = part * x[k] + (1.0 - part) * change[k];
                    let before = branch.time * rates[k];
                    let after = before + change[k] - x[k];
                    let stiff = element.length * branch.share * element.stiffness[k];
                    power += stiff * (after * after - before * before) / branch.time;
                }
            }
        });
        power
    }
}

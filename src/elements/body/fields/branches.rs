//! Stresses of Maxwell branches at the nodes of cells: those of their springs, true ones as of the elasticity.

use nalgebra::{Matrix3, SMatrix};

use super::{in_space, normal_part, swelling};
use crate::elements::body::branches::Site;
use crate::elements::body::elements::ElementsOf;
use crate::elements::body::regions::Regions;
use crate::elements::material::with_law;

/// Elements whose branches have stresses.
pub(in crate::elements::body) trait BranchFields {
    /// Calls `see` with the number of a cell, that of one of its nodes among them, and a stress (Pa), for the cells that are `asked`
    /// for, at the displacements and internal strains `at`: the sum at a node is its stress, extrapolated from the strain points.
    fn each_branch_stress(
        &self,
        regions: &Regions,
        at: [&[f64]; 2],
        asked: &dyn Fn(usize) -> bool,
        see: &mut dyn FnMut(usize, usize, &Matrix3<f64>),
    );
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> BranchFields
    for ElementsOf<N, M, D, Q>
{
    fn each_branch_stress(
        &self,
        regions: &Regions,
        [u, internal]: [&[f64]; 2],
        asked: &dyn Fn(usize) -> bool,
        see: &mut dyn FnMut(usize, usize, &Matrix3<f64>),
    ) {
        let apart = |site: &Site<'_, N, M, D>| [site.apart(internal)];
        self.visit(regions, u, &apart, &mut |site, [apart]| {
            let cell = site.cell;
            let deformed = self.deformed(cell, u).nth(site.number).filter(|_| asked(cell));
            let Some((_, deformed)) = deformed else { return };
            let (first, across) = match site.rubber(internal) {
                Some((spring, at)) => {
                    let first = site.at.first(&spring.stress::<M>(&at), 1.0);
                    (first, spring.stress_across::<M>(&at))
                }
                None => {
                    let first = site.branch.stress(&site.at, &apart, 1.0);
                    (first, site.branch.stress_across::<M>(&apart))
                }
            };
            let [first, shape] =
                [first, site.at.shape()].map(|columns| in_space(&SMatrix::from(columns)));
            let volume = with_law!(regions.of(cell).elastic, law => swelling(&law, &deformed));
            let stress = (first * shape.transpose() + normal_part(&shape) * across) / volume;
            for (a, factors) in self.extrapolation.iter().enumerate() {
                see(cell, a, &(stress * factors[site.number]));
            }
        });
    }
}

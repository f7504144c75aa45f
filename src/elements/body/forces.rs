//! The forces of all elements: the loop in which explicit methods spend their time.
//!
//! It is compiled for each instruction set (`pulp`), and computes as many cells at once as a register holds
//! numbers. The forces of these cells are added to each node in the order of the cells: cell by cell, or for
//! cells in a row (`contiguous`) node by node. So results are the same to the last bit on all machines. Functions
//! called in the loop have to be inlined: a separate function would be compiled for the oldest instruction set.
//!
//! The shape functions of a cell add up to 1 and their gradients to 0. So displacements are relative to
//! the first node, whose force balances those on the others: this is less work, and forces stay as precise
//! when the body has moved far.
//!
//! `map` of arrays and `as_flattened` of `core` are inlined only where a build is optimized across its units
//! a second time, as a release is and tests are not: loops avoid them, and closures.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::contiguous::{self, Vectors};
use super::elements::{ElementsOf, gradients};
use super::projection::Projected;
use super::regions::{Laws, Regions};
use crate::base::lane::{Lane, SIDE_BY_SIDE};
use crate::base::simd::at_once;
use crate::base::tensor::{Matrix, Real};
use crate::elements::force::NodalForces;
use crate::elements::material::{
    ByPoint, Deformation, Elastic, Hooke, Hookean, Linear, ObjectiveViscosity,
};
use crate::integrators::ode::Failure;

mod revolved;
mod stress;

use stress::ViscousStress;
pub(super) use stress::{ElasticStress, StressTerm};

/// Which forces are computed element by element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Terms {
    pub(super) elastic: bool,
    pub(super) viscous: bool,
}

impl Terms {
    pub(super) fn are_any(self) -> bool {
        self.elastic || self.viscous
    }
}

/// Elements as forces.
pub(super) trait Forces {
    /// Adds the elastic forces to the conservative ones and those of objective viscosity to the
    /// dissipative ones, as far as `terms` has them.
    fn add_forces(
        &self,
        regions: &Regions,
        terms: Terms,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure>;

    /// Adds -K u to the conservative forces and -B v to the dissipative ones, as far as `terms` has them.
    fn add_linear_forces(
        &self,
        regions: &Regions,
        terms: Terms,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure>;
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Forces
    for ElementsOf<N, M, D, Q>
{
    fn add_forces(
        &self,
        regions: &Regions,
        terms: Terms,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        if let Some(revolved) = &self.revolved {
            return revolved.add_forces(regions, terms, u, v, forces);
        }
        if terms.elastic {
            self.shares.each_force(D, &mut forces.conservative, &|run, first, forces| {
                regions.runs(run).try_for_each(|(cells, laws)| {
                    let is_projected = self.is_projected();
                    match &laws.elastic {
                        Elastic::Linear(law) => {
                            self.add(cells, [u], first, forces, ElasticStress { law, is_projected })
                        }
                        Elastic::StVenantKirchhoff(law) => {
                            self.add(cells, [u], first, forces, ElasticStress { law, is_projected })
                        }
                        // a call would cost a seventh of so short a formula
                        Elastic::ByPoint(ByPoint::Rivlin(law)) => {
                            self.add(cells, [u], first, forces, ElasticStress { law, is_projected })
                        }
                        Elastic::ByPoint(law) => {
                            self.add(cells, [u], first, forces, ElasticStress { law, is_projected })
                        }
                    }
                })
            })?;
        }
        if terms.viscous {
            self.shares.each_force(D, &mut forces.dissipative, &|run, first, forces| {
                regions.runs(run).try_for_each(|(cells, laws)| {
                    let (fields, is_projected) = ([u, v], self.is_projected());
                    match &laws.objective {
                        ObjectiveViscosity::Hookean(law) => {
                            let pull = ViscousStress { law, is_projected };
                            self.add(cells, fields, first, forces, pull)
                        }
                        ObjectiveViscosity::Newtonian(law) => {
                            let pull = ViscousStress { law, is_projected };
                            self.add(cells, fields, first, forces, pull)
                        }
                    }
                })
            })?;
        }
        Ok(())
    }

    fn add_linear_forces(
        &self,
        regions: &Regions,
        terms: Terms,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        if let Some(revolved) = &self.revolved {
            return revolved.add_linear_forces(regions, terms, u, v, forces);
        }
        let add = |x: &[f64], hooke: fn(&Laws) -> Hooke, forces: &mut [f64]| {
            self.shares.each_force(D, forces, &|run, first, forces| {
                regions.runs(run).try_for_each(|(cells, laws)| {
                    let law: Linear = Hookean(hooke(laws));
                    self.add(
                        cells,
                        [x],
                        first,
                        forces,
                        ElasticStress { law: &law, is_projected: false },
                    )
                })
            })
        };
        if terms.elastic {
            add(u, |laws| laws.hooke, &mut forces.conservative)?;
        }
        if terms.viscous {
            add(v, |laws| laws.viscous, &mut forces.dissipative)?;
        }
        Ok(())
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Adds the forces of `cells` to those on the nodes from `first` on, by the `fields` that `pull`
    /// requires: in the order of cells, however many the machine computes at once.
    pub(super) fn add<const K: usize>(
        &self,
        cells: Range<usize>,
        fields: [&[f64]; K],
        first: usize,
        forces: &mut [f64],
        pull: impl StressTerm<K>,
    ) -> Result<(), Failure> {
        at_once(Pass { elements: self, cells, fields, first, forces, pull })
    }

    /// Fails with a message about the first of `cells` that is outside the domain of its law.
    #[cold]
    fn outside<const K: usize>(
        &self,
        cells: Range<usize>,
        fields: [&[f64]; K],
        pull: &impl StressTerm<K>,
    ) -> Result<(), Failure> {
        for cell in cells {
            let nodes = &self.nodes[cell];
            let mut x = [[[0.0; D]; N]; K];
            (0..K).for_each(|k| x[k] = relative(nodes, fields[k].as_chunks::<D>().0));
            for point in self.points(cell) {
                let gradients = gradients(1, &x, &point.gradients);
                let at = Deformation::new(point.frame, gradients[0]);
                let (_, domain) = pull.stress(&at, &gradients, None, point.volume);
                // false for NaN
                let is_inside = domain > 0.0;
                if !is_inside {
                    let (nodes, problem) = (nodes.map(|node| node + 1), pull.outside(domain));
                    let number = self.number(cell) + 1;
                    let problem = format!("cell {number} (nodes {nodes:?}) {problem}");
                    return Err(Failure::Recoverable(problem));
                }
            }
        }
        Ok(())
    }
}

/// The forces of a run of cells of one law, compiled for each instruction set.
struct Pass<'a, P, const N: usize, const M: usize, const D: usize, const Q: usize, const K: usize> {
    elements: &'a ElementsOf<N, M, D, Q>,
    cells: Range<usize>,
    fields: [&'a [f64]; K],
    first: usize,
    forces: &'a mut [f64],
    pull: P,
}

impl<
    P: StressTerm<K>,
    const N: usize,
    const M: usize,
    const D: usize,
    const Q: usize,
    const K: usize,
> WithSimd for Pass<'_, P, N, M, D, Q, K>
{
    type Output = Result<(), Failure>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Result<(), Failure> {
        let Self { elements, cells, fields, first, forces, pull } = self;
        let (nodes, abreast) = (&elements.nodes[..], elements.abreast());
        let count = forces.len() / D;
        let zero = Lane::splat(simd, 0.0);
        for register in cells.start / S::F64_LANES..cells.end.div_ceil(S::F64_LANES) {
            let start = register * S::F64_LANES;
            let (block, part) = (start / SIDE_BY_SIDE, start % SIDE_BY_SIDE / S::F64_LANES);
            let mut x = [[[zero; D]; N]; K];
            for k in 0..K {
                x[k] = elements.gather(simd, start, fields[k]);
            }
            let mut projected = None;
            if const { ElementsOf::<N, M, D, Q>::CAN_LOCK } && pull.is_projected() {
                let (mut sum, mut volume) = (Projected::new(zero), zero);
                for q in 0..Q {
                    let point = abreast[block][q].lane(simd, part);
                    let gradients = gradients(1, &x, &point.gradients);
                    let at = Deformation::new(point.frame, gradients[0]);
                    let modes = elements.modes_of_lane(simd, block, part, q);
                    sum.add(pull.dilatation(&at, &gradients) * point.volume, modes.as_ref());
                    volume += point.volume;
                }
                let dilatation = sum.over(volume);
                let mut of_volume = Projected::new(zero);
                if !elements.is_linear() {
                    of_volume.mean = pull.of_volume(dilatation.mean);
                } else {
                    for q in 0..Q {
                        let modes = elements.modes_of_lane(simd, block, part, q);
                        let at_point = pull.of_volume(dilatation.at(modes.as_ref()));
                        let of_point = Lane::load(simd, &abreast[block][q].volume.0, part);
                        of_volume.add(at_point * of_point, modes.as_ref());
                    }
                    of_volume = of_volume.over(volume);
                }
                projected = Some(of_volume);
            }
            let mut pulls = [[Lane::splat(simd, -0.0); D]; N];
            let mut is_inside = true;
            for q in 0..Q {
                let point = abreast[block][q].lane(simd, part);
                let gradients = gradients(1, &x, &point.gradients);
                let at = Deformation::new(point.frame, gradients[0]);
                let mut of_volume = None;
                if let Some(projected) = &projected {
                    let modes = elements.modes_of_lane(simd, block, part, q);
                    of_volume = Some(projected.at(modes.as_ref()));
                }
                let (stress, domain) = pull.stress(&at, &gradients, of_volume, point.volume);
                is_inside &= domain.are_positive();
                collect(&point.gradients, &stress, &mut pulls);
            }
            let active = cells.start.max(start)..cells.end.min(start + S::F64_LANES);
            if !is_inside {
                elements.outside(active.clone(), fields, &pull)?;
            }
            let is_of_share = |&node: &usize| first <= node && node + S::F64_LANES <= first + count;
            if let Some(order) = elements.rows.at(block)
                && active.len() == S::F64_LANES
                && nodes[start].iter().all(is_of_share)
            {
                balance(&mut pulls);
                let mut vectors: [Vectors<D>; N] = [[[0.0; SIDE_BY_SIDE]; D]; N];
                for a in 0..N {
                    vectors[a] = contiguous::vectors(&pulls[a]);
                }
                for &a in order {
                    let a = usize::from(a);
                    let node = nodes[start][a] - first;
                    contiguous::subtract(simd, &vectors[a], &mut forces[D * node..]);
                }
                continue;
            }
            let mut numbers = [[[0.0; SIDE_BY_SIDE]; D]; N];
            for a in 1..N {
                for i in 0..D {
                    pulls[a][i].store(&mut numbers[a][i], 0);
                }
            }
            for cell in active {
                subtract(&nodes[cell], &numbers, cell - start, first, forces);
            }
        }
        Ok(())
    }
}

/// The vectors of the nodes of a cell, less that of the first one.
#[inline(always)]
pub(super) fn relative<const N: usize, const D: usize>(
    nodes: &[usize; N],
    x: &[[f64; D]],
) -> [[f64; D]; N] {
    let first = x[nodes[0]];
    let mut relative = [[0.0; D]; N];
    for a in 1..N {
        let of_node = x[nodes[a]];
        for i in 0..D {
            relative[a][i] = of_node[i] - first[i];
        }
    }
    relative
}

/// Adds P g_a to the forces of all nodes but the first.
#[inline(always)]
pub(super) fn collect<T: Real, const N: usize, const M: usize, const D: usize>(
    gradients: &[[T; M]; N],
    stress: &Matrix<T, D, M>,
    pull: &mut [[T; D]; N],
) {
    for a in 1..N {
        for j in 0..M {
            for i in 0..D {
                pull[a][i] += stress[j][i] * gradients[a][j];
            }
        }
    }
}

/// Lets the force on the first node balance those on the others.
#[inline(always)]
fn balance<T: Real, const N: usize, const D: usize>(pulls: &mut [[T; D]; N]) {
    for i in 0..D {
        let mut sum = pulls[0][i];
        for a in 1..N {
            sum += pulls[a][i];
        }
        pulls[0][i] = sum * -1.0;
    }
}

/// Subtracts the forces of the cell in one lane from those on a share of the nodes, which begins with node
/// `first`; the first node of the cell gets the negative sum of the others.
#[inline(always)]
fn subtract<const N: usize, const D: usize>(
    nodes: &[usize; N],
    pulls: &[[[f64; SIDE_BY_SIDE]; D]; N],
    lane: usize,
    first: usize,
    forces: &mut [f64],
) {
    let forces = forces.as_chunks_mut::<D>().0;
    let mut sum = [-0.0; D];
    for a in 1..N {
        for i in 0..D {
            sum[i] += pulls[a][i][lane];
        }
        if let Some(on_node) = forces.get_mut(nodes[a].wrapping_sub(first)) {
            for i in 0..D {
                on_node[i] -= pulls[a][i][lane];
            }
        }
    }
    if let Some(on_first) = forces.get_mut(nodes[0].wrapping_sub(first)) {
        for i in 0..D {
            on_first[i] += sum[i];
        }
    }
}

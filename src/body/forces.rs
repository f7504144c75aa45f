//! The forces of all elements: the loop in which explicit methods spend their time.
//!
//! It is written in plain arrays, column by column, which the compiler turns into less than half the
//! instructions that it makes of products of small matrices. Sums begin with -0, the zero that
//! changes nothing it is added to, so that their first addition is left out.
//!
//! The shape functions of a cell add up to 1 and their gradients to 0. So displacements count
//! relative to the first node, whose force balances those on the others: less work, and forces far
//! from home are as precise as there.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use std::ops::Range;

use rayon::prelude::*;

use super::elements::{ElementsOf, gradient};
use super::regions::Regions;
use crate::element::StrainPoint;
use crate::force::NodalForces;
use crate::material::{Deformation, ElasticLaw, ViscousLaw, with_law};
use crate::ode::Failure;
use crate::tensor::Matrix;

/// Which forces are nonlinear, and computed element by element; the others have constant matrices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NonlinearTerms {
    pub(super) elastic: bool,
    /// Objective viscosity.
    pub(super) viscous: bool,
}

/// Elements as forces.
pub(super) trait Forces {
    /// Adds the elastic forces to the conservative ones and those of objective viscosity to the
    /// dissipative ones, as far as `terms` has them.
    fn add_forces(
        &self,
        regions: &Regions,
        terms: NonlinearTerms,
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
        terms: NonlinearTerms,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let (u, v) = (u.as_chunks::<D>().0, v.as_chunks::<D>().0);
        if terms.elastic {
            self.share_out(&mut forces.conservative, |run, first, forces| {
                regions.runs(run).try_for_each(|(cells, substance)| {
                    with_law!(substance.elastic, law => {
                        self.add(cells, [u], first, forces, |point, [h]| {
                            let at = Deformation::new(&point.frame, h);
                            let domain = law.domain(&at);
                            // not `domain <= 0`, which NaN is not
                            match domain > 0.0 {
                                true => Ok(law.stress(&at, point.volume)),
                                false => Err(law.outside(domain)),
                            }
                        })
                    })
                })
            })?;
        }
        if terms.viscous {
            self.share_out(&mut forces.dissipative, |run, first, forces| {
                regions.runs(run).try_for_each(|(cells, substance)| {
                    self.add(cells, [u, v], first, forces, |point, [h, rate]| {
                        let at = Deformation::new(&point.frame, h);
                        Ok(substance.viscous.stress(&at, &rate, point.volume))
                    })
                })
            })?;
        }
        Ok(())
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Calls `add` for all runs of cells with the forces on each share of the nodes and the first of
    /// these, on threads if there are several shares.
    fn share_out(
        &self,
        forces: &mut [f64],
        add: impl Fn(&Range<usize>, usize, &mut [[f64; D]]) -> Result<(), Failure> + Sync,
    ) -> Result<(), Failure> {
        let add_share = |number: usize, forces: &mut [f64]| {
            let (first, forces) = (number * self.shares.nodes, forces.as_chunks_mut::<D>().0);
            self.shares.cells[number].iter().try_for_each(|run| add(run, first, forces))
        };
        if self.shares.cells.len() == 1 {
            return add_share(0, forces);
        }
        let shares = forces.par_chunks_mut(D * self.shares.nodes).enumerate();
        let failed = shares.find_map_first(|(number, forces)| add_share(number, forces).err());
        failed.map_or(Ok(()), Err)
    }

    /// Adds the forces of `cells` to those on the nodes from `first` on. `stress` gives P times the
    /// volume of a point, or says what is wrong there, from the gradients of the `fields`.
    #[inline(always)]
    fn add<const K: usize>(
        &self,
        cells: Range<usize>,
        fields: [&[[f64; D]]; K],
        first: usize,
        forces: &mut [[f64; D]],
        stress: impl Fn(
            &StrainPoint<N, M, D>,
            [Matrix<f64, D, M>; K],
        ) -> Result<Matrix<f64, D, M>, String>,
    ) -> Result<(), Failure> {
        let points = &self.points()[cells.clone()];
        for ((nodes, points), cell) in self.nodes[cells.clone()].iter().zip(points).zip(cells) {
            let mut x = [[[0.0; D]; N]; K];
            (0..K).for_each(|k| x[k] = relative(nodes, fields[k]));
            let mut pull = [[-0.0; D]; N];
            for point in points {
                let mut gradients = [[[0.0; D]; M]; K];
                (0..K).for_each(|k| gradients[k] = gradient(&x[k][1..], &point.gradients[1..]));
                let stress = stress(point, gradients).map_err(|problem| {
                    let nodes = nodes.map(|node| node + 1);
                    let problem = format!("cell {} (nodes {nodes:?}) {problem}", cell + 1);
                    Failure::Recoverable(problem)
                })?;
                collect(point, &stress, &mut pull);
            }
            subtract(nodes, &pull, first, forces);
        }
        Ok(())
    }
}

/// The vectors of the nodes of a cell, less that of the first one.
#[inline(always)]
fn relative<const N: usize, const D: usize>(nodes: &[usize; N], x: &[[f64; D]]) -> [[f64; D]; N] {
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
fn collect<const N: usize, const M: usize, const D: usize>(
    point: &StrainPoint<N, M, D>,
    stress: &Matrix<f64, D, M>,
    pull: &mut [[f64; D]; N],
) {
    for a in 1..N {
        for j in 0..M {
            for i in 0..D {
                pull[a][i] += stress[j][i] * point.gradients[a][j];
            }
        }
    }
}

/// Subtracts the forces of a cell from those on a share of the nodes, which begins with node `first`;
/// the first node of the cell gets what balances the others.
#[inline(always)]
fn subtract<const N: usize, const D: usize>(
    nodes: &[usize; N],
    pull: &[[f64; D]; N],
    first: usize,
    forces: &mut [[f64; D]],
) {
    let mut sum = [-0.0; D];
    for a in 1..N {
        (0..D).for_each(|i| sum[i] += pull[a][i]);
        if let Some(on_node) = forces.get_mut(nodes[a].wrapping_sub(first)) {
            (0..D).for_each(|i| on_node[i] -= pull[a][i]);
        }
    }
    if let Some(on_first) = forces.get_mut(nodes[0].wrapping_sub(first)) {
        (0..D).for_each(|i| on_first[i] += sum[i]);
    }
}

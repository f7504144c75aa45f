//! The forces of all cells: the loop in which explicit methods spend their time.
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

use nalgebra::SMatrix;
use rayon::prelude::*;

use super::cells::{Law, check_orientation};
use super::regions::Regions;
use super::shares::Shares;
use crate::element::StrainPoint;
use crate::force::NodalForces;
use crate::material::Lame;
use crate::ode::Failure;

/// A matrix of M columns.
type Columns<const D: usize, const M: usize> = [[f64; D]; M];

/// Cells as arrays of one kind, and how they are shared out.
pub(super) struct Shared<'a, const N: usize, const M: usize, const D: usize, const Q: usize> {
    pub(super) nodes: &'a [[usize; N]],
    pub(super) points: &'a [[StrainPoint<N, M, D>; Q]],
    pub(super) shares: &'a Shares,
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Shared<'_, N, M, D, Q> {
    /// Adds the forces of Green strain, if `law` has them, and of objective viscosity.
    pub(super) fn add_forces(
        &self,
        regions: &Regions,
        law: Law,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let (u, v) = (u.as_chunks::<D>().0, v.as_chunks::<D>().0);
        if law.green {
            self.share_out(&mut forces.conservative, |run, first, forces| {
                self.add_elastic(run, regions, u, first, forces)
            })?;
        }
        if law.objective {
            self.share_out(&mut forces.dissipative, |run, first, forces| {
                self.add_viscous(run, regions, u, v, first, forces);
                Ok(())
            })?;
        }
        Ok(())
    }

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

    /// Number, nodes and strain points of a run of cells.
    fn cells(
        &self,
        run: &Range<usize>,
    ) -> impl Iterator<Item = (usize, &[usize; N], &[StrainPoint<N, M, D>; Q])> {
        let cells = self.nodes[run.clone()].iter().zip(&self.points[run.clone()]);
        cells.zip(run.clone()).map(|((nodes, points), cell)| (cell, nodes, points))
    }

    /// Adds the forces of Green strain of a run of cells to those on the nodes from `first` on.
    fn add_elastic(
        &self,
        run: &Range<usize>,
        regions: &Regions,
        u: &[[f64; D]],
        first: usize,
        forces: &mut [[f64; D]],
    ) -> Result<(), Failure> {
        for (cell, nodes, points) in self.cells(run) {
            let elastic = regions.of(cell).elastic;
            let displacements = relative(nodes, u);
            let mut pull = [[-0.0; D]; N];
            for point in points {
                let h = gradient(point, &displacements);
                let f = deformation(point, &h);
                check_orientation(cell, nodes, &SMatrix::<f64, D, M>::from_fn(|i, j| f[j][i]))?;
                let stress = stress(elastic, point.volume, &twice_strain(point, &h));
                collect(point, &f, &stress, &mut pull);
            }
            subtract(nodes, &pull, first, forces);
        }
        Ok(())
    }

    /// Adds the forces of objective viscosity likewise.
    fn add_viscous(
        &self,
        run: &Range<usize>,
        regions: &Regions,
        u: &[[f64; D]],
        v: &[[f64; D]],
        first: usize,
        forces: &mut [[f64; D]],
    ) {
        for (cell, nodes, points) in self.cells(run) {
            let viscous = regions.of(cell).viscous;
            let (displacements, velocities) = (relative(nodes, u), relative(nodes, v));
            let mut pull = [[-0.0; D]; N];
            for point in points {
                let f = deformation(point, &gradient(point, &displacements));
                let rate = twice_symmetric(&f, &gradient(point, &velocities));
                collect(point, &f, &stress(viscous, point.volume, &rate), &mut pull);
            }
            subtract(nodes, &pull, first, forces);
        }
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

/// H = sum x_a g_a^T
#[inline(always)]
fn gradient<const N: usize, const M: usize, const D: usize>(
    point: &StrainPoint<N, M, D>,
    relative: &[[f64; D]; N],
) -> Columns<D, M> {
    let mut h = [[-0.0; D]; M];
    for (j, column) in h.iter_mut().enumerate() {
        for a in 1..N {
            for i in 0..D {
                column[i] += relative[a][i] * point.gradients[a][j];
            }
        }
    }
    h
}

/// F = F_0 + H
#[inline(always)]
fn deformation<const N: usize, const M: usize, const D: usize>(
    point: &StrainPoint<N, M, D>,
    h: &Columns<D, M>,
) -> Columns<D, M> {
    let mut f = *h;
    for (j, column) in f.iter_mut().enumerate() {
        // a frame that is the identity need not be looked up
        match M == D {
            true => column[j] += 1.0,
            false => (0..D).for_each(|i| column[i] += point.frame[(i, j)]),
        }
    }
    f
}

/// 2 E = F_0^T H + H^T F_0 + H^T H
#[inline(always)]
fn twice_strain<const N: usize, const M: usize, const D: usize>(
    point: &StrainPoint<N, M, D>,
    h: &Columns<D, M>,
) -> Columns<M, M> {
    let along = |j: usize, k: usize| match M == D {
        true => h[k][j],
        false => (0..D).fold(-0.0, |sum, i| sum + point.frame[(i, j)] * h[k][i]),
    };
    symmetric(|j, k| along(j, k) + along(k, j) + dot(&h[j], &h[k]))
}

/// F^T L + L^T F: twice the rate of strain, if L is that of F.
#[inline(always)]
fn twice_symmetric<const M: usize, const D: usize>(
    f: &Columns<D, M>,
    l: &Columns<D, M>,
) -> Columns<M, M> {
    symmetric(|j, k| dot(&f[j], &l[k]) + dot(&f[k], &l[j]))
}

/// lambda tr(E) I + 2 mu E, times the volume, of 2 E.
#[inline(always)]
fn stress<const M: usize>(lame: Lame, volume: f64, twice: &Columns<M, M>) -> Columns<M, M> {
    let trace = (0..M).fold(-0.0, |sum, j| sum + twice[j][j]);
    let (mean, shear) = (0.5 * lame.lambda * volume * trace, lame.mu * volume);
    symmetric(|j, k| shear * twice[j][k] + if j == k { mean } else { -0.0 })
}

/// Adds F S g_a to the forces of all nodes but the first.
#[inline(always)]
fn collect<const N: usize, const M: usize, const D: usize>(
    point: &StrainPoint<N, M, D>,
    f: &Columns<D, M>,
    s: &Columns<M, M>,
    pull: &mut [[f64; D]; N],
) {
    let mut product = [[-0.0; D]; M];
    for j in 0..M {
        for k in 0..M {
            for i in 0..D {
                product[j][i] += f[k][i] * s[j][k];
            }
        }
    }
    for a in 1..N {
        for j in 0..M {
            for i in 0..D {
                pull[a][i] += product[j][i] * point.gradients[a][j];
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

#[inline(always)]
fn symmetric<const M: usize>(entry: impl Fn(usize, usize) -> f64) -> Columns<M, M> {
    let mut matrix = [[0.0; M]; M];
    for j in 0..M {
        for k in 0..=j {
            matrix[j][k] = entry(j, k);
            matrix[k][j] = matrix[j][k];
        }
    }
    matrix
}

#[inline(always)]
fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).fold(-0.0, |sum, i| sum + a[i] * b[i])
}

//! Functions of few coefficients on each cell, onto which a dilatation is projected.
//!
//! A function on a cell is its mean plus M linear modes p_k of the undeformed position. The modes are orthonormal over
//! the volume V of the cell: int p_k dV = 0, int p_k p_l dV = V if k = l, else 0. The projection of g has the coefficients
//! int g dV / V and int g p_k dV / V.
//!
//! The energy int U(projected g) dV then has the derivative int q dg dV with q the projection of U' of the projected g. With
//! G_k = int p_k dg dV (p_0 = 1), the tangent is that of g at a constant q, and sum A_kl G_k G_l^T with
//! A_kl = int U'' p_k p_l dV / V^2. For the mean alone only A_00 = U''/V remains.
//!
//! The modes are linear in space and not in the reference cell, so that they keep their order in distorted
//! cells.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use crate::base::lane::{Packed, SIDE_BY_SIDE};
use crate::base::tensor::Real;

/// Most coefficients: the mean and a mode for each axis of space.
pub(super) const COEFFICIENTS: usize = 4;

/// The coefficients of a function on a cell.
#[derive(Clone, Copy)]
pub(super) struct Projected<T, const M: usize> {
    pub(super) mean: T,
    slopes: [T; M],
}

impl<T: Real, const M: usize> Projected<T, M> {
    #[inline(always)]
    pub(super) fn new(mean: T) -> Self {
        Self { mean, slopes: [mean.constant(0.0); M] }
    }

    /// Adds a value at a point times the volume of that, where the modes have these values if there are any.
    #[inline(always)]
    pub(super) fn add(&mut self, value: T, modes: Option<&[T; M]>) {
        self.mean += value;
        if let Some(modes) = modes {
            for k in 0..M {
                self.slopes[k] += value * modes[k];
            }
        }
    }

    /// The coefficients, of sums over a cell of this `volume`.
    #[inline(always)]
    pub(super) fn over(mut self, volume: T) -> Self {
        self.mean = self.mean / volume;
        for k in 0..M {
            self.slopes[k] = self.slopes[k] / volume;
        }
        self
    }

    /// The value at a point.
    #[inline(always)]
    pub(super) fn at(&self, modes: Option<&[T; M]>) -> T {
        let mut value = self.mean;
        if let Some(modes) = modes {
            for k in 0..M {
                value += self.slopes[k] * modes[k];
            }
        }
        value
    }
}

/// The linear modes of a cell at its points, of which `points` are the positions and volumes: the coordinates, made
/// orthonormal one after the other (Gram and Schmidt).
pub(super) fn linear_modes<const M: usize, const Q: usize>(
    points: &[([f64; M], f64); Q],
) -> [[f64; M]; Q] {
    let volume: f64 = points.iter().map(|(_, volume)| volume).sum();
    let product = |f: &dyn Fn(usize) -> f64| {
        points.iter().enumerate().map(|(q, (_, volume))| volume * f(q)).sum::<f64>() / volume
    };
    let mut modes = [[0.0; M]; Q];
    for k in 0..M {
        let mean = product(&|q| points[q].0[k]);
        let along: [f64; M] = std::array::from_fn(|l| {
            if l < k { product(&|q| modes[q][l] * points[q].0[k]) } else { 0.0 }
        });
        for q in 0..Q {
            let before: f64 = (0..k).map(|l| along[l] * modes[q][l]).sum();
            modes[q][k] = points[q].0[k] - mean - before;
        }
        let size = product(&|q| modes[q][k] * modes[q][k]).sqrt();
        modes.iter_mut().for_each(|mode| mode[k] /= size);
    }
    modes
}

/// The modes of cells, `Q` points of each, in lanes. Cells that are missing at the end repeat the last one.
pub(super) fn modes_side_by_side<const M: usize, const Q: usize>(
    cells: &[[[f64; M]; Q]],
) -> Vec<[Packed; M]> {
    let blocks = cells.chunks(SIDE_BY_SIDE);
    blocks
        .flat_map(|cells| {
            let of_lane = |lane: usize| &cells[lane.min(cells.len() - 1)];
            (0..Q).map(move |q| {
                std::array::from_fn(|k| Packed(std::array::from_fn(|lane| of_lane(lane)[q][k])))
            })
        })
        .collect()
}

//! Hooke's law: the isotropic linear formula between strain and stress that several laws share.
//!
//! A cell of lower dimension has the Lamé pair of a cell without stress across it, so that lambda + 2 mu of a
//! segment is Young's modulus.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use super::law::{Block, Blocks};
use crate::base::tensor::{
    Matrix, Real, dot, product, product_transposed, symmetric, times, trace,
};

/// Lamé's constants (Pa; Pa s for the viscous pair).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lame {
    /// First constant, lambda.
    pub lambda: f64,
    /// Second constant, mu (the shear modulus).
    pub mu: f64,
}

/// Assumption about the direction across cells of two dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plane {
    /// No strain across the plane (Hirai's choice): lambda as it is. The default of bodies in the plane.
    Strain,
    /// No stress across the plane, so that the thickness changes: lambda becomes 2 lambda mu / (lambda + 2 mu). The default of
    /// membranes in space.
    Stress,
    /// Bodies of revolution: the plane is the half r >= 0 of (r, z), turned about the axis r = 0, x being r and y being z. Around it
    /// the strain is u_r / R.
    Axisymmetric,
}

impl Plane {
    /// Name: `strain`, `stress`, `axisymmetric`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Strain => "strain",
            Self::Stress => "stress",
            Self::Axisymmetric => "axisymmetric",
        }
    }

    /// Whether the section of cells of dimension `M` is free to change.
    pub(super) const fn is_free<const M: usize>(self) -> bool {
        M == 1 || M == 2 && matches!(self, Self::Stress)
    }
}

/// S = lambda tr(E) I + 2 mu E in the coordinates of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hooke {
    pub(crate) lame: Lame,
    /// Assumption across the cell, if it has less than three dimensions.
    pub(super) across: Plane,
}

impl Hooke {
    /// The law of a cell of `cell_dimension`: segments have no stress across them, so that they stretch with
    /// E = lambda + 2 mu exactly; cells of two dimensions are as `plane` says.
    pub(crate) fn new(lame: Lame, cell_dimension: usize, plane: Plane) -> Self {
        let Lame { lambda, mu } = lame;
        let across = if cell_dimension == 1 { Plane::Stress } else { plane };
        let lambda = match (cell_dimension, across) {
            (1 | 2, Plane::Stress) if mu == 0.0 => 0.0,
            // E - 2 mu, with E = mu (3 lambda + 2 mu) / (lambda + mu)
            (1, _) => lambda * mu / (lambda + mu),
            (2, Plane::Stress) => 2.0 * lambda * mu / (lambda + 2.0 * mu),
            _ => lambda,
        };
        Self { lame: Lame { lambda, mu }, across }
    }

    /// Whether there is no stress across its cells, of this `cell_dimension`.
    pub(crate) fn is_free_across(&self, cell_dimension: usize) -> bool {
        cell_dimension < 3 && self.across == Plane::Stress
    }

    /// The same with lambda = 0, without the resistance to a change of volume.
    #[inline(always)]
    pub(crate) fn of_shear(&self) -> Self {
        Self { lame: Lame { lambda: 0.0, ..self.lame }, ..*self }
    }

    /// lambda g^2 / 2 of the trace g of the strain, with its derivatives.
    #[inline(always)]
    pub(super) fn of_volume<T: Real>(&self, trace: T) -> [T; 3] {
        let pull = trace * self.lame.lambda;
        [pull * trace * 0.5, pull, trace.constant(self.lame.lambda)]
    }

    /// Whether there is no stress at any strain.
    pub(crate) fn is_zero(&self) -> bool {
        self.lame == Lame { lambda: 0.0, mu: 0.0 }
    }

    /// lambda tr(E)^2 / 2 + mu E : E, given 2 E
    #[inline(always)]
    pub(crate) fn energy<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> T {
        let strain = times(*twice, twice[0][0].constant(0.5));
        let trace = trace(&strain);
        let mut square = dot(&strain[0], &strain[0]);
        for j in 1..M {
            square += dot(&strain[j], &strain[j]);
        }
        trace * (0.5 * self.lame.lambda) * trace + square * self.lame.mu
    }

    /// lambda tr(E) I + 2 mu E, times `weight`, given 2 E; a `pull` takes the place of lambda tr(E).
    #[inline(always)]
    pub(super) fn stress<T: Real, const M: usize>(
        &self,
        twice: &Matrix<T, M, M>,
        pull: Option<T>,
        weight: T,
    ) -> Matrix<T, M, M> {
        let mean = match pull {
            None => weight * (0.5 * self.lame.lambda) * trace(twice),
            Some(pull) => pull * weight,
        };
        let shear = weight * self.lame.mu;
        symmetric!(mean; j, k => match j == k {
            true => shear * twice[j][k] + mean,
            false => shear * twice[j][k],
        })
    }

    /// Strain and stress across a cell with 2 E along it.
    #[inline(always)]
    pub(super) fn across<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> [T; 2] {
        let Lame { lambda, mu } = self.lame;
        let swelling = trace(twice) * 0.5;
        let zero = swelling.constant(0.0);
        match self.across {
            Plane::Strain | Plane::Axisymmetric => [zero, swelling * lambda],
            Plane::Stress => [swelling * (-lambda / (2.0 * mu)), zero],
        }
    }
}

/// The material part of tangents of Hooke's law. Their geometric part, of the stress S, is g_a . S g_b on the
/// diagonal.
pub(super) struct Spread<'a, T, const N: usize, const M: usize, const D: usize> {
    pub(super) gradients: &'a [[T; M]; N],
    /// F g_a
    pub(super) along: [[T; D]; N],
    /// F F^T, symmetric to the last bit
    square: Matrix<T, D, D>,
    lame: Lame,
    pub(super) weight: T,
}

impl<'a, T: Real, const N: usize, const M: usize, const D: usize> Spread<'a, T, N, M, D> {
    #[inline(always)]
    pub(super) fn new(
        f: &Matrix<T, D, M>,
        gradients: &'a [[T; M]; N],
        lame: Lame,
        weight: T,
    ) -> Self {
        let along = product(f, gradients);
        Self { gradients, along, square: product_transposed(f, f), lame, weight }
    }

    /// lambda f_a f_b^T + mu ((g_a . g_b) F F^T + f_b f_a^T), f_a = F g_a
    #[inline(always)]
    pub(super) fn material(&self, a: usize, b: usize) -> Block<T, D> {
        let (fa, fb) = (&self.along[a], &self.along[b]);
        let Lame { lambda, mu } = self.lame;
        let stretch = dot(&self.gradients[a], &self.gradients[b]);
        let mut block = [[stretch; D]; D];
        for i in 0..D {
            for k in 0..D {
                let shear = self.square[i][k] * stretch + fb[i] * fa[k];
                block[i][k] = fa[i] * fb[k] * lambda + shear * mu;
            }
        }
        block
    }
}

impl<T: Real, const N: usize, const M: usize, const D: usize> Blocks<T, D>
    for Spread<'_, T, N, M, D>
{
    #[inline(always)]
    fn block(&self, a: usize, b: usize) -> Block<T, D> {
        times(self.material(a, b), self.weight)
    }
}

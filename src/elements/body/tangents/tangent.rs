//! The tangents at the points of cells: of elastic laws and of viscosity, at points or with a projected
//! dilatation.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use crate::base::tensor::{Matrix, Real, product, times};
use crate::elements::material::{Block, Blocks, CellLaw, Deformation, ViscousLaw};

/// A tangent at a point, by the gradients of `K` fields: of displacements and, if K is 2, of velocities.
pub(in crate::elements::body) trait TangentTerm<const K: usize> {
    /// Whether the block of nodes b and a is that of a and b, transposed.
    const IS_SYMMETRIC: bool;

    /// Whether the dilatation is a projected one.
    fn is_projected(&self) -> bool;

    /// The tangent of a point of this `volume`, with the `pull` of a projected dilatation kept constant.
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        fields: &[Matrix<T, D, M>; K],
        pull: Option<T>,
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D>;

    /// The dilatation of a point, the derivative of the nodal forces by the `pull` there, and that of the
    /// dilatation by the motion of the nodes, all times its `volume`.
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        fields: &[Matrix<T, D, M>; K],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> (T, [[T; D]; N], [[T; D]; N]);

    /// The `pull` of a projected dilatation where it has this value, and its derivative by that.
    fn of_volume<T: Real>(&self, dilatation: T) -> [T; 2];
}

/// Tangent term of one coefficient of the projected dilatation: `share` times the outer product of two derivatives, of the nodal
/// forces with respect to the coefficient of the `pull`, and of the dilatation with respect to nodal positions.
#[derive(Clone, Copy)]
pub(super) struct OfVolume<T, const N: usize, const D: usize> {
    pub(super) force: [[T; D]; N],
    pub(super) motion: [[T; D]; N],
    pub(super) share: T,
}

impl<T: Real, const N: usize, const D: usize> Blocks<T, D> for OfVolume<T, N, D> {
    #[inline(always)]
    fn block(&self, a: usize, b: usize) -> Block<T, D> {
        let mut block = [[self.share; D]; D];
        for i in 0..D {
            for k in 0..D {
                block[i][k] = self.force[a][i] * self.motion[b][k] * self.share;
            }
        }
        block
    }
}

/// Of an elastic law.
pub(in crate::elements::body) struct ElasticTangent<'l, L> {
    pub(in crate::elements::body) law: &'l L,
    pub(in crate::elements::body) is_projected: bool,
}

impl<L: CellLaw> TangentTerm<1> for ElasticTangent<'_, L> {
    const IS_SYMMETRIC: bool = true;

    #[inline(always)]
    fn is_projected(&self) -> bool {
        self.is_projected
    }

    #[inline(always)]
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
        pull: Option<T>,
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D> {
        self.law.tangent_at(at, pull, gradients, volume)
    }

    #[inline(always)]
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> (T, [[T; D]; N], [[T; D]; N]) {
        let (dilatation, slope) = self.law.swelling_at(at);
        let by_nodes = times(product(&slope, gradients), volume);
        (dilatation * volume, by_nodes, by_nodes)
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, dilatation: T) -> [T; 2] {
        let [_, pull, stiff] = self.law.of_projected(dilatation);
        [pull, stiff]
    }
}

/// The tangent of viscous stress by the rate.
pub(super) struct RateTangent<'l, L> {
    pub(super) law: &'l L,
    pub(super) is_projected: bool,
}

impl<L: ViscousLaw> TangentTerm<1> for RateTangent<'_, L> {
    const IS_SYMMETRIC: bool = true;

    #[inline(always)]
    fn is_projected(&self) -> bool {
        self.is_projected
    }

    #[inline(always)]
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
        _: Option<T>,
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D> {
        self.law.rate_tangent(at, self.is_projected, gradients, volume)
    }

    #[inline(always)]
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        [rate]: &[Matrix<T, D, M>; 1],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> (T, [[T; D]; N], [[T; D]; N]) {
        let [by_rate, _] = self.law.swelling(at, rate, gradients);
        let force = times(by_rate, volume);
        (volume, force, force)
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, rate: T) -> [T; 2] {
        self.law.of_volume(rate)
    }
}

/// The tangent of viscous stress by the deformation.
pub(super) struct ViscousTangent<'l, L> {
    pub(super) law: &'l L,
    pub(super) is_projected: bool,
}

impl<L: ViscousLaw> TangentTerm<2> for ViscousTangent<'_, L> {
    const IS_SYMMETRIC: bool = false;

    #[inline(always)]
    fn is_projected(&self) -> bool {
        self.is_projected
    }

    #[inline(always)]
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        [_, rate]: &[Matrix<T, D, M>; 2],
        pull: Option<T>,
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D> {
        self.law.tangent(at, rate, pull, gradients, volume)
    }

    #[inline(always)]
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        [_, rate]: &[Matrix<T, D, M>; 2],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> (T, [[T; D]; N], [[T; D]; N]) {
        let [force, motion] =
            self.law.swelling(at, rate, gradients).map(|by_nodes| times(by_nodes, volume));
        (self.law.rate_of_dilatation(at, rate) * volume, force, motion)
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, rate: T) -> [T; 2] {
        self.law.of_volume(rate)
    }
}
